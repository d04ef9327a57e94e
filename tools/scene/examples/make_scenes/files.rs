//! The files of `scenes/`: what the program writes, and what a test holds them to.

use crate::{clock, coats, demo, lamps, room, screen, sweep};

/// Each file's name and bytes.
pub fn files() -> [(&'static str, Vec<u8>); 7] {
    [
        ("sweep.glb", sweep::glb()),
        ("room.glb", room::glb()),
        ("demo.glb", demo::glb()),
        ("screen.glb", screen::glb()),
        ("shapes.glb", lamps::glb()),
        ("clock.glb", clock::glb()),
        ("coats.glb", coats::glb()),
    ]
}
