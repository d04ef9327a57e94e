//! `arealight eval`

use crate::failure::Failure;
use crate::output::{self, print, say_beside};
use crate::quality::{self, QualityArguments};
use crate::visible::{self, Piece};
use crate::{gpu, memory, progress};
use arealight::{LightTable, Quality};
use arealight_cases::answers::{Answer, read_answers, write_answers};
use arealight_cases::cases::{Case, CaseError, SupportedCase, read_cases};
use arealight_cases::images::Images;
use arealight_cases::measure::{Measure, UnknownTruth, measure};
use arealight_oracle::cubature::Settings;
use arealight_oracle::shading::{
    Truth, in_scattered, in_scattered_truth, ltc_on, shape_in_scattered, shape_in_scattered_truth,
    shape_ltc_on, shape_truth, truth,
};
use arealight_oracle::texture::Texture;
use glam::DVec3;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// Shade a file of shading points, and compare answers with known radiance.
#[derive(clap::Args)]
pub struct Arguments {
    /// The shading points, `-` for standard input (images of lights are in the working folder then); the
    /// format is described in tests/data/reference/README.md.
    cases: PathBuf,
    /// Where the answers go, `-` for standard output. Without it and without --against they are printed.
    #[arg(short, long, value_name = "OUT.json")]
    output: Option<PathBuf>,
    /// What answers.
    #[arg(long, value_enum, default_value_t = Method::Gpu)]
    on: Method,
    /// Known radiance: prints how far the answers lie from it, a family of cases a line.
    #[arg(long, value_name = "TRUTH.json")]
    against: Option<PathBuf>,
    /// The largest relative error of an answered case, max |answer - truth| / max truth over its channels:
    /// where one is larger, or none is answered, the worst case is named and the exit code is 1.
    #[arg(long, value_name = "T", requires = "against", value_parser = tolerance)]
    tolerance: Option<f64>,
    #[command(flatten)]
    device: gpu::DeviceArgument,
    #[command(flatten)]
    quality: QualityArguments,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

/// What answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Method {
    /// The shade pass's GLSL on a Vulkan device, in float32.
    Gpu,
    /// The fitted table on the CPU, in float64.
    Oracle,
    /// Adaptive cubature of the true BRDF on the CPU, in float64.
    Truth,
}

impl Method {
    fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Oracle => "oracle",
            Self::Truth => "truth",
        }
    }
}

/// Reads the value of `--tolerance`.
pub fn tolerance(text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    value
        .filter(|value| value.is_finite() && *value >= 0.0)
        .ok_or_else(|| "a tolerance is a number from 0 on, for example 1e-3".to_owned())
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.device.device.is_some() && arguments.on != Method::Gpu {
        let message = "only --on gpu uses a device".into();
        return Err(Failure::Argument { argument: "--device", message });
    }
    // Read and check both files first: answers may take longer than finding that one is bad
    let cases = read(&arguments.cases, read_cases)?;
    let known = match &arguments.against {
        Some(path) => {
            let known = read(path, read_answers)?;
            check_known(&cases, &known).map_err(|error| Failure::input(path, error))?;
            Some((path, known))
        }
        None => None,
    };

    if let Some(path) = &arguments.output {
        output::check(path)?;
    }

    let start = Instant::now();
    let answers = answer_all(&cases, arguments)?;
    let seconds = start.elapsed().as_secs_f64();

    // Write before measuring, so that no answer is lost
    let level = (arguments.on != Method::Truth).then(|| quality::said(arguments.quality.quality()));
    let text = write_answers(&answers, &by(arguments.on, level.as_ref()));
    match &arguments.output {
        Some(path) => {
            output::write(path, text.as_bytes())?;
            if !output::is_stream(path) {
                output::say_wrote(path);
            }
        }
        None if known.is_none() => return print(&text),
        None => {}
    }
    let measures = match &known {
        Some((path, known)) => {
            Some(measure(&cases, &answers, known).map_err(|error| Failure::input(*path, error))?)
        }
        None => None,
    };
    let measures = measures.as_deref();
    let summary = Summary { method: arguments.on, level, answers: &answers, seconds, measures };
    say_beside(
        arguments.output.as_deref(),
        &if arguments.json { summary.to_json() } else { summary.to_text() },
    )?;

    // Compare
    match arguments.tolerance.and_then(|tolerance| complaint(measures?, tolerance)) {
        Some(complaint) => {
            output::say(&format!("error: {complaint}"));
            Ok(ExitCode::from(1))
        }
        None => Ok(ExitCode::SUCCESS),
    }
}

