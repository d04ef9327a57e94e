//! The grain of shadows: no pattern that an eye finds is left by a mean over pixels.

use crate::shadows::{flat, options, surfaces};
use arealight_tests::prelude::*;
use arealight_tests::shadow_patch::{PatchPasses, SIDE, ShadowPatch};

const SIZE: usize = SIDE as usize;

/// The standard deviation of the mean, in pixels, and the frequencies that it lets through, in periods over
/// the picture.
const WIDTH: f64 = 2.0;
const MOST_PERIODS: i32 = 12;

/// The largest power of a frequency in the Gaussian mean of a picture, within a window that is smooth at the
/// edges. Waves longer than two thirds of the picture are its brightness.
fn peak(picture: &[f64]) -> f64 {
    let mean = picture.iter().sum::<f64>() / picture.len() as f64;
    let window = |i: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / SIZE as f64).cos();
    let wave = |periods: i32, i: usize| TAU * f64::from(periods) * i as f64 / SIZE as f64;
    let mut largest = 0.0_f64;
    for across in 0..=MOST_PERIODS {
        let rows: Vec<[f64; 2]> = (0..SIZE)
            .map(|y| {
                let mut sum = [0.0; 2];
                for x in 0..SIZE {
                    let value = (picture[y * SIZE + x] - mean) * window(x) * window(y);
                    let (sin, cos) = wave(across, x).sin_cos();
                    sum = [sum[0] + value * cos, sum[1] + value * sin];
                }
                sum
            })
            .collect();
        for down in -MOST_PERIODS..=MOST_PERIODS {
            let square = f64::from(across * across + down * down);
            if square < 2.25 {
                continue;
            }
            let mut sum = [0.0; 2];
            for (y, row) in rows.iter().enumerate() {
                let (sin, cos) = wave(down, y).sin_cos();
                sum = [sum[0] + row[0] * cos - row[1] * sin, sum[1] + row[0] * sin + row[1] * cos];
            }
            let frequency = square / (SIZE * SIZE) as f64;
            let passes = (-TAU * TAU * WIDTH * WIDTH * frequency).exp();
            largest = largest.max((sum[0] * sum[0] + sum[1] * sum[1]) * passes);
        }
    }
    largest
}

/// The peak of random numbers that are 1 as often as a picture's: of four the largest.
fn peak_of_chance(picture: &[f64]) -> f64 {
    let mean = picture.iter().sum::<f64>() / picture.len() as f64;
    let mut state = 1_u64;
    let mut coin = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u8::from((state >> 33) as f64 / f64::from(1_u32 << 31) < mean))
    };
    (0..4).map(|_| peak(&(0..picture.len()).map(|_| coin()).collect::<Vec<_>>())).fold(0.0, f64::max)
}

#[test]
fn no_frequency_stands_out_of_random_numbers() {
    let Some(engine) = TestEngine::new() else { return };
    let passes = PatchPasses::new(&engine, ShadeOptions { shadow_rays: 1, ..options() }, ShadowFilter::Off);
    let light = |x: [f64; 2]| flat(1.5, &[[x[0], -0.6], [x[0], 0.6], [x[1], 0.6], [x[1], -0.6]]);
    let corner = |x: f32, y: f32| Vec3::new(-100.0 * x, 100.0 * y, 0.01);
    for (surface, material, view) in surfaces() {
        // Half of one of two lights is hidden
        let patch = ShadowPatch {
            material,
            view,
            lights: vec![light([-1.5, -0.2]), light([0.2, 1.5])],
            blockers: vec![[corner(0.0, 0.0), corner(2.0, 0.0), corner(0.0, 2.0)]],
        };
        let found: Vec<f64> = patch.run(&passes).shadows.iter().map(|shadow| shadow.x.into()).collect();
        let (peak, chance) = (peak(&found), peak_of_chance(&found));
        println!("{surface}: {:.2} of {:.2}", peak.sqrt(), chance.sqrt());
        assert!(peak < chance, "{surface}: {peak} of {chance}");
    }
    // The twin: two lattices of these coefficients: one picks the light, the other the direction
    let fraction = |x: usize, y: usize, by: [u32; 2]| {
        let bits = by[0].wrapping_mul(x as u32).wrapping_add(by[1].wrapping_mul(y as u32));
        f64::from(bits) / f64::from(u32::MAX)
    };
    let lattice: Vec<f64> = (0..SIZE * SIZE)
        .map(|i| {
            let at = |by| fraction(i % SIZE, i / SIZE, by);
            let pick = at([3_242_174_889, 2_447_445_414]);
            let is_hidden = (0.25..0.75).contains(&pick) && at([2_680_578_941, 2_340_746_611]) < 0.5;
            f64::from(u8::from(!is_hidden))
        })
        .collect();
    let (peak, chance) = (peak(&lattice), peak_of_chance(&lattice));
    println!("lattice: {:.2} of {:.2}", peak.sqrt(), chance.sqrt());
    assert!(peak > chance, "{peak} of {chance}");
}
