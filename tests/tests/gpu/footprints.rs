//! The errors of light textures' lookups in short form: the kernel's are within its bars, and the filter of
//! Heitz et al. 2016 is not. `arealight bench textures` is the long form.

use arealight_benches::footprints::{METHODS, Options, run};
use arealight_engine::host::testing::device_or_skip;
use arealight_oracle::shading::poses::{Bar, Family};
use arealight_tests::prelude::*;

#[test]
fn the_kernel_is_within_its_bars_and_the_article_is_not() {
    let Some(host) = device_or_skip() else { return };
    let options = Options { poses: 20, rounds: 0, ..Options::default() };
    let found = run(&host, &LightTable::ggx(), &options, &|_| {}).unwrap();
    let judged = found.rows.iter().filter(|row| row.bar.is_some()).count();
    assert_eq!(judged, 4, "four families");
    assert_eq!(found.shortfalls().count(), 0, "{}", found.to_text());

    // The twin
    for family in [Family::Diffuse, Family::Horizon] {
        let errors = found.errors(METHODS[0].name, family).unwrap();
        assert!(
            !Bar::of(Footprint::Kernel, family).unwrap().holds(errors),
            "the article's passes: {errors:?}"
        );
    }

    // The texture is there: a bright spot is nothing that a light of one colour could be taken for
    let spot = found.rows.iter().find(|row| row.pictures == "spot" && row.family == Family::Sharp).unwrap();
    assert!(spot.errors.rmse > 10.0, "{spot:?}");

    let text = found.to_markdown();
    let left = text.lines().find(|line| line.contains('{'));
    assert!(left.is_none(), "a place of the document was not filled: {left:?}");
}
