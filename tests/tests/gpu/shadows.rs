//! The shade pass and the shadow pass, after one another: what arrives of lights of every kind, from surfaces
//! of every kind.

use arealight_oracle::visibility::visible_parts;
use arealight_tests::globe::icosphere;
use arealight_tests::prelude::*;
use arealight_tests::shadow_patch::{PatchPasses, PatchShadows, ShadowPatch};
use arealight_tool_kernels::light_sampling::triangles_of;

const RAYS: u32 = 4;

/// Of linear Rec. 709 colour.
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

pub(crate) fn options() -> ShadeOptions {
    ShadeOptions { shadow_rays: RAYS, ..ShadeOptions::default() }
}

fn light(shape: LightShape) -> Light {
    Light { radiance: Vec3::ONE, shape, ..Light::default() }
}

/// A flat light at a height, which shines down; its outline in (x, y), clockwise from above.
pub(crate) fn flat(height: f64, outline: &[[f64; 2]]) -> Light {
    let vertices = outline.iter().map(|&xy| DVec2::from_array(xy).extend(height)).collect();
    light(LightShape::Polygon(vertices))
}

/// A rectangle as two triangles.
fn rectangle(corners: [Vec3; 4]) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] = corners;
    vec![[a, b, c], [a, c, d]]
}

