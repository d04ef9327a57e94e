//! Outputs are whole or not there, and what cannot be written is said before long work.

use crate::common::{device, printed, reference, refuse, refused, run, text};
use std::path::Path;
use std::process::{Command, Output};

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Runs the program under a limit of a shell's `ulimit`: `f`, blocks of a file, as on a full disk, or `t`,
/// seconds of processor time.
#[cfg(unix)]
fn limited(limit: &str, most: &str, folder: &Path, arguments: &[&str]) -> Output {
    let script = format!("trap '' XFSZ; ulimit -{limit} \"$1\"; shift; exec \"$@\"");
    Command::new("sh")
        .args(["-c", &script, "sh", most, env!("CARGO_BIN_EXE_arealight")])
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[cfg(unix)]
#[test]
fn where_the_disk_is_full_the_old_file_stays() {
    use std::os::unix::fs::PermissionsExt;
    let cases = reference("anisotropy.json");
    for (file, arguments) in [
        ("answers.json", vec!["eval", &cases, "--on", "oracle", "-o"]),
        ("table.ktx2", vec!["table", "convert", "built-in"]),
        ("lobes.png", vec!["inspect", "-o"]),
        ("fit.exr", vec!["fit", "--size", "8", "-o"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(file);
        let arguments = [&arguments[..], &[file]].concat();
        std::fs::write(&path, "old").unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();

        let limited = |most: &str| limited("f", most, folder.path(), &arguments);
        refused(&limited("1"), 5, &[&format!("{file}: cannot write")]);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old", "{file}");
        assert_eq!(names(folder.path()), [file]);

        // The twin: with room it is replaced, and keeps its permissions
        printed(&limited("unlimited"));
        let there = std::fs::metadata(&path).unwrap();
        assert!(there.len() > 512 && there.permissions().mode() & 0o777 == 0o640, "{file}");
        assert_eq!(names(folder.path()), [file]);
    }
}

#[cfg(unix)]
#[test]
fn a_path_that_cannot_be_written_is_said_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let cases = reference("anisotropy.json");
    for arguments in [
        &["bench", "--html", "missing/report.html"][..],
        &["bench", "--save", "missing/report.json"],
        &["bench", "stability", "--svg", "missing/chart.svg"],
        &["bench", "shadows", "--markdown", "missing/page.md"],
        &["fit", "-o", "missing/table.exr"],
        &["inspect", "--errors", "built-in", "-o", "missing/errors.png"],
        &["table", "convert", "built-in", "missing/table.ktx2"],
        &["eval", "--on", "truth", &cases, "-o", "missing/answers.json"],
        &["render", "-o", "missing/picture.png"],
    ] {
        // The work takes minutes
        println!("{arguments:?}");
        refused(&limited("t", "20", folder.path(), arguments), 5, &["missing/", "cannot write"]);
    }
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_name_that_is_no_format_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["inspect", "-o", "lobes.jpg"][..], ".png"),
        (&["render", "-o", "picture.bmp"], ".png or .exr"),
        (&["fit", "-o", "table.txt"], ".exr"),
    ] {
        refuse(folder.path(), arguments, 2, &[words]);
    }
    assert_eq!(names(folder.path()), [""; 0]);
}

#[cfg(unix)]
#[test]
fn what_is_interrupted_leaves_the_old_file() {
    use std::os::unix::process::ExitStatusExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    std::fs::write(&path, "old").unwrap();
    for signal in ["INT", "TERM"] {
        // Minutes of work
        let mut child = Command::new(env!("CARGO_BIN_EXE_arealight"))
            .args(["bench", "stability", "--samples", "1000000", "--save", "picture.exr"])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(1500));
        assert_eq!(child.try_wait().unwrap(), None, "it is at work still");
        Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        let ended = child.wait().unwrap();
        assert!(ended.signal().is_some() || ended.code().is_some_and(|code| code != 0), "{ended}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old", "{signal}");
        assert_eq!(names(folder.path()), ["picture.exr"], "{signal}");
    }
}

#[test]
fn a_picture_goes_through_a_pipe() {
    let Some(()) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["render", "--size", "32x18", "--supersample", "1", "-o", "-"]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    let picture = image::load_from_memory_with_format(&output.stdout, image::ImageFormat::Png).unwrap();
    assert_eq!((picture.width(), picture.height()), (32, 18));
    assert!(said.contains("picture  - (32x18"), "{said}");
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn the_page_of_results_is_made_of_the_files() {
    let there = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/results");
    let folder = tempfile::tempdir().unwrap();
    for name in names(&there).iter().filter(|name| *name != "README.md") {
        std::fs::copy(there.join(name), folder.path().join(name)).unwrap();
    }
    let page = || {
        printed(&run(folder.path(), &["bench", "results", "."]));
        std::fs::read_to_string(folder.path().join("README.md")).unwrap()
    };
    let checked_in = std::fs::read_to_string(there.join("README.md")).unwrap();
    assert!(page() == checked_in, "run `arealight bench results`");
    // The twins: of one file less it is another page, and of none there is no page
    std::fs::remove_file(folder.path().join("lavapipe.json")).unwrap();
    assert!(page() != checked_in);
    let empty = tempfile::tempdir().unwrap();
    let output = run(empty.path(), &["bench", "results", "."]);
    assert!(!output.status.success() && names(empty.path()).is_empty());
    assert!(text(&output.stderr).contains("arealight bench --save"));
}
