//! Images that move.

use crate::shapes::panel;
use crate::writer::{Writer, png};
use crate::{error, load};
use arealight_scene::{LoadOptions, Scene};
use serde_json::json;

/// Two texels: red and black for a tenth of a second, then blue and green for three tenths.
const APNG: &str = "\
    89504e470d0a1a0a0000000d49484452000000020000000108020000007b40e8dd000000086163544c00000002000000 \
    00f38d93700000001a6663544c0000000000000002000000010000000000000000006403e800001028e5640000000f49 \
    444154789c63f8cfc0c0c0c0000006010100b09746130000001a6663544c000000010000000200000001000000000000 \
    0000012c03e800002884cf9d000000136664415400000002789c636060f8cff09f0100060101ff65c158350000000049 \
    454e44ae426082";

/// The same.
const WEBP: &str = "\
    524946468600000057454250565038580a00000002000000010000000000414e494d06000000000000000000414e4d46 \
    28000000000000000000010000000000640000025650384c100000002f010000000f10f31ff31f868ce87f00414e4d46 \
    2a0000000000000000000100000000002c0100005650384c120000002f010000000f30ffb1fff31f0e2a10d1ff00";

fn bytes(hexadecimal: &str) -> Vec<u8> {
    let digits: Vec<u8> = hexadecimal.chars().filter_map(|c| c.to_digit(16)).map(|d| d as u8).collect();
    digits.chunks(2).map(|pair| pair[0] << 4 | pair[1]).collect()
}

/// A PNG of two texels that does not move.
fn still(texels: [u8; 6]) -> Vec<u8> {
    png(image::RgbImage::from_raw(2, 1, texels.to_vec()).unwrap())
}

/// A panel that shows an image, upright.
fn screen(image: &[u8]) -> Writer {
    let mut writer = Writer::new();
    let texture = writer.texture("picture", image);
    let material = writer.emitter_of_image("glow", [1.0; 3], texture, false);
    let mut shape = panel(2.0, 1.0);
    for (at, [x, y, _]) in shape.uvs.iter_mut().zip(&shape.positions) {
        *at = [x * 0.5 + 0.5, 0.5 - y];
    }
    writer.object("tv", &shape, material, json!({}));
    writer
}

#[test]
fn the_frame_of_a_time_is_shown() {
    let (red, black, blue, green) = (0xff00_00ff, 0xff00_0000, 0xffff_0000, 0xff00_ff00);
    for (name, image) in [("APNG", APNG), ("WebP", WEBP)] {
        let writer = screen(&bytes(image));
        let mut scene = load(writer.clone());
        let frames = scene.images[0].frames.clone();
        let expected = [(0.1, [red, black]), (0.4, [blue, green])];
        assert_eq!(frames.len(), 2);
        for ((end, found), (last, texels)) in frames.iter().zip(expected) {
            assert_eq!(*end, last, "{name}");
            // A decoder that blends frames by their alpha of one loses a level of WebP
            let off = |(a, b): (&u32, u32)| {
                a.to_le_bytes().iter().zip(b.to_le_bytes()).map(|(a, b)| a.abs_diff(b)).max()
            };
            assert!(found.iter().zip(texels).all(|pair| off(pair) <= Some(1)), "{name}: {found:x?}");
        }
        assert_eq!(scene.images[0].texels, frames[0].1, "at rest the first");
        // They repeat
        for (time, frame) in [(0.05, 0), (0.1, 1), (0.39, 1), (0.41, 0), (4.2, 1), (-0.1, 1), (f64::NAN, 0)] {
            assert_eq!(scene.frames_at(time), [Some(frame)], "{name} at {time}");
            scene.show_frames(time);
            let options = LoadOptions { time: Some(time), ..LoadOptions::default() };
            let loaded = Scene::from_bytes_with(&writer.clone().glb(), "test.glb", options).unwrap();
            assert_eq!([&scene.images[0].texels, &loaded.images[0].texels], [&frames[frame].1; 2], "{name}");
            assert_eq!(loaded.light_texture_source(0).unwrap().texels, frames[frame].1);
        }
    }
    // The twin: an image that does not move
    let still = load(screen(&still([0; 6])));
    assert_eq!((still.frames_at(0.2), still.has_moving_images()), (vec![None], false));
}

#[test]
fn what_is_black_at_first_may_shine_later() {
    // The right half is black in the first frame alone
    let lights = |image: &[u8]| {
        let mut writer = screen(image);
        let mut shape = panel(2.0, 1.0);
        for (at, [x, y, _]) in shape.uvs.iter_mut().zip(&shape.positions) {
            *at = [x * 0.1 + 0.88, 0.5 - y];
        }
        writer.object("right half", &shape, 0, json!({ "translation": [3, 0, 0] }));
        load(writer).lights.iter().filter(|light| light.texture.is_some()).count()
    };
    assert_eq!(lights(&bytes(APNG)), 2);
    // The twin: an image of the first frame
    assert_eq!(lights(&still([255, 0, 0, 0, 0, 0])), 1);
}

#[test]
fn broken_films_are_refused() {
    for image in [APNG, WEBP] {
        let whole = bytes(image);
        for end in (whole.len() / 2)..whole.len() - 20 {
            // No panic: refused, or a still
            if let Ok(scene) = Scene::from_bytes(&screen(&whole[..end]).glb(), "test.glb") {
                assert!(scene.images.iter().all(|image| image.frames.len() != 1));
            }
        }
    }
    let mut longer = bytes(APNG);
    longer.truncate(longer.len() - 24);
    assert!(error(screen(&longer)).contains("images[0]"));
    // Each frame is asked for
    let writer = screen(&bytes(APNG));
    let least = |memory| {
        let options = LoadOptions { memory: Some(memory), ..LoadOptions::default() };
        Scene::from_bytes_with(&writer.clone().glb(), "test.glb", options).is_ok()
    };
    let needed = (0..1 << 20).step_by(4).find(|memory| least(*memory)).unwrap();
    assert!(needed > 0 && !least(needed - 4));
}
