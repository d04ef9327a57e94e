//! What the comments of the GLSL library state of single functions, held against float64 one function at a
//! time.

use arealight::table::{TableSample, mirror_frame};
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::ggx::Ggx;
use arealight_tests::kernel::Function;
use arealight_tests::prelude::*;

type Arguments = [[f32; 4]; 3];

fn wide(vector: [f32; 4]) -> DVec3 {
    DVec3::new(vector[0].into(), vector[1].into(), vector[2].into())
}

fn narrow(vector: DVec3, w: f64) -> [f32; 4] {
    [vector.x as f32, vector.y as f32, vector.z as f32, w as f32]
}

fn arguments(a: DVec3, w: f64, b: DVec3) -> Arguments {
    [narrow(a, w), narrow(b, 0.0), [0.0; 4]]
}

/// A unit view at this cosine to a unit normal.
fn view_at(random: &mut Random, normal: DVec3, cosine: f64) -> DVec3 {
    let aside = normal.any_orthonormal_vector();
    let (sin, cos) = random.between(0.0, TAU).sin_cos();
    let tangent = aside * cos + normal.cross(aside) * sin;
    normal * cosine + tangent * (1.0 - cosine * cosine).max(0.0).sqrt()
}

/// Normals and views of every kind.
fn frames() -> Vec<Arguments> {
    let mut random = Random::new(51);
    let mut frames = Vec::new();
    for index in 0..20_000 {
        let normal = random.direction();
        let near = 10.0_f64.powf(random.between(-8.0, -3.0));
        let grazing = 10.0_f64.powf(random.between(-8.0, -1.0));
        let cosine = random.between(-1.0, 1.0);
        let view = match index % 6 {
            0 => normal,
            1 => -normal,
            2 => (normal + random.direction() * near).normalize_or(normal),
            3 => view_at(&mut random, normal, grazing),
            4 => view_at(&mut random, normal, -grazing),
            _ => view_at(&mut random, normal, cosine),
        };
        // Lengths that float32 holds, and its denormal ones
        let length = |random: &mut Random| random.between(-140.0, 127.0).exp2();
        let (long, other) = (length(&mut random), length(&mut random));
        frames.push(if index % 2 == 0 {
            arguments(normal, 0.0, view)
        } else {
            arguments(normal * long, 0.0, view * other)
        });
    }
    let odd = [0.0, -0.0, 1.0, 1e-45, -3e38, f32::INFINITY, f32::NAN];
    for _ in 0..2000 {
        let mut pick = || odd[random.bits() as usize % odd.len()];
        frames.push([[pick(), pick(), pick(), 0.0], [pick(), pick(), pick(), 0.0], [0.0; 4]]);
    }
    frames
}

/// Whether `arealight_normalize_or` takes a vector for one.
fn is_vector(vector: DVec3) -> bool {
    let largest = vector.abs().max_element();
    vector.is_finite() && (1e-37..=3e38).contains(&largest)
}

/// How far a driver that takes denormal numbers for zero, as Vulkan allows, turns a vector at most.
fn flushed(vector: DVec3) -> f64 {
    2.0_f64.powi(-125) / vector.length()
}

