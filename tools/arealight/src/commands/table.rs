//! `arealight table`

use crate::failure::Failure;
use crate::output::{self, print};
use crate::progress;
use arealight::{Horizon, LightTable, SpecularLobes};
use arealight_fit::report::{COUNT, Errors, Level, SEED, cases, measure};
use arealight_fit::{Brdf, GgxBrdf};
use arealight_table::{
    Adjusted, FileError, Precision, TableFile, Target, WriteError, hash, load_published, resampled, rounded,
};
use serde_json::json;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Convert light tables from one file format to another.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    Convert(Convert),
}

/// Read a table in any format, and write it in the one that OUT's extension stands for: .exr (our own), .ktx2
/// and .dds (2D arrays of six layers, for engines), .h (a C array), .f32 (raw).
#[derive(clap::Args)]
struct Convert {
    /// The table: OpenEXR, KTX2 or DDS, told by content; or `built-in`.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where it goes.
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// The second image of a table in the convention of Heitz et al. 2016, IN being the first:
    /// `convert ltc_1.dds OUT --magnitude ltc_2.dds`.
    #[arg(long, value_name = "FILE")]
    magnitude: Option<PathBuf>,
    /// What such a table was fitted to; its images do not say.
    #[arg(long, requires = "magnitude", default_value = "unknown")]
    brdf: String,
    /// The floats that are written: 16 bits unless given, in .exr always 32.
    #[arg(long, value_enum)]
    format: Option<Floats>,
    /// Nodes a side that are written, 2 to 1024: interpolated bilinearly (`arealight fit --size` is better by
    /// a little).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1024))]
    size: Option<u32>,
    /// Measure how far the table is from GGX, and write that beside it.
    #[arg(long)]
    measure: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Floats {
    F16,
    F32,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Command::Convert(arguments) = &arguments.command;
    arguments.run()
}

impl Convert {
    fn run(&self) -> Result<ExitCode, Failure> {
        // Find out what to write before anything is read
        let precision = self.format.map(|floats| match floats {
            Floats::F16 => Precision::Half,
            Floats::F32 => Precision::Single,
        });
        let target = Target::of_path(&self.output, precision)
            .map_err(|error| Failure::Argument { argument: "OUT", message: error.to_string() })?;

        self.magnitude.iter().chain([&self.input]).for_each(|path| output::keep(path));
        output::check(&self.output)?;

        // Read, and bring to size
        let (mut file, adjusted) = self.read()?;
        if let Some(size) = self.size.filter(|size| *size != file.table.size()) {
            let table = resampled(&file.table, size);
            let table = table.map_err(|error| Failure::input(&self.input, error))?;
            // Its error was another table's
            file = TableFile { table, fit_error: None };
        }
        // Round before measuring: what is said is said of the table that is written
        file.table = rounded(&file.table, target.precision())
            .map_err(|error| Failure::input(&self.input, WriteError::from(error)))?;
        if self.measure {
            file.fit_error = Some(measured(&file.table)?);
        }

        // Write
        let bytes = file.write(target).map_err(|error| Failure::input(&self.input, error))?;
        output::write(&self.output, &bytes)?;
        let summary =
            Summary { arguments: self, file: &file, bytes: bytes.len(), target, adjusted: &adjusted };
        print(&if self.json { summary.to_json() } else { summary.to_text() })
    }

    fn read(&self) -> Result<(TableFile, Vec<Adjusted>), Failure> {
        if let Some(magnitude) = &self.magnitude {
            let published = load_published(&self.input, magnitude, &self.brdf);
            let published = published.map_err(|error| Failure::input(&self.input, error))?;
            return Ok((TableFile { table: published.table, fit_error: None }, published.adjusted));
        }
        let file = if self.input == Path::new("built-in") {
            arealight_table::ggx_file()
        } else {
            TableFile::load(&self.input).map_err(|error: FileError| Failure::input(&self.input, error))?
        };
        Ok((file, Vec::new()))
    }
}

/// The mean errors of a table of GGX, in words.
fn measured(table: &LightTable) -> Result<String, Failure> {
    let (brdf, known) = (&table.description().brdf, GgxBrdf.name());
    if *brdf != known {
        let message = format!("the table is of `{brdf}`; only `{known}` can be measured (say so by --brdf?)");
        return Err(Failure::Argument { argument: "--measure", message });
    }
    let bar = progress::bar(COUNT as u64, "quads");
    let cases = cases(COUNT, SEED, &|| bar.inc(1));
    bar.finish_and_clear();
    let mut text =
        format!("mean absolute error of the reflected radiance over {COUNT} quads of unit radiance");
    let levels = [("one lobe", SpecularLobes::One), ("two lobes", SpecularLobes::Two)];
    for (name, specular_lobes) in levels.into_iter().take(1 + usize::from(table.pairs().is_some())) {
        let errors = measure(table, Level { specular_lobes, horizon: Horizon::Cosine }, &cases);
        let at = |e: &Errors| format!("{:.2e} at F0 = {}", e.mean, e.f0);
        let _ = write!(text, "; {name}: {}", errors.iter().map(at).collect::<Vec<_>>().join(", "));
    }
    Ok(text)
}

/// What there is to say of a run.
struct Summary<'a> {
    arguments: &'a Convert,
    file: &'a TableFile,
    bytes: usize,
    target: Target,
    adjusted: &'a [Adjusted],
}

impl Summary<'_> {
    fn matrices(&self) -> u32 {
        1 + u32::from(self.file.table.schlick_matrix().is_some())
    }

    fn has_pairs(&self) -> bool {
        self.file.table.pairs().is_some()
    }

    fn bits(&self) -> u32 {
        match self.target.precision() {
            Precision::Half => 16,
            Precision::Single => 32,
        }
    }

    fn to_text(&self) -> String {
        const MOST: usize = 8;
        let size = self.file.table.size();
        let mut text = format!(
            "wrote {}: {size} x {size} nodes, {}, {}-bit floats, {} bytes\n",
            self.arguments.output.display(),
            match (self.matrices(), self.has_pairs()) {
                (1, false) => "one matrix",
                (_, false) => "two matrices",
                (1, true) => "one matrix and pairs of lobes",
                (_, true) => "two matrices and pairs of lobes",
            },
            self.bits(),
            self.bytes
        );
        if let Some(error) = &self.file.fit_error {
            // Text of a file that may be anybody's must not steer the terminal
            let _ = writeln!(text, "{}", error.escape_debug());
        }
        for one in self.adjusted.iter().take(MOST) {
            let _ = match one {
                Adjusted::Magnitude { x, y, found, used } => {
                    writeln!(text, "magnitude of texel ({x}, {y}): {found:?} became {used:?}")
                }
                Adjusted::Matrix { y, found } => {
                    writeln!(text, "matrix of texel (0, {y}): {found:?} is singular; became that of (1, {y})")
                }
                other => writeln!(text, "{other:?}"),
            };
        }
        if self.adjusted.len() > MOST {
            let _ = writeln!(text, "and {} more", self.adjusted.len() - MOST);
        }
        text
    }

    fn to_json(&self) -> String {
        let table = &self.file.table;
        let summary = json!({
            "output": self.arguments.output.display().to_string(),
            "brdf": table.description().brdf,
            "made_by": table.description().made_by,
            "size": table.size(),
            "matrices": self.matrices(),
            "pairs": self.has_pairs(),
            "bits": self.bits(),
            "bytes": self.bytes,
            "hash": hash(table),
            "fit_error": self.file.fit_error,
            "adjusted": self.adjusted.len(),
        });
        format!("{summary:#}\n")
    }
}
