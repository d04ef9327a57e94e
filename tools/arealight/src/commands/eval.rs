//! `arealight eval`

use crate::failure::Failure;
use crate::{gpu, progress};
use arealight_oracle::answers::{Answer, read_answers, write_answers};
use arealight_oracle::cases::{Case, CaseError, SupportedCase, read_cases};
use arealight_oracle::cubature::Settings;
use arealight_oracle::measure::{Measure, measure};
use arealight_oracle::shading::{ltc, truth};
use glam::DVec3;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use serde_json::json;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Answer a file of shading points, and measure answers against known radiance.
#[derive(clap::Args)]
pub struct Arguments {
    /// The shading points; the format is described in tests/data/reference/README.md.
    cases: PathBuf,
    /// Where the answers go. Without it and without --against they are printed.
    #[arg(short, long, value_name = "OUT.json")]
    output: Option<PathBuf>,
    /// What answers.
    #[arg(long, value_enum, default_value_t = Method::Gpu)]
    on: Method,
    /// Known radiance: prints how far the answers lie from it, a family of cases a line.
    #[arg(long, value_name = "TRUTH.json")]
    against: Option<PathBuf>,
    /// The Vulkan device, by a part of its name.
    #[arg(long)]
    device: Option<String>,
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

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.device.is_some() && arguments.on != Method::Gpu {
        let message = "only --on gpu uses a device".into();
        return Err(Failure::Argument { argument: "--device", message });
    }
    // Read both files first: answers may take longer than finding that one is bad
    let cases = read(&arguments.cases, read_cases)?;
    let known = arguments.against.as_deref().map(|path| read(path, read_answers)).transpose()?;

    let start = Instant::now();
    let answers = answer_all(&cases, arguments.on, arguments.device.as_deref())?;
    let seconds = start.elapsed().as_secs_f64();

    let measures = match (&arguments.against, &known) {
        (Some(path), Some(known)) => {
            Some(measure(&cases, &answers, known).map_err(|error| Failure::input(path, error))?)
        }
        _ => None,
    };
    let text = write_answers(&answers);
    match &arguments.output {
        Some(path) => std::fs::write(path, text).map_err(|error| Failure::output(path, error))?,
        None if measures.is_none() => return print(&text),
        None => {}
    }
    let summary = Summary { method: arguments.on, answers: &answers, seconds, measures: measures.as_deref() };
    print(&if arguments.json { summary.to_json() } else { summary.to_text() })
}

fn read<T>(path: &Path, parse: impl Fn(&str) -> Result<T, CaseError>) -> Result<T, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::input(path, error))?;
    parse(&text).map_err(|error| Failure::input(path, error))
}

/// Prints to standard output, which may be a pipe that closes early.
fn print(text: &str) -> Result<ExitCode, Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::output("standard output", error))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// One answer a case, in their order: the radiance, or why there is none.
fn answer_all(cases: &[Case], method: Method, device: Option<&str>) -> Result<Vec<Answer>, Failure> {
    // Set aside what is not supported
    let supported: Vec<_> = cases.iter().map(Case::supported).collect();
    let answerable: Vec<SupportedCase> = supported.iter().filter_map(|case| case.clone().ok()).collect();
    let answered = match method {
        // Without work no device is needed
        Method::Gpu if answerable.is_empty() => Vec::new(),
        Method::Gpu => answer_on_gpu(&answerable, device)?,
        Method::Oracle => answer_by_table(&answerable),
        Method::Truth => answer_in_parallel(&answerable, answer_by_cubature),
    };
    // Put the answers in between
    let mut answered = answered.into_iter();
    let answer = |(case, supported): (&Case, &Result<_, _>)| match supported {
        Ok(_) => answered.next().unwrap_or_else(|| Answer::none(&case.name, "the device gave no answer")),
        Err(unsupported) => Answer::none(&case.name, format!("{unsupported}")),
    };
    Ok(cases.iter().zip(&supported).map(answer).collect())
}

fn answer_on_gpu(cases: &[SupportedCase], device: Option<&str>) -> Result<Vec<Answer>, Failure> {
    let radiance = gpu::eval::answer(cases, device)?;
    let answers = cases.iter().zip(radiance);
    Ok(answers.map(|(case, radiance)| Answer::new(&case.name, DVec3::from_array(radiance))).collect())
}

