//! The program in a window, on a screen of its own: what is seen is what the engine draws, and the validation
//! layer is silent.

mod screen;

use arealight_examples::command_line::FRAME_RATE;
use arealight_examples::deferred::Deferred;
use arealight_examples::host_options;
use arealight_host::Semaphores;
use arealight_host::testing::device_of;
use screen::{Screen, under_validation};
use std::process::Stdio;

/// The program's own size, which the screen has too.
const SIZE: [u32; 2] = [640, 400];

const FRAMES: u32 = 6;

const PROGRAM: &str = env!("CARGO_BIN_EXE_deferred");

/// The largest difference between two pictures, of a channel, in 255ths.
fn difference(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

#[test]
fn a_window_shows_what_the_engine_draws() {
    let Some(host) = device_of(&host_options()) else { return };
    let Some(screen) = Screen::start(SIZE) else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut command =
        under_validation(PROGRAM, folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
    command.args(["--frames", &FRAMES.to_string()]).env("DISPLAY", &screen.display);
    let mut running = command.spawn().unwrap();
    let mut seen: Vec<Vec<u8>> = vec![];
    while running.try_wait().unwrap().is_none() {
        let now = screen.look();
        if seen.last() != Some(&now) {
            seen.push(now);
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let output = running.wait_with_output().unwrap();
    // Nothing else: the layer is silent
    assert_eq!(String::from_utf8_lossy(&output.stdout), format!("{FRAMES} frames were shown\n"));
    assert!(output.status.success());

    // What was seen: some pictures are caught while the next is copied over them, so one of all must be a
    // frame's
    let mut engine = Deferred::new(&host, SIZE).unwrap();
    let frames = (0..FRAMES).map(|frame| {
        engine.frame(f64::from(frame) / FRAME_RATE, |_| Ok(()), |(), _| Semaphores::default()).unwrap();
        engine.picture().unwrap().encoded()
    });
    let frames: Vec<_> = frames.collect();
    let nearest = |picture: &[u8]| frames.iter().map(|frame| difference(picture, frame)).min().unwrap();
    let best = seen.iter().map(|dump| nearest(&Screen::pixels(dump, SIZE))).min().unwrap();
    // The device's pow may round to the other side of a half
    assert!(best <= 1, "{} pictures were seen, the nearest to a frame {best} away", seen.len());
    // The twin: frames differ by more than that
    assert!(frames.windows(2).all(|pair| difference(&pair[0], &pair[1]) > 10));
}

#[test]
fn without_a_display_it_saves_a_picture_and_says_so() {
    // Skipped where the other is
    let Some(_host) = device_of(&host_options()) else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut command = under_validation(
        PROGRAM,
        folder.path(),
        "error,warn,perf",
        "BEST_PRACTICES",
        "validate_best_practices",
    );
    let output = command.args(["--frames", "1"]).stderr(Stdio::piped()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.starts_with("There is no window (no display is open"), "{said}");
    assert_eq!(&std::fs::read(folder.path().join("deferred.png")).unwrap()[..4], b"\x89PNG");
    // The twin of the silence above: what the layer has to say is heard, such as of memory that is not shared
    let heard = String::from_utf8_lossy(&output.stdout);
    assert!(heard.contains("BestPractices") && heard.ends_with("deferred.png\n"), "{heard}");
}
