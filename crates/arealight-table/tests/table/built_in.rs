//! The table that is built in.

use arealight::LightTable;
use arealight_table::ggx;

#[test]
fn it_reads() {
    let table = ggx();
    assert_eq!(table.size(), 64);
    assert_eq!(table.description().brdf, "ggx-correlated-smith");
}

#[test]
fn its_file_is_small_and_as_this_version_writes_it() {
    let bytes = include_bytes!("../../tables/ggx.exr");
    assert!(bytes.len() < 200_000, "{} bytes", bytes.len());
    // Compression may differ in a newer library; what is compressed may not
    assert_eq!(arealight_table::read(&arealight_table::write(&ggx())).unwrap(), ggx());
}

#[test]
fn seen_from_the_normal_its_lobes_are_round() {
    let table = ggx();
    for texel in &table.matrix()[..table.size() as usize] {
        assert_eq!(texel[..3], [1.0, 0.0, 0.0]);
    }
}

#[test]
fn neighbouring_nodes_differ_little() {
    // Entries are of order 1. The largest step, 0.26, is one of q20 towards the last row, where lobes become
    // fans; in all rows but the last five, up to 85 degrees, steps are below 0.17
    let table = ggx();
    let size = table.size() as usize;
    let step = |a: usize, b: usize| {
        let pairs = table.matrix()[a].iter().zip(&table.matrix()[b]);
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
    assert!(worst[0] < 0.2 && worst[1] < 0.3, "{worst:?}");
}

#[test]
fn a_white_rough_surface_seen_from_the_normal_reflects_one_minus_ln_two() {
    // In closed form for alpha = 1
    let table = ggx();
    let sample = table.lookup(1.0, 1.0);
    assert!((sample.albedo - (1.0 - 2.0_f64.ln())).abs() < 1e-7, "{sample:?}");
}

#[test]
fn a_lookup_anywhere_is_a_lobe() {
    let table: LightTable = ggx();
    for i in 0..=200 {
        for j in 0..=200 {
            let sample = table.lookup(f64::from(i) / 200.0, f64::from(j) / 200.0);
            assert!(sample.inverse.determinant() > 0.0, "{i} {j} {sample:?}");
            assert!((0.0..=1.0).contains(&sample.albedo) && (0.0..=sample.albedo).contains(&sample.schlick));
        }
    }
}
