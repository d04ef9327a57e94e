//! Emissive textures: which rectangle of which image each light shows.

use crate::shapes::{panel, polygon};
use crate::writer::{Shape, Writer, png};
use crate::{load, warnings};
use arealight::{Effects, Light, TexturePart};
use arealight_scene::{MAX_LIGHT_TEXELS, MAX_LIGHT_TEXTURES, Scene, Wrap, required_effects};
use glam::{DVec2, DVec3, Vec3};
use image::{Rgb, RgbImage};
use serde_json::json;

/// An image of 64 by 32 whose texels all differ.
fn picture() -> RgbImage {
    RgbImage::from_fn(64, 32, |x, y| Rgb([x as u8 * 4, y as u8 * 8, 40]))
}

/// A panel of 2 by 1 on which the corners of the square image lie as they should, moved by `uv`.
fn screen(uv: impl Fn(DVec2) -> DVec2) -> Shape {
    let mut shape = panel(2.0, 1.0);
    for (at, [x, y, _]) in shape.uvs.iter_mut().zip(&shape.positions) {
        let plain = DVec2::new(f64::from(*x) * 0.5 + 0.5, 0.5 - f64::from(*y));
        *at = uv(plain).as_vec2().to_array();
    }
    shape
}

/// A writer with an emitter of radiance (3, 2, 1) times `image`.
fn textured(image: &RgbImage) -> (Writer, usize) {
    let mut writer = Writer::new();
    let material = writer.emitter("glow", [3.0, 2.0, 1.0], false);
    let texture = writer.texture("picture", &png(image.clone()));
    writer.root["materials"][material]["emissiveTexture"] = json!({ "index": texture });
    (writer, material)
}

/// A scene of emitters of one material, side by side.
fn scene_of(image: &RgbImage, shapes: &[Shape], sampler: &serde_json::Value) -> Scene {
    let (mut writer, material) = textured(image);
    writer.push("samplers", sampler.clone());
    writer.root["textures"][0]["sampler"] = json!(0);
    for (i, shape) in shapes.iter().enumerate() {
        writer.object("tv", shape, material, json!({ "translation": [3 * i, 0, 0] }));
    }
    load(writer)
}

fn one(shape: Shape) -> Scene {
    scene_of(&picture(), &[shape], &json!({}))
}

/// The texture coordinate that a light shows at each vertex, in its image.
fn shown(scene: &Scene, light: &Light) -> Vec<DVec2> {
    let texture = light.texture.as_ref().expect("a texture");
    let layer = scene.light_textures[texture.layer as usize];
    texture.uvs.iter().map(|uv| layer.low + layer.size * *uv).collect()
}

fn near(a: DVec2, b: DVec2) -> bool {
    // Float32 coordinates and positions
    (a - b).length() < 2e-6 * (1.0 + b.length())
}

#[test]
fn a_screen_shows_its_whole_image() {
    let scene = one(screen(|uv| uv));
    assert_eq!(warnings(&scene), [""; 0]);
    let [layer] = scene.light_textures[..] else { panic!("{:?}", scene.light_textures) };
    assert_eq!((layer.low, layer.size), (DVec2::ZERO, DVec2::ONE));
    let [light] = &scene.lights[..] else { panic!("{} lights", scene.lights.len()) };
    assert!((light.radiance - Vec3::new(3.0, 2.0, 1.0)).length() < 1e-6, "the texture is not in it");
    // The image's upper left corner is the panel's, seen from the front
    for (vertex, uv) in light.shape.vertices().iter().zip(&light.texture.as_ref().unwrap().uvs) {
        assert!(near(*uv, DVec2::new(vertex.x * 0.5 + 0.5, 0.5 - vertex.y)), "{vertex}: {uv}");
    }
    // What to load
    let source = scene.light_texture_source(0).unwrap();
    assert_eq!((source.width, source.height, source.srgb), (64, 32, true));
    let part = TexturePart {
        low: layer.low,
        size: layer.size,
        wrap: [Wrap::Repeat; 2],
        aspect: layer.aspect,
        ..TexturePart::default()
    };
    assert_eq!(source.part, part);
    assert_eq!(source.texels[64 * 3 + 5].to_le_bytes(), [20, 24, 40, 255]);
    assert_eq!(scene.light_texture_source(1), None);
    // And what it needs
    let calls = required_effects(&scene);
    assert!(calls.iter().any(|c| c.to_string() == "textured: light 'tv'"), "{calls:?}");
}

