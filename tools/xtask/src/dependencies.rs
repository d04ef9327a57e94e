//! `dependencies`: the product builds, and its tests run, without the laboratory.
//!
//! A dependency that a manifest under `crates/` states, for tests and build scripts too, is on a package
//! under `crates/` or on one from outside this repository; and a crate that an engine takes depends on none
//! that is for fitting a BRDF. A test that needs more lies in `tests/`, or with the tool that it needs.

use crate::TaskError;
use crate::cargo::metadata;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The crates that an engine takes.
const ENGINE: [&str; 4] = ["arealight", "arealight-vk", "arealight-table", "arealight-capi"];
/// The crates for fitting a BRDF: ground truth, and the fit to it.
const FITTING: [&str; 2] = ["arealight-oracle", "arealight-fit"];

/// The workspace, as its manifests state it.
#[derive(Deserialize)]
struct Workspace {
    workspace_root: PathBuf,
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    /// The package's own name, whatever the manifest calls it.
    name: String,
}

/// Whether every crate under `crates/` keeps the rules.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let wrong = violations(&metadata(root, &["--no-deps"])?);
    for message in &wrong {
        eprintln!("error: {message}");
    }
    println!("dependencies of crates/: {}", if wrong.is_empty() { "good" } else { "see above" });
    Ok(wrong.is_empty())
}

/// What breaks a rule.
fn violations(Workspace { workspace_root, packages }: &Workspace) -> Vec<String> {
    let crates = workspace_root.join("crates");
    let (product, laboratory): (Vec<_>, Vec<_>) =
        packages.iter().partition(|package| package.manifest_path.starts_with(&crates));
    let is_listed = |name: &str| ENGINE.contains(&name) || FITTING.contains(&name);
    let mut wrong = vec![];
    for Package { name, dependencies, .. } in product {
        if !is_listed(name) {
            wrong.push(format!("{name} is new in crates/: tools/xtask/src/dependencies.rs does not list it"));
        }
        for Dependency { name: other } in dependencies {
            if laboratory.iter().any(|package| package.name == *other) {
                wrong.push(format!("{name} depends on {other}, which is not in crates/"));
            } else if ENGINE.contains(&name.as_str()) && FITTING.contains(&other.as_str()) {
                wrong.push(format!("{name} depends on {other}, which engines do not take"));
            }
        }
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is wrong with this workspace if a package depends on one more.
    fn with(package: &str, dependency: &str) -> Vec<String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut workspace: Workspace = metadata(&root, &["--no-deps"]).unwrap();
        let package = workspace.packages.iter_mut().find(|one| one.name == package).unwrap();
        package.dependencies.push(Dependency { name: dependency.to_owned() });
        violations(&workspace)
    }

    #[test]
    fn dependencies_on_the_laboratory_and_on_fitting_are_named() {
        for (package, dependency, wrong) in [
            ("arealight-vk", "arealight-scene", "is not in crates/"),
            ("arealight-oracle", "arealight-cases", "is not in crates/"),
            ("arealight-table", "arealight-oracle", "engines do not take"),
        ] {
            assert_eq!(with(package, dependency).len(), 1);
            assert!(with(package, dependency)[0].ends_with(wrong));
        }
        for (package, dependency) in [
            ("arealight-oracle", "arealight-vk"),
            ("arealight-fit", "arealight-oracle"),
            ("arealight", "proptest"),
            ("arealight-scene", "arealight-oracle"),
        ] {
            assert_eq!(with(package, dependency), Vec::<String>::new(), "{package} -> {dependency}");
        }
    }

    #[test]
    fn a_crate_that_is_new_is_named() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut workspace: Workspace = metadata(&root, &["--no-deps"]).unwrap();
        let fit = workspace.packages.iter_mut().find(|one| one.name == "arealight-fit").unwrap();
        "arealight-plot".clone_into(&mut fit.name);
        assert!(violations(&workspace)[0].starts_with("arealight-plot is new in crates/"));
    }
}
