//! `arealight bench compiled`, and null hardware, which computes nothing.

use crate::common::{reference, run, scene, text};
use arealight_engine::host::testing::{radv_or_skip, ran, skip};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The exit code where there is no compiler, or not the one of the file.
const NO_COMPILER: i32 = 6;

fn checked_in() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/data/compiled.json")
}

fn said(output: &Output) -> String {
    text(&output.stdout) + &text(&output.stderr)
}

/// Asserts that a run ended with `code` and said all of `words`.
#[track_caller]
fn ends(output: &Output, code: i32, words: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
}

/// Compiles for a family with these arguments.
fn compile(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&["bench", "compiled"], arguments].concat())
}

/// Compiles the rows that contain `only`, and holds them against a file.
fn check(only: &str, file: &Path) -> Output {
    compile(&["--only", only, "--check", &file.display().to_string()])
}

/// Whether the compiler is the file's; where there is none or another, the test is skipped, unless a device
/// is required.
fn is_compared(output: &Output) -> bool {
    if output.status.code() == Some(NO_COMPILER) {
        skip(&said(output));
        return false;
    }
    ran();
    true
}

#[test]
fn no_row_takes_more_than_the_file_says() {
    if radv_or_skip().is_none() {
        return;
    }
    // AREALIGHT_LONG=1: all of the file's. Otherwise one Radeon, and one of Intel's where its compiler is
    let families = match std::env::var_os("AREALIGHT_COMPILERS") {
        _ if std::env::var("AREALIGHT_LONG").is_ok_and(|value| value == "1") => "all",
        Some(_) => "navi21,tgl",
        None => "navi21",
    };
    let output = compile(&["--family", families, "--check", &checked_in().display().to_string()]);
    if !is_compared(&output) {
        return;
    }
    println!("{}", said(&output));
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("rows compared: no row takes more than the file says"));
}

#[test]
fn a_file_of_less_fails() {
    if radv_or_skip().is_none() {
        return;
    }
    let only = "texture_load";
    if !is_compared(&check(only, &checked_in())) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("compiled.json");
    let text = std::fs::read_to_string(checked_in()).unwrap();
    let doctored = |change: &dyn Fn(&mut serde_json::Map<String, serde_json::Value>) -> bool| {
        let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
        for family in value["families"].as_array_mut().unwrap() {
            let rows = family["rows"].as_array_mut().unwrap();
            rows.retain_mut(|row| change(row.as_object_mut().unwrap()));
        }
        std::fs::write(&file, value.to_string()).unwrap();
        check(only, &file)
    };
    let less = |name: &'static str, part: f64| {
        move |row: &mut serde_json::Map<String, serde_json::Value>| {
            // Of the Radeons, whose words these are
            if let Some(number) = row["said"][name].as_f64() {
                row["said"][name] = serde_json::json!((number * part) as u64);
            }
            true
        }
    };

    // The twin of all that follow: the same numbers
    assert!(doctored(&|_| true).status.success());
    for (name, part) in [("VGPRs", 0.99), ("Inverse Throughput", 0.96)] {
        let output = doctored(&less(name, part));
        ends(&output, 1, &["FAILED: "]);
    }
    // Within 3 %
    assert!(doctored(&less("Inverse Throughput", 0.98)).status.success());

    // More than what is found: better, and it says how to keep that
    let output = doctored(&less("VGPRs", 2.0));
    assert!(output.status.success() && said(&output).contains("better: VGPRs"), "{}", said(&output));
    assert!(said(&output).contains("arealight bench compiled --family all --update"));

    // A row that is not there
    let output = doctored(&|row| row["kernel"] != "texture_load");
    ends(&output, 1, &["the file has no such row", "--update"]);

    // Another version of the driver is no comparison
    std::fs::write(&file, text.replace("Mesa", "Mesa 0.")).unwrap();
    let output = check(only, &file);
    ends(&output, NO_COMPILER, &["can't be compared"]);
}

