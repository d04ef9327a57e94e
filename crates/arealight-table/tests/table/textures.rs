//! KTX2 and DDS: to files and back, as independent readers see them, and spoilt.

use arealight::LightTable;
use arealight_table::{
    Format, Precision, ReadError, TableFile, Target, WriteError, hash, load, read, resampled, rounded,
};
use half::f16;

use crate::draft::{table, table_of_pairs, table_of_two};

const PRECISIONS: [Precision; 2] = [Precision::Half, Precision::Single];

pub fn write(table: &LightTable, target: Target) -> Vec<u8> {
    TableFile { table: table.clone(), fit_error: Some("none".into()) }.write(target).unwrap()
}

pub fn targets() -> impl Iterator<Item = Target> {
    PRECISIONS.into_iter().flat_map(|precision| [Target::Ktx2(precision), Target::Dds(precision)])
}

/// A file with a word replaced.
fn with_word(file: &[u8], at: usize, word: u32) -> Vec<u8> {
    let mut file = file.to_vec();
    file[at..at + 4].copy_from_slice(&word.to_le_bytes());
    file
}

fn refusal(file: &[u8]) -> String {
    read(file).expect_err("the file is spoilt").to_string()
}

#[test]
fn a_table_comes_back_rounded_to_the_precision_and_no_further() {
    for target in targets() {
        for table in [table(2), table(7), table_of_two(16), table_of_pairs(5), LightTable::ggx()] {
            let file = TableFile::read(&write(&table, target)).unwrap();
            assert_eq!(file.table, rounded(&table, target.precision()).unwrap(), "{target:?}");
            assert_eq!(file.fit_error.as_deref(), Some("none"));
        }
        // Or else the above would show little
        assert_eq!(
            read(&write(&LightTable::ggx(), target)).unwrap() == LightTable::ggx(),
            target.precision() == Precision::Single
        );
    }
}

#[test]
fn half_floats_err_by_their_last_bit_at_most() {
    let (table, half) = (LightTable::ggx(), rounded(&LightTable::ggx(), Precision::Half).unwrap());
    for (a, b) in table.texels().as_flattened().iter().zip(half.texels().as_flattened()) {
        // Half a unit of 11 bits; below 6e-5, of a subnormal number
        assert!((a - b).abs() <= a.abs() / 2048.0 + 3e-8, "{a} {b}");
    }
}

#[test]
fn what_the_gpu_reads_says_if_a_dip_was_added() {
    for (table, dip) in [(table_of_two(4), 0.0), (resampled(&LightTable::ggx(), 4).unwrap(), 1.0)] {
        assert!(table.texels()[16..32].iter().all(|texel| texel[2] == dip), "{dip}");
        let header = String::from_utf8(write(&table, Target::CHeader(Precision::Half))).unwrap();
        assert!(header.contains(&format!("The dip is {dip}")), "{header}");
    }
}

#[test]
fn a_number_too_large_for_half_floats_is_refused_with_its_place() {
    let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 4];
    matrix[3][2] = 7e4;
    let table = LightTable::new(table(2).description().clone(), 2, matrix, vec![[1.0, 0.0]; 4]).unwrap();
    let file = TableFile { table, fit_error: None };
    let error = file.write(Target::Ktx2(Precision::Half)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "in 16-bit floats, matrix: texel (1, 1) channel 2 is inf, not a finite number; write 32-bit ones"
    );
    assert_eq!(read(&file.write(Target::Ktx2(Precision::Single)).unwrap()).unwrap(), file.table);
}

#[test]
fn attributes_that_could_not_be_read_back_are_not_written() {
    let file = TableFile { table: table(2), fit_error: Some("x".repeat(100_000)) };
    assert!(matches!(file.write(Target::Dds(Precision::Half)), Err(WriteError::Attributes { .. })));
}

#[test]
fn formats_are_told_by_content_not_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.exr");
    for target in targets() {
        std::fs::write(&path, write(&table(4), target)).unwrap();
        assert_eq!(load(&path).unwrap(), rounded(&table(4), target.precision()).unwrap());
    }
}

#[test]
fn an_extension_chooses_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = TableFile { table: table(4), fit_error: None };
    for (name, format) in [
        ("a.exr", Some(Format::Exr)),
        ("a.KTX2", Some(Format::Ktx2)),
        ("a.dds", Some(Format::Dds)),
        ("a.h", None),
    ] {
        let path = folder.path().join(name);
        file.save(&path, None).unwrap();
        assert_eq!(Format::detect(&std::fs::read(&path).unwrap()), format);
    }
    let refused = |name: &str, precision| {
        let error = file.save(&folder.path().join(name), precision).unwrap_err().to_string();
        assert!(!folder.path().join(name).exists());
        error
    };
    let expected = "extension `png`: tables are written as .exr, .ktx2, .dds, .h (C) or .f32 (raw)";
    assert_eq!(refused("b.png", None), expected);
    assert_eq!(refused("b.exr", Some(Precision::Half)), "OpenEXR tables are written in 32-bit floats only");
}

