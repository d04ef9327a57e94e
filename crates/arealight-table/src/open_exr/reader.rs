//! Reads a table, trusting nothing.

use arealight::table::{LobePairs, MAX_SIZE};
use exr::block::UncompressedBlock;
use exr::block::reader::ChunksReader;
use exr::meta::BlockDescription;
use exr::meta::attribute::{AttributeValue, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::{Compression, Vec2};
use half::f16;
use std::io::Cursor;

use super::{IMAGE, Layer, MAGNITUDE, MATRIX, PAIR_MATRICES, SCHLICK_MATRIX, SECOND_SHARES};
use crate::attributes::{Attributes, Value};
use crate::{Format, ReadError, TableFile};

/// The table in a file.
pub fn read(file: &[u8]) -> Result<TableFile, ReadError> {
    // Read the headers alone, and check all that they say
    let reader = exr::block::read(Cursor::new(file), true).map_err(|error| damaged("header", &error))?;
    let headers = reader.headers();
    let attributes = Attributes::read(1, |name| attribute(headers, name))?;
    let (matrix_index, matrix_header) = find_layer(headers, &MATRIX)?;
    let (magnitude_index, magnitude_header) = find_layer(headers, &MAGNITUDE)?;
    if !attributes.layer_counts().contains(&headers.len()) {
        return Err(ReadError::LayerCount { count: headers.len(), expected: attributes.layer_counts() });
    }
    let size = check_layer(matrix_header, &MATRIX, None, &[SampleType::F32])?;
    let mut matrix = Texels::<4>::new(&MATRIX, matrix_index, matrix_header, size);
    check_layer(magnitude_header, &MAGNITUDE, Some(size), &[SampleType::F32])?;
    let mut magnitude = Texels::<2>::new(&MAGNITUDE, magnitude_index, magnitude_header, size);
    // The matrices that a table may have beside its first, and the shares of pairs
    let has_pairs = headers.len() >= LAYERS_WITH_PAIRS;
    let has_schlick = has_schlick(headers.len());
    let names = [&SCHLICK_MATRIX].into_iter().filter(|_| has_schlick);
    let mut matrices = Vec::new();
    for names in names.chain(PAIR_MATRICES.iter().filter(|_| has_pairs)) {
        let (index, header) = find_layer(headers, names)?;
        check_layer(header, names, Some(size), &[SampleType::F32])?;
        matrices.push(Texels::<4>::new(names, index, header, size));
    }
    let mut second_shares = if has_pairs {
        let (index, header) = find_layer(headers, &SECOND_SHARES)?;
        check_layer(header, &SECOND_SHARES, Some(size), &[SampleType::F32])?;
        Some(Texels::<2>::new(&SECOND_SHARES, index, header, size))
    } else {
        None
    };

    // Read the texels into what the headers announce
    let mut unknown_layer = false;
    reader
        .all_chunks(true)
        .and_then(|chunks| {
            chunks.decompress_sequential(true, |_, block| {
                let taken = matrix.insert(&block)
                    || magnitude.insert(&block)
                    || matrices.iter_mut().any(|texels| texels.insert(&block))
                    || second_shares.as_mut().is_some_and(|texels| texels.insert(&block));
                unknown_layer |= !taken;
                Ok(())
            })
        })
        .map_err(|error| damaged("texels", &error))?;
    if unknown_layer {
        let reason = "a block of a layer that is not there".into();
        return Err(ReadError::Damaged { format: Format::Exr, part: "texels", reason });
    }
    let (matrix, magnitude) = (matrix.finish()?, magnitude.finish()?);
    let mut matrices = matrices.into_iter().map(Texels::finish);
    let mut next = || matrices.next().transpose();
    let schlick_matrix = if has_schlick { next()? } else { None };
    let pairs = match (next()?, next()?, second_shares) {
        (Some(first), Some(second), Some(shares)) => {
            Some(LobePairs { matrices: [first, second], second_shares: shares.finish()? })
        }
        _ => None,
    };
    attributes.table(size as u32, matrix, magnitude, schlick_matrix, pairs)
}

/// How many layers a table of one matrix and of pairs has; one more with Schlick's.
const LAYERS_WITH_PAIRS: usize = 5;

/// Whether Schlick's matrix is among so many layers.
fn has_schlick(layers: usize) -> bool {
    [3, LAYERS_WITH_PAIRS + 1].contains(&layers)
}

/// The texels a side and the texels of an image of one layer, of whatever name, with channels R, G, B and A.
pub fn read_image(file: &[u8]) -> Result<(u32, Vec<[f32; 4]>), ReadError> {
    let reader = exr::block::read(Cursor::new(file), true).map_err(|error| damaged("header", &error))?;
    let [header] = reader.headers() else {
        return Err(ReadError::LayerCount { count: reader.headers().len(), expected: &[1] });
    };
    let size = check_layer(header, &IMAGE, None, &[SampleType::F16, SampleType::F32])?;
    let mut texels = Texels::<4>::new(&IMAGE, 0, header, size);
    reader
        .all_chunks(true)
        .and_then(|chunks| {
            chunks.decompress_sequential(true, |_, block| {
                texels.insert(&block);
                Ok(())
            })
        })
        .map_err(|error| damaged("texels", &error))?;
    Ok((size as u32, texels.finish()?))
}

fn damaged(part: &'static str, error: &exr::error::Error) -> ReadError {
    ReadError::Damaged { format: Format::Exr, part, reason: error.to_string() }
}

/// The attribute in the first header that has it. Some programs move shared attributes to the layers, or keep
/// them in the first one only.
fn attribute(headers: &[Header], name: &str) -> Option<Value> {
    let key = Text::from(name);
    let value = headers.iter().find_map(|header| {
        header.shared_attributes.other.get(&key).or_else(|| header.own_attributes.other.get(&key))
    })?;
    Some(match value {
        AttributeValue::Text(text) => Value::Text(text.to_string()),
        AttributeValue::I32(number) => Value::Number(*number),
        other => Value::Other(format!("{other:?}")),
    })
}

fn find_layer<'a>(headers: &'a [Header], layer: &Layer) -> Result<(usize, &'a Header), ReadError> {
    let name = Some(Text::from(layer.name));
    let mut found = headers.iter().enumerate().filter(|(_, header)| header.own_attributes.layer_name == name);
    found.next().ok_or(ReadError::MissingLayer { layer: layer.name })
}

