//! The channels of a table: what their texels span, and how smooth they are.

use crate::plots::floats;
use arealight::LightTable;
use serde_json::{Value, json};

/// The entries of a matrix texel.
const ENTRIES: [&str; 4] = ["q00", "q02", "q20", "q22"];

/// A channel of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// As a table file calls its layer.
    pub layer: &'static str,
    pub name: &'static str,
    pub min: f32,
    pub max: f32,
    pub step: Step,
    size: usize,
    values: Vec<f32>,
}

/// The largest difference between neighbouring nodes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Step {
    pub difference: f32,
    /// The two nodes, (x, y).
    pub from: (usize, usize),
    pub to: (usize, usize),
}

impl Channel {
    /// All channels of a table: the matrix, that of Schlick's weight if there is one, the magnitude.
    pub fn all(table: &LightTable) -> Vec<Self> {
        let size = table.size() as usize;
        let matrices = [("matrix", Some(table.matrix())), ("schlick_matrix", table.schlick_matrix())];
        let entries = matrices.into_iter().filter_map(|(layer, texels)| Some((layer, texels?))).flat_map(
            |(layer, texels)| {
                let entry =
                    move |(i, name)| Self::new(layer, name, size, texels.iter().map(|t| t[i]).collect());
                ENTRIES.into_iter().enumerate().map(entry)
            },
        );
        // The albedos that the texels stand for, without the dip that may be added to them
        let albedos = table.albedos();
        let magnitude = ["albedo", "schlick"]
            .into_iter()
            .enumerate()
            .map(|(i, name)| Self::new("magnitude", name, size, albedos.iter().map(|t| t[i]).collect()));
        entries.chain(magnitude).collect()
    }

    fn new(layer: &'static str, name: &'static str, size: usize, values: Vec<f32>) -> Self {
        let (min, max) = (f32::INFINITY, f32::NEG_INFINITY);
        let mut channel = Self { layer, name, min, max, step: Step::default(), size, values };
        for from in (0..size * size).map(|i| (i % size, i / size)) {
            let value = channel.at(from);
            channel.min = channel.min.min(value);
            channel.max = channel.max.max(value);
            for to in [(from.0 + 1, from.1), (from.0, from.1 + 1)] {
                if to.0 < size && to.1 < size {
                    let difference = (channel.at(to) - value).abs();
                    if difference > channel.step.difference {
                        channel.step = Step { difference, from, to };
                    }
                }
            }
        }
        channel
    }

    /// What node (x, y) holds.
    pub fn at(&self, (x, y): (usize, usize)) -> f32 {
        self.values[y * self.size + x]
    }
}

/// The channels of a table, for a picture.
pub fn found(table: &LightTable, channels: &[Channel]) -> Value {
    let (brdf, size) = (&table.description().brdf, table.size());
    let channel = |channel: &Channel| {
        json!({
            "layer": channel.layer,
            "channel": channel.name,
            "step": channel.step.difference,
            "values": floats(channel.values.iter().copied()),
        })
    };
    json!({
        "title": format!("{brdf}, {size} x {size} nodes: what they hold, by roughness and view angle"),
        "size": size,
        "channels": channels.iter().map(channel).collect::<Value>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::TableDescription;

    #[test]
    fn channels_know_their_range_and_largest_step() {
        let description = TableDescription::default();
        let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 9];
        matrix[7][2] = -0.5;
        let table = LightTable::new(description, 3, matrix, vec![[0.5, 0.25]; 9]).unwrap();
        let channels = Channel::all(&table);
        assert_eq!(channels.len(), 6);
        let channel = &channels[2];
        assert_eq!((channel.layer, channel.name, channel.min, channel.max), ("matrix", "q20", -0.5, 0.0));
        // Texel 7 is node (1, 2); the first neighbour that differs is the one above it
        assert_eq!(channel.step, Step { difference: 0.5, from: (1, 1), to: (1, 2) });
        let albedo = &channels[4];
        assert_eq!((albedo.name, albedo.max, albedo.step), ("albedo", 0.5, Step::default()));

        let mut second = vec![[1.0, 0.0, 0.0, 1.0]; 9];
        second[4][0] = 3.0;
        let channels = Channel::all(&table.with_schlick_matrix(second).unwrap());
        assert_eq!(channels.len(), 10);
        assert_eq!((channels[4].layer, channels[4].max, channels[0].max), ("schlick_matrix", 3.0, 1.0));
        assert_eq!(channels[9].name, "schlick");
    }
}
