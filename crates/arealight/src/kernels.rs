//! The kernels, and what their SPIR-V says of them: bindings, constants, group size.

use crate::output::RadianceFormat;
use reflection::Reflection;
use std::sync::OnceLock;

pub use binding::{Access, Binding, BindingKind};
pub use images::{read_samples, store_to};

mod binding;
pub mod constant;
mod images;
mod reflection;

/// A compute kernel.
#[derive(Debug)]
pub struct Kernel {
    /// The file's name without its ending.
    pub name: &'static str,
    /// SPIR-V 1.3 for Vulkan 1.1, entry point `main`; a multiple of four bytes.
    pub spirv: &'static [u8],
    /// The kernels whose descriptor set it shares.
    pass: &'static [&'static Self],
    reflection: OnceLock<Reflection>,
    bindings: OnceLock<Vec<Binding>>,
}

impl PartialEq for Kernel {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.spirv == other.spirv
    }
}

impl Eq for Kernel {}

impl Kernel {
    /// A kernel with a descriptor set of its own.
    pub const fn new(name: &'static str, spirv: &'static [u8]) -> Self {
        Self::of_pass(name, spirv, &[])
    }

    /// A kernel that has a descriptor set in common with those of `pass`.
    pub const fn of_pass(name: &'static str, spirv: &'static [u8], pass: &'static [&'static Self]) -> Self {
        Self { name, spirv, pass, reflection: OnceLock::new(), bindings: OnceLock::new() }
    }

    fn reflection(&self) -> &Reflection {
        self.reflection.get_or_init(|| Reflection::of(self.spirv))
    }

    /// Invocations of a workgroup in x, y and z.
    pub fn local_size(&self) -> [u32; 3] {
        self.reflection().local_size
    }

    /// Size of the push constants in bytes, of the struct of [`crate::gpu`] named for the kernel. A pass has
    /// one struct, though a kernel of it may declare only the first members.
    pub fn push_constant_size(&self) -> u32 {
        let of_pass = self.pass.iter().map(|kernel| kernel.reflection().push_constant_size);
        of_pass.fold(self.reflection().push_constant_size, u32::max)
    }

    /// Ids of the specialisation constants that the kernel has.
    pub fn constants(&self) -> &[u32] {
        &self.reflection().constants
    }

    /// The bindings of set 0, by number: the kernel's, and those of the other kernels of its pass with
    /// [`Access::None`].
    pub fn bindings(&self) -> &[Binding] {
        self.bindings.get_or_init(|| {
            let mut all = self.reflection().bindings.clone();
            for other in self.pass.iter().flat_map(|kernel| &kernel.reflection().bindings) {
                if let Err(place) = all.binary_search_by_key(&other.number, |one| one.number) {
                    all.insert(place, Binding { access: Access::None, ..*other });
                }
            }
            all
        })
    }

    /// How many workgroups cover so many invocations.
    pub fn groups_for(&self, invocations: [u32; 3]) -> [u32; 3] {
        let local_size = self.local_size();
        [0, 1, 2].map(|i| invocations[i].div_ceil(local_size[i]))
    }

    /// The SPIR-V as words, in the machine's byte order.
    pub fn words(&self) -> Vec<u32> {
        self.spirv.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
    }

    /// As [`Kernel::words`], with images of this format where the module stores to rgba32f, and a G-buffer of
    /// so many samples: a word a type or a read, so that one module serves all.
    pub fn words_for(&self, format: RadianceFormat, samples: u32) -> Vec<u32> {
        let mut words = self.words();
        store_to(format, &mut words);
        read_samples(samples, &mut words);
        words
    }
}

/// The kernels of a shade pass, which have one descriptor set.
pub static SHADE_PASS: [&Kernel; 2] = [&SHADE, &CLASSIFY];

/// The kernels of a shadow pass, which have one descriptor set and [`crate::gpu::ShadowConstants`].
pub static SHADOW_PASS: [&Kernel; 3] = [&SHADOW_RAYS, &SHADOW_HISTORY, &SHADOW_FILTER];

/// Shades a G-buffer with polygon lights and shapes: whole frames, or the tiles of one class, by
/// [`constant::CLASS`]. Push constants: [`crate::gpu::ShadeConstants`].
///
/// A module that was pruned for whole frames has none of [`TILE_BINDINGS`], and `light_counts` only with
/// [`ShadeOptions::light_counts`](crate::plan::ShadeOptions::light_counts): its pipeline layout needs no
/// more. The module as it is has `tile_lists`, too.
pub static SHADE: Kernel = Kernel::of_pass("shade", include_bytes!("../spirv/shade.spv"), &SHADE_PASS);

/// The names of the bindings that tiles alone have.
pub const TILE_BINDINGS: [&str; 2] = ["tile_lists", "lobe_horizons"];

/// Sorts the tiles of a G-buffer into classes; a workgroup per tile. Push constants:
/// [`crate::gpu::ShadeConstants`].
pub static CLASSIFY: Kernel =
    Kernel::of_pass("classify", include_bytes!("../spirv/classify.spv"), &SHADE_PASS);

/// Traces the shadow rays that [`SHADE`] picked lights and lobes for.
pub static SHADOW_RAYS: Kernel =
    Kernel::of_pass("shadow_rays", include_bytes!("../spirv/shadow_rays.spv"), &SHADOW_PASS);

