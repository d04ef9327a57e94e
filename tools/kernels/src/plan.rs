//! How these kernels are specialised and dispatched.

use crate::kernels::{EVAL, EVAL_MEDIUM, EVAL_SHAPES};
use arealight::kernels::{Kernel, constant};
use arealight::plan::{ShadeOptions, shade_specialization};
use arealight::{Effects, LightSummary, Quality};

/// One dispatch: a kernel, the values of its specialisation constants, and its number of groups.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispatch {
    /// The kernel.
    pub kernel: &'static Kernel,
    /// Pairs of constant id and value.
    pub specialization: Vec<(u32, u32)>,
    /// Groups in x, y and z.
    pub groups: [u32; 3],
}

/// The eval pass: the shade kernel's functions over a list of `case_count` shading points.
pub fn eval(effects: Effects, quality: Quality, case_count: u32) -> Dispatch {
    let specialization = specialization(&EVAL, effects, quality);
    Dispatch { kernel: &EVAL, specialization, groups: EVAL.groups_for([case_count, 1, 1]) }
}

/// As [`eval`], of disks, spheres or tubes: all of one kind of [`arealight::gpu::GpuShape`], or of any.
pub fn eval_shapes(effects: Effects, quality: Quality, kind: u32, case_count: u32) -> Dispatch {
    let mut specialization = specialization(&EVAL_SHAPES, effects, quality);
    specialization.push((constant::SHAPE, kind));
    Dispatch { kernel: &EVAL_SHAPES, specialization, groups: EVAL_SHAPES.groups_for([case_count, 1, 1]) }
}

/// As [`eval`], of points in a medium: under polygons and meshes, or under shapes where `effects` have any.
pub fn eval_medium(effects: Effects, quality: Quality, case_count: u32) -> Dispatch {
    let specialization = specialization(&EVAL_MEDIUM, effects, quality);
    Dispatch { kernel: &EVAL_MEDIUM, specialization, groups: EVAL_MEDIUM.groups_for([case_count, 1, 1]) }
}

/// The shade kernel's constants, of those that `kernel` has.
fn specialization(kernel: &Kernel, effects: Effects, quality: Quality) -> Vec<(u32, u32)> {
    let options = ShadeOptions { surfaces: effects, quality, ..ShadeOptions::default() };
    let lights = LightSummary { effects, ..LightSummary::default() };
    let mut values = shade_specialization(options, lights);
    values.retain(|(id, _)| kernel.constants().contains(id));
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::gpu::GpuShape;

    #[test]
    fn every_constant_of_a_kernel_has_a_value() {
        let ids = |dispatch: &Dispatch| {
            let mut ids: Vec<u32> = dispatch.specialization.iter().map(|(id, _)| *id).collect();
            ids.sort_unstable();
            ids
        };
        let points = eval(Effects::all(), Quality::default(), 65);
        assert_eq!((points.groups, ids(&points)), ([2, 1, 1], EVAL.constants().to_vec()));
        let shapes = eval_shapes(Effects::all(), Quality::default(), GpuShape::ANY, 64);
        assert_eq!((shapes.groups, ids(&shapes)), ([1, 1, 1], EVAL_SHAPES.constants().to_vec()));
        let medium = eval_medium(Effects::all(), Quality::default(), 1);
        assert_eq!((medium.groups, ids(&medium)), ([1, 1, 1], EVAL_MEDIUM.constants().to_vec()));
    }
}
