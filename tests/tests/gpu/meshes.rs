//! Meshes of emitters, several faces that are one light: against their faces, against spheres that they are
//! nearly, in frames and against the Monte Carlo reference.

use arealight_tests::Path;
use arealight_tests::frame::black;
use arealight_tests::globe::icosphere;
use arealight_tests::lobe::{Lobe, Seen};
use arealight_tests::prelude::*;
use glam::DAffine3;

const SIZE: [u32; 2] = [64, 36];

/// A mesh of three outlines at random places of one region: convex and concave, to the front and the back,
/// some cut by the horizon.
fn mesh(random: &mut Random, two_sided: bool) -> Light {
    let center = random.direction() * random.between(1.0, 3.0);
    let mut light = point(lambert_surface(), DVec3::Z, Vec::new(), two_sided).light;
    for number in 0..3 {
        let place = center + random.direction() * 0.5;
        let mut outline = random.polygon(place, 3 + number, 0.1, 0.8);
        if random.unit() < 0.25 {
            outline.reverse();
        }
        light.shape.add_face(&outline);
    }
    light
}

/// Each face as a light of its own. In all they send what the light does.
fn split(light: &Light) -> Vec<Light> {
    let face = |outline: &[DVec3]| Light { shape: LightShape::Polygon(outline.to_vec()), ..light.clone() };
    light.shape.outlines().map(face).collect()
}

/// A point that sees a mesh, and then one for each of its faces.
fn group(random: &mut Random, glossy: bool, two_sided: bool) -> Vec<EvalPoint> {
    let light = mesh(random, two_sided);
    let (surface, view) = if glossy {
        let view = random.direction();
        (glossy_surface(random.between(0.1, 1.0)), view.with_z(view.z.abs()))
    } else {
        (lambert_surface(), DVec3::Z)
    };
    let seen = |light: Light| EvalPoint { light, ..point(surface, view, Vec::new(), two_sided) };
    [vec![light.clone()], split(&light)].concat().into_iter().map(seen).collect()
}

/// That meshes send the sum of what their faces do, by some levels.
fn assert_sums(engine: &TestEngine, table: Option<&LightTable>, levels: &[Level]) {
    let mut random = Random::new(401);
    let groups: Vec<Vec<EvalPoint>> =
        (0..200).map(|index| group(&mut random, table.is_some(), index % 2 == 0)).collect();
    let given = Cases::new(&groups.concat());
    let lobes = if table.is_some() { Effects::GLOSSY } else { Effects::DIFFUSE };
    for &level in levels {
        let factors = engine.factors(&given, lobes, level);
        let mut comparison = Comparison::new(format!("meshes and their faces, {level}"));
        let mut without = Comparison::new("without the last face");
        for (number, found) in factors.chunks_exact(4).enumerate() {
            let bounds = (1..4).map(|face| {
                let case = 4 * number + face;
                let surface = &given.cases[case];
                let lobe = table.map_or_else(|| Lobe::lambert(surface), |table| Lobe::glossy(table, surface));
                Seen::new(&given, case, lobe, level.quality.horizon).judge().bound()
            });
            // A face may err by its bound, and as part of the mesh by as much for being given from a center
            // that is twice as far from it
            let bound = 3.0 * bounds.sum::<f64>();
            let sum: f64 = found[1..].iter().sum();
            // What overlaps in the view of the lobe is no more than all there is
            comparison.add(found[0], sum.min(1.0), bound, || format!("group {number}: {found:?}"));
            without.add(found[0], sum - found[3], bound, String::new);
        }
        comparison.assert_all();
        assert!(without.failures() > 60, "a face that is left out is noticed: {}", without.failures());
    }
}

#[test]
fn a_mesh_sends_what_its_faces_do() {
    let Some(engine) = TestEngine::new() else { return };
    let all = Level::of(&[Path::Mesh], &[Horizon::Cosine]);
    assert_sums(&engine, None, &all);
    let twice = Level::of(&[Path::Mesh], &[Horizon::Both]);
    assert_sums(&engine, Some(&TABLE), &[all[0], twice[0]]);
    faces_in_front_alone_count(&engine, all[0]);
    any_bits_give_a_form_factor(&engine, all[0]);
    far_meshes_keep_relative_precision(&engine, all[0]);
}

