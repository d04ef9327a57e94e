//! Tables to files and back.

use arealight::{LightTable, TableDescription};
use arealight_table::{FileError, ReadError, TableFile, Target, hash, load, read, save, write};
use exr::prelude::{AttributeValue, Compression};

use crate::draft::{Draft, table, table_of_pairs, table_of_two};

#[test]
fn a_table_comes_back_bit_for_bit() {
    for size in [2, 3, 17, 64] {
        let table = table(size);
        assert_eq!(read(&write(&table)).unwrap(), table, "size {size}");
        for table in [table_of_two(size), table_of_pairs(size)] {
            assert_eq!(read(&write(&table)).unwrap(), table, "size {size}, more matrices");
        }
    }
}

#[test]
fn the_fit_error_comes_back() {
    let fit_error = Some("a mean of 1e-3".to_owned());
    let file = TableFile { table: table(3), fit_error };
    assert_eq!(TableFile::read(&file.write(Target::Exr).unwrap()).unwrap(), file);
    assert_eq!(TableFile::read(&write(&table(3))).unwrap().fit_error, None);
}

#[test]
fn a_file_of_version_1_has_two_layers_and_no_hash() {
    let mut draft = Draft::of(&table(3)).without("arealight.hash").without("arealight.grazing_dip");
    draft.set("arealight.version", AttributeValue::I32(1));
    assert_eq!(read(&draft.write()).unwrap(), table(3));
    let mut draft = Draft::of(&table_of_two(3));
    draft.set("arealight.version", AttributeValue::I32(1));
    assert_eq!(read(&draft.write()), Err(ReadError::LayerCount { count: 3, expected: &[2] }));
}

#[test]
fn a_file_of_version_2_has_no_grazing_dip() {
    let mut draft = Draft::of(&table_of_two(3)).without("arealight.grazing_dip");
    draft.set("arealight.version", AttributeValue::I32(2));
    assert_eq!(read(&draft.write()).unwrap(), table_of_two(3));
    // Nor is one believed that it cannot have
    let mut draft = Draft::of(&table_of_two(3));
    draft.set("arealight.version", AttributeValue::I32(2));
    draft.set_text("arealight.grazing_dip", "ggx");
    assert_eq!(read(&draft.write()).unwrap(), table_of_two(3));
}

#[test]
fn a_grazing_dip_comes_back_and_counts_in_the_hash() {
    let dipped = LightTable::ggx();
    assert!(dipped.description().ggx_dip);
    assert_eq!(read(&write(&dipped)).unwrap(), dipped);
    // The same texels are another table without it
    let mut draft = Draft::of(&dipped);
    draft.set_text("arealight.grazing_dip", "none");
    assert!(read(&draft.write()).is_err());
    let with = |ggx_dip| {
        let description = TableDescription { ggx_dip, ..TableDescription::default() };
        LightTable::new(description, 2, vec![[1.0, 0.0, 0.0, 1.0]; 4], vec![[0.9, -0.7]; 4])
    };
    assert!(with(false).is_err() && with(true).is_err());
}

#[test]
fn a_hash_is_of_texels_alone() {
    let described = |brdf: &str| {
        let description = TableDescription { brdf: brdf.into(), ..TableDescription::default() };
        LightTable::new(description, 2, vec![[1.0, 0.0, 0.0, 1.0]; 4], vec![[1.0, 0.0]; 4]).unwrap()
    };
    assert_eq!(hash(&described("a")), hash(&described("b")));
    // By Python's hashlib, so that others can compute it: sha256(pack("<II16f8f", 2, 1, *(1, 0, 0, 1) * 4,
    // *(1, 0) * 4))
    let expected = "sha256:56377ea8af2ee463758acb31e839469047ad5496eecf89d896a372ae07816581";
    assert_eq!(hash(&described("a")), expected);
    let two = described("a").with_schlick_matrix(vec![[1.0, 0.0, 0.0, 1.0]; 4]).unwrap();
    assert_ne!(hash(&two), expected);
}

#[test]
fn equal_tables_make_equal_files() {
    // The attributes lie in hash maps of random order: a few tries would show it
    let table = table(4);
    let first = write(&table);
    assert!((0..20).all(|_| write(&table) == first));
}

#[test]
fn a_different_table_makes_a_different_file() {
    assert_ne!(write(&table(4)), write(&table(5)));
}

#[test]
fn characters_that_exr_lacks_are_replaced() {
    let description = TableDescription { brdf: "α".into(), ..TableDescription::default() };
    let table = LightTable::new(description, 2, vec![[1.0, 0.0, 0.0, 1.0]; 4], vec![[1.0, 0.0]; 4]).unwrap();
    assert_eq!(read(&write(&table)).unwrap().description().brdf, "?");
}

#[test]
fn files_are_saved_and_loaded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.exr");
    save(&table(8), &path).unwrap();
    assert_eq!(load(&path).unwrap(), table(8));
    assert!(matches!(load(&folder.path().join("none.exr")), Err(FileError::File(_))));
    std::fs::write(&path, "GIF89a").unwrap();
    assert!(matches!(load(&path), Err(FileError::Read(ReadError::UnknownFormat))));
}

#[test]
fn a_file_larger_than_any_table_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.exr");
    // A sparse file: it takes no space
    std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
    assert!(matches!(load(&path), Err(FileError::TooLarge)));
}

#[test]
fn an_uncompressed_file_reads_alike() {
    let table = table(5);
    let mut draft = Draft::of(&table);
    draft.compression = Compression::Uncompressed;
    assert_eq!(read(&draft.write()).unwrap(), table);
}

#[test]
fn layers_may_come_in_any_order_and_with_attributes_of_their_own() {
    for table in [table(5), table_of_two(5), table_of_pairs(5)] {
        let mut draft = Draft::of(&table);
        draft.layers.reverse();
        assert_eq!(read(&draft.write()).unwrap(), table);
    }
}
