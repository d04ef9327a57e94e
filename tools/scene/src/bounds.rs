//! Boxes along the axes.

use glam::DVec3;

/// World coordinates beyond are refused: areas of boxes, as `f32`, would be infinite.
pub const MAX_COORDINATE: f64 = 1e15;

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The smallest corner; infinite for an empty box.
    pub min: DVec3,
    /// The largest corner; negative infinite for an empty box.
    pub max: DVec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// Grows the box to hold `point`.
    pub fn add(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// The middle; zero for an empty box.
    pub fn center(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { (self.min + self.max) * 0.5 }
    }

    /// Its eight corners; infinite for an empty box.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let high = |bit: usize| i >> bit & 1 == 1;
            DVec3::select(glam::BVec3::new(high(0), high(1), high(2)), self.max, self.min)
        })
    }

    /// The length of the diagonal; zero for an empty box.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.min.distance(self.max) }
    }
}

impl FromIterator<DVec3> for Bounds {
    fn from_iter<I: IntoIterator<Item = DVec3>>(points: I) -> Self {
        let mut bounds = Self::default();
        points.into_iter().for_each(|p| bounds.add(p));
        bounds
    }
}
