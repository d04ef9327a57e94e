//! Scenes through an orthographic camera: what it sees, and what it is shaded like, with shadows and without.
//! The twin of each is a perspective camera that sees as much.

use arealight_engine::EngineError;
use arealight_tests::prelude::*;
use arealight_tests::scenes::{box_of, quad_light, square};
use arealight_tool_kernels::gpu::VisibilityConstants;
use std::time::Duration;

const SIZE: [u32; 2] = [48, 32];
const ASPECT: f64 = 1.5;
const HALF_HEIGHT: f64 = 1.5;

/// A floor with a box above it, and a lamp.
fn scene(material: Material) -> Scene {
    let block = box_of(DVec3::new(-0.5, 0.4, -0.4), DVec3::new(0.4, 0.7, 0.3));
    let mut scene = scene_of(&[&square(0.0, 9.0)[..], &block].concat(), without_textures(material));
    scene.lights = vec![quad_light(DVec3::new(0.0, 2.0, -0.8))];
    scene
}

fn metal() -> Material {
    Material { metalness: 1.0, roughness: 0.4, ..lambert(0.75) }
}

fn camera() -> Camera {
    let bounds = [DVec3::NEG_ONE, DVec3::ONE].into_iter().collect();
    let framing = Camera::framing("", bounds, DVec3::new(-0.2, -1.0, -0.7), DVec3::Y, ASPECT);
    Camera { orthographic: true, half_height: HALF_HEIGHT, ..framing }
}

/// A scene as a camera sees it.
struct View<'a> {
    scene: &'a Scene,
    buffers: SceneBuffers,
    renderer: SceneRenderer<'a>,
}

impl<'a> View<'a> {
    fn new(engine: &'a TestEngine, scene: &'a Scene, camera: &Camera) -> Self {
        let buffers = SceneBuffers::new(scene, camera.position).unwrap();
        let constants = buffers.constants(camera, SIZE, Vec3::ZERO);
        let mut renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, SIZE).unwrap();
        renderer.visibility().unwrap();
        Self { scene, buffers, renderer }
    }

    /// World positions, and normals.
    fn surfaces(&self) -> Vec<[DVec3; 2]> {
        let g_buffer = self.renderer.g_buffer();
        let [positions, normals]: [Vec<[f32; 4]>; 2] = [&g_buffer[Plane::Position], &g_buffer[Plane::Normal]]
            .map(|image| image.download(Usage::COMPUTE_READ).unwrap());
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
        let pixels = positions.into_iter().zip(normals);
        pixels.map(|(position, normal)| [vector(position) + self.buffers.origin, vector(normal)]).collect()
    }

    /// What `shade` adds, in the first channel.
    fn shaded(
        &mut self,
        shade: impl FnOnce(&mut SceneRenderer<'_>) -> Result<Option<Duration>, EngineError>,
    ) -> Vec<f64> {
        self.renderer.visibility().unwrap();
        shade(&mut self.renderer).unwrap();
        self.renderer.radiance().unwrap().iter().map(|texel| f64::from(texel.x)).collect()
    }

    /// What each pixel's surface reflects along `view`, by the kernel that shades points.
    fn evaluated(&self, engine: &TestEngine, view: impl Fn(DVec3) -> DVec3) -> Vec<f64> {
        let point = |[position, normal]: [DVec3; 2]| EvalPoint {
            surface: self.scene.materials[0].material.coupled_surface(),
            position,
            normal,
            view: view(position),
            light: self.scene.lights[0].clone(),
        };
        let points: Vec<_> = self.surfaces().into_iter().map(point).collect();
        let answers = engine.eval(&points, Quality::default()).unwrap();
        answers.into_iter().map(|radiance| f64::from(radiance.x)).collect()
    }

    fn options(&self) -> ShadeOptions {
        ShadeOptions { surfaces: self.scene.effects(), ..ShadeOptions::default() }
    }
}

/// Where a pixel's centre is in the image, from -1 to 1, y up.
fn place(pixel: usize) -> [f64; 2] {
    let at = |index: usize, size: u32| (index as f64 + 0.5) / f64::from(size) * 2.0 - 1.0;
    let width = SIZE[0] as usize;
    [at(pixel % width, SIZE[0]), -at(pixel / width, SIZE[1])]
}

