//! docs/architecture.md lists the places of a lobe, a kind of light and a layout, by one that is there: each
//! file of a list names it, and each file of the product that does is in the list.

use std::collections::BTreeSet;
use std::fs::{read_dir, read_to_string};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The files in the first column of the table after the line that begins a list.
fn listed(page: &str, word: &str) -> BTreeSet<String> {
    let heading = format!("The places of `{word}`:");
    let (_, list) = page.split_once(&heading).unwrap_or_else(|| panic!("the page has no '{heading}'"));
    let rows = list.trim_start().lines().take_while(|line| line.starts_with('|'));
    let files =
        rows.filter_map(|row| row.split('|').nth(1)).flat_map(|cell| cell.split('`').skip(1).step_by(2));
    files.map(str::to_owned).collect()
}

/// The text without comments, strings and unit tests, in small letters.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let without = |line: &str| {
        let line: String = line.split('"').step_by(2).collect();
        line.split("//").next().unwrap_or_default().to_lowercase()
    };
    text.lines().map(without).collect::<Vec<_>>().join("\n")
}

fn names(file: &str, word: &str) -> bool {
    read_to_string(root().join(file)).is_ok_and(|text| code(&text).contains(word))
}

/// Sources of the product, but for crates' lists of modules, examples, tests and what is generated.
fn product(folder: &str, found: &mut Vec<String>) {
    for entry in read_dir(root().join(folder)).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{folder}/{name}");
        if entry.file_type().unwrap().is_dir() {
            if !["tests", "examples", "target", "benches"].contains(&name.as_str()) {
                product(&path, found);
            }
        } else if [".rs", ".glsl", ".comp"].iter().any(|ending| name.ends_with(ending))
            && !["lib.rs", "tests.rs", "self_test.glsl"].contains(&name.as_str())
        {
            found.push(path);
        }
    }
}

#[test]
fn the_places_of_a_lobe_a_light_and_a_layout_are_those_of_the_page() {
    let page = read_to_string(root().join("docs/architecture.md")).unwrap();
    let mut files = vec![];
    product("crates", &mut files);
    product("shaders", &mut files);
    for word in ["sheen", "tube", "octahedral"] {
        let listed = listed(&page, word);
        let wrong: Vec<_> = listed.iter().filter(|file| !names(file, word)).collect();
        assert!(wrong.is_empty(), "files of the list that do not name '{word}': {wrong:#?}");
        let missing: Vec<_> =
            files.iter().filter(|file| names(file, word) && !listed.contains(*file)).collect();
        assert!(missing.is_empty(), "files that name '{word}' and are in no row: {missing:#?}");
    }
}

#[test]
fn a_file_that_names_nothing_is_found() {
    let page = "The places of `sheen`:\n\n| files | what |\n|---|---|\n| `a.rs`, `b.rs` | both |\n\n`c.rs`\n";
    assert!(listed(page, "sheen").into_iter().eq(["a.rs", "b.rs"]));
    assert!(!names("a.rs", "sheen") && !names("crates/arealight/src/tiles.rs", "sheen"));
    assert!(names("crates/arealight/src/effects.rs", "sheen"));
    assert_eq!(code("let Tube = \"sheen\"; // sheen\n#[cfg(test)]\nsheen"), "let tube = ; ");
}
