//! Draws some frames by the deferred engine, and keeps the last as a PNG.

use arealight_examples::command_line::{CommandLine, FRAMES};
use arealight_examples::deferred::Deferred;
use arealight_examples::gpu::{Gpu, Instance};

fn main() -> arealight_examples::Result<()> {
    let wanted = CommandLine::parse("deferred.png", std::env::args().skip(1))?;
    let instance = Instance::new()?;
    let gpu = Gpu::new(&instance)?;
    let mut engine = Deferred::new(&gpu, wanted.size)?;
    for frame in 0..FRAMES {
        engine.frame(f64::from(frame) / 30.0)?;
    }
    engine.picture()?.save(&wanted.path)?;
    println!("{}", wanted.path.display());
    Ok(())
}
