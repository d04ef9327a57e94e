//! A scene that is looked at frame by frame, by every scheme alike.

use super::{FrameTruth, Motion, Options, Scheme};
use crate::shadow_levels::PicturesError;
use crate::shadow_levels::pictures::{Pictures, unshadowed};
use crate::shadows::{ShadowTruth, part_found};
use arealight::plan::{Output, ShadeOptions, ShadowFilter, ShadowHistory};
use arealight::{Effects, Light, LightShape, Plane};
use arealight_engine::host::Usage;
use arealight_engine::{Engine, EngineError, ShadowedView};
use arealight_scene::{Camera, Scene, SceneBuffers};
use arealight_vk::ShadowStage;
use glam::{DQuat, DVec3, Vec3};

/// Metres that lights move in a frame, along x.
const STEP: f64 = 0.04;

/// Rays a pixel of a truth's frames.
const TRUTH_RAYS: u32 = 4;

/// Out of its plane by this part of the camera's distance, a point is of another surface: as the history has
/// it.
const PLANE_PART: f64 = 0.01;

/// A point that a pixel sees, relative to the scene's origin, and its normal.
type Seen = Option<(DVec3, DVec3)>;

pub(super) struct Film<'a> {
    scene: &'a Scene,
    buffers: SceneBuffers,
    pictures: Pictures<'a>,
    schemes: Vec<ShadowedView>,
    truth: ShadowedView,
    motion: Motion,
    size: [u32; 2],
    /// From the middle of the film, frames.
    middle: f64,
    camera: Camera,
    seen: Vec<Seen>,
    uncovered: Vec<bool>,
}

impl<'a> Film<'a> {
    pub fn new(
        engine: &'a Engine,
        scene: &'a Scene,
        motion: Motion,
        options: &Options,
    ) -> Result<Self, PicturesError> {
        let size = options.size;
        let (pictures, buffers, camera) = Pictures::new(engine, scene, size)?;
        let passes = |shadow_rays, filter| {
            let surfaces = scene.effects() & Effects::SURFACES;
            let options =
                ShadeOptions { surfaces, shadow_rays, output: Output::default(), ..ShadeOptions::default() };
            pictures.renderer.shadowed(&buffers, options, filter)
        };
        let scheme = |scheme: &Scheme| {
            let history = if scheme.history { ShadowHistory::Camera } else { ShadowHistory::Off };
            passes(scheme.rays, (ShadowFilter::Gather, history))
        };
        let schemes = Scheme::ALL.iter().map(scheme).collect::<Result<_, _>>()?;
        let truth = passes(TRUTH_RAYS, (ShadowFilter::Off, ShadowHistory::Off))?;
        Ok(Self {
            scene,
            schemes,
            truth,
            pictures,
            buffers,
            motion,
            size,
            middle: f64::from(options.frames_of(motion)) / 2.0,
            camera,
            seen: vec![],
            uncovered: vec![],
        })
    }

    /// Moves what moves to where it is in a frame.
    pub fn advance(&mut self, frame: u32) -> Result<(), EngineError> {
        let time = f64::from(self.motion.speed()) * (f64::from(frame) - self.middle);
        if self.motion.moves_light() {
            let lights: Vec<Light> = self.scene.lights.iter().map(|light| moved(light, time)).collect();
            self.pictures.renderer.set_lights(&lights, self.buffers.origin)?;
        }
        let before = self.camera.clone();
        if self.motion.moves_camera() {
            let aspect = f64::from(self.size[0]) / f64::from(self.size[1].max(1));
            if let Some(camera) = self.scene.camera(None, aspect) {
                self.camera = orbit(camera, time.to_radians());
            }
            let constants = self.buffers.constants(&self.camera, self.size, Vec3::ZERO);
            self.pictures.renderer.look(constants);
        }
        self.pictures.look_again()?;

        // What the frame before did not see
        let seen = self.see()?;
        let was_seen = |point: &Seen| {
            let (position, normal) = (*point)?;
            let there = self.seen.get(pixel_of(&before, self.size, position + self.buffers.origin)?)?;
            let apart = normal.dot((*there)?.0 - position).abs();
            let distance = (position + self.buffers.origin - before.position).length();
            (apart < PLANE_PART * distance).then_some(())
        };
        self.uncovered =
            seen.iter().map(|point| frame > 0 && point.is_some() && was_seen(point).is_none()).collect();
        self.seen = seen;
        Ok(())
    }

    /// What each pixel sees.
    fn see(&self) -> Result<Vec<Seen>, EngineError> {
        let g_buffer = self.pictures.renderer.g_buffer();
        let positions: Vec<[f32; 4]> = g_buffer[Plane::Position].download(Usage::COMPUTE_READ)?;
        let normals: Vec<[f32; 4]> = g_buffer[Plane::Normal].download(Usage::COMPUTE_READ)?;
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
        let points = positions.into_iter().zip(normals);
        Ok(points.map(|(p, n)| (p[3] != 0.0).then(|| (vector(p), vector(n)))).collect())
    }

    /// Of each pixel, whether the frame before did not see its surface.
    pub fn uncovered(&self) -> &[bool] {
        &self.uncovered
    }

