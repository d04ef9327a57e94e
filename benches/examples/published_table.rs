//! Makes `benches/tables/published-quality.exr` again, and prints its errors beside those of the published
//! table: `cargo run --release -p arealight-benches --example published_table -- FILE.exr`. About a minute of
//! processor time.

use arealight_benches::published;
use arealight_fit::report::{COUNT, Level, PUBLISHED, SEED, cases, measure};
use arealight_table::{Precision, rounded, save};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Rounded to float16, which changes the errors by less than their third digit and halves the file
    let table = rounded(&published::fit(&arealight::LightTable::ggx())?, Precision::Half)?;
    if let Some(path) = std::env::args_os().nth(1).map(PathBuf::from) {
        save(&table, &path)?;
    }
    println!(
        "{:>6}  {:>9} {:>9} {:>6}  {:>9} {:>9} {:>6}",
        "F0", "mean", "published", "", "95 %", "published", ""
    );
    for (ours, published) in
        measure(&table, Level::default(), &cases(COUNT, SEED, &|| {})).iter().zip(&PUBLISHED)
    {
        let pair =
            |ours: f64, published: f64| format!("{ours:>9.5} {published:>9.5} {:>6.3}", ours / published);
        println!(
            "{:>6}  {}  {}",
            ours.f0,
            pair(ours.mean, published.mean),
            pair(ours.percentile_95, published.percentile_95)
        );
    }
    Ok(())
}
