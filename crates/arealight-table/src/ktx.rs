//! Tables as KTX2 textures.
//!
//! The `ktx2` crate's own reader of whole files is passed by: its version 0.5.0 panics on some data format
//! descriptors (a block dimension of 256, a block of 12 bytes). The format of the texels is in the header as
//! well.

use arealight::table::LAYERS;
use ktx2::dfd::{Basic, Block};
use ktx2::{Header, Index, LevelIndex};

use crate::texture::{
    MAX_KEY_VALUE_BYTES, Texture, byte_length, check_size, encode_key_values, encode_texels, field, length,
};
use crate::{Format, Precision, ReadError, TableFile};

const FORMAT: Format = Format::Ktx2;

/// The image in a file.
pub fn read(file: &[u8]) -> Result<Texture<'_>, ReadError> {
    // Check the header
    let header = file
        .first_chunk::<{ Header::LENGTH }>()
        .ok_or_else(|| length(FORMAT, "header", Header::LENGTH as u64, file.len() as u64))?;
    let raw_format = u32::from_le_bytes([header[12], header[13], header[14], header[15]]);
    let raw_scheme = u32::from_le_bytes([header[44], header[45], header[46], header[47]]);
    let header = Header::from_bytes(header).map_err(|error| damaged("header", &error))?;
    let precision = match header.format {
        Some(ktx2::Format::R16G16B16A16_SFLOAT) => Precision::Half,
        Some(ktx2::Format::R32G32B32A32_SFLOAT) => Precision::Single,
        _ => return Err(field(FORMAT, "vkFormat", raw_format, "97 (RGBA, half float) or 109 (RGBA, float)")),
    };
    let size = check_size(header.pixel_width, header.pixel_height)?;
    for (name, found, is_expected, expected) in [
        ("pixelDepth", header.pixel_depth, header.pixel_depth == 0, "0"),
        ("layerCount", header.layer_count, header.layer_count <= LAYERS, "at most 6"),
        ("faceCount", header.face_count, header.face_count == 1, "1"),
        ("levelCount", header.level_count, header.level_count <= 1, "at most 1"),
        ("supercompressionScheme", raw_scheme, raw_scheme == 0, "0 (none)"),
    ] {
        if !is_expected {
            return Err(field(FORMAT, name, found, expected));
        }
    }
    let layers = header.layer_count.max(1);

    // Find the texels
    let level = file.get(Header::LENGTH..).and_then(|rest| rest.first_chunk::<{ LevelIndex::LENGTH }>());
    let level = level.ok_or_else(|| {
        length(FORMAT, "level index", (Header::LENGTH + LevelIndex::LENGTH) as u64, file.len() as u64)
    })?;
    let level = LevelIndex::from_bytes(level);
    let needed = byte_length(size, layers, precision);
    if level.byte_length != needed {
        return Err(length(FORMAT, "level 0", needed, level.byte_length));
    }
    let texels = section(file, "level 0", level.byte_offset, level.byte_length)?;

    // Find the attributes
    let Index { kvd_byte_offset, kvd_byte_length, .. } = header.index;
    if kvd_byte_length as usize > MAX_KEY_VALUE_BYTES {
        return Err(field(FORMAT, "kvdByteLength", kvd_byte_length, "at most 65536"));
    }
    let key_values = section(file, "key/value data", u64::from(kvd_byte_offset), u64::from(kvd_byte_length))?;
    Ok(Texture { precision, size, layers, texels, key_values })
}

fn damaged(part: &'static str, error: &ktx2::ParseError) -> ReadError {
    ReadError::Damaged { format: FORMAT, part, reason: error.to_string() }
}

fn section<'a>(
    file: &'a [u8],
    part: &'static str,
    offset: u64,
    byte_length: u64,
) -> Result<&'a [u8], ReadError> {
    let end = offset.saturating_add(byte_length);
    // The end is in the file, so that both fit a pointer
    let inside = end <= file.len() as u64;
    inside
        .then(|| &file[offset as usize..end as usize])
        .ok_or_else(|| length(FORMAT, part, end, file.len() as u64))
}

/// The file of a table whose numbers fit the precision.
pub fn write(file: &TableFile, precision: Precision) -> Vec<u8> {
    let format = match precision {
        Precision::Half => ktx2::Format::R16G16B16A16_SFLOAT,
        Precision::Single => ktx2::Format::R32G32B32A32_SFLOAT,
    };
    let (descriptor, type_size) =
        Basic::from_format(format).expect("the formats of four floats have descriptors");
    let descriptor = Block::Basic(descriptor).to_vec();
    let writer = concat!("arealight-table ", env!("CARGO_PKG_VERSION"));
    let key_values = encode_key_values(file, &[("KTXorientation", "rd"), ("KTXwriter", writer)]);
    let texels = encode_texels(file, precision);

    // Lay out header, level index, descriptor, attributes, texels, these at a multiple of a texel's bytes
    let descriptor_start = Header::LENGTH + LevelIndex::LENGTH;
    let key_values_start = descriptor_start + 4 + descriptor.len();
    let texels_start = (key_values_start + key_values.len()).next_multiple_of(precision.texel_bytes());
    let header = Header {
        format: Some(format),
        type_size,
        pixel_width: file.table.size(),
        pixel_height: file.table.size(),
        pixel_depth: 0,
        layer_count: LAYERS,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: descriptor_start as u32,
            dfd_byte_length: 4 + descriptor.len() as u32,
            kvd_byte_offset: key_values_start as u32,
            kvd_byte_length: key_values.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let level = LevelIndex {
        byte_offset: texels_start as u64,
        byte_length: texels.len() as u64,
        uncompressed_byte_length: texels.len() as u64,
    };
    let mut bytes = [&header.as_bytes()[..], &level.as_bytes()].concat();
    bytes.extend_from_slice(&(4 + descriptor.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&descriptor);
    bytes.extend_from_slice(&key_values);
    bytes.resize(texels_start, 0);
    bytes.extend_from_slice(&texels);
    bytes
}
