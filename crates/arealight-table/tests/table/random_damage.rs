//! Bytes changed at random: the reader may refuse or, where nothing that matters changed, accept. It may not
//! panic, hang, or allocate out of proportion.

use arealight_table::{read, write};
use proptest::prelude::*;
use std::sync::LazyLock;

use crate::draft::{Draft, table};

/// Small, so that most changes hit the headers; one compressed, one not.
static FILES: LazyLock<[Vec<u8>; 2]> = LazyLock::new(|| {
    let mut draft = Draft::of(&table(2));
    draft.compression = exr::prelude::Compression::Uncompressed;
    [write(&table(2)), draft.write()]
});

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    #[test]
    fn changed_bytes(
        which in 0_usize..2,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut file = FILES[which].clone();
        for (index, byte) in changes {
            let at = index.index(file.len());
            file[at] = byte;
        }
        let _ = read(&file);
    }

    #[test]
    fn extreme_words(
        which in 0_usize..2,
        index in any::<prop::sample::Index>(),
        word in prop::sample::select(vec![0_u32, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x0100_0000]),
    ) {
        let mut file = FILES[which].clone();
        let at = index.index(file.len() - 4);
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        let _ = read(&file);
    }

    #[test]
    fn pieces_removed_and_repeated(
        which in 0_usize..2,
        from in any::<prop::sample::Index>(),
        to in any::<prop::sample::Index>(),
        repeat in any::<bool>(),
    ) {
        let file = &FILES[which];
        let (a, b) = (from.index(file.len()), to.index(file.len()));
        let (a, b) = (a.min(b), a.max(b));
        let file = if repeat { [&file[..b], &file[a..]].concat() } else { [&file[..a], &file[b..]].concat() };
        let _ = read(&file);
    }

    #[test]
    fn anything_after_the_magic_number(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&[&exr::meta::magic_number::BYTES[..], &[2, 0, 0, 0], &bytes].concat());
        let _ = read(&[&exr::meta::magic_number::BYTES[..], &[2, 16, 0, 0], &bytes].concat());
    }
}
