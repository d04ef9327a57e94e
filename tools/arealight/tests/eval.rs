//! `arealight eval` as a user runs it, without a device.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn eval(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_arealight"))
        .arg("eval")
        .args(arguments)
        .output()
        .expect("the command runs")
}

fn reference(file: &str) -> String {
    format!("{}/../../tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"))
}

fn temporary(file: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(file)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn answers_come_in_the_cases_order_with_reasons_for_those_that_are_missing() {
    let output = eval(&[&reference("cases.json"), "--on", "truth"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let answers: Value = serde_json::from_slice(&output.stdout).unwrap();
    let cases: Value =
        serde_json::from_str(&std::fs::read_to_string(reference("cases.json")).unwrap()).unwrap();
    let names =
        |values: &Value| values.as_array().unwrap().iter().map(|v| v["name"].clone()).collect::<Vec<_>>();
    assert_eq!(names(&answers["results"]), names(&cases["cases"]));
    for answer in answers["results"].as_array().unwrap() {
        assert_eq!(answer["radiance"].is_null(), answer["reason"].is_string(), "{answer}");
    }
}

#[test]
fn each_method_meets_its_measure() {
    for (method, diffuse, glossy) in [
        // Twice the cubature's tolerance, of two programs
        ("truth", 2e-6, 2e-6),
        // The closed form in float64; and no worse than the published table of Heitz et al. 2016
        ("oracle", 1e-14, 0.245),
    ] {
        let out = temporary(&format!("{method}.json"));
        let arguments =
            ["--on", method, "--against", &reference("truth.json"), "--json", "-o", out.to_str().unwrap()];
        let output = eval(&[&[reference("cases.json").as_str()], &arguments[..]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        let measure = |material: &str| {
            let families = summary["families"].as_array().unwrap().iter();
            let mut matching = families
                .filter(|f| f["shape"] == "polygon" && f["textured"] == false && f["material"] == material);
            let family = matching.next().unwrap();
            assert_eq!(family["unanswered"], 0);
            family["rmse_over_mean"].as_f64().unwrap()
        };
        assert!(measure("diffuse") <= diffuse, "{method}: {summary:#}");
        assert!(measure("ggx") <= glossy, "{method}: {summary:#}");
        // What was written is what was measured: against itself it has no error
        let again = eval(&[&reference("cases.json"), "--on", method, "--against", out.to_str().unwrap()]);
        let table = text(&again.stdout);
        let line = table.lines().find(|line| line.starts_with("polygon, ggx ")).unwrap();
        assert!(line.contains("50          0     0.0000     0.0000     0.0000     0.0000"), "{table}");
    }
}

#[test]
fn failures_say_what_and_where_and_have_their_exit_codes() {
    let write = |file: &str, text: &str| {
        std::fs::write(temporary(file), text).unwrap();
        temporary(file).to_str().unwrap().to_owned()
    };
    let cases = reference("cases.json");
    let nan = write("nan.json", "{\"cases\": [{\"name\": \"a\", \"alpha\": NaN}]}");
    let missing = write("missing.json", "{\"cases\": [{\"name\": \"a\"}]}");
    let empty_truth = write("empty.json", "[]");
    for (arguments, code, message) in [
        (vec!["no-such-file.json"], 3, "no-such-file.json: No such file"),
        (vec![&nan], 3, "JSON has no NaN and no infinity"),
        (vec![&missing], 3, "case 'a': light: is missing"),
        (
            vec![&cases, "--on", "truth", "--against", &empty_truth],
            3,
            "empty.json: case '000_rect' has no known radiance",
        ),
        (vec![&cases, "--on", "truth", "-o", "no/such/folder.json"], 5, "no/such/folder.json: cannot write"),
        (vec![&cases, "--on", "truth", "--device", "x"], 2, "--device: only --on gpu uses a device"),
        (vec![&cases, "--on", "abacus"], 2, "invalid value 'abacus'"),
    ] {
        let output = eval(&arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
        assert!(error.contains(message), "{arguments:?}: {error}");
        assert!(!error.contains("panicked"), "{error}");
    }
}
