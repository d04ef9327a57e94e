//! Which pixels a frame is, and from where it is seen: viewports, rectangles, half resolution and
//! orthographic cameras, with and without tiles, each pixel against the oracle.

use arealight_tests::floor::{floor_material, looking_at_floor};
use arealight_tests::pass::{run, texels};
use arealight_tests::prelude::*;
use arealight_vk::Viewport;
use glam::{DMat4, DVec4};

/// Of the G-buffer's images.
const TEXELS: [u32; 2] = [47, 31];
const EYE: DVec3 = DVec3::new(0.5, -4.0, 3.0);
const NEAR: f64 = 1.0;
const FAR: f64 = 20.0;

/// One picture of the floor z = 0 in the G-buffer, and the frame that shades it.
#[derive(Clone, Copy)]
struct Shot {
    /// To clip space of the viewport; y is down where its height is positive.
    clip_from_position: DMat4,
    /// As [`ShadeFrame::camera`].
    camera: DVec3,
    /// What draws the G-buffer.
    viewport: Viewport,
    size: [u32; 2],
    offset: [u32; 2],
}

fn viewport(x: f32, y: f32, width: f32, height: f32) -> Viewport {
    Viewport { x, y, width, height, min_depth: 0.0, max_depth: 1.0 }
}

/// A perspective camera at `eye` that sees the floor, y down.
fn perspective(eye: DVec3) -> DMat4 {
    let (x, depth) = (1.2, FAR / (FAR - NEAR));
    let projection = DMat4::from_cols(
        DVec4::X * x,
        DVec4::Y * -1.4,
        DVec4::new(0.0, 0.0, -depth, -1.0),
        DVec4::Z * (-NEAR * depth),
    );
    projection * looking_at_floor(eye)
}

fn orthographic(eye: DVec3) -> DMat4 {
    let depth = 1.0 / (FAR - NEAR);
    let projection = DMat4::from_cols(
        DVec4::X * 0.4,
        DVec4::Y * -0.5,
        DVec4::Z * -depth,
        DVec4::new(0.0, 0.0, -NEAR * depth, 1.0),
    );
    projection * looking_at_floor(eye)
}

impl Shot {
    fn new(clip_from_position: DMat4, camera: DVec3) -> Self {
        let whole = viewport(0.0, 0.0, TEXELS[0] as f32, TEXELS[1] as f32);
        Self { clip_from_position, camera, viewport: whole, size: TEXELS, offset: [0, 0] }
    }

    /// The place in clip space of a texel's centre, and the floor's point there at a stored depth.
    fn position(&self, texel: [u32; 2], depth: f64) -> DVec3 {
        let Viewport { x, y, width, height, min_depth, max_depth } = self.viewport;
        let clip = |texel: u32, start: f32, extent: f32| {
            (f64::from(texel) + 0.5 - f64::from(start)) / f64::from(extent) * 2.0 - 1.0
        };
        let depth = (depth - f64::from(min_depth)) / f64::from(max_depth - min_depth);
        let clip = DVec3::new(clip(texel[0], x, width), clip(texel[1], y, height), depth);
        self.clip_from_position.inverse().project_point3(clip)
    }

    /// What is drawn of the floor at a texel: its depth, if it is seen at all.
    fn depth(&self, texel: [u32; 2]) -> Option<f32> {
        // A ray from the near plane to the far one
        let Viewport { min_depth, max_depth, .. } = self.viewport;
        let ends = [min_depth, max_depth].map(|depth| self.position(texel, depth.into()));
        let along = ends[0].z / (ends[0].z - ends[1].z);
        let position = ends[0].lerp(ends[1], along);
        let depth = self.clip_from_position.project_point3(position).z;
        let stored = f64::from(min_depth) + depth * f64::from(max_depth - min_depth);
        (along > 0.0 && along < 1.0).then_some(stored as f32)
    }

    fn frame(&self, viewport: Option<Viewport>) -> ShadeFrame {
        ShadeFrame {
            size: self.size,
            offset: self.offset,
            viewport,
            camera: self.camera.as_vec3(),
            position_from_clip: Some(self.clip_from_position.inverse().as_mat4()),
            ..ShadeFrame::default()
        }
    }

    /// Whether a texel is in the shot, by the texels of its pixels.
    fn has(&self, texel: [u32; 2], side: u32) -> bool {
        (0..2).all(|axis| {
            let start = self.offset[axis] * side;
            (start..start + self.size[axis] * side).contains(&texel[axis])
        })
    }
}

/// A lamp over the floor, and another beside it.
fn lights() -> Vec<Light> {
    let LightShape::Polygon(vertices) = lamp().shape else { unreachable!("a polygon") };
    let beside = vertices.iter().map(|vertex| *vertex * 0.4 + DVec3::new(2.0, 1.0, 0.0)).collect();
    vec![lamp(), Light { radiance: Vec3::new(3.0, 1.0, 0.5), shape: LightShape::Polygon(beside), ..lamp() }]
}

