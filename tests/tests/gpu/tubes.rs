//! Tubes and capsules on the device against float64.

use arealight_oracle::polygon;
use arealight_oracle::sphere::{self, Sphere};
use arealight_oracle::tube::{Ends, Tube, form_factor, transformed_form_factor};
use arealight_tests::Numbers;
use arealight_tests::prelude::*;
use arealight_tests::shapes::tube_arguments;
use glam::Mat3;

pub(super) const ENDS: [Ends; 3] = [Ends::Open, Ends::Flat, Ends::Round];
pub(super) const COUNT: usize = 100;

pub(super) fn round(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

/// Where a tube is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// About as long as far, any way.
    Generic,
    /// Across the horizon.
    Crossing,
    /// An end's rim in the plane of the point.
    Level,
    /// Thinner than a hundredth of its distance.
    Thin,
    /// 1e3 to 1e5 times as far as long.
    Far,
    /// Its surface 1e-3 to 1e-1 of the radius away.
    Near,
    /// Seen along its axis, from past an end.
    EndOn,
}

fn tubes(place: Place, ends: Ends) -> Vec<Tube> {
    let mut random = Random::new(90 + place as u64);
    let mut tube = || {
        let mut start = random.direction() * random.between(-1.5, 1.5).exp2();
        let mut axis = random.direction() * random.between(-2.0, 2.0).exp2();
        let mut radius = random.between(-4.0, 0.0).exp2();
        match place {
            Place::Generic => {}
            Place::Crossing => start.z = -axis.z * random.unit(),
            Place::Level => {
                start -= axis * (start.dot(axis) / axis.length_squared());
                radius = radius.min(0.9 * start.length());
            }
            Place::Thin => radius = random.between(-17.0, -7.0).exp2() * start.length(),
            Place::Far => start *= random.between(10.0, 17.0).exp2(),
            Place::Near => {
                let towards = axis.any_orthonormal_vector();
                let away = radius * (1.0 + random.between(-10.0, -3.0).exp2());
                start = towards * away - axis * random.between(-0.1, 1.1);
            }
            Place::EndOn => {
                let towards = axis.any_orthonormal_vector();
                start = axis * random.between(0.2, 2.0) + towards * (radius * random.between(0.0, 3.0));
                if random.bits().is_multiple_of(2) {
                    start += axis;
                    axis = -axis;
                }
            }
        }
        let (center, half) = (round(start + axis * 0.5), round(axis * 0.5));
        Tube { start: center - half, end: center + half, radius: f64::from(radius as f32), ends }
    };
    (0..COUNT).map(|_| tube()).collect()
}

/// A lobe's cosine space.
fn lobe(random: &mut Random) -> DMat3 {
    let rotation = DMat3::from_axis_angle(random.direction(), random.between(0.0, 6.0));
    let alpha = random.between(-5.0, 0.0).exp2();
    (DMat3::from_diagonal(DVec3::new(1.0, 0.8, alpha)) * rotation).as_mat3().as_dmat3()
}

fn ends_of(tubes: &[Tube]) -> Vec<Ends> {
    tubes.iter().map(|tube| tube.ends).collect()
}

pub(super) fn found(engine: &TestEngine, tubes: &[Tube], matrices: &[DMat3]) -> Vec<f64> {
    let arguments: Vec<_> = tubes.iter().zip(matrices).map(|(t, m)| tube_arguments(t, m)).collect();
    let found = engine.tubes(false, &arguments, &ends_of(tubes));
    let bits = found.iter().all(|factor| factor.to_bits() <= 1.0_f32.to_bits());
    assert!(bits, "{found:?}");
    found.into_iter().map(f64::from).collect()
}

