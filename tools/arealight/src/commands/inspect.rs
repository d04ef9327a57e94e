//! `arealight inspect`

use crate::failure::Failure;
use crate::output::print;
use arealight::LightTable;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

mod canvas;
mod colour;
mod lobes;

/// Say what a light table holds, and draw its lobes beside those of the BRDF.
#[derive(clap::Args)]
pub struct Arguments {
    /// The table; the one that is built in if none is given.
    table: Option<PathBuf>,
    /// Where a picture of the fitted lobes beside the true ones goes.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The reflectance at normal incidence of the lobes in the picture, 0 to 1.
    #[arg(long, value_name = "F0", default_value_t = 1.0)]
    f0: f64,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

/// The channels in the order of the texels of both layers, with the layer they belong to.
const CHANNELS: [(&str, &str); 6] = [
    ("matrix", "q00"),
    ("matrix", "q02"),
    ("matrix", "q20"),
    ("matrix", "q22"),
    ("magnitude", "albedo"),
    ("magnitude", "schlick"),
];

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if !(0.0..=1.0).contains(&arguments.f0) {
        let message = format!("{} is not in 0 to 1", arguments.f0);
        return Err(Failure::Argument { argument: "--f0", message });
    }
    let (name, table) = match &arguments.table {
        Some(path) => {
            let table = arealight_table::load(path).map_err(|error| Failure::input(path, error))?;
            (path.display().to_string(), table)
        }
        None => ("the built-in table".to_owned(), arealight_table::ggx()),
    };
    if let Some(path) = &arguments.output {
        lobes::draw(&table, arguments.f0).save_png(path)?;
    }
    let channels: Vec<Channel> = (0..CHANNELS.len()).map(|i| Channel::of(&table, i)).collect();
    print(&if arguments.json { to_json(&name, &table, &channels) } else { to_text(&name, &table, &channels) })
}

/// What a channel's texels span, and how smooth they are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Channel {
    layer: &'static str,
    name: &'static str,
    min: f32,
    max: f32,
    step: Step,
}

/// The largest difference between neighbouring nodes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Step {
    difference: f32,
    /// The two nodes, (x, y).
    from: (usize, usize),
    to: (usize, usize),
}

impl Channel {
    fn of(table: &LightTable, index: usize) -> Self {
        let (layer, name) = CHANNELS[index];
        let size = table.size() as usize;
        let value = |(x, y): (usize, usize)| {
            let i = y * size + x;
            if index < 4 { table.matrix()[i][index] } else { table.magnitude()[i][index - 4] }
        };
        let mut channel =
            Self { layer, name, min: f32::INFINITY, max: f32::NEG_INFINITY, step: Step::default() };
        for from in (0..size * size).map(|i| (i % size, i / size)) {
            channel.min = channel.min.min(value(from));
            channel.max = channel.max.max(value(from));
            for to in [(from.0 + 1, from.1), (from.0, from.1 + 1)] {
                if to.0 < size && to.1 < size {
                    let difference = (value(to) - value(from)).abs();
                    if difference > channel.step.difference {
                        channel.step = Step { difference, from, to };
                    }
                }
            }
        }
        channel
    }
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

fn to_text(name: &str, table: &LightTable, channels: &[Channel]) -> String {
    let (size, description) = (table.size(), table.description());
    let mut text = format!(
        "{name}\n\
         brdf           {}\n\
         made by        {}\n\
         format         {} {}\n\
         axes           {}\n\
         frame          {}\n\
         normalisation  {}\n\
         size           {size} x {size} nodes, {} KiB as float32\n\n",
        // Text of a file that may be anybody's must not steer the terminal
        description.brdf.escape_debug(),
        description.made_by.escape_debug(),
        arealight_table::FORMAT,
        arealight_table::VERSION,
        arealight_table::AXES,
        arealight_table::FRAME,
        arealight_table::NORMALISATION,
        size * size * 24 / 1024,
    );
    let _ = writeln!(text, "{:<10} {:<8} {:>11} {:>11} {:>11}", "layer", "channel", "least", "most", "step");
    for channel in channels {
        let Channel { layer, name, min, max, step } = channel;
        let place = place(table, step.to);
        let _ = writeln!(
            text,
            "{layer:<10} {name:<8} {min:>11.6} {max:>11.6} {:>11.6}  at {place}",
            step.difference
        );
    }
    text.push_str("\nstep: the largest difference between neighbouring nodes\n");
    text
}

fn to_json(name: &str, table: &LightTable, channels: &[Channel]) -> String {
    let channel = |c: &Channel| {
        json!({
            "layer": c.layer,
            "channel": c.name,
            "min": c.min,
            "max": c.max,
            "largest_step": { "difference": c.step.difference, "from": c.step.from, "to": c.step.to },
        })
    };
    let summary = json!({
        "table": name,
        "brdf": table.description().brdf,
        "made_by": table.description().made_by,
        "format": arealight_table::FORMAT,
        "version": arealight_table::VERSION,
        "axes": arealight_table::AXES,
        "frame": arealight_table::FRAME,
        "normalisation": arealight_table::NORMALISATION,
        "size": table.size(),
        "channels": channels.iter().map(channel).collect::<Value>(),
    });
    format!("{summary:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::TableDescription;

    fn table() -> LightTable {
        let description = TableDescription { brdf: "a\u{1b}[2J".into(), made_by: "b".into() };
        let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 9];
        matrix[7][2] = -0.5;
        LightTable::new(description, 3, matrix, vec![[0.5, 0.25]; 9]).unwrap()
    }

    #[test]
    fn channels_know_their_range_and_largest_step() {
        let channel = Channel::of(&table(), 2);
        assert_eq!((channel.layer, channel.name, channel.min, channel.max), ("matrix", "q20", -0.5, 0.0));
        // Texel 7 is node (1, 2); the first neighbour that differs is the one above it
        assert_eq!(channel.step, Step { difference: 0.5, from: (1, 1), to: (1, 2) });
        let albedo = Channel::of(&table(), 4);
        assert_eq!((albedo.name, albedo.max, albedo.step), ("albedo", 0.5, Step::default()));
    }

    #[test]
    fn text_from_the_file_is_escaped() {
        let table = table();
        let channels: Vec<Channel> = (0..6).map(|i| Channel::of(&table, i)).collect();
        let text = to_text("t", &table, &channels);
        assert!(!text.contains('\u{1b}') && text.contains("size           3 x 3 nodes"), "{text}");
        assert!(text.contains("at (1, 2), roughness 0.500, view 90.0°"), "{text}");
        let value: Value = serde_json::from_str(&to_json("t", &table, &channels)).unwrap();
        assert_eq!(value["channels"][2]["largest_step"]["to"], json!([1, 2]));
    }
}