fn read<T>(path: &Path, parse: impl Fn(&str) -> Result<T, CaseError>) -> Result<T, Failure> {
    parse(&memory::read_text(path)?).map_err(|error| Failure::input(path, error))
}

/// Checks that `known` holds the radiance of every case that can be answered.
fn check_known(cases: &[Case], known: &[Answer]) -> Result<(), UnknownTruth> {
    let known = known.iter().filter(|answer| answer.radiance.is_some());
    let names: HashSet<&str> = known.map(|answer| answer.name.as_str()).collect();
    // Whether an image can be read is no matter here
    let image = Arc::new(Texture::from_fn(1, 1, |_, _| DVec3::ONE));
    let is_supported = |case: &Case| case.supported(|_| Ok(Arc::clone(&image))).is_ok();
    let unknown = |case: &&Case| !names.contains(case.name.as_str()) && is_supported(case);
    match cases.iter().find(unknown) {
        Some(case) => Err(UnknownTruth { case: case.name.clone() }),
        None => Ok(()),
    }
}

/// What is wrong with the answers if a relative error is above `tolerance`, or if there is none to compare: a
/// comparison of nothing shows nothing.
fn complaint(measures: &[Measure], tolerance: f64) -> Option<String> {
    let answered = measures.iter().filter(|measure| measure.answered > 0);
    let Some(worst) = answered.max_by(|a, b| a.worst.total_cmp(&b.worst)) else {
        return Some("--tolerance: no case was answered, so nothing was compared".into());
    };
    (worst.worst > tolerance).then(|| {
        let (case, error) = (&worst.worst_case, worst.worst);
        format!(
            "case '{case}' ({}): relative error {error:e} is above --tolerance {tolerance:e}",
            worst.family
        )
    })
}

/// Cases that are answered at a time: what is made of them takes some kilobytes each.
const BATCH: usize = 1 << 12;

/// One answer a case, in their order: the radiance, or why there is none.
fn answer_all(cases: &[Case], arguments: &Arguments) -> Result<Vec<Answer>, Failure> {
    // The truth reads no file of a table
    let is_truth = arguments.on == Method::Truth;
    let table = if is_truth { LightTable::ggx() } else { arguments.quality.table()? };
    let mut engine = gpu::LazyEngine::new(arguments.device.device.as_deref(), &table);
    let mut images = Images::beside(&arguments.cases, memory::most_of);
    let mut answers = Vec::with_capacity(cases.len());
    for cases in cases.chunks(BATCH) {
        answers.extend(answer_batch(cases, arguments, &table, &mut engine, &mut images)?);
    }
    Ok(answers)
}

fn answer_batch(
    cases: &[Case],
    arguments: &Arguments,
    table: &LightTable,
    engine: &mut gpu::LazyEngine<'_>,
    images: &mut Images,
) -> Result<Vec<Answer>, Failure> {
    // Set aside what is not supported; of lights behind blockers only what is visible shines
    let supported = |case: &Case| {
        let supported = case.supported(|path| images.load(path));
        supported.map_err(|reason| Answer::none(&case.name, reason))
    };
    let cases: Vec<Result<SupportedCase, Answer>> = cases.iter().map(supported).collect();
    let mut pieces: Vec<Piece<'_>> = vec![];
    let mut ranges = vec![];
    for case in cases.iter().flatten() {
        let begin = pieces.len();
        pieces.extend(visible::pieces(case));
        ranges.push(begin..pieces.len());
    }
    let quality = arguments.quality.quality();
    let answers = match arguments.on {
        Method::Gpu => gpu::eval::answer(&pieces, quality, engine, &arguments.cases)?,
        Method::Oracle => answer_in_parallel(&pieces, |piece| fitted(piece, quality, table)),
        Method::Truth => answer_in_parallel(&pieces, exact),
    };
    // Put the reasons in between
    let mut ranges = ranges.into_iter();
    let answer = |case: Result<&SupportedCase, &Answer>| match case {
        Ok(case) => visible::sum(case, &answers[ranges.next().unwrap_or_default()]),
        Err(reason) => reason.clone(),
    };
    Ok(cases.iter().map(Result::as_ref).map(answer).collect())
}

