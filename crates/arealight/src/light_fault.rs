//! The faults of lights.

use glam::{DVec2, DVec3, Vec3};

/// The most vertices of a mesh's face: what float32 counts.
pub(crate) const MAX_FACE: u32 = 1 << 24;

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
    #[error("vertices[{index}]: {value} is not a finite float32 position relative to the origin")]
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
    #[error(
        "holes[{hole}]: vertices[{index}]: {value} is not a finite float32 position relative to the origin"
    )]
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
    #[error("faces[{face}]: {count} vertices, a face has at most {}", MAX_FACE)]
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
        light shows into a layer of its own"
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
    /// A profile's pairs or levels.
    #[error("profile: {reason}")]
    BadProfile {
        /// What is wrong with it.
        reason: String,
    },
    /// An opening that a light can't be seen through.
    #[error("opening: {reason}")]
    BadOpening {
        /// What is wrong with it.
        reason: String,
    },
    /// Only flat lights have a front to measure a profile's angles from, or an outline for an opening.
    #[error(
        "profile or opening: of a mesh, sphere, tube or disk with an image: give it to flat faces that are \
         lights of their own"
    )]
    ProfileNotFlat,
    /// The outline of a light with a profile is clipped by disks, edge by edge.
    #[error("profile: of an outline that is not flat and convex: cut it into convex lights")]
    ProfileConcave,
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
    pub(crate) fn of(self, index: usize, name: &str) -> LightError {
        LightError { index, name: name.to_owned(), fault: self }
    }
}
