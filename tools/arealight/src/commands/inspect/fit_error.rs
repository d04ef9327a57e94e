//! What a table file says of its fit, in numbers where it says it as `arealight table` writes it.

use serde_json::{Value, json};

/// What is said of one level: mean errors, each at a reflectance.
#[derive(Debug, Clone, PartialEq)]
pub struct FitErrors<'a> {
    /// The level, such as `one lobe`.
    pub level: &'a str,
    /// F0, and the mean absolute error there.
    pub errors: Vec<(f64, f64)>,
}

/// What is measured, and the numbers of each level:
/// `what; one lobe: 4e-4 at F0 = 0.02, 5e-4 at F0 = 0.04; ...`. None of words of another kind.
pub fn parse(text: &str) -> Option<(&str, Vec<FitErrors<'_>>)> {
    let (what, levels) = text.split_once("; ")?;
    Some((what, levels.split("; ").map(parse_level).collect::<Option<_>>()?))
}

fn parse_level(text: &str) -> Option<FitErrors<'_>> {
    let (level, errors) = text.split_once(": ")?;
    let error = |error: &str| {
        let (mean, f0) = error.split_once(" at F0 = ")?;
        Some((f0.parse().ok()?, mean.parse().ok()?))
    };
    Some(FitErrors { level, errors: errors.split(", ").map(error).collect::<Option<_>>()? })
}

/// The words as lines: what is measured, and one for each level.
pub fn lines(text: &str) -> Vec<String> {
    let Some((what, levels)) = parse(text) else { return vec![text.to_owned()] };
    let mut lines = vec![what.to_owned()];
    lines.extend(levels.iter().map(|FitErrors { level, errors }| {
        let errors: Vec<String> = errors.iter().map(|(f0, mean)| format!("F0 {f0}: {mean:.2e}")).collect();
        format!("{level}: {}", errors.join(", "))
    }));
    lines
}

/// The numbers; null where there are none.
pub fn to_json(text: &str) -> Value {
    let Some((_, levels)) = parse(text) else { return Value::Null };
    let level = |FitErrors { level, errors }: &FitErrors<'_>| {
        let errors: Vec<Value> = errors.iter().map(|(f0, mean)| json!({ "f0": f0, "mean": mean })).collect();
        json!({ "level": level, "errors": errors })
    };
    levels.iter().map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_table_s_words_are_numbers() {
        let words = arealight_table::ggx_file().fit_error.unwrap();
        let (what, levels) = parse(&words).unwrap();
        assert!(what.starts_with("mean absolute error"), "{what}");
        let names: Vec<&str> = levels.iter().map(|level| level.level).collect();
        assert_eq!(names, ["one lobe", "two lobes"]);
        assert_eq!(levels[0].errors.len(), 7);
        assert!(levels.iter().flat_map(|level| &level.errors).all(|(f0, mean)| *f0 <= 1.0 && *mean < 3e-3));
        assert_eq!(to_json(&words)[1]["errors"][6]["f0"], 1.0);
        assert_eq!(lines(&words).len(), 3);
        // Any other words stay as they are
        for other in ["small", "a; b", "a; b: c", "a; b: 1 at F0 = x"] {
            assert_eq!((parse(other), lines(other)), (None, vec![other.to_owned()]));
            assert_eq!(to_json(other), Value::Null);
        }
    }
}
