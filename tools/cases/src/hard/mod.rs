//! The hard cases of the polygon integral: families of polygons that break form factors in float32, their
//! truth in 106 bits, and the judgement of a computed value against what is promised.
//!
//! | module | holds |
//! |---|---|
//! | [`family`] | the families, and the case of each index |
//! | [`double`] | numbers of 106 bits |
//! | [`edges`] | the form factor in float64 or in those |
//! | [`mod@reference`] | the truth about a case |
//! | [`promise`] | what a way to compute form factors promises |
//! | [`nearby`] | the values that polygons nearby have: the backward error |
//! | [`nearby_shape`] | the same of ellipses, spheres and tubes |
//! | [`search`] | how they are looked for |
//! | [`judge`] | a family's results against its promises |
//! | [`ellipse`] | families of ellipses, which are disk lights |

pub mod double;
pub mod edges;
pub mod ellipse;
pub mod family;
pub mod judge;
pub mod nearby;
pub mod nearby_shape;
mod outline;
pub mod promise;
pub mod reference;
pub mod search;

use arealight_oracle::stream;

/// A polygon in the space whose z axis is the normal, as seen from the shading point at the origin. Its
/// vertices are the real sums `anchor + offset`, which float32 need not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct HardCase {
    /// What the offsets start from.
    pub anchor: [f32; 3],
    /// The vertices, in order.
    pub offsets: Vec<[f32; 3]>,
    /// The vertices lie in a plane but for their rounding; else the polygon is only what its edges say.
    pub flat: bool,
}

impl HardCase {
    /// The offsets in float64.
    pub fn offsets_exactly(&self) -> Vec<[f64; 3]> {
        self.offsets.iter().map(|offset| offset.map(f64::from)).collect()
    }

    /// Whether every number is finite, and every vertex within float32's range.
    pub fn is_finite(&self) -> bool {
        let finite = |offset: &[f32; 3]| (0..3).all(|i| (self.anchor[i] + offset[i]).is_finite());
        self.offsets.iter().all(finite)
    }
}

#[cfg(test)]
mod tests;
