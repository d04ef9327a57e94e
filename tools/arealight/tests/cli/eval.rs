//! `arealight eval` as a user runs it.

use crate::common::{device, json_of, printed, reference, refused, text};
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

/// As [`eval`], by two specular lobes where it is not said.
fn precisely(arguments: &[&str]) -> Output {
    let lobes = if arguments.contains(&"--specular-lobes") { &[][..] } else { &["--specular-lobes", "two"] };
    eval(&[arguments, lobes].concat())
}

fn temporary(file: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(file)
}

/// The methods that can be run here: without a device not the GPU's.
fn methods<T>(all: impl IntoIterator<Item = T>, name: impl Fn(&T) -> &str) -> impl Iterator<Item = T> {
    let device = device().is_some();
    all.into_iter().filter(move |one| device || name(one) != "gpu")
}

/// What `eval --json` says of the measures, of answers that must be given.
fn measures(arguments: &[&str]) -> Value {
    json_of(&precisely(&[arguments, &["--json"]].concat()))
}

/// What is answered, which must be possible.
fn answers(arguments: &[&str]) -> Vec<Value> {
    json_of(&eval(arguments))["results"].as_array().unwrap().clone()
}

/// That of the summary's families which has polygons without a texture on this material.
fn family<'a>(summary: &'a Value, material: &str) -> &'a Value {
    let is_it = |f: &&Value| f["shape"] == "polygon" && f["textured"] == false && f["material"] == material;
    summary["families"].as_array().unwrap().iter().find(is_it).unwrap()
}

