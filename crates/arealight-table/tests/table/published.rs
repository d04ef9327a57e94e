//! The convention of Heitz et al. 2016, by images that are made here from our table.

use arealight::table::inverse_from_texel;
use arealight::{LightTable, TableDescription};
use arealight_table::{Adjusted, PublishedError, ReadError, read_published, resampled};
use exr::prelude::*;
use glam::DMat3;

const SIZE: u32 = 8;

/// How the images of the convention are stored.
#[derive(Clone, Copy, Debug)]
enum Storage {
    Dds16,
    Dds32,
    Exr16,
    Exr32,
}

/// The lobes of our table with other albedos, which their images hold as they are, of 8 nodes a side.
fn table() -> LightTable {
    let table = resampled(&LightTable::ggx(), SIZE).unwrap();
    let magnitude = (0..SIZE * SIZE).map(|i| [1.0 - 0.005 * i as f32, 0.005 * i as f32]).collect();
    LightTable::new(TableDescription::default(), SIZE, table.matrix().to_vec(), magnitude)
        .and_then(|plain| plain.with_schlick_matrix(table.schlick_matrix().unwrap().to_vec()))
        .unwrap()
}

/// M⁻¹ of node (x, y) in the surface frame, at the alpha that the convention has there.
fn inverse(table: &LightTable, x: u32, y: u32) -> DMat3 {
    let (roughness, cos_view) = LightTable::node(SIZE, x, y);
    let texel = table.matrix()[(y * SIZE + x) as usize].map(f64::from);
    inverse_from_texel(texel, (roughness * roughness).max(1e-5), cos_view)
}

/// The texels of the two images.
fn published(table: &LightTable) -> [Vec<[f32; 4]>; 2] {
    let nodes = (0..SIZE * SIZE).map(|i| (i % SIZE, i / SIZE));
    let matrix = nodes.map(|(x, y)| {
        let m = inverse(table, x, y);
        [m.x_axis.x, m.x_axis.z, m.z_axis.x, m.z_axis.z].map(|entry| entry as f32)
    });
    let magnitude = table.magnitude().iter().map(|&[albedo, schlick]| [albedo, schlick, 0.0, 0.5]);
    [matrix.collect(), magnitude.collect()]
}

/// A file as other programs make it.
fn store(texels: &[[f32; 4]], storage: Storage) -> Vec<u8> {
    let size = texels.len().isqrt();
    let halves = |c: usize| texels.iter().map(move |texel| f16::from_f32(texel[c])).collect::<Vec<_>>();
    match storage {
        // The authors' header: Direct3D 9, a depth and one mip map
        Storage::Dds16 | Storage::Dds32 => {
            let (code, bytes) = if matches!(storage, Storage::Dds16) { (113, 8) } else { (116, 16) };
            let side = size as u32;
            let mut header = vec![0x2053_4444, 124, 0x100f, side, side, side * bytes, 1, 1];
            header.extend([0; 11]);
            header.extend([32, 4, code, 0, 0, 0, 0, 0, 0x1000, 0, 0, 0, 0]);
            let mut file: Vec<u8> = header.iter().flat_map(|word: &u32| word.to_le_bytes()).collect();
            for number in texels.as_flattened() {
                match storage {
                    Storage::Dds16 => file.extend(f16::from_f32(*number).to_le_bytes()),
                    _ => file.extend(number.to_le_bytes()),
                }
            }
            file
        }
        Storage::Exr16 | Storage::Exr32 => {
            let channels = ["R", "G", "B", "A"].into_iter().enumerate().map(|(c, name)| {
                let samples = match storage {
                    Storage::Exr16 => FlatSamples::F16(halves(c)),
                    _ => FlatSamples::F32(texels.iter().map(|texel| texel[c]).collect()),
                };
                AnyChannel::new(name, samples)
            });
            let channels = AnyChannels::sort(channels.collect());
            let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::UNCOMPRESSED };
            let layer = Layer::new((size, size), LayerAttributes::default(), encoding, channels);
            let mut bytes = Vec::new();
            Image::from_layer(layer).write().to_buffered(std::io::Cursor::new(&mut bytes)).unwrap();
            bytes
        }
    }
}

fn half_texel(texel: [f32; 4]) -> [f32; 4] {
    texel.map(|number| f16::from_f32(number).to_f32())
}

#[test]
fn the_lobes_at_the_nodes_are_those_of_the_images() {
    let [matrix, magnitude] = published(&table());
    for (storage, tolerance) in [
        // Rounding of the images' numbers to 24 and to 11 bits, relative to entries of order 1
        (Storage::Dds32, 1e-6),
        (Storage::Exr32, 1e-6),
        (Storage::Dds16, 1e-3),
        (Storage::Exr16, 1e-3),
    ] {
        let read = read_published(&store(&matrix, storage), &store(&magnitude, storage), "ggx").unwrap();
        assert_eq!(read.table.size(), SIZE);
        // At the horizon and alpha = 1e-5, entries vanish in 16 bits
        let half = matches!(storage, Storage::Dds16 | Storage::Exr16);
        let vanished = [Adjusted::Matrix { y: 7, found: half_texel(matrix[56]) }];
        assert_eq!(read.adjusted, if half { &vanished[..] } else { &[] }, "{storage:?}");
        assert_eq!(read.table.description().brdf, "ggx");
        assert_eq!(read.table.schlick_matrix(), None);
        for (x, y) in (0..SIZE * SIZE).map(|i| (i % SIZE, i / SIZE)) {
            let i = (y * SIZE + x) as usize;
            if half && (x, y) == (0, 7) {
                assert_eq!(read.table.matrix()[i], read.table.matrix()[i + 1]);
                continue;
            }
            let (ours, theirs) = (inverse(&read.table, x, y), inverse(&table(), x, y));
            assert!(ours.abs_diff_eq(theirs, tolerance), "{storage:?} ({x}, {y}): {ours} {theirs}");
            for (a, b) in read.table.magnitude()[i].iter().zip(&table().magnitude()[i]) {
                assert!(f64::from(a - b).abs() <= tolerance, "{storage:?} ({x}, {y}): {a} {b}");
            }
        }
    }
}

