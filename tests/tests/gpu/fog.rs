//! Points in a medium under lights of every kind: against the reference, the float64 twin, and what must be
//! so.

use arealight::{Opening, Profile};
use arealight_benches::pictures;
use arealight_cases::answers::read_answers;
use arealight_cases::cases::{SupportedCase, read_cases};
use arealight_engine::MediumPoint;
use arealight_oracle::phase::{MAX_ANISOTROPY, henyey_greenstein};
use arealight_oracle::shading::{in_scattered, in_scattered_truth, shape_in_scattered, shape_seen_from};
use arealight_tests::kernel::Function;
use arealight_tests::prelude::*;
use std::collections::HashMap;
use std::f64::consts::PI;

const CASES: &str = include_str!("../../data/reference/media.json");
const TRUTH: &str = include_str!("../../data/reference/media-truth.json");

/// Four form factors of 1e-6 and their weights' sizes.
const ROUNDING: f64 = 3e-6;

fn light(shape: LightShape) -> Light {
    Light { radiance: Vec3::ONE, shape, ..Light::default() }
}

fn point(anisotropy: f64, view: DVec3, light: Light) -> MediumPoint {
    MediumPoint { anisotropy, position: DVec3::ZERO, view, light }
}

/// The float64 twin of a point.
fn twin(point: &MediumPoint) -> f64 {
    let MediumPoint { anisotropy, position, view, light } = point;
    if matches!(light.shape, LightShape::Polygon(_)) {
        return in_scattered(*anisotropy, *view, &RelativeLight::new(light, *position)).x;
    }
    shape_in_scattered(*anisotropy, *view, &shape_seen_from(light, *position)).unwrap().x
}

/// The phase function's integrals over lights of unit radiance.
fn found(engine: &TestEngine, points: &[MediumPoint]) -> Vec<f64> {
    engine.eval_medium(points, Quality::default()).unwrap().iter().map(|v| f64::from(v.x)).collect()
}

/// RMSE over mean of a family of cases whose anisotropy is changed.
fn relative(
    engine: &TestEngine,
    cases: &[&SupportedCase],
    known: &HashMap<String, [f64; 3]>,
    g: impl Fn(f64) -> f64,
) -> f64 {
    let points: Vec<_> = cases.iter().map(|c| point(g(c.medium.unwrap()), c.view, c.light.clone())).collect();
    let (mut square, mut mean) = (0.0, 0.0);
    for (case, found) in cases.iter().zip(engine.eval_medium(&points, Quality::default()).unwrap()) {
        let truth = DVec3::from(known[&case.name]);
        square += (found.as_dvec3() - truth).length_squared();
        mean += truth.element_sum();
    }
    let count = 3.0 * cases.len() as f64;
    (square / count).sqrt() / (mean / count)
}

#[test]
fn the_reference_is_met_by_family() {
    let Some(engine) = TestEngine::new() else { return };
    let known: HashMap<String, [f64; 3]> =
        read_answers(TRUTH).unwrap().into_iter().map(|a| (a.name, a.radiance.unwrap())).collect();
    let cases: Vec<SupportedCase> = read_cases(CASES)
        .unwrap()
        .iter()
        .map(|case| case.supported(|path| panic!("{path}")).unwrap())
        .collect();
    let mut families: HashMap<&str, Vec<&SupportedCase>> = HashMap::new();
    for case in &cases {
        families.entry(case.name.split_once('_').unwrap().1).or_default().push(case);
    }
    let mut names: Vec<_> = families.keys().copied().collect();
    names.sort_unstable();
    for name in names {
        let of = |g: &dyn Fn(f64) -> f64| relative(&engine, &families[name], &known, g);
        let (error, turned, even) = (of(&|g| g), of(&|g| -g), of(&|_| 0.0));
        println!("{name}: {error:.4} of {} cases; turned {turned:.2}, even {even:.2}", families[name].len());
        // What the fit promises of its range
        let bound = if name.ends_with("high") { 0.02 } else { 0.01 };
        assert!(error <= bound, "{name}: {error}");
        // The twins: light that goes on to the other side, and to all alike
        assert!(turned > 3.0 * bound && even > 3.0 * bound, "{name}: {turned}, {even}");
    }
}

