//! `arealight inspect`

use crate::failure::Failure;
use crate::output::{keep, print, say_wrote};
use crate::plots::{self, Kind};
use crate::progress;
use crate::quality::{FITTED_LOBES, word_of};
use arealight::{LightTable, SpecularLobes};
use arealight_table::TableFile;
use channels::Channel;
use errors::{CELLS, ErrorMap, Source, Subject};
use lobes::Material;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

mod channels;
mod errors;
mod fit_error;
mod lobes;
mod pyramid;

/// Describe a light table, and draw its lobes and the BRDF's, its errors, or its entries; or what a light's
/// texture becomes.
#[derive(clap::Args)]
pub struct Arguments {
    /// The table; the one that is built in if none is given.
    table: Option<PathBuf>,
    /// The picture: fitted and true lobes side by side, or that of --errors, --entries or
    /// --pyramid.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The reflectance at normal incidence of the lobes in the picture, 0 to 1.
    #[arg(long, value_name = "F0", default_value_t = 1.0, requires = "output",
        conflicts_with_all = ["errors", "entries"])]
    f0: f64,
    /// How many lobes stand for the specular one in the picture.
    #[arg(long, value_name = "COUNT", default_value = "one", value_parser = word_of(&FITTED_LOBES),
        requires = "output", conflicts_with_all = ["errors", "entries"])]
    specular_lobes: SpecularLobes,
    /// Measure the errors of the table, of the table-free formula and of other tables (by one lobe) over
    /// roughness and view angle, and draw these.
    #[arg(long, value_name = "OTHER", num_args = 0.., conflicts_with = "entries")]
    errors: Option<Vec<PathBuf>>,
    /// On how many quads --errors measures each of 32 x 32 cells, 3 to 3000.
    #[arg(long, value_name = "COUNT", default_value_t = 96, requires = "errors",
          value_parser = clap::value_parser!(u16).range(3..=3000))]
    quads: u16,
    /// Draw the table's entries and albedos.
    #[arg(long, requires = "output")]
    entries: bool,
    /// Draw the pyramid of a light's texture instead, as the GPU makes it: all its levels, each blurred more
    /// than the one before. Of a scene (.glb, .gltf) or of an image (.png, .jpg, .exr).
    #[arg(long, value_name = "SCENE_OR_IMAGE", conflicts_with_all = ["table", "errors", "entries", "f0",
        "specular_lobes"])]
    pyramid: Option<PathBuf>,
    /// Which of the scene's light textures --pyramid draws, from 0.
    #[arg(long, value_name = "INDEX", default_value_t = 0, requires = "pyramid")]
    layer: u32,
    /// The Vulkan device that makes the pyramid: a part of its name, or its number, as `arealight devices`
    /// lists them.
    #[arg(long, value_name = "NAME|NUMBER", requires = "pyramid")]
    device: Option<String>,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    arguments
        .errors
        .iter()
        .flatten()
        .chain(&arguments.table)
        .chain(&arguments.pyramid)
        .for_each(|it| keep(it));
    if let Some(path) = &arguments.pyramid {
        return run_pyramid(path, arguments);
    }
    arguments.check_output()?;
    if !(0.0..=1.0).contains(&arguments.f0) {
        let message = format!("{} is not in 0 to 1", arguments.f0);
        return Err(Failure::Argument { argument: "--f0", message });
    }
    let (name, TableFile { table, fit_error }) = match &arguments.table {
        Some(path) => (path.display().to_string(), load(path)?),
        None => ("the built-in table".to_owned(), arealight_table::ggx_file()),
    };
    let channels = Channel::all(&table);
    let errors =
        arguments.errors.as_ref().map(|others| measure(&table, others, arguments.quads)).transpose()?;
    if let Some(path) = &arguments.output {
        let (kind, found) = match &errors {
            Some(maps) => (Kind::Errors, errors::found(maps, arguments.quads)),
            None if arguments.entries => (Kind::Entries, channels::found(&table, &channels)),
            None => (Kind::Lobes, lobes::found(&table, arguments.material())),
        };
        plots::draw(kind, &found, path)?;
        say_wrote(path);
    }
    let summary = Summary {
        name: &name,
        table: &table,
        fit_error: fit_error.as_deref(),
        channels: &channels,
        errors: errors.as_deref(),
    };
    print(&if arguments.json { summary.to_json() } else { summary.to_text() })
}

