//! Writes the scenes of `scenes/`: `cargo run -p arealight-scene --example make_scenes [FOLDER]`.

mod clock;
mod coats;
mod demo;
mod files;
mod hundred_lamps;
mod interior;
mod lamps;
mod material_balls;
mod neon;
mod paper;
mod product;
mod room;
mod screen;
mod shadows;
mod shapes;
mod sheen;
mod shop;
mod studio;
mod sweep;
mod test_card;
mod writer;

use std::path::{Path, PathBuf};

fn main() -> std::io::Result<()> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folder = std::env::args_os().nth(1).map_or(default, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    for (name, bytes) in files::files() {
        let path = folder.join(name);
        println!("{}: {} bytes", path.display(), bytes.len());
        std::fs::write(path, bytes)?;
    }
    Ok(())
}
