//! Fields of a JSON object, read one by one, so that every error names its case and field.

use super::CaseError;
use super::strict::{Items, Strict};
use glam::{DVec2, DVec3};
use serde::Deserializer as _;
use serde_json::{Map, Value};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Parses JSON, in which no key may be there twice.
pub fn json(text: &str) -> Result<Value, CaseError> {
    serde_json::from_str(text).map(|Strict(value)| value).map_err(|error| not_json(text, &error))
}

fn not_json(text: &str, error: &serde_json::Error) -> CaseError {
    // The likeliest wrong token is a number that JSON does not have
    let line = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let start = error.column().saturating_sub(2);
    let token: String = line.chars().skip(start).take(9).collect::<String>().to_lowercase();
    let hint = if ["nan", "inf"].iter().any(|word| token.contains(word)) {
        "; JSON has no NaN and no infinity"
    } else {
        ""
    };
    CaseError::NotJson { message: format!("{error}{hint}") }
}

/// Gives each item of the array under `field` of the outermost object to `take`, in turn.
pub fn each(
    text: &str,
    field: &'static str,
    expected: &str,
    mut take: impl FnMut(usize, &Value) -> Result<(), CaseError>,
) -> Result<(), CaseError> {
    let (mut found, mut refused) = (false, None);
    let keep = |index, value| match take(index, &value) {
        Ok(()) => true,
        Err(error) => {
            refused = Some(error);
            false
        }
    };
    let mut reader = serde_json::Deserializer::from_str(text);
    let read =
        reader.deserialize_any(Items { field, take: keep, found: &mut found }).and_then(|()| reader.end());
    match (read, refused) {
        (_, Some(refused)) => Err(refused),
        (Err(error), _) if found || !error.to_string().starts_with("invalid type") => {
            Err(not_json(text, &error))
        }
        (Ok(()), _) if found => Ok(()),
        _ => {
            Err(CaseError::File { field: field.into(), message: format!("missing or no array; {expected}") })
        }
    }
}

/// The fields of one object of a case.
pub struct Fields<'a> {
    case: String,
    /// What comes before a field's name: nothing, or `light.`
    prefix: &'static str,
    map: &'a Map<String, Value>,
    read: RefCell<BTreeSet<String>>,
}

impl<'a> Fields<'a> {
    /// The fields of a case, which is an object with a name.
    pub fn of_case(index: usize, value: &'a Value) -> Result<Self, CaseError> {
        let place = format!("cases[{index}]");
        let Value::Object(map) = value else {
            return Err(CaseError::File { field: place, message: describe("an object", value) });
        };
        let fields = Self { case: place, prefix: "", map, read: RefCell::default() };
        let case = fields.text("name")?.to_owned();
        Ok(Self { case, ..fields })
    }

    /// The case's name.
    pub fn name(&self) -> &str {
        &self.case
    }

    /// An error about a field.
    pub fn error(&self, field: &str, message: &str) -> CaseError {
        CaseError::Case {
            case: self.case.clone(),
            field: format!("{}{field}", self.prefix),
            message: message.to_owned(),
        }
    }

    /// Fields that nobody asked for, each with the one that it is most like among those that somebody did.
    pub fn unread(&self) -> Vec<String> {
        let read = self.read.borrow();
        let unread = self.map.keys().filter(|key| !read.contains(*key));
        unread
            .map(|key| {
                let absent = read.iter().filter(|known| !self.map.contains_key(*known));
                let like = absent.map(|known| (steps(key, known), known)).min();
                let meant =
                    like.filter(|(steps, _)| *steps <= LIKE).map(|(_, known)| format!(": \"{known}\"?"));
                format!("\"{}{key}\" is not known{}", self.prefix, meant.unwrap_or_default())
            })
            .collect()
    }

    /// Whether the field is there.
    pub fn has(&self, field: &str) -> bool {
        self.read.borrow_mut().insert(field.to_owned());
        self.map.contains_key(field)
    }

