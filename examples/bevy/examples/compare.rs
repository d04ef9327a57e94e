//! Bevy's own example of rectangles of light, by Bevy, by the plugin and by cubature of the true BRDF: a
//! table of errors, RMSE over mean, and the three pictures side by side. `cargo run --example compare --
//! FILE.png`; a minute on two cores.

#[path = "../tests/headless/mod.rs"]
mod headless;

use arealight::glam::{DVec3, Vec3 as Color3};
use arealight::{Light, LightShape};
use arealight_oracle::cubature::Settings;
use arealight_oracle::material::{Material, Surface};
use arealight_oracle::shading::{RelativeLight, truth};
use bevy::prelude::*;
use bevy_arealight::{AreaLight, AreaLightPlugin, Level};

const SIZE: [u32; 2] = [304, 176];
/// Candelas per square metre that are white in the pictures.
const WHITE: f32 = 6000.0;

fn main() {
    let levels = [Level::Exact, Level::TwoLobes, Level::Finest, Level::HalfVectors];
    let drawn: Vec<_> = std::iter::once(None).chain(levels.map(Some)).map(draw).collect();
    let places: Vec<Option<Place>> = (0..SIZE[0] * SIZE[1]).map(seen).collect();
    let reference: Vec<DVec3> =
        places.iter().map(|place| place.as_ref().map_or(DVec3::ZERO, radiance)).collect();
    println!("| error of | RectLight | {} |", levels.map(Level::name).join(" | "));
    println!("|---|---|---|---|---|---|");
    for (name, is_floor) in [("floor: metal, roughness .6", true), ("ball: white dielectric, .5", false)] {
        let on: Vec<usize> = (0..places.len())
            .filter(|at| places[*at].as_ref().is_some_and(|it| it.is_floor == is_floor))
            .collect();
        let mean = on.iter().map(|at| reference[*at].element_sum()).sum::<f64>() / (3 * on.len()) as f64;
        let errors = drawn.iter().map(|pixels| {
            let square = |at: &usize| (color(&pixels[*at]) - reference[*at]).length_squared();
            format!("{:.4}", (on.iter().map(square).sum::<f64>() / (3 * on.len()) as f64).sqrt() / mean)
        });
        println!("| {name} | {} |", errors.collect::<Vec<_>>().join(" | "));
    }
    let path = std::env::args().nth(1).unwrap_or_else(|| "compare.png".into());
    let reference = reference.iter().map(|it| it.as_vec3().extend(1.0).to_array()).collect();
    save_beside(&path, &[&drawn[0], &drawn[2], &reference]);
}

fn color([red, green, blue, _]: &[f32; 4]) -> DVec3 {
    Color3::new(*red, *green, *blue).as_dvec3()
}

fn camera() -> Transform {
    Transform::from_xyz(-8.0, 5.0, 8.0).looking_at(Vec3::Y, Vec3::Y)
}

/// The example's lights, with a range that cuts nothing off.
fn lights() -> [(RectLight, Transform); 2] {
    let light = |color, intensity, width, height| RectLight { color, intensity, width, height, range: 1e6 };
    let turned = Quat::from_rotation_y(std::f32::consts::PI);
    [
        (
            light(Color::srgb(1.0, 0.3, 0.2), 1e5, 2.0, 1.0),
            Transform::from_xyz(1.0, 3.0, 1.0).looking_at(Vec3::Y, Vec3::Y),
        ),
        (
            light(Color::srgb(0.5, 0.7, 1.0), 8e5, 1.5, 4.0),
            Transform::from_xyz(-2.0, 1.5, -3.0).with_rotation(turned),
        ),
    ]
}

