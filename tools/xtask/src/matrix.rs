//! `matrix`: the exported GLSL library through two compilers, as hosts of every kind would compile it.
//!
//! The kinds are stages (fragment, compute), images and samplers (apart, combined), and each option of the
//! library, alone and with every kind of light. They are read from the library itself, so that a new one is
//! in the matrix from its first day. Each compiler gets every option in one stage with one way of images;
//! with `--all`, in every stage with each. Every module goes through spirv-val, and those of compute shaders
//! with separate samplers and without open options through naga: each option, optimised and not. Cases that
//! must fail, and say why, show that the matrix can.

use crate::TaskError;
use crate::library::Library;
use crate::lint::bridges;
use crate::parallel::in_parallel;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The host that is compiled, from the checkout's root.
const HOST: &str = "tools/xtask/matrix/host.glsl";
/// Shaders that are shown as examples, from the checkout's root; each is compiled as it is.
const EXAMPLES: &str = "shaders/examples";

/// Compile the exported GLSL library as hosts of every kind would, with glslangValidator and with glslc.
#[derive(clap::Args)]
pub struct Arguments {
    /// A folder that `arealight export` wrote; without it, the library is exported for the purpose.
    #[arg(long, value_name = "DIR")]
    library: Option<PathBuf>,
    /// Compile each option in every stage, with images and samplers apart and combined.
    #[arg(long)]
    all: bool,
    /// Print what is compiled.
    #[arg(long)]
    verbose: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tool {
    Glslang,
    Glslc,
    /// With an option for its optimiser.
    GlslcOptimised(&'static str),
}

/// Something to compile.
#[derive(Debug, Clone)]
struct Case {
    tool: Tool,
    compute: bool,
    shader: PathBuf,
    /// What differs from other cases, in words.
    name: String,
    macros: Vec<(String, String)>,
    /// What naga reads goes through it.
    naga: bool,
    /// Compilation must fail, and name this.
    lacks: Option<String>,
    /// The folder of includes in an export.
    include: &'static str,
}

/// Folders of includes in an export: the library, and the library in one file.
const INCLUDES: [&str; 2] = ["include", "single"];

/// Whether every case does as it should.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    let scratch = tempfile::tempdir().map_err(TaskError::file(&std::env::temp_dir()))?;
    let folder = match &arguments.library {
        Some(folder) => folder.clone(),
        None => export(root, &scratch.path().join("library"))?,
    };
    let library = Library::read(&folder.join("include/arealight"))?;

    let mut cases = hosts(&root.join(HOST), &library, arguments.all);
    cases.extend(examples(&root.join(EXAMPLES))?);
    cases.extend(host_bridges(&folder));
    let in_one = cases.iter().filter(|case| case.compute && case.is_of_one_file());
    let in_one: Vec<Case> = in_one.map(|case| Case { include: INCLUDES[1], ..case.clone() }).collect();
    cases.extend(in_one);
    let found = in_parallel(&cases, |index, case| {
        if arguments.verbose {
            println!("{}", case.title());
        }
        case.run(&folder, &scratch.path().join(format!("{index}.spv")))
    })?;
    let failures: Vec<String> = found.into_iter().flatten().collect();
    let validator_can_fail = validator_refuses(&scratch.path().join("0.spv"))?;
    if !validator_can_fail {
        eprintln!("error: spirv-val accepts a module that is cut short");
    }
    for failure in &failures {
        eprintln!("error: {failure}");
    }
    let good = failures.is_empty() && validator_can_fail;
    println!(
        "{} shaders compiled by glslangValidator and by glslc, {} of them with a bridge missing: {}",
        cases.len(),
        cases.iter().filter(|case| case.lacks.is_some()).count(),
        if good { "good" } else { "see above" }
    );
    Ok(good)
}

/// The hosts of the matrix.
fn hosts(shader: &Path, library: &Library, all: bool) -> Vec<Case> {
    let mut cases = vec![];
    let mut add = |tool, compute, combined: bool, name: &str, mut macros: Vec<(String, String)>, lacks| {
        macros.push(("COMPUTE".into(), u32::from(compute).to_string()));
        macros.push(("COMBINED".into(), u32::from(combined).to_string()));
        // WebGPU has neither combined samplers nor what a pipeline leaves open
        let naga = !combined && !macros.iter().any(|(name, _)| name == "SPECIALIZED");
        let name = format!("{name}, {}", if combined { "combined samplers" } else { "separate samplers" });
        let shader = shader.to_owned();
        cases.push(Case { tool, compute, shader, name, macros, naga, lacks, include: INCLUDES[0] });
    };
    for (first, tool) in [Tool::Glslang, Tool::Glslc].into_iter().enumerate() {
        for (kind, (compute, combined)) in KINDS.into_iter().enumerate() {
            for (index, (name, macros)) in variants(library).into_iter().enumerate() {
                if all || index < IN_ALL_KINDS || (first + index) % KINDS.len() == kind {
                    add(tool, compute, combined, &name, macros, None);
                }
            }
        }
        for bridge in library.files.iter().flat_map(|(_, text)| bridges(text)) {
            let mut macros = everything(library);
            macros.push((format!("WITHOUT_{}", bridge.name), "1".into()));
            add(tool, true, false, &format!("without {}", bridge.name), macros, Some(bridge.name));
        }
    }
    for (name, macros) in variants(library).into_iter().filter(|(name, _)| name.ends_with(ALONE)) {
        for optimiser in ["-O0", "-O"] {
            add(Tool::GlslcOptimised(optimiser), true, false, &name, macros.clone(), None);
        }
    }
    cases
}

/// What the name of a variant ends in that changes one option, and no kind of light beside it.
const ALONE: &str = " alone";

/// Stages and images: whether they are compute, and combined with their samplers.
const KINDS: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];

