//! `licences`: what others made is used under licences that allow what ours do, and comes from the registry.

use crate::TaskError;
use crate::cargo::metadata;
use serde::Deserialize;
use spdx::{Expression, ParseMode};
use std::path::Path;

/// Licences under which a program may be given on, whatever its own is.
const ALLOWED: [&str; 9] =
    ["MIT", "Apache-2.0", "Zlib", "BSD-2-Clause", "BSD-3-Clause", "ISC", "0BSD", "Unicode-3.0", "CC0-1.0"];

/// Packages of another licence that are tools of this checkout: nothing that is given on has them in it.
const TOOLS: [(&str, &str); 1] = [("cbindgen", "MPL-2.0")];

/// Where packages come from.
const REGISTRY: &str = "registry+";

/// Every package that the lock file has.
#[derive(Deserialize)]
struct Packages {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    license: Option<String>,
    /// None for those of this checkout.
    source: Option<String>,
}

/// Whether every package keeps the rules.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let Packages { packages } = metadata(root, &["--all-features"])?;
    let wrong: Vec<_> = packages.iter().filter_map(violation).collect();
    for message in &wrong {
        eprintln!("error: {message}");
    }
    println!(
        "{} packages' licences checked: {}",
        packages.len(),
        if wrong.is_empty() { "good" } else { "see above" }
    );
    Ok(wrong.is_empty())
}

/// What is wrong with a package.
fn violation(package: &Package) -> Option<String> {
    let Package { name, license, source } = package;
    if let Some(source) = source.as_deref().filter(|source| !source.starts_with(REGISTRY)) {
        return Some(format!("{name} comes from {source}, not from the registry"));
    }
    let Some(license) = license else { return Some(format!("{name} states no licence")) };
    if TOOLS.contains(&(name, license)) {
        return None;
    }
    // Old manifests write `A/B` for `A OR B`
    let expression = match Expression::parse_mode(license, ParseMode::LAX) {
        Ok(expression) => expression,
        Err(error) => return Some(format!("{name}: the licence \"{license}\" cannot be read: {error}")),
    };
    let is_allowed =
        expression.evaluate(|licence| licence.license.id().is_some_and(|id| ALLOWED.contains(&id.name)));
    (!is_allowed).then(|| format!("{name}: the licence {license} is not among {}", ALLOWED.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, license: Option<&str>, source: &str) -> Package {
        Package { name: name.into(), license: license.map(str::to_owned), source: Some(source.into()) }
    }

    #[test]
    fn licences_and_sources_that_are_not_allowed_are_named() {
        let of = |license| violation(&package("a", license, "registry+https://example.org"));
        for good in ["MIT", "MIT/Apache-2.0", "GPL-3.0 OR ISC", "(MIT OR Apache-2.0) AND Unicode-3.0"] {
            assert_eq!(of(Some(good)), None, "{good}");
        }
        for bad in ["GPL-3.0", "MIT AND GPL-3.0", "MPL-2.0", "no licence at all"] {
            assert!(of(Some(bad)).is_some_and(|said| said.starts_with("a: the licence")), "{bad}");
        }
        assert_eq!(of(None).as_deref(), Some("a states no licence"));
        assert_eq!(violation(&package("cbindgen", Some("MPL-2.0"), "registry+https://example.org")), None);
        let elsewhere = violation(&package("a", Some("MIT"), "git+https://example.org"));
        assert!(elsewhere.is_some_and(|said| said.contains("not from the registry")));
    }
}
