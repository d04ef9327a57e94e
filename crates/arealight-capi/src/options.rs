//! Numbers of C as options of the recorder.

use crate::failure::Failure;
use crate::lights::read_effects;
use crate::types::ArealightPassOptions;
use arealight::plan::{GBufferLayout, Output, RadianceFormat, ShadeOptions, TileOptions};
use arealight::{Effects, Footprint, FormFactor, Horizon, Lobes, Quality, SpecularLobes};

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
    let quality = Quality {
        form_factor: level(
            options.form_factor,
            &[FormFactor::Exact, FormFactor::Difference],
            "options.form_factor",
        )?,
        horizon: level(options.horizon, &[Horizon::Cosine, Horizon::Both], "options.horizon")?,
        specular_lobes: specular_lobes_of(options.specular_lobes, "options.specular_lobes")?,
        lobes: level(options.lobes, &[Lobes::Table, Lobes::Formula], "options.lobes")?,
        footprint: level(options.footprint, &[Footprint::Kernel, Footprint::Mips], "options.footprint")?,
    };
    Ok(ShadeOptions {
        surfaces,
        quality,
        from_depth: level(options.position, &[false, true], "options.position")?,
        g_buffer: level(
            options.g_buffer,
            &[
                GBufferLayout::Arealight,
                GBufferLayout::Unreal,
                GBufferLayout::Unity,
                GBufferLayout::Octahedral,
            ],
            "options.g_buffer",
        )?,
        output: level(options.output, &[Output::Overwrite, Output::Add], "options.output")?,
        separate_lobes: level(options.radiance_images, &[false, true], "options.radiance_images")?,
        format: level(
            options.radiance_format,
            &[RadianceFormat::Rgba32Float, RadianceFormat::Rgba16Float],
            "options.radiance_format",
        )?,
        shadow_rays: level(options.shadow_rays, &RAYS, "options.shadow_rays")?,
        orthographic: level(options.camera, &[false, true], "options.camera")?,
        rectangle: level(options.rectangle, &[false, true], "options.rectangle")?,
        texels_per_pixel: options.texels_per_pixel.max(1),
        samples: options.samples.max(1),
        stencil: level(options.stencil, &[false, true], "options.stencil")?,
        light_counts: level(options.light_counts, &[false, true], "options.light_counts")?,
    })
}

/// One of AREALIGHT_SPECULAR_LOBES_*.
pub(crate) fn specular_lobes_of(number: u32, field: &str) -> Result<SpecularLobes, Failure> {
    level(number, &[SpecularLobes::One, SpecularLobes::Two, SpecularLobes::HalfVectors], field)
}

/// How many shadow rays a pixel may have.
const RAYS: [u32; ShadeOptions::MOST_SHADOW_RAYS as usize + 1] = [0, 1, 2, 3, 4];

/// The level that a number stands for: its place among them.
pub(crate) fn level<T: Copy>(number: u32, levels: &[T], field: &str) -> Result<T, Failure> {
    levels
        .get(number as usize)
        .copied()
        .ok_or_else(|| Failure::argument(format!("{field}: {number} must be from 0 to {}", levels.len() - 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants as c;

    #[test]
    fn constants_are_those_of_the_vocabulary() {
        for (number, effect) in [
            (c::AREALIGHT_EFFECT_DIFFUSE, Effects::DIFFUSE),
            (c::AREALIGHT_EFFECT_GLOSSY, Effects::GLOSSY),
            (c::AREALIGHT_EFFECT_TWO_SIDED, Effects::TWO_SIDED),
            (c::AREALIGHT_EFFECT_SPECULAR_INPUT, Effects::SPECULAR_INPUT),
            (c::AREALIGHT_EFFECT_POLYGON, Effects::POLYGON),
            (c::AREALIGHT_EFFECT_TEXTURED, Effects::TEXTURED),
            (c::AREALIGHT_EFFECT_ELLIPSE, Effects::ELLIPSE),
            (c::AREALIGHT_EFFECT_SPHERE, Effects::SPHERE),
            (c::AREALIGHT_EFFECT_TUBE, Effects::TUBE),
            (c::AREALIGHT_EFFECT_MESH, Effects::MESH),
            (c::AREALIGHT_EFFECT_TEXTURED_ELLIPSE, Effects::TEXTURED_ELLIPSE),
            (c::AREALIGHT_EFFECT_COAT, Effects::COAT),
            (c::AREALIGHT_EFFECT_COAT_NORMAL, Effects::COAT_NORMAL),
            (c::AREALIGHT_EFFECT_COUPLED, Effects::COUPLED),
            (c::AREALIGHT_EFFECT_COUPLED_BY_ALBEDO, Effects::COUPLED_BY_ALBEDO),
            (c::AREALIGHT_EFFECT_COAT_BY_ALBEDO, Effects::COAT_BY_ALBEDO),
            (c::AREALIGHT_EFFECT_DIFFUSE_ROUGHNESS, Effects::DIFFUSE_ROUGHNESS),
            (c::AREALIGHT_EFFECT_ANISOTROPY, Effects::ANISOTROPY),
            (c::AREALIGHT_EFFECT_SHEEN, Effects::SHEEN),
            (c::AREALIGHT_EFFECT_MULTIPLE_SCATTERING, Effects::MULTIPLE_SCATTERING),
            (c::AREALIGHT_EFFECT_TRANSMISSION, Effects::TRANSMISSION),
            (c::AREALIGHT_EFFECT_THIN_FILM, Effects::THIN_FILM),
            (c::AREALIGHT_EFFECT_GLASS, Effects::GLASS),
            (c::AREALIGHT_EFFECT_PROFILE, Effects::PROFILE),
            (c::AREALIGHT_EFFECT_OPENING, Effects::OPENING),
            (c::AREALIGHT_EFFECT_LINKED, Effects::LINKED),
            (c::AREALIGHT_EFFECT_AZIMUTH, Effects::AZIMUTH),
        ] {
            assert_eq!(number, effect.bits(), "{effect}");
        }
        let options = |form_factor, horizon, footprint| ArealightPassOptions {
            form_factor,
            horizon,
            footprint,
            ..ArealightPassOptions::default()
        };
        let made = |options: ArealightPassOptions| shade_options(&options).unwrap().quality;
        let quality = made(options(
            c::AREALIGHT_FORM_FACTOR_DIFFERENCE,
            c::AREALIGHT_HORIZON_BOTH,
            c::AREALIGHT_FOOTPRINT_MIPS,
        ));
        assert_eq!((quality.form_factor, quality.horizon), (FormFactor::Difference, Horizon::Both));
        assert_eq!(quality.footprint, Footprint::Mips);
        // Zero is the default of everything
        let zero = shade_options(&ArealightPassOptions::default()).unwrap();
        assert_eq!(zero, ShadeOptions::default());
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
            (ArealightPassOptions { form_factor: 2, ..zero }, "options.form_factor"),
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
