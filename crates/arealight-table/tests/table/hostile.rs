//! Files that are well-formed images and no tables, or not even images.

use arealight_table::{ReadError, read, write};
use exr::prelude::*;

use crate::draft::{Draft, table, table_of_two};

/// Drafts a good file, spoils it, and reads it.
fn spoil(change: impl FnOnce(&mut Draft)) -> ReadError {
    let mut draft = Draft::of(&table(3));
    change(&mut draft);
    read(&draft.write()).expect_err("the file is spoilt")
}

#[test]
fn the_draft_itself_is_good() {
    // Or else every refusal below would mean nothing
    assert_eq!(read(&Draft::of(&table(3)).write()).unwrap(), table(3));
}

#[test]
fn what_is_no_exr_is_refused() {
    for bytes in [&b""[..], b"v", b"not an image at all", &[0; 100]] {
        assert_eq!(read(bytes), Err(ReadError::UnknownFormat));
    }
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    let file = write(&table(3));
    for length in 4..file.len() {
        match read(&file[..length]) {
            Err(ReadError::Damaged { .. }) => {}
            other => panic!("cut to {length} of {}: {other:?}", file.len()),
        }
    }
}

#[test]
fn another_version_is_refused() {
    let error = spoil(|draft| draft.set("arealight.version", AttributeValue::I32(5)));
    assert_eq!(error.to_string(), "attribute `arealight.version` is `5`; this program reads `1 to 4`");
    let error = spoil(|draft| draft.set_text("arealight.version", "one"));
    assert_eq!(error.to_string(), "attribute `arealight.version` is `one`; this program reads `1 to 4`");
}

#[test]
fn other_meanings_of_texels_are_refused() {
    for attribute in ["arealight.format", "arealight.axes", "arealight.frame", "arealight.normalisation"] {
        match spoil(|draft| draft.set_text(attribute, "something else")) {
            ReadError::Attribute { attribute: named, found, .. } => {
                assert_eq!((named, found.as_str()), (attribute, "something else"));
            }
            other => panic!("{attribute}: {other:?}"),
        }
        let error = spoil(|draft| draft.set(attribute, AttributeValue::F32(1.0)));
        assert!(matches!(error, ReadError::Attribute { .. }), "{error:?}");
    }
}

#[test]
fn a_long_value_is_not_repeated_whole() {
    let error = spoil(|draft| draft.set_text("arealight.axes", &"é".repeat(10_000)));
    assert!(error.to_string().chars().count() < 500, "{error}");
}

#[test]
fn each_missing_attribute_is_named() {
    let names = Draft::of(&table(3)).attributes.into_iter().map(|(name, _)| name);
    for name in names {
        let file = Draft::of(&table(3)).without(name).write();
        assert_eq!(read(&file), Err(ReadError::MissingAttribute { attribute: name }));
    }
}

#[test]
fn missing_and_superfluous_layers_are_named() {
    assert_eq!(spoil(|d| d.layers[0].name = "matrices"), ReadError::MissingLayer { layer: "matrix" });
    assert_eq!(spoil(|d| d.layers.truncate(1)), ReadError::MissingLayer { layer: "magnitude" });
    let with = |names: &[&'static str]| {
        spoil(|draft| {
            for name in names {
                let mut layer = Draft::of(&table(3)).layers.remove(0);
                layer.name = name;
                draft.layers.push(layer);
            }
        })
    };
    assert_eq!(with(&["third"]), ReadError::MissingLayer { layer: "schlick_matrix" });
    assert_eq!(
        with(&["schlick_matrix", "fourth"]),
        ReadError::LayerCount { count: 4, expected: &[2, 3, 5, 6] }
    );
    assert_eq!(
        with(&["first_matrix", "fourth", "fifth"]),
        ReadError::MissingLayer { layer: "second_matrix" }
    );
    assert_eq!(
        with(&["first_matrix", "second_matrix", "fifth"]),
        ReadError::MissingLayer { layer: "second_shares" }
    );
}

#[test]
fn missing_renamed_and_superfluous_channels_are_named() {
    let found = |change: fn(&mut Draft)| match spoil(change) {
        ReadError::Channels { layer, found, .. } => format!("{layer}: {found}"),
        other => panic!("{other:?}"),
    };
    assert_eq!(found(|d| d.layers[1].channels.truncate(1)), "magnitude: R F32");
    assert_eq!(found(|d| d.layers[1].channels[1].0 = "X"), "magnitude: R F32, X F32");
    assert_eq!(
        found(|d| {
            let extra = ("Z", d.layers[0].channels[0].1.clone());
            d.layers[0].channels.push(extra);
        }),
        "matrix: A F32, B F32, G F32, R F32, Z F32"
    );
}

