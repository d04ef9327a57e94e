//! What every benchmark that prints a table begins with.

use arealight_engine::host::{Host, HostOptions};

/// A device, and `rounds`; under `cargo test`, where a benchmark is only to be seen to run, one round. None,
/// and a word of it, where there is no device.
pub fn start(rounds: usize) -> Option<(Host, usize)> {
    let rounds = if std::env::args().any(|argument| argument == "--bench") { rounds } else { 1 };
    match Host::new(HostOptions::default()) {
        Ok(host) => Some((host, rounds)),
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    }
}