#[test]
fn a_turned_image_keeps_its_box() {
    // A quarter turn, and one by 30 degrees about the middle
    let scene = one(screen(|uv| DVec2::new(uv.y, 1.0 - uv.x)));
    assert_eq!((scene.light_textures[0].low, scene.light_textures[0].size), (DVec2::ZERO, DVec2::ONE));
    assert_eq!(scene.lights.len(), 1);

    let turn = |uv: DVec2| DVec2::from_angle(std::f64::consts::FRAC_PI_6).rotate((uv - 0.5) * 0.4) + 0.5;
    let scene = one(screen(turn));
    let light = &scene.lights[0];
    for (vertex, uv) in light.shape.vertices().iter().zip(shown(&scene, light)) {
        assert!(near(uv, turn(DVec2::new(vertex.x * 0.5 + 0.5, 0.5 - vertex.y))), "{vertex}: {uv}");
    }
    let layer = scene.light_textures[0];
    // cos 30° + sin 30°, of 0.4
    assert!(
        near(layer.size, DVec2::splat(0.4 * 1.366_03))
            && near(layer.low + layer.size * 0.5, DVec2::splat(0.5))
    );
}

#[test]
fn repeats_are_a_rectangle_beyond_the_image() {
    let scene = one(screen(|uv| uv * DVec2::new(2.0, 3.0) + DVec2::new(5.25, -7.0)));
    assert_eq!(warnings(&scene), [""; 0]);
    let layer = scene.light_textures[0];
    assert!(near(layer.low, DVec2::new(0.25, 0.0)) && near(layer.size, DVec2::new(2.0, 3.0)), "{layer:?}");
    // Clamped coordinates stay where they are; a whole mirror image turns around
    let clamp = json!({ "wrapS": 33071, "wrapT": 33648 });
    let scene = scene_of(&picture(), &[screen(|uv| uv + DVec2::new(-1.5, 3.0))], &clamp);
    let layer = scene.light_textures[0];
    assert!(near(layer.low, DVec2::new(-1.5, 0.0)) && near(layer.size, DVec2::ONE), "{layer:?}");
    assert_eq!(scene.light_texture_source(0).unwrap().part.wrap, [Wrap::Clamp, Wrap::Mirror]);
    for (vertex, uv) in scene.lights[0].shape.vertices().iter().zip(shown(&scene, &scene.lights[0])) {
        // v = 3.5 - y before, of which 3 to 4 is the image from its lower edge up
        assert!(near(uv, DVec2::new(vertex.x * 0.5 - 1.0, 0.5 + vertex.y)), "{vertex}: {uv}");
    }
}

#[test]
fn a_part_of_an_atlas_is_a_layer_of_its_own() {
    let part = |uv: DVec2| DVec2::new(0.25, 0.5) + uv * DVec2::new(0.25, 0.125);
    let scene = scene_of(
        &picture(),
        &[screen(part), screen(|uv| part(DVec2::ONE - uv)), screen(|uv| uv)],
        &json!({}),
    );
    // The two that show the same share it, one of them upside down
    let layers: Vec<u32> = scene.lights.iter().map(|light| light.texture.as_ref().unwrap().layer).collect();
    assert_eq!((layers, scene.light_textures.len()), (vec![0, 0, 1], 2));
    assert_eq!(
        (scene.light_textures[0].low, scene.light_textures[0].size),
        (part(DVec2::ZERO), DVec2::new(0.25, 0.125))
    );
    let uvs = |light: usize| &scene.lights[light].texture.as_ref().unwrap().uvs;
    assert!(uvs(0).iter().zip(uvs(1)).all(|(a, b)| near(*a, DVec2::ONE - *b)));
}

/// Where in the image object `i` of [`letters`] finds its part, and how large that is.
fn letter(i: u32) -> [DVec2; 2] {
    let size = DVec2::new(1.0 / 16.0, 1.0 / 8.0);
    [size * DVec2::new(f64::from(i % 13), f64::from(i / 13)) + 0.02, size]
}

