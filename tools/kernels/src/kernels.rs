//! The manifest of these kernels, as [`arealight::kernels`] has it: SPIR-V, bindings, constants and group
//! size. A test reads the same facts back out of the SPIR-V.

use arealight::kernels::{
    Access, Binding, BindingKind, G_ANISOTROPY, G_BASE_COLOR, G_COAT, G_FILM, G_NORMAL, G_POSITION, G_SHEEN,
    G_SPECULAR, Kernel, LIGHT_TEXTURES, LIGHT_VERTICES, LIGHTS, SHAPES, TABLE, constant,
};

const fn read(name: &'static str, kind: BindingKind, content: &'static str) -> Binding {
    Binding { name, kind, access: Access::Read, content }
}

const fn write(name: &'static str, kind: BindingKind, access: Access, content: &'static str) -> Binding {
    Binding { name, kind, access, content }
}

/// The shade kernel's functions over a list of shading points. Push constants: [`crate::gpu::EvalConstants`].
pub static EVAL: Kernel = Kernel {
    name: "eval",
    spirv: include_bytes!("../spirv/eval.spv"),
    local_size: [64, 1, 1],
    push_constant_size: size_of::<crate::gpu::EvalConstants>() as u32,
    bindings: &[
        TABLE,
        LIGHTS,
        LIGHT_VERTICES,
        read("cases", BindingKind::StorageBuffer, "GpuCase[]"),
        write("results", BindingKind::StorageBuffer, Access::Write, "vec4[]: radiance, 0"),
        LIGHT_TEXTURES,
    ],
    constants: &[
        constant::EFFECTS,
        constant::FORM_FACTOR,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::FOOTPRINT,
    ],
};

/// As [`EVAL`], of disks, spheres and tubes. Push constants: [`crate::gpu::EvalConstants`].
pub static EVAL_SHAPES: Kernel = Kernel {
    name: "eval_shapes",
    spirv: include_bytes!("../spirv/eval_shapes.spv"),
    local_size: [64, 1, 1],
    push_constant_size: size_of::<crate::gpu::EvalConstants>() as u32,
    bindings: &[
        TABLE,
        read("shapes", BindingKind::StorageBuffer, "GpuShape[]"),
        read("cases", BindingKind::StorageBuffer, "GpuCase[], whose light is a shape's index"),
        write("results", BindingKind::StorageBuffer, Access::Write, "vec4[]: radiance, 0"),
        LIGHT_TEXTURES,
    ],
    constants: &[
        constant::EFFECTS,
        constant::FORM_FACTOR,
        constant::HORIZON,
        constant::SPECULAR_LOBES,
        constant::LOBES,
        constant::FOOTPRINT,
        constant::SHAPE,
    ],
};

/// [`arealight::kernels::SHADE`] for whole frames, which is translated to other shading languages: its
/// bindings have the same numbers, the constants of a frame are a uniform block, images are apart from their
/// sampler, and radiance is not read. No device runs it as it is.
pub static SHADE_PORTABLE: &[u8] = include_bytes!("../spirv/shade_portable.spv");

/// Id of a specialisation constant of [`REFERENCE`]: 1 where the triangles of the scene block light, else 0.
pub const SHADOWS: u32 = 100;
/// Id of a specialisation constant of [`REFERENCE`]: 1 where diffuse lobes get what the Fresnel term leaves,
/// as in glTF, else 0.
pub const COUPLED: u32 = 101;

/// The buffers of a scene: a hierarchy of its triangles, and what they look like.
const SCENE: [Binding; 5] = [
    read("nodes", BindingKind::StorageBuffer, "GpuBvhNode[]"),
    read("triangles", BindingKind::StorageBuffer, "GpuTriangle[]"),
    read("materials", BindingKind::StorageBuffer, "GpuMaterial[]"),
    read("textures", BindingKind::StorageBuffer, "GpuTexture[]"),
    read("texels", BindingKind::StorageBuffer, "uint[]: RGBA8, red in the low byte"),
];

/// Integrates the true BRDF over the same lights by Monte Carlo, on the same G-buffer. Push constants:
/// [`crate::gpu::ReferenceConstants`].
pub static REFERENCE: Kernel = Kernel {
    name: "reference",
    spirv: include_bytes!("../spirv/reference.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::ReferenceConstants>() as u32,
    bindings: &[
        LIGHTS,
        LIGHT_VERTICES,
        read("light_sampling", BindingKind::StorageBuffer, "GpuLightSampling[]: a record per light"),
        read("light_triangles", BindingKind::StorageBuffer, "GpuLightTriangle[]"),
        G_POSITION,
        G_NORMAL,
        G_BASE_COLOR,
        G_SPECULAR,
        write(
            "radiance_image",
            BindingKind::StorageImage,
            Access::ReadWrite,
            "the dispatch's weighted mean is added (rgba32f)",
        ),
        LIGHT_TEXTURES,
        SHAPES,
        G_COAT,
        G_SHEEN,
        G_ANISOTROPY,
        G_FILM,
        read(
            "g_transmitted",
            BindingKind::SampledImage,
            "albedo of what is let through in rgb, below the interface and above all other layers (rgba16f)",
        ),
        SCENE[0],
        SCENE[1],
        SCENE[2],
        SCENE[3],
        SCENE[4],
    ],
    constants: &[SHADOWS, COUPLED],
};

/// Finds the surface that each pixel sees, in a hierarchy of triangles, and writes a G-buffer. Push
/// constants: [`crate::gpu::VisibilityConstants`].
pub static VISIBILITY: Kernel = Kernel {
    name: "visibility",
    spirv: include_bytes!("../spirv/visibility.spv"),
    local_size: [8, 8, 1],
    push_constant_size: size_of::<crate::gpu::VisibilityConstants>() as u32,
    bindings: &[
        SCENE[0],
        SCENE[1],
        SCENE[2],
        SCENE[3],
        SCENE[4],
        write(
            "out_position",
            BindingKind::StorageImage,
            Access::Write,
            "g_position of the shade kernel (rgba32f); in w one more than the triangle's index",
        ),
        write(
            "out_normal",
            BindingKind::StorageImage,
            Access::Write,
            "g_normal of the shade kernel (rgba32f)",
        ),
        write("out_base_color", BindingKind::StorageImage, Access::Write, "g_base_color (rgba16f)"),
        write("out_specular", BindingKind::StorageImage, Access::Write, "g_specular (rgba32f)"),
        write("out_radiance", BindingKind::StorageImage, Access::Write, "emission seen directly (rgba32f)"),
        write("out_coat", BindingKind::StorageImage, Access::Write, "g_coat, with normals (rgba32f)"),
        write("out_sheen", BindingKind::StorageImage, Access::Write, "g_sheen (rgba32f)"),
        write("out_anisotropy", BindingKind::StorageImage, Access::Write, "g_anisotropy (rgba32f)"),
        write("out_film", BindingKind::StorageImage, Access::Write, "g_film (rgba32f)"),
        write(
            "out_transmitted",
            BindingKind::StorageImage,
            Access::Write,
            "g_base_color of a pass with Effects::TRANSMISSION (rgba16f)",
        ),
    ],
    constants: &[],
};

/// Every kernel of this crate.
pub static ALL: [&Kernel; 4] = [&EVAL, &EVAL_SHAPES, &REFERENCE, &VISIBILITY];