/// A light of a kind at some place, seen from the front.
fn any_light(random: &mut Random, kind: usize) -> Light {
    // All of a light is on the other side of its opening
    let center = random.direction() * random.between(if kind == 8 { 3.0 } else { 0.6 }, 6.0);
    let (u, v) = random.direction().any_orthonormal_pair();
    let mut size = |most: f64| random.between(0.1, most);
    let mut lamp = light(match kind {
        0 => {
            let (u, v) = (u * size(1.5), v * size(1.5));
            LightShape::Disk { center, axis_u: u, axis_v: v + 0.2 * u }
        }
        1 => LightShape::Sphere { center, radius: size(0.5) },
        2..5 => {
            let ends = [TubeEnds::Open, TubeEnds::Flat, TubeEnds::Round][kind - 2];
            let (half, radius) = (u * size(2.0), size(0.25));
            LightShape::Tube { p0: center - half, p1: center + half, radius, ends }
        }
        _ => LightShape::Polygon(random.polygon(center, kind - 2, 0.1, 1.5)),
    });
    lamp.two_sided = random.unit() < 0.3;
    if kind == 8 {
        let axes = center.normalize_or(DVec3::Z).any_orthonormal_pair();
        let (axis_u, axis_v) = (axes.0 * 0.2, axes.1 * 0.15);
        lamp.opening = Some(Opening { center: 0.2 * center, axis_u, axis_v, housed: false });
    }
    lamp
}

#[test]
fn profiles_are_those_of_the_angles_that_near_points_see() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(73);
    let fourth = |i: i32| [5.0 * f64::from(i), (5.0 * f64::from(i)).to_radians().cos().powi(4)];
    let rows: Vec<[f64; 2]> = (0..19).map(fourth).collect();
    for profile in [Profile::cone(0.35, 0.61, 8), Profile::new(&rows, 8)].map(Result::unwrap) {
        let mut near = || DVec3::new(random.between(-1.2, 1.2), random.between(-0.8, 0.8), 0.3);
        let places: Vec<DVec3> = (0..60).map(|_| near()).collect();
        let seen = |place: &DVec3| {
            let corners = [[-1.0, -0.5], [-1.0, 0.5], [1.0, 0.5], [1.0, -0.5]];
            let shape = LightShape::Polygon(corners.map(|[x, y]| *place + DVec3::new(x, y, 0.0)).to_vec());
            point(0.3, DVec3::new(1.0, 2.0, 1.0), Light { profile: Some(profile.clone()), ..light(shape) })
        };
        let points: Vec<MediumPoint> = places.iter().map(seen).collect();
        let known: Vec<f64> = points.iter().map(twin).collect();
        let square: f64 = found(&engine, &points).iter().zip(&known).map(|(a, b)| (a - b).powi(2)).sum();
        let error = (60.0 * square).sqrt() / known.iter().sum::<f64>();
        // A cosine's mean of the profile times the light's solid angle: .24 and more
        assert!(error < 0.07, "{error}");
    }
}

#[test]
fn every_kind_agrees_with_its_twin() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(71);
    let round = ["disk", "sphere", "open tube", "capped tube", "capsule"];
    let flat = ["triangle", "quad", "pentagon", "hexagon behind an opening"];
    for (kind, name) in round.into_iter().chain(flat).enumerate() {
        let points: Vec<MediumPoint> = (0..300)
            .map(|_| {
                let light = any_light(&mut random, kind);
                point(random.between(-0.95, 0.95), random.direction(), light)
            })
            .collect();
        let mut comparison = Comparison::new(name);
        let mut others = Comparison::new("a hundredth more of g");
        // Of rims that are near eight points are not all; polygons, disks and spheres are exact
        let bound = if (2..5).contains(&kind) { 3e-4 } else { ROUNDING };
        for (point, found) in points.iter().zip(found(&engine, &points)) {
            comparison.add(found, twin(point), bound, || format!("{point:?}"));
            let g = point.anisotropy * 1.01;
            others.add(found, twin(&MediumPoint { anisotropy: g, ..point.clone() }), bound, String::new);
        }
        println!("{name}: {:.1e}", comparison.largest());
        let noticed = others.failures();
        comparison.assert_all();
        assert!(noticed > if bound > 1e-4 { 10 } else { 100 }, "the twin: {noticed} noticed");
    }
}

