//! `arealight fit`

use crate::failure::Failure;
use crate::output::{self, print};
use crate::progress;
use arealight::{Horizon, LightTable, SpecularLobes, TableSample};
use arealight_fit::report::{
    COUNT, Case, Errors, Level, METALS, PUBLISHED, SEED, cases, measure_lookup, measure_lookup_colour,
};
use arealight_fit::{Aim, FitError, GgxBrdf, Settings, formula, phase};
use arealight_oracle::formula::Formula;
use arealight_table::{TableFile, Target};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Fit a light table to GGX, and measure it.
#[derive(clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "they are flags of a command")]
pub struct Arguments {
    /// Where the table goes; without it the table is only fitted, and measured with --report.
    #[arg(short, long, value_name = "FILE.exr")]
    output: Option<PathBuf>,
    /// Nodes a side, 2 to 1024.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1024))]
    size: u32,
    /// Two matrices, one for the lobe of F0 and one for that of Schlick's weight; or one for all
    /// reflectances.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    matrices: u8,
    /// Fit no pairs of lobes, which are for `--specular-lobes two` and take twice as long as the rest.
    #[arg(long)]
    no_pairs: bool,
    /// Fit a formula to the table as well, and print its coefficients as Rust and GLSL.
    #[arg(long)]
    formula: bool,
    /// Fit no table, but the lobes of Henyey and Greenstein's phase function; print their coefficients as
    /// Rust and GLSL, and their errors.
    #[arg(long, conflicts_with_all = ["output", "size", "matrices", "formula", "report", "no_pairs", "json"])]
    phase: bool,
    /// Compare the table, and the published one, with the true BRDF on 3000 random quads.
    #[arg(long)]
    report: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.phase {
        return print(&phase_text());
    }
    let format = |path: &Path| {
        Target::of_path(path, None)
            .map_err(|error| Failure::Argument { argument: "--output", message: error.to_string() })
    };
    let output = arguments.output.as_deref().map(|path| Ok((path, format(path)?))).transpose()?;
    output.map_or(Ok(()), |(path, _)| output::check(path))?;
    // Fit
    let aim = if arguments.matrices == 1 { Aim::one_for_all() } else { Aim::ByF0 };
    let settings = Settings { size: arguments.size, aim, pairs: !arguments.no_pairs };
    let bar = progress::bar(settings.steps(), "steps");
    let start = Instant::now();
    let table = arealight_fit::fit(&GgxBrdf, &settings, &|done, _| bar.set_position(done));
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let refused = |error: FitError| Failure::Argument { argument: "--size", message: error.to_string() };
    let table = table.map_err(refused)?;

    // Write it before it is measured: a report that is broken off loses nothing
    if let Some((path, target)) = output {
        let file = TableFile { table: table.clone(), fit_error: None };
        let bytes = file.write(target).map_err(|error| Failure::output(path, error))?;
        output::write(path, &bytes)?;
    }
    let formula = arguments.formula.then(|| formula::fit(&GgxBrdf, &table)).transpose().map_err(refused)?;
    let report = arguments.report.then(|| Report::of(&table, formula.as_ref()));
    let summary = Summary { arguments, table: &table, seconds, formula, report };
    print(&if arguments.json { summary.to_json() } else { summary.to_text() })
}

/// The phase function's lobes, fitted.
fn phase_text() -> String {
    let fit = phase::fit();
    let mut text = format!("{}\n{}\n  |g|  error over the sphere\n", phase::rust(&fit), phase::glsl(&fit));
    for g in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95] {
        let _ = writeln!(text, "{g:>5}  {:.4}", phase::error(&fit, g));
    }
    text
}

/// The errors of a table, and of the formula that was fitted to it.
struct Report {
    table: Horizons,
    formula: Option<Horizons>,
}

/// The errors in each way of using a table or a formula.
struct Horizons {
    cosine_space: Comparison,
    both_horizons: Comparison,
}

/// The errors at one horizon level.
struct Comparison {
    one: Vec<Errors>,
    two: Vec<Errors>,
    /// By one lobe and by two, a metal of [`METALS`] a line.
    metals: Vec<[Errors; 2]>,
}