/// Ninety-one objects in 7 rows of 13 of an atlas, each with a material and a texture of its own; the last
/// one's is of image `last`.
fn letters(last: u32) -> Scene {
    let (mut writer, _) = textured(&picture());
    let again = writer.root["images"][0].clone();
    writer.push("images", again);
    for i in 0..91 {
        let texture = writer.push("textures", json!({ "source": if i == 90 { last } else { 0 } }));
        let material = writer.emitter_of_image(&format!("glow {i}"), [3.0, 2.0, 1.0], texture, false);
        let [low, size] = letter(i);
        writer.object(
            "letter",
            &screen(|uv| low + uv * size),
            material,
            json!({ "translation": [3 * i, 0, 0] }),
        );
    }
    load(writer)
}

#[test]
fn many_emitters_of_one_image_read_it_once() {
    let scene = letters(0);
    assert_eq!((scene.lights.len(), scene.materials.len(), warnings(&scene)), (91, 91, vec![]));
    assert_eq!((scene.images.len(), scene.textures.len()), (1, 1));
    // So many pieces are loaded as a whole
    assert_eq!(scene.light_textures.len(), 1);
    for (i, light) in (0..).zip(&scene.lights) {
        let [low, size] = letter(i);
        for (vertex, uv) in light.shape.vertices().iter().zip(shown(&scene, light)) {
            let on_screen = DVec2::new((vertex.x - f64::from(3 * i)) * 0.5 + 0.5, 0.5 - vertex.y);
            assert!(near(uv, low + on_screen * size), "{i}: {vertex}: {uv}");
        }
    }
    // The twin: another image, though of the same bytes, is read by itself
    assert_eq!(letters(1).images.len(), 2);
}

/// A curved screen of `count` strips, each of which shows its part of the image's upper `share`.
fn strips(count: u32, share: f64) -> Shape {
    let mut shape = Shape::default();
    for i in 0..count {
        let place = |i: u32| f64::from(i) / f64::from(count);
        for (x, y) in [(i, 0.0), (i + 1, 0.0), (i + 1, 1.0), (i, 1.0)] {
            let (sin, cos) = (place(x) * 2.0).sin_cos();
            shape.positions.push(DVec3::new(-cos, y, -sin).as_vec3().to_array());
            shape.uvs.push(DVec2::new(place(x), (1.0 - y) * share).as_vec2().to_array());
        }
        shape.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| 4 * i + corner));
    }
    shape
}

#[test]
fn an_image_in_many_pieces_is_loaded_whole() {
    let scene = one(strips(12, 0.9));
    assert_eq!((scene.lights.len(), scene.light_textures.len()), (12, 1));
    assert_eq!((scene.light_textures[0].low, scene.light_textures[0].size), (DVec2::ZERO, DVec2::ONE));
    let left = scene.lights.iter().flat_map(|light| shown(&scene, light)).map(|uv| uv.x).fold(1.0, f64::min);
    assert_eq!(left, 0.0);
    // The twins: a few pieces, or many of a small part, have their own
    assert_eq!(one(strips(4, 0.9)).light_textures.len(), 4);
    assert_eq!(one(strips(12, 0.4)).light_textures.len(), 12);
}

#[test]
fn a_seam_splits_the_light() {
    // The right half of the panel shows the image's left half
    let half = |x: f32| {
        let mut shape = panel(1.0, 1.0);
        for (uv, position) in shape.uvs.iter_mut().zip(&mut shape.positions) {
            *uv = [0.25 + position[0] * 0.5, 0.5 - position[1]];
            position[0] += x;
        }
        shape
    };
    let mut both = half(0.0);
    let right = half(1.0);
    both.positions.extend(right.positions);
    both.uvs.extend(right.uvs);
    both.normals.extend(right.normals);
    both.indices.extend(right.indices.iter().map(|i| i + 4));
    let scene = one(both.clone());
    assert_eq!((scene.lights.len(), scene.light_textures.len()), (2, 1));
    let text = "light 'tv' (node 0): its texture has seams or bends: 2 polygon lights, one a straight part";
    assert_eq!(warnings(&scene), [text]);
    // The twin: without a texture it is one
    let (mut writer, material) = textured(&picture());
    writer.root["materials"][0].as_object_mut().unwrap().remove("emissiveTexture");
    writer.object("tv", &both, material, json!({}));
    assert_eq!(load(writer).lights.len(), 1);
}

