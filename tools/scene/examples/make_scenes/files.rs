//! The files of `scenes/`: what the program writes, and what a test holds them to.

use crate::hundred_lamps::Surface;
use crate::shadows::Floor;
use crate::{
    clock, coats, demo, hundred_lamps, interior, lamps, material_balls, neon, paper, product, room, screen,
    shadows, sheen, shop, studio, sweep,
};

/// Each file's name and bytes.
pub fn files() -> [(&'static str, Vec<u8>); 19] {
    [
        ("sweep.glb", sweep::glb()),
        ("room.glb", room::glb()),
        ("demo.glb", demo::glb()),
        ("screen.glb", screen::glb()),
        ("shapes.glb", lamps::glb()),
        ("clock.glb", clock::glb()),
        ("coats.glb", coats::glb()),
        ("sheen.glb", sheen::glb()),
        ("materials.glb", material_balls::glb()),
        ("shadows.glb", shadows::glb(Floor::Matt)),
        ("shadows-glossy.glb", shadows::glb(Floor::Glossy)),
        ("hundred-lamps.glb", hundred_lamps::glb(Surface::Satin)),
        ("hundred-lamps-metal.glb", hundred_lamps::glb(Surface::Metal)),
        ("studio.glb", studio::glb()),
        ("interior.glb", interior::glb()),
        ("neon.glb", neon::glb()),
        ("shop.glb", shop::glb()),
        ("product.glb", product::glb()),
        ("paper.glb", paper::glb()),
    ]
}