/// The root mean square of the differences over the mean of what is right.
fn error(found: &[f64], right: &[f64]) -> f64 {
    let count = right.len() as f64;
    let square = found.iter().zip(right).map(|(found, right)| (found - right).powi(2)).sum::<f64>() / count;
    square.sqrt() / (right.iter().sum::<f64>() / count)
}

#[test]
fn everything_is_as_large_at_any_distance() {
    let Some(engine) = TestEngine::new() else { return };
    let (scene, camera) = (scene(metal()), camera());
    // How far surfaces are from where the camera's parallel lines of sight are, and at what distances
    let off_lines = |seen: &Camera| {
        let surfaces = View::new(&engine, &scene, seen).surfaces();
        let offsets = surfaces.iter().map(|[position, _]| *position - camera.position);
        let off = offsets.clone().enumerate().map(|(pixel, offset)| {
            let [x, y] = place(pixel);
            let across = [offset.dot(camera.right), offset.dot(camera.up)];
            (across[0] - x * ASPECT * HALF_HEIGHT).abs() + (across[1] - y * HALF_HEIGHT).abs()
        });
        let depths: Vec<f64> = offsets.map(|offset| offset.dot(camera.forward)).collect();
        let spread =
            depths.iter().copied().fold(f64::MIN, f64::max) - depths.iter().copied().fold(f64::MAX, f64::min);
        (off.fold(0.0, f64::max), spread)
    };
    let (off, spread) = off_lines(&camera);
    // Positions of some five units, as f32
    assert!(off < 1e-5 && spread > 1.5, "{off} at depths over {spread}");
    let (off, _) = off_lines(&camera.clone().pinhole(DVec3::ZERO));
    assert!(off > 0.3, "{off}");
}

#[test]
fn surfaces_reflect_along_one_direction() {
    let Some(engine) = TestEngine::new() else { return };
    let (scene, camera) = (scene(metal()), camera());
    let mut view = View::new(&engine, &scene, &camera);
    let expected = view.evaluated(&engine, |_| -camera.forward);
    // The twin: seen from where a perspective camera would be
    let eye = camera.clone().pinhole(DVec3::ZERO).position;
    let other = view.evaluated(&engine, |position| eye - position);
    let options = ShadeOptions { output: Output::Add, ..view.options() };
    let plain = view.shaded(|renderer| renderer.shade_as(options));
    let tiles = TileOptions { least_quads: 0, ..TileOptions::default() };
    let tiled = view.shaded(|renderer| {
        let view = renderer.tiled(options, tiles)?;
        renderer.shade_tiled(&view)
    });
    for (name, found) in [("plain", plain), ("tiled", tiled)] {
        let (off, twin) = (error(&found, &expected), error(&found, &other));
        println!("{name}: {off:.1e}, from one place {twin:.3}");
        // Both round a lobe of f32
        assert!(off < 1e-4 && twin > 0.1, "{name}: {off}, {twin}");
    }
    // The reference samples the true BRDF: what is left is its noise and the fit
    let samples = Reference { samples: 1024, ..Reference::default() };
    let sampled = view.shaded(|renderer| renderer.reference(samples, |_| {}));
    let (off, twin) = (error(&sampled, &expected), error(&sampled, &other));
    println!("reference: {off:.3}, from one place {twin:.3}");
    assert!(off < 0.06 && twin > 2.0 * off, "{off}, {twin}");
}

