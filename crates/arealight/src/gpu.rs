//! Data laid out as the GPU reads it (std430). A test compares every offset with the SPIR-V.

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
    /// Unit normal of the front; zero for a light without area, which gives no light. Of a mesh that of its
    /// mean.
    pub normal: [f32; 3],
    /// Area divided by the radius squared; of a mesh that of its area vector.
    pub area: f32,
    /// How many rows the outline has, or the faces of a mesh.
    pub vertex_count: u32,
    /// [`GpuLight::TWO_SIDED`], [`GpuLight::FLAT`], [`GpuLight::MESH`], [`GpuLight::QUAD`],
    /// [`GpuLight::PROFILE`] and [`GpuLight::OPENING`], where they are so; links from
    /// [`GpuLight::LINKS_SHIFT`] on.
    pub flags: u32,
    /// Layer of the light textures, or [`GpuLight::NO_TEXTURE`].
    pub texture_layer: u32,
    /// The first row of its opening in the vertex buffer, with [`GpuLight::OPENING`], which that of its
    /// profile follows, with [`GpuLight::PROFILE`]; else zero.
    pub shaping: u32,
}

impl GpuLight {
    /// The back emits too.
    pub const TWO_SIDED: u32 = 1;
    /// [`LightShape::is_flat`](crate::LightShape::is_flat).
    pub const FLAT: u32 = 2;
    /// It has several faces ([`LightShape::is_mesh`](crate::LightShape::is_mesh)).
    pub const MESH: u32 = 4;
    /// It is convex and has at most four vertices
    /// ([`LightShape::is_convex_quad`](crate::LightShape::is_convex_quad)).
    pub const QUAD: u32 = 8;
    /// It has a profile: the upper half of the flags is the cosine, of 65535, of an angle that it ends
    /// within.
    pub const PROFILE: u32 = 16;
    /// It is seen through an opening.
    pub const OPENING: u32 = 32;
    /// It has one or the other, or both.
    pub const SHAPED: u32 = Self::PROFILE | Self::OPENING;
    /// Where that cosine begins.
    pub const PROFILE_END_SHIFT: u32 = 16;
    /// Where [`Light::links`](crate::Light::links) begin, in flags of either record.
    pub const LINKS_SHIFT: u32 = 8;
    /// No texture.
    pub const NO_TEXTURE: u32 = u32::MAX;
}

/// A disk, sphere or tube as a light: `ArealightGpuShape` in
/// `shaders/kernels/light_records.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuShape {
    /// Radiance of the front or outside, W/(m² sr).
    pub radiance: [f32; 3],
    /// [`GpuShape::DISK`], [`GpuShape::SPHERE`] or [`GpuShape::TUBE`].
    pub kind: u32,
    /// The middle, relative to the origin.
    pub center: [f32; 3],
    /// Of a sphere or tube; of a disk the longer half axis, or a little more.
    pub radius: f32,
    /// A half axis of a disk; of a tube, from the center to one end. Else zero.
    pub axis_u: [f32; 3],
    /// Of a tube [`crate::TubeEnds`]; of a disk the layer of its texture, or [`GpuLight::NO_TEXTURE`]; else
    /// zero.
    pub detail: u32,
    /// The other half axis of a disk, else zero.
    pub axis_v: [f32; 3],
    /// [`GpuShape::TWO_SIDED`] or zero; links from [`GpuLight::LINKS_SHIFT`] on.
    pub flags: u32,
}

impl GpuShape {
    /// The back of a disk, or the inside of a sphere, emits too.
    pub const TWO_SIDED: u32 = 1;
    /// A kind: [`LightShape::Disk`](crate::LightShape::Disk).
    pub const DISK: u32 = 0;
    /// A kind: [`LightShape::Sphere`](crate::LightShape::Sphere).
    pub const SPHERE: u32 = 1;
    /// A kind: [`LightShape::Tube`](crate::LightShape::Tube).
    pub const TUBE: u32 = 2;
    /// No record's kind; as a specialisation constant, each shape is what its record says: for lists of
    /// several kinds.
    pub const ANY: u32 = 3;
}

/// Push constants of the kernels that shade frames and classify their tiles.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct ShadeConstants {
    /// The inverse of (projection × view), from clip space (depth as stored, 0 to 1) to positions relative to
    /// the origin, column-major. Read only when positions come from depth.
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin; of an orthographic camera the direction to it.
    pub camera: [f32; 3],
    /// How many polygon lights are shaded.
    pub light_count: u32,
    /// How many shapes are shaded.
    pub shape_count: u32,
    /// How many of the first polygon lights are convex quads without a texture, see
    /// [`crate::LightSummary::quad_count`].
    pub quad_count: u32,
    /// Of the random numbers that lights are picked for shadow rays with; not read without those.
    pub seed: u32,
    /// The most lights that a tile's list holds; not read without tiles.
    pub capacity: u32,
    /// The image's size in pixels.
    pub size: [u32; 2],
    /// Cells a side of the table's lobe horizons: its size less one. Not read without tiles.
    pub horizon_cells: u32,
    /// As [`crate::plan::TileOptions::cull_threshold`]. Not read without tiles.
    pub cull_threshold: f32,
    /// Where the image's rectangle begins that is shaded; not read without
    /// [`crate::plan::ShadeOptions::rectangle`].
    pub offset: [u32; 2],
    /// Of the stencil test: the compare mask, and the reference from bit 8 on. Not read without
    /// [`crate::plan::ShadeOptions::stencil`].
    pub stencil: u32,
}

