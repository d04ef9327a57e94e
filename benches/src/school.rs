//! The yardsticks: how others compute the form factor of a quad, a school each, and with which table.
//!
//! All run in kernels of ours on the same work with the same reads: see `benches/kernels/yardsticks.glsl`.

/// A way to compute a polygon's form factor that others ship. Edges are the same in all three: the angle over
/// its sine as a rational function of the cosine (Hill and Heitz 2016).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum School {
    /// Nothing is clipped: the vector form factor gives a sphere, and that is clipped at the horizon.
    SphereHorizon = 0,
    /// Nothing is clipped: a rational function of the vector form factor's length and height, in place of the
    /// clipped sphere.
    Clipless = 1,
    /// The quad is clipped by one of 16 cases into up to five vertices. For quads alone.
    ClipByCases = 2,
}

impl School {
    /// Every school.
    pub const ALL: [Self; 3] = [Self::SphereHorizon, Self::Clipless, Self::ClipByCases];

    /// Its name in tables and charts.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SphereHorizon => "sphere horizon",
            Self::Clipless => "clipless",
            Self::ClipByCases => "clip by cases",
        }
    }

    /// What it does and who ships it, in a line.
    pub const fn description(self) -> &'static str {
        match self {
            Self::SphereHorizon => "no clip; a clipped sphere of the same form factor (EEVEE, LearnOpenGL)",
            Self::Clipless => "no clip; a rational function of length and height (three.js, HDRP's default)",
            Self::ClipByCases => "a quad clipped by 16 cases into up to 5 vertices (Bevy, Godot, ltc_code)",
        }
    }
}

/// The table that a yardstick looks its lobe up in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum YardstickTable {
    /// Ours: then the form factor alone differs.
    Ours,
    /// One matrix for every reflectance, of the quality that engines ship: see [`crate::published`].
    PublishedQuality,
}
