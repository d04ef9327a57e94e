//! Colours of text, and colour maps.

use crate::canvas::Colour;

pub const PAPER: Colour = [255, 255, 255];
pub const INK: Colour = [32, 32, 36];
pub const FAINT: Colour = [120, 120, 128];

/// The map viridis (van der Walt and Smith 2015) at eighths: perceptually even, and safe for colour-blind
/// readers.
const VIRIDIS: [Colour; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Blue over white to red, after a scheme of Brewer's: too little, right, too much.
const DIVERGING: [Colour; 7] = [
    [33, 102, 172],
    [103, 169, 207],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [239, 138, 98],
    [178, 24, 43],
];

/// How many colours a map has between its ends: few enough for small files, too many to be seen as steps.
const STEPS: f64 = 80.0;

/// A magnitude in [0, 1]; what is outside is clamped.
pub fn viridis(value: f64) -> Colour {
    interpolate(&VIRIDIS, value)
}

/// A difference in [-1, 1]; what is outside is clamped.
pub fn diverging(value: f64) -> Colour {
    interpolate(&DIVERGING, 0.5 + 0.5 * value)
}

fn interpolate(colours: &[Colour], value: f64) -> Colour {
    let last = colours.len() - 1;
    // NaN counts as 0
    let value = (value.clamp(0.0, 1.0).max(0.0) * STEPS).round() / STEPS;
    let place = value * last as f64;
    let index = (place as usize).min(last - 1);
    let share = place - index as f64;
    std::array::from_fn(|i| {
        let (a, b) = (f64::from(colours[index][i]), f64::from(colours[index + 1][i]));
        (a + (b - a) * share).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_end_at_their_ends_and_clamp() {
        assert_eq!((viridis(0.0), viridis(1.0)), (VIRIDIS[0], VIRIDIS[8]));
        assert_eq!((viridis(-1.0), viridis(2.0)), (VIRIDIS[0], VIRIDIS[8]));
        assert_eq!(
            (diverging(-1.0), diverging(0.0), diverging(1.0)),
            (DIVERGING[0], DIVERGING[3], DIVERGING[6])
        );
        assert_eq!(viridis(f64::NAN), VIRIDIS[0]);
    }
}
