//! Which kernel runs, specialised how: a pass described without Vulkan, for the
//! recorder of this project or for one of your own.

use crate::kernels;
pub use crate::output::{Output, RadianceFormat};
use crate::planes::Plane;
use crate::tiles::{self, TileClass};
use crate::{Effects, LightSummary, Quality};

/// What the images at the bindings `g_normal`, `g_base_color` and `g_specular` hold of a surface. Base
/// colours are linear when they are read: in images of sRGB formats they are stored as sRGB. The other planes
/// are alike in every layout. A G-buffer of any other layout is read by a bridge function in GLSL of the
/// host's (docs/embed-glsl.md).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum GBufferLayout {
    /// Normal in xyz, of any length, and perceptual roughness; base colour and metalness; with
    /// [`Effects::SPECULAR_INPUT`] dielectric F0 in rgb and F90.
    #[default]
    Arealight = 0,
    /// Of Unreal Engine, for surfaces of its default shading model: `GBufferA` (normal, times 0.5, plus 0.5),
    /// `GBufferC` (base colour) and `GBufferB` (metallic, specular, roughness). Dielectric F0 is 0.08 ×
    /// specular.
    Unreal = 1,
    /// Of Unity's Universal Render Pipeline, for metallic materials, without its option Accurate G-buffer
    /// normals: `GBuffer2` (normal, smoothness), `GBuffer0` (albedo) and `GBuffer1` (reflectivity).
    /// Dielectric F0 is 0.04.
    Unity = 2,
    /// Of engines that store directions on an octahedron and materials as glTF does: a signed place on the
    /// octahedron in xy; base colour in rgb; occlusion, which is not used, roughness and metalness.
    /// Dielectric F0 is 0.04.
    Octahedral = 3,
}

/// Options fixed at pipeline creation.
#[expect(clippy::struct_excessive_bools, reason = "each is an option of its own")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ShadeOptions {
    /// What the host's surfaces need, of [`Effects::SURFACES`]; light bits are ignored, since they come from
    /// [`LightSummary`].
    pub surfaces: Effects,
    /// The quality level.
    pub quality: Quality,
    /// If true, `g_position` is the depth buffer as stored, reversed or not: exactly 0 or 1 is background.
    /// Else it holds positions relative to the origin, with w = 0 for background.
    pub from_depth: bool,
    /// How surfaces are stored.
    pub g_buffer: GBufferLayout,
    /// Overwrite or add.
    pub output: Output,
    /// Whether the diffuse and the glossy lobe's radiance go to an image each, for what treats them apart
    /// (denoisers, skin, fog), or their sum to one.
    pub separate_lobes: bool,
    /// Their format.
    pub format: RadianceFormat,
    /// How many shadow rays a pixel has, at most [`ShadeOptions::MOST_SHADOW_RAYS`]: the shade kernel picks a
    /// light and a lobe for each. 0: no shadows, and no code for them.
    pub shadow_rays: u32,
    /// Whether the camera is orthographic: `ShadeFrame::camera` is the direction to it then.
    pub orthographic: bool,
    /// Whether frames are rectangles of larger images, each from `ShadeFrame::offset` on: views side by side,
    /// an atlas. Without shadow rays.
    pub rectangle: bool,
    /// How many texels of the G-buffer a pixel of radiance has to a side, from 1 to
    /// [`ShadeOptions::MOST_TEXELS_PER_PIXEL`]; of them the first is shaded. 2 is half resolution. Without
    /// shadow rays, unless it is 1.
    pub texels_per_pixel: u32,
    /// How many samples the texels of the G-buffer have: 1, 2, 4 or 8, in Vulkan's standard places. A pixel's
    /// radiance is the mean over its samples; samples with the same surface in the same plane are shaded
    /// once; `a` is the part that has a surface. Without shadow rays and half resolution, unless it is
    /// 1.
    pub samples: u32,
    /// Whether frames have a stencil test: pixels that fail it stay as they are, with either [`Output`].
    /// Without shadow rays.
    pub stencil: bool,
    /// Whether the number of lights is read from a buffer, [`LightCounts`](crate::gpu::LightCounts), when the
    /// commands run: for lights that the GPU culled or made. What [`LightSummary`] says is the most then.
    /// Costs a storage buffer more.
    pub light_counts: bool,
}

