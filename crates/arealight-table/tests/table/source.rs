//! C: what a compiler makes of the text.

use arealight::LightTable;
use arealight_table::{Precision, TableFile, Target, resampled, rounded};
use std::process::{Command, Output};

use crate::draft::table;

fn text(table: &LightTable, target: Target) -> String {
    let fit_error = Some("small */ #error \"no\"\n#error".to_owned());
    String::from_utf8(TableFile { table: table.clone(), fit_error }.write(target).unwrap()).unwrap()
}

/// Runs a program, or says that it is not installed.
fn run(command: &mut Command) -> Option<Output> {
    match command.output() {
        Ok(output) => Some(output),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            eprintln!("skipped: {} is not installed", command.get_program().display());
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn assert_success(output: &Output) {
    let text = [&output.stdout[..], &output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&text));
}

/// A C program that prints each element's bits.
const PROGRAM: &str = r#"
#include "table.h"
#include "table.h"
#include <stdio.h>
#include <string.h>
int main(void) {
    unsigned i;
    for (i = 0; i < sizeof arealight_table / sizeof *arealight_table; ++i) {
        unsigned bits = 0;
        memcpy(&bits, &arealight_table[i], sizeof *arealight_table);
        printf("%u\n", bits);
    }
    return AREALIGHT_TABLE_SIZE == 5 && AREALIGHT_TABLE_LAYERS == 6 ? 0 : 1;
}
"#;

#[test]
fn a_c_compiler_finds_the_same_numbers() {
    for precision in [Precision::Half, Precision::Single] {
        let table = resampled(&LightTable::ggx(), 5).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("table.h"), text(&table, Target::CHeader(precision))).unwrap();
        std::fs::write(at("main.c"), PROGRAM).unwrap();
        let mut compiler = Command::new("cc");
        compiler.args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-o"]);
        let Some(output) = run(compiler.arg(at("program")).arg(at("main.c"))) else { return };
        assert_success(&output);
        let output = Command::new(at("program")).output().unwrap();
        assert_success(&output);
        let found: Vec<u32> =
            String::from_utf8(output.stdout).unwrap().lines().map(|line| line.parse().unwrap()).collect();
        let texels = rounded(&table, precision).unwrap().texels();
        let bits = |number: &f32| match precision {
            Precision::Half => u32::from(half::f16::from_f32(*number).to_bits()),
            Precision::Single => number.to_bits(),
        };
        assert_eq!(found, texels.as_flattened().iter().map(bits).collect::<Vec<_>>());
    }
}

#[test]
fn text_of_the_table_does_not_end_a_comment() {
    let text = text(&table(2), Target::CHeader(Precision::Single));
    assert!(!text.contains("*/ #error") && !text.contains("\n#error"), "{text}");
    assert!(text.is_ascii());
}
