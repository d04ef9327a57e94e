//! Draws some frames by the forward engine, and keeps the last as a PNG.

use arealight_examples::command_line::CommandLine;
use arealight_examples::forward::Forward;
use arealight_host::Host;

fn main() -> arealight_examples::Result<()> {
    let wanted = CommandLine::parse(std::env::args().skip(1))?;
    let host = Host::new(arealight_examples::host_options())?;
    let mut engine = Forward::new(&host, wanted.size)?;
    for seconds in wanted.times() {
        engine.frame(seconds)?;
    }
    let path = wanted.path_or("forward.png");
    engine.picture()?.save(&path)?;
    println!("{}", path.display());
    Ok(())
}
