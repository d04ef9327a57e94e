//! Lookup and pyramid against their definitions.

use super::*;
use arealight::PyramidSize;
use glam::DVec4;

fn random_texture(width: usize, height: usize) -> Texture {
    Texture::from_fn(width, height, |x, y| {
        let value = |c: usize| ((x * 7919 + y * 104_729 + c * 1299) % 1009) as f64 / 1008.0;
        DVec3::new(value(0), value(1), value(2))
    })
}

#[test]
fn texels_that_are_no_texture_are_refused() {
    let error = Texture::new(2, 2, vec![DVec3::ONE; 3]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "texels: 3 given for 2 x 2; give one row after the other, at least one texel in all"
    );
    assert!(Texture::new(0, 5, Vec::new()).is_err());
    assert!(Texture::new(usize::MAX, 2, vec![DVec3::ONE; 2]).is_err());
    let error = Texture::new(1, 2, vec![DVec3::ONE, DVec3::NAN]).unwrap_err();
    assert!(matches!(error, BadTexture::NotFinite { index: 1, .. }));
}

#[test]
fn a_lookup_is_bilinear_and_starts_at_the_top_left_corner() {
    let texture =
        Texture::new(2, 2, [0.0, 1.0, 2.0, 4.0].map(DVec3::splat).to_vec()).expect("four finite texels");
    let at = |u: f64, v: f64| texture.sample(DVec2::new(u, v)).x;
    assert_eq!([at(0.25, 0.25), at(0.75, 0.25), at(0.25, 0.75), at(0.75, 0.75)], [0.0, 1.0, 2.0, 4.0]);
    assert_eq!(at(0.5, 0.5), 1.75);
    assert_eq!([at(-3.0, 0.0), at(1.0, 0.1), at(f64::NAN, 9.0)], [0.0, 1.0, 2.0], "clamped");
}

#[test]
fn equal_sizes_copy_and_larger_ones_interpolate() {
    let texture = random_texture(5, 3);
    assert_eq!(texture.resampled(5, 3), texture);
    let larger = texture.resampled(20, 9);
    for row in 0..9 {
        for column in 0..20 {
            let uv = DVec2::new((column as f64 + 0.5) / 20.0, (row as f64 + 0.5) / 9.0);
            let off = (larger.texel(column, row) - texture.sample(uv)).abs().max_element();
            assert!(off < 1e-14, "{column}, {row}: {off}");
        }
    }
    assert_eq!(random_texture(1, 1).resampled(64, 64).texel(40, 3), random_texture(1, 1).texel(0, 0));
}

#[test]
fn smaller_ones_are_means_under_a_tent() {
    // Four times smaller: tents of radius four texels, weights 0.5 1.5 2.5 3.5 3.5 2.5 1.5 0.5 of 16
    let texture = random_texture(16, 1);
    let weights = [0.5, 1.5, 2.5, 3.5, 3.5, 2.5, 1.5, 0.5];
    let expected = |index: isize| -> DVec3 {
        (0..8).map(|tap| texture.texel(4 * index - 2 + tap, 0) * (weights[tap as usize] / 16.0)).sum()
    };
    let smaller = texture.resampled(4, 1);
    for index in 0..4 {
        let off = (smaller.texel(index, 0) - expected(index)).abs().max_element();
        assert!(off < 1e-15, "{index}: {off}");
    }
}

#[test]
fn a_pyramid_of_one_colour_sees_as_much_as_it_covers() {
    let color = DVec3::new(0.3, 4.0, 65_504.0);
    let size = PyramidSize::new(64).unwrap();
    for is_ellipse in [false, true] {
        let pyramid = Pyramid::new(&Texture::from_fn(1, 1, |_, _| color), size, 2.0, is_ellipse);
        for (layer, level) in (0..4).flat_map(|layer| (0..size.levels()).map(move |level| (layer, level))) {
            let texels = pyramid.level(layer, level);
            assert_eq!(texels.len() as u32, size.side(level).pow(2));
            for texel in texels {
                let off = (texel.truncate() / color - texel.w).abs().max_element();
                assert!(off < 1e-12, "{layer}, {level}: {texel}");
            }
        }
        // From afar all of it
        let area = if is_ellipse { std::f64::consts::FRAC_PI_4 } else { 1.0 };
        let far = pyramid.lookup(1, DVec2::splat(0.5), 99.0).w;
        assert!((far - area).abs() < 0.01, "{far}");
    }
}

#[test]
fn what_is_seen_of_a_white_image_is_its_form_factor() {
    // Lambert, the light parallel: the form factor, and half a light's that stands upright beside
    let pyramid = Pyramid::new(&random_texture(1, 1), PyramidSize::new(64).unwrap(), 1.0, false);
    let height = pyramid.size().height(3);
    let corner = 0.5 / height;
    let slant = (1.0 + corner * corner).sqrt();
    let expected = 4.0 / (2.0 * std::f64::consts::PI) * 2.0 * (corner / slant) * (corner / slant).atan();
    let scale = 1.0 + std::f64::consts::PI * height * height;
    let found = pyramid.lookup(1, DVec2::splat(0.5), 3.0).w / scale;
    // Between nodes a third of a height apart
    assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    assert!(pyramid.lookup(2, DVec2::splat(0.5), 3.0).w.abs() < 1e-12, "B is odd");
}

#[test]
fn level_zero_is_the_image() {
    let texture = random_texture(64, 64);
    let pyramid = Pyramid::new(&texture, PyramidSize::new(64).unwrap(), 1.0, false);
    for uv in [DVec2::new(0.31, 0.77), DVec2::ZERO, DVec2::ONE, DVec2::new(0.9, -0.08)] {
        let off = (pyramid.lookup(0, uv, 0.0).truncate() - texture.sample(uv)).abs().max_element();
        assert!(off < 1e-13, "{uv}");
    }
    // Clamped at both ends, also where no level is named
    let middle = DVec2::splat(0.5);
    assert_eq!(pyramid.lookup(0, middle, -1.0), pyramid.lookup(0, middle, 0.0));
    assert_eq!(pyramid.lookup(0, middle, 99.0), pyramid.lookup(0, middle, 6.0));
    assert_eq!(pyramid.lookup(0, middle, f64::NAN), pyramid.lookup(0, middle, 0.0));
}

#[test]
fn from_afar_an_image_of_any_aspect_shows_its_mean() {
    for (width, height) in [(64, 64), (70, 40), (48, 144), (512, 32), (9, 288), (1, 1), (3, 2)] {
        let texture = random_texture(width, height);
        let size = PyramidSize::new(64).unwrap();
        let pyramid = Pyramid::new(&texture, size, width as f64 / height as f64, false);
        let mean = texture.mean();
        let mut found = vec![pyramid.lookup(1, DVec2::splat(0.5), 99.0)];
        found.extend((0..size.levels()).map(|level| {
            let texels = pyramid.level(0, level);
            texels.iter().sum::<DVec4>() / texels.len() as f64
        }));
        for found in found {
            // Tents that reach beyond the edge count its texels for more: where sides don't divide the
            // layer's, by a part of a texel in as many as there are
            let off = (found.truncate() / found.w / mean - 1.0).abs().max_element();
            assert!(off < 0.03, "{width} x {height}: {off}");
        }
    }
}
