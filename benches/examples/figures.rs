//! Draws what the documents show: `cargo run -p arealight-benches --example figures -- docs/images`. From the
//! checkout's root.

use arealight_benches::compiled::Compiled;
use arealight_benches::figures::{drawings, error_cost};
use arealight_benches::ladder::Ladder;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("a folder to write to is expected")?);
    let bench: Ladder = serde_json::from_str(&std::fs::read_to_string("benches/data/lavapipe.json")?)?;
    let compiled: Compiled = serde_json::from_str(&std::fs::read_to_string("benches/data/compiled.json")?)?;
    let mut files = drawings(&arealight::LightTable::ggx());
    files.push(("error-cost.svg", error_cost(&bench, &compiled, "navi21")?));
    for (name, drawing) in files {
        std::fs::write(folder.join(name), drawing)?;
        println!("wrote {}", folder.join(name).display());
    }
    Ok(())
}
