//! Tables as DDS textures.
//!
//! The header is a fixed list of words. DDS has no attributes: ours follow the texels, where other readers do
//! not look, in the form that KTX2 has, and two of the header's reserved words hold a mark and their length.

use crate::texture::{
    MAX_KEY_VALUE_BYTES, Texture, byte_length, check_size, encode_key_values, encode_texels, field, length,
};
use crate::{Format, Precision, ReadError, TableFile};
use arealight::table::LAYERS;

const FORMAT: Format = Format::Dds;

/// Words of the magic number and the header.
const HEADER: usize = 32;
/// Words of the further header of Direct3D 10.
const HEADER_10: usize = 5;

/// The places of words in the file.
mod word {
    pub const MAGIC: usize = 0;
    pub const SIZE: usize = 1;
    pub const FLAGS: usize = 2;
    pub const HEIGHT: usize = 3;
    pub const WIDTH: usize = 4;
    pub const PITCH: usize = 5;
    pub const DEPTH: usize = 6;
    pub const MIP_MAP_COUNT: usize = 7;
    /// The first two of eleven reserved words.
    pub const MARK: usize = 8;
    pub const KEY_VALUE_BYTES: usize = 9;
    pub const PIXEL_SIZE: usize = 19;
    pub const PIXEL_FLAGS: usize = 20;
    pub const FOUR_CC: usize = 21;
    pub const CAPS: usize = 27;
    pub const CAPS_2: usize = 28;
    pub const DXGI_FORMAT: usize = 32;
    pub const DIMENSION: usize = 33;
    pub const MISC_FLAG: usize = 34;
    pub const ARRAY_SIZE: usize = 35;
    pub const MISC_FLAGS_2: usize = 36;
}

const MAGIC: u32 = u32::from_le_bytes(*b"DDS ");
const MARK: u32 = u32::from_le_bytes(*b"ARLT");
const DX10: u32 = u32::from_le_bytes(*b"DX10");
/// Caps, height, width, pitch, pixel format.
const FLAGS: u32 = 0x100f;
const PIXEL_FLAG_FOUR_CC: u32 = 4;
const CAPS_TEXTURE: u32 = 0x1000;
const TEXTURE_2D: u32 = 3;
/// The fourth channel is no opacity.
const ALPHA_CUSTOM: u32 = 4;
/// Of Direct3D 9: the four-character codes of four half floats and of four floats.
const D3D_FORMATS: [(u32, Precision); 2] = [(113, Precision::Half), (116, Precision::Single)];
/// The same of DXGI.
const DXGI_FORMATS: [(u32, Precision); 2] = [(10, Precision::Half), (2, Precision::Single)];

/// The image in a file.
pub fn read(file: &[u8]) -> Result<Texture<'_>, ReadError> {
    // Check the header
    let header = words::<HEADER>(file)?;
    let size = check_size(header[word::WIDTH], header[word::HEIGHT])?;
    let expect = |name, index: usize, expected: u32, text| {
        if header[index] == expected { Ok(()) } else { Err(field(FORMAT, name, header[index], text)) }
    };
    expect("dwSize", word::SIZE, 124, "124")?;
    expect("ddspf.dwSize", word::PIXEL_SIZE, 32, "32")?;
    expect("dwCaps2", word::CAPS_2, 0, "0 (neither cube map nor volume)")?;
    if header[word::PIXEL_FLAGS] & PIXEL_FLAG_FOUR_CC == 0 {
        return Err(field(FORMAT, "ddspf.dwFlags", header[word::PIXEL_FLAGS], "4 (a four-character code)"));
    }
    for (name, index) in [("dwDepth", word::DEPTH), ("dwMipMapCount", word::MIP_MAP_COUNT)] {
        if header[index] > 1 {
            return Err(field(FORMAT, name, header[index], "at most 1"));
        }
    }
    let (start, layers, precision) = match header[word::FOUR_CC] {
        DX10 => read_header_10(file)?,
        other => (HEADER * 4, 1, precision_of(D3D_FORMATS, other, "ddspf.dwFourCC")?),
    };

    // Find the texels, and the attributes after them
    let needed = byte_length(size, layers, precision);
    let rest = &file[start..];
    let is_marked = header[word::MARK] == MARK;
    let key_value_bytes = if is_marked { header[word::KEY_VALUE_BYTES] } else { 0 };
    if key_value_bytes as usize > MAX_KEY_VALUE_BYTES {
        return Err(field(FORMAT, "dwReserved1[1]", key_value_bytes, "at most 65536"));
    }
    let needed_in_all = needed + u64::from(key_value_bytes);
    if rest.len() as u64 != needed_in_all {
        return Err(length(FORMAT, "texels", needed_in_all, rest.len() as u64));
    }
    let (texels, key_values) = rest.split_at(needed as usize);
    Ok(Texture { precision, size, layers, texels, key_values })
}