/// A one-sided cube around the point is dark, a two-sided one is all there is; the polygon kernel alone takes
/// the cube for one outline.
fn faces_in_front_alone_count(engine: &TestEngine, level: Level) {
    let cube = |two_sided| EvalPoint {
        light: Light { two_sided, ..cube(DVec3::new(0.1, 0.2, 0.3), 1.0) },
        ..point(lambert_surface(), DVec3::Z, Vec::new(), two_sided)
    };
    let given = Cases::new(&[cube(false), cube(true)]);
    let found = engine.factors(&given, Effects::DIFFUSE, level);
    // Five faces reach above the horizon; each errs by 6e-7
    assert!(found[0] == 0.0 && (found[1] - 1.0).abs() <= 3e-6, "{found:?}");
    let mut unmarked = given;
    unmarked.vertices.iter_mut().for_each(|vertex| vertex[3] = 0.0);
    let found = engine.factors(&unmarked, Effects::DIFFUSE, level);
    assert!((found[1] - 1.0).abs() > 0.1, "{found:?}");
}

/// Whatever is said of the faces: [`TestEngine::factors`] asserts that it is in [0, 1].
fn any_bits_give_a_form_factor(engine: &TestEngine, level: Level) {
    let mut random = Random::new(402);
    let points: Vec<EvalPoint> = (0..512).map(|_| group(&mut random, false, true).swap_remove(0)).collect();
    let mut given = Cases::new(&points);
    for (index, vertex) in given.vertices.iter_mut().enumerate() {
        vertex[3] = if index % 3 == 0 { f32::from_bits(random.bits()) } else { (random.bits() % 5) as f32 };
        if index % 7 == 0 {
            vertex[index % 3] = f32::from_bits(random.bits());
        }
    }
    assert_eq!(engine.factors(&given, Effects::DIFFUSE, level).len(), 512);
}

/// A closed mesh far away, whose area vector is zero, sends what its projected area does.
fn far_meshes_keep_relative_precision(engine: &TestEngine, level: Level) {
    let center = DVec3::new(3e2, 1e2, 9e2);
    let light = Light { radiance: Vec3::ONE, ..cube(center, 1.0) };
    let given = Cases::new(&[EvalPoint { light, ..point(lambert_surface(), DVec3::Z, Vec::new(), false) }]);
    let found = engine.factors(&given, Effects::DIFFUSE, level)[0];
    let direction = center.normalize_or_zero();
    // Its projected area, at the distance of the center: (2 / 950)^2 off
    let expected = 4.0 * (direction.x + direction.y + direction.z) * direction.z
        / center.length_squared()
        / std::f64::consts::PI;
    assert!((found / expected - 1.0).abs() < 1e-5, "{found:e}, {expected:e}");
}

/// A cube of side 2 `half` that shines outwards.
fn cube(center: DVec3, half: f64) -> Light {
    let mut light = Light { name: "cube".into(), radiance: Vec3::ONE, ..Light::default() };
    for n in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
        let u = n.any_orthonormal_vector();
        let v = n.cross(u);
        light.shape.add_face(&[-u - v, u - v, u + v, v - u].map(|corner| center + (n + corner) * half));
    }
    light
}

