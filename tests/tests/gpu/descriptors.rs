//! How passes get at a host's resources: sets, sets with offsets of rings of lights, and pushed descriptors.
//! The picture is the same.

use arealight_engine::host::{Buffer, Host};
use arealight_tests::prelude::*;
use arealight_vk::Bound;

/// A multiple of every device's minStorageBufferOffsetAlignment.
const SLOT: usize = 1024;

/// A buffer with a frame's bytes in each slot.
fn ring(host: &Host, frames: [&[u8]; 2]) -> Buffer {
    let slot = |bytes: &[u8]| bytes.iter().copied().chain([0; SLOT]).take(SLOT).collect::<Vec<_>>();
    host.storage_buffer("ring", &[slot(frames[0]), slot(frames[1])].concat()).unwrap()
}

fn bytes<T: bytemuck::Pod>(items: &[T]) -> &[u8] {
    bytemuck::cast_slice(items)
}

fn differ(a: &[Vec4], b: &[Vec4]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn frames_of_a_ring_have_their_offsets() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let mut others = lamps();
    others.reverse();
    for light in &mut others {
        light.radiance *= 0.5;
    }
    let [first, second] = [lamps(), others].map(|lights| PackedLights::new(&lights, DVec3::ZERO).unwrap());
    let rings = [
        ring(engine.host(), [bytes(&first.lights), bytes(&second.lights)]),
        ring(engine.host(), [bytes(&first.vertices), bytes(&second.vertices)]),
        ring(engine.host(), [bytes(&first.shapes), bytes(&second.shapes)]),
    ];
    let part = |index: usize, offset: usize| Resource::StorageBuffer {
        buffer: rings[index].handle(),
        offset: offset as u64,
        range: SLOT as u64,
    };
    let at = |offset| ShadeResources {
        lights: part(0, offset),
        light_vertices: part(1, offset),
        shapes: Some(part(2, offset)),
        ..floor.resources()
    };
    let (options, frame) = (ShadeOptions::default(), floor.frame());
    for tiles in [false, true] {
        let by_sets = |offset| floor.shade(options, tiles, (&at(offset), &frame, Descriptors::Sets));
        let by_offsets = |offset: usize| {
            let frame = ShadeFrame { light_offsets: [offset as u32; 3], ..frame };
            floor.shade(options, tiles, (&at(0), &frame, Descriptors::LightOffsets))
        };
        let (first, second) = (by_sets(0), by_sets(SLOT));
        assert_eq!(by_offsets(0), first);
        assert_eq!(by_offsets(SLOT), second);
        // The twin: the frames are not alike
        assert!(differ(&first, &second) > first.len() / 2);
    }
}

fn pushed(resources: &ShadeResources) -> Bound<'_> {
    Bound::Pushed { resources, host_set: None }
}

#[test]
fn pushed_resources_shade_as_sets_do() {
    let Some(engine) = TestEngine::with_push_descriptors() else { return };
    let floor = Floor::new(&engine, &lamps());
    let (options, frame) = (ShadeOptions::default(), floor.frame());
    for tiles in [false, true] {
        let pushed = floor.shade(options, tiles, (&floor.resources(), &frame, Descriptors::Pushed));
        let by_sets = floor.shade(options, tiles, (&floor.resources(), &frame, Descriptors::Sets));
        assert_eq!(differ(&pushed, &by_sets), 0);
        assert!(by_sets.iter().any(|texel| texel.x > 0.1));
    }
    // What lights need is missed before anything is recorded
    let without = ShadeResources { shapes: None, ..floor.resources() };
    // SAFETY: Nothing is recorded where an error is returned.
    unsafe {
        let info = ShadePassInfo { descriptors: Descriptors::Pushed, ..options.into() };
        let pass = engine.pass(info).unwrap();
        let null = vk::CommandBuffer::null();
        let missed = pass.record(null, pushed(&without), &frame).unwrap_err();
        assert_eq!(field(&missed), "shapes");
        let set = vk::DescriptorSet::null();
        assert_eq!(field(&pass.record(null, set, &frame).unwrap_err()), "set");
        assert_eq!(field(&pass.write_set(set, &floor.resources()).unwrap_err()), "set");
    }
}

#[test]
fn ways_of_binding_are_not_mixed_up() {
    let Some(engine) = TestEngine::new() else { return };
    let floor = Floor::new(&engine, &lamps());
    let (null, set) = (vk::CommandBuffer::null(), vk::DescriptorSet::null());
    let made = |descriptors| engine.pass(ShadePassInfo { descriptors, ..ShadePassInfo::default() }).unwrap();
    let moved = ShadeFrame { light_offsets: [0, 1 << 16, 0], ..floor.frame() };
    // SAFETY: Nothing is recorded or written where an error is returned.
    unsafe {
        let plain = made(Descriptors::Sets);
        let resources = plain.record(null, pushed(&floor.resources()), &floor.frame());
        assert_eq!(field(&resources.unwrap_err()), "resources");
        assert_eq!(field(&plain.record(null, set, &moved).unwrap_err()), "light_offsets");
        let ring = made(Descriptors::LightOffsets);
        // An offset needs a range, and an alignment
        assert_eq!(field(&ring.write_set(set, &floor.resources()).unwrap_err()), "lights");
        let odd = ShadeFrame { light_offsets: [0, 0, 3], ..floor.frame() };
        assert_eq!(field(&ring.record(null, set, &odd).unwrap_err()), "light_offsets");
    }
}
