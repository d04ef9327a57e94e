//! How far lights are of any matter, by points outside.

use arealight::reach::{self, DIFFUSE_DENSITY};
use arealight_oracle::shading::{shape_ltc_on, shape_seen_from};
use arealight_oracle::stream::Stream;
use arealight_tests::kernel::LIGHT_REACH;
use arealight_tests::prelude::*;

const THRESHOLD: f64 = 0.01;
const LEAST_ROUGHNESS: f64 = 0.3;

/// A light of each kind, about (5, 0, 0).
fn lights() -> Vec<Light> {
    let at = DVec3::X * 5.0;
    let quad = |front: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| at + DVec3::new(x, front * y * 0.5, 0.3 * x))
            .to_vec()
    };
    let bent = vec![at, at + DVec3::X, at + DVec3::new(1.0, 1.0, 0.5), at + DVec3::Y];
    let (axis_u, axis_v) = (DVec3::Y * 0.7, DVec3::new(0.0, 0.2, 0.9));
    let faces = vec![3, 3];
    let mesh = vec![at, at + DVec3::X, at + DVec3::Y, at, at + DVec3::Z, at + DVec3::X];
    let shapes = [
        LightShape::Polygon(quad(1.0)),
        LightShape::Polygon(quad(-1.0)),
        LightShape::Polygon(bent),
        LightShape::mesh(mesh, faces),
        LightShape::Disk { center: at, axis_u, axis_v },
        LightShape::Sphere { center: at, radius: 0.5 },
        LightShape::Tube { p0: at - DVec3::Y, p1: at + DVec3::Y, radius: 0.1, ends: TubeEnds::Round },
    ];
    let radiance = Vec3::new(2.0, 5.0, 1.0);
    let light = |(index, shape)| Light { radiance, shape, two_sided: index == 1, ..Light::default() };
    shapes.into_iter().enumerate().map(light).collect()
}

fn reflected(light: &Light, surface: &Surface, position: DVec3, normal: DVec3, view: DVec3) -> f64 {
    let table = &TABLE;
    let radiance: DVec3 = if light.shape.vertices().is_empty() {
        let there = shape_seen_from(light, position);
        shape_ltc_on(Quality::default(), table, surface, normal, view, &there).unwrap()
    } else {
        // Faces are lights of their own
        let of = |face: &[DVec3]| {
            let face = Light { shape: LightShape::Polygon(face.to_vec()), ..light.clone() };
            ltc(table, surface, normal, view, &RelativeLight::new(&face, position))
        };
        light.shape.outlines().map(of).sum()
    };
    radiance.max_element()
}

/// The most that is reflected of points from `part` of the reach on, among some that look for it.
fn most(light: &Light, reach: f64, part: f64, random: &mut Stream) -> f64 {
    let front = light.shape.area_vector().normalize_or(DVec3::Z);
    let (mut most, mut found) = (0.0, [front, -front, front]);
    for index in 0..20_000 {
        let [away, normal, view] = if index % 2 == 0 {
            seen(front, random)
        } else {
            // Near what was found
            let width = random.unit().powi(3);
            found.map(|direction| (direction + random.direction() * width).normalize_or(DVec3::Z))
        };
        let position = light.shape.center() + away * reach * part * random.between(1.0, 1.05);
        let roughness = if index % 8 == 0 { random.between(LEAST_ROUGHNESS, 1.0) } else { LEAST_ROUGHNESS };
        let material = Material {
            base_color: Vec3::ONE,
            metalness: random.unit().round() as f32,
            roughness: roughness as f32,
            ..Material::default()
        };
        let lit = reflected(light, &material.surface(), position, normal, view);
        if lit > most {
            (most, found) = (lit, [away, normal, view]);
        }
    }
    most
}

/// A direction from a light, the normal of a surface there, and the direction to a viewer who sees the light
/// mirrored, or about so. Mostly from before the light, where it is largest, and at any angle to the surface:
/// lobes are densest near grazing.
fn seen(front: DVec3, random: &mut Stream) -> [DVec3; 3] {
    let spread = if random.one_in(4) { 2.0 } else { 0.2 };
    let away = (front + random.direction() * spread).normalize_or(DVec3::Z);
    let side = away.cross(random.direction()).normalize_or(DVec3::Z);
    let cosine = random.unit().powi(2);
    let normal = side * (1.0 - cosine * cosine).sqrt() - away * cosine;
    let mirrored = away + normal * (2.0 * cosine);
    [away, normal, mirrored + random.direction() * random.unit().powi(3)]
}