#[test]
fn tubes_are_what_their_outlines_are() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(99);
    let mut sixteen = 0;
    for ends in ENDS {
        for place in [Place::Generic, Place::Crossing, Place::Level, Place::Near, Place::EndOn] {
            let tubes = tubes(place, ends);
            let lobes: Vec<_> =
                (0..COUNT).map(|i| if i % 2 == 0 { DMat3::IDENTITY } else { lobe(&mut random) }).collect();
            let truth: Vec<_> =
                tubes.iter().zip(&lobes).map(|(t, m)| transformed_form_factor(m, t)).collect();
            // A thousandth of the radius away, the center's rounding of 6e-8 of it is 6e-5 of the distance:
            // of the form factor that is a tenth or less, as a rim's place is what matters
            let bound = if place == Place::Near { 1e-5 } else { 2e-6 };
            let mut comparison = Comparison::new(format!("{ends:?}, {place:?}"));
            for (i, found) in found(&engine, &tubes, &lobes).into_iter().enumerate() {
                comparison.add(found, truth[i], bound, || format!("{:?}, {:?}", tubes[i], lobes[i]));
                let polygon = polygon::transformed_form_factor(&lobes[i], &tubes[i].outline(16));
                sixteen += usize::from((polygon.abs() - truth[i]).abs() > bound);
            }
            comparison.assert_all();
        }
    }
    // The twin: outlines of sixteen segments an end
    assert!(sixteen > 4 * COUNT, "{sixteen} noticed");
}

#[test]
fn thin_and_far_tubes_keep_relative_precision() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(98);
    let (mut twin, mut dark) = (0, 0);
    for ends in ENDS {
        for place in [Place::Thin, Place::Far] {
            let tubes = tubes(place, ends);
            let lobes: Vec<_> =
                (0..COUNT).map(|i| if i % 2 == 0 { DMat3::IDENTITY } else { lobe(&mut random) }).collect();
            let mut comparison = Comparison::new(format!("{ends:?}, {place:?}, relative"));
            for (i, found) in found(&engine, &tubes, &lobes).into_iter().enumerate() {
                // What the whole tube sends with the horizon out of the way
                let (tube, lobe) = (tubes[i], lobes[i]);
                let truth = transformed_form_factor(&lobe, &tube);
                let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)) * lobe;
                let whole = truth + transformed_form_factor(&mirror, &tube);
                // A line's own error is the square of a hundredth. What is no line is an outline, whose error
                // is absolute. In the lobe's space rounding costs a height 2^-23 of the distance, and it is a
                // hundredth of that or less
                let outlined = if is_thin(&tube, &lobe) { 0.0 } else { 2e-7 / whole };
                let center = lobe * (0.5 * (tube.start + tube.end));
                let low = (0.01 * center.length() / center.z.abs()).clamp(1.0, 2.0);
                let bound = outlined + 1e-4 * low;
                if whole > 0.0 {
                    comparison.add(found / whole, truth / whole, bound, || {
                        format!("{tube:?}, {lobe:?}, {whole:e}")
                    });
                    twin += usize::from((1.001 * found - truth).abs() > bound * whole);
                } else {
                    dark += 1;
                }
            }
            comparison.assert_all();
        }
    }
    // The twin: a result that is a thousandth too large
    assert!(twin > COUNT && dark < COUNT, "{twin} noticed, {dark} dark");
}

/// The point's distance from the axis as a line.
pub(super) fn distance(tube: &Tube) -> f64 {
    let axis = (tube.end - tube.start).try_normalize().expect("long enough");
    tube.start.cross(axis).length()
}

/// Whether a tube is thin in its own space and a lobe's, so that it is a line.
pub(super) fn is_thin(tube: &Tube, lobe: &DMat3) -> bool {
    let nearest = |start: DVec3, end: DVec3| {
        let axis = (end - start).try_normalize().expect("long enough");
        start.cross(axis).length().max((0.5 * (start + end)).length() - 0.5 * start.distance(end))
    };
    let axis = (tube.end - tube.start).try_normalize().expect("long enough");
    let plane = tube.start.cross(axis);
    let area = (*lobe * axis).cross(*lobe * plane.cross(axis)).length() / plane.length();
    let width = tube.radius * lobe.determinant().abs() / area;
    let towards = plane.cross(axis) / plane.length();
    let reach = tube.radius * (*lobe * axis).length().hypot((*lobe * towards).length());
    width.max(reach) < 1e-2 * nearest(*lobe * tube.start, *lobe * tube.end)
        && tube.radius < 1e-2 * nearest(tube.start, tube.end)
}