/// How many lights a frame has, where the GPU says so: [`crate::plan::ShadeOptions::light_counts`].
/// `LightCounts` in `shaders/kernels/light_counts.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct LightCounts {
    /// How many of the polygon lights are shaded, from the buffer's first on.
    pub light_count: u32,
    /// How many of the shapes.
    pub shape_count: u32,
    /// How many of the first polygon lights are convex quads without a texture; no other light may be before
    /// them. Not read where the frame's lights are all such quads.
    pub quad_count: u32,
}

/// Push constants of the kernels that trace shadow rays and filter them.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadowConstants {
    /// As [`ShadeConstants::position_from_clip`].
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// Of the random numbers that rays are drawn with.
    pub seed: u32,
    /// The image's size in pixels.
    pub size: [u32; 2],
}

/// Push constants of the kernels of a medium.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
pub struct MediumConstants {
    /// As [`ShadeConstants::position_from_clip`].
    pub position_from_clip: [[f32; 4]; 4],
    /// The camera's position relative to the origin.
    pub camera: [f32; 3],
    /// How many polygon lights shine.
    pub light_count: u32,
    /// What is scattered per unit of length, a channel.
    pub scattering: [f32; 3],
    /// What is scattered or absorbed per unit of length.
    pub extinction: f32,
    /// How many shapes shine.
    pub shape_count: u32,
    /// How many of the first polygon lights are convex quads without a texture.
    pub quad_count: u32,
    /// Of the random numbers that distances and rays are drawn with.
    pub seed: u32,
    /// Henyey and Greenstein's g.
    pub anisotropy: f32,
    /// Froxels of a slice: columns, and rows from bit 16 on.
    pub columns_rows: u32,
    /// How many slices there are; in the upper 16 bits those of the float of the radiance that a pixel may
    /// lose.
    pub slices_cull: u32,
    /// About where slices begin to grow.
    pub nearest: f32,
    /// Where they end.
    pub farthest: f32,
}

/// A node of a binary hierarchy of boxes, [`crate::Blockers::nodes`]: `ArealightGpuBvhNode` in
/// `shaders/kernels/bvh.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GpuBvhNode {
    /// The box's smallest corner, relative to the origin.
    pub min: [f32; 3],
    /// Index of the first of a leaf's triangles; or of the node after all those in an inner node, of whose
    /// two children the first is the next node. A root of zeros holds nothing.
    pub first: u32,
    /// The box's largest corner.
    pub max: [f32; 3],
    /// Triangles of a leaf; 0 for an inner node.
    pub count: u32,
}

impl GpuBvhNode {
    /// Whether it has children.
    pub fn is_inner(&self) -> bool {
        self.count == 0 && self.first > 0
    }

    /// The node after all those in this one, which is at `index`: where a ray that misses it goes on.
    pub fn end(&self, index: usize) -> usize {
        if self.is_inner() { self.first as usize } else { index + 1 }
    }
}

/// Push constants of the kernel that loads an image into a layer of the light textures, made by
/// [`crate::TexturePart::load_constants`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TextureLoadConstants {
    /// Where the middle of the layer's first texel is in the image: in texels from the middle of texel 0,
    /// rounded down. Where the image repeats, within its first repeat.
    pub first_texel: [i32; 2],
    /// What was rounded off, 0 to 1.
    pub first_offset: [f32; 2],
    /// Texels of the image from one texel of the layer to the next.
    pub stride: [f32; 2],
    /// [`TextureLoadConstants::SRGB`], and a wrap mode for each axis.
    pub flags: u32,
    /// The layer that is written.
    pub layer: u32,
    /// What texels are multiplied by.
    pub factor: f32,
}

impl TextureLoadConstants {
    /// The image holds sRGB in a format that does not decode by itself.
    pub const SRGB: u32 = 1;
    /// u is clamped to the edge (else repeated).
    pub const CLAMP_U: u32 = 2;
    /// v is clamped to the edge (else repeated).
    pub const CLAMP_V: u32 = 4;
    /// u is mirrored at every repeat.
    pub const MIRROR_U: u32 = 8;
    /// v is mirrored at every repeat.
    pub const MIRROR_V: u32 = 16;

    /// What the kernel does beyond copying, to load with these: bits of
    /// [`crate::kernels::constant::LOAD_STEPS`].
    pub fn steps(&self) -> u32 {
        let copies = self.first_offset == [0.0; 2] && self.stride == [1.0; 2];
        let decodes = self.flags & Self::SRGB != 0;
        (u32::from(!copies) * Self::RESAMPLE) | (u32::from(decodes) * Self::DECODE)
    }

    /// A step: texels are resampled.
    pub const RESAMPLE: u32 = 1;
    /// A step: sRGB is decoded.
    pub const DECODE: u32 = 2;
}
