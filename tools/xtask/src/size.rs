//! `size`: how much there is to read, and that no line is wider than a page.

use crate::TaskError;
use std::path::Path;
use std::process::Command;

/// The most lines of code: Rust, GLSL, Python, C++ and shell, without the generated header.
const MOST_LINES: usize = 129_895;
/// The most words of README.md and docs/, without tables that commands write.
const MOST_WORDS: usize = 42_230;
/// The most characters of a line of Rust, GLSL and Markdown.
const WIDTH: usize = 110;

const CODE: [&str; 12] = ["rs", "glsl", "comp", "frag", "vert", "py", "c", "cpp", "h", "hpp", "sh", "wgsl"];
const IS_NARROW: [&str; 6] = ["rs", "glsl", "comp", "frag", "vert", "md"];
/// Tables that commands write.
const DATA: [&str; 2] = ["docs/data/", "docs/results/"];
const GENERATED: &str = "crates/arealight-capi/include/arealight.h";

/// Whether the checkout keeps the limits.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let (mut lines, mut words, mut wide) = (0, 0, 0);
    for name in files(root)? {
        let path = root.join(&name);
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let is_data = DATA.iter().any(|folder| name.starts_with(folder));
        let is_code = CODE.contains(&ending) && name != GENERATED;
        // A file that git has may be deleted
        if !(is_code || ending == "md") || !path.exists() {
            continue;
        }
        let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
        if is_code {
            lines += text.lines().count();
        } else if name == "README.md" || name.starts_with("docs/") && !is_data {
            words += text.split_whitespace().count();
        }
        if IS_NARROW.contains(&ending) && !is_data {
            for (number, width) in wide_lines(&text, ending == "md") {
                eprintln!("{name}:{number}: error: {width} characters, at most {WIDTH}");
                wide += 1;
            }
        }
    }
    println!("{lines} lines of code, at most {MOST_LINES}; {words} words of documents, at most {MOST_WORDS}");
    let is_much = lines > MOST_LINES || words > MOST_WORDS;
    if is_much {
        eprintln!("error: there is too much (tools/xtask/src/size.rs says what)");
    }
    Ok(wide == 0 && !is_much && lines > 0 && words > 0)
}

/// What git has, or would add.
fn files(root: &Path) -> Result<Vec<String>, TaskError> {
    let mut command = Command::new("git");
    command.args(["ls-files", "--cached", "--others", "--exclude-standard"]).current_dir(root);
    let failed = |source| TaskError::Program { program: "git", package: "git", source };
    let output = command.output().map_err(failed)?;
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

/// The numbers and widths of lines that are too wide. Exceptions: tables; macros whose lines end in a
/// backslash; addresses in code; and in Markdown what links, formulas and fenced code are written in.
fn wide_lines(text: &str, is_markdown: bool) -> Vec<(usize, usize)> {
    let mut fenced = false;
    let mut wide = vec![];
    for (number, line) in (1..).zip(text.lines()) {
        let start = line.trim_start_matches(['/', '!', ' ']);
        fenced ^= is_markdown && start.starts_with("```");
        let is_free = start.starts_with('|')
            || if is_markdown {
                fenced || start.starts_with("$$") || line.contains("](")
            } else {
                line.ends_with('\\') || line.contains("://")
            };
        let width = line.chars().count();
        if width > WIDTH && !is_free {
            wide.push((number, width));
        }
    }
    wide
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_lines_are_found_but_for_the_exceptions() {
        let long = "x ".repeat(60);
        let fits = "²".repeat(WIDTH);
        let wide = |text: &str, is_markdown| wide_lines(text, is_markdown).len();
        for (text, markdown, code) in [
            (fits.clone(), 0, 0),
            (long.clone(), 1, 1),
            (format!("/// | {long}"), 0, 0),
            (format!("| {long}"), 0, 0),
            (format!("{long}\\"), 1, 0),
            (format!("// https://{long}"), 1, 0),
            (format!("[{long}](x.md)"), 0, 1),
            (format!("```\n{long}\n```"), 0, 1),
            (format!("```\n```\n{long}"), 1, 1),
        ] {
            assert_eq!([wide(&text, true), wide(&text, false)], [markdown, code], "{text}");
        }
    }
}
