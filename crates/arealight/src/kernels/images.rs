//! What one module makes of images of several kinds: a word or two for each that differs.

use crate::output::RadianceFormat;
use std::collections::HashSet;

// Instructions (the SPIR-V specification, 3.42)
const HEADER: usize = 5;
const TYPE_IMAGE: u32 = 25;
const LOAD: u32 = 61;
const IMAGE_FETCH: u32 = 95;

/// Makes every type of a storage image of rgba32f in a SPIR-V module one of `format`.
pub fn store_to(format: RadianceFormat, words: &mut [u32]) {
    const STORAGE: u32 = 2;
    const RGBA32F: u32 = 1;
    const RGBA16F: u32 = 2;
    if format == RadianceFormat::Rgba32Float {
        return;
    }
    each_instruction(words, |code, words| {
        if code == TYPE_IMAGE
            && let [_, _, _, _, _, _, _, STORAGE, format @ RGBA32F, ..] = words
        {
            *format = RGBA16F;
        }
    });
}

/// Makes a SPIR-V module of a kernel that reads a G-buffer read one of `samples` samples: where there are
/// several, the types of its images that are read by texel become those of multisampled images, and the level
/// of each read becomes the sample. The kernels read `g_buffer_sample` as their level, which is that.
pub fn read_samples(samples: u32, words: &mut [u32]) {
    const TWO_DIMENSIONS: u32 = 1;
    const READ: u32 = 1;
    const LEVEL: u32 = 0x2;
    const SAMPLE: u32 = 0x40;
    if samples <= 1 {
        return;
    }
    let (mut types, mut images) = (HashSet::new(), HashSet::new());
    each_instruction(words, |code, words| match (code, words) {
        (TYPE_IMAGE, [_, id, _, TWO_DIMENSIONS, _, 0, multisampled, READ, ..]) => {
            types.insert(*id);
            *multisampled = 1;
        }
        (LOAD, [_, of, id, ..]) if types.contains(of) => {
            images.insert(*id);
        }
        (IMAGE_FETCH, [_, _, _, image, _, operands @ LEVEL, ..]) if images.contains(image) => {
            *operands = SAMPLE;
        }
        _ => {}
    });
}

/// Visits each instruction with its opcode and its words; the first word holds opcode and word count.
fn each_instruction(words: &mut [u32], mut act: impl FnMut(u32, &mut [u32])) {
    let mut at = HEADER;
    while at < words.len() {
        let length = (words[at] >> 16).max(1) as usize;
        let end = (at + length).min(words.len());
        act(words[at] & 0xffff, &mut words[at..end]);
        at = end;
    }
}