/// The radiance image after `frames` of a G-buffer that the shots were drawn to.
fn shade(
    engine: &TestEngine,
    options: ShadeOptions,
    tiles: bool,
    shots: &[Shot],
    frames: &[ShadeFrame],
) -> Vec<Vec4> {
    let side = options.texels_per_pixel;
    // Where no shot is, what an earlier frame left
    let depth = texels(TEXELS).map(|texel| {
        let shot = shots.iter().find(|shot| shot.has(texel, side));
        shot.map_or(0.5, |shot| shot.depth(texel).unwrap_or(1.0))
    });
    let (depth, sampled) = (depth.collect::<Vec<f32>>(), vk::ImageUsageFlags::SAMPLED);
    let depth = image(engine, TEXELS, vk::Format::R32_SFLOAT, sampled, &depth);
    let Material { base_color, roughness, metalness, .. } = material();
    let planes = planes(engine, TEXELS, &|plane, _| match plane {
        Plane::Normal => Some(Vec3::Z.extend(roughness)),
        Plane::BaseColor => Some(base_color.extend(metalness)),
        _ => None,
    });
    let radiance = radiance(engine, TEXELS, BEFORE);
    let lights = LightBuffers::new(engine, &lights(), DVec3::ZERO);
    let resources = ShadeResources {
        planes: reads(&planes).with(Plane::Position, Some(read(&depth))),
        radiance: store(&radiance),
        ..lights.resources(engine)
    };
    let summary = lights.packed.summary();
    let frames: Vec<_> = frames.iter().map(|frame| ShadeFrame { lights: summary, ..*frame }).collect();
    let tiles = tiles.then_some(TileOptions { least_quads: 0, ..TileOptions::default() });
    let info = ShadePassInfo { tiles, table_size: engine.table_size(), ..options.into() };
    let pass = engine.pass(info).unwrap();
    // Frames with tiles have their lists in turn
    run(engine, &pass, &resources, TEXELS, &frames, Descriptors::Sets);
    stored_in(&radiance)
}

/// The largest difference from the oracle, of pixels that some shot has; others are as they were.
fn worst(options: ShadeOptions, shots: &[Shot], found: &[Vec4]) -> f64 {
    let (table, lights, surface) = (LightTable::ggx(), lights(), floor_material().surface());
    let (mut worst, mut lit) = (0.0_f64, 0);
    for (pixel, found) in texels(TEXELS).zip(found) {
        let Some(shot) = shots.iter().find(|shot| shot.has(pixel, 1)) else {
            assert_eq!(*found, BEFORE, "{pixel:?} is in no frame");
            continue;
        };
        let texel = pixel.map(|place| place * options.texels_per_pixel);
        let expected = shot.depth(texel).map_or(DVec3::ZERO, |depth| {
            let position = shot.position(texel, depth.into());
            let view = if options.orthographic { shot.camera } else { shot.camera - position };
            let one = |light| ltc(&table, &surface, DVec3::Z, view, &RelativeLight::new(light, position));
            lights.iter().map(one).sum()
        });
        lit += usize::from(expected.max_element() > 0.05);
        worst = worst.max((found.truncate().as_dvec3() - expected).abs().max_element());
    }
    let pixels: usize = shots.iter().map(|shot| (shot.size[0] * shot.size[1]) as usize).sum();
    assert!(lit > pixels / 4, "{lit} of {pixels} pixels are lit");
    worst
}

/// Twenty units away a depth of 24 bits is known to 4e-6 of them with this near plane, and radiance of 3
/// changes by as much at most.
const BOUND: f64 = 1e-4;

/// Shots by their frames equal the oracle; frames as they would be by default do not.
fn check(engine: &TestEngine, options: ShadeOptions, shots: &[Shot], wrong: &[ShadeFrame]) {
    let options = ShadeOptions { from_depth: true, ..options };
    let frames: Vec<_> = shots.iter().map(|shot| shot.frame(Some(shot.viewport))).collect();
    for tiles in [false, true] {
        let worst = worst(options, shots, &shade(engine, options, tiles, shots, &frames));
        assert!(worst < BOUND, "{worst:e} from the oracle, tiles: {tiles}");
    }
    let worst = worst(options, shots, &shade(engine, options, false, shots, wrong));
    assert!(worst > 100.0 * BOUND, "the twin: {worst:e}");
}

#[test]
fn a_viewport_of_negative_height_has_y_up() {
    let Some(engine) = TestEngine::new() else { return };
    let up = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * perspective(EYE);
    let mut shot = Shot::new(up, EYE);
    let height = shot.viewport.height;
    shot.viewport = Viewport { y: height, height: -height, min_depth: 0.9, max_depth: 0.2, ..shot.viewport };
    check(&engine, ShadeOptions::default(), &[shot], &[shot.frame(None)]);
}

