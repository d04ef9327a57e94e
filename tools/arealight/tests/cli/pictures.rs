//! `arealight bench pictures`: one of each kind, of a few pixels.

use crate::common::{device, refuse, run, scene, text};

#[test]
fn a_strip_and_a_film_are_made_again() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let sweep = scene("sweep.glb");
    let make = |file: &str, options: &[&str]| {
        let common = ["bench", "pictures", &sweep, "-o", file, "--size", "32x18", "--samples", "4"];
        let output = run(folder.path(), &[&common, options].concat());
        let said = text(&output.stderr);
        assert!(output.status.success() && said.contains(&format!("wrote {file}")), "{said}");
        std::fs::read(folder.path().join(file)).unwrap()
    };
    // Three pictures of 32 x 18 above two maps, each below a line of text, or five rows of 32 x 4
    let strip = image::load_from_memory(&make("strip.png", &[])).unwrap().to_rgb8();
    assert_eq!(strip.dimensions(), (3 * 40 + 8, 2 * 42 + 8));
    let rows = image::load_from_memory(&make("rows.png", &["--crop", "0,7,32,4"])).unwrap();
    assert_eq!((rows.width(), rows.height()), (48, 5 * 28 + 8 + 24));
    // Ours and the truth are alike, and not the same
    let pixels = |left: u32| (24..42).flat_map(move |y| (0..32).map(move |x| (left + x, y)));
    let differ = pixels(8).zip(pixels(8 + 2 * 40));
    let apart: u32 = differ
        .map(|(a, b)| u32::from(strip.get_pixel(a.0, a.1)[0].abs_diff(strip.get_pixel(b.0, b.1)[0])))
        .sum();
    assert!(apart > 0 && apart < 32 * 18 * 32, "{apart}");

    let film = make("film.gif", &["--frames", "3", "--swing", "60"]);
    let mut film = gif::DecodeOptions::new().read_info(film.as_slice()).unwrap();
    let mut frames = vec![];
    while let Some(frame) = film.read_next_frame().unwrap() {
        frames.push(frame.buffer.to_vec());
    }
    assert_eq!((film.width(), film.height(), frames.len()), (68, 36, 3));
    // What does not move is not written again
    let written = |frame: &[u8]| frame.iter().filter(|index| **index != 127).count();
    assert!(written(&frames[1]) > 0 && written(&frames[1]) < written(&frames[0]));
}

#[test]
fn what_cannot_be_shown_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = scene("sweep.glb");
    let refused = |options: &[&str], code: i32, words: &str| {
        refuse(folder.path(), &[&["bench", "pictures", &sweep], options].concat(), code, &[words]);
    };
    refused(&["-o", "strip.jpg"], 2, "must end in .png or .gif");
    refused(&["-o", "a.png", "--crop", "300,0,32,8"], 2, "300,0,32,8 reaches out of a picture of 320x180");
    refused(&["-o", "nowhere/strip.png"], 5, "cannot write");
}
