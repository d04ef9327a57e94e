//! Triangles to polygons: connected coplanar triangles merge into one simple outline.
//!
//! A flat part grows triangle by triangle from its largest one, and its outline stays a simple loop all the
//! way: a triangle that would close a ring around a hole, or make the loop touch itself, waits, and what
//! still waits at the end starts a polygon of its own. A part without holes always becomes one polygon
//! (planar discs can be shelled from any start). A part with holes becomes one, too, whose outline goes
//! around the holes by bridges; only where its borders touch is it several.
//!
//! Where a texture is shown, the triangles of a part also agree in how it is mapped: at a seam, or where the
//! mapping bends, another part begins.

use crate::borders::{borders, with_holes};
use crate::bounds::Bounds;
use crate::uv_map::{UvMap, UvTolerance};
use crate::weld;
use glam::{DVec2, DVec3, Vec2};
use std::collections::{HashMap, HashSet, VecDeque};

/// How far a vertex may be off the plane of its polygon, or off the straight line it is removed from,
/// relative to the diagonal of all.
const FLAT: f64 = 1e-5;

/// How many triangles of an edge are looked at. Two are enough for back-to-back faces; a file with thousands
/// on one edge must not cost their square.
const SHARED: usize = 4;

/// The polygons that a set of triangles is.
#[derive(Debug, Default)]
pub(crate) struct Outlines {
    /// In the orientation of the triangles; without vertices in the middle of straight edges. One that goes
    /// around holes passes each bridge to them twice.
    pub polygons: Vec<Vec<DVec3>>,
    /// Texture coordinates of the polygons' vertices; empty if none were given.
    pub uvs: Vec<Vec<DVec2>>,
    /// Whether some neighbours are not coplanar.
    pub bent: bool,
    /// Whether some coplanar neighbours differ in how the texture is mapped.
    pub seams: bool,
    /// How many polygons there are beyond one a flat part.
    pub split: usize,
}

/// Texture coordinates that the triangles of a part must agree in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinates<'a> {
    /// As many as positions.
    pub uvs: &'a [Vec2],
    /// How far a vertex's coordinates may be off the map of its part.
    pub tolerance: DVec2,
}

/// Merges triangles. `rounding` is how far positions may be off in any case.
pub(crate) fn outlines(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    rounding: f64,
    coordinates: Option<Coordinates>,
) -> Outlines {
    let size = triangles.iter().flatten().map(|&i| positions[i as usize]).collect::<Bounds>().diagonal();
    let weld = weld::tolerance(size, rounding);
    let mesh = Mesh::new(positions, triangles, weld, coordinates.map(|c| c.uvs));
    let flat = size * FLAT + rounding;
    let tolerance = UvTolerance { uv: coordinates.map_or(DVec2::ZERO, |c| c.tolerance), position: weld };
    let mut outlines = Outlines::default();
    let mut part = vec![usize::MAX; mesh.triangles.len()];
    // Start from large triangles: they know their plane best
    let mut seeds: Vec<usize> = (0..mesh.triangles.len()).collect();
    seeds.sort_by(|a, b| mesh.areas[*b].length().total_cmp(&mesh.areas[*a].length()));
    let mut parts = 0;
    for seed in seeds {
        if part[seed] != usize::MAX {
            continue;
        }
        let plane = Plane::of(&mesh, seed, flat, tolerance);
        let members = mesh.flat_part(seed, &plane, parts, &mut part, &mut outlines);
        parts += 1;
        let before = outlines.polygons.len();
        let polygons = mesh.outline_with_holes(&members, plane.normal, flat).map_or_else(
            || {
                mesh.simple_loops(&members)
                    .iter()
                    .filter_map(|outline| mesh.straightened(outline, flat))
                    .collect()
            },
            |polygon| vec![polygon],
        );
        for polygon in polygons {
            if let Some(map) = &plane.map {
                outlines.uvs.push(polygon.iter().map(|vertex| map.at(*vertex)).collect());
            }
            outlines.polygons.push(polygon);
        }
        outlines.split += (outlines.polygons.len() - before).saturating_sub(1);
    }
    outlines
}

/// What the triangles of a part share.
struct Plane {
    normal: DVec3,
    anchor: DVec3,
    /// How far a corner may be off the plane.
    flat: f64,
    /// How a texture is mapped, if there is one.
    map: Option<UvMap>,
    tolerance: UvTolerance,
}

impl Plane {
    fn of(mesh: &Mesh, triangle: usize, flat: f64, tolerance: UvTolerance) -> Self {
        let corners = mesh.corners(triangle);
        let map = mesh.uvs.get(triangle).map(|uvs| UvMap::new(corners, *uvs));
        let normal = mesh.areas[triangle].normalize_or_zero();
        Self { normal, anchor: corners[0], flat, map, tolerance }
    }

