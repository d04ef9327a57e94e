//! What a scene does with lights and cameras besides drawing them: no panic, and the light that is left.

mod headless;

use bevy::camera::Hdr;
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::prelude::*;
use bevy_arealight::{AreaLight, AreaLightPlugin};
use headless::{add_picture, app, picture};

const SIZE: [u32; 2] = [32, 24];

/// The picture's mean of green.
fn brightness(app: &mut App) -> f32 {
    picture(app).iter().map(|pixel| pixel[1]).sum::<f32>() / (SIZE[0] * SIZE[1]) as f32
}

/// What is left of the brightness when a component is put on an entity in the place of its own.
fn with<C: Component + Clone>(app: &mut App, entity: Entity, component: C) -> f32 {
    let before = app.world().get::<C>(entity).cloned();
    app.world_mut().entity_mut(entity).insert(component);
    let brightness = brightness(app);
    match before {
        Some(before) => app.world_mut().entity_mut(entity).insert(before),
        None => app.world_mut().entity_mut(entity).remove::<C>(),
    };
    brightness
}

#[test]
fn lights_and_cameras_come_and_go_without_a_panic() {
    let mut app = app();
    app.add_plugins(AreaLightPlugin::default());
    // No camera, and no light
    app.finish();
    app.cleanup();
    app.update();
    let image = add_picture(&mut app, SIZE);
    let above = Transform::from_xyz(0.0, 3.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = app.world_mut().spawn(headless::camera(&image, above)).id();
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(40.0, 40.0));
    let material =
        app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material.clone())));
    assert_eq!(brightness(&mut app), 0.0, "no light");

    let down = Transform::from_xyz(0.0, 1.5, 0.0).looking_at(Vec3::ZERO, Vec3::Z);
    let parent = app.world_mut().spawn((Transform::default(), Visibility::default())).id();
    let light = app.world_mut().spawn((AreaLight::rectangle(2.0, 1.0), down, ChildOf(parent))).id();
    let lit = brightness(&mut app);
    assert!(lit > 1.0, "{lit}");

    // Lights
    let same = |brightness: f32| (brightness / lit - 1.0).abs() < 1e-3;
    assert_eq!(with(&mut app, light, Visibility::Hidden), 0.0);
    assert_eq!(with(&mut app, parent, Visibility::Hidden), 0.0, "its parent is hidden");
    assert_eq!(with(&mut app, light, down.with_scale(Vec3::ZERO)), 0.0);
    assert!(same(with(&mut app, light, down.with_scale(Vec3::new(-1.0, 1.0, 1.0)))), "mirrored in its plane");
    assert_eq!(with(&mut app, light, down.with_scale(Vec3::new(1.0, 1.0, -1.0))), 0.0, "shines up");
    assert_eq!(with(&mut app, light, Transform::from_xyz(f32::NAN, 0.0, 0.0)), 0.0);
    let wrong = AreaLight { radiance: LinearRgba::rgb(-1.0, 0.0, 0.0), ..AreaLight::sphere(0.1) };
    assert_eq!(with(&mut app, light, wrong), 0.0);
    assert_eq!(with(&mut app, light, AreaLight::sphere(0.0)), 0.0);
    assert_eq!(with(&mut app, light, bevy::camera::visibility::RenderLayers::layer(1)), 0.0);
    assert!(same(brightness(&mut app)), "all of that is over");

    // Cameras that cannot show it; Bevy itself turns MSAA off
    assert!(same(with(&mut app, camera, Msaa::Sample4)));
    app.world_mut().despawn(camera);
    // Without the deferred prepass alone Bevy 0.19.1 panics in its own queue_prepass_material_meshes
    let forward = app
        .world_mut()
        .spawn(headless::camera(&image, above))
        .remove::<(DepthPrepass, DeferredPrepass)>()
        .id();
    assert_eq!(brightness(&mut app), 0.0, "no G-buffer");
    app.world_mut().despawn(forward);
    let camera = app.world_mut().spawn(headless::camera(&image, above)).remove::<Hdr>().id();
    assert!(brightness(&mut app).abs() < 1e-6, "not HDR");
    app.world_mut().entity_mut(camera).insert(Hdr);
    assert!(same(brightness(&mut app)));

    // Unlit surfaces get none
    let unlit = StandardMaterial { unlit: true, base_color: Color::BLACK, ..default() };
    *app.world_mut().resource_mut::<Assets<StandardMaterial>>().get_mut(&material).unwrap() = unlit;
    assert_eq!(brightness(&mut app), 0.0, "unlit");
    app.world_mut().despawn(light);
    app.world_mut().despawn(camera);
    (0..3).for_each(|_| app.update());
}
