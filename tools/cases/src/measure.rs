//! How far answers lie from the truth, a family of cases at a time.

use crate::answers::Answer;
use crate::cases::{Case, CaseMaterial};
use arealight::LightShape;
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};

/// Cases of one kind: the light's shape, the surface's material, and whether the light is textured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Family {
    /// `polygon`, `disk`, `sphere` or `cylinder`.
    pub shape: &'static str,
    /// Whether the light has a texture.
    pub textured: bool,
    /// `diffuse`, `rough diffuse`, `ggx`, `ggx + diffuse`, `ggx over diffuse` where the two are coupled,
    /// `anisotropic ggx`, `anisotropic ggx + diffuse`, `coat` or `medium`.
    pub material: &'static str,
}

impl Family {
    /// The family of a case.
    pub fn of(case: &Case) -> Self {
        let shape = match case.light.shape {
            LightShape::Disk { .. } => "disk",
            LightShape::Sphere { .. } => "sphere",
            LightShape::Tube { .. } => "cylinder",
            LightShape::Polygon(_) | LightShape::Mesh { .. } => "polygon",
        };
        let textured = case.image.is_some();
        let material = match &case.material {
            CaseMaterial::Diffuse { roughness: 0.0, .. } => "diffuse",
            CaseMaterial::Diffuse { .. } => "rough diffuse",
            CaseMaterial::Ggx { coat: Some(_), .. } => "coat",
            CaseMaterial::Ggx { sheen: Some(_), .. } => "sheen_over",
            CaseMaterial::Sheen(_) => "sheen",
            CaseMaterial::Medium { .. } => "medium",
            CaseMaterial::Ggx { albedo: Some(_), coupled: true, .. } => "ggx over diffuse",
            CaseMaterial::Ggx { alpha, albedo, .. } => match (alpha.x == alpha.y, albedo) {
                (true, None) => "ggx",
                (true, Some(_)) => "ggx + diffuse",
                (false, None) => "anisotropic ggx",
                (false, Some(_)) => "anisotropic ggx + diffuse",
            },
        };
        Self { shape, textured, material }
    }
}

impl std::fmt::Display for Family {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let textured = if self.textured { "textured " } else { "" };
        f.pad(&format!("{textured}{}, {}", self.shape, self.material))
    }
}

/// The errors of one family. Where there is no answer all of them are zero.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measure {
    /// The family.
    #[serde(flatten)]
    pub family: Family,
    /// How many of its cases have an answer.
    pub answered: usize,
    /// How many have none.
    pub unanswered: usize,
    /// `sqrt(mean over cases and channels of (answer - truth)²) / mean truth`.
    pub rmse_over_mean: f64,
    /// Mean over cases and channels of `|answer - truth|` of lights of unit radiance.
    pub mean_unit_error: f64,
    /// Median over the cases of `max |answer - truth| / max truth`, the maxima over the channels.
    pub median: f64,
    /// 95 % quantile of the same, interpolated between cases.
    pub quantile_95: f64,
    /// Largest of the same.
    pub worst: f64,
    /// The case of the largest.
    pub worst_case: String,
}

/// A case whose radiance is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("case '{case}' has no known radiance")]
pub struct UnknownTruth {
    /// The case's name.
    pub case: String,
}

/// Measures `answers`, one a case in the cases' order, against `truth`, which is found by name and may hold
/// more. Families come in the order of their names.
///
/// # Errors
/// [`UnknownTruth`] if an answered case has no truth.
pub fn measure(cases: &[Case], answers: &[Answer], truth: &[Answer]) -> Result<Vec<Measure>, UnknownTruth> {
    let truth: HashMap<&str, [f64; 3]> =
        truth.iter().filter_map(|answer| Some((answer.name.as_str(), answer.radiance?))).collect();
    let mut families: BTreeMap<Family, Errors> = BTreeMap::new();
    for (case, answer) in cases.iter().zip(answers) {
        let errors = families.entry(Family::of(case)).or_default();
        match answer.radiance {
            None => errors.unanswered += 1,
            Some(radiance) => {
                let known = truth.get(case.name.as_str());
                let known = known.ok_or_else(|| UnknownTruth { case: case.name.clone() })?;
                errors.add(case, radiance, *known);
            }
        }
    }
    Ok(families.into_iter().map(|(family, errors)| errors.finish(family)).collect())
}

/// `max |answer - truth| / max truth` over the channels: 0 for a right answer, also to a black case, and
/// infinite for a wrong answer to a black case.
pub fn relative_error(answer: [f64; 3], truth: [f64; 3]) -> f64 {
    let difference = (0..3).map(|i| (answer[i] - truth[i]).abs()).fold(0.0, f64::max);
    quotient(difference, truth.into_iter().fold(0.0, f64::max))
}

