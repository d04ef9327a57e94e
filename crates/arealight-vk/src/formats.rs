//! Which formats the images of a host may have.

use crate::error::Error;
use arealight::Effects;
use arealight::plan::{GBufferLayout, RadianceFormat, ShadeOptions};
use ash::vk::Format;

/// The formats of the images that a host binds to the shade pass, which their views do not tell: check them
/// once, where the images are made.
///
/// ```
/// use arealight::plan::ShadeOptions;
/// use arealight_vk::{ShadeFormats, ash::vk::Format};
///
/// let formats = ShadeFormats {
///     position: Format::D32_SFLOAT,
///     normal: Format::R16G16B16A16_SFLOAT,
///     base_color: Format::R8G8B8A8_SRGB,
///     specular: Format::UNDEFINED, // not read without Effects::SPECULAR_INPUT
///     coat: Format::UNDEFINED, // not read without Effects::COAT
///     sheen: Format::UNDEFINED, // not read without Effects::SHEEN
///     anisotropy: Format::UNDEFINED, // nor this without Effects::ANISOTROPY or DIFFUSE_ROUGHNESS
///     film: Format::UNDEFINED, // nor this without Effects::THIN_FILM
///     radiance: Format::R32G32B32A32_SFLOAT,
/// };
/// let options = ShadeOptions { from_depth: true, ..ShadeOptions::default() };
/// formats.check(options)?;
/// # Ok::<(), arealight_vk::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShadeFormats {
    /// Of [`crate::ShadeResources::position`]: float32 positions, or depth, by [`ShadeOptions::from_depth`].
    pub position: Format,
    /// Of [`crate::ShadeResources::normal`]: signed, with four channels, or as [`ShadeOptions::g_buffer`] has
    /// it.
    pub normal: Format,
    /// Of [`crate::ShadeResources::base_color`]: with four channels.
    pub base_color: Format,
    /// Of [`crate::ShadeResources::specular`], where [`ShadeOptions::reads_specular`].
    pub specular: Format,
    /// Of [`crate::ShadeResources::coat`], where [`ShadeOptions::reads_coat`]: two channels, or with
    /// [`Effects::COAT_NORMAL`] four, signed.
    pub coat: Format,
    /// Of [`crate::ShadeResources::sheen`], where [`ShadeOptions::reads_sheen`]: with four channels.
    pub sheen: Format,
    /// Of [`crate::ShadeResources::anisotropy`], where [`ShadeOptions::reads_anisotropy`]: signed or float,
    /// with four channels.
    pub anisotropy: Format,
    /// Of [`crate::ShadeResources::film`], where [`ShadeOptions::reads_film`]: float, with four channels.
    pub film: Format,
    /// Of [`crate::ShadeResources::radiance`] and [`crate::ShadeResources::glossy`], by
    /// [`ShadeOptions::format`].
    pub radiance: Format,
}

const POSITION: &[Format] = &[Format::R32G32B32A32_SFLOAT];
const DEPTH: &[Format] = &[
    Format::D32_SFLOAT,
    Format::D32_SFLOAT_S8_UINT,
    Format::D24_UNORM_S8_UINT,
    Format::X8_D24_UNORM_PACK32,
    Format::D16_UNORM,
    Format::D16_UNORM_S8_UINT,
    Format::R32_SFLOAT,
];
const NORMAL: &[Format] =
    &[Format::R16G16B16A16_SFLOAT, Format::R32G32B32A32_SFLOAT, Format::R16G16B16A16_SNORM];
