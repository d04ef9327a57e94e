//! Many lights in short form: by tiles it is the picture with all lights, but for what may be left out.
//! `arealight bench lights` is the long form.

use arealight_benches::many_lights::{Options, Way, run};
use arealight_engine::host::testing::device_or_skip;

#[test]
fn lists_of_lights_leave_out_no_more_than_they_may() {
    let Some(host) = device_or_skip() else { return };
    let ways = [Way::All, Way::Tiles(0.0), Way::Tiles(0.1)];
    let options =
        Options { counts: vec![200], size: [160, 96], rounds: 1, ways: ways.to_vec(), ..Options::default() };
    let found = run(&host, &arealight::LightTable::ggx(), &options, &|_| {}).unwrap();
    println!("{}", found.to_text());
    let [all, tiles, culled] = &found.rows[..] else { panic!("a row for each way") };
    assert_eq!(all.lights_per_pixel, 200.0);

    // With every light in the lists it is the same picture
    assert!(tiles.largest < 1e-5, "{tiles:?}");
    // Tiles keep their promise for each pixel
    assert!(culled.largest <= 0.1 && culled.lights_per_pixel < 0.9 * tiles.lights_per_pixel, "{culled:?}");
}
