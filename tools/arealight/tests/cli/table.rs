//! `arealight table` as a user meets it.

use crate::common::{self, printed, run};
use arealight_table::{Format, Precision, TableFile, resampled, rounded};
use std::path::Path;

/// Runs `table convert` with what must succeed, and returns what it prints.
fn convert(folder: &Path, arguments: &[&str]) -> String {
    printed(&run(folder, &[&["table", "convert"], arguments].concat()))
}

/// Runs `table convert` with what must fail with `code` and say `words`.
fn refuse(folder: &Path, arguments: &[&str], code: i32, words: &str) {
    common::refuse(folder, &[&["table", "convert"], arguments].concat(), code, &[words]);
}

#[test]
fn a_table_goes_through_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let said = convert(folder, &["built-in", "a.ktx2"]);
    assert!(
        said.starts_with("wrote a.ktx2: 64 x 64 nodes, two matrices and pairs of lobes, 16-bit floats, 198"),
        "{said}"
    );
    convert(folder, &["a.ktx2", "b.dds", "--format", "f32"]);
    convert(folder, &["b.dds", "c.exr"]);
    // Nothing is lost but what 16 bits lose
    let file = TableFile::load(&folder.join("c.exr")).unwrap();
    assert_eq!(file.table, rounded(&arealight::LightTable::ggx(), Precision::Half).unwrap());
    assert_eq!(file.fit_error, arealight_table::ggx_file().fit_error);
    for (name, format) in [("a.ktx2", Format::Ktx2), ("b.dds", Format::Dds), ("c.exr", Format::Exr)] {
        assert_eq!(Format::detect(&std::fs::read(folder.join(name)).unwrap()), Some(format));
    }
}

#[test]
fn sources_and_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    convert(folder, &["built-in", "t.h", "--size", "8"]);
    assert!(
        std::fs::read_to_string(folder.join("t.h")).unwrap().contains("#define AREALIGHT_TABLE_SIZE 8\n")
    );
    convert(folder, &["built-in", "t.dds", "--size", "22"]);
    let file = TableFile::load(&folder.join("t.dds")).unwrap();
    assert_eq!(
        file.table,
        rounded(&resampled(&arealight::LightTable::ggx(), 22).unwrap(), Precision::Half).unwrap()
    );
    // What was measured is another table
    assert_eq!(file.fit_error, None);
}

#[test]
fn a_table_is_measured_as_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let said = convert(folder.path(), &["built-in", "a.exr", "--measure", "--json"]);
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!((&said["size"], &said["matrices"], &said["bits"]), (&64.into(), &2.into(), &32.into()));
    assert_eq!(said["fit_error"], arealight_table::ggx_file().fit_error.unwrap());
    let said = convert(folder.path(), &["built-in", "a.dds", "--json"]);
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let written = arealight_table::load(&folder.path().join("a.dds")).unwrap();
    assert_eq!(said["hash"], arealight_table::hash(&written));
}

/// An image of 2 x 2 texels of four floats, as the authors of the convention write it.
fn dds(texels: [[f32; 4]; 4]) -> Vec<u8> {
    let mut header = vec![0x2053_4444, 124, 0x100f, 2, 2, 32, 1, 1];
    header.extend([0; 11]);
    header.extend([32, 4, 116, 0, 0, 0, 0, 0, 0x1000, 0, 0, 0, 0]);
    let texels = texels.as_flattened().iter().flat_map(|number| number.to_le_bytes());
    header.iter().flat_map(|word: &u32| word.to_le_bytes()).chain(texels).collect()
}

#[test]
fn two_images_of_the_published_convention_become_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("ltc_1.dds"), dds([[1.0, 0.0, 0.0, 1.0]; 4])).unwrap();
    std::fs::write(folder.join("ltc_2.dds"), dds([[1.002, 0.1, 0.0, 0.0]; 4])).unwrap();
    let both = ["ltc_1.dds", "t.exr", "--magnitude", "ltc_2.dds", "--brdf", "a test"];
    let said = convert(folder, &both);
    assert!(said.starts_with("wrote t.exr: 2 x 2 nodes, one matrix, 32-bit floats"), "{said}");
    assert!(said.contains("magnitude of texel (1, 0): [1.002, 0.1] became [1.0, 0.1]"), "{said}");
    let table = arealight_table::load(&folder.join("t.exr")).unwrap();
    assert_eq!((table.size(), table.description().brdf.as_str()), (2, "a test"));
    // One of the images is no table, and what cannot be measured is not
    refuse(folder, &["ltc_1.dds", "t.exr"], 3, "arealight table convert");
    refuse(folder, &[&both[..], &["--measure"]].concat(), 2, "the table is of `a test`");
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    refuse(folder, &["built-in", "t.png"], 2, "extension `png`: tables are written as .exr, .ktx2, .dds");
    refuse(folder, &["built-in", "t.exr", "--format", "f16"], 2, "OpenEXR tables are written in 32-bit");
    refuse(folder, &["built-in", "t.exr", "--size", "1"], 2, "--size");
    refuse(folder, &["missing.exr", "t.exr"], 3, "missing.exr");
    std::fs::write(folder.join("noise.ktx2"), "noise").unwrap();
    refuse(folder, &["noise.ktx2", "t.exr"], 3, "neither OpenEXR nor KTX2 nor DDS");
    refuse(folder, &["built-in", "nowhere/t.exr"], 5, "nowhere/t.exr");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), 1);
}
