//! Tiles of a picture, classified by the lights that matter to them: what the kernels `classify` and `shade_tiles` share.
//!
//! A scene has a set of effects, but few of its pixels call for all of them. Each tile of 8 × 8 pixels gets a list of
//! the lights that matter to it, and each class of tiles has a pipeline that does no more than those call for. docs/tiles.md
//! tells what that gains.

use crate::Effects;
use crate::gpu::GpuTileClass;
use crate::plan::Output;

/// Width and height of a tile in pixels.
pub const SIDE: u32 = 8;

/// Words of a tile's record before the indices of its lights.
pub const RECORD_HEADER: u32 = 2;

/// Groups of a class's dispatch in x.
pub const ROW: u32 = 32768;

/// What the tiles of a class have in common, from the cheapest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum TileClass {
    /// No surface, or no light that reaches it. Its pipeline writes that, where pixels are overwritten; where they are added
    /// to it has none.
    Empty = 0,
    /// Convex quads without images.
    Quads = 1,
    /// Any lights; and all lights, where a tile's list does not hold them.
    Any = 2,
}

impl TileClass {
    /// Every class, by number.
    pub const ALL: [Self; 3] = [Self::Empty, Self::Quads, Self::Any];

    /// What is left of a frame's effects in its pipeline.
    pub fn effects(self, frame: Effects) -> Effects {
        match self {
            Self::Any => frame,
            _ => frame - Effects::BEYOND_QUADS,
        }
    }

    /// Whether a frame of these effects may have such tiles that something is to be done for.
    pub fn is_called_for(self, frame: Effects, output: Output) -> bool {
        match self {
            Self::Empty => output == Output::Overwrite,
            Self::Quads => true,
            Self::Any => frame.intersects(Effects::BEYOND_QUADS),
        }
    }

    /// A few words, for people to read.
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Quads => "quads",
            Self::Any => "any",
        }
    }
}

impl std::fmt::Display for TileClass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// In the place of a class: the kernel shades all tiles of a frame, none of which was classified.
pub const NOT_CLASSIFIED: u32 = TileClass::ALL.len() as u32;

/// How many tiles an image of `size` pixels has in each direction.
pub fn tile_counts(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(SIDE))
}

/// Column and row of a tile, as the lists hold it.
pub fn unpack(tile: u32) -> [u32; 2] {
    [tile & 0xffff, tile >> 16]
}

/// Words before the classes' lists of tiles.
pub const FIRST_LIST: u32 = (TileClass::ALL.len() * size_of::<GpuTileClass>() / 4) as u32;

/// Bytes of the buffer of tile lists, for an image of `size` pixels and lists of `capacity` lights: the classes' dispatches
/// ([`GpuTileClass`]), their lists of tiles, and a record a tile.
pub fn memory(size: [u32; 2], capacity: u32) -> u64 {
    let [columns, rows] = tile_counts(size).map(u64::from);
    let record = u64::from(RECORD_HEADER) + u64::from(capacity);
    (u64::from(FIRST_LIST) + columns * rows * (TileClass::ALL.len() as u64 + record)) * 4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cheapest_class_comes_first_and_numbers_are_places() {
        for (number, class) in (0..).zip(TileClass::ALL) {
            assert_eq!(class as u32, number);
        }
        let quads = Effects::all() - Effects::BEYOND_QUADS;
        assert!(!TileClass::Any.is_called_for(quads, Output::Add));
        assert!(TileClass::Any.is_called_for(Effects::POLYGON, Output::Add));
        assert!(TileClass::Empty.is_called_for(quads, Output::Overwrite));
        assert!(!TileClass::Empty.is_called_for(quads, Output::Add));
    }

    #[test]
    fn memory_is_that_of_whole_tiles() {
        assert_eq!(memory([17, 8], 64), (12 + 3 * (3 + 2 + 64)) * 4);
    }
}