/// By the table's lobes, whose integrals are exact.
fn fitted(piece: &Piece<'_>, quality: Quality, table: &LightTable) -> Answer {
    let SupportedCase { name, surface, normal, view, medium, light, .. } = piece.case;
    let found = match (piece.polygon(), medium) {
        (Some(light), None) => Some(ltc_on(quality, table, surface, *normal, *view, &light)),
        (Some(light), Some(g)) => Some(in_scattered(*g, *view, &light)),
        (None, None) => shape_ltc_on(quality, table, surface, *normal, *view, light),
        (None, Some(g)) => shape_in_scattered(*g, *view, light),
    };
    found.map_or_else(|| Answer::none(name, NO_SHAPE), |radiance| Answer::new(name, radiance))
}

/// By the true BRDF, whose integral has an error.
fn exact(piece: &Piece<'_>) -> Answer {
    let SupportedCase { name, surface, normal, view, medium, light, .. } = piece.case;
    let settings = &Settings::default();
    let found = match (piece.polygon(), medium) {
        (Some(light), None) => Some(truth(surface, *normal, *view, &light, settings)),
        (Some(light), Some(g)) => Some(in_scattered_truth(*g, *view, &light, settings)),
        (None, None) => shape_truth(surface, *normal, *view, light, settings),
        (None, Some(g)) => shape_in_scattered_truth(*g, *view, light, settings),
    };
    let Some(Truth { radiance, error, .. }) = found else { return Answer::none(name, NO_SHAPE) };
    let error = error.max_element();
    if error > UNKNOWN * radiance.max_element().max(0.0) {
        let reason = format!("the cubature did not converge: {radiance} give or take {error}");
        return Answer::none(name, reason);
    }
    Answer::new(name, radiance)
}

/// Why a light that no polygon stands for has no answer.
const NO_SHAPE: &str = "the light is no disk, sphere or tube";

/// Above this share of the radiance a cubature's error estimate makes it no truth. It is reached only where
/// the evaluations ran out.
const UNKNOWN: f64 = 1e-4;

fn answer_in_parallel<T: Sync>(cases: &[T], answer: impl Fn(&T) -> Answer + Send + Sync) -> Vec<Answer> {
    let bar = progress::bar(cases.len() as u64, "cases");
    let answers = cases.par_iter().progress_with(bar.clone()).map(answer).collect();
    bar.finish_and_clear();
    answers
}

/// What answered, as files of answers and summaries say it: a port is compared at its own level.
fn by(method: Method, level: Option<&Value>) -> Value {
    json!({ "on": method.name(), "level": level })
}

/// What there is to say of a run.
struct Summary<'a> {
    method: Method,
    level: Option<Value>,
    answers: &'a [Answer],
    seconds: f64,
    measures: Option<&'a [Measure]>,
}

