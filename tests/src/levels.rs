//! The quality levels, by both kernels of a polygon.

use arealight::{Effects, FormFactor, Horizon, Quality};
use arealight_cases::hard::promise::Promises;

/// Which code integrates the polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Path {
    /// The convex quad: no more than four vertices.
    Quad,
    /// Any polygon, edge by edge.
    Polygon,
    /// Each face of a mesh, edge by edge.
    Mesh,
}

/// One kind of pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Level {
    /// The code.
    pub path: Path,
    /// What it is specialised for.
    pub quality: Quality,
}

impl std::fmt::Display for Level {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Quality { form_factor, horizon, .. } = self.quality;
        write!(f, "{:?} {form_factor:?} {horizon:?}", self.path)
    }
}

/// Every way to integrate edges.
pub const FORM_FACTORS: [FormFactor; 2] = [FormFactor::Exact, FormFactor::Difference];

impl Level {
    /// The quality levels of these paths and horizons.
    pub fn of(paths: &[Path], horizons: &[Horizon]) -> Vec<Self> {
        let mut levels = Vec::new();
        for &path in paths {
            for &horizon in horizons {
                levels.extend(FORM_FACTORS.map(|form_factor| Self {
                    path,
                    quality: Quality { form_factor, horizon, ..Quality::default() },
                }));
            }
        }
        levels
    }

    /// The effects of a pass on this path that has these lobes.
    pub fn effects(self, lobes: Effects) -> Effects {
        let effects = lobes | Effects::TWO_SIDED;
        match self.path {
            Path::Quad => effects,
            Path::Polygon => effects | Effects::POLYGON,
            Path::Mesh => effects | Effects::POLYGON | Effects::MESH,
        }
    }

    /// What `form_factor/quad.glsl` promises of it.
    pub fn promises(self) -> Promises {
        match self.quality.form_factor {
            FormFactor::Exact => Promises::EXACT,
            FormFactor::Difference => Promises::DIFFERENCE,
        }
    }
}
