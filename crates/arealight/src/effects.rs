//! What a scene calls for. The set becomes one specialisation constant, and the driver's compiler removes
//! the code of every effect that is not in it.

bitflags::bitflags! {
    /// A set of effects: the lobes, light properties and surface inputs that a shade pass must handle.
    ///
    /// The bits are those of `shaders/kernels/effects.glsl`; a test compares the two. A set that is
    /// too large only costs time; a set that is too small for the lights is refused when they are packed for
    /// a pass ([`Effects::missing_for`]).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub struct Effects: u32 {
        /// The Lambert lobe: some surface has a metalness below one and a base colour that is not black.
        const DIFFUSE = 1 << 0;
        /// The GGX lobe: some surface reflects specularly.
        const GLOSSY = 1 << 1;
        /// Some light lights both of its sides.
        const TWO_SIDED = 1 << 2;
        /// Some surface has a dielectric reflectance other than F0 = 0.04, F90 = 1 (an index of refraction,
        /// a specular colour or weight), so the G-buffer's fourth image is read.
        const SPECULAR_INPUT = 1 << 3;
        /// Some light is concave, not quite flat, or has more than four vertices
        /// ([`PolygonLight::is_convex_quad`](crate::PolygonLight::is_convex_quad) is false).
        const POLYGON = 1 << 4;
        /// Some light shows an image ([`PolygonLight::texture`](crate::PolygonLight::texture)).
        const TEXTURED = 1 << 5;
        /// Some light is a disk or an ellipse ([`Shape::Ellipse`](crate::Shape::Ellipse)).
        const ELLIPSE = 1 << 8;
        /// Some light is a sphere ([`Shape::Sphere`](crate::Shape::Sphere)).
        const SPHERE = 1 << 9;
        /// Some light is a cylinder or a capsule ([`Shape::Tube`](crate::Shape::Tube)).
        const TUBE = 1 << 10;
        /// Some light has several faces ([`PolygonLight::is_mesh`](crate::PolygonLight::is_mesh)). Such a light calls for
        /// [`Effects::POLYGON`], too.
        const MESH = 1 << 11;
        /// Some disk or ellipse shows an image ([`ShapeLight::texture`](crate::ShapeLight::texture)). Such a light calls for
        /// [`Effects::ELLIPSE`], too.
        const TEXTURED_ELLIPSE = 1 << 12;
    }
}

/// A word that names no effect.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{name}' is no effect; there are {}", Effects::all())]
pub struct UnknownEffect {
    /// The word.
    pub name: String,
}

impl Effects {
    /// Every kind of light that is no polygon.
    pub const SHAPES: Self = Self::ELLIPSE.union(Self::SPHERE).union(Self::TUBE);

    /// What lights that are no polygons may call for, beside two sides.
    pub const OF_SHAPES: Self = Self::SHAPES.union(Self::TEXTURED_ELLIPSE);

    /// What a convex quad without an image never calls for. Such quads are shaded in a loop of their own.
    pub const BEYOND_QUADS: Self = Self::POLYGON.union(Self::TEXTURED).union(Self::MESH);

    /// With any of these the light textures are read.
    pub const IMAGES: Self = Self::TEXTURED.union(Self::TEXTURED_ELLIPSE);

    /// What the surfaces of a frame call for, whatever its lights.
    pub const SURFACES: Self = Self::DIFFUSE.union(Self::GLOSSY).union(Self::SPECULAR_INPUT);

    /// The effects in words, in the order of their bits, for people to read.
    pub fn names(self) -> Vec<&'static str> {
        [
            (Self::DIFFUSE, "diffuse"),
            (Self::GLOSSY, "glossy"),
            (Self::TWO_SIDED, "two_sided"),
            (Self::SPECULAR_INPUT, "specular_input"),
            (Self::POLYGON, "polygon"),
            (Self::TEXTURED, "textured"),
            (Self::ELLIPSE, "ellipse"),
            (Self::SPHERE, "sphere"),
            (Self::TUBE, "tube"),
            (Self::MESH, "mesh"),
            (Self::TEXTURED_ELLIPSE, "textured_ellipse"),
        ]
        .into_iter()
        .filter_map(|(effect, name)| self.contains(effect).then_some(name))
        .collect()
    }

    /// What `lights` call for beyond this set, with the name of the first light that does.
    pub fn missing_for(self, lights: &[crate::PolygonLight]) -> Option<(Self, &str)> {
        // A light that is none calls for nothing: packing says what is wrong with it
        lights.iter().filter(|light| light.validate().is_ok()).find_map(|light| {
            let missing = light.effects() - self;
            (!missing.is_empty()).then_some((missing, light.name.as_str()))
        })
    }

    /// As [`Effects::missing_for`], of lights that are no polygons.
    pub fn missing_for_shapes(self, shapes: &[crate::ShapeLight]) -> Option<(Self, &str)> {
        shapes.iter().filter(|shape| shape.validate().is_ok()).find_map(|shape| {
            let missing = shape.effects() - self;
            (!missing.is_empty()).then_some((missing, shape.name.as_str()))
        })
    }
}