impl Default for ShadeOptions {
    /// Both lobes, at the exact level; positions from an image, dielectrics of F0 = 0.04, overwriting one
    /// image of 32-bit floats.
    fn default() -> Self {
        Self {
            surfaces: Effects::DIFFUSE | Effects::GLOSSY,
            quality: Quality::default(),
            from_depth: false,
            g_buffer: GBufferLayout::default(),
            output: Output::default(),
            separate_lobes: false,
            format: RadianceFormat::default(),
            shadow_rays: 0,
            orthographic: false,
            rectangle: false,
            texels_per_pixel: 1,
            samples: 1,
            stencil: false,
            light_counts: false,
        }
    }
}

impl ShadeOptions {
    /// The most shadow rays of a pixel.
    pub const MOST_SHADOW_RAYS: u32 = 4;

    /// The most texels of the G-buffer to a pixel's side.
    pub const MOST_TEXELS_PER_PIXEL: u32 = 16;

    /// The effects of a pipeline: what surfaces need, and `lights`.
    pub fn effects(self, lights: LightSummary) -> Effects {
        let surfaces = self.surfaces & Effects::SURFACES;
        let unlinked = Effects::LINKED - lights.effects;
        (surfaces - unlinked) | (lights.effects - Effects::SURFACES)
    }

    /// Whether a plane is read. [`Plane::Motion`] is by shadows alone, whose options are not these.
    pub fn reads(self, plane: Plane) -> bool {
        match plane {
            Plane::Position | Plane::Normal | Plane::BaseColor => true,
            Plane::Specular if self.g_buffer != GBufferLayout::Arealight => true,
            Plane::Stencil => self.stencil || self.surfaces.contains(Effects::LINKED),
            _ => self.surfaces.intersects(plane.effects()),
        }
    }

    /// [`ShadeOptions::output`], [`ShadeOptions::separate_lobes`] and [`ShadeOptions::format`] as the bits
    /// `OUTPUT_*`.
    pub fn output_bits(self) -> u32 {
        self.output as u32 | u32::from(self.separate_lobes) << 1 | self.format as u32
    }

    /// [`ShadeOptions::orthographic`], [`ShadeOptions::rectangle`], [`ShadeOptions::stencil`] and
    /// [`ShadeOptions::texels_per_pixel`] as the bits `VIEW_*`.
    pub fn view_bits(self) -> u32 {
        u32::from(self.orthographic)
            | u32::from(self.rectangle) << 1
            | u32::from(self.stencil) << 2
            | self.texels_per_pixel.saturating_sub(1) << 8
    }
}

/// The values of the shade kernel's specialisation constants, for a frame's lights: what none of them needs
/// is not in the pipeline.
pub fn shade_specialization(options: ShadeOptions, lights: LightSummary) -> Vec<(u32, u32)> {
    specialization_of_class(options, lights, tiles::NO_CLASS)
}

/// Likewise, for the tiles of a class in a frame of these lights.
pub fn shade_tiles_specialization(
    options: ShadeOptions,
    lights: LightSummary,
    class: TileClass,
) -> Vec<(u32, u32)> {
    specialization_of_class(options, class.lights(lights), class as u32)
}

fn specialization_of_class(options: ShadeOptions, lights: LightSummary, class: u32) -> Vec<(u32, u32)> {
    let mut values = lobe_specialization(options.effects(lights), options.quality);
    values.extend([
        (kernels::constant::POSITION_SOURCE, u32::from(options.from_depth)),
        (kernels::constant::OUTPUT, options.output_bits()),
        (kernels::constant::LAYOUT, options.g_buffer as u32),
        (kernels::constant::FOOTPRINT, options.quality.footprint as u32),
        (kernels::constant::HAS_QUADS, u32::from(lights.quad_count > 0)),
        (kernels::constant::CLASS, class),
        (kernels::constant::SHADOW_RAYS, options.shadow_rays),
        (kernels::constant::VIEW, options.view_bits()),
        (kernels::constant::LIGHT_COUNTS, u32::from(options.light_counts)),
        (kernels::constant::SAMPLES, options.samples),
    ]);
    values
}

/// How tiles get their lists of lights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileOptions {
    /// The most lights, of all kinds, that a tile's list holds, from 1 on: a tile that more lights contribute
    /// to is shaded by all of the frame's.
    pub capacity: u32,
    /// Lights are culled from a tile that together contribute less than this fraction of what its other
    /// lights do, to the radiance of each of its pixels, in the sum of the channels; in [0, 1). With 0 only
    /// lights that contribute nothing are left out.
    pub cull_threshold: f32,
    /// Frames of fewer lights than this, all of them convex quads without a texture, are shaded without
    /// tiles: to classify them would take longer than it could save (docs/tiles.md). With 0 every frame is
    /// classified.
    pub least_quads: u32,
}

