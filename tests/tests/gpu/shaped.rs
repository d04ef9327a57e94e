//! Lights with a profile on the GPU: known radiance, the float64 twin, and where they are hard.

use arealight::plan::{ShadowFilter, ShadowHistory};
use arealight::{LightTexture, Opening, Profile, PyramidSize, TexturePart};
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{SupportedCase, read_cases};
use arealight_engine::{Engine, Reference};
use arealight_oracle::cubature::Settings;
use arealight_oracle::shading::truth;
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::VisibilityConstants;
use glam::DVec2;

fn read(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/reference/");
    std::fs::read_to_string(format!("{folder}{name}")).unwrap()
}

fn case_point(case: &SupportedCase, profile: Option<Profile>) -> EvalPoint {
    let light = Light { profile, ..case.light.clone() };
    EvalPoint { surface: case.surface, position: DVec3::ZERO, normal: case.normal, view: case.view, light }
}

/// The root of the mean squared difference of the first channels, in parts of the mean truth.
fn error(answers: &[f64], exact: &[f64], truth: &[f64]) -> f64 {
    let squares: f64 = answers.iter().zip(exact).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / answers.len() as f64).sqrt() / (truth.iter().sum::<f64>() / truth.len() as f64)
}

#[test]
fn known_radiance_is_met_by_few_levels() {
    let Some(engine) = TestEngine::new() else { return };
    let truths = read_answers(&read("emission-truth.json")).unwrap();
    let cases = read_cases(&read("emission.json")).unwrap();
    for (material, bounds) in [("diffuse", [0.01, 0.005, 0.0035]), ("ggx", [0.03, 0.015, 0.0125])] {
        let cases: Vec<(SupportedCase, f64)> = cases
            .iter()
            .zip(&truths)
            .filter(|(case, _)| case.name.ends_with(material))
            .map(|(case, truth)| (case.supported(|_| unreachable!()).unwrap(), truth.radiance.unwrap()[0]))
            .collect();
        let truth: Vec<f64> = cases.iter().map(|(_, truth)| *truth).collect();
        // The lobes' own answers: what the fit makes of it is not the profile's error
        let exact: Vec<f64> = cases
            .iter()
            .map(|(case, _)| {
                let profile = case.light.profile.as_ref().unwrap().with_levels(Profile::MAX_LEVELS);
                polygon_twin(Quality::default(), &case_point(case, Some(profile))).x
            })
            .collect();
        if material == "diffuse" {
            let fit = error(&exact, &truth, &truth);
            assert!(fit < 2e-3, "Lambert's lobe is exact: {fit}");
        }
        let by = |levels| {
            let points: Vec<EvalPoint> = cases
                .iter()
                .map(|(case, _)| {
                    case_point(case, Some(case.light.profile.as_ref().unwrap().with_levels(levels)))
                })
                .collect();
            let answers = engine.eval(&points, Quality::default()).unwrap();
            answers.iter().map(|answer| f64::from(answer.x)).collect::<Vec<f64>>()
        };
        for (levels, bound) in [4, 6, 8].into_iter().zip(bounds) {
            let found = error(&by(levels), &exact, &truth);
            println!("{material}, {levels} levels: {found:.5}");
            assert!(found < bound, "{material}, {levels} levels: {found}");
        }
        // The twin: the profile at one direction, that of the light's middle
        let plain: Vec<EvalPoint> = cases.iter().map(|(case, _)| case_point(case, None)).collect();
        let answers = engine.eval(&plain, Quality::default()).unwrap();
        let one: Vec<f64> = answers
            .iter()
            .zip(&plain)
            .zip(&cases)
            .map(|((answer, given), (case, _))| {
                let [center, normal] = [given.light.shape.center(), given.light.shape.area_vector()];
                let cosine = -center.dot(normal) / (center.length() * normal.length());
                f64::from(answer.x) * case.light.profile.as_ref().unwrap().factor(cosine)
            })
            .collect();
        let found = error(&one, &exact, &truth);
        println!("{material}, one direction: {found:.3}");
        assert!(found > 0.2, "{material}, one direction: {found}");
    }
}

