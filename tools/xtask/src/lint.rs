//! The rules of the GLSL library, checked on its text: what a host includes must not collide with its own
//! names, bindings or state, and must not use functions without a stated precision.

/// A place where a library file breaks a rule.
#[derive(Debug, PartialEq, Eq)]
pub struct Violation {
    /// Counted from 1.
    pub line: usize,
    /// Which rule, and what to do.
    pub message: String,
}

/// A function that the library declares and the host defines.
#[derive(Debug, PartialEq, Eq)]
pub struct Bridge {
    /// Its name.
    pub name: String,
    /// Its declaration without the semicolon.
    pub prototype: String,
    /// The type that it returns.
    pub returns: String,
}

/// A piece of GLSL with the line it begins on.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Token {
    line: usize,
    text: String,
}

impl Token {
    fn is_directive(&self) -> bool {
        self.text.starts_with('#')
    }
}

/// Every violation in a library file, by line.
pub fn lint(text: &str) -> Vec<Violation> {
    let text = without_comments(text);
    let tokens = tokens(&text);
    let mut violations = vec![];
    for token in tokens.iter().filter(|token| token.is_directive()) {
        lint_directive(token, &mut violations);
    }
    let code: Vec<Token> = tokens.into_iter().filter(|token| !token.is_directive()).collect();
    lint_words(&code, &mut violations);
    for declaration in declarations(&code) {
        lint_declaration(&declaration, &mut violations);
    }
    violations.sort_by_key(|violation| violation.line);
    violations
}

/// The functions `arealight_bridge_*` that a library file declares.
pub fn bridges(text: &str) -> Vec<Bridge> {
    let code: Vec<Token> =
        tokens(&without_comments(text)).into_iter().filter(|token| !token.is_directive()).collect();
    let mut bridges = vec![];
    for declaration in declarations(&code) {
        if let [returns, name, open, .., close] = &declaration[..]
            && name.text.starts_with("arealight_bridge_")
            && (open.text.as_str(), close.text.as_str()) == ("(", ")")
        {
            let words: Vec<&str> = declaration.iter().map(|token| token.text.as_str()).collect();
            let (name, returns) = (name.text.clone(), returns.text.clone());
            bridges.push(Bridge { name, prototype: words.join(" "), returns });
        }
    }
    bridges
}

/// No version; macros under the library's prefix; no forbidden function in a macro's body.
fn lint_directive(directive: &Token, violations: &mut Vec<Violation>) {
    let mut words = directive.text.trim_start_matches('#').split_whitespace();
    match words.next() {
        Some("version") => violations.push(Violation {
            line: directive.line,
            message: "#version belongs to the host's shader".to_owned(),
        }),
        Some("define") => {
            let name: String = words
                .next()
                .unwrap_or_default()
                .chars()
                .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
                .collect();
            lint_name(&name, "macro", "AREALIGHT_", directive.line, violations);
            let mut body = tokens(&directive.text[1..]);
            for token in &mut body {
                token.line = directive.line;
            }
            lint_words(&body, violations);
        }
        _ => {}
    }
}

/// No binding, and no built-in function whose precision is undefined.
fn lint_words(code: &[Token], violations: &mut Vec<Violation>) {
    for pair in code.windows(2) {
        let [word, next] = pair else { continue };
        let message = match word.text.as_str() {
            "layout" => {
                "layout(…) belongs to the host: read through an arealight_bridge_ function".to_owned()
            }
            "acos" | "asin" | "atan" if next.text == "(" => {
                format!("the precision of {}() is undefined: use a polynomial of the library", word.text)
            }
            _ => continue,
        };
        violations.push(Violation { line: word.line, message });
    }
}

/// At the top level: functions, constants and structs under the library's prefix, and nothing else.
fn lint_declaration(declaration: &[Token], violations: &mut Vec<Violation>) {
    let Some(first) = declaration.first() else { return };
    let at = |symbols: &[&str]| declaration.iter().position(|token| symbols.contains(&token.text.as_str()));
    let before = |index: usize| index.checked_sub(1).map(|index| &declaration[index]);
    let (kind, prefix, name) = if first.text == "struct" {
        ("struct", "Arealight", declaration.get(1))
    } else if first.text == "const" {
        ("constant", "AREALIGHT_", at(&["=", "["]).and_then(before))
    } else if first.text == "layout" {
        return; // said already
    } else if let Some(open) = at(&["(", "="]).filter(|&index| declaration[index].text == "(") {
        ("function", "arealight_", before(open))
    } else {
        violations.push(Violation {
            line: first.line,
            message: format!("`{}` begins a global that is no function, constant or struct", first.text),
        });
        return;
    };
    if let Some(name) = name {
        lint_name(&name.text, kind, prefix, name.line, violations);
    }
}

fn lint_name(name: &str, kind: &str, prefix: &str, line: usize, violations: &mut Vec<Violation>) {
    // A macro of the library that stands where a function is declared makes functions of the library
    if !name.starts_with(prefix) && !name.starts_with("AREALIGHT_") {
        let message = format!("the {kind} `{name}` must begin with {prefix}");
        violations.push(Violation { line, message });
    }
}

