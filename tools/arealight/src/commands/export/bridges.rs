//! The functions that the GLSL library declares and a host defines, read from the library's text.

use std::collections::{BTreeMap, BTreeSet};

/// A bridge function.
#[derive(Debug, PartialEq, Eq)]
pub struct Bridge {
    /// Its name.
    pub name: String,
    /// Its declaration, without the semicolon.
    pub prototype: String,
    /// What it returns: the comment before it.
    pub comment: String,
    /// The file that declares it.
    pub file: String,
    /// The toggle that it is declared under: it is needed where that is defined as 1.
    pub toggle: Option<String>,
}

/// The bridges of a library of paths and texts: of one that several files declare, the first declaration.
pub fn bridges(library: &[(&str, &str)]) -> Vec<Bridge> {
    let mut names = BTreeSet::new();
    let all = library.iter().flat_map(|(path, text)| bridges_of(path, text));
    all.filter(|bridge| names.insert(bridge.name.clone())).collect()
}

fn bridges_of(path: &str, text: &str) -> Vec<Bridge> {
    let mut found: Vec<Bridge> = vec![];
    let mut conditions: Vec<&str> = vec![];
    // What a bridge's comment says holds for those that follow it without one
    let mut comment: Vec<&str> = vec![];
    for line in text.lines() {
        if let Some(condition) = line.strip_prefix("#if") {
            conditions.push(condition);
        } else if line.starts_with("#endif") {
            conditions.pop();
        } else if let Some(words) = line.strip_prefix("//") {
            comment.push(words.trim());
            continue;
        } else if let Some(prototype) = line.strip_suffix(");")
            && let Some((returns, rest)) = prototype.split_once(" arealight_bridge_")
            && returns.chars().all(char::is_alphanumeric)
        {
            let name = rest.split('(').next().unwrap_or_default();
            found.push(Bridge {
                name: format!("arealight_bridge_{name}"),
                prototype: format!("{prototype})"),
                comment: comment.join(" "),
                file: path.to_owned(),
                toggle: conditions.iter().rev().find_map(|condition| toggle(condition)),
            });
        }
        comment.clear();
    }
    found
}

/// The name in ` NAME`, as `#if NAME` has it; include guards begin with `ndef`.
fn toggle(condition: &str) -> Option<String> {
    condition.strip_prefix(' ').map(|name| name.trim().to_owned())
}

/// For each header, the names of the bridges that a shader which includes it defines.
pub fn by_header(library: &[(&str, &str)]) -> BTreeMap<String, BTreeSet<String>> {
    let bridges = bridges(library);
    let texts: BTreeMap<&str, &str> =
        library.iter().filter_map(|(path, text)| Some((path.strip_prefix("include/")?, *text))).collect();
    let needed = |header: &str| {
        let (mut open, mut seen) = (vec![header], BTreeSet::new());
        while let Some(header) = open.pop() {
            if seen.insert(header) {
                let lines = texts.get(header).copied().unwrap_or_default().lines();
                open.extend(lines.filter_map(|line| line.strip_prefix("#include \"")?.strip_suffix('"')));
            }
        }
        let of_seen =
            |bridge: &&Bridge| bridge.file.strip_prefix("include/").is_some_and(|file| seen.contains(file));
        bridges.iter().filter(of_seen).map(|bridge| bridge.name.clone()).collect()
    };
    texts.keys().map(|header| ((*header).to_owned(), needed(header))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = "#ifndef ONE\n#define ONE\n// The host's\n// table.\nvec4 arealight_bridge_table(int \
    layer);\n\
        float arealight_one() {\n    return 2.0 * arealight_bridge_table(0);\n}\n#endif\n";
    const TWO: &str = "#ifndef TWO\n#include \"arealight/one.glsl\"\n#if AREALIGHT_IMAGES\n// An image.\n\
        vec3 arealight_bridge_image(uint layer);\n#endif\n#endif\n";
    const LIBRARY: [(&str, &str); 2] =
        [("include/arealight/one.glsl", ONE), ("include/arealight/two.glsl", TWO)];

    #[test]
    fn a_bridge_has_its_comment_and_toggle() {
        let found = bridges(&LIBRARY);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].prototype, "vec4 arealight_bridge_table(int layer)");
        assert_eq!((found[0].comment.as_str(), &found[0].toggle), ("The host's table.", &None));
        assert_eq!(found[1].name, "arealight_bridge_image");
        assert_eq!(found[1].toggle.as_deref(), Some("AREALIGHT_IMAGES"));
    }

    #[test]
    fn a_header_needs_what_its_includes_need() {
        let headers = by_header(&LIBRARY);
        assert_eq!(headers["arealight/one.glsl"].len(), 1);
        assert_eq!(headers["arealight/two.glsl"].len(), 2);
    }
}
