//! Lookup, blur and pyramid against their definitions.

use super::*;
use arealight::PyramidSize;

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
    assert!(matches!(error, BadTexture::NoLight { index: 1, .. }));
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
fn a_blur_is_the_integral_of_the_gaussian() {
    let texture = random_texture(6, 4);
    for (u, v, sigma) in [(0.3, 0.6, 0.03), (0.02, 0.9, 0.2), (1.1, 0.5, 0.35), (0.4, 0.4, 0.002)] {
        // A midpoint rule over eight deviations; beyond the kinks its error falls with the square of the
        // step: 1e-5
        let steps = 1200;
        let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
        let place = |i: usize| ((i as f64 + 0.5) / steps as f64 * 2.0 - 1.0) * 8.0;
        for i in 0..steps {
            for j in 0..steps {
                let (x, y) = (place(i), place(j));
                let gaussian = (-0.5 * (x * x + y * y)).exp();
                let place = DVec2::new(u + sigma * x, v + sigma * y);
                sum += texture.sample(place.map(mirrored_at_the_edges)) * gaussian;
                weight += gaussian;
            }
        }
        let grid = Blur::new(&texture, &[0.5, u], &[v, 0.1], DVec2::splat(sigma));
        let off = (grid.at(1, 0) - sum / weight).abs().max_element();
        assert!(off < 1e-5, "{u} {v}, {sigma}: {off}");
        assert_eq!(grid.values().len(), 4);
    }
    let sharp = Blur::new(&texture, &[0.3], &[0.6], DVec2::ZERO).at(0, 0);
    assert!((sharp - texture.sample(DVec2::new(0.3, 0.6))).abs().max_element() < 1e-14);
}

/// A coordinate where those beyond 0 to 1 are mirrored, without end.
fn mirrored_at_the_edges(coordinate: f64) -> f64 {
    let within = coordinate.rem_euclid(2.0);
    within.min(2.0 - within)
}

#[test]
fn a_pyramid_of_one_colour_has_it_everywhere() {
    let color = DVec3::new(0.3, 4.0, 65_504.0);
    let size = PyramidSize::new(128).unwrap();
    let pyramid = Pyramid::new(&Texture::from_fn(1, 1, |_, _| color), size);
    for level in 0..size.levels() {
        let image = pyramid.level(level);
        assert_eq!([image.width() as u32, image.height() as u32], [size.side(level); 2]);
        // The kernels are rounded to float32
        for texel in image.texels() {
            assert!(((*texel - color) / color).abs().max_element() < 1e-6);
        }
    }
}

#[test]
fn level_zero_is_the_image() {
    let texture = random_texture(64, 64);
    let pyramid = Pyramid::new(&texture, PyramidSize::new(64).unwrap());
    assert_eq!(pyramid.size().side(0), 64);
    for uv in [DVec2::new(0.31, 0.77), DVec2::ZERO, DVec2::ONE, DVec2::new(0.9, -0.08)] {
        assert!((pyramid.lookup(uv, 0.0) - texture.sample(uv)).abs().max_element() < 1e-13, "{uv}");
    }
    // Clamped at both ends, also where no level is named
    let middle = DVec2::splat(0.5);
    assert_eq!(pyramid.lookup(middle, -1.0), pyramid.lookup(middle, 0.0));
    assert_eq!(pyramid.lookup(middle, 99.0), pyramid.lookup(middle, 4.0));
    assert_eq!(pyramid.lookup(middle, f64::NAN), pyramid.lookup(middle, 0.0));
}

#[test]
fn every_level_has_the_mean_of_an_image_of_any_aspect() {
    for (width, height) in [(64, 64), (70, 40), (128, 64), (48, 144), (512, 32), (9, 288), (1, 1), (3, 2)] {
        let texture = random_texture(width, height);
        let pyramid = Pyramid::new(&texture, PyramidSize::for_image(width as u32, height as u32));
        let mean = texture.mean();
        for level in 0..pyramid.size().levels() {
            // Tents that reach beyond the edge count its texels for more: where sides don't divide the
            // layer's, by a part of a texel in as many as there are
            assert!(
                ((pyramid.level(level).mean() - mean) / mean).abs().max_element() < 0.02,
                "{width} x {height}, {level}"
            );
        }
    }
}