impl TileOptions {
    /// Whether the tiles of a frame of these lights are classified.
    pub fn classifies(self, lights: LightSummary) -> bool {
        lights.light_count >= self.least_quads || lights.has_polygons() || lights.shape_count > 0
    }
}

impl Default for TileOptions {
    /// Lists of 128 lights, no culling of lights that contribute; frames of four quads and more are
    /// classified.
    fn default() -> Self {
        Self { capacity: 128, cull_threshold: 0.0, least_quads: 4 }
    }
}

/// What the mean of a pixel's shadow rays becomes before it is multiplied with the unshadowed radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum ShadowFilter {
    /// Nothing: unbiased, with noise in penumbras.
    Off = 0,
    /// A mean over neighbours in the same plane, as wide as a fifth of the penumbra and at least two pixels.
    #[default]
    Gather = 1,
}

/// Over which frames a pixel's shadow rays are a mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum ShadowHistory {
    /// One frame's.
    #[default]
    Off = 0,
    /// Up to sixteen frames', as long as what rays find does not change: pixels are found again by the
    /// camera's motion alone.
    Camera = 1,
    /// Likewise, found again by motion vectors of the host's.
    MotionVectors = 2,
}

/// Bytes of the buffer of what shadow rays are picked for, for images of `size` pixels: a word of each pixel,
/// and two of each of its `rays`; 0 without rays.
pub fn shadow_picks_size(rays: u32, size: [u32; 2]) -> u64 {
    let words = if rays == 0 { 0 } else { 1 + 2 * u64::from(rays) };
    size.map(u64::from).iter().product::<u64>().saturating_mul(4 * words)
}

/// Words at the beginning of the buffer that keeps shadows from frame to frame: for frames of even and of odd
/// seeds a half each.
pub const SHADOW_HISTORY_HEAD: usize = 40;
/// Words of a pixel in that buffer, of one frame; it has two.
pub const SHADOW_HISTORY_PIXEL: usize = 10;

/// Bytes of the buffer that keeps shadows from frame to frame, for images of `size` pixels. It holds zeros
/// before the first frame.
pub fn shadow_history_size(size: [u32; 2]) -> u64 {
    let pixels: u64 = size.map(u64::from).iter().product();
    pixels.saturating_mul(8 * SHADOW_HISTORY_PIXEL as u64).saturating_add(4 * SHADOW_HISTORY_HEAD as u64)
}

/// The values of the constants of the kernel [`kernels::SHADOW_HISTORY`].
pub fn shadow_history_specialization(options: ShadeOptions, history: ShadowHistory) -> Vec<(u32, u32)> {
    let mut values = shadow_specialization(options, options.surfaces & Effects::SURFACES);
    values.push((kernels::constant::SHADOW_MOTION, u32::from(history == ShadowHistory::MotionVectors)));
    values
}

/// The values of the constants of the kernel [`kernels::SHADOW_RAYS`], for a frame's lights: what none of
/// them needs is not in the pipeline.
pub fn shadow_rays_specialization(options: ShadeOptions, lights: LightSummary) -> Vec<(u32, u32)> {
    shadow_specialization(options, options.effects(lights))
}

/// The values of the constants that every kernel of shadows has.
fn shadow_specialization(options: ShadeOptions, effects: Effects) -> Vec<(u32, u32)> {
    vec![
        (kernels::constant::EFFECTS, effects.bits()),
        (kernels::constant::POSITION_SOURCE, u32::from(options.from_depth)),
        (kernels::constant::HORIZON, options.quality.horizon as u32),
        (kernels::constant::SPECULAR_LOBES, options.quality.specular_lobes as u32),
        (kernels::constant::LOBES, options.quality.lobes as u32),
        (kernels::constant::LAYOUT, options.g_buffer as u32),
        (kernels::constant::SHADOW_RAYS, options.shadow_rays),
        (kernels::constant::VIEW, options.view_bits()),
    ]
}