fn json(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

fn write(file: &str, text: &str) -> String {
    std::fs::write(temporary(file), text).unwrap();
    temporary(file).to_str().unwrap().to_owned()
}

#[test]
fn answers_come_in_the_cases_order_with_reasons_for_those_that_are_missing() {
    let answers = answers(&[&reference("cases.json"), "--on", "truth"]);
    let cases = json(reference("cases.json"));
    let names = |values: &[Value]| values.iter().map(|v| v["name"].clone()).collect::<Vec<_>>();
    assert_eq!(names(&answers), names(cases["cases"].as_array().unwrap()));
    for answer in answers {
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
        let summary = json_of(&precisely(&[&[reference("cases.json").as_str()], &arguments[..]].concat()));
        let measure = |material: &str| {
            let family = family(&summary, material);
            assert_eq!(family["unanswered"], 0);
            family["rmse_over_mean"].as_f64().unwrap()
        };
        assert!(measure("diffuse") <= diffuse, "{method}: {summary:#}");
        assert!(measure("ggx") <= glossy, "{method}: {summary:#}");
        // What was written is what was measured: against itself it has no error
        let again =
            precisely(&[&reference("cases.json"), "--on", method, "--against", out.to_str().unwrap()]);
        let table = text(&again.stdout);
        let line = table.lines().find(|line| line.starts_with("polygon, ggx ")).unwrap();
        assert!(line.contains("50          0     0.0000     0.0000     0.0000     0.0000"), "{table}");
    }
}

/// Shadows by exact visibility, of each family as RMSE over mean: the truth by both programs' cubatures; the
/// fitted lobes, in float64 and by the GPU, within what the reference's own lobes of a fitted table give.
#[test]
fn what_is_visible_of_lights_behind_triangles_shines() {
    // Of two lobes one case makes the last: a dielectric that is seen at 77 degrees. Without it they err less
    // than one does
    let [one, two] = ["one", "two"];
    let all = [
        ("truth", two, [1e-9, 1e-8, 1e-8]),
        ("oracle", one, [1e-14, 1.4e-2, 0.12]),
        ("oracle", two, [1e-14, 7.5e-3, 0.13]),
        ("gpu", one, [1e-6, 1.4e-2, 0.12]),
        ("gpu", two, [1e-6, 7.5e-3, 0.13]),
    ];
    for (method, lobes, bounds) in methods(all, |one| one.0) {
        let errors = |cases: &str| -> Vec<f64> {
            let truth = reference("shadows-truth.json");
            let lobes = if method == "truth" { &[][..] } else { &["--specular-lobes", lobes] };
            let summary = measures(&[&[cases, "--on", method, "--against", &truth], lobes].concat());
            let families = summary["families"].as_array().unwrap().iter();
            families.map(|family| family["rmse_over_mean"].as_f64().unwrap()).collect()
        };
        let found = errors(&reference("shadows.json"));
        assert!(
            found.len() == 3 && found.iter().zip(bounds).all(|(f, bound)| *f <= bound),
            "{method}, {lobes}: {found:?}"
        );
        // The twin: without what blocks them
        let mut cases = json(reference("shadows.json"));
        for case in cases["cases"].as_array_mut().unwrap() {
            case.as_object_mut().unwrap().remove("occluders");
        }
        let found = errors(&write(&format!("unshadowed-{method}.json"), &cases.to_string()));
        assert!(found.iter().all(|f| *f > 0.3), "{method}: {found:?}");
    }
}

#[test]
fn anisotropic_surfaces_are_answered_by_every_method() {
    let measure = |method: &str, cases: &str| -> f64 {
        let truth = reference("anisotropy-truth.json");
        let summary = measures(&[cases, "--on", method, "--against", &truth]);
        let family = &summary["families"][0];
        assert_eq!((&family["material"], &family["answered"]), (&"anisotropic ggx".into(), &20.into()));
        family["mean_unit_error"].as_f64().unwrap()
    };
    // Twice the mean of what another design gives of metals and of dielectrics there, 8.8e-3 and 1.2e-3
    for (method, bound) in methods([("truth", 1e-7), ("oracle", 10e-3), ("gpu", 10e-3)], |one| one.0) {
        let found = measure(method, &reference("anisotropy.json"));
        assert!(found < bound, "{method}: {found:e}");
        // The twin: turned by a right angle
        let mut cases = json(reference("anisotropy.json"));
        for case in cases["cases"].as_array_mut().unwrap() {
            let fields = case.as_object_mut().unwrap();
            let (along, across) = (fields["alpha_x"].clone(), fields["alpha_y"].clone());
            fields.insert("alpha_x".into(), across);
            fields.insert("alpha_y".into(), along);
        }
        let turned = measure(method, &write(&format!("turned-{method}.json"), &cases.to_string()));
        assert!(turned > 2.0 * bound, "{method}: {turned:e}");
    }
}

#[test]
fn layered_materials_are_answered_by_every_method() {
    // A layer's albedo is itself an integral, of sheen to 1e-4. Fitted lobes are held to the means below:
    // where next to nothing is reflected they err by as much
    let [cases, truth] = ["materials.json", "materials-truth.json"].map(reference);
    for (method, tolerance) in methods([("truth", "1e-4"), ("oracle", "1"), ("gpu", "1")], |one| one.0) {
        let summary = measures(&[&cases, "--on", method, "--against", &truth, "--tolerance", tolerance]);
        // Twice what another design gives there
        for (family, (material, count, bound)) in [
            ("coat", 14, 4.8e-3),
            ("ggx over diffuse", 6, 2.6e-3),
            ("rough diffuse", 13, 0.62e-3),
            ("sheen", 6, 1.3e-3),
            ("sheen_over", 6, 7.4e-3),
        ]
        .into_iter()
        .enumerate()
        {
            let family = &summary["families"][family];
            assert_eq!(
                (&family["material"], &family["answered"]),
                (&material.into(), &count.into()),
                "{summary:#}"
            );
            assert!(family["mean_unit_error"].as_f64().unwrap() < bound, "{summary:#}");
        }
    }
    // The twin: the fitted lobe is not the truth
    let output = precisely(&[&cases, "--on", "oracle", "--against", &truth, "--tolerance", "1e-3"]);
    assert_eq!(output.status.code(), Some(1));
}

/// The reference's cases of GGX without a coat or sheen, with a thin film each: metals and coupled
/// dielectrics.
fn cases_with_films() -> Value {
    let mut cases = json(reference("materials.json"));
    let others = json(reference("cases.json"));
    let mut all = cases["cases"].as_array().unwrap().clone();
    // Images are files beside the reference's
    let is_rough = |case: &&Value| {
        case["alpha"].as_f64().is_some_and(|alpha| alpha > 0.05)
            && !case["light"].to_string().contains(".exr")
    };
    all.extend(others["cases"].as_array().unwrap().iter().filter(is_rough).cloned());
    let with_film = |(index, case): (usize, &Value)| {
        let mut case = case.clone();
        case["film_ior"] = (1.2 + 0.1 * (index % 9) as f64).into();
        case["film_thickness"] = (150.0 + 70.0 * (index % 13) as f64).into();
        if case["coupling"].is_null() {
            // Copper
            case["F0"] = serde_json::json!([0.955, 0.638, 0.538]);
            for field in ["albedo", "coupling"] {
                case.as_object_mut().unwrap().remove(field);
            }
        }
        case
    };
    let isotropic = all.iter().filter(|case| case["alpha"].is_number());
    let ggx = isotropic.filter(|case| case["bsdf"].is_null() || case["bsdf"] == "ggx");
    cases["cases"] = ggx.enumerate().map(with_film).collect();
    cases
}

#[test]
fn thin_films_are_answered_by_every_method() {
    let cases = write("films.json", &cases_with_films().to_string());
    let truth = write("films-truth.json", "");
    printed(&eval(&[&cases, "--on", "truth", "-o", &truth]));
    let mean_error = |cases: &str, method: &str| {
        let summary = measures(&[cases, "--on", method, "--against", &truth]);
        let families = summary["families"].as_array().unwrap().iter();
        let number = |family: &Value, field: &str| family[field].as_f64().unwrap();
        let sums = families.fold([0.0; 2], |[sum, count], family| {
            let answered = number(family, "answered");
            [sum + answered * number(family, "mean_unit_error"), count + answered]
        });
        assert_eq!(sums[1], 119.0, "{summary:#}");
        sums[0] / sums[1]
    };
    for method in methods(["oracle", "gpu"], |one| one) {
        let error = mean_error(&cases, method);
        println!("{method}: {error:.2e}");
        // 2.9e-3 was found: what lobes err where the Fresnel term is right is most of it
        assert!(error < 3.2e-3, "{method}: {error:.2e}");
    }
    // The twin: without the films
    let mut bare = cases_with_films();
    for case in bare["cases"].as_array_mut().unwrap() {
        for field in ["film_thickness", "film_ior"] {
            case.as_object_mut().unwrap().remove(field);
        }
    }
    let error = mean_error(&write("films-none.json", &bare.to_string()), "oracle");
    println!("without films: {error:.2e}");
    assert!(error > 10e-3, "{error:.2e}");
}

#[test]
fn failures_say_what_and_where_and_have_their_exit_codes() {
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
        (vec![&cases, "--on", "oracle", "--tolerance", "0.1"], 2, "--against <TRUTH.json>"),
        (vec![&cases, "--against", &empty_truth, "--tolerance", "-1"], 2, "a number from 0 on"),
        (vec![&cases, "--against", &empty_truth, "--tolerance", "NaN"], 2, "a number from 0 on"),
    ] {
        println!("{arguments:?}");
        refused(&eval(&arguments), code, &[message]);
    }
}

