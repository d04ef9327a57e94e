//! What accuracy costs in time: every quality level on a device, its error against the integral of the true
//! BRDF and its time, beside Monte Carlo and what others ship.

mod errors;
pub(crate) mod frame;
pub(crate) mod methods;
mod names;
mod pictures;
mod points;
mod reference;
mod results;
mod text;
pub(crate) mod timing;

pub use errors::{Errors, SplitErrors};
pub use methods::{BASELINE, CASES_PUBLISHED, CLIPLESS_PUBLISHED, DEFAULT, SHADE_YARDSTICK};
pub use names::LevelNames;
pub use pictures::{Picture, Pictures, STEPS_BESIDE_THE_TRUTH, View, beside_the_truth, yardstick_for};
pub use reference::{PictureError, Reference};
pub use results::results;
pub use text::{READS, error_cells, number, percent};
pub use timing::{Spread, Time};

use crate::textures::is_software;
use arealight::{Effects, LightTable, Quality, TexturePart};
use arealight_engine::host::Host;
use arealight_engine::{Engine, EngineError, GBuffer};
use arealight_oracle::texture::Texture;
use arealight_scene::Scene;
use arealight_vk::TableFormat;
use errors::Known;
use frame::Frame;
use glam::{DVec3, Vec3};
use methods::{LOBES, Method, Named, SAMPLES, Workload, workloads};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::time::Instant;
use timing::{Clock, Entry};

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Points whose error is measured; workloads after the first take a share of them.
    pub points: usize,
    /// Rounds in which time is taken.
    pub rounds: usize,
    /// Another seed makes other points.
    pub seed: u64,
    /// Monte Carlo's samples of the pictures' reference.
    pub reference: u32,
}

impl Options {
    /// As the documents have it: some minutes, most of them for making pipelines.
    pub const FULL: Self = Self { points: 512, rounds: 15, seed: 1, reference: 2048 };
    /// A third of that: to see that it runs, and about what comes out.
    pub const QUICK: Self = Self { points: 128, rounds: 5, seed: 1, reference: 256 };

    /// What progress adds up to.
    pub fn steps(&self) -> u64 {
        let workloads = workloads();
        let points: usize = workloads.iter().map(|workload| self.points_of(workload)).sum();
        let methods: usize = workloads.iter().map(|workload| workload.methods.len()).sum();
        // Each session makes every pipeline, and warms up
        let timed = methods + Effects::all().iter().count() + TIMED_SAMPLES.len();
        let sessions = shares(self.rounds).count() + 1;
        let long = methods + sessions * (timed + 1) + self.rounds + pictures::STEPS;
        points as u64 + LONG * long as u64
    }

    fn points_of(&self, workload: &Workload) -> usize {
        ((self.points as f64 * workload.share) as usize).max(PATCHES_A_ROW)
    }
}

/// About as many points are integrated in the time of a pipeline, or of a round: so much it adds to progress.
const LONG: u64 = 20;

/// A method's error and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The lights: a workload's name.
    pub lights: String,
    /// The method's name.
    pub name: String,
    /// What it does, in a few words.
    pub description: String,
    /// The levels; none of a yardstick.
    pub levels: Option<LevelNames>,
    /// Its errors.
    pub errors: SplitErrors,
    /// Its time.
    pub time: Time,
    /// Monte Carlo's samples that err as much, and that take as long. Of the first lights alone.
    pub samples: Option<Equal>,
}

/// Monte Carlo's samples beside a method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Equal {
    /// So many err as much.
    pub error: f64,
    /// So many take as long.
    pub time: f64,
}

/// Monte Carlo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// How many a pixel.
    pub count: u32,
    /// Errors.
    pub errors: Errors,
    /// Milliseconds a light and a megapixel.
    pub milliseconds: f64,
    /// Whether that was measured, or is of fewer samples, multiplied.
    pub measured: bool,
}

