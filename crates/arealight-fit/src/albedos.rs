//! Albedos of a table at grazing views: changed at the nodes so that interpolation between them has the least
//! error.

use arealight::{MIN_ALPHA, TableDescription};
use glam::{DMat3, DVec3};

use crate::brdf::{Brdf, Magnitude};

/// Rows of nodes that are balanced: the last ones, beyond which interpolation has an error of less than 5e-4.
pub(crate) const ROWS: usize = 3;

/// Views of a cell that count.
const VIEWS: usize = 24;

/// And more in the last cell, of 89.94, 89.98 and 89.997 degrees with 64 nodes.
const NEAR_HORIZON: [f64; 3] = [0.97, 0.99, 0.998];

/// Iterations of Lawson's method: more change the largest error by less than a hundredth.
const ITERATIONS: usize = 30;

/// The albedos, with the description's dip filled, of the last [`ROWS`] nodes of a column, from `column`,
/// those of all of its nodes: the largest error between them is the least. `None` for a table that has no
/// more rows.
pub(crate) fn balanced(
    brdf: &dyn Brdf,
    description: &TableDescription,
    roughness: f64,
    column: &[[f64; 2]],
) -> Option<[[f64; 2]; ROWS]> {
    let first = column.len().checked_sub(ROWS + 2)?;
    let cells = (column.len() - 1) as f64;
    let alpha = (roughness * roughness).max(MIN_ALPHA);
    // At views in the last cells, the error of the nodes as they are, and the part of each balanced node in
    // it
    let places = (0..ROWS * VIEWS).map(|view| (view as f64 + 0.75) / VIEWS as f64);
    let views = places.chain(NEAR_HORIZON.map(|part| (ROWS - 1) as f64 + part)).map(|place| {
        let (row, part) = (place.floor() as usize, place.fract());
        let sqrt = ((first + 1 + row) as f64 + part) / cells;
        let cos_view = 1.0 - sqrt * sqrt;
        let Magnitude { albedo, schlick } = brdf.magnitude(alpha, cos_view);
        let dip = description.dip(roughness, cos_view);
        let [before, after] = [column[first + 1 + row], column[first + 2 + row]];
        let error = |i: usize, truth: f64| before[i] + (after[i] - before[i]) * part - dip[i] - truth;
        let mut nodes = [0.0; ROWS + 1];
        [nodes[row], nodes[row + 1]] = [1.0 - part, part];
        ([error(0, albedo), error(1, schlick)], DVec3::from_slice(&nodes[1..]))
    });
    let views: Vec<([f64; 2], DVec3)> = views.collect();
    let steps = [0, 1].map(|i| {
        let errors: Vec<(f64, DVec3)> = views.iter().map(|(error, nodes)| (error[i], *nodes)).collect();
        least_largest(&errors).to_array()
    });
    Some(std::array::from_fn(|row| {
        let node = column[first + 2 + row];
        [node[0] + steps[0][row], node[1] + steps[1][row]]
    }))
}

/// The `x` for which the largest of `|error + nodes . x|` is the least. Source: Lawson 1961, *Contributions
/// to the Theory of Linear Least Maximum Approximation*: least squares, weighted by the errors that are left.
fn least_largest(errors: &[(f64, DVec3)]) -> DVec3 {
    let mut weights = vec![1.0 / errors.len() as f64; errors.len()];
    let mut best = (f64::INFINITY, DVec3::ZERO);
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (DMat3::from_diagonal(DVec3::splat(1e-9)), DVec3::ZERO);
        for ((error, nodes), weight) in errors.iter().zip(&weights) {
            let column = *nodes * *weight;
            normal += DMat3::from_cols(column * nodes.x, column * nodes.y, column * nodes.z);
            right -= column * *error;
        }
        let x = normal.inverse() * right;
        let left: Vec<f64> = errors.iter().map(|(error, nodes)| (error + nodes.dot(x)).abs()).collect();
        let largest = left.iter().copied().fold(0.0, f64::max);
        if largest < best.0 {
            best = (largest, x);
        }
        let sum: f64 = weights.iter().zip(&left).map(|(weight, left)| weight * left).sum();
        if sum <= 0.0 {
            break;
        }
        for (weight, left) in weights.iter_mut().zip(&left) {
            *weight *= left / sum;
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GgxBrdf;
    use arealight::LightTable;

    #[test]
    fn the_least_largest_error_alternates() {
        // A parabola by a line: the Chebyshev polynomial is left, 1/8 at both ends and in the middle
        let errors: Vec<(f64, DVec3)> =
            (0..=100).map(|i| f64::from(i) / 100.0).map(|t| (t * t, DVec3::new(1.0, t, 0.0))).collect();
        let x = least_largest(&errors);
        let largest = errors.iter().map(|(error, nodes)| (error + nodes.dot(x)).abs()).fold(0.0, f64::max);
        assert!((largest - 0.125).abs() < 1e-3, "{largest}");
    }

    #[test]
    fn what_is_interpolated_errs_less_than_by_the_truth_at_each_node() {
        let (size, roughness) = (32, 0.5);
        let description = TableDescription { ggx_dip: true, ..TableDescription::default() };
        let with_dip = |cos_view: f64| {
            let Magnitude { albedo, schlick } = GgxBrdf.magnitude(roughness * roughness, cos_view);
            let dip = description.dip(roughness, cos_view);
            [albedo + dip[0], schlick + dip[1]]
        };
        let nodes: Vec<[f64; 2]> = (0..size).map(|row| with_dip(LightTable::node(size, 0, row).1)).collect();
        let mut balanced_nodes = nodes.clone();
        let last = balanced(&GgxBrdf, &description, roughness, &nodes).unwrap();
        balanced_nodes[size as usize - ROWS..].copy_from_slice(&last);
        let largest = |nodes: &[[f64; 2]], i: usize| {
            let error = |step: u32| {
                let place = f64::from(size - 1) - f64::from(step) / 10.0;
                let row = (place as usize).min(size as usize - 2);
                let part = place - row as f64;
                let y = place / f64::from(size - 1);
                let found = nodes[row][i] + (nodes[row + 1][i] - nodes[row][i]) * part;
                (found - with_dip(1.0 - y * y)[i]).abs()
            };
            (0..30).map(error).fold(0.0, f64::max)
        };
        for i in 0..2 {
            let (before, after) = (largest(&nodes, i), largest(&balanced_nodes, i));
            assert!(after < 0.85 * before, "{i}: {after} after {before}");
        }
    }
}
