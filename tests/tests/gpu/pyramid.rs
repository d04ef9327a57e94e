//! Images on lights as the GPU stores them, every level, against float64: images of any size, repeated and in
//! part; what is black, blinding or not a number; what lobes see of them; and layers that are left alone.

use arealight::Wrap;
use arealight_engine::{Engine, EngineError, Of, SourceImage, SourceTexels};
use arealight_oracle::texture::Pyramid;
use arealight_tests::prelude::*;
use glam::DVec4;

/// The largest number of sixteen bits.
const LARGEST: f64 = 65504.0;

/// Half a unit in the last place of sixteen bits, as a part of the number.
const HALF_ULP: f64 = 1.0 / 2048.0;

/// Half of the smallest number of sixteen bits.
const HALF_SMALLEST: f64 = 1.0 / 33_554_432.0;

/// An image in linear light.
#[derive(Clone)]
struct Picture {
    texels: Vec<[f32; 4]>,
    size: [u32; 2],
    part: TexturePart,
}

impl Picture {
    fn new(size: [u32; 2], mut texel: impl FnMut(u32, u32) -> [f32; 3]) -> Self {
        let [width, height] = size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| {
            let [r, g, b] = texel(x, y);
            // Alpha has no meaning
            [r, g, b, 0.3]
        });
        Self { texels: texels.collect(), size, part: TexturePart::default() }
    }

    /// Numbers from 0 to 4, a tenth of them black: as rough as a picture can be.
    fn noise(size: [u32; 2], seed: u64) -> Self {
        let mut random = Random::new(seed);
        Self::new(size, |_, _| {
            [(); 3].map(|()| if random.unit() < 0.1 { 0.0 } else { random.between(0.0, 4.0) as f32 })
        })
    }

    fn source(&self) -> SourceImage<'_> {
        SourceImage { texels: SourceTexels::Linear(&self.texels), size: self.size, part: self.part }
    }

    /// The texel that stands at a column and a row, however far away, as it is loaded.
    fn texel(&self, place: [i64; 2]) -> DVec3 {
        let wrapped = [0, 1].map(|axis| {
            let count = i64::from(self.size[axis]);
            match self.part.wrap[axis] {
                Wrap::Clamp => place[axis].clamp(0, count - 1),
                Wrap::Repeat => place[axis].rem_euclid(count),
                Wrap::Mirror => {
                    let within = place[axis].rem_euclid(2 * count);
                    within.min(2 * count - 1 - within)
                }
            }
        });
        let [r, g, b, _] = self.texels[(wrapped[1] * i64::from(self.size[0]) + wrapped[0]) as usize];
        // `max` takes NaN to zero
        let color = DVec3::new(r.into(), g.into(), b.into()) / f64::from(self.part.divisor);
        color.max(DVec3::ZERO).min(DVec3::splat(LARGEST))
    }

    /// The part that is shown, resampled by a tent: the kernel's twin.
    fn resampled(&self, size: PyramidSize) -> Texture {
        let content = size.side(0);
        let taps = [0, 1].map(|axis| -> Vec<Vec<(i64, f64)>> {
            let texels = f64::from(self.size[axis]);
            let stride = self.part.size[axis] * texels / f64::from(content);
            let radius = stride.max(1.0);
            let tent = |texel: u32| {
                let center = self.part.low[axis] * texels + (f64::from(texel) + 0.5) * stride - 0.5;
                let (first, last) = ((center - radius).ceil() as i64, (center + radius).floor() as i64);
                let weight = |tap: i64| (1.0 - (tap as f64 - center).abs() / radius).max(0.0);
                let sum: f64 = (first..=last).map(weight).sum();
                (first..=last).map(|tap| (tap, weight(tap) / sum)).collect()
            };
            (0..content).map(tent).collect()
        });
        let texel = |x: usize, y: usize| -> DVec3 {
            let row = |(tap_y, weight): &(i64, f64)| -> DVec3 {
                let along = taps[0][x].iter().map(|(tap_x, weight)| self.texel([*tap_x, *tap_y]) * *weight);
                along.sum::<DVec3>() * *weight
            };
            taps[1][y].iter().map(row).sum()
        };
        Texture::from_fn(content as usize, content as usize, texel)
    }

    /// What a resampled texel may be off, as a part of the largest: the tent's place is rounded to 2^-24 of
    /// the way to it, and changes the weights by as much of its radius; twice, for two axes, and twice, for
    /// both sides of a tent.
    fn resampling_error(&self, size: PyramidSize) -> f64 {
        let off = |axis: usize| {
            let texels = self.part.size[axis] * f64::from(self.size[axis]);
            texels / (texels / f64::from(size.side(0))).max(1.0)
        };
        4.0 * 2.0_f64.powi(-24) * (1.0 + off(0).max(off(1)))
    }
}

