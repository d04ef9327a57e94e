//! The white furnace: what surfaces that reflect everything lose, or gain, of light from everywhere, by each
//! quality level.

use crate::table::Table;
use arealight::{Horizon, Light, LightShape, LightTable, Lobes, MIN_ALPHA, Quality, SpecularLobes};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, EvalPoint};
use arealight_fit::{Brdf, GgxBrdf};
use arealight_oracle::material::Surface;
use arealight_vk::TableFormat;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Roughnesses from 0 to 1, and views from the normal to [`LAST_VIEW`], evenly in what the table is
    /// evenly spaced in.
    pub steps: u32,
}

impl Default for Options {
    /// Four and a half times as many as the table has nodes, and none of them alike.
    fn default() -> Self {
        Self { steps: 287 }
    }
}

/// The last view's angle from the normal, in degrees.
pub const LAST_VIEW: f64 = 89.9;

/// Half the side of the light, which is 1 above the surface: it fills the hemisphere but for 1e-5 of the
/// cosine. In a mirror's cosine space its corners are 1e9 times as far as it is.
const HALF_SIDE: f64 = 1e5;

/// A level, as rows have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Level {
    /// What it is, in words.
    pub name: &'static str,
    quality: Quality,
    format: TableFormat,
    multiple_scattering: bool,
}

/// Every level that has an albedo of its own. Two lobes have those of one.
pub fn levels() -> [Level; 7] {
    let level = |name, horizon, lobes| Level {
        name,
        quality: Quality { horizon, lobes, ..Quality::default() },
        format: TableFormat::default(),
        multiple_scattering: false,
    };
    let both = level("both horizons", Horizon::Both, Lobes::Table);
    [
        level("default", Horizon::Cosine, Lobes::Table),
        both,
        Level { name: "both horizons, table of float16", format: TableFormat::Rgba16Float, ..both },
        Level {
            name: "both horizons, two lobes",
            quality: Quality { specular_lobes: SpecularLobes::Two, ..both.quality },
            ..both
        },
        Level {
            name: "half vectors",
            quality: Quality { specular_lobes: SpecularLobes::HalfVectors, ..Quality::default() },
            ..both
        },
        level("both horizons, formula", Horizon::Both, Lobes::Formula),
        Level { name: "both horizons, multiple scattering", multiple_scattering: true, ..both },
    ]
}

/// What a level does to light from everywhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The level.
    pub level: String,
    /// The largest part of the light that is lost, of what the true lobe reflects.
    pub loss: f64,
    /// Roughness at which it is lost, and the view's angle from the normal in degrees.
    pub at: [f64; 2],
    /// The largest part that is gained.
    pub gain: f64,
    /// The mean of either over all roughnesses and views.
    pub mean: f64,
}

/// What a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Furnace {
    /// The device.
    pub device: String,
    /// [`Options::steps`].
    pub steps: u32,
    /// A row for each of [`levels`].
    pub rows: Vec<Row>,
}

/// A roughness and the cosine of a view.
type Place = [f64; 2];

fn places(steps: u32) -> impl Iterator<Item = Place> {
    let last = (1.0 - LAST_VIEW.to_radians().cos()).sqrt();
    let part = move |step: u32| f64::from(step) / f64::from(steps.max(2) - 1);
    (0..steps)
        .flat_map(move |row| (0..steps).map(move |column| [part(column), 1.0 - (last * part(row)).powi(2)]))
}

/// Runs every level. `progress` is told of levels done.
pub fn run(
    host: &Host,
    table: &LightTable,
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<Furnace, EngineError> {
    let places: Vec<Place> = places(options.steps).collect();
    // What the true lobe reflects
    let alpha = |roughness: f64| (roughness * roughness).max(MIN_ALPHA);
    let truth: Vec<f64> = places
        .par_iter()
        .map(|[roughness, cos_view]| GgxBrdf.magnitude(alpha(*roughness), *cos_view).albedo)
        .collect();
    let corner = |x: f64, y: f64| HALF_SIDE * DVec3::new(x, y, 0.0) + DVec3::Z;
    let corners = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let light = Light { radiance: Vec3::ONE, shape: LightShape::Polygon(corners), ..Light::default() };

    let mut rows = vec![];
    for level in levels() {
        let engine = Engine::new(host.clone(), table, level.format)?;
        let point = |[roughness, cos_view]: &Place| EvalPoint {
            surface: Surface {
                f0: DVec3::ONE,
                f90: 1.0,
                alpha: alpha(*roughness),
                multiple_scattering: level.multiple_scattering,
                ..Surface::default()
            },
            position: DVec3::ZERO,
            normal: DVec3::Z,
            view: DVec3::new((1.0 - cos_view * cos_view).max(0.0).sqrt(), 0.0, *cos_view),
            light: light.clone(),
        };
        let points: Vec<EvalPoint> = places.iter().map(point).collect();
        let found = engine.eval(&points, level.quality)?;
        // With what facets reflect more than once, nothing is lost
        let excess = found
            .iter()
            .zip(&truth)
            .map(|(found, truth)| f64::from(found.x) - if level.multiple_scattering { 1.0 } else { *truth });
        rows.push(row(level.name, &places, &excess.collect::<Vec<_>>()));
        progress(1);
    }
    Ok(Furnace { device: host.device_name(), steps: options.steps, rows })
}

fn row(level: &str, places: &[Place], excess: &[f64]) -> Row {
    let most_lost = places.iter().zip(excess).min_by(|a, b| a.1.total_cmp(b.1));
    let at = most_lost.map_or([0.0; 2], |([roughness, cos_view], _)| {
        let sin_view = (1.0 - cos_view * cos_view).max(0.0).sqrt();
        [*roughness, sin_view.atan2(*cos_view).to_degrees()]
    });
    Row {
        level: level.to_owned(),
        loss: most_lost.map_or(0.0, |(_, excess)| (-excess).max(0.0)),
        at,
        gain: excess.iter().copied().fold(0.0, f64::max),
        mean: excess.iter().map(|excess| excess.abs()).sum::<f64>() / excess.len().max(1) as f64,
    }
}

impl Furnace {
    fn table(&self) -> Table {
        let cells = |row: &Row| {
            vec![
                row.level.clone(),
                format!("{:.2e}", row.loss),
                format!("{:.2}, {:.1}°", row.at[0], row.at[1]),
                format!("{:.2e}", row.gain),
                format!("{:.2e}", row.mean),
            ]
        };
        Table::new(
            "level | largest loss | at roughness, angle | largest gain | mean",
            self.rows.iter().map(cells),
        )
    }

    /// A table for a terminal.
    pub fn to_text(&self) -> String {
        format!("{}: {} roughnesses and views\n\n{}", self.device, self.steps, self.table().to_text())
    }

    /// A section of a document. `command` is what made it.
    pub fn to_markdown(&self, command: &str) -> String {
        format!(
            "By `{command}` on {}: GGX of F0 = 1 below light of 1 from everywhere, {} roughnesses from 0 to \
            1 by as many views to {LAST_VIEW}°. Losses and \
             gains are of the true lobe's albedo; with multiple scattering of all light.\n\n{}",
            self.device,
            self.steps,
            self.table().to_markdown()
        )
    }
}
