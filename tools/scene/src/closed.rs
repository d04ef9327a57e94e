//! Closed meshes: what has an inside, which nobody sees.

use crate::bounds::Bounds;
use crate::weld;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

/// The most of a part's area that its holes may have, for it to have an inside: the ends of a long tube, as
/// curves with a bevel leave them open.
const HOLES: f64 = 0.05;

/// Which triangles belong to a connected part that is closed up to small holes (other edges are shared by
/// exactly two of its triangles, which run along them in opposite directions) and faces outwards (its signed
/// volume is positive). `rounding` is how far positions may be off in any case.
pub(crate) fn closed(positions: &[DVec3], triangles: &[[u32; 3]], rounding: f64) -> Vec<bool> {
    let corners = welded(positions, triangles, rounding);
    let parts = connected(&corners);
    let mut is_closed = vec![true; triangles.len()];
    // An edge is good where it is passed once in each direction
    let mut passed: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    // A triangle with two corners in one place, as at a sphere's pole, has no sides
    let has_sides = |[a, b, c]: &&[u32; 3]| a != b && b != c && c != a;
    for edge in corners.iter().filter(has_sides).flat_map(edges) {
        let way = usize::from(edge[0] > edge[1]);
        passed.entry(sorted(edge)).or_default()[way] += 1;
    }
    for (triangle, part) in corners.iter().zip(&parts).filter(|(triangle, _)| has_sides(triangle)) {
        let ways = edges(triangle).map(|edge| passed[&sorted(edge)]);
        is_closed[*part] &= ways.iter().all(|way| matches!(way, [0, 1] | [1, 0 | 1]));
    }
    let borders = corners.iter().zip(triangles).zip(&parts).filter(|((corners, _), _)| has_sides(corners));
    let borders = borders.flat_map(|((corners, triangle), part)| {
        let ends = edges(corners).into_iter().zip(edges(triangle));
        ends.filter(|(edge, _)| passed[&sorted(*edge)] != [1, 1]).map(|(edge, ends)| (*part, edge, ends))
    });
    let borders: Vec<(usize, [u32; 2], [u32; 2])> = borders.collect();
    let holes = holes(positions, &borders, triangles.len());
    let mut areas = vec![0.0; triangles.len()];
    for (triangle, part) in triangles.iter().zip(&parts) {
        let [a, b, c] = triangle.map(|index| positions[index as usize]);
        areas[*part] += 0.5 * (b - a).cross(c - a).length();
    }
    for (part, is_closed) in is_closed.iter_mut().enumerate() {
        *is_closed &= holes[part] <= HOLES * areas[part];
    }
    // Six times the volume, about a corner of the part, which costs no digits where the mesh is far away
    let mut volumes = vec![0.0; triangles.len()];
    for (triangle, part) in triangles.iter().zip(&parts) {
        let origin = positions[triangles[*part][0] as usize];
        let [a, b, c] = triangle.map(|index| positions[index as usize] - origin);
        volumes[*part] += a.cross(b).dot(c);
    }
    parts.iter().map(|part| is_closed[*part] && volumes[*part] > 0.0).collect()
}

/// The area of each part's holes, or more: what edges that join enclose at most, the disk of their length.
/// `borders` has of each edge its part, its ends by their numbers and by their positions'.
fn holes(positions: &[DVec3], borders: &[(usize, [u32; 2], [u32; 2])], parts: usize) -> Vec<f64> {
    let mut parent: Vec<usize> = (0..borders.len()).collect();
    let mut owner: HashMap<u32, usize> = HashMap::new();
    for (number, (_, edge, _)) in borders.iter().enumerate() {
        for end in edge {
            let neighbour = *owner.entry(*end).or_insert(number);
            let (a, b) = (root(&mut parent, neighbour), root(&mut parent, number));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut lengths = vec![0.0; borders.len()];
    for (number, (_, _, ends)) in borders.iter().enumerate() {
        let [from, to] = ends.map(|end| positions[end as usize]);
        lengths[root(&mut parent, number)] += from.distance(to);
    }
    let mut areas = vec![0.0; parts];
    for ((part, ..), length) in borders.iter().zip(lengths) {
        areas[*part] += length * length / (4.0 * PI);
    }
    areas
}

/// The triangles' corners, with one number for all vertices in one place.
fn welded(positions: &[DVec3], triangles: &[[u32; 3]], rounding: f64) -> Vec<[u32; 3]> {
    let size = triangles.iter().flatten().map(|&i| positions[i as usize]).collect::<Bounds>().diagonal();
    let (_, numbers) = weld::weld(positions, triangles, weld::tolerance(size, rounding));
    triangles.iter().map(|triangle| triangle.map(|index| numbers[&index])).collect()
}

/// The part of each triangle: the first triangle that is joined to it by edges.
fn connected(corners: &[[u32; 3]]) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..corners.len()).collect();
    let mut owner: HashMap<[u32; 2], usize> = HashMap::new();
    for (number, triangle) in corners.iter().enumerate() {
        for edge in edges(triangle) {
            let neighbour = *owner.entry(sorted(edge)).or_insert(number);
            let (a, b) = (root(&mut parent, neighbour), root(&mut parent, number));
            parent[a.max(b)] = a.min(b);
        }
    }
    (0..corners.len()).map(|number| root(&mut parent, number)).collect()
}

/// The representative of a set, with the way to it halved.
fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}

fn edges(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron that faces outwards, each face with vertices of its own.
    fn tetrahedron(at: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let positions = faces.iter().flatten().map(|corner: &usize| at + corners[*corner]).collect();
        (positions, (0..4).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect())
    }

    #[test]
    fn a_tetrahedron_is_closed_and_without_a_face_it_is_not() {
        let (positions, mut triangles) = tetrahedron(DVec3::new(1e3, 0.0, -1e3));
        assert_eq!(closed(&positions, &triangles, 0.0), [true; 4]);
        // Inside out; with one face turned around; twice in one place; without a face
        let inside_out: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(closed(&positions, &inside_out, 0.0), [false; 4]);
        let mut turned = triangles.clone();
        turned[2].swap(0, 1);
        assert_eq!(closed(&positions, &turned, 0.0), [false; 4]);
        let doubled = [&triangles[..], &triangles[..]].concat();
        assert_eq!(closed(&positions, &doubled, 0.0), [false; 8]);
        triangles.pop();
        assert_eq!(closed(&positions, &triangles, 0.0), [false; 3]);
    }

    #[test]
    fn each_part_is_judged_by_itself() {
        let (mut positions, mut triangles) = tetrahedron(DVec3::ZERO);
        let (more, _) = tetrahedron(DVec3::splat(5.0));
        positions.extend(more);
        triangles.extend((4..7).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]));
        let [yes, no] = [true, false];
        assert_eq!(closed(&positions, &triangles, 0.0), [yes, yes, yes, yes, no, no, no]);
    }

    #[test]
    fn vertices_are_welded_up_to_rounding() {
        let (mut positions, triangles) = tetrahedron(DVec3::ZERO);
        positions[0] += 1e-4;
        assert_eq!(closed(&positions, &triangles, 2e-4), [true; 4]);
        assert_eq!(closed(&positions, &triangles, 0.0), [false; 4]);
    }
}