/// Compares every mip of a layer with its twin.
fn compare(
    engine: &Engine,
    layer: u32,
    picture: &Texture,
    resampling: f64,
    comparison: &mut Comparison,
    name: &str,
) {
    let largest = picture.brightest();
    let mut expected = picture.clone();
    for level in 0..engine.texture_size().expect("textures were loaded").levels() {
        let found = engine.download_level(layer, Of::Image, level).unwrap();
        assert_eq!(found.len(), expected.texels().len());
        // Each level rounds once, and averages what the ones before have rounded: nothing is negative, so
        // that relative errors only add. In each, float32 rounds 4 sums and products, which is little beside.
        let relative = f64::from(level + 1) * (HALF_ULP + 4.0 * 2.0_f64.powi(-24));
        for (index, (found, texel)) in found.iter().zip(expected.texels()).enumerate() {
            for channel in 0..3 {
                let bound =
                    relative * texel[channel] + f64::from(level + 1) * HALF_SMALLEST + resampling * largest;
                comparison.add(found[channel].into(), texel[channel], bound, || {
                    let (x, y) = (index % expected.width(), index / expected.width());
                    format!("{name}, level {level}, texel {x} {y}")
                });
            }
            assert_eq!(found[3], 1.0, "alpha");
        }
        expected = halved(&expected);
    }
}

/// Means of four texels.
fn halved(finer: &Texture) -> Texture {
    let side = (finer.width() / 2).max(1);
    Texture::from_fn(side, side, |x, y| {
        let at = |column: usize, row: usize| {
            finer.texel((2 * x + column).cast_signed(), (2 * y + row).cast_signed())
        };
        0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))
    })
}

/// Loads the pictures, a layer each, and compares them all.
fn check(engine: &mut TestEngine, size: PyramidSize, pictures: &[Picture], comparison: &mut Comparison) {
    let sources: Vec<_> = pictures.iter().map(Picture::source).collect();
    engine.load_textures(size, &sources).unwrap();
    for (layer, picture) in (0..).zip(pictures) {
        let name = format!("{:?} in {size:?}, {:?}", picture.size, picture.part);
        compare(engine, layer, &picture.resampled(size), picture.resampling_error(size), comparison, &name);
    }
}

#[test]
fn every_level_of_images_of_any_size_is_the_twins() {
    let Some(mut engine) = TestEngine::new() else { return };
    let mut comparison = Comparison::new("pyramids");
    let small = PyramidSize::new(64).unwrap();
    let sizes = [[1, 1], [1, 7], [9, 1], [3, 5], [64, 64], [63, 65], [100, 37], [1, 4096]];
    let pictures: Vec<_> = (1..).zip(sizes).map(|(seed, size)| Picture::noise(size, seed)).collect();
    check(&mut engine, small, &pictures, &mut comparison);
    let large = PyramidSize::new(256).unwrap();
    let pictures = [[256, 64], [300, 200], [4096, 2]].map(|size| Picture::noise(size, 20));
    check(&mut engine, large, &pictures, &mut comparison);
    comparison.assert_all();
}

/// Every layer of an image.
const LAYERS: [Of; 4] = [Of::Image, Of::A, Of::BRows, Of::BColumns];