#[test]
fn frames_are_orthonormal_whatever_comes_in() {
    let Some(engine) = TestEngine::new() else { return };
    let given = frames();
    let mut orthonormal = Comparison::new("frame: products of its axes");
    let mut view = Comparison::new("frame: cosine and sine of the view");
    let mut one_pass = Comparison::new("one pass of Gram and Schmidt");
    for (given, found) in given.iter().zip(engine.probe(Function::Frame, &given)) {
        let axes = [wide(found[0]), wide(found[1]), wide(found[2])];
        let place = || format!("{given:?}: {found:?}");
        for i in 0..3 {
            orthonormal.add(axes[i].length(), 1.0, 3e-7, place);
            orthonormal.add(axes[i].dot(axes[(i + 1) % 3]), 0.0, 3e-7, place);
        }
        orthonormal.add(axes[0].cross(axes[1]).dot(axes[2]), 1.0, 6e-7, place);
        let (normal, to_viewer) = (wide(given[0]), wide(given[1]));
        if is_vector(normal) && is_vector(to_viewer) {
            let exact = SurfaceFrame::new(normal, to_viewer);
            let direction = exact.view();
            // Three roundings of products of unit vectors, and the vectors' own; within 1e-6 of the normal
            // any tangent
            let rounding = if direction.x < 1.5e-6 { 1.5e-6 } else { 4e-7 };
            let bound = rounding + flushed(normal) + flushed(to_viewer);
            view.add(found[0][3].into(), exact.cos_view().clamp(0.0, 1.0), bound, place);
            view.add(found[1][3].into(), direction.x, bound, place);
            let (n, v) = (normal.as_vec3(), to_viewer.normalize_or(normal).as_vec3());
            let n = n.normalize_or(n);
            let tangent = (v - n * n.dot(v)).normalize_or(Vec3::X);
            one_pass.add(tangent.as_dvec3().dot(n.as_dvec3()), 0.0, 3e-7, String::new);
        }
    }
    orthonormal.assert_all();
    view.assert_all();
    assert!(one_pass.failures() > 500, "the twin: {} noticed", one_pass.failures());
}

#[test]
fn unit_vectors_and_scales_are_what_they_say() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(52);
    let given: Vec<Arguments> = (0..20_000)
        .map(|index| {
            let length = random.between(-122.0, 126.0).exp2();
            let number = f32::from_bits(random.bits() & 0x7fff_ffff);
            // Near an axis its largest component is nearly all of it, and over itself less than 1 where
            // divisions round as coarsely as Vulkan allows
            let others = if index % 4 == 0 { DVec3::new(1e-5, 1.0, 1e-6) } else { DVec3::ONE };
            let direction = random.direction() * random.direction().abs() * others;
            [narrow(direction * length, number.into()), [0.0, 0.0, 1.0, 0.0], [0.0; 4]]
        })
        .collect();
    let mut length = Comparison::new("normalize_or: length");
    let mut direction = Comparison::new("normalize_or: direction");
    let mut twin = Comparison::new("normalize_or, of the next vector");
    let found = engine.probe(Function::Common, &given);
    let next = found.iter().cycle().skip(1);
    for ((given, found), next) in given.iter().zip(&found).zip(next) {
        let (vector, unit) = (wide(given[0]), wide(found[0]));
        if is_vector(vector) {
            let exact = vector.normalize_or_zero();
            length.add(unit.length(), 1.0, 2e-7, || format!("{given:?}: {found:?}"));
            direction
                .add(unit.distance(exact), 0.0, 3e-7 + flushed(vector), || format!("{given:?}: {found:?}"));
            twin.add(wide(next[0]).distance(exact), 0.0, 3e-7, String::new);
        }
        // The exponent alone is left, negated; that of what is outside [2^-123, 2^124) is clamped
        let exponent = (given[0][3].to_bits() >> 23).clamp(4, 250);
        assert_eq!(found[0][3].to_bits(), (254 - exponent) << 23, "{:e}", given[0][3]);
    }
    length.assert_all();
    direction.assert_all();
    assert!(twin.failures() > 10_000);
    // Zero and what is not finite give the fallback
    let odd =
        [[0.0; 3], [f32::NAN, 1.0, 0.0], [1.0, f32::INFINITY, 0.0], [1.0, 0.0, f32::NAN], [1e-40, 0.0, 0.0]];
    let given: Vec<Arguments> =
        odd.iter().map(|v| [[v[0], v[1], v[2], 1.0], [0.0, 0.6, 0.8, 0.0], [0.0; 4]]).collect();
    for (odd, found) in odd.iter().zip(engine.probe(Function::Common, &given)) {
        assert_eq!(found[0][..3], [0.0, 0.6, 0.8], "{odd:?}");
    }
}

fn largest_entry(matrix: &DMat3) -> f64 {
    matrix.to_cols_array().iter().fold(0.0, |largest, entry| entry.abs().max(largest))
}