    fn holds(&self, corners: [DVec3; 3]) -> bool {
        corners.iter().all(|p| (*p - self.anchor).dot(self.normal).abs() <= self.flat)
    }

    fn maps(&self, mesh: &Mesh, triangle: usize) -> bool {
        let Some(map) = &self.map else { return true };
        let mut corners = mesh.corners(triangle).into_iter().zip(mesh.uvs[triangle]);
        corners.all(|(position, uv)| map.agrees(position, uv, self.tolerance))
    }
}

/// Triangles whose vertices are shared where they are at the same place.
#[derive(Default)]
struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Area times normal of each triangle.
    areas: Vec<DVec3>,
    /// Texture coordinates of each triangle's corners; empty if there are none.
    uvs: Vec<[DVec2; 3]>,
    /// The triangles on the left of a directed edge, at most [`SHARED`].
    by_edge: HashMap<(u32, u32), Vec<usize>>,
}

/// The directed edges of a triangle, each with the corner opposite to it.
fn edges([a, b, c]: [u32; 3]) -> [(u32, u32, u32); 3] {
    [(a, b, c), (b, c, a), (c, a, b)]
}

impl Mesh {
    fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        tolerance: f64,
        coordinates: Option<&[Vec2]>,
    ) -> Self {
        let (positions, index) = weld::weld(positions, triangles, tolerance);
        let mut mesh = Self { positions, ..Self::default() };
        let mut known = HashSet::new();
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| index[&i]);
            let [p, q, r] = [a, b, c].map(|i| mesh.positions[i as usize]);
            let area = (q - p).cross(r - p) * 0.5;
            // Leave out slivers that are as thin as the tolerance, and copies
            let longest = p.distance(q).max(q.distance(r)).max(r.distance(p));
            let copy = !known.insert([[a, b, c], [b, c, a], [c, a, b]].into_iter().min());
            if a == b || b == c || c == a || area.length() * 2.0 <= longest * tolerance || copy {
                continue;
            }
            for (from, to, _) in edges([a, b, c]) {
                let sharing = mesh.by_edge.entry((from, to)).or_default();
                if sharing.len() < SHARED {
                    sharing.push(mesh.triangles.len());
                }
            }
            mesh.triangles.push([a, b, c]);
            mesh.areas.push(area);
            mesh.uvs.extend(coordinates.map(|uvs| triangle.map(|i| uvs[i as usize].as_dvec2())));
        }
        mesh
    }

    /// Triangles across the edges of one.
    fn neighbors(&self, triangle: usize) -> impl Iterator<Item = usize> + '_ {
        edges(self.triangles[triangle])
            .into_iter()
            .filter_map(|(from, to, _)| self.by_edge.get(&(to, from)))
            .flatten()
            .copied()
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// The triangles that are connected to `seed`, in its plane, and mapped as it is; they are marked with
    /// `number`.
    fn flat_part(
        &self,
        seed: usize,
        plane: &Plane,
        number: usize,
        part: &mut [usize],
        found: &mut Outlines,
    ) -> Vec<usize> {
        let mut members = vec![seed];
        part[seed] = number;
        let mut next = 0;
        while next < members.len() {
            for neighbor in self.neighbors(members[next]) {
                if !plane.holds(self.corners(neighbor)) {
                    found.bent = true;
                } else if part[neighbor] == number || self.areas[neighbor].dot(plane.normal) <= 0.0 {
                    // A member already, or the back of one
                } else if !plane.maps(self, neighbor) {
                    found.seams = true;
                } else if part[neighbor] == usize::MAX {
                    part[neighbor] = number;
                    members.push(neighbor);
                }
            }
            next += 1;
        }
        members
    }

    /// The outline around `members`, a connected flat part, and around its holes. None if it has no holes, or
    /// its borders touch.
    fn outline_with_holes(&self, members: &[usize], normal: DVec3, flat: f64) -> Option<Vec<DVec3>> {
        let loops = borders(members.iter().map(|&member| self.triangles[member]))?;
        if loops.len() < 2 {
            return None;
        }
        let loops: Option<Vec<_>> = loops.iter().map(|outline| self.straightened(outline, flat)).collect();
        with_holes(loops?, normal)
    }

    /// The outline's positions, see [`straightened`].
    fn straightened(&self, outline: &[u32], tolerance: f64) -> Option<Vec<DVec3>> {
        let outline: Vec<DVec3> = outline.iter().map(|&i| self.positions[i as usize]).collect();
        straightened(&outline, tolerance)
    }

    /// Simple outlines that cover `members`, a connected flat part, once.
    fn simple_loops(&self, members: &[usize]) -> Vec<Vec<u32>> {
        let mut waiting: HashSet<usize> = members.iter().copied().collect();
        let mut loops = Vec::new();
        for &start in members {
            if !waiting.remove(&start) {
                continue;
            }
            let mut outline = Loop::around(self.triangles[start]);
            let mut queue: VecDeque<usize> = self.neighbors(start).collect();
            while let Some(triangle) = queue.pop_front() {
                // A triangle that waits gets another chance when a neighbour has been added
                if waiting.contains(&triangle) && outline.add(self.triangles[triangle]) {
                    waiting.remove(&triangle);
                    queue.extend(self.neighbors(triangle));
                }
            }
            loops.push(outline.vertices());
        }
        loops
    }
}

