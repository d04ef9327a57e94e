//! Any bytes as an OpenEXR table.
#![no_main]

mod memory;

use arealight_table::{TableFile, Target};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(file) = memory::follows(bytes.len(), || TableFile::read(bytes)) {
        let again = file.write(Target::Exr).expect("what was read can be written");
        assert_eq!(TableFile::read(&again).expect("and read again"), file);
    }
});
