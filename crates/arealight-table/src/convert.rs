//! Tables from tables: of another size, of another precision.

use arealight::table::LobePairs;
use arealight::{LightTable, TableDescription, TableError};
use half::f16;

use crate::Precision;

/// A table of another number of nodes, interpolated bilinearly, as shading does. Its description says so.
///
/// A new node that coincides with an old one keeps its numbers (64 nodes hold those of 22, 10, 8, 4 and 2);
/// the others lie on chords between the old ones. A table that is fitted with the number of nodes asked for
/// is better, at 16 nodes by 1 % of its error.
///
/// # Errors
/// [`TableError::Size`] if no table has `size`; [`TableError::Singular`] if lobes of opposite tilt
/// cancel.
pub fn resampled(table: &LightTable, size: u32) -> Result<LightTable, TableError> {
    if table.size() == size {
        return Ok(table.clone());
    }
    if !(2..=arealight::table::MAX_SIZE).contains(&size) {
        return Err(TableError::Size { size });
    }
    let description = TableDescription {
        brdf: table.description().brdf.clone(),
        made_by: format!("{}, resampled from {} nodes", table.description().made_by, table.size()),
        ggx_dip: table.description().ggx_dip,
    };
    let old = table.size();
    mapped(
        table,
        description,
        size,
        |texels| resampled_layer(texels, old, size),
        |texels| resampled_layer(texels, old, size),
    )
}

/// A table whose layers are made of another's: of four numbers a texel, and of two.
fn mapped(
    table: &LightTable,
    description: TableDescription,
    size: u32,
    matrix: impl Fn(&[[f32; 4]]) -> Vec<[f32; 4]>,
    magnitude: impl Fn(&[[f32; 2]]) -> Vec<[f32; 2]>,
) -> Result<LightTable, TableError> {
    let mut made = LightTable::new(description, size, matrix(table.matrix()), magnitude(table.magnitude()))?;
    if let Some(texels) = table.schlick_matrix() {
        made = made.with_schlick_matrix(matrix(texels))?;
    }
    if let Some(pairs) = table.pairs() {
        made = made.with_pairs(LobePairs {
            matrices: [matrix(&pairs.matrices[0]), matrix(&pairs.matrices[1])],
            second_shares: magnitude(&pairs.second_shares),
        })?;
    }
    Ok(made)
}

fn resampled_layer<const N: usize>(texels: &[[f32; N]], old: u32, new: u32) -> Vec<[f32; N]> {
    // The old node below a new one, and the way to the next, by integers so that nodes that coincide do so
    // exactly
    let place = |i: u32| {
        let position = u64::from(i) * u64::from(old - 1);
        let node = (position / u64::from(new - 1)).min(u64::from(old - 2));
        (node as usize, (position - node * u64::from(new - 1)) as f32 / (new - 1) as f32)
    };
    let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
    let mut result = Vec::with_capacity(new as usize * new as usize);
    for (y, t) in (0..new).map(place) {
        for (x, s) in (0..new).map(place) {
            let at = |dx: usize, dy: usize| texels[(y + dy) * old as usize + x + dx];
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            result.push(std::array::from_fn(|i| mix(mix(a[i], b[i], s), mix(c[i], d[i], s), t)));
        }
    }
    result
}

/// A table whose numbers are rounded to a precision.
///
/// # Errors
/// [`TableError`] if a number is too large for 16 bits (above 65504) or a matrix becomes singular.
pub fn rounded(table: &LightTable, precision: Precision) -> Result<LightTable, TableError> {
    if precision == Precision::Single {
        return Ok(table.clone());
    }
    let description = table.description().clone();
    mapped(
        table,
        description,
        table.size(),
        |texels| texels.iter().copied().map(to_half).collect(),
        |texels| texels.iter().copied().map(to_half).collect(),
    )
}

fn to_half<const N: usize>(texel: [f32; N]) -> [f32; N] {
    texel.map(|number| f16::from_f32(number).to_f32())
}
