//! `circles`: a module of a crate needs none that needs it, but for the parts that it is made of.

use crate::TaskError;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The crates that are looked at.
const CRATES: [&str; 3] = ["crates/arealight", "crates/arealight-vk", "tools/scene"];

/// The modules of a crate by their paths, such as `table::horizons`, and what each names.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Whether the crates' modules are free of circles.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let mut good = true;
    for name in CRATES {
        let source = root.join(name).join("src");
        let mut files = vec![];
        read(&source, "", &mut files)?;
        let found = circles(&arrows(&files));
        for circle in &found {
            eprintln!("{name}: error: a circle of modules: {}", circle.join(", "));
        }
        good &= found.is_empty() && !files.is_empty();
    }
    println!("circles of modules in {}: {}", CRATES.join(", "), if good { "none" } else { "see above" });
    Ok(good)
}

/// The modules of a folder, with their texts but for comments and tests.
fn read(folder: &Path, prefix: &str, files: &mut Vec<(String, String)>) -> Result<(), TaskError> {
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let module = if stem == "mod" { prefix.to_owned() } else { joined(prefix, stem) };
        if path.is_dir() {
            read(&path, &module, files)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") && module != "tests" {
            let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
            let module = if module == "lib" { String::new() } else { module };
            files.push((module, without_tests(&text)));
        }
    }
    Ok(())
}

fn joined(prefix: &str, name: &str) -> String {
    if prefix.is_empty() { name.to_owned() } else { format!("{prefix}::{name}") }
}

fn without_tests(text: &str) -> String {
    let tests = ["#[cfg(test)]\nmod ", "#[cfg(test)]\npub(crate) mod "];
    let end = tests.iter().filter_map(|start| text.find(start)).min().unwrap_or(text.len());
    let code = &text[..end];
    let lines = code.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// What each module names by `crate::` and `super::`, and its parts. A name that the crate's root passes on
/// counts as its module's; the root itself is no module.
fn arrows(files: &[(String, String)]) -> Arrows {
    let modules: BTreeSet<&str> = files.iter().map(|(module, _)| module.as_str()).collect();
    let root = files.iter().find(|(module, _)| module.is_empty()).map_or("", |(_, text)| text);
    let passed: BTreeMap<String, String> = root
        .split(';')
        .filter_map(|statement| statement.split_once("pub use ").or(statement.split_once("pub(crate) use ")))
        .flat_map(|(_, tree)| paths(tree))
        .filter_map(|path| {
            let path = path.trim_start_matches("self::").trim_start_matches("crate::").to_owned();
            Some((path.rsplit_once("::")?.1.to_owned(), path))
        })
        .collect();
    let module_of = |path: &str| -> Option<String> {
        let first = path.split("::").next().unwrap_or_default();
        let path = if modules.contains(first) { path } else { passed.get(first)? };
        let mut path = path.to_owned();
        while !modules.contains(path.as_str()) {
            path.truncate(path.rfind("::")?);
        }
        Some(path)
    };
    let mut arrows = Arrows::new();
    for (module, text) in files.iter().filter(|(module, _)| !module.is_empty()) {
        let parent = module.rsplit_once("::").map_or("", |(parent, _)| parent);
        let named = ["crate::", "super::"].into_iter().flat_map(|start| {
            let above = if start == "super::" { parent } else { "" };
            let trees = text.match_indices(start).flat_map(|(at, _)| paths(&text[at + start.len()..]));
            trees.map(|path| joined(above, &path)).collect::<Vec<_>>()
        });
        let to = named.filter_map(|path| module_of(&path)).filter(|to| to != module);
        arrows.entry(module.clone()).or_default().extend(to);
        if !parent.is_empty() {
            arrows.entry(parent.to_owned()).or_default().insert(module.clone());
        }
    }
    arrows
}

/// The paths that a tree such as `a::{b, c::D}` is of, as far as it goes.
fn paths(tree: &str) -> Vec<String> {
    let (mut found, mut path, mut above) = (vec![], String::new(), vec![]);
    for c in tree.chars() {
        match c {
            '{' if path.is_empty() || path.ends_with("::") => above.push(path.clone()),
            ',' | '}' if !above.is_empty() => {
                found.push(path);
                if c == '}' {
                    above.pop();
                }
                path = above.last().cloned().unwrap_or_default();
                if above.is_empty() {
                    return found;
                }
            }
            c if c.is_alphanumeric() || c == '_' || c == ':' => path.push(c),
            c if c.is_whitespace() && !above.is_empty() => {}
            _ => break,
        }
    }
    found.push(path);
    found
}

/// Sets of modules that lead to each other, but for a module with its own parts.
fn circles(arrows: &Arrows) -> Vec<Vec<String>> {
    let reached = |from: &String| -> BTreeSet<String> {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(module) = next.pop() {
            for to in arrows.get(&module).into_iter().flatten() {
                if seen.insert(to.clone()) {
                    next.push(to.clone());
                }
            }
        }
        seen
    };
    let all: BTreeMap<&String, BTreeSet<String>> = arrows.keys().map(|from| (from, reached(from))).collect();
    let mut found = BTreeSet::new();
    for (from, to) in all.iter().filter(|(from, to)| to.contains(**from)) {
        let circle = to.iter().filter(|module| all.get(module).is_some_and(|back| back.contains(*from)));
        found.insert(circle.cloned().collect::<Vec<_>>());
    }
    let is_part =
        |module: &String, whole: &String| module == whole || module.starts_with(&format!("{whole}::"));
    let of_one = |circle: &Vec<String>| circle.iter().all(|module| is_part(module, &circle[0]));
    found.into_iter().filter(|circle| !of_one(circle)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let files: Vec<_> =
            files.iter().map(|(name, text)| (name.to_string(), without_tests(text))).collect();
        circles(&arrows(&files))
    }

    #[test]
    fn circles_are_found_and_parts_are_none() {
        let part = ("a::part", "use super::A;");
        // One way, and a type with its parts
        assert!(found(&[("a", "use crate::b::B; mod part; use part::P;"), ("b", ""), part]).is_empty());
        // By lists, by what the root passes on, by a part, and by a path in a body
        for back in [
            "use crate::{\n    c::C,\n    a::{A, part},\n};",
            "use crate::A;",
            "use crate::a::part::P;", // which needs what it is a part of
            "fn f() { crate::a::f() }",
            "use super::a::A;",
        ] {
            let files =
                [("", "pub use a::{A, Other};"), ("a", "use crate::b::B;"), ("b", back), part, ("c", "")];
            assert_eq!(found(&files), [["a", "a::part", "b"]], "{back}");
        }
        // Three in a row; comments and tests do not count
        let three = [("a", "use crate::b;"), ("b", "use crate::c;"), ("c", "use crate::a;")];
        assert_eq!(found(&three), [["a", "b", "c"]]);
        let harmless = "// use crate::a;\n#[cfg(test)]\nmod tests { use crate::a; }";
        assert!(found(&[("a", "use crate::b;"), ("b", harmless)]).is_empty());
    }
}
