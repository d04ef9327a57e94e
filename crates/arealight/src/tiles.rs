//! Tiles of a picture, classified by the lights that contribute to them: what the kernels `classify` and
//! `shade` share.
//!
//! A frame may have many lights of every kind, and few contribute to a pixel. Each tile of 8 × 8 pixels gets
//! a list of the lights that contribute to it, and each class of tiles has a pipeline with no more code than
//! their lights need. docs/tiles.md has measurements.

use crate::LightSummary;
use crate::output::Output;

/// Width and height of a tile in pixels.
pub const SIDE: u32 = 8;

/// Words of a tile's record before the indices of its lights: how many convex quads without a texture,
/// polygons in all, and shapes.
pub const RECORD_HEADER: u32 = 3;

/// In the place of each of these counts: the tile is shaded by all lights of the frame, since its list does
/// not hold those that contribute to it.
pub const ALL_LIGHTS: u32 = u32::MAX;

/// Workgroups of a class's dispatch in x.
pub const ROW: u32 = 32768;

/// In the place of a [`TileClass`]: a whole frame is shaded, which has no tiles.
pub const NO_CLASS: u32 = 3;

/// The classes of tiles, from the cheapest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum TileClass {
    /// No surface, or no light that contributes to it. Its pipeline writes that, where pixels are
    /// overwritten; where they are added to it has none.
    Empty = 0,
    /// Convex quads without textures, and no other light.
    Quads = 1,
    /// Any lights.
    Any = 2,
}

impl TileClass {
    /// Every class, by number.
    pub const ALL: [Self; 3] = [Self::Empty, Self::Quads, Self::Any];

    /// What its pipeline needs of a frame's lights.
    pub fn lights(self, frame: LightSummary) -> LightSummary {
        match self {
            Self::Any => frame,
            Self::Empty | Self::Quads => frame.quads(),
        }
    }

    /// Whether frames with these lights may have such tiles, and pixels are written for them.
    pub fn is_dispatched(self, frame: LightSummary, output: Output) -> bool {
        match self {
            Self::Empty => output == Output::Overwrite,
            Self::Quads => frame.quad_count > 0,
            Self::Any => frame.has_polygons() || frame.shape_count > 0,
        }
    }

    /// A word, for people to read.
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

/// How many tiles an image of `size` pixels has in each direction.
pub fn tile_counts(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(SIDE))
}

/// Column and row of a tile, as the lists hold it.
pub fn unpack(tile: u32) -> [u32; 2] {
    [tile & 0xffff, tile >> 16]
}

/// Words of a class at the buffer's begin: `VkDispatchIndirectCommand`, and how many tiles there are in the
/// class.
pub const CLASS_WORDS: usize = 4;

/// The words of a class without a tile.
pub const NO_TILES: [u32; CLASS_WORDS] = [0, 0, 1, 0];

/// Words before the classes' lists of tiles.
pub const FIRST_LIST: u32 = (TileClass::ALL.len() * CLASS_WORDS) as u32;

/// Bytes of the buffer of tile lists, for an image of `size` pixels and lists of `capacity` lights: the
/// classes' dispatches ([`CLASS_WORDS`]), their lists of tiles, and a record a tile. The most that there is
/// where it is more.
pub fn memory(size: [u32; 2], capacity: u32) -> u64 {
    let [columns, rows] = tile_counts(size).map(u64::from);
    let record = u64::from(RECORD_HEADER) + u64::from(capacity);
    let words = (columns * rows).saturating_mul(TileClass::ALL.len() as u64 + record);
    words.saturating_add(u64::from(FIRST_LIST)).saturating_mul(4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Effects;

    #[test]
    fn no_size_is_too_large_to_be_told() {
        assert_eq!(memory([u32::MAX; 2], u32::MAX), u64::MAX);
        assert_eq!(crate::plan::shadow_picks_size(4, [u32::MAX; 2]), u64::MAX);
        assert_eq!(crate::plan::shadow_history_size([u32::MAX; 2]), u64::MAX);
    }

    #[test]
    fn the_cheapest_class_comes_first_and_numbers_are_places() {
        for (number, class) in (0..).zip(TileClass::ALL) {
            assert_eq!(class as u32, number);
            assert_ne!(class as u32, NO_CLASS);
        }
        let frame = |light_count, quad_count, shape_count| LightSummary {
            light_count,
            quad_count,
            shape_count,
            ..LightSummary::default()
        };
        let dispatched = |frame, output| TileClass::ALL.map(|class| class.is_dispatched(frame, output));
        assert_eq!(dispatched(frame(2, 2, 0), Output::Add), [false, true, false]);
        assert_eq!(dispatched(frame(2, 2, 0), Output::Overwrite), [true, true, false]);
        assert_eq!(dispatched(frame(3, 2, 0), Output::Add), [false, true, true]);
        assert_eq!(dispatched(frame(0, 0, 1), Output::Add), [false, false, true]);
    }

    #[test]
    fn tiles_of_quads_have_the_code_of_quads_alone() {
        let effects = Effects::all() - Effects::SURFACES;
        let frame = LightSummary { light_count: 3, quad_count: 2, shape_count: 1, effects };
        assert_eq!(TileClass::Quads.lights(frame).effects, Effects::TWO_SIDED);
        assert_eq!(TileClass::Any.lights(frame), frame);
    }

    #[test]
    fn memory_is_that_of_whole_tiles() {
        assert_eq!(memory([17, 8], 64), (12 + 3 * (3 + 3 + 64)) * 4);
    }
}