#[test]
fn at_the_switch_nothing_jumps() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(97);
    for ends in ENDS {
        let mut pairs = Vec::new();
        for _ in 0..200 {
            let half = round(random.direction() * random.between(-2.0, 1.0).exp2());
            let center = round(random.direction());
            let tube = Tube { start: center - half, end: center + half, radius: 1.0, ends };
            // To a line
            let beside = distance(&tube).max(center.length() - half.length());
            let at = |share: f64| f64::from((1e-2 * beside * share) as f32);
            pairs.push(Tube { radius: at(1.0 - 1e-5), ..tube });
            pairs.push(Tube { radius: at(1.0 + 1e-5), ..tube });
        }
        let found = found(&engine, &pairs, &vec![DMat3::IDENTITY; pairs.len()]);
        let jumps = found.chunks_exact(2).map(|pair| (pair[0] - pair[1]).abs());
        let (largest, light) = (jumps.fold(0.0, f64::max), found.iter().fold(0.0, |a: f64, b| a.max(*b)));
        println!("{ends:?}: {largest:.1e} of {light:.1e}");
        // The line's error, some 1e-4 of form factors of up to 1e-2, and the outline's rounding
        assert!(largest < 1e-6 && light > 1e-3, "{ends:?}: {largest:e}");
    }
}

#[test]
fn a_capsule_shrinks_to_a_sphere() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(96);
    let mut comparison = Comparison::new("short capsules");
    let mut twin = 0;
    for exponent in [-2, -6, -10, -14, -18] {
        let tubes: Vec<_> = (0..100)
            .map(|_| {
                let center = round(random.direction());
                let half = round(random.direction() * f64::from(exponent).exp2());
                Tube { start: center - half, end: center + half, radius: 0.25, ends: Ends::Round }
            })
            .collect();
        for (tube, found) in tubes.iter().zip(found(&engine, &tubes, &vec![DMat3::IDENTITY; 100])) {
            let sphere = Sphere { center: (tube.start + tube.end) * 0.5, radius: tube.radius };
            // What the length adds, 2 r L / pi, and rounding: a short axis has a rounded direction
            let bound = 2e-6 + 0.4 * (tube.end - tube.start).length();
            comparison.add(found, sphere::form_factor(&sphere), bound, || format!("{tube:?}"));
            twin += usize::from(exponent == -2 && (found - sphere::form_factor(&sphere)).abs() > 1e-2);
        }
    }
    comparison.assert_all();
    assert!(twin > 20, "{twin} noticed");
    in_contact_a_tube_is_all_there_is(&engine);
}

/// A tube over a point sends no less than the sphere in it that is nearest, and no more than all there is: in
/// contact that is the same.
fn in_contact_a_tube_is_all_there_is(engine: &TestEngine) {
    let mut random = Random::new(97);
    for ends in ENDS {
        let mut tubes = Vec::new();
        for exponent in 1..20 {
            for _ in 0..10 {
                let distance = 1.0 + f64::from(-exponent).exp2();
                let (sin, cos) = random.between(0.0, 6.3).sin_cos();
                let axis = DVec3::new(cos, sin, 0.0);
                let [back, front] = [random.between(1.0, 4.0), random.between(1.0, 4.0)];
                let above = DVec3::Z * distance;
                tubes.push(Tube {
                    start: round(above - axis * back),
                    end: round(above + axis * front),
                    radius: 1.0,
                    ends,
                });
            }
        }
        let mut comparison = Comparison::new(format!("{ends:?} in contact"));
        let mut twin = 0;
        for (tube, found) in tubes.iter().zip(found(engine, &tubes, &vec![DMat3::IDENTITY; tubes.len()])) {
            let least = tube.start.z.powi(-2);
            // Near tubes are right to 1e-5
            comparison.add(found, found.clamp(least, 1.0), 1e-5, || format!("{tube:?}"));
            // The twin: one that is farther by half its radius
            twin += usize::from(
                (tube.start.z + 0.5).powi(-2) < least - 1e-5 && found > (tube.start.z + 0.5).powi(-2) + 1e-5,
            );
        }
        comparison.assert_all();
        assert!(twin > 150, "{ends:?}: {twin} noticed");
    }
}

