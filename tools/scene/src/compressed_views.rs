//! `EXT_meshopt_compression`, and `KHR_meshopt_compression`: buffer views whose data are there compressed
//! alone become as if they had been stored plainly.

use crate::document::Document;
use crate::error::SceneError;
use crate::extensions;
use bytemuck::{cast_slice, cast_slice_mut};
use meshopt::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use serde::Deserialize;

/// The most bytes that one becomes: of vertices that are all alike, a block of 256 takes a byte for each word
/// of a vertex.
const MOST_PER_BYTE: u64 = 1024;

/// What the extension says of a view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: u64,
    count: u64,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

/// Decodes the views of buffers without data.
pub(crate) fn decompress(document: &mut Document) -> Result<(), SceneError> {
    for index in 0..document.root.buffer_views.len() {
        let view = &document.root.buffer_views[index];
        let extension = view.extensions.as_ref().and_then(|others| extensions::meshopt(&others.others));
        let Some((name, said)) = extension.filter(|_| !document.has_data(view)) else { continue };
        let field = format!("bufferViews[{index}].extensions.{name}");
        let said = Compressed::deserialize(said).map_err(|e| document.invalid(&field, e.to_string()))?;
        // Bound what is decoded before there is memory for it
        let size = said.count.saturating_mul(said.byte_stride);
        if size != view.byte_length.0 {
            let problem = format!("is of {size} bytes, and its view of {}", view.byte_length.0);
            return Err(document.invalid(field, problem));
        }
        if size / MOST_PER_BYTE > said.byte_length {
            let problem = format!("is of {size} bytes, which {} bytes cannot become", said.byte_length);
            return Err(document.invalid(field, problem));
        }
        document.take(&field, size)?;
        let bytes = document.bytes(|| field.clone(), said.buffer, said.byte_offset, said.byte_length)?;
        let decoded = said.decode(bytes).map_err(|problem| document.invalid(field, problem))?;
        document.fill(index, decoded);
    }
    Ok(())
}

impl Compressed {
    /// As many elements as it says, or what is wrong.
    fn decode(&self, bytes: &[u8]) -> Result<Vec<u8>, String> {
        let Self { mode, filter, count, byte_stride, .. } = *self;
        let count = count as usize;
        let decoded = match (mode, byte_stride, filter) {
            (Mode::Attributes, ..) => {
                let index = (byte_stride / 4).checked_sub(1).filter(|_| byte_stride.is_multiple_of(4));
                let decode = index.and_then(|index| VERTICES.get(index as usize));
                let decode =
                    decode.ok_or_else(|| format!("byteStride: {byte_stride} bytes are no vertex"))?;
                decode(bytes, count).map(|words| filter.apply(words, byte_stride)).transpose()
            }
            (Mode::Triangles, 2, Filter::None) if count.is_multiple_of(3) => {
                Some(decode_index_buffer(bytes, count).map(|indices: Vec<u16>| to_bytes(&indices)))
            }
            (Mode::Triangles, 4, Filter::None) if count.is_multiple_of(3) => {
                Some(decode_index_buffer(bytes, count).map(|indices: Vec<u32>| to_bytes(&indices)))
            }
            (Mode::Indices, 2, Filter::None) => {
                Some(decode_index_sequence(bytes, count).map(|indices: Vec<u16>| to_bytes(&indices)))
            }
            (Mode::Indices, 4, Filter::None) => {
                Some(decode_index_sequence(bytes, count).map(|indices: Vec<u32>| to_bytes(&indices)))
            }
            _ => None,
        };
        let decoded = decoded.ok_or_else(|| {
            format!(
                "{mode:?} of {count} elements of {byte_stride} bytes with the filter {filter:?} cannot be"
            )
        })?;
        decoded.map_err(|error| format!("cannot be decoded: {error}"))
    }
}

impl Filter {
    /// What vertices of `stride` bytes are, as bytes. None where the filter is for others.
    fn apply(self, mut words: Vec<u32>, stride: u64) -> Option<Vec<u8>> {
        match (self, stride) {
            (Self::None, _) => {}
            (Self::Octahedral, 4) => decode_filter_oct::<i8>(cast_slice_mut(&mut words)),
            (Self::Octahedral, 8) => decode_filter_oct::<i16>(cast_slice_mut(&mut words)),
            (Self::Quaternion, 8) => decode_filter_quat(cast_slice_mut(&mut words)),
            (Self::Exponential, _) => decode_filter_exp::<1>(cast_slice_mut(&mut words)),
            (Self::Color, 4) => decode_filter_color::<u8>(cast_slice_mut(&mut words)),
            (Self::Color, 8) => decode_filter_color::<u16>(cast_slice_mut(&mut words)),
            _ => return None,
        }
        Some(to_bytes(&words))
    }
}

fn to_bytes(values: &[impl bytemuck::NoUninit]) -> Vec<u8> {
    cast_slice(values).to_vec()
}

/// A vertex of `N` words of 32 bits.
#[derive(Clone)]
struct Vertex<const N: usize>([u32; N]);

impl<const N: usize> Default for Vertex<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

/// As many vertices, word by word.
fn vertices<const N: usize>(bytes: &[u8], count: usize) -> meshopt::Result<Vec<u32>> {
    let vertices = decode_vertex_buffer::<Vertex<N>>(bytes, count)?;
    Ok(vertices.into_iter().flat_map(|vertex| vertex.0).collect())
}

type Decode = fn(&[u8], usize) -> meshopt::Result<Vec<u32>>;

macro_rules! by_words {
    ($($count:literal)*) => { [$(vertices::<$count>),*] };
}

/// [`vertices`] of 1, 2, ... words.
const VERTICES: [Decode; 64] = by_words![
    1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32
    33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64
];