impl Report {
    /// Measures a table and a formula, with a progress bar.
    fn of(table: &LightTable, formula: Option<&Formula>) -> Self {
        let bar = progress::bar(COUNT as u64, "quads");
        let cases = cases(COUNT, SEED, &|| bar.inc(1));
        bar.finish_and_clear();
        Self {
            table: Horizons::of(&|roughness, cos_view| table.lookup(roughness, cos_view), &cases),
            formula: formula.map(|formula| {
                Horizons::of(&|roughness, cos_view| formula.lookup(roughness, cos_view), &cases)
            }),
        }
    }

    fn to_text(&self) -> String {
        let mut text = format!(
            "\nAbsolute error of the reflected radiance, over {COUNT} random quads of unit radiance (about \
            the mirror\n\
             direction, anywhere, across the horizon), roughness 0.1 to 1, view 0 to 89 degrees. The \
             published\n\
             table is clipped in cosine space only, with one integral.\n\n{}",
            self.table.to_text()
        );
        if let Some(formula) = &self.formula {
            let _ = write!(text, "\nBy formula, without a table\n\n{}", formula.to_text());
        }
        text
    }
}

/// What answers a roughness and a view's cosine with a lobe.
type Lookup<'a> = &'a (dyn Fn(f64, f64) -> TableSample + Sync);

impl Horizons {
    fn of(lookup: Lookup, cases: &[Case]) -> Self {
        let at = |horizon| Comparison::of(lookup, horizon, cases);
        Self { cosine_space: at(Horizon::Cosine), both_horizons: at(Horizon::Both) }
    }

    fn to_text(&self) -> String {
        format!(
            "Clipped in cosine space\n{}\nClipped at the surface's horizon too\n{}",
            self.cosine_space.to_text(),
            self.both_horizons.to_text()
        )
    }

    fn to_json(&self) -> Value {
        json!({
            "cosine_space": self.cosine_space.to_json(),
            "both_horizons": self.both_horizons.to_json(),
        })
    }
}

impl Comparison {
    fn of(lookup: Lookup, horizon: Horizon, cases: &[Case]) -> Self {
        let levels =
            [SpecularLobes::One, SpecularLobes::Two].map(|specular_lobes| Level { specular_lobes, horizon });
        let [one, two] = levels.map(|level| measure_lookup(lookup, level, cases));
        let metal = |&(_, f0): &(_, _)| levels.map(|level| measure_lookup_colour(lookup, level, f0, cases));
        Self { one, two, metals: METALS.iter().map(metal).collect() }
    }

    /// The errors beside those of the published table, a reflectance a line.
    fn to_text(&self) -> String {
        let mut text = format!(
            "{:>6}  {:^24}  {:^24}  {:^24}\n{:>6}",
            "", "one lobe", "two lobes", "published, 64 x 64", "F0"
        );
        for _ in 0..3 {
            let _ = write!(text, "  {:>8} {:>7} {:>7}", "mean", "95 %", "max");
        }
        text.push('\n');
        let columns = |text: &mut String, errors: &Errors| {
            let (mean, percentile_95, max) = (errors.mean, errors.percentile_95, errors.max);
            let _ = write!(text, "  {mean:>8.5} {percentile_95:>7.4} {max:>7.3}");
        };
        for ((one, two), published) in self.one.iter().zip(&self.two).zip(&PUBLISHED) {
            let _ = write!(text, "{:>6}", one.f0);
            for errors in [one, two, published] {
                columns(&mut text, errors);
            }
            text.push('\n');
        }
        for ((name, _), levels) in METALS.iter().zip(&self.metals) {
            let _ = write!(text, "{name:>6}");
            for errors in levels {
                columns(&mut text, errors);
            }
            text.push('\n');
        }
        text
    }

    fn to_json(&self) -> Value {
        let errors = |e: &Errors| json!({ "mean": e.mean, "percentile_95": e.percentile_95, "max": e.max });
        let grey = self.one.iter().zip(&self.two).zip(&PUBLISHED).map(|((one, two), published)| {
            json!({
                "f0": one.f0,
                "one_lobe": errors(one),
                "two_lobes": errors(two),
                "published": errors(published),
            })
        });
        let metals = METALS.iter().zip(&self.metals).map(|((name, f0), [one, two])| {
            json!({ "metal": name, "f0": f0.to_array(), "one_lobe": errors(one), "two_lobes": errors(two) })
        });
        grey.chain(metals).collect()
    }
}

