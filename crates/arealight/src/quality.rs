//! Quality levels, chosen by the host for each pass: a [`Level`] by its name, or each choice in a
//! [`Quality`].

use crate::effects::Effects;

/// Where a polygon is clipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Horizon {
    /// At the horizon of the lobe's cosine space. A fitted lobe reaches below the surface, with 2 % of its
    /// energy on average and 17 % at grazing angles: lights leak in from there.
    #[default]
    Cosine = 0,
    /// At the surface's horizon as well, before the lobe's transform: nothing leaks from behind the surface.
    /// What the lobe loses there is made up for, so that its albedo stays: a light that is wholly above both
    /// horizons is brighter than by [`Horizon::Cosine`].
    Both = 1,
}

/// How the specular lobe is integrated: by how many transformed cosines that stand for it, or over half
/// vectors. Errors: docs/fit.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum SpecularLobes {
    /// One integral a light, of the lobe that the reflectance asks for. A colour counts by the mean of its
    /// channels; the specular albedo stays exact in each.
    #[default]
    One = 0,
    /// Two integrals a light, at .6 to .8 times the error of one, exact in the reflectance and its colour. Of
    /// a surface that has sheen the second goes to that, at a third to a half of its error. Falls back to one
    /// with [`Lobes::Formula`] and with a table that has no pairs.
    Two = 1,
    /// No transformed cosine: GGX itself, integrated over the half vectors of a light's outline, at four
    /// times the time of one integral. Error relative to two lobes: under lamps, a tenth to a
    /// thirtieth for two roughnesses ([`crate::Effects::ANISOTROPY`]), a third to the same for one; two to
    /// three times for lights that fill the lobe, as a sky does; light from everywhere is exact. Only for
    /// polygons and meshes without an image; other lights have [`SpecularLobes::One`]. The table is read for
    /// albedos. Sheen has two lobes, as with [`SpecularLobes::Two`]. Tiles cull no such light.
    HalfVectors = 2,
}

/// Where the glossy lobe comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Lobes {
    /// The fitted table: twelve texel reads a pixel.
    #[default]
    Table = 0,
    /// Formulas fitted to it (`arealight_formula_sample`): about a hundred multiply-adds a pixel and no
    /// texture, at 1.2 to 1.35 times the table's error. For roughness above .15; nearer to a mirror the table
    /// is far better.
    Formula = 1,
}

/// How what a lobe sees of a light's image is looked up. Errors against the integral of image times lobe:
/// docs/textures.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Footprint {
    /// Three trilinear fetches of the image filtered by the kernel of a point's distance: exact for Lambert
    /// surfaces whose horizon does not cut the light, but for the filter.
    #[default]
    Kernel = 0,
    /// One fetch of the image's plain mips, as in Heitz et al. 2016: for a chain of mips that is at hand.
    Mips = 1,
}

/// A quality level by its name: each has the least error at its cost, or keeps a promise that no other keeps.
/// Which to take: docs/cost.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Level {
    /// One fitted lobe, clipped at its own horizon: for most scenes.
    #[default]
    Exact = 0,
    /// Two fitted lobes, at .6 to .8 times the error: for metals and glossy floors.
    TwoLobes = 1,
    /// That, clipped at the surface's horizon as well: for stills and references. Nothing leaks in from below
    /// the surface.
    Finest = 2,
    /// GGX over half vectors: for brushed metals, thin films and coats under lamps.
    HalfVectors = 3,
    /// As [`Level::Exact`], of formulas in place of the table: no texture to bind.
    Formula = 4,
}

impl Level {
    /// Every level, by number.
    pub const ALL: [Self; 5] = [Self::Exact, Self::TwoLobes, Self::Finest, Self::HalfVectors, Self::Formula];

    /// The level's name, as charts and the viewer have it; `--level` has hyphens for its spaces.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::TwoLobes => "two lobes",
            Self::Finest => "finest",
            Self::HalfVectors => "half vectors",
            Self::Formula => "formula",
        }
    }

    /// The level to take for surfaces of these effects: of brushed metal, thin films or coats
    /// [`Level::HalfVectors`], else the default.
    pub fn for_surfaces(surfaces: Effects) -> Self {
        let bent = Effects::ANISOTROPY | Effects::THIN_FILM | Effects::COAT;
        if surfaces.intersects(bent) { Self::HalfVectors } else { Self::default() }
    }

    /// What the level chooses.
    pub fn quality(self) -> Quality {
        let exact = Quality::default();
        match self {
            Self::Exact => exact,
            Self::TwoLobes => Quality { specular_lobes: SpecularLobes::Two, ..exact },
            Self::Finest => Quality { specular_lobes: SpecularLobes::Two, horizon: Horizon::Both, ..exact },
            Self::HalfVectors => Quality { specular_lobes: SpecularLobes::HalfVectors, ..exact },
            Self::Formula => Quality { lobes: Lobes::Formula, ..exact },
        }
    }
}

/// What a pass is specialised for, choice by choice: of a [`Level`], or of your own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Quality {
    /// Where polygons are clipped.
    pub horizon: Horizon,
    /// How many lobes the specular one is made of.
    pub specular_lobes: SpecularLobes,
    /// Where the glossy lobe comes from.
    pub lobes: Lobes,
    /// How light textures are looked up.
    pub footprint: Footprint,
}
