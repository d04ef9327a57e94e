//! A sphere of triangles.

use arealight::glam::DVec3;
use std::collections::HashMap;

/// A sphere of triangles whose vertices are on it: an icosahedron, each triangle split in four `times` times.
pub fn icosphere(times: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    let mut corners: Vec<DVec3> = corners.into_iter().map(DVec3::normalize_or_zero).collect();
    // Three corners that are nearest to each other are a triangle
    let near = |a: usize, b: usize| corners[a].dot(corners[b]) > 0.4;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in (a + 1..12).filter(|&b| near(a, b)) {
            for c in (b + 1..12).filter(|&c| near(a, c) && near(b, c)) {
                let outwards = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                triangles.push(if outwards { [a, b, c] } else { [a, c, b] }.map(|corner| corner as u32));
            }
        }
    }
    for _ in 0..times {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                corners.push((corners[a as usize] + corners[b as usize]).normalize_or_zero());
                corners.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (corners, triangles)
}