fn answer_by_table(cases: &[SupportedCase]) -> Vec<Answer> {
    let table = arealight_table::ggx();
    answer_in_parallel(cases, |case| {
        Answer::new(&case.name, ltc(&table, &case.surface, case.normal, case.view, &case.light))
    })
}

/// Above this share of the radiance a cubature's error estimate makes it no truth. It is reached only where
/// the evaluations ran out.
const UNKNOWN: f64 = 1e-4;

fn answer_by_cubature(case: &SupportedCase) -> Answer {
    let truth = truth(&case.surface, case.normal, case.view, &case.light, &Settings::default());
    let error = truth.error.max_element();
    if error > UNKNOWN * truth.radiance.max_element() {
        let reason = format!("the cubature did not converge: {} give or take {error}", truth.radiance);
        return Answer::none(&case.name, reason);
    }
    Answer::new(&case.name, truth.radiance)
}

fn answer_in_parallel(
    cases: &[SupportedCase],
    answer: impl Fn(&SupportedCase) -> Answer + Send + Sync,
) -> Vec<Answer> {
    let bar = progress::bar(cases.len() as u64, "cases");
    let answers = cases.par_iter().progress_with(bar.clone()).map(answer).collect();
    bar.finish_and_clear();
    answers
}

/// What there is to say of a run.
struct Summary<'a> {
    method: Method,
    answers: &'a [Answer],
    seconds: f64,
    measures: Option<&'a [Measure]>,
}

impl Summary<'_> {
    fn unanswered(&self) -> usize {
        self.answers.iter().filter(|answer| answer.radiance.is_none()).count()
    }

    fn method(&self) -> &'static str {
        match self.method {
            Method::Gpu => "gpu",
            Method::Oracle => "oracle",
            Method::Truth => "truth",
        }
    }

    fn to_json(&self) -> String {
        let summary = json!({
            "on": self.method(),
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
        let _ =
            writeln!(text, "{count} cases on {} in {seconds:.2} s, {unanswered} unanswered", self.method());
        // Each reason once
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for reason in self.answers.iter().filter_map(|answer| answer.reason.as_deref()) {
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        for (reason, count) in reasons {
            let _ = writeln!(text, "{count:>6}: {reason}");
        }
        text
    }
}

/// The measures as an aligned table, a family a line.
fn table(measures: &[Measure]) -> String {
    let width = measures.iter().map(|m| m.family.to_string().len()).max().unwrap_or(0).max("family".len());
    let mut text = format!(
        "{:width$} {:>6} {:>10} {:>10} {:>10} {:>10} {:>10}  worst case\n",
        "family", "cases", "unanswered", "RMSE/mean", "median", "95 %", "worst"
    );
    for m in measures {
        let _ = write!(text, "{:width$} {:>6} {:>10}", m.family, m.answered + m.unanswered, m.unanswered);
        if m.answered > 0 {
            let columns = [m.rmse_over_mean, m.median, m.quantile_95, m.worst].map(number);
            let _ = write!(
                text,
                " {:>10} {:>10} {:>10} {:>10}  {}",
                columns[0], columns[1], columns[2], columns[3], m.worst_case
            );
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
    use arealight_oracle::measure::Family;

    #[test]
    fn the_table_is_aligned_and_leaves_out_what_is_not_known() {
        let family = |material| Family { shape: "polygon", textured: false, material };
        let one = |material, answered, unanswered| Measure {
            family: family(material),
            answered,
            unanswered,
            rmse_over_mean: 0.24512,
            median: 0.0,
            quantile_95: 1.5e-7,
            worst: f64::INFINITY,
            worst_case: "a case".into(),
        };
        let text = table(&[one("ggx", 50, 0), one("anisotropic ggx", 0, 7)]);
        let expected = "\
family                    cases unanswered  RMSE/mean     median       95 %      worst  worst case
polygon, ggx                 50          0     0.2451     0.0000     1.5e-7        inf  a case
polygon, anisotropic ggx      7          7
";
        assert_eq!(text, expected);
    }

    #[test]
    fn each_reason_is_given_once() {
        let answers =
            [Answer::none("a", "no disks"), Answer::none("b", "no disks"), Answer::new("c", DVec3::ONE)];
        let summary = Summary { method: Method::Truth, answers: &answers, seconds: 0.25, measures: None };
        assert_eq!(summary.to_text(), "3 cases on truth in 0.25 s, 2 unanswered\n     2: no disks\n");
        let value: serde_json::Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!((&value["on"], &value["unanswered"]), (&json!("truth"), &json!(2)));
    }
}