#[test]
fn the_table_is_looked_up_as_in_float64() {
    let Some(engine) = TestEngine::new() else { return };
    let table = LightTable::ggx();
    let mut random = Random::new(53);
    let given: Vec<Arguments> = (0..20_000)
        .map(|index| {
            let cos_view = match index % 4 {
                0 => 10.0_f64.powf(random.between(-7.0, 0.0)),
                1 => 1.0 - 10.0_f64.powf(random.between(-9.0, 0.0)),
                2 => f64::from(random.bits() % 65).mul_add(-1.0 / 64.0, 1.0),
                _ => random.unit(),
            };
            let view = DVec3::new((1.0 - cos_view * cos_view).max(0.0).sqrt(), 0.0, cos_view);
            arguments(DVec3::Z, random.between(0.0, 1.0), view)
        })
        .collect();
    let mut entries = Comparison::new("lookup: entries over the largest");
    let mut rows = Comparison::new("lookup: beyond that, over their row's length, in units of 2^-24");
    let mut albedo = Comparison::new("lookup: albedo and Schlick part");
    let mut twin = Comparison::new("lookup at a roughness 1e-5 off");
    for (given, found) in given.iter().zip(engine.probe(Function::Table, &given)) {
        let frame = SurfaceFrame::new(DVec3::Z, wide(given[1]));
        let sample = table.lookup(given[0][3].into(), frame.cos_view());
        let other = table.lookup(f64::from(given[0][3]) + 1e-5, frame.cos_view());
        let found_transform = DMat3::from_cols(wide(found[0]), wide(found[1]), wide(found[2]));
        let largest = largest_entry(&sample.inverse);
        let off = |exact: &DMat3| largest_entry(&(found_transform - *exact)) / largest;
        // As stated: 4e-7, and the axes' roundings, three units of 2^-24 in all; twice both where an inverse
        // square root is as coarse as Vulkan allows
        let coarse = if engine.rounds_as_oracle() { 1.0 } else { 2.0 };
        let unit = coarse * 3.0 * 2.0_f64.powi(-24);
        let texel = |roughness: f64, axis: f64| {
            let sample = table.lookup(roughness, 1.0 - axis);
            // In the mirror frame of the given view, whatever the axis
            sample.inverse * mirror_frame(1.0 - axis) * mirror_frame(frame.cos_view()).transpose()
        };
        let (roughness, axis) = (f64::from(given[0][3]).max(0.01), 1.0 - frame.cos_view().clamp(0.0, 1.0));
        let moved = [texel(roughness * (1.0 - unit), axis), texel(roughness, axis * (1.0 - 2.0 * unit))];
        let reach = moved.iter().map(|moved| largest_entry(&(*moved - sample.inverse))).fold(0.0, f64::max);
        entries.add(off(&sample.inverse), 0.0, coarse * 4e-7 + reach / largest, || {
            format!("{given:?}: {found:?}")
        });
        twin.add(off(&other.inverse), 0.0, 4e-7, String::new);
        for row in 0..3 {
            let (found, exact) = (found_transform.row(row), sample.inverse.row(row));
            let reach: f64 = moved.iter().map(|moved| moved.row(row).distance(exact)).sum();
            let units = (found.distance(exact) - reach).max(0.0) / exact.length() * 2.0_f64.powi(24);
            // What arealight_tests::lobe takes for granted
            rows.add(units, 0.0, 8.0, || format!("{given:?}, row {row}: {found:?}"));
        }
        let reach = |part: fn(&TableSample) -> f64| {
            let cosine = 1.0 - axis * (1.0 - 2.0 * unit);
            let moved = [table.lookup(roughness * (1.0 - unit), 1.0 - axis), table.lookup(roughness, cosine)];
            coarse * 4e-7 + moved.iter().map(|moved| (part(moved) - part(&sample)).abs()).sum::<f64>()
        };
        albedo
            .add(found[0][3].into(), sample.albedo, reach(|s| s.albedo), || format!("{given:?}: {found:?}"));
        albedo.add(found[1][3].into(), sample.schlick, reach(|s| s.schlick), || {
            format!("{given:?}: {found:?}")
        });
    }
    let noticed = twin.failures();
    for comparison in [entries, rows, albedo] {
        comparison.assert_all();
    }
    assert!(noticed > 10_000, "the twin: {noticed} noticed");
}

