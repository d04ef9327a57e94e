//! The GLSL library in one file, for people who paste.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// What is written as one file each: below `include/` in an export, and below `single/`.
pub const FILES: [&str; 2] = ["arealight/arealight.glsl", "arealight/self_test.glsl"];

/// The library's file of this name, after all that it includes, each once. What is included under options
/// alone is below any of these.
pub fn single(library: &[(&str, &str)], name: &str) -> String {
    let mut text = format!(
        "// Arealight {}, {}. The library in one file, as `arealight export` wrote it: paste or include it.\n\
         // Define options before it, and the bridges after it: docs/embed-glsl.md.\n",
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_LICENSE"),
    );
    let mut found = Found { library, order: vec![], needed_by: BTreeMap::new() };
    found.visit(name, None);
    for name in &found.order {
        let options: Vec<&str> = found.needed_by[name].iter().filter_map(|option| *option).collect();
        let is_always = found.needed_by[name].contains(&None);
        if !is_always {
            let _ = write!(text, "\n#if {}", options.join(" || "));
        }
        text += "\n";
        let lines = found.source(name).lines().filter(|line| included(line).is_none());
        lines.for_each(|line| text.extend([line, "\n"]));
        text += if is_always { "" } else { "#endif\n" };
    }
    text
}

struct Found<'a> {
    library: &'a [(&'a str, &'a str)],
    /// Files after those that they include.
    order: Vec<&'a str>,
    /// The options that each is included under; none for what is whatever they are.
    needed_by: BTreeMap<&'a str, BTreeSet<Option<&'a str>>>,
}

impl<'a> Found<'a> {
    fn source(&self, name: &str) -> &'a str {
        let file = self.library.iter().find(|(path, _)| path.strip_prefix("include/") == Some(name));
        file.map_or("", |(_, source)| source)
    }

    fn visit(&mut self, name: &'a str, option: Option<&'a str>) {
        if !self.needed_by.entry(name).or_default().insert(option) {
            return;
        }
        let mut option = option;
        let outside = option;
        for line in self.source(name).lines() {
            option = match line.strip_prefix("#if ") {
                Some(condition) => Some(condition),
                None if line.starts_with("#endif") => outside,
                None => option,
            };
            if let Some(included) = included(line) {
                self.visit(included, option);
            }
        }
        if !self.order.contains(&name) {
            self.order.push(name);
        }
    }
}

/// The file that a line includes.
fn included(line: &str) -> Option<&str> {
    line.strip_prefix("#include \"")?.strip_suffix('"')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_there_once_below_any_option_that_needs_it() {
        let library = [
            (
                "include/a",
                "#ifndef A\n#include \"b\"\n#if X\n#include \"c\"\n#endif\n\
                 #if Y\n#include \"d\"\n#endif\nint a;\n#endif\n",
            ),
            ("include/b", "int b;\n"),
            ("include/c", "#include \"b\"\n#include \"e\"\nint c;\n"),
            ("include/d", "#include \"e\"\nint d;\n"),
            ("include/e", "int e;\n"),
        ];
        let text = single(&library, "a");
        let code: Vec<&str> =
            text.lines().filter(|line| !line.is_empty() && !line.starts_with("//")).collect();
        let expected = "int b;|#if X || Y|int e;|#endif|#if X|int c;|#endif|#if Y|int d;|#endif\
             |#ifndef A|#if X|#endif|#if Y|#endif|int a;|#endif";
        assert_eq!(code.join("|"), expected);
    }
}
