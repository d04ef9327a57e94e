//! Progress on the error stream: a bar on a terminal; elsewhere, as in a log, a line now and then; nothing
//! with `--quiet`.

use crate::failure::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle, TermLike};
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// From now on there is no progress.
pub fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

static IS_VERBOSE: AtomicBool = AtomicBool::new(false);

/// From now on [`say`] says what it is given.
pub fn be_verbose() {
    IS_VERBOSE.store(true, Ordering::Relaxed);
}

/// Whether it does.
pub fn is_verbose() -> bool {
    IS_VERBOSE.load(Ordering::Relaxed)
}

/// With `--verbose`, writes a line to the error stream.
pub fn say(line: impl FnOnce() -> String) {
    if is_verbose() {
        crate::output::say(&line());
    }
}

/// The time until the first line of a log: what is done by then has none.
const FIRST: Duration = Duration::from_secs(10);
/// The time from line to line.
const EVERY: Duration = Duration::from_secs(30);

/// A bar of `length` steps of `unit`.
pub fn bar(length: u64, unit: &'static str) -> ProgressBar {
    let (template, target) = if IS_QUIET.load(Ordering::Relaxed) {
        (String::new(), ProgressDrawTarget::hidden())
    } else if io::stderr().is_terminal() {
        (format!("{{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"), ProgressDrawTarget::stderr())
    } else {
        let lines = Lines::new(FIRST, Box::new(io::stderr()));
        // As seldom as there is: a line is written still more seldom
        let target = ProgressDrawTarget::term_like_with_hz(Box::new(lines), 1);
        (format!("{{pos}} of {{len}} {unit}, {{elapsed}} of about {{duration}}"), target)
    };
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(length), target).with_style(style)
}

/// What work on a device finds, under a bar of `length` steps of `unit` that it tells of.
pub fn of<T, E: std::fmt::Display>(
    length: u64,
    unit: &'static str,
    work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> Result<T, E>,
) -> Result<T, Failure> {
    let bar = bar(length, unit);
    let found = work(&|count| bar.inc(count));
    bar.finish_and_clear();
    found.map_err(|error| Failure::Device(error.to_string()))
}

/// A log that takes a line now and then of those that it is given.
struct Lines {
    /// When the next line is due, and where it goes.
    next: Mutex<(Instant, Box<dyn Write + Send>)>,
}

impl Lines {
    fn new(first: Duration, log: Box<dyn Write + Send>) -> Self {
        Self { next: Mutex::new((Instant::now() + first, log)) }
    }

    fn say(&self, line: &str) -> io::Result<()> {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        let (due, log) = &mut *next;
        let now = Instant::now();
        if line.trim().is_empty() || now < *due {
            return Ok(());
        }
        *due = now + EVERY;
        writeln!(log, "{}", line.trim_end())
    }
}

impl std::fmt::Debug for Lines {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Lines").finish_non_exhaustive()
    }
}

impl TermLike for Lines {
    fn width(&self) -> u16 {
        100
    }
    fn move_cursor_up(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_down(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_right(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn move_cursor_left(&self, _: usize) -> io::Result<()> {
        Ok(())
    }
    fn write_line(&self, line: &str) -> io::Result<()> {
        self.say(line)
    }
    fn write_str(&self, line: &str) -> io::Result<()> {
        self.say(line)
    }
    fn clear_line(&self) -> io::Result<()> {
        Ok(())
    }
    fn flush(&self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// A log in memory.
    #[derive(Clone, Default)]
    struct Log(Arc<Mutex<Vec<u8>>>);

    impl Write for Log {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn said(first: Duration) -> String {
        let log = Log::default();
        let lines = Lines::new(first, Box::new(log.clone()));
        for line in ["", "1 of 3", "   ", "2 of 3"] {
            lines.write_str(line).unwrap();
        }
        String::from_utf8(log.0.lock().unwrap().clone()).unwrap()
    }

    #[test]
    fn a_log_gets_a_line_now_and_then() {
        assert_eq!(said(Duration::ZERO), "1 of 3\n");
        // The twin: what does not take long says nothing
        assert_eq!(said(FIRST), "");
    }

    #[test]
    fn a_bar_says_how_far_it_is_and_how_long_it_takes() {
        let log = Log::default();
        let target = ProgressDrawTarget::term_like_with_hz(
            Box::new(Lines::new(Duration::ZERO, Box::new(log.clone()))),
            1,
        );
        let style =
            ProgressStyle::with_template("{pos} of {len} steps, {elapsed} of about {duration}").unwrap();
        let bar = ProgressBar::with_draw_target(Some(8), target).with_style(style);
        bar.inc(2);
        bar.force_draw();
        let said = String::from_utf8(log.0.lock().unwrap().clone()).unwrap();
        assert!(said.contains(" of 8 steps, 0s of about "), "{said:?}");
        assert_eq!(said.lines().count(), 1);
    }
}
