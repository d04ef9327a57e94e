//! The command line of Arealight.

mod budget;
mod commands;
mod failure;
mod gpu;
mod output;
mod picture;
mod progress;
mod quality;
mod shadows;
mod visible;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Analytic area lights for Vulkan engines: a polygon, a material and a view go in; radiance comes out.
#[derive(Parser)]
#[command(name = "arealight", version, about, max_term_width = 100, after_help = AFTER_HELP)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
}

const AFTER_HELP: &str = "\
Without a command, the demo scene is rendered.

Exit codes: 0 success, 1 an answer is farther from the truth than eval --tolerance allows, or a \
level falls short of its promises in bench stability or misses a bar in bench textures, \
or a kernel takes more than bench compiled --check allows, \
2 wrong arguments, 3 a bad input file, 4 no usable Vulkan device, 5 an output file cannot be written, \
6 no compiler for bench compiled.";

#[derive(Subcommand)]
enum Command {
    Render(commands::render::Arguments),
    Eval(commands::eval::Arguments),
    Effects(commands::effects::Arguments),
    Fit(commands::fit::Arguments),
    Inspect(commands::inspect::Arguments),
    Bench(commands::bench::Arguments),
    Table(commands::table::Arguments),
    Devices(commands::devices::Arguments),
    Export(commands::export::Arguments),
}

fn main() -> ExitCode {
    let result = match CommandLine::parse().command {
        None => commands::render::run(&commands::render::Arguments::default_scene()),
        Some(Command::Render(arguments)) => commands::render::run(&arguments),
        Some(Command::Eval(arguments)) => commands::eval::run(&arguments),
        Some(Command::Effects(arguments)) => commands::effects::run(&arguments),
        Some(Command::Fit(arguments)) => commands::fit::run(&arguments),
        Some(Command::Inspect(arguments)) => commands::inspect::run(&arguments),
        Some(Command::Bench(arguments)) => commands::bench::run(&arguments),
        Some(Command::Table(arguments)) => commands::table::run(&arguments),
        Some(Command::Devices(arguments)) => commands::devices::run(&arguments),
        Some(Command::Export(arguments)) => commands::export::run(&arguments),
    };
    match result {
        Ok(code) => code,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}
