//! `instructions`: what each effect and each rung adds to the shade kernel, counted in its SPIR-V after `spirv-opt`.
//!
//! The bits and numbers of effects and rungs are read from the GLSL library, and the ids of the specialisation
//! constants from the kernel, so that nothing is written down twice.

use crate::TaskError;
use crate::manifest::hash;
use crate::parallel::in_parallel;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

const KERNEL: &str = "shaders/kernels/shade_resources.glsl";
const MODULE: &str = "crates/arealight/spirv/shade.spv";
const LIBRARY: &str = "shaders/include/arealight/effects.glsl";
const TABLE: &str = "benches/src/instructions.json";

/// Count the instructions of the shade kernel, specialised and optimised by spirv-opt, by effect and by rung.
///
/// Writes benches/src/instructions.json, which `arealight effects` shows.
#[derive(clap::Args)]
pub struct Arguments {
    /// Count nothing; fail when the table was made of another module than the one that is checked in.
    #[arg(long)]
    check: bool,
}

/// The table, as the crate of the benchmarks reads it.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
struct Table {
    /// How to make it again.
    command: String,
    /// What counted.
    tool: String,
    /// Of the module that was counted.
    spirv_sha256: String,
    /// Each specialisation once.
    counts: Vec<Counted>,
}

/// A specialisation, and what is left of the kernel in it.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
struct Counted {
    /// What is specialised beyond the plain kernel: an effect, a rung as `form_factor:fast`, or several with `+`.
    name: String,
    /// Bits.
    effects: u32,
    #[serde(flatten)]
    count: Count,
}

/// What a module's functions hold.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, PartialEq, Eq)]
struct Count {
    /// Every instruction.
    instructions: u32,
    /// Reads of an image by texel.
    fetches: u32,
    /// Filtered reads of an image.
    samples: u32,
}

/// Whether the table is of the module that is checked in; where it is to be made, it is.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    let module = root.join(MODULE);
    let spirv = std::fs::read(&module).map_err(TaskError::file(&module))?;
    let path = root.join(TABLE);
    if arguments.check {
        let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
        let table: Table = serde_json::from_str(&text)
            .map_err(|error| TaskError::Unreadable { path: path.clone(), message: error.to_string() })?;
        let fresh = table.spirv_sha256 == hash(&spirv);
        println!(
            "{TABLE}: {}",
            if fresh { "fresh" } else { "stale: run: cargo run -p xtask -- instructions" }
        );
        return Ok(fresh);
    }

    // Count every specialisation
    let plans = plans(root)?;
    let counts = in_parallel(&plans, |_, plan| {
        let count = count(&optimised(&spirv, &plan.constants)?);
        println!("{:40} {:5} instructions", plan.name, count.instructions);
        Ok(Counted { name: plan.name.clone(), effects: plan.effects, count })
    })?;
    let table = Table {
        command: "cargo run -p xtask -- instructions".to_owned(),
        tool: tool()?,
        spirv_sha256: hash(&spirv),
        counts,
    };
    let text = serde_json::to_string_pretty(&table)
        .map_err(|error| TaskError::Unreadable { path: path.clone(), message: error.to_string() })?;
    std::fs::write(&path, text + "\n").map_err(TaskError::file(&path))?;
    Ok(true)
}

/// What one count is of.
#[derive(Debug, Clone, PartialEq)]
struct Plan {
    name: String,
    effects: u32,
    /// Values by constant id.
    constants: BTreeMap<u32, u32>,
}

