//! What a quad's form factor costs, by level, as ratios to the clipless yardstick in the same run:
//! `cargo bench -p arealight-benches --bench form_factor`. Prints a Markdown table.

use arealight_benches::cost::{markdown, measure};
use arealight_benches::start::start;

const ROUNDS: usize = 40;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let costs = measure(&host, rounds)?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    Ok(())
}
