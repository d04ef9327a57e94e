//! What filtering a light's texture costs, as a ratio to a plain chain of mips of the same image in the same
//! run: `cargo bench -p arealight-benches --bench textures`. Prints a Markdown table.

use arealight_benches::start::start;
use arealight_benches::textures::{markdown, measure};

const ROUNDS: usize = 40;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some((host, rounds)) = start(ROUNDS) else { return Ok(()) };
    let sides = if rounds == ROUNDS { &[512, 1024][..] } else { &[64][..] };
    let costs = sides.iter().map(|side| measure(&host, *side, rounds)).collect::<Result<Vec<_>, _>>()?;
    println!("{}, {rounds} rounds\n\n{}", host.device_name(), markdown(&costs));
    Ok(())
}
