//! The table that is built in.

#[test]
fn the_built_in_table_reads() {
    let table = arealight_table::ggx();
    assert_eq!(table.size(), 64);
    assert_eq!(table.description().brdf, "ggx-correlated-smith");
}