#[test]
fn a_tube_that_passes_the_horizon_does_not_jump() {
    const STEPS: usize = 4000;
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(95);
    for ends in ENDS {
        let half = random.direction() * 0.4;
        let sweep: Vec<_> = (0..=STEPS)
            .map(|step| {
                let height = 1.6 * step as f64 / STEPS as f64 - 0.8;
                let (center, half) = (round(DVec3::new(0.7, 0.4, height)), round(half));
                Tube { start: center - half, end: center + half, radius: 0.25, ends }
            })
            .collect();
        let found = found(&engine, &sweep, &vec![DMat3::IDENTITY; sweep.len()]);
        assert!(found[0] < 1e-6 && found[STEPS] > 0.01);
        // The steps are small and the form factor is smooth but for a few kinks: float64 has them too
        let mut bends: Vec<_> =
            (1..STEPS).map(|i| ((found[i - 1] - 2.0 * found[i] + found[i + 1]).abs(), i)).collect();
        bends.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{ends:?}: {:.1e}, and the twentieth {:.1e}", bends[0].0, bends[20].0);
        assert!(bends[20].0 < 2e-6, "{ends:?}: {:e}", bends[20].0);
        for (_, place) in &bends[..20] {
            for i in place - 1..=place + 1 {
                let truth = form_factor(&sweep[i]);
                assert!((found[i] - truth).abs() < 2e-6, "{:?}: {} is not {truth}", sweep[i], found[i]);
            }
        }
        // The twin: a jump would be seen among them
        assert!(found[STEPS / 2] > 1e-3);
    }
}

#[test]
fn tubes_are_cut_by_the_surface_too() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(93);
    let (mut cut, mut hidden) = (0, 0);
    for ends in ENDS {
        for place in [Place::Generic, Place::Crossing, Place::Level, Place::EndOn] {
            let tubes = tubes(place, ends);
            let lobes: Vec<_> = (0..COUNT).map(|_| lobe(&mut random)).collect();
            let arguments: Vec<_> = tubes.iter().zip(&lobes).map(|(t, m)| tube_arguments(t, m)).collect();
            let one = found(&engine, &tubes, &lobes);
            let both = engine.tubes(true, &arguments, &ends_of(&tubes));
            let mut comparison = Comparison::new(format!("{ends:?}, {place:?}, both horizons"));
            for (i, (tube, lobe)) in tubes.iter().zip(&lobes).enumerate() {
                let at = |count| {
                    let outline = polygon::above_horizon(&tube.outline(count));
                    polygon::transformed_form_factor(lobe, &outline).abs()
                };
                let (coarse, fine) = (at(250), at(500));
                let truth = fine + (fine - coarse) / 3.0;
                // The outline's rounding, and where an arc of the polygon is cut, its third order
                comparison.add(both[i].into(), truth, 3e-6, || format!("{tube:?}, {lobe:?}"));
                cut += usize::from(one[i] - truth > 1e-4 && truth > 0.0);
                hidden += usize::from(one[i] > 1e-4 && truth == 0.0);
            }
            comparison.assert_all();
        }
    }
    // The twin: what the surface takes away
    assert!(cut > COUNT && hidden > COUNT / 4, "{cut} cut, {hidden} hidden");
}