#[test]
fn what_lobes_see_is_the_sum_over_all_texels() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(64).unwrap();
    let mut worst = 0.0_f64;
    for (aspect, is_ellipse) in [(1.0, false), (1.0, true), (2.0, false), (0.25, false)] {
        let part = TexturePart { aspect, is_ellipse, ..TexturePart::default() };
        // Of images with texels that are no squares on the light, rows are skipped
        let checker = |x: u32, y: u32| [(x / 8 + y / 8) % 2, x / 32, 1].map(|it| it as f32);
        let noise = Picture::noise([if aspect == 1.0 { 64 } else { 8 }; 2], 5);
        let pictures = [noise, Picture::new([64, 64], checker)];
        let pictures = pictures.map(|picture| Picture { part, ..picture });
        engine.load_textures(size, &pictures.each_ref().map(Picture::source)).unwrap();
        for (layer, picture) in (0..).zip(&pictures) {
            let twin = Pyramid::new(&picture.resampled(size), size, aspect.into(), is_ellipse);
            for (of, level) in LAYERS.iter().flat_map(|of| (0..size.levels()).map(move |at| (*of, at))) {
                // Only ratios count: over what is covered, and of B over how far it is off
                let level_of = |of| engine.download_level(layer, of, level).unwrap();
                let (found, covered) = (level_of(of), level_of(Of::A));
                let pairs = twin.level(of as usize, level).iter().zip(twin.level(1, level));
                let (mut squares, mut count) = (0.0, 0.0);
                for (index, ((found, covered), (expected, over))) in
                    found.iter().zip(&covered).zip(pairs).enumerate()
                {
                    // Within two sides of the light: few nodes are farther out
                    let side = size.side(level) as usize;
                    let node = DVec2::new((index % side) as f64 + 0.5, (index / side) as f64 + 0.5);
                    if (node / side as f64 - 0.5).abs().max_element() > 0.45 {
                        continue;
                    }
                    count += 1.0;
                    let (found, expected) = if of == Of::Image {
                        (DVec4::from_array(found.map(f64::from)), *expected)
                    } else {
                        let found = DVec4::from_array(found.map(f64::from)) / f64::from(covered[3]);
                        (found, *expected / over.w)
                    };
                    let off = (found - expected) / (1.0 + expected.w.abs());
                    squares += off.length_squared() / 4.0;
                }
                let off = (squares / count).sqrt();
                println!("aspect {aspect}, {is_ellipse}, picture {layer}, {of:?}, level {level}: {off:.5}");
                worst = worst.max(off);
            }
        }
    }
    // What falls beyond three heights, and what is between nodes of coarser levels
    assert!(worst < 0.03, "{worst}");
}

#[test]
fn the_comparison_finds_another_picture_another_kernel_and_a_cut_bit() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(64).unwrap();
    let picture = Picture::noise([64, 64], 5);
    engine.load_textures(size, &[picture.source()]).unwrap();
    let failures = |twin: &Picture, of: PyramidSize| {
        let mut comparison = Comparison::new("twin");
        compare(&engine, 0, &twin.resampled(of), 0.0, &mut comparison, "twin");
        comparison.failures()
    };
    assert_eq!(failures(&picture, size), 0);
    // One texel of 4096 brighter by a hundredth
    let mut brighter = picture.clone();
    brighter.texels[2000][1] *= 1.01;
    assert!(failures(&brighter, size) > 0);
    // Numbers that are cut to sixteen bits, not rounded, are all too small: seen as twins that are larger by
    // as much
    let mut cut = picture.clone();
    for texel in &mut cut.texels {
        *texel = texel.map(|value| value * (1.0 + 1.5 * HALF_ULP as f32));
    }
    assert!(failures(&cut, size) > 10_000);
}