#[test]
fn the_ktx2_crate_reads_what_is_written() {
    for precision in PRECISIONS {
        let table = table_of_two(8);
        let bytes = write(&table, Target::Ktx2(precision));
        let reader = ktx2::Reader::new(&bytes).unwrap();
        let header = reader.header();
        assert_eq!((header.pixel_width, header.pixel_height, header.layer_count), (8, 8, 6));
        let basic = reader.basic_dfd().expect("there is a basic descriptor");
        assert_eq!(basic.transfer_function, Some(ktx2::TransferFunction::Linear));
        assert_eq!(basic.sample_information.len(), 4);
        let values: Vec<(&str, &[u8])> = reader.key_value_data().collect();
        assert!(values.is_sorted_by_key(|(key, _)| *key), "{values:?}");
        let expected = format!("{}\0", hash(&rounded(&table, precision).unwrap()));
        assert!(values.contains(&("arealight.hash", expected.as_bytes())), "{values:?}");
        let level = reader.levels().next().unwrap();
        assert_eq!(level.data.len(), 8 * 8 * 6 * precision.texel_bytes());
        // Texels lie at a multiple of their size
        let start = level.data.as_ptr() as usize - bytes.as_ptr() as usize;
        assert_eq!(start % precision.texel_bytes(), 0);
    }
}

#[test]
fn the_ddsfile_crate_reads_what_is_written() {
    for (precision, format) in [
        (Precision::Half, ddsfile::DxgiFormat::R16G16B16A16_Float),
        (Precision::Single, ddsfile::DxgiFormat::R32G32B32A32_Float),
    ] {
        let table = table_of_two(8);
        let bytes = write(&table, Target::Dds(precision));
        let dds = ddsfile::Dds::read(&bytes[..]).unwrap();
        assert_eq!((dds.get_width(), dds.get_height(), dds.get_num_array_layers()), (8, 8, 6));
        assert_eq!(dds.get_dxgi_format(), Some(format));
        // Its second layer is the magnitude
        let layer = dds.get_data(1).unwrap();
        let albedo = table.magnitude()[0][0];
        let first = match precision {
            Precision::Half => f16::from_le_bytes([layer[0], layer[1]]).to_f32(),
            Precision::Single => f32::from_le_bytes([layer[0], layer[1], layer[2], layer[3]]),
        };
        assert_eq!(first, if precision == Precision::Half { f16::from_f32(albedo).to_f32() } else { albedo });
    }
}

#[test]
fn a_file_cut_short_anywhere_or_longer_is_refused() {
    for target in targets() {
        let file = write(&table_of_two(3), target);
        for length in 12..file.len() {
            assert!(read(&file[..length]).is_err(), "{target:?} cut to {length} of {}", file.len());
        }
        // KTX2 says where everything is; what follows is nobody's
        let longer = read(&[&file[..], &[0]].concat());
        assert_eq!(longer.is_err(), matches!(target, Target::Dds(_)), "{target:?}: {longer:?}");
    }
}

#[test]
fn fields_of_ktx2_that_no_table_has_are_named() {
    let file = write(&table(3), Target::Ktx2(Precision::Half));
    assert!(read(&with_word(&file, 12, 97)).is_ok(), "the word is where the test believes it");
    for (at, word, expected) in [
        (12, 37, "KTX2 header: `vkFormat` is 37; expected 97 (RGBA, half float) or 109 (RGBA, float)"),
        (20, 4, "layer `image`: 4 x 3 texels; tables are square, 2 to 1024 a side, all layers alike"),
        (28, 7, "KTX2 header: `pixelDepth` is 7; expected 0"),
        (32, u32::MAX, "KTX2 header: `layerCount` is 4294967295; expected at most 6"),
        (36, 6, "KTX2 header: `faceCount` is 6; expected 1"),
        (40, 2, "KTX2 header: `levelCount` is 2; expected at most 1"),
        (44, 2, "KTX2 header: `supercompressionScheme` is 2; expected 0 (none)"),
        (60, 70_000, "KTX2 header: `kvdByteLength` is 70000; expected at most 65536"),
    ] {
        assert_eq!(refusal(&with_word(&file, at, word)), expected);
    }
    for (at, word, expected) in [
        (12, 109, "level 0: damaged or unsupported KTX2 data: 864 bytes"),
        (80, u32::MAX, "level 0: damaged or unsupported KTX2 data: "),
        (84, u32::MAX, "level 0: damaged or unsupported KTX2 data: "),
        (56, u32::MAX, "key/value data: damaged or unsupported KTX2"),
    ] {
        assert!(refusal(&with_word(&file, at, word)).starts_with(expected), "{at}");
    }
}