/// The declarations at the top level, each without its body, braces and semicolon.
fn declarations(code: &[Token]) -> Vec<Vec<Token>> {
    let mut declarations = vec![];
    let mut current: Vec<Token> = vec![];
    let mut depth = 0_usize;
    for token in code {
        match token.text.as_str() {
            "{" => depth += 1,
            "}" => {
                depth = depth.saturating_sub(1);
                // A function ends with its brace; a struct or an initialiser with the semicolon after it.
                let function = current.last().is_some_and(|last| last.text == ")");
                if depth == 0 && function {
                    declarations.push(std::mem::take(&mut current));
                }
            }
            ";" if depth == 0 => declarations.push(std::mem::take(&mut current)),
            _ if depth == 0 => current.push(token.clone()),
            _ => {}
        }
    }
    declarations.push(current);
    declarations.retain(|declaration| !declaration.is_empty());
    declarations
}

/// Words, digits and single symbols; a directive with its continued lines is one token that begins with `#`.
fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = vec![];
    let mut line = 1;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '\n' => {
                line += 1;
                1
            }
            '#' => directive_length(rest),
            c if c.is_ascii_alphanumeric() || c == '_' => {
                rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
            }
            c => c.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        if !first.is_whitespace() {
            tokens.push(Token { line, text: token.to_owned() });
        }
        if first == '#' {
            line += token.matches('\n').count();
        }
        rest = after;
    }
    tokens
}

/// The length of a directive up to the line's end that no backslash precedes.
fn directive_length(text: &str) -> usize {
    let mut length = 0;
    for line in text.split_inclusive('\n') {
        length += line.trim_end_matches('\n').len();
        if !line.trim_end().ends_with('\\') {
            break;
        }
        length += line.len() - line.trim_end_matches('\n').len();
    }
    length
}

/// The text with each comment replaced by a space and the line ends that it held.
fn without_comments(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(start) = rest.find("//").into_iter().chain(rest.find("/*")).min() {
        code.push_str(&rest[..start]);
        code.push(' ');
        let comment = &rest[start..];
        let length = if comment.starts_with("//") {
            comment.find('\n').unwrap_or(comment.len())
        } else {
            comment[2..].find("*/").map_or(comment.len(), |end| end + 4)
        };
        code.extend(comment[..length].matches('\n').map(|_| '\n'));
        rest = &comment[length..];
    }
    code + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<(usize, String)> {
        lint(text).into_iter().map(|violation| (violation.line, violation.message)).collect()
    }

    #[test]
    fn a_file_that_keeps_the_rules_passes() {
        let text = "\
#ifndef AREALIGHT_X_GLSL
#define AREALIGHT_X_GLSL
/* layout(binding = 0), acos(x)
   in a comment */
#define AREALIGHT_SQUARE(x) \\
    ((x) * (x))
const float AREALIGHT_PI = 3.14159; // atan(1) * 4
const float AREALIGHT_NODES[2] = float[2](0.0, 1.0);
struct ArealightSurface { vec3 normal; float atan; };
vec4 arealight_bridge_table(int layer, ivec2 texel);
float arealight_f(ArealightSurface surface, const float x) {
    float global = surface.atan;
    if (x > 0.5) { global += 1.0; }
    return arealight_bridge_table(0, ivec2(0)).x;
}
#endif
";
        assert_eq!(lint(text), []);
    }

    #[test]
    fn each_broken_rule_is_found_on_its_line() {
        let cases = [
            ("\n#version 450\n", 2, "#version"),
            ("\n\nlayout(binding = 0) uniform sampler2D arealight_t;\n", 3, "layout"),
            ("float arealight_f(float x) {\n    return acos (x);\n}\n", 2, "acos()"),
            ("#define AREALIGHT_ANGLE(x) \\\n  atan(x)\n", 1, "atan()"),
            ("/* one\ntwo */ float ltc_f() { return 1.0; }\n", 2, "function `ltc_f`"),
            ("#define PI 3\n", 1, "macro `PI`"),
            ("#define SQUARE(x) ((x) * (x))\n", 1, "macro `SQUARE`"),
            ("const float arealight_pi = 3.0;\n", 1, "constant `arealight_pi`"),
            ("struct Surface { vec3 normal; };\n", 1, "struct `Surface`"),
            ("float arealight_state;\n", 1, "global"),
            ("float arealight_state = sqrt(2.0);\n", 1, "global"),
            ("shared float arealight_state[64];\n", 1, "global"),
        ];
        for (text, line, part) in cases {
            let found = messages(text);
            assert_eq!(found.len(), 1, "{text}: {found:?}");
            assert_eq!(found[0].0, line, "{text}");
            assert!(found[0].1.contains(part), "{text}: {found:?}");
        }
    }

    #[test]
    fn bridges_are_the_declarations_without_a_body() {
        let text = "\
// vec4 arealight_bridge_commented(int layer);
vec4 arealight_bridge_table(int layer, ivec2 texel);
int arealight_bridge_size();
float arealight_other(float x);
";
        let found = bridges(text);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].prototype, "vec4 arealight_bridge_table ( int layer , ivec2 texel )");
        assert_eq!(found[0].returns, "vec4");
        assert_eq!(found[1].prototype, "int arealight_bridge_size ( )");
    }
}
