//! What a quad's form factor costs, by rung, as ratios to the common practice in the same run:
//! `cargo bench -p arealight-benches --bench form_factor`. Prints a Markdown table.

use arealight_benches::cost::{markdown, measure};
use arealight_host::{Host, HostOptions};

const ROUNDS: usize = 40;

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
