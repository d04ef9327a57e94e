//! `includes`: the GLSL library's files, each on its own, through a second compiler.

use crate::TaskError;
use crate::lint::{Bridge, bridges, lint};
use crate::shaders::stems_below;
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

const LIBRARY: &str = "shaders/include/arealight";

/// Whether every file of the library keeps the rules and compiles alone.
pub fn run(root: &Path) -> Result<bool, TaskError> {
    let folder = root.join(LIBRARY);
    let mut texts = BTreeMap::new();
    for name in stems_below(&folder, "glsl")? {
        let path = folder.join(format!("{name}.glsl"));
        let text = std::fs::read_to_string(&path).map_err(TaskError::file(&path))?;
        texts.insert(name, text);
    }
    let host = bridges_of_host(texts.values());

    let mut good = true;
    for (name, text) in &texts {
        for violation in lint(text) {
            eprintln!("{LIBRARY}/{name}.glsl:{}: error: {}", violation.line, violation.message);
            good = false;
        }
        for options in OPTIONS {
            if let Some(messages) = compile_alone(root, name, options, &host)? {
                eprintln!("{LIBRARY}/{name}.glsl: error: does not compile on its own{options}:\n{messages}");
                good = false;
            }
        }
    }
    println!("{} library files checked: {}", texts.len(), if good { "good" } else { "see above" });
    Ok(good)
}

/// None, and those that decide what there is in files.
const OPTIONS: [&str; 2] = ["", "\n#define AREALIGHT_MEDIA 1\n#define AREALIGHT_LIGHT_TEXTURES 1"];

/// The definitions that a host would give for every bridge the library declares.
fn bridges_of_host<'a>(texts: impl Iterator<Item = &'a String>) -> String {
    let define = |Bridge { prototype, returns, .. }| format!("{prototype} {{ return {returns}(0); }}\n");
    let definitions: std::collections::BTreeSet<String> =
        texts.flat_map(|text| bridges(text)).map(define).collect();
    definitions.into_iter().collect()
}

/// What glslangValidator says against a shader that includes just this file, twice.
fn compile_alone(root: &Path, name: &str, options: &str, host: &str) -> Result<Option<String>, TaskError> {
    let shader = format!(
        "#version 450{options}\n\
         #extension GL_GOOGLE_include_directive : require\n\
         layout(local_size_x = 1) in;\n\
         #include \"arealight/{name}.glsl\"\n\
         #include \"arealight/{name}.glsl\"\n\
         {host}\
         void main() {{}}\n"
    );
    let failed =
        |source| TaskError::Program { program: "glslangValidator", package: "glslang-tools", source };
    let null = if cfg!(windows) { "NUL" } else { "/dev/null" };
    let mut tool = Command::new("glslangValidator")
        .args(["--stdin", "-S", "comp", "--target-env", "vulkan1.1", "-Ishaders/include", "-o", null])
        .current_dir(root)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    if let Some(mut input) = tool.stdin.take() {
        input.write_all(shader.as_bytes()).map_err(failed)?;
    }
    let output = tool.wait_with_output().map_err(failed)?;
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    let bad = !output.status.success() || said.contains("WARNING");
    Ok(bad.then(|| said.lines().filter(|line| *line != "stdin").collect::<Vec<_>>().join("\n")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::tests::checkout;

    const GOOD: &str = "#ifndef AREALIGHT_A_GLSL\n#define AREALIGHT_A_GLSL\n\
        vec4 arealight_bridge_table(int layer, ivec2 texel);\n\
        float arealight_a() { return arealight_bridge_table(0, ivec2(0)).x; }\n#endif\n";

    #[test]
    fn a_file_that_stands_alone_passes() {
        let folder = checkout(&[], &[("a", GOOD)]);
        assert!(run(folder.path()).unwrap());
    }

    #[test]
    fn a_file_that_leans_on_another_or_lacks_a_guard_or_breaks_a_rule_fails() {
        let leans = "#ifndef AREALIGHT_B_GLSL\n#define AREALIGHT_B_GLSL\n\
            float arealight_b() { return arealight_a(); }\n#endif\n";
        let unguarded = "float arealight_b() { return 1.0; }\n";
        let unprefixed = "#ifndef AREALIGHT_B_GLSL\n#define AREALIGHT_B_GLSL\n\
            float b() { return 1.0; }\n#endif\n";
        let late = "#ifndef AREALIGHT_B_GLSL\n#define AREALIGHT_B_GLSL\n\
            #if AREALIGHT_MEDIA\nfloat arealight_b() { return arealight_a(); }\n#endif\n#endif\n";
        for bad in [leans, unguarded, unprefixed, late] {
            let folder = checkout(&[], &[("a", GOOD), ("b", bad)]);
            assert!(!run(folder.path()).unwrap(), "{bad}");
        }
    }
}
