//! How far off the lookups of light textures are, on a device and through its pyramid: against the integral
//! of image times lobe in float64, over families of poses, beside the filter of Heitz et al. 2016.

mod cost;
mod report;

use crate::textures::{self, TextureCost};
use arealight::{Effects, Footprint, Light, LightTable, Quality, TexturePart};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, EvalPoint};
use arealight_oracle::material::Surface;
use arealight_oracle::shading::poses::{Bar, Errors, Family, Pose, Summary, poses};
use arealight_oracle::shading::{RelativeLight, ltc_on};
use arealight_oracle::texture::Texture;
use arealight_vk::TableFormat;
pub use cost::Cost;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;

/// A way to look up a light's texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Method {
    /// A short name.
    pub name: &'static str,
    /// What it does, in a few words.
    pub description: &'static str,
    /// What it is.
    pub footprint: Footprint,
}

/// Every method, the yardstick first.
pub static METHODS: [Method; 2] = [
    Method {
        name: "mips",
        description: "one fetch of the image's mips at the foot of the perpendicular (Heitz et al. 2016)",
        footprint: Footprint::Mips,
    },
    Method {
        name: "kernel",
        description: "three fetches of the image filtered by the lobe's own kernel",
        footprint: Footprint::Kernel,
    },
];

impl Method {
    fn answers(
        &self,
        engine: &Engine,
        quality: Quality,
        points: &[EvalPoint],
    ) -> Result<Vec<DVec3>, EngineError> {
        let answers = engine.eval(points, Quality { footprint: self.footprint, ..quality })?;
        Ok(answers.into_iter().map(Vec3::as_dvec3).collect())
    }
}

/// What the poses need.
const EFFECTS: Effects = Effects::DIFFUSE.union(Effects::GLOSSY).union(Effects::TEXTURED);

/// Texels of the pictures, and of the pyramid, to a side.
const SIDE: u32 = 256;

const PICTURES: u32 = 5;

/// The layers of the pictures that the bars are for: [`pictures`] makes them.
const JUDGED: std::ops::Range<u32> = 0..3;
const NOISE: u32 = 2;
const SPOT: u32 = 3;
const FRAMED: u32 = 4;

fn pictures() -> Vec<Arc<Texture>> {
    let side = SIDE as usize;
    let mut pictures = judged_pictures();
    pictures.extend([Texture::spot(side, side), Texture::framed(side, side)].map(Arc::new));
    pictures
}

/// Those that the bars are for.
pub(crate) fn judged_pictures() -> Vec<Arc<Texture>> {
    let side = SIDE as usize;
    vec![Arc::new(Texture::checker(side, side, 8)), Arc::new(Texture::gradient(side, side)), noise(1)]
}

/// Noise with the spectrum of photographs.
pub(crate) fn noise(seed: u64) -> Arc<Texture> {
    Arc::new(Texture::noise(SIDE as usize, SIDE as usize, seed))
}

/// What to run.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Poses of each family.
    pub poses: usize,
    /// Another seed makes other poses.
    pub seed: u64,
    /// Rounds in which time is taken; with none it is not.
    pub rounds: usize,
}

impl Default for Options {
    /// 600 poses a family, ten rounds: with half as many a few bright poses decide, and errors scatter by a
    /// tenth.
    fn default() -> Self {
        Self { poses: 600, seed: 1, rounds: 10 }
    }
}

impl Options {
    /// How often progress is told of, in all.
    pub fn steps(&self) -> u64 {
        (self.poses * Family::ALL.len()) as u64
    }
}

/// A method on a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The pictures shown.
    pub pictures: &'static str,
    /// The family of poses.
    pub family: Family,
    /// The method's name.
    pub method: &'static str,
    /// Its errors.
    pub errors: Summary,
    /// The most that they may be.
    pub bar: Option<Bar>,
}

impl Row {
    /// Whether the errors are within the bar, if there is one.
    pub fn is_kept(&self) -> bool {
        self.bar.is_none_or(|bar| bar.holds(&self.errors))
    }
}

/// A light far away, which shows its mean.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Far {
    /// The picture shown.
    pub picture: &'static str,
    /// The surface lit.
    pub surface: &'static str,
    /// The method's name.
    pub method: &'static str,
    /// The answer over the truth, the sum of all channels.
    pub ratio: f64,
}

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct Footprints {
    /// The device's name.
    pub device: String,
    /// Poses of each family.
    pub poses: usize,
    /// The seed of the poses.
    pub seed: u64,
    /// Errors: by pictures, by family, each method in turn.
    pub rows: Vec<Row>,
    /// Lights far away.
    pub far: Vec<Far>,
    /// Costs of the lookup, the light without a texture first; none where time was not taken.
    pub costs: Vec<Cost>,
    /// Costs of an update; none where time was not taken.
    pub updates: Vec<TextureCost>,
}

/// The judged pictures, in words.
pub const JUDGED_PICTURES: &str = "checker, gradient and noise";
const SPOT_PICTURE: &str = "spot";

impl Footprints {
    /// Where a level misses its bar.
    pub fn shortfalls(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.is_kept())
    }

    /// A method's errors on a family, of the judged pictures.
    pub fn errors(&self, method: &str, family: Family) -> Option<&Summary> {
        let is_it =
            |row: &&Row| row.pictures == JUDGED_PICTURES && row.method == method && row.family == family;
        self.rows.iter().find(is_it).map(|row| &row.errors)
    }
}

