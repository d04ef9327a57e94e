//! Which formats the images of a host may have.

use crate::error::Error;
use arealight::plan::{GBufferLayout, RadianceFormat, ShadeOptions};
use arealight::planes::Texels;
use arealight::{Effects, Plane, Planes};
use ash::vk::Format;

/// The formats of the images that a host binds to the shade pass, which their views do not tell: check them
/// once, where the images are made.
///
/// ```
/// use arealight::{Plane, plan::ShadeOptions};
/// use arealight_vk::{ShadeFormats, ash::vk::Format};
///
/// let formats = ShadeFormats {
///     // What is not read needs none
///     planes: [
///         (Plane::Position, Format::D32_SFLOAT),
///         (Plane::Normal, Format::R16G16B16A16_SFLOAT),
///         (Plane::BaseColor, Format::R8G8B8A8_SRGB),
///     ]
///     .into(),
///     radiance: Format::R32G32B32A32_SFLOAT,
/// };
/// let options = ShadeOptions { from_depth: true, ..ShadeOptions::default() };
/// formats.check(options)?;
/// # Ok::<(), arealight_vk::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShadeFormats {
    /// Of [`crate::ShadeResources::planes`], each that [`ShadeOptions::reads`].
    pub planes: Planes<Format>,
    /// Of [`crate::ShadeResources::radiance`] and [`crate::ShadeResources::glossy`], by
    /// [`ShadeOptions::format`].
    pub radiance: Format,
}

/// Formats by their names in ash.
macro_rules! formats {
    ($($name:ident)+) => { &[$(Format::$name),+] };
}

const POSITION: &[Format] = formats![R32G32B32A32_SFLOAT];
const DEPTH: &[Format] = formats![
    D32_SFLOAT D32_SFLOAT_S8_UINT D24_UNORM_S8_UINT X8_D24_UNORM_PACK32 D16_UNORM D16_UNORM_S8_UINT
    R32_SFLOAT
];
const NORMAL: &[Format] = formats![R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT R16G16B16A16_SNORM];
const NORMAL_UNSIGNED: &[Format] = formats![
    A2B10G10R10_UNORM_PACK32 A2R10G10B10_UNORM_PACK32 R16G16B16A16_SFLOAT R16G16B16A16_UNORM R8G8B8A8_UNORM
    B8G8R8A8_UNORM R32G32B32A32_SFLOAT
];
const NORMAL_UNITY: &[Format] = formats![
    R8G8B8A8_SNORM R16G16B16A16_SFLOAT R16G16B16A16_SNORM R32G32B32A32_SFLOAT
];
const OCTAHEDRAL: &[Format] = formats![
    R16G16_SNORM R16G16_SFLOAT R32G32_SFLOAT R16G16B16A16_SNORM R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT
];
const COLOR: &[Format] = formats![
    R8G8B8A8_UNORM R8G8B8A8_SRGB B8G8R8A8_UNORM B8G8R8A8_SRGB A8B8G8R8_UNORM_PACK32 A8B8G8R8_SRGB_PACK32
    R16G16B16A16_UNORM R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT
];
const COAT: &[Format] = formats![
    R8G8_UNORM R16G16_UNORM R16G16_SFLOAT R8G8B8A8_UNORM R8G8B8A8_SNORM R16G16B16A16_UNORM
    R16G16B16A16_SNORM R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT
];
const DIRECTION: &[Format] = formats![
    R8G8B8A8_SNORM R16G16B16A16_SNORM R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT
];
const FLOATS: &[Format] = formats![R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT];
const OFFSETS: &[Format] = formats![R16G16_SFLOAT R32G32_SFLOAT R16G16B16A16_SFLOAT R32G32B32A32_SFLOAT];
const STENCIL: &[Format] = formats![
    S8_UINT D16_UNORM_S8_UINT D24_UNORM_S8_UINT D32_SFLOAT_S8_UINT R8_UINT R8G8_UINT R8G8B8A8_UINT R16_UINT
    R32_UINT
];
const RADIANCE: &[Format] = formats![R32G32B32A32_SFLOAT];
const RADIANCE_HALF: &[Format] = formats![R16G16B16A16_SFLOAT];

impl ShadeFormats {
    /// Checks that a pass of these options reads from every image what it should, and can store to the last.
    ///
    /// # Errors
    /// [`Error::WrongFormat`] names the first image of another format, and the formats that will do.
    pub fn check(&self, options: ShadeOptions) -> Result<(), Error> {
        let radiance = match options.format {
            RadianceFormat::Rgba32Float => RADIANCE,
            RadianceFormat::Rgba16Float => RADIANCE_HALF,
        };
        let planes = self.planes.iter().filter(|(plane, _)| options.reads(*plane));
        let planes = planes.map(|(plane, format)| (plane.name(), *format, formats_of(plane, options)));
        for (field, format, expected) in planes.chain([("radiance", self.radiance, radiance)]) {
            if !expected.contains(&format) {
                return Err(Error::WrongFormat { field, format, expected });
            }
        }
        Ok(())
    }
}

