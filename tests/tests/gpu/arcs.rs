//! The rational functions of `arc.glsl`, evaluated in float64 from the GLSL's own text, have the errors that
//! their comments state.

const ARC_GLSL: &str = include_str!("../../../shaders/include/arealight/form_factor/arc.glsl");

/// Evaluates a GLSL expression of numbers, names, `+ - * /` and parentheses.
struct Expression<'a> {
    rest: &'a str,
    variables: &'a [(&'a str, f64)],
}

impl Expression<'_> {
    fn evaluate(text: &str, variables: &[(&str, f64)]) -> f64 {
        let mut expression = Expression { rest: text, variables };
        let value = expression.sum();
        assert_eq!(expression.rest.trim(), "", "the whole of '{text}' is an expression");
        value
    }

    fn accept(&mut self, symbol: char) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(symbol);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn sum(&mut self) -> f64 {
        let mut value = self.product();
        loop {
            if self.accept('+') {
                value += self.product();
            } else if self.accept('-') {
                value -= self.product();
            } else {
                return value;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut value = self.factor();
        loop {
            if self.accept('*') {
                value *= self.factor();
            } else if self.accept('/') {
                value /= self.factor();
            } else {
                return value;
            }
        }
    }

    fn factor(&mut self) -> f64 {
        if self.accept('-') {
            return -self.factor();
        }
        if self.accept('(') {
            let value = self.sum();
            assert!(self.accept(')'), "a closing parenthesis before '{}'", self.rest);
            return value;
        }
        let end = self.rest.find(|c: char| !c.is_alphanumeric() && c != '.').unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        let variable = self.variables.iter().find(|(name, _)| *name == word);
        variable.map_or_else(|| word.parse().expect("a number or a known name"), |(_, value)| *value)
    }
}

/// The expression behind `before` in a function of a GLSL source.
fn expression_of(source: &str, function: &str, before: &str) -> String {
    let (_, body) = source.split_once(&format!(" {function}(")).expect("the function");
    let (body, _) = body.split_once("\n}").expect("its end");
    let (_, statement) = body.split_once(before).expect("the statement");
    statement.split_once(';').expect("a statement").0.to_owned()
}

/// theta / sin(theta), from theta.
fn ratio(theta: f64) -> f64 {
    if theta == 0.0 { 1.0 } else { theta / theta.sin() }
}

/// The largest error of `expression` relative to `exact` over the angles from 0 to `end`, given the variables
/// of an angle.
fn largest_error(
    expression: &str,
    end: f64,
    variables: impl Fn(f64) -> Vec<(&'static str, f64)>,
    exact: impl Fn(f64) -> f64,
) -> f64 {
    (0..=20_000)
        .map(|i| end * f64::from(i) / 20_000.0)
        .map(|theta| (Expression::evaluate(expression, &variables(theta)) / exact(theta) - 1.0).abs())
        .fold(0.0, f64::max)
}

/// Asserts the error of a function, and that one part in a thousand of one coefficient would show.
fn assert_error(
    (source, function, before): (&str, &str, &str),
    bound: f64,
    end: f64,
    variables: impl Fn(f64) -> Vec<(&'static str, f64)> + Copy,
    exact: impl Fn(f64) -> f64 + Copy,
) {
    let expression = expression_of(source, function, before);
    let error = largest_error(&expression, end, variables, exact);
    println!("{function}: {error:.2e} (stated {bound:.1e})");
    assert!(error <= bound, "{function}: {error:e}, stated {bound:e}");
    let wrong = expression.replacen("(1.", "(1.001 * 1.", 1).replacen("(3.", "(1.001 * 3.", 1);
    assert_ne!(wrong, expression);
    assert!(largest_error(&wrong, end, variables, exact) > 5e-4, "{function}: the twin shows");
}

#[test]
fn the_weight_of_an_arc_has_the_error_that_it_states() {
    let variables = |theta: f64| vec![("s", 1.0), ("y", 2.0 * (0.5 * theta).cos())];
    // Up to where the weight is a million
    assert_error((ARC_GLSL, "arealight_arc", "return "), 7e-8, std::f64::consts::PI - 3e-6, variables, ratio);
}

#[test]
fn the_weight_of_an_acute_arc_has_the_error_that_it_states() {
    let variables = |theta: f64| vec![("s", 1.0), ("x", theta.cos())];
    assert_error(
        (ARC_GLSL, "arealight_acute_weight", "return "),
        5.6e-7,
        std::f64::consts::FRAC_PI_2,
        variables,
        ratio,
    );
}
