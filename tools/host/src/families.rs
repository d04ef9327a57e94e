//! Families of GPU whose compilers run on a machine that has none of them.
//!
//! Mesa's RADV makes code for any Radeon by itself (*null hardware*). For Intel and Adreno a library stands
//! for the kernel's driver and does nothing; `tools/compilers.sh` builds both, and the folder that it prints
//! is [`COMPILERS`].

use std::path::{Path, PathBuf};
use std::process::Command;

/// The variable that names the folder of `tools/compilers.sh`.
pub const COMPILERS: &str = "AREALIGHT_COMPILERS";

/// Intel's that both the driver and what stands for the kernel know, from Skylake on.
const INTEL: [&str; 11] = ["skl", "kbl", "cfl", "icl", "ehl", "tgl", "rkl", "dg1", "adl", "rpl", "dg2"];

/// What makes code for a family.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Driver {
    /// The file by which the Vulkan loader finds the driver.
    manifest: PathBuf,
    /// The variable that lets it see one family alone, and its value.
    family: (&'static str, String),
    /// What stands for the kernel's driver, where it needs that.
    shim: Option<PathBuf>,
}

/// Why nothing makes code for a family.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoDriver {
    /// Mesa's driver is not installed.
    #[error("{0}, is not installed: on Debian, apt-get install mesa-vulkan-drivers")]
    NotInstalled(&'static str),
    /// What runs it without hardware is not there.
    #[error(
        "{0} needs what tools/compilers.sh builds, in two minutes: {COMPILERS}=\"$(tools/compilers.sh)\""
    )]
    NotBuilt(String),
}

impl Driver {
    /// The driver of a family, as Mesa calls it: `navi21`, `vega10` (Radeon), `tgl`, `dg2` (Intel), `a660`
    /// (Adreno). Whether Mesa knows a Radeon or an Adreno of that name shows when it runs.
    ///
    /// # Errors
    /// Where a part of it is not on this machine.
    pub fn of(family: &str) -> Result<Self, NoDriver> {
        let built = |name: &str| {
            let file = std::env::var_os(COMPILERS).map(|folder| Path::new(&folder).join(name));
            file.filter(|file| file.is_file()).ok_or_else(|| NoDriver::NotBuilt(family.to_owned()))
        };
        let adreno = family.strip_prefix('a').filter(|chip| chip.parse::<u32>().is_ok());
        Ok(if INTEL.contains(&family) {
            Self {
                manifest: manifest("intel_icd", "Mesa's driver of Intel's GPUs")?,
                family: ("INTEL_STUB_GPU_PLATFORM", family.to_owned()),
                shim: Some(built("libintel_noop_drm_shim.so")?),
            }
        } else if let Some(chip) = adreno {
            Self {
                manifest: built("freedreno_icd.json")?,
                family: ("FD_GPU_ID", chip.to_owned()),
                shim: Some(built("libfreedreno_noop_drm_shim.so")?),
            }
        } else {
            Self {
                manifest: manifest("radeon_icd", "RADV, Mesa's driver of Radeon cards")?,
                family: ("RADV_FORCE_FAMILY", family.to_owned()),
                shim: None,
            }
        })
    }

    /// Lets a process see nothing but the family.
    pub fn set_environment(&self, command: &mut Command) {
        // What would change the driver's list of devices, or what its compiler makes
        let debug =
            ["RADV_DEBUG", "RADV_PERFTEST", "ACO_DEBUG", "INTEL_DEBUG", "TU_DEBUG", "IR3_SHADER_DEBUG"];
        for name in ["VK_ADD_DRIVER_FILES", "VK_INSTANCE_LAYERS"].iter().chain(&debug) {
            command.env_remove(name);
        }
        command
            .env("VK_DRIVER_FILES", &self.manifest)
            .env("VK_ICD_FILENAMES", &self.manifest)
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .env("MESA_GLSL_CACHE_DISABLE", "true")
            .env(self.family.0, &self.family.1)
            .envs(self.shim.iter().map(|library| ("LD_PRELOAD", library)));
    }

    /// What the family's devices have in their names, in small letters.
    pub fn chip(&self) -> &str {
        &self.family.1
    }
}

/// An installed driver's file whose name begins so: one that `VK_DRIVER_FILES` or `VK_ICD_FILENAMES` names,
/// else one of the loader's folders, whatever those variables name.
fn manifest(begins: &str, driver: &'static str) -> Result<PathBuf, NoDriver> {
    let is_of_driver =
        |file: &PathBuf| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(begins));
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].into_iter().filter_map(std::env::var_os);
    let mut named = named.flat_map(|files| std::env::split_paths(&files).collect::<Vec<_>>());
    if let Some(file) = named.find(|file| is_of_driver(file) && file.is_file()) {
        return Ok(file);
    }
    let data = std::env::var("XDG_DATA_DIRS").unwrap_or_else(|_| "/usr/local/share:/usr/share".to_owned());
    let folders =
        ["/etc"].into_iter().chain(data.split(':')).map(|folder| Path::new(folder).join("vulkan/icd.d"));
    let entries = folders.filter_map(|folder| std::fs::read_dir(folder).ok()).flatten();
    let mut files: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_of_driver).collect();
    // Debian names the architecture in the file: the driver of this one comes first
    files.sort_by_key(|file| (!file.to_string_lossy().contains(std::env::consts::ARCH), file.clone()));
    files.into_iter().next().ok_or(NoDriver::NotInstalled(driver))
}
