//! Lights that the items of a subgroup read together, held against those that each item reads: the same picture to the bit.

use arealight::plan::{LightReads, Output, ShadeOptions, TileOptions, shade_specialization};
use arealight::{Effects, Footprint, Horizon, Quality};
use arealight_oracle::texture::Texture;
use arealight_scene::Scene;
use arealight_tests::TestEngine;
use arealight_tests::frame::{bits, scene, with_renderer};
use std::sync::Arc;

/// No multiple of a group's side.
const SIZE: [u32; 2] = [61, 37];

/// A scene of ours, and how it is shaded.
struct Frame<'a> {
    engine: &'a TestEngine,
    scene: Scene,
    quality: Quality,
}

impl<'a> Frame<'a> {
    fn new(engine: &'a TestEngine, name: &str, quality: Quality) -> Self {
        Self { engine, scene: scene(name), quality }
    }

    /// The bits of the picture, without tiles or with.
    fn shade(&self, reads: LightReads, by_tiles: bool) -> Vec<[u32; 4]> {
        let Self { engine, scene, quality } = self;
        // Items part where one point is enough for some
        let far = if quality.one_point { Effects::FAR } else { Effects::empty() };
        let effects = scene.effects() | far;
        let options =
            ShadeOptions { effects, quality: *quality, reads, output: Output::Add, ..ShadeOptions::all() };
        with_renderer(engine, scene, &scene.lights, SIZE, |renderer| {
            if by_tiles {
                let every = TileOptions { least_quads: 0, ..TileOptions::default() };
                let view = renderer.tiled(options, every).unwrap();
                renderer.shade_tiled(&view).unwrap();
            } else {
                renderer.shade_by(reads.shade(), &shade_specialization(options)).unwrap();
            }
            bits(renderer)
        })
    }

    /// Holds what is read together against what is read by item. The picture.
    fn check_to_the_bit(&self, by_tiles: bool) -> Vec<[u32; 4]> {
        let by_item = self.shade(LightReads::ByItem, by_tiles);
        assert_eq!(differing(&by_item, &self.shade(LightReads::Together, by_tiles)), 0);
        by_item
    }
}

fn differing(a: &[[u32; 4]], b: &[[u32; 4]]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn outlines_and_quads_are_read_together() {
    let Some(engine) = TestEngine::new() else { return };
    let mut frame = Frame::new(&engine, "demo.glb", Quality::default());
    let picture = frame.check_to_the_bit(false);
    // The twin: lights that are a little elsewhere are seen
    frame.scene.lights.iter_mut().flat_map(|light| &mut light.vertices).for_each(|vertex| vertex.x += 1e-3);
    assert!(differing(&picture, &frame.shade(LightReads::Together, false)) > 100, "the twin is the same");
}

#[test]
fn lists_of_tiles_are_read_together() {
    let Some(engine) = TestEngine::new() else { return };
    let quality = Quality { one_point: true, ..Quality::default() };
    Frame::new(&engine, "room.glb", quality).check_to_the_bit(true);
}

#[test]
fn far_lights_are_read_together() {
    let Some(engine) = TestEngine::new() else { return };
    let quality = Quality { one_point: true, horizon: Horizon::Both, ..Quality::default() };
    Frame::new(&engine, "sweep.glb", quality).check_to_the_bit(false);
}

#[test]
fn shapes_are_read_together() {
    let Some(engine) = TestEngine::new() else { return };
    let mut frame = Frame::new(&engine, "shapes.glb", Quality::default());
    let picture = frame.check_to_the_bit(false);
    // The twin: shapes that are a little brighter are seen
    frame.scene.shapes.iter_mut().for_each(|shape| shape.radiance *= 1.001);
    assert!(differing(&picture, &frame.shade(LightReads::Together, false)) > 100, "the twin is the same");
}

#[test]
fn images_on_lights_are_read_together() {
    let Some(mut engine) = TestEngine::new() else { return };
    let textures = [0, 1, 2, 3].map(|seed| Arc::new(Texture::noise(64, 64, seed)));
    arealight_benches::pictures::load(&mut engine, &textures).unwrap();
    Frame::new(&engine, "clock.glb", Quality::default()).check_to_the_bit(false);
    let quality = Quality { footprint: Footprint::SplitTwo, ..Quality::default() };
    Frame::new(&engine, "screen.glb", quality).check_to_the_bit(false);
}
