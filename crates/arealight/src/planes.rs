//! The planes of a G-buffer: what a pass reads of each pixel, an image each. All that binds, checks or
//! describes one goes over [`Plane::ALL`].

use crate::Effects;
use std::ops::{Index, IndexMut};

/// An image that a pass reads at each pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[repr(u32)]
pub enum Plane {
    /// Positions or depth.
    Position,
    /// Normals and roughness: this and the next two by [`GBufferLayout`](crate::plan::GBufferLayout).
    Normal,
    /// Base colour and metalness.
    BaseColor,
    /// Dielectric reflectance, or the third image of another layout.
    Specular,
    /// Coats.
    Coat,
    /// Sheen.
    Sheen,
    /// Second roughnesses.
    Anisotropy,
    /// Thin films.
    Film,
    /// Stencils.
    Stencil,
    /// Where points were in the frame before.
    Motion,
}

/// What the texels of a plane are, in the layout of our own: the formats that a recorder allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Texels {
    /// Four floats of 32 bits.
    Positions,
    /// Three signed numbers, and one of 16 bits.
    Normals,
    /// Four numbers from 0 to 1.
    Colors,
    /// Two numbers from 0 to 1.
    Weights,
    /// Four signed numbers.
    Directions,
    /// Four floats.
    Floats,
    /// An integer of eight bits.
    Integers,
    /// Two signed floats.
    Offsets,
}

/// What there is to know of a plane.
struct Row {
    plane: Plane,
    /// In the GLSL; without `g_` in Rust and C.
    binding: &'static str,
    texels: Texels,
    /// It is read with any of these.
    effects: Effects,
    content: &'static str,
}

/// A row of the table.
const fn row(
    plane: Plane,
    binding: &'static str,
    (texels, effects): (Texels, Effects),
    content: &'static str,
) -> Row {
    Row { plane, binding, texels, effects, content }
}

/// The table. Another plane is a row, and a number in `shaders/kernels/bindings.glsl`.
const ROWS: [Row; Plane::COUNT] = [
    row(
        Plane::Position,
        "g_position",
        (Texels::Positions, Effects::all()),
        "position relative to the origin in xyz, 0 in w where there is no surface (rgba32f); or depth (d32f)",
    ),
    row(
        Plane::Normal,
        "g_normal",
        (Texels::Normals, Effects::all()),
        "shading normal in xyz, of any length; perceptual roughness in w (rgba16f; rgba32f for mirrors); or by \
         GBufferLayout",
    ),
    row(
        Plane::BaseColor,
        "g_base_color",
        (Texels::Colors, Effects::all()),
        "linear base colour in rgb, metalness in a (rgba8 unorm; sRGB formats decode by themselves); or by \
         GBufferLayout",
    ),
    row(
        Plane::Specular,
        "g_specular",
        (Texels::Colors, Effects::SPECULAR_INPUT),
        "dielectric F0 in rgb, dielectric F90 in a (rgba8 unorm); or by GBufferLayout; read only with \
         Effects::SPECULAR_INPUT or another layout, else bind any image",
    ),
    row(
        Plane::Coat,
        "g_coat",
        (Texels::Weights, Effects::COAT),
        "weight of the coat in r, its perceptual roughness in g; with Effects::COAT_NORMAL its normal's place \
         on the octahedron, in [-1, 1], in ba (rgba16f; rg8 unorm without normals); read only with \
         Effects::COAT, else bind any image",
    ),
    row(
        Plane::Sheen,
        "g_sheen",
        (Texels::Colors, Effects::SHEEN),
        "linear colour of the sheen in rgb, its perceptual roughness in a (rgba8 unorm; sRGB formats decode by \
         themselves); read only with Effects::SHEEN, else bind any image",
    ),
    row(
        Plane::Anisotropy,
        "g_anisotropy",
        (Texels::Directions, Effects::ANISOTROPY.union(Effects::DIFFUSE_ROUGHNESS)),
        "tangent's place on the octahedron, in [-1, 1], in rg, perceptual roughness along it in b \
         (Effects::ANISOTROPY; 0: isotropic), roughness of the diffuse lobe in a (Effects::DIFFUSE_ROUGHNESS) \
         (rgba16f); read only with one of these, else bind any image",
    ),
    row(
        Plane::Film,
        "g_film",
        (Texels::Floats, Effects::THIN_FILM),
        "how much of a surface a thin film covers in r, its index of refraction in g, its thickness in \
         nanometres in b (rgba16f); read only with Effects::THIN_FILM, else bind any image",
    ),
    row(
        Plane::Stencil,
        "g_stencil",
        (Texels::Integers, Effects::LINKED),
        "stencil in r: eight bits, for the stencil test, or for light linking with Effects::LINKED (s8_uint, \
         r8_uint); read only with that or ShadeOptions::stencil, else bind any image",
    ),
    row(
        Plane::Motion,
        "g_motion",
        (Texels::Offsets, Effects::empty()),
        "where a pixel's point was in the frame before less where it is, in parts of the image's size \
         (rg16f); read only with ShadowHistory::MotionVectors, else bind any image",
    ),
];

