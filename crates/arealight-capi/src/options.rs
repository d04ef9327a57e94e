//! Numbers of C as options of the recorder.

use crate::failure::Failure;
use crate::lights::read_effects;
use crate::types::ArealightPassOptions;
use arealight::plan::{GBufferLayout, Output, RadianceFormat, ShadeOptions, TileOptions};
use arealight::{Effects, Footprint, Horizon, Lobes, Quality, SpecularLobes};

/// How tiles get their lists; none in a pass without.
pub(crate) fn tile_options(options: &ArealightPassOptions) -> Option<TileOptions> {
    let tiles = TileOptions {
        capacity: options.tile_capacity,
        cull_threshold: options.tile_cull_threshold,
        least_quads: options.tile_least_quads,
    };
    (tiles.capacity > 0).then_some(tiles)
}

/// What a pass is specialised for.
pub(crate) fn shade_options(options: &ArealightPassOptions) -> Result<ShadeOptions, Failure> {
    let surfaces = match read_effects(options.surfaces, "options.surfaces")? {
        none if none.is_empty() => ShadeOptions::default().surfaces,
        given if Effects::SURFACES.contains(given) => given,
        given => {
            let others = given - Effects::SURFACES;
            return Err(Failure::argument(format!("options.surfaces: {others} are what lights need")));
        }
    };
    macro_rules! of {
        ($field:ident, $($level:expr),*) => {
            level(options.$field, &[$($level),*], concat!("options.", stringify!($field)))?
        };
    }
    let quality = Quality {
        horizon: of!(horizon, Horizon::Cosine, Horizon::Both),
        specular_lobes: specular_lobes_of(options.specular_lobes, "options.specular_lobes")?,
        lobes: of!(lobes, Lobes::Table, Lobes::Formula),
        footprint: of!(footprint, Footprint::Kernel, Footprint::Mips),
    };
    Ok(ShadeOptions {
        surfaces,
        quality,
        from_depth: of!(position, false, true),
        g_buffer: level(options.g_buffer, &LAYOUTS, "options.g_buffer")?,
        output: of!(output, Output::Overwrite, Output::Add),
        separate_lobes: of!(radiance_images, false, true),
        format: of!(radiance_format, RadianceFormat::Rgba32Float, RadianceFormat::Rgba16Float),
        shadow_rays: level(options.shadow_rays, &RAYS, "options.shadow_rays")?,
        orthographic: of!(camera, false, true),
        rectangle: of!(rectangle, false, true),
        texels_per_pixel: options.texels_per_pixel.max(1),
        samples: options.samples.max(1),
        stencil: of!(stencil, false, true),
        light_counts: of!(light_counts, false, true),
    })
}

/// One of AREALIGHT_SPECULAR_LOBES_*.
pub(crate) fn specular_lobes_of(number: u32, field: &str) -> Result<SpecularLobes, Failure> {
    level(number, &[SpecularLobes::One, SpecularLobes::Two, SpecularLobes::HalfVectors], field)
}

/// By AREALIGHT_G_BUFFER_*.
const LAYOUTS: [GBufferLayout; 4] =
    [GBufferLayout::Arealight, GBufferLayout::Unreal, GBufferLayout::Unity, GBufferLayout::Octahedral];

/// How many shadow rays a pixel may have.
const RAYS: [u32; ShadeOptions::MOST_SHADOW_RAYS as usize + 1] = [0, 1, 2, 3, 4];

/// 0 or 1 as they are meant.
pub(crate) fn flag(number: u32, field: &str) -> Result<bool, Failure> {
    level(number, &[false, true], field)
}

/// The level that a number stands for: its place among them.
pub(crate) fn level<T: Copy>(number: u32, levels: &[T], field: &str) -> Result<T, Failure> {
    let wrong = || Failure::argument(format!("{field}: {number} must be from 0 to {}", levels.len() - 1));
    levels.get(number as usize).copied().ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::*;

    #[test]
    fn constants_are_those_of_the_vocabulary() {
        let made = |horizon, footprint| {
            let zero = ArealightPassOptions::default();
            shade_options(&ArealightPassOptions { horizon, footprint, ..zero }).unwrap()
        };
        let Quality { horizon, footprint, .. } =
            made(AREALIGHT_HORIZON_BOTH, AREALIGHT_FOOTPRINT_MIPS).quality;
        assert_eq!((horizon, footprint), (Horizon::Both, Footprint::Mips));
        // Zero is the default of everything
        assert_eq!(made(0, 0), ShadeOptions::default());
    }

    #[test]
    fn options_out_of_range_are_named() {
        let zero = ArealightPassOptions::default();
        let tiles = ArealightPassOptions { tile_capacity: 64, tile_cull_threshold: 0.5, ..zero };
        let expected = TileOptions { capacity: 64, cull_threshold: 0.5, least_quads: 0 };
        assert_eq!((tile_options(&tiles), tile_options(&zero)), (Some(expected), None));
        for (wrong, field) in [
            (ArealightPassOptions { surfaces: 1 << 30, ..zero }, "options.surfaces"),
            (ArealightPassOptions { surfaces: 16, ..zero }, "options.surfaces: polygon are what lights need"),
            (ArealightPassOptions { horizon: 2, ..zero }, "options.horizon"),
            (ArealightPassOptions { specular_lobes: 3, ..zero }, "options.specular_lobes"),
            (ArealightPassOptions { lobes: 2, ..zero }, "options.lobes"),
            (ArealightPassOptions { footprint: 2, ..zero }, "options.footprint"),
            (ArealightPassOptions { position: 2, ..zero }, "options.position"),
            (ArealightPassOptions { output: u32::MAX, ..zero }, "options.output"),
            (ArealightPassOptions { g_buffer: 4, ..zero }, "options.g_buffer"),
            (ArealightPassOptions { radiance_images: 2, ..zero }, "options.radiance_images"),
            (ArealightPassOptions { radiance_format: 2, ..zero }, "options.radiance_format"),
            (ArealightPassOptions { camera: 2, ..zero }, "options.camera"),
            (ArealightPassOptions { rectangle: 2, ..zero }, "options.rectangle"),
            (ArealightPassOptions { shadow_rays: 5, ..zero }, "options.shadow_rays: 5 must be from 0 to 4"),
        ] {
            let message = shade_options(&wrong).err().unwrap().message;
            assert!(message.starts_with(field), "{message}");
        }
    }
}
