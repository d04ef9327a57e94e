//! What crosses the boundary.
//!
//! Handles of Vulkan: those that are pointers everywhere (instance, device, command buffer) are `void *`, all others
//! `uint64_t`, so that vulkan.h is not needed.

use std::ffi::{c_char, c_void};

/// The Lambert lobe: some surface has a metalness below one and a base colour that is not black.
pub const AREALIGHT_EFFECT_DIFFUSE: u32 = 1;
/// The GGX lobe: some surface reflects specularly.
pub const AREALIGHT_EFFECT_GLOSSY: u32 = 2;
/// Some light lights both of its sides.
pub const AREALIGHT_EFFECT_TWO_SIDED: u32 = 4;
/// Some surface has a dielectric reflectance of its own: ArealightResources.specular is read.
pub const AREALIGHT_EFFECT_SPECULAR_INPUT: u32 = 8;
/// Some light is concave, not quite flat, or has more than four vertices.
pub const AREALIGHT_EFFECT_POLYGON: u32 = 16;
/// Some light shows an image: ArealightResources.light_textures is read.
pub const AREALIGHT_EFFECT_TEXTURED: u32 = 32;
/// Some light is a disk or an ellipse.
pub const AREALIGHT_EFFECT_ELLIPSE: u32 = 256;
/// Some light is a sphere.
pub const AREALIGHT_EFFECT_SPHERE: u32 = 512;
/// Some light is a cylinder or a capsule.
pub const AREALIGHT_EFFECT_TUBE: u32 = 1024;
/// Some light has several faces: a mesh.
pub const AREALIGHT_EFFECT_MESH: u32 = 2048;
/// Some disk or ellipse shows an image: ArealightResources.light_textures is read. AREALIGHT_EFFECT_ELLIPSE is set then, too.
pub const AREALIGHT_EFFECT_TEXTURED_ELLIPSE: u32 = 4096;
/// Every effect: right for any lights, at the highest cost.
pub const AREALIGHT_EFFECTS_ALL: u32 = 7999;

/// Form factors to float32's own precision, 1e-6.
pub const AREALIGHT_FORM_FACTOR_EXACT: u32 = 0;
/// As EXACT, and relative precision for lights that look small.
pub const AREALIGHT_FORM_FACTOR_DIFFERENCE: u32 = 1;

/// Polygons are clipped at the horizon of the lobe's cosine space.
pub const AREALIGHT_HORIZON_COSINE: u32 = 0;
/// And at the surface's horizon: nothing leaks from behind the surface.
pub const AREALIGHT_HORIZON_BOTH: u32 = 1;

/// One integral a glossy lobe.
pub const AREALIGHT_FRESNEL_BY_F0: u32 = 0;
/// Two: exact in the reflectance and its colour.
pub const AREALIGHT_FRESNEL_SPLIT: u32 = 1;

/// The glossy lobe is the table's.
pub const AREALIGHT_LOBES_TABLE: u32 = 0;
/// Formulas instead, without a texture, at 1.2 to 1.35 times the error.
pub const AREALIGHT_LOBES_FORMULA: u32 = 1;

/// A light's image is looked up with one round fetch a lobe.
pub const AREALIGHT_FOOTPRINT_ROUND: u32 = 0;
/// With four along the longer axis.
pub const AREALIGHT_FOOTPRINT_ELLIPSE: u32 = 1;
/// With four by four parts of the light, a form factor and two fetches each.
pub const AREALIGHT_FOOTPRINT_SPLIT: u32 = 2;

/// ArealightResources.position holds positions; w = 0 where there is no surface.
pub const AREALIGHT_POSITION_IMAGE: u32 = 0;
/// It holds depth as stored; exactly 0 or 1 where there is no surface.
pub const AREALIGHT_POSITION_DEPTH: u32 = 1;

/// What ArealightResources.normal, base_color and specular hold: normal and roughness; base colour and metalness; dielectric
/// F0 and F90.
pub const AREALIGHT_G_BUFFER_AREALIGHT: u32 = 0;
/// Unreal Engine's `GBufferA`, `GBufferC` and `GBufferB`, of its default shading model.
pub const AREALIGHT_G_BUFFER_UNREAL: u32 = 1;
/// `GBuffer2`, `GBuffer0` and `GBuffer1` of Unity's Universal Render Pipeline: metallic materials, no accurate normals.
pub const AREALIGHT_G_BUFFER_UNITY: u32 = 2;
/// A signed place on an octahedron; base colour; occlusion (not used), roughness, metalness.
pub const AREALIGHT_G_BUFFER_OCTAHEDRAL: u32 = 3;