/// The faces of a box around the point, fronts inwards.
fn faces(low: DVec3, high: DVec3) -> Vec<Vec<DVec3>> {
    let corner = |i: usize| {
        DVec3::new([low.x, high.x][i & 1], [low.y, high.y][i >> 1 & 1], [low.z, high.z][i >> 2 & 1])
    };
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    faces.map(|face| face.map(corner).to_vec()).into()
}

#[test]
fn what_is_all_around_gives_one_and_parts_give_the_whole() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(72);
    let mut comparison = Comparison::new("boxes, as faces and as a mesh; spheres around; parts");
    let mut open = Comparison::new("without a face");
    for _ in 0..200 {
        let g = [0.0, 0.3, -0.5, 0.7, -0.9, 0.95, random.between(-0.95, 0.95)][random.bits() as usize % 7];
        let view = random.direction();
        let mut corner =
            |from: f64, to: f64| DVec3::from_array(std::array::from_fn(|_| random.between(from, to)));
        let faces = faces(corner(-3.0, -0.1), corner(0.1, 3.0));
        let mut mesh = light(LightShape::mesh(vec![], vec![]));
        let mut points = vec![];
        for face in &faces {
            mesh.shape.add_face(face);
            points.push(point(g, view, light(LightShape::Polygon(face.clone()))));
        }
        let sphere = LightShape::Sphere { center: random.direction(), radius: 1.5 };
        points.push(point(g, view, mesh));
        points.push(point(g, view, Light { two_sided: true, ..light(sphere) }));
        // A quad is two triangles, and two quads; a concave outline too
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| faces[3][i]);
        let middle = a.lerp(c, 0.3);
        let parts: [Vec<DVec3>; 4] =
            [vec![a, b, c], vec![a, c, d], vec![a, b, middle, d], vec![b, c, d, middle]];
        points.extend(parts.map(|part| point(g, view, light(LightShape::Polygon(part)))));
        let found = found(&engine, &points);
        let sum: f64 = found[..6].iter().sum();
        let place = || format!("{g}: {found:?}");
        // As many roundings as faces
        comparison.add(sum, 1.0, 4.0 * ROUNDING, place);
        comparison.add(found[6], 1.0, 4.0 * ROUNDING, place);
        comparison.add(found[7], 1.0, ROUNDING, place);
        comparison.add(found[8] + found[9], found[3], 2.0 * ROUNDING, place);
        comparison.add(found[10] + found[11], found[3], 2.0 * ROUNDING, place);
        open.add(sum - found[0], 1.0, 4.0 * ROUNDING, String::new);
    }
    comparison.assert_all();
    assert_eq!(open.failures(), 200);
}