/// Makes means over frames of the rays of [`SHADOW_RAYS`].
pub static SHADOW_HISTORY: Kernel =
    Kernel::of_pass("shadow_history", include_bytes!("../spirv/shadow_history.spv"), &SHADOW_PASS);

/// Multiplies unshadowed radiance with what the rays of [`SHADOW_RAYS`] say of it.
pub static SHADOW_FILTER: Kernel =
    Kernel::of_pass("shadow_filter", include_bytes!("../spirv/shadow_filter.spv"), &SHADOW_PASS);

/// The kernels of a medium's pass, which have one descriptor set and [`crate::gpu::MediumConstants`].
pub static MEDIUM_PASS: [&Kernel; 4] = [&MEDIUM_HIDE, &MEDIUM_SCATTER, &MEDIUM_INTEGRATE, &MEDIUM_COMPOSE];

/// Marks the froxels that pixels look through; an invocation per column.
pub static MEDIUM_HIDE: Kernel =
    Kernel::of_pass("medium_hide", include_bytes!("../spirv/medium_hide.spv"), &MEDIUM_PASS);

/// Fills froxels with what a medium scatters of every light towards the camera; an invocation per froxel.
pub static MEDIUM_SCATTER: Kernel =
    Kernel::of_pass("medium_scatter", include_bytes!("../spirv/medium_scatter.spv"), &MEDIUM_PASS);

/// Sums that along each column of froxels, from the camera on; an invocation per column.
pub static MEDIUM_INTEGRATE: Kernel =
    Kernel::of_pass("medium_integrate", include_bytes!("../spirv/medium_integrate.spv"), &MEDIUM_PASS);

/// Puts the sum before the surfaces of a picture; an invocation per pixel.
pub static MEDIUM_COMPOSE: Kernel =
    Kernel::of_pass("medium_compose", include_bytes!("../spirv/medium_compose.spv"), &MEDIUM_PASS);

/// Loads a part of an image into level 0 of a layer of the light textures; an invocation per texel of the
/// level. Push constants: [`crate::gpu::TextureLoadConstants`].
pub static TEXTURE_LOAD: Kernel = Kernel::new("texture_load", include_bytes!("../spirv/texture_load.spv"));

/// Makes a mip of the light textures' images from the one before; an invocation per texel and layer. Push
/// constants: the first layer.
pub static TEXTURE_MIP: Kernel = Kernel::new("texture_mip", include_bytes!("../spirv/texture_mip.spv"));

/// Makes a level of what lobes see of an image on a light; an invocation per two by two nodes. Push
/// constants: the layer, the level, [`crate::TexturePart::aspect`] and [`crate::TexturePart::is_ellipse`].
pub static TEXTURE_KERNEL: Kernel =
    Kernel::new("texture_kernel", include_bytes!("../spirv/texture_kernel.spv"));

/// Every kernel.
pub static ALL: [&Kernel; 12] = [
    &SHADE,
    &CLASSIFY,
    &SHADOW_RAYS,
    &SHADOW_HISTORY,
    &SHADOW_FILTER,
    &MEDIUM_HIDE,
    &MEDIUM_SCATTER,
    &MEDIUM_INTEGRATE,
    &MEDIUM_COMPOSE,
    &TEXTURE_LOAD,
    &TEXTURE_MIP,
    &TEXTURE_KERNEL,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_module_is_spirv() {
        for kernel in ALL {
            assert_eq!(kernel.spirv.len() % 4, 0, "{}", kernel.name);
            assert_eq!(kernel.words()[0], 0x0723_0203, "{}: SPIR-V's magic number", kernel.name);
        }
    }

    #[test]
    fn one_word_makes_the_shade_kernel_store_to_half_floats() {
        let words = SHADE.words();
        assert_eq!(SHADE.words_for(RadianceFormat::Rgba32Float, 1), words);
        let half = SHADE.words_for(RadianceFormat::Rgba16Float, 1);
        let changed: Vec<_> = words.iter().zip(&half).filter(|(from, to)| from != to).collect();
        // Both images have one type
        assert_eq!(changed, [(&1, &2)]);
        // A module that is cut off is left as it is from there on, without a panic
        let end = words.iter().zip(&half).position(|(from, to)| from != to).unwrap();
        store_to(RadianceFormat::Rgba16Float, &mut words[..end].to_vec());
    }

    #[test]
    fn a_few_words_make_kernels_read_samples() {
        for kernel in [&SHADE, &CLASSIFY] {
            let words = kernel.words();
            let samples = kernel.words_for(RadianceFormat::Rgba32Float, 4);
            let mut changed: Vec<_> = words
                .iter()
                .zip(&samples)
                .filter(|(from, to)| from != to)
                .map(|(from, to)| (*from, *to))
                .collect();
            // The images of floats have one type, the stencil another; each image is read once, or more often
            // in code that is there twice
            let types = changed.extract_if(.., |change| *change == (0, 1)).count();
            assert_eq!(types, 2, "{}", kernel.name);
            assert!(changed.len() >= 8, "{}: {} reads", kernel.name, changed.len());
            assert!(changed.iter().all(|change| *change == (0x2, 0x40)), "{}: {changed:?}", kernel.name);
        }
    }
}
