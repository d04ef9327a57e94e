//! The program in a window, on a screen of its own: what is seen is what the engine draws, and the validation layer is silent.

use arealight_engine::host::testing::instance_or_skip;
use arealight_examples::command_line::FRAME_RATE;
use arealight_examples::deferred::Deferred;
use arealight_examples::gpu::{Gpu, Semaphores};
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// The program's own size, which the screen has too.
const SIZE: [u32; 2] = [640, 400];

const FRAMES: u32 = 6;

/// An X server without a monitor, whose screen is a file. It ends when this is dropped.
struct Screen {
    server: Child,
    folder: tempfile::TempDir,
    display: String,
}

impl Screen {
    /// Starts it. `None` where it is not installed, and nothing says that it must be.
    fn start() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let started = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &format!("{}x{}x24", SIZE[0], SIZE[1]), "-fbdir"])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match started {
            Ok(server) => server,
            Err(error) => {
                let required = std::env::var("AREALIGHT_REQUIRE_GPU").is_ok_and(|value| value == "1");
                assert!(!required, "AREALIGHT_REQUIRE_GPU=1, and Xvfb: {error} (tools/setup.sh window)");
                println!("skipped: Xvfb: {error}");
                return None;
            }
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        Some(Self { server, folder, display })
    }

    /// An X window dump of it.
    fn look(&self) -> Vec<u8> {
        std::fs::read(self.folder.path().join("Xvfb_screen0")).unwrap()
    }

    /// Red, green and blue of its pixels, from a dump of version 7 with 32 bits a pixel.
    fn pixels(dump: &[u8]) -> Vec<u8> {
        let field =
            |index: usize| u32::from_be_bytes(dump[4 * index..4 * index + 4].try_into().unwrap()) as usize;
        let [header, width, height, bits, row, colors] = [0, 4, 5, 11, 12, 19].map(field);
        assert_eq!([width as u32, height as u32, bits as u32], [SIZE[0], SIZE[1], 32]);
        let pixels = &dump[header + 12 * colors..];
        let rows = pixels.chunks_exact(row).take(height);
        rows.flat_map(|row| row[..4 * width].chunks_exact(4))
            .flat_map(|bgr| [bgr[2], bgr[1], bgr[0]])
            .collect()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // It has no work that matters
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The program with the validation layer, which says what it finds on the standard output: messages of the kinds `report`. `feature`
/// is one of `VK_EXT_validation_features`, `setting` what newer layers call it.
fn program(folder: &Path, report: &str, feature: &str, setting: &str) -> Command {
    let settings = [
        "",
        "debug_action = VK_DBG_LAYER_ACTION_LOG_MSG",
        "log_filename = stdout",
        &format!("report_flags = {report}"),
        &format!("enables = VK_VALIDATION_FEATURE_ENABLE_{feature}_EXT"),
        &format!("{setting} = true"),
    ];
    std::fs::write(folder.join("vk_layer_settings.txt"), settings.join("\nkhronos_validation.")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_deferred"));
    command
        .current_dir(folder)
        .env("VK_LAYER_SETTINGS_PATH", folder)
        .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::piped());
    command
}

/// The largest difference between two pictures, of a channel, in 255ths.
fn difference(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

#[test]
fn a_window_shows_what_the_engine_draws() {
    let Some(instance) = instance_or_skip() else { return };
    let Some(screen) = Screen::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut command = program(folder.path(), "error,warn", "SYNCHRONIZATION_VALIDATION", "validate_sync");
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

    // What was seen: some pictures are caught while the next is copied over them, so one of all must be a frame's
    let gpu = Gpu::new(&instance).unwrap();
    let mut engine = Deferred::new(&gpu, SIZE).unwrap();
    let frames = (0..FRAMES).map(|frame| {
        engine.frame(f64::from(frame) / FRAME_RATE, |_, _| Ok(Semaphores::default())).unwrap();
        engine.picture().unwrap().encoded()
    });
    let frames: Vec<_> = frames.collect();
    let nearest = |picture: &[u8]| frames.iter().map(|frame| difference(picture, frame)).min().unwrap();
    let best = seen.iter().map(|dump| nearest(&Screen::pixels(dump))).min().unwrap();
    // The device's pow may round to the other side of a half
    assert!(best <= 1, "{} pictures were seen, the nearest to a frame {best} away", seen.len());
    // The twin: frames differ by more than that
    assert!(frames.windows(2).all(|pair| difference(&pair[0], &pair[1]) > 10));
}

#[test]
fn without_a_display_it_saves_a_picture_and_says_so() {
    // Skipped where the other is
    let Some(_instance) = instance_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut command = program(folder.path(), "error,warn,perf", "BEST_PRACTICES", "validate_best_practices");
    let output = command.args(["--frames", "1"]).stderr(Stdio::piped()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.starts_with("There is no window (no display is open"), "{said}");
    assert_eq!(&std::fs::read(folder.path().join("deferred.png")).unwrap()[..4], b"\x89PNG");
    // The twin of the silence above: what the layer has to say is heard, such as of memory that is not shared
    let heard = String::from_utf8_lossy(&output.stdout);
    assert!(heard.contains("BestPractices") && heard.ends_with("deferred.png\n"), "{heard}");
}
