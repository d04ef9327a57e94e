//! A table of what was found: as text for a terminal, as Markdown for the documents.

use std::fmt::Write as _;

/// Heads, and rows of cells, the first of each being a name.
pub(crate) struct Table {
    pub heads: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table of those heads, as a line of Markdown has them.
    pub fn new(heads: &str, rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        Self { heads: heads.split(" | ").map(str::to_owned).collect(), rows: rows.into_iter().collect() }
    }

    pub fn to_text(&self) -> String {
        let width = |column: usize| {
            let all = self.rows.iter().chain([&self.heads]);
            all.filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.heads.len()).map(width).collect();
        let mut text = String::new();
        for row in [&self.heads].into_iter().chain(&self.rows) {
            let mut line = String::from(" ");
            for (index, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let _ = if index == 0 {
                    write!(line, " {cell:<width$}")
                } else {
                    write!(line, "  {cell:>width$}")
                };
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }

    pub fn to_markdown(&self) -> String {
        let mut text = format!("| {} |\n|{}\n", self.heads.join(" | "), "---|".repeat(self.heads.len()));
        for row in &self.rows {
            let _ = writeln!(text, "| {} |", row.join(" | "));
        }
        text
    }
}
