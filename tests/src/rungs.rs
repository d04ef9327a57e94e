//! The rungs of the quality ladder, on both ways around an outline.

use arealight::{Effects, FormFactor, Horizon, Quality};
use arealight_oracle::hard::promise::Promises;

/// Which code integrates the polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Path {
    /// The convex quad: no more than four vertices.
    Quad,
    /// The walk around any polygon.
    Walk,
    /// The walk around each face of a mesh.
    Mesh,
}

/// One kind of pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rung {
    /// The code.
    pub path: Path,
    /// What it is specialised for.
    pub quality: Quality,
}

impl std::fmt::Display for Rung {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Quality { form_factor, horizon, one_point, .. } = self.quality;
        write!(f, "{:?} {form_factor:?} {horizon:?}", self.path)?;
        if one_point { f.write_str(" one point") } else { Ok(()) }
    }
}

/// Every series for the arcs.
pub const FORM_FACTORS: [FormFactor; 4] =
    [FormFactor::Exact, FormFactor::Fast, FormFactor::ExactDifference, FormFactor::FastDifference];

impl Rung {
    /// The rungs of these paths and horizons, with every series, without the one-point form.
    pub fn of(paths: &[Path], horizons: &[Horizon]) -> Vec<Self> {
        let mut rungs = Vec::new();
        for &path in paths {
            for &horizon in horizons {
                rungs.extend(FORM_FACTORS.map(|form_factor| Self {
                    path,
                    quality: Quality { form_factor, horizon, ..Quality::default() },
                }));
            }
        }
        rungs
    }

    /// The effects of a pass on this path that has these lobes.
    pub fn effects(self, lobes: Effects) -> Effects {
        let effects = lobes | Effects::TWO_SIDED | Effects::FAR;
        match self.path {
            Path::Quad => effects,
            Path::Walk => effects | Effects::POLYGON,
            Path::Mesh => effects | Effects::POLYGON | Effects::MESH,
        }
    }

    /// What `form_factor.glsl` promises of it.
    pub fn promises(self) -> Promises {
        match self.quality.form_factor {
            FormFactor::Exact => Promises::EXACT,
            FormFactor::Fast => Promises::FAST,
            FormFactor::ExactDifference => Promises::EXACT_DIFFERENCE,
            FormFactor::FastDifference => Promises::FAST_DIFFERENCE,
        }
    }

    /// The same, with the one-point form.
    #[must_use]
    pub fn with_one_point(mut self) -> Self {
        self.quality.one_point = true;
        self
    }
}
