//! `dependencies`: the product builds, and its tests run, without the laboratory.
//!
//! Two rules for every dependency that a manifest under `crates/` states, optional ones and those of tests
//! and build scripts too:
//! - it is on a package under `crates/`, or on one from outside this repository;
//! - a crate that an engine takes depends on none that is for fitting a BRDF.
//!
//! Tests are no exception. A published crate carries its tests and names what they depend on, so that an
//! unpublished tool would keep it from being published; and who changes a crate can run its tests without
//! building a renderer. A test that needs more than `crates/` lies in `tests/`, or with the tool that it
//! needs. Tests may use crates in the rules' direction.

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
    /// `dev` or `build`; none where the library itself depends on it.
    kind: Option<String>,
    /// Its folder; none where it comes from a registry.
    path: Option<PathBuf>,
}

/// Whether every crate under `crates/` keeps the rules.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let workspace: Workspace = metadata(root, &["--no-deps"])?;
    let wrong = workspace.violations();
    for message in &wrong {
        eprintln!("error: {message}");
    }
    let count = workspace.product().count();
    println!("{count} crates' dependencies checked: {}", if wrong.is_empty() { "good" } else { "see above" });
    Ok(wrong.is_empty())
}

impl Workspace {
    /// The packages under `crates/`.
    fn product(&self) -> impl Iterator<Item = &Package> {
        self.packages.iter().filter(|package| self.is_in_crates(&package.manifest_path))
    }

    fn is_in_crates(&self, path: &Path) -> bool {
        path.starts_with(self.workspace_root.join("crates"))
    }

    /// What breaks a rule, and which.
    fn violations(&self) -> Vec<String> {
        let listed = || ENGINE.iter().chain(&FITTING);
        let lost = listed().filter(|name| self.product().all(|package| package.name != **name));
        let mut wrong: Vec<_> = lost.map(|name| format!("crates/ holds no package {name}")).collect();
        for package in self.product() {
            if !listed().any(|name| *name == package.name) {
                wrong.push(format!(
                    "{}: is it for engines or for fitting? tools/xtask/src/dependencies.rs lists it under \
                    neither",
                    package.name
                ));
            }
            wrong.extend(package.dependencies.iter().filter_map(|one| self.violation(package, one)));
        }
        wrong
    }

    /// What is wrong with a dependency of a package under `crates/`.
    fn violation(&self, package: &Package, dependency: &Dependency) -> Option<String> {
        let names = (package.name.as_str(), dependency.name.as_str());
        let kind = dependency.kind.as_deref().unwrap_or("normal");
        if let Some(path) = self.place(dependency)
            && !self.is_in_crates(path)
        {
            let place = path.strip_prefix(&self.workspace_root).unwrap_or(path).display();
            return Some(format!(
                "{}: {kind} dependency on {}, which is in {place}, not crates/",
                names.0, names.1
            ));
        }
        (ENGINE.contains(&names.0) && FITTING.contains(&names.1))
            .then(|| format!("{}: {kind} dependency on {}, which engines do not take", names.0, names.1))
    }

    /// Where a dependency lies in this repository, if it does. One that a manifest would take from a registry
    /// counts by its name.
    fn place<'a>(&'a self, dependency: &'a Dependency) -> Option<&'a Path> {
        let member = || self.packages.iter().find(|package| package.name == dependency.name);
        dependency.path.as_deref().or_else(|| member()?.manifest_path.parent())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// This workspace, with a dependency more.
    fn workspace_with(package: &str, dependency: &str, kind: Option<&str>, from_registry: bool) -> Workspace {
        let mut workspace = workspace();
        let path = workspace.packages.iter().find(|one| one.name == dependency);
        let path = path.and_then(|one| one.manifest_path.parent()).map(Path::to_owned);
        let added = Dependency {
            name: dependency.to_owned(),
            kind: kind.map(str::to_owned),
            path: path.filter(|_| !from_registry),
        };
        workspace.packages.iter_mut().find(|one| one.name == package).unwrap().dependencies.push(added);
        workspace
    }

    fn workspace() -> Workspace {
        metadata(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."), &["--no-deps"]).unwrap()
    }

    #[test]
    fn the_product_depends_on_no_laboratory() {
        let workspace = workspace();
        assert_eq!(workspace.violations(), Vec::<String>::new());
        assert_eq!(workspace.product().count(), ENGINE.len() + FITTING.len());
    }

    /// The twin: each rule is seen to be broken, by every kind of dependency.
    #[test]
    fn a_dependency_on_the_laboratory_is_named() {
        let violations = |package, dependency, kind, from_registry| {
            workspace_with(package, dependency, kind, from_registry).violations()
        };
        let outside = |package: &str, kind: &str, dependency: &str, place: &str| {
            vec![format!("{package}: {kind} dependency on {dependency}, which is in {place}, not crates/")]
        };
        for (kind, named) in [(None, "normal"), (Some("dev"), "dev"), (Some("build"), "build")] {
            for from_registry in [false, true] {
                let found = violations("arealight-vk", "arealight-scene", kind, from_registry);
                assert_eq!(found, outside("arealight-vk", named, "arealight-scene", "tools/scene"));
                let found = violations("arealight-table", "arealight-oracle", kind, from_registry);
                let wanted = "dependency on arealight-oracle, which engines do not take";
                assert_eq!(found, [format!("arealight-table: {named} {wanted}")]);
            }
        }
        for (package, dependency, place) in [
            ("arealight", "arealight-tests", "tests"),
            ("arealight-fit", "arealight-benches", "benches"),
            ("arealight-capi", "arealight-examples", "examples/rust"),
            ("arealight-oracle", "arealight-cases", "tools/cases"),
        ] {
            let found = violations(package, dependency, Some("dev"), false);
            assert_eq!(found, outside(package, "dev", dependency, place));
        }
    }

    #[test]
    fn what_the_rules_allow_is_not_named() {
        for (package, dependency) in [
            ("arealight-oracle", "arealight-vk"),
            ("arealight-fit", "arealight-oracle"),
            ("arealight-vk", "arealight-table"),
            ("arealight", "proptest"),
            ("arealight-scene", "arealight-oracle"),
        ] {
            let found = workspace_with(package, dependency, None, false).violations();
            assert_eq!(found, Vec::<String>::new(), "{package} -> {dependency}");
        }
    }

    #[test]
    fn a_crate_that_is_new_or_renamed_is_named() {
        let mut workspace = workspace();
        let fit = workspace.packages.iter_mut().find(|one| one.name == "arealight-fit").unwrap();
        "arealight-plot".clone_into(&mut fit.name);
        let found = workspace.violations();
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(found[0], "crates/ holds no package arealight-fit");
        assert!(found[1].starts_with("arealight-plot: is it for engines or for fitting?"), "{found:?}");
    }
}
