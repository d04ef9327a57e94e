//! G-buffers of several samples a texel: a pixel is the mean over its surfaces, each shaded once, in its
//! sample's place.

use arealight::kernels::read_samples;
use arealight_tests::floor::{CAMERA, SIZE, floor_material, looking_at_floor, one_light};
use arealight_tests::kernel::shade_with_bridge;
use arealight_tests::multisampled::{Multisampled, Texel};
use arealight_tests::prelude::*;
use glam::{DMat4, DVec4};

/// What a sample shows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shown {
    Floor,
    /// A plane over it with the floor's normal and material.
    Shelf,
    /// The floor's plane with another normal.
    Tilted,
    Nothing,
}

/// Vulkan's standard locations (table in the specification's chapter on rasterization).
fn location(samples: u32, index: u32) -> DVec2 {
    let of: &[[f64; 2]] = match samples {
        2 => &[[0.75, 0.75], [0.25, 0.25]],
        4 => &[[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]],
        8 => &[
            [0.5625, 0.3125],
            [0.4375, 0.6875],
            [0.8125, 0.5625],
            [0.3125, 0.1875],
            [0.1875, 0.8125],
            [0.0625, 0.4375],
            [0.6875, 0.9375],
            [0.9375, 0.0625],
        ],
        _ => unreachable!("2, 4 or 8"),
    };
    of[index as usize].into()
}

/// What the samples of a pixel show: by columns all the same, or by halves one thing and another.
fn shown([x, y]: [u32; 2], index: u32) -> Shown {
    let is_second = (index + y) % 2 == 1;
    match x {
        8..16 if is_second => Shown::Shelf,
        16..24 if is_second => Shown::Tilted,
        24..30 if is_second => Shown::Nothing,
        0..30 => Shown::Floor,
        _ => Shown::Nothing,
    }
}

/// The camera's projection: from positions to clip space, y down.
fn clip_from_position() -> DMat4 {
    let projection = DMat4::from_cols(
        DVec4::X * 1.2,
        DVec4::Y * -1.9,
        DVec4::new(0.0, 0.0, -1.05, -1.0),
        DVec4::Z * -1.05,
    );
    projection * looking_at_floor(CAMERA)
}

/// Where what is shown is hit by the ray through a place of the picture.
fn hit(place: DVec2, shown: Shown) -> DVec3 {
    let clip = place / DVec2::new(SIZE[0].into(), SIZE[1].into()) * 2.0 - 1.0;
    let along = clip_from_position().inverse().project_point3(clip.extend(0.5)) - CAMERA;
    let height = if shown == Shown::Shelf { 0.4 } else { 0.0 };
    CAMERA + along * ((height - CAMERA.z) / along.z)
}

/// The floor's plane is nearer to a tilted surface's than half of the samples' distance.
fn normal(shown: Shown) -> DVec3 {
    if shown == Shown::Tilted { DVec3::new(0.28, 0.0, 0.96) } else { DVec3::Z }
}

/// How the oracle shades a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Shading {
    /// Each surface once, at its first sample.
    Surfaces,
    /// Each sample.
    Samples,
    /// The first sample alone.
    First,
    /// Each surface at the pixel's centre.
    Centers,
}

struct Oracle {
    table: LightTable,
    surface: Surface,
    floor: Vec<Light>,
}

impl Oracle {
    /// Radiance, and what part of the pixel has a surface.
    fn pixel(&self, pixel: [u32; 2], samples: u32, shading: Shading) -> (DVec3, f64) {
        let corner = DVec2::new(pixel[0].into(), pixel[1].into());
        let place = |index| corner + location(samples, index);
        let mut sum = DVec3::ZERO;
        let covered = (0..samples).filter(|index| shown(pixel, *index) != Shown::Nothing);
        for index in covered.clone() {
            let of = shown(pixel, index);
            let first = (0..samples).find(|other| shown(pixel, *other) == of).unwrap_or(index);
            let (at, of) = match shading {
                Shading::Surfaces => (place(first), of),
                Shading::Samples => (place(index), of),
                Shading::First => (place(0), shown(pixel, 0)),
                Shading::Centers => (corner + 0.5, of),
            };
            let position = hit(at, of);
            for light in &self.floor {
                sum += one_light(&self.table, &self.surface, normal(of), position, light);
            }
        }
        (sum / f64::from(samples), covered.count() as f64 / f64::from(samples))
    }

    fn worst(&self, samples: u32, shading: Shading, found: &[Vec4], before: Vec4) -> f64 {
        let error = |(pixel, found): ([u32; 2], &Vec4)| {
            let (radiance, coverage) = self.pixel(pixel, samples, shading);
            let expected = if coverage > 0.0 {
                (radiance + before.truncate().as_dvec3()).extend(coverage)
            } else {
                before.as_dvec4()
            };
            (found.as_dvec4() - expected).abs().max_element()
        };
        pixels().zip(found).map(error).fold(0.0, f64::max)
    }
}

