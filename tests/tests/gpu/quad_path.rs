//! docs/architecture.md lists the functions that one quad light goes through: each is where the list says,
//! and what it calls is listed too.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const PAGE: &str = "docs/architecture.md";
/// The most files and functions that a reader has to follow.
const MOST_FILES: usize = 4;
const MOST_FUNCTIONS: usize = 12;
/// Functions of options that are off by default.
const OF_OPTIONS: [&str; 5] = [
    "arealight_cut_local",
    "arealight_far_quad_vector",
    "arealight_has_facet_form_factor",
    "arealight_facet_form_factor",
    "arealight_half_vectors_reflected",
];
/// What says which lobes there are and what an image adds: questions to others than the light.
const OF_OTHERS: [&str; 4] =
    ["arealight_has_lobe", "arealight_lobe_at", "arealight_lobe_albedo", "arealight_image_average"];

/// The names of functions in a text: words that begin with `arealight_`.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| word.starts_with("arealight_"))
}

/// Functions of the table in the page's section by file; and the functions that the text below it leaves out.
fn listed(page: &str) -> (BTreeMap<String, BTreeSet<String>>, BTreeSet<String>) {
    let (_, section) = page.split_once("## One quad light in GLSL").expect("the section");
    let (section, _) = section.split_once("\n## ").expect("its end");
    let mut by_file = BTreeMap::new();
    for row in section.lines().filter(|line| line.contains("shaders/include/")) {
        let Some((_, file)) = row.rsplit_once("(../") else { continue };
        let file = file.split(')').next().expect("a path").to_owned();
        let functions: BTreeSet<_> = names(row).map(str::to_owned).collect();
        if row.starts_with('|') {
            by_file.insert(file, functions);
        }
    }
    let (_, below) = section.split_once("Not in it is").expect("what is left out");
    (by_file, names(below).map(str::to_owned).collect())
}

/// The body of a function in a file or in its macro: all definitions of that name but those of another kind
/// of light.
fn body(source: &str, function: &str) -> Option<String> {
    let start = source.match_indices(&format!(" {function}(")).find(|(at, _)| {
        // A definition has a type before it, and is no call
        let line = source[..*at].rsplit('\n').next().unwrap_or("");
        let line = line.trim_start();
        !line.is_empty() && line.chars().all(|c| c.is_ascii_alphanumeric())
    })?;
    let rest = &source[start.0..];
    let mut depth = 0;
    let mut opened = false;
    for (at, c) in rest.char_indices() {
        match c {
            '{' => (depth, opened) = (depth + 1, true),
            '}' => depth -= 1,
            _ => {}
        }
        if opened && depth == 0 {
            return Some(rest[..at].to_owned());
        }
    }
    None
}

/// What is wrong with the list.
fn faults(page: &str, read: impl Fn(&str) -> String) -> Vec<String> {
    let (by_file, left_out) = listed(page);
    let functions: BTreeSet<_> = by_file.values().flatten().cloned().collect();
    let mut faults = vec![];
    if by_file.len() > MOST_FILES || functions.len() > MOST_FUNCTIONS {
        faults.push(format!("{} files and {} functions", by_file.len(), functions.len()));
    }
    for (file, of_file) in &by_file {
        let source = read(file);
        for function in of_file {
            let Some(body) = body(&source, function) else {
                faults.push(format!("{function} is not in {file}"));
                continue;
            };
            let called = names(&body).filter(|name| *name != function && body.contains(&format!("{name}(")));
            for name in called.filter(|name| !OF_OPTIONS.contains(name) && !OF_OTHERS.contains(name)) {
                if !functions.contains(name) && !left_out.contains(name) {
                    faults.push(format!("{function} calls {name}, which is not listed"));
                }
            }
        }
    }
    faults
}

#[test]
fn the_way_of_a_quad_is_as_short_as_the_page_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let read = |file: &str| {
        std::fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    };
    let page = read(PAGE);
    let found = faults(&page, read);
    assert!(found.is_empty(), "{PAGE}: {found:#?}");
    // The twin: a page that forgets a function, or names one that is not there
    assert!(!faults(&page.replace("`arealight_turned`", "`arealight_unit`"), read).is_empty());
    assert!(
        !faults(&page.replace("`arealight_turned`", "`arealight_turned`, `arealight_missing`"), read)
            .is_empty()
    );
}
