//! `types`: the vocabulary that an engine's programmer has to know stays small.

use crate::TaskError;
use std::path::Path;

/// The most public types of the crate `arealight`, errors included. A type more needs a reason, and often
/// replaces another.
const MOST: usize = 57;

/// What declares a type.
const KEYWORDS: [&str; 5] = ["struct", "enum", "union", "trait", "type"];

/// Whether the crate `arealight` has no more public types than [`MOST`].
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let types = public_types(&root.join("crates/arealight/src"))?;
    let count = types.len();
    if count > MOST {
        eprintln!("error: crates/arealight has {count} public types, at most {MOST}: {}", types.join(", "));
    }
    println!("{count} public types of arealight, at most {MOST}");
    Ok(count <= MOST)
}

/// The names of all types that files in a folder and below declare as public.
fn public_types(folder: &Path) -> Result<Vec<String>, TaskError> {
    let mut types = vec![];
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        if path.is_dir() {
            types.extend(public_types(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
            types.extend(declared(&text).map(str::to_owned));
        }
    }
    types.sort();
    Ok(types)
}

/// The names of the public types that a file declares, those of a macro's body (`bitflags!`) among them.
/// Associated types are no types of their own, and have no `pub`.
fn declared(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let (keyword, rest) = line.trim_start().strip_prefix("pub ")?.split_once(' ')?;
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        KEYWORDS.contains(&keyword).then(|| &rest[..end])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arealight_has_few_public_types() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let types = public_types(&root.join("crates/arealight/src")).unwrap();
        assert!(types.len() <= MOST, "{}: {types:?}", types.len());
        // The twin: they are found, in files of modules and in macros
        for name in ["Light", "LobeHorizon", "Binding", "Effects", "LightFault"] {
            assert!(types.iter().any(|found| found == name), "{name}: {types:?}");
        }
    }

    #[test]
    fn every_kind_of_type_counts_and_nothing_else() {
        let text = "pub struct A(u32);\npub enum B {\n    pub union C {}\npub trait D: Sized {\npub type \
        E<T> = [T; 2];\n\
                    struct Hidden;\npub(crate) struct Inner;\n/// pub struct Comment\npub fn f() {}\npub use \
                    other::F;\n";
        assert_eq!(declared(text).collect::<Vec<_>>(), ["A", "B", "C", "D", "E"]);
    }
}