/// Checks a layer's header and returns its size. All channels have one and the same of the types.
fn check_layer(
    header: &Header,
    layer: &Layer,
    size: Option<usize>,
    types: &[SampleType],
) -> Result<usize, ReadError> {
    let Vec2(width, height) = header.layer_size;
    let is_square = width == height && (2..=MAX_SIZE as usize).contains(&width);
    if !is_square || size.is_some_and(|size| size != width) {
        return Err(ReadError::Size { layer: layer.name, width, height });
    }
    let storage = |found: String| Err(ReadError::Storage { layer: layer.name, found });
    if header.deep {
        return storage("deep data".into());
    }
    if header.blocks != BlockDescription::ScanLines {
        return storage("tiles".into());
    }
    if !matches!(header.compression, Compression::Uncompressed | Compression::ZIP1 | Compression::ZIP16) {
        return storage(header.compression.to_string());
    }
    let list = &header.channels.list;
    let is_expected = |channel: &exr::meta::attribute::ChannelDescription| {
        layer.channels.iter().any(|&name| channel.name.as_slice() == name.as_bytes())
            && types.contains(&channel.sample_type)
            && channel.sample_type == list[0].sample_type
            && channel.sampling == Vec2(1, 1)
    };
    // Names are unique, as the header's own check has shown, so that counting them is enough
    if list.len() != layer.channels.len() || !list.iter().all(is_expected) {
        let found: Vec<String> = list
            .iter()
            .take(8)
            .map(|channel| format!("{} {:?}", channel.name, channel.sample_type))
            .collect();
        let expected = match (layer.channels.len(), types) {
            (2, _) => "R G, 32-bit float",
            (_, [_]) => "R G B A, 32-bit float",
            _ => "R G B A, all 16-bit or all 32-bit float",
        };
        return Err(ReadError::Channels { layer: layer.name, found: found.join(", "), expected });
    }
    Ok(width)
}

/// The texels of a layer, filled block by block.
struct Texels<const N: usize> {
    layer: &'static str,
    /// The layer's place in the file.
    index: usize,
    size: usize,
    /// For each channel in the file's order, its place in a texel.
    places: Vec<usize>,
    /// Of all channels.
    sample_type: SampleType,
    values: Vec<[f32; N]>,
    /// Which scan lines have come.
    lines: Vec<bool>,
}

impl<const N: usize> Texels<N> {
    fn new(layer: &Layer, index: usize, header: &Header, size: usize) -> Self {
        let place =
            |name: &Text| layer.channels.iter().position(|&c| name.as_slice() == c.as_bytes()).unwrap_or(0);
        let places = header.channels.list.iter().map(|channel| place(&channel.name)).collect();
        Self {
            layer: layer.name,
            index,
            size,
            places,
            sample_type: header.channels.list[0].sample_type,
            values: vec![[0.0; N]; size * size],
            lines: vec![false; size],
        }
    }

    /// Copies a block's scan lines, if it is one of this layer's, and says whether it is. One that does not
    /// fit the layer is passed over, and its lines are found missing in the end.
    fn insert(&mut self, block: &UncompressedBlock) -> bool {
        if block.index.layer != self.index {
            return false;
        }
        let Vec2(left, top) = block.index.pixel_position;
        let Vec2(width, height) = block.index.pixel_size;
        let sample_bytes = self.sample_type.bytes_per_sample();
        let line_bytes = self.size * N * sample_bytes;
        if left != 0 || width != self.size || block.data.len() != height * line_bytes {
            return true;
        }
        for (y, line) in (top..self.size).zip(block.data.chunks_exact(line_bytes)) {
            for (&place, samples) in self.places.iter().zip(line.chunks_exact(self.size * sample_bytes)) {
                let texels = &mut self.values[y * self.size..(y + 1) * self.size];
                for (texel, sample) in texels.iter_mut().zip(samples.chunks_exact(sample_bytes)) {
                    texel[place] = match *sample {
                        [a, b] => f16::from_ne_bytes([a, b]).to_f32(),
                        [a, b, c, d] => f32::from_ne_bytes([a, b, c, d]),
                        _ => f32::NAN,
                    };
                }
            }
            self.lines[y] = true;
        }
        true
    }

    fn finish(self) -> Result<Vec<[f32; N]>, ReadError> {
        let found = self.lines.iter().filter(|line| **line).count();
        if found != self.size {
            return Err(ReadError::Incomplete { layer: self.layer, found, expected: self.size });
        }
        Ok(self.values)
    }
}
