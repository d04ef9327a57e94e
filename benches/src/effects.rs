//! What absent effects cost on a device: the shade kernel and pass with one set of effects after another over one frame in which
//! nothing calls for them.
//!
//! The machines that this runs on are shared: every method is run in turn, round after round, forwards and
//! backwards, and read as a ratio to the yardstick in the same round; of software in processor time.

use crate::cost::quantile;
use crate::textures::clocked;
use arealight::kernels::SHADE;
use arealight::plan::{Output, ShadeOptions, shade_specialization};
use arealight::{Effects, Quality};
use arealight_engine::{EngineError, SceneRenderer};
use arealight_host::Host;
use serde::Serialize;
use std::fmt::Write as _;

/// What is timed.
#[derive(Debug, Clone)]
enum Method {
    /// The pass: of the effects it has what the frame's lights and surfaces call for.
    Pass { effects: Effects, quality: Quality },
    /// The kernel with the code of all of the effects.
    Kernel { effects: Effects, quality: Quality },
}

/// A method's time.
#[derive(Debug, Clone, Serialize)]
pub struct EffectCost {
    /// What ran.
    pub name: String,
    /// What it is a ratio to.
    pub yardstick: String,
    /// Seconds a frame: the median over the rounds. Only ratios mean something on a shared machine.
    pub seconds: f64,
    /// The median over the rounds of the ratio to the yardstick in the same round.
    pub ratio: f64,
    /// The quartiles of that ratio.
    pub quartiles: [f64; 2],
}

struct Run {
    name: String,
    method: Method,
    yardstick: usize,
    seconds: Vec<f64>,
}

impl Run {
    /// Seconds of one frame.
    fn once(&self, host: &Host, renderer: &mut SceneRenderer<'_>) -> Result<f64, EngineError> {
        let options =
            |effects, quality| ShadeOptions { effects, quality, output: Output::Add, ..ShadeOptions::all() };
        clocked(host, || match self.method {
            Method::Pass { effects, quality } => renderer.shade_as(options(effects, quality)),
            Method::Kernel { effects, quality } => {
                renderer.shade_by(&SHADE, &shade_specialization(options(effects, quality)))
            }
        })
    }
}

/// Every method: what it is a ratio to comes before it.
fn runs() -> Vec<Run> {
    let run = |name: String, method, yardstick| Run { name, method, yardstick, seconds: Vec::new() };
    let shade = |effects, quality| Method::Pass { effects, quality };
    let both = Effects::DIFFUSE | Effects::GLOSSY;
    let exact = Quality::default();
    let mut runs = vec![
        run(both.to_string(), shade(both, exact), 0),
        run(Effects::DIFFUSE.to_string(), shade(Effects::DIFFUSE, exact), 0),
    ];
    for added in (Effects::all() - both).iter() {
        let (effects, name) = (both | added, (both | added).to_string());
        runs.push(run(format!("{name}, compiled in"), Method::Kernel { effects, quality: exact }, 0));
        runs.push(run(name, shade(effects, exact), 0));
    }
    runs.push(run("every effect".into(), shade(Effects::all(), exact), 0));
    runs
}

/// Measures every method on `host` over the renderer's frame in `rounds` rounds, after one that warms up. The scene calls for no
/// effect but the lobes, so that each is one that no pixel uses.
///
/// # Errors
/// [`EngineError`] where the device fails.
pub fn measure(
    host: &Host,
    renderer: &mut SceneRenderer<'_>,
    rounds: usize,
) -> Result<Vec<EffectCost>, EngineError> {
    let mut runs = runs();
    let count = runs.len();
    for round in 0..=rounds {
        for place in 0..count {
            // There and back, so that nobody always runs after the same one
            let run = &mut runs[if round % 2 == 0 { place } else { count - 1 - place }];
            let seconds = run.once(host, renderer)?;
            if round > 0 {
                run.seconds.push(seconds);
            }
        }
    }
    let cost = |run: &Run| {
        let yardstick = &runs[run.yardstick];
        let ratios: Vec<f64> = run.seconds.iter().zip(&yardstick.seconds).map(|(a, b)| a / b).collect();
        EffectCost {
            name: run.name.clone(),
            yardstick: yardstick.name.clone(),
            seconds: quantile(&run.seconds, 0.5),
            ratio: quantile(&ratios, 0.5),
            quartiles: [quantile(&ratios, 0.25), quantile(&ratios, 0.75)],
        }
    };
    Ok(runs.iter().map(cost).collect())
}

/// The costs as a Markdown table.
pub fn markdown(costs: &[EffectCost]) -> String {
    let mut text = String::from("| effects | as a ratio to | time | quartiles |\n|---|---|---|---|\n");
    for EffectCost { name, yardstick, ratio, quartiles: [low, high], .. } in costs {
        let _ = writeln!(text, "| {name} | {yardstick} | {ratio:.3} | {low:.3} to {high:.3} |");
    }
    text
}
