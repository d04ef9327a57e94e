//! Draws some frames by the deferred engine, and keeps the last as a PNG; or shows them in a window, where
//! there is one (with the feature `window`, and no picture asked for).

use arealight_examples::command_line::CommandLine;
use arealight_examples::deferred::Deferred;
use arealight_host::{Host, Semaphores};

fn main() -> arealight_examples::Result<()> {
    let wanted = CommandLine::parse(std::env::args().skip(1))?;
    #[cfg(feature = "window")]
    if wanted.path.is_none() {
        use arealight_examples::window::{Shown, show};
        match show(wanted.size, wanted.frames)? {
            Shown::Frames(count) => {
                println!("{count} frames were shown");
                return Ok(());
            }
            Shown::Nowhere(why) => eprintln!("There is no window ({why}): a picture is saved instead"),
        }
    }
    let host = Host::new(arealight_examples::host_options())?;
    let mut engine = Deferred::new(&host, wanted.size)?;
    for seconds in wanted.times() {
        engine.frame(seconds, |_| Ok(()), |(), _| Semaphores::default())?;
    }
    let path = wanted.path_or("deferred.png");
    engine.picture()?.save(&path)?;
    println!("{}", path.display());
    Ok(())
}