#[test]
fn truth_that_lacks_a_case_is_found_before_anything_is_answered() {
    // One name is missing; the rest of the file is sound
    let mut known = json(reference("truth.json"));
    let results = known.as_array_mut().unwrap();
    let place = results.iter().position(|result| result["name"] == "000_rect").unwrap();
    results.remove(place);
    let lacking = write("lacking.json", &known.to_string());
    let out = temporary("never-written.json");
    let _ = std::fs::remove_file(&out);
    let arguments = ["--on", "oracle", "--against", &lacking, "-o", out.to_str().unwrap()];
    let output = eval(&[&[reference("cases.json").as_str()], &arguments[..]].concat());
    refused(&output, 3, &["lacking.json: case '000_rect' has no known radiance"]);
    assert!(!out.exists(), "no answer was asked for");
}

#[test]
fn a_tolerance_is_a_gate() {
    let (cases, truth) = (reference("cases.json"), reference("truth.json"));
    let gate = |method: &str, tolerance: &str| {
        precisely(&[&cases, "--on", method, "--against", &truth, "--tolerance", tolerance])
    };
    // The cubature agrees with the known radiance of the same integral; a fitted lobe does not
    printed(&gate("truth", "1e-3"));
    let failed = gate("oracle", "1e-3");
    refused(&failed, 1, &["error: case '", "is above --tolerance 1e-3"]);
    assert!(text(&failed.stdout).contains("polygon, ggx"), "the measures are printed all the same");
}