/// So many variants, the first, are compiled in every stage: defaults, every kind of light, everything.
const IN_ALL_KINDS: usize = 3;

/// What a host may switch: in words, and as macros of the host.
fn variants(library: &Library) -> Vec<(String, Vec<(String, String)>)> {
    // Every option at its default, but for those given
    let set = |changes: &[(&str, u32)]| -> Vec<(String, String)> {
        let value = |name: &str, default: u32| {
            changes.iter().find(|(changed, _)| *changed == name).map_or(default, |(_, value)| *value)
        };
        library
            .options
            .iter()
            .map(|(name, default)| (name.clone(), value(name, *default).to_string()))
            .collect()
    };
    let every_kind: Vec<(&str, u32)> = library
        .options
        .iter()
        .filter(|(name, _)| has_bridges(name))
        .map(|(name, _)| (name.as_str(), 1))
        .collect();
    let mut variants = vec![
        ("defaults".to_owned(), set(&[])),
        ("every kind of light".to_owned(), set(&every_kind)),
        ("everything".to_owned(), everything(library)),
    ];
    for (name, default) in &library.options {
        let changed = (name.as_str(), 1 - default.min(&1));
        variants.push((format!("{name} {}{ALONE}", changed.1), set(&[changed])));
        if !has_bridges(name) {
            variants.push((
                format!("{name} {} with every kind of light", changed.1),
                set(&[&every_kind[..], &[changed]].concat()),
            ));
        }
    }
    let mut below_macros = set(&every_kind);
    below_macros.extend(OF_HOSTS.split(' ').map(|name| (name.to_owned(), "1".to_owned())));
    variants.push(("every kind of light below a host's macros".to_owned(), below_macros));
    let split = [&every_kind[..], &[("AREALIGHT_FOOTPRINT", 2)]].concat();
    variants.push(("AREALIGHT_FOOTPRINT 2 with every kind of light".to_owned(), set(&split)));
    variants
}

/// Names that engines define, which the library has for nothing of its own.
const OF_HOSTS: &str = "PI TAU EPSILON INFINITY N V L H R T B F0 F90 NdotL near far half saturate lerp rcp \
                        rsqrt mad frac float3 luminance sqr MAX_LIGHTS TILE_SIZE";

/// Whether an option decides which bridges a host has to define: those are 0 or 1, not constants of a
/// pipeline.
fn has_bridges(option: &str) -> bool {
    let name = option.trim_start_matches("AREALIGHT_");
    ["LIGHT_TEXTURES", "QUADS", "POLYGONS", "MESHES", "SHAPED", "DISKS", "SPHERES", "TUBES"].contains(&name)
}

/// Every kind of light and all bridges, the other options open until the pipeline is made.
fn everything(library: &Library) -> Vec<(String, String)> {
    let kinds = library.options.iter().filter(|(name, _)| has_bridges(name));
    let mut macros: Vec<_> = kinds.map(|(name, _)| (name.clone(), "1".to_owned())).collect();
    macros.push(("SPECIALIZED".to_owned(), "1".to_owned()));
    macros
}

