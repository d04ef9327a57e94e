//! What the form factor of a quad costs on a device, by the library's levels and by the yardsticks.
//!
//! The machines that this runs on are shared: every method is run in turn, round after round, and read as a
//! ratio to a yardstick in the same round. All read the same quads, once each.

use crate::ladder::Spread;
use crate::school::School;
use crate::table::Table;
use arealight::FormFactor;
use arealight::kernels::Kernel;
use arealight_engine::host::Host;
use arealight_engine::{EngineError, ListPass, Passes};
use arealight_vk::Resource;
use bytemuck::Pod;
use serde::Serialize;

/// A quad's form factor many times over.
pub static FORM_FACTOR_COST: Kernel =
    Kernel::new("form_factor_cost", include_bytes!("../spirv/form_factor_cost.spv"));

/// What is measured.
#[derive(Debug, Clone, Copy)]
pub struct CostMethod {
    /// A short name.
    pub name: &'static str,
    /// The error that it promises, in words.
    pub promise: &'static str,
    /// The kernel's `METHOD`.
    id: u32,
}

const QUAD: u32 = 0;
const BOTH: u32 = 8;
const POLYGON: u32 = 12;

const fn level(name: &'static str, shape: u32, level: FormFactor) -> CostMethod {
    let promise = match level {
        FormFactor::Exact => "1e-6",
        FormFactor::Difference => "1e-6, of small lights relative",
    };
    CostMethod { name, promise, id: shape | level as u32 }
}

const fn yardstick(school: School) -> CostMethod {
    CostMethod { name: school.name(), promise: "none", id: YARDSTICK + school as u32 }
}

/// The first of the kernel's yardsticks, `METHOD_YARDSTICK`.
const YARDSTICK: u32 = 17;

/// Every method, the yardstick of the ratios first.
pub static METHODS: &[CostMethod] = &[
    yardstick(School::Clipless),
    yardstick(School::SphereHorizon),
    yardstick(School::ClipByCases),
    CostMethod { name: "an empty loop", promise: "none", id: 16 },
    level("quad, exact", QUAD, FormFactor::Exact),
    level("quad, difference", QUAD, FormFactor::Difference),
    level("any outline, exact", POLYGON, FormFactor::Exact),
    level("any outline, difference", POLYGON, FormFactor::Difference),
    level("both horizons, quad, exact", BOTH, FormFactor::Exact),
    level("both horizons, quad, difference", BOTH, FormFactor::Difference),
];

/// A method's cost.
#[derive(Debug, Clone, Serialize)]
pub struct Cost {
    /// The method.
    pub method: &'static str,
    /// Nanoseconds a form factor: the median over the rounds. Only ratios mean something on a shared machine.
    pub nanoseconds: f64,
    /// The ratio to the first method, [`School::Clipless`], in the same round.
    pub ratio: Spread,
    /// The mean form factor of the quads: what was computed.
    pub mean: f64,
}

const WORK_ITEMS: usize = 4096;
const REPEATS: u32 = 256;

/// Runs a list of each method in turn, `rounds` times after a round that warms up: the seconds of each.
pub(crate) fn in_turn<R: Pod, C: Pod>(
    lists: &[ListPass<R, C>],
    rounds: usize,
) -> Result<Vec<Vec<f64>>, EngineError> {
    let mut seconds = vec![vec![]; lists.len()];
    for round in 0..=rounds {
        for (list, seconds) in lists.iter().zip(&mut seconds) {
            let took = list.run()?.as_secs_f64();
            if round > 0 {
                seconds.push(took);
            }
        }
    }
    Ok(seconds)
}

/// Measures every method in `rounds` rounds, after one that warms up.
pub fn measure(host: &Host, rounds: usize) -> Result<Vec<Cost>, EngineError> {
    let passes = Passes::new(host.clone())?;
    let vertices = host.storage_buffer("vertices", &quads())?;
    let list = |method: &CostMethod| {
        let kernel = (&FORM_FACTOR_COST, &[(0, method.id), (1, REPEATS)][..]);
        let inputs = [Resource::buffer(vertices.handle())];
        // SAFETY: The vertices live until this returns.
        unsafe { passes.over_list::<f32, ()>(kernel, &inputs, (), WORK_ITEMS) }
    };
    let lists = METHODS.iter().map(list).collect::<Result<Vec<_>, _>>()?;
    let seconds = in_turn(&lists, rounds)?;
    let cost = |((method, list), taken): ((&CostMethod, &ListPass<f32, ()>), &Vec<f64>)| {
        let means = list.results()?;
        Ok(Cost {
            method: method.name,
            nanoseconds: quantile(taken, 0.5) * 1e9 / (WORK_ITEMS as f64 * f64::from(REPEATS)),
            ratio: Spread::of_ratios(taken, &seconds[0]),
            mean: means.iter().map(|mean| f64::from(*mean)).sum::<f64>() / WORK_ITEMS as f64,
        })
    };
    METHODS.iter().zip(&lists).zip(&seconds).map(cost).collect()
}

pub(crate) fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (part * (sorted.len().max(1) - 1) as f64).round() as usize;
    sorted.get(index).copied().unwrap_or(f64::NAN)
}

/// Quads of half a unit about a point one or two units above the shading point, front towards it.
fn quads() -> Vec<[f32; 4]> {
    let mut state = 88172645463325252_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / 16_777_216.0
    };
    let mut vertices = Vec::with_capacity(4 * WORK_ITEMS);
    for _ in 0..WORK_ITEMS {
        let center = [random() - 0.5, random() - 0.5, 1.5 + random()];
        let a = [0.1 + 0.3 * random(), 0.2 * random(), 0.3 * random()];
        let b = [0.2 * random(), 0.1 + 0.3 * random(), 0.3 * random()];
        for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)] {
            let vertex = |axis: usize| center[axis] + x * a[axis] + y * b[axis];
            vertices.push([vertex(0), vertex(1), vertex(2), 0.0]);
        }
    }
    vertices
}

/// The costs as a Markdown table.
pub fn markdown(costs: &[Cost]) -> String {
    let row = |(cost, method): (&Cost, &CostMethod)| {
        [cost.method, method.promise].map(str::to_owned).into_iter().chain(cost.ratio.cells()).collect()
    };
    let heads = ["form factor of a quad", "error promised", "time, clipless = 1", "quartiles"];
    Table::new(&heads, costs.iter().zip(METHODS).map(row)).to_markdown()
}
