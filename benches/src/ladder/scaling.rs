//! How a frame's time grows with its lights and with its pixels.

use super::LONG;
use super::frame::{Frame, g_buffer};
use super::methods::{BASELINE, DEFAULT, LOBES, Method};
use super::points::{LightKind, lights, many_lights, points};
use super::timing::Spread;
use crate::school::YardstickTable;
use crate::textures::is_software;
use arealight::Quality;
use arealight_engine::{Engine, EngineError};
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// A method's time as something grows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// The method's name.
    pub method: String,
    /// How many lights or pixels, and the milliseconds of a frame.
    pub steps: Vec<(u32, Spread)>,
}

/// Both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scaling {
    /// Pixels of the frames of `lights`.
    pub pixels: u32,
    /// By the number of lights.
    pub by_lights: Vec<Growth>,
    /// Lights of the frames of `pixels`.
    pub lights: u32,
    /// By the number of pixels.
    pub by_pixels: Vec<Growth>,
}

/// Numbers of lights.
pub const LIGHT_STEPS: [u32; 7] = [1, 3, 10, 30, 100, 300, 1000];

/// Columns of patches of the frames, half as many rows.
const SOFTWARE_COLUMNS: [usize; 5] = [8, 16, 32, 64, 128];
const GPU_COLUMNS: [usize; 5] = [32, 64, 128, 256, 512];

/// Pixels of a patch to a side.
const SIDE: usize = 8;

fn methods() -> [(&'static str, Method); 3] {
    [
        (
            BASELINE.name(),
            Method::Yardstick { effects: LOBES, school: BASELINE, table: YardstickTable::Ours },
        ),
        (DEFAULT, Method::Level { effects: LOBES, quality: Quality::default() }),
        ("Monte Carlo, 1 sample", Method::Samples { count: 1 }),
    ]
}

/// Measures both in `rounds` rounds after one that warms up.
pub fn measure(engine: &Engine, rounds: usize, progress: &dyn Fn(u64)) -> Result<Scaling, EngineError> {
    let software = is_software(engine.host());
    let points = points(LightKind::Quads, 512, 1);
    let columns = if software { 16 } else { 128 };
    let buffer = g_buffer(engine, &points, columns, columns / 2, SIDE)?;
    let crowd = Frame::new(engine, &buffer, &many_lights(1000), DVec3::ZERO, Vec3::ZERO)?;
    let mut by_lights = vec![];
    for (name, method) in methods() {
        let ready = crowd.ready(method)?;
        let mut steps = vec![];
        for count in LIGHT_STEPS {
            let mut seconds = vec![];
            // What is long needs no repetition
            let rounds = if count > 100 && software { rounds.div_ceil(3) } else { rounds };
            for round in 0..=rounds {
                let took = crowd.run(&ready, count, 0)?;
                if round > 0 {
                    seconds.push(took);
                }
            }
            steps.push((count, Spread::of(&seconds).times(1e3)));
            progress(LONG);
        }
        by_lights.push(Growth { method: name.to_owned(), steps });
    }

    let mut by_pixels: Vec<Growth> =
        methods().map(|(name, _)| Growth { method: name.to_owned(), steps: vec![] }).to_vec();
    for columns in if software { SOFTWARE_COLUMNS } else { GPU_COLUMNS } {
        let buffer = g_buffer(engine, &points, columns, columns / 2, SIDE)?;
        let frame = Frame::new(engine, &buffer, &lights(LightKind::Quads), DVec3::ZERO, Vec3::ZERO)?;
        for ((_, method), growth) in methods().into_iter().zip(&mut by_pixels) {
            let ready = frame.ready(method)?;
            let mut seconds = vec![];
            for round in 0..=rounds {
                let took = frame.run(&ready, u32::MAX, 0)?;
                if round > 0 {
                    seconds.push(took);
                }
            }
            growth.steps.push((frame.pixels() as u32, Spread::of(&seconds).times(1e3)));
            progress(LONG);
        }
    }
    Ok(Scaling { pixels: crowd.pixels() as u32, by_lights, lights: super::points::LIGHTS as u32, by_pixels })
}

/// How many long steps of progress it tells of.
pub const STEPS: usize = 3 * (LIGHT_STEPS.len() + SOFTWARE_COLUMNS.len());
