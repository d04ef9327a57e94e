//! The manifest in Rust and the embedded SPIR-V say the same: bindings, group sizes, constants, push
//! constants, and every offset of every structure that the CPU writes.

mod reflection;
mod structures;

use arealight::kernels::{self, Access, Kernel};
use arealight::plan::{ShadeOptions, shade_specialization, shade_tiles_specialization};
use arealight::{Effects, LightSummary, TileClass};
use arealight_tool_kernels as tool;
use reflection::{binding_name, bound_variables, literal, module, parsed, reflected};
use rspirv::dr::{Module, Operand};
use rspirv::spirv::{Decoration, ExecutionMode, Op};

/// Compares the manifest of a kernel with its module; the first difference in words.
fn compare(kernel: &Kernel, module: &Module) -> Result<(), String> {
    let bound = bound_variables(module);
    let numbers: Vec<u32> = bound.keys().copied().collect();
    let used = || (0u32..).zip(kernel.bindings).filter(|(_, binding)| binding.access != Access::None);
    if numbers != used().map(|(number, _)| number).collect::<Vec<_>>() {
        return Err(format!("{}: the module binds {numbers:?}", kernel.name));
    }
    for (number, binding) in used() {
        let found = reflected(module, bound[&number]);
        if found != (binding.kind, binding.access) {
            return Err(format!("{}: binding '{}' is {found:?}", kernel.name, binding.name));
        }
        let named = binding_name(module, bound[&number]);
        if named != binding.name {
            return Err(format!("{}: binding '{}' is named '{named}'", kernel.name, binding.name));
        }
    }

    let local_size = module.entry_points.len() == 1
        && module.execution_modes.iter().any(|mode| {
            mode.operands[1] == Operand::ExecutionMode(ExecutionMode::LocalSize)
                && [2, 3, 4].map(|i| literal(&mode.operands[i])) == kernel.local_size
        });
    if !local_size {
        return Err(format!("{}: another local size", kernel.name));
    }

    let mut constants: Vec<u32> = module
        .annotations
        .iter()
        .filter(|i| {
            i.class.opcode == Op::Decorate && i.operands[1] == Operand::Decoration(Decoration::SpecId)
        })
        .map(|i| literal(&i.operands[2]))
        .collect();
    constants.sort_unstable();
    if constants != kernel.constants {
        return Err(format!("{}: the module's constants are {constants:?}", kernel.name));
    }
    Ok(())
}

#[test]
fn the_manifest_agrees_with_every_module() {
    for kernel in kernels::ALL.into_iter().chain(tool::kernels::ALL) {
        compare(kernel, &module(kernel)).unwrap();
    }
}

#[test]
fn the_comparison_can_fail() {
    // One kernel's manifest against another's module
    assert!(compare(&kernels::SHADE, &module(&tool::kernels::EVAL)).is_err());
    // The right module, one binding's kind changed
    let swapped = Kernel {
        bindings: vec![tool::kernels::EVAL.bindings[1]; tool::kernels::EVAL.bindings.len()].leak(),
        ..copy(&tool::kernels::EVAL)
    };
    assert!(compare(&swapped, &module(&tool::kernels::EVAL)).unwrap_err().contains("SampledImage"));
    // A binding that is said not to be used, and one that is not used
    for access in [Access::None, Access::Read] {
        let bindings = kernels::CLASSIFY.bindings.iter().map(|binding| match binding.access {
            Access::Read if access == Access::None && binding.name == "shapes" => binding.unused(),
            Access::None => kernels::Binding { access, ..*binding },
            _ => *binding,
        });
        let changed = Kernel { bindings: bindings.collect::<Vec<_>>().leak(), ..copy(&kernels::CLASSIFY) };
        assert!(compare(&changed, &module(&kernels::CLASSIFY)).unwrap_err().contains("the module binds"));
    }
    // Two bindings of one kind in each other's place: buffers, then images
    for (kernel, one, other) in [(&tool::kernels::EVAL, 1, 2), (&kernels::SHADE, 4, 5)] {
        let mut bindings = kernel.bindings.to_vec();
        bindings.swap(one, other);
        let swapped = Kernel { bindings: Box::leak(bindings.into()), ..copy(kernel) };
        let error = compare(&swapped, &module(kernel)).unwrap_err();
        assert!(error.ends_with(&format!("is named '{}'", kernel.bindings[one].name)), "{error}");
    }
    // Another group size, another constant
    let resized = Kernel { local_size: [32, 1, 1], ..copy(&tool::kernels::EVAL) };
    assert!(compare(&resized, &module(&tool::kernels::EVAL)).unwrap_err().contains("local size"));
    let constants = Kernel { constants: &[0], ..copy(&tool::kernels::EVAL) };
    assert!(compare(&constants, &module(&tool::kernels::EVAL)).unwrap_err().contains("constants"));
}

#[test]
fn a_pruned_module_binds_what_its_frames_use() {
    let options = ShadeOptions {
        surfaces: Effects::all(),
        separate_lobes: true,
        shadow_rays: 1,
        stencil: true,
        ..ShadeOptions::default()
    };
    let lights = LightSummary { quad_count: 1, effects: Effects::all(), ..LightSummary::default() };
    let bound = |specialization: Vec<(u32, u32)>| {
        let pruned = arealight_vk::prune(&kernels::SHADE.words(), &specialization);
        bound_variables(&parsed(&pruned)).into_keys().collect::<Vec<u32>>()
    };
    let of_frames: Vec<u32> = (0..kernels::FRAME_BINDINGS as u32).collect();
    assert_eq!(bound(shade_specialization(options, lights)), of_frames);
    let counted = ShadeOptions { light_counts: true, ..options };
    let of_counted = bound(shade_specialization(counted, lights));
    assert_eq!(of_counted, [of_frames.as_slice(), &[kernels::FRAME_BINDINGS as u32]].concat());
    // Tiles have their lists, too; a frame of quads without shadows has no more than quads need
    let of_tiles = bound(shade_tiles_specialization(options, lights, TileClass::Any));
    assert_eq!(of_tiles, [of_frames.as_slice(), &[kernels::FRAME_BINDINGS as u32 + 1]].concat());
    let quads = LightSummary { effects: Effects::empty(), ..lights };
    assert_eq!(bound(shade_specialization(ShadeOptions::default(), quads)), [0, 1, 2, 3, 4, 5, 7]);
}

fn copy(kernel: &Kernel) -> Kernel {
    Kernel {
        name: kernel.name,
        spirv: kernel.spirv,
        local_size: kernel.local_size,
        push_constant_size: kernel.push_constant_size,
        bindings: kernel.bindings,
        constants: kernel.constants,
    }
}
