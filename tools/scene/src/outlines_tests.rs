use super::*;
use std::f64::consts::{PI, TAU};

/// A triangulated grid of unit cells in the plane z = 0, facing +Z; `keep` says which cells are there.
fn grid(width: u32, height: u32, keep: impl Fn(u32, u32) -> bool) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let positions = (0..=height)
        .flat_map(|y| (0..=width).map(move |x| DVec3::new(f64::from(x), f64::from(y), 0.0)))
        .collect();
    let at = |x: u32, y: u32| y * (width + 1) + x;
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| keep(x, y));
    let triangles = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        [[a, b, c], [a, c, d]]
    });
    (positions, triangles.collect())
}

/// Triangles around a middle, to places on the unit circle times `radius`.
fn fan(count: u32, radius: impl Fn(u32) -> f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corner = |i| DVec2::from_angle(f64::from(i) * TAU / f64::from(count)).extend(0.0) * radius(i);
    let positions = [DVec3::ZERO].into_iter().chain((0..count).map(corner)).collect();
    (positions, (0..count).map(|i| [0, i + 1, (i + 1) % count + 1]).collect())
}

/// The outlines of triangles without texture coordinates, to the digit.
fn plain((positions, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> Outlines {
    outlines(positions, triangles, 0.0, None)
}

/// Area times normal of all polygons.
fn total_area(outlines: &Outlines) -> DVec3 {
    let area = |vertices: &Vec<DVec3>| arealight::LightShape::Polygon(vertices.clone()).area_vector();
    outlines.polygons.iter().map(area).sum()
}

fn counts(outlines: &Outlines) -> Vec<usize> {
    outlines.polygons.iter().map(Vec::len).collect()
}

#[test]
fn a_quad_is_one_outline_of_four_vertices() {
    let (positions, triangles) = grid(1, 1, |_, _| true);
    let merged = outlines(&positions, &triangles, 0.0, None);
    assert_eq!((counts(&merged), merged.bent, merged.split), (vec![4], false, 0));
    assert_eq!(total_area(&merged), DVec3::Z);
    // The twin: turned around, it faces down
    let turned: Vec<_> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    assert_eq!(total_area(&outlines(&positions, &turned, 0.0, None)), DVec3::NEG_Z);
}

#[test]
fn vertices_inside_and_on_straight_edges_go() {
    let merged = plain(&grid(7, 5, |_, _| true));
    assert_eq!(counts(&merged), [4]);
    assert_eq!(total_area(&merged), DVec3::Z * 35.0);
}

#[test]
fn concave_outlines_stay_whole() {
    let (positions, triangles) = grid(4, 4, |x, y| x == 0 || y == 0);
    let merged = outlines(&positions, &triangles, 0.0, None);
    assert_eq!((counts(&merged), merged.split), (vec![6], 0), "an L");
    assert_eq!(total_area(&merged), DVec3::Z * 7.0);

    let star = fan(10, |i| if i % 2 == 0 { 1.0 } else { 0.4 });
    assert_eq!(counts(&plain(&star)), [10]);
}

#[test]
fn vertices_that_are_not_shared_are_welded() {
    let (positions, triangles) = grid(3, 2, |_, _| true);
    let loose: Vec<DVec3> = triangles.iter().flatten().map(|&i| positions[i as usize]).collect();
    let apart: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    assert_eq!(counts(&outlines(&loose, &apart, 0.0, None)), [4]);
    // The twin: a gap that is larger than the tolerance keeps them apart
    let gaps: Vec<DVec3> =
        loose.iter().enumerate().map(|(i, p)| *p + DVec3::X * ((i / 3) as f64 * 1e-3)).collect();
    assert_eq!(counts(&outlines(&gaps, &apart, 0.0, None)), [3; 12]);
}

#[test]
fn islands_are_outlines_of_their_own() {
    let merged = plain(&grid(5, 1, |x, _| x != 2));
    assert_eq!((counts(&merged), merged.bent, merged.split), (vec![4, 4], false, 0));
}

#[test]
fn corners_that_touch_do_not_connect() {
    assert_eq!(counts(&plain(&grid(2, 2, |x, y| x == y))), [4, 4]);
}

#[test]
fn a_ring_becomes_one_outline_around_its_hole() {
    let merged = plain(&grid(5, 5, |x, y| !(1..4).contains(&x) || !(1..4).contains(&y)));
    assert_eq!((counts(&merged), merged.split, merged.bent), (vec![4 + 4 + 2], 0, false));
    assert_eq!(total_area(&merged), DVec3::Z * 16.0);
    // The bridge is all that is there twice
    let polygon = &merged.polygons[0];
    let twice = polygon.iter().enumerate().filter(|(i, a)| polygon[..*i].contains(a)).count();
    assert_eq!(twice, 2);
}

#[test]
fn many_holes_are_covered_once() {
    let merged = plain(&grid(9, 9, |x, y| x % 2 == 0 || y % 2 == 0));
    assert_eq!(total_area(&merged), DVec3::Z * (81.0 - 16.0));
    assert_eq!((counts(&merged), merged.split), (vec![4 + 16 * (4 + 2)], 0));
}

#[test]
fn holes_that_touch_make_several_simple_outlines() {
    // Two holes that share a corner
    let merged = plain(&grid(4, 4, |x, y| !((x, y) == (1, 1) || (x, y) == (2, 2))));
    assert_eq!(total_area(&merged), DVec3::Z * 14.0);
    assert!(merged.split > 0);
    // Each outline is simple: no vertex twice
    for polygon in &merged.polygons {
        for (i, a) in polygon.iter().enumerate() {
            assert!(polygon[..i].iter().all(|b| a != b));
        }
    }
}

/// A cube of 2 × 2 × 2 around the origin with `n` by `n` cells a face, and `shape` applied to its vertices.
fn cube(n: u32, shape: impl Fn(DVec3) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (flat, cells) = grid(n, n, |_, _| true);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for face in 0..6 {
        let first = positions.len() as u32;
        let turn = [DVec3::X, DVec3::Y, DVec3::Z][face % 3];
        let side = if face < 3 { 1.0 } else { -1.0 };
        let across = DVec3::new(turn.z, turn.x, turn.y) * side;
        let up = turn.cross(across) * side;
        positions.extend(flat.iter().map(|p| {
            let q = *p * (2.0 / f64::from(n)) - DVec3::new(1.0, 1.0, 0.0);
            shape(turn * side + across * q.x + up * q.y)
        }));
        triangles.extend(cells.iter().map(|t| t.map(|i| i + first)));
    }
    (positions, triangles)
}

#[test]
fn a_box_is_six_quads() {
    let merged = plain(&cube(3, |p| p));
    assert_eq!((counts(&merged), merged.bent, merged.split), (vec![4; 6], true, 0));
    // It is closed, and each face shows outwards
    assert!(total_area(&merged).length() < 1e-12);
    for polygon in &merged.polygons {
        let normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[1]);
        assert!(normal.dot(polygon[0]) > 0.0);
    }
}

#[test]
fn a_sphere_is_a_light_a_triangle() {
    let (positions, triangles) = cube(4, DVec3::normalize_or_zero);
    let merged = outlines(&positions, &triangles, 0.0, None);
    assert!(merged.bent);
    // Some cells are flat by symmetry; all others are two triangles each
    assert!(merged.polygons.len() > 150 && merged.polygons.len() <= 192, "{}", merged.polygons.len());
    assert!(total_area(&merged).length() < 1e-12);
}

#[test]
fn a_fine_cylinder_does_not_drift_flat() {
    // Neighbouring strips differ by 0.1 degrees: each is compared with the first of its part
    let strips = 3600_u32;
    let positions: Vec<DVec3> = (0..strips * 2)
        .map(|i| {
            let (sin, cos) = (f64::from(i / 2) * TAU / f64::from(strips)).sin_cos();
            DVec3::new(cos, sin, f64::from(i % 2))
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..strips)
        .flat_map(|i| {
            let (a, b) = (2 * i, 2 * ((i + 1) % strips));
            [[a, b, b + 1], [a, b + 1, a + 1]]
        })
        .collect();
    let merged = outlines(&positions, &triangles, 0.0, None);
    // Within 1e-5 of a plane: a few strips each
    assert!(merged.bent && merged.polygons.len() > 300, "{}", merged.polygons.len());
}

#[test]
fn faces_back_to_back_are_two_quads() {
    let (positions, mut triangles) = grid(2, 2, |_, _| true);
    let back: Vec<_> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    triangles.extend(back);
    let merged = outlines(&positions, &triangles, 0.0, None);
    assert_eq!((counts(&merged), merged.bent, merged.split), (vec![4, 4], false, 0));
    assert_eq!(total_area(&merged), DVec3::ZERO);
}

#[test]
fn copies_and_slivers_are_left_out() {
    let (mut positions, mut triangles) = grid(1, 1, |_, _| true);
    triangles.extend([triangles[0], [triangles[1][1], triangles[1][2], triangles[1][0]]]);
    positions.push(DVec3::new(0.5, 1e-9, 0.0));
    triangles.push([0, 4, 1]);
    assert_eq!(counts(&outlines(&positions, &triangles, 0.0, None)), [4]);
}

#[test]
fn curved_outlines_keep_their_shape() {
    // 2000 vertices on a circle: dropping them one by one would let the error grow
    let merged = plain(&fan(2000, |_| 1.0));
    assert_eq!(merged.polygons.len(), 1);
    // An outline within 2.8e-5 of the circle loses at most that times its circumference
    assert!((total_area(&merged).z - PI).abs() < 2.8e-5 * TAU);
    assert!(merged.polygons[0].len() < 1000);
}

#[test]
fn rounding_does_not_keep_neighbors_apart() {
    // A square of side 1 at 1e5 in float32: its vertices are 0.004 off
    let (positions, triangles) = grid(2, 2, |_, _| true);
    let turned = glam::DQuat::from_rotation_x(0.7) * glam::DQuat::from_rotation_y(0.4);
    let rounded: Vec<DVec3> =
        positions.iter().map(|p| (turned * *p + DVec3::splat(1e5)).as_vec3().as_dvec3()).collect();
    let error = 1e5 * f64::from(f32::EPSILON);
    assert_eq!(counts(&outlines(&rounded, &triangles, error, None)), [4]);
    // The twin: without the allowance it is not flat
    assert!(outlines(&rounded, &triangles, 0.0, None).bent);
}

#[test]
fn nothing_is_nothing() {
    let merged = outlines(&[], &[], 0.0, None);
    assert!(merged.polygons.is_empty() && !merged.bent);
    let merged = outlines(&[DVec3::ONE], &[[0, 0, 0]], 0.0, None);
    assert!(merged.polygons.is_empty());
}

/// Outlines of triangles with texture coordinates, to a thousandth.
fn mapped(positions: &[DVec3], triangles: &[[u32; 3]], uv: impl Fn(DVec3) -> DVec2) -> Outlines {
    let uvs: Vec<Vec2> = positions.iter().map(|p| uv(*p).as_vec2()).collect();
    let coordinates = Coordinates { uvs: &uvs, tolerance: DVec2::splat(1e-3) };
    outlines(positions, triangles, 0.0, Some(coordinates))
}

#[test]
fn one_mapping_is_one_outline_with_coordinates() {
    let (positions, triangles) = grid(8, 5, |_, _| true);
    let uv = |p: DVec3| DVec2::new(0.1 + 0.3 * p.x - 0.2 * p.y, 2.0 + 0.05 * p.x + 0.4 * p.y);
    let merged = mapped(&positions, &triangles, uv);
    assert_eq!((counts(&merged), merged.seams), (vec![4], false));
    for (vertex, at) in merged.polygons[0].iter().zip(&merged.uvs[0]) {
        // 2e-6: float32 coordinates around 2, of a seed an eighth as wide as the whole
        assert!((uv(*vertex) - *at).length() < 2e-6 * 8.0, "{vertex}: {at}");
    }
    // The twin: without coordinates there are none
    assert!(outlines(&positions, &triangles, 0.0, None).uvs.is_empty());
}

#[test]
fn a_seam_begins_another_outline() {
    // The texture starts anew in the middle, where the vertices are there twice
    let (mut positions, mut triangles) = grid(2, 1, |x, _| x == 0);
    let (more, other) = grid(2, 1, |x, _| x == 1);
    triangles.extend(other.iter().map(|t| t.map(|i| i + positions.len() as u32)));
    let left = positions.len();
    positions.extend(more);
    let uvs: Vec<Vec2> = positions
        .iter()
        .enumerate()
        .map(|(i, p)| Vec2::new(p.x as f32 - if i < left { 0.0 } else { 1.0 }, p.y as f32))
        .collect();
    let at = |tolerance| {
        let coordinates = Coordinates { uvs: &uvs, tolerance: DVec2::splat(tolerance) };
        outlines(&positions, &triangles, 0.0, Some(coordinates))
    };
    let merged = at(1e-3);
    assert_eq!((counts(&merged), merged.seams, merged.bent, merged.split), (vec![4, 4], true, false, 0));
    for uvs in &merged.uvs {
        assert_eq!(uvs.iter().copied().fold(DVec2::INFINITY, DVec2::min), DVec2::ZERO);
        assert_eq!(uvs.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max), DVec2::ONE);
    }
    // The twin: a tolerance of more than the step does not see it
    assert_eq!((counts(&at(1.5)), at(1.5).seams), (vec![4], false));
}

#[test]
fn a_mapping_that_bends_follows_the_triangles() {
    // A trapezium with the corners of a square image: each of its triangles is mapped in its own way
    let positions = [[-2.0, 0.0], [2.0, 0.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let corners = [DVec2::new(0.0, 1.0), DVec2::ONE, DVec2::X, DVec2::ZERO];
    let uv = |p: DVec3| corners[positions.iter().position(|q| *q == p).unwrap()];
    let merged = mapped(&positions, &[[0, 1, 2], [0, 2, 3]], uv);
    assert_eq!((counts(&merged), merged.seams), (vec![3, 3], true));
}

#[test]
fn a_fan_is_one_outline_however_it_is_turned() {
    let turn = glam::DQuat::from_rotation_x(0.7) * glam::DQuat::from_rotation_y(0.4);
    let (flat, triangles) = fan(500, |_| 1.0);
    let positions: Vec<DVec3> = flat.into_iter().map(|p| turn * p).collect();
    let merged = mapped(&positions, &triangles, |p| (turn.inverse() * p).truncate() * 0.5 + 0.5);
    assert_eq!((merged.polygons.len(), merged.seams), (1, false));
    // The twin: a mapping along the edge and out from the middle bends everywhere; a few neighbours are
    // within the tolerance
    let cone = |p: DVec3| {
        let p = (turn.inverse() * p).truncate();
        DVec2::new(p.to_angle(), p.length())
    };
    assert!(mapped(&positions, &triangles, cone).polygons.len() > 100);
}

#[test]
fn coordinates_may_be_anything() {
    let (positions, triangles) = grid(3, 3, |_, _| true);
    for scale in [0.0, 1e30, f64::MAX, f64::INFINITY, f64::NAN] {
        let merged = mapped(&positions, &triangles, |p| p.truncate() * scale);
        assert_eq!(total_area(&merged), DVec3::Z * 9.0, "{scale}");
        assert_eq!(merged.uvs.len(), merged.polygons.len());
    }
}