/// Runs every method on a device. `progress` is told how many more poses are integrated.
pub fn run(
    host: &Host,
    table: &LightTable,
    options: &Options,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Footprints, EngineError> {
    let pictures = pictures();
    let engine = engine(host, table, &pictures)?;
    let truth = |quality: Quality, point: &EvalPoint| truth(quality, table, &pictures, point);

    // Judge every method on every family
    let mut rows = Vec::new();
    let mut judged_points = Vec::new();
    for family in Family::ALL {
        let poses = poses(family, options.poses, options.seed, table);
        let expected: Vec<Vec<DVec3>> = poses
            .par_iter()
            .map(|pose| {
                let truths = (0..=SPOT).map(|layer| truth(Quality::default(), &point(pose, layer))).collect();
                progress(1);
                truths
            })
            .collect();
        // A lobe counts by what it sees of a light, not by how much of it the surface reflects
        let albedos: Vec<f64> = poses.iter().map(|pose| pose.lobe(table).1).collect();
        for (name, layers) in [(JUDGED_PICTURES, JUDGED), (SPOT_PICTURE, SPOT..SPOT + 1)] {
            let points = poses.iter().flat_map(|pose| layers.clone().map(|layer| point(pose, layer)));
            let points: Vec<EvalPoint> = points.collect();
            let shown = layers.start as usize..layers.end as usize;
            for method in &METHODS {
                let answers = method.answers(&engine, Quality::default(), &points)?;
                let answers = answers.chunks_exact(shown.len());
                let mut errors = Errors::default();
                for ((found, expected), albedo) in answers.zip(&expected).zip(&albedos) {
                    for (found, expected) in found.iter().zip(&expected[shown.clone()]) {
                        errors.add(*found / *albedo, *expected / *albedo);
                    }
                }
                let bar = if name == SPOT_PICTURE { None } else { Bar::of(method.footprint, family) };
                rows.push(Row { pictures: name, family, method: method.name, errors: errors.summary(), bar });
            }
            if name == JUDGED_PICTURES {
                judged_points.extend(points);
            }
        }
    }
    rows.sort_by_key(|row| row.pictures != JUDGED_PICTURES);

    let far = far(&engine, &truth)?;
    let (mut costs, mut updates) = (Vec::new(), Vec::new());
    if options.rounds > 0 {
        // Of one aspect: as few images as a scene has
        for texture in judged_points.iter_mut().filter_map(|point| point.light.texture.as_mut()) {
            texture.layer %= PICTURES;
        }
        costs = cost::measure(&engine, &judged_points, options.rounds)?;
        for side in [512, 1024] {
            updates.push(textures::measure(host, side, options.rounds)?);
        }
    }
    let (poses, seed) = (options.poses, options.seed);
    Ok(Footprints { device: host.device_name(), poses, seed, rows, far, costs, updates })
}

/// An engine that has the pictures for layers.
fn engine(host: &Host, table: &LightTable, textures: &[Arc<Texture>]) -> Result<Engine, EngineError> {
    let mut engine = Engine::new(host.clone(), table, TableFormat::Rgba32Float)?;
    crate::pictures::load_by_aspect(&mut engine, textures, TexturePart::default())?;
    Ok(engine)
}

fn point(pose: &Pose, picture: u32) -> EvalPoint {
    let layer = crate::pictures::layer_of(picture, PICTURES, pose.aspect());
    EvalPoint {
        surface: pose.surface,
        position: DVec3::ZERO,
        normal: DVec3::Z,
        view: pose.view,
        light: pose.light(layer),
    }
}

/// The integral of image times the table's lobe.
fn truth(quality: Quality, table: &LightTable, pictures: &[Arc<Texture>], point: &EvalPoint) -> DVec3 {
    let layer = point.light.texture.as_ref().map_or(0, |texture| texture.layer);
    let light = RelativeLight::textured(
        &point.light,
        point.position,
        Arc::clone(&pictures[(layer % PICTURES) as usize]),
    );
    light.map_or(DVec3::NAN, |light| ltc_on(quality, table, &point.surface, point.normal, point.view, &light))
}

/// How far the far lights are, in their size.
const FAR: f64 = 1000.0;

/// A square of size 1 in the mirror direction, that faces the point.
fn far(engine: &Engine, truth: &dyn Fn(Quality, &EvalPoint) -> DVec3) -> Result<Vec<Far>, EngineError> {
    let view = DVec3::new(1.0, 0.0, 1.0) * std::f64::consts::FRAC_1_SQRT_2;
    let towards = view.with_x(-view.x);
    let (u, v) = (DVec3::Y * 0.5, towards.cross(DVec3::Y) * -0.5);
    let vertices = [-u - v, u - v, u + v, v - u].map(|corner| towards * FAR + corner);
    let lambert =
        Surface { diffuse_albedo: DVec3::ONE, f0: DVec3::ZERO, f90: 0.0, alpha: 1.0, ..Surface::default() };
    let glossy =
        Surface { diffuse_albedo: DVec3::ZERO, f0: DVec3::ONE, f90: 1.0, alpha: 0.25, ..Surface::default() };
    let quality = Quality::default();

    let mut rows = Vec::new();
    for (picture, layer) in [("noise", NOISE), (SPOT_PICTURE, SPOT), ("framed", FRAMED)] {
        for (name, surface) in [("Lambert", lambert), ("roughness .5", glossy)] {
            let point = point(&Pose { surface, view, vertices }, layer);
            let expected = truth(quality, &point).element_sum();
            for method in &METHODS {
                let found = method.answers(engine, quality, std::slice::from_ref(&point))?;
                let found: f64 = found.iter().map(|found| found.element_sum()).sum();
                let ratio = found / expected;
                rows.push(Far { picture, surface: name, method: method.name, ratio });
            }
        }
    }
    Ok(rows)
}

/// The point's light without its texture.
fn untextured(point: &EvalPoint) -> EvalPoint {
    EvalPoint { light: Light { texture: None, ..point.light.clone() }, ..point.clone() }
}