impl Summary<'_> {
    fn unanswered(&self) -> usize {
        self.answers.iter().filter(|answer| answer.radiance.is_none()).count()
    }

    fn to_json(&self) -> String {
        let summary = json!({
            "on": self.method.name(),
            "level": self.level,
            "cases": self.answers.len(),
            "unanswered": self.unanswered(),
            "seconds": self.seconds,
            "families": self.measures,
        });
        format!("{summary:#}\n")
    }

    fn to_text(&self) -> String {
        let mut text = self.measures.map(table).unwrap_or_default();
        let (count, seconds, unanswered) = (self.answers.len(), self.seconds, self.unanswered());
        let name = self.method.name();
        let _ = writeln!(text, "{count} cases on {name} in {seconds:.2} s, {unanswered} unanswered");
        // Each reason once
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for reason in self.answers.iter().filter_map(|answer| answer.reason.as_deref()) {
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        for (reason, count) in reasons {
            let _ = writeln!(text, "{count:>6}: {}", output::brief(reason));
        }
        text
    }
}

/// The measures as an aligned table, a family a line.
fn table(measures: &[Measure]) -> String {
    let width = measures.iter().map(|m| m.family.to_string().len()).max().unwrap_or(0).max("family".len());
    let mut text = format!(
        "{:width$} {:>6} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}  worst case\n",
        "family", "cases", "unanswered", "RMSE/mean", "unit error", "median", "95 %", "worst"
    );
    for m in measures {
        let _ = write!(text, "{:width$} {:>6} {:>10}", m.family, m.answered + m.unanswered, m.unanswered);
        if m.answered > 0 {
            let columns = [m.rmse_over_mean, m.mean_unit_error, m.median, m.quantile_95, m.worst];
            for column in columns {
                let _ = write!(text, " {:>10}", number(column));
            }
            let _ = write!(text, "  {}", m.worst_case);
        }
        text.push('\n');
    }
    text
}

/// A share for people to read: digits where there are some, else a power of ten.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e3).contains(&value) { format!("{value:.4}") } else { format!("{value:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight_cases::measure::Family;
    use glam::DVec3;

    #[test]
    fn the_table_is_aligned_and_leaves_out_what_is_not_known() {
        let family = |material| Family { shape: "polygon", textured: false, material };
        let one = |material, answered, unanswered| Measure {
            family: family(material),
            answered,
            unanswered,
            rmse_over_mean: 0.24512,
            mean_unit_error: 2.5e-4,
            median: 0.0,
            quantile_95: 1.5e-7,
            worst: f64::INFINITY,
            worst_case: "a case".into(),
        };
        let text = table(&[one("ggx", 50, 0), one("anisotropic ggx", 0, 7)]);
        let expected = "\
family                    cases unanswered  RMSE/mean unit error     median       95 %      worst  worst case
polygon, ggx                 50          0     0.2451     2.5e-4     0.0000     1.5e-7        inf  a case
polygon, anisotropic ggx      7          7
";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_tolerance_is_held_against_the_worst_answered_case() {
        let one = |answered, worst, worst_case: &str| Measure {
            family: Family { shape: "polygon", textured: false, material: "ggx" },
            answered,
            unanswered: 1,
            rmse_over_mean: 0.0,
            mean_unit_error: 0.0,
            median: 0.0,
            quantile_95: 0.0,
            worst,
            worst_case: worst_case.into(),
        };
        let measures = [one(2, 0.25, "a"), one(3, 0.5, "b"), one(0, 0.0, "")];
        assert_eq!(complaint(&measures, 0.5), None);
        let expected = "case 'b' (polygon, ggx): relative error 5e-1 is above --tolerance 4e-1";
        assert_eq!(complaint(&measures, 0.4).as_deref(), Some(expected));
        assert!(complaint(&[one(1, f64::INFINITY, "a")], 1e300).is_some());
        assert!(complaint(&measures[2..], 0.5).is_some(), "nothing was compared");
    }

    #[test]
    fn each_reason_is_given_once() {
        let answers =
            [Answer::none("a", "no disks"), Answer::none("b", "no disks"), Answer::new("c", DVec3::ONE)];
        let (method, level, seconds, measures) = (Method::Truth, None, 0.25, None);
        let summary = Summary { method, level, answers: &answers, seconds, measures };
        assert_eq!(summary.to_text(), "3 cases on truth in 0.25 s, 2 unanswered\n     2: no disks\n");
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!((&value["on"], &value["unanswered"]), (&json!("truth"), &json!(2)));
    }
}
