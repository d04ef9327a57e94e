//! Lights at the horizons, and the level that has none.

use super::{COUNT, PATHS, TABLE, lambert, outline, view};
use arealight::gpu::GpuLight;
use arealight_tests::prelude::*;
use arealight_tests::{Path, Property};

/// Steps of a light that rises over the horizon.
const STEPS: usize = 40_000;
/// From so far below to so far above.
const REACH: f64 = 0.05;

/// A wall with a level top, one that stands on a corner, a ceiling seen from below, and a concave wall.
fn rising() -> Vec<Vec<DVec3>> {
    let wall = vec![
        DVec3::new(2.0, -1.0, -1.0),
        DVec3::new(2.0, 1.0, -1.0),
        DVec3::new(2.0, 1.0, 0.0),
        DVec3::new(2.0, -1.0, 0.0),
    ];
    let tilt = DQuat::from_rotation_x(0.6);
    let tilted: Vec<DVec3> = wall.iter().map(|v| tilt * *v).collect();
    let top = tilted.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
    let ceiling = [(1.0, -1.0), (1.0, 1.0), (3.0, 1.0), (3.0, -1.0)];
    let mut notched = wall.clone();
    notched.insert(3, DVec3::new(2.0, 0.1, -0.5));
    vec![
        wall,
        tilted.iter().map(|v| *v - DVec3::Z * top).collect(),
        ceiling.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect(),
        notched,
    ]
}

/// A light rises over the horizon in 40,000 steps, each of a millionth of its distance or so. What it gains
/// in one is that times the sine of its elevation at most, which is 0.05 in the end. The roundings of
/// neighbours differ by a few units in the last place of arcs of up to a right angle.
pub fn a_light_rises_without_a_jump(engine: &TestEngine, levels: &[Level]) {
    for &level in levels {
        let bound = REACH * 2.0 * REACH / STEPS as f64 + 2.0 * f64::from(f32::EPSILON);
        for (kind, light) in rising().iter().enumerate() {
            if level.path == Path::Quad && light.len() > 4 {
                continue;
            }
            let height = |step: usize| REACH * (2.0 * step as f64 / STEPS as f64 - 1.0);
            let mut given = Cases::new(&[lambert(light.clone())]);
            let (packed, case) = (given.lights[0], given.cases[0]);
            // The light moves by its center alone: its shape is the same to the bit
            given.lights = (0..=STEPS)
                .map(|step| {
                    let mut light = packed;
                    light.center[2] = (f64::from(packed.center[2]) + height(step)) as f32;
                    GpuLight { flags: GpuLight::TWO_SIDED, ..light }
                })
                .collect();
            given.cases = (0..=STEPS as u32)
                .map(|light| arealight_tool_kernels::gpu::GpuCase { light, ..case })
                .collect();
            let factors = engine.factors(&given, Effects::DIFFUSE, level);
            let jump = factors.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            let rise = factors[STEPS] - factors[0];
            println!("{level}, light {kind}: rises by {rise:.2e}, by at most {jump:.2e} at once");
            assert!(jump <= bound, "{level}, light {kind}: a jump of {jump:e}, {bound:e} allowed");
            assert_eq!(factors[0], 0.0, "{level}, light {kind}: dark below the horizon");
            // The twin: it does rise, by more than is allowed at once
            assert!(rise > bound, "{level}, light {kind}: rises by {rise:e}");
        }
    }
}

/// Lights wholly below the surface, out to grazing views: exactly nothing, of a lobe that reaches there.
pub fn nothing_leaks_from_below_the_surface(engine: &TestEngine, levels: &[Level]) {
    for &level in levels {
        let mut random = Random::new(31);
        let mut points = Vec::new();
        for index in 0..2 * COUNT {
            let mut vertices = outline(&mut random, level.path, index);
            // From just below, by more than float32's rounding, on down
            let top = vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
            let depth = 10.0_f64.powf(random.between(-5.0, 0.0));
            for vertex in &mut vertices {
                vertex.z -= top + depth;
            }
            let cos_view: f64 = random.between(0.0, 0.4);
            let azimuth = DQuat::from_rotation_z(random.between(0.0, 6.3));
            let view = azimuth * DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
            let two_sided = index % 2 == 0;
            points.push(point(glossy_surface(random.between(0.01, 1.0)), view, vertices, two_sided));
        }
        let given = Cases::new(&points);
        let answers = engine.run(&given, level.effects(Effects::GLOSSY), level.quality);
        let lit = answers.iter().position(|answer| *answer != [0; 4]);
        assert_eq!(lit, None, "{level}: {:?}", lit.map(|index| &points[index]));
        // The twin: clipped once, they do shine in
        let once = Level::of(&[level.path], &[Horizon::Cosine])[0];
        let leaks = engine.factors(&given, Effects::GLOSSY, once);
        let many = leaks.iter().filter(|leak| **leak > 1e-4).count();
        assert!(many > COUNT / 20, "{once}: {many} leak");
    }
}

/// The form factor of what is clipped at both horizons is no larger than of what is clipped at one; its gain
/// aside, with which the lobe keeps its albedo.
pub fn clipping_twice_is_no_brighter(engine: &TestEngine) {
    let mut random = Random::new(32);
    for path in PATHS {
        let group = |index| {
            let vertices = outline(&mut random, path, index);
            let mut given =
                point(glossy_surface(random.between(0.05, 1.0)), view(&mut random), vertices, false);
            given.light.two_sided = index % 3 == 0;
            vec![given]
        };
        let property =
            Property::new("both horizons", Some(&TABLE), &(0..2 * COUNT).map(group).collect::<Vec<_>>());
        for level in Level::of(&[path], &[Horizon::Both]) {
            let mut once = level;
            once.quality.horizon = Horizon::Cosine;
            let mut comparison = Comparison::new(format!("no brighter, {level}"));
            let mut darker = 0;
            let gains = property.gains(level);
            let pairs = property.groups(engine, level).into_iter().zip(property.groups(engine, once));
            for (((twice, bound), (once, other)), gain) in pairs.zip(gains) {
                let more = twice[0] / gain - once[0];
                comparison.add(more.max(0.0), 0.0, bound + other, || format!("{twice:?} {once:?}"));
                darker += usize::from(-more > bound + other);
            }
            comparison.assert_all();
            assert!(darker > COUNT / 20, "the twin: {darker} lights lost what is below the surface");
        }
    }
}
