//! One module for both formats of radiance.

use crate::plan::RadianceFormat;

/// Makes every type of a storage image of rgba32f in a SPIR-V module one of `format`.
pub fn store_to(format: RadianceFormat, words: &mut [u32]) {
    const HEADER: usize = 5;
    const TYPE_IMAGE: u32 = 25;
    // Operands of OpTypeImage, and their values (the SPIR-V specification, 3.42.6 and 3.11)
    const SAMPLED: usize = 7;
    const FORMAT: usize = 8;
    const STORAGE: u32 = 2;
    const RGBA32F: u32 = 1;
    const RGBA16F: u32 = 2;
    if format == RadianceFormat::Rgba32Float {
        return;
    }
    let mut at = HEADER;
    while at < words.len() {
        let length = (words[at] >> 16).max(1) as usize;
        let instruction = words[at] & 0xffff;
        if instruction == TYPE_IMAGE
            && let Some([STORAGE, format @ RGBA32F]) = words.get_mut(at + SAMPLED..=at + FORMAT)
        {
            *format = RGBA16F;
        }
        at += length;
    }
}
