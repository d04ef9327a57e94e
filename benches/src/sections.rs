//! Sections of a document that a command writes, between two lines that say so.

/// The lines that a generated section of a document lies between.
#[derive(Debug, Clone, Copy)]
pub struct Markers {
    /// The line before.
    pub begin: &'static str,
    /// The line after.
    pub end: &'static str,
}

impl Markers {
    /// Of the tables of [`crate::compiled`].
    pub const COMPILED: Self = Self {
        begin: "<!-- begin: arealight bench compiled -->",
        end: "<!-- end: arealight bench compiled -->",
    };

    /// Of the frames of [`crate::model`].
    pub const MODEL: Self = Self {
        begin: "<!-- begin: arealight bench compiled --model -->",
        end: "<!-- end: arealight bench compiled --model -->",
    };

    /// Of [`crate::materials`].
    pub const MATERIALS: Self = Self {
        begin: "<!-- begin: arealight bench materials -->",
        end: "<!-- end: arealight bench materials -->",
    };

    /// Of [`crate::furnace`].
    pub const FURNACE: Self = Self {
        begin: "<!-- begin: arealight bench furnace -->",
        end: "<!-- end: arealight bench furnace -->",
    };

    /// Of [`crate::many_lights`].
    pub const LIGHTS: Self =
        Self { begin: "<!-- begin: arealight bench lights -->", end: "<!-- end: arealight bench lights -->" };

    /// Of the same in fog.
    pub const FOG: Self = Self {
        begin: "<!-- begin: arealight bench lights --fog -->",
        end: "<!-- end: arealight bench lights --fog -->",
    };

    /// Of [`crate::shadow_motion`].
    pub const SHADOWS_IN_MOTION: Self = Self {
        begin: "<!-- begin: arealight bench shadows --motion -->",
        end: "<!-- end: arealight bench shadows --motion -->",
    };

    /// Of [`crate::shadow_levels`].
    pub const SHADOWS: Self = Self {
        begin: "<!-- begin: arealight bench shadows -->",
        end: "<!-- end: arealight bench shadows -->",
    };
}

/// The document with `section` between its markers; `None` where it has no such place.
pub fn replace_section(document: &str, markers: Markers, section: &str) -> Option<String> {
    let (before, rest) = document.split_once(markers.begin)?;
    let (_, after) = rest.split_once(markers.end)?;
    let (begin, end) = (markers.begin, markers.end);
    Some(format!("{before}{begin}\n\n{}\n\n{end}{after}", section.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_takes_the_place_of_the_one_before() {
        let document =
            format!("# Title\n\n{}\nold\n{}\n\n## More\n", Markers::COMPILED.begin, Markers::COMPILED.end);
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
