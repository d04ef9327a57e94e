//! How long frames take of a floor under many rectangles, by Bevy's `RectLight` and by the plugin, in turn:
//! the least of 15 each, since other work on the machine only adds to it. `cargo run --example many_lights --
//! 0 1 8 64`; five minutes on two cores.

#[path = "../tests/headless/mod.rs"]
mod headless;

use bevy::prelude::*;
use bevy::render::render_resource::PollType;
use bevy::render::renderer::RenderDevice;
use bevy_arealight::{AreaLight, AreaLightPlugin};
use std::time::Instant;

const SIZE: [u32; 2] = [640, 360];
/// Turns of each, and frames that count in a turn.
const TURNS: usize = 3;
const FRAMES: usize = 5;

fn main() {
    let counts = std::env::args().skip(1).map(|count| count.parse().expect("a count of lights"));
    println!("| lights | RectLight, ms | plugin, ms | ratio | light there, RectLight to plugin |");
    println!("|---|---|---|---|---|");
    for count in counts {
        let mut apps = [scene(count, false), scene(count, true)];
        // Pictures are the warm-up
        let [of_bevy, of_plugin] = [0, 1].map(|at| brightness(&headless::picture(&mut apps[at])));
        let mut times = [vec![], vec![]];
        for _ in 0..TURNS {
            for (app, times) in apps.iter_mut().zip(&mut times) {
                // The first has work of the other one's last beside it
                times.extend((0..=FRAMES).map(|_| frame(app)).skip(1));
            }
        }
        let [bevy, plugin] = times.map(|times| times.into_iter().fold(f64::MAX, f64::min));
        let (ratio, share) = (plugin / bevy, of_bevy / of_plugin);
        println!("| {count} | {bevy:.1} | {plugin:.1} | {ratio:.2} | {share:.3} |");
    }
}

/// A floor under a grid of so many rectangles that face it, with a range that cuts nothing off.
fn scene(count: usize, by_plugin: bool) -> App {
    let mut app = headless::app();
    app.add_plugins(AreaLightPlugin::default());
    let image = headless::add_picture(&mut app, SIZE);
    let camera = Transform::from_xyz(0.0, 6.0, 12.0).looking_at(Vec3::ZERO, Vec3::Y);
    app.world_mut().spawn(headless::camera(&image, camera));
    let floor: Mesh = Plane3d::default().mesh().size(40.0, 40.0).into();
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(floor);
    let material = app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(Color::WHITE);
    app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material)));
    let side = (count as f32).sqrt().ceil();
    for index in 0..count {
        let light = RectLight { width: 0.4, height: 0.4, range: 1e6, ..default() };
        let of_grid = |at: f32| ((at + 0.5) / side - 0.5) * 16.0;
        let (x, z) = (of_grid(index as f32 % side), of_grid((index as f32 / side).floor()));
        let transform = Transform::from_xyz(x, 1.0, z).looking_to(Vec3::NEG_Y, Vec3::X);
        match by_plugin {
            true => app.world_mut().spawn((AreaLight::from(light), transform)),
            false => app.world_mut().spawn((light, transform)),
        };
    }
    app
}

/// Milliseconds until the GPU has drawn what it was given, a frame for each call.
fn frame(app: &mut App) -> f64 {
    let began = Instant::now();
    app.update();
    app.world().resource::<RenderDevice>().poll(PollType::wait_indefinitely()).expect("a device");
    began.elapsed().as_secs_f64() * 1e3
}

fn brightness(pixels: &[[f32; 4]]) -> f64 {
    pixels.iter().map(|pixel| f64::from(pixel[1])).sum()
}
