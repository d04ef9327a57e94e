//! `arealight bench compiled`

mod driver;
mod model;

use super::{document, write};
use crate::failure::Failure;
use crate::output::{self, print};
use crate::{progress, verdict};
use arealight_benches::compiled::{Check, Compiled, Row, matching, of_device, rows};
use arealight_benches::sections::Markers;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The statistics that are checked in, from the root of a checkout.
const FILE: &str = "benches/data/compiled.json";

/// What brings everything that is checked in up to date.
const UPDATE: &str = "arealight bench compiled --family all --update --markdown docs/data/gpu.md";

/// The families that are checked in.
const FAMILIES: [&str; 6] = ["navi21", "vega10", "gfx1100", "tgl", "dg2", "a660"];

/// Ask a GPU's compiler what it makes of the kernels: registers, waves, instructions, estimated cycles.
///
/// Mesa's drivers compile for any family of Radeon, and with what tools/compilers.sh builds for Intel's and
/// Adreno, without a card; nothing runs. Each row is a kernel, a kind of light and a quality level, as a pass
/// hands it to the driver; beside them are other methods with the same reads. The ratio, of Radeons, is that
/// of inverse throughput to the clipless method's in a kernel of the same form. These are a compiler's
/// statistics, not times: docs/gpu.md explains them.
///
/// Exit code 1 if --check finds a spill, or a row that takes more than the file says or that the file lacks;
/// 6 if the driver is not installed, or is another version than the file's.
#[derive(clap::Args)]
pub struct Arguments {
    /// Families of GPU, as Mesa names them: navi21, vangogh, navi10, vega10, polaris10, gfx1100 and so on;
    /// where `AREALIGHT_COMPILERS` is the folder that tools/compilers.sh prints, Intel's skl, tgl, adl or dg2
    /// and Adreno's a630 or a660. `all` stands for those that are checked in.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_value = "navi21",
        value_parser = family)]
    family: Vec<String>,
    /// Only rows whose names contain this, and those that their ratios are of.
    #[arg(long, value_name = "PATTERN")]
    only: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Write JSON.
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write the tables as Markdown: in a file that has tables of this command, in their place.
    #[arg(long, value_name = "FILE", conflicts_with = "only")]
    markdown: Option<PathBuf>,
    /// Compare the rows with a file of --update; benches/data/compiled.json by default.
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = FILE,
        conflicts_with = "update")]
    check: Option<PathBuf>,
    /// Write the rows to such a file; its other families stay.
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = FILE, conflicts_with = "only")]
    update: Option<PathBuf>,
    /// Model frames of our scenes: which paths through the code of quads waves take, counted on a device
    /// (lavapipe will do), times what each path costs by these statistics. Beside the clipless method.
    #[arg(long, conflicts_with_all = ["only", "check", "update", "json", "save"])]
    model: bool,
    /// Compile by this device's own driver, which must have `VK_KHR_pipeline_executable_properties`, and
    /// print what it says of each row in its own words: a part of the device's name, or its number.
    #[arg(long, value_name = "NAME|NUMBER",
        conflicts_with_all = ["family", "check", "update", "model", "on_null_hardware"])]
    device: Option<String>,
    /// Compile here, where the environment names the driver and the family, and print each row as it is done.
    #[arg(long, hide = true, conflicts_with_all = ["json", "save", "markdown", "check", "update"])]
    on_null_hardware: Option<String>,
}

/// The name of a family; whether there is one, the driver knows.
fn family(name: &str) -> Result<String, String> {
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_name { Ok(name.to_lowercase()) } else { Err("a name such as navi21 or vega10".to_owned()) }
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    // Choose the rows
    let wanted = if arguments.model {
        arealight_benches::model::rows()
    } else {
        arguments.only.as_deref().map_or_else(rows, matching)
    };
    if let Some(pattern) = &arguments.only
        && wanted.is_empty()
    {
        let message = format!("no row's name contains '{pattern}'; there are:\n{}", names());
        return Err(Failure::Argument { argument: "--only", message });
    }
    if let Some(chip) = &arguments.on_null_hardware {
        return driver::compile_here(chip, &wanted);
    }

    // Look at every file before the work
    let file = arguments.check.as_deref().map(read).transpose()?;
    let older = match arguments.update.as_deref() {
        Some(path) if path.exists() => read(path)?,
        _ => Compiled::default(),
    };
    for path in [&arguments.save, &arguments.markdown, &arguments.update].into_iter().flatten() {
        output::check(path)?;
    }

    let every = FAMILIES.map(str::to_owned);
    let families = if arguments.family == ["all"] { &every[..] } else { &arguments.family };
    if arguments.model {
        let found = driver::compile(families, &["--model"], &wanted)?;
        return model::run(&found, arguments.markdown.as_deref());
    }
    let which: Vec<&str> =
        arguments.only.as_deref().into_iter().flat_map(|pattern| ["--only", pattern]).collect();
    let found = match &arguments.device {
        Some(device) => by_device(device, &wanted)?,
        None => driver::compile(families, &which, &wanted)?,
    };

    // Write and print
    if let Some(path) = &arguments.markdown {
        write(path, &document(path, Markers::COMPILED, &found.to_markdown())?)?;
    }
    // Strings and numbers, with strings for keys, always serialise
    let json = serde_json::to_string_pretty(&found).unwrap_or_default() + "\n";
    if let Some(path) = &arguments.save {
        write(path, &json)?;
    }
    if let Some(path) = &arguments.update {
        write(path, &found.clone().replacing(older).to_checked_in())?;
    }
    let printed = print(&if arguments.json { json } else { found.to_text() })?;
    let Some(file) = file else { return Ok(printed) };
    let check = Check::new(&found, &file, arguments.only.is_none())
        .map_err(|error| Failure::NoProgram(error.to_string()))?;
    let _ = std::io::Write::write_all(
        &mut std::io::stderr(),
        verdict::for_stderr(&check.to_text(UPDATE)).as_bytes(),
    );
    Ok(if check.passes() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The rows by a device's own driver.
fn by_device(device: &str, wanted: &[Row]) -> Result<Compiled, Failure> {
    let progress = progress::bar(wanted.len() as u64, "rows");
    let found = of_device(Some(device), wanted, &|| progress.inc(1));
    progress.finish_and_clear();
    let found = found.map_err(|error| Failure::Device(error.to_string()))?;
    Ok(Compiled { families: vec![found] })
}

/// The rows' names, a line each.
fn names() -> String {
    rows().iter().map(|row| format!("  {}", row.name())).collect::<Vec<_>>().join("\n")
}

fn read(path: &Path) -> Result<Compiled, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::input(path, error))?;
    if text.is_empty() {
        return Ok(Compiled::default());
    }
    serde_json::from_str(&text).map_err(|error| Failure::input(path, error))
}
