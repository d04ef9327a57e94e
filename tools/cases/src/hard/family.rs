//! The families of hard cases. A case is the same on every machine: random numbers, sums, products, quotients
//! and square roots make it, and it is rounded to float32 before anything is computed from it.

mod contact;
mod far;
mod horizon;
mod lobe;
mod wild;

use super::HardCase;
use super::stream::Stream;
use arealight::LightTable;
use serde::Serialize;

/// Which promises a family is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// All of them.
    Accuracy,
    /// A number from 0 to 1, whatever the bits: float32 cannot hold the polygon's squares or differences, or
    /// a device may take its numbers for zero.
    Range,
    /// Exactly 0: a vertex is NaN or infinite.
    Zero,
}

/// A family of hard cases.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// A short name, for tables and arguments.
    pub name: &'static str,
    /// What makes it hard.
    pub description: &'static str,
    /// What it is judged by.
    pub scope: Scope,
    make: fn(&mut Stream, &LightTable) -> HardCase,
}

impl PartialEq for Family {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Family {
    const fn new(
        name: &'static str,
        description: &'static str,
        make: fn(&mut Stream, &LightTable) -> HardCase,
    ) -> Self {
        Self { name, description, scope: Scope::Accuracy, make }
    }

    const fn judged(self, scope: Scope) -> Self {
        Self { scope, ..self }
    }

    /// The family's case of an index, for a seed; `table` gives the lobes of those families that have one.
    ///
    /// Half of the flat polygons come as vertices, their anchor being zero, the others as offsets from an
    /// anchor in their midst.
    pub fn case(&self, index: u64, seed: u64, table: &LightTable) -> HardCase {
        let mut stream = Stream::new(self.name, index, seed);
        let case = (self.make)(&mut stream, table);
        let as_vertices = case.anchor == [0.0; 3] && case.flat && self.scope == Scope::Accuracy;
        if as_vertices && stream.one_in(2) {
            return Some(anchored(&case)).filter(HardCase::is_finite).unwrap_or(case);
        }
        case
    }

    /// The family of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        FAMILIES.iter().find(|family| family.name == name)
    }
}

/// The same polygon as offsets from the mean of its vertices, rounded anew.
fn anchored(case: &HardCase) -> HardCase {
    let vertices = case.offsets_exactly();
    let mean = |axis: usize| vertices.iter().map(|v| v[axis] / vertices.len() as f64).sum::<f64>() as f32;
    let anchor = [mean(0), mean(1), mean(2)];
    let offset = |v: &[f64; 3]| [0, 1, 2].map(|axis| (v[axis] - f64::from(anchor[axis])) as f32);
    HardCase { anchor, offsets: vertices.iter().map(offset).collect(), flat: case.flat }
}

/// Every family.
pub static FAMILIES: &[Family] = &[
    Family::new("above", "wholly above the horizon, of ordinary size: what must not be lost", horizon::above),
    Family::new("crossing", "crosses the horizon", horizon::crossing),
    Family::new(
        "touching",
        "a vertex or an edge on the horizon, or within 1e-7 to 1e-3 of it",
        horizon::touching,
    ),
    Family::new("in-horizon", "lies in the horizon plane, exactly or but for 1e-8 to 1e-5", horizon::lying),
    Family::new("just-above", "flat, 1e-7 to 1e-2 above the horizon", horizon::just_above),
    Family::new("sliver", "1e-7 to 1e-3 as wide as long, along the horizon or across it", horizon::sliver),
    Family::new("concave", "stars, L, U and combs that cross the horizon several times", horizon::concave),
    Family::new("many-vertices", "64 vertices, round or jagged, crossing the horizon or not", horizon::many),
    Family::new("edge-on", "seen along its plane, 1e-9 to 1e-3 off it", contact::edge_on),
    Family::new("in-plane-outside", "the point in its plane, outside of the outline", contact::plane_outside),
    Family::new("in-plane-inside", "the point in its plane, inside of the outline", contact::plane_inside),
    Family::new(
        "in-plane-concave",
        "the point in its plane, in a bay of the outline",
        contact::plane_concave,
    ),
    Family::new("contact-interior", "1e-6 to 1e-3 before or behind its inside", contact::interior),
    Family::new("contact-edge", "1e-6 to 1e-3 from an edge", contact::edge),
    Family::new("contact-vertex", "1e-6 to 1e-3 from a vertex", contact::vertex),
    Family::new("antipodal", "an edge passes the point at 0 to 1e-6, its ends opposite", contact::antipodal),
    Family::new("huge-near", "16 to 1e7 times as large as near", contact::huge),
    Family::new("far", "1 to 1e8 times as far as large, above the horizon", far::above),
    Family::new("far-crossing", "1 to 1e8 times as far as large, on the horizon", far::crossing),
    Family::new("far-grazing", "4 to 1e8 times as far as large, at elevations of 1e-7 to 1e-2", far::grazing),
    Family::new("far-edge-on", "4 to 1e8 times as far as large, seen along its plane", far::edge_on),
    Family::new(
        "low-alpha",
        "through the table's lobes of alpha 1e-4 to 1e-2, about the mirror direction",
        lobe::low,
    ),
    Family::new("low-alpha-far", "the same, small", lobe::low_far),
    Family::new("grazing", "through the table's lobes at views of 88 to 90 degrees", lobe::grazing),
    Family::new(
        "degenerate",
        "duplicate and collinear vertices, spikes, no area, a vertex at the point",
        wild::degenerate,
    ),
    Family::new("scaled", "another family's polygon, times 2^-40 to 2^40", wild::scaled),
    Family::new("random-quads", "four vertices anywhere, not in a plane", wild::quads),
    Family::new("overflowing", "as large as float32 goes: squares and sums overflow", wild::overflowing),
    Family::new("denormal", "components of 2^-149 to 2^-110: squares vanish", wild::denormal)
        .judged(Scope::Range),
    Family::new("bits", "finite numbers of any bits", wild::bits).judged(Scope::Range),
    Family::new("not-finite", "a vertex is NaN or infinite", wild::not_finite).judged(Scope::Zero),
];
