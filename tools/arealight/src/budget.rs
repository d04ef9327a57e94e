//! Levels by what was measured, as options of a command.

use crate::failure::Failure;
use arealight_benches::budget::{Budget, FrameLoad, Limit, ProfileLevel};
use arealight_benches::ladder::Ladder;
use std::path::{Path, PathBuf};

/// Reads what `arealight bench --save FILE` wrote.
///
/// # Errors
/// A file that cannot be read, or is something else.
pub fn read_profile(path: &Path) -> Result<Ladder, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::input(path, error))?;
    serde_json::from_str(&text).map_err(|error| {
        Failure::input(path, format!("{error}; write one with `arealight bench --save {}`", path.display()))
    })
}

/// What may not be exceeded, and what was measured.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct BudgetArguments {
    /// Shade on the most accurate level that takes no longer
    #[arg(long, value_name = "MS", requires = "profile", conflicts_with_all = ["max_error", "reference", "form_factor", "horizon", "specular_lobes", "lobes", "footprint"])]
    budget_ms: Option<f64>,
    /// Use the fastest level with RMSE/mean of at most this
    #[arg(long, value_name = "E", requires = "profile", conflicts_with_all = ["reference", "form_factor", "horizon", "specular_lobes", "lobes", "footprint"])]
    max_error: Option<f64>,
    /// What `arealight bench --save FILE` measured on this device
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
}

impl BudgetArguments {
    /// The level for a frame on a device; none without a budget. A profile of another device is said to be
    /// one.
    ///
    /// # Errors
    /// A profile without a budget, or that cannot be read; a budget that no level keeps, with the nearest.
    pub fn pick(&self, frame: FrameLoad, device: &str) -> Result<Option<ProfileLevel>, Failure> {
        let (argument, limit) = match (self.budget_ms, self.max_error) {
            (Some(limit), _) => ("--budget-ms", Limit::Milliseconds(limit)),
            (None, Some(limit)) => ("--max-error", Limit::Error(limit)),
            (None, None) if self.profile.is_some() => {
                let message = "is for --budget-ms or --max-error, and there is neither".into();
                return Err(Failure::Argument { argument: "--profile", message });
            }
            (None, None) => return Ok(None),
        };
        let Some(path) = &self.profile else { return Ok(None) };
        let profile = read_profile(path)?.profile().map_err(|error| Failure::input(path, error))?;
        if profile.device != device {
            let (path, of) = (path.display(), &profile.device);
            eprintln!("warning: {path}: was measured on '{of}', and this is '{device}': times will differ");
        }
        let picked = profile.within(Budget { frame, limit });
        picked.map(Some).map_err(|error| Failure::Argument { argument, message: error.to_string() })
    }
}