#[test]
fn ggx_is_that_of_the_oracle() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(54);
    let given: Vec<Arguments> = (0..20_000)
        .map(|index| {
            let alpha = 10.0_f64.powf(random.between(-4.0, 0.0));
            let cosine =
                if index % 3 == 0 { 10.0_f64.powf(random.between(-6.0, 0.0)) } else { random.unit() };
            let view = view_at(&mut random, DVec3::Z, cosine);
            let u = [random.unit(), random.unit()];
            // Where the lobe is, or anywhere
            let drawn = Ggx { alpha }.sample(view, u);
            let light = if index % 2 == 0 { drawn } else { random.direction() };
            let mut given = arguments(view, alpha, light);
            given[2] = [u[0] as f32, u[1] as f32, 0.0, 0.0];
            given
        })
        .collect();
    let mut distribution = Comparison::new("ggx_distribution, relative, of the half vector given");
    let mut evaluate = Comparison::new("ggx_evaluate, relative");
    let mut density = Comparison::new("ggx_density, relative");
    let mut visibility = Comparison::new("ggx_visibility, relative");
    let mut samples = Comparison::new("ggx_sample");
    let mut twin = Comparison::new("ggx_evaluate at an alpha 1 % off");
    for (given, found) in given.iter().zip(engine.probe(Function::Ggx, &given)) {
        let place = || format!("{given:?}: {found:?}");
        let (view, light, alpha) = (wide(given[0]), wide(given[1]), f64::from(given[0][3]));
        let lobe = Ggx { alpha };
        // A relative error of the numbers that there are; what is below 1e-30 is none
        let relative = |comparison: &mut Comparison, found: f32, exact: f64, bound: f64| {
            if exact > 1e-30 {
                comparison.add(f64::from(found) / exact, 1.0, bound, place);
            }
        };
        let half = wide(found[1]);
        relative(&mut distribution, found[1][3], lobe.distribution(half), 1e-6);
        // As `arealight_ggx_distribution` says
        let rounding = if alpha >= 1e-3 { 1e-5 } else { 1e-3 };
        let weight = Ggx::schlick_weight(view, light);
        let fresnel = 0.04 + (0.9 - 0.04) * weight;
        relative(&mut evaluate, found[0][0], fresnel * lobe.evaluate(view, light), rounding);
        relative(
            &mut twin,
            found[0][0],
            fresnel * Ggx { alpha: 1.01 * alpha }.evaluate(view, light),
            rounding,
        );
        relative(&mut density, found[0][3], lobe.density(view, light), rounding);
        if light.z > 0.0 {
            relative(&mut visibility, found[2][3], lobe.visibility(view.z, light.z), 1e-6);
        }
        let drawn = lobe.sample(view, [given[2][0].into(), given[2][1].into()]);
        // Sine and cosine are good to 2^-11 in Vulkan; drivers do better than that by far
        samples.add(wide(found[2]).distance(drawn), 0.0, 2e-3, place);
        if light.z <= 0.0 {
            assert_eq!([found[0][0], found[0][3]], [0.0; 2], "{given:?}");
        }
    }
    let noticed = twin.failures();
    for comparison in [distribution, evaluate, density, visibility, samples] {
        comparison.assert_all();
    }
    assert!(noticed > 1000, "the twin: {noticed} noticed");
}

/// The arc from a to b, directions of any length.
fn arc(a: DVec3, b: DVec3) -> f64 {
    let normal = a.cross(b);
    normal.length().atan2(a.dot(b)) * normal.normalize_or_zero().z
}