const NORMAL_UNSIGNED: &[Format] = &[
    Format::A2B10G10R10_UNORM_PACK32,
    Format::A2R10G10B10_UNORM_PACK32,
    Format::R16G16B16A16_SFLOAT,
    Format::R16G16B16A16_UNORM,
    Format::R8G8B8A8_UNORM,
    Format::B8G8R8A8_UNORM,
    Format::R32G32B32A32_SFLOAT,
];
const NORMAL_UNITY: &[Format] = &[
    Format::R8G8B8A8_SNORM,
    Format::R16G16B16A16_SFLOAT,
    Format::R16G16B16A16_SNORM,
    Format::R32G32B32A32_SFLOAT,
];
const OCTAHEDRAL: &[Format] = &[
    Format::R16G16_SNORM,
    Format::R16G16_SFLOAT,
    Format::R32G32_SFLOAT,
    Format::R16G16B16A16_SNORM,
    Format::R16G16B16A16_SFLOAT,
    Format::R32G32B32A32_SFLOAT,
];
const COLOR: &[Format] = &[
    Format::R8G8B8A8_UNORM,
    Format::R8G8B8A8_SRGB,
    Format::B8G8R8A8_UNORM,
    Format::B8G8R8A8_SRGB,
    Format::A8B8G8R8_UNORM_PACK32,
    Format::A8B8G8R8_SRGB_PACK32,
    Format::R16G16B16A16_UNORM,
    Format::R16G16B16A16_SFLOAT,
    Format::R32G32B32A32_SFLOAT,
];
const COAT: &[Format] = &[
    Format::R8G8_UNORM,
    Format::R16G16_UNORM,
    Format::R16G16_SFLOAT,
    Format::R8G8B8A8_UNORM,
    Format::R8G8B8A8_SNORM,
    Format::R16G16B16A16_UNORM,
    Format::R16G16B16A16_SNORM,
    Format::R16G16B16A16_SFLOAT,
    Format::R32G32B32A32_SFLOAT,
];
const DIRECTION: &[Format] = &[
    Format::R8G8B8A8_SNORM,
    Format::R16G16B16A16_SNORM,
    Format::R16G16B16A16_SFLOAT,
    Format::R32G32B32A32_SFLOAT,
];
const FILM: &[Format] = &[Format::R16G16B16A16_SFLOAT, Format::R32G32B32A32_SFLOAT];
const RADIANCE: &[Format] = &[Format::R32G32B32A32_SFLOAT];
const RADIANCE_HALF: &[Format] = &[Format::R16G16B16A16_SFLOAT];

