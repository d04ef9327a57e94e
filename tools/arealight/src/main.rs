//! The command line of Arealight.

mod canvas;
mod commands;
mod differences;
mod edges;
mod failure;
mod film;
mod gpu;
mod lights;
mod means;
mod memory;
mod output;
mod picture;
mod plots;
mod progress;
mod quality;
mod shadows;
mod verdict;
mod view;
mod visible;
mod whole_file;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

/// Render, measure and export analytic area lights: a polygon, a material and a view go in; radiance comes
/// out.
#[derive(Parser)]
#[command(name = "arealight", version, max_term_width = 100, after_help = AFTER_HELP,
    arg_required_else_help = true)]
struct CommandLine {
    /// Hide progress.
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Say which device and table are used, and print every table of a report.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// The most memory that what is read may take: bytes, or with K, M or G; without it 256M and 256 bytes
    /// for each byte of the files.
    #[arg(long, global = true, value_name = "SIZE", value_parser = memory::parse)]
    memory: Option<u64>,
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "\
For example:
  arealight render                                 the demo scene, into out/
  arealight render scenes/room.glb -o room.exr
  arealight view scenes/room.glb                   move lamps and the camera, in a window
  arealight compare room.exr reference.exr -o difference.png
  arealight export DIR                             the GLSL library, tables and SPIR-V for your engine

Exit codes: 0 success, 1 an answer or a picture is farther from the truth than --tolerance allows, or a \
level falls short of its promises in bench stability or misses a bar in bench textures, \
or a kernel takes more than bench compiled --check allows, \
2 wrong arguments, 3 a bad input file, 4 no usable Vulkan device or no window, \
5 an output file cannot be written, \
6 no compiler for bench compiled, or no matplotlib for charts and pictures of tables.";

#[derive(Subcommand)]
enum Command {
    Render(commands::render::Arguments),
    View(commands::view::Arguments),
    Eval(commands::eval::Arguments),
    Effects(commands::effects::Arguments),
    Fit(commands::fit::Arguments),
    Inspect(commands::inspect::Arguments),
    Bench(commands::bench::Arguments),
    Table(commands::table::Arguments),
    Devices(commands::devices::Arguments),
    Export(commands::export::Arguments),
    Compare(commands::compare::Arguments),
    Completions(commands::shell::Completions),
    Man(commands::shell::Man),
}

/// The program's commands. A negative number is always a value: that it is out of range is said as such.
fn program() -> clap::Command {
    fn with_numbers(command: clap::Command) -> clap::Command {
        let numbers = |of: clap::Arg| {
            let takes = of.get_action().takes_values();
            of.allow_negative_numbers(takes)
        };
        command.mut_args(numbers).mut_subcommands(with_numbers)
    }
    with_numbers(CommandLine::command())
}

fn main() -> ExitCode {
    // Lavapipe gives each thread a part of a dispatch, and parts of a picture differ: many wait less
    if std::env::var_os("LP_NUM_THREADS").is_none() {
        // SAFETY: no other thread has begun.
        unsafe { std::env::set_var("LP_NUM_THREADS", "32") };
    }
    let matches = program().get_matches();
    let CommandLine { quiet, verbose, memory, command } =
        CommandLine::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    memory::be_within(memory);
    if quiet {
        progress::be_quiet();
    }
    if verbose {
        progress::be_verbose();
    }
    let result = match command {
        Command::Render(arguments) => commands::render::run(&arguments),
        Command::View(arguments) => commands::view::run(&arguments),
        Command::Eval(arguments) => commands::eval::run(&arguments),
        Command::Effects(arguments) => commands::effects::run(&arguments),
        Command::Fit(arguments) => commands::fit::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Bench(arguments) => commands::bench::run(&arguments),
        Command::Table(arguments) => commands::table::run(&arguments),
        Command::Devices(arguments) => commands::devices::run(&arguments),
        Command::Export(arguments) => commands::export::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Completions(arguments) => commands::shell::completions(&arguments, program()),
        Command::Man(arguments) => commands::shell::man(&arguments, program()),
    };
    match result {
        Ok(code) => code,
        Err(failure) => {
            output::say(&format!("error: {failure}"));
            failure.exit_code()
        }
    }
}
