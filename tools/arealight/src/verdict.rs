//! Verdicts in colours, where they are shown on a terminal: what is broken in red, what is kept in green.
//!
//! `NO_COLOR`, `CLICOLOR` and `CLICOLOR_FORCE` are heeded as everywhere.

use anstream::{AutoStream, ColorChoice};
use std::io;

const RED: &str = "\x1b[1;31m";
const GREEN: &str = "\x1b[32m";
const YELLOW: &str = "\x1b[33m";
const PLAIN: &str = "\x1b[0m";

/// What verdicts begin with, and their colours.
const VERDICTS: [(&str, &str); 8] = [
    ("OUR PROMISES ARE BROKEN", RED),
    ("**BROKEN**", RED),
    ("BROKEN", RED),
    ("FAILED", RED),
    ("Every promise of ours is kept", GREEN),
    ("no row takes more than the file says", GREEN),
    ("kept", GREEN),
    ("better", YELLOW),
];

/// A report for standard output.
pub fn for_stdout(text: &str) -> String {
    painted(text, AutoStream::choice(&io::stdout()) != ColorChoice::Never)
}

/// A report for standard error.
pub fn for_stderr(text: &str) -> String {
    painted(text, AutoStream::choice(&io::stderr()) != ColorChoice::Never)
}

fn painted(text: &str, in_colours: bool) -> String {
    if !in_colours {
        return text.to_owned();
    }
    let (mut painted, mut rest) = (String::with_capacity(text.len()), text);
    while let Some((at, verdict, colour)) = first(rest) {
        let end = at + verdict.len();
        painted.extend([&rest[..at], colour, verdict, PLAIN]);
        rest = &rest[end..];
    }
    painted + rest
}

/// The first verdict in a text that is a word of its own: the longest of those that begin there.
fn first(text: &str) -> Option<(usize, &'static str, &'static str)> {
    let found = VERDICTS.iter().filter_map(|&(verdict, colour)| {
        let is_word = |&(at, _): &(usize, &str)| {
            let is_letter = |c: char| c.is_alphanumeric();
            !text[..at].ends_with(is_letter) && !text[at + verdict.len()..].starts_with(is_letter)
        };
        let (at, _) = text.match_indices(verdict).find(is_word)?;
        Some((at, verdict, colour))
    });
    found.min_by_key(|(at, verdict, _)| (*at, usize::MAX - verdict.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_have_colours_and_other_words_none() {
        let text = "a kept\nb BROKEN: not finite\nc unkept, BROKENLY\n";
        let expected =
            format!("a {GREEN}kept{PLAIN}\nb {RED}BROKEN{PLAIN}: not finite\nc unkept, BROKENLY\n");
        assert_eq!(painted(text, true), expected);
        assert_eq!(painted(text, false), text);
    }

    #[test]
    fn the_longest_verdict_counts() {
        let text = "Every promise of ours is kept.\nOUR PROMISES ARE BROKEN in 2 rows";
        let expected = format!(
            "{GREEN}Every promise of ours is kept{PLAIN}.\n{RED}OUR PROMISES ARE BROKEN{PLAIN} in 2 rows"
        );
        assert_eq!(painted(text, true), expected);
    }
}
