//! Outputs are whole or not there, and what cannot be written is said before long work.

mod common;

use common::run;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

fn cases() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/data/reference/anisotropy.json")
        .to_str()
        .expect("a path in UTF-8")
        .to_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[cfg(unix)]
#[test]
fn where_the_disk_is_full_the_old_file_stays() {
    let folder = tempfile::tempdir().unwrap();
    let answers = folder.path().join("answers.json");
    std::fs::write(&answers, "old").unwrap();
    // Files of more than a block are refused, as by a full disk
    let limited = |limit: &str| {
        let script =
            format!("trap '' XFSZ; ulimit -f {limit}; exec \"$0\" eval --on oracle \"$1\" -o answers.json");
        Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_arealight"), &cases()])
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let refused = limited("1");
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(5), "{said}");
    assert!(said.contains("answers.json: cannot write"), "{said}");
    assert_eq!(std::fs::read_to_string(&answers).unwrap(), "old");
    assert_eq!(names(folder.path()), ["answers.json"]);
    // The twin: with room it is replaced
    assert_eq!(limited("unlimited").status.code(), Some(0));
    assert!(std::fs::read_to_string(&answers).unwrap().len() > 1000);
    assert_eq!(names(folder.path()), ["answers.json"]);
}

#[test]
fn a_path_that_cannot_be_written_is_said_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let cases = cases();
    for arguments in [
        &["bench", "--html", "missing/report.html"][..],
        &["bench", "--json", "missing/report.json"],
        &["bench", "stability", "--svg", "missing/chart.svg"],
        &["bench", "shadows", "--markdown", "missing/page.md"],
        &["fit", "-o", "missing/table.exr"],
        &["inspect", "--errors", "built-in", "-o", "missing/errors.png"],
        &["table", "convert", "built-in", "missing/table.ktx2"],
        &["eval", "--on", "truth", &cases, "-o", "missing/answers.json"],
        &["render", "-o", "missing/picture.png"],
    ] {
        let start = Instant::now();
        let refused = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(5), "{arguments:?}: {said}");
        assert!(said.contains("missing/") && said.contains("cannot write"), "{arguments:?}: {said}");
        // The work takes minutes; a busy machine may take seconds to start a program
        assert!(start.elapsed().as_secs() < 20, "{arguments:?}");
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
        let refused = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert_eq!(names(folder.path()), [""; 0]);
}