#[test]
fn the_gpu_meets_its_measure() {
    let Some(()) = device() else { return };
    let summary = measures(&[&reference("cases.json"), "--against", &reference("truth.json")]);
    let measure = |material: &str, measure: &str| {
        let family = family(&summary, material);
        assert_eq!(family["unanswered"], 0, "{family}");
        family[measure].as_f64().unwrap()
    };
    // The closed form in float32, each case by itself: 1e-5 is less than two hundred roundings
    assert!(measure("diffuse", "worst") <= 1e-5, "{summary:#}");
    // No worse than the published table of Heitz et al. 2016
    assert!(measure("ggx", "rmse_over_mean") <= 0.245, "{summary:#}");
}

#[test]
fn a_light_that_float32_cannot_hold_costs_only_its_own_answer() {
    let Some(()) = device() else { return };
    let case = |name: &str, size: &str, radiance: &str| {
        format!(
            r#"{{"name": "{name}", "position": [0, 0, 0], "normal": [0, 0, 1], "view": [0, 0, 1],
                "alpha": 0.5,
             "light": {{"type": "polygon", "radiance": [{radiance}, 1, 1], "two_sided": true,
             "vertices": [[0, 0, 1], [{size}, 0, 1], [0, {size}, 1]]}}}}"#
        )
    };
    let all = [
        case("before", "1", "1"),
        case("far", "1e39", "1"),
        case("bright", "1", "1e39"),
        case("after", "1", "1"),
    ];
    let cases = write("far.json", &format!(r#"{{"cases": [{}]}}"#, all.join(",")));
    let answers = answers(&[&cases]);
    assert_eq!(answers.len(), 4);
    assert!(answers[0]["radiance"].is_array(), "{}", answers[0]);
    assert_eq!(answers[0]["radiance"], answers[3]["radiance"]);
    for (answer, reason) in [(&answers[1], "vertices[1]"), (&answers[2], "radiance")] {
        assert!(answer["radiance"].is_null(), "{answer}");
        assert!(answer["reason"].as_str().unwrap().contains(reason), "{answer}");
    }
}

#[test]
fn thousands_of_cases_are_answered_each_like_the_one_it_repeats() {
    let Some(()) = device() else { return };
    // Those that are answered, under new names until there are enough
    let once = answers(&[&reference("cases.json")]);
    let cases = json(reference("cases.json"));
    let answered = cases["cases"].as_array().unwrap().iter().zip(&once);
    let answered: Vec<_> = answered.filter(|(_, answer)| answer["radiance"].is_array()).collect();
    let repeated = answered.iter().cycle().take(5_000).enumerate();
    let renamed: Vec<Value> = repeated
        .map(|(index, (case, _))| {
            let mut case = (*case).clone();
            case["name"] = format!("{index}").into();
            case
        })
        .collect();
    // Their image is looked for beside them
    std::fs::copy(reference("light.exr"), temporary("light.exr")).unwrap();
    let many = answers(&[&write("many.json", &serde_json::json!({ "cases": renamed }).to_string())]);
    assert_eq!(many.len(), 5_000);
    for (index, (answer, (_, first))) in many.iter().zip(answered.iter().cycle()).enumerate() {
        assert_eq!(answer["name"], format!("{index}"));
        assert_eq!(answer["radiance"], first["radiance"], "{}", first["name"]);
    }
}

#[test]
fn cases_and_answers_go_through_pipes() {
    use std::io::Write as _;
    let (cases, truth) = (reference("cases.json"), reference("truth.json"));
    let plain = printed(&eval(&[&cases, "--on", "oracle"]));
    let mut piped = Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(["eval", "-", "--on", "oracle", "--against", &truth, "-o", "-"])
        // Images of lights are beside the file, or where the program runs
        .current_dir(Path::new(&cases).parent().unwrap())
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    piped.stdin.take().unwrap().write_all(&std::fs::read(&cases).unwrap()).unwrap();
    let piped = piped.wait_with_output().unwrap();
    // Answers and nothing else on one stream, how far they are on the other
    let (found, said) = (printed(&piped), text(&piped.stderr));
    assert!(found == plain, "{} bytes, not {}", found.len(), plain.len());
    assert!(said.contains("family") && said.contains("worst"), "{said}");
}

#[test]
fn an_image_keeps_its_range_whatever_the_other_images_are() {
    let Some(()) = device() else { return };
    let mut cases = vec![];
    for (name, [width, height], brightest) in [
        ("room", [64, 64], 1.0),
        ("banner", [512, 32], 1.0),
        ("sun", [32, 20], 1e6),
        ("night", [32, 32], 1e-6),
    ] {
        let texel = |x: usize, y: usize| {
            let share = brightest * (1 + (x * 5 / width + y * 3 / height) % 4) as f32;
            (share, 0.5 * share, 0.01 * share)
        };
        exr::prelude::write_rgb_file(temporary(&format!("{name}.exr")), width, height, texel).unwrap();
        let across = width as f64 / height as f64;
        let corner = |x: f64, y: f64| [x * across, y, 2.0];
        let vertices = [corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, -0.5)];
        cases.push(serde_json::json!({
            "name": name, "position": [0, 0, 0], "normal": [0, 0, 1], "view": [0, 0.3, 1],
            "bsdf": "diffuse", "albedo": [1, 1, 1],
            "light": {
                "type": "polygon", "radiance": [1, 1, 1], "vertices": vertices,
                "texture": format!("{name}.exr"), "uv": [[0, 1], [0, 0], [1, 0], [1, 1]],
            },
        }));
    }
    let answers = |cases: &[Value], on: &str| -> Vec<Value> {
        answers(&[&write("images.json", &serde_json::json!({ "cases": cases }).to_string()), "--on", on])
    };
    let both = answers(&cases, "gpu").into_iter().zip(answers(&cases, "oracle"));
    for (case, (found, exact)) in cases.iter().zip(both) {
        assert_eq!(answers(std::slice::from_ref(case), "gpu")[0], found);
        for channel in 0..3 {
            let of = |answer: &Value| answer["radiance"][channel].as_f64().unwrap();
            // What levels an octave apart leave of an image like a checker board
            assert!((of(&found) / of(&exact) - 1.0).abs() < 0.01, "{found}, {exact}");
        }
    }
}

