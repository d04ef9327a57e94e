//! Compiling by another process: the loader and the driver read their environment when a process starts.

use crate::failure::Failure;
use crate::output::print;
use crate::progress;
use arealight_benches::compiled::{Compiled, Family, Measured, Row, measure};
use arealight_engine::host::HostError;
use arealight_engine::host::families::Driver;
use arealight_engine::host::null_hardware::Compiler;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;

/// How many families are compiled for at a time: a process each, of one thread.
const AT_A_TIME: usize = 2;

/// The exit code of a process whose driver offers no null hardware.
const NO_SUCH_FAMILY: u8 = 2;

/// What such a process prints, a line each: the driver, then every row.
#[derive(Serialize, Deserialize)]
enum Line {
    Driver(String),
    Row(Box<Measured>),
}

/// Compiles the rows on this process's null hardware.
pub fn compile_here(chip: &str, rows: &[Row]) -> Result<ExitCode, Failure> {
    let failed = |error: HostError| Failure::Device(error.to_string());
    let compiler = match Compiler::of_chip(chip) {
        Err(error @ HostError::NoDevice { .. }) => {
            crate::output::say(&error.to_string());
            return Ok(ExitCode::from(NO_SUCH_FAMILY));
        }
        made => made.map_err(failed)?,
    };
    print_line(&Line::Driver(compiler.driver().to_owned()))?;
    for row in rows {
        print_line(&Line::Row(Box::new(measure(&compiler, row).map_err(failed)?)))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn print_line(line: &Line) -> Result<(), Failure> {
    // Strings and numbers, with strings for keys, always serialise
    print(&(serde_json::to_string(line).unwrap_or_default() + "\n")).map(drop)
}

/// Compiles the rows for each family, in processes of their own, which find them by the arguments `which`.
pub fn compile(families: &[String], which: &[&str], rows: &[Row]) -> Result<Compiled, Failure> {
    let drivers = families.iter().map(|family| Driver::of(family)).collect::<Result<Vec<_>, _>>();
    let drivers = drivers.map_err(|lack| Failure::NoProgram(lack.to_string()))?;
    let progress = progress::bar((families.len() * rows.len()) as u64, "rows");
    let mut found: Vec<Option<Result<Family, Failure>>> = families.iter().map(|_| None).collect();
    let left = Mutex::new(families.iter().zip(&drivers).zip(&mut found));
    let work = || {
        loop {
            let next = left.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
            let Some(((family, driver), place)) = next else { return };
            *place = Some(compile_family(family, which, rows.len(), driver, &progress));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME.min(families.len()) {
            scope.spawn(work);
        }
    });
    progress.finish_and_clear();
    Ok(Compiled { families: found.into_iter().flatten().collect::<Result<_, _>>()? })
}

fn compile_family(
    family: &str,
    which: &[&str],
    count: usize,
    driver: &Driver,
    progress: &ProgressBar,
) -> Result<Family, Failure> {
    let failed = |message: String| Failure::Device(format!("{family}: {message}"));
    let program = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let mut command = Command::new(program);
    command.args(["bench", "compiled", "--on-null-hardware", driver.chip()]).args(which);
    driver.set_environment(&mut command);
    let started = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = started.map_err(|error| failed(error.to_string()))?;

    // Read the rows as they are done
    let (mut name, mut rows) = (String::new(), vec![]);
    for line in child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()) {
        let line = line.map_err(|error| failed(error.to_string()))?;
        match serde_json::from_str(&line).map_err(|error| failed(format!("{error} in: {line}")))? {
            Line::Driver(driver) => name = driver,
            Line::Row(row) => {
                rows.push(*row);
                progress.inc(1);
            }
        }
    }
    let mut said = String::new();
    if let Some(mut errors) = child.stderr.take() {
        errors.read_to_string(&mut said).map_err(|error| failed(error.to_string()))?;
    }
    let status = child.wait().map_err(|error| failed(error.to_string()))?;
    // Mesa's drivers abort where they don't know a family
    let aborted = said.contains("Unknown family") || said.contains("FD_GPU_ID unrecognized");
    let is_unknown = status.code() == Some(NO_SUCH_FAMILY.into()) || aborted;
    if is_unknown && rows.is_empty() {
        let message = format!("Mesa knows no family of GPU '{family}' ({})", said.trim());
        return Err(Failure::Argument { argument: "--family", message });
    }
    if !status.success() || rows.len() != count {
        return Err(failed(format!("after {} of {count} rows: {status}: {}", rows.len(), said.trim())));
    }
    Ok(Family::new(family.to_owned(), name, rows))
}