/// What there is to say of a run.
struct Summary<'a> {
    arguments: &'a Arguments,
    table: &'a LightTable,
    seconds: f64,
    formula: Option<Formula>,
    report: Option<Report>,
}

impl Summary<'_> {
    fn to_text(&self) -> String {
        let (size, brdf, seconds) = (self.table.size(), &self.table.description().brdf, self.seconds);
        let mut text = format!("fitted {brdf}, {size} x {size} nodes, in {seconds:.1} s\n");
        if let Some(path) = &self.arguments.output {
            let _ = writeln!(text, "wrote {}", path.display());
        }
        if let Some(formula) = &self.formula {
            let _ = write!(text, "\n{}\n{}", formula::rust(formula), formula::glsl(formula));
        }
        if let Some(report) = &self.report {
            text.push_str(&report.to_text());
        }
        text
    }

    fn to_json(&self) -> String {
        let report = self.report.as_ref().map(|report| {
            let mut errors = report.table.to_json();
            errors["quads"] = json!(COUNT);
            errors["formula"] = json!(report.formula.as_ref().map(Horizons::to_json));
            errors
        });
        let formula = self.formula.as_ref().map(|formula| {
            json!({
                "lobe": formula.lobe,
                "schlick_lobe": formula.schlick_lobe,
                "dip": formula.dip,
                "albedo": formula.albedo,
                "albedo_denominator": formula.albedo_denominator,
                "schlick": formula.schlick,
                "schlick_denominator": formula.schlick_denominator,
            })
        });
        let summary = json!({
            "brdf": self.table.description().brdf,
            "made_by": self.table.description().made_by,
            "size": self.table.size(),
            "seconds": self.seconds,
            "output": self.arguments.output.as_ref().map(|path| path.display().to_string()),
            "formula": formula,
            "report": report,
        });
        format!("{summary:#}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments() -> Arguments {
        Arguments {
            output: Some("a.exr".into()),
            size: 2,
            no_pairs: false,
            matrices: 2,
            formula: true,
            phase: false,
            report: true,
            json: true,
        }
    }

    fn comparison() -> Comparison {
        let published = PUBLISHED.to_vec();
        let metals = vec![[PUBLISHED[0], PUBLISHED[6]]; METALS.len()];
        Comparison { one: published.clone(), two: published, metals }
    }

    #[test]
    fn the_comparison_is_aligned() {
        let text = comparison().to_text();
        let lines: Vec<&str> = text.lines().skip(2).collect();
        let columns = "   0.00140  0.0088   0.040";
        assert_eq!(lines[0], format!("  0.02{columns}{columns}{columns}"));
        assert_eq!(lines.len(), PUBLISHED.len() + METALS.len());
        let (grey, metals) = lines.split_at(PUBLISHED.len());
        for lines in [grey, metals] {
            assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
        }
        assert!(metals[0].starts_with("  gold   0.00140"), "{text}");
    }

    #[test]
    fn json_holds_what_the_text_says() {
        let (arguments, table) = (arguments(), LightTable::ggx());
        let horizons = || Horizons { cosine_space: comparison(), both_horizons: comparison() };
        let report = Some(Report { table: horizons(), formula: Some(horizons()) });
        let formula = Some(Formula::GGX);
        let summary = Summary { arguments: &arguments, table: &table, seconds: 1.5, formula, report };
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!(value["size"], 64);
        assert_eq!(value["output"], "a.exr");
        let lines = value["report"]["cosine_space"].as_array().unwrap();
        assert_eq!(lines.len(), PUBLISHED.len() + METALS.len());
        assert_eq!(lines[6]["two_lobes"]["max"], 0.234);
        assert_eq!(lines[7]["metal"], "gold");
        assert_eq!(value["report"]["formula"]["both_horizons"][6]["one_lobe"]["max"], 0.234);
        assert_eq!(value["formula"]["lobe"][9][3], Formula::GGX.lobe[9][3]);
        let text = summary.to_text();
        assert!(text.starts_with("fitted ggx-correlated-smith, 64 x 64 nodes, in 1.5 s\nwrote a.exr\n"));
        for part in
            ["\nFormula {\n", "\nconst vec4 ", "\nClipped at the surface's horizon too\n", "\nBy formula"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