    /// The frame's truth: a mean over so many frames of rays, of seeds that no scheme has.
    pub fn truth(&mut self, frames: u32) -> Result<FrameTruth, PicturesError> {
        let renderer = &mut self.pictures.renderer;
        let pixels = self.size.map(|side| side as usize).iter().product();
        let mut sums = [vec![0.0; pixels], vec![0.0; pixels]];
        let mut lit = vec![false; pixels];
        for frame in 0..frames.max(2) {
            let seed = 1_000_000 + frame;
            renderer.shade_picking(&self.truth, seed)?;
            renderer.shadow_stage(&self.truth, ShadowStage::Rays, seed)?;
            let half = &mut sums[usize::from(2 * frame >= frames.max(2))];
            for ((sum, lit), shadow) in half.iter_mut().zip(&mut lit).zip(self.truth.shadows()?) {
                *sum += f64::from(shadow.x);
                *lit = shadow.z > 0.0;
            }
        }
        let (first, all) = (f64::from(frames.max(2).div_ceil(2)), f64::from(frames.max(2)));
        let half: Vec<f64> = sums[0].iter().map(|sum| sum / first).collect();
        let whole = sums[0].iter().zip(&sums[1]).map(|(a, b)| (a + b) / all);
        let light = unshadowed(&self.truth)?;
        let parts: Vec<_> = whole.zip(&lit).map(|(part, lit)| lit.then_some(part)).collect();
        let radiance = light.iter().zip(&parts).map(|(light, part)| *light * part.unwrap_or(0.0)).collect();
        Ok(FrameTruth { mean: ShadowTruth { parts, radiance }, half })
    }

    /// What arrives at each pixel, by a scheme.
    pub fn shadows(&mut self, scheme: usize, frame: u32) -> Result<Vec<f64>, EngineError> {
        self.pictures.begin()?;
        let passes = &self.schemes[scheme];
        self.pictures.renderer.shade_shadowed(passes, frame)?;
        let (shadowed, unshadowed) = (self.pictures.radiance()?, unshadowed(passes)?);
        Ok(shadowed.iter().zip(&unshadowed).map(|(with, without)| part_found(*with, *without)).collect())
    }
}

/// A polygon light so many frames after the middle; others stay.
fn moved(light: &Light, time: f64) -> Light {
    let LightShape::Polygon(vertices) = &light.shape else { return light.clone() };
    let center = vertices.iter().sum::<DVec3>() / vertices.len().max(1) as f64;
    let turn = DQuat::from_rotation_y(time.to_radians());
    let place = center + DVec3::X * (STEP * time);
    let vertices = vertices.iter().map(|vertex| place + turn * (*vertex - center)).collect();
    Light { shape: LightShape::Polygon(vertices), ..light.clone() }
}

/// A camera turned about the vertical axis through the origin.
fn orbit(camera: Camera, angle: f64) -> Camera {
    let turn = DQuat::from_rotation_y(angle);
    Camera {
        position: turn * camera.position,
        forward: turn * camera.forward,
        up: turn * camera.up,
        right: turn * camera.right,
        ..camera
    }
}

/// The pixel, in rows from the top, at which a camera sees a world position; none outside of its picture.
fn pixel_of(camera: &Camera, [width, height]: [u32; 2], position: DVec3) -> Option<usize> {
    let offset = position - camera.position;
    let depth = offset.dot(camera.forward) * camera.half_height;
    let aspect = f64::from(width) / f64::from(height.max(1));
    let x = (0.5 + 0.5 * offset.dot(camera.right) / (depth * aspect)) * f64::from(width);
    let y = (0.5 - 0.5 * offset.dot(camera.up) / depth) * f64::from(height);
    let is_within = depth > 0.0 && x >= 0.0 && y >= 0.0 && x < f64::from(width) && y < f64::from(height);
    is_within.then(|| y as usize * width as usize + x as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_scene::Bounds;

    #[test]
    fn a_point_is_seen_at_the_pixel_whose_ray_meets_it() {
        let bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        let camera = Camera::framing("", bounds, DVec3::new(-0.3, -0.8, -1.0), DVec3::Y, 1.5);
        for camera in [camera.clone(), orbit(camera, 0.4)] {
            for (x, y, pixel) in
                [(-0.99, 0.99, 0), (0.99, 0.99, 29), (-0.99, -0.99, 19 * 30), (0.01, -0.01, 10 * 30 + 15)]
            {
                let [start, direction] = camera.ray([x, y], 1.5);
                let point = start + 3.0 * direction;
                assert_eq!(pixel_of(&camera, [30, 20], point), Some(pixel));
            }
            assert_eq!(pixel_of(&camera, [30, 20], camera.position + camera.ray([1.01, 0.0], 1.5)[1]), None);
            assert_eq!(pixel_of(&camera, [30, 20], camera.position - camera.forward), None);
        }
    }

    #[test]
    fn a_light_moves_and_keeps_its_size() {
        let corner = |x: f64, z: f64| DVec3::new(x, 2.0, z);
        let shape = LightShape::Polygon(vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 2.0)]);
        let light = Light { shape, ..Light::default() };
        let at = |time| moved(&light, time).shape.vertices().to_vec();
        let (first, later) = (at(0.0), at(10.0));
        assert!(first.iter().zip(light.shape.vertices()).all(|(a, b)| (*a - *b).length() < 1e-12));
        let center = |points: &[DVec3]| points.iter().sum::<DVec3>() / 3.0;
        assert!((center(&later) - center(&first) - DVec3::X * 0.4).length() < 1e-12);
        let edge = |points: &[DVec3]| points[1] - points[0];
        assert!((edge(&later).angle_between(edge(&first)).to_degrees() - 10.0).abs() < 1e-9);
        assert!((edge(&later).length() - 1.0).abs() < 1e-12);
    }
}
