//! What relates the form factors of an outline and of others that are made of it.

use super::{outline, with_outline};
use arealight_tests::Path;
use arealight_tests::prelude::*;

/// A relation between the form factors of a group of lights: the given one, then the others.
pub struct Relation {
    pub what: &'static str,
    /// The others.
    pub others: fn(&mut Random, &EvalPoint) -> Vec<EvalPoint>,
    /// Two sides that are the same.
    pub sides: fn(&[f64]) -> [f64; 2],
    /// Two that are not.
    pub twin: fn(&[f64]) -> [f64; 2],
}

pub const RELATIONS: [Relation; 9] = [
    Relation { what: "split", others: split, sides: |f| [f[1] + f[2], f[0]], twin: |f| [f[1], f[0]] },
    Relation {
        what: "other beginning",
        others: begun_elsewhere,
        sides: |f| [f[1], f[0]],
        twin: |f| [f[1], 1.001 * f[0]],
    },
    Relation {
        what: "both sides, reversed",
        others: reversed,
        sides: |f| [f[2], f[0]],
        twin: |f| [f[1], f[0]],
    },
    Relation { what: "back", others: reversed, sides: |f| [f[1], 0.0], twin: |f| [f[0], 0.0] },
    Relation { what: "midpoint", others: inserted, sides: |f| [f[2], f[1]], twin: |f| [f[2], 1.001 * f[1]] },
    Relation { what: "duplicate", others: inserted, sides: |f| [f[3], f[1]], twin: |f| [f[3], 1.001 * f[1]] },
    // What a part has more than the whole is nothing
    Relation {
        what: "part",
        others: part,
        sides: |f| [(f[1] - f[0]).max(0.0), 0.0],
        twin: |f| [(f[0] - f[1]).max(0.0), 0.0],
    },
    Relation { what: "rotation", others: rotated, sides: |f| [f[1], f[0]], twin: |f| [f[1], 1.001 * f[0]] },
    Relation {
        what: "rotation about z",
        others: rotated,
        sides: |f| [f[2], f[0]],
        twin: |f| [f[2], 1.001 * f[0]],
    },
];

/// A light with a hole and its hole are the whole: of any outline alone.
pub const HOLE: Relation =
    Relation { what: "hole", others: cut, sides: |f| [f[1] + f[2], f[0]], twin: |f| [f[1], f[0]] };

impl Relation {
    /// Groups for a path and a lobe.
    pub fn groups(&self, path: Path, glossy: bool, count: usize) -> Vec<Vec<EvalPoint>> {
        let mut random = Random::new(12);
        let group = |index| {
            let vertices = outline(&mut random, path, index);
            let mut given = point(lambert_surface(), DVec3::Z, vertices, false);
            if glossy {
                given.surface = glossy_surface(random.between(0.05, 1.0));
                given.view = random.direction();
                given.view.z = given.view.z.abs();
            }
            let others = (self.others)(&mut random, &given);
            [vec![given], others].concat()
        };
        (0..count).map(group).collect()
    }
}

/// In two, from the first vertex on. A convex quad along its diagonal, a triangle to the middle of the
/// opposite edge, a star through its middle.
fn split(_: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let outline = given.light.shape.vertices();
    let [one, other] = match outline {
        [a, b, c] => {
            let middle = (*b + *c) * 0.5;
            [vec![*a, *b, middle], vec![*a, middle, *c]]
        }
        [a, b, c, d] if given.light.shape.is_convex_quad() => [vec![*a, *b, *c], vec![*a, *c, *d]],
        _ => {
            let middle = star_middle(outline);
            let rest = [&outline[2..], &[outline[0], middle][..]].concat();
            [[&outline[..3], &[middle][..]].concat(), rest]
        }
    };
    vec![with_outline(given, one), with_outline(given, other)]
}

/// The point from which all vertices are seen at even angles, see `Random::polygon`: where the lines from the
/// first vertex and from the second do as the others say.
fn star_middle(outline: &[DVec3]) -> DVec3 {
    // Minimise how unevenly the directions lie, from the mean on, by Newton's method on the sum of unit
    // vectors, which vanishes there
    let mut middle = outline.iter().sum::<DVec3>() / outline.len() as f64;
    for _ in 0..200 {
        let pull: DVec3 = outline.iter().map(|v| (*v - middle).normalize_or_zero()).sum();
        let weight: f64 = outline.iter().map(|v| 1.0 / v.distance(middle)).sum();
        middle += pull * (2.0 / weight);
    }
    middle
}

fn begun_elsewhere(random: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let mut turned = given.clone();
    let count = turned.light.shape.vertices().len();
    turned.light.shape.vertices_mut().rotate_left(1 + random.bits() as usize % (count - 1));
    vec![turned]
}

/// With one side, and with two.
fn reversed(_: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let mut back = given.clone();
    back.light.shape.vertices_mut().reverse();
    let mut both_sides = back.clone();
    both_sides.light.two_sided = true;
    vec![back, both_sides]
}

/// A triangle or a star as it is, with the midpoint of an edge, and with a vertex twice. A quad has no room
/// for a fifth vertex, so it loses one first.
fn inserted(random: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let mut outline = given.light.shape.vertices().to_vec();
    if given.light.shape.is_convex_quad() {
        outline.truncate(3);
    }
    let after = random.bits() as usize % outline.len();
    let next = outline[(after + 1) % outline.len()];
    let (mut halved, mut doubled) = (outline.clone(), outline.clone());
    halved.insert(after + 1, outline[after].lerp(next, 0.5));
    doubled.insert(after + 1, outline[after]);
    [outline, halved, doubled].map(|outline| with_outline(given, outline)).into()
}

/// Shrunk towards the middle: by a ten-millionth, or by half.
fn part(random: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let outline = given.light.shape.vertices();
    let middle = star_middle(outline);
    let factor = 1.0 - 10.0_f64.powf(random.between(-7.0, -0.3));
    vec![with_outline(given, outline.iter().map(|v| middle.lerp(*v, factor)).collect())]
}

/// With a hole, and what was cut out of it: the outline shrunk towards its middle.
fn cut(random: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let outline = given.light.shape.vertices();
    let middle = star_middle(outline);
    let factor = random.between(0.1, 0.95);
    let hole: Vec<_> = outline.iter().map(|v| middle.lerp(*v, factor)).collect();
    let mut with_hole = given.clone();
    with_hole.light.cut_holes(std::slice::from_ref(&hole)).expect("it is inside");
    vec![with_hole, with_outline(given, hole)]
}

/// Everything together: anyhow, and about the normal.
fn rotated(random: &mut Random, given: &EvalPoint) -> Vec<EvalPoint> {
    let anyhow = DQuat::from_axis_angle(random.direction(), random.between(0.0, 6.0));
    let about_normal = DQuat::from_rotation_z(random.between(0.0, 6.0));
    let by = |turn: DQuat| {
        let mut turned = given.clone();
        turned.normal = turn * given.normal;
        turned.view = turn * given.view;
        turned.light.shape.vertices_mut().iter_mut().for_each(|vertex| *vertex = turn * *vertex);
        turned
    };
    [anyhow, about_normal].map(by).into()
}
