//! Sections of a document that a command writes, between two lines that say so.

/// The lines around a generated section of a document, by the command that writes it.
#[derive(Debug, Clone, Copy)]
pub struct Markers(&'static str);

impl Markers {
    /// Of the tables of [`crate::compiled`].
    pub const COMPILED: Self = Self("arealight bench compiled");
    /// Of the frames of [`crate::model`].
    pub const MODEL: Self = Self("arealight bench compiled --model");
    /// Of [`crate::materials`].
    pub const MATERIALS: Self = Self("arealight bench materials");
    /// Of [`crate::furnace`].
    pub const FURNACE: Self = Self("arealight bench furnace");
    /// Of [`crate::many_lights`].
    pub const LIGHTS: Self = Self("arealight bench lights");
    /// Of the same in fog.
    pub const FOG: Self = Self("arealight bench lights --fog");
    /// Of [`crate::shadow_motion`].
    pub const SHADOWS_IN_MOTION: Self = Self("arealight bench shadows --motion");
    /// Of [`crate::shadow_levels`].
    pub const SHADOWS: Self = Self("arealight bench shadows");

    /// The line before, and the one after.
    pub fn lines(self) -> [String; 2] {
        ["begin", "end"].map(|which| format!("<!-- {which}: {} -->", self.0))
    }
}

/// The document with `section` between its markers; `None` where it has no such place.
pub fn replace_section(document: &str, markers: Markers, section: &str) -> Option<String> {
    let [begin, end] = markers.lines();
    let (before, rest) = document.split_once(&begin)?;
    let (_, after) = rest.split_once(&end)?;
    Some(format!("{before}{begin}\n\n{}\n\n{end}{after}", section.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_takes_the_place_of_the_one_before() {
        let document = format!("# Title\n\n{}\n\n## More\n", Markers::COMPILED.lines().join("\nold\n"));
        let new = replace_section(&document, Markers::COMPILED, "new\n").unwrap();
        assert!(new.starts_with("# Title\n\n<!-- begin") && new.ends_with("-->\n\n## More\n"), "{new}");
        assert!(new.contains("\n\nnew\n\n") && !new.contains("old"));
        assert_eq!(
            replace_section(&new, Markers::COMPILED, "new").as_deref(),
            Some(&*new),
            "again is the same"
        );
        assert_eq!(replace_section("# Title\n", Markers::COMPILED, "new"), None);
    }
}
