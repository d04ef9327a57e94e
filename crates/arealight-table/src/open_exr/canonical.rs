//! Equal tables make equal files.
//!
//! The `exr` crate keeps custom attributes in a hash map whose order changes from run to run. EXR does not
//! care for the order within a header, so the attributes are put in order after writing; no offset changes.

use std::ops::Range;

/// Magic number and version field.
const PREAMBLE: usize = 8;

/// Sorts the attributes of each header of a well-formed file of several layers by their bytes, that is, by
/// name. A file that is not well-formed is left as it is from there on.
pub fn sort_attributes(file: &mut [u8]) {
    let mut position = PREAMBLE;
    // Each header ends with a zero byte, and an empty header ends the list
    while let Some((attributes, end)) = header(file, position) {
        if let (Some(first), Some(last)) = (attributes.first(), attributes.last()) {
            let whole = first.start..last.end;
            let mut sorted: Vec<Vec<u8>> =
                attributes.iter().map(|range| file[range.clone()].to_vec()).collect();
            sorted.sort_unstable();
            file[whole].copy_from_slice(&sorted.concat());
        } else {
            return;
        }
        position = end;
    }
}

/// The byte ranges of the attributes of the header at `position`, and where the next header begins.
fn header(file: &[u8], mut position: usize) -> Option<(Vec<Range<usize>>, usize)> {
    let mut attributes = Vec::new();
    while *file.get(position)? != 0 {
        let start = position;
        // An attribute is a name and a type, each ended by a zero, the value's length, and the value
        position = after_zero(file, after_zero(file, position)?)?;
        let length = file.get(position..position + 4)?;
        let length = u32::from_le_bytes([length[0], length[1], length[2], length[3]]);
        position += 4 + length as usize;
        attributes.push(start..position);
    }
    Some((attributes, position + 1))
}

fn after_zero(file: &[u8], position: usize) -> Option<usize> {
    let length = file.get(position..)?.iter().position(|&byte| byte == 0)?;
    Some(position + length + 1)
}
