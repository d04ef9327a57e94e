//! `arealight render --frames`: pictures of times that follow each other.

use crate::common::{device, difference, json_of, picture, printed, run, scene};
use std::path::Path;

/// Renders the cinema into a folder. What was said.
fn render(folder: &Path, options: &[&str]) -> String {
    let common = ["render", &scene("cinema.glb"), "--size", "48x27", "--supersample", "1"];
    printed(&run(folder, &[&common, options].concat()))
}

#[test]
fn a_films_pictures_are_those_of_their_times() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let film = ["--frames", "3", "--rate", "2", "--time", "0.25", "--shadows", "off"];
    let said = render(path, &[&film[..], &["-o", "f.png"]].concat());
    assert!(said.contains("f-0000.png, 3 in all"), "{said}");
    for (index, time) in ["0.25", "0.75", "1.25"].into_iter().enumerate() {
        render(path, &["--time", time, "--shadows", "off", "-o", "one.png"]);
        assert_eq!(picture(path, &format!("f-000{index}.png")), picture(path, "one.png"), "{time}");
    }
    assert!(!path.join("f-0003.png").exists());
    // The twin: they differ, where nothing but the picture on the screen moves
    let [first, last] = ["f-0000.png", "f-0002.png"].map(|name| picture(path, name));
    assert!(difference(&first, &last) > 0.2);

    render(path, &[&film[..], &["-o", "f.gif"]].concat());
    let bytes = std::fs::read(path.join("f.gif")).unwrap();
    let mut gif = gif::DecodeOptions::new().read_info(bytes.as_slice()).unwrap();
    let delay = gif.read_next_frame().unwrap().unwrap().delay;
    let more = (0..9).take_while(|_| gif.read_next_frame().unwrap().is_some()).count();
    assert_eq!((gif.width(), gif.height(), delay, more), (48, 27, 50, 2));
}

#[test]
fn a_films_shadows_have_less_noise_than_a_pictures() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // At rest: the time hardly goes on
    let still = ["--time", "1", "--rate", "240"];
    render(path, &[&still[..2], &["--shadow-noise", "0.2", "--seed", "70", "-o", "truth.exr"]].concat());
    let noise = |name: &str| {
        let found = json_of(&run(path, &["compare", name, "truth.exr", "--json"]));
        found["rmse_over_mean"].as_f64().unwrap()
    };
    let film = |history: &[&str], name: &str| {
        let eight = ["--frames", "8", "--shadows", "filtered:1", "-o", name];
        render(path, &[&still[..], &eight, history].concat());
    };
    film(&[], "film.exr");
    let (first, last) = (noise("film-0000.exr"), noise("film-0007.exr"));
    assert!(last < 0.8 * first, "{first}, {last}");
    // The twin: pictures that converge by themselves do not go on from each other
    film(&["--shadow-noise", "100"], "alone.exr");
    let (first, last) = (noise("alone-0000.exr"), noise("alone-0007.exr"));
    assert!(last > 0.8 * first, "{first}, {last}");
}