impl ShadeFormats {
    /// Checks that a pass of these options reads from every image what it should, and can store to the last.
    ///
    /// # Errors
    /// [`Error::WrongFormat`] names the first image of another format, and the formats that will do.
    pub fn check(&self, options: ShadeOptions) -> Result<(), Error> {
        let position = if options.from_depth { DEPTH } else { POSITION };
        let radiance = match options.format {
            RadianceFormat::Rgba32Float => RADIANCE,
            RadianceFormat::Rgba16Float => RADIANCE_HALF,
        };
        let normal = match options.g_buffer {
            GBufferLayout::Arealight => NORMAL,
            GBufferLayout::Unreal => NORMAL_UNSIGNED,
            GBufferLayout::Unity => NORMAL_UNITY,
            GBufferLayout::Octahedral => OCTAHEDRAL,
        };
        let coat = if options.surfaces.contains(Effects::COAT_NORMAL) { DIRECTION } else { COAT };
        let images = [
            ("position", self.position, position, true),
            ("normal", self.normal, normal, true),
            ("base_color", self.base_color, COLOR, true),
            ("specular", self.specular, COLOR, options.reads_specular()),
            ("coat", self.coat, coat, options.reads_coat()),
            ("sheen", self.sheen, COLOR, options.reads_sheen()),
            ("anisotropy", self.anisotropy, DIRECTION, options.reads_anisotropy()),
            ("film", self.film, FILM, options.reads_film()),
            ("radiance", self.radiance, radiance, true),
        ];
        for (field, format, expected, used) in images {
            if used && !expected.contains(&format) {
                return Err(Error::WrongFormat { field, format, expected });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: ShadeFormats = ShadeFormats {
        position: Format::R32G32B32A32_SFLOAT,
        normal: Format::R16G16B16A16_SFLOAT,
        base_color: Format::R8G8B8A8_SRGB,
        specular: Format::R8G8B8A8_UNORM,
        coat: Format::R16G16B16A16_SFLOAT,
        sheen: Format::R16G16B16A16_SFLOAT,
        anisotropy: Format::R16G16B16A16_SFLOAT,
        film: Format::R16G16B16A16_SFLOAT,
        radiance: Format::R32G32B32A32_SFLOAT,
    };

    fn field(formats: ShadeFormats, options: ShadeOptions) -> &'static str {
        match formats.check(options).unwrap_err() {
            Error::WrongFormat { field, .. } => field,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn formats_that_will_do_pass() {
        let all = ShadeOptions { surfaces: Effects::SURFACES, ..ShadeOptions::default() };
        RIGHT.check(all).unwrap();
        let depth = ShadeOptions { from_depth: true, ..all };
        ShadeFormats { position: Format::D24_UNORM_S8_UINT, ..RIGHT }.check(depth).unwrap();
        let unread = ShadeFormats { specular: Format::UNDEFINED, coat: Format::UNDEFINED, ..RIGHT };
        unread.check(ShadeOptions::default()).unwrap();
        let flat_coats = ShadeOptions { surfaces: Effects::COAT, ..ShadeOptions::default() };
        ShadeFormats { coat: Format::R8G8_UNORM, ..RIGHT }.check(flat_coats).unwrap();
        let half = ShadeOptions { format: RadianceFormat::Rgba16Float, ..all };
        ShadeFormats { radiance: Format::R16G16B16A16_SFLOAT, ..RIGHT }.check(half).unwrap();
    }

    #[test]
    fn each_wrong_format_is_named_with_those_that_will_do() {
        let options = ShadeOptions { surfaces: Effects::SURFACES, ..ShadeOptions::default() };
        // Rounded positions, unsigned normals, integers, three channels, and what the kernel cannot store to
        for (formats, expected) in [
            (ShadeFormats { position: Format::R16G16B16A16_SFLOAT, ..RIGHT }, "position"),
            (ShadeFormats { position: Format::D32_SFLOAT, ..RIGHT }, "position"),
            (ShadeFormats { normal: Format::R8G8B8A8_UNORM, ..RIGHT }, "normal"),
            (ShadeFormats { base_color: Format::R8G8B8A8_UINT, ..RIGHT }, "base_color"),
            (ShadeFormats { specular: Format::B10G11R11_UFLOAT_PACK32, ..RIGHT }, "specular"),
            (ShadeFormats { coat: Format::R8G8_UNORM, ..RIGHT }, "coat"),
            (ShadeFormats { radiance: Format::R16G16B16A16_SFLOAT, ..RIGHT }, "radiance"),
        ] {
            assert_eq!(field(formats, options), expected);
        }
        let depth = ShadeOptions { from_depth: true, ..options };
        assert_eq!(field(RIGHT, depth), "position");
        // A layout's normals, and its third image, which is read whatever surfaces need
        let unreal = ShadeOptions { g_buffer: GBufferLayout::Unreal, ..ShadeOptions::default() };
        let ten_bits = ShadeFormats { normal: Format::A2B10G10R10_UNORM_PACK32, ..RIGHT };
        ten_bits.check(unreal).unwrap();
        assert_eq!(field(ten_bits, options), "normal");
        assert_eq!(field(ShadeFormats { specular: Format::UNDEFINED, ..ten_bits }, unreal), "specular");
        let octahedral = ShadeOptions { g_buffer: GBufferLayout::Octahedral, ..unreal };
        assert_eq!(field(ten_bits, octahedral), "normal");
        let unity = ShadeOptions { g_buffer: GBufferLayout::Unity, ..unreal };
        assert_eq!(field(ten_bits, unity), "normal");
        let half = ShadeOptions { format: RadianceFormat::Rgba16Float, ..options };
        assert_eq!(field(RIGHT, half), "radiance");
        let error = ShadeFormats { radiance: Format::R8G8B8A8_UNORM, ..RIGHT }.check(options).unwrap_err();
        assert_eq!(
            error.to_string(),
            "radiance: the format is R8G8B8A8_UNORM; it must be one of R32G32B32A32_SFLOAT"
        );
    }
}