/// The scene by the plugin on a level, or by Bevy.
fn draw(level: Option<Level>) -> Vec<[f32; 4]> {
    let mut app = headless::app();
    let quality = level.unwrap_or_default().quality();
    app.add_plugins(AreaLightPlugin { quality, ..AreaLightPlugin::default() });
    let image = headless::add_picture(&mut app, SIZE);
    app.world_mut().spawn(headless::camera(&image, camera()));
    let mut add = |mesh: Mesh, material: StandardMaterial, transform: Transform| {
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
        let material = app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(material);
        app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material), transform));
    };
    let metal = StandardMaterial { metallic: 1.0, perceptual_roughness: 0.6, ..Color::WHITE.into() };
    add(Plane3d::default().mesh().size(20.0, 20.0).into(), metal, Transform::default());
    add(Sphere::new(1.0).mesh().uv(128, 64), Color::WHITE.into(), Transform::from_xyz(0.0, 1.0, 0.0));
    for (light, transform) in lights() {
        match level {
            None => app.world_mut().spawn((light, transform)),
            Some(_) => app.world_mut().spawn((AreaLight::from(light), transform)),
        };
    }
    headless::picture(&mut app)
}

/// What a pixel sees.
struct Place {
    position: DVec3,
    normal: DVec3,
    is_floor: bool,
}

fn seen(pixel: u32) -> Option<Place> {
    let of = |vector: Vec3| DVec3::from_array(vector.to_array().map(f64::from));
    let (camera, tangent) = (camera(), (std::f64::consts::FRAC_PI_4 / 2.0).tan());
    let [width, height] = SIZE.map(f64::from);
    let x = (f64::from(pixel % SIZE[0]) + 0.5) * 2.0 - width;
    let y = height - (f64::from(pixel / SIZE[0]) + 0.5) * 2.0;
    let aside = of(*camera.right()) * (x * tangent / height) + of(*camera.up()) * (y * tangent / height);
    let (eye, ray) = (of(camera.translation), (aside - of(*camera.back())).normalize_or_zero());
    // The ball of radius 1 around (0, 1, 0), else the floor
    let (center, to_eye) = (DVec3::Y, eye - DVec3::Y);
    let (half, rest) = (to_eye.dot(ray), to_eye.length_squared() - 1.0);
    if half * half >= rest {
        let position = eye + ray * (-half - (half * half - rest).sqrt());
        return Some(Place { position, normal: position - center, is_floor: false });
    }
    let position = eye - ray * (eye.y / ray.y);
    let is_floor = ray.y < 0.0 && position.abs().max_element() < 10.0;
    is_floor.then_some(Place { position, normal: DVec3::Y, is_floor })
}

/// What the true BRDF reflects to the camera there.
fn radiance(place: &Place) -> DVec3 {
    let surface: Surface = if place.is_floor {
        Material { metalness: 1.0, roughness: 0.6, ..Material::default() }.surface()
    } else {
        Material { roughness: 0.5, ..Material::default() }.surface()
    };
    let eye = DVec3::from_array(camera().translation.to_array().map(f64::from));
    let settings = Settings::default();
    let of = |light: &Light| {
        let seen = RelativeLight::new(light, place.position);
        truth(&surface, place.normal, eye - place.position, &seen, &settings).radiance
    };
    lights().into_iter().map(|(light, transform)| of(&in_world(light, &transform))).sum()
}

fn in_world(light: RectLight, transform: &Transform) -> Light {
    let area = light.width * light.height;
    let color = light.color.to_linear() * (light.intensity / (area * std::f32::consts::PI));
    let (x, y) = (transform.right() * light.width / 2.0, transform.up() * light.height / 2.0);
    let corner =
        |x: Vec3, y: Vec3| DVec3::from_array((transform.translation + x + y).to_array().map(f64::from));
    Light {
        radiance: Color3::new(color.red, color.green, color.blue),
        shape: LightShape::Polygon(vec![corner(-x, -y), corner(-x, y), corner(x, y), corner(x, -y)]),
        ..Light::default()
    }
}

/// Pictures in a row, with a black column between two.
fn save_beside(path: &str, pictures: &[&Vec<[f32; 4]>]) {
    let [width, height] = SIZE.map(|side| side as usize);
    let mut row = Vec::new();
    for y in 0..height {
        for picture in pictures {
            row.extend(picture[y * width..(y + 1) * width].iter().map(|pixel| pixel.map(|it| it / WHITE)));
            row.push([0.0; 4]);
        }
    }
    headless::save(path, [(pictures.len() * (width + 1)) as u32, height as u32], &row);
    println!("{path}: Bevy, the plugin, the reference");
}
