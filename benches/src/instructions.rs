//! What each effect and each rung adds to the shade kernel in instructions: SPIR-V after `spirv-opt`, counted by
//! `cargo run -p xtask -- instructions`.

use arealight::Effects;
use serde::Deserialize;

/// The counts that are checked in.
#[derive(Debug, Clone, Deserialize)]
pub struct Instructions {
    /// How to make them again.
    pub command: String,
    /// What counted.
    pub tool: String,
    /// SHA-256 of the module that was counted.
    pub spirv_sha256: String,
    /// Each specialisation once.
    pub counts: Vec<Count>,
}

/// What is left of the kernel in one specialisation.
#[derive(Debug, Clone, Deserialize)]
pub struct Count {
    /// `plain` (both lobes, the first rungs), `none`, `all`, an effect's name, or a quality level as `horizon:both`.
    pub name: String,
    /// [`Effects`] as bits.
    pub effects: u32,
    /// Every instruction.
    pub instructions: u32,
    /// Reads of an image by texel.
    pub fetches: u32,
    /// Filtered reads of an image.
    pub samples: u32,
}

/// What has been counted of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Added {
    /// The kernel with both lobes on the first rungs, without the effect.
    pub without: u32,
    /// The same with it.
    pub with: u32,
}

impl Instructions {
    /// The table that is checked in.
    ///
    /// # Panics
    /// Never: a test reads the table.
    pub fn checked_in() -> Self {
        serde_json::from_str(include_str!("instructions.json")).expect("a test reads the table")
    }

    /// The specialisation of that name.
    pub fn find(&self, name: &str) -> Option<&Count> {
        self.counts.iter().find(|count| count.name == name)
    }

    /// What one effect adds to the plain kernel. None where it was not counted.
    pub fn added_by(&self, effect: Effects) -> Option<Added> {
        let plain = self.find("plain")?.instructions;
        let other = self.find(effect.names().first()?)?;
        // Lobes are taken away from the plain kernel, all else is added to it
        let is_added = Effects::from_bits_retain(other.effects).contains(effect);
        let [without, with] =
            if is_added { [plain, other.instructions] } else { [other.instructions, plain] };
        Some(Added { without, with })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_that_is_off_is_gone() {
        let table = Instructions::checked_in();
        for effect in Effects::all().iter() {
            let added = table.added_by(effect).unwrap_or_else(|| panic!("{effect} was not counted"));
            assert!(added.with > added.without, "{effect}: {added:?}");
        }
        // No filtered read is left without images, and one texel read more comes with the fourth image
        let count = |name: &str| table.find(name).unwrap_or_else(|| panic!("{name} was not counted"));
        for count in &table.counts {
            let textured = Effects::from_bits_retain(count.effects).intersects(Effects::IMAGES);
            assert_eq!(count.samples > 0, textured, "{}", count.name);
        }
        assert_eq!(count("specular_input").fetches, count("plain").fetches + 1);
        // The table of lobes is read for the glossy one alone: three bilinear reads; and nothing but the surface is left of none
        assert_eq!(count("plain").fetches - count("glossy").fetches, 12);
        assert!(count("none").instructions * 4 < count("plain").instructions);
    }

    #[test]
    fn every_rung_was_counted_and_formulas_read_no_table() {
        let table = Instructions::checked_in();
        let count = |name: &str| table.find(name).unwrap_or_else(|| panic!("{name} was not counted"));
        let plain = count("plain");
        for dearer in ["form_factor:difference", "horizon:both", "fresnel:split"] {
            assert!(count(dearer).instructions > plain.instructions, "{dearer}");
        }
        assert_eq!(count("lobes:formula").fetches, plain.fetches - 12);
        let footprints = ["textured", "footprint:ellipse", "footprint:split"];
        let counts = footprints.map(|name| count(name).instructions);
        assert!(counts.is_sorted(), "{counts:?}");
    }
}
