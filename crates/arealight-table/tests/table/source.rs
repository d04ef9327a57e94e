//! C and GLSL: what their compilers make of the text.

use arealight::LightTable;
use arealight_table::{Precision, TableFile, Target, WriteError, resampled, rounded};
use std::path::Path;
use std::process::{Command, Output};

use crate::draft::{table, table_of_pairs, table_of_two};

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

/// Compiles a compute shader that looks up the table in `constants`.
fn compile_glsl(constants: &str) -> Option<Output> {
    let shader = format!(
        "#version 450\n#extension GL_GOOGLE_include_directive : require\n\
         #include \"arealight/lobes/table.glsl\"\n{constants}\n\
         layout(local_size_x = 1) in;\n\
         layout(std430, set = 0, binding = 0) buffer Out {{ vec4 result; }};\n\
         void main() {{\n    result = arealight_table_bilinear(2, vec2(0.5), \
         arealight_bridge_table_size())\n        \
         + arealight_bridge_table(1, ivec2(1));\n}}\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shader.comp");
    std::fs::write(&path, shader).unwrap();
    let include = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders/include");
    let mut compiler = Command::new("glslangValidator");
    compiler
        .arg("-V")
        .arg(format!("-I{}", include.display()))
        .args(["-o"])
        .arg(folder.path().join("out.spv"));
    run(compiler.arg(&path))
}

#[test]
fn a_glsl_compiler_takes_the_bridge_with_the_library() {
    for table in [resampled(&LightTable::ggx(), 16).unwrap(), table(16), LightTable::ggx()] {
        let Some(output) = compile_glsl(&text(&table, Target::Glsl)) else { return };
        assert_success(&output);
    }
    // It would say so if something was wrong
    let broken = text(&table(3), Target::Glsl).replace("uint[", "uint[1 + ");
    assert!(!compile_glsl(&broken).unwrap().status.success());
}

#[test]
fn the_words_of_glsl_are_the_numbers_of_the_table() {
    for table in [table(4), table_of_two(4), table_of_pairs(4)] {
        let text = text(&table, Target::Glsl);
        let (_, array) = text.split_once("(\n").unwrap();
        let (array, _) = array.split_once(");").unwrap();
        let words: Vec<u32> = array
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter_map(|word| word.strip_prefix("0x"))
            .map(|word| u32::from_str_radix(word.trim_end_matches('u'), 16).unwrap())
            .collect();
        let matrices =
            1 + usize::from(table.schlick_matrix().is_some()) + if table.pairs().is_some() { 2 } else { 0 };
        assert_eq!(words.len(), 16 * (2 * matrices + 2));
        let unpack =
            |word: u32| [word as u16, (word >> 16) as u16].map(|bits| half::f16::from_bits(bits).to_f32());
        let half = rounded(&table, Precision::Half).unwrap();
        for i in 0..16 {
            let matrix = [unpack(words[2 * i]), unpack(words[2 * i + 1])].concat();
            assert_eq!(matrix, half.matrix()[i]);
            assert_eq!(unpack(words[32 * matrices + i]), half.magnitude()[i]);
            if let Some(schlick) = half.schlick_matrix() {
                assert_eq!([unpack(words[32 + 2 * i]), unpack(words[33 + 2 * i])].concat(), schlick[i]);
            }
        }
        let shares = |i: usize| unpack(words[32 * matrices + 16 + i]);
        match half.pairs() {
            None => assert!((0..16).all(|i| shares(i)[0] == 0.0), "the second lobe is Schlick's"),
            Some(pairs) => {
                for i in 0..16 {
                    for (k, matrix) in pairs.matrices.iter().enumerate() {
                        let at = 32 * (2 + k) + 2 * i;
                        assert_eq!([unpack(words[at]), unpack(words[at + 1])].concat(), matrix[i]);
                    }
                    assert_eq!(shares(i), pairs.second_shares[i]);
                }
            }
        }
        // The function reads layers where they are
        let layers = match matrices {
            1 => "0, 32, 0, 0, 0, 48",
            2 => "0, 64, 32, 0, 32, 80",
            _ => "0, 128, 32, 64, 96, 144",
        };
        assert!(text.contains(&format!("int[6]({layers})")), "{text}");
    }
}

#[test]
fn a_table_too_large_for_constants_is_refused() {
    let file = TableFile { table: table(65), fit_error: None };
    assert_eq!(file.write(Target::Glsl), Err(WriteError::TooLarge { size: 65 }));
}

#[test]
fn text_of_the_table_does_not_end_a_comment() {
    for target in [Target::CHeader(Precision::Single), Target::Glsl] {
        let text = text(&table(2), target);
        assert!(!text.contains("*/ #error") && !text.contains("\n#error"), "{text}");
        assert!(text.is_ascii());
    }
}