/// What an effect adds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectCost {
    /// Its name.
    pub effect: String,
    /// Time of a pipeline with it over one without, of a frame in which nothing needs it; of a lobe, where
    /// all does.
    pub on: Spread,
    /// Time of a frame of lights that need it, over one of quads.
    pub used: Option<Spread>,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ladder {
    /// The device's name.
    pub device: String,
    /// The driver's name and version.
    #[serde(default)]
    pub driver: String,
    /// Whether it is the processor: then times are its threads' processor time over their number.
    pub software: bool,
    /// The command to run it again.
    pub command: String,
    /// Points whose error was measured.
    pub points: usize,
    /// Rounds in which time was taken.
    pub rounds: usize,
    /// The seed of the points.
    pub seed: u64,
    /// Pixels of the frames.
    pub pixels: u32,
    /// Seconds that all took.
    pub seconds: f64,
    /// By lights, each method in turn.
    pub rows: Vec<Row>,
    /// Monte Carlo over the first lights.
    pub monte_carlo: Vec<Samples>,
    /// What effects add.
    pub effects: Vec<EffectCost>,
    /// Names of the lights, with what they are.
    pub workloads: Vec<(String, String)>,
}

/// Patches of points in a row of the frames.
const PATCHES_A_ROW: usize = 16;

