//! Data laid out as the GPU reads it (std430). A test compares every offset with the SPIR-V.

use crate::pyramid::LevelKernel;
use bytemuck::{Pod, Zeroable};

/// A polygon or mesh light: `ArealightGpuLight` in `shaders/kernels/light_records.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Radiance of the front, W/(m² sr).
    pub radiance: [f32; 3],
    /// Index of the first row in the vertex buffer: see [`crate::PackedLights::vertices`].
    pub first_vertex: u32,
    /// The middle of the area, relative to the origin: what the vertices are offsets from.
    pub center: [f32; 3],
    /// Radius of a sphere about the center that holds every vertex.
    pub radius: f32,
    /// Unit normal of the front; zero for a light without area, which gives no light. Of a mesh that of its mean.
    pub normal: [f32; 3],
    /// Area divided by the radius squared; of a mesh that of its area vector.
    pub area: f32,
    /// How many rows the outline has, or the faces of a mesh.
    pub vertex_count: u32,
    /// [`GpuLight::TWO_SIDED`], [`GpuLight::FLAT`], [`GpuLight::MESH`] and [`GpuLight::QUAD`], where they are so.
    pub flags: u32,
    /// Layer of the light textures, or [`GpuLight::NO_TEXTURE`].
    pub texture_layer: u32,
    /// Zero.
    pub reserved: u32,
}

impl GpuLight {
    /// The back emits too.
    pub const TWO_SIDED: u32 = 1;
    /// [`PolygonLight::is_flat`](crate::PolygonLight::is_flat).
    pub const FLAT: u32 = 2;
    /// It has several faces ([`PolygonLight::is_mesh`](crate::PolygonLight::is_mesh)).
    pub const MESH: u32 = 4;
    /// It is convex and has at most four vertices ([`PolygonLight::is_convex_quad`](crate::PolygonLight::is_convex_quad)).
    pub const QUAD: u32 = 8;
    /// No texture.
    pub const NO_TEXTURE: u32 = u32::MAX;
}

/// A disk, sphere or tube as a light, packed by [`crate::ShapeLight::pack`]: `ArealightGpuShape` in
/// `shaders/kernels/light_records.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuShape {
    /// Radiance of the front or outside, W/(m² sr).
    pub radiance: [f32; 3],
    /// [`crate::ShapeKind`], but not `Any`.
    pub kind: u32,
    /// The middle, relative to the origin.
    pub center: [f32; 3],
    /// Of a sphere or tube; of an ellipse the longer half axis, or a little more.
    pub radius: f32,
    /// A half axis of an ellipse; of a tube, from the center to one end. Else zero.
    pub axis_u: [f32; 3],
    /// Of a tube [`crate::TubeEnds`]; of an ellipse the layer of the image that it shows, or [`GpuLight::NO_TEXTURE`]; else zero.
    pub detail: u32,
    /// The other half axis of an ellipse, else zero.
    pub axis_v: [f32; 3],
    /// [`GpuShape::TWO_SIDED`] or zero.
    pub flags: u32,
}

impl GpuShape {
    /// The back of an ellipse, or the inside of a sphere, emits too.
    pub const TWO_SIDED: u32 = 1;
}

/// Push constants of the shade kernel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadeConstants {
    /// The inverse of (projection × view), from clip space (depth as stored, 0 to 1) to positions relative to
    /// the origin, column-major. Read only when positions come from depth.
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many polygon lights are shaded.
    pub light_count: u32,
    /// How many shapes are shaded.
    pub shape_count: u32,
    /// How many of the first polygon lights are convex quads without an image, see [`crate::PackedLights::quad_count`].
    pub quad_count: u32,
}

/// Push constants of the kernels that classify tiles and shade them.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TileConstants {
    /// As [`ShadeConstants::position_from_clip`].
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many lights are shaded.
    pub light_count: u32,
    /// The image's size in pixels.
    pub size: [u32; 2],
    /// The most lights that a tile's list holds.
    pub capacity: u32,
    /// Cells a side of the table's lobe horizons: its size less one.
    pub horizon_cells: u32,
    /// How many shapes are shaded.
    pub shape_count: u32,
    /// As [`ShadeConstants::quad_count`].
    pub quad_count: u32,
    /// As [`crate::plan::TileOptions::cull_threshold`].
    pub cull_threshold: f32,
}

/// How a class of tiles is dispatched.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct GpuTileClass {
    /// Workgroups in x: `VkDispatchIndirectCommand` begins here.
    pub x: u32,
    /// Workgroups in y.
    pub y: u32,
    /// Workgroups in z: 1.
    pub z: u32,
    /// How many tiles there are in the class.
    pub tile_count: u32,
}

