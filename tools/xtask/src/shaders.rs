//! `shaders`: compiles the kernels, or checks that the embedded SPIR-V is what they compile to.

use crate::TaskError;
use crate::compile::{Compiled, compile};
use crate::manifest::{Entry, Manifest, hash};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const REMEDY: &str = "run: SHADERC_LIB_DIR=\"$(tools/shaderc.sh)\" cargo run -p xtask -- shaders";

/// Kernels, or shaders of other stages, and where their modules go, both from the checkout's root.
struct KernelSet {
    sources: &'static str,
    modules: &'static str,
}

/// What the crate `arealight` embeds, what only the tools, the benchmarks and the tests run, the GLSL
/// library's example, whose statistics the benchmarks read, the wrong-doers that the engine's tests must
/// catch, and what the example hosts draw with.
const SETS: [KernelSet; 7] = [
    KernelSet { sources: "shaders/kernels", modules: "crates/arealight/spirv" },
    KernelSet { sources: "tools/kernels/shaders", modules: "tools/kernels/spirv" },
    KernelSet { sources: "benches/kernels", modules: "benches/spirv" },
    KernelSet { sources: "shaders/examples", modules: "benches/spirv/examples" },
    KernelSet { sources: "tests/kernels", modules: "tests/spirv" },
    KernelSet { sources: "tools/engine/tests/canary", modules: "tools/engine/tests/canary" },
    KernelSet { sources: "examples/rust/shaders", modules: "examples/rust/spirv" },
];

/// Compile the kernels to the SPIR-V that is checked in.
///
/// Each of shaders/kernels/*.comp becomes crates/arealight/spirv/*.spv, and manifest.json beside them records
/// the sources' hash, the module's hash and the compiler. Likewise tools/kernels/shaders into
/// tools/kernels/spirv, benches/kernels into benches/spirv, shaders/examples into benches/spirv/examples,
/// tests/kernels into tests/spirv, and tools/engine/tests/canary; examples/rust/shaders into
/// examples/rust/spirv, of which shaders of other stages (*.vert, *.frag) keep that ending in their names.
#[derive(clap::Args)]
pub struct Arguments {
    /// Kernels, by file name without its ending; all when none is named.
    names: Vec<String>,
    /// Write nothing; fail when a module is not what its sources compile to.
    ///
    /// Fails when sources have changed since the module was made, or the module is not the one recorded.
    /// When only this compiler's output differs, another version of the compiler made the module: that is
    /// said, and fails with --strict alone.
    #[arg(long, conflicts_with = "names")]
    check: bool,
    /// With --check: fail too when the module is what another version of the compiler makes.
    #[arg(long, requires = "check")]
    strict: bool,
}

/// Whether every kernel compiled, or passed the check.
pub fn run(root: &Path, arguments: &Arguments) -> Result<bool, TaskError> {
    if arguments.check { check_all(root, arguments.strict) } else { write_all(root, &arguments.names) }
}

/// Checks every set, and reports.
fn check_all(root: &Path, strict: bool) -> Result<bool, TaskError> {
    let (mut kernels, mut findings) = (0, vec![]);
    for set in &SETS {
        let checked = Checkout { root, set }.check()?;
        kernels += checked.0;
        findings.extend(checked.1);
    }
    for finding in &findings {
        println!("{}: {}", finding.severity(strict), finding.text());
    }
    let fresh = !findings.iter().any(|finding| finding.is_error(strict));
    println!("{kernels} kernels checked: {}", if fresh { "fresh" } else { REMEDY });
    Ok(fresh)
}

/// Compiles the kernels of these names in every set, or all.
fn write_all(root: &Path, names: &[String]) -> Result<bool, TaskError> {
    let mut available = vec![];
    for set in &SETS {
        available.extend(Checkout { root, set }.kernels()?);
    }
    if let Some(name) = names.iter().find(|name| !available.contains(name)) {
        return Err(TaskError::NoSuchKernel { name: name.clone(), available: available.join(", ") });
    }
    let mut all_compiled = true;
    for set in &SETS {
        all_compiled &= Checkout { root, set }.write(names)?;
    }
    Ok(all_compiled)
}