/// A spot, a flood, a batwing, and a profile that ends at once.
fn profiles(levels: u32) -> [Profile; 4] {
    let profile = |pairs: &[[f64; 2]]| Profile::new(pairs, levels).unwrap();
    [
        profile(&[[0.0, 1.0], [18.0, 1.0], [32.0, 0.0]]),
        profile(&[[0.0, 1.0], [37.0, 1.0], [60.0, 0.0]]),
        profile(&[[0.0, 0.5], [20.0, 0.7], [40.0, 1.0], [70.0, 0.1], [90.0, 0.0]]),
        profile(&[[0.0, 1.0], [45.0, 1.0]]),
    ]
}

/// Points under convex outlines of 3 to 8 vertices about as large as they are far: above, across and below
/// the horizons, every third with two sides.
fn points(seed: u64, surface: &Surface, count: usize) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let profiles = profiles(4);
    let one = |index: usize| {
        let cos_view = random.between(0.0, 1.0);
        let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
        let size = random.between(0.1, 2.0);
        // Of one radius, so that it is convex
        let center = random.direction();
        let vertices = random.polygon(center, 3 + index % 6, size, size * (1.0 + 1e-12));
        let mut given = point(*surface, view, vertices, index.is_multiple_of(3));
        given.light.profile = Some(profiles[index % 4].clone());
        given
    };
    (0..count).map(one).collect()
}

#[test]
fn narrow_beams_are_met_by_few_levels() {
    let Some(engine) = TestEngine::new() else { return };
    let power = |exponent: f64| {
        (0..=90).map(|d| [f64::from(d), f64::from(d).to_radians().cos().max(0.0).powf(exponent)]).collect()
    };
    let beams: [Vec<[f64; 2]>; 5] = [
        vec![[0.0, 1.0], [5.0, 1.0], [8.0, 0.0]],
        vec![[0.0, 1.0], [5.0, 1.0], [8.0, 0.05], [90.0, 0.0]],
        vec![[0.0, 1.0], [2.0, 1.0], [3.0, 0.01], [90.0, 0.0]],
        power(16.0),
        power(128.0),
    ];
    for (material, surface, bounds) in
        [("diffuse", lambert_surface(), [0.06, 0.016]), ("ggx", glossy_surface(0.25), [0.12, 0.05])]
    {
        for (index, beam) in beams.iter().enumerate() {
            let by = |levels| {
                let mut points = points(7, &surface, 600);
                let profile = Profile::new(beam, levels).unwrap();
                for point in &mut points {
                    point.light.profile = Some(profile.clone());
                }
                let answers = engine.eval(&points, Quality::default()).unwrap();
                answers.iter().map(|answer| f64::from(answer.x)).collect::<Vec<f64>>()
            };
            let exact = by(Profile::MAX_LEVELS);
            let [one, four, eight] = [1, 4, 8].map(|levels| error(&by(levels), &exact, &exact));
            println!("{material}, beam {index}: {four:.4} {eight:.4}");
            assert!(
                four < bounds[0] && eight < bounds[1] && one > 3.0 * eight,
                "{material} {index}: {one} {four} {eight}"
            );
        }
    }
}

/// A street lamp's candela by degrees and azimuth, 24 of them: two lobes along the street, to one side of it.
fn street() -> Vec<Vec<f64>> {
    let lobe = |angle: f64, azimuth: f64| {
        let toward =
            |azimuth: f64| DVec2::from_angle(azimuth).extend(0.0) * angle.sin() + DVec3::Z * angle.cos();
        let lobes = [70.0_f64, -70.0].map(|at| {
            let peak = DVec2::from_angle(at.to_radians()).extend(0.0) * 0.9 + DVec3::Z * 0.436;
            (12.0 * (toward(azimuth).dot(peak) - 1.0)).exp()
        });
        (lobes[0] + lobes[1] + 0.15) * ((90.0 - angle.to_degrees()) / 15.0).clamp(0.0, 1.0)
    };
    let row = |step: u32| {
        let degrees = f64::from(step) * 3.0;
        let azimuths = (0..24).map(|i| lobe(degrees.to_radians(), f64::from(i) * TAU / 24.0));
        std::iter::once(degrees).chain(azimuths).collect()
    };
    (0..=30).map(row).collect()
}

