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
    /// The option that it is declared under, such as `AREALIGHT_LIGHT_TEXTURES 1`.
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
    // What a bridge's comment says holds for those that follow it without one
    let mut comment: Vec<&str> = vec![];
    for (line, toggle) in lines_under_toggles(text) {
        if let Some(words) = line.strip_prefix("//") {
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
                toggle,
            });
        }
        comment.clear();
    }
    found
}

/// Lines, each with the toggle that it is under: `NAME` of `#if NAME`; include guards begin with `#ifndef`.
fn lines_under_toggles(text: &str) -> impl Iterator<Item = (&str, Option<String>)> {
    let mut conditions: Vec<&str> = vec![];
    text.lines().map(move |line| {
        if let Some(condition) = line.strip_prefix("#if") {
            conditions.push(condition);
        } else if line.starts_with("#endif") {
            conditions.pop();
        }
        let toggle = conditions.iter().rev().find_map(|condition| condition.strip_prefix(' '));
        (line, toggle.map(|name| format!("{} 1", name.trim())))
    })
}

/// For each header, the bridges that a shader which includes it defines, each with the options that it is
/// needed with, any of them: `always`, or such as `AREALIGHT_POLYGONS 1`.
pub fn by_header(library: &[(&str, &str)]) -> BTreeMap<String, BTreeMap<String, BTreeSet<String>>> {
    let bridges = bridges(library);
    let texts: BTreeMap<&str, &str> =
        library.iter().filter_map(|(path, text)| Some((path.strip_prefix("include/")?, *text))).collect();
    let needed = |header: &str| {
        let mut needed: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        // Headers with what they are included under
        let (mut open, mut seen) = (vec![(header.to_owned(), BTreeSet::new())], BTreeSet::new());
        while let Some((header, toggles)) = open.pop() {
            if !seen.insert((header.clone(), toggles.clone())) {
                continue;
            }
            let with =
                |toggle: Option<String>| toggles.iter().cloned().chain(toggle).collect::<BTreeSet<_>>();
            let of_header = |bridge: &&Bridge| bridge.file.strip_prefix("include/") == Some(&header);
            for bridge in bridges.iter().filter(of_header) {
                let all = Vec::from_iter(with(bridge.toggle.clone())).join(" and ");
                let all = if all.is_empty() { "always".to_owned() } else { all };
                needed.entry(bridge.name.clone()).or_default().insert(all);
            }
            for (line, toggle) in lines_under_toggles(texts.get(&*header).copied().unwrap_or_default()) {
                let included = line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"'));
                open.extend(included.map(|included| (included.to_owned(), with(toggle))));
            }
        }
        for options in needed.values_mut().filter(|options| options.contains("always")) {
            options.retain(|option| option == "always");
        }
        needed
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
        assert_eq!(found[1].toggle.as_deref(), Some("AREALIGHT_IMAGES 1"));
    }

    #[test]
    fn a_header_needs_what_its_includes_need() {
        let kinds = "#if AREALIGHT_A\n#include \"arealight/two.glsl\"\n#endif\n";
        let headers = by_header(&[&LIBRARY[..], &[("include/kinds.glsl", kinds)]].concat());
        let needed = |header: &str, bridge: &str| headers[header][bridge].iter().cloned().collect::<String>();
        assert_eq!(headers["arealight/one.glsl"].len(), 1);
        assert_eq!(needed("arealight/two.glsl", "arealight_bridge_table"), "always");
        assert_eq!(needed("arealight/two.glsl", "arealight_bridge_image"), "AREALIGHT_IMAGES 1");
        assert_eq!(needed("kinds.glsl", "arealight_bridge_table"), "AREALIGHT_A 1");
        assert_eq!(needed("kinds.glsl", "arealight_bridge_image"), "AREALIGHT_A 1 and AREALIGHT_IMAGES 1");
    }
}