/// What the check found wrong with a kernel's module.
#[derive(Debug, PartialEq, Eq)]
enum Finding {
    /// The sources do not compile.
    Broken { messages: String },
    /// The sources have changed since the module was made, or it was never made.
    Stale { path: String },
    /// The module is not the one that the manifest records.
    Replaced { path: String },
    /// This compiler makes another module of the same sources.
    OtherCompiler { path: String, theirs: String, ours: String },
    /// A module or record whose kernel is gone.
    Orphan { path: String },
}

impl Finding {
    fn is_error(&self, strict: bool) -> bool {
        strict || !matches!(self, Self::OtherCompiler { .. })
    }

    fn severity(&self, strict: bool) -> &'static str {
        if self.is_error(strict) { "error" } else { "note" }
    }

    fn text(&self) -> String {
        match self {
            Self::Broken { messages } => format!("does not compile:\n{}", messages.trim_end()),
            Self::Stale { path } => format!("{path} is older than its sources"),
            Self::Replaced { path } => format!("{path} is not the module that manifest.json records"),
            Self::OtherCompiler { path, theirs, ours } => format!(
                "{path} was made by another version of the compiler ({theirs}; here: {ours}) from the same \
                 sources"
            ),
            Self::Orphan { path } => format!("{path} has no source: delete it, or restore the source"),
        }
    }
}

/// A set of kernels in a checkout.
struct Checkout<'a> {
    root: &'a Path,
    set: &'a KernelSet,
}

impl Checkout<'_> {
    /// The kernels' names, sorted: those of files, without the ending of a compute shader.
    fn kernels(&self) -> Result<Vec<String>, TaskError> {
        let folder = self.root.join(self.set.sources);
        let mut names = stems(&folder, "comp")?;
        for stage in ["vert", "frag"] {
            names.extend(stems(&folder, stage)?.into_iter().map(|stem| format!("{stem}.{stage}")));
        }
        names.sort();
        Ok(names)
    }

    fn modules(&self) -> PathBuf {
        self.root.join(self.set.modules)
    }

    /// A module's path from the root.
    fn module(&self, name: &str) -> String {
        format!("{}/{name}.spv", self.set.modules)
    }

    /// Compiles the kernels of these names, or all, writes each module that differs, and brings the manifest
    /// up to date. Whether all compiled.
    fn write(&self, names: &[String]) -> Result<bool, TaskError> {
        let available = self.kernels()?;
        let mut manifest = Manifest::read(&self.modules())?;
        manifest.kernels.retain(|name, _| available.contains(name));
        let mut all_compiled = true;
        for name in available.iter().filter(|name| names.is_empty() || names.contains(name)) {
            match self.compile(name)? {
                Ok(compiled) => {
                    let path = self.module(name);
                    let changed = write_if_changed(&self.root.join(&path), &compiled.spirv)?;
                    let state = if changed { "written" } else { "unchanged" };
                    println!("{path}: {} bytes, {state}", compiled.spirv.len());
                    manifest.kernels.insert(name.clone(), Entry::of(&compiled));
                }
                Err(messages) => {
                    eprint!("{messages}");
                    all_compiled = false;
                }
            }
        }
        write_if_changed(&Manifest::path(&self.modules()), manifest.to_text().as_bytes())?;
        Ok(all_compiled)
    }

    /// Compares what is checked in with what the sources compile to: how many kernels, and what is wrong.
    fn check(&self) -> Result<(usize, Vec<Finding>), TaskError> {
        let available = self.kernels()?;
        let manifest = Manifest::read(&self.modules())?;
        let mut findings = vec![];
        for name in &available {
            let path = self.module(name);
            match self.compile(name)? {
                Ok(compiled) => {
                    let module = std::fs::read(self.root.join(&path)).ok();
                    let here = Entry::of(&compiled);
                    findings.extend(compare(path, &here, manifest.kernels.get(name), module.as_deref()));
                }
                Err(messages) => findings.push(Finding::Broken { messages }),
            }
        }
        let gone = |name: &String| !available.contains(name);
        for name in stems(&self.modules(), "spv")?.into_iter().filter(gone) {
            findings.push(Finding::Orphan { path: self.module(&name) });
        }
        for name in manifest.kernels.into_keys().filter(gone) {
            findings.push(Finding::Orphan { path: format!("{name} in {}/manifest.json", self.set.modules) });
        }
        Ok((available.len(), findings))
    }

    /// Compiles a kernel and has spirv-val look at the module, where that tool is installed.
    fn compile(&self, name: &str) -> Result<Result<Compiled, String>, TaskError> {
        let ending = if name.contains('.') { "" } else { ".comp" };
        let path = format!("{}/{name}{ending}", self.set.sources);
        let compiled = match compile(self.root, &path)? {
            Ok(compiled) => compiled,
            Err(messages) => return Ok(Err(messages)),
        };
        Ok(match validate(&compiled.spirv)? {
            None => Ok(compiled),
            Some(messages) => Err(format!("{path}: error: invalid SPIR-V: {messages}\n")),
        })
    }
}