/// Radiance replaces what is in the image.
pub const AREALIGHT_OUTPUT_OVERWRITE: u32 = 0;
/// Radiance is added to it.
pub const AREALIGHT_OUTPUT_ADD: u32 = 1;

/// The radiance of both lobes goes to ArealightResources.radiance.
pub const AREALIGHT_IMAGES_ONE: u32 = 0;
/// That of the glossy lobe goes to ArealightResources.glossy instead.
pub const AREALIGHT_IMAGES_APART: u32 = 1;

/// Radiance is stored in 32-bit floats.
pub const AREALIGHT_RADIANCE_RGBA32F: u32 = 0;
/// In 16-bit floats, rounded to the nearest; what is above 65,504 as that.
pub const AREALIGHT_RADIANCE_RGBA16F: u32 = 1;

/// The table is kept in 32-bit floats, 16 bytes a texel.
pub const AREALIGHT_TABLE_RGBA32F: u32 = 0;
/// In 16-bit floats, 8 bytes a texel, at 5e-4 of a light more error.
pub const AREALIGHT_TABLE_RGBA16F: u32 = 1;

/// A flat ellipse about `center` with the conjugate half axes `axis_u` and `axis_v`, which shines to the side of their cross product.
pub const AREALIGHT_SHAPE_ELLIPSE: u32 = 0;
/// A sphere about `center`.
pub const AREALIGHT_SHAPE_SPHERE: u32 = 1;
/// A tube about `center`, whose axis goes from `center - axis_u` to `center + axis_u`.
pub const AREALIGHT_SHAPE_TUBE: u32 = 2;

/// The lateral surface of a tube alone shines.
pub const AREALIGHT_TUBE_OPEN: u32 = 0;
/// Flat caps shine too.
pub const AREALIGHT_TUBE_FLAT: u32 = 1;
/// Half spheres about both ends do: a capsule.
pub const AREALIGHT_TUBE_ROUND: u32 = 2;

/// Beyond the image is its edge.
pub const AREALIGHT_WRAP_CLAMP: u32 = 0;
/// The image again.
pub const AREALIGHT_WRAP_REPEAT: u32 = 1;
/// The image again, every other one mirrored.
pub const AREALIGHT_WRAP_MIRROR: u32 = 2;

/// The range of an ArealightBuffer from its offset to its end.
pub const AREALIGHT_WHOLE_SIZE: u64 = u64::MAX;

/// A function of Vulkan, as vkGetInstanceProcAddr returns it.
pub type ArealightFunction = Option<unsafe extern "system" fn()>;

/// vkGetInstanceProcAddr or vkGetDeviceProcAddr, by a cast.
pub type ArealightProcAddr =
    Option<unsafe extern "system" fn(handle: *mut c_void, name: *const c_char) -> ArealightFunction>;

/// The host's Vulkan. All handles stay the host's, and outlive what is made from them.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightHost {
    /// AREALIGHT_ABI_VERSION.
    pub abi_version: u32,
    /// VkApplicationInfo.apiVersion that the instance was made with: Vulkan 1.1 or later.
    pub api_version: u32,
    /// vkGetInstanceProcAddr
    pub get_instance_proc_addr: ArealightProcAddr,
    /// vkGetDeviceProcAddr
    pub get_device_proc_addr: ArealightProcAddr,
    /// VkInstance
    pub instance: *mut c_void,
    /// VkPhysicalDevice
    pub physical_device: *mut c_void,
    /// VkDevice, with a queue that computes. No optional feature or extension is needed.
    pub device: *mut c_void,
    /// VkPipelineCache that pipelines are made with, or 0. Not used elsewhere while a pass is being made.
    pub pipeline_cache: u64,
}

/// Which light table.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTable {
    /// A file in OpenEXR, KTX2 or DDS, as `arealight fit` and `arealight table convert` write them; null for the table of
    /// GGX that is built in.
    pub bytes: *const u8,
    /// How many bytes.
    pub size: usize,
    /// One of AREALIGHT_TABLE_*.
    pub format: u32,
    /// 0
    pub reserved: u32,
}

