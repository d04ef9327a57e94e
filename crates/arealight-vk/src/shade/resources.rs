//! The host's images and buffers that a shade pass reads and writes.

use crate::error::Error;
use crate::resource::Resource;
use arealight::kernels::{Access, Binding, BindingKind, Kernel};
use arealight::plan::ShadeOptions;
use arealight::{Effects, LightSummary, Plane, Planes};
use ash::vk;

/// The names of bindings that options ask for.
pub(super) const LIGHT_COUNTS: &str = "light_counts";
/// And of those of tiles.
pub(super) const TILE_LISTS: &str = "tile_lists";
pub(super) const LOBE_HORIZONS: &str = "lobe_horizons";

/// The names of bindings that may have nothing.
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
/// By default there is none; the pass refuses a set without those that are no `Option`, and without a plane
/// that it reads.
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
    /// The G-buffer: each plane that [`ShadeOptions::reads`], see [`Plane::content`].
    pub planes: Planes<Option<Resource>>,
    /// Where radiance goes, in the format of [`ShadeOptions::format`]; with [`ShadeOptions::separate_lobes`]
    /// that of the diffuse lobe.
    pub radiance: Resource,
    /// Where the glossy lobe's goes with [`ShadeOptions::separate_lobes`]: another image of that format. Else
    /// none.
    pub glossy: Option<Resource>,
    /// With [`ShadeOptions::shadow_rays`], a buffer of [`crate::ShadePass::picks_size`] bytes, which the pass
    /// writes and a [`crate::ShadowPass`] reads. Else none.
    pub picks: Option<Resource>,
    /// A buffer of [`arealight::gpu::LightCounts`]; none without [`ShadeOptions::light_counts`].
    pub light_counts: Option<Resource>,
    /// With tiles, a buffer of [`arealight::LightTable::lobe_horizons`] of the table. Else none.
    pub lobe_horizons: Option<Resource>,
    /// With tiles, a buffer of [`crate::ShadePass::tile_memory`]. The pass alone writes it; frames that run
    /// at the same time need one each. Else none.
    pub tile_lists: Option<Resource>,
}

impl ShadeResources {
    /// What is bound by a name of the GLSL.
    fn bound_at(&self, name: &str) -> Option<Resource> {
        match name {
            "table_image" => Some(self.table),
            "lights" => Some(self.lights),
            "light_vertices" => Some(self.light_vertices),
            SHAPES => self.shapes,
            LIGHT_TEXTURES => self.light_textures,
            "radiance_image" | "unshadowed_image" => Some(self.radiance),
            "glossy_image" => self.glossy,
            "shadow_picks" => self.picks,
            LIGHT_COUNTS => self.light_counts,
            LOBE_HORIZONS => self.lobe_horizons,
            TILE_LISTS => self.tile_lists,
            _ => Plane::bound_at(name).and_then(|plane| self.planes[plane]),
        }
    }

    /// What is at a binding; something that stands there in the place of what is missing, and not read.
    pub(crate) fn at(&self, binding: &Binding) -> Resource {
        self.bound_at(binding.name).unwrap_or(match binding.kind {
            BindingKind::SampledImage => self.planes[Plane::BaseColor].unwrap_or_default(),
            BindingKind::StorageImage => self.radiance,
            BindingKind::StorageBuffer => self.lights,
            BindingKind::FilteredImage => match self.table {
                Resource::SampledImage { view, layout } => Resource::FilteredImage { view, layout },
                other => other,
            },
        })
    }

    /// The resources as `bindings` have them, and the bindings of those that frames may need and have not.
    pub(super) fn in_order(
        &self,
        options: ShadeOptions,
        has_tiles: bool,
        bindings: &[Binding],
    ) -> Result<(Vec<Resource>, Vec<&'static str>), Error> {
        self.check_planes(|plane| options.reads(plane))?;
        self.check_glossy(options)?;
        for (field, resource, is_used, why) in [
            ("picks", self.picks, options.shadow_rays > 0, "the pass uses it: see ShadeOptions::shadow_rays"),
            (
                LIGHT_COUNTS,
                self.light_counts,
                options.light_counts,
                "the pass uses it: see ShadeOptions::light_counts",
            ),
            (TILE_LISTS, self.tile_lists, has_tiles, "the pass was made with tiles"),
            (LOBE_HORIZONS, self.lobe_horizons, has_tiles, "the pass was made with tiles"),
        ] {
            if is_used && resource.is_none() {
                let message = format!("is missing, but {why}");
                return Err(Error::InvalidArgument { field, message });
            }
        }
        let all = bindings.iter().map(|binding| self.at(binding)).collect();
        Ok((all, self.absent(bindings)))
    }

    /// Of `bindings` those that some frames need, and that are missing.
    pub(crate) fn absent(&self, bindings: &[Binding]) -> Vec<&'static str> {
        let missing = |binding: &Binding| {
            [LIGHT_TEXTURES, SHAPES].contains(&binding.name) && self.bound_at(binding.name).is_none()
        };
        bindings.iter().filter(|binding| missing(binding)).map(|binding| binding.name).collect()
    }

    /// Refuses a G-buffer without a plane that is read.
    pub(crate) fn check_planes(&self, reads: impl Fn(Plane) -> bool) -> Result<(), Error> {
        match self.planes.iter().find(|(plane, resource)| resource.is_none() && reads(*plane)) {
            None => Ok(()),
            Some((plane, _)) => {
                let message = "is missing, but the pass reads it: see ShadeOptions::reads".into();
                Err(Error::InvalidArgument { field: plane.name(), message })
            }
        }
    }

    /// What is bound for the glossy lobe's radiance is an image of its own, where there is one.
    fn check_glossy(&self, options: ShadeOptions) -> Result<(), Error> {
        let message = match self.glossy {
            _ if !options.separate_lobes => return Ok(()),
            None => "is missing, but the pass stores the lobes' radiance to an image each",
            Some(glossy) if glossy.view() == self.radiance.view() => {
                "is the image of `radiance`; each lobe's radiance needs its own"
            }
            Some(_) => return Ok(()),
        };
        Err(Error::InvalidArgument { field: "glossy", message: message.into() })
    }
}

/// How the pass uses a resource of the host, so that the host can place its barriers. Layouts are left as
/// they were found; the pass makes no barrier for host resources.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceAccess {
    /// The binding's name in the GLSL.
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
    let used = kernel.bindings().iter().filter(|binding| binding.access != Access::None);
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