/// Every specialisation that is counted: each effect away from, or added to, the plain kernel (both lobes, the first
/// rungs), each rung instead of the first, and what some rungs cost with the effect that they are for.
fn plans(root: &Path) -> Result<Vec<Plan>, TaskError> {
    let read = |path: &str| {
        let path = root.join(path);
        std::fs::read_to_string(&path).map_err(TaskError::file(&path))
    };
    let (library, kernel) = (read(LIBRARY)?, read(KERNEL)?);
    let ids = constant_ids(&kernel);
    let missing = |path: &str, name: &str| TaskError::Unreadable {
        path: root.join(path),
        message: format!("has no constant {name}, which this counts by"),
    };
    let id = |name: &str| ids.get(name).copied().ok_or_else(|| missing(KERNEL, name));
    let numbers = |prefix: &str| constants(&library, &format!("AREALIGHT_{prefix}_"));

    let effects = numbers("EFFECT");
    let bit = |name: &str| {
        let found = effects.iter().find(|(effect, _)| effect == name).map(|(_, bit)| *bit);
        found.ok_or_else(|| missing(LIBRARY, name))
    };
    let both_lobes = bit("diffuse")? | bit("glossy")?;
    let plan = |name: String, effects: u32, rungs: &[(&str, u32)]| -> Result<Plan, TaskError> {
        // What is not given is the first rung: every constant is set, so that all of them are fixed
        let mut constants: BTreeMap<u32, u32> = ids.values().map(|id| (*id, 0)).collect();
        constants.insert(id("EFFECTS")?, effects);
        for (constant, value) in rungs {
            constants.insert(id(constant)?, *value);
        }
        Ok(Plan { name, effects, constants })
    };

    let mut plans = vec![plan("plain".to_owned(), both_lobes, &[])?, plan("none".to_owned(), 0, &[])?];
    let all = effects.iter().fold(0, |all, (_, bit)| all | bit);
    plans.push(plan("all".to_owned(), all, &[])?);
    let ellipse = bit("ellipse")?;
    for (name, bit) in &effects {
        // That of images on ellipses matters with ellipses alone
        let others = if name == "textured_ellipse" { both_lobes | ellipse } else { both_lobes };
        plans.push(plan(name.clone(), others ^ bit, &[])?);
    }
    for constant in ["FORM_FACTOR", "HORIZON", "FRESNEL", "LOBES", "FOOTPRINT"] {
        for (name, value) in numbers(constant) {
            // The first one is the plain kernel
            if value != 0 {
                let textured = if constant == "FOOTPRINT" { bit("textured")? } else { 0 };
                let name = format!("{}:{name}", constant.to_lowercase());
                plans.push(plan(name, both_lobes | textured, &[(constant, value)])?);
            }
        }
    }
    Ok(plans)
}

/// The ids of a kernel's specialisation constants, by name.
fn constant_ids(kernel: &str) -> BTreeMap<String, u32> {
    let id = |line: &str| {
        let (id, rest) = line.strip_prefix("layout(constant_id = ")?.split_once(") const ")?;
        let name = rest.split_whitespace().nth(1)?;
        Some((name.to_owned(), id.parse().ok()?))
    };
    kernel.lines().filter_map(id).collect()
}

/// The integer constants of a source whose names begin with `prefix`, without it and in lower case, in order.
fn constants(source: &str, prefix: &str) -> Vec<(String, u32)> {
    let constant = |line: &str| {
        let (name, rest) = line.strip_prefix("const ")?.split_once(' ')?.1.split_once(" = ")?;
        let value = rest.split(';').next()?.trim_end_matches('u');
        Some((name.strip_prefix(prefix)?.to_lowercase(), value.parse().ok()?))
    };
    source.lines().filter_map(constant).collect()
}

const SPIRV_OPT: &str = "spirv-opt";

fn no_tool(source: std::io::Error) -> TaskError {
    TaskError::Program { program: SPIRV_OPT, package: "spirv-tools", source }
}

/// The tool's version.
fn tool() -> Result<String, TaskError> {
    let output = Command::new(SPIRV_OPT).arg("--version").output().map_err(no_tool)?;
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    Ok(text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default().to_owned())
}

