//! Files of answers: the radiance of each case of a file, or the reason why there is none.

use crate::cases::CaseError;
use glam::DVec3;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write as _;

/// What was found for a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// The case's name.
    pub name: String,
    /// Outgoing radiance, W/(m² sr); `None` (null) where there is no answer.
    pub radiance: Option<[f64; 3]>,
    /// Why there is no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

impl Answer {
    /// An answer. Radiance that is not finite becomes none with a reason: JSON could not hold it.
    pub fn new(name: impl Into<String>, radiance: DVec3) -> Self {
        if !radiance.is_finite() {
            return Self::none(name, format!("the result is not finite: {radiance}"));
        }
        Self { name: name.into(), radiance: Some(radiance.to_array()), reason: None }
    }

    /// No answer, and why.
    pub fn none(name: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { name: name.into(), radiance: None, reason: Some(reason.into()) }
    }
}

/// The text of a file of answers, `{"by": ..., "results": [...]}`, one a line; `by` says what answered.
pub fn write_answers(answers: &[Answer], by: &Value) -> String {
    let mut text = format!("{{\"by\": {by}, \"results\": [");
    for (index, answer) in answers.iter().enumerate() {
        let _ = write!(text, "{}\n{}", if index == 0 { "" } else { "," }, serde_json::json!(answer));
    }
    text + "\n]}\n"
}

/// Reads a file of answers or of known radiance: `{"results": [...]}`, or the array alone. Fields beside
/// `name`, `radiance` and `reason` are passed over.
///
/// # Errors
/// [`CaseError`] says which answer and field is wrong.
pub fn read_answers(text: &str) -> Result<Vec<Answer>, CaseError> {
    let document = crate::cases::json(text)?;
    let items = document.as_array().or_else(|| document.get("results")?.as_array());
    let items = items.ok_or_else(|| CaseError::File {
        field: "results".into(),
        message: "missing or no array; a file of answers is {\"results\": [...]}, or the array alone".into(),
    })?;
    items.iter().enumerate().map(|(index, item)| read_answer(index, item)).collect()
}

fn read_answer(index: usize, item: &Value) -> Result<Answer, CaseError> {
    let Some(name) = item.get("name").and_then(Value::as_str) else {
        let message = "is missing, or no text".into();
        return Err(CaseError::File { field: format!("results[{index}].name"), message });
    };
    let reason = item.get("reason").and_then(Value::as_str).map(ToOwned::to_owned);
    let numbers = |value: &Value| -> Option<[f64; 3]> {
        let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
        numbers?.try_into().ok()
    };
    let radiance = match item.get("radiance") {
        Some(Value::Null) => None,
        Some(value) if numbers(value).is_some() => numbers(value),
        _ => {
            return Err(CaseError::Case {
                case: name.to_owned(),
                field: "radiance".into(),
                message: "is missing, or neither three numbers nor null".into(),
            });
        }
    };
    Ok(Answer { name: name.to_owned(), radiance, reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_survive_being_written_and_read() {
        let answers = vec![
            Answer::new("a \"quoted\" name", DVec3::new(0.44691750956508275, 1e-300, 51.24416514123215)),
            Answer::none("b", "light.type \"disk\" is not supported yet"),
            Answer::new("c", DVec3::new(f64::NAN, 0.0, 0.0)),
        ];
        let text = write_answers(&answers, &Value::Null);
        assert!(text.contains(r#"{"name":"b","radiance":null,"reason":"light.type \"disk\" is"#), "{text}");
        assert_eq!(read_answers(&text).unwrap(), answers);
        assert_eq!(answers[2].radiance, None);
        assert_eq!(read_answers(&write_answers(&[], &Value::Null)).unwrap(), []);
    }

    #[test]
    fn known_radiance_may_be_an_array_with_more_fields() {
        let answers = read_answers(r#"[{"name": "a", "radiance": [1, 2, 3], "err": 1e-9}]"#).unwrap();
        assert_eq!(answers, [Answer::new("a", DVec3::new(1.0, 2.0, 3.0))]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let message = |text: &str| read_answers(text).unwrap_err().to_string();
        assert!(message("{}").starts_with("results: missing or no array"));
        assert!(message(r#"[{"radiance": null}]"#).starts_with("results[0].name: is missing"));
        assert!(message(r#"[{"name": "a"}]"#).starts_with("case 'a': radiance: is missing"));
        assert!(message(r#"[{"name": "a", "radiance": [1, null, 2]}]"#).starts_with("case 'a': radiance"));
        assert!(message("[NaN]").starts_with("not JSON: expected value at line 1 column 2"));
    }
}
