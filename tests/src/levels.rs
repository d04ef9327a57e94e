//! The quality levels, by both kernels of a polygon.

use arealight::{Effects, Horizon, Quality};

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
        write!(f, "{:?} {:?}", self.path, self.quality.horizon)
    }
}

impl Level {
    /// The quality levels of these paths and horizons.
    pub fn of(paths: &[Path], horizons: &[Horizon]) -> Vec<Self> {
        let mut levels = Vec::new();
        for &path in paths {
            for &horizon in horizons {
                levels.push(Self { path, quality: Quality { horizon, ..Quality::default() } });
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
}