fn run_pyramid(path: &Path, arguments: &Arguments) -> Result<ExitCode, Failure> {
    arguments.check_output()?;
    let pyramid = pyramid::make(path, arguments.layer, arguments.device.as_deref())?;
    if let Some(output) = &arguments.output {
        plots::draw(Kind::Pyramid, &pyramid.found(), output)?;
        say_wrote(output);
    }
    print(&if arguments.json { pyramid.to_json() } else { pyramid.to_text() })
}

impl Arguments {
    /// Sees to it that the picture can be written, before long work.
    fn check_output(&self) -> Result<(), Failure> {
        let Some(path) = &self.output else { return Ok(()) };
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            return plots::check(path);
        }
        let message = format!("{}: the file's name must end in .png", path.display());
        Err(Failure::Argument { argument: "--output", message })
    }

    fn material(&self) -> Material {
        Material { f0: self.f0, specular_lobes: self.specular_lobes }
    }
}

fn load(path: &Path) -> Result<TableFile, Failure> {
    TableFile::load(path).map_err(|error| Failure::input(path, error))
}

/// Maps the errors of a table in both levels, of the formula and of other tables, with a progress bar.
fn measure(table: &LightTable, others: &[PathBuf], quads: u16) -> Result<Vec<ErrorMap>, Failure> {
    let loaded = others.iter().map(|path| load(path)).collect::<Result<Vec<_>, _>>()?;
    let subject =
        |name: &str, lobes, specular_lobes| Subject { name: name.to_owned(), lobes, specular_lobes };
    let mut subjects = vec![
        subject("table", Source::Table(table), SpecularLobes::One),
        subject("table", Source::Table(table), SpecularLobes::Two),
        subject("formula", Source::Formula, SpecularLobes::One),
    ];
    subjects.extend(others.iter().zip(&loaded).map(|(path, file)| {
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        subject(&name, Source::Table(&file.table), SpecularLobes::One)
    }));
    let bar = progress::bar((CELLS * CELLS) as u64, "cells");
    let maps = errors::measure(&subjects, usize::from(quads), &|| bar.inc(1));
    bar.finish_and_clear();
    Ok(maps)
}

/// Where a node lies, for people.
fn place(table: &LightTable, (x, y): (usize, usize)) -> String {
    let (roughness, cos_view) = LightTable::node(table.size(), x as u32, y as u32);
    format!("({x}, {y}), roughness {roughness:.3}, view {:.1}°", degrees(cos_view))
}

/// The angle of a cosine in [0, 1], without `acos` and its domain.
fn degrees(cosine: f64) -> f64 {
    (1.0 - cosine * cosine).max(0.0).sqrt().atan2(cosine).to_degrees()
}

/// What there is to say of a table.
struct Summary<'a> {
    name: &'a str,
    table: &'a LightTable,
    /// How far it is from its BRDF, where the file says so.
    fit_error: Option<&'a str>,
    channels: &'a [Channel],
    errors: Option<&'a [ErrorMap]>,
}

