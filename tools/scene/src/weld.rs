//! Vertices in one place.

use glam::{DVec3, I64Vec3};
use std::collections::HashMap;

/// How far vertices may be apart to be one, relative to the diagonal of all: below what is visible, above the
/// rounding of transforms.
const WELD: f64 = 1e-6;

/// How far vertices may be apart to be one: `size` is the diagonal of all, `rounding` how far positions may
/// be off in any case.
pub(crate) fn tolerance(size: f64, rounding: f64) -> f64 {
    size * WELD + rounding
}

/// Gives vertices within `tolerance` of each other one index: new positions, and the new index of each used
/// old one.
pub(crate) fn weld(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    tolerance: f64,
) -> (Vec<DVec3>, HashMap<u32, u32>) {
    let anchor = triangles.first().map_or(DVec3::ZERO, |t| positions[t[0] as usize]);
    let cell = |p: DVec3| ((p - anchor) / tolerance.max(f64::MIN_POSITIVE)).floor().as_i64vec3();
    let mut cells: HashMap<I64Vec3, Vec<u32>> = HashMap::new();
    let mut welded: Vec<DVec3> = Vec::new();
    let mut index = HashMap::new();
    for &old in triangles.iter().flatten() {
        if index.contains_key(&old) {
            continue;
        }
        let position = positions[old as usize];
        let home = cell(position);
        // Look in the cells around for a vertex that is near enough
        let around = (0..27).map(|i| home.wrapping_add(I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
        let near = around
            .filter_map(|cell| cells.get(&cell))
            .flatten()
            .find(|&&i| welded[i as usize].distance(position) <= tolerance)
            .copied();
        let new = near.unwrap_or_else(|| {
            welded.push(position);
            let new = (welded.len() - 1) as u32;
            cells.entry(home).or_default().push(new);
            new
        });
        index.insert(old, new);
    }
    (welded, index)
}