#[test]
fn hard_places_give_numbers_and_what_is_known_of_them() {
    let Some(engine) = TestEngine::new() else { return };
    let square = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    let at = |height: f64| LightShape::Polygon(square.map(|[x, y]| DVec3::new(x, y, height)).to_vec());
    let view = DVec3::new(0.2, -0.3, 1.0);
    let shapes = [
        at(1.0),
        LightShape::Disk { center: DVec3::Z, axis_u: DVec3::X, axis_v: -DVec3::Y },
        LightShape::Sphere { center: DVec3::Z * 2.0, radius: 1.0 },
        LightShape::Tube {
            p0: DVec3::Z - DVec3::X,
            p1: DVec3::Z + DVec3::X,
            radius: 0.2,
            ends: TubeEnds::Round,
        },
    ];
    // In the plane, at a vertex, on the light, on an edge, deep behind; far away; g beyond its ends
    let places = [
        [3.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.3, 0.2, 1.0],
        [1.0, 0.1, 1.0],
        [0.0, 0.0, 3.0],
        [0.0, 0.0, -1e7],
    ];
    for shape in shapes {
        for g in [0.0, 0.95, -0.95, 1.0, -7.0, f64::NAN] {
            for two_sided in [false, true] {
                let lamp = Light { two_sided, ..light(shape.clone()) };
                let near = [DVec3::ZERO, DVec3::Z * 1e-6, DVec3::new(1e-7, -1e-6, -1e-6)];
                let points: Vec<_> = places
                    .into_iter()
                    .flat_map(|place| near.map(|by| DVec3::from(place) + by))
                    .map(|position| MediumPoint { position, ..point(g, view, lamp.clone()) })
                    .collect();
                for (point, found) in points.iter().zip(found(&engine, &points)) {
                    assert!((0.0..=1.0 + ROUNDING).contains(&found), "{found}: {point:?}");
                }
            }
        }
    }
    // On a large light it is half of everything, but for what rounding makes of the height: 1e-7 over its
    // part of the distance
    let close = [1e-4, 0.1].map(|height| point(0.0, view, light(at(height))));
    let [on, above] = found(&engine, &close)[..] else { panic!("two answers") };
    assert!((on - 0.5).abs() < 1e-3 && (above - 0.5).abs() > 0.02, "{on}, {above}");
    // Even is the solid angle, whatever the view; beyond the ends it is as at them
    let cube = point(0.0, view, light(at(1.0)));
    let beyond = |g: f64| point(g, view, light(at(1.0)));
    let [even, end, beyond, nan] =
        found(&engine, &[cube, beyond(MAX_ANISOTROPY), beyond(3.0), beyond(f64::NAN)])[..]
    else {
        panic!("four answers")
    };
    assert!((even - 1.0 / 6.0).abs() < ROUNDING && nan == even, "{even}, {nan}");
    assert_eq!(end, beyond);
    // The twin: another g is another number
    assert!((end - even).abs() > 0.1);
    // What is small and far is the phase function times its solid angle
    let mut comparison = Comparison::new("far away");
    for g in [-0.8, 0.0, 0.4, 0.9] {
        for towards in [DVec3::Z, -DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
            let sphere = LightShape::Sphere { center: towards * 200.0, radius: 1.0 };
            let solid_angle = PI / 200.0_f64.powi(2);
            let expected = henyey_greenstein(g, towards.z) * solid_angle;
            let found = found(&engine, &[point(g, -DVec3::Z, light(sphere))])[0];
            // The worst of the fit is .02 of the peak
            let bound = 0.025 * henyey_greenstein(g.abs(), 1.0) * solid_angle + 1e-6;
            comparison.add(found, expected, bound, || format!("{g}, {towards}"));
        }
    }
    comparison.assert_all();
}

#[test]
fn images_are_seen_by_direction() {
    let Some(mut engine) = TestEngine::new() else { return };
    let halves = Texture::from_fn(64, 64, |column, _| DVec3::new(f64::from(column < 32), 1.0, 0.5));
    let white = Texture::from_fn(64, 64, |_, _| DVec3::ONE);
    let images = [white, halves].map(Arc::new);
    pictures::load(&mut engine, &images, |_| TexturePart::default()).unwrap();
    let mut random = Random::new(73);
    let uvs: Vec<_> = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from).into();
    let (mut squares, mut mean) = (DVec3::ZERO, DVec3::ZERO);
    for _ in 0..200 {
        let towards = random.direction();
        let (u, v) = towards.any_orthonormal_pair();
        let center = towards * random.between(0.4, 3.0);
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        let vertices = corners.map(|[x, y]| center + u * x + v * y).to_vec();
        let plain =
            point(random.between(-0.9, 0.9), random.direction(), light(LightShape::Polygon(vertices)));
        let showing = |layer: u32| {
            let texture = Some(LightTexture { layer, uvs: uvs.clone() });
            MediumPoint { light: Light { texture, ..plain.light.clone() }, ..plain.clone() }
        };
        let points = [plain.clone(), showing(0), showing(1)];
        let found = engine.eval_medium(&points, Quality::default()).unwrap();
        // White is none; what is even in the image stays so
        assert!((found[0] - found[1]).abs().max_element() < 1e-5, "{found:?}");
        assert!((found[2].y - found[0].x).abs() < 1e-5 && (found[2].z - 0.5 * found[0].x).abs() < 1e-5);
        let shown = RelativeLight::textured(&points[2].light, DVec3::ZERO, Arc::clone(&images[1])).unwrap();
        let settings =
            arealight_oracle::cubature::Settings { relative_tolerance: 1e-3, ..Default::default() };
        let truth = in_scattered_truth(plain.anisotropy, plain.view, &shown, &settings).radiance;
        squares += (found[2].as_dvec3() - truth).powf(2.0);
        mean += truth;
    }
    let error = (squares / 200.0).powf(0.5) / (mean / 200.0);
    println!("an image of halves: RMSE over mean {error}");
    // A picture of two halves is the worst there is, as lobes of fog are cut along it: with the mean colour
    // alone it is .45
    assert!(error.x < 0.25, "{error}");
}