/// The samples as a G-buffer with positions, or depth, holds them.
fn texels(samples: u32, from_depth: bool) -> Vec<Texel> {
    let material = floor_material();
    let color = material.base_color.extend(material.metalness).to_array();
    let of = |pixel: [u32; 2], index: u32| {
        let shown = shown(pixel, index);
        let position = hit(DVec2::new(pixel[0].into(), pixel[1].into()) + location(samples, index), shown);
        let depth = clip_from_position().project_point3(position).z as f32;
        let position = match (shown, from_depth) {
            (Shown::Nothing, _) => [0.0; 4],
            (_, true) => [depth, 0.0, 0.0, 0.0],
            (_, false) => position.as_vec3().extend(1.0).to_array(),
        };
        Texel { position, normal: normal(shown).as_vec3().extend(material.roughness).to_array(), color }
    };
    pixels().flat_map(|pixel| (0..samples).map(move |index| of(pixel, index))).collect()
}

#[test]
fn pixels_of_several_samples_are_the_mean_over_their_surfaces() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let oracle = Oracle { table: LightTable::ggx(), surface: floor_material().surface(), floor: lamps() };
    for (samples, from_depth, tiles, output) in [
        (4, true, false, Output::Overwrite),
        (4, true, true, Output::Overwrite),
        (4, false, true, Output::Add),
        (2, true, false, Output::Overwrite),
        (8, true, false, Output::Overwrite),
    ] {
        let counts = engine.host().properties().limits.sampled_image_color_sample_counts;
        if counts.as_raw() & samples == 0 {
            assert!(samples != 4, "every device has images of 4 samples");
            continue;
        }
        let images = Multisampled::new(&engine, samples, &texels(samples, from_depth));
        let [position, normal, base_color] = images.resources();
        let planes =
            [(Plane::Position, position), (Plane::Normal, normal), (Plane::BaseColor, base_color)].into();
        let resources = ShadeResources { planes, ..floor.resources() };
        let options = ShadeOptions { samples, from_depth, output, ..ShadeOptions::default() };
        let position_from_clip = Some(clip_from_position().inverse().as_mat4());
        let frame = ShadeFrame { position_from_clip, ..floor.frame() };
        let found = floor.shade(options, tiles, (&resources, &frame, Descriptors::Sets));
        let before = if output == Output::Add { BEFORE } else { Vec4::ZERO };
        let worst = |shading| oracle.worst(samples, shading, &found, before);
        let error = worst(Shading::Surfaces);
        let case = format!("{samples} samples, depth {from_depth}, tiles {tiles}");
        // Depths of 24 bits, as in views.rs
        assert!(error < 2e-4, "{case}: {error:e}");
        for (twin, least) in [(Shading::First, 0.1), (Shading::Samples, 1e-3), (Shading::Centers, 1e-3)] {
            let error = worst(twin);
            assert!(error > least, "{case}, a twin: {error:e}");
        }
    }
}

#[test]
fn a_host_s_own_g_buffer_may_have_samples() {
    let Some(engine) = TestEngine::new() else { return };
    let words = shade_with_bridge();
    let mut sampled = words.clone();
    read_samples(4, &mut sampled);
    // Of position, of the host's unsigned integers and the stencil's; and each read of them
    let changes = |to: [u32; 2]| words.iter().zip(&sampled).filter(|(a, b)| [**a, **b] == to).count();
    assert_eq!(changes([0, 1]), 2);
    assert!(changes([0x2, 0x40]) >= 3);
    assert_eq!(words.iter().zip(&sampled).filter(|(a, b)| a != b).count(), 2 + changes([0x2, 0x40]));
    // A pipeline of it is made, validated
    let options = ShadeOptions { samples: 4, ..ShadeOptions::default() };
    let frame = Floor::new(&engine, &lamps()).frame();
    let info = ShadePassInfo { module: Some(words), ..options.into() };
    engine.pass(info).unwrap().prepare(&frame).unwrap();
}

#[test]
fn samples_that_cannot_be_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let refused = |options: ShadeOptions| field(&engine.pass(options).unwrap_err());
    let plain = ShadeOptions::default();
    for samples in [0, 3, 16, u32::MAX] {
        assert_eq!(refused(ShadeOptions { samples, ..plain }), "samples");
    }
    let four = ShadeOptions { samples: 4, ..plain };
    assert_eq!(refused(ShadeOptions { texels_per_pixel: 2, ..four }), "samples");
    assert_eq!(refused(ShadeOptions { shadow_rays: 1, ..four }), "samples");
}