/// A simple closed loop of vertices, counter-clockwise around what it holds.
struct Loop {
    start: u32,
    next: HashMap<u32, u32>,
}

impl Loop {
    fn around(triangle: [u32; 3]) -> Self {
        Self { start: triangle[0], next: edges(triangle).map(|(from, to, _)| (from, to)).into() }
    }

    /// Grows by a triangle outside; false if the loop would not stay simple.
    fn add(&mut self, triangle: [u32; 3]) -> bool {
        let is_shared = |(from, to, _): &(u32, u32, u32)| self.next.get(to) == Some(from);
        let shared: Vec<(u32, u32, u32)> = edges(triangle).into_iter().filter(is_shared).collect();
        match shared[..] {
            // One edge: go around by the opposite corner, which must be new
            [(from, to, opposite)] if !self.next.contains_key(&opposite) => {
                self.next.insert(to, opposite);
                self.next.insert(opposite, from);
                true
            }
            // Two edges: take the short cut past the corner between them
            [one, other] => {
                let consecutive = one.1 == other.0;
                let (first, second) = if consecutive { (one, other) } else { (other, one) };
                let (from, middle, to) = (second.1, first.1, first.0);
                self.next.remove(&middle);
                self.next.insert(from, to);
                self.start = from;
                true
            }
            _ => false,
        }
    }

    fn vertices(&self) -> Vec<u32> {
        let mut vertices = vec![self.start];
        let mut at = self.next[&self.start];
        while at != self.start {
            vertices.push(at);
            at = self.next[&at];
        }
        vertices
    }
}

/// The outline without the vertices that lie on straight edges, to `tolerance`; none if nothing is left.
///
/// From each kept vertex the edge reaches as far as one direction passes within the tolerance of every vertex
/// on the way.
fn straightened(outline: &[DVec3], tolerance: f64) -> Option<Vec<DVec3>> {
    let count = outline.len();
    let center = outline.iter().sum::<DVec3>() / count as f64;
    let pairs = outline.iter().zip(outline.iter().cycle().skip(1));
    let area: DVec3 = pairs.map(|(a, b)| (*a - center).cross(*b - center)).sum::<DVec3>() * 0.5;
    let (tangent, bitangent) = area.try_normalize()?.any_orthonormal_pair();
    let flat: Vec<DVec2> = outline
        .iter()
        .map(|p| DVec2::new((*p - center).dot(tangent), (*p - center).dot(bitangent)))
        .collect();
    // The vertex farthest from the middle is a corner
    let first = (0..count).max_by(|a, b| flat[*a].length().total_cmp(&flat[*b].length()))?;
    let at = |i: usize| (first + i) % count;
    let mut kept = vec![outline[first]];
    let mut start = 0;
    while start < count {
        let end = start + straight_run(count - start, |i| flat[at(start + i)], tolerance);
        if end < count {
            kept.push(outline[at(end)]);
        }
        start = end;
    }
    (kept.len() >= 3).then_some(kept)
}

/// How far, up to `limit`, a straight edge from point 0 reaches: each point on the way is within `tolerance`
/// of it, and each is farther from point 0 than the one before.
fn straight_run(limit: usize, point: impl Fn(usize) -> DVec2, tolerance: f64) -> usize {
    let origin = point(0);
    let axis = point(1) - origin;
    let mut reach = 1;
    // The slopes, against the first step, of lines that pass every point so far
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let coordinates = |i: usize| {
        let offset = point(i) - origin;
        (offset.dot(axis), axis.perp_dot(offset))
    };
    let mut along_before = 0.0;
    for i in 1..limit {
        let (along, across) = coordinates(i);
        if along <= along_before {
            break;
        }
        let margin = tolerance * axis.length();
        low = low.max((across - margin) / along);
        high = high.min((across + margin) / along);
        let (next_along, next_across) = coordinates(i + 1);
        let slope = next_across / next_along;
        if !(next_along > along && slope >= low && slope <= high) {
            break;
        }
        along_before = along;
        reach = i + 1;
    }
    reach
}

#[cfg(test)]
#[path = "outlines_tests.rs"]
mod tests;
