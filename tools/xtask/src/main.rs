//! Project tasks. Most need a shader compiler. Run them from anywhere in the checkout:
//!
//! ```text
//! export SHADERC_LIB_DIR="$(tools/shaderc.sh)"   # where xtask is not built yet
//! cargo run -p xtask -- shaders                  # shaders/kernels/*.comp -> crates/arealight/spirv/*.spv,
//!                                                # and those of tools, benchmarks and tests
//! cargo run -p xtask -- shaders --check          # are they fresh?
//! cargo run -p xtask -- includes                 # does each library file stand alone and keep the rules?
//! cargo run -p xtask -- header                   # crates/arealight-capi -> its include/arealight.h
//! cargo run -p xtask -- matrix                   # does the library compile for hosts of every kind?
//! cargo run -p xtask -- quotes                   # put the code that documents show into them
//! cargo run -p xtask -- links                    # do the links of documents lead somewhere?
//! cargo run -p xtask -- packages                 # is what would be published whole?
//! cargo run -p xtask -- dependencies             # does the product stand without the laboratory?
//! cargo run -p xtask -- types                    # has the crate arealight few public types?
//! cargo run -p xtask -- circles                  # do modules need each other?
//! cargo run -p xtask -- size                     # how much there is, and is a line too wide?
//! ```

#![forbid(unsafe_code)]

mod cargo;
mod circles;
mod compile;
mod dependencies;
mod header;
mod includes;
mod library;
mod links;
mod lint;
mod manifest;
mod matrix;
mod packages;
mod parallel;
mod quotes;
mod shaders;
mod size;
mod types;

use clap::{Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Project tasks of Arealight.
#[derive(Parser)]
#[command(name = "xtask", about, max_term_width = 100)]
struct CommandLine {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Compile the kernels to the SPIR-V that the crate `arealight` embeds.
    Shaders(shaders::Arguments),
    /// Compile each file of the GLSL library on its own, and check the library's rules.
    Includes,
    Header(header::Arguments),
    Matrix(matrix::Arguments),
    Quotes(quotes::Arguments),
    /// Check that every link of a document leads somewhere, and that docs/SUMMARY.md has every page.
    Links,
    /// Pack every crate that is published, and check that it is whole and that no dependency wants a newer
    /// Rust.
    Packages,
    /// Check that no crate under crates/ depends on tools, tests, benches or examples, and none for engines
    /// on those for fitting.
    Dependencies,
    /// Check that no modules of the library, the recorder and the scenes need each other.
    Circles,
    /// Count lines of code and words of documents, and check that no line is too wide.
    Size,
    /// Check that the crate arealight has no more public types than a programmer cares to know.
    Types,
}

/// A task that cannot be carried out. Its text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TaskError {
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    #[error("{}: {source}; delete the file and run: cargo run -p xtask -- shaders", path.display())]
    Manifest { path: PathBuf, source: serde_json::Error },
    #[error("what cargo metadata prints is not what was expected: {0}")]
    Metadata(serde_json::Error),
    #[error("the shader compiler cannot start: {0}")]
    Compiler(shaderc::Error),
    #[error("there is no kernel {name} (there are: {available})")]
    NoSuchKernel { name: String, available: String },
    #[error("cannot run {program}: {source}. On Debian: apt-get install {package}")]
    Program { program: &'static str, package: &'static str, source: std::io::Error },
    #[error("cargo {arguments} failed:\n{message}")]
    Cargo { arguments: String, message: String },
    #[error("crates/arealight-capi: cannot make the header: {message}")]
    Header { message: String },
    #[error("arealight export failed: {message}")]
    Export { message: String },
}

impl TaskError {
    fn file(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        move |source| Self::File { path: path.to_owned(), source }
    }
}

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = root.canonicalize().unwrap_or(root);
    let outcome = match CommandLine::parse().task {
        Task::Shaders(arguments) => shaders::run(&root, &arguments),
        Task::Includes => includes::run(&root),
        Task::Header(arguments) => header::run(&root, &arguments),
        Task::Matrix(arguments) => matrix::run(&root, &arguments),
        Task::Quotes(arguments) => quotes::run(&root, &arguments),
        Task::Links => links::run(&root),
        Task::Packages => packages::run(&root),
        Task::Dependencies => dependencies::run(&root),
        Task::Circles => circles::run(&root),
        Task::Size => size::run(&root),
        Task::Types => types::run(&root),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
