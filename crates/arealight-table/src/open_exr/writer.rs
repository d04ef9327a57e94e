//! Writes a table.

use exr::prelude::*;
use std::io::Cursor;

use super::canonical::sort_attributes;
use super::{Layer as TableLayer, MAGNITUDE, MATRIX, PAIR_MATRICES, SCHLICK_MATRIX, SECOND_SHARES};
use crate::TableFile;
use crate::attributes::{VERSION, name, texts};

/// The file of a table.
pub fn write(file: &TableFile) -> Vec<u8> {
    let table = &file.table;
    let size = table.size() as usize;
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions((size, size)));
    for (name, value) in texts(file) {
        attributes.other.insert(text(name), AttributeValue::Text(text(&value)));
    }
    attributes.other.insert(text(name::VERSION), AttributeValue::I32(VERSION));

    let mut layers = vec![layer(&MATRIX, size, table.matrix()), layer(&MAGNITUDE, size, table.magnitude())];
    layers.extend(table.schlick_matrix().map(|texels| layer(&SCHLICK_MATRIX, size, texels)));
    if let Some(pairs) = table.pairs() {
        let matrices = PAIR_MATRICES.iter().zip(&pairs.matrices);
        layers.extend(matrices.map(|(names, texels)| layer(names, size, texels)));
        layers.push(layer(&SECOND_SHARES, size, &pairs.second_shares));
    }
    let image = Image { attributes, layer_data: Layers::from(layers) };
    let mut bytes = Vec::new();
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .expect("a valid table, in memory, meets all of the format's rules");
    sort_attributes(&mut bytes);
    bytes
}

fn layer<const N: usize>(
    layer: &TableLayer,
    size: usize,
    texels: &[[f32; N]],
) -> Layer<AnyChannels<FlatSamples>> {
    let channels = layer.channels.iter().enumerate().map(|(c, &name)| {
        AnyChannel::new(name, FlatSamples::F32(texels.iter().map(|texel| texel[c]).collect()))
    });
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    Layer::new(
        (size, size),
        LayerAttributes::named(layer.name),
        encoding,
        AnyChannels::sort(channels.collect()),
    )
}

/// Text in EXR's Latin-1.
fn text(value: &str) -> Text {
    let latin: String = value.chars().map(|c| if u32::from(c) < 256 { c } else { '?' }).collect();
    Text::new_or_none(latin).unwrap_or_default()
}