/// A share that is zero where there is nothing to share.
fn quotient(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// The sums of a family.
#[derive(Default)]
struct Errors<'a> {
    unanswered: usize,
    squares: f64,
    truths: f64,
    units: f64,
    relative: Vec<(f64, &'a str)>,
}

impl<'a> Errors<'a> {
    fn add(&mut self, case: &'a Case, answer: [f64; 3], truth: [f64; 3]) {
        for i in 0..3 {
            self.units += quotient((answer[i] - truth[i]).abs(), case.radiance[i]);
            self.squares += (answer[i] - truth[i]).powi(2);
            self.truths += truth[i];
        }
        self.relative.push((relative_error(answer, truth), &case.name));
    }

    fn finish(mut self, family: Family) -> Measure {
        self.relative.sort_by(|a, b| a.0.total_cmp(&b.0));
        let values = (3 * self.relative.len()).max(1) as f64;
        let (worst, worst_case) = self.relative.last().copied().unwrap_or_default();
        Measure {
            family,
            answered: self.relative.len(),
            unanswered: self.unanswered,
            rmse_over_mean: quotient((self.squares / values).sqrt(), self.truths / values),
            mean_unit_error: self.units / values,
            median: quantile(&self.relative, 0.5),
            quantile_95: quantile(&self.relative, 0.95),
            worst,
            worst_case: worst_case.to_owned(),
        }
    }
}

/// The quantile of sorted values, linear between them. Zero of none.
fn quantile(sorted: &[(f64, &str)], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let (low, high) = (sorted[below].0, sorted[(below + 1).min(last)].0);
    // Equal values first: infinity minus infinity is no number
    if low == high { low } else { low + (high - low) * (place - below as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::read_cases;
    use glam::DVec3;

    fn cases() -> Vec<Case> {
        let case = |name: &str, material: &str| {
            format!(
                r#"{{"name": "{name}", "position": [0, 0, 0], "normal": [0, 0, 1], "view": [0, 0, 1],
                 {material}, "light": {{"type": "polygon", "radiance": [1, 1, 1],
                 "vertices": [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}}}}"#
            )
        };
        let texts = [
            case("a", r#""alpha": 0.5"#),
            case("b", r#""alpha": 0.5, "F0": [0.5, 0.5, 0.5]"#),
            case("c", r#""bsdf": "diffuse", "albedo": [1, 1, 1]"#),
            case("d", r#""alpha_x": 0.5, "alpha_y": 0.1"#),
        ];
        read_cases(&format!(r#"{{"cases": [{}]}}"#, texts.join(","))).unwrap()
    }

    #[test]
    fn each_family_is_measured_apart() {
        let truth =
            [("c", 4.0), ("b", 1.0), ("a", 3.0), ("d", 1.0)].map(|(n, v)| Answer::new(n, DVec3::splat(v)));
        let answers = [
            Answer::new("a", DVec3::new(3.0, 3.0, 6.0)),
            Answer::new("b", DVec3::ONE),
            Answer::new("c", DVec3::splat(3.0)),
            Answer::none("d", "not yet"),
        ];
        let measures = measure(&cases(), &answers, &truth).unwrap();
        let names: Vec<String> = measures.iter().map(|m| m.family.to_string()).collect();
        assert_eq!(names, ["polygon, anisotropic ggx", "polygon, diffuse", "polygon, ggx"]);
        assert_eq!((measures[0].answered, measures[0].unanswered), (0, 1));
        assert_eq!((measures[1].rmse_over_mean, measures[1].median), (0.25, 0.25));
        // errors 0, 0, 3, 0, 0, 0 over a mean truth of 2; the cases' relative errors are 1 and 0
        let ggx = &measures[2];
        assert!((ggx.rmse_over_mean - (9.0_f64 / 6.0).sqrt() / 2.0).abs() < 1e-15);
        assert!((ggx.median - 0.5).abs() < 1e-15 && (ggx.quantile_95 - 0.95).abs() < 1e-15);
        assert!((ggx.mean_unit_error - 0.5).abs() < 1e-15);
        assert_eq!((ggx.worst, ggx.worst_case.as_str()), (1.0, "a"));
    }

    #[test]
    fn black_cases_are_right_or_infinitely_wrong() {
        assert_eq!(relative_error([0.0; 3], [0.0; 3]), 0.0);
        assert_eq!(relative_error([1e-9, 0.0, 0.0], [0.0; 3]), f64::INFINITY);
        assert_eq!(quantile(&[(f64::INFINITY, ""); 3], 0.95), f64::INFINITY);
    }

    #[test]
    fn a_case_without_truth_is_named() {
        let answers: Vec<Answer> = cases().iter().map(|c| Answer::new(&c.name, DVec3::ONE)).collect();
        let error = measure(&cases(), &answers, &answers[..2]).unwrap_err();
        assert_eq!(error.to_string(), "case 'c' has no known radiance");
    }
}