/// Where texels start, how many layers there are, and their precision.
fn read_header_10(file: &[u8]) -> Result<(usize, u32, Precision), ReadError> {
    let header = words::<{ HEADER + HEADER_10 }>(file)?;
    let precision = precision_of(DXGI_FORMATS, header[word::DXGI_FORMAT], "dxgiFormat")?;
    if header[word::DIMENSION] != TEXTURE_2D {
        return Err(field(FORMAT, "resourceDimension", header[word::DIMENSION], "3 (two dimensions)"));
    }
    if header[word::MISC_FLAG] != 0 {
        return Err(field(FORMAT, "miscFlag", header[word::MISC_FLAG], "0 (no cube map)"));
    }
    let layers = header[word::ARRAY_SIZE];
    if !(1..=LAYERS).contains(&layers) {
        return Err(field(FORMAT, "arraySize", layers, "1 to 6"));
    }
    Ok(((HEADER + HEADER_10) * 4, layers, precision))
}

fn precision_of(
    formats: [(u32, Precision); 2],
    found: u32,
    name: &'static str,
) -> Result<Precision, ReadError> {
    let expected = match name {
        "dxgiFormat" => "10 (RGBA, half float) or 2 (RGBA, float)",
        _ => "113 (RGBA, half float), 116 (RGBA, float) or DX10",
    };
    let known = formats.into_iter().find(|&(format, _)| format == found);
    known.map(|(_, precision)| precision).ok_or_else(|| field(FORMAT, name, found, expected))
}

fn words<const N: usize>(file: &[u8]) -> Result<[u32; N], ReadError> {
    if file.len() < N * 4 {
        return Err(length(FORMAT, "header", N as u64 * 4, file.len() as u64));
    }
    Ok(std::array::from_fn(|i| u32::from_le_bytes(std::array::from_fn(|byte| file[4 * i + byte]))))
}

/// The file of a table whose numbers fit the precision.
pub fn write(file: &TableFile, precision: Precision) -> Vec<u8> {
    let key_values = encode_key_values(file, &[]);
    let formats = DXGI_FORMATS.into_iter();
    let format = formats.filter(|&(_, one)| one == precision).map(|(format, _)| format).sum();
    let mut header = [0; HEADER + HEADER_10];
    for (index, value) in [
        (word::MAGIC, MAGIC),
        (word::SIZE, 124),
        (word::FLAGS, FLAGS),
        (word::HEIGHT, file.table.size()),
        (word::WIDTH, file.table.size()),
        (word::PITCH, file.table.size() * precision.texel_bytes() as u32),
        (word::MIP_MAP_COUNT, 1),
        (word::MARK, MARK),
        (word::KEY_VALUE_BYTES, key_values.len() as u32),
        (word::PIXEL_SIZE, 32),
        (word::PIXEL_FLAGS, PIXEL_FLAG_FOUR_CC),
        (word::FOUR_CC, DX10),
        (word::CAPS, CAPS_TEXTURE),
        (word::DXGI_FORMAT, format),
        (word::DIMENSION, TEXTURE_2D),
        (word::ARRAY_SIZE, LAYERS),
        (word::MISC_FLAGS_2, ALPHA_CUSTOM),
    ] {
        header[index] = value;
    }
    let mut bytes: Vec<u8> = header.iter().flat_map(|word: &u32| word.to_le_bytes()).collect();
    bytes.extend(encode_texels(file, precision));
    bytes.extend(key_values);
    bytes
}
