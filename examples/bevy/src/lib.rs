//! Area lights of any shape for Bevy's deferred renderer, by linearly transformed cosines.
//!
//! [`AreaLightPlugin`] adds what [`AreaLight`]s reflect from surfaces to what Bevy lit them with, before
//! transparent things are drawn and colours are mapped for the display. Its kernel is that of `arealight
//! export --target webgpu`, made at run time for the effects that the lights have; table and kernel are in
//! the crates.
//!
//! | module | holds |
//! |---|---|
//! | `light` | the component, and how it moves |
//! | `extract` | lights on their way to the render world |
//! | `images` | images on lights |
//! | `pipelines` | what the GPU runs, and its layouts |
//! | `views` | what each camera needs of it in a frame |

mod extract;
mod images;
mod light;
mod pipelines;
mod views;

pub use arealight;
pub use arealight::{Effects, Level, LightShape, Opening, Profile, Quality, TubeEnds};
pub use light::AreaLight;

use bevy::core_pipeline::core_3d::main_opaque_pass_3d;
use bevy::core_pipeline::schedule::{Core3d, Core3dSystems, camera_driver};
use bevy::pbr::deferred::deferred_lighting;
use bevy::prelude::*;
use bevy::render::renderer::RenderGraph;
use bevy::render::{ExtractSchedule, Render, RenderApp, RenderStartup, RenderSystems};

/// Shades what cameras see by [`AreaLight`]s. Add it after Bevy's own plugins.
///
/// A camera needs `Hdr`, `DepthPrepass` and `DeferredPrepass`, and surfaces need to be opaque and deferred
/// (`DefaultOpaqueRendererMethod::deferred()`). A warning names what a camera lacks, once.
#[derive(Debug, Clone, Copy)]
pub struct AreaLightPlugin {
    /// What surfaces have, of [`Effects::SURFACES`]: without `COAT` clear coats are not shaded, in less time.
    pub surfaces: Effects,
    /// How exact it is: [`Level::quality`].
    pub quality: Quality,
    /// What lights will have ([`arealight::Light::effects`]): a kernel with it is made for the first light.
    /// Else one is made when a light has what no light before it had; meanwhile nothing is shaded.
    pub lights: Effects,
}

impl Default for AreaLightPlugin {
    /// All that Bevy stores of a surface: both lobes, reflectance and clear coat; the exact level.
    fn default() -> Self {
        let lobes = Effects::DIFFUSE | Effects::GLOSSY;
        Self {
            surfaces: lobes | Effects::SPECULAR_INPUT | Effects::COAT,
            quality: Quality::default(),
            lights: Effects::empty(),
        }
    }
}

impl Plugin for AreaLightPlugin {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        let effects = (self.surfaces & Effects::SURFACES) | (self.lights - Effects::SURFACES);
        render_app
            .init_resource::<extract::ExtractedLights>()
            .insert_resource(pipelines::Needed { effects, quality: self.quality })
            .add_systems(RenderStartup, pipelines::make)
            .add_systems(ExtractSchedule, extract::extract)
            .add_systems(Render, images::prepare.in_set(RenderSystems::PrepareResources))
            .add_systems(Render, views::prepare.in_set(RenderSystems::PrepareBindGroups))
            .add_systems(RenderGraph, images::draw.before(camera_driver))
            .add_systems(
                Core3d,
                views::shade
                    .after(deferred_lighting)
                    .before(main_opaque_pass_3d)
                    .in_set(Core3dSystems::MainPass),
            );
    }
}