impl Summary<'_> {
    fn to_text(&self) -> String {
        let (size, description) = (self.table.size(), self.table.description());
        let fit_error = fit_error::lines(self.fit_error.unwrap_or("not said"));
        // Text of a file that may be anybody's must not steer the terminal
        let fit_error: Vec<String> = fit_error.iter().map(|line| line.escape_debug().to_string()).collect();
        let mut text = format!(
            "{}\n\
             brdf           {}\n\
             made by        {}\n\
             fit error      {}\n\
             format         {} {}\n\
             axes           {}\n\
             frame          {}\n\
             normalisation  {}\n\
             size           {size} x {size} nodes, {} KiB on a GPU (float16)\n\n",
            self.name,
            description.brdf.escape_debug(),
            description.made_by.escape_debug(),
            fit_error.join("\n               "),
            arealight_table::FORMAT,
            arealight_table::VERSION,
            arealight_table::AXES,
            arealight_table::FRAME,
            arealight_table::NORMALISATION,
            size * size * arealight::table::LAYERS * 4 * 2 / 1024,
        );
        let heads = ["layer", "channel", "least", "most", "step"];
        let [layer, channel, least, most, step] = heads;
        let _ = writeln!(text, "{layer:<14} {channel:<8} {least:>11} {most:>11} {step:>11}");
        for Channel { layer, name, min, max, step, .. } in self.channels {
            let place = place(self.table, step.to);
            let _ = writeln!(
                text,
                "{layer:<14} {name:<8} {min:>11.6} {max:>11.6} {:>11.6}  at {place}",
                step.difference
            );
        }
        text.push_str("\nstep: the largest difference between neighbouring nodes\n");
        for map in self.errors.unwrap_or_default() {
            let (cell, most) = map.worst();
            let (roughness, view) = errors::middle(cell);
            let label = format!("{}, {}, F0 = {}", map.name.escape_debug(), map.level(), map.f0);
            let _ = write!(
                text,
                "\n{label:<30} mean error {:.2e}, most {most:.2e} at roughness {roughness:.2}, view \
                {view:.1}°",
                map.mean()
            );
        }
        if self.errors.is_some() {
            text.push('\n');
        }
        text
    }

    fn to_json(&self) -> String {
        let channel = |c: &Channel| {
            json!({
                "layer": c.layer,
                "channel": c.name,
                "min": c.min,
                "max": c.max,
                "largest_step": { "difference": c.step.difference, "from": c.step.from, "to": c.step.to },
            })
        };
        let errors = |map: &ErrorMap| {
            let (cell, most) = map.worst();
            let (roughness, view) = errors::middle(cell);
            json!({
                "of": map.name,
                "specular_lobes": map.level(),
                "f0": map.f0,
                "mean": map.mean(),
                "largest": { "mean": most, "roughness": roughness, "view_degrees": view },
            })
        };
        let summary = json!({
            "table": self.name,
            "brdf": self.table.description().brdf,
            "made_by": self.table.description().made_by,
            "fit_error": self.fit_error,
            "fit_errors": self.fit_error.map(fit_error::to_json),
            "format": arealight_table::FORMAT,
            "version": arealight_table::VERSION,
            "axes": arealight_table::AXES,
            "frame": arealight_table::FRAME,
            "normalisation": arealight_table::NORMALISATION,
            "size": self.table.size(),
            "channels": self.channels.iter().map(channel).collect::<Value>(),
            "errors": self.errors.map(|maps| maps.iter().map(errors).collect::<Value>()),
        });
        format!("{summary:#}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::TableDescription;

    fn table() -> LightTable {
        let description = TableDescription { brdf: "a\u{1b}[2J".into(), ..TableDescription::default() };
        let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 9];
        matrix[7][2] = -0.5;
        LightTable::new(description, 3, matrix, vec![[0.5, 0.25]; 9]).unwrap()
    }

    #[test]
    fn text_from_the_file_is_escaped() {
        let table = table();
        let channels = Channel::all(&table);
        let fit_error = Some("1e-3\u{1b}[2J");
        let summary = Summary { name: "t", table: &table, fit_error, channels: &channels, errors: None };
        let text = summary.to_text();
        assert!(!text.contains('\u{1b}') && text.contains("fit error      1e-3"), "{text}");
        assert!(text.contains("size           3 x 3 nodes"), "{text}");
        assert!(text.contains("at (1, 2), roughness 0.500, view 90.0°"), "{text}");
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!(value["channels"][2]["largest_step"]["to"], json!([1, 2]));
        assert_eq!(value["errors"], Value::Null);
        assert_eq!(value["fit_error"], "1e-3\u{1b}[2J");
    }

    #[test]
    fn errors_are_told_with_their_place() {
        let table = table();
        let mut cells = vec![1e-3; CELLS * CELLS];
        cells[CELLS - 1] = 0.5;
        let map = ErrorMap { name: "b\u{1b}".into(), specular_lobes: SpecularLobes::Two, f0: 0.04, cells };
        let channels = Channel::all(&table);
        let maps = [map];
        let errors = Some(maps.as_slice());
        let summary = Summary { name: "t", table: &table, fit_error: None, channels: &channels, errors };
        let text = summary.to_text();
        assert!(!text.contains('\u{1b}') && text.contains(", two lobes, F0 = 0.04"), "{text}");
        assert!(text.contains("most 5.00e-1 at roughness 0.99, view 1.4°\n"), "{text}");
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!(value["errors"][0]["largest"]["mean"], 0.5);
    }
}
