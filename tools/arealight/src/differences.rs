//! Differences of pictures in false colours, from a thousandth of the mean to all of it.

use glam::DVec3;

/// Colours of the map from the smallest difference to the largest, evenly spaced: dark blue, violet, red,
/// orange, pale yellow.
const COLORS: [[u8; 3]; 6] =
    [[0, 0, 20], [50, 15, 110], [140, 35, 130], [220, 70, 85], [250, 150, 70], [252, 253, 190]];

/// Differences over the mean that the ends of the map stand for.
pub const SCALE: [f64; 2] = [1e-3, 1.0];

/// Steps of the map: its contours are legible, and noise below a step takes no bytes.
const STEPS: f64 = 18.0;

/// Blue over white to red, after a scheme of Brewer's: too little, right, too much.
const DIVERGING: [[u8; 3]; 7] = [
    [33, 102, 172],
    [103, 169, 207],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [239, 138, 98],
    [178, 24, 43],
];

/// The colour of a difference over the mean.
pub fn color(difference: f64) -> [u8; 3] {
    // What is no number is as bad as can be
    let difference = if difference.is_nan() { SCALE[1] } else { difference.clamp(SCALE[0], SCALE[1]) };
    let [low, high] = SCALE.map(f64::log10);
    interpolate(&COLORS, (difference.log10() - low) / (high - low), STEPS)
}

/// The colour of a signed difference in [-1, 1]; what is outside is clamped, and NaN is -1.
pub fn diverging(difference: f64) -> [u8; 3] {
    interpolate(&DIVERGING, 0.5 + 0.5 * difference, 80.0)
}

/// The colour at a place from 0 to 1, of so many steps.
fn interpolate(colors: &[[u8; 3]], place: f64, steps: f64) -> [u8; 3] {
    let last = colors.len() - 1;
    let place = (place.clamp(0.0, 1.0).max(0.0) * steps).round() / steps * last as f64;
    let index = (place as usize).min(last - 1);
    let share = place - index as f64;
    std::array::from_fn(|i| {
        let [a, b] = [colors[index][i], colors[index + 1][i]].map(f64::from);
        (a + (b - a) * share).round() as u8
    })
}

/// The map's colours as a gradient of CSS.
pub fn gradient() -> String {
    let colors: Vec<String> = COLORS.iter().map(|[r, g, b]| format!("rgb({r} {g} {b})")).collect();
    format!("linear-gradient(to right, {})", colors.join(", "))
}

/// The colour of each pixel's difference from a reference over its mean.
pub fn difference_colors(found: &[DVec3], reference: &[DVec3]) -> Vec<[u8; 3]> {
    let mean =
        reference.iter().map(|pixel| pixel.element_sum()).sum::<f64>() / (3 * reference.len().max(1)) as f64;
    let pairs = found.iter().zip(reference);
    let color_of = |(found, expected): (&DVec3, &DVec3)| {
        let off = (*found - *expected).abs();
        color(if off.is_nan() { f64::NAN } else { off.max_element() / mean })
    };
    pairs.map(color_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_run_through_the_colours() {
        assert_eq!(color(0.0), COLORS[0]);
        assert_eq!(color(SCALE[0]), COLORS[0]);
        assert_eq!([color(1.0), color(7.0), color(f64::NAN)], [COLORS[5]; 3]);
        assert!(color(1e-1)[0] > color(1e-2)[0]);
        assert_eq!([-1.0, 0.0, 2.0, f64::NAN].map(diverging), [0, 3, 6, 0].map(|index| DIVERGING[index]));
    }
}
