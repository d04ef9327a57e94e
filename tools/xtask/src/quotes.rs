//! `quotes`: the code that documents show is taken from files that are compiled and run, so that it cannot
//! rot.
//!
//! In a document, `<!-- from PATH -->` stands on the line before a fenced block that shows a file (from the
//! checkout's root), and `<!-- from PATH: NAME -->` before one that shows a part of it: the lines between a
//! comment `// doc: NAME` (or `# doc: NAME`) and the next `// doc end`, with their common indentation taken
//! away.

use crate::TaskError;
use std::path::{Path, PathBuf};

/// Documents, from the checkout's root; of a folder, every .md file in it.
const DOCUMENTS: [&str; 2] = ["README.md", "docs"];

const BEGIN: &str = "doc: ";
const END: &str = "doc end";

/// Put the code that documents quote into them, from the files that they name.
#[derive(clap::Args)]
pub struct Arguments {
    /// Write nothing; fail when a document does not show what is in the file.
    #[arg(long)]
    check: bool,
}

/// Whether every quotation was found, and with `--check` is as it should be.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    let (mut good, mut count) = (true, 0);
    for path in documents(root)? {
        let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
        let shown = path.strip_prefix(root).unwrap_or(&path).display();
        let quoted = match requote(&text, |name| std::fs::read_to_string(root.join(name)).ok()) {
            Ok(quoted) => quoted,
            Err(message) => {
                eprintln!("{shown}:{message}");
                good = false;
                continue;
            }
        };
        count += quoted.count;
        if quoted.text == text {
            continue;
        }
        if arguments.check {
            eprintln!("{shown}: error: shows other code than the files; run: cargo run -p xtask -- quotes");
            good = false;
        } else {
            std::fs::write(&path, quoted.text).map_err(TaskError::file(&path))?;
            println!("wrote {shown}");
        }
    }
    println!("{count} quotations of files in documents: {}", if good { "good" } else { "see above" });
    Ok(good && count > 0)
}

fn documents(root: &Path) -> Result<Vec<PathBuf>, TaskError> {
    let mut found = vec![];
    for name in DOCUMENTS {
        let path = root.join(name);
        if !path.is_dir() {
            found.push(path);
            continue;
        }
        for entry in std::fs::read_dir(&path).map_err(TaskError::file(&path))? {
            let entry = entry.map_err(TaskError::file(&path))?.path();
            if entry.extension().is_some_and(|extension| extension == "md") {
                found.push(entry);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// A document with its quotations renewed.
#[derive(Debug)]
struct Quoted {
    text: String,
    count: usize,
}

/// Renews the quotations of a document. The error is a place in it with what is wrong:
/// `LINE: error: MESSAGE`.
fn requote(document: &str, read: impl Fn(&str) -> Option<String>) -> Result<Quoted, String> {
    let mut quoted = Quoted { text: String::with_capacity(document.len()), count: 0 };
    let mut lines = document.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        quoted.text += line;
        quoted.text.push('\n');
        let Some(source) = line.strip_prefix("<!-- from ").and_then(|rest| rest.strip_suffix(" -->")) else {
            continue;
        };
        let wrong = |message: String| format!("{}: error: {message}", number + 1);
        // Keep the fence's first line, which says the language
        let Some((_, fence)) = lines.next().filter(|(_, line)| line.starts_with("```")) else {
            return Err(wrong("no fenced block on the next line".into()));
        };
        quoted.text += fence;
        quoted.text.push('\n');
        quoted.text += &excerpt(source, &read).map_err(wrong)?;
        quoted.text += "```\n";
        if !lines.by_ref().any(|(_, line)| line == "```") {
            return Err(format!("{}: error: the block does not end", number + 1));
        }
        quoted.count += 1;
    }
    Ok(quoted)
}

/// What `PATH` or `PATH: NAME` refers to.
fn excerpt(source: &str, read: impl Fn(&str) -> Option<String>) -> Result<String, String> {
    let (path, part) = source.split_once(": ").map_or((source, None), |(path, part)| (path, Some(part)));
    let text = read(path).ok_or_else(|| format!("cannot read {path}"))?;
    let comment = |line: &str| {
        let line = line.trim();
        line.strip_prefix("//").or_else(|| line.strip_prefix('#')).map_or("", str::trim_start).to_owned()
    };
    let is_mark = |line: &&str| comment(line).starts_with(BEGIN) || comment(line) == END;
    let lines: Vec<&str> = match part {
        None => text.lines().filter(|line| !is_mark(line)).collect(),
        Some(part) => {
            let mut lines = text.lines();
            let begins = |line: &str| comment(line).strip_prefix(BEGIN) == Some(part);
            if !lines.by_ref().any(begins) {
                return Err(format!("{path} has no line `// {BEGIN}{part}`"));
            }
            let taken: Vec<&str> = lines.by_ref().take_while(|line| comment(line) != END).collect();
            taken.into_iter().filter(|line| !is_mark(line)).collect()
        }
    };
    let indentation = |line: &&str| line.len() - line.trim_start().len();
    let common = lines.iter().filter(|line| !line.trim().is_empty()).map(indentation).min().unwrap_or(0);
    Ok(lines.iter().map(|line| line.get(common..).unwrap_or_default().to_owned() + "\n").collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "one\n    // doc: inner\n    two {\n        three\n    # doc end\nfour\n";

    fn read(path: &str) -> Option<String> {
        (path == "a.rs").then(|| SOURCE.to_owned())
    }

    #[test]
    fn files_and_parts_of_them_are_put_in() {
        let document =
            "before\n<!-- from a.rs -->\n```rust\nold\n```\n<!-- from a.rs: inner -->\n```\n```\nafter\n";
        let quoted = requote(document, read).unwrap();
        let expected = "before\n<!-- from a.rs -->\n```rust\none\n    two {\n        three\nfour\n```\n\
                        <!-- from a.rs: inner -->\n```\ntwo {\n    three\n```\nafter\n";
        assert_eq!((quoted.text.as_str(), quoted.count), (expected, 2));
        // What is renewed stays as it is
        assert_eq!(requote(expected, read).unwrap().text, expected);
    }

    #[test]
    fn what_is_not_there_is_named_with_its_line() {
        for (document, message) in [
            ("x\n<!-- from b.rs -->\n```\n```\n", "2: error: cannot read b.rs"),
            ("<!-- from a.rs: outer -->\n```\n```\n", "1: error: a.rs has no line `// doc: outer`"),
            ("<!-- from a.rs -->\ntext\n", "1: error: no fenced block on the next line"),
            ("<!-- from a.rs -->\n```\n", "1: error: the block does not end"),
        ] {
            assert_eq!(requote(document, read).unwrap_err(), message);
        }
    }

    #[test]
    fn a_document_that_differs_fails_the_check() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        std::fs::create_dir(folder.path().join("docs")).unwrap();
        file("a.rs", "new\n");
        file("README.md", "<!-- from a.rs -->\n```\nold\n```\n");
        assert!(!run(folder.path(), &Arguments { check: true }).unwrap());
        assert!(run(folder.path(), &Arguments { check: false }).unwrap());
        assert!(run(folder.path(), &Arguments { check: true }).unwrap());
        // Documents without a quotation are no success
        file("README.md", "nothing\n");
        assert!(!run(folder.path(), &Arguments { check: true }).unwrap());
    }
}
