//! Polygons with holes: several outlines of one light.
//!
//! A hole is joined to the outline by a bridge, an edge there and the same edge back, which makes one outline
//! of both. What the two edges of a bridge add to a sum over edges cancels but for rounding, wherever it is
//! cut: so all that takes any outline takes this one, and the light is one record with one radiance.

use crate::light_fault::LightFault;
use crate::light_shape::FLAT;
use crate::{Light, LightShape};
use glam::{DVec2, DVec3};

impl Light {
    /// Cuts holes into a polygon, each an outline of its own, in either direction. The light's vertices
    /// become one outline that goes around all of them; its area and center are those of what is left, and
    /// its image stays where it is. A light has as many vertices more as the holes have, and two for each
    /// hole.
    ///
    /// ```
    /// # use arealight::{Light, LightShape};
    /// # use glam::DVec3;
    /// let square =
    ///     |size: f64| vec![DVec3::ZERO, DVec3::X * size, DVec3::new(size, size, 0.0), DVec3::Y * size];
    /// let hole = square(1.0).into_iter().map(|vertex| vertex + DVec3::new(1.0, 1.0, 0.0)).collect();
    /// let mut frame = Light { shape: LightShape::Polygon(square(3.0)), ..Light::default() };
    /// frame.cut_holes(&[hole])?;
    /// assert_eq!((frame.shape.vertices().len(), frame.shape.area_vector()), (10, DVec3::Z * 8.0));
    /// # Ok::<(), arealight::LightFault>(())
    /// ```
    ///
    /// # Errors
    /// What [`Light::validate`] refuses, and what is wrong with a hole, which is named; then the light is as
    /// it was.
    pub fn cut_holes(&mut self, holes: &[Vec<DVec3>]) -> Result<(), LightFault> {
        self.validate()?;
        if holes.is_empty() {
            return Ok(());
        }
        if !self.shape.is_polygonal() || self.shape.is_mesh() {
            return Err(LightFault::HolesNoPolygon);
        }
        let map = self.texture.as_ref().and_then(|texture| texture.map(&self.shape).ok());
        let outline = with_holes(&self.shape, holes)?;
        // The holes' vertices are where the image is
        if let (Some(texture), Some(map)) = (&mut self.texture, map) {
            texture.uvs = outline.iter().map(|vertex| map.coordinate(*vertex)).collect();
        }
        self.shape = LightShape::Polygon(outline);
        Ok(())
    }
}

/// A vertex in space and in the polygon's plane.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    space: DVec3,
    flat: DVec2,
}

/// The vertices of one outline around a polygon and its holes; else the hole that cannot be cut.
fn with_holes(polygon: &LightShape, holes: &[Vec<DVec3>]) -> Result<Vec<DVec3>, LightFault> {
    // Project onto the plane, so that the front is counter-clockwise
    let normal = polygon.area_vector().try_normalize().ok_or(LightFault::HoleNoArea { hole: 0 })?;
    let vertices = polygon.vertices();
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let anchor = vertices[0];
    let flatten = |space: &DVec3| {
        let offset = *space - anchor;
        Vertex { space: *space, flat: DVec2::new(offset.dot(tangent), offset.dot(bitangent)) }
    };
    let mut outline: Vec<Vertex> = vertices.iter().map(flatten).collect();
    let size = vertices.iter().map(|vertex| vertex.distance(anchor)).fold(0.0, f64::max);
    let mut loops = Vec::new();
    for (number, hole) in holes.iter().enumerate() {
        check_vertices((number, hole), |vertex| (vertex - anchor).dot(normal), size)?;
        // Holes go around clockwise
        let mut hole: Vec<Vertex> = hole.iter().map(flatten).collect();
        let area = doubled_area(&hole);
        if area == 0.0 {
            return Err(LightFault::HoleNoArea { hole: number });
        }
        if area > 0.0 {
            hole.reverse();
        }
        loops.push((number, hole));
    }
    check_places(&outline, &loops)?;
    // From the right: so the rightmost vertex of a hole sees the outline of what was joined before
    let rightmost = |hole: &[Vertex]| {
        (0..hole.len()).max_by(|a, b| hole[*a].flat.x.total_cmp(&hole[*b].flat.x)).unwrap_or_default()
    };
    loops.sort_by(|(_, a), (_, b)| b[rightmost(b)].flat.x.total_cmp(&a[rightmost(a)].flat.x));
    for index in 0..loops.len() {
        let (number, hole) = &loops[index];
        let start = rightmost(hole);
        let obstacles = loops[index..].iter().flat_map(|(_, hole)| edges(hole));
        let bridge = bridge(&outline, hole[start], &obstacles.collect::<Vec<_>>());
        let at = bridge.ok_or(LightFault::HoleNoBridge { hole: *number })?;
        // There, around, and back
        let around = (0..=hole.len()).map(|i| hole[(start + i) % hole.len()]);
        let rest = outline.split_off(at + 1);
        let corner = outline[at];
        outline.extend(around.chain([corner]).chain(rest));
    }
    Ok(outline.into_iter().map(|vertex| vertex.space).collect())
}

