//! `--memory`: what the files that a command reads may take.

use crate::failure::Failure;
use crate::output;
use std::io::{self, Read};
use std::path::Path;
use std::sync::OnceLock;

static LIMIT: OnceLock<u64> = OnceLock::new();

/// From now on [`limit`] is this, if it is one.
pub fn be_within(limit: Option<u64>) {
    if let Some(limit) = limit {
        let _ = LIMIT.set(limit);
    }
}

/// The most that may be taken, in bytes, where somebody said so; else it follows the files
/// ([`arealight_scene::memory_of`]).
pub fn limit() -> Option<u64> {
    LIMIT.get().copied()
}

/// The most that may be taken where files hold `read` bytes.
pub fn most_of(read: u64) -> u64 {
    limit().unwrap_or_else(|| arealight_scene::memory_of(read))
}

/// Reads the value of `--memory`.
pub fn parse(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().last() {
        Some((end, 'k' | 'K')) => (&text[..end], 1 << 10),
        Some((end, 'm' | 'M')) => (&text[..end], 1 << 20),
        Some((end, 'g' | 'G')) => (&text[..end], 1 << 30),
        _ => (text, 1),
    };
    let bytes = digits.parse::<u64>().ok().and_then(|number| number.checked_mul(unit));
    bytes.ok_or_else(|| "a size is a number of bytes, for example 800M or 2G".to_owned())
}

/// The most that is read of what has no size, such as standard input, in bytes.
const STREAM: u64 = 64 << 20;

/// A file's text, or standard input's. A pipe or device could be endless.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let read = || {
        if output::is_stream(path) {
            return within(io::stdin().lock());
        }
        output::keep(path);
        let file = std::fs::File::open(path)?;
        let about = file.metadata()?;
        if about.is_file() { io::read_to_string(file) } else { within(file) }
    };
    read().map_err(|error| Failure::input(path, error))
}

fn within(stream: impl Read) -> io::Result<String> {
    let most = limit().unwrap_or(STREAM);
    let mut text = String::new();
    stream.take(most.saturating_add(1)).read_to_string(&mut text)?;
    if text.len() as u64 <= most {
        return Ok(text);
    }
    let message = format!("a stream of more than {most} bytes; --memory allows more");
    Err(io::Error::new(io::ErrorKind::FileTooLarge, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        let sizes = ["1024", "2K", "3m", "4G"].map(|text| parse(text).unwrap());
        assert_eq!(sizes, [1024, 2048, 3 << 20, 4 << 30]);
        for bad in ["", "G", "-1", "1.5G", "1e9", "99999999999G", "1é"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn an_endless_stream_is_refused() {
        let refused = within(io::repeat(b' ')).unwrap_err();
        assert!(refused.to_string().contains("more than 67108864 bytes"), "{refused}");
        assert_eq!(within(&b"some"[..]).unwrap(), "some");
    }
}