impl std::fmt::Display for Effects {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_empty() { f.write_str("none") } else { f.write_str(&self.names().join(", ")) }
    }
}

impl std::str::FromStr for Effects {
    type Err = UnknownEffect;

    /// The set of names with commas between them, as [`Display`](std::fmt::Display) writes it; `none` is the empty one.
    fn from_str(text: &str) -> Result<Self, UnknownEffect> {
        let text = text.trim();
        if text == "none" {
            return Ok(Self::empty());
        }
        let effect = |name: &str| {
            let found = Self::all().iter().find(|effect| effect.names() == [name]);
            found.ok_or_else(|| UnknownEffect { name: name.to_owned() })
        };
        text.split(',').map(|name| effect(name.trim())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PolygonLight, Shape, ShapeLight, TubeEnds};
    use glam::{DVec3, Vec3};

    fn light(name: &str, two_sided: bool) -> PolygonLight {
        PolygonLight {
            name: name.into(),
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            radiance: Vec3::ONE,
            two_sided,
            ..PolygonLight::default()
        }
    }

    #[test]
    fn every_effect_has_a_name() {
        assert_eq!(Effects::all().names().len(), Effects::all().iter().count());
        assert_eq!(Effects::empty().to_string(), "none");
        assert_eq!((Effects::DIFFUSE | Effects::TWO_SIDED).to_string(), "diffuse, two_sided");
    }

    #[test]
    fn a_set_is_read_as_it_is_written() {
        for set in [Effects::all(), Effects::empty(), Effects::DIFFUSE | Effects::TEXTURED] {
            assert_eq!(set.to_string().parse(), Ok(set));
        }
        for bad in ["", "diffuse,", "Diffuse", "diffuse glossy", "none, diffuse"] {
            let error = bad.parse::<Effects>().unwrap_err();
            assert!(error.to_string().contains("diffuse, glossy"), "{bad}: {error}");
        }
    }

    #[test]
    fn a_set_too_small_names_the_light() {
        let lights = [light("lamp", false), light("sign", true)];
        assert_eq!(Effects::GLOSSY.missing_for(&lights), Some((Effects::TWO_SIDED, "sign")));
        assert_eq!(Effects::TWO_SIDED.missing_for(&lights), None);
        assert_eq!(Effects::GLOSSY.missing_for(&lights[..1]), None);
        let mut star = light("star", false);
        star.vertices = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y, -DVec3::X].into();
        assert_eq!(Effects::TWO_SIDED.missing_for(&[star]), Some((Effects::POLYGON, "star")));
    }

    #[test]
    fn a_set_without_a_shape_s_kind_names_it() {
        let shape = |name: &str, two_sided, shape| ShapeLight {
            name: name.into(),
            radiance: Vec3::ONE,
            two_sided,
            texture: None,
            shape,
        };
        let (center, radius) = (DVec3::ZERO, 1.0);
        let shapes = [
            shape("sun", false, Shape::Sphere { center, radius }),
            shape("plate", true, Shape::Ellipse { center, axis_u: DVec3::X, axis_v: DVec3::Y }),
            shape("lamp", false, Shape::Tube { p0: center, p1: DVec3::X, radius, ends: TubeEnds::Flat }),
        ];
        let all = Effects::SHAPES | Effects::TWO_SIDED;
        assert_eq!(all.missing_for_shapes(&shapes), None);
        for (without, name) in [
            (Effects::SPHERE, "sun"),
            (Effects::ELLIPSE, "plate"),
            (Effects::TWO_SIDED, "plate"),
            (Effects::TUBE, "lamp"),
        ] {
            assert_eq!((all - without).missing_for_shapes(&shapes), Some((without, name)));
        }
    }
}