/// Two tubes of whose arcs a lobe's horizon, or the surface's, leaves next to nothing: what is left is not
/// all of the outline.
#[test]
fn little_that_is_left_of_an_arc_is_not_all_of_it() {
    let Some(engine) = TestEngine::new() else { return };
    let tube = |center: [f32; 3], half: [f32; 3], radius: f32, ends| {
        let [center, half] = [center, half].map(|v| Vec3::from_array(v).as_dvec3());
        Tube { start: center - half, end: center + half, radius: radius.into(), ends }
    };
    // A capsule with an end level with the point
    let capsule = tube(
        [-0.309_477_99, -0.166_330_52, 0.139_532_1],
        [-0.144_608_15, 0.061_458_077, -0.051_516_157],
        0.305_959_16,
        Ends::Round,
    );
    let its_lobe = [
        [0.135_420_65, 0.519_707_86, -0.055_790_734],
        [0.837_793_47, 0.262_395_77, 0.032_552_28],
        [0.528_926_6, -0.548_682_3, -0.037_277_136],
    ];
    // A flat end, seen from within the infinite cylinder
    let cylinder = tube(
        [-0.563_797_06, -0.117_902_06, 0.004_105_331],
        [0.233_427_94, 0.035_748_426, -0.079_030_53],
        0.568_985_7,
        Ends::Flat,
    );
    let other_lobe = [
        [0.853_026_6, -0.002_211_806_1, 0.017_348_932],
        [-0.263_870_27, -0.692_020_06, 0.014_186_61],
        [0.450_242_2, -0.401_376_84, -0.024_554_955],
    ];
    let tubes = [capsule, cylinder];
    let lobes = [its_lobe, other_lobe].map(|columns| Mat3::from_cols_array_2d(&columns).as_dmat3());
    let arguments: Vec<_> = tubes.iter().zip(&lobes).map(|(t, m)| tube_arguments(t, m)).collect();
    let one = found(&engine, &tubes, &lobes);
    let both = engine.tubes(true, &arguments, &ends_of(&tubes));
    for (i, (tube, lobe)) in tubes.iter().zip(&lobes).enumerate() {
        let truth = transformed_form_factor(lobe, tube);
        assert!((one[i] - truth).abs() < 2e-6, "{tube:?}: {} is not {truth}", one[i]);
        let above = polygon::above_horizon(&tube.outline(1000));
        let truth = polygon::transformed_form_factor(lobe, &above).abs();
        assert!((f64::from(both[i]) - truth).abs() < 3e-6, "{tube:?}: {} is not {truth}", both[i]);
    }
    // The twin: all of the outline instead would be 5e-3 less, and 1
    assert!(one[0] > 1e-2 && both[1] < 1e-2);
}

#[test]
fn any_bits_give_a_form_factor() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(94);
    let mut arguments = Vec::new();
    for _ in 0..50_000 {
        let [tube, lobe] = [0; 2].map(|_| Numbers::choose(&mut random));
        arguments.push([tube, tube, lobe, lobe].map(|numbers| numbers.vector(&mut random)));
    }
    // Each with every kind of end
    let ends = [0, 1, 2].map(|kind| vec![ENDS[kind]; arguments.len()]).concat();
    let thrice = arguments.repeat(3);
    for cut in [false, true] {
        let found = engine.tubes(cut, &thrice, &ends);
        for (ends, found) in ENDS.iter().zip(found.chunks_exact(arguments.len())) {
            let wrong = found.iter().filter(|factor| factor.to_bits() > 1.0_f32.to_bits()).count();
            let partial = found.iter().filter(|factor| **factor > 0.0 && **factor < 1.0).count();
            println!("{ends:?}: {partial} between 0 and 1");
            assert_eq!(wrong, 0, "{ends:?}");
            // The twin: it is not that all are dark
            assert!(partial > 1000, "{partial}");
        }
    }
}
