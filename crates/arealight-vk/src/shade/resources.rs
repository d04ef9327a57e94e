//! The host's images and buffers that a shade pass reads and writes.

use crate::error::Error;
use crate::resource::Resource;
use arealight::kernels::{Access, BindingKind, Kernel};
use arealight::plan::ShadeOptions;
use arealight::{Effects, LightSummary};
use ash::vk;

/// The names of bindings that options ask for, in the manifest.
pub(super) const STENCIL: &str = "g_stencil";
pub(super) const LIGHT_COUNTS: &str = "light_counts";
/// And of those of tiles.
pub(super) const TILE_LISTS: &str = "tile_lists";
pub(super) const LOBE_HORIZONS: &str = "lobe_horizons";

/// The names of bindings that may have nothing, in the manifest.
const LIGHT_TEXTURES: &str = "light_textures";
const SHAPES: &str = "shapes";

/// The bindings that lights need, of those that may have nothing.
pub(super) fn needed(lights: LightSummary) -> Vec<&'static str> {
    let images = lights.effects.intersects(Effects::IMAGES).then_some(LIGHT_TEXTURES);
    let shapes = (lights.shape_count > 0).then_some(SHAPES);
    images.into_iter().chain(shapes).collect()
}

/// The host's resources of one run. Images are read and written by texel; the light textures have a sampler
/// that is the pass's own. Optional resources may be missing; a frame that reads a missing one is refused.
///
/// [`arealight::kernels::SHADE`] says for each what it holds and in which format at least.
/// By default there is none; the pass refuses a set without the seven that are no `Option`.
#[derive(Debug, Clone, Copy, Default)]
pub struct ShadeResources {
    /// The light table, see [`crate::TableImage`].
    pub table: Resource,
    /// [`PackedLights::lights`](arealight::PackedLights::lights). With no lights, bind any buffer of 64 bytes
    /// or more.
    pub lights: Resource,
    /// [`PackedLights::vertices`](arealight::PackedLights::vertices); with no lights, any buffer of 64 bytes
    /// or more.
    pub light_vertices: Resource,
    /// [`PackedLights::shapes`](arealight::PackedLights::shapes); `None` if no frame has disks, spheres or
    /// tubes.
    pub shapes: Option<Resource>,
    /// The lights' textures ([`crate::LightTextures`]), a 2D array. The caller must have uploaded every
    /// referenced layer. `None` if no frame has textured lights.
    pub light_textures: Option<Resource>,
    /// Positions or depth, by [`ShadeOptions::from_depth`].
    pub position: Resource,
    /// Normal and roughness: this and the next two by [`ShadeOptions::g_buffer`].
    pub normal: Resource,
    /// Base colour and metalness.
    pub base_color: Resource,
    /// Dielectric reflectance, or the third image of another layout; none without
    /// [`ShadeOptions::reads_specular`].
    pub specular: Option<Resource>,
    /// Coats: weight, roughness and normal; none without [`ShadeOptions::reads_coat`].
    pub coat: Option<Resource>,
    /// Sheen: colour and roughness; none without [`ShadeOptions::reads_sheen`].
    pub sheen: Option<Resource>,
    /// Second roughnesses: tangent, roughness along it, diffuse roughness; none without
    /// [`ShadeOptions::reads_anisotropy`].
    pub anisotropy: Option<Resource>,
    /// Thin films: weight, index of refraction and thickness; none without [`ShadeOptions::reads_film`].
    pub film: Option<Resource>,
    /// Where radiance goes, in the format of [`ShadeOptions::format`]; with [`ShadeOptions::separate_lobes`]
    /// that of the diffuse lobe.
    pub radiance: Resource,
    /// Where the glossy lobe's goes with [`ShadeOptions::separate_lobes`]: another image of that format. Else
    /// none.
    pub glossy: Option<Resource>,
    /// With [`ShadeOptions::shadow_rays`], a buffer of [`crate::ShadePass::picks_size`] bytes, which the pass
    /// writes and a [`crate::ShadowPass`] reads. Else none.
    pub picks: Option<Resource>,
    /// Stencils, in the aspect of stencils or an image of unsigned integers, for each texel of the G-buffer;
    /// none without [`ShadeOptions::stencil`].
    pub stencil: Option<Resource>,
    /// A buffer of [`arealight::gpu::LightCounts`]; none without [`ShadeOptions::light_counts`].
    pub light_counts: Option<Resource>,
    /// With tiles, a buffer of [`arealight::LightTable::lobe_horizons`] of the table. Else none.
    pub lobe_horizons: Option<Resource>,
    /// With tiles, a buffer of [`crate::ShadePass::tile_memory`]. The pass alone writes it; frames that run
    /// at the same time need one each. Else none.
    pub tile_lists: Option<Resource>,
}