    /// What `read` makes of the field, or nothing if it is absent.
    pub fn optional<T>(
        &self,
        field: &str,
        read: impl Fn(&Self, &str) -> Result<T, CaseError>,
    ) -> Result<Option<T>, CaseError> {
        if self.has(field) { read(self, field).map(Some) } else { Ok(None) }
    }

    /// The fields of an object.
    pub fn object(&self, field: &'static str) -> Result<Self, CaseError> {
        let prefix = match field {
            "light" => "light.",
            "opening" => "light.opening.",
            other => other,
        };
        match self.value(field)? {
            Value::Object(map) => Ok(Self { case: self.case.clone(), prefix, map, read: RefCell::default() }),
            other => Err(self.error(field, &describe("an object", other))),
        }
    }

    /// A text.
    pub fn text(&self, field: &str) -> Result<&'a str, CaseError> {
        let value = self.value(field)?;
        value.as_str().ok_or_else(|| self.error(field, &describe("a text", value)))
    }

    /// True or false.
    pub fn boolean(&self, field: &str) -> Result<bool, CaseError> {
        let value = self.value(field)?;
        value.as_bool().ok_or_else(|| self.error(field, &describe("true or false", value)))
    }

    /// Three numbers.
    pub fn vector(&self, field: &str) -> Result<DVec3, CaseError> {
        self.vector_at(field, self.value(field)?)
    }

    /// Three numbers that are not all zero.
    pub fn direction(&self, field: &str) -> Result<DVec3, CaseError> {
        let vector = self.vector(field)?;
        if vector == DVec3::ZERO {
            Err(self.error(field, "is zero, and has no direction"))
        } else {
            Ok(vector)
        }
    }

    /// Three numbers from 0 to `limit`.
    pub fn color(&self, field: &str, limit: f64) -> Result<DVec3, CaseError> {
        let color = self.vector(field)?;
        if color.min_element() < 0.0 || color.max_element() > limit {
            let range = if limit.is_finite() { format!("from 0 to {limit}") } else { "not negative".into() };
            return Err(self.error(field, &format!("{color} must be {range}")));
        }
        Ok(color)
    }

    /// A number above zero.
    pub fn length(&self, field: &str) -> Result<f64, CaseError> {
        let length = self.number_at(field, self.value(field)?)?;
        if length > 0.0 { Ok(length) } else { Err(self.error(field, &format!("{length} must be above 0"))) }
    }

    /// A GGX alpha.
    pub fn alpha(&self, field: &str) -> Result<f64, CaseError> {
        let alpha = self.number_at(field, self.value(field)?)?;
        if alpha > 0.0 && alpha <= 1.0 {
            Ok(alpha)
        } else {
            Err(self.error(field, &format!("{alpha} must be above 0 and at most 1")))
        }
    }

    /// A number.
    pub fn number(&self, field: &str) -> Result<f64, CaseError> {
        self.number_at(field, self.value(field)?)
    }

    /// A number from 0 to 1.
    pub fn share(&self, field: &str) -> Result<f64, CaseError> {
        let share = self.number_at(field, self.value(field)?)?;
        let message = || format!("{share} must be from 0 to 1");
        if (0.0..=1.0).contains(&share) { Ok(share) } else { Err(self.error(field, &message())) }
    }

    /// An array whose items are read by `read`, each with its own field name.
    pub fn list<T>(
        &self,
        field: &str,
        read: impl Fn(&Self, &str, &Value) -> Result<T, CaseError>,
    ) -> Result<Vec<T>, CaseError> {
        let value = self.value(field)?;
        let items = value.as_array().ok_or_else(|| self.error(field, &describe("an array", value)))?;
        items.iter().enumerate().map(|(i, item)| read(self, &format!("{field}[{i}]"), item)).collect()
    }

    /// Three numbers in `value`.
    pub fn vector_at(&self, field: &str, value: &Value) -> Result<DVec3, CaseError> {
        self.numbers_at(field, value).map(DVec3::from_array)
    }

    /// Three corners in `value`.
    pub fn triangle_at(&self, field: &str, value: &Value) -> Result<[DVec3; 3], CaseError> {
        let corners = value.as_array().filter(|corners| corners.len() == 3);
        let corners = corners.ok_or_else(|| self.error(field, &describe("3 corners", value)))?;
        let mut triangle = [DVec3::ZERO; 3];
        for (i, corner) in corners.iter().enumerate() {
            triangle[i] = self.vector_at(&format!("{field}[{i}]"), corner)?;
        }
        Ok(triangle)
    }

    /// Two numbers in `value`.
    pub fn pair_at(&self, field: &str, value: &Value) -> Result<DVec2, CaseError> {
        self.numbers_at(field, value).map(DVec2::from_array)
    }

    /// Any count of numbers in `value`.
    pub fn row_at(&self, field: &str, value: &Value) -> Result<Vec<f64>, CaseError> {
        let items = value.as_array().ok_or_else(|| self.error(field, &describe("numbers", value)))?;
        items.iter().map(|item| self.number_at(field, item)).collect()
    }

    fn numbers_at<const N: usize>(&self, field: &str, value: &Value) -> Result<[f64; N], CaseError> {
        let items = value.as_array().filter(|items| items.len() == N);
        let items = items.ok_or_else(|| self.error(field, &describe(&format!("{N} numbers"), value)))?;
        let mut numbers = [0.0; N];
        for (i, item) in items.iter().enumerate() {
            numbers[i] = self.number_at(&format!("{field}[{i}]"), item)?;
        }
        Ok(numbers)
    }

    fn number_at(&self, field: &str, value: &Value) -> Result<f64, CaseError> {
        // JSON's own grammar keeps NaN and infinity out
        value.as_f64().ok_or_else(|| self.error(field, &describe("a number", value)))
    }

    fn value(&self, field: &str) -> Result<&'a Value, CaseError> {
        self.read.borrow_mut().insert(field.to_owned());
        self.map.get(field).ok_or_else(|| {
            let read = self.read.borrow();
            let others =
                self.map.keys().filter(|key| !read.contains(*key)).map(|key| (steps(key, field), key));
            let like = others.min().filter(|(steps, _)| *steps <= LIKE && field.len() > LIKE);
            let there = like.map(|(_, key)| format!("; \"{key}\" is there")).unwrap_or_default();
            self.error(field, &format!("is missing{there}"))
        })
    }
}

/// So many [`steps`] are between names that may be meant for each other.
const LIKE: usize = 2;

/// How many letters must be put in, taken out, changed or swapped with the next, to make one name of another;
/// 9 for names that are longer than any field's.
fn steps(from: &str, to: &str) -> usize {
    let (from, to) = (from.as_bytes(), to.as_bytes());
    if from.len() > 32 {
        return 9;
    }
    let (mut before, mut last): (Vec<usize>, Vec<usize>) = (vec![], (0..=to.len()).collect());
    for (i, a) in from.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in to.iter().enumerate() {
            let mut least = (last[j] + usize::from(a != b)).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *a == to[j - 1] && from[i - 1] == *b {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        (before, last) = (last, row);
    }
    last[to.len()]
}

/// What was expected, and what is there instead.
fn describe(expected: &str, found: &Value) -> String {
    let found = match found {
        Value::Null => "null (some programs write NaN so)".to_owned(),
        Value::Bool(_) => "true or false".to_owned(),
        Value::Number(number) => format!("the number {number}"),
        Value::String(text) => format!("the text \"{text}\""),
        Value::Array(items) => format!("an array of {}", items.len()),
        Value::Object(_) => "an object".to_owned(),
    };
    format!("is {found}, where {expected} should be")
}