#[test]
fn parts_and_repeats_are_the_twins() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(128).unwrap();
    let part = |low: [f64; 2], size: [f64; 2], wrap: [Wrap; 2]| TexturePart {
        low: DVec2::from_array(low),
        size: DVec2::from_array(size),
        wrap,
        divisor: 0.3,
        ..TexturePart::default()
    };
    let (clamp, repeat, mirror) = (Wrap::Clamp, Wrap::Repeat, Wrap::Mirror);
    let mut pictures: Vec<_> = [
        part([0.25, 0.5], [0.5, 0.25], [clamp, clamp]),
        part([-0.5, -1.0], [2.0, 3.0], [clamp, clamp]),
        part([-0.5, -1.0], [2.0, 3.0], [repeat, mirror]),
        part([0.9, 3.7], [7.0, 0.3], [mirror, repeat]),
        part([-100.3, 99.1], [0.7, 1.9], [repeat, clamp]),
        part([0.0, 0.0], [16.0, 16.0], [mirror, mirror]),
        part([3.1, -3.1], [1e-3, 1e-3], [repeat, clamp]),
    ]
    .into_iter()
    .map(|part| Picture { part, ..Picture::noise([50, 31], 7) })
    .collect();
    // Texels that are copied one to one, from beyond the image
    let shifted = part([0.25, -0.5], [1.0, 1.0], [repeat, mirror]);
    pictures.push(Picture { part: shifted, ..Picture::noise([128, 128], 8) });
    let mut comparison = Comparison::new("parts");
    check(&mut engine, size, &pictures, &mut comparison);
    comparison.assert_all();
}

#[test]
fn srgb_is_decoded() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(64).unwrap();
    let linear = |code: u8| {
        let encoded = f64::from(code) / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    };
    let mut comparison = Comparison::new("sRGB");
    // Every code, in an image that is copied and in one that is resampled
    for width in [64, 50] {
        let code = |x: u32, y: u32| [(x + 64 * y) % 256, (x + 64 * y) / 256, 255].map(|code| code as u8);
        let linear = Picture::new([width, 64], |x, y| code(x, y).map(|code| linear(code) as f32));
        let places = (0..64).flat_map(|y| (0..width).map(move |x| (x, y)));
        let codes: Vec<[u8; 4]> = places
            .map(|(x, y)| {
                let [r, g, b] = code(x, y);
                [r, g, b, 7]
            })
            .collect();
        let source = SourceImage { texels: SourceTexels::Srgb(&codes), ..linear.source() };
        engine.load_textures(size, &[source]).unwrap();
        // exp2 and log2 of float32, which pow is made of, are rounded by a few 2^-22
        let error = 2e-6 + linear.resampling_error(size);
        compare(&engine, 0, &linear.resampled(size), error, &mut comparison, "sRGB");
    }
    comparison.assert_all();
}

#[test]
fn a_constant_stays_what_it_is_to_the_bit() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(128).unwrap();
    // Numbers of sixteen bits, the smallest and the largest among them
    let values = [1.0, 0.1, 3.7e-5, 65504.0, 5.9604645e-8, 6.1e-5, 1000.0 / 3.0, 0.0]
        .map(|value: f32| f32::from(half::f16::from_f32(value)));
    for source in [[128, 128], [5, 3], [1, 1], [1000, 77]] {
        let pictures: Vec<_> = values.iter().map(|value| Picture::new(source, |_, _| [*value; 3])).collect();
        let sources: Vec<_> = pictures.iter().map(Picture::source).collect();
        engine.load_textures(size, &sources).unwrap();
        for (layer, value) in (0..).zip(values) {
            for level in 0..size.levels() {
                let found = engine.download_level(layer, Of::Image, level).unwrap();
                assert!(
                    found.iter().all(|texel| *texel == [value, value, value, 1.0]),
                    "{value} from {source:?}, level {level}: {:?}",
                    found.iter().find(|texel| texel[0] != value)
                );
            }
        }
    }
}

#[test]
fn what_is_blinding_or_not_a_number_stays_where_it_is() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(64).unwrap();
    let wild = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, f32::MAX, 65504.0, 65519.9, 1e-40];
    let mut pictures = vec![];
    // Alone in the dark, in images that are copied, magnified and minified
    for (seed, value) in (0..).zip(wild) {
        let side = [64, 13, 200][seed % 3];
        let middle = side / 2;
        pictures.push(Picture::new([side, side], |x, y| {
            if (x, y) == (middle, middle) { [value; 3] } else { [0.0; 3] }
        }));
    }
    // All at once, beside black and white
    let mut random = Random::new(3);
    pictures.push(Picture::new([64, 64], |_, _| {
        [(); 3].map(|()| match random.bits() % 10 {
            8 => 0.0,
            9 => 1.0,
            other => wild[other as usize],
        })
    }));
    pictures.push(Picture::new([64, 64], |x, y| if (x + y) % 2 == 0 { [65504.0; 3] } else { [0.0; 3] }));
    let mut comparison = Comparison::new("wild numbers");
    check(&mut engine, size, &pictures, &mut comparison);
    comparison.assert_all();
}

