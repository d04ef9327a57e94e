//! Flat parts of meshes that have holes: their borders, and one outline around all of them.

use arealight::{Light, LightShape};
use glam::DVec3;
use std::collections::HashMap;

/// The closed loops along which a set of triangles ends, each with the triangles on its left. None where a
/// loop touches another or itself.
pub(crate) fn borders(triangles: impl Iterator<Item = [u32; 3]>) -> Option<Vec<Vec<u32>>> {
    let edges: Vec<[u32; 2]> = triangles.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let known: std::collections::HashSet<[u32; 2]> = edges.iter().copied().collect();
    let mut next = HashMap::new();
    for &[from, to] in edges.iter().filter(|[from, to]| !known.contains(&[*to, *from])) {
        if next.insert(from, to).is_some() {
            return None;
        }
    }
    let mut loops = Vec::new();
    // In the order of the triangles, so that a file always becomes the same lights
    for [start, _] in edges {
        let mut outline = Vec::new();
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            outline.push(at);
            at = to;
        }
        if !outline.is_empty() {
            loops.push(outline);
        }
    }
    Some(loops)
}

/// One outline around what several loops border, of which one goes around counter-clockwise as seen from the
/// side that `normal` points to, and the others are holes. None where that is not so.
pub(crate) fn with_holes(loops: Vec<Vec<DVec3>>, normal: DVec3) -> Option<Vec<DVec3>> {
    let shapes = loops.into_iter().map(LightShape::Polygon);
    let (mut outlines, holes): (Vec<_>, Vec<_>) =
        shapes.partition(|shape| shape.area_vector().dot(normal) > 0.0);
    let mut light = Light { shape: outlines.pop()?, ..Light::default() };
    let holes: Vec<_> = holes.iter().map(|shape| shape.vertices().to_vec()).collect();
    light.cut_holes(&holes).ok()?;
    outlines.is_empty().then(|| light.shape.vertices().to_vec())
}