impl Plane {
    /// How many there are.
    pub const COUNT: usize = 10;

    /// Every plane, in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] = {
        let mut all = [Self::Position; Self::COUNT];
        let mut index = 0;
        while index < Self::COUNT {
            all[index] = ROWS[index].plane;
            index += 1;
        }
        all
    };

    const fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The name, as in C: `base_color`.
    pub fn name(self) -> &'static str {
        &self.binding()["g_".len()..]
    }

    /// The name of its binding in the GLSL: `g_base_color`.
    pub const fn binding(self) -> &'static str {
        self.row().binding
    }

    /// The plane that is bound at a name of the GLSL.
    pub fn bound_at(binding: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|plane| plane.binding() == binding)
    }

    /// What its texels hold, in which format at least, and when it is read.
    pub const fn content(self) -> &'static str {
        self.row().content
    }

    /// What its texels are in [`GBufferLayout::Arealight`](crate::plan::GBufferLayout::Arealight).
    pub const fn texels(self) -> Texels {
        self.row().texels
    }

    /// It is read where surfaces need any of these; see
    /// [`ShadeOptions::reads`](crate::plan::ShadeOptions::reads).
    pub const fn effects(self) -> Effects {
        self.row().effects
    }
}

/// Something for each plane: `planes[Plane::Coat]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Planes<T>([T; Plane::COUNT]);

impl<T> Planes<T> {
    /// What a function has for each.
    pub fn from_fn(of: impl FnMut(Plane) -> T) -> Self {
        Self(Plane::ALL.map(of))
    }

    /// Each with what it has.
    pub fn iter(&self) -> impl Iterator<Item = (Plane, &T)> {
        Plane::ALL.into_iter().zip(&self.0)
    }

    /// The same with something else for one.
    #[must_use]
    pub fn with(mut self, plane: Plane, value: T) -> Self {
        self[plane] = value;
        self
    }
}

impl<T: Default, const N: usize> From<[(Plane, T); N]> for Planes<T> {
    /// The default for planes that are not in the list.
    fn from(list: [(Plane, T); N]) -> Self {
        let mut planes = Self::from_fn(|_| T::default());
        for (plane, value) in list {
            planes[plane] = value;
        }
        planes
    }
}

impl<T, const N: usize> From<[(Plane, T); N]> for Planes<Option<T>> {
    /// Nothing for planes that are not in the list.
    fn from(list: [(Plane, T); N]) -> Self {
        list.map(|(plane, value)| (plane, Some(value))).into()
    }
}

impl<T> Index<Plane> for Planes<T> {
    type Output = T;

    fn index(&self, plane: Plane) -> &T {
        &self.0[plane as usize]
    }
}

impl<T> IndexMut<Plane> for Planes<T> {
    fn index_mut(&mut self, plane: Plane) -> &mut T {
        &mut self.0[plane as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_numbers() {
        for (index, plane) in Plane::ALL.into_iter().enumerate() {
            assert_eq!((plane as usize, Plane::bound_at(plane.binding())), (index, Some(plane)));
        }
        assert_eq!((Plane::BaseColor.name(), Plane::BaseColor.binding()), ("base_color", "g_base_color"));
        assert_eq!(Plane::bound_at("base_color"), None);
    }

    #[test]
    fn each_plane_has_its_own_place() {
        let planes = Planes::from([(Plane::Film, 2), (Plane::Position, 1)]).with(Plane::Motion, 3);
        let set: Vec<_> = planes.iter().filter(|(_, value)| **value > 0).collect();
        assert_eq!(set, [(Plane::Position, &1), (Plane::Film, &2), (Plane::Motion, &3)]);
        assert_eq!(planes[Plane::Coat], 0);
    }
}