/// What memory an image of the library's needs.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArealightMemory {
    /// VkMemoryRequirements of the image.
    pub size: u64,
    /// VkMemoryRequirements of the image.
    pub alignment: u64,
    /// Of the table: bytes of the staging buffer, VK_BUFFER_USAGE_TRANSFER_SRC_BIT. Of light textures 0.
    pub staging_size: u64,
    /// VkMemoryRequirements of the image.
    pub memory_type_bits: u32,
    /// 0
    pub reserved: u32,
}

/// How the table gets to the device.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightUpload {
    /// VkDeviceMemory for ArealightMemory; it is freed after arealight_destroy.
    pub memory: u64,
    /// Where in it.
    pub memory_offset: u64,
    /// The staging buffer's memory at staging_offset, mapped; the texels are written there.
    pub staging_data: *mut c_void,
    /// Bytes from there on: ArealightMemory.staging_size or more.
    pub staging_size: u64,
    /// VkBuffer; it lives until the commands have run.
    pub staging_buffer: u64,
    /// Where in it, a multiple of 16.
    pub staging_offset: u64,
    /// VkCommandBuffer that is being recorded, outside a render pass, on a queue with graphics or compute.
    pub command_buffer: *mut c_void,
}

/// What a pass is specialised for. All zero is exact without an effect.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightPassOptions {
    /// AREALIGHT_EFFECT_* that the scene calls for. More only costs time; less is an error when lights are packed.
    pub effects: u32,
    /// One of AREALIGHT_FORM_FACTOR_*.
    pub form_factor: u32,
    /// One of AREALIGHT_HORIZON_*.
    pub horizon: u32,
    /// One of AREALIGHT_FRESNEL_*.
    pub fresnel: u32,
    /// One of AREALIGHT_LOBES_*.
    pub lobes: u32,
    /// One of AREALIGHT_FOOTPRINT_*.
    pub footprint: u32,
    /// One of AREALIGHT_POSITION_*.
    pub position: u32,
    /// One of AREALIGHT_OUTPUT_*.
    pub output: u32,
    /// One of AREALIGHT_IMAGES_*.
    pub radiance_images: u32,
    /// One of AREALIGHT_RADIANCE_*.
    pub radiance_format: u32,
    /// One of AREALIGHT_G_BUFFER_*.
    pub g_buffer: u32,
    /// 0: a pass without tiles. Else the most lights, of all kinds, that the list of a tile of 8 x 8 pixels holds, such as 128; a tile that
    /// more lights contribute to is shaded by all.
    pub tile_capacity: u32,
    /// With tiles: lights are culled from a tile that together contribute less than this fraction of what its other lights do, to the
    /// radiance of each of its pixels, in the sum of the channels; in [0, 1). 0: only those that contribute nothing.
    pub tile_cull_threshold: f32,
    /// With tiles: frames of fewer lights, all of them convex quads without an image, are shaded without, which takes less time; such as 4.
    pub tile_least_quads: u32,
}

/// What a descriptor set is made with.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArealightSetLayout {
    /// VkDescriptorSetLayout, the library's own.
    pub layout: u64,
    /// Descriptors that a set takes from its pool: VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE.
    pub sampled_images: u32,
    /// VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
    pub combined_image_samplers: u32,
    /// VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
    pub storage_images: u32,
    /// VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
    pub storage_buffers: u32,
}

/// A flat polygon that emits constant radiance, or shows an image; or several that are one light, a mesh. Convex or concave, without
/// crossing edges.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightLight {
    /// For messages, UTF-8; may be null.
    pub name: *const c_char,
    /// World positions, three numbers a vertex: seen from the front, counter-clockwise.
    pub vertices: *const f64,
    /// Null, or two texture coordinates a vertex of the outline, in [0, 1], an affine function of the positions: the light shows
    /// `texture_layer` of the light textures.
    pub texture_coordinates: *const f64,
    /// From 3 on: of the outline, or of all faces.
    pub vertex_count: u32,
    /// Read only with texture coordinates.
    pub texture_layer: u32,
    /// Radiance of the front, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: [f32; 3],
    /// 1: the back emits too.
    pub two_sided: u32,
    /// Null, or how many vertices each hole has. Their vertices follow the outline's in `vertices`, in either direction; they lie
    /// in the light's plane and inside. A light with holes needs AREALIGHT_EFFECT_POLYGON.
    pub hole_vertex_counts: *const u32,
    /// Null, or how many vertices each face of a mesh has, `vertex_count` together: faces follow one another in `vertices`, each an
    /// outline of its own, such as the three of a triangle. What a face hides of another is added all the same. A mesh needs
    /// AREALIGHT_EFFECT_POLYGON and AREALIGHT_EFFECT_MESH, and has neither holes nor texture coordinates.
    pub face_vertex_counts: *const u32,
    /// How many holes.
    pub hole_count: u32,
    /// How many faces; 0 and 1 are one polygon.
    pub face_count: u32,
}