/// Checks what can be told of a hole by itself.
fn check_vertices(
    (hole, vertices): (usize, &[DVec3]),
    height: impl Fn(DVec3) -> f64,
    size: f64,
) -> Result<(), LightFault> {
    if vertices.len() < 3 {
        return Err(LightFault::HoleTooFewVertices { hole, count: vertices.len() });
    }
    for (index, &value) in vertices.iter().enumerate() {
        if !value.as_vec3().is_finite() {
            return Err(LightFault::HoleVertexNotFinite { hole, index, value });
        }
        let distance = height(value).abs();
        if distance > FLAT * size {
            return Err(LightFault::HoleOffPlane { hole, index, distance });
        }
    }
    Ok(())
}

/// Checks that holes are in the outline, none in another, and that nothing touches.
fn check_places(outline: &[Vertex], holes: &[(usize, Vec<Vertex>)]) -> Result<(), LightFault> {
    for (number, hole) in holes {
        let others = || holes.iter().filter(|(other, _)| other != number).map(|(_, other)| &other[..]);
        let misplaced = hole.iter().position(|vertex| {
            !is_inside(vertex.flat, outline) || others().any(|other| is_inside(vertex.flat, other))
        });
        if let Some(index) = misplaced {
            return Err(LightFault::HoleOutside { hole: *number, index });
        }
        let around = || edges(outline).chain(others().flat_map(edges));
        let meets_others = edges(hole).any(|edge| around().any(|other| meet(edge, other)));
        // Edges that follow one another share a vertex
        let count = hole.len();
        let own: Vec<_> = edges(hole).collect();
        let meets_itself = (0..count).any(|i| {
            (i + 2..count).any(|j| (j + 1) % count != i && meet(own[i], own[j])) || own[i][0] == own[i][1]
        });
        if meets_others || meets_itself {
            return Err(LightFault::HoleCrosses { hole: *number });
        }
    }
    Ok(())
}

/// The vertex of an outline that a bridge from `start` goes to: the nearest that it reaches without meeting
/// an edge.
fn bridge(outline: &[Vertex], start: Vertex, obstacles: &[[DVec2; 2]]) -> Option<usize> {
    let mut candidates: Vec<usize> = (0..outline.len()).collect();
    let distance = |index: &usize| outline[*index].flat.distance_squared(start.flat);
    candidates.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    candidates.into_iter().find(|&index| {
        let end = outline[index].flat;
        let [before, after] = [index + outline.len() - 1, index + 1].map(|i| outline[i % outline.len()].flat);
        // Where bridges meet, a corner of the outline is there several times: the one whose inside the bridge
        // comes from
        let (of_before, of_after) = (turn(before, end, start.flat), turn(end, after, start.flat));
        let convex = turn(before, end, after) > 0.0;
        let inside =
            if convex { of_before >= 0.0 && of_after >= 0.0 } else { of_before >= 0.0 || of_after >= 0.0 };
        let shares = |edge: &[DVec2; 2]| edge.iter().any(|place| *place == end || *place == start.flat);
        let mut others = edges(outline).chain(obstacles.iter().copied()).filter(|edge| !shares(edge));
        inside && others.all(|edge| !meet([start.flat, end], edge))
    })
}

fn edges(outline: &[Vertex]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..outline.len()).map(|i| [outline[i].flat, outline[(i + 1) % outline.len()].flat])
}

/// Twice the area that an outline goes around counter-clockwise.
fn doubled_area(outline: &[Vertex]) -> f64 {
    let anchor = outline.first().map_or(DVec2::ZERO, |vertex| vertex.flat);
    edges(outline).map(|[a, b]| (a - anchor).perp_dot(b - anchor)).sum()
}

