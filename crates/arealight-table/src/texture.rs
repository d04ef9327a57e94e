//! Images of four channels as texture formats hold them, and tables in them.

use crate::attributes::{Attributes, Value, matrix_count, name, texts};
use crate::{Format, Precision, ReadError, TableFile, VERSION};
use arealight::table::{LAYERS, LobePairs, MAX_SIZE};
use half::f16;
use ktx2::KeyValueDataIterator;

/// The most bytes of attributes that are searched: ours take about one thousand.
pub const MAX_KEY_VALUE_BYTES: usize = 1 << 16;

/// An image in a file's bytes, whose sizes were checked.
#[derive(Debug)]
pub struct Texture<'a> {
    pub precision: Precision,
    /// Texels a side.
    pub size: u32,
    pub layers: u32,
    /// Just as long as the above need.
    pub texels: &'a [u8],
    /// Key/value data as KTX2 has it.
    pub key_values: &'a [u8],
}

/// Checks that an image is square and of a table's size.
pub fn check_size(width: u32, height: u32) -> Result<u32, ReadError> {
    if width != height || !(2..=MAX_SIZE).contains(&width) {
        let (width, height) = (width as usize, height as usize);
        return Err(ReadError::Size { layer: "image", width, height });
    }
    Ok(width)
}

/// Bytes of an image whose size [`check_size`] has seen.
pub fn byte_length(size: u32, layers: u32, precision: Precision) -> u64 {
    u64::from(size) * u64::from(size) * u64::from(layers) * precision.texel_bytes() as u64
}

impl Texture<'_> {
    /// The table in an image.
    pub fn table(&self) -> Result<TableFile, ReadError> {
        let attributes = Attributes::read(VERSION, |name| self.attribute(name))?;
        let matrices = match self.attribute(name::MATRICES) {
            Some(Value::Text(text)) if ["1", "2", "3", "4"].contains(&text.as_str()) => text,
            Some(other) => return Err(other.unexpected(name::MATRICES, "1 to 4")),
            None => return Err(ReadError::MissingAttribute { attribute: name::MATRICES }),
        };
        if self.layers != LAYERS {
            return Err(ReadError::LayerCount { count: self.layers as usize, expected: &[LAYERS as usize] });
        }
        let has_pairs = ["3", "4"].contains(&matrices.as_str());
        let schlick_matrix = ["2", "4"].contains(&matrices.as_str()).then(|| self.layer(2));
        let pairs = has_pairs.then(|| LobePairs {
            matrices: [self.layer(3), self.layer(4)],
            second_shares: self.layer(5).into_iter().map(|texel| [texel[0], texel[1]]).collect(),
        });
        let magnitude = self.layer(1).into_iter().map(|texel| [texel[0], texel[1]]).collect();
        attributes.table(self.size, self.layer(0), magnitude, schlick_matrix, pairs)
    }

    /// The texels of a layer that is there.
    pub fn layer(&self, layer: u32) -> Vec<[f32; 4]> {
        let texel_bytes = self.precision.texel_bytes();
        let layer_bytes = self.size as usize * self.size as usize * texel_bytes;
        let bytes = &self.texels[layer as usize * layer_bytes..][..layer_bytes];
        let decode = |texel: &[u8]| match self.precision {
            Precision::Half => {
                std::array::from_fn(|c| f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32())
            }
            Precision::Single => {
                std::array::from_fn(|c| f32::from_le_bytes(std::array::from_fn(|byte| texel[4 * c + byte])))
            }
        };
        bytes.chunks_exact(texel_bytes).map(decode).collect()
    }

    fn attribute(&self, wanted: &str) -> Option<Value> {
        let (_, value) = KeyValueDataIterator::new(self.key_values).find(|(key, _)| *key == wanted)?;
        let value = value.strip_suffix(&[0]).unwrap_or(value);
        // Text ends with its zero: one that has more could not be written as it was read
        let Some(text) = std::str::from_utf8(value).ok().filter(|text| !text.contains('\0')) else {
            return Some(Value::Other(String::from_utf8_lossy(value).into_owned()));
        };
        // Numbers are text here
        if wanted == name::VERSION
            && let Ok(number) = text.parse()
        {
            return Some(Value::Number(number));
        }
        Some(Value::Text(text.to_owned()))
    }
}

/// The layers of a table.
pub fn encode_texels(file: &TableFile, precision: Precision) -> Vec<u8> {
    let texels = file.table.texels();
    let numbers = texels.as_flattened().iter();
    match precision {
        Precision::Half => numbers.flat_map(|&number| f16::from_f32(number).to_le_bytes()).collect(),
        Precision::Single => numbers.flat_map(|number| number.to_le_bytes()).collect(),
    }
}

/// A table's attributes and `others` as key/value data of KTX2: sorted by key, each of them padded to four
/// bytes.
pub fn encode_key_values(file: &TableFile, others: &[(&'static str, &str)]) -> Vec<u8> {
    let mut entries = texts(file);
    entries.push((name::VERSION, VERSION.to_string()));
    entries.push((name::MATRICES, matrix_count(&file.table).to_string()));
    entries.extend(others.iter().map(|&(key, value)| (key, value.to_owned())));
    entries.sort_unstable_by_key(|(key, _)| *key);
    let mut bytes = Vec::new();
    for (key, value) in entries {
        // Text ends with a zero, and cannot hold one
        let entry = [key.as_bytes(), &[0], value.replace('\0', "?").as_bytes(), &[0]].concat();
        bytes.extend_from_slice(&(entry.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&entry);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

/// The error for a field of a header.
pub fn field(format: Format, field: &'static str, found: u32, expected: &'static str) -> ReadError {
    ReadError::Field { format, field, found: found.to_string(), expected }
}

/// The error for a file that ends too early, or goes on.
pub fn length(format: Format, part: &'static str, needed: u64, found: u64) -> ReadError {
    let reason = format!("{needed} bytes are needed, {found} are there");
    ReadError::Damaged { format, part, reason }
}
