//! How far lights are of any matter, by points outside.

use arealight::reach::{self, DIFFUSE_DENSITY};
use arealight::{Light, LightShape, LightTable, Quality, SpecularLobes, TubeEnds};
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::shading::{RelativeLight, ltc, shape_ltc_on};
use arealight_oracle::stream::Stream;
use glam::{DVec3, Vec3};
use std::sync::LazyLock;

static TABLE: LazyLock<LightTable> = LazyLock::new(arealight_table::ggx);

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
        LightShape::Mesh { vertices: mesh, faces },
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
    let radiance = match &light.shape {
        LightShape::Polygon(_) => ltc(table, surface, normal, view, &RelativeLight::new(light, position)),
        LightShape::Mesh { vertices, faces } => {
            // Faces are lights of their own
            let mut rest = vertices.as_slice();
            faces.iter().fold(DVec3::ZERO, |sum, &count| {
                let (face, after) = rest.split_at(count as usize);
                rest = after;
                let face = Light { shape: LightShape::Polygon(face.to_vec()), ..light.clone() };
                sum + ltc(table, surface, normal, view, &RelativeLight::new(&face, position))
            })
        }
        shape => {
            let shape = match shape.clone() {
                LightShape::Disk { center, axis_u, axis_v } => {
                    LightShape::Disk { center: center - position, axis_u, axis_v }
                }
                LightShape::Sphere { center, radius } => {
                    LightShape::Sphere { center: center - position, radius }
                }
                LightShape::Tube { p0, p1, radius, ends } => {
                    LightShape::Tube { p0: p0 - position, p1: p1 - position, radius, ends }
                }
                polygonal => polygonal,
            };
            let there = Light { shape, ..light.clone() };
            shape_ltc_on(Quality::default(), table, surface, normal, view, &there).unwrap()
        }
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

/// A direction from a light, the normal of a surface there, and the direction to a viewer who sees the light mirrored, or about so. Mostly from before
/// the light, where it is largest, and at any angle to the surface: lobes are densest near grazing.
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