#[test]
fn arcs_are_what_they_say() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(55);
    let mut given = Vec::new();
    for index in 0..40_000 {
        let a = random.direction();
        let gap = 10.0_f64.powf(random.between(-7.0, 0.0));
        let b = match index % 3 {
            0 => random.direction(),
            1 => a + random.direction() * gap,
            // No nearer to the antipode than where the plane of the edge is good to a part in ten thousand
            _ => -a + random.direction() * gap.max(2e-3),
        };
        let length = random.between(-20.0, 20.0).exp2();
        if a.dot(b.normalize_or(b)) > 2e-6 - 1.0 {
            given.push(arguments(a * length, 0.0, b * length));
        }
    }
    let mut arcs = Comparison::new("arc");
    let mut twin = Comparison::new("an arc a thousandth too long");
    let mut horizon = Comparison::new("crossing of the horizon");
    for (given, found) in given.iter().zip(engine.probe(Function::Arc, &given)) {
        let place = || format!("{given:?}: {found:?}");
        let (a, b) = (wide(found[0]), wide(found[1]));
        let exact = arc(a, b);
        // Eight units of 2^-24 of the angle, or of a radian: the two unit vectors, their sum and its length,
        // the cross product, the quotient. (3.6e-7 was stated once; a second 20,000 arcs have 4.6e-7, between
        // nearly opposite ends.)
        let bound = 5e-7 * a.cross(b).length().atan2(a.dot(b)).max(1.0);
        arcs.add(found[0][3].into(), exact, bound, place);
        twin.add(f64::from(found[0][3]) * 1.001, exact, bound, String::new);
        if (a.z > 0.0) != (b.z > 0.0) {
            // Each product and the unit vector are rounded: three units of 2^-24, over the sine of the angle
            // between the ends' directions within the horizon's plane
            let crossing = (b * a.z.abs() + a * b.z.abs()).with_z(0.0);
            let bound = 4.0 * 2.0_f64.powi(-24) * (1.0 + (a.z.abs() + b.z.abs()) / crossing.length());
            let found = wide(found[2]);
            horizon.add(found.distance(crossing.normalize_or_zero()), 0.0, bound, place);
            assert_eq!(found.z, 0.0);
        }
    }
    let noticed = twin.failures();
    for comparison in [arcs, horizon] {
        comparison.assert_all();
    }
    assert!(noticed > 10_000, "the twin: {noticed} noticed");
}

/// Rays that leave a floor of any tilt and size, out to 200 times the viewer's height, start above it; where
/// positions are wrong by a step, too.
#[test]
fn shadow_rays_start_above_the_surface_that_they_leave() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(91);
    let (mut given, mut planes) = (Vec::new(), Vec::new());
    for index in 0..20_000 {
        // A point of the plane at a height of -1.5, rounded; moved by up to `step` away from it
        let normal = wide(narrow(random.direction(), 0.0));
        let tangent = normal.cross(random.direction()).normalize_or_zero();
        let scale = [1.0, 1e-6, 1e4][index % 3];
        let distance = scale * 10.0_f64.powf(random.between(-3.0, 2.5));
        let step = if index % 2 == 0 { 0.0 } else { 1e-4 * distance };
        let point = tangent * distance - normal * scale * 1.5;
        let moved = point + random.direction() * step * 0.99;
        given.push([narrow(moved, 0.0), narrow(normal, step), [0.0; 4]]);
        planes.push((normal.normalize_or_zero(), point, step));
    }
    let found = engine.probe(Function::RayOrigin, &given);
    let mut below = 0;
    for ((arguments, found), (normal, point, step)) in given.iter().zip(&found).zip(&planes) {
        let position = wide(arguments[0]);
        let height = normal.dot(wide(found[0]) - *point);
        assert!(height > 0.0, "{height:e} above the plane at {position}");
        // 2^-16 of the largest coordinate, two steps, and half a unit in each last place of the sum
        let largest = position.abs().max_element();
        let bound = (2.0_f64.powi(-16) + 2.0_f64.powi(-23)) * largest + 2.0 * step;
        let moved = wide(found[0]).distance(position);
        assert!(moved <= bound, "{moved:e} from {position}");
        below += usize::from(normal.dot(position - *point) < 0.0);
    }
    // The twin: of the positions themselves half are below
    assert!(below > 8_000 && below < 12_000, "{below}");
}
