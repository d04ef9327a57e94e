//! What disks, spheres and tubes cost, and how far off they are at that cost:
//! `cargo bench -p arealight-benches --bench shapes`. Prints a Markdown table.

use arealight_benches::shape_cost::{markdown, measure};
use arealight_host::{Host, HostOptions};

const ROUNDS: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Under `cargo test` a benchmark is only to be seen to run
    let rounds = if std::env::args().any(|argument| argument == "--bench") { ROUNDS } else { 1 };
    let host = match Host::new(HostOptions::default()) {
        Ok(host) => host,
        Err(error) => {
            eprintln!("skipped: {error}");
            return Ok(());
        }
    };
    let costs = measure(&host, rounds)?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    Ok(())
}