#[test]
fn fields_of_dds_that_no_table_has_are_named() {
    let file = write(&table(3), Target::Dds(Precision::Half));
    assert!(read(&with_word(&file, 128, 10)).is_ok(), "the word is where the test believes it");
    for (at, word, expected) in [
        (4, 100, "DDS header: `dwSize` is 100; expected 124"),
        (
            12,
            u32::MAX,
            "layer `image`: 3 x 4294967295 texels; tables are square, 2 to 1024 a side, all layers alike",
        ),
        (24, 3, "DDS header: `dwDepth` is 3; expected at most 1"),
        (28, 2, "DDS header: `dwMipMapCount` is 2; expected at most 1"),
        (36, 70_000, "DDS header: `dwReserved1[1]` is 70000; expected at most 65536"),
        (76, 0, "DDS header: `ddspf.dwSize` is 0; expected 32"),
        (80, 0x41, "DDS header: `ddspf.dwFlags` is 65; expected 4 (a four-character code)"),
        (
            84,
            36,
            "DDS header: `ddspf.dwFourCC` is 36; expected 113 (RGBA, half float), 116 (RGBA, float) or DX10",
        ),
        (112, 0xfe00, "DDS header: `dwCaps2` is 65024; expected 0 (neither cube map nor volume)"),
        (128, 28, "DDS header: `dxgiFormat` is 28; expected 10 (RGBA, half float) or 2 (RGBA, float)"),
        (132, 4, "DDS header: `resourceDimension` is 4; expected 3 (two dimensions)"),
        (136, 4, "DDS header: `miscFlag` is 4; expected 0 (no cube map)"),
        (140, 0, "DDS header: `arraySize` is 0; expected 1 to 6"),
    ] {
        assert_eq!(refusal(&with_word(&file, at, word)), expected);
    }
    assert!(refusal(&with_word(&file, 128, 2)).starts_with("texels: damaged or unsupported DDS data: "));
    // Without our mark, the attributes are surplus
    assert!(
        refusal(&with_word(&file, 32, 0)).starts_with("texels: damaged or unsupported DDS data: 432 bytes")
    );
}

#[test]
fn attributes_are_checked_as_those_of_exr() {
    for target in targets() {
        let spoil = |from: &str, to: &str| {
            let mut file = write(&table_of_two(3), target);
            let at = file.windows(from.len()).position(|bytes| bytes == from.as_bytes()).expect(from);
            file[at..at + to.len()].copy_from_slice(to.as_bytes());
            read(&file).unwrap_err()
        };
        for name in [
            "arealight.format",
            "arealight.version",
            "arealight.axes",
            "arealight.frame",
            "arealight.normalisation",
            "arealight.brdf",
            "arealight.made_by",
            "arealight.grazing_dip",
            "arealight.hash",
            "arealight.matrices",
        ] {
            let missing = spoil(name, "A");
            assert_eq!(missing, ReadError::MissingAttribute { attribute: name });
        }
        for (name, from, to, expected) in [
            ("version", "4", "3", "`3`; this program reads `4`"),
            ("matrices", "2", "5", "`5`; this program reads `1 to 4`"),
            ("grazing_dip", "none", "nine", "`nine`; this program reads `none or ggx`"),
            ("brdf", "a ", "a\0", "`a\\0test`; this program reads `a string`"),
        ] {
            let of = |value: &str| format!("arealight.{name}\0{value}");
            let expected = format!("attribute `arealight.{name}` is {expected}");
            assert_eq!(spoil(&of(from), &of(to)).to_string(), expected);
        }
        // One matrix is another table
        assert!(matches!(
            spoil("arealight.matrices\x002", "arealight.matrices\x001"),
            ReadError::Hash { .. }
        ));
    }
}

#[test]
fn texels_that_were_changed_are_refused() {
    for target in targets() {
        let file = write(&table_of_pairs(3), target);
        let layer_bytes = 9 * target.precision().texel_bytes();
        let start = match target {
            Target::Ktx2(_) => file.len() - 6 * layer_bytes,
            _ => 148,
        };
        for layer in 0..6 {
            // The lowest bit of a number: the first of the middle texel
            let mut spoilt = file.clone();
            spoilt[start + layer * layer_bytes + layer_bytes / 9 * 4] ^= 1;
            assert!(matches!(read(&spoilt), Err(ReadError::Hash { .. })), "{target:?} layer {layer}");
        }
    }
}

#[test]
fn an_image_without_attributes_is_no_table() {
    let mut file = write(&table(3), Target::Dds(Precision::Single));
    file.truncate(148 + 9 * 6 * 16);
    let message = refusal(&with_word(&file, 32, 0));
    assert!(message.starts_with("attribute `arealight.format` is missing"), "{message}");
    assert!(message.contains("convert them by `arealight table convert`"), "{message}");
}
