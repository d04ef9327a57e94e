//! The viewer in a window, on a screen of its own, under the validation layer.

#[path = "../../../../examples/rust/tests/screen/mod.rs"]
mod screen;

use crate::common::{device, refused, scene};
use screen::{Screen, under_validation};
use std::process::Stdio;
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [320, 200];

/// Every mode for a second each, lamps and views that are dragged.
const SCRIPT: &str = "
0.25 key h
0.75 press 0.3 0.2
0.75 release
1    key h
1    key 2
1.5  key 4
2    key 1
2.5  key w
3.5  press 0.5 0.5
4    move 0.2 0.5
4    release
4.5  key w
5.5  key w
6    key e
7.5  key e
8    press 0.5 0.95
9.5  move 0.9 0.7
9.5  release
10   key c
11   key c
11.5 key s
12   key ]
12.5 key r
13.5 wheel 3
15   key r
";

#[test]
fn a_window_is_silent_and_shows_each_mode() {
    let Some(()) = device() else { return };
    let Some(screen) = Screen::start(SIZE) else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("script"), SCRIPT).unwrap();
    let program = env!("CARGO_BIN_EXE_arealight");
    let mut command =
        under_validation(program, folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
    command.arg("view").arg(scene("sweep.glb")).args(["--size", "320x200", "--script", "script"]);
    let mut running = command.env("DISPLAY", &screen.display).stderr(Stdio::piped()).spawn().unwrap();
    let (began, mut seen): (Instant, Vec<Vec<u8>>) = (Instant::now(), vec![]);
    while running.try_wait().unwrap().is_none() {
        let now = screen.look();
        if !seen.contains(&now) {
            seen.push(now);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let output = running.wait_with_output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{err}");
    assert!(began.elapsed() >= Duration::from_secs(15));
    // Nothing else: the layer is silent
    let frames = out.strip_suffix(" frames were shown\n").and_then(|count| count.parse::<u32>().ok());
    assert!(frames.is_some_and(|frames| frames > 20), "{out}{err}");

    // Pictures of each mode were on the screen: the bar of the map of errors is in one of them, not in the
    // first
    let pictures: Vec<Vec<u8>> = seen.iter().map(|dump| Screen::pixels(dump, SIZE)).collect();
    assert!(pictures.len() > 12, "{} pictures were seen", pictures.len());
    let has_bar =
        |picture: &Vec<u8>| picture.chunks_exact(3).filter(|pixel| pixel == &[252, 253, 190]).count() > 20;
    assert!(pictures.iter().any(has_bar) && !has_bar(&pictures[0]));
}

#[test]
fn without_a_display_it_says_what_needs_none() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_arealight");
    let mut command =
        under_validation(program, folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
    let output = command.arg("view").stderr(Stdio::piped()).output().unwrap();
    refused(&output, 4, &["no window can be opened", "--record"]);
}