#[test]
fn dynamic_resolution_shades_part_of_larger_images() {
    let Some(engine) = TestEngine::new() else { return };
    let mut shot = Shot::new(perspective(EYE), EYE);
    (shot.size, shot.viewport) = ([24, 15], viewport(0.0, 0.0, 24.0, 15.0));
    let whole = viewport(0.0, 0.0, TEXELS[0] as f32, TEXELS[1] as f32);
    check(&engine, ShadeOptions::default(), &[shot], &[shot.frame(Some(whole))]);
    // Without a viewport it is that of the frame's pixels
    let options = ShadeOptions { from_depth: true, ..ShadeOptions::default() };
    let found = shade(&engine, options, false, &[shot], &[shot.frame(None)]);
    assert!(worst(options, &[shot], &found) < BOUND);
}

#[test]
fn orthographic_cameras_have_a_direction() {
    let Some(engine) = TestEngine::new() else { return };
    let shot = Shot::new(orthographic(EYE), EYE.normalize_or(DVec3::Z) * 3.0);
    let options = ShadeOptions { orthographic: true, ..ShadeOptions::default() };
    // The twin's direction is from above
    check(&engine, options, &[shot], &[ShadeFrame { camera: Vec3::Z, ..shot.frame(None) }]);
}

#[test]
fn two_views_are_two_rectangles() {
    let Some(engine) = TestEngine::new() else { return };
    let other = DVec3::new(-3.0, -2.0, 2.0);
    let [mut left, mut right] = [EYE, other].map(|eye| Shot::new(perspective(eye), eye));
    (left.size, left.viewport) = ([20, 31], viewport(0.0, 0.0, 20.0, 31.0));
    // Of the right one a part is shaded, of a viewport that begins before it
    (right.size, right.offset, right.viewport) = ([23, 25], [22, 5], viewport(20.0, 0.0, 27.0, 31.0));
    let options = ShadeOptions { rectangle: true, ..ShadeOptions::default() };
    let swapped = ShadeFrame { camera: left.camera.as_vec3(), ..right.frame(Some(right.viewport)) };
    check(&engine, options, &[left, right], &[left.frame(None), swapped]);
}

#[test]
fn half_resolution_shades_every_other_texel() {
    let Some(engine) = TestEngine::new() else { return };
    let mut shot = Shot::new(perspective(EYE), EYE);
    // The last column and row of an odd number are half a pixel
    shot.size = [24, 16];
    let options = ShadeOptions { texels_per_pixel: 2, ..ShadeOptions::default() };
    let blocks = ShadeFrame { viewport: Some(viewport(0.0, 0.0, 24.0, 16.0)), ..shot.frame(None) };
    check(&engine, options, &[shot], &[blocks]);
    // Without a viewport it is that of the texels of the frame's pixels
    (shot.size, shot.viewport) = ([22, 15], viewport(0.0, 0.0, 44.0, 30.0));
    let options = ShadeOptions { from_depth: true, ..options };
    let found = shade(&engine, options, false, &[shot], &[shot.frame(None)]);
    assert!(worst(options, &[shot], &found) < BOUND);
}

#[test]
fn views_that_cannot_be_are_refused_by_field() {
    let Some(engine) = TestEngine::new() else { return };
    let pass = |options: ShadeOptions| engine.pass(options);
    let plain = ShadeOptions::default();
    for texels_per_pixel in [0, 17] {
        assert_eq!(field(&pass(ShadeOptions { texels_per_pixel, ..plain }).unwrap_err()), "texels_per_pixel");
    }
    let rays = ShadeOptions { shadow_rays: 1, ..plain };
    assert_eq!(field(&pass(ShadeOptions { rectangle: true, ..rays }).unwrap_err()), "rectangle");
    assert_eq!(field(&pass(ShadeOptions { texels_per_pixel: 2, ..rays }).unwrap_err()), "texels_per_pixel");

    let frame = ShadeFrame { size: [8, 8], ..ShadeFrame::default() };
    let refused = |options, frame| field(&pass(options).unwrap().prepare(&frame).unwrap_err());
    assert_eq!(refused(plain, ShadeFrame { offset: [1, 0], ..frame }), "offset");
    let rectangle = ShadeOptions { rectangle: true, ..plain };
    assert_eq!(refused(rectangle, ShadeFrame { offset: [0, u32::MAX], ..frame }), "offset");
    assert_eq!(refused(ShadeOptions { orthographic: true, ..plain }, frame), "camera");
    let right = viewport(0.0, 0.0, 8.0, -8.0);
    for wrong in [
        Viewport { width: -8.0, ..right },
        Viewport { height: 0.0, ..right },
        Viewport { x: f32::NAN, ..right },
        Viewport { min_depth: 1.0, ..right },
    ] {
        assert_eq!(refused(plain, ShadeFrame { viewport: Some(wrong), ..frame }), "viewport");
    }
    // The twin
    let frame = ShadeFrame { offset: [8, 0], viewport: Some(right), ..frame };
    pass(rectangle).unwrap().prepare(&frame).unwrap();
}
