//! What lights and surfaces need. The set becomes one specialisation constant, and the code of every effect
//! that is not in it is removed.

bitflags::bitflags! {
    /// A set of effects: the lobes, light properties and surface inputs that a shade pass must handle.
    ///
    /// The bits are those of `shaders/kernels/effects.glsl`; a test compares the two. What lights need is
    /// known when they are packed ([`LightSummary::effects`](crate::LightSummary::effects)); what surfaces
    /// need ([`Effects::SURFACES`]) the host says.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
        /// ([`LightShape::is_convex_quad`](crate::LightShape::is_convex_quad) is false).
        const POLYGON = 1 << 4;
        /// Some polygon is textured ([`Light::texture`](crate::Light::texture)).
        const TEXTURED = 1 << 5;
        /// Some light is a disk or an ellipse ([`LightShape::Disk`](crate::LightShape::Disk)).
        const ELLIPSE = 1 << 8;
        /// Some light is a sphere ([`LightShape::Sphere`](crate::LightShape::Sphere)).
        const SPHERE = 1 << 9;
        /// Some light is a cylinder or a capsule ([`LightShape::Tube`](crate::LightShape::Tube)).
        const TUBE = 1 << 10;
        /// Some light has several faces ([`LightShape::is_mesh`](crate::LightShape::is_mesh)). Such a light
        /// needs [`Effects::POLYGON`], too.
        const MESH = 1 << 11;
        /// Some disk or ellipse is textured ([`Light::texture`](crate::Light::texture)). Such a light needs
        /// [`Effects::ELLIPSE`], too.
        const TEXTURED_ELLIPSE = 1 << 12;
        /// Some surface has a clear coat, so the G-buffer's image of coats is read.
        const COAT = 1 << 13;
        /// Some coat has a normal of its own, other than its surface's. Such a surface needs
        /// [`Effects::COAT`], too.
        const COAT_NORMAL = 1 << 14;
        /// The diffuse lobe gets what the Fresnel term above it leaves, as in glTF; else it is added to the
        /// specular lobe, as in many engines, and dielectrics reflect 4 to 24 % too much.
        const COUPLED = 1 << 15;
        /// It gets what the specular lobe's albedo leaves, as in OpenPBR. With [`Effects::COUPLED`].
        const COUPLED_BY_ALBEDO = 1 << 16;
        /// What is below a coat gets what the coat's albedo leaves, as in OpenPBR; else what a Fresnel term
        /// of the view does, as in glTF. With [`Effects::COAT`].
        const COAT_BY_ALBEDO = 1 << 17;
        /// Some diffuse lobe is rough, EON instead of Lambert's, so the G-buffer's image of anisotropy is
        /// read.
        const DIFFUSE_ROUGHNESS = 1 << 18;
        /// Some surface has sheen, so the G-buffer's image of sheen is read.
        const SHEEN = 1 << 19;
        /// Some surface's GGX lobe has two roughnesses, along a tangent and across it, so the G-buffer's
        /// image of anisotropy is read.
        const ANISOTROPY = 1 << 20;
        /// Adds multiple scattering of specular lobes, as in OpenPBR; else it is lost, as in glTF, and rough
        /// metals are up to 60 % too dark. Metals have a diffuse lobe then.
        const MULTIPLE_SCATTERING = 1 << 21;
        /// Some thin surface lets light through. A pass with this shades what the G-buffer holds from behind,
        /// for a pass of its own: its base colour is the part of the light that is let through, and its
        /// normals are those of the front ([`Effects::passes`]).
        const TRANSMISSION = 1 << 22;
        /// Some surface has a thin film that its reflectances lack, so the G-buffer's image of films is read.
        /// Without it a host may put films into the reflectances, for what a few evaluations a pixel cost;
        /// with it lobes over half vectors
        /// ([`SpecularLobes::HalfVectors`](crate::SpecularLobes::HalfVectors)) show each light at its own
        /// facets' angle.
        const THIN_FILM = 1 << 23;
        /// Some thin surface lets light through without diffusing it: a pane of glass, smooth or rough. The
        /// pass over the other side has the GLOSSY lobe then, and the metalness of what it reads is the part
        /// of its base colour that is let through so ([`Effects::passes`]). A pass itself ignores it.
        const GLASS = 1 << 24;
        /// Some light has a profile ([`Light::profile`](crate::Light::profile)).
        const PROFILE = 1 << 25;
        /// Some light is seen through an opening ([`Light::opening`](crate::Light::opening)).
        const OPENING = 1 << 26;
        /// Lights shine on surfaces of some groups alone ([`Light::links`](crate::Light::links)), so the
        /// G-buffer's image of stencils is read. Said of surfaces; without it such lights shine on all.
        const LINKED = 1 << 27;
        /// Some profile is not round about the normal. Such a light needs [`Effects::PROFILE`], too.
        const AZIMUTH = 1 << 28;
    }
}

impl Effects {
    /// Every kind of light but polygons and meshes.
    pub const SHAPES: Self = Self::ELLIPSE.union(Self::SPHERE).union(Self::TUBE);

    /// Any of these is of lights with a profile or an opening.
    pub const SHAPED: Self = Self::PROFILE.union(Self::OPENING);