/// A case of a white diffuse surface that looks up.
fn white(name: &str, light: &str) -> String {
    format!(
        r#"{{ "name": "{name}", "position": [0, 0, 0], "normal": [0, 0, 1], "view": [0, 0, 1],
        "bsdf": "diffuse", "albedo": [1, 1, 1], "light": {{ {light} }} }}"#
    )
}

#[test]
fn narrow_beams_pieces_of_images_and_what_is_hidden_of_profiles_agree() {
    let texel = |x: usize, y: usize| (1.0, (x * x + y) as f32, if x + y > 7 { 1.0 } else { 0.1 });
    exr::prelude::write_rgb_file(temporary("piece.exr"), 8, 8, texel).unwrap();
    let light = |more: &str| {
        let corners = "[[-0.5, -0.5, 1], [-0.5, 0.5, 1], [0.5, 0.5, 1], [0.5, -0.5, 1]]";
        format!(r#""type": "polygon", "radiance": [1, 1, 1], "vertices": {corners}, {more}"#)
    };
    let hidden = r#""occluders": [[[-0.4, -0.4, 0.5], [0.1, -0.4, 0.5], [0.1, 0.4, 0.5]]], "light""#;
    let turned = r#""profile": [[0, 1, 0.2, 0.1, 0.2], [80, 1, 0.2, 0.1, 0.2]], "profile_levels": 8"#;
    let piece = r#""texture": "piece.exr", "uv": [[0.3, 0.6], [0.3, 0.4], [0.6, 0.4], [0.6, 0.6]]"#;
    let cases = [
        white("beam", &light(r#""profile": [[0, 1], [1, 0]], "profile_levels": 8"#)),
        white("piece", &light(piece)),
        white("hidden image", &light(piece)).replace("\"light\"", hidden),
        white("hidden profile", &light(turned)).replace("\"light\"", hidden),
    ];
    let file = write("pieces.json", &format!(r#"{{ "cases": [{}] }}"#, cases.join(",")));
    let of = |method: &str| {
        let found = answers(&[&file, "--on", method]);
        found.iter().map(|answer| answer["radiance"][1].as_f64().unwrap()).collect::<Vec<_>>()
    };
    let known = of("truth");
    // A factor of 1 - angle / end: end^2 / 3
    assert!((known[0] / (1_f64.to_radians().powi(2) / 3.0) - 1.0).abs() < 2e-3, "{known:?}");
    for method in methods(["oracle", "gpu"], |name| name) {
        let off: Vec<f64> = of(method).iter().zip(&known).map(|(found, known)| found / known - 1.0).collect();
        // The filter's error, of triangles with what is beside them; a pixel that looks by an outline's own
        // first edge errs by half
        assert!(
            off.iter().zip([0.02, 0.02, 0.1, 0.1]).all(|(off, most)| off.abs() < most),
            "{method}: {off:?}"
        );
    }
}

#[test]
fn disks_have_their_profile_and_opening_and_images_their_profile() {
    exr::prelude::write_rgb_file(temporary("half.exr"), 2, 2, |x, y| (1.0, (x + y) as f32, 0.5)).unwrap();
    // Half of the light, whatever the angle
    let half = r#""profile": [[0, 0.5], [90, 0.5]]"#;
    let disk = r#""type": "disk", "radiance": [1, 1, 1], "center": [0, 0, 1], "axis_u": [0, 0.5, 0],
        "axis_v": [0.5, 0, 0]"#;
    let opening = r#""opening": { "center": [0, 0, 0.5], "axis_u": [0.1, 0, 0], "axis_v": [0, 0.1, 0] }"#;
    let image = r#""type": "polygon", "radiance": [1, 1, 1], "texture": "half.exr",
        "vertices": [[-0.5, -0.5, 1], [-0.5, 0.5, 1], [0.5, 0.5, 1], [0.5, -0.5, 1]],
        "uv": [[0, 1], [0, 0], [1, 0], [1, 1]]"#;
    let cases = [
        white("image", image),
        white("half of it", &format!("{image}, {half}")),
        white("whole", disk),
        white("half", &format!("{disk}, {half}")),
        white("through a window", &format!("{disk}, {opening}")),
    ];
    let file = write("disks.json", &format!(r#"{{ "cases": [{}] }}"#, cases.join(",")));
    for method in methods(["oracle", "truth", "gpu"], |name| name) {
        let found = answers(&[&file, "--on", method]);
        let found: Vec<f64> = found.iter().map(|answer| answer["radiance"][0].as_f64().unwrap()).collect();
        // A window of .2 at .5 is seen as one of .4 at 1: 0.0483570
        let [whole, half] = [found[0], found[1]];
        assert!((half / whole - 0.5).abs() < 1e-6, "{method}: {half} of {whole}");
        for (found, expected) in found[2..].iter().zip([0.2, 0.1, 0.048_357_0]) {
            // Twelve corners for the disk
            assert!((found / expected - 1.0).abs() < 1e-4, "{method}: {found} and {expected}");
        }
    }
}
