//! The manifest in Rust and the embedded SPIR-V say the same: bindings, group sizes, constants, push constants,
//! and every offset of every structure that the CPU writes.

use arealight::gpu;
use arealight::kernels::{self, Access, BindingKind, Kernel};
use arealight::plan::{ShadeOptions, shade_specialization, shade_tiles_specialization};
use arealight::pyramid::MOST_TAPS;
use arealight::{Effects, LightSummary, TileClass};
use arealight_tests::kernel::BLOCKERS;
use arealight_tool_kernels as tool;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, ExecutionMode, Op, StorageClass};
use std::collections::BTreeMap;
use std::mem::offset_of;

fn module(kernel: &Kernel) -> Module {
    parsed(&kernel.words())
}

fn parsed(words: &[u32]) -> Module {
    let mut loader = rspirv::dr::Loader::new();
    rspirv::binary::parse_words(words, &mut loader).expect("the module parses");
    loader.module()
}

fn literal(operand: &Operand) -> u32 {
    match operand {
        Operand::LiteralBit32(value) | Operand::IdRef(value) => *value,
        other => panic!("{other:?} is no 32-bit literal"),
    }
}

/// The operands of a decoration of `id`, if it has it.
fn decoration(module: &Module, id: u32, wanted: Decoration) -> Option<Vec<Operand>> {
    module.annotations.iter().find_map(|i| {
        let matches = i.class.opcode == Op::Decorate
            && i.operands[0] == Operand::IdRef(id)
            && i.operands[1] == Operand::Decoration(wanted);
        matches.then(|| i.operands[2..].to_vec())
    })
}

fn member_decorations(module: &Module, id: u32, wanted: Decoration) -> BTreeMap<u32, Vec<Operand>> {
    let of_type = module.annotations.iter().filter(|i| {
        i.class.opcode == Op::MemberDecorate
            && i.operands[0] == Operand::IdRef(id)
            && i.operands[2] == Operand::Decoration(wanted)
    });
    of_type.map(|i| (literal(&i.operands[1]), i.operands[3..].to_vec())).collect()
}

fn name(module: &Module, id: u32) -> String {
    let names = module.debug_names.iter();
    let mut named = names.filter(|i| i.class.opcode == Op::Name && i.operands[0] == Operand::IdRef(id));
    match named.next().map(|i| &i.operands[1]) {
        Some(Operand::LiteralString(text)) => text.clone(),
        _ => String::new(),
    }
}

fn member_name(module: &Module, id: u32, member: u32) -> String {
    let mut names = module.debug_names.iter().filter(|i| {
        i.class.opcode == Op::MemberName
            && i.operands[0] == Operand::IdRef(id)
            && literal(&i.operands[1]) == member
    });
    match names.next().map(|i| &i.operands[2]) {
        Some(Operand::LiteralString(text)) => text.clone(),
        _ => panic!("member {member} of %{id} has no name"),
    }
}

fn definition(module: &Module, id: u32) -> &Instruction {
    module.types_global_values.iter().find(|i| i.result_id == Some(id)).expect("ids are defined")
}

fn pointee<'a>(module: &'a Module, variable: &Instruction) -> &'a Instruction {
    let pointer = definition(module, variable.result_type.expect("variables are typed"));
    definition(module, literal(&pointer.operands[1]))
}

/// The variables with a binding, by binding number.
fn bound_variables(module: &Module) -> BTreeMap<u32, &Instruction> {
    let variables = module.types_global_values.iter().filter(|i| i.class.opcode == Op::Variable);
    variables
        .filter_map(|variable| {
            let id = variable.result_id?;
            let binding = literal(&decoration(module, id, Decoration::Binding)?[0]);
            let set = literal(&decoration(module, id, Decoration::DescriptorSet)?[0]);
            assert_eq!(set, 0, "all bindings are in set 0");
            Some((binding, variable))
        })
        .collect()
}

