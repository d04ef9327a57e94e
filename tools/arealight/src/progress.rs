//! Progress bars: on the terminal's error stream, and silent where that is no terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of `length` steps of `unit`.
pub fn bar(length: u64, unit: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template(&format!("{{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"));
    ProgressBar::new(length).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