/// The values of the constants of the kernel [`kernels::SHADOW_FILTER`], which stores by `output` in the
/// format of `options`.
pub fn shadow_filter_specialization(
    options: ShadeOptions,
    filter: ShadowFilter,
    history: ShadowHistory,
    output: Output,
) -> Vec<(u32, u32)> {
    let mut values = shadow_specialization(options, options.surfaces & Effects::SURFACES);
    values.extend([
        (kernels::constant::OUTPUT, output as u32 | options.format as u32),
        (kernels::constant::SHADOW_FILTER, filter as u32),
        (kernels::constant::SHADOW_HISTORY, u32::from(history != ShadowHistory::Off)),
    ]);
    values
}

/// How a medium is shaded.
#[expect(clippy::struct_excessive_bools, reason = "each is an option of its own")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MediumOptions {
    /// Whether each sample has a ray over each light, which asks for what blocks it; else light passes
    /// through everything, or the host's module says what arrives.
    pub shadow_rays: bool,
    /// Whether a sample has one ray alone instead, over a light that is drawn by how much of it is scattered
    /// there. For hosts that filter over frames.
    pub one_light: bool,
    /// At how many points of a froxel light is scattered, each with rays of its own. From 1, as which 0
    /// counts, to [`MediumOptions::MOST_SAMPLES`].
    pub samples: u32,
    /// Whether scattering and extinction come from an image, a texel a froxel; else they are the frame's.
    pub by_image: bool,
    /// Whether a froxel's distance is drawn within it, by the frame's seed; else it is its middle.
    pub jitter: bool,
    /// Whether froxels that surfaces hide from every pixel are filled, too: for hosts that record the first
    /// stage before positions are there. Else they hold nothing, and [`Plane::Position`] has the picture's
    /// size.
    pub fill_hidden: bool,
    /// Frames of fewer lights have no lists: to make them would take longer than it could save
    /// (docs/media.md).
    pub least_lights: u32,
    /// As [`ShadeOptions::from_depth`], of the surfaces that the medium is before.
    pub from_depth: bool,
    /// The format of the radiance that it is put before.
    pub format: RadianceFormat,
    /// Of it the form factor and how images are looked up.
    pub quality: Quality,
}

impl MediumOptions {
    /// The most [`MediumOptions::samples`].
    pub const MOST_SAMPLES: u32 = 64;
}

impl Default for MediumOptions {
    fn default() -> Self {
        Self {
            shadow_rays: false,
            one_light: false,
            samples: 1,
            by_image: false,
            jitter: false,
            fill_hidden: false,
            least_lights: 32,
            from_depth: false,
            format: RadianceFormat::default(),
            quality: Quality::default(),
        }
    }
}

/// The values of the constants of [`kernels::MEDIUM_SCATTER`], for a frame's lights.
pub fn medium_scatter_specialization(options: MediumOptions, lights: LightSummary) -> Vec<(u32, u32)> {
    let rays = if options.one_light { 1 } else { 2 };
    let has_lists = lights.light_count.saturating_add(lights.shape_count) >= options.least_lights;
    vec![
        (kernels::constant::EFFECTS, lights.effects.bits()),
        (kernels::constant::FOOTPRINT, options.quality.footprint as u32),
        (kernels::constant::HAS_QUADS, u32::from(lights.quad_count > 0)),
        (kernels::constant::MEDIUM_RAYS, if options.shadow_rays { rays } else { 0 }),
        (kernels::constant::MEDIUM_IMAGE, u32::from(options.by_image)),
        (kernels::constant::MEDIUM_JITTER, u32::from(options.jitter)),
        (kernels::constant::MEDIUM_SAMPLES, options.samples.max(1)),
        (kernels::constant::MEDIUM_LISTS, u32::from(has_lists)),
        (kernels::constant::MEDIUM_HIDDEN, u32::from(options.fill_hidden)),
    ]
}

/// The values of the constants of [`kernels::MEDIUM_HIDE`].
pub fn medium_hide_specialization(options: MediumOptions) -> Vec<(u32, u32)> {
    vec![(kernels::constant::POSITION_SOURCE, u32::from(options.from_depth))]
}

/// The values of the constants of [`kernels::MEDIUM_COMPOSE`].
pub fn medium_compose_specialization(options: MediumOptions) -> Vec<(u32, u32)> {
    let mut values = medium_hide_specialization(options);
    values.push((kernels::constant::OUTPUT, options.format as u32));
    values
}