    /// Any of these is of lights that are no convex quads without an image, a profile or an opening.
    pub const BEYOND_QUADS: Self = Self::POLYGON.union(Self::TEXTURED).union(Self::MESH).union(Self::SHAPED);

    /// Every lobe: without any of these surfaces are black.
    pub const LOBES: Self = Self::DIFFUSE.union(Self::GLOSSY).union(Self::COAT).union(Self::SHEEN);

    /// With any of these the light textures are read.
    pub const IMAGES: Self = Self::TEXTURED.union(Self::TEXTURED_ELLIPSE);

    /// How layers of surfaces share light, the material model, and from which side it comes: choices of the
    /// host's that change the picture. Of every other effect the code alone changes nothing where no surface
    /// or light needs it.
    pub const MODEL: Self = Self::COUPLED
        .union(Self::COUPLED_BY_ALBEDO)
        .union(Self::COAT_BY_ALBEDO)
        .union(Self::MULTIPLE_SCATTERING)
        .union(Self::TRANSMISSION)
        .union(Self::GLASS);

    /// What surfaces need, whatever the lights.
    pub const SURFACES: Self = Self::DIFFUSE
        .union(Self::GLOSSY)
        .union(Self::SPECULAR_INPUT)
        .union(Self::COAT)
        .union(Self::COAT_NORMAL)
        .union(Self::MODEL)
        .union(Self::DIFFUSE_ROUGHNESS)
        .union(Self::SHEEN)
        .union(Self::ANISOTROPY)
        .union(Self::THIN_FILM)
        .union(Self::LINKED);

    /// What lights of any kind may have.
    pub const OF_ANY_KIND: Self = Self::TWO_SIDED.union(Self::LINKED);

    /// What each pass over surfaces with these effects has, its radiance added to that of the one before:
    /// what is reflected, and what is let through below the same interface, with [`Effects::TRANSMISSION`] by
    /// an ideally diffusing sheet, with [`Effects::GLASS`] by a pane.
    pub fn passes(self) -> impl Iterator<Item = Self> {
        let below_interface =
            Self::COUPLED | Self::SPECULAR_INPUT | Self::THIN_FILM | Self::TRANSMISSION | Self::LINKED;
        let lets_through = Self::TRANSMISSION | Self::GLASS;
        let reflects = !self.intersects(lets_through) || self.intersects(Self::LOBES);
        let mut transmitted = (self & below_interface) | Self::TRANSMISSION;
        transmitted.set(Self::DIFFUSE, self.contains(Self::TRANSMISSION));
        if self.contains(Self::GLASS) {
            transmitted |= Self::GLOSSY | (self & Self::ANISOTROPY);
        }
        let transmitted = self.intersects(lets_through).then_some(transmitted);
        [reflects.then_some(self - lets_through), transmitted].into_iter().flatten()
    }

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
            (Self::COAT, "coat"),
            (Self::COAT_NORMAL, "coat_normal"),
            (Self::COUPLED, "coupled"),
            (Self::COUPLED_BY_ALBEDO, "coupled_by_albedo"),
            (Self::COAT_BY_ALBEDO, "coat_by_albedo"),
            (Self::DIFFUSE_ROUGHNESS, "diffuse_roughness"),
            (Self::SHEEN, "sheen"),
            (Self::ANISOTROPY, "anisotropy"),
            (Self::MULTIPLE_SCATTERING, "multiple_scattering"),
            (Self::TRANSMISSION, "transmission"),
            (Self::THIN_FILM, "thin_film"),
            (Self::GLASS, "glass"),
            (Self::PROFILE, "profile"),
            (Self::OPENING, "opening"),
            (Self::LINKED, "linked"),
            (Self::AZIMUTH, "azimuth"),
        ]
        .into_iter()
        .filter_map(|(effect, name)| self.contains(effect).then_some(name))
        .collect()
    }
}

impl std::fmt::Display for Effects {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_empty() { f.write_str("none") } else { f.write_str(&self.names().join(", ")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_that_is_let_through_has_a_pass_of_its_own() {
        let opaque = Effects::DIFFUSE | Effects::GLOSSY | Effects::COUPLED | Effects::COAT;
        assert!(opaque.passes().eq([opaque]));
        let transmitted = Effects::DIFFUSE | Effects::COUPLED | Effects::TRANSMISSION;
        assert!((opaque | Effects::TRANSMISSION).passes().eq([opaque, transmitted]));
        // A pane has the lobe that is mirrored, of a paper pane both
        let pane = Effects::GLOSSY | Effects::COUPLED | Effects::TRANSMISSION;
        assert!((opaque | Effects::GLASS).passes().eq([opaque, pane]));
        let both = (opaque | Effects::GLASS | Effects::TRANSMISSION).passes();
        assert!(both.eq([opaque, pane | Effects::DIFFUSE]));
        // A film is part of the interface
        let below_film = (opaque | Effects::THIN_FILM | Effects::TRANSMISSION).passes();
        assert!(below_film.eq([opaque, transmitted].map(|pass| pass | Effects::THIN_FILM)));
    }

    #[test]
    fn every_effect_has_a_name() {
        assert_eq!(Effects::all().names().len(), Effects::all().iter().count());
        assert_eq!(Effects::empty().to_string(), "none");
        assert_eq!((Effects::DIFFUSE | Effects::TWO_SIDED).to_string(), "diffuse, two_sided");
    }
}