/// Positive where the way from a over b to c turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// Whether two edges meet, if only in a point.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    let sides = |x: f64, y: f64| x == 0.0 || y == 0.0 || (x > 0.0) != (y > 0.0);
    !apart && sides(turn(a, b, c), turn(a, b, d)) && sides(turn(c, d, a), turn(c, d, b))
}

/// Whether a point is inside an outline, in either direction: a ray to the right meets it an odd number of
/// times.
fn is_inside(point: DVec2, outline: &[Vertex]) -> bool {
    let crossings = edges(outline)
        .filter(|[a, b]| (a.y > point.y) != (b.y > point.y) && (turn(*a, *b, point) > 0.0) == (b.y > a.y));
    crossings.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A regular polygon about a point of the plane z = 2, counter-clockwise from above.
    fn regular(center: [f64; 2], radius: f64, count: u32) -> Vec<DVec3> {
        let vertex = |i: u32| {
            let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / f64::from(count)).sin_cos();
            DVec3::new(center[0] + radius * cosine, center[1] + radius * sine, 2.0)
        };
        (0..count).map(vertex).collect()
    }

    fn polygon(vertices: Vec<DVec3>) -> Light {
        Light { shape: LightShape::Polygon(vertices), ..Light::default() }
    }

    fn disk() -> Light {
        polygon(regular([0.0; 2], 4.0, 24))
    }

    /// That triangles with the corners of a light cover its area once.
    fn assert_covered(light: &Light, area: f64) {
        assert!(
            (light.shape.area_vector() - DVec3::Z * area).length() < 1e-12,
            "{}",
            light.shape.area_vector()
        );
        let mut triangles: Vec<usize> = Vec::new();
        earcut::Earcut::new().earcut(light.shape.vertices().iter().map(|v| [v.x, v.y]), &[], &mut triangles);
        let areas = triangles.chunks_exact(3).map(|triangle| {
            let [a, b, c] = [0, 1, 2].map(|i| light.shape.vertices()[triangle[i]]);
            (b - a).cross(c - a).z.abs() * 0.5
        });
        let sum: f64 = areas.sum();
        assert!((sum - area).abs() < 1e-12, "{sum} is not {area}");
    }

    fn area(outline: &[DVec3]) -> f64 {
        LightShape::Polygon(outline.to_vec()).area_vector().z.abs()
    }

    #[test]
    fn a_ring_is_one_outline_in_either_direction() {
        let hole = regular([0.5, 0.0], 3.0, 24);
        let reversed: Vec<_> = hole.iter().rev().copied().collect();
        for hole in [hole, reversed] {
            let mut ring = disk();
            ring.cut_holes(std::slice::from_ref(&hole)).unwrap();
            assert_eq!(ring.shape.vertices().len(), 24 + 24 + 2);
            assert_covered(&ring, area(disk().shape.vertices()) - area(&hole));
            // What is left lies to the left
            assert!(
                ring.shape.center().x < -0.1 && ring.shape.center().y.abs() < 1e-12,
                "{}",
                ring.shape.center()
            );
            assert!(!ring.shape.is_convex_quad());
        }
    }

    #[test]
    fn an_image_stays_where_it_is() {
        let mut ring = disk();
        let place = |vertex: &DVec3| DVec2::new(vertex.x, vertex.y) / 8.0 + 0.5;
        let uvs = ring.shape.vertices().iter().map(place).collect();
        ring.texture = Some(crate::LightTexture { layer: 0, uvs });
        let mut stale = ring.clone();
        let before = ring.texture.as_ref().unwrap().map(&ring.shape).unwrap();
        let hole = regular([0.5, 0.0], 3.0, 24);
        ring.cut_holes(std::slice::from_ref(&hole)).unwrap();
        ring.validate().unwrap();
        let texture = ring.texture.as_ref().unwrap();
        let off = |(uv, vertex): (&DVec2, &DVec3)| uv.distance(place(vertex));
        assert!(texture.uvs.iter().zip(ring.shape.vertices()).map(off).fold(0.0, f64::max) < 1e-12);
        let after = texture.map(&ring.shape).unwrap();
        assert!(
            (after.corner - before.corner).length() < 1e-9 && (after.axis_u - before.axis_u).length() < 1e-9
        );
        // The twin: a light whose coordinates stay as they were is refused
        stale.shape.clone_from(&ring.shape);
        assert!(stale.validate().is_err());
    }

    #[test]
    fn many_holes_are_all_cut() {
        let places = (0..25).map(|i| [f64::from(i % 5) - 2.0, f64::from(i / 5) - 2.0]);
        let holes: Vec<_> = places.map(|center| regular(center, 0.45, 7)).collect();
        let mut sieve = disk();
        sieve.cut_holes(&holes).unwrap();
        assert_eq!(sieve.shape.vertices().len(), 24 + 25 * (7 + 2));
        assert_covered(&sieve, area(disk().shape.vertices()) - 25.0 * area(&holes[0]));
        // The twin: one hole less
        sieve = disk();
        sieve.cut_holes(&holes[1..]).unwrap();
        assert!(sieve.shape.area_vector().z > area(disk().shape.vertices()) - 24.5 * area(&holes[0]));
    }

    #[test]
    fn holes_in_a_concave_outline() {
        // A comb whose teeth point up, with a hole in each
        let mut comb = vec![DVec3::new(9.0, -1.0, 0.0)];
        let mut holes = Vec::new();
        for tooth in (0..5).rev() {
            let left = f64::from(tooth) * 2.0;
            let corners = [[1.0, 0.0], [1.0, 5.0], [0.0, 5.0], [0.0, 0.0]];
            comb.extend(corners.map(|[x, y]| DVec3::new(left + x, y, 0.0)));
            let low = 4.0 - f64::from(tooth) * 0.7;
            holes.push(
                [[0.2, 0.0], [0.8, 0.0], [0.5, 0.5]]
                    .map(|[x, y]| DVec3::new(left + x, low + y, 0.0))
                    .to_vec(),
            );
        }
        comb.push(DVec3::new(0.0, -1.0, 0.0));
        let mut light = polygon(comb);
        let whole = light.shape.area_vector().z;
        light.cut_holes(&holes).unwrap();
        assert_covered(&light, whole - 5.0 * area(&holes[0]));
    }

    #[test]
    fn holes_that_cannot_be_are_refused() {
        let refused = |holes: &[Vec<DVec3>]| {
            let mut light = disk();
            let error = light.cut_holes(holes).unwrap_err();
            assert_eq!(light, disk(), "as it was");
            error
        };
        let good = regular([0.0; 2], 1.0, 5);
        let two = good[..2].to_vec();
        assert_eq!(refused(&[good.clone(), two]), LightFault::HoleTooFewVertices { hole: 1, count: 2 });
        let mut lifted = good.clone();
        lifted[3].z += 0.1;
        assert!(matches!(refused(&[lifted]), LightFault::HoleOffPlane { hole: 0, index: 3, .. }));
        let mut not_finite = good.clone();
        not_finite[4].x = f64::NAN;
        assert!(matches!(refused(&[not_finite]), LightFault::HoleVertexNotFinite { hole: 0, index: 4, .. }));
        assert_eq!(refused(&[regular([7.0, 0.0], 1.0, 5)]), LightFault::HoleOutside { hole: 0, index: 0 });
        assert!(refused(&[good.clone(), good.clone()]).to_string().starts_with("holes[0]: "));
        let inner = regular([0.0; 2], 0.5, 5);
        assert_eq!(refused(&[good.clone(), inner]), LightFault::HoleOutside { hole: 1, index: 0 });
        // Around all of another, across another, across itself, along a line
        assert_eq!(
            refused(&[good.clone(), regular([0.0; 2], 2.0, 5)]),
            LightFault::HoleOutside { hole: 0, index: 0 }
        );
        let needle = [[-3.0, 0.35], [3.0, 0.3], [3.0, 0.4]].map(|[x, y]| DVec3::new(x, y, 2.0)).to_vec();
        assert_eq!(refused(&[good.clone(), needle]), LightFault::HoleCrosses { hole: 0 });
        let bow_tie =
            [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.5]].map(|[x, y]| DVec3::new(x, y, 2.0)).to_vec();
        assert_eq!(refused(&[bow_tie]), LightFault::HoleCrosses { hole: 0 });
        let line = [0.0, 1.0, 0.5].map(|x| DVec3::new(x, 0.0, 2.0)).to_vec();
        assert_eq!(refused(&[line]), LightFault::HoleNoArea { hole: 0 });
        let message = disk().cut_holes(&[good[..2].to_vec()]).unwrap_err().to_string();
        assert_eq!(message, "holes[0]: 2 vertices given, a hole has at least 3");
    }
}