/// A profile that is the same all around, the mean of another.
fn round_of(rows: &[Vec<f64>], levels: u32) -> Profile {
    let mean = |row: &Vec<f64>| [row[0], row[1..].iter().sum::<f64>() / (row.len() - 1) as f64];
    Profile::new(&rows.iter().map(mean).collect::<Vec<_>>(), levels).unwrap()
}

#[test]
fn a_street_lamp_is_not_round() {
    let Some(engine) = TestEngine::new() else { return };
    let rows = street();
    let by = |points: &[EvalPoint], profile: &Profile| {
        let with = |given: &EvalPoint| {
            let light = Light { profile: Some(profile.clone()), ..given.light.clone() };
            EvalPoint { light, ..given.clone() }
        };
        let points: Vec<EvalPoint> = points.iter().map(with).collect();
        let answers = engine.eval(&points, Quality::default()).unwrap();
        (points, answers.iter().map(|answer| f64::from(answer.x)).collect::<Vec<f64>>())
    };
    // Lights up to half as large as they are far, and larger; of the glossy lobe the fit's error is in it
    for (surface, far, bound) in [
        (lambert_surface(), true, 0.07),
        (lambert_surface(), false, 0.13),
        (glossy_surface(0.3), true, 0.35),
        (glossy_surface(0.3), false, 0.3),
    ] {
        let mut points = points(5, &surface, 300);
        points.retain(|given| {
            let (center, corner) = (given.light.shape.center(), given.light.shape.vertices()[0]);
            ((corner - center).length() < 0.5 * center.length()) == far
        });
        let [profile, round] = [Profile::new(&rows, 8).unwrap(), round_of(&rows, 8)];
        let (points, found) = by(&points, &profile);
        let truth: Vec<f64> = points
            .iter()
            .map(|given| {
                let light = RelativeLight::new(&given.light, given.position);
                let settings = Settings { max_evaluations: 40_000, ..Settings::default() };
                truth(&given.surface, given.normal, given.view, &light, &settings).radiance.x
            })
            .collect();
        let of_round = error(&by(&points, &round).1, &truth, &truth);
        let off = error(&found, &truth, &truth);
        println!("{}, far: {far}: {off:.4}, round {of_round:.4}", surface.alpha);
        assert!(off < bound, "{}, far: {far}: {off}", surface.alpha);
        // The twin: the mean about the axis
        assert!(of_round > 1.7 * off, "{}, far: {far}: {of_round} round, {off}", surface.alpha);
        let mut comparison = Comparison::new(format!("{}, far: {far}", surface.alpha));
        for (index, (given, found)) in points.iter().zip(&found).enumerate() {
            let expected = polygon_twin(Quality::default(), given);
            // As rings, whose chords are coarser than the twin's
            comparison.add(*found, expected.x, 1.5e-2, || format!("point {index}: {given:?}"));
        }
        comparison.assert_all();
    }
}

#[test]
fn rings_follow_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    for (surface, bound) in [(lambert_surface(), 2e-3), (glossy_surface(0.2), 1.5e-2)] {
        for quality in [Quality::default(), Quality { horizon: Horizon::Both, ..Quality::default() }] {
            let (points, what) = (points(1, &surface, 2000), format!("{quality:?}, {}", surface.alpha));
            // Chords of a rim have its area, not its place: Lambert's lobe sees little of that
            engine.beside_polygon_twin(what, quality, &points, |_| bound).assert_all();
        }
    }
}