/// What a ray through an even medium gets of a light, by places along it with weights.
fn along_ray(
    light: &Light,
    anisotropy: f64,
    direction: DVec3,
    places: impl Iterator<Item = [f64; 2]>,
) -> f64 {
    let at = |[distance, weight]: [f64; 2]| {
        let shown = RelativeLight::new(light, distance * direction);
        weight * (-0.2 * distance).exp() * in_scattered(anisotropy, -direction, &shown).x
    };
    places.map(at).sum()
}

#[test]
fn four_places_along_a_ray_are_nearly_all_of_it() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(81);
    let rays: Vec<(DVec3, f64, f64, DVec3)> = (0..60)
        .map(|_| {
            let direction = random.direction();
            let aside = direction.any_orthonormal_vector() * random.between(0.3, 3.0);
            let end = random.between(4.0, 14.0);
            let radius = random.between(0.15, 0.6);
            (direction * random.between(-1.0, end + 1.0) + aside, radius, end, direction)
        })
        .collect();
    let given: Vec<[[f32; 4]; 3]> = rays
        .iter()
        .map(|(center, radius, end, direction)| {
            let row = |v: &DVec3, w: &f64| v.as_vec3().extend(*w as f32).to_array();
            [row(center, radius), row(direction, end), [0.0; 4]]
        })
        .collect();
    let (mut four, mut even, mut mean) = (0.0, 0.0, 0.0);
    let even_places = |end: f64, count: u32| {
        let step = end / f64::from(count);
        (0..count).map(move |place| [(f64::from(place) + 0.5) * step, step])
    };
    for ((center, radius, end, direction), found) in rays.iter().zip(engine.probe(Function::RayPoint, &given))
    {
        // A square that faces the ray, more or less
        let aside = *center - *direction * center.dot(*direction);
        let facing = (-aside.normalize_or(DVec3::Z) + 0.6 * random.direction()).normalize_or(DVec3::Z);
        let u = facing.any_orthonormal_vector() * *radius;
        let w = facing.cross(u);
        let corners = [-u - w, u - w, u + w, w - u].map(|corner| *center + corner).to_vec();
        let light = Light { two_sided: true, ..light(LightShape::Polygon(corners)) };
        let places: Vec<[f64; 2]> = (0..4).map(|i| [found[0][i].into(), found[1][i].into()]).collect();
        assert!(places.iter().all(|[place, weight]| (0.0..=*end).contains(place) && *weight > 0.0));
        let of = |places: &mut dyn Iterator<Item = [f64; 2]>| along_ray(&light, 0.5, *direction, places);
        let truth = of(&mut even_places(*end, 2000));
        four += (of(&mut places.into_iter()) - truth).powi(2);
        even += (of(&mut even_places(*end, 4)) - truth).powi(2);
        mean += truth;
    }
    let relative = |squares: f64| (squares * rays.len() as f64).sqrt() / mean;
    println!("{:.4}; even places {:.4}", relative(four), relative(even));
    // .044 was found: as stated
    assert!(relative(four) < 0.05);
    // The twin: four even places
    assert!(relative(even) > 0.15);
}