/// The example shaders, as they are.
fn examples(folder: &Path) -> Result<Vec<Case>, TaskError> {
    let mut cases = vec![];
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let shader = entry.map_err(TaskError::file(folder))?.path();
        let compute = match shader.extension().and_then(std::ffi::OsStr::to_str) {
            Some("comp") => true,
            Some("frag") => false,
            _ => continue,
        };
        let optimised = ["-O", "-Os"].map(Tool::GlslcOptimised);
        for tool in [Tool::Glslang, Tool::Glslc].into_iter().chain(optimised) {
            let (shader, macros) = (shader.clone(), vec![]);
            let (name, include) = ("example".into(), INCLUDES[0]);
            let naga = shader.ends_with("self_test.comp"); // the others have combined samplers
            cases.push(Case { tool, compute, shader, name, macros, naga, lacks: None, include });
        }
    }
    Ok(cases)
}

/// The exported kernels with the examples' G-buffer, shadows and blocker, and with an acceleration structure.
fn host_bridges(folder: &Path) -> Vec<Case> {
    let hosts = [
        ("shade", &["AREALIGHT_HOST_G_BUFFER"][..], "a G-buffer of the host"),
        ("shade", &["AREALIGHT_HOST_VISIBILITY"], "shadows of the host"),
        ("shadow_rays", &["AREALIGHT_HOST_BLOCKER"], "a blocker of the host"),
        ("shadow_rays", &["AREALIGHT_HOST_ALPHA"], "cut out by the host"),
        ("shadow_rays", &["AREALIGHT_RAY_QUERY"], "an acceleration structure"),
        ("shadow_rays", &["AREALIGHT_RAY_QUERY", "AREALIGHT_HOST_ALPHA"], "one that is cut out"),
    ];
    let cases = hosts.into_iter().flat_map(|(kernel, options, name)| {
        [Tool::Glslang, Tool::Glslc].map(|tool| Case {
            tool,
            compute: true,
            shader: folder.join(format!("kernels/{kernel}.comp")),
            name: name.into(),
            macros: options.iter().map(|option| ((*option).into(), "1".into())).collect(),
            naga: false,
            lacks: None,
            include: INCLUDES[0],
        })
    });
    cases.collect()
}

impl Case {
    /// Whether it is compiled with the library in one file, too: examples, and hosts of one kind of light.
    fn is_of_one_file(&self) -> bool {
        self.name == "example" || self.name.contains("S 1 alone") || self.name.contains("everything")
    }

    fn title(&self) -> String {
        let stage = if self.compute { "compute" } else { "fragment" };
        let tool = match self.tool {
            Tool::Glslang => "glslangValidator".to_owned(),
            Tool::Glslc => "glslc".to_owned(),
            Tool::GlslcOptimised(option) => format!("glslc {option}"),
        };
        let file = self.shader.file_name().unwrap_or_default().to_string_lossy();
        format!("{tool}, {stage}, {}: {file}, {}", self.include, self.name)
    }

    /// Compiles and validates; `None` where all is as it should be, else what is wrong.
    fn run(&self, folder: &Path, module: &Path) -> Result<Option<String>, TaskError> {
        let output = self.compile(folder, module)?;
        let said = said(&output);
        let failure = |what: &str| Some(format!("{}: {what}\n{said}", self.title()));
        if let Some(lacks) = &self.lacks {
            let named = said.contains(&format!("{lacks}("));
            return Ok(match (output.status.success(), named) {
                (true, _) => failure("must not compile"),
                (false, false) => failure("fails, as it should, but does not name what is missing"),
                (false, true) => None,
            });
        }
        if !output.status.success() || said.contains("WARNING") || said.contains("warning") {
            return Ok(failure("does not compile without a message"));
        }
        let output = validate(module)?;
        if !output.status.success() {
            return Ok(Some(format!("{}: spirv-val says\n{}", self.title(), crate::matrix::said(&output))));
        }
        let refused = if self.naga { naga_refuses(module)? } else { None };
        Ok(refused.map(|why| format!("{}: naga says\n{why}", self.title())))
    }