#[test]
fn one_color_needs_no_texture() {
    let at = |x: u32, y: u32| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / DVec2::new(64.0, 32.0);
    // A palette: all vertices at a texel's centre; sRGB 240 and 128 are 0.871 and 0.216 linear, 40 is 0.0212
    let scene = one(screen(|_| at(60, 16)));
    let expected = Vec3::new(3.0 * 0.871_367, 2.0 * 0.215_861, 0.021_219);
    assert!((scene.lights[0].radiance - expected).length() < 1e-5, "{}", scene.lights[0].radiance);
    assert!(scene.lights[0].texture.is_none() && scene.light_textures.is_empty());
    assert!(!scene.effects().contains(Effects::TEXTURED));
    assert_eq!(warnings(&scene), [""; 0]);
    // A line: from black to white, each half of it
    let two = RgbImage::from_fn(2, 1, |x, _| Rgb([x as u8 * 255; 3]));
    let scene = scene_of(&two, &[screen(|uv| DVec2::new(0.25 + 0.5 * uv.x, 0.5))], &json!({}));
    assert!((scene.lights[0].radiance - Vec3::new(1.5, 1.0, 0.5)).length() < 1e-3);
    // An image of one texel; no coordinates, which is (0, 0): the mean of the corners around it, when
    // repeated
    let gray = RgbImage::from_pixel(1, 1, Rgb([188; 3]));
    let scene = scene_of(&gray, &[screen(|uv| uv)], &json!({}));
    assert!((scene.lights[0].radiance.x - 3.0 * 0.502_886).abs() < 1e-5);
    let scene = scene_of(&two, &[panel(2.0, 1.0).plain()], &json!({}));
    assert!((scene.lights[0].radiance.x - 1.5).abs() < 1e-6);
}

#[test]
fn black_parts_are_no_lights() {
    // Only the image's lower right quarter is lit
    let corner = RgbImage::from_fn(64, 64, |x, y| Rgb([if x >= 32 && y >= 32 { 200 } else { 0 }; 3]));
    let quarter = |x: f64, y: f64| screen(move |uv| DVec2::new(x, y) + uv * 0.48);
    let shapes = [quarter(0.0, 0.0), quarter(0.51, 0.0), quarter(0.51, 0.51), screen(|_| DVec2::splat(0.2))];
    let scene = scene_of(&corner, &shapes, &json!({}));
    assert_eq!((scene.lights.len(), scene.light_textures.len()), (1, 1));
    assert!(scene.lights[0].shape.center().x > 5.0, "the third");
    // All are seen, and only what shines is a lamp
    let lamps: Vec<bool> = (0..8).map(|triangle| scene.is_lamp(triangle)).collect();
    assert_eq!(lamps, [false, false, false, false, true, true, false, false]);
}

