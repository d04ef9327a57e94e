//! The table that is built in.

use arealight::LightTable;
use arealight_table::{TableFile, Target, ggx_file, hash};

#[test]
fn it_reads() {
    let table = LightTable::ggx();
    assert_eq!(table.size(), 64);
    assert_eq!(table.description().brdf, "ggx-correlated-smith");
    assert!(ggx_file().fit_error.unwrap().contains("two lobes: 3.37e-4 at F0 = 0.02"));
}

#[test]
fn it_is_embedded_as_the_command_writes_it() {
    let raw = ggx_file().write(Target::Raw).unwrap();
    assert!(raw == include_bytes!("../../../arealight/tables/ggx.f32"), "{} bytes", raw.len());
    // Through a file, which says what the texels must be, and to the same bytes again
    let hashed = "sha256:d8dc7d4b032b32f880f0ed749e3dec563ac4ce2c4a5c89950af50f1e99de6bfe";
    assert_eq!(hash(&LightTable::ggx()), hashed);
    let read = TableFile::read(&ggx_file().write(Target::Exr).unwrap()).unwrap();
    assert_eq!((&read, read.write(Target::Raw).unwrap()), (&ggx_file(), raw));
}

#[test]
fn seen_from_the_normal_its_lobes_are_round() {
    let table = LightTable::ggx();
    let [first, second] = &table.pairs().unwrap().matrices;
    for layer in [table.matrix(), table.schlick_matrix().unwrap(), first, second] {
        for texel in &layer[..table.size() as usize] {
            assert_eq!(texel[..3], [1.0, 0.0, 0.0]);
        }
    }
}

#[test]
fn neighbouring_nodes_differ_little() {
    // Entries are of order 1. The largest step, 0.27, is one of q20 towards the last row, where lobes become
    // fans; in all rows but the last five, up to 85 degrees, steps are below 0.08
    let table = LightTable::ggx();
    let worst = largest_steps(&table, table.matrix());
    assert!(worst[0] < 0.1 && worst[1] < 0.3, "{worst:?}");
    // The lobe of Schlick's weight turns from that of F0 to its own where it begins to count: entries up to 9
    let worst = largest_steps(&table, table.schlick_matrix().unwrap());
    assert!(worst[0] < 2.5 && worst[1] < 0.3, "{worst:?}");
}

/// The largest step of an entry between neighbours: in all rows but the last five, and in those.
fn largest_steps(table: &LightTable, texels: &[[f32; 4]]) -> [f32; 2] {
    let size = table.size() as usize;
    let step = |a: usize, b: usize| {
        let pairs = texels[a].iter().zip(&texels[b]);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    let mut worst = [0.0_f32; 2];
    for (x, y) in (0..size * size).map(|i| (i % size, i / size)) {
        let last_rows = usize::from(y + 5 >= size);
        for (dx, dy) in [(1, 0), (0, 1)] {
            if x + dx < size && y + dy < size {
                let step = step(y * size + x, (y + dy) * size + x + dx);
                worst[last_rows] = worst[last_rows].max(step);
            }
        }
    }
    worst
}

#[test]
fn a_white_rough_surface_seen_from_the_normal_reflects_one_minus_ln_two() {
    // In closed form for alpha = 1
    let table = LightTable::ggx();
    let sample = table.lookup(1.0, 1.0);
    assert!((sample.albedo - (1.0 - 2.0_f64.ln())).abs() < 1e-7, "{sample:?}");
}

#[test]
fn a_lookup_anywhere_is_a_lobe() {
    let table: LightTable = LightTable::ggx();
    for i in 0..=200 {
        for j in 0..=200 {
            let sample = table.lookup(f64::from(i) / 200.0, f64::from(j) / 200.0);
            // Those in between too: of one integral for a reflectance
            for f0 in [0.0, 0.02, 0.04, 0.1, 0.3, 1.0] {
                assert!(sample.inverse_by_f0(f0, 1.0).determinant() > 0.0, "{i} {j} {f0} {sample:?}");
            }
            assert!((0.0..=1.0).contains(&sample.albedo) && (0.0..=sample.albedo).contains(&sample.schlick));
        }
    }
}
