//! What is measured: the levels one by one, the yardsticks, and Monte Carlo.

use super::points::LightKind;
use crate::school::{School, YardstickTable};
use arealight::kernels::{Kernel, SHADE_PASS};
use arealight::{Effects, Footprint, Horizon, Level, Lobes, Quality, SpecularLobes};

/// The shade kernel with the form factors that others ship.
pub static SHADE_YARDSTICK: Kernel =
    Kernel::of_pass("shade_yardstick", include_bytes!("../../spirv/shade_yardstick.spv"), &SHADE_PASS);

/// A way to shade a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The library's.
    Level {
        /// What the pipeline is specialised for.
        effects: Effects,
        /// On which levels.
        quality: Quality,
    },
    /// Somebody else's.
    Yardstick {
        /// What the pipeline is specialised for.
        effects: Effects,
        /// Whose form factor.
        school: School,
        /// With which table.
        table: YardstickTable,
    },
    /// Monte Carlo.
    Samples {
        /// How many a pixel.
        count: u32,
    },
}

/// A method with its name.
#[derive(Debug, Clone)]
pub struct Named {
    /// A short name.
    pub name: &'static str,
    /// What it does, in a few words.
    pub description: &'static str,
    /// The method.
    pub method: Method,
}

/// Levels over one kind of lights.
#[derive(Debug, Clone)]
pub struct Workload {
    /// A short name.
    pub name: &'static str,
    /// What is shaded, in a few words.
    pub description: &'static str,
    /// The lights.
    pub lights: LightKind,
    /// What times are ratios to; its error is measured too.
    pub methods: Vec<Named>,
    /// A share of the points.
    pub share: f64,
}

/// What points of the workloads need, beside their lights.
pub const LOBES: Effects = Effects::DIFFUSE.union(Effects::GLOSSY);

/// The level that every host starts from.
pub const DEFAULT: &str = "exact";

/// The yardstick of the ratios: the school that is used most, with our table.
pub const BASELINE: School = School::Clipless;

/// The names of the yardsticks with a table of published quality.
pub const CLIPLESS_PUBLISHED: &str = "clipless, published quality";
/// As [`CLIPLESS_PUBLISHED`].
pub const SPHERE_PUBLISHED: &str = "sphere horizon, published quality";
/// As [`CLIPLESS_PUBLISHED`].
pub const CASES_PUBLISHED: &str = "clip by cases, published quality";

/// The name of the textured lights.
pub const TEXTURED: &str = "textured";

/// Monte Carlo's numbers of samples.
pub const SAMPLES: [u32; 6] = [1, 4, 16, 64, 256, 1024];

const EXACT: Quality = Quality {
    horizon: Horizon::Cosine,
    specular_lobes: SpecularLobes::One,
    lobes: Lobes::Table,
    footprint: Footprint::Kernel,
};

/// Every workload; the first has the whole ladder.
pub fn workloads() -> Vec<Workload> {
    let level = |name, description, effects: Effects, quality: Quality| Named {
        name,
        description,
        method: Method::Level { effects: LOBES | effects, quality },
    };
    let plain = |name, description, quality| level(name, description, Effects::empty(), quality);
    let named = |level: Level, description| plain(level.name(), description, level.quality());
    let yardstick = |name, description, school, table| Named {
        name,
        description,
        method: Method::Yardstick { effects: LOBES, school, table },
    };
    let with_our_table =
        |school: School| yardstick(school.name(), school.description(), school, YardstickTable::Ours);

    let ladder = vec![
        with_our_table(BASELINE),
        with_our_table(School::SphereHorizon),
        with_our_table(School::ClipByCases),
        yardstick(
            CLIPLESS_PUBLISHED,
            "clipless, with a table of one matrix as good as the published one (three.js, HDRP's default)",
            School::Clipless,
            YardstickTable::PublishedQuality,
        ),
        yardstick(
            CASES_PUBLISHED,
            "clip by cases, with a table of one matrix as good as the published one (Bevy, Godot, ltc_code)",
            School::ClipByCases,
            YardstickTable::PublishedQuality,
        ),
        plain(DEFAULT, "the default: clipped in cosine space", EXACT),
        named(Level::Formula, "lobes by formula, no table"),
        named(Level::TwoLobes, "two specular lobes"),
        named(Level::HalfVectors, "GGX over half vectors"),
        plain("both horizons", "nothing leaks from below", Quality { horizon: Horizon::Both, ..EXACT }),
        named(Level::Finest, "two specular lobes, at both horizons"),
    ];
    let far = vec![with_our_table(BASELINE), plain(DEFAULT, "absolute precision", EXACT)];
    let textured = |name, description, footprint| {
        level(name, description, Effects::TEXTURED, Quality { footprint, ..EXACT })
    };
    vec![
        Workload {
            name: "quads",
            description: "four quads, .5 to 8 times their size away",
            lights: LightKind::Quads,
            methods: ladder,
            share: 1.0,
        },
        Workload {
            name: "far",
            description: "the same, 30 to 1000 times their size away",
            lights: LightKind::Far,
            methods: far,
            share: 0.25,
        },
        Workload {
            name: TEXTURED,
            description: "textured quads",
            lights: LightKind::Textured,
            methods: vec![
                textured("mips", "one fetch of plain mips", Footprint::Mips),
                textured("kernel", "three fetches", Footprint::Kernel),
            ],
            share: 1.0,
        },
        Workload {
            name: "two-sided",
            description: "quads that light both sides",
            lights: LightKind::TwoSided,
            methods: vec![level(DEFAULT, "the default", Effects::TWO_SIDED, EXACT)],
            share: 0.25,
        },
        Workload {
            name: "stars",
            description: "concave lights of ten vertices",
            lights: LightKind::Stars,
            methods: vec![level(DEFAULT, "the default, any outline", Effects::POLYGON, EXACT)],
            share: 0.25,
        },
    ]
}
