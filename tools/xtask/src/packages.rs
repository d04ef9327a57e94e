//! `packages`: what would be published is whole, and nothing that it is built from asks for a newer Rust than
//! is promised.

use crate::TaskError;
use crate::cargo::{cargo, metadata};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What packages must hold beside their sources, which compiling would not miss everywhere.
const NEEDED: [(&str, &[&str]); 3] = [
    (
        "arealight",
        &[
            "spirv/shade.spv",
            "spirv/texture_load.spv",
            "spirv/texture_kernel.spv",
            "spirv/manifest.json",
            "tables/ggx.f32",
        ],
    ),
    ("arealight-table", &["tables/ggx-fit-error.txt"]),
    ("arealight-capi", &["include/arealight.h", "arealight.pc.in", "cmake/arealight-config.cmake.in"]),
];

/// What every package must hold.
const NEEDED_BY_ALL: [&str; 4] = ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT"];

/// Cargo's metadata, as far as it is looked at.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    workspace_members: BTreeSet<String>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    /// No registry where it is not published, none named where it is.
    publish: Option<Vec<String>>,
    rust_version: Option<String>,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    deps: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    pkg: String,
    dep_kinds: Vec<DependencyKind>,
}

#[derive(Deserialize)]
struct DependencyKind {
    kind: Option<String>,
}

/// Whether every published crate packs, with what it needs, and depends on nothing that wants a newer Rust.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let metadata: Metadata = metadata(root, &[])?;
    let published: Vec<&Package> = metadata.published().collect();
    let mut wrong = metadata.too_new();

    // Pack all at once, since they depend on each other: cargo 1.90 or newer can. What is not committed
    // counts too. A lock file of each package would be resolved anew, from a registry that may be out of
    // reach
    let mut arguments =
        vec!["package", "--no-verify", "--allow-dirty", "--locked", "--quiet", "--exclude-lockfile"];
    for package in &published {
        arguments.extend(["-p", &package.name]);
    }
    cargo(root, &arguments)?;
    for package in &published {
        let list =
            ["package", "--list", "--allow-dirty", "--quiet", "--exclude-lockfile", "-p", &package.name];
        let list = cargo(root, &list)?;
        let files: BTreeSet<String> = list.lines().map(|line| line.replace('\\', "/")).collect();
        wrong.extend(missing(&package.name, &files));
        println!("{}: {} files", package.name, files.len());
    }
    for message in &wrong {
        eprintln!("error: {message}");
    }
    let good = wrong.is_empty() && !published.is_empty();
    println!("{} packages checked: {}", published.len(), if good { "good" } else { "see above" });
    Ok(good)
}

impl Metadata {
    /// The crates that are published.
    fn published(&self) -> impl Iterator<Item = &Package> {
        let members = &self.workspace_members;
        self.packages.iter().filter(|package| members.contains(&package.id) && package.publish.is_none())
    }

    /// Which packages that a published crate is built from want a newer Rust than it promises.
    fn too_new(&self) -> Vec<String> {
        let nodes: BTreeMap<&str, &Node> =
            self.resolve.nodes.iter().map(|node| (node.id.as_str(), node)).collect();
        let packages: BTreeMap<&str, &Package> =
            self.packages.iter().map(|package| (package.id.as_str(), package)).collect();
        let mut wrong = vec![];
        for package in self.published() {
            let Some(promised) = &package.rust_version else {
                wrong.push(format!("{}: Cargo.toml has no rust-version", package.name));
                continue;
            };
            // Traverse what is built, which leaves dependencies of tests out
            let (mut seen, mut next) = (BTreeSet::new(), vec![package.id.as_str()]);
            while let Some(id) = next.pop() {
                if !seen.insert(id) {
                    continue;
                }
                if let Some(built) = packages.get(id)
                    && let Some(wanted) = &built.rust_version
                    && version(wanted) > version(promised)
                {
                    let names = (&package.name, &built.name);
                    wrong.push(format!(
                        "{} promises Rust {promised}, but {} wants {wanted}",
                        names.0, names.1
                    ));
                }
                let built = nodes.get(id).into_iter().flat_map(|node| &node.deps);
                let built =
                    built.filter(|one| one.dep_kinds.iter().any(|kind| kind.kind.as_deref() != Some("dev")));
                next.extend(built.map(|one| one.pkg.as_str()));
            }
        }
        wrong
    }
}

/// Which files a package lacks.
fn missing(name: &str, files: &BTreeSet<String>) -> Vec<String> {
    let own = NEEDED.iter().filter(|(package, _)| *package == name).flat_map(|(_, needed)| needed.iter());
    let lacks = own.chain(&NEEDED_BY_ALL).filter(|file| !files.contains(**file));
    lacks.map(|file| format!("the package {name} lacks {file}")).collect()
}

/// A version's numbers.
fn version(text: &str) -> Vec<u32> {
    let mut numbers: Vec<u32> = text.split('.').map(|part| part.parse().unwrap_or(0)).collect();
    numbers.resize(3, 0);
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_package_without_its_kernels_or_licence_is_found_out() {
        let mut files: BTreeSet<String> = NEEDED_BY_ALL.iter().map(ToString::to_string).collect();
        assert_eq!(missing("arealight-vk", &files), Vec::<String>::new());
        assert_eq!(
            missing("arealight-table", &files),
            ["the package arealight-table lacks tables/ggx-fit-error.txt"]
        );
        assert_eq!(missing("arealight", &files).len(), 5);
        files.remove("LICENSE-MIT");
        assert_eq!(missing("arealight-vk", &files), ["the package arealight-vk lacks LICENSE-MIT"]);
    }

    #[test]
    fn a_dependency_that_wants_a_newer_rust_is_named_and_one_of_tests_is_not() {
        let text = r#"{
            "workspace_members": ["ours"],
            "packages": [
                {"id": "ours", "name": "ours", "publish": null, "rust_version": "1.88"},
                {"id": "old", "name": "old", "publish": null, "rust_version": "1.9.1"},
                {"id": "new", "name": "new", "publish": null, "rust_version": "1.88.1"},
                {"id": "newest", "name": "newest", "publish": null, "rust_version": "1.90"}
            ],
            "resolve": {"nodes": [
                {"id": "ours", "deps": [
                    {"pkg": "old", "dep_kinds": [{"kind": null}]},
                    {"pkg": "newest", "dep_kinds": [{"kind": "dev"}]}
                ]},
                {"id": "old", "deps": [{"pkg": "new", "dep_kinds": [{"kind": "build"}, {"kind": null}]}]},
                {"id": "new", "deps": []},
                {"id": "newest", "deps": []}
            ]}
        }"#;
        let metadata: Metadata = serde_json::from_str(text).unwrap();
        assert_eq!(metadata.too_new(), ["ours promises Rust 1.88, but new wants 1.88.1"]);
    }
}
