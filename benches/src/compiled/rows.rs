//! The shaders whose statistics are read: kernel x lights x quality level.
//!
//! Another row is a line in [`rows`].

use crate::ladder::methods::SHADE_YARDSTICK;
use crate::school::School;
use arealight::kernels::{self, BindingKind, Kernel};
use arealight::plan::{
    self, MediumOptions, Output, RadianceFormat, ShadeOptions, ShadowFilter, ShadowHistory, TileOptions,
};
use arealight::{Effects, Footprint, Horizon, Level, LightSummary, Lobes, Quality, SpecularLobes, TileClass};
use arealight_engine::host::null_hardware::ComputeShader;
use arealight_vk::prune;
use ash::vk;

/// What rows of the shade kernel are held against: quads by the clipless method, in a kernel of the same
/// branches and loops, that reads lights, surfaces and the table as the shade kernel does.
pub const YARDSTICK: &str = "shade_yardstick: quads, clipless";

/// Likewise of the README's pixel.
pub const DEFERRED_YARDSTICK: &str = "deferred_yardstick: quads, clipless";

const LOBES: Effects = Effects::DIFFUSE.union(Effects::GLOSSY);
const COATS: Effects = Effects::COAT.union(Effects::COAT_NORMAL);

/// The README's pixel: the GLSL library in a deferred engine's own shader.
static DEFERRED: &[u8] = include_bytes!("../../spirv/examples/deferred.spv");

/// The same with the clipless method.
static CLIPLESS: &[u8] = include_bytes!("../../spirv/deferred_yardstick.spv");

/// A shader, specialised.
#[derive(Debug, Clone)]
pub struct Row {
    /// The kernel.
    pub kernel: &'static str,
    /// What it shades with, or works on.
    pub lights: &'static str,
    /// The quality level, lobe or option.
    pub level: &'static str,
    /// The row whose inverse throughput it is held against: one of the same branches and loops, since the
    /// compiler's estimate depends on how deep code lies in them. `None` where there is none.
    pub yardstick: Option<&'static str>,
    source: Source,
}