#[test]
fn a_corner_on_a_rim_is_not_all_of_the_rim() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(9);
    let spot = profiles(4)[0].clone();
    let mut points = points(13, &lambert_surface(), 3000);
    for (index, given) in points.iter_mut().enumerate() {
        let corner = given.light.shape.vertices()[0];
        let normal = given.light.shape.area_vector().normalize_or_zero();
        let cosine = spot.levels()[index % spot.levels().len()];
        let tangent = (1.0 - cosine * cosine).sqrt() / cosine;
        // At a level's angle to rounding, from without the light's outline or over it
        let aside = random.direction().reject_from(normal).normalize_or_zero();
        let part = 1.0 + 10_f64.powf(random.between(-8.0, -4.5)) * if index % 2 == 0 { 1.0 } else { -1.0 };
        let height = random.between(0.2, 2.0);
        given.position = corner + normal * height + aside * (height * tangent * part);
        given.normal = -normal;
        given.light.profile = Some(spot.clone());
    }
    let quality = Quality::default();
    let comparison = engine.beside_polygon_twin("corners on rims", quality, &points, |_| 2e-3);
    let lit = points.iter().filter(|given| polygon_twin(quality, given).x > 1e-3).count();
    println!("{lit} are lit, {:e}", comparison.largest());
    assert!(lit > 500, "{lit}");
    comparison.assert_all();
}

/// Lights as of [`points`], each seen through an opening: between the point and the light, of every size;
/// behind the point; the size of the light from the point to rounding; and with sides through its corners.
fn opened_points(seed: u64, surface: &Surface, count: usize, has_profiles: bool) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let mut points = points(seed, surface, count);
    points.iter_mut().enumerate().for_each(|(index, given)| {
        let light = &mut given.light;
        light.profile = light.profile.take().filter(|_| has_profiles);
        if !has_profiles && index.is_multiple_of(5) {
            // Concave ones
            let (center, size) = (random.direction(), random.between(0.1, 1.0));
            light.shape = LightShape::Polygon(random.polygon(center, 4 + index % 5, 0.3 * size, size));
        }
        let vertices = light.shape.vertices().to_vec();
        let center = light.shape.center();
        let normal = (center.normalize_or_zero() + 0.5 * random.direction()).normalize_or_zero();
        let height = vertices.iter().map(|vertex| vertex.dot(normal)).fold(f64::INFINITY, f64::min);
        let part = if index % 11 == 7 { -0.4 } else { random.between(0.05, 0.99) };
        // Onto the plane, as seen from the point
        let seen = |to: DVec3| to * (height * part / to.dot(normal));
        let (u, v) = normal.any_orthonormal_pair();
        let housed = index.is_multiple_of(2);
        let opening = if height <= 0.0 {
            Opening { center: center - 2.0 * center.length() * normal, axis_u: u, axis_v: v, housed: false }
        } else if index % 7 == 3 {
            // What covers the light exactly, or a part of it with a corner on its edge
            let (a, b, c) = (vertices[0] * part.abs(), vertices[1] * part.abs(), vertices[2] * part.abs());
            let (u, v) = (0.5 * (b - a), 0.5 * (c - b));
            Opening { center: a + u + v, axis_u: u, axis_v: v, housed }
        } else {
            let [a, b, size] =
                [random.between(0.2, 1.5), random.between(0.2, 1.5), random.between(0.02, 1.0)];
            let aim = seen(vertices[index % vertices.len()].lerp(center, random.between(0.0, 1.0)));
            let size = size * height * part.abs();
            Opening { center: aim, axis_u: size * a * u, axis_v: size * (b * v + 0.3 * u), housed }
        };
        light.opening = Some(opening);
    });
    points.retain(|given| given.light.validate().is_ok());
    assert!(points.len() > count * 9 / 10, "{} of {count} are lights", points.len());
    points
}

#[test]
fn openings_clip_as_their_float64_twin() {
    let Some(engine) = TestEngine::new() else { return };
    for (surface, has_profiles, bound) in [
        // The promise for any outline
        (lambert_surface(), false, 1e-6),
        (glossy_surface(0.2), false, 1e-6),
        // The chords of rims, as without an opening
        (lambert_surface(), true, 2e-3),
        (glossy_surface(0.2), true, 1.5e-2),
    ] {
        for quality in [Quality::default(), Quality { horizon: Horizon::Both, ..Quality::default() }] {
            let points = opened_points(3, &surface, 1200, has_profiles);
            let what = format!("{quality:?}, {}, {has_profiles}", surface.alpha);
            let comparison = engine.beside_polygon_twin(what, quality, &points, |_| bound);
            let (mut hidden, mut dimmer) = (0, 0);
            for given in &points {
                let expected = polygon_twin(quality, given);
                let open = Light { opening: None, ..given.light.clone() };
                let all = polygon_twin(quality, &EvalPoint { light: open, ..given.clone() });
                hidden += usize::from(all.x > 0.01 && expected.x == 0.0);
                dimmer += usize::from(expected.x > 0.0 && expected.x < all.x - 2.0 * bound);
            }
            println!("{}, {hidden} hidden, {dimmer} dimmer: {:e}", surface.alpha, comparison.largest());
            // The twin: without the openings these would differ
            assert!(hidden > 15 && dimmer > 50, "{hidden} {dimmer}");
            comparison.assert_all();
        }
    }
}

