//! What disks, spheres and tubes cost, and how far off they are at that cost:
//! `cargo bench -p arealight-benches --bench shapes`. Prints a Markdown table; with
//! `-- --chart FILE` it draws error against time of disks, in SVG.

use arealight_benches::shape_cost::{chart, markdown, measure};
use arealight_benches::start::start;

const ROUNDS: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let costs = measure(&host, rounds)?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    let mut arguments = std::env::args();
    if arguments.any(|argument| argument == "--chart") {
        let file = arguments.next().ok_or("--chart: name a file to write")?;
        std::fs::write(file, chart(&costs, &host.device_name()))?;
    }
    Ok(())
}