/// A module with these constants, as `spirv-opt` leaves it.
fn optimised(spirv: &[u8], constants: &BTreeMap<u32, u32>) -> Result<Vec<u8>, TaskError> {
    let values: Vec<String> = constants.iter().map(|(id, value)| format!("{id}:{value}")).collect();
    let mut tool = Command::new(SPIRV_OPT)
        .arg(format!("--set-spec-const-default-value={}", values.join(" ")))
        // What the constants rule out goes before anything is inlined, for speed
        .args(["--freeze-spec-const", "--fold-spec-const-op-composite", "--ccp"])
        .args(["--eliminate-dead-branches", "--eliminate-dead-functions", "-O", "-", "-o", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(no_tool)?;
    if let Some(mut input) = tool.stdin.take() {
        input.write_all(spirv).map_err(no_tool)?;
    }
    let output = tool.wait_with_output().map_err(no_tool)?;
    if !output.status.success() {
        return Err(no_tool(std::io::Error::other("it fails on the shade kernel")));
    }
    Ok(output.stdout)
}

/// Counts what is in the functions of a module.
fn count(spirv: &[u8]) -> Count {
    const HEADER: usize = 5;
    const LINE: u32 = 8;
    const FUNCTION: u32 = 54;
    const FUNCTION_END: u32 = 56;
    const NO_LINE: u32 = 317;
    // Sampled ways to read an image, then fetches
    const SAMPLES: std::ops::RangeInclusive<u32> = 87..=94;
    const FETCH: u32 = 95;
    let words: Vec<u32> =
        spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let (mut count, mut inside, mut at) = (Count::default(), false, HEADER);
    while let Some(word) = words.get(at) {
        let (operation, length) = (word & 0xffff, (word >> 16) as usize);
        match operation {
            FUNCTION => inside = true,
            FUNCTION_END => inside = false,
            LINE | NO_LINE => {}
            _ if inside => {
                count.instructions += 1;
                count.fetches += u32::from(operation == FETCH);
                count.samples += u32::from(SAMPLES.contains(&operation));
            }
            _ => {}
        }
        at += length.max(1);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_found_by_name() {
        let kernel = "layout(constant_id = 7) const int FOOTPRINT = 0;\nconst int OTHER = 3;\n";
        assert_eq!(constant_ids(kernel), BTreeMap::from([("FOOTPRINT".to_owned(), 7)]));
        let library = "const uint A_EFFECT_ONE = 1u;\n// const uint A_EFFECT_NO = 2u;\nconst int A_EFFECT_FOUR = 4; // four\n";
        assert_eq!(constants(library, "A_EFFECT_"), [("one".to_owned(), 1), ("four".to_owned(), 4)]);
    }

    #[test]
    fn what_is_in_functions_is_counted() {
        let instruction = |operation: u32, operands: &[u32]| {
            let mut words = vec![((operands.len() as u32 + 1) << 16) | operation];
            words.extend(operands);
            words
        };
        let words = [
            vec![0x0723_0203, 0x10300, 0, 9, 0],
            // A capability, a function with a label, a line, a fetch, a sample and the return, and its end
            instruction(17, &[1]),
            instruction(54, &[1, 2, 0, 3]),
            instruction(248, &[4]),
            instruction(8, &[1, 1, 1]),
            instruction(95, &[1, 5, 6, 7]),
            instruction(88, &[1, 5, 6, 7, 2, 8]),
            instruction(253, &[]),
            instruction(56, &[]),
        ]
        .concat();
        let spirv: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert_eq!(count(&spirv), Count { instructions: 4, fetches: 1, samples: 1 });
    }

    #[test]
    fn each_specialisation_is_planned_once() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let plans = plans(&root).unwrap();
        for (i, plan) in plans.iter().enumerate() {
            assert!(plans[..i].iter().all(|other| other.name != plan.name), "{}", plan.name);
            assert!(plans[..i].iter().all(|other| other.constants != plan.constants), "{}", plan.name);
        }
        assert!(plans.len() > 15, "{}", plans.len());
    }
}
