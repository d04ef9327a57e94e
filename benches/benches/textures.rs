//! What filtering a light's texture costs, as a ratio to a plain chain of mips of the same image in the same run:
//! `cargo bench -p arealight-benches --bench textures`. Prints a Markdown table.

use arealight_benches::textures::{markdown, measure};
use arealight_host::{Host, HostOptions};

const ROUNDS: usize = 40;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Under `cargo test` a benchmark is only to be seen to run
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (rounds, sides) = if is_bench { (ROUNDS, &[512, 1024][..]) } else { (1, &[64][..]) };
    let host = match Host::new(HostOptions::default()) {
        Ok(host) => host,
        Err(error) => {
            eprintln!("skipped: {error}");
            return Ok(());
        }
    };
    let costs = sides.iter().map(|side| measure(&host, *side, rounds)).collect::<Result<Vec<_>, _>>()?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    Ok(())
}