    fn compile(&self, folder: &Path, module: &Path) -> Result<Output, TaskError> {
        let (include, examples) = (folder.join(self.include), folder.join("examples"));
        let (mut command, program, package) = match self.tool {
            Tool::Glslang => {
                let mut command = Command::new("glslangValidator");
                let stage = if self.compute { "comp" } else { "frag" };
                command.args(["--target-env", "vulkan1.1", "-S", stage]);
                command.arg(format!("-I{}", include.display()));
                command.arg(format!("-I{}", examples.display()));
                (command, "glslangValidator", "glslang-tools")
            }
            Tool::Glslc | Tool::GlslcOptimised(_) => {
                let mut command = Command::new("glslc");
                if let Tool::GlslcOptimised(option) = self.tool {
                    command.arg(option);
                }
                let stage = if self.compute { "compute" } else { "fragment" };
                command.args(["--target-env=vulkan1.1", "-c", &format!("-fshader-stage={stage}"), "-I"]);
                command.arg(include).arg("-I").arg(examples);
                (command, "glslc", "glslc")
            }
        };
        command.args(self.macros.iter().map(|(name, value)| format!("-D{name}={value}")));
        command.arg("-o").arg(module).arg(&self.shader);
        command.output().map_err(|source| TaskError::Program { program, package, source })
    }
}

fn validate(module: &Path) -> Result<Output, TaskError> {
    let output = Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(module).output();
    output.map_err(|source| TaskError::Program { program: "spirv-val", package: "spirv-tools", source })
}

/// Why naga does not take a module by WebGPU's rules, if it does not.
fn naga_refuses(module: &Path) -> Result<Option<String>, TaskError> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let bytes = std::fs::read(module).map_err(TaskError::file(module))?;
    let read = match naga::front::spv::parse_u8_slice(&bytes, &naga::front::spv::Options::default()) {
        Ok(read) => read,
        Err(error) => return Ok(Some(error.to_string())),
    };
    let checked = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&read);
    Ok(checked.err().map(|error| error.emit_to_string("")))
}

/// Whether spirv-val refuses a good module that lacks its last word.
fn validator_refuses(module: &Path) -> Result<bool, TaskError> {
    let bytes = std::fs::read(module).map_err(TaskError::file(module))?;
    let cut = module.with_extension("cut");
    std::fs::write(&cut, &bytes[..bytes.len().saturating_sub(4)]).map_err(TaskError::file(&cut))?;
    Ok(validate(module)?.status.success() && !validate(&cut)?.status.success())
}

fn said(output: &Output) -> String {
    (String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr)).into_owned()
}

/// Lets the command line, built here or $AREALIGHT, write the library to `folder`, as a user would.
fn export(root: &Path, folder: &Path) -> Result<PathBuf, TaskError> {
    let mut command = if let Some(program) = std::env::var_os("AREALIGHT") {
        Command::new(program)
    } else {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["run", "--locked", "--quiet", "-p", "arealight-cli", "--"]);
        cargo
    };
    let output = command
        .arg("export")
        .arg(folder)
        .current_dir(root)
        .output()
        .map_err(|source| TaskError::Program { program: "cargo", package: "cargo", source })?;
    if output.status.success() {
        Ok(folder.to_owned())
    } else {
        Err(TaskError::Export { message: said(&output) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(tool: Tool, folder: &Path, text: &str, lacks: Option<&str>) -> Case {
        let shader = folder.join("host.comp");
        std::fs::write(&shader, text).unwrap();
        let lacks = lacks.map(str::to_owned);
        let name = "test".into();
        Case { tool, compute: true, shader, name, macros: vec![], naga: false, lacks, include: "" }
    }

    const GOOD: &str = "#version 450\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
    const LACKS: &str = "#version 450\nfloat f(float x);\nlayout(local_size_x = 1) in;\n\
        layout(binding = 0) buffer B { float b; };\nvoid main() { b = f(b); }\n";

    #[test]
    fn a_case_fails_where_it_should() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        for tool in [Tool::Glslang, Tool::Glslc] {
            let verdict =
                |text, lacks| case(tool, folder, text, lacks).run(folder, &folder.join("o.spv")).unwrap();
            assert_eq!(verdict(GOOD, None), None);
            assert_eq!(verdict(LACKS, Some("f")), None);
            assert!(verdict(GOOD, Some("f")).unwrap().contains("must not compile"));
            assert!(verdict(LACKS, Some("g")).unwrap().contains("does not name"));
            assert!(verdict(LACKS, None).unwrap().contains("does not compile"));
        }
    }
}
