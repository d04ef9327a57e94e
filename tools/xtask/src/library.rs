//! What the GLSL library can be asked for, read from its text.

use crate::TaskError;
use crate::shaders::stems_below;
use std::path::Path;

/// The library's files, and its options.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Library {
    /// Names without ending, and texts.
    pub files: Vec<(String, String)>,
    /// Macros that a host may define: those to which a file gives a number where the host has not.
    pub options: Vec<LibraryOption>,
}

/// A macro that a host may define before it includes the library.
#[derive(Debug, PartialEq, Eq)]
pub struct LibraryOption {
    pub name: String,
    /// A file tests it by `#if`: it is 0 or 1, and no expression of specialisation constants.
    pub is_literal: bool,
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
        let is_tested = |name: &str| {
            let test = format!("#if {name}");
            files.iter().any(|(_, text)| text.lines().any(|line| line == test))
        };
        let options = files.iter().flat_map(|(_, text)| options(text));
        let options =
            options.map(|name| LibraryOption { is_literal: is_tested(&name), name }).collect::<Vec<_>>();
        Self { options, files }
    }
}

/// Macros `X` of `#ifndef X` and, on the next line, `#define X` with a number.
fn options(text: &str) -> impl Iterator<Item = String> {
    let pairs = text.lines().zip(text.lines().skip(1));
    pairs.filter_map(|(guard, define)| {
        let name = guard.strip_prefix("#ifndef ")?;
        let value = define.strip_prefix("#define ")?.strip_prefix(name)?.strip_prefix(' ')?;
        value.parse::<u32>().is_ok().then(|| name.to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_from_the_text() {
        let text = "#ifndef AREALIGHT_A_GLSL\n#define AREALIGHT_A_GLSL\n\
            #ifndef AREALIGHT_IMAGES\n#define AREALIGHT_IMAGES 0\n#endif\n\
            #ifndef AREALIGHT_LOBE\n#define AREALIGHT_LOBE 1\n#endif\n\
            #if AREALIGHT_IMAGES\nvec3 f();\n#endif\n#endif\n";
        let library = Library::of(vec![("a".to_owned(), text.to_owned())]);
        let found: Vec<_> =
            library.options.iter().map(|option| (option.name.as_str(), option.is_literal)).collect();
        assert_eq!(found, [("AREALIGHT_IMAGES", true), ("AREALIGHT_LOBE", false)]);
    }

    #[test]
    fn this_library_has_options_of_both_kinds() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let library = Library::read(&root.join("shaders/include/arealight")).unwrap();
        let is_literal = |name: &str| {
            library.options.iter().find(|option| option.name == name).map(|option| option.is_literal)
        };
        assert_eq!(is_literal("AREALIGHT_LIGHT_TEXTURES"), Some(true));
        assert_eq!(is_literal("AREALIGHT_MESHES"), Some(true));
        assert_eq!(is_literal("AREALIGHT_DIFFUSE"), Some(false));
        assert_eq!(is_literal("AREALIGHT_FOOTPRINT"), Some(false));
    }
}