#[test]
fn a_mapping_that_bends_is_a_light_a_triangle() {
    let mut shape = polygon(&[[-2.0, 0.0], [2.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]);
    shape.uvs = vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let scene = one(shape);
    // On one of them the image is twice as wide, so that each has a layer
    assert_eq!((scene.lights.len(), scene.light_textures.len()), (2, 2));
    assert!(scene.lights.iter().all(|light| light.shape.vertices().len() == 3));
    assert!(warnings(&scene)[0].contains("seams or bends"), "{:?}", warnings(&scene));
}

#[test]
fn what_cannot_be_shown_has_the_mean() {
    // Half white, half black: sRGB 188 would be half, as encoded values 128 would
    let two = RgbImage::from_fn(2, 1, |x, _| Rgb([x as u8 * 255; 3]));
    let cases: [(f64, &str); 4] = [
        (65.0, "repeats its image too often"),
        (1e6, "its texture coordinates are too large"),
        (1e30, "its texture coordinates are too large"),
        (f64::from(f32::MAX), "its texture coordinates are too large"),
    ];
    for (scale, text) in cases {
        let shapes = [screen(|uv| uv * scale), screen(|uv| uv * -scale)];
        let scene = scene_of(&two, &shapes, &json!({}));
        assert_eq!((scene.lights.len(), scene.light_textures.len()), (2, 0), "{scale}");
        for light in &scene.lights {
            assert!(
                (light.radiance - Vec3::new(1.5, 1.0, 0.5)).length() < 1e-5,
                "{scale}: {}",
                light.radiance
            );
        }
        let expected =
            format!("light 'tv' and 1 more: emissiveTexture: {text}: its mean colour is everywhere");
        assert_eq!(warnings(&scene), [expected]);
    }
    // The twin: a little less is shown
    assert_eq!(scene_of(&two, &[screen(|uv| uv * 63.0)], &json!({})).light_textures.len(), 1);
    // NaN is refused with all numbers that are none
    let (mut writer, material) = textured(&two);
    writer.object("tv", &screen(|uv| uv * f64::NAN), material, json!({}));
    assert!(crate::error(writer).contains("TEXCOORD_0[0]"));
}

#[test]
fn a_device_loads_every_layer() {
    let long = RgbImage::from_fn(9000, 2, |x, y| Rgb([x as u8, y as u8, 90]));
    let many = [screen(|uv| uv), screen(|uv| uv * 0.5), screen(|uv| uv * 30.0), screen(|uv| uv * 60.0)];
    let scene = scene_of(&long, &many, &json!({}));
    let widths: Vec<u32> = (0..4).map(|layer| scene.light_texture_source(layer).unwrap().width).collect();
    // 9000 / 4 is within 4096; 30 and 60 of an image within 16384
    assert_eq!(widths, [2250, 2250, 281, 140]);
    assert_eq!(scene.images.len(), 4);
    for layer in 0..4 {
        let source = scene.light_texture_source(layer).unwrap();
        let size = scene.light_texture_size(1024).unwrap();
        source.part.load_constants([source.width, source.height], size, 0, true).unwrap();
    }
    // Surfaces keep the whole image
    assert_eq!(scene.textures[scene.materials[0].emission_texture.unwrap() as usize].image, 0);
    assert_eq!(scene.images[0].width, 9000);
    // Far away, where it is clamped, there is the edge's colour
    let clamp = json!({ "wrapS": 33071, "wrapT": 33071 });
    let scene = scene_of(&picture(), &[screen(|uv| uv + 5000.0)], &clamp);
    assert!(scene.light_textures.is_empty());
    assert!((scene.lights[0].radiance.x - 3.0 * 0.973_445).abs() < 1e-4, "{}", scene.lights[0].radiance.x);
}

#[test]
fn there_are_only_so_many_layers() {
    // As many islands as there may be and ten more, each of an eighth of the image's width, a texel apart
    let shapes: Vec<Shape> = (0..MAX_LIGHT_TEXTURES as u32 + 10)
        .map(|i| screen(move |uv| DVec2::new(f64::from(i % 55), f64::from(i / 55)) / 64.0 + uv * 0.125))
        .collect();
    let (mut writer, material) = textured(&picture());
    // So many pieces cover the image more than once: repeat it, so that they are not within it
    let shapes = shapes.into_iter().map(|mut shape| {
        shape.uvs.iter_mut().for_each(|uv| uv[1] *= 10.0);
        shape
    });
    for shape in shapes {
        writer.object("tv", &shape, material, json!({}));
    }
    let scene = load(writer);
    assert_eq!(scene.light_textures.len(), MAX_LIGHT_TEXTURES);
    let plain = scene.lights.iter().filter(|light| light.texture.is_none());
    assert_eq!(plain.clone().count(), 10);
    assert!(plain.clone().all(|light| light.radiance.x < 2.9 && light.radiance.x > 0.0));
    let text = "light 'tv' and 9 more: emissiveTexture: there are too many light textures: its mean colour \
    is everywhere";
    assert_eq!(warnings(&scene), [text]);
    // So many of them are small
    let size = scene.light_texture_size(4096).unwrap();
    assert!(size.texels() * MAX_LIGHT_TEXTURES as u64 <= MAX_LIGHT_TEXELS);
}

#[test]
fn one_size_fits_all_layers() {
    let wide = RgbImage::from_fn(700, 90, |x, y| Rgb([x as u8, y as u8, 90]));
    let size = |shape: Shape, largest: u32| {
        scene_of(&wide, &[shape], &json!({})).light_texture_size(largest).map(|size| size.side(0))
    };
    assert_eq!(size(screen(|uv| uv), 4096), Some(1024));
    assert_eq!(size(screen(|uv| uv), 512), Some(512));
    assert_eq!(size(screen(|uv| uv), 700), Some(512), "not beyond what is asked for");
    assert_eq!(size(screen(|uv| uv), 0), Some(64));
    assert_eq!(size(screen(|uv| uv * 0.3), 4096), Some(256));
    assert_eq!(size(screen(|uv| uv * 8.0), u32::MAX), Some(2048));
    assert_eq!(size(screen(|_| DVec2::splat(0.4)), 4096), None);
}

/// The dented front of a cylinder, of `count` quads a side, mapped onto the whole image.
fn dented(count: u32) -> Shape {
    let mut shape = Shape::default();
    let corner = |i: u32| f64::from(i) / f64::from(count);
    for (x, y) in (0..=count).flat_map(|y| (0..=count).map(move |x| (x, y))) {
        let (u, v) = (corner(x), corner(y));
        let (sin, cos) = ((u - 0.5) * 2.0).sin_cos();
        let radius = 1.0 + 0.05 * (9.0 * u).sin() * (7.0 * v).sin();
        shape.positions.push(DVec3::new(radius * sin, 2.0 * v - 1.0, radius * cos).as_vec3().to_array());
        shape.uvs.push(DVec2::new(u, 1.0 - v).as_vec2().to_array());
    }
    shape.grid(0, count + 1, count + 1);
    shape
}

/// Radiance by area of all lights, of one colour each.
fn flux(scene: &Scene) -> DVec3 {
    let of = |light: &Light| light.radiance.as_dvec3() * light.shape.area_vector().length();
    scene.lights.iter().map(of).sum()
}

#[test]
fn small_parts_of_a_model_show_their_mean() {
    // Two bright patches, one dim one, and black elsewhere
    let image = RgbImage::from_fn(256, 256, |x, y| match (x / 32, y / 32) {
        (1..=3, 2..=4) => Rgb([x as u8, 255 - y as u8, 200]),
        (5, 1..=6) => Rgb([255, 255, (x * y) as u8]),
        (7, 7) => Rgb([3, 3, 3]),
        _ => Rgb([0; 3]),
    });
    let scene = scene_of(&image, &[dented(24)], &json!({}));
    assert!(scene.light_textures.is_empty() && scene.lights.iter().all(|light| light.texture.is_none()));
    let words = warnings(&scene);
    let small = "small, one of many parts of its surface: its mean colour is everywhere";
    assert!(words.iter().any(|warning| warning.ends_with(small)), "{words:?}");
    // All light is there: the triangles' own areas by the image, 256 samples a triangle
    let shape = dented(24);
    let decode = |byte: u8| match f64::from(byte) / 255.0 {
        encoded if encoded <= 0.04045 => encoded / 12.92,
        encoded => ((encoded + 0.055) / 1.055).powf(2.4),
    };
    let mut expected = DVec3::ZERO;
    for corners in shape.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| {
            let at = corners[i] as usize;
            (Vec3::from(shape.positions[at]).as_dvec3(), DVec2::from_array(shape.uvs[at].map(f64::from)))
        });
        let area = (b.0 - a.0).cross(c.0 - a.0).length() / 2.0;
        let mut sum = DVec3::ZERO;
        for (i, j) in (0..16).flat_map(|i| (0..16).map(move |j| (i, j))) {
            let (s, t) = (((f64::from(i) + 0.5) / 16.0).sqrt(), (f64::from(j) + 0.5) / 16.0);
            let uv = a.1 * (1.0 - s) + b.1 * (s * (1.0 - t)) + c.1 * (s * t);
            let texel = (uv * 256.0).min(DVec2::splat(255.0)).as_uvec2();
            sum += DVec3::from_array(image.get_pixel(texel.x, texel.y).0.map(decode));
        }
        expected += sum / 256.0 * area * DVec3::new(3.0, 2.0, 1.0);
    }
    // A hundredth: nearest texels here, filtered ones there, at the patches' edges
    let ratio = flux(&scene) / expected;
    assert!((ratio - 1.0).abs().max_element() < 0.01, "{ratio}");
    // The twin: few parts show the image
    let few = scene_of(&image, &[dented(7)], &json!({}));
    assert!(few.lights.iter().any(|light| light.texture.is_some()));
    assert!(!warnings(&few).iter().any(|warning| warning.contains("one of many parts")));
}
