//! What disks, spheres and tubes cost, and how far off they are at that cost:
//! `cargo bench -p arealight-benches --bench shapes`. Prints a Markdown table; `-- --save
//! FILE` writes JSON, of which `tools/plots/plots.py shapes FILE -o FILE.svg` draws error against time of
//! disks.

use arealight_benches::shape_cost::{markdown, measure};
use arealight_benches::start::start;

const ROUNDS: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let costs = measure(&host, rounds)?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    let mut arguments = std::env::args();
    if arguments.any(|argument| argument == "--save") {
        let file = arguments.next().ok_or("--save: name a file to write")?;
        let found = serde_json::json!({ "device": host.device_name(), "costs": costs });
        std::fs::write(file, format!("{found:#}\n"))?;
    }
    Ok(())
}
