//! What a lookup costs: the time of the eval kernel over the same points, as ratios within the same run.

use super::{EFFECTS, METHODS, untextured};
use crate::ladder::Spread;
use crate::ladder::timing::quantile;
use crate::textures::{is_software, timed};
use arealight::{Effects, PackedLights, Quality};
use arealight_engine::host::Buffer;
use arealight_engine::{BoundSet, Engine, EngineError, EvalPoint, SharedPass, gpu_case};
use arealight_tool_kernels::gpu::EvalConstants;
use arealight_tool_kernels::plan::{self, Dispatch};
use arealight_vk::Resource;
use serde::Serialize;

/// A method's cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cost {
    /// The method's name, or `no texture`.
    pub method: &'static str,
    /// Nanoseconds a point: the least over the rounds. Only ratios mean something on a shared machine.
    pub nanoseconds: f64,
    /// The median over the rounds of the ratio to the light without a texture in the same round.
    pub to_untextured: f64,
}

/// The light without a texture.
pub const UNTEXTURED: &str = "no texture";

/// Points that a dispatch has at least: a GPU is full, and software does not take minutes.
const POINTS: usize = 1 << 20;
const SOFTWARE_POINTS: usize = 1 << 14;

struct Run {
    method: &'static str,
    pass: SharedPass,
    set: BoundSet,
    seconds: Vec<f64>,
    _buffers: [Buffer; 4],
}

impl Run {
    fn new(
        engine: &Engine,
        method: &'static str,
        dispatch: &Dispatch,
        points: &[EvalPoint],
        count: usize,
    ) -> Result<Self, EngineError> {
        // Pack as the engine does, and repeat the cases
        let mut lights = PackedLights::default();
        let mut cases = Vec::with_capacity(count);
        for point in points {
            let packed = PackedLights::new(std::slice::from_ref(&point.light), point.position)?;
            cases.push(gpu_case(point, lights.lights.len() as u32));
            lights.append(packed)?;
        }
        let cases: Vec<_> = cases.iter().cycle().take(count).copied().collect();
        let host = engine.host();
        let buffers = [
            host.storage_buffer("lights", &lights.lights)?,
            host.storage_buffer("light vertices", &lights.vertices)?,
            host.storage_buffer("cases", &cases)?,
            host.storage_buffer("results", &vec![[0.0_f32; 4]; cases.len()])?,
        ];
        let [lights, vertices, cases, results] = [0, 1, 2, 3].map(|i| Resource::buffer(buffers[i].handle()));
        let resources = [engine.table(), lights, vertices, cases, results, engine.light_textures()];
        let pass = engine.passes().pass(dispatch.kernel, &dispatch.specialization)?;
        // SAFETY: This keeps the buffers until submissions are waited for; the caller keeps the engine.
        let set = unsafe { engine.passes().bind(&pass, &resources) }?;
        Ok(Self { method, pass, set, seconds: Vec::new(), _buffers: buffers })
    }

    fn once(&self, engine: &Engine, count: usize) -> Result<f64, EngineError> {
        let case_count = count as u32;
        timed(engine.host(), |commands| {
            // SAFETY: `commands` is being recorded, outside a render pass.
            unsafe {
                self.set.record(&self.pass, commands, &EvalConstants { case_count }, [case_count, 1, 1])
            }
        })
    }
}

/// Measures every method over `points`, in `rounds` rounds after one that warms up.
pub(super) fn measure(
    engine: &Engine,
    points: &[EvalPoint],
    rounds: usize,
) -> Result<Vec<Cost>, EngineError> {
    let least = if is_software(engine.host()) { SOFTWARE_POINTS } else { POINTS };
    let count = points.len() * least.div_ceil(points.len().max(1));
    let plain: Vec<EvalPoint> = points.iter().map(untextured).collect();
    let without = plan::eval(EFFECTS - Effects::TEXTURED, Quality::default(), 0);
    let mut runs = vec![Run::new(engine, UNTEXTURED, &without, &plain, count)?];
    for method in &METHODS {
        let quality = Quality { footprint: method.footprint, ..Quality::default() };
        runs.push(Run::new(engine, method.name, &plan::eval(EFFECTS, quality, 0), points, count)?);
    }
    for round in 0..=rounds {
        for run in &mut runs {
            let seconds = run.once(engine, count)?;
            if round > 0 {
                run.seconds.push(seconds);
            }
        }
    }
    let cost = |run: &Run| Cost {
        method: run.method,
        nanoseconds: quantile(&run.seconds, 0.0) * 1e9 / count as f64,
        to_untextured: Spread::of_ratios(&run.seconds, &runs[0].seconds).median,
    };
    Ok(runs.iter().map(cost).collect())
}