/// The kind and access that a variable's type and decorations say.
fn reflected(module: &Module, variable: &Instruction) -> (BindingKind, Access) {
    let kind = pointee(module, variable);
    let id = variable.result_id.expect("a variable has an id");
    if kind.class.opcode == Op::TypeSampledImage {
        return (BindingKind::FilteredImage, Access::Read);
    }
    if kind.class.opcode == Op::TypeImage {
        // Operand 5: 1 is sampled, 2 is storage
        if literal(&kind.operands[5]) == 1 {
            return (BindingKind::SampledImage, Access::Read);
        }
        let has = |wanted| decoration(module, id, wanted).is_some();
        let access = match (has(Decoration::NonWritable), has(Decoration::NonReadable)) {
            (true, _) => Access::Read,
            (false, true) => Access::Write,
            (false, false) => Access::ReadWrite,
        };
        return (BindingKind::StorageImage, access);
    }
    let block = kind.result_id.expect("a type has an id");
    let all = |wanted| {
        decoration(module, id, wanted).is_some()
            || member_decorations(module, block, wanted).len() == kind.operands.len()
    };
    let access = match (all(Decoration::NonWritable), all(Decoration::NonReadable)) {
        (true, false) => Access::Read,
        (false, true) => Access::Write,
        _ => Access::ReadWrite,
    };
    (BindingKind::StorageBuffer, access)
}

/// What the GLSL calls a binding: an image by its variable, a buffer by its block's only member.
fn binding_name(module: &Module, variable: &Instruction) -> String {
    let kind = pointee(module, variable);
    if matches!(kind.class.opcode, Op::TypeImage | Op::TypeSampledImage) {
        return name(module, variable.result_id.expect("a variable has an id"));
    }
    assert_eq!(kind.operands.len(), 1, "a buffer's block has one member");
    member_name(module, kind.result_id.expect("a type has an id"), 0)
}

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

/// Member names and offsets of the structure named `wanted`, with and without a layout being two types.
fn offsets(module: &Module, wanted: &str) -> Option<Vec<(String, u32)>> {
    let structs = module.types_global_values.iter().filter(|i| i.class.opcode == Op::TypeStruct);
    structs.filter_map(|i| i.result_id).filter(|&id| name(module, id) == wanted).find_map(|id| {
        let offsets = member_decorations(module, id, Decoration::Offset);
        (!offsets.is_empty())
            .then(|| offsets.iter().map(|(&m, o)| (member_name(module, id, m), literal(&o[0]))).collect())
    })
}

macro_rules! layout {
    ($type:ty, $($rust:ident $(as $glsl:literal)?),+ $(,)?) => {
        vec![$((layout!(@name $rust $($glsl)?), offset_of!($type, $rust) as u32)),+]
    };
    (@name $rust:ident) => { stringify!($rust).to_owned() };
    (@name $rust:ident $glsl:literal) => { $glsl.to_owned() };
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
        ..ShadeOptions::default()
    };
    let lights = LightSummary { quad_count: 1, effects: Effects::all(), ..LightSummary::default() };
    let bound = |specialization: Vec<(u32, u32)>| {
        let pruned = arealight_vk::prune(&kernels::SHADE.words(), &specialization);
        bound_variables(&parsed(&pruned)).into_keys().collect::<Vec<u32>>()
    };
    let of_frames: Vec<u32> = (0..kernels::FRAME_BINDINGS as u32).collect();
    assert_eq!(bound(shade_specialization(options, lights)), of_frames);
    // Tiles have their lists, too; a frame of quads without shadows has no more than quads need
    let of_tiles = bound(shade_tiles_specialization(options, lights, TileClass::Any));
    assert_eq!(of_tiles, [of_frames.as_slice(), &[13]].concat());
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

fn shade_constants() -> Vec<(String, u32)> {
    layout!(
        gpu::ShadeConstants,
        position_from_clip,
        camera,
        light_count,
        shape_count,
        quad_count,
        seed,
        capacity,
        size,
        horizon_cells,
        cull_threshold
    )
}

fn light_layout() -> Vec<(String, u32)> {
    layout!(
        gpu::GpuLight,
        radiance,
        first_vertex,
        center,
        radius,
        normal,
        area,
        vertex_count,
        flags,
        texture_layer,
        reserved
    )
}

