//! A formula as the source text that is checked in.

use arealight_oracle::formula::Formula;
use std::fmt::Write as _;

/// A formula as the Rust text of a [`Formula`].
pub fn rust(formula: &Formula) -> String {
    let mut text = String::from("Formula {\n");
    for (name, rows) in [("lobe", &formula.lobe), ("schlick_lobe", &formula.schlick_lobe)] {
        let _ = writeln!(text, "    {name}: [");
        for row in rows {
            let _ = writeln!(text, "        {row:?},");
        }
        text.push_str("    ],\n");
    }
    for (name, coefficients) in scalars(formula) {
        let _ = writeln!(text, "    {name}: {coefficients:?},");
    }
    text.push_str("}\n");
    text
}

/// A formula as the GLSL constants that `arealight_formula_sample` evaluates.
pub fn glsl(formula: &Formula) -> String {
    let mut text = String::new();
    let mut array = |kind: &str, name: &str, lines: &[String], count: usize| {
        let (name, lines) = (name.to_uppercase(), lines.join(",\n    "));
        let _ = writeln!(
            text,
            "const {kind} AREALIGHT_FORMULA_{name}[{count}] = {kind}[{count}](\n    {lines});"
        );
    };
    for (name, rows) in [("lobe", &formula.lobe), ("schlick_lobe", &formula.schlick_lobe)] {
        array("vec4", name, &rows.map(|row| format!("vec4({})", list(&row))), rows.len());
    }
    for (name, coefficients) in scalars(formula) {
        array("float", name, &[list(coefficients)], coefficients.len());
    }
    text
}

/// The coefficients of everything but the matrices, by their names.
fn scalars(formula: &Formula) -> [(&'static str, &[f64]); 5] {
    [
        ("dip", &formula.dip),
        ("albedo", &formula.albedo),
        ("albedo_denominator", &formula.albedo_denominator),
        ("schlick", &formula.schlick),
        ("schlick_denominator", &formula.schlick_denominator),
    ]
}

/// Numbers with a comma between them, each with a point or an exponent, as GLSL wants its floats.
fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(", ")
}
