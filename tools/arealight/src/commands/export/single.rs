//! The GLSL library in one file, for people who paste.

use arealight::Effects;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// What is written as one file each: below `include/` in an export, and below `single/`.
pub const FILES: [&str; 2] = ["arealight/arealight.glsl", "arealight/self_test.glsl"];

/// The first line of what is pasted, in every language.
pub const LICENCE_LINE: &str = concat!(
    "// Arealight ",
    env!("CARGO_PKG_VERSION"),
    ", ",
    env!("CARGO_PKG_LICENSE"),
    ", as `arealight export` wrote it.\n"
);

/// The library in one file, with the options' defaults as these effects need them: a host may still define
/// its own.
pub fn resolved(mut text: String, effects: Effects) -> String {
    let kinds = [("LIGHT_TEXTURES", Effects::IMAGES), ("SHAPED", Effects::SHAPED)];
    let kinds = kinds.map(|(option, any)| (option.to_owned(), effects.intersects(any)));
    // What shows an image is a polygon, of four vertices too
    let effects = if effects.contains(Effects::TEXTURED) { effects | Effects::POLYGON } else { effects };
    let options = Effects::all().iter().map(|effect| (option_of(effect), effects.contains(effect)));
    for (option, is_on) in options.chain(kinds) {
        let define = |value: u8| format!("#define AREALIGHT_{option} {value}\n");
        text = text.replace(&define(u8::from(!is_on)), &define(u8::from(is_on)));
    }
    text
}

/// The option that switches an effect, or would: four need none.
fn option_of(effect: Effects) -> String {
    match effect.to_string().as_str() {
        "glossy" => "SPECULAR".into(),
        "ellipse" => "DISKS".into(),
        "mesh" => "MESHES".into(),
        "textured" => "TEXTURED_POLYGONS".into(),
        "textured_ellipse" => "TEXTURED_DISKS".into(),
        name @ ("polygon" | "sphere" | "tube" | "opening" | "profile" | "azimuth") => {
            name.to_uppercase() + "S"
        }
        name => name.to_uppercase(),
    }
}

/// The library's file of this name, after all that it includes, each once. What is included under options
/// alone is below any of these.
pub fn single(library: &[(&str, &str)], name: &str) -> String {
    let mut text = format!(
        "{LICENCE_LINE}// The library in one file: paste or include it. Define options before it, and the\n\
         // bridges after it: docs/embed-glsl.md. Call arealight_point and arealight_radiance; and, of\n\
         // self_test.glsl, arealight_self_test.\n",
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
    fn each_effect_switches_its_option() {
        let options =
            crate::commands::export::LIBRARY.iter().find(|(path, _)| path.ends_with("/options.glsl"));
        let text = |effects| resolved(options.unwrap().1.replace("\r\n", "\n"), effects);
        let without = text(Effects::empty());
        let idle = Effects::all().iter().filter(|effect| text(*effect) == without);
        let idle: Effects = idle.collect();
        let expected = Effects::SPECULAR_INPUT | Effects::TRANSMISSION | Effects::GLASS | Effects::LINKED;
        assert_eq!(idle, expected);
        let on = text(Effects::GLOSSY | Effects::TEXTURED);
        for line in ["SPECULAR 1", "DIFFUSE 0", "LIGHT_TEXTURES 1", "POLYGONS 1", "TEXTURED_DISKS 0"] {
            assert!(on.contains(&format!("#define AREALIGHT_{line}\n")), "{line}");
        }
    }

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