#[test]
fn every_structure_has_the_same_offsets() {
    let shade = module(&kernels::SHADE);
    let eval = module(&tool::kernels::EVAL);
    let visibility = module(&tool::kernels::VISIBILITY);
    let light = light_layout();
    for (kernel, structure, expected) in [
        (&shade, "ArealightGpuLight", light.clone()),
        (&eval, "ArealightGpuLight", light),
        (&shade, "ShadeConstants", shade_constants()),
        (&eval, "EvalConstants", layout!(tool::gpu::EvalConstants, case_count)),
        (
            &eval,
            "ArealightGpuCase",
            layout!(
                tool::gpu::GpuCase,
                normal,
                roughness,
                view,
                f90,
                diffuse_albedo,
                light,
                f0,
                coat_weight,
                coat_normal,
                coat_roughness
            ),
        ),
        (
            &visibility,
            "ArealightGpuBvhNode",
            layout!(gpu::GpuBvhNode, min as "min_corner", first,
                                                     max as "max_corner", count),
        ),
        (
            &visibility,
            "ArealightGpuTriangle",
            layout!(tool::gpu::GpuTriangle, p0, material, p1, v0, p2, v1, n0, u0, n1,
                                                      u1, n2, u2, v2, flags, reserved as "reserved0"),
        ),
        (
            &visibility,
            "ArealightGpuMaterial",
            layout!(
                tool::gpu::GpuMaterial,
                base_color,
                metalness,
                emission,
                roughness,
                dielectric_f0,
                dielectric_f90,
                base_color_texture,
                metallic_roughness_texture,
                normal_texture,
                normal_scale,
                flags,
                alpha_cutoff,
                base_alpha,
                emission_texture,
                coat,
                coat_roughness,
                coat_texture,
                coat_roughness_texture,
                coat_normal_texture,
                coat_normal_scale,
                reserved as "reserved0"
            ),
        ),
        (
            &visibility,
            "ArealightGpuTexture",
            layout!(tool::gpu::GpuTexture, first_texel, width, height, flags),
        ),
        (
            &visibility,
            "VisibilityConstants",
            layout!(
                tool::gpu::VisibilityConstants,
                camera,
                reserved0,
                right,
                reserved1,
                up,
                reserved2,
                forward,
                reserved3,
                background,
                reserved4
            ),
        ),
    ] {
        assert_offsets(kernel, structure, &expected);
    }
}

#[test]
fn the_structures_of_tiles_have_the_same_offsets() {
    let classify = module(&kernels::CLASSIFY);
    let shadow = layout!(gpu::ShadowConstants, position_from_clip, camera, seed, size);
    assert_eq!(offsets(&module(&kernels::SHADOW_RAYS), "ShadowConstants"), Some(shadow));
    let horizon = layout!(
        arealight::table::LobeHorizon,
        lobe,
        schlick,
        weight,
        envelope,
        schlick_albedo,
        reserved as "reserved0"
    );
    for (kernel, structure, expected) in [
        (&classify, "ShadeConstants", &shade_constants()),
        (&classify, "ArealightGpuLobeHorizon", &horizon),
        (&classify, "ArealightGpuLight", &light_layout()),
    ] {
        assert_offsets(kernel, structure, expected);
    }
}

#[test]
fn the_reference_s_structures_have_the_same_offsets() {
    let reference = module(&tool::kernels::REFERENCE);
    let light = light_layout();
    for (kernel, structure, expected) in [
        (&reference, "ArealightGpuLight", light),
        (
            &reference,
            "ReferenceConstants",
            layout!(
                tool::gpu::ReferenceConstants,
                camera,
                light_count,
                first_sample,
                sample_count,
                weight,
                seed,
                shape_count
            ),
        ),
        (
            &reference,
            "ArealightGpuLightSampling",
            layout!(tool::gpu::GpuLightSampling, normal, area, first_triangle,
                                                          triangle_count, reserved as "reserved0"),
        ),
        (
            &reference,
            "ArealightGpuLightTriangle",
            layout!(tool::gpu::GpuLightTriangle, vertices as "vertex0",
                                                          cumulative),
        ),
    ] {
        assert_offsets(kernel, structure, &expected);
    }
}

#[test]
fn shapes_have_the_same_offsets() {
    let shape = layout!(gpu::GpuShape, radiance, kind, center, radius, axis_u, detail, axis_v, flags);
    for kernel in [&kernels::SHADE, &tool::kernels::EVAL_SHAPES, &tool::kernels::REFERENCE] {
        assert_offsets(&module(kernel), "ArealightGpuShape", &shape);
    }
    let constants = layout!(tool::gpu::EvalConstants, case_count);
    assert_offsets(&module(&tool::kernels::EVAL_SHAPES), "EvalConstants", &constants);
}

