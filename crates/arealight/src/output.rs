//! The kernels' output: what becomes of radiance, and in which format.

/// What the shade kernel does to the radiance image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Output {
    /// Radiance replaces what is there; pixels without a surface become zero.
    #[default]
    Overwrite = 0,
    /// Radiance is added to what is there; pixels without a surface stay as they are.
    Add = 1,
}

/// The texel format of the images that the shade kernel stores radiance to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum RadianceFormat {
    /// Sixteen bytes a texel.
    #[default]
    Rgba32Float = 0,
    /// Eight bytes a texel: rounded to the nearest of 11 bits (a relative error of 4.9e-4), and what is above
    /// 65,504 is stored as that. Lights added by several passes are rounded by each.
    Rgba16Float = 4,
}
