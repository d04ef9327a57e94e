//! Tables of another size.

use arealight::TableError;
use arealight_table::resampled;

use crate::draft::{table, table_of_pairs};

#[test]
fn nodes_that_coincide_keep_their_numbers() {
    // 64 nodes are 63 steps: every third of them makes 22 nodes
    let (fine, coarse) =
        (arealight::LightTable::ggx(), resampled(&arealight::LightTable::ggx(), 22).unwrap());
    for (x, y) in (0..22 * 22).map(|i| (i % 22, i / 22)) {
        let (fine_node, node) = (3 * y * 64 + 3 * x, y * 22 + x);
        assert_eq!(coarse.matrix()[node], fine.matrix()[fine_node]);
        assert_eq!(coarse.magnitude()[node], fine.magnitude()[fine_node]);
        assert_eq!(coarse.schlick_matrix().unwrap()[node], fine.schlick_matrix().unwrap()[fine_node]);
    }
}

#[test]
fn between_nodes_a_new_one_is_what_a_lookup_finds() {
    let (old, new) = (table_of_pairs(7), resampled(&table_of_pairs(7), 12).unwrap());
    for (x, y) in (1..12).flat_map(|y| (1..12).map(move |x| (x, y))) {
        let (roughness, cos_view) = arealight::LightTable::node(12, x, y);
        let (a, b) = (old.lookup(roughness, cos_view), new.lookup(roughness, cos_view));
        // Rounding of texels to float32
        assert!(a.inverse.abs_diff_eq(b.inverse, 1e-6) && (a.albedo - b.albedo).abs() < 1e-6, "({x}, {y})");
        assert!(a.schlick_inverse.abs_diff_eq(b.schlick_inverse, 1e-6), "({x}, {y})");
        let ((a, of_a), (b, of_b)) = (a.pairs.unwrap(), b.pairs.unwrap());
        for k in 0..2 {
            assert!(a[k].abs_diff_eq(b[k], 1e-5) && (of_a[k] - of_b[k]).abs() < 1e-6, "({x}, {y})");
        }
    }
}

#[test]
fn a_resampled_table_says_so() {
    assert_eq!(resampled(&table(5), 5).unwrap(), table(5));
    let made_by = &resampled(&table(5), 3).unwrap().description().made_by.clone();
    assert_eq!(made_by, "files.rs, François, resampled from 5 nodes");
}

#[test]
fn sizes_that_no_table_has_are_refused() {
    for size in [0, 1, 1025, u32::MAX] {
        assert_eq!(resampled(&table(5), size), Err(TableError::Size { size }));
    }
}