/// The values of the classify kernel's specialisation constants, for the lights of a frame.
pub fn classify_specialization(
    options: ShadeOptions,
    lights: LightSummary,
    tiles: TileOptions,
) -> Vec<(u32, u32)> {
    vec![
        (kernels::constant::EFFECTS, options.effects(lights).bits()),
        (kernels::constant::POSITION_SOURCE, u32::from(options.from_depth)),
        (kernels::constant::HORIZON, options.quality.horizon as u32),
        (kernels::constant::SPECULAR_LOBES, options.quality.specular_lobes as u32),
        (kernels::constant::LOBES, options.quality.lobes as u32),
        (kernels::constant::LAYOUT, options.g_buffer as u32),
        (kernels::constant::CULL, u32::from(tiles.cull_threshold > 0.0)),
        (kernels::constant::VIEW, options.view_bits()),
        (kernels::constant::LIGHT_COUNTS, u32::from(options.light_counts)),
        (kernels::constant::SAMPLES, options.samples),
    ]
}

/// The values of the constants that every kernel has that integrates lobes over lights.
fn lobe_specialization(effects: Effects, quality: Quality) -> Vec<(u32, u32)> {
    vec![
        (kernels::constant::EFFECTS, effects.bits()),
        (kernels::constant::HORIZON, quality.horizon as u32),
        (kernels::constant::SPECULAR_LOBES, quality.specular_lobes as u32),
        (kernels::constant::LOBES, quality.lobes as u32),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(light_count: u32, quad_count: u32, shape_count: u32) -> LightSummary {
        LightSummary { light_count, quad_count, shape_count, ..LightSummary::default() }
    }

    #[test]
    fn a_pipeline_has_what_surfaces_and_lights_need() {
        let options = ShadeOptions::default();
        let lobes = Effects::DIFFUSE | Effects::GLOSSY;
        let lights = |effects| LightSummary { effects, ..counts(3, 1, 2) };
        assert_eq!(options.effects(lights(Effects::SPHERE)), lobes | Effects::SPHERE);
        // Neither has a say in what is the other's
        assert_eq!(options.effects(lights(Effects::SPECULAR_INPUT)), lobes);
        let all = ShadeOptions { surfaces: Effects::all(), ..options };
        // But for links, which both have
        assert_eq!(all.effects(lights(Effects::empty())), Effects::SURFACES - Effects::LINKED);
        assert_eq!(all.effects(lights(Effects::LINKED)), Effects::SURFACES);
        assert_eq!(options.effects(lights(Effects::LINKED)), lobes);
        assert!(all.reads(Plane::Specular) && !options.reads(Plane::Specular));
        let has_quads = |lights| {
            let values = shade_specialization(options, lights);
            values.iter().find(|(id, _)| *id == kernels::constant::HAS_QUADS).map(|(_, value)| *value)
        };
        assert_eq!([counts(3, 1, 0), counts(3, 0, 0)].map(has_quads), [Some(1), Some(0)]);
    }

    #[test]
    fn shadow_rays_have_the_kinds_of_the_frames_lights() {
        let options = ShadeOptions { shadow_rays: 1, ..ShadeOptions::default() };
        let effects = |values: Vec<(u32, u32)>| {
            values.into_iter().find(|(id, _)| *id == kernels::constant::EFFECTS).map(|(_, value)| value)
        };
        for kinds in [Effects::empty(), Effects::SPHERE, Effects::POLYGON | Effects::MESH] {
            let lights = LightSummary { effects: kinds, ..counts(3, 1, 2) };
            let shade = effects(shade_specialization(options, lights));
            assert_eq!(effects(shadow_rays_specialization(options, lights)), shade);
            // What comes after the rays does not differ by lights
            let history = shadow_history_specialization(options, ShadowHistory::Camera);
            assert_eq!(effects(history), Some(options.surfaces.bits()));
        }
    }

    #[test]
    fn groups_cover_every_pixel() {
        assert_eq!(kernels::SHADE.groups_for([17, 8, 1]), [3, 1, 1]);
    }

    #[test]
    fn frames_of_few_quads_and_nothing_else_are_not_classified() {
        let tiles = TileOptions::default();
        assert!(!tiles.classifies(counts(0, 0, 0)) && !tiles.classifies(counts(3, 3, 0)));
        assert!(tiles.classifies(counts(4, 4, 0)));
        assert!(tiles.classifies(counts(1, 0, 0)), "an outline");
        assert!(tiles.classifies(counts(1, 1, 1)), "a shape");
        assert!(TileOptions { least_quads: 0, ..tiles }.classifies(counts(0, 0, 0)));
    }
}