#[test]
fn no_point_out_of_reach_reflects_more_than_the_threshold() {
    let density = DIFFUSE_DENSITY + TABLE.lobe_density(SpecularLobes::default(), LEAST_ROUGHNESS);
    for (index, light) in lights().iter().enumerate() {
        let reach = reach::radius(light, THRESHOLD, density);
        let mut random = Stream::new("reach", index as u64, 0);
        let beyond = most(light, reach, 1.0, &mut random);
        assert!(beyond <= THRESHOLD, "light {index}: {beyond} beyond {reach}");
        // The twin: near grazing, of tubes above all, the reach is over twice what it must be
        let within = most(light, reach, 0.35, &mut random);
        assert!(within > THRESHOLD, "light {index}: {within} within {reach}");
    }
}

#[test]
fn boxes_hold_what_is_before_a_light() {
    let density = DIFFUSE_DENSITY;
    let surface = Material { roughness: 1.0, ..Material::default() }.surface();
    let diffuse = Surface { f0: DVec3::ZERO, f90: 0.0, ..surface };
    for (index, light) in lights().iter().enumerate() {
        let reach = reach::radius(light, THRESHOLD, density);
        let [low, high] = reach::bounds(light, reach);
        let mut random = Stream::new("boxes", index as u64, 0);
        let mut outside = 0;
        for _ in 0..2000 {
            let away = random.direction();
            let position = light.shape.center() + away * reach * random.unit();
            if position.cmpge(low).all() && position.cmple(high).all() {
                continue;
            }
            outside += 1;
            let lit = reflected(light, &diffuse, position, -away, -away);
            assert!(lit <= THRESHOLD, "light {index}: {lit} at {position}");
        }
        // Flat lights of one side have smaller boxes than their spheres
        assert_eq!(outside > 0, light.shape.is_flat() && !light.two_sided, "light {index}");
    }
}

#[test]
fn what_nothing_bounds_reaches_everywhere_and_dark_lights_nowhere() {
    let light = &lights()[0];
    assert!(reach::radius(light, 0.0, 1.0).is_infinite());
    assert!(reach::radius(light, f64::NAN, 1.0).is_infinite());
    let dark = Light { radiance: Vec3::ZERO, ..light.clone() };
    assert_eq!(reach::radius(&dark, 0.0, 1.0), 0.0);
    // Twice as far for a fourth of the threshold, but for the light's own size
    let [far, near] = [THRESHOLD / 4.0, THRESHOLD].map(|threshold| reach::radius(light, threshold, 1.0));
    let size = light.shape.vertices()[0].distance(light.shape.center());
    assert!((far - size - 2.0 * (near - size)).abs() < 1e-9);
}

/// Quads and disks of one side towards both ends of each axis: screens on walls, images on ceilings.
fn upright() -> Vec<Light> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let turned = (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
    let shapes = turned.flat_map(|(axis, side)| {
        let [u, v] = [axes[(axis + 1) % 3], axes[(axis + 2) % 3] * side];
        let quad = [-u - v, u - v, u + v, v - u].map(|vertex| vertex + DVec3::X).to_vec();
        [LightShape::Polygon(quad), LightShape::Disk { center: DVec3::Y, axis_u: u, axis_v: v }]
    });
    shapes.map(|shape| Light { radiance: Vec3::ONE, shape, ..Light::default() }).collect()
}

