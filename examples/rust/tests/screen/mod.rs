//! A screen that needs no monitor, and programs under the validation layer.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// An X server without a monitor, whose screen is a file. It ends when this is dropped.
pub struct Screen {
    server: Child,
    folder: tempfile::TempDir,
    /// Its name, for DISPLAY.
    pub display: String,
}

impl Screen {
    /// Starts it, of so many pixels. `None` where it is not installed, and nothing says that it must be.
    pub fn start([width, height]: [u32; 2]) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let started = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &format!("{width}x{height}x24"), "-fbdir"])
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
    pub fn look(&self) -> Vec<u8> {
        std::fs::read(self.folder.path().join("Xvfb_screen0")).unwrap()
    }

    /// Red, green and blue of its pixels, from a dump of version 7 with 32 bits a pixel, of a screen of so
    /// many.
    pub fn pixels(dump: &[u8], size: [u32; 2]) -> Vec<u8> {
        let field =
            |index: usize| u32::from_be_bytes(dump[4 * index..4 * index + 4].try_into().unwrap()) as usize;
        let [header, width, height, bits, row, colors] = [0, 4, 5, 11, 12, 19].map(field);
        assert_eq!([width as u32, height as u32, bits as u32], [size[0], size[1], 32]);
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

/// A program with the validation layer, which says what it finds on the standard output: messages of the
/// kinds `report`. `feature` is one of `VK_EXT_validation_features`, `setting` what newer layers call it.
pub fn under_validation(program: &str, folder: &Path, report: &str, feature: &str, setting: &str) -> Command {
    let settings = [
        "",
        "debug_action = VK_DBG_LAYER_ACTION_LOG_MSG",
        "log_filename = stdout",
        &format!("report_flags = {report}"),
        &format!("enables = VK_VALIDATION_FEATURE_ENABLE_{feature}_EXT"),
        &format!("{setting} = true"),
    ];
    std::fs::write(folder.join("vk_layer_settings.txt"), settings.join("\nkhronos_validation.")).unwrap();
    let mut command = Command::new(program);
    command
        .current_dir(folder)
        .env("VK_LAYER_SETTINGS_PATH", folder)
        .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::piped());
    command
}
