//! Every structure that the CPU writes has the same offsets and sizes in Rust and in the modules.

use super::reflection::{bound_variables, decoration, literal, member_name, module, offsets, pointee};
use arealight::gpu;
use arealight::kernels;
use arealight_tests::kernel::BLOCKERS;
use arealight_tool_kernels as tool;
use rspirv::dr::Module;
use rspirv::spirv::Decoration;
use std::mem::offset_of;

macro_rules! layout {
    ($type:ty, $($rust:ident $(as $glsl:literal)?),+ $(,)?) => {
        vec![$((layout!(@name $rust $($glsl)?), offset_of!($type, $rust) as u32)),+]
    };
    (@name $rust:ident) => { stringify!($rust).to_owned() };
    (@name $rust:ident $glsl:literal) => { $glsl.to_owned() };
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
        cull_threshold,
        offset
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
        shaping
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
                coat_roughness,
                sheen_color,
                sheen_roughness,
                interface_f0,
                interface_f90,
                diffuse_roughness,
                reserved
            ),
        ),
        (
            &visibility,
            "ArealightGpuBvhNode",
            layout!(gpu::GpuBvhNode, min as "min_corner", first,
                                                     max as "max_corner", count),
        ),
    ] {
        assert_offsets(kernel, structure, &expected);
    }
}

#[test]
fn a_scenes_material_has_the_same_offsets() {
    let expected = layout!(
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
        sheen_color_texture,
        sheen_roughness_texture,
        sheen_color,
        sheen_roughness,
        anisotropy_texture,
        anisotropy_strength,
        anisotropy_direction,
        film_weight,
        film_ior,
        film_least_thickness,
        film_thickness,
        film_texture,
        film_thickness_texture,
        transmission_texture,
        transmission_color_texture,
        transmission_color,
        transmission,
        specular_texture,
        specular_color_texture,
        glass_texture,
        glass
    );
    assert_offsets(&module(&tool::kernels::VISIBILITY), "ArealightGpuMaterial", &expected);
}

#[test]
fn structures_of_scenes_have_the_same_offsets() {
    let visibility = module(&tool::kernels::VISIBILITY);
    for (kernel, structure, expected) in [
        (
            &visibility,
            "ArealightGpuTriangle",
            layout!(
                tool::gpu::GpuTriangle,
                p0,
                material,
                p1,
                v0,
                p2,
                v1,
                n0,
                u0,
                n1,
                u1,
                n2,
                u2,
                v2,
                flags,
                tangent0,
                tangent1,
                tangent2,
                color0,
                color1,
                color2
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
                orthographic,
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
        (
            &classify,
            "ArealightGpuLightCounts",
            &layout!(gpu::LightCounts, light_count, shape_count, quad_count),
        ),
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
fn the_constants_of_media_have_the_same_offsets() {
    let of_pass = layout!(
        gpu::MediumConstants,
        position_from_clip,
        camera,
        light_count,
        scattering,
        extinction,
        shape_count,
        quad_count,
        seed,
        anisotropy,
        columns_rows,
        slices_cull,
        nearest,
        farthest,
    );
    for kernel in kernels::MEDIUM_PASS {
        assert_offsets(&module(kernel), "MediumConstants", &of_pass);
    }
    let of_reference = layout!(
        tool::gpu::MediumReferenceConstants,
        position_from_clip,
        camera,
        light_count,
        scattering,
        extinction,
        shape_count,
        first_sample,
        sample_count,
        weight,
        anisotropy,
        farthest,
        seed,
        reserved,
    );
    assert_offsets(&module(&tool::kernels::REFERENCE_MEDIUM), "MediumReferenceConstants", &of_reference);
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
            layout!(gpu::TextureLoadConstants, first_texel, first_offset, stride, flags, layer, factor),
        ),
        (
            &kernels::TEXTURE_KERNEL,
            "TextureKernelConstants",
            ["layer", "level", "aspect", "is_ellipse"]
                .map(str::to_owned)
                .into_iter()
                .zip((0..).step_by(4))
                .collect(),
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
        (&tool::kernels::EVAL_MEDIUM, "cases", size_of::<tool::gpu::GpuMediumCase>()),
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
        let number = kernel.bindings().iter().find(|b| b.name == buffer).expect("the kernel has it").number;
        let block = pointee(&module, bound_variables(&module)[&number]);
        assert_eq!(member_name(&module, block.result_id.unwrap(), 0), buffer);
        let array = literal(&block.operands[0]);
        let stride = literal(&decoration(&module, array, Decoration::ArrayStride).expect("an array")[0]);
        assert_eq!(stride as usize, size, "{buffer}");
    }
}
