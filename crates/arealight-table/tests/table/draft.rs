//! Files made by hand, so that they can be wrong.

use arealight::table::LobePairs;
use arealight::{LightTable, TableDescription};
use exr::prelude::*;
use std::io::Cursor;

/// A table file in parts.
pub struct Draft {
    pub attributes: Vec<(&'static str, AttributeValue)>,
    pub layers: Vec<DraftLayer>,
    pub compression: Compression,
    pub blocks: Blocks,
}

pub struct DraftLayer {
    pub name: &'static str,
    pub size: (usize, usize),
    pub channels: Vec<(&'static str, FlatSamples)>,
}

impl Draft {
    /// The draft of a good file.
    pub fn of(table: &LightTable) -> Self {
        let text = |value: &str| AttributeValue::Text(Text::new_or_panic(value));
        let size = (table.size() as usize, table.size() as usize);
        let matrix = |name, texels: &[[f32; 4]]| {
            let channel = |(c, letter)| {
                (letter, FlatSamples::F32(texels.iter().map(|texel: &[f32; 4]| texel[c]).collect()))
            };
            DraftLayer {
                name,
                size,
                channels: ["R", "G", "B", "A"].into_iter().enumerate().map(channel).collect(),
            }
        };
        let magnitude = |c: usize| FlatSamples::F32(table.magnitude().iter().map(|texel| texel[c]).collect());
        let mut layers = vec![
            matrix("matrix", table.matrix()),
            DraftLayer { name: "magnitude", size, channels: vec![("R", magnitude(0)), ("G", magnitude(1))] },
        ];
        layers.extend(table.schlick_matrix().map(|texels| matrix("schlick_matrix", texels)));
        if let Some(pairs) = table.pairs() {
            let matrices = ["first_matrix", "second_matrix"].into_iter().zip(&pairs.matrices);
            layers.extend(matrices.map(|(name, texels)| matrix(name, texels)));
            let share =
                |c: usize| FlatSamples::F32(pairs.second_shares.iter().map(|shares| shares[c]).collect());
            layers.push(DraftLayer {
                name: "second_shares",
                size,
                channels: vec![("R", share(0)), ("G", share(1))],
            });
        }
        Self {
            attributes: vec![
                ("arealight.format", text(arealight_table::FORMAT)),
                ("arealight.version", AttributeValue::I32(arealight_table::VERSION)),
                ("arealight.axes", text(arealight_table::AXES)),
                ("arealight.frame", text(arealight_table::FRAME)),
                ("arealight.normalisation", text(arealight_table::NORMALISATION)),
                ("arealight.brdf", text(&table.description().brdf)),
                ("arealight.made_by", text(&table.description().made_by)),
                ("arealight.grazing_dip", text("none")),
                ("arealight.hash", text(&arealight_table::hash(table))),
            ],
            layers,
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
        }
    }

    /// Sets an attribute's value.
    pub fn set(&mut self, name: &str, value: AttributeValue) {
        let attribute = self.attributes.iter_mut().find(|(known, _)| *known == name);
        attribute.expect("the attribute is there").1 = value;
    }

    /// Sets an attribute's text.
    pub fn set_text(&mut self, name: &str, value: &str) {
        self.set(name, AttributeValue::Text(Text::new_or_panic(value)));
    }

    /// Drops an attribute.
    pub fn without(mut self, name: &str) -> Self {
        self.attributes.retain(|(known, _)| *known != name);
        self
    }

    /// The file.
    pub fn write(&self) -> Vec<u8> {
        let size = self.layers.iter().fold((1, 1), |s, l| (s.0.max(l.size.0), s.1.max(l.size.1)));
        let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
        for (name, value) in &self.attributes {
            attributes.other.insert(Text::new_or_panic(name), value.clone());
        }
        let encoding = Encoding {
            compression: self.compression,
            blocks: self.blocks,
            line_order: LineOrder::Increasing,
        };
        let layers: Vec<_> = self
            .layers
            .iter()
            .map(|layer| {
                let channels =
                    layer.channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone()));
                let channels = AnyChannels::sort(channels.collect());
                Layer::new(layer.size, LayerAttributes::named(layer.name), encoding, channels)
            })
            .collect();
        let mut bytes = Vec::new();
        let image = Image { attributes, layer_data: Layers::from(layers) };
        image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("the draft can be written");
        bytes
    }
}

/// A table of two matrices and of pairs.
pub fn table_of_pairs(size: u32) -> LightTable {
    let table = table_of_two(size);
    let scaled = |scale: f32| table.matrix().iter().map(|texel| texel.map(|q| scale * q)).collect();
    let share = |i: u32| i as f32 / (size * size) as f32;
    let pairs = LobePairs {
        matrices: [scaled(3.0), scaled(4.0)],
        second_shares: (0..size * size).map(|i| [share(i), 1.0 - share(i)]).collect(),
    };
    table.with_pairs(pairs).unwrap()
}

/// A table of two matrices.
pub fn table_of_two(size: u32) -> LightTable {
    let table = table(size);
    let schlick = table.matrix().iter().rev().map(|texel| texel.map(|q| 2.0 * q)).collect();
    table.with_schlick_matrix(schlick).unwrap()
}

/// A table of `size` in which every number is another one.
pub fn table(size: u32) -> LightTable {
    let count = (size * size) as usize;
    let number = |i: usize, channel: usize| (i * 4 + channel) as f32 / (count * 8) as f32;
    let matrix =
        (0..count).map(|i| [1.0 + number(i, 0), number(i, 1), -number(i, 2), 1.0 + number(i, 3)]).collect();
    let magnitude = (0..count).map(|i| [1.0 - number(i, 0), number(i, 1)]).collect();
    let description =
        TableDescription { brdf: "a test".into(), made_by: "files.rs, François".into(), ggx_dip: false };
    LightTable::new(description, size, matrix, magnitude).unwrap()
}