#[test]
fn openings_of_any_size_and_place_let_no_more_through_than_there_is() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(7);
    for surface in [lambert_surface(), glossy_surface(0.05)] {
        let mut points = opened_points(11, &surface, 600, true);
        for (index, given) in points.iter_mut().enumerate() {
            let opening = given.light.opening.as_mut().unwrap();
            let scale = 10_f64.powf(random.between(-30.0, 15.0));
            match index % 4 {
                0 => (opening.axis_u, opening.axis_v) = (opening.axis_u * scale, opening.axis_v * scale),
                1 => opening.axis_v *= scale,
                // The point in the opening's plane, and all of it a grain or a world
                2 => opening.center = opening.axis_u * random.between(-2.0, 2.0),
                _ => {
                    opening.center *= scale;
                    (opening.axis_u, opening.axis_v) = (opening.axis_u * scale, opening.axis_v * scale);
                    let LightShape::Polygon(vertices) = &mut given.light.shape else { unreachable!() };
                    for vertex in vertices.iter_mut() {
                        *vertex *= scale;
                    }
                }
            }
        }
        points.retain(|given| given.light.validate().is_ok());
        assert!(points.len() > 300, "{}", points.len());
        let answers = engine.eval(&points, Quality::default()).unwrap();
        for (given, answer) in points.iter().zip(&answers) {
            assert!((0.0..=1.0 + 1e-6).contains(&answer.x), "{answer}: {given:?}");
        }
        let lit = answers.iter().filter(|answer| answer.x > 0.0).count();
        assert!(lit > 50, "{lit} of {} are lit", points.len());
    }
}

#[test]
fn truth_has_openings() {
    let points = opened_points(5, &lambert_surface(), 40, false);
    for given in &points {
        let light = RelativeLight::new(&given.light, given.position);
        let truth = truth(&given.surface, given.normal, given.view, &light, &Settings::default());
        let exact = polygon_twin(Quality::default(), given);
        assert!((truth.radiance - exact).abs().max_element() < 1e-6, "{} {exact}", truth.radiance);
    }
}

/// A floor with plates above it, seen from among them.
struct Above<'a> {
    engine: &'a TestEngine,
    buffers: SceneBuffers,
    constants: VisibilityConstants,
    options: ShadeOptions,
}

impl<'a> Above<'a> {
    const SIZE: [u32; 2] = [16, 16];

