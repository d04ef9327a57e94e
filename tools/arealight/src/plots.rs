//! Pictures, charts and pages by Python's matplotlib: the files of `tools/plots` are a part of the program.

use crate::failure::Failure;
use crate::output;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// The modules, each after those that it imports.
const MODULES: [(&str, &str); 2] =
    [("plots", include_str!("../../plots/plots.py")), ("page", include_str!("../../plots/page.py"))];

/// Makes the modules and draws: what comes over standard input, to standard output.
const DRAW: &str = "
import json, types
asked = json.load(sys.stdin)
for name, source in asked['modules']:
    module = sys.modules[name] = types.ModuleType(name)
    exec(compile(source, name + '.py', 'exec'), module.__dict__)
drawn = getattr(sys.modules['plots'], asked['kind'])(asked['found'])
sys.stdout.buffer.write(drawn if isinstance(drawn, bytes) else drawn.encode())
";

/// What comes before: nothing is imported from the folder that the program runs in, which may be anybody's.
const NOT_FROM_HERE: &str = "import sys; sys.path[:] = filter(None, sys.path); ";

/// What Python is called: on Windows, elsewhere, and where another comes first that has no matplotlib.
const PYTHONS: [&str; 3] = ["python3", "/usr/bin/python3", "python"];

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The page of `arealight bench`.
    Report,
    /// The errors of hard cases, as SVG.
    Stability,
    /// Time and error of many lights, as SVG.
    Lights,
    /// Fitted lobes beside true ones, as PNG.
    Lobes,
    /// Error maps of tables, as PNG.
    Errors,
    /// The numbers in a table, as PNG.
    Entries,
    /// The levels of a light's texture, as PNG.
    Pyramid,
}

impl Kind {
    /// The function of `plots.py`.
    const fn function(self) -> &'static str {
        match self {
            Self::Report => "report",
            Self::Stability => "stability",
            Self::Lights => "lights",
            Self::Lobes => "lobes",
            Self::Errors => "errors",
            Self::Entries => "entries",
            Self::Pyramid => "pyramid",
        }
    }
}

/// Sees to it that a file can be drawn and written, before long work.
pub fn check(path: &Path) -> Result<(), Failure> {
    output::check(path)?;
    python().map(drop)
}

/// Draws what was found, and writes the file.
pub fn draw(kind: Kind, found: &Value, path: &Path) -> Result<(), Failure> {
    let bytes = drawn(kind, found)?;
    output::write(path, &bytes)
}

/// The bytes of a drawing.
fn drawn(kind: Kind, found: &Value) -> Result<Vec<u8>, Failure> {
    let asked = json!({ "modules": MODULES, "kind": kind.function(), "found": found }).to_string();
    let failed = |what: &dyn std::fmt::Display| Failure::NoProgram(format!("matplotlib: {what}"));
    let started = python()?
        .arg(format!("{NOT_FROM_HERE}{DRAW}"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = started.map_err(|error| failed(&error))?;
    let mut input = child.stdin.take();
    // It says why it ended where it does not read all
    let writing = std::thread::spawn(move || input.as_mut().map(|input| input.write_all(asked.as_bytes())));
    let output = child.wait_with_output().map_err(|error| failed(&error))?;
    let _ = writing.join();
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(failed(&said.trim().lines().last().unwrap_or_default()))
}

/// A Python that has matplotlib, to run a program.
fn python() -> Result<Command, Failure> {
    let has_matplotlib = |python: &&&str| {
        let mut command = Command::new(python);
        command
            .arg("-c")
            .arg(format!("{NOT_FROM_HERE}import matplotlib"))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    let python = PYTHONS.iter().find(has_matplotlib).ok_or_else(|| {
        let message = "pictures and charts are drawn by Python's matplotlib, which is not installed: on Debian, \
                       apt-get install python3-matplotlib, elsewhere pip install matplotlib";
        Failure::NoProgram(message.to_owned())
    })?;
    let mut command = Command::new(python);
    command.args(["-B", "-c"]);
    Ok(command)
}

/// Numbers as `plots.py` takes them: float32, little-endian, in base 64.
pub fn floats(values: impl IntoIterator<Item = f32>) -> Value {
    let bytes: Vec<u8> = values.into_iter().flat_map(f32::to_le_bytes).collect();
    bytes_of(&bytes)
}

/// Bytes as `plots.py` takes them: in base 64.
pub fn bytes_of(bytes: &[u8]) -> Value {
    BASE64_STANDARD.encode(bytes).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn svg(kind: Kind, found: &Value) -> Result<String, Failure> {
        drawn(kind, found).map(|bytes| String::from_utf8(bytes).unwrap())
    }

    fn row(method: &str, not_finite: u32) -> Value {
        let tally = json!({ "samples": 10, "largest_backward_error": 1e-7, "not_finite": not_finite });
        json!({ "family": "crossing", "method": method, "tally": tally })
    }

    #[test]
    fn what_is_not_finite_is_drawn_elsewhere() {
        if python().is_err() && std::env::var_os("AREALIGHT_REQUIRE_GPU").is_none() {
            eprintln!("skipped: no matplotlib");
            return;
        }
        let chart = |not_finite| {
            let rows = [row("polygon-exact", 0), row("clip-and-acos", not_finite)];
            svg(Kind::Stability, &json!({ "rows": rows })).unwrap()
        };
        let (finite, other) = (chart(0), chart(3));
        assert!(finite.starts_with("<svg") && finite.contains(">crossing<"), "{finite}");
        assert_ne!(finite, other);
        assert_eq!(finite, chart(0), "the same of the same");
        // What it cannot draw is said
        let failure = svg(Kind::Stability, &json!({})).unwrap_err();
        assert_eq!(failure.to_string(), "matplotlib: KeyError: 'rows'");
    }
}
