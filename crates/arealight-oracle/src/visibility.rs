//! What is visible of a flat light behind triangles, exactly: by set difference, without a ray.
//!
//! Positions are relative to the shading point, which is the origin, in any rotation of space.

use glam::DVec3;

/// A triangle that blocks light from both sides.
pub type Blocker = [DVec3; 3];

/// The convex parts of a convex, flat polygon that are visible from the origin past `blockers`, in the
/// polygon's order. They don't overlap. None where all is hidden, or where the origin lies in the polygon's
/// plane.
///
/// A blocker hides what lies behind it as seen from the origin; the part of it behind the polygon's plane
/// hides nothing, and neither does one that is seen edge-on. Error: that of float64, 1e-15 of the distances;
/// parts smaller than that may remain where blockers touch.
pub fn visible_parts(polygon: &[DVec3], blockers: &[Blocker]) -> Vec<Vec<DVec3>> {
    let Some(plane) = Plane::of_light(polygon) else { return Vec::new() };
    let mut visible = vec![polygon.to_vec()];
    for blocker in blockers {
        // What is on the origin's side of the light's plane casts a shadow: a cone of planes through the
        // origin
        let before = clip(blocker, |vertex| plane.normal.dot(*vertex) - plane.distance);
        let cone = cone_through(&before);
        if cone.is_empty() {
            continue;
        }
        visible = visible.into_iter().flat_map(|part| outside(part, &cone)).collect();
    }
    visible
}

/// A light's plane: `normal · x = distance`, the origin on the side where that is more.
struct Plane {
    normal: DVec3,
    distance: f64,
}

impl Plane {
    /// `None` where the polygon has no area, or the origin lies in its plane.
    fn of_light(polygon: &[DVec3]) -> Option<Self> {
        let first = *polygon.first()?;
        let next = |i: usize| polygon[(i + 1) % polygon.len()];
        let area: DVec3 =
            polygon.iter().enumerate().map(|(i, vertex)| (*vertex - first).cross(next(i) - first)).sum();
        let normal = area.try_normalize()?;
        let distance = normal.dot(first);
        let (normal, distance) = if distance > 0.0 { (-normal, -distance) } else { (normal, distance) };
        (distance < 0.0).then_some(Self { normal, distance })
    }
}

/// The planes through the origin and the edges of a convex polygon, their normals to the inside; none where
/// the origin lies in its plane.
fn cone_through(polygon: &[DVec3]) -> Vec<DVec3> {
    let middle: DVec3 = polygon.iter().sum();
    let mut cone = Vec::with_capacity(polygon.len());
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let Some(normal) = a.cross(b - *a).try_normalize() else { continue };
        let inside = normal.dot(middle);
        if inside.abs() <= 1e-15 * middle.length() {
            return Vec::new();
        }
        cone.push(normal * inside.signum());
    }
    if cone.len() < 3 { Vec::new() } else { cone }
}

/// The parts of a convex polygon outside of a cone.
fn outside(polygon: Vec<DVec3>, cone: &[DVec3]) -> Vec<Vec<DVec3>> {
    let (mut parts, mut rest) = (Vec::new(), polygon);
    for normal in cone {
        let part = clip(&rest, |vertex| -normal.dot(*vertex));
        if part.len() >= 3 {
            parts.push(part);
        }
        rest = clip(&rest, |vertex| normal.dot(*vertex));
        if rest.len() < 3 {
            break;
        }
    }
    parts
}

/// The part of a convex polygon where `height` is not negative; empty where it is nowhere positive.
fn clip(polygon: &[DVec3], height: impl Fn(&DVec3) -> f64) -> Vec<DVec3> {
    let heights: Vec<f64> = polygon.iter().map(height).collect();
    if !heights.iter().any(|height| *height > 0.0) {
        return Vec::new();
    }
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let j = (i + 1) % polygon.len();
        let (from, to) = (heights[i], heights[j]);
        if from >= 0.0 {
            left.push(*a);
        }
        if (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0) {
            left.push(a.lerp(polygon[j], from / (from - to)));
        }
    }
    left
}

