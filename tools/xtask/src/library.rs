//! What the GLSL library can be asked for, read from its text.

use crate::TaskError;
use crate::shaders::stems_below;
use std::path::Path;

/// The library's files, and its vocabulary.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Library {
    /// Names without ending, and texts.
    pub files: Vec<(String, String)>,
    /// Macros that a host may define as 1: those which a file defines as 0 where the host has not.
    pub toggles: Vec<String>,
    /// The constants `AREALIGHT_EFFECT_*`.
    pub effects: Vec<String>,
    /// The fields of `ArealightQuality`, in capitals.
    pub quality_fields: Vec<String>,
    /// Pairs of a field and the constant of one of its rungs.
    pub rungs: Vec<(String, String)>,
}

impl Library {
    /// Reads the files of a folder.
    pub fn read(folder: &Path) -> Result<Self, TaskError> {
        let mut files = vec![];
        for name in stems_below(folder, "glsl")? {
            let path = folder.join(format!("{name}.glsl"));
            files.push((name, std::fs::read_to_string(&path).map_err(TaskError::file(&path))?));
        }
        Ok(Self::of(files))
    }

    fn of(files: Vec<(String, String)>) -> Self {
        let mut library = Self::default();
        for (_, text) in &files {
            library.toggles.extend(toggles(text));
            library.quality_fields.extend(quality_fields(text));
        }
        for constant in files.iter().flat_map(|(_, text)| constants(text)) {
            let Some(name) = constant.strip_prefix("AREALIGHT_") else { continue };
            if name.starts_with("EFFECT_") {
                library.effects.push(constant.to_owned());
            } else if let Some(field) = library.quality_fields.iter().find(|field| is_rung(name, field)) {
                library.rungs.push((field.clone(), constant.to_owned()));
            }
        }
        library.files = files;
        library
    }
}

fn is_rung(name: &str, field: &str) -> bool {
    name.strip_prefix(field).is_some_and(|rung| rung.starts_with('_'))
}

/// Macros `X` of `#ifndef X` and, on the next line, `#define X 0`.
fn toggles(text: &str) -> impl Iterator<Item = String> {
    let pairs = text.lines().zip(text.lines().skip(1));
    pairs.filter_map(|(guard, define)| {
        let name = guard.strip_prefix("#ifndef ")?;
        (define.strip_prefix("#define ")?.strip_suffix(" 0")? == name).then(|| name.to_owned())
    })
}

/// The names of integer constants.
fn constants(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let rest = line.strip_prefix("const int ").or_else(|| line.strip_prefix("const uint "))?;
        rest.split_once(" = ").map(|(name, _)| name)
    })
}

fn quality_fields(text: &str) -> impl Iterator<Item = String> {
    let body = text.split_once("struct ArealightQuality {").and_then(|(_, rest)| rest.split_once("};"));
    body.map_or("", |(body, _)| body).lines().filter_map(|line| {
        let field = line.trim().strip_prefix("int ")?;
        field.split_once(';').map(|(name, _)| name.to_uppercase())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vocabulary_is_read_from_the_text() {
        let text = "#ifndef AREALIGHT_A_GLSL\n#define AREALIGHT_A_GLSL\n\
            #ifndef AREALIGHT_IMAGES\n#define AREALIGHT_IMAGES 0\n#endif\n\
            const uint AREALIGHT_EFFECT_GLOSSY = 2u;\nconst int AREALIGHT_HORIZON_BOTH = 1; // both\n\
            const int AREALIGHT_HORIZONTAL = 3;\nconst float AREALIGHT_PI = 3.0;\n\
            struct ArealightQuality {\n    int horizon; // one of\n    int lobes;\n};\n#endif\n";
        let library = Library::of(vec![("a".to_owned(), text.to_owned())]);
        assert_eq!(library.toggles, ["AREALIGHT_IMAGES"]);
        assert_eq!(library.effects, ["AREALIGHT_EFFECT_GLOSSY"]);
        assert_eq!(library.quality_fields, ["HORIZON", "LOBES"]);
        assert_eq!(library.rungs, [("HORIZON".to_owned(), "AREALIGHT_HORIZON_BOTH".to_owned())]);
    }

    #[test]
    fn this_library_has_a_vocabulary() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let library = Library::read(&root.join("shaders/include/arealight")).unwrap();
        assert!(library.toggles.contains(&"AREALIGHT_LIGHT_TEXTURES".to_owned()));
        assert!(library.effects.contains(&"AREALIGHT_EFFECT_POLYGON".to_owned()));
        for field in &library.quality_fields {
            assert!(library.rungs.iter().any(|(of, _)| of == field), "{field} has rungs");
        }
    }
}
