//! Lights of every shape, in one list.

use crate::light_texture::{LightTexture, TextureMap};
use crate::{Effects, LightShape};
use glam::{DVec2, DVec3, Vec3};

/// A light of constant radiance, or a textured one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Light {
    /// A name for messages; it need not be unique, and may be empty.
    pub name: String,
    /// Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: Vec3,
    /// Whether the back of a polygon, mesh or disk, or the inside of a sphere, emits too. Of a tube only the
    /// outside is shaded.
    pub two_sided: bool,
    /// An image that multiplies the radiance of a polygon or disk; the back shows it mirrored, as a slide
    /// does.
    pub texture: Option<LightTexture>,
    /// What shines.
    pub shape: LightShape,
}

/// A light of a list that cannot be used. Nothing is packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("lights[{index}]{}: {fault}", quoted(name))]
pub struct LightError {
    /// Its place in the list.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub fault: LightFault,
}

fn quoted(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!(" '{name}'") }
}

/// What is wrong with a light: its messages begin with the field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LightFault {
    /// A polygon has three vertices or more.
    #[error("vertices: {count} given, a polygon has at least 3")]
    TooFewVertices {
        /// How many it has.
        count: usize,
    },
    /// A vertex is NaN, infinite, or farther from the origin than float32 reaches.
    #[error("vertices[{index}]: {value} is not a finite float32 position")]
    VertexNotFinite {
        /// The vertex.
        index: usize,
        /// Its position.
        value: DVec3,
    },
    /// A position or axis of a disk, sphere or tube is NaN, infinite, or farther from the origin than float32
    /// reaches.
    #[error("{field}: {value} is not a finite float32 vector")]
    NotFinite {
        /// The field of its shape.
        field: &'static str,
        /// What it holds.
        value: DVec3,
    },
    /// A radius is not above zero, or outside the range of float32.
    #[error("radius: {value} must be above zero and within the range of float32")]
    BadRadius {
        /// The radius given.
        value: f64,
    },
    /// The axes of a disk are zero or parallel, to the precision of float32.
    #[error("axis_u and axis_v: {axis_u} and {axis_v} span no ellipse")]
    NoArea {
        /// A half axis.
        axis_u: DVec3,
        /// The other one.
        axis_v: DVec3,
    },
    /// The ends of a tube are one point, to the precision of float32.
    #[error("p0 and p1: {value} is both ends of the axis; a sphere has one center")]
    NoAxis {
        /// The point.
        value: DVec3,
    },
    /// Radiance is NaN, infinite or negative.
    #[error("radiance: {value} must be finite and not negative")]
    BadRadiance {
        /// The radiance given.
        value: Vec3,
    },
    /// A hole has three vertices or more.
    #[error("holes[{hole}]: {count} vertices given, a hole has at least 3")]
    HoleTooFewVertices {
        /// The hole.
        hole: usize,
        /// How many it has.
        count: usize,
    },
    /// A hole's vertex is NaN, infinite, or farther from the origin than float32 reaches.
    #[error("holes[{hole}]: vertices[{index}]: {value} is not a finite float32 position")]
    HoleVertexNotFinite {
        /// The hole.
        hole: usize,
        /// The vertex.
        index: usize,
        /// Its position.
        value: DVec3,
    },
    /// A hole's vertex is not in the polygon's plane.
    #[error("holes[{hole}]: vertices[{index}]: {distance} off the polygon's plane: a hole lies in it")]
    HoleOffPlane {
        /// The hole.
        hole: usize,
        /// The vertex.
        index: usize,
        /// How far it is off.
        distance: f64,
    },
    /// A hole's vertex is outside the polygon, or in another hole.
    #[error(
        "holes[{hole}]: vertices[{index}]: outside the polygon, or in another hole: merge holes that overlap"
    )]
    HoleOutside {
        /// The hole.
        hole: usize,
        /// The vertex.
        index: usize,
    },
    /// A hole touches or crosses the outline, another hole or itself.
    #[error("holes[{hole}]: touches or crosses the outline, another hole or itself")]
    HoleCrosses {
        /// The hole.
        hole: usize,
    },
    /// A hole has no area, or the polygon has none.
    #[error("holes[{hole}]: no area: of the hole, or of the polygon it is in")]
    HoleNoArea {
        /// The hole.
        hole: usize,
    },
    /// There is no way from a hole to the outline that crosses nothing: vertices are as near to each other as
    /// float64 can tell.
    #[error("holes[{hole}]: no straight way to the outline: vertices lie too near to each other")]
    HoleNoBridge {
        /// The hole.
        hole: usize,
    },
    /// The light is a mesh, disk, sphere or tube, which has no holes.
    #[error("holes: only polygons have holes: cut them into a face before it is added")]
    HolesNoPolygon,
    /// A face has three vertices or more.
    #[error("faces[{face}]: {count} vertices, a face has at least 3")]
    FaceTooFewVertices {
        /// The face.
        face: usize,
        /// How many it has.
        count: u32,
    },
    /// A face has more vertices than the GPU's count of them reaches.
    #[error("faces[{face}]: {count} vertices, a face has at most {}", LightShape::MAX_FACE)]
    FaceTooManyVertices {
        /// The face.
        face: usize,
        /// How many it has.
        count: u32,
    },
    /// The faces have not as many vertices as the light.
    #[error(
        "faces: {faces} vertices in all, but the light has {vertices}: each face has vertices of its own"
    )]
    FaceCount {
        /// Vertices of all faces.
        faces: u64,
        /// Vertices of the light.
        vertices: usize,
    },
    /// A triangle refers to a vertex that is not there.
    #[error("triangles[{triangle}]: vertex {index}, but there are {count}")]
    TriangleOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The index that it has.
        index: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// No triangle has an area.
    #[error("triangles: none has an area")]
    TrianglesNoArea,
    /// The light has several faces, which one image does not fit.
    #[error("texture: a mesh is not textured; give the faces that are lights of their own")]
    TextureOfMesh,
    /// The light is a sphere or tube, which are not textured.
    #[error("texture: only polygons and disks are textured; a sphere or tube has one colour")]
    TextureOfSolid,
    /// There must be one texture coordinate per vertex.
    #[error("texture: uvs: {uvs} given for {vertices} vertices; give one each")]
    TextureCount {
        /// Coordinates.
        uvs: usize,
        /// Vertices.
        vertices: usize,
    },
    /// A texture coordinate is NaN or outside of the image.
    #[error(
        "texture: uvs[{index}]: {value} is not within 0 to 1; load the part of the repeated image that the \
        light shows \
         into a layer of its own"
    )]
    TextureOutside {
        /// The vertex.
        index: usize,
        /// Its coordinate.
        value: DVec2,
    },
    /// The texture coordinates are not an affine function of the positions.
    #[error(
        "texture: uvs[{index}]: {off} off a straight mapping of the polygon; split the polygon where its \
        mapping bends"
    )]
    TextureBent {
        /// The vertex that is farthest off.
        index: usize,
        /// How far, in texture coordinates.
        off: f64,
    },
    /// The texture coordinates lie on a line, or the polygon's vertices do.
    #[error("texture: uvs: they span no area; a light of one colour needs no texture")]
    TextureFlat,
    /// Its texture is a layer that the light textures do not have.
    #[error("texture: layer {layer} is not there: there are {layers}")]
    NoTextureLayer {
        /// The layer that it refers to.
        layer: u32,
        /// How many layers there are.
        layers: u32,
    },
    /// With it the list has more vertices than a 32-bit index reaches.
    #[error("vertices: {count} up to this light, at most {} fit one buffer", u32::MAX)]
    TooManyVertices {
        /// How many there are.
        count: usize,
    },
}