#[test]
fn what_cannot_be_compiled_is_said() {
    let output = compile(&["--only", "nothing like this"]);
    ends(&output, 2, &["--only", "shade: quads, exact"]);
    ends(&compile(&["--family", "navi21;reboot"]), 2, &[]);
    ends(&compile(&["--check", "/nonexistent/compiled.json"]), 3, &[]);
    if std::env::var_os("AREALIGHT_COMPILERS").is_none() {
        ends(&compile(&["--family", "tgl"]), NO_COMPILER, &["tools/compilers.sh"]);
    }
    ends(&compile(&["--device", "no such device", "--only", "texture_load"]), 4, &[]);

    if radv_or_skip().is_none() {
        return;
    }
    ran();
    let output = compile(&["--family", "navi9000", "--only", "texture_load"]);
    ends(&output, 2, &["no family of GPU 'navi9000'"]);
    ends(&compile(&["--only", "texture_load", "--save", "/nonexistent/compiled.json"]), 5, &[]);
}

#[test]
fn without_the_driver_the_message_says_what_to_install() {
    if Path::new("/etc/vulkan/icd.d").exists() {
        return; // The loader's folder that no variable moves
    }
    let output = Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(["bench", "compiled"])
        .env("XDG_DATA_DIRS", "/nonexistent")
        .env_remove("VK_DRIVER_FILES")
        .env_remove("VK_ICD_FILENAMES")
        .output()
        .unwrap();
    ends(&output, NO_COMPILER, &["apt-get install mesa-vulkan-drivers"]);
}

#[test]
fn null_hardware_is_listed_and_never_used() {
    let Some(driver) = radv_or_skip() else { return };
    ran();
    let folder = tempfile::tempdir().unwrap();
    let on_null = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arealight"));
        command.args(arguments).current_dir(folder.path());
        driver.set_environment(&mut command);
        command.output().unwrap()
    };
    // Its name says which chip it is; another's statistics are not taken for it
    for (chip, code) in [("navi21", 0), ("vega10", 2)] {
        let output = on_null(&["bench", "compiled", "--only", "texture_load", "--on-null-hardware", chip]);
        ends(&output, code, &[]);
    }
    let words = "Null hardware (RADV NAVI21): cannot be used: it compiles shaders";
    ends(&on_null(&["devices"]), 4, &[words]);

    let (scene, cases) = (scene("sweep.glb"), reference("cases.json"));
    let render: &[&str] = &["render", &scene, "--size", "16x16", "-o", "picture.png"];
    for arguments in [
        render,
        &[render, &["--device", "null"]].concat(),
        &[render, &["--device", "0"]].concat(),
        &["eval", &cases],
        &["bench", "stability", "--samples", "1"],
    ] {
        println!("{arguments:?}");
        ends(&on_null(arguments), 4, &["Null hardware", "runs none"]);
    }
    assert!(!folder.path().join("picture.png").exists());
}

#[test]
fn a_device_that_computes_is_taken_before_null_hardware() {
    let Some(_) = radv_or_skip() else { return };
    // RADV's null hardware and whatever else is installed
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arealight"));
        command.args(arguments).env("RADV_FORCE_FAMILY", "navi21");
        command.env_remove("VK_DRIVER_FILES").env_remove("VK_ICD_FILENAMES").output().unwrap()
    };
    let output = run(&["devices", "--json"]);
    let listed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    let of_null = |null: bool| {
        let devices = listed.as_array().cloned().unwrap_or_default();
        let is_null =
            |one: &serde_json::Value| one["name"].as_str().unwrap_or_default().contains("Null hardware");
        devices.into_iter().filter(|one| is_null(one) == null).collect::<Vec<_>>()
    };
    if of_null(false).is_empty() || of_null(true).is_empty() {
        return skip("RADV and another driver are not both in use here");
    }
    ran();
    for null in of_null(true) {
        assert_eq!((&null["default"], &null["usable"]), (&false.into(), &false.into()));
    }
    assert!(of_null(false).iter().any(|one| one["default"] == true));

    let output = run(&["eval", "--device", "null", &reference("cases.json")]);
    ends(&output, 4, &["Null hardware (RADV NAVI21) cannot be used"]);
}
