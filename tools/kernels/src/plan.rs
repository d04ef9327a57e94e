//! How these kernels are specialised and dispatched.

use crate::kernels::{EVAL, EVAL_SHAPES};
use arealight::kernels::{Kernel, constant};
use arealight::plan::{Dispatch, ShadeOptions, shade_specialization};
use arealight::{Effects, Quality, ShapeKind};

/// The eval pass: the shade kernel's functions over a list of `case_count` shading points.
pub fn eval(effects: Effects, quality: Quality, case_count: u32) -> Dispatch {
    let specialization = specialization(&EVAL, effects, quality);
    Dispatch { kernel: &EVAL, specialization, groups: EVAL.groups_for([case_count, 1, 1]) }
}

/// As [`eval`], of shapes that are all of one kind, or of [`ShapeKind::Any`].
pub fn eval_shapes(effects: Effects, quality: Quality, kind: ShapeKind, case_count: u32) -> Dispatch {
    let mut specialization = specialization(&EVAL_SHAPES, effects, quality);
    specialization.push((constant::SHAPE, kind as u32));
    Dispatch { kernel: &EVAL_SHAPES, specialization, groups: EVAL_SHAPES.groups_for([case_count, 1, 1]) }
}

/// The shade kernel's constants, of those that `kernel` has.
fn specialization(kernel: &Kernel, effects: Effects, quality: Quality) -> Vec<(u32, u32)> {
    let mut values = shade_specialization(ShadeOptions { effects, quality, ..ShadeOptions::all() });
    values.retain(|(id, _)| kernel.constants.contains(id));
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_constant_of_a_kernel_has_a_value() {
        let ids = |dispatch: &Dispatch| {
            let mut ids: Vec<u32> = dispatch.specialization.iter().map(|(id, _)| *id).collect();
            ids.sort_unstable();
            ids
        };
        let points = eval(Effects::all(), Quality::default(), 65);
        assert_eq!((points.groups, ids(&points)), ([2, 1, 1], EVAL.constants.to_vec()));
        let shapes = eval_shapes(Effects::all(), Quality::default(), ShapeKind::Any, 64);
        assert_eq!((shapes.groups, ids(&shapes)), ([1, 1, 1], EVAL_SHAPES.constants.to_vec()));
    }
}
