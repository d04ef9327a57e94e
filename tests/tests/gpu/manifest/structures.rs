//! Every structure that the CPU writes has the same offsets and sizes in Rust and in the modules.

use super::reflection::{bound_variables, decoration, literal, member_name, module, offsets, pointee};
use arealight::gpu::{
    GpuBvhNode, GpuLight, GpuShape, LightCounts, MediumConstants, ShadeConstants, ShadowConstants,
    TextureLoadConstants,
};
use arealight::kernels::{
    CLASSIFY, Kernel, MEDIUM_COMPOSE, MEDIUM_HIDE, MEDIUM_INTEGRATE, MEDIUM_SCATTER, SHADE, SHADOW_RAYS,
    TEXTURE_KERNEL, TEXTURE_LOAD,
};
use arealight::table::LobeHorizon;
use arealight_tests::kernel::BLOCKERS;
use arealight_tool_kernels::gpu::{
    EvalConstants, GpuCase, GpuLightSampling, GpuLightTriangle, GpuMaterial, GpuMediumCase, GpuTexture,
    GpuTriangle, MediumReferenceConstants, ReferenceConstants, VisibilityConstants,
};
use arealight_tool_kernels::kernels::{
    EVAL, EVAL_MEDIUM, EVAL_SHAPES, REFERENCE, REFERENCE_MEDIUM, VISIBILITY,
};
use rspirv::dr::Module;
use rspirv::spirv::Decoration;
use std::mem::offset_of;

/// Kernels, a structure that they have, and its members with their offsets in Rust, by their names in GLSL.
type Structure = (Vec<&'static Kernel>, &'static str, Vec<(String, u32)>);

/// The structures of a list: kernels, the name in GLSL, that in Rust, members.
macro_rules! structures {
    ($($($kernel:ident)+: $structure:literal as $type:ty { $($rust:ident $(= $glsl:literal)?)+ })+) => {
        vec![$((
            vec![$(&$kernel),+],
            $structure,
            vec![$((structures!(@name $rust $($glsl)?), offset_of!($type, $rust) as u32)),+],
        )),+]
    };
    (@name $rust:ident) => { stringify!($rust).to_owned() };
    (@name $rust:ident $glsl:literal) => { $glsl.to_owned() };
}