/// What is compiled.
#[derive(Debug, Clone)]
enum Source {
    /// A kernel with values of its specialisation constants.
    Kernel(&'static Kernel, Vec<(u32, u32)>),
    /// A module with the bindings of shaders/examples/deferred.comp, and values of its specialisation
    /// constants.
    Deferred(&'static [u8], Vec<(u32, u32)>),
}

impl Row {
    /// The row's name, which no other has.
    pub fn name(&self) -> String {
        format!("{}: {}, {}", self.kernel, self.lights, self.level)
    }

    /// What a driver is handed: the module as the recorder prunes it, and its layout.
    pub fn shader(&self) -> ComputeShader {
        match &self.source {
            Source::Kernel(kernel, specialization) => ComputeShader {
                words: prune(&words_of(kernel, specialization), specialization),
                specialization: specialization.clone(),
                bindings: kernel.bindings().iter().map(|one| (one.number, descriptor(one.kind), 1)).collect(),
                push_constant_size: kernel.push_constant_size(),
            },
            Source::Deferred(module, specialization) => ComputeShader {
                words: prune(&words(module), specialization),
                specialization: specialization.clone(),
                bindings: vec![
                    (0, vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 1), // table
                    (1, vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 3), // g_buffer
                    (2, vk::DescriptorType::STORAGE_IMAGE, 1),          // radiance_image
                    (3, vk::DescriptorType::STORAGE_BUFFER, 1),         // Lamps
                ],
                push_constant_size: 16,
            },
        }
    }
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

fn descriptor(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::FilteredImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
    }
}

/// Every row, in the order of the table.
pub fn rows() -> Vec<Row> {
    let mut rows = vec![
        // Others' ways to shade quads, with our reads
        yardstick(School::Clipless),
        yardstick(School::SphereHorizon),
        yardstick(School::ClipByCases),
        // The README's pixel, and the same by another method
        deferred("deferred_yardstick", "clipless", CLIPLESS),
        deferred("deferred", "exact", DEFERRED),
    ];
    rows.extend(quad_rows());
    rows.extend(other_rows());
    rows
}

/// Quads, by quality level and by effect.
fn quad_rows() -> Vec<Row> {
    let exact = Quality::default();
    let both = Quality { horizon: Horizon::Both, ..exact };
    let two_lobes = Quality { specular_lobes: SpecularLobes::Two, ..exact };
    let half_vectors = Quality { specular_lobes: SpecularLobes::HalfVectors, ..exact };
    let formula = Quality { lobes: Lobes::Formula, ..exact };
    vec![
        quads("exact", LOBES, exact),
        quads("both horizons", LOBES, both),
        quads("two specular lobes", LOBES, two_lobes),
        quads("half vectors", LOBES, half_vectors),
        quads("formula", LOBES, formula),
        quads("finest", LOBES, Level::Finest.quality()),
        // Quads, by lobe
        quads("exact, diffuse alone", Effects::DIFFUSE, exact),
        quads("exact, specular alone", Effects::GLOSSY, exact),
        // Quads and nothing else, with more asked of them or of the surface
        shade("two-sided quads", "exact", LOBES | Effects::TWO_SIDED, true, exact),
        quads("exact, F0 from an image", LOBES | Effects::SPECULAR_INPUT, exact),
        // Quads on surfaces whose layers share light
        quads("exact, coupled", LOBES | Effects::COUPLED, exact),
        quads("both horizons, coupled", LOBES | Effects::COUPLED, both),
        quads("exact, coupled by albedo", LOBES | Effects::COUPLED | Effects::COUPLED_BY_ALBEDO, exact),
        quads("exact, all layers by albedo", LOBES | Effects::COAT | Effects::MODEL, exact),
        // Quads on coated surfaces
        quads("exact, coat", LOBES | Effects::COAT, exact),
        quads("exact, coat with its own normal", LOBES | COATS, exact),
        quads("both horizons, coat with its own normal", LOBES | COATS, both),
        quads("half vectors, coat", LOBES | Effects::COAT, half_vectors),
        quads("exact, sheen", LOBES | Effects::SHEEN, exact),
        quads("two specular lobes, sheen", LOBES | Effects::SHEEN, two_lobes),
        quads("exact, anisotropy", LOBES | Effects::ANISOTROPY, exact),
        quads("half vectors, anisotropy", LOBES | Effects::ANISOTROPY, half_vectors),
        quads("exact, thin film", LOBES | Effects::THIN_FILM, exact),
        quads("half vectors, thin film", LOBES | Effects::THIN_FILM, half_vectors),
        quads("exact, multiple scattering", LOBES | Effects::MULTIPLE_SCATTERING, exact),
        quads("exact, linked", LOBES | Effects::LINKED, exact),
        quads("exact, rough diffuse", LOBES | Effects::DIFFUSE_ROUGHNESS, exact),
        quads("exact, transmission (a pass of its own)", Effects::DIFFUSE | Effects::TRANSMISSION, exact),
        quads("exact, glass (a pass of its own)", Effects::GLOSSY | Effects::TRANSMISSION, exact),
    ]
}

/// Other kinds of light, what frames are, tiles and shadows.
fn other_rows() -> Vec<Row> {
    let (exact, none) = (Quality::default(), Effects::empty());
    let both = Quality { horizon: Horizon::Both, ..exact };
    let half_vectors = Quality { specular_lobes: SpecularLobes::HalfVectors, ..exact };
    let mips = Quality { footprint: Footprint::Mips, ..exact };
    let (polygon, mesh) = (Effects::POLYGON, Effects::POLYGON | Effects::MESH);
    // A profile or an opening is what any flat light may have: those that have none don't pay for it
    let every_kind =
        (Effects::all() - Effects::SURFACES - Effects::SHAPED - Effects::AZIMUTH) | Effects::SPECULAR_INPUT;
    let uneven = Effects::PROFILE | Effects::AZIMUTH;
    let (disk, textured_disk) = (Effects::ELLIPSE, Effects::ELLIPSE | Effects::TEXTURED_ELLIPSE);
    vec![
        // Other kinds of light in place of quads
        others("polygons", "exact", polygon, exact),
        others("polygons", "both horizons", polygon, both),
        others("polygons", "half vectors", polygon, half_vectors),
        others("textured quads", "exact", Effects::TEXTURED, exact),
        others("textured quads", "exact, plain mips", Effects::TEXTURED, mips),
        others("meshes", "exact", mesh, exact),
        others("disks", "exact", disk, exact),
        others("textured disks", "exact", textured_disk, exact),
        others("spheres", "exact", Effects::SPHERE, exact),
        others("tubes", "exact", Effects::TUBE, exact),
        others("lights with profiles", "exact", Effects::PROFILE, exact),
        others("lights with profiles that are not round", "exact", uneven, exact),
        others("lights behind openings", "exact", Effects::OPENING, exact),
        others("lights with profiles behind openings", "exact", Effects::SHAPED, exact),
        // Several kinds
        shade("quads and polygons", "exact", LOBES | polygon, true, exact),
        shade("quads and disks", "exact", LOBES | disk, true, exact),
        shade("every kind", "exact", LOBES | every_kind, true, exact),
        shade("every kind", "exact, coat with its own normal", LOBES | COATS | every_kind, true, exact),
        // What a host's frames and images are
        frames("exact, stencil test", ShadeOptions { stencil: true, ..ShadeOptions::default() }),
        frames(
            "exact, lights counted by the GPU",
            ShadeOptions { light_counts: true, ..ShadeOptions::default() },
        ),
        frames("exact, 4 samples a pixel", ShadeOptions { samples: 4, ..ShadeOptions::default() }),
        // Tiles
        classify("quads", "no culling", none, 0.0),
        classify("quads", "culling", none, 0.01),
        classify("quads", "culling, coat with its own normal", COATS, 0.01),
        classify("every kind", "culling", every_kind, 0.01),
        tiles("tiles of quads", "exact", TileClass::Quads, none),
        tiles("tiles of every kind", "exact", TileClass::Any, every_kind),
        // Shadows
        picks("quads", "exact, picks of 1 ray", none, 1),
        picks("quads", "exact, picks of 4 rays", none, 4),
        picks("every kind", "exact, picks of 1 ray", every_kind, 1),
        shadow_rays("quads", "1 ray", none, LOBES, 1),
        shadow_rays("quads", "4 rays", none, LOBES, 4),
        shadow_rays("quads", "1 ray, coat with its own normal", none, LOBES | COATS, 1),
        shadow_rays("quads and polygons", "1 ray", polygon, LOBES, 1),
        shadow_rays("quads and disks", "1 ray", disk, LOBES, 1),
        shadow_rays("every kind", "1 ray", every_kind, LOBES, 1),
        shadow_rays("every kind", "4 rays", every_kind, LOBES, 4),
        shadow_rays("every kind", "1 ray, coat with its own normal", every_kind, LOBES | COATS, 1),
        shadow_history("by the camera", ShadowHistory::Camera),
        shadow_history("by motion vectors", ShadowHistory::MotionVectors),
        shadow_filter("off", ShadowFilter::Off, ShadowHistory::Off),
        shadow_filter("gather", ShadowFilter::Gather, ShadowHistory::Off),
        shadow_filter("gather, with a history", ShadowFilter::Gather, ShadowHistory::Camera),
        // Media
        medium("quads", "no rays", none, (1, false)),
        medium("quads", "no rays, lists", none, (100, false)),
        medium("quads", "1 ray", none, (1, true)),
        medium("profiles", "no rays", Effects::POLYGON | Effects::PROFILE, (1, false)),
        medium("every kind", "no rays", every_kind, (1, false)),
        // Images of lights
        load("copied", 0),
        load("resampled, sRGB", 3),
        row(&kernels::TEXTURE_MIP, "images", "a mip", None, vec![]),
        row(&kernels::TEXTURE_KERNEL, "images", "what lobes see", None, vec![]),
    ]
}

fn yardstick(school: School) -> Row {
    let specialization = vec![(kernels::constant::EFFECTS, LOBES.bits()), (1, school as u32)];
    row(&SHADE_YARDSTICK, "quads", school.name(), Some(YARDSTICK), specialization)
}

/// A whole pixel as a host writes it.
fn deferred(kernel: &'static str, level: &'static str, module: &'static [u8]) -> Row {
    let yardstick = Some(DEFERRED_YARDSTICK);
    Row { kernel, lights: "quads", level, yardstick, source: Source::Deferred(module, vec![]) }
}

/// A path through a light in the pixel of the deferred rows: `benches/kernels/path_cost.comp`.
pub(crate) fn path_cost(
    method: &'static str,
    path: &'static str,
    module: &'static [u8],
    specialization: Vec<(u32, u32)>,
) -> Row {
    let source = Source::Deferred(module, specialization);
    Row { kernel: "path_cost", lights: method, level: path, yardstick: None, source }
}

/// The shade pass where all lights are quads.
fn quads(level: &'static str, effects: Effects, quality: Quality) -> Row {
    shade("quads", level, effects, true, quality)
}

/// The shade pass of both lobes where no light is a quad without a texture.
fn others(lights: &'static str, level: &'static str, kinds: Effects, quality: Quality) -> Row {
    shade(lights, level, LOBES | kinds, false, quality)
}

fn shade(lights: &'static str, level: &'static str, effects: Effects, quads: bool, quality: Quality) -> Row {
    let options = ShadeOptions { surfaces: effects, quality, ..ShadeOptions::default() };
    let frame = LightSummary { quad_count: u32::from(quads), effects, ..LightSummary::default() };
    let specialization = plan::shade_specialization(options, frame);
    row(&kernels::SHADE, lights, level, Some(YARDSTICK), specialization)
}

/// The shade pass of quads with other options.
fn frames(level: &'static str, options: ShadeOptions) -> Row {
    let frame = LightSummary { quad_count: 1, ..LightSummary::default() };
    let specialization = plan::shade_specialization(options, frame);
    row(&kernels::SHADE, "quads", level, Some(YARDSTICK), specialization)
}

/// A kernel's module as the recorder has it for this specialisation.
fn words_of(kernel: &Kernel, specialization: &[(u32, u32)]) -> Vec<u32> {
    let samples = specialization.iter().find(|(id, _)| *id == kernels::constant::SAMPLES);
    kernel.words_for(RadianceFormat::default(), samples.map_or(1, |(_, samples)| *samples))
}

/// The shade pass that picks lights and lobes for shadow rays; `kinds` of lights beside quads.
fn picks(lights: &'static str, level: &'static str, kinds: Effects, rays: u32) -> Row {
    let frame = LightSummary { quad_count: 1, effects: LOBES | kinds, ..LightSummary::default() };
    let specialization = plan::shade_specialization(shadowed(LOBES, rays), frame);
    row(&kernels::SHADE, lights, level, Some(YARDSTICK), specialization)
}

/// Rays through [`arealight::Blockers`]; `kinds` of lights beside quads.
fn shadow_rays(
    lights: &'static str,
    level: &'static str,
    kinds: Effects,
    surfaces: Effects,
    rays: u32,
) -> Row {
    let frame = LightSummary { quad_count: 1, effects: kinds, ..LightSummary::default() };
    let specialization = plan::shadow_rays_specialization(shadowed(surfaces, rays), frame);
    row(&kernels::SHADOW_RAYS, lights, level, None, specialization)
}

fn shadow_history(level: &'static str, history: ShadowHistory) -> Row {
    let specialization = plan::shadow_history_specialization(shadowed(LOBES, 1), history);
    row(&kernels::SHADOW_HISTORY, "1 ray", level, None, specialization)
}

fn shadow_filter(level: &'static str, filter: ShadowFilter, history: ShadowHistory) -> Row {
    let options = shadowed(LOBES, 1);
    let specialization = plan::shadow_filter_specialization(options, filter, history, Output::default());
    row(&kernels::SHADOW_FILTER, "1 ray", level, None, specialization)
}

fn shadowed(surfaces: Effects, shadow_rays: u32) -> ShadeOptions {
    ShadeOptions { surfaces, shadow_rays, ..ShadeOptions::default() }
}

/// Froxels, all of them filled: where a texel says which are, RADV's estimate counts half as much again.
/// `kinds` of lights beside quads.
fn medium(lights: &'static str, level: &'static str, kinds: Effects, (count, rays): (u32, bool)) -> Row {
    let frame = LightSummary { light_count: count, quad_count: 1, effects: kinds, ..LightSummary::default() };
    let options =
        MediumOptions { shadow_rays: rays, one_light: rays, fill_hidden: true, ..MediumOptions::default() };
    let specialization = plan::medium_scatter_specialization(options, frame);
    row(&kernels::MEDIUM_SCATTER, lights, level, None, specialization)
}

/// `kinds`: of lights, and what coats need.
fn classify(lights: &'static str, level: &'static str, kinds: Effects, cull_threshold: f32) -> Row {
    let frame = LightSummary { quad_count: 1, effects: kinds, ..LightSummary::default() };
    let tiles = TileOptions { cull_threshold, ..TileOptions::default() };
    let options = ShadeOptions { surfaces: LOBES | (kinds & COATS), ..ShadeOptions::default() };
    let specialization = plan::classify_specialization(options, frame, tiles);
    row(&kernels::CLASSIFY, lights, level, None, specialization)
}

fn tiles(lights: &'static str, level: &'static str, class: TileClass, kinds: Effects) -> Row {
    let frame = LightSummary { quad_count: 1, effects: kinds, ..LightSummary::default() };
    let specialization = plan::shade_tiles_specialization(ShadeOptions::default(), frame, class);
    row(&kernels::SHADE, lights, level, None, specialization)
}

fn load(level: &'static str, steps: u32) -> Row {
    row(&kernels::TEXTURE_LOAD, "images", level, None, vec![(kernels::constant::LOAD_STEPS, steps)])
}

fn row(
    kernel: &'static Kernel,
    lights: &'static str,
    level: &'static str,
    yardstick: Option<&'static str>,
    specialization: Vec<(u32, u32)>,
) -> Row {
    Row { kernel: kernel.name, lights, level, yardstick, source: Source::Kernel(kernel, specialization) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn rows_have_names_of_their_own_and_yardsticks_are_rows() {
        let rows = rows();
        let names: BTreeSet<String> = rows.iter().map(Row::name).collect();
        assert_eq!(names.len(), rows.len());
        for yardstick in rows.iter().filter_map(|row| row.yardstick) {
            assert!(names.contains(yardstick), "{yardstick}");
        }
    }

    #[test]
    fn rows_that_are_not_the_same_have_modules_or_constants_that_are_not() {
        let rows = rows();
        let shaders: Vec<ComputeShader> = rows.iter().map(Row::shader).collect();
        for (place, shader) in shaders.iter().enumerate() {
            let same = |other: &ComputeShader| {
                other.words == shader.words && other.specialization == shader.specialization
            };
            let first = shaders.iter().position(same).expect("the shader itself");
            assert_eq!(rows[first].name(), rows[place].name());
        }
    }
}