/// Compares one module: `here` as compiled now, `recorded` by the manifest, `module` as it is checked in.
fn compare(path: String, here: &Entry, recorded: Option<&Entry>, module: Option<&[u8]>) -> Option<Finding> {
    let (Some(recorded), Some(module)) = (recorded, module) else {
        return Some(Finding::Stale { path });
    };
    if recorded.source_sha256 != here.source_sha256 {
        return Some(Finding::Stale { path });
    }
    if recorded.spirv_sha256 != hash(module) {
        return Some(Finding::Replaced { path });
    }
    if recorded.spirv_sha256 != here.spirv_sha256 {
        let (theirs, ours) = (recorded.compiler.clone(), here.compiler.clone());
        return Some(Finding::OtherCompiler { path, theirs, ours });
    }
    None
}

/// What spirv-val says against a module; nothing where it is not installed.
fn validate(spirv: &[u8]) -> Result<Option<String>, TaskError> {
    let tool = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.1", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let failed = |source| TaskError::Program { program: "spirv-val", package: "spirv-tools", source };
    let mut tool = match tool {
        Ok(tool) => tool,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(failed(error)),
    };
    if let Some(mut input) = tool.stdin.take() {
        input.write_all(spirv).map_err(failed)?;
    }
    let output = tool.wait_with_output().map_err(failed)?;
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    Ok((!output.status.success()).then(|| said.trim().to_owned()))
}

