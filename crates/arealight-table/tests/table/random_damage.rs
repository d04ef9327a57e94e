//! Bytes changed at random: the readers may refuse or, where nothing that matters changed, accept. They may
//! not panic, hang, or allocate out of proportion. `AREALIGHT_DAMAGE_CASES` sets how many times each test
//! tries; the fuzz targets in `fuzz/` look deeper.

use arealight_table::{read, read_published, write};
use proptest::prelude::*;
use std::sync::LazyLock;

use crate::draft::{Draft, table, table_of_two};
use crate::textures::{self, targets};

/// Small, so that most changes hit the headers; EXR compressed and not, then the textures.
static FILES: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let mut draft = Draft::of(&table(2));
    draft.compression = exr::prelude::Compression::Uncompressed;
    let exr = [write(&table_of_two(2)), draft.write()];
    exr.into_iter().chain(targets().map(|target| textures::write(&table_of_two(2), target))).collect()
});

const COUNT: usize = 6;

/// Reads damaged bytes in every way.
fn read_all(file: &[u8]) {
    let _ = read(file);
    let _ = read_published(file, file, "");
}

fn cases() -> u32 {
    std::env::var("AREALIGHT_DAMAGE_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(4000)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases()) })]

    #[test]
    fn changed_bytes(
        which in 0..COUNT,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut file = FILES[which].clone();
        for (index, byte) in changes {
            let at = index.index(file.len());
            file[at] = byte;
        }
        read_all(&file);
    }

    #[test]
    fn extreme_words(
        which in 0..COUNT,
        index in any::<prop::sample::Index>(),
        word in prop::sample::select(vec![0_u32, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x0100_0000]),
    ) {
        let mut file = FILES[which].clone();
        let at = index.index(file.len() - 4);
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        read_all(&file);
    }

    #[test]
    fn pieces_removed_and_repeated(
        which in 0..COUNT,
        from in any::<prop::sample::Index>(),
        to in any::<prop::sample::Index>(),
        repeat in any::<bool>(),
    ) {
        let file = &FILES[which];
        let (a, b) = (from.index(file.len()), to.index(file.len()));
        let (a, b) = (a.min(b), a.max(b));
        let file = if repeat { [&file[..b], &file[a..]].concat() } else { [&file[..a], &file[b..]].concat() };
        read_all(&file);
    }

    #[test]
    fn anything_after_the_magic_number(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let exr = exr::meta::magic_number::BYTES;
        for start in [&[&exr[..], &[2, 0, 0, 0]].concat(), &[&exr[..], &[2, 16, 0, 0]].concat(),
            &ktx2::MAGIC[..], b"DDS "] {
            read_all(&[start, &bytes].concat());
        }
    }

    #[test]
    fn images_that_are_not_marked(
        code in prop::sample::select(vec![113_u32, 116, 0x3031_5844]),
        side in 0_u32..4,
        changes in prop::collection::vec((0_usize..36, any::<u32>()), 0..3),
        bytes in prop::collection::vec(any::<u8>(), 0..160),
    ) {
        let mut header = vec![0x2053_4444, 124, 0x100f, side, side, 0, 1, 1];
        header.extend([0; 11]);
        header.extend([32, 4, code, 0, 0, 0, 0, 0, 0x1000, 0, 0, 0, 0, 2, 3, 0, 1]);
        for (at, word) in changes {
            header[at] = word;
        }
        let header: Vec<u8> = header.iter().flat_map(|word: &u32| word.to_le_bytes()).collect();
        read_all(&[header, bytes].concat());
    }
}