impl LightFault {
    /// The error of a list's light.
    pub(crate) fn of(self, index: usize, light: &Light) -> LightError {
        LightError { index, name: light.name.clone(), fault: self }
    }
}

impl Light {
    /// Checks that the light can be shaded.
    ///
    /// # Errors
    /// [`LightFault`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightFault> {
        if self.shape.is_polygonal() {
            self.mapped().map(drop)
        } else {
            self.pack_shape(DVec3::ZERO).map(drop)
        }
    }

    /// Checks that a polygon or mesh can be shaded, and maps its texture.
    pub(crate) fn mapped(&self) -> Result<Option<TextureMap>, LightFault> {
        let vertices = self.shape.vertices();
        if vertices.len() < 3 {
            return Err(LightFault::TooFewVertices { count: vertices.len() });
        }
        for (index, &value) in vertices.iter().enumerate() {
            if !value.as_vec3().is_finite() {
                return Err(LightFault::VertexNotFinite { index, value });
            }
        }
        self.shape.check_faces()?;
        self.check_radiance()?;
        self.texture.as_ref().map(|texture| texture.map(&self.shape)).transpose()
    }

    pub(crate) fn check_radiance(&self) -> Result<(), LightFault> {
        if self.radiance.is_finite() && self.radiance.min_element() >= 0.0 {
            Ok(())
        } else {
            Err(LightFault::BadRadiance { value: self.radiance })
        }
    }

    /// Checks that a textured light's layer is among `layers`.
    ///
    /// # Errors
    /// [`LightFault::NoTextureLayer`] where it is not: the device would show another.
    pub fn check_texture_layer(&self, layers: u32) -> Result<(), LightFault> {
        match &self.texture {
            Some(texture) if texture.layer >= layers => {
                Err(LightFault::NoTextureLayer { layer: texture.layer, layers })
            }
            _ => Ok(()),
        }
    }

    /// As [`Light::check_texture_layer`], of every light of a list.
    ///
    /// # Errors
    /// [`LightError`] names the first light whose layer is not there.
    pub fn check_texture_layers(lights: &[Self], layers: u32) -> Result<(), LightError> {
        lights.iter().enumerate().try_for_each(|(index, light)| {
            light.check_texture_layer(layers).map_err(|fault| fault.of(index, light))
        })
    }

    /// The effects that the light needs.
    pub fn effects(&self) -> Effects {
        let textured = self.texture.is_some();
        // A tube's inside is not shaded
        let two_sided = self.two_sided && !matches!(self.shape, LightShape::Tube { .. });
        let mut effects = Effects::empty();
        effects.set(Effects::TWO_SIDED, two_sided);
        match self.shape {
            LightShape::Polygon(_) | LightShape::Mesh { .. } => {
                effects.set(Effects::POLYGON, !self.shape.is_convex_quad());
                effects.set(Effects::TEXTURED, textured);
                effects.set(Effects::MESH, self.shape.is_mesh());
            }
            LightShape::Disk { .. } => {
                effects |= Effects::ELLIPSE;
                effects.set(Effects::TEXTURED_ELLIPSE, textured);
            }
            LightShape::Sphere { .. } => effects |= Effects::SPHERE,
            LightShape::Tube { .. } => effects |= Effects::TUBE,
        }
        effects
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::PackedLights;

    pub(crate) fn arrow() -> Light {
        // A concave quad in the plane z = 2, counter-clockwise from above, so it emits upwards
        Light {
            name: "arrow".into(),
            radiance: Vec3::new(1.0, 2.0, 3.0),
            shape: LightShape::Polygon(vec![
                DVec3::new(0.0, 0.0, 2.0),
                DVec3::new(2.0, 1.0, 2.0),
                DVec3::new(0.0, 2.0, 2.0),
                DVec3::new(1.0, 1.0, 2.0),
            ]),
            ..Light::default()
        }
    }

    #[test]
    fn bad_lights_are_named_and_refused() {
        let two = Light { shape: LightShape::Polygon(arrow().shape.vertices()[..2].to_vec()), ..arrow() };
        let error = PackedLights::new(&[arrow(), two.clone()], DVec3::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "lights[1] 'arrow': vertices: 2 given, a polygon has at least 3");
        let error = PackedLights::new(&[Light { name: String::new(), ..two }], DVec3::ZERO).unwrap_err();
        assert_eq!(error.to_string(), "lights[0]: vertices: 2 given, a polygon has at least 3");
        let with = |index: usize, x: f64| {
            let mut light = arrow();
            light.shape.vertices_mut()[index].x = x;
            light
        };
        for (index, value) in [(2, f64::NAN), (1, 1e39)] {
            let fault = with(index, value).validate().unwrap_err();
            assert!(matches!(fault, LightFault::VertexNotFinite { index: found, .. } if found == index));
        }
        let mut light = with(0, -3e38);
        light.shape.vertices_mut()[2].x = 3e38;
        let error = PackedLights::new(&[light], DVec3::ZERO).unwrap_err();
        assert!(matches!(error.fault, LightFault::VertexNotFinite { .. }), "{error}");
        let mut light = arrow();
        light.radiance.y = -1.0;
        assert!(matches!(light.validate(), Err(LightFault::BadRadiance { .. })));
    }
}
