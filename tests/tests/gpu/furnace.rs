//! The white furnace in short form: with both horizons, or over half vectors, next to nothing of light from
//! everywhere is lost. `arealight bench furnace` is the long form.

use arealight_benches::furnace::{Options, Row, run};
use arealight_engine::host::testing::device_or_skip;

#[test]
fn both_horizons_lose_at_most_a_thousandth_of_light_from_everywhere() {
    let Some(host) = device_or_skip() else { return };
    let found = run(&host, &arealight::LightTable::ggx(), &Options { steps: 71 }, &|_| {}).unwrap();
    println!("{}", found.to_text());
    let row = |name: &str| -> &Row { found.rows.iter().find(|row| row.level == name).unwrap() };
    // The table's albedo between its nodes, and float32; float16 rounds albedos above 1/2 by 2.4e-4
    for (level, most) in [
        ("both horizons", 1e-3),
        ("both horizons, table of float16", 1.2e-3),
        ("both horizons, two lobes", 1e-3),
        ("half vectors", 1e-3),
        ("both horizons, multiple scattering", 1e-3),
    ] {
        let row = row(level);
        assert!(row.loss < most && row.gain < most && row.mean < 2e-4, "{row:?}");
    }
    // The twin: by the default level the part of the lobe below the surface is lost
    assert!(row("default").loss > 0.05 && row("default").mean > 2e-3);
}