#[test]
fn shadows_are_those_of_the_reference() {
    let Some(engine) = TestEngine::new() else { return };
    let camera = camera();
    for (name, material, bound) in [("lambert", lambert(0.75), 0.03), ("metal", metal(), 0.08)] {
        let scene = scene(material);
        let picture = |camera: &Camera, filter, history, frames: u32| {
            let mut view = View::new(&engine, &scene, camera);
            let options = ShadeOptions { shadow_rays: 4, ..view.options() };
            let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
            let mut last = vec![];
            let shadowed = view.renderer.shadowed(&view.buffers, options, (filter, history)).unwrap();
            for seed in 0..frames {
                last = view.shaded(|renderer| renderer.shade_shadowed(&shadowed, seed));
                sum.iter_mut().zip(&last).for_each(|(sum, one)| *sum += one / f64::from(frames));
            }
            [sum, last]
        };
        let reference = |camera: &Camera, shadows| {
            let samples = Reference { samples: 1024, shadows, ..Reference::default() };
            let mut view = View::new(&engine, &scene, camera);
            view.shaded(|renderer| renderer.reference(samples, |_| {}))
        };
        let right = reference(&camera, true);
        // Rays alone are right in the mean
        let [mean, one] = picture(&camera, ShadowFilter::Off, ShadowHistory::Off, 32);
        let error_of_mean = error(&mean, &right);
        let unshadowed = error(&mean, &reference(&camera, false));
        let other = error(&mean, &reference(&camera.clone().pinhole(DVec3::ZERO), true));
        println!("{name}: {error_of_mean:.3}, without shadows {unshadowed:.3}, perspective {other:.3}");
        assert!(error_of_mean < bound && unshadowed > 2.0 * bound && other > 2.0 * bound);
        // The filter finds neighbours, and the history what was there before
        let [_, gathered] = picture(&camera, ShadowFilter::Gather, ShadowHistory::Off, 1);
        let [_, kept] = picture(&camera, ShadowFilter::Off, ShadowHistory::Camera, 16);
        let [one, gathered, kept] = [one, gathered, kept].map(|found| error(&found, &mean));
        println!("{name}: noise {one:.3}, filtered {gathered:.3}, of 16 frames {kept:.3}");
        assert!(gathered < 0.8 * one && kept < 0.5 * one, "{one}, {gathered}, {kept}");
    }
}

#[test]
fn lines_of_sight_of_a_pixel_are_in_rows_and_columns_of_their_own() {
    let Some(engine) = TestEngine::new() else { return };
    let scene = scene_of(&square(0.0, 9.0), without_textures(lambert(0.5)));
    let bounds = [DVec3::NEG_ONE, DVec3::ONE].into_iter().collect();
    let framing = Camera::framing("", bounds, DVec3::NEG_Y, DVec3::Z, ASPECT);
    let camera = Camera { orthographic: true, half_height: HALF_HEIGHT, ..framing };
    // Across and down, in quarters of a pixel of two by two texels, rounded down
    let quarters = |supersample: u32, first_row: u32| -> Vec<[i64; 2]> {
        let mut view = View::new(&engine, &scene, &camera);
        let constants = view.buffers.constants(&camera, SIZE, Vec3::ZERO);
        view.renderer.look(VisibilityConstants { supersample, first_row, ..constants });
        view.renderer.visibility().unwrap();
        let place = |[position, _]: [DVec3; 2]| {
            let from = position - camera.position;
            let across = from.dot(camera.right) / (HALF_HEIGHT * ASPECT) * f64::from(SIZE[0]);
            let down = -from.dot(camera.up) / HALF_HEIGHT * f64::from(SIZE[1]);
            [across.floor() as i64, down.floor() as i64]
        };
        view.surfaces().into_iter().map(place).collect()
    };
    let [width, height] = SIZE.map(|side| side as usize);
    let steps = |places: &[[i64; 2]], axis: usize, pixel: [usize; 2]| {
        let texels = [0, 1, width, width + 1].map(|texel| texel + 2 * (pixel[1] * width + pixel[0]));
        texels.map(|texel| places[texel][axis]).into_iter().collect::<std::collections::BTreeSet<_>>().len()
    };
    let (whole, band, centers) = (quarters(2, 0), quarters(2, 3), quarters(1, 0));
    for pixel in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| [x, y])) {
        for axis in [0, 1] {
            assert_eq!(steps(&whole, axis, pixel), 4, "{pixel:?}");
            assert_eq!(steps(&centers, axis, pixel), 2, "the twin: centres of texels, {pixel:?}");
        }
    }
    // A band that begins at an odd row is a part of the picture
    for row in 0..height - 1 {
        for x in 0..width {
            assert_eq!(band[row * width + x][0], whole[(row + 1) * width + x][0], "{x}, {row}");
        }
    }
}

#[test]
fn an_unlit_surface_shows_its_base_color_by_any_light() {
    let Some(engine) = TestEngine::new() else { return };
    let mean = |unlit: bool| {
        let mut scene = scene(lambert(0.25));
        scene.materials[0].unlit = unlit;
        let mut view = View::new(&engine, &scene, &camera());
        let found = view.shaded(|renderer| renderer.shade(scene.surfaces(), Quality::default()));
        assert!(!unlit || found.iter().all(|radiance| [0.0, 0.25].contains(radiance)));
        found.iter().sum::<f64>() / found.len() as f64
    };
    // The twin is lit
    assert!((mean(true) - 0.25).abs() < 0.05 && (mean(false) - 0.25).abs() > 0.05);
}
