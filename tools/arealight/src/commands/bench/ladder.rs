//! `arealight bench` without a subcommand

use super::{Ends, page};
use crate::failure::Failure;
use crate::plots::{self, Kind};
use crate::progress;
use arealight_benches::ladder::{self, Options};
use arealight_scene::Scene;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// What to run, and where to write it.
#[derive(clap::Args)]
pub struct LadderArguments {
    /// Fewer points and rounds, and pipelines made anew once: a third of the time.
    #[arg(long)]
    quick: bool,
    /// Points whose error is measured [default: 512; 128 with --quick].
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..=100_000))]
    points: Option<u32>,
    /// Rounds in which time is taken [default: 15; 5 with --quick].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: Option<u32>,
    /// Another seed makes other points.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Write the report: one page that needs nothing else.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    ends: Ends,
}

impl LadderArguments {
    fn options(&self) -> Options {
        let base = if self.quick { Options::QUICK } else { Options::FULL };
        Options {
            points: self.points.map_or(base.points, |points| points as usize),
            rounds: self.rounds.map_or(base.rounds, |rounds| rounds as usize),
            seed: self.seed,
            ..base
        }
    }

    /// The command that runs the same again.
    fn command(&self) -> String {
        let mut command = "arealight bench".to_owned();
        if self.quick {
            command += " --quick";
        }
        for (option, value) in [("--points", self.points), ("--rounds", self.rounds)] {
            command += &value.map(|value| format!(" {option} {value}")).unwrap_or_default();
        }
        if self.seed != 1 {
            let _ = write!(command, " --seed {}", self.seed);
        }
        command + self.html.as_ref().map_or("", |_| " --html report.html")
    }
}

pub fn run(arguments: &LadderArguments) -> Result<ExitCode, Failure> {
    let options = arguments.options();
    let scene = Scene::from_bytes(include_bytes!("../../../../../scenes/demo.glb"), "demo")
        .map_err(|error| Failure::input("demo (built in)", error))?;
    arguments.html.as_deref().map_or(Ok(()), plots::check)?;
    let host = arguments.ends.host()?;

    let (mut found, pictures) = progress::of(options.steps(), "steps", |tell| {
        ladder::run(&host, &arealight::LightTable::ggx(), &scene, &options, tell)
    })?;
    found.command = arguments.command();

    if let Some(path) = &arguments.html {
        plots::draw(Kind::Report, &page::found(&found, &pictures)?, path)?;
    }
    arguments.ends.report(&found, &found.to_markdown(), &found.to_text())?;
    Ok(ExitCode::SUCCESS)
}