impl ShadeResources {
    /// The resources as the kernel's first `bindings` have them, and the bindings of those that are missing:
    /// something stands there in their place.
    pub(super) fn in_order(
        &self,
        options: ShadeOptions,
        has_tiles: bool,
        bindings: usize,
    ) -> Result<(Vec<Resource>, Vec<&'static str>), Error> {
        for (field, resource, is_used, option) in [
            ("specular", self.specular, options.reads_specular(), "reads_specular"),
            ("coat", self.coat, options.reads_coat(), "reads_coat"),
            ("sheen", self.sheen, options.reads_sheen(), "reads_sheen"),
            ("anisotropy", self.anisotropy, options.reads_anisotropy(), "reads_anisotropy"),
            ("film", self.film, options.reads_film(), "reads_film"),
            ("picks", self.picks, options.shadow_rays > 0, "shadow_rays"),
            ("stencil", self.stencil, options.stencil, "stencil"),
            ("light_counts", self.light_counts, options.light_counts, "light_counts"),
        ] {
            if is_used && resource.is_none() {
                let message = format!("is missing, but the pass uses it: see ShadeOptions::{option}");
                return Err(Error::InvalidArgument { field, message });
            }
        }
        let textures_place = match self.table {
            Resource::SampledImage { view, layout } => Resource::FilteredImage { view, layout },
            other => other,
        };
        let mut all = vec![
            self.table,
            self.lights,
            self.light_vertices,
            self.position,
            self.normal,
            self.base_color,
            self.specular.unwrap_or(self.base_color),
            self.radiance,
            self.light_textures.unwrap_or(textures_place),
            self.shapes.unwrap_or(self.lights),
            self.glossy_image(options)?,
            self.coat.unwrap_or(self.base_color),
            self.sheen.unwrap_or(self.base_color),
            self.anisotropy.unwrap_or(self.base_color),
            self.film.unwrap_or(self.base_color),
            self.picks.unwrap_or(self.lights),
            self.stencil.unwrap_or(self.base_color),
        ];
        if has_tiles || options.light_counts {
            all.push(self.light_counts.unwrap_or(self.lights));
        }
        if has_tiles {
            for (resource, field) in [(self.tile_lists, TILE_LISTS), (self.lobe_horizons, LOBE_HORIZONS)] {
                let message = "is missing, but the pass was made with tiles".into();
                all.push(resource.ok_or(Error::InvalidArgument { field, message })?);
            }
        }
        // A whole module has bindings that no frame of this pass uses
        all.resize(bindings, self.lights);
        let absent = [(LIGHT_TEXTURES, self.light_textures.is_none()), (SHAPES, self.shapes.is_none())];
        let absent = absent.into_iter().filter_map(|(name, is_absent)| is_absent.then_some(name)).collect();
        Ok((all, absent))
    }

    /// What is bound for the glossy lobe's radiance: where there is one image, that again.
    fn glossy_image(&self, options: ShadeOptions) -> Result<Resource, Error> {
        let wrong = |message: &str| Error::InvalidArgument { field: "glossy", message: message.into() };
        match (options.separate_lobes, self.glossy) {
            (false, _) => Ok(self.radiance),
            (true, None) => {
                Err(wrong("is missing, but the pass stores the lobes' radiance to an image each"))
            }
            (true, Some(glossy)) if glossy.view() == self.radiance.view() => {
                Err(wrong("is the image of `radiance`; each lobe's radiance needs its own"))
            }
            (true, Some(glossy)) => Ok(glossy),
        }
    }
}

/// How the pass uses a resource of the host, so that the host can place its barriers. Layouts are left as
/// they were found; the pass makes no barrier for host resources.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceAccess {
    /// The binding's name in the manifest.
    pub name: &'static str,
    /// The stage that uses it.
    pub stage: vk::PipelineStageFlags,
    /// What it does there.
    pub access: vk::AccessFlags,
    /// The layout that an image must have; `UNDEFINED` for a buffer, and for a sampled image, whose layout
    /// the host states in its [`Resource`].
    pub layout: vk::ImageLayout,
}

/// How `kernel` uses each of its bindings.
pub(crate) fn accesses_of(kernel: &Kernel) -> Vec<ResourceAccess> {
    let used = kernel.bindings.iter().filter(|binding| binding.access != Access::None);
    let accesses = used.map(|binding| ResourceAccess {
        name: binding.name,
        stage: vk::PipelineStageFlags::COMPUTE_SHADER,
        access: match binding.access {
            Access::Read => vk::AccessFlags::SHADER_READ,
            Access::Write => vk::AccessFlags::SHADER_WRITE,
            Access::ReadWrite => vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE,
            Access::None => vk::AccessFlags::empty(),
        },
        layout: match binding.kind {
            BindingKind::StorageImage => vk::ImageLayout::GENERAL,
            _ => vk::ImageLayout::UNDEFINED,
        },
    });
    accesses.collect()
}