/// Push constants of the Monte Carlo reference kernel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ReferenceConstants {
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many lights are shaded.
    pub light_count: u32,
    /// The index of this dispatch's first sample: a pixel's random numbers depend on it, the pixel and `seed`.
    pub first_sample: u32,
    /// Samples this dispatch adds.
    pub sample_count: u32,
    /// What this dispatch's mean is multiplied with before it is added: `sample_count / total`.
    pub weight: f32,
    /// Another seed gives independent noise.
    pub seed: u32,
    /// How many shapes are shaded.
    pub shape_count: u32,
}

/// A light's triangle for the reference's light sampling: three vertex indices, and the sum of the areas of
/// this light's triangles up to and with this one.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuLightTriangle {
    /// Indices into the light vertex buffer.
    pub vertices: [u32; 3],
    /// Cumulative area, divided by the light's area: 1 in the light's last triangle.
    pub cumulative: f32,
}

/// A light's range of triangles for the reference kernel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuLightSampling {
    /// Unit normal of the front; zero for a mesh.
    pub normal: [f32; 3],
    /// Area.
    pub area: f32,
    /// Index of the first triangle.
    pub first_triangle: u32,
    /// How many triangles the light has.
    pub triangle_count: u32,
    /// Zero.
    pub reserved: [u32; 2],
}

/// One shading point of the eval kernel. Its light's center is relative to the point.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuCase {
    /// Normal, of any length.
    pub normal: [f32; 3],
    /// Perceptual roughness.
    pub roughness: f32,
    /// Direction to the viewer, of any length.
    pub view: [f32; 3],
    /// Schlick's reflectance at grazing incidence.
    pub f90: f32,
    /// Lambert albedo.
    pub diffuse_albedo: [f32; 3],
    /// Index of the light.
    pub light: u32,
    /// Schlick's reflectance at normal incidence.
    pub f0: [f32; 3],
    /// Zero.
    pub reserved: u32,
}

/// Push constants of the eval kernel, and of its twin for shapes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct EvalConstants {
    /// How many cases there are.
    pub case_count: u32,
}

/// Push constants of the kernel that loads an image into a layer of the light textures, made by
/// [`crate::TexturePart::load_constants`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TextureLoadConstants {
    /// Where the middle of the layer's first texel is in the image: in texels from the middle of texel 0, rounded
    /// down. Where the image repeats, within its first repeat.
    pub first_texel: [i32; 2],
    /// What was rounded off, 0 to 1.
    pub first_offset: [f32; 2],
    /// Texels of the image from one texel of the layer to the next.
    pub stride: [f32; 2],
    /// [`TextureLoadConstants::SRGB`], and a wrap mode for each axis.
    pub flags: u32,
    /// The layer that is written.
    pub layer: u32,
}

impl TextureLoadConstants {
    /// The image holds sRGB in a format that does not decode by itself.
    pub const SRGB: u32 = GpuTexture::SRGB;
    /// u is clamped to the edge (else repeated).
    pub const CLAMP_U: u32 = GpuTexture::CLAMP_U;
    /// v is clamped to the edge (else repeated).
    pub const CLAMP_V: u32 = GpuTexture::CLAMP_V;
    /// u is mirrored at every repeat.
    pub const MIRROR_U: u32 = GpuTexture::MIRROR_U;
    /// v is mirrored at every repeat.
    pub const MIRROR_V: u32 = GpuTexture::MIRROR_V;

    /// What the kernel must be specialised for, to load with these: bits of [`crate::kernels::constant::CALLED_FOR`].
    pub fn called_for(&self) -> u32 {
        let copies = self.first_offset == [0.0; 2] && self.stride == [1.0; 2];
        let decodes = self.flags & Self::SRGB != 0;
        (u32::from(!copies) * Self::RESAMPLING) | (u32::from(decodes) * Self::DECODING)
    }

    /// Called for: texels are not copied one to one.
    pub const RESAMPLING: u32 = 1;
    /// Called for: sRGB is decoded.
    pub const DECODING: u32 = 2;
}

/// Push constants of the kernel that makes a level of the light textures from the one before.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TextureBlurConstants {
    /// [`crate::pyramid::LevelKernel::weights`].
    pub weights: [f32; LevelKernel::MAX_RADIUS as usize],
    /// The layer of the first group in z.
    pub first_layer: u32,
}

