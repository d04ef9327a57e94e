//! These kernels, as [`arealight::kernels`] has its own.

use arealight::kernels::Kernel;

/// The shade kernel's functions over a list of shading points. Push constants: [`crate::gpu::EvalConstants`].
pub static EVAL: Kernel = Kernel::new("eval", include_bytes!("../spirv/eval.spv"));

/// As [`EVAL`], of disks, spheres and tubes. Push constants: [`crate::gpu::EvalConstants`].
pub static EVAL_SHAPES: Kernel = Kernel::new("eval_shapes", include_bytes!("../spirv/eval_shapes.spv"));

/// The library's lights over a list of points in a medium. Push constants: [`crate::gpu::EvalConstants`].
pub static EVAL_MEDIUM: Kernel = Kernel::new("eval_medium", include_bytes!("../spirv/eval_medium.spv"));

/// [`arealight::kernels::SHADE`] for whole frames, which is translated to other shading languages: its
/// bindings have the same numbers, the constants of a frame are a uniform block, images are apart from their
/// sampler, and radiance is not read. No device runs it as it is.
pub static SHADE_PORTABLE: &[u8] = include_bytes!("../spirv/shade_portable.spv");

/// Id of a specialisation constant of [`REFERENCE`]: 1 where the triangles of the scene block light, else 0.
pub const SHADOWS: u32 = 100;
/// Id of a specialisation constant of [`REFERENCE`]: 1 where diffuse lobes get what the Fresnel term leaves,
/// as in glTF, else 0.
pub const COUPLED: u32 = 101;
/// Id of a specialisation constant of kernels that send rays: 0 where no material has alpha, else 1.
pub const HAS_ALPHA: u32 = 102;

/// Integrates the true BRDF over the same lights by Monte Carlo, on the same G-buffer. Push constants:
/// [`crate::gpu::ReferenceConstants`].
pub static REFERENCE: Kernel = Kernel::new("reference", include_bytes!("../spirv/reference.spv"));

/// Puts a medium before a picture by Monte Carlo. Push constants: [`crate::gpu::MediumReferenceConstants`].
pub static REFERENCE_MEDIUM: Kernel =
    Kernel::new("reference_medium", include_bytes!("../spirv/reference_medium.spv"));

/// Finds the surface that each pixel sees, in a hierarchy of triangles, and writes a G-buffer: the planes
/// `out_*`, and in w of positions one more than the triangle's index. Push constants:
/// [`crate::gpu::VisibilityConstants`].
pub static VISIBILITY: Kernel = Kernel::new("visibility", include_bytes!("../spirv/visibility.spv"));

/// [`arealight::kernels::SHADOW_RAYS`] of scenes with triangles that are cut out or blended: those with a
/// number ([`arealight::Blockers::with_alpha`]) are asked for in set 1, whose bindings 1 to 4 are the scene's
/// triangles, materials, textures and texels. The number is one more than the triangle's index.
pub static SHADOW_RAYS_MASKED: Kernel =
    Kernel::new("shadow_rays", include_bytes!("../spirv/shadow_rays_masked.spv"));

/// Every kernel of this crate that is bound by itself.
pub static ALL: [&Kernel; 6] =
    [&EVAL, &EVAL_SHAPES, &EVAL_MEDIUM, &REFERENCE, &REFERENCE_MEDIUM, &VISIBILITY];
