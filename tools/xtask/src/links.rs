//! `links`: every link of a document leads to a file and a heading that are there, and every page of docs/ is
//! in docs/SUMMARY.md.

use crate::TaskError;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders that hold no documents of the project.
const SKIPPED: [&str; 4] = ["target", ".git", "out", "book"];

/// The table of contents of the site that mdBook makes of docs/.
const SUMMARY: &str = "docs/SUMMARY.md";

/// Whether all links lead somewhere, and the table of contents is whole.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let mut documents = vec![];
    find(root, &mut documents)?;
    documents.sort();
    let (mut good, mut count) = (true, 0);
    for path in &documents {
        let text = std::fs::read_to_string(path).map_err(TaskError::file(path))?;
        let shown = path.strip_prefix(root).unwrap_or(path).display();
        for link in links(&text) {
            count += 1;
            if let Some(wrong) = wrong(path, &text, &link) {
                eprintln!("{shown}: error: the link to {link} leads nowhere: {wrong}");
                good = false;
            }
        }
    }
    for missing in missing_pages(root, &documents)? {
        eprintln!("{SUMMARY}: error: {missing} is not in it");
        good = false;
    }
    println!("{count} links in {} documents: {}", documents.len(), if good { "good" } else { "see above" });
    Ok(good && count > 0)
}

/// The documents of a folder and those below it.
fn find(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), TaskError> {
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && !SKIPPED.contains(&name) {
            find(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
    Ok(())
}

/// A document's lines outside of fenced blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut fenced = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        fenced ^= is_fence;
        !fenced && !is_fence
    })
}

/// The targets of a document's links and pictures that are no addresses.
fn links(text: &str) -> Vec<String> {
    let targets = |line: &str| -> Vec<String> {
        let ends = line.match_indices("](").filter_map(|(at, _)| line[at + 2..].split([')', ' ']).next());
        ends.map(str::to_owned).collect()
    };
    let is_address = |link: &String| link.contains("://") || link.starts_with("mailto:");
    prose(text).flat_map(targets).filter(|link| !link.is_empty() && !is_address(link)).collect()
}

/// What is wrong with a link.
fn wrong(document: &Path, text: &str, link: &str) -> Option<String> {
    let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
    let target = document.parent()?.join(file);
    if !file.is_empty() && !target.exists() {
        return Some("there is no such file".to_owned());
    }
    let heading = heading?;
    let there = if file.is_empty() { text.to_owned() } else { std::fs::read_to_string(&target).ok()? };
    (!headings(&there).contains(heading)).then(|| format!("there is no heading #{heading}"))
}

/// A document's headings as GitHub names them: lower case, without punctuation, hyphens for spaces.
fn headings(text: &str) -> BTreeSet<String> {
    let slug = |heading: &str| -> String {
        let kept = heading.trim().to_lowercase();
        let kept = kept.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    prose(text).filter(|line| line.starts_with('#')).map(|line| slug(line.trim_start_matches('#'))).collect()
}

/// The pages of docs/ that its table of contents lacks.
fn missing_pages(root: &Path, documents: &[PathBuf]) -> Result<Vec<String>, TaskError> {
    let summary = root.join(SUMMARY);
    let text = std::fs::read_to_string(&summary).map_err(TaskError::file(&summary))?;
    let listed: BTreeSet<String> = links(&text).into_iter().collect();
    let folder = root.join("docs");
    let pages = documents.iter().filter_map(|path| path.strip_prefix(&folder).ok());
    let pages = pages.map(|page| page.display().to_string()).filter(|page| page != "SUMMARY.md");
    Ok(pages.filter(|page| !listed.contains(page)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_nowhere_and_what_is_not_listed_fails() {
        let folder = tempfile::tempdir().unwrap();
        let docs = folder.path().join("docs");
        std::fs::create_dir(&docs).unwrap();
        let file = |name: &str, text: &str| std::fs::write(docs.join(name), text).unwrap();
        let check = || run(folder.path()).unwrap();
        file("SUMMARY.md", "- [a](a.md)\n");
        file("a.md", "# A, and *b*\n[x](#a-and-b) [y](https://example.org/z)\n```\n[n](nowhere.md)\n```\n");
        assert!(check());
        for wrong in ["[x](b.md)", "[x](#a)", "[x](SUMMARY.md#a)", "![x](b.png)"] {
            file("a.md", wrong);
            assert!(!check(), "{wrong}");
        }
        file("a.md", "none\n");
        assert!(check());
        file("c.md", "none\n");
        assert!(!check());
    }
}