fn structures() -> Vec<Structure> {
    structures! {
        SHADE EVAL CLASSIFY REFERENCE: "ArealightGpuLight" as GpuLight {
            radiance first_vertex center radius normal area vertex_count flags texture_layer shaping
        }
        SHADE EVAL_SHAPES REFERENCE: "ArealightGpuShape" as GpuShape {
            radiance kind center radius axis_u detail axis_v flags
        }
        SHADE CLASSIFY: "ShadeConstants" as ShadeConstants {
            position_from_clip camera light_count shape_count quad_count seed capacity size horizon_cells
            cull_threshold offset
        }
        CLASSIFY: "ArealightGpuLobeHorizon" as LobeHorizon {
            lobe schlick weight envelope schlick_albedo reserved = "reserved0"
        }
        CLASSIFY: "ArealightGpuLightCounts" as LightCounts { light_count shape_count quad_count }
        SHADOW_RAYS: "ShadowConstants" as ShadowConstants { position_from_clip camera seed size }
        MEDIUM_HIDE MEDIUM_SCATTER MEDIUM_INTEGRATE MEDIUM_COMPOSE: "MediumConstants" as MediumConstants {
            position_from_clip camera light_count scattering extinction shape_count quad_count seed anisotropy
            columns_rows slices_cull nearest farthest
        }
        TEXTURE_LOAD: "TextureLoadConstants" as TextureLoadConstants {
            first_texel first_offset stride flags layer factor
        }
        EVAL EVAL_SHAPES: "EvalConstants" as EvalConstants { case_count }
        EVAL: "ArealightGpuCase" as GpuCase {
            normal roughness view f90 diffuse_albedo light f0 coat_weight coat_normal coat_roughness
            sheen_color sheen_roughness interface_f0 interface_f90 diffuse_roughness reserved
        }
        REFERENCE: "ReferenceConstants" as ReferenceConstants {
            camera light_count first_sample sample_count weight seed shape_count
        }
        REFERENCE: "ArealightGpuLightSampling" as GpuLightSampling {
            normal area first_triangle triangle_count reserved = "reserved0"
        }
        REFERENCE: "ArealightGpuLightTriangle" as GpuLightTriangle { vertices = "vertex0" cumulative }
        REFERENCE_MEDIUM: "MediumReferenceConstants" as MediumReferenceConstants {
            position_from_clip camera light_count scattering extinction shape_count first_sample sample_count
            weight anisotropy farthest seed reserved
        }
        VISIBILITY: "ArealightGpuBvhNode" as GpuBvhNode {
            min = "min_corner" first max = "max_corner" count
        }
        VISIBILITY: "ArealightGpuMaterial" as GpuMaterial {
            base_color metalness emission roughness dielectric_f0 dielectric_f90 base_color_texture
            metallic_roughness_texture normal_texture normal_scale flags alpha_cutoff base_alpha
            emission_texture coat coat_roughness coat_texture coat_roughness_texture coat_normal_texture
            coat_normal_scale sheen_color_texture sheen_roughness_texture sheen_color sheen_roughness
            anisotropy_texture anisotropy_strength anisotropy_direction film_weight film_ior
            film_least_thickness film_thickness film_texture film_thickness_texture transmission_texture
            transmission_color_texture transmission_color transmission specular_texture
            specular_color_texture glass_texture glass
        }
        VISIBILITY: "ArealightGpuTriangle" as GpuTriangle {
            p0 material p1 v0 p2 v1 n0 u0 n1 u1 n2 u2 v2 flags tangent0 tangent1 tangent2 color0 color1 color2
        }
        VISIBILITY: "ArealightGpuTexture" as GpuTexture { first_texel width height flags }
        VISIBILITY: "VisibilityConstants" as VisibilityConstants {
            camera orthographic right supersample up first_row forward reserved3 background reserved4
        }
    }
}

#[test]
fn every_structure_has_the_same_offsets() {
    for (kernels, structure, expected) in structures() {
        for kernel in kernels {
            assert_offsets(&module(kernel), structure, &expected);
        }
    }
    // Its constants are an array in Rust
    let expected = ["layer", "level", "aspect", "is_ellipse"].map(str::to_owned).into_iter();
    let expected: Vec<_> = expected.zip((0..).step_by(4)).collect();
    assert_offsets(&module(&TEXTURE_KERNEL), "TextureKernelConstants", &expected);
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
        (&SHADE, "lights", size_of::<GpuLight>()),
        (&EVAL, "cases", size_of::<GpuCase>()),
        (&EVAL_SHAPES, "cases", size_of::<GpuCase>()),
        (&EVAL_SHAPES, "shapes", size_of::<GpuShape>()),
        (&EVAL_MEDIUM, "cases", size_of::<GpuMediumCase>()),
        (&SHADE, "shapes", size_of::<GpuShape>()),
        (&REFERENCE, "light_sampling", size_of::<GpuLightSampling>()),
        (&REFERENCE, "light_triangles", size_of::<GpuLightTriangle>()),
        (&BLOCKERS, "nodes", size_of::<GpuBvhNode>()),
        (&BLOCKERS, "blocker_triangles", size_of::<[[f32; 4]; 3]>()),
        (&VISIBILITY, "nodes", size_of::<GpuBvhNode>()),
        (&VISIBILITY, "triangles", size_of::<GpuTriangle>()),
        (&VISIBILITY, "materials", size_of::<GpuMaterial>()),
        (&VISIBILITY, "textures", size_of::<GpuTexture>()),
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
