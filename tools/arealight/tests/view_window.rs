//! The viewer in a window, on a screen of its own: a script of a minute, under the validation layer.

#[path = "../../../examples/rust/tests/screen/mod.rs"]
mod screen;

use screen::{Screen, under_validation};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [320, 200];

/// Every mode for seconds each, lamps and views that are dragged, until a minute is over.
const SCRIPT: &str = "
1  key h
3  key h
4  key 2
6  key 4
8  key 1
10 key w
14 press 0.5 0.5
16 move 0.2 0.5
16 release
18 key w
22 key w
24 key e
30 key e
32 press 0.5 0.95
38 move 0.9 0.7
38 release
40 key c
44 key c
46 key s
48 key ]
50 key r
54 wheel 3
60 key r
";

#[test]
fn a_minute_in_a_window_is_silent_and_shows_each_mode() {
    if arealight_engine::host::testing::device_with(arealight_engine::host::Validation::Off).is_none() {
        return;
    }
    let Some(screen) = Screen::start(SIZE) else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("script"), SCRIPT).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/sweep.glb");
    let program = env!("CARGO_BIN_EXE_arealight");
    let mut command =
        under_validation(program, folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
    command.arg("view").arg(scene).args(["--size", "320x200", "--script", "script"]);
    let mut running = command.env("DISPLAY", &screen.display).stderr(Stdio::piped()).spawn().unwrap();
    let (began, mut seen): (Instant, Vec<Vec<u8>>) = (Instant::now(), vec![]);
    while running.try_wait().unwrap().is_none() {
        let now = screen.look();
        if !seen.contains(&now) {
            seen.push(now);
        }
        std::thread::sleep(Duration::from_millis(200));
    }
    let output = running.wait_with_output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{err}");
    assert!(began.elapsed() >= Duration::from_secs(60));
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
    if arealight_engine::host::testing::device_with(arealight_engine::host::Validation::Off).is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_arealight");
    let mut command =
        under_validation(program, folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
    let output = command.arg("view").stderr(Stdio::piped()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("no window can be opened") && said.contains("--record"), "{said}");
}