/// A mesh between two spheres sends no less than the inner one and no more than the outer one, before any
/// lobe: so it is a sphere to the square of the two radii's ratio.
#[test]
fn an_icosphere_is_a_sphere_to_the_error_of_its_faces() {
    let Some(engine) = TestEngine::new() else { return };
    let (corners, triangles) = icosphere(2);
    assert_eq!(triangles.len(), 320);
    let inner = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
            (b - a).cross(c - a).normalize_or_zero().dot(a)
        })
        .fold(1.0, f64::min);
    assert!((0.98..0.99).contains(&inner), "{inner}");
    let mut random = Random::new(403);
    let (mut meshes, mut spheres) = (Vec::new(), Vec::new());
    for index in 0..64 {
        // Half of the points see a mirror-coloured surface; many spheres are cut by the horizon
        let surface =
            if index % 2 == 0 { lambert_surface() } else { glossy_surface(random.between(0.2, 1.0)) };
        let view = random.direction();
        let view = view.with_z(view.z.abs());
        let radius = random.between(0.1, 1.0);
        let center = random.direction() * (radius * random.between(1.1, 4.0));
        let center = if center.z < -radius { -center } else { center };
        let placed: Vec<DVec3> = corners.iter().map(|corner| center + *corner * radius).collect();
        let shape = LightShape::from_triangles(&placed, &triangles).expect("a mesh");
        let light = Light { radiance: Vec3::ONE, shape, ..Light::default() };
        meshes.push(EvalPoint { light, ..point(surface, view, Vec::new(), false) });
        for radius in [radius * inner, radius] {
            let shape = LightShape::Sphere { center, radius };
            let light = Light { radiance: Vec3::ONE, shape, ..Light::default() };
            spheres.push(EvalPoint { surface, position: DVec3::ZERO, normal: DVec3::Z, view, light });
        }
    }
    let quality = Quality::default();
    let found = engine.eval(&meshes, quality).expect("meshes");
    let bounds = engine.eval(&spheres, quality).expect("spheres");
    let mut comparison = Comparison::new("icospheres between two spheres");
    let mut outside = 0;
    for (index, (found, bounds)) in found.iter().zip(bounds.chunks_exact(2)).enumerate() {
        let [found, least, most] = [found, &bounds[0], &bounds[1]].map(|radiance| f64::from(radiance.x));
        // A sum of 160 triangles' arcs, each of which rounds as much as one light's
        let bound = 10.0 * rounding(meshes[index].surface.alpha);
        comparison.add(found, found.clamp(least, most), bound, || format!("case {index}: {least} to {most}"));
        // The twin: spheres that are smaller by as much again
        outside += usize::from(found > least + bound);
    }
    comparison.assert_all();
    assert!(outside > 32, "most send more than the sphere inside: {outside}");
}

/// The tube of `sides` sides about a bent line, closed, of triangles.
fn bent_tube(sides: u32) -> LightShape {
    let rings = 60;
    let mut corners = Vec::new();
    for ring in 0..rings {
        let t = 0.05 * f64::from(ring);
        let along = DVec3::new(-2.0 * (2.0 * t).sin(), 3.0 * (3.0 * t).cos(), 1.0).normalize_or_zero();
        let (u, v) = along.any_orthonormal_pair();
        let center = DVec3::new((2.0 * t).cos(), (3.0 * t).sin(), t - 1.5) * 0.5;
        let turn = |side: u32| TAU * f64::from(side) / f64::from(sides);
        corners.extend((0..sides).map(|side| center + (u * turn(side).cos() + v * turn(side).sin()) * 0.03));
    }
    let quads = (0..rings - 1).flat_map(|ring| {
        (0..sides).flat_map(move |side| {
            let next = (side + 1) % sides;
            let [a, b] = [ring * sides + side, ring * sides + next];
            [[a, b, b + sides], [a, b + sides, a + sides]]
        })
    });
    LightShape::from_triangles(&corners, &quads.collect::<Vec<_>>()).expect("a tube")
}

/// What a mesh sends by clusters of an error and without, of random places and lobes in a unit of length: the
/// worst and the mean of the relative errors, and how many points see no cluster.
fn clustered_errors(engine: &TestEngine, shape: &LightShape, error: f64, unit: f64) -> (f64, f64, usize) {
    let mut random = Random::new(405);
    let (mut exact, mut clustered) = (Vec::new(), Vec::new());
    let with_clusters = shape.clone().clustered(error);
    for index in 0..512 {
        let surface =
            if index % 2 == 0 { lambert_surface() } else { glossy_surface(random.between(0.2, 1.0)) };
        let direction = random.direction();
        let place = direction.with_z(direction.z.abs()) * 10.0_f64.powf(random.between(0.1, 1.5));
        let view = -direction.with_z(-direction.z.abs()) + random.direction() * 0.5;
        let view = view.with_z(view.z.abs());
        for (points, shape) in [(&mut exact, shape), (&mut clustered, &with_clusters)] {
            let shape =
                shape.moved(&(DAffine3::from_scale(DVec3::splat(unit)) * DAffine3::from_translation(place)));
            let light = Light { radiance: Vec3::ONE, shape, ..Light::default() };
            points.push(EvalPoint { light, ..point(surface, view, Vec::new(), index % 4 < 2) });
        }
    }
    let quality = Quality::default();
    let [exact, clustered] = [exact, clustered].map(|points| engine.eval(&points, quality).expect("meshes"));
    let errors = exact.iter().zip(&clustered).map(|(exact, found)| {
        let [exact, found] = [exact, found].map(|radiance| f64::from(radiance.x));
        (found - exact).abs() / exact.max(1e-6)
    });
    let errors: Vec<f64> = errors.collect();
    let same = errors.iter().filter(|error| **error == 0.0).count();
    (errors.iter().copied().fold(0.0, f64::max), errors.iter().sum::<f64>() / 512.0, same)
}

