//! Draws the scene, and keeps it as a PNG.

use arealight_wgpu_example::{Gpu, draw};
use std::path::PathBuf;

fn main() -> arealight_wgpu_example::Result<()> {
    let path = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "wgpu.png".into()));
    let gpu = Gpu::new()?;
    draw(&gpu, [640, 400], 0.5)?.save(&path)?;
    println!("{}, on {}", path.display(), gpu.adapter.get_info().name);
    Ok(())
}