/// Runs everything on a device. `progress` is told how many more of [`Options::steps`] are done.
pub fn run(
    host: &Host,
    table: &LightTable,
    scene: &Scene,
    options: &Options,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<(Ladder, Pictures), EngineError> {
    let start = Instant::now();
    let textures = errors::pictures();
    let engine = engine(host, table, &textures)?;
    let workloads = workloads();

    // Errors: a pixel a point
    let mut rows = vec![];
    let mut monte_carlo = vec![];
    for (index, workload) in workloads.iter().enumerate() {
        let count = options.points_of(workload);
        let mut known = Known::new(workload, count, options.seed, table, &textures, progress);
        let buffer =
            frame::g_buffer(&engine, &known.points, PATCHES_A_ROW, count.div_ceil(PATCHES_A_ROW), 1)?;
        let frame = Frame::new(&engine, &buffer, &known.lights, DVec3::ZERO, Vec3::ZERO)?;
        let pipelines = workload.methods.iter().map(|named| frame.pipeline(named.method));
        engine.passes().make_all(&pipelines.collect::<Vec<_>>(), &|| progress(LONG))?;
        for named in &workload.methods {
            let found = frame.shaded(&frame.ready(named.method)?, 0)?;
            rows.push((workload, named, known.judge(named.method, table, &found)));
        }
        if index == 0 {
            monte_carlo = noise(&frame, &known)?;
        }
    }

    // Time: a patch a point. Once to fill the driver's cache: some make other code the first time than they
    // load later. Then with pipelines that are made anew again and again: where their code lies, and how good
    // it is, is a part of the spread
    let effects: Vec<Effects> = Effects::all().iter().collect();
    let mut timed = time(&engine, &workloads, &effects, options.seed, 0, progress)?;
    let mut engine = engine;
    for rounds in shares(options.rounds) {
        engine = self::engine(host, table, &textures)?;
        timed.extend(time(&engine, &workloads, &effects, options.seed, rounds, progress)?);
    }

    let yardstick = &timed.methods[0];
    let rows: Vec<Row> = rows
        .into_iter()
        .zip(&timed.methods)
        .map(|((workload, named, errors), clock)| row(workload, named, errors, clock.time(yardstick)))
        .collect();
    let default = rows.iter().position(|row| row.name == DEFAULT).unwrap_or(0);
    let effects = effects.iter().zip(&timed.effects).map(|(effect, clock)| {
        let default = &timed.methods[default];
        // Without a lobe it is the other way round
        let on = if LOBES.contains(*effect) { default.ratio(clock) } else { clock.ratio(default) };
        let calls = |named: &Named| match named.method {
            Method::Level { effects, .. } => effects - LOBES == *effect,
            _ => false,
        };
        // Nothing needs it in the first
        let all = workloads.iter().flat_map(|workload| &workload.methods).zip(&timed.methods);
        let mut others = all.skip(workloads[0].methods.len());
        let used = others.find(|(named, _)| calls(named)).map(|(_, clock)| clock.ratio(default));
        EffectCost { effect: effect.names().join(", "), on, used }
    });
    let effects = effects.collect();
    let times: Vec<Time> = timed.samples.iter().map(|clock| clock.time(yardstick)).collect();
    let monte_carlo = with_time(monte_carlo, &times);
    let rows = rows.into_iter().map(|row| with_samples(row, &monte_carlo)).collect();

    let pictures = pictures::make(&engine, table, scene, options.reference, progress)?;
    let ladder = Ladder {
        device: host.device_name(),
        driver: host.driver().to_owned(),
        software: is_software(host),
        command: String::new(),
        points: options.points,
        rounds: options.rounds,
        seed: options.seed,
        pixels: timed.pixels,
        seconds: start.elapsed().as_secs_f64(),
        rows,
        monte_carlo,
        effects,
        workloads: workloads.iter().map(|w| (w.name.to_owned(), w.description.to_owned())).collect(),
    };
    Ok((ladder, pictures))
}

/// How often pipelines are made anew to be timed, at most: so few that quartiles of all rounds lie in the
/// fastest and the slowest session.
const SESSIONS: usize = 3;

/// Rounds of a session, at least: making its pipelines takes longer.
const ROUNDS: usize = 5;

/// The rounds of each session.
fn shares(rounds: usize) -> impl Iterator<Item = usize> {
    let sessions = (rounds / ROUNDS).clamp(1, SESSIONS);
    (0..sessions).map(move |session| rounds * (session + 1) / sessions - rounds * session / sessions)
}

/// What the frames took.
struct Timed {
    pixels: u32,
    methods: Vec<Clock>,
    effects: Vec<Clock>,
    samples: Vec<Clock>,
}

impl Timed {
    /// Adds the rounds of another session.
    fn extend(&mut self, other: Self) {
        let clocks = [
            (&mut self.methods, other.methods),
            (&mut self.effects, other.effects),
            (&mut self.samples, other.samples),
        ];
        for (clocks, others) in clocks {
            for (clock, other) in clocks.iter_mut().zip(others) {
                clock.extend(other);
            }
        }
    }
}

/// Times every method, the default with each effect changed, and Monte Carlo.
fn time(
    engine: &Engine,
    workloads: &[Workload],
    effects: &[Effects],
    seed: u64,
    rounds: usize,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Timed, EngineError> {
    let buffers = workloads.iter().map(|workload| patches(engine, workload, seed));
    let buffers = buffers.collect::<Result<Vec<GBuffer>, _>>()?;
    let frames = workloads.iter().zip(&buffers).map(|(workload, buffer)| {
        Frame::new(engine, buffer, &points::lights(workload.lights), DVec3::ZERO, Vec3::ZERO)
    });
    let frames = frames.collect::<Result<Vec<Frame<'_>>, _>>()?;
    let first = &frames[0];
    let changed = |effect: &Effects| Method::Level { effects: LOBES ^ *effect, quality: Quality::default() };

    let mut timed: Vec<(&Frame<'_>, Method)> = vec![];
    for (workload, frame) in workloads.iter().zip(&frames) {
        timed.extend(workload.methods.iter().map(|named| (frame, named.method)));
    }
    let methods = timed.len();
    timed.extend(effects.iter().map(|effect| (first, changed(effect))));
    timed.extend(TIMED_SAMPLES.map(|count| (first, Method::Samples { count })));

    let pipelines: Vec<_> = timed.iter().map(|(frame, method)| frame.pipeline(*method)).collect();
    engine.passes().make_all(&pipelines, &|| progress(LONG))?;
    let entries = timed.into_iter().map(|(frame, method)| Entry::new(frame, method));
    let entries = entries.collect::<Result<Vec<_>, _>>()?;
    let mut clocks = timing::measure(&entries, rounds, progress)?;
    let samples = clocks.split_off(methods + effects.len());
    let effects = clocks.split_off(methods);
    Ok(Timed { pixels: first.pixels() as u32, methods: clocks, effects, samples })
}

/// The numbers of samples that are timed; more take in proportion.
const TIMED_SAMPLES: [u32; 3] = [1, 4, 16];

/// A G-buffer of many pixels: software has a hundredth of a GPU's throughput.
fn patches(engine: &Engine, workload: &Workload, seed: u64) -> Result<GBuffer, EngineError> {
    let points = points::points(workload.lights, 512, seed);
    let (columns, rows, side) = if is_software(engine.host()) { (32, 16, 8) } else { (128, 64, 16) };
    frame::g_buffer(engine, &points, columns, rows, side)
}

/// An engine whose light textures are the pictures.
fn engine(host: &Host, table: &LightTable, textures: &[Arc<Texture>]) -> Result<Engine, EngineError> {
    let mut engine = Engine::new(host.clone(), table, TableFormat::default())?;
    // A layer a light
    let lights = points::lights(points::LightKind::Textured);
    crate::pictures::load(&mut engine, textures, |layer| TexturePart::default().shown_by(&lights[layer]))?;
    Ok(engine)
}

/// Monte Carlo's errors, of several seeds where samples are few.
fn noise(frame: &Frame<'_>, known: &Known) -> Result<Vec<Samples>, EngineError> {
    let mut found = vec![];
    for count in SAMPLES {
        let ready = frame.ready(Method::Samples { count })?;
        let seeds = (64 / count).clamp(4, 16);
        let answers = (0..seeds).map(|seed| {
            let mut answer = frame.shaded(&ready, seed + 1)?;
            answer.truncate(known.points.len());
            Ok(answer)
        });
        let errors = known.noise(&answers.collect::<Result<Vec<_>, EngineError>>()?);
        found.push(Samples { count, errors, milliseconds: 0.0, measured: TIMED_SAMPLES.contains(&count) });
    }
    Ok(found)
}

/// Fills in the time: what was measured, and beyond it what each sample adds.
fn with_time(mut samples: Vec<Samples>, timed: &[Time]) -> Vec<Samples> {
    let at = |index: usize| timed.get(index).map_or(f64::NAN, |time| time.milliseconds.median);
    let last = TIMED_SAMPLES.len() - 1;
    let (low, high) = (f64::from(TIMED_SAMPLES[0]), f64::from(TIMED_SAMPLES[last]));
    let each = (at(last) - at(0)) / (high - low);
    for entry in &mut samples {
        let measured = TIMED_SAMPLES.iter().position(|count| *count == entry.count);
        entry.milliseconds = measured.map_or_else(|| at(last) + (f64::from(entry.count) - high) * each, at);
    }
    samples
}

/// Fills in Monte Carlo's samples of equal error and of equal time.
fn with_samples(mut row: Row, monte_carlo: &[Samples]) -> Row {
    let is_first = |row: &Row| row.lights == workloads()[0].name;
    if let ([first, .., last], true) = (monte_carlo, is_first(&row)) {
        // Errors go with the root of the number
        let error = f64::from(last.count) * (last.errors.rmse / row.errors.all.rmse).powi(2);
        let each = (last.milliseconds - first.milliseconds) / f64::from(last.count - first.count);
        let time = 1.0 + (row.time.milliseconds.median - first.milliseconds) / each;
        row.samples = Some(Equal { error, time: time.max(0.0) });
    }
    row
}

fn row(workload: &Workload, named: &Named, errors: SplitErrors, time: Time) -> Row {
    let levels = match named.method {
        Method::Level { quality, .. } => Some(LevelNames::from(quality)),
        Method::Yardstick { .. } | Method::Samples { .. } => None,
    };
    Row {
        lights: workload.name.to_owned(),
        name: named.name.to_owned(),
        description: named.description.to_owned(),
        levels,
        errors,
        time,
        samples: None,
    }
}