/// Whether a blocker hides `target` from the origin (Möller and Trumbore 1997).
pub fn is_hidden(target: DVec3, blockers: &[Blocker]) -> bool {
    blockers.iter().any(|[a, b, c]| {
        let (u, v) = (*b - *a, *c - *a);
        let p = target.cross(v);
        let determinant = u.dot(p);
        if determinant == 0.0 {
            return false;
        }
        let s = -*a;
        let q = s.cross(u);
        let (x, y, t) = (s.dot(p) / determinant, target.dot(q) / determinant, v.dot(q) / determinant);
        x >= 0.0 && y >= 0.0 && x + y <= 1.0 && t > 0.0 && t < 1.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::form_factor;
    use crate::stream::Stream;

    fn triangle(stream: &mut Stream, distance: f64, size: f64) -> Blocker {
        let center = DVec3::Z * distance + stream.direction() * 0.5 * distance;
        [0, 1, 2].map(|_| center + stream.direction() * size)
    }

    fn quad() -> Vec<DVec3> {
        [[-1.0, -0.7], [-1.0, 0.7], [1.0, 0.7], [1.0, -0.7]]
            .map(|[x, y]| DVec3::new(x, y, 2.0 + 0.3 * x))
            .to_vec()
    }

    fn area(polygon: &[DVec3]) -> f64 {
        let sum: DVec3 = (1..polygon.len() - 1)
            .map(|i| (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]))
            .sum();
        sum.length() / 2.0
    }

    #[test]
    fn the_visible_area_is_that_of_rays() {
        const ROOT: usize = 200;
        let mut stream = Stream::new("visible parts", 0, 1);
        let (quad, mut differ) = (quad(), 0);
        for index in 0..60 {
            // Before the light, and some of them through its plane or behind it
            let distance = if index % 4 == 3 { 2.2 } else { 1.0 };
            let blockers: Vec<Blocker> =
                (0..=index % 5).map(|_| triangle(&mut stream, distance, 0.6)).collect();
            let parts = visible_parts(&quad, &blockers);
            let share = parts.iter().map(|part| area(part)).sum::<f64>() / area(&quad);
            let mut visible = 0;
            for i in 0..ROOT * ROOT {
                let at = |n: usize| (n as f64 + 0.5) / ROOT as f64;
                let point = quad[0] + (quad[1] - quad[0]) * at(i % ROOT) + (quad[3] - quad[0]) * at(i / ROOT);
                visible += usize::from(!is_hidden(point, &blockers));
            }
            let rays = visible as f64 / (ROOT * ROOT) as f64;
            // Each edge of a shadow crosses up to 2 x 200 cells of 40,000, of which half may be off either
            // way
            assert!((share - rays).abs() < 2e-3 * (blockers.len() as f64).sqrt(), "{index}: {share}, {rays}");
            differ += usize::from(rays > 0.02 && rays < 0.98);
        }
        assert!(differ > 30, "most are partly hidden: {differ}");
    }

    #[test]
    fn parts_that_nothing_hides_add_up_to_the_light() {
        let quad = quad();
        // A blocker that covers the light hides all, one behind or beside nothing; two halves hide what one
        // does
        let big = [DVec3::new(-9.0, -9.0, 1.0), DVec3::new(9.0, -9.0, 1.0), DVec3::new(0.0, 9.0, 1.0)];
        assert!(visible_parts(&quad, &[big]).is_empty());
        let behind = big.map(|vertex| vertex * 5.0);
        assert_eq!(visible_parts(&quad, &[behind]), vec![quad.clone()]);
        let half = [DVec3::new(0.0, -9.0, 1.0), DVec3::new(0.0, 9.0, 1.0), DVec3::new(9.0, 0.0, 1.0)];
        let sum = |parts: &[Vec<DVec3>]| parts.iter().map(|part| form_factor(part)).sum::<f64>();
        let other = half.map(|vertex| vertex * DVec3::new(-1.0, 1.0, 1.0));
        let [left, right] = [half, other].map(|half| sum(&visible_parts(&quad, &[half])));
        assert!((left + right - form_factor(&quad)).abs() < 1e-15, "{left} {right}");
        // The twin: they are not the same half
        assert!((left - right).abs() > 1e-3);
    }

    #[test]
    fn a_light_in_the_plane_of_the_point_has_no_parts() {
        let flat = [[0.0, 1.0], [1.0, 1.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert!(visible_parts(&flat, &[]).is_empty());
        assert!(visible_parts(&[], &[]).is_empty());
    }
}