    fn new(engine: &'a TestEngine, plates: &[[DVec3; 3]]) -> Self {
        let [a, b, c, d] =
            [(-2.0, 2.0), (2.0, 2.0), (2.0, -2.0), (-2.0, -2.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
        let triangles = [&[[a, b, c], [a, c, d]], plates].concat();
        let scene = scene_of(&triangles, without_textures(lambert(0.8)));
        let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
        let look = Camera::framing("", [DVec3::ZERO].into_iter().collect(), DVec3::NEG_Y, DVec3::Z, 1.0);
        let camera = Camera { position: DVec3::Y * 0.7, half_height: 2.0, ..look };
        let constants = buffers.constants(&camera, Self::SIZE, Vec3::ZERO);
        let options = ShadeOptions { surfaces: Effects::DIFFUSE, shadow_rays: 4, ..ShadeOptions::default() };
        Self { engine, buffers, constants, options }
    }

    /// The mean of each pixel over what is added.
    fn seen(&self, lamp: &Light, rounds: u32, shade: impl Fn(&mut SceneRenderer<'_>)) -> Vec<f64> {
        let lights = std::slice::from_ref(lamp);
        let mut renderer =
            SceneRenderer::new(self.engine, &self.buffers, lights, self.constants, Self::SIZE).unwrap();
        shade(&mut renderer);
        let radiance = renderer.radiance().unwrap();
        radiance.iter().map(|pixel| f64::from(pixel.x) / f64::from(rounds)).collect()
    }

    fn by_rays(&self, lamp: &Light, rounds: u32) -> Vec<f64> {
        self.seen(lamp, rounds, |renderer| {
            let unfiltered = (ShadowFilter::Off, ShadowHistory::Off);
            let view = renderer.shadowed(&self.buffers, self.options, unfiltered).unwrap();
            for seed in 0..rounds {
                renderer.shade_shadowed(&view, seed).unwrap();
            }
        })
    }
}

/// A lamp over a floor with a plate between them, with its shadows and without, is what Monte Carlo says, by
/// these bounds of pixels' errors, without and with rays; `others` are not.
fn assert_monte_carlo(lamp: &Light, [plain_bound, shadowed_bound]: [f64; 2], others: &[(&str, &Light)]) {
    let Some(mut engine) = TestEngine::new() else { return };
    if lamp.texture.is_some() {
        load_bright_part(&mut engine, |[x, _]| x == 0);
    }
    let plate = box_of(DVec3::new(0.1, 0.8, -0.2), DVec3::new(0.5, 0.85, 0.6));
    let above = Above::new(&engine, &plate);
    let [plain, shadowed] = [false, true].map(|shadows| {
        let reference = Reference { samples: 4096, seed: 1, shadows, coupled: false, ..Reference::default() };
        above.seen(lamp, 1, |renderer| {
            renderer.reference(reference, |_| {}).unwrap();
        })
    });
    let by_cosines = |lamp: &Light| {
        above.seen(lamp, 1, |renderer| {
            renderer.shade(above.options.surfaces, above.options.quality).unwrap();
        })
    };
    let by_rays = above.by_rays(lamp, 64);
    let mean = |picture: &[f64]| picture.iter().sum::<f64>() / picture.len() as f64;
    for (what, found, expected, bound) in [
        ("by cosines", by_cosines(lamp), &plain, plain_bound),
        ("by rays", by_rays, &shadowed, shadowed_bound),
    ] {
        let (ratio, off) = (mean(&found) / mean(expected), error(&found, expected, expected));
        println!("{what}: mean {ratio:.4}, pixels {off:.4}");
        // Several times the noise of these means, and what rings are off with chords for their rims
        assert!((ratio - 1.0).abs() < 0.02, "{what}: {ratio}");
        assert!(off < bound, "{what}: {off}");
    }
    // The twins: without the plate, and other lamps
    let others = others.iter().map(|(what, lamp)| (*what, by_cosines(lamp), &plain));
    for (what, found, expected) in others.chain([("without the plate", plain.clone(), &shadowed)]) {
        let off = error(&found, expected, expected);
        println!("{what}: pixels {off:.4}");
        assert!(off > 0.3, "{what}: {off}");
    }
}

/// A square that faces down, of this half side at this height.
fn square_over(half: f64, height: f64) -> LightShape {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    LightShape::Polygon(corners.map(|(x, z)| DVec3::new(x, height, z)).to_vec())
}

#[test]
fn a_spot_behind_doors_and_its_shadows_are_those_of_monte_carlo() {
    let shape = square_over(0.3, 1.6);
    // Doors that cut half of the cone away
    let doors = Opening::doors(&shape, 0.3, 0.1).unwrap();
    let spot = Light {
        opening: Some(Opening { axis_u: 0.5 * doors.axis_u, ..doors }),
        shape,
        radiance: Vec3::splat(5.0),
        profile: Some(Profile::cone(0.2, 0.5, 6).unwrap()),
        ..Light::default()
    };
    let wide = Light { profile: None, ..spot.clone() };
    let open = Light { opening: None, ..spot.clone() };
    // 4096 samples, half of them hidden, of a factor from 0 to 1 leave .015 of a pixel's light, three times
    // that of the mean's; 256 rays .03 in the penumbra, which is most of it
    assert_monte_carlo(&spot, [0.06, 0.1], &[("without the cone", &wide), ("without the doors", &open)]);
}

/// A picture that is dim but for some of its 8 x 8 pieces.
fn load_bright_part(engine: &mut Engine, is_bright: impl Fn([u32; 2]) -> bool) {
    const SIDE: u32 = 64;
    let texel = |index| {
        let is_bright = is_bright([index % SIDE * 8 / SIDE, index / SIDE * 8 / SIDE]);
        if is_bright { [1.0, 0.9, 0.7, 1.0] } else { [1e-4, 1e-4, 2e-4, 1.0] }
    };
    let texels: Vec<[f32; 4]> = (0..SIDE * SIDE).map(texel).collect();
    let texels = SourceTexels::Linear(&texels);
    let image = SourceImage { texels, size: [SIDE; 2], part: TexturePart::default() };
    engine.load_textures(PyramidSize::new(SIDE).unwrap(), &[image]).unwrap();
}

#[test]
fn a_picture_and_its_shadows_are_those_of_monte_carlo() {
    let uvs = [(1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)].map(DVec2::from);
    let shown = |uvs: [DVec2; 4]| Light {
        shape: square_over(0.7, 1.6),
        radiance: Vec3::splat(5.0),
        texture: Some(LightTexture { layer: 0, uvs: uvs.to_vec() }),
        ..Light::default()
    };
    let mirrored = uvs.map(|at| DVec2::new(1.0 - at.x, at.y));
    // An eighth of the samples meets what shines
    assert_monte_carlo(&shown(uvs), [0.07, 0.1], &[("the picture mirrored", &shown(mirrored))]);
}

#[test]
fn rays_go_to_what_shines() {
    let Some(mut engine) = TestEngine::new() else { return };
    load_bright_part(&mut engine, |piece| piece == [1, 2]);
    let uvs = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    let panel = Light { radiance: Vec3::ONE, shape: square_over(1.0, 2.0), ..Light::default() };
    let shown = Light { texture: Some(LightTexture { layer: 0, uvs }), ..panel.clone() };
    let narrow = Light { profile: Some(Profile::spread(0.1, 4).unwrap()), ..panel.clone() };
    // A plate before all, or before the bright piece of the picture; 1 % of the mean is everywhere in that
    let (all, piece) = (DVec3::new(3.0, 0.0, 3.0), DVec3::new(0.3, 0.0, 0.3));
    let of_piece = DVec3::new(-0.625, 1.9, -0.375);
    for (what, lamp, middle, half, bound) in
        [("narrow", &narrow, DVec3::Y * 1.9, all, 1e-6), ("picture", &shown, of_piece, piece, 0.03)]
    {
        let plate = box_of(middle - half, middle + half + DVec3::Y * 0.01);
        let hidden =
            [&plate[..], &[]].map(|plates| Above::new(&engine, plates).by_rays(lamp, 1).iter().sum::<f64>());
        println!("{what}: {:.2e} arrives", hidden[0] / hidden[1]);
        // The twin is what arrives without the plate
        assert!(hidden[1] > 0.0 && hidden[0] < bound * hidden[1], "{what}: {hidden:?}");
    }
}

#[test]
fn a_window_and_its_shadows_are_those_of_monte_carlo() {
    // A thirteenth of the sky is seen: rays that were drawn to all of it would miss the window half the time
    let (axis_u, axis_v) = (DVec3::X * 0.2, DVec3::Z * 0.2);
    let window = Opening { center: DVec3::Y * 1.2, axis_u, axis_v, housed: false };
    let sky = Light {
        shape: square_over(3.0, 5.0),
        radiance: Vec3::ONE,
        opening: Some(window),
        ..Light::default()
    };
    let open = Light { opening: None, ..sky.clone() };
    // Of 4096 samples 300 come through: .06 of a pixel's light, and as much in the mean's
    assert_monte_carlo(&sky, [0.12, 0.15], &[("without the wall", &open)]);
}
