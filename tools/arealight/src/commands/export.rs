//! `arealight export`

mod bridges;
mod folder;
mod interface;
mod manifest;
mod single;
mod target;
mod translate;

use crate::failure::Failure;
use crate::output::print;
use arealight::kernels;
use arealight::table::LAYERS;
use arealight_table::{Precision, Target, ggx_file};
use folder::{Folder, Plan};
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use target::TargetArguments;

/// Write what a shader author needs into DIR: the GLSL library, the table as KTX2, DDS and EXR, our kernels
/// as SPIR-V, an example, and manifest.json, which says what each file is and what your shader defines.
#[derive(clap::Args)]
pub struct Arguments {
    /// The folder; it is made where it is not there.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Replace files that an export did not write, or that were changed since.
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    target: TargetArguments,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

/// The GLSL library and its examples: paths in an export, and texts.
const LIBRARY: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/library.rs"));

/// The licences that the library comes with.
const LICENCES: [(&str, &str); 2] = [
    ("LICENSE-APACHE", include_str!("../../../../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../../../../LICENSE-MIT")),
];

/// A file of an export.
struct File {
    /// From the folder, with `/`.
    path: String,
    bytes: Vec<u8>,
    /// What it is.
    content: String,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let mut files = files(arguments)?;
    let (translated, targets) = arguments.target.files()?;
    files.extend(translated);
    let manifest = manifest::manifest(&files, LIBRARY, &targets);
    let bytes = format!("{manifest:#}\n").into_bytes();
    files.push(File { path: manifest::NAME.into(), bytes, content: String::new() });

    // See that nothing of anybody else's is in the way before anything is written
    let folder = Folder::open(&arguments.folder)?;
    let plan = folder.plan(&files)?;
    if !plan.foreign.is_empty() && !arguments.force {
        return Err(in_the_way(arguments, &plan));
    }
    folder.write(&files)?;
    print(&summary(arguments, &files, &plan))
}

/// Every file but the manifest.
fn files(arguments: &Arguments) -> Result<Vec<File>, Failure> {
    let mut files: Vec<File> = LIBRARY
        .iter()
        .chain(&LICENCES)
        .map(|(path, text)| File {
            path: (*path).into(),
            // The same bytes on every system
            bytes: text.replace("\r\n", "\n").into_bytes(),
            content: manifest::content_of(path).into(),
        })
        .collect();
    files.extend(single::FILES.map(|name| {
        let text = single::single(LIBRARY, name).replace("\r\n", "\n");
        // The self-test is for the default options
        let effects = arguments.target.effects().filter(|_| name != single::FILES[1]);
        File {
            path: format!("single/{name}"),
            bytes: effects.map_or(text.clone(), |effects| single::resolved(text, effects)).into_bytes(),
            content: "the GLSL library in one file; include it or paste it".into(),
        }
    }));
    let table = ggx_file();
    for (name, target, floats) in [
        ("ggx.ktx2", Target::Ktx2(Precision::Half), "rgba16f"),
        ("ggx.dds", Target::Dds(Precision::Half), "rgba16f"),
        ("ggx.exr", Target::Exr, "rgba32f"),
    ] {
        let bytes = table.write(target).map_err(|error| Failure::input(&arguments.folder, error))?;
        let size = table.table.size();
        let content =
            format!("the built-in table of GGX: {LAYERS} layers of {size} x {size} texels, {floats}");
        files.push(File { path: format!("tables/{name}"), bytes, content });
    }
    for kernel in kernels::ALL {
        files.push(File {
            path: format!("spirv/{}.spv", kernel.name),
            bytes: kernel.spirv.to_vec(),
            content: "SPIR-V 1.3 for Vulkan 1.1, entry point main; see `kernels`".into(),
        });
    }
    Ok(files)
}

fn in_the_way(arguments: &Arguments, plan: &Plan) -> Failure {
    const MOST: usize = 8;
    let mut message = String::from("these files are not of an export, or were changed since:");
    for path in plan.foreign.iter().take(MOST) {
        let _ = write!(message, " {path}");
    }
    if plan.foreign.len() > MOST {
        let _ = write!(message, " and {} more", plan.foreign.len() - MOST);
    }
    message += ". Nothing was written; name another folder, or replace them by --force";
    Failure::output(&arguments.folder, message)
}

fn summary(arguments: &Arguments, files: &[File], plan: &Plan) -> String {
    let bytes: usize = files.iter().map(|file| file.bytes.len()).sum();
    if arguments.json {
        let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
        let summary = json!({
            "folder": arguments.folder.display().to_string(),
            "files": paths,
            "bytes": bytes,
            "replaced": plan.foreign,
            "left": plan.left,
        });
        return format!("{summary:#}\n");
    }
    let folder = arguments.folder.display();
    let mut text = format!("wrote {} files, {bytes} bytes, to {folder}\n", files.len());
    for path in &plan.left {
        let _ = writeln!(text, "{path} is of an earlier export, and no longer a part: delete it");
    }
    let _ = writeln!(
        text,
        "Next: add {folder}/include to your compiler's include folders, and see {folder}/manifest.json for \
        the bridges, and {folder}/examples"
    );
    text
}
