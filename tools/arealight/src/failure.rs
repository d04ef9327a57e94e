//! Why a command failed, and the exit code that says so.

use std::path::PathBuf;
use std::process::ExitCode;

/// A failure of a command. Its text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// An input file is missing or does not hold what it should. Exit code 3.
    #[error("{}: {message}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// A scene that cannot be shown; the text names the file. Exit code 3.
    #[error("{0}")]
    Scene(String),
    /// An argument is well-formed but cannot be used. Exit code 2, as for a malformed one.
    #[error("{argument}: {message}")]
    Argument {
        /// The argument.
        argument: &'static str,
        /// What is wrong with it.
        message: String,
    },
    /// No Vulkan, no device, a missing feature, or a device that was lost. Exit code 4.
    #[error("{0}")]
    Device(String),
    /// No driver whose compiler can be asked, or not the version that a file is of; or no matplotlib. Exit
    /// code 6.
    #[error("{0}")]
    NoProgram(String),
    /// An output file cannot be written. Exit code 5.
    #[error("{}: cannot write: {message}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        message: String,
    },
}

impl Failure {
    /// The process's exit code.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Argument { .. } => 2,
            Self::Input { .. } | Self::Scene(_) => 3,
            Self::Device(_) => 4,
            Self::Output { .. } => 5,
            Self::NoProgram(_) => 6,
        })
    }

    /// An [`Failure::Input`] of anything that prints.
    pub fn input(path: impl Into<PathBuf>, error: impl std::fmt::Display) -> Self {
        Self::Input { path: path.into(), message: error.to_string() }
    }

    /// An [`Failure::Output`] of anything that prints.
    pub fn output(path: impl Into<PathBuf>, error: impl std::fmt::Display) -> Self {
        Self::Output { path: path.into(), message: error.to_string() }
    }
}