#[test]
fn the_texture_kernels_constants_have_the_same_offsets() {
    for (kernel, structure, expected) in [
        (
            &kernels::TEXTURE_LOAD,
            "TextureLoadConstants",
            layout!(gpu::TextureLoadConstants, first_texel, first_offset, stride, flags, layer),
        ),
        (
            &kernels::TEXTURE_BLUR,
            "TextureBlurConstants",
            vec![("weights".to_owned(), 0), ("first_layer".to_owned(), 4 * MOST_TAPS as u32)],
        ),
    ] {
        assert_offsets(&module(kernel), structure, &expected);
    }
}

/// Fails unless a structure of a module has the members of `expected` at the same offsets.
fn assert_offsets(module: &Module, structure: &str, expected: &[(String, u32)]) {
    let found = offsets(module, structure).unwrap_or_else(|| panic!("{structure} is in the module"));
    // An array in Rust may be several members in GLSL: compare the first of each
    let found: Vec<_> =
        found.into_iter().filter(|(name, _)| expected.iter().any(|(e, _)| e == name)).collect();
    assert_eq!(found, expected, "{structure}");
}

#[test]
fn array_strides_are_the_sizes_in_rust() {
    for (kernel, buffer, size) in [
        (&kernels::SHADE, "lights", size_of::<gpu::GpuLight>()),
        (&tool::kernels::EVAL, "cases", size_of::<tool::gpu::GpuCase>()),
        (&tool::kernels::EVAL_SHAPES, "cases", size_of::<tool::gpu::GpuCase>()),
        (&tool::kernels::EVAL_SHAPES, "shapes", size_of::<gpu::GpuShape>()),
        (&kernels::SHADE, "shapes", size_of::<gpu::GpuShape>()),
        (&tool::kernels::REFERENCE, "light_sampling", size_of::<tool::gpu::GpuLightSampling>()),
        (&tool::kernels::REFERENCE, "light_triangles", size_of::<tool::gpu::GpuLightTriangle>()),
        (&BLOCKERS, "nodes", size_of::<gpu::GpuBvhNode>()),
        (&BLOCKERS, "blocker_triangles", size_of::<[[f32; 4]; 3]>()),
        (&tool::kernels::VISIBILITY, "nodes", size_of::<gpu::GpuBvhNode>()),
        (&tool::kernels::VISIBILITY, "triangles", size_of::<tool::gpu::GpuTriangle>()),
        (&tool::kernels::VISIBILITY, "materials", size_of::<tool::gpu::GpuMaterial>()),
        (&tool::kernels::VISIBILITY, "textures", size_of::<tool::gpu::GpuTexture>()),
    ] {
        let module = module(kernel);
        let number =
            kernel.bindings.iter().position(|b| b.name == buffer).expect("the manifest has it") as u32;
        let block = pointee(&module, bound_variables(&module)[&number]);
        assert_eq!(member_name(&module, block.result_id.unwrap(), 0), buffer);
        let array = literal(&block.operands[0]);
        let stride = literal(&decoration(&module, array, Decoration::ArrayStride).expect("an array")[0]);
        assert_eq!(stride as usize, size, "{buffer}");
    }
}

#[test]
fn push_constants_have_the_size_in_the_manifest() {
    for kernel in kernels::ALL.into_iter().chain(tool::kernels::ALL) {
        let module = module(kernel);
        let block = module
            .types_global_values
            .iter()
            .find(|i| {
                i.class.opcode == Op::Variable
                    && i.operands[0] == Operand::StorageClass(StorageClass::PushConstant)
            })
            .map(|variable| pointee(&module, variable))
            .expect("every kernel has push constants");
        let id = block.result_id.unwrap();
        let last = member_decorations(&module, id, Decoration::Offset);
        let (member, offset) = last.iter().next_back().unwrap();
        // Every last member is of 32-bit scalars
        let kind = definition(&module, literal(&block.operands[*member as usize]));
        let scalars = match kind.class.opcode {
            Op::TypeInt | Op::TypeFloat => 1,
            Op::TypeVector => literal(&kind.operands[1]),
            other => panic!("{}: {other:?}", kernel.name),
        };
        assert_eq!(literal(&offset[0]) + 4 * scalars, kernel.push_constant_size, "{}", kernel.name);
    }
}
