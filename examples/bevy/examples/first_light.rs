//! A lamp over a floor, drawn without a window: `cargo run --example first_light -- FILE.png`.

#[path = "../tests/headless/mod.rs"]
mod headless;

use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::{camera::Hdr, camera::RenderTarget};
use bevy_arealight::{AreaLight, AreaLightPlugin};

const SIZE: [u32; 2] = [640, 360];

fn main() {
    let mut app = headless::app();
    // doc: plugin
    app.add_plugins(AreaLightPlugin::default()).insert_resource(DefaultOpaqueRendererMethod::deferred());
    // doc end
    let image = headless::add_picture(&mut app, SIZE);
    app.insert_resource(Target(image)).add_systems(Startup, setup);
    let pixels = headless::picture(&mut app);
    let path = std::env::args().nth(1).unwrap_or_else(|| "first_light.png".into());
    headless::save(&path, SIZE, &pixels);
    println!("{path}");
}

/// Where the camera draws, in the place of a window.
#[derive(Resource)]
struct Target(Handle<Image>);

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    target: Res<Target>,
) {
    let gray =
        materials.add(StandardMaterial { perceptual_roughness: 0.4, ..Color::srgb(0.5, 0.5, 0.5).into() });
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(20.0, 20.0))),
        MeshMaterial3d(gray.clone()),
    ));
    let ball = meshes.add(Sphere::new(0.5));
    commands.spawn((Mesh3d(ball), MeshMaterial3d(gray), Transform::from_xyz(-1.2, 0.5, 0.2)));
    // doc: first light
    commands.spawn((
        AreaLight { radiance: LinearRgba::rgb(8e3, 7e3, 5e3), ..AreaLight::rectangle(2.0, 1.0) },
        Transform::from_xyz(0.0, 2.0, -1.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let view = Transform::from_xyz(0.0, 2.0, 5.0).looking_at(Vec3::Y * 0.5, Vec3::Y);
    let camera = commands.spawn((Camera3d::default(), Hdr, DepthPrepass, DeferredPrepass, view)).id();
    // doc end
    // Bevy's default tone mapping needs a table, of the feature tonemapping_luts
    commands.entity(camera).insert((RenderTarget::Image(target.0.clone().into()), Tonemapping::AcesFitted));
}
