//! Any bytes as two images of the published convention: the first half and the second.
#![no_main]

mod memory;

use arealight_table::{hash, read_published};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let (matrix, magnitude) = bytes.split_at(bytes.len() / 2);
    let read = || read_published(matrix, magnitude, "any");
    if let Ok(published) = memory::follows(bytes.len(), read) {
        let _ = hash(&published.table);
    }
    // One image for both: its size is right at once
    let _ = read_published(bytes, bytes, "any");
});