/// A disk, sphere or tube of constant radiance, or a disk that shows an image, in world positions.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightShape {
    /// For messages, UTF-8; may be null.
    pub name: *const c_char,
    /// One of AREALIGHT_SHAPE_*.
    pub kind: u32,
    /// Of a tube: one of AREALIGHT_TUBE_*.
    pub ends: u32,
    /// The middle.
    pub center: [f64; 3],
    /// Of an ellipse and a tube.
    pub axis_u: [f64; 3],
    /// Of an ellipse.
    pub axis_v: [f64; 3],
    /// Of a sphere and a tube, above zero.
    pub radius: f64,
    /// Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: [f32; 3],
    /// 1: the back of an ellipse, or the inside of a sphere, emits too.
    pub two_sided: u32,
    /// 1: an ellipse shows `texture_layer` of the light textures. Seen from the front, its rows run along `axis_u` and its top is where
    /// `axis_v` points to; the parallelogram of both touches its edges.
    pub textured: u32,
    /// Read only with `textured`.
    pub texture_layer: u32,
}

/// Arrays of the host for packed lights, as the buffers of ArealightResources hold them.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightPackedLights {
    /// Where the lights go, aligned to 4 bytes; null to ask for the sizes alone.
    pub lights: *mut c_void,
    /// Where the vertices go, likewise.
    pub vertices: *mut c_void,
    /// In: bytes at `lights`. Out: bytes that are needed, 128 a light.
    pub lights_size: u64,
    /// In: bytes at `vertices`. Out: bytes that are needed, 16 a vertex.
    pub vertices_size: u64,
    /// Out: how many lights are convex quads without an image. They come first, else lights are in the given order.
    pub quad_count: u32,
    /// Out: AREALIGHT_EFFECT_* of lights that none of these calls for.
    pub unused: u32,
}

/// An image of the host, in the layout that it has when the pass runs.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightImage {
    /// VkImageView
    pub view: u64,
    /// VkImageLayout
    pub layout: u32,
    /// 0
    pub reserved: u32,
}

/// A range of a buffer of the host, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightBuffer {
    /// VkBuffer
    pub buffer: u64,
    /// A multiple of minStorageBufferOffsetAlignment.
    pub offset: u64,
    /// Bytes, or AREALIGHT_WHOLE_SIZE.
    pub range: u64,
}

/// The host's resources of a pass. The host's barriers make them visible to the compute stage; layouts are left as they
/// are.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightResources {
    /// ArealightPackedLights.lights; without lights, any buffer of 128 bytes or more.
    pub lights: ArealightBuffer,
    /// ArealightPackedLights.vertices, likewise.
    pub light_vertices: ArealightBuffer,
    /// What arealight_pass_pack_shapes made. May be 0 in a pass without AREALIGHT_EFFECT_ELLIPSE, _SPHERE and _TUBE.
    pub shapes: ArealightBuffer,
    /// Positions relative to the origin in xyz, 0 in w where there is no surface (rgba32f); or depth (d32f).
    pub position: ArealightImage,
    /// Shading normal in xyz, of any length; perceptual roughness in w (rgba16f, rgba32f for mirrors).
    pub normal: ArealightImage,
    /// Linear base colour in rgb, metalness in a (rgba8).
    pub base_color: ArealightImage,
    /// Dielectric F0 in rgb, F90 in a (rgba8). May be 0 without AREALIGHT_EFFECT_SPECULAR_INPUT, in a pass with
    /// AREALIGHT_G_BUFFER_AREALIGHT. Other layouts have other contents here and in the two before.
    pub specular: ArealightImage,
    /// The lights' images: what arealight_textures_image says, or a 2D array (rgba16f) with the levels that `arealight export`
    /// describes. May be 0 without AREALIGHT_EFFECT_TEXTURED and AREALIGHT_EFFECT_TEXTURED_ELLIPSE.
    pub light_textures: ArealightImage,
    /// Where radiance goes: a storage image of ArealightPassOptions.radiance_format in VK_IMAGE_LAYOUT_GENERAL.
    pub radiance: ArealightImage,
    /// Where the glossy lobe's goes with AREALIGHT_IMAGES_APART: another such image. Else 0.
    pub glossy: ArealightImage,
    /// What arealight_lobe_horizons wrote. Without tiles 0.
    pub lobe_horizons: ArealightBuffer,
    /// What arealight_pass_tile_memory asks for: frames that run at the same time need one each. Without tiles 0.
    pub tile_lists: ArealightBuffer,
}

