//! `arealight completions` and `arealight man`: what a shell and `man` know of the program.

use crate::failure::Failure;
use crate::output::{self, print};
use clap::Command;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Print completions for a shell.
///
/// For example: arealight completions bash > arealight.bash
#[derive(clap::Args)]
pub struct Completions {
    /// The shell
    shell: clap_complete::Shell,
}

/// Write manual pages into a folder, one a command.
#[derive(clap::Args)]
pub struct Man {
    /// The folder, which is made where it is not there
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

pub fn completions(arguments: &Completions, mut program: Command) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "arealight", &mut script);
    print(&String::from_utf8_lossy(&script))
}

pub fn man(arguments: &Man, program: Command) -> Result<ExitCode, Failure> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    std::fs::create_dir_all(&arguments.folder).map_err(|error| Failure::output(&arguments.folder, error))?;
    page(&program, "arealight", &arguments.folder)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the page of a command, and those of the commands below it.
fn page(command: &Command, name: &str, folder: &Path) -> Result<(), Failure> {
    let path = folder.join(format!("{name}.1"));
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone())
        .render(&mut text)
        .map_err(|error| Failure::output(&path, error))?;
    output::write(&path, &text)?;
    let below = command.get_subcommands().filter(|below| !below.is_hide_set());
    below.into_iter().try_for_each(|below| page(below, &format!("{name}-{}", below.get_name()), folder))
}