#[test]
fn another_pixel_type_is_refused() {
    let error = spoil(|draft| draft.layers[0].channels[3].1 = FlatSamples::U32(vec![1; 9]));
    assert_eq!(
        error.to_string(),
        "layer `matrix`: channels `A U32, B F32, G F32, R F32`; expected `R G B A, 32-bit float`, not \
        subsampled"
    );
    let halves = vec![f16::from_f32(0.5); 9];
    let error = spoil(|draft| draft.layers[1].channels[0].1 = FlatSamples::F16(halves));
    assert!(matches!(error, ReadError::Channels { layer: "magnitude", .. }), "{error:?}");
}

#[test]
fn sizes_that_are_not_square_or_differ_are_refused() {
    fn resize(draft: &mut Draft, layer: usize, size: (usize, usize)) {
        let layer = &mut draft.layers[layer];
        layer.size = size;
        for (_, samples) in &mut layer.channels {
            *samples = FlatSamples::F32(vec![0.5; size.0 * size.1]);
        }
    }
    for (layer, name, size) in
        [(0, "matrix", (3, 2)), (0, "matrix", (1, 1)), (0, "matrix", (1025, 1025)), (1, "magnitude", (4, 4))]
    {
        let error = spoil(|draft| resize(draft, layer, size));
        assert_eq!(error, ReadError::Size { layer: name, width: size.0, height: size.1 });
    }
}

#[test]
fn a_header_that_promises_more_than_memory_is_refused_at_once() {
    let file = write(&table(3));
    let window = b"dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0\x02\0\0\0\x02\0\0\0";
    let at = file.windows(window.len()).position(|w| w == window).expect("the window is in the file");
    for largest in [i32::MAX - 1, 1 << 24, 1 << 20] {
        let mut file = file.clone();
        for corner in [at + window.len() - 8, at + window.len() - 4] {
            file[corner..corner + 4].copy_from_slice(&largest.to_le_bytes());
        }
        match read(&file) {
            Err(ReadError::Size { .. } | ReadError::Damaged { part: "header", .. }) => {}
            other => panic!("{largest}: {other:?}"),
        }
    }
}

#[test]
fn storage_that_is_lossy_or_unusual_is_refused() {
    let storage = |change: fn(&mut Draft)| match spoil(change) {
        ReadError::Storage { layer, found } => format!("{layer}: {found}"),
        other => panic!("{other:?}"),
    };
    assert_eq!(storage(|d| d.compression = Compression::PXR24), "matrix: pxr24 compression");
    assert_eq!(storage(|d| d.blocks = Blocks::Tiles(Vec2(2, 2))), "matrix: tiles");
}

#[test]
fn texels_that_were_changed_are_refused() {
    for layer in 0..3 {
        let mut draft = Draft::of(&table_of_two(3));
        match &mut draft.layers[layer].channels[0].1 {
            FlatSamples::F32(samples) => samples[4] = f32::from_bits(samples[4].to_bits() + 1),
            other => panic!("{other:?}"),
        }
        let error = read(&draft.write()).unwrap_err();
        assert!(error.to_string().starts_with("attribute `arealight.hash` is `sha256:"), "{error}");
    }
    let error = spoil(|draft| draft.set_text("arealight.hash", "sha256:00"));
    assert!(matches!(error, ReadError::Hash { .. }), "{error}");
}

#[test]
fn texels_that_make_no_table_are_refused_with_their_place() {
    let spoil_texel = |layer: usize, channel: usize, value: f32| {
        spoil(|draft| match &mut draft.layers[layer].channels[channel].1 {
            FlatSamples::F32(samples) => samples[7] = value,
            other => panic!("{other:?}"),
        })
        .to_string()
    };
    assert_eq!(spoil_texel(0, 1, f32::NAN), "matrix: texel (1, 2) channel 1 is NaN, not a finite number");
    assert_eq!(
        spoil_texel(1, 1, f32::INFINITY),
        "magnitude: texel (1, 2) channel 1 is inf, not a finite number"
    );
    assert!(spoil_texel(0, 0, -1.0).starts_with("matrix: texel (1, 2) is singular or mirrored"));
    assert!(spoil_texel(1, 0, 1.5).starts_with("magnitude: texel (1, 2) is (1.5, "));
    let mut draft = Draft::of(&table_of_two(3));
    draft.layers[2].channels[0].1 = FlatSamples::F32(vec![-1.0; 9]);
    let error = read(&draft.write()).unwrap_err().to_string();
    assert!(error.starts_with("schlick matrix: texel (0, 0) is singular or mirrored"), "{error}");
}