/// What differs from frame to frame.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightFrame {
    /// Of the radiance image, in pixels; those of the G-buffer are of the same size.
    pub width: u32,
    /// Likewise.
    pub height: u32,
    /// The camera's position relative to the origin of positions and lights.
    pub camera: [f32; 3],
    /// How many lights of their buffer are shaded.
    pub light_count: u32,
    /// How many disks, spheres and tubes of theirs.
    pub shape_count: u32,
    /// ArealightPackedLights.quad_count: how many of the first lights are convex quads without an image. 0 is always right; what
    /// is not counted takes longer.
    pub quad_count: u32,
    /// AREALIGHT_EFFECT_* that nothing of the frame calls for, which cost nothing then: ArealightPackedLights.unused, with what
    /// the host knows of DIFFUSE, GLOSSY and SPECULAR_INPUT (no surface calls for it) and FAR (no light is 282 of its radii
    /// from a surface). 0 is always right.
    pub unused: u32,
    /// 0
    pub reserved: u32,
    /// Column-major 4 x 4: the inverse of projection times view, from clip space to positions relative to the origin. May
    /// be null with AREALIGHT_POSITION_IMAGE.
    pub position_from_clip: *const f32,
    /// With tiles, ArealightResources.tile_lists of the set: dispatches are read from it. Else 0.
    pub tile_lists: ArealightBuffer,
}

/// The buffer of ArealightResources.tile_lists. The pass alone writes it, with barriers of its own; before another frame uses it, the host
/// waits for the stages `TRANSFER`, `COMPUTE_SHADER` and `DRAW_INDIRECT`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArealightTileMemory {
    /// Bytes; 0 for a pass without tiles.
    pub size: u64,
    /// VkBufferUsageFlags that it is made with.
    pub usage: u32,
    /// 0
    pub reserved: u32,
}

/// The lights' images: a layer each, all of one size, with the levels that footprints are looked up in.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureOptions {
    /// In texels: a power of two from 64 to 4096. Images of other sizes are resampled.
    pub width: u32,
    /// Likewise.
    pub height: u32,
    /// How many images, from 1 on.
    pub layers: u32,
    /// 0
    pub reserved: u32,
}

/// What light textures need of the host.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArealightTextureNeeds {
    /// Of the image.
    pub memory: ArealightMemory,
    /// Of a set for a level.
    pub level_set: ArealightSetLayout,
    /// Of a set for an image that is loaded.
    pub source_set: ArealightSetLayout,
    /// How many sets there are for levels.
    pub level_set_count: u32,
    /// 0
    pub reserved: u32,
}

/// What light textures are given once.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureSetup {
    /// VkDeviceMemory for ArealightTextureNeeds.memory; it is freed after arealight_textures_destroy.
    pub memory: u64,
    /// Where in it.
    pub memory_offset: u64,
    /// VkDescriptorSet each, made with ArealightTextureNeeds.level_set. They live as long as the textures.
    pub level_sets: *const u64,
    /// ArealightTextureNeeds.level_set_count.
    pub level_set_count: u32,
    /// 0
    pub reserved: u32,
    /// VkCommandBuffer that is being recorded, outside a render pass, on a queue with graphics or compute.
    pub command_buffer: *mut c_void,
}

/// An image that replaces a layer. Zero in `part_size` is the whole image.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTextureUpdate {
    /// VkDescriptorSet that arealight_textures_write_source_set pointed at the image.
    pub source_set: u64,
    /// The texture coordinates of the image that the layer shows at (0, 0), the outer corner of its first texel.
    pub part_low: [f64; 2],
    /// What is added to them at (1, 1); positive.
    pub part_size: [f64; 2],
    /// Which layer.
    pub layer: u32,
    /// The image's width in texels, from 1 to 4096.
    pub source_width: u32,
    /// Its height.
    pub source_height: u32,
    /// 1: it holds sRGB in a format that does not decode by itself, such as rgba8.
    pub decode_srgb: u32,
    /// What is beyond 0 to 1 along u: one of AREALIGHT_WRAP_*.
    pub wrap_u: u32,
    /// Along v.
    pub wrap_v: u32,
}