#[test]
fn the_box_of_what_nothing_bounds_is_everything() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    let textured = upright().into_iter().map(|light| {
        let uvs = if light.shape.is_polygonal() { corners.clone() } else { vec![] };
        Light { texture: Some(LightTexture { layer: 0, uvs }), ..light }
    });
    let plain = [lights(), upright()].concat();
    let engine = TestEngine::new();
    for (threshold, lights) in [(0.0, plain), (THRESHOLD, textured.collect())] {
        for (index, light) in lights.iter().enumerate() {
            light.validate().unwrap();
            let [low, high] = reach::bounds(light, reach::radius(light, threshold, 1.0));
            assert_eq!((low, high), (DVec3::NEG_INFINITY, DVec3::INFINITY), "light {index}");
        }
        let Some(engine) = &engine else { continue };
        for (index, (radius, [low, high])) in
            reaches_on_gpu(engine, &lights, threshold, 1.0).into_iter().enumerate()
        {
            // Behind a light, a millionth of the largest radius that it has, as float32 rounds it
            let far = 0.99e-6 * radius;
            assert!(radius > 1e38 && radius < f64::INFINITY, "light {index}: {radius}");
            assert!(low.cmple(DVec3::splat(-far)).all() && high.cmpge(DVec3::splat(far)).all(), "{index}");
        }
    }
    // The twin: with a threshold, walls end the boxes of what is on them
    for light in upright() {
        let [low, high] = reach::bounds(&light, reach::radius(&light, THRESHOLD, 1.0));
        let depth = (high - low).min_element();
        assert!(depth < 0.6 * (high - low).max_element() && low.cmplt(high).all(), "{low} {high}");
    }
}

/// What the GPU says of lights: radius, low and high, in their order.
fn reaches_on_gpu(
    engine: &TestEngine,
    lights: &[Light],
    threshold: f64,
    density: f64,
) -> Vec<(f64, [DVec3; 2])> {
    let packed = PackedLights::new(lights, DVec3::ZERO).unwrap();
    let summary = packed.summary();
    let [threshold, density] = [threshold, density].map(|value| (value as f32).to_bits());
    let asked = [summary.light_count, summary.shape_count, threshold, density];
    let host = engine.host();
    let buffers = [
        host.storage_buffer("lights", &packed.lights).unwrap(),
        host.storage_buffer("shapes", &packed.shapes).unwrap(),
        host.storage_buffer("asked", &asked).unwrap(),
    ];
    let inputs = [0, 1, 2].map(|index: usize| Resource::buffer(buffers[index].handle()));
    let results: Vec<[f32; 7]> = engine.dispatch(&LIGHT_REACH, &[], &inputs, lights.len());
    let mut reaches = vec![(0.0, [DVec3::ZERO; 2]); lights.len()];
    for (place, [radius, low @ .., x, y, z]) in packed.order.iter().chain(&packed.shape_order).zip(results) {
        let corners = [Vec3::from_array(low), Vec3::new(x, y, z)].map(Vec3::as_dvec3);
        reaches[*place as usize] = (f64::from(radius), corners);
    }
    reaches
}

#[test]
fn the_gpu_reaches_as_far_as_rust_says() {
    let Some(engine) = TestEngine::new() else { return };
    let density = DIFFUSE_DENSITY + TABLE.lobe_density(SpecularLobes::default(), LEAST_ROUGHNESS);
    let mut lights = lights();
    let dark = Light { radiance: Vec3::ZERO, ..lights[0].clone() };
    lights.push(dark);
    for (index, (light, (radius, [low, high]))) in
        lights.iter().zip(reaches_on_gpu(&engine, &lights, THRESHOLD, density)).enumerate()
    {
        let expected = reach::radius(light, THRESHOLD, density);
        let is_bent = light.shape.is_polygonal() && !light.shape.is_flat();
        if is_bent {
            // By the sphere that covers it, in the place of its faces' areas
            let mut random = Stream::new("reach on the GPU", index as u64, 0);
            let beyond = most(light, radius, 1.0, &mut random);
            assert!(beyond <= THRESHOLD, "light {index}: {beyond} beyond {radius}");
            assert!(radius < 3.0 * expected, "light {index}: {radius} for {expected}");
            continue;
        }
        // No nearer, and farther by no more than float32's rounding is allowed for
        let within =
            |found: f64, expected: f64| found >= expected && found <= expected + 1e-5 * expected.abs();
        assert!(within(radius, expected), "light {index}: {radius} for {expected}");
        let bounds = reach::bounds(light, radius);
        let far = 3e-5 * radius + 1e-6;
        assert!((low - bounds[0]).abs().max_element() <= far, "light {index}: {low} for {}", bounds[0]);
        assert!((high - bounds[1]).abs().max_element() <= far, "light {index}: {high} for {}", bounds[1]);
    }
    // The twin: another density is another reach
    let far = reaches_on_gpu(&engine, &lights[..1], THRESHOLD, 4.0 * density)[0].0;
    assert!(far > 1.5 * reach::radius(&lights[0], THRESHOLD, density));
}
