//! What is promised of a computed form factor, as numbers that a result is held against.

use super::reference::Reference;
use serde::Serialize;

/// How far each vertex may be moved, as a part of its distance, for a result to count as that of a polygon
/// nearby: four units in float32's last place.
pub const MOVE: f64 = 4.0 / (1 << 24) as f64;

/// The largest offset from the anchor, as a part of the farthest vertex's distance, of a small light.
pub const SMALL: f64 = 0.2;

/// What a way to compute form factors promises. All promise a finite number in [0, 1] for any bits, and 0
/// where a vertex is NaN or infinite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Promises {
    /// The largest distance to the values between those that the polygons within [`MOVE`] have.
    pub backward: f64,
    /// The largest error far from contact.
    pub forward: f64,
    /// What is added to it, over the distance to the polygon as a part of the farthest vertex's distance.
    pub contact: f64,
    /// For small lights, the largest error as a part of area / (pi distance²), what the light would send if
    /// it stood upright at the zenith, for each time that it is as far as large.
    pub small_light: f64,
    /// The same of those that cross the horizon, or touch it.
    pub small_light_crossing: f64,
}

impl Promises {
    /// The library's.
    pub const OURS: Self =
        Self { backward: 6e-7, forward: 1e-6, contact: 1e-7, small_light: 8e-7, small_light_crossing: 1e-5 };

    /// The largest error; infinite in contact.
    pub fn forward_bound(&self, reference: &Reference) -> f64 {
        self.forward + self.contact / reference.rho
    }

    /// The largest error of a small light, where there is a promise for this one.
    pub fn small_light_bound(&self, reference: &Reference) -> Option<f64> {
        let growth = if reference.is_above { self.small_light } else { self.small_light_crossing };
        reference.small_light_unit.map(|unit| growth * reference.extents_away * unit)
    }
}

/// One of the promises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Promise {
    /// The bits are those of a number from 0 to 1.
    Range,
    /// 0 for a vertex that is NaN or infinite.
    Zero,
    /// A value between those of polygons nearby.
    Backward,
    /// Close to the given polygon's value.
    Forward,
    /// Close for its size.
    SmallLight,
}

impl std::fmt::Display for Promise {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Range => "range",
            Self::Zero => "zero",
            Self::Backward => "backward",
            Self::Forward => "forward",
            Self::SmallLight => "small light",
        })
    }
}