#[test]
fn updating_a_layer_leaves_the_others_alone() {
    let Some(mut engine) = TestEngine::new() else { return };
    let size = PyramidSize::new(64).unwrap();
    let pictures: Vec<_> = (0..4).map(|seed| Picture::noise([64, 64], seed)).collect();
    let sources: Vec<_> = pictures.iter().map(Picture::source).collect();
    engine.load_textures(size, &sources).unwrap();
    let every_level = |engine: &Engine, layer: u32| -> Vec<Vec<[u32; 4]>> {
        let bits = |texel: &[f32; 4]| texel.map(f32::to_bits);
        let level = |of, level| engine.download_level(layer, of, level).unwrap().iter().map(bits).collect();
        LAYERS.iter().flat_map(|of| (0..size.levels()).map(|at| level(*of, at))).collect()
    };
    let before: Vec<_> = (0..4).map(|layer| every_level(&engine, layer)).collect();
    let another = Picture::noise([64, 64], 99);
    engine.update_texture(2, &another.source()).unwrap();
    for layer in 0..4 {
        let after = every_level(&engine, layer);
        for (level, (after, before)) in after.iter().zip(&before[layer as usize]).enumerate() {
            // B of a single node is 0, nearly
            let same = after == before || layer == 2 && after.len() == 1;
            assert_eq!(same, layer != 2 || after.len() == 1, "layer {layer}, level {level}");
        }
    }
    let mut comparison = Comparison::new("the updated layer");
    compare(&engine, 2, &another.resampled(size), 0.0, &mut comparison, "updated");
    comparison.assert_all();
}

#[test]
fn what_is_not_there_is_named() {
    let Some(mut engine) = TestEngine::new() else { return };
    let screen = Light {
        name: "screen".into(),
        radiance: Vec3::ONE,
        shape: LightShape::Polygon(vec![DVec3::ZERO, DVec3::X, DVec3::Y]),
        texture: Some(LightTexture { layer: 1, uvs: vec![DVec2::ZERO, DVec2::X, DVec2::Y] }),
        ..Light::default()
    };
    let lights = [Light { texture: None, ..screen.clone() }, screen];
    let error = engine.check_layers(&lights).unwrap_err();
    assert_eq!(error.to_string(), "lights[1] 'screen': texture: layer 1 is not there: there are 0");
    engine.check_layers(&lights[..1]).unwrap();

    let size = PyramidSize::new(64).unwrap();
    let picture = Picture::noise([3, 2], 1);
    engine.load_textures(size, &[picture.source(), picture.source()]).unwrap();
    engine.check_layers(&lights).unwrap();
    for (layer, level) in [(2, 0), (0, 7)] {
        let error = engine.download_level(layer, Of::Image, level).unwrap_err();
        assert!(matches!(error, EngineError::NoTextureLevel { layers: 2, levels: 7, .. }), "{error}");
    }
    let short = SourceImage { size: [3, 3], ..picture.source() };
    let error = engine.update_texture(1, &short).unwrap_err();
    assert_eq!(error.to_string(), "image of texture layer 1: 6 texels given for 3 x 3");
    let part = TexturePart { size: DVec2::new(1.0, f64::NAN), ..TexturePart::default() };
    let error = engine.update_texture(1, &SourceImage { part, ..picture.source() }).unwrap_err();
    assert!(error.to_string().starts_with("layer 1 of the light textures: size: "), "{error}");
    // With no image there are no textures
    engine.load_textures(size, &[]).unwrap();
    assert_eq!((engine.texture_layers(), engine.texture_size()), (0, None));
}