/// A node of a binary bounding volume hierarchy; the root is node 0. The children of an inner node are
/// `first` and `first + 1`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuBvhNode {
    /// The box's smallest corner, relative to the origin.
    pub min: [f32; 3],
    /// The first child, or the first triangle of a leaf.
    pub first: u32,
    /// The box's largest corner.
    pub max: [f32; 3],
    /// Triangles of a leaf; 0 for an inner node.
    pub count: u32,
}

/// A triangle of the visibility kernel, in the order of the hierarchy's leaves.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuTriangle {
    /// First vertex, relative to the origin.
    pub p0: [f32; 3],
    /// Index of the material.
    pub material: u32,
    /// Second vertex.
    pub p1: [f32; 3],
    /// Texture coordinate v of the first vertex.
    pub v0: f32,
    /// Third vertex.
    pub p2: [f32; 3],
    /// Texture coordinate v of the second vertex.
    pub v1: f32,
    /// Normal at the first vertex.
    pub n0: [f32; 3],
    /// Texture coordinate u of the first vertex.
    pub u0: f32,
    /// Normal at the second vertex.
    pub n1: [f32; 3],
    /// Texture coordinate u of the second vertex.
    pub u1: f32,
    /// Normal at the third vertex.
    pub n2: [f32; 3],
    /// Texture coordinate u of the third vertex.
    pub u2: f32,
    /// Texture coordinate v of the third vertex.
    pub v2: f32,
    /// Zero.
    pub reserved: [u32; 3],
}

/// A material of the visibility kernel. Texture indices are [`GpuMaterial::NO_TEXTURE`] where there is none.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuMaterial {
    /// Linear base colour factor.
    pub base_color: [f32; 3],
    /// Metalness factor.
    pub metalness: f32,
    /// Emitted radiance, as the camera sees it.
    pub emission: [f32; 3],
    /// Perceptual roughness factor.
    pub roughness: f32,
    /// Reflectance of the dielectric at normal incidence.
    pub dielectric_f0: [f32; 3],
    /// Reflectance of the dielectric at grazing incidence.
    pub dielectric_f90: f32,
    /// sRGB texture times `base_color`.
    pub base_color_texture: u32,
    /// Linear texture: green times `roughness`, blue times `metalness`.
    pub metallic_roughness_texture: u32,
    /// Tangent-space normal texture.
    pub normal_texture: u32,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// [`GpuMaterial::DOUBLE_SIDED`], [`GpuMaterial::ALPHA_MASK`].
    pub flags: u32,
    /// Base colour alpha below which a masked hit is passed through.
    pub alpha_cutoff: f32,
    /// Base colour alpha factor.
    pub base_alpha: f32,
    /// sRGB texture times `emission`.
    pub emission_texture: u32,
}

impl GpuMaterial {
    /// No texture.
    pub const NO_TEXTURE: u32 = u32::MAX;
    /// Seen from both sides.
    pub const DOUBLE_SIDED: u32 = 1;
    /// Transparent where the base colour's alpha is below the cutoff.
    pub const ALPHA_MASK: u32 = 2;
}

/// A texture of the visibility kernel: a range of the texel buffer, one RGBA8 texel a `u32`, red in the low
/// byte, rows from the top.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct GpuTexture {
    /// Index of the first texel.
    pub first_texel: u32,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// [`GpuTexture::SRGB`], and a wrap mode for each axis.
    pub flags: u32,
}

impl GpuTexture {
    /// Red, green and blue are sRGB-encoded.
    pub const SRGB: u32 = 1;
    /// u is clamped to the edge (else repeated).
    pub const CLAMP_U: u32 = 2;
    /// v is clamped to the edge (else repeated).
    pub const CLAMP_V: u32 = 4;
    /// u is mirrored at every repeat.
    pub const MIRROR_U: u32 = 8;
    /// v is mirrored at every repeat.
    pub const MIRROR_V: u32 = 16;
}

/// Push constants of the visibility kernel: a pinhole camera.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct VisibilityConstants {
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many nodes the hierarchy has; 0 for a scene without triangles.
    pub node_count: u32,
    /// From the middle of the image to its right edge, at distance 1 along `forward`.
    pub right: [f32; 3],
    /// Zero.
    pub reserved0: u32,
    /// From the middle of the image to its top edge, at distance 1.
    pub up: [f32; 3],
    /// Zero.
    pub reserved1: u32,
    /// Unit viewing direction.
    pub forward: [f32; 3],
    /// Zero.
    pub reserved2: u32,
    /// Radiance where nothing is hit.
    pub background: [f32; 3],
    /// Zero.
    pub reserved3: u32,
}
