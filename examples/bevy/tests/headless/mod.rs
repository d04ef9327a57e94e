//! Bevy without a window: pictures in linear floats.

#![allow(dead_code, reason = "each test and example uses a part of it")]

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages};
use bevy::window::ExitCondition;

/// Pictures until one shows what changed, meshes and materials too.
const PICTURES: usize = 6;
/// Frames that they are waited for.
const MOST_FRAMES: usize = 400;

/// How many pictures were read back, and the last one's pixels, row after row.
#[derive(Resource, Default)]
struct Picture(usize, Vec<[f32; 4]>);

/// Bevy without a window, deferred and without light, before its first frame. Pipelines are there when they
/// are needed.
pub fn app() -> App {
    let mut app = App::new();
    let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
    app.add_plugins(DefaultPlugins.set(window).set(render));
    app.insert_resource(DefaultOpaqueRendererMethod::deferred());
    app.insert_resource(GlobalAmbientLight::NONE);
    app.insert_resource(ClearColor(Color::BLACK));
    app.init_resource::<Picture>();
    app
}

/// Adds an image of a size that is read back, whose width is a multiple of 16: rows are as they are copied.
pub fn add_picture(app: &mut App, [width, height]: [u32; 2]) -> Handle<Image> {
    assert!(width.is_multiple_of(16));
    let mut image = Image::new_target_texture(width, height, TextureFormat::Rgba32Float, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let image = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    app.world_mut().spawn(Readback::texture(image.clone())).observe(
        |read: On<ReadbackComplete>, mut picture: ResMut<Picture>| {
            picture.0 += 1;
            picture.1 = read.data.chunks_exact(16).map(pixel).collect();
        },
    );
    image
}

/// A camera that draws candelas per square metre.
pub fn camera(image: &Handle<Image>, transform: Transform) -> impl Bundle {
    let exposure = Exposure { ev100: -(1.2f32).log2() };
    let prepasses = (DepthPrepass, DeferredPrepass);
    let target = RenderTarget::Image(image.clone().into());
    (Camera3d::default(), Hdr, Msaa::Off, Tonemapping::None, prepasses, exposure, target, transform)
}

fn pixel(bytes: &[u8]) -> [f32; 4] {
    [0, 4, 8, 12].map(|at| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}

/// Draws frames until one shows what is in the world now.
pub fn picture(app: &mut App) -> Vec<[f32; 4]> {
    if app.plugins_state() != bevy::app::PluginsState::Cleaned {
        app.finish();
        app.cleanup();
    }
    app.world_mut().resource_mut::<Picture>().0 = 0;
    for _ in 0..MOST_FRAMES {
        app.update();
        let Picture(count, pixels) = app.world().resource::<Picture>();
        if *count >= PICTURES {
            return pixels.clone();
        }
    }
    panic!("no picture in {MOST_FRAMES} frames")
}

/// Keeps pixels as a PNG, what is brighter than 1 as 1.
pub fn save(path: &str, [width, height]: [u32; 2], pixels: &[[f32; 4]]) {
    let bytes = pixels
        .iter()
        .flat_map(|&[red, green, blue, _]| Srgba::from(LinearRgba::rgb(red, green, blue)).to_u8_array());
    let size = Extent3d { width, height, depth_or_array_layers: 1 };
    let format = TextureFormat::Rgba8UnormSrgb;
    let usage = RenderAssetUsages::MAIN_WORLD;
    let image = Image::new(size, TextureDimension::D2, bytes.collect(), format, usage);
    image.try_into_dynamic().unwrap().into_rgb8().save(path).unwrap();
}