/// What a plane may be, to a pass of these options.
fn formats_of(plane: Plane, options: ShadeOptions) -> &'static [Format] {
    match (plane.texels(), options.g_buffer) {
        (Texels::Positions, _) if options.from_depth => DEPTH,
        (Texels::Positions, _) => POSITION,
        (Texels::Normals, GBufferLayout::Arealight) => NORMAL,
        (Texels::Normals, GBufferLayout::Unreal) => NORMAL_UNSIGNED,
        (Texels::Normals, GBufferLayout::Unity) => NORMAL_UNITY,
        (Texels::Normals, GBufferLayout::Octahedral) => OCTAHEDRAL,
        (Texels::Weights, _) if options.surfaces.contains(Effects::COAT_NORMAL) => DIRECTION,
        (Texels::Weights, _) => COAT,
        (Texels::Colors, _) => COLOR,
        (Texels::Directions, _) => DIRECTION,
        (Texels::Floats, _) => FLOATS,
        (Texels::Integers, _) => STENCIL,
        (Texels::Offsets, _) => OFFSETS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn right() -> ShadeFormats {
        let planes = Planes::from_fn(|_| Format::R16G16B16A16_SFLOAT)
            .with(Plane::Position, Format::R32G32B32A32_SFLOAT)
            .with(Plane::BaseColor, Format::R8G8B8A8_SRGB)
            .with(Plane::Specular, Format::R8G8B8A8_UNORM)
            .with(Plane::Stencil, Format::R8_UINT);
        ShadeFormats { planes, radiance: Format::R32G32B32A32_SFLOAT }
    }

    fn with(plane: Plane, format: Format) -> ShadeFormats {
        ShadeFormats { planes: right().planes.with(plane, format), ..right() }
    }

    fn field(formats: ShadeFormats, options: ShadeOptions) -> &'static str {
        match formats.check(options).unwrap_err() {
            Error::WrongFormat { field, .. } => field,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn formats_that_will_do_pass() {
        let all = ShadeOptions { surfaces: Effects::SURFACES, ..ShadeOptions::default() };
        right().check(all).unwrap();
        let depth = ShadeOptions { from_depth: true, ..all };
        with(Plane::Position, Format::D24_UNORM_S8_UINT).check(depth).unwrap();
        let unread = ShadeFormats {
            planes: with(Plane::Specular, Format::UNDEFINED).planes.with(Plane::Coat, Format::UNDEFINED),
            ..right()
        };
        unread.check(ShadeOptions::default()).unwrap();
        let flat_coats = ShadeOptions { surfaces: Effects::COAT, ..ShadeOptions::default() };
        with(Plane::Coat, Format::R8G8_UNORM).check(flat_coats).unwrap();
        let half = ShadeOptions { format: RadianceFormat::Rgba16Float, ..all };
        ShadeFormats { radiance: Format::R16G16B16A16_SFLOAT, ..right() }.check(half).unwrap();
    }

    #[test]
    fn each_wrong_format_is_named_with_those_that_will_do() {
        let options = ShadeOptions { surfaces: Effects::SURFACES, ..ShadeOptions::default() };
        // Rounded positions, unsigned normals, integers, three channels, and what the kernel cannot store to
        for (formats, expected) in [
            (with(Plane::Position, Format::R16G16B16A16_SFLOAT), "position"),
            (with(Plane::Position, Format::D32_SFLOAT), "position"),
            (with(Plane::Normal, Format::R8G8B8A8_UNORM), "normal"),
            (with(Plane::BaseColor, Format::R8G8B8A8_UINT), "base_color"),
            (with(Plane::Specular, Format::B10G11R11_UFLOAT_PACK32), "specular"),
            (with(Plane::Coat, Format::R8G8_UNORM), "coat"),
            (with(Plane::Film, Format::R8G8B8A8_UNORM), "film"),
            (ShadeFormats { radiance: Format::R16G16B16A16_SFLOAT, ..right() }, "radiance"),
        ] {
            assert_eq!(field(formats, options), expected);
        }
        let depth = ShadeOptions { from_depth: true, ..options };
        assert_eq!(field(right(), depth), "position");
        // A layout's normals, and its third image, which is read whatever surfaces need
        let unreal = ShadeOptions { g_buffer: GBufferLayout::Unreal, ..ShadeOptions::default() };
        let ten_bits = with(Plane::Normal, Format::A2B10G10R10_UNORM_PACK32);
        ten_bits.check(unreal).unwrap();
        assert_eq!(field(ten_bits, options), "normal");
        assert_eq!(
            field(
                ShadeFormats { planes: ten_bits.planes.with(Plane::Specular, Format::UNDEFINED), ..ten_bits },
                unreal
            ),
            "specular"
        );
        let octahedral = ShadeOptions { g_buffer: GBufferLayout::Octahedral, ..unreal };
        assert_eq!(field(ten_bits, octahedral), "normal");
        let unity = ShadeOptions { g_buffer: GBufferLayout::Unity, ..unreal };
        assert_eq!(field(ten_bits, unity), "normal");
        let stencil = ShadeOptions { stencil: true, ..options };
        assert_eq!(field(with(Plane::Stencil, Format::R8_UNORM), stencil), "stencil");
        with(Plane::Stencil, Format::S8_UINT).check(stencil).unwrap();
        let half = ShadeOptions { format: RadianceFormat::Rgba16Float, ..options };
        assert_eq!(field(right(), half), "radiance");
        let error = ShadeFormats { radiance: Format::R8G8B8A8_UNORM, ..right() }.check(options).unwrap_err();
        assert_eq!(
            error.to_string(),
            "radiance: the format is R8G8B8A8_UNORM; it must be one of R32G32B32A32_SFLOAT"
        );
    }
}
