//! The options of the GLSL library, read from its text.

use crate::TaskError;
use crate::shaders::stems_below;
use std::path::Path;

/// The library's files, and what a host may switch.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Library {
    /// Names without ending, and texts.
    pub files: Vec<(String, String)>,
    /// Macros that a host may define, with their defaults: those which a file defines as a number where the
    /// host has not.
    pub options: Vec<(String, u32)>,
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
        let options = files.iter().flat_map(|(_, text)| options(text)).collect();
        Self { files, options }
    }
}

/// Macros `X` of `#ifndef X` and, on the next line, `#define X` with a number.
fn options(text: &str) -> impl Iterator<Item = (String, u32)> {
    let pairs = text.lines().zip(text.lines().skip(1));
    pairs.filter_map(|(guard, define)| {
        let name = guard.strip_prefix("#ifndef ")?;
        let (defined, value) = define.strip_prefix("#define ")?.split_once(' ')?;
        (defined == name).then_some(())?;
        Some((name.to_owned(), value.parse().ok()?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_from_the_text() {
        let text = "#ifndef AREALIGHT_A_GLSL\n#define AREALIGHT_A_GLSL\n\
            #ifndef AREALIGHT_IMAGES\n#define AREALIGHT_IMAGES 0\n#endif\n\
            #ifndef AREALIGHT_DIFFUSE\n#define AREALIGHT_DIFFUSE 1\n#endif\n\
            #ifndef AREALIGHT_OTHER\n#define AREALIGHT_ANOTHER 1\n#endif\n\
            #define AREALIGHT_MACRO(x) (x)\n#endif\n";
        let library = Library::of(vec![("a".to_owned(), text.to_owned())]);
        let expected = [("AREALIGHT_IMAGES", 0), ("AREALIGHT_DIFFUSE", 1)];
        assert_eq!(library.options, expected.map(|(name, value)| (name.to_owned(), value)));
    }

    #[test]
    fn this_library_has_options() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let library = Library::read(&root.join("shaders/include/arealight")).unwrap();
        for option in [("AREALIGHT_LIGHT_TEXTURES", 0), ("AREALIGHT_SPECULAR", 1), ("AREALIGHT_TUBES", 0)] {
            assert!(library.options.contains(&(option.0.to_owned(), option.1)), "{option:?}");
        }
    }
}