/// A wide plate at a height over all that has y > 0.
fn plate_over_half(height: f32) -> Vec<[Vec3; 3]> {
    let corner = |x: f32, y: f32| Vec3::new(100.0 * x, 100.0 * y, height);
    rectangle([corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
}

/// Surfaces of every lobe, with a view in the plane y = 0.
pub(crate) fn surfaces() -> Vec<(&'static str, Material, Vec3)> {
    let metal = Material { metalness: 1.0, ..Material::default() };
    let view = Vec3::new(-1.0, 0.0, 1.2);
    vec![
        ("diffuse", Material { dielectric_f0: Vec3::ZERO, dielectric_f90: 0.0, ..Material::default() }, view),
        ("metal .2", Material { roughness: 0.2, ..metal }, view),
        ("metal .5", Material { roughness: 0.5, ..metal }, Vec3::new(-3.0, 0.0, 1.0)),
        ("plastic", Material { roughness: 0.35, ..Material::default() }, view),
    ]
}

/// Lights that are their own mirror image in the plane y = 0.
pub(crate) fn symmetric_lights() -> Vec<(&'static str, Light)> {
    let (u, v) = (DVec3::X * 0.8, DVec3::Y * 0.5);
    let center = DVec3::new(0.9, 0.0, 1.5);
    let box_corner = |i: usize| {
        let sign = |bit: usize| if i & bit == 0 { -0.4 } else { 0.4 };
        center + DVec3::new(sign(1), sign(2), sign(4))
    };
    let box_faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    vec![
        ("quad", flat(1.5, &[[0.2, -0.6], [0.2, 0.6], [1.5, 0.6], [1.5, -0.6]])),
        ("quad through the horizon", {
            let at = |y: f64, z: f64| DVec3::new(1.2, y, z);
            light(LightShape::Polygon(vec![at(-0.6, -0.5), at(-0.6, 1.0), at(0.6, 1.0), at(0.6, -0.5)]))
        }),
        ("small quad", flat(1.5, &[[0.9, -0.02], [0.9, 0.02], [0.95, 0.02], [0.95, -0.02]])),
        ("hexagon", flat(1.5, &[[0.2, 0.0], [0.5, 0.5], [1.1, 0.5], [1.4, 0.0], [1.1, -0.5], [0.5, -0.5]])),
        (
            "arrow",
            flat(
                1.5,
                &[
                    [0.0, 0.0],
                    [0.8, 0.9],
                    [0.8, 0.3],
                    [1.8, 0.3],
                    [1.4, 0.0],
                    [1.8, -0.3],
                    [0.8, -0.3],
                    [0.8, -0.9],
                ],
            ),
        ),
        (
            "box",
            light(LightShape::mesh(box_faces.iter().flatten().map(|&i| box_corner(i)).collect(), vec![4; 6])),
        ),
        ("globe in clusters", {
            let (corners, triangles) = icosphere(2);
            let corners: Vec<DVec3> = corners.iter().map(|corner| center + *corner * 0.3).collect();
            light(LightShape::from_triangles(&corners, &triangles).expect("a mesh").clustered(0.02))
        }),
        ("disk", light(LightShape::Disk { center, axis_u: u, axis_v: -v })),
        ("sphere", light(LightShape::Sphere { center, radius: 0.5 })),
        (
            "tube along the plane",
            light(LightShape::Tube { p0: center - u, p1: center + u, radius: 0.1, ends: TubeEnds::Open }),
        ),
        (
            "capsule across the plane",
            light(LightShape::Tube { p0: center - v, p1: center + v, radius: 0.2, ends: TubeEnds::Round }),
        ),
    ]
}

#[test]
fn half_of_every_symmetric_light_arrives_where_half_of_it_is_hidden() {
    let Some(engine) = TestEngine::new() else { return };
    // A lobe's part below the surface would be hidden
    let options =
        ShadeOptions { quality: Quality { horizon: Horizon::Both, ..Quality::default() }, ..options() };
    let passes = PatchPasses::new(&engine, options, ShadowFilter::Off);
    for (kind, light) in symmetric_lights() {
        for (surface, material, view) in surfaces() {
            let patch =
                ShadowPatch { material, view, lights: vec![light.clone()], blockers: plate_over_half(0.01) };
            let found = patch.run(&passes);
            assert!(found.unshadowed[0].max_element() > 1e-4, "{kind}, {surface}: {}", found.unshadowed[0]);
            // 16,384 rays, more evenly spread than random ones, which would err by .004. Of many faces they
            // are as random
            let bound = if kind.starts_with("globe") { 1.2e-2 } else { 4e-3 };
            assert!((found.mean() - 0.5).abs() < bound, "{kind}, {surface}: {}", found.mean());
            for (unshadowed, (radiance, shadow)) in
                found.unshadowed.iter().zip(found.radiance.iter().zip(&found.shadows))
            {
                assert!(
                    (*unshadowed * shadow.x - *radiance).abs().max_element()
                        <= 1e-3 * unshadowed.max_element()
                );
            }
            // The twins: nothing blocks, and everything
            let lit = ShadowPatch { blockers: plate_over_half(-0.5), ..patch.clone() };
            let lit = lit.run(&passes);
            assert!(lit.shadows.iter().all(|shadow| shadow.x == 1.0), "{kind}, {surface}: {}", lit.mean());
            assert_eq!(lit.radiance, lit.unshadowed, "without noise");
            let mut all = plate_over_half(0.01);
            all.extend(
                plate_over_half(0.01).into_iter().map(|t| t.map(|vertex| vertex * Vec3::new(1.0, -1.0, 1.0))),
            );
            let dark = ShadowPatch { blockers: all, ..patch }.run(&passes);
            // What comes in below the plates is left
            assert!(dark.mean() < 1e-2, "{kind}, {surface}: {}", dark.mean());
        }
    }
}

/// What a patch reflects of an outline by the oracle: of its visible parts, and of all of it.
fn exact(light: &Light, patch: &ShadowPatch) -> [DVec3; 2] {
    let table = LightTable::ggx();
    let whole = RelativeLight::new(light, DVec3::ZERO);
    let blockers: Vec<_> = patch.blockers.iter().map(|t| t.map(Vec3::as_dvec3)).collect();
    let surface = patch.material.surface();
    let of = |vertices: Vec<DVec3>| {
        let part = RelativeLight { vertices, ..whole.clone() };
        ltc_on(Quality::default(), &table, &surface, DVec3::Z, patch.view.as_dvec3(), &part)
    };
    let triangles = triangles_of(&whole.vertices);
    let triangle = |corners: &[u32]| corners.iter().map(|i| whole.vertices[*i as usize]).collect::<Vec<_>>();
    let parts = triangles.chunks(3).flat_map(|corners| visible_parts(&triangle(corners), &blockers));
    let visible = parts.map(of).sum();
    [visible, of(whole.vertices.clone())]
}

#[test]
fn what_arrives_of_outlines_is_what_the_oracle_sees_of_them() {
    let Some(engine) = TestEngine::new() else { return };
    let quad = flat(1.5, &[[-0.3, -0.6], [-0.4, 0.6], [1.5, 0.9], [1.5, -0.6]]);
    // Concave and not symmetric: the blockers hide its sides unequally
    let xs = [-0.5, -0.1, -0.6, 0.3, 1.5, 0.8, 1.4, 0.4];
    let ys = [-0.9, -0.2, 0.8, 0.1, 0.9, -0.1, -0.9, -0.4];
    let star: [_; 8] = std::array::from_fn(|corner| [xs[corner], ys[corner]]);
    let star = flat(1.5, &star);
    let at = |x: f32, y: f32| Vec3::new(x, y, 0.5);
    let blockers =
        vec![[at(0.2, -0.1), at(0.5, 0.05), at(0.2, 0.35)], [at(-0.2, -0.2), at(0.2, -0.05), at(0.0, 0.2)]];
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    let mut largest = 0.0_f64;
    for ((surface, material, view), light) in
        surfaces().into_iter().flat_map(|surface| [(surface, &quad), (surface, &star)])
    {
        let patch = ShadowPatch { material, view, lights: vec![light.clone()], blockers: blockers.clone() };
        let found = patch.run(&passes).mean();
        let [exact, whole] = exact(light, &patch).map(|radiance| radiance.dot(LUMINANCE));
        let exact = exact / whole;
        assert!((0.05..0.95).contains(&exact), "{surface}: {exact}, the case says nothing");
        largest = largest.max((found - exact).abs());
        // As above; where draws are refused rays are as random
        let bound = if light == &star { 1.2e-2 } else { 4e-3 };
        assert!((found - exact).abs() < bound, "{surface}: {found} and {exact}");
    }
    println!("largest error {largest:.1e}");
}

/// A brown, shiny surface under a red light that is partly hidden and a blue one that is not, with what hides
/// the one, or all.
fn of_many_colors(is_dark: bool) -> ShadowPatch {
    let material = Material { base_color: Vec3::new(0.6, 0.3, 0.2), roughness: 0.4, ..Material::default() };
    let colored = |radiance: Vec3, light| Light { radiance, ..light };
    let lights = vec![
        colored(Vec3::new(1.5, 0.3, 0.05), flat(1.5, &[[0.3, -0.6], [0.3, 0.6], [1.5, 0.6], [1.5, -0.6]])),
        colored(Vec3::new(0.1, 0.3, 2.0), flat(2.0, &[[-1.2, -0.6], [-1.2, 0.6], [-0.2, 0.6], [-0.2, -0.6]])),
    ];
    let at = |x: f32, y: f32| Vec3::new(x, y, 0.5);
    let some = rectangle([at(0.2, -0.15), at(0.6, -0.15), at(0.6, 0.1), at(0.2, 0.1)]);
    let all = rectangle([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
    let blockers = if is_dark { all } else { some };
    ShadowPatch { material, view: Vec3::new(-1.0, 0.0, 1.2), lights, blockers }
}

#[test]
fn each_channel_gets_what_arrives_of_each_light_and_lobe() {
    let Some(engine) = TestEngine::new() else { return };
    let patch = of_many_colors(false);
    let [visible, whole] = patch
        .lights
        .iter()
        .map(|light| exact(light, &patch))
        .fold([DVec3::ZERO; 2], |[visible, whole], [one_visible, one_whole]| {
            [visible + one_visible, whole + one_whole]
        });
    let exact = visible / whole;
    assert!(exact.max_element() - exact.min_element() > 0.2, "{exact}: the case says nothing");
    for filter in [ShadowFilter::Off, ShadowFilter::Gather] {
        let found = patch.run(&PatchPasses::new(&engine, options(), filter));
        let sum: DVec3 = found.radiance.iter().map(|radiance| radiance.as_dvec3()).sum();
        let part = sum / found.radiance.len() as f64 / found.unshadowed[0].as_dvec3();
        let error = (part - exact).abs().max_element();
        println!("{filter:?}: {part}, {exact}");
        // As for one light; a ray of the red one is three times as much of its channel
        assert!(error < 0.012, "{filter:?}: {part} and {exact}");
        // The twin: one factor for all channels and lobes
        let error = (DVec3::splat(found.mean()) - exact).abs().max_element();
        assert!(error > 0.1, "{} and {exact}", found.mean());
    }
}

#[test]
fn means_leave_nothing_in_the_dark_and_all_in_the_light() {
    let Some(engine) = TestEngine::new() else { return };
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Gather);
    let largest = |radiance: &[Vec3]| radiance.iter().fold(Vec3::ZERO, |a, b| a.max(b.abs()));
    let dark = of_many_colors(true).run(&passes);
    // A sum and its quotient in float32
    assert!(largest(&dark.radiance).max_element() < 1e-6 * dark.unshadowed[0].min_element());
    let lit = ShadowPatch { blockers: plate_over_half(-0.5), ..of_many_colors(true) }.run(&passes);
    assert_eq!(lit.radiance, lit.unshadowed);
    // The twin: by chance each ray takes its own light away, and their noise has colours
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    let dark = of_many_colors(true).run(&passes);
    assert!(largest(&dark.radiance).max_element() > 0.01 * dark.unshadowed[0].min_element());
}

#[test]
fn lights_are_picked_by_what_they_add() {
    let Some(engine) = TestEngine::new() else { return };
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    // Of three lights the one in the middle is hidden
    let light = |x: f64, radiance: f32| Light {
        radiance: Vec3::splat(radiance),
        ..flat(2.0, &[[x, -0.5], [x, 0.5], [x + 1.0, 0.5], [x + 1.0, -0.5]])
    };
    let lights = vec![light(-2.5, 1.0), light(-0.5, 0.2), light(1.5, 3.0)];
    let at = |x: f32, y: f32| Vec3::new(x, y, 1.0);
    let blockers = rectangle([at(-0.3, -0.3), at(0.3, -0.3), at(0.3, 0.3), at(-0.3, 0.3)]);
    for (surface, material, view) in surfaces() {
        let patch = ShadowPatch { material, view, lights: lights.clone(), blockers: blockers.clone() };
        let found = patch.run(&passes);
        let hidden = ShadowPatch { lights: vec![lights[1].clone()], ..patch.clone() };
        let hidden = hidden.run(&passes);
        let exact = 1.0 - hidden.unshadowed[0].y / found.unshadowed[0].y;
        assert!((found.mean() - f64::from(exact)).abs() < 4e-3, "{surface}: {} and {exact}", found.mean());
    }
}

#[test]
fn rays_leave_the_pocket_and_the_hole_of_a_light_alone() {
    let Some(engine) = TestEngine::new() else { return };
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    let pocket = flat(
        1.0,
        &[
            [-1.0, -1.0],
            [-1.0, 1.0],
            [1.0, 1.0],
            [1.0, 0.5],
            [-0.5, 0.5],
            [-0.5, -0.5],
            [1.0, -0.5],
            [1.0, -1.0],
        ],
    );
    let mut frame = flat(1.0, &[[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]]);
    let hole = [[-0.5, -0.5], [-0.5, 0.5], [0.8, 0.5], [0.8, -0.5]];
    frame.cut_holes(&[hole.iter().map(|&xy| DVec2::from_array(xy).extend(1.0)).collect()]).unwrap();
    let at = |x: f32, y: f32| Vec3::new(x, y, 0.5);
    // Before the hole, but for what rounding takes at its rim
    let within = rectangle([at(-0.24, -0.24), at(0.39, -0.24), at(0.39, 0.24), at(-0.24, 0.24)]);
    let beyond = rectangle([at(-0.24, -0.4), at(0.6, -0.4), at(0.6, 0.4), at(-0.24, 0.4)]);
    for (kind, light) in [("pocket", pocket), ("hole", frame)] {
        for (surface, material, view) in surfaces() {
            let patch = ShadowPatch { material, view, lights: vec![light.clone()], blockers: within.clone() };
            let found = patch.run(&passes).mean();
            // Eight draws in the pocket after one another are as likely as .4^8 = 7e-4 for a lobe that looks
            // into it
            assert!(found > 0.99, "{kind}, {surface}: {found}");
            // The twin: a blocker before a part of the light
            let patch = ShadowPatch { blockers: beyond.clone(), ..patch };
            let found = patch.run(&passes).mean();
            assert!(found < 0.99, "{kind}, {surface}: {found}");
        }
    }
}

#[test]
fn the_filter_takes_the_noise_and_leaves_the_mean() {
    let Some(engine) = TestEngine::new() else { return };
    let (_, material, view) = surfaces().remove(0);
    let (_, light) = symmetric_lights().remove(0);
    let patch = ShadowPatch { material, view, lights: vec![light], blockers: plate_over_half(0.5) };
    let one_ray = ShadeOptions { shadow_rays: 1, ..options() };
    let deviation = |found: &PatchShadows| {
        let parts = found.radiance.iter().zip(&found.unshadowed).map(|(a, b)| f64::from(a.y / b.y));
        let parts: Vec<f64> = parts.collect();
        let mean = parts.iter().sum::<f64>() / parts.len() as f64;
        (mean, (parts.iter().map(|part| (part - mean).powi(2)).sum::<f64>() / parts.len() as f64).sqrt())
    };
    let [(plain_mean, plain), (mean, filtered)] = [ShadowFilter::Off, ShadowFilter::Gather]
        .map(|filter| deviation(&patch.run(&PatchPasses::new(&engine, one_ray, filter))));
    assert!((plain - 0.5).abs() < 0.01, "a coin's: {plain}");
    assert!((mean - plain_mean).abs() < 0.01, "{mean} and {plain_mean}");
    // All pixels are at one place: the search's weights alone, a Gaussian of 3 pixels, would leave .05
    assert!(filtered < 0.05, "{filtered}");
}

/// A prism of so many sides about an axis: faces outwards.
fn prism([p0, p1]: [DVec3; 2], radius: f64, sides: u32) -> Light {
    let axis = (p1 - p0).normalize_or(DVec3::Z);
    let (u, v) = axis.any_orthonormal_pair();
    let at = |center: DVec3, side: u32| {
        let angle = TAU * f64::from(side % sides) / f64::from(sides);
        center + radius * (angle.cos() * u + angle.sin() * v)
    };
    let mut mesh = LightShape::default();
    mesh.add_face(&(0..sides).map(|side| at(p1, side)).collect::<Vec<_>>());
    mesh.add_face(&(0..sides).rev().map(|side| at(p0, side)).collect::<Vec<_>>());
    for side in 0..sides {
        mesh.add_face(&[at(p0, side), at(p0, side + 1), at(p1, side + 1), at(p1, side)]);
    }
    light(mesh)
}

#[test]
fn rays_go_to_the_flat_ends_of_tubes() {
    let Some(engine) = TestEngine::new() else { return };
    let passes = PatchPasses::new(&engine, options(), ShadowFilter::Off);
    let (_, material, view) = surfaces().remove(0);
    let ends = [DVec3::new(1.0, 0.0, 1.0), DVec3::new(1.3, 0.0, 1.9)];
    let radius = 0.4;
    // Before the end that is seen, and little of the side
    let middle = 0.5 * ends[0].as_vec3();
    let corner = |x: f32, y: f32| middle + x * Vec3::new(0.9, 0.0, -0.5) + y * Vec3::Y;
    let blockers =
        rectangle([corner(-0.1, -0.16), corner(0.16, -0.16), corner(0.16, 0.16), corner(-0.1, 0.16)]);
    let arrives = |light| {
        let patch = ShadowPatch { material, view, lights: vec![light], blockers: blockers.clone() };
        patch.run(&passes).mean()
    };
    let tube = |ends_are| light(LightShape::Tube { p0: ends[0], p1: ends[1], radius, ends: ends_are });
    let exact = arrives(prism(ends, radius, 24));
    let [flat, open] = [TubeEnds::Flat, TubeEnds::Open].map(|ends| arrives(tube(ends)));
    println!("{flat} and {open} of {exact}");
    // Of the half of the end before the side; and three times the noise of 16,384 rays
    assert!((flat - exact).abs() < 0.06 + 3.0 * 0.004, "{flat} of {exact}");
    // The twin: the side alone
    assert!((open - exact).abs() > 0.15, "{open} of {exact}");
}

#[test]
fn coats_and_both_horizons_draw_from_their_own_lobes() {
    let Some(engine) = TestEngine::new() else { return };
    let (_, light) = symmetric_lights().remove(0);
    let quality = Quality { horizon: Horizon::Both, ..Quality::default() };
    let surfaces = Effects::DIFFUSE | Effects::GLOSSY | Effects::COAT;
    let material = Material { roughness: 0.6, coat: 0.9, coat_roughness: 0.2, ..Material::default() };
    for options in [
        ShadeOptions { surfaces, ..options() },
        ShadeOptions { quality, ..options() },
        ShadeOptions {
            quality: Quality { specular_lobes: SpecularLobes::Two, ..Quality::default() },
            ..options()
        },
    ] {
        let view = Vec3::new(-1.0, 0.0, 0.8);
        let patch =
            ShadowPatch { material, view, lights: vec![light.clone()], blockers: plate_over_half(0.01) };
        let found = patch.run(&PatchPasses::new(&engine, options, ShadowFilter::Off)).mean();
        assert!((found - 0.5).abs() < 4e-3, "{options:?}: {found}");
    }
}

#[test]
fn tiles_pick_the_lights_that_frames_pick() {
    let Some(engine) = TestEngine::new() else { return };
    let (_, material, view) = surfaces().remove(3);
    let lights: Vec<Light> = symmetric_lights().into_iter().map(|(_, light)| light).collect();
    let patch = ShadowPatch { material, view, lights, blockers: plate_over_half(0.3) };
    let [frame, tiles] = [
        PatchPasses::new(&engine, options(), ShadowFilter::Off),
        PatchPasses::with_tiles(&engine, options()),
    ]
    .map(|passes| patch.run(&passes));
    assert!((0.1..0.9).contains(&frame.mean()), "{}", frame.mean());
    assert_eq!(tiles.unshadowed, frame.unshadowed);
    assert_eq!(tiles.shadows, frame.shadows);
}
