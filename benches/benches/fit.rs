//! How long the fit of a GGX table takes, its albedos included:
//! `cargo bench -p arealight-benches --bench fit`. Seconds of the clock; on a machine busy with other work,
//! of little meaning.

use arealight_fit::{Aim, GgxBrdf, Settings, fit};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Under `cargo test` a benchmark is only to be seen to run
    let size = if std::env::args().any(|argument| argument == "--bench") { 64 } else { 4 };
    println!("| {size} x {size} nodes | seconds |\n|---|---|");
    let plain = Settings { size, pairs: false, ..Settings::default() };
    for (name, settings) in [
        ("one matrix for all F0", Settings { aim: Aim::one_for_all(), ..plain.clone() }),
        ("two matrices", plain.clone()),
        ("two matrices and pairs of lobes", Settings { pairs: true, ..plain }),
    ] {
        let start = Instant::now();
        let table = fit(&GgxBrdf, &settings, &|_, _| {})?;
        assert_eq!(table.size(), size);
        println!("| {name} | {:.1} |", start.elapsed().as_secs_f64());
    }
    Ok(())
}