#[test]
fn a_lookup_finds_what_the_images_say() {
    // By the whole way to shading, not by the texels
    let [matrix, magnitude] = published(&table());
    let read =
        read_published(&store(&matrix, Storage::Dds32), &store(&magnitude, Storage::Exr32), "").unwrap();
    for (x, y) in [(1, 0), (3, 5), (7, 7), (7, 2)] {
        let (roughness, cos_view) = LightTable::node(SIZE, x, y);
        let sample = read.table.lookup(roughness, cos_view);
        let [m00, m20, m02, m22] = matrix[(y * SIZE + x) as usize].map(f64::from);
        let expected = DMat3::from_cols_array_2d(&[[m00, 0.0, m20], [0.0, 1.0, 0.0], [m02, 0.0, m22]]);
        assert!(sample.inverse.abs_diff_eq(expected, 1e-6), "({x}, {y}): {} {expected}", sample.inverse);
        // A transposed matrix would be seen
        assert!(y == 0 || !sample.inverse.transpose().abs_diff_eq(expected, 1e-3));
    }
}

#[test]
fn magnitudes_a_little_out_of_range_are_brought_in_and_reported() {
    let [matrix, mut magnitude] = published(&table());
    magnitude[9][0] = 1.004;
    magnitude[20][1] = -0.001;
    magnitude[30][1] = magnitude[30][0] + 0.003;
    let files = (store(&matrix, Storage::Dds32), store(&magnitude, Storage::Dds32));
    let read = read_published(&files.0, &files.1, "").unwrap();
    let adjusted = |x, y, used| {
        let [albedo, schlick, ..] = magnitude[(y * SIZE + x) as usize];
        Adjusted::Magnitude { x, y, found: [albedo, schlick], used }
    };
    let expected = [
        adjusted(1, 1, [1.0, magnitude[9][1]]),
        adjusted(4, 2, [magnitude[20][0], 0.0]),
        adjusted(6, 3, [magnitude[30][0]; 2]),
    ];
    assert_eq!(read.adjusted, expected);
}

#[test]
fn what_is_far_out_of_range_is_refused_with_its_place() {
    let [matrix, magnitude] = published(&table());
    for (value, expected) in [
        ([1.5, 0.1], "magnitude: texel (2, 1) is (1.5, 0.1); "),
        ([0.5, 0.6], "magnitude: texel (2, 1) is (0.5, 0.6); "),
        ([-5.0, 0.1], "magnitude: texel (2, 1) is (-5, 0.1); "),
        ([f32::NAN, 0.1], "magnitude: texel (2, 1) channel 0 is NaN"),
        ([0.1, f32::INFINITY], "magnitude: texel (2, 1) channel 1 is inf"),
    ] {
        let mut magnitude = magnitude.clone();
        magnitude[10][..2].copy_from_slice(&value);
        let files = (store(&matrix, Storage::Dds32), store(&magnitude, Storage::Dds32));
        let error = read_published(&files.0, &files.1, "").unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
        assert!(error.ends_with("(are these images of another convention?)"), "{error}");
    }
    let mut mirrored = matrix.clone();
    mirrored[10][3] = -mirrored[10][3];
    let files = (store(&mirrored, Storage::Dds32), store(&magnitude, Storage::Dds32));
    let error = read_published(&files.0, &files.1, "").unwrap_err().to_string();
    assert!(error.starts_with("matrix: texel (2, 1) is singular or mirrored"), "{error}");
}

#[test]
fn images_that_do_not_belong_together_are_refused() {
    let [matrix, magnitude] = published(&table());
    let good = store(&matrix, Storage::Dds32);
    let error = read_published(&good, &store(&magnitude[..16], Storage::Dds32), "").unwrap_err();
    assert!(matches!(error, PublishedError::Sizes { matrix: 8, magnitude: 4 }), "{error}");
    let error = read_published(&good, b"GIF89a", "").unwrap_err().to_string();
    assert_eq!(
        error,
        "the image of magnitudes: neither OpenEXR nor KTX2 nor DDS, in which light tables are kept"
    );
    let error = read_published(b"", &good, "").unwrap_err().to_string();
    assert!(error.starts_with("the image of matrices: neither"), "{error}");
}

#[test]
fn our_own_tables_are_not_taken_for_such_images() {
    use arealight_table::{FileError, Precision, TableFile, Target};
    let [_, magnitude] = published(&table());
    let magnitude = store(&magnitude, Storage::Dds32);
    let file = TableFile { table: table(), fit_error: None };
    for target in [Target::Exr, Target::Dds(Precision::Single), Target::Ktx2(Precision::Half)] {
        match read_published(&file.write(target).unwrap(), &magnitude, "") {
            Err(PublishedError::Matrix(FileError::Read(ReadError::LayerCount {
                count: 3 | 6,
                expected: &[1],
            }))) => {}
            other => panic!("{target:?}: {other:?}"),
        }
    }
}