#[test]
fn clusters_send_what_their_faces_do() {
    let Some(engine) = TestEngine::new() else { return };
    let (corners, triangles) = icosphere(3);
    let globe = LightShape::from_triangles(&corners, &triangles).expect("a mesh");
    for (name, shape) in [("globe", globe), ("tube", bent_tube(8))] {
        for (error, unit) in [(0.02, 1.0), (0.05, 1.0), (0.05, 1e-12), (0.05, 1e12)] {
            let (worst, mean, same) = clustered_errors(&engine, &shape, error, unit);
            println!("{name}, {error}: worst {worst:.4}, mean {mean:.5}, {same} of 512 the same");
            // The error is the root of a mean square over directions: a tube's end errs by more
            assert!(
                worst < 4.0 * error && mean < 0.2 * error && same < 128,
                "{name}: {worst}, {mean}, {same}"
            );
        }
        // The twins: clusters that may be anything, and none
        let (worst, mean, _) = clustered_errors(&engine, &shape, 10.0, 1.0);
        assert!(worst > 0.05 && mean > 0.01, "{name}: {worst}, {mean}");
        assert_eq!(clustered_errors(&engine, &shape, 0.0, 1.0), (0.0, 0.0, 512));
    }
}

/// What a scene's surfaces show of lights.
fn shaded(engine: &TestEngine, scene: &Scene, lights: &[Light]) -> Vec<[f32; 4]> {
    with_renderer(engine, scene, lights, SIZE, |renderer| {
        renderer.shade(Effects::DIFFUSE | Effects::GLOSSY, Quality::default()).expect("it shades");
        renderer.radiance().expect("radiance").into_iter().map(|texel| texel.to_array()).collect()
    })
}

/// The mean of the first channel by the reference.
fn sampled(engine: &TestEngine, scene: &Scene, lights: &[Light]) -> f64 {
    with_renderer(engine, scene, lights, SIZE, |renderer| {
        let reference = Reference { samples: 32, coupled: false, ..Reference::default() };
        renderer.reference(reference, |_| ()).expect("it samples");
        let texels = renderer.radiance().expect("radiance");
        texels.iter().map(|texel| f64::from(texel.x)).sum::<f64>() / texels.len() as f64
    })
}

#[test]
fn a_mesh_is_one_light_of_a_frame() {
    let Some(engine) = TestEngine::new() else { return };
    // The surfaces alone: the camera sees no light
    let scene = black(&scene("sweep.glb"));
    let place = scene.lights[0].shape.center();
    let (mesh, apart) = ([cube(place, 0.4)], split(&cube(place, 0.4)));
    let [one, six, five] = [&mesh[..], &apart, &apart[1..]].map(|lights| shaded(&engine, &scene, lights));
    let brightest = six.iter().map(|texel| texel[0]).fold(0.0, f32::max);
    let apart_by = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        let differences = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs());
        f64::from(differences.fold(0.0, f32::max)) / f64::from(brightest)
    };
    // Six faces by two lobes
    assert!(brightest > 0.0 && apart_by(&one, &six) < 12.0 * 1e-6 / 0.05, "{}", apart_by(&one, &six));
    assert!(apart_by(&one, &five) > 1e-2, "{}", apart_by(&one, &five));

    // The reference draws points of all faces, and meets all of them
    let [one, six, five] = [&mesh[..], &apart, &apart[1..]].map(|lights| sampled(&engine, &scene, lights));
    println!("reference: mesh {one}, faces {six}, five of them {five}");
    assert!((one / six - 1.0).abs() < 0.02, "{one}, {six}");
    assert!((one / five - 1.0).abs() > 0.05, "{one}, {five}");
}