/// The names without ending of the files in a folder that have this ending, sorted.
pub fn stems(folder: &Path, ending: &str) -> Result<Vec<String>, TaskError> {
    let mut stems = vec![];
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        if path.extension().is_some_and(|found| found == ending) {
            stems.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    stems.sort();
    Ok(stems)
}

/// As [`stems`], of the folders in it too: those of files in `lights` begin with `lights/`.
pub fn stems_below(folder: &Path, ending: &str) -> Result<Vec<String>, TaskError> {
    let mut all = stems(folder, ending)?;
    for entry in std::fs::read_dir(folder).map_err(TaskError::file(folder))? {
        let path = entry.map_err(TaskError::file(folder))?.path();
        if path.is_dir() {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            all.extend(stems_below(&path, ending)?.into_iter().map(|stem| format!("{name}/{stem}")));
        }
    }
    all.sort();
    Ok(all)
}

/// Leaves a file alone that is right already, so that nothing is built anew for it.
fn write_if_changed(path: &Path, bytes: &[u8]) -> Result<bool, TaskError> {
    if std::fs::read(path).is_ok_and(|there| there == bytes) {
        return Ok(false);
    }
    std::fs::write(path, bytes).map_err(TaskError::file(path))?;
    Ok(true)
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A checkout with kernels (name, text before `main`, body of `main`) and library files (name, text).
    pub fn checkout(kernels: &[(&str, &str, &str)], library: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let file = |path: String, text: String| {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        file("crates/arealight/spirv/README".to_owned(), String::new());
        file("shaders/include/arealight/README".to_owned(), String::new());
        for (name, before, body) in kernels {
            let head = "#version 450\n#extension GL_GOOGLE_include_directive : require\n";
            let text = format!("{head}{before}\nlayout(local_size_x = 1) in;\nvoid main() {{ {body} }}\n");
            file(format!("shaders/kernels/{name}.comp"), text);
        }
        for (name, text) in library {
            file(format!("shaders/include/arealight/{name}.glsl"), (*text).to_owned());
        }
        folder
    }

    const ONE: &str = "crates/arealight/spirv/one.spv";
    const TWO: &str = "crates/arealight/spirv/two.spv";

    fn kernels_of(folder: &tempfile::TempDir) -> Checkout<'_> {
        Checkout { root: folder.path(), set: &SETS[0] }
    }

    fn findings(folder: &tempfile::TempDir) -> Vec<Finding> {
        kernels_of(folder).check().unwrap().1
    }

    fn compiled_checkout() -> tempfile::TempDir {
        let folder = checkout(
            &[("one", "#include \"arealight/part.glsl\"", "float x = PART;"), ("two", "", "")],
            &[("part", "#define PART 1.0\n")],
        );
        assert!(kernels_of(&folder).write(&[]).unwrap());
        folder
    }

    #[test]
    fn what_was_just_written_is_fresh() {
        let folder = compiled_checkout();
        assert_eq!(findings(&folder), []);
    }

    #[test]
    fn a_changed_include_makes_its_kernel_stale_and_no_other() {
        let folder = compiled_checkout();
        // The same SPIR-V would come of it: the sources count.
        let part = folder.path().join("shaders/include/arealight/part.glsl");
        std::fs::write(part, "#define PART 1.0 // one\n").unwrap();
        assert_eq!(findings(&folder), [Finding::Stale { path: ONE.to_owned() }]);
    }

    #[test]
    fn a_module_from_elsewhere_is_found_out() {
        let folder = compiled_checkout();
        std::fs::copy(folder.path().join(ONE), folder.path().join(TWO)).unwrap();
        assert_eq!(findings(&folder), [Finding::Replaced { path: TWO.to_owned() }]);
    }

    #[test]
    fn a_missing_module_is_stale_and_one_without_a_source_an_orphan() {
        let folder = compiled_checkout();
        let path = "crates/arealight/spirv/three.spv".to_owned();
        std::fs::rename(folder.path().join(ONE), folder.path().join(&path)).unwrap();
        assert_eq!(findings(&folder), [Finding::Stale { path: ONE.to_owned() }, Finding::Orphan { path }]);
    }

    #[test]
    fn another_compiler_is_a_note_unless_strict() {
        let folder = compiled_checkout();
        // Another compiler's module: one that the manifest records, of the same sources.
        let mut other = std::fs::read(folder.path().join(ONE)).unwrap();
        other[8] ^= 1;
        std::fs::write(folder.path().join(ONE), &other).unwrap();
        let mut manifest = Manifest::read(&kernels_of(&folder).modules()).unwrap();
        manifest.kernels.get_mut("one").unwrap().spirv_sha256 = hash(&other);
        std::fs::write(Manifest::path(&kernels_of(&folder).modules()), manifest.to_text()).unwrap();

        let findings = findings(&folder);
        assert!(
            matches!(&findings[..], [Finding::OtherCompiler { path, .. }] if path == ONE),
            "{findings:?}"
        );
        assert!(!findings[0].is_error(false));
        assert!(findings[0].is_error(true));
    }

    #[test]
    fn a_kernel_that_does_not_compile_keeps_the_others_from_nothing() {
        let folder = checkout(&[("bad", "", "x"), ("good", "", "")], &[]);
        assert!(!kernels_of(&folder).write(&[]).unwrap());
        let manifest = Manifest::read(&kernels_of(&folder).modules()).unwrap();
        assert_eq!(manifest.kernels.keys().collect::<Vec<_>>(), ["good"]);
        let findings = findings(&folder);
        assert!(matches!(&findings[..], [Finding::Broken { .. }]), "{findings:?}");
    }
}
