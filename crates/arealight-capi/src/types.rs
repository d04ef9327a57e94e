//! What crosses the boundary.
//!
//! Handles of Vulkan: those that are pointers everywhere (instance, device, command buffer) are `void *`, all
//! others `uint64_t`, so that vulkan.h is not needed.

use crate::constants::AREALIGHT_PLANE_COUNT;
use std::ffi::{c_char, c_void};

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
    /// VkPipelineCache that pipelines are made with, or 0. It synchronises itself.
    pub pipeline_cache: u64,
}

/// Which light table.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArealightTable {
    /// A file in OpenEXR, KTX2 or DDS, as `arealight fit` and `arealight table convert` write them; null for
    /// the table of GGX that is built in.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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

/// SPIR-V that the host compiled from the sources of `arealight export`. All zero is the library's own.
///
/// It is valid SPIR-V of this version's kernel; the layout lives as long as the pass that is made of it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightModule {
    /// The words.
    pub words: *const u32,
    /// Their bytes.
    pub size: usize,
    /// VkDescriptorSetLayout of set 1, with what the host's own answers read. Else 0.
    pub host_set_layout: u64,
}

/// Options fixed when a pass is created. All zero is both lobes at the exact level.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightPassOptions {
    /// What the surfaces need: AREALIGHT_EFFECT_DIFFUSE, _GLOSSY, _SPECULAR_INPUT, _COAT, _COAT_NORMAL,
    /// _COAT_BY_ALBEDO, _SHEEN, _ANISOTROPY, _DIFFUSE_ROUGHNESS, _COUPLED, _COUPLED_BY_ALBEDO,
    /// _MULTIPLE_SCATTERING, _TRANSMISSION, _THIN_FILM and _LINKED. 0 is DIFFUSE and GLOSSY. What lights need
    /// is known from ArealightFrame.lights.
    pub surfaces: u32,
    /// One of AREALIGHT_HORIZON_*.
    pub horizon: u32,
    /// One of AREALIGHT_SPECULAR_LOBES_*.
    pub specular_lobes: u32,
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
    /// 0: a pass without tiles. Else the most lights, of all kinds, that the list of a tile of 8 x 8 pixels
    /// holds, such as 128; a tile that more lights contribute to is shaded by all.
    pub tile_capacity: u32,
    /// With tiles: lights are culled from a tile that together contribute less than this fraction of what its
    /// other lights do, to the radiance of each of its pixels, in the sum of the channels; in [0, 1). 0: only
    /// those that contribute nothing.
    pub tile_cull_threshold: f32,
    /// With tiles: frames of fewer lights, all of them convex quads without a texture, are shaded without,
    /// which takes less time; such as 4.
    pub tile_least_quads: u32,
    /// How many shadow rays a pixel has, at most 4: the pass picks a light and a lobe for each, for an
    /// ArealightShadowPass. 0: no shadows.
    pub shadow_rays: u32,
    /// One of AREALIGHT_CAMERA_*.
    pub camera: u32,
    /// 1: frames are rectangles of larger images, each from ArealightFrame.offset on, such as views side by
    /// side; without shadow rays. Else 0.
    pub rectangle: u32,
    /// How many texels of the G-buffer a pixel of radiance has to a side, at most 16; of them the first is
    /// shaded: 2 is half resolution. Not with shadow rays. 0 is 1.
    pub texels_per_pixel: u32,
    /// How many samples the texels of the G-buffer have: 1, 2, 4 or 8, in Vulkan's standard places. Radiance
    /// is the mean over them. Not with shadow rays or half resolution. 0 is 1.
    pub samples: u32,
    /// 1: frames have a stencil test, by AREALIGHT_PLANE_STENCIL; pixels that fail it stay as they are;
    /// without shadow rays. Else 0.
    pub stencil: u32,
    /// 1: how many lights a frame has is read from ArealightResources.light_counts when the commands run;
    /// ArealightFrame.lights says the most. Else 0.
    pub light_counts: u32,
    /// One of AREALIGHT_DESCRIPTORS_*.
    pub descriptors: u32,
    /// `shade.comp` for a G-buffer of the host's: `g_buffer` does not count then, and tiles cannot be had.
    /// Images that it does not declare may be any in ArealightResources.
    pub module: ArealightModule,
}

/// The resources of a descriptor set.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
    /// VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC
    pub dynamic_storage_buffers: u32,
    /// 0
    pub reserved: u32,
}

/// A light of constant radiance, or a textured one, in world positions. Which fields are read depends on its
/// kind.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightLight {
    /// For messages, UTF-8; may be null.
    pub name: *const c_char,
    /// One of AREALIGHT_LIGHT_*.
    pub kind: u32,
    /// 1: the back of a polygon, mesh or disk, or the inside of a sphere, emits too.
    pub two_sided: u32,
    /// Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    pub radiance: [f32; 3],
    /// 1: `texture_layer` of the light textures multiplies the radiance of a polygon or disk. Seen from the
    /// front of a disk, its rows run along `axis_u` and its top is where `axis_v` points to; the
    /// parallelogram of both touches its edges.
    pub textured: u32,
    /// Read only with `textured`.
    pub texture_layer: u32,
    /// Of a polygon or mesh: how many vertices its outline has, or all faces have; from 3 on.
    pub vertex_count: u32,
    /// Of a polygon or mesh: three numbers a vertex; seen from the front, counter-clockwise.
    pub vertices: *const f64,
    /// Of a textured polygon: two texture coordinates a vertex of the outline, in [0, 1], an affine function
    /// of the positions.
    pub texture_coordinates: *const f64,
    /// Of a polygon: null, or how many vertices each hole has. Their vertices follow the outline's in
    /// `vertices`, in either direction; they lie in the light's plane and inside.
    pub hole_vertex_counts: *const u32,
    /// Of a mesh: how many vertices each face has, `vertex_count` in all. Faces follow one another in
    /// `vertices`, each an outline of its own, such as the three of a triangle. What a face hides of another
    /// is added all the same.
    pub face_vertex_counts: *const u32,
    /// How many holes.
    pub hole_count: u32,
    /// How many faces.
    pub face_count: u32,
    /// Of a disk, sphere or tube: the middle.
    pub center: [f64; 3],
    /// Of a disk or tube.
    pub axis_u: [f64; 3],
    /// Of a disk.
    pub axis_v: [f64; 3],
    /// Of a sphere or tube, above zero.
    pub radius: f64,
    /// Of a tube: one of AREALIGHT_TUBE_*.
    pub ends: u32,
    /// How many rows `profile` has.
    pub profile_row_count: u32,
    /// How many factors a row has: 0 or 1 of a profile that is round about the front normal. More are at
    /// azimuths that divide the circle evenly, from where the outline's first edge goes, or a disk's
    /// `axis_u`, counter-clockwise as seen from behind.
    pub profile_azimuth_count: u32,
    /// With AREALIGHT_EFFECT_LINKED, at most 255: it shines on surfaces whose stencil has any of these bits;
    /// 0: on all.
    pub links: u32,
    /// Null, or of a disk or convex polygon: rows of degrees from the front normal, rising from 0 to 90, and
    /// factors of the radiance, linear between them, 0 after the last row.
    pub profile: *const f64,
    /// Read only with `profile`: how many angles divide it, 1 to 180. Of 4 the error is 1 % on Lambert
    /// surfaces and 3 % on glossy ones, of 8 less than half of it.
    pub profile_levels: u32,
    /// 1: a disk or polygon is seen through the opening below.
    pub has_opening: u32,
    /// Read only with `has_opening`, as the next three: the middle of the opening, a parallelogram in an
    /// opaque plane with all of the light on one side.
    pub opening_center: [f64; 3],
    /// From there to the middle of a side.
    pub opening_axis_u: [f64; 3],
    /// And of another.
    pub opening_axis_v: [f64; 3],
    /// 1: points on the light's side of the plane see nothing of it, as between a lamp's doors; 0: all of it,
    /// as outside of a window.
    pub opening_housed: u32,
    /// Of a mesh: 0, or how much of what far faces show on average clusters of them may be off by, .05 say.
    /// What they send then takes time by what is seen of them. Ten thousand faces take a fortieth of a
    /// second to pack: keep them packed.
    pub cluster_error: f32,
}

/// How far a light is of any matter: arealight_light_reach.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ArealightReach {
    /// The light's middle, in world positions.
    pub center: [f64; 3],
    /// How far from there it may reflect more than the threshold; infinite where nothing bounds it.
    pub radius: f64,
    /// The lower corner of a box with the same bound: smaller for flat one-sided lights.
    pub low: [f64; 3],
    /// The upper corner.
    pub high: [f64; 3],
}

/// Counts and effects of packed lights: arealight_pack_lights writes it, ArealightFrame takes it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ArealightLightSummary {
    /// How many records ArealightPackedLights.lights has: those of polygons and meshes.
    pub light_count: u32,
    /// How many of the first are convex quads without a texture.
    pub quad_count: u32,
    /// How many records ArealightPackedLights.shapes has: those of disks, spheres and tubes, in this order.
    pub shape_count: u32,
    /// AREALIGHT_EFFECT_* that the lights need.
    pub effects: u32,
}

/// Arrays of the host for packed lights, as the buffers of ArealightResources hold them; aligned to 4 bytes,
/// null to ask for the sizes alone. Sizes become what is needed: set them before each call.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightPackedLights {
    /// Where polygons and meshes go.
    pub lights: *mut c_void,
    /// Where their vertices go.
    pub vertices: *mut c_void,
    /// Where disks, spheres and tubes go.
    pub shapes: *mut c_void,
    /// In: bytes at `lights`. Out: bytes that are needed, 64 a light.
    pub lights_size: u64,
    /// In: bytes at `vertices`. Out: bytes that are needed, 16 a vertex.
    pub vertices_size: u64,
    /// In: bytes at `shapes`. Out: bytes that are needed, 64 a light.
    pub shapes_size: u64,
    /// Out: for ArealightFrame.lights.
    pub summary: ArealightLightSummary,
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

/// The host's resources of a pass. The host's barriers make them visible to the compute stage; layouts are
/// left as they are.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightResources {
    /// ArealightPackedLights.lights; without lights, any buffer of 64 bytes or more.
    pub lights: ArealightBuffer,
    /// ArealightPackedLights.vertices; without lights, any buffer of 64 bytes or more.
    pub light_vertices: ArealightBuffer,
    /// ArealightPackedLights.shapes. May be 0 where no frame has disks, spheres or tubes.
    pub shapes: ArealightBuffer,
    /// The G-buffer, by AREALIGHT_PLANE_*. What a pass does not read may be 0.
    pub planes: [ArealightImage; AREALIGHT_PLANE_COUNT],
    /// The lights' images: what arealight_textures_image says, or a 2D array (rgba16f) with the levels that
    /// `arealight export` describes. May be 0 where no frame has textured lights.
    pub light_textures: ArealightImage,
    /// Where radiance goes: a storage image of ArealightPassOptions.radiance_format in
    /// VK_IMAGE_LAYOUT_GENERAL.
    pub radiance: ArealightImage,
    /// Where the glossy lobe's goes with AREALIGHT_IMAGES_SEPARATE: another such image. Else 0.
    pub glossy: ArealightImage,
    /// What arealight_lobe_horizons wrote. Without tiles 0.
    pub lobe_horizons: ArealightBuffer,
    /// What arealight_pass_tile_memory asks for: frames that run at the same time need one each. Without
    /// tiles 0.
    pub tile_lists: ArealightBuffer,
    /// Of arealight_pass_shadow_picks_size bytes. Without shadow rays 0.
    pub shadow_picks: ArealightBuffer,
    /// Three numbers of 32 bits: how many lights, how many shapes, and how many of the first lights are
    /// convex quads without a texture. Without ArealightPassOptions.light_counts 0.
    pub light_counts: ArealightBuffer,
}

/// The rectangle of a G-buffer's texels that clip space was drawn to: VkViewport.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ArealightViewport {
    /// Where x = -1 in clip space is, in texels.
    pub x: f32,
    /// Where y = -1 in clip space is, in texels: with a negative height the lower edge.
    pub y: f32,
    /// Above 0.
    pub width: f32,
    /// Negative where y is up in clip space.
    pub height: f32,
    /// The depth that is stored of depth 0 in clip space.
    pub min_depth: f32,
    /// Likewise, of depth 1.
    pub max_depth: f32,
}

/// What differs from frame to frame.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightFrame {
    /// How many pixels are shaded, from the first of the radiance image on, or from `offset`. The images may
    /// be larger.
    pub width: u32,
    /// Likewise.
    pub height: u32,
    /// The camera's position relative to the origin of positions and lights; with
    /// AREALIGHT_CAMERA_ORTHOGRAPHIC the direction to it. With shadow rays its length is that at which a
    /// perspective camera would stand that sees as much.
    pub camera: [f32; 3],
    /// ArealightPackedLights.summary of the lights in the set's buffers.
    pub lights: ArealightLightSummary,
    /// With shadow rays, of their random numbers: one more in each frame. Else 0.
    pub seed: u32,
    /// Column-major 4 x 4: the inverse of projection times view, from clip space to positions relative to the
    /// origin. May be null with AREALIGHT_POSITION_IMAGE.
    pub position_from_clip: *const f32,
    /// With tiles, ArealightResources.tile_lists of the set: dispatches are read from it. Else 0.
    pub tile_lists: ArealightBuffer,
    /// VkDescriptorSet for set 1 of ArealightPassOptions.module, where it has a layout of it. Else 0.
    pub host_set: u64,
    /// The viewport that drew the G-buffer, with a negative height where y is up. All 0: just the texels of
    /// the frame's pixels, y down. Only positions from depth, and a shadow's history, depend on it.
    pub viewport: ArealightViewport,
    /// With ArealightPassOptions.rectangle the first pixel that is shaded, x and y. Else 0.
    pub offset: [u32; 2],
    /// The rows of pixels that this record shades, from the first to before the second, of those of `height`:
    /// a frame of more work than a driver's watchdog allows is recorded and submitted in parts. Both are
    /// multiples of 8, or the second is `height`. 0, 0: all.
    pub rows: [u32; 2],
    /// With ArealightPassOptions.stencil, which bits of the stencil are compared, at most 255: 0 is none, and
    /// every pixel is shaded.
    pub stencil_compare_mask: u32,
    /// What those bits must be, at most 255.
    pub stencil_reference: u32,
    /// With AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS, where the frame's lights, vertices and shapes begin, in
    /// bytes after what the set was written with. Else 0.
    pub light_offsets: [u32; 3],
}

/// The buffer of ArealightResources.tile_lists. The pass alone writes it, with barriers of its own, to frames
/// before on the same queue, too.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ArealightTileMemory {
    /// Bytes; 0 for a pass without tiles.
    pub size: u64,
    /// VkBufferUsageFlags that it is made with.
    pub usage: u32,
    /// 0
    pub reserved: u32,
}

/// The output of a shadow pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightShadowOptions {
    /// One of AREALIGHT_SHADOW_FILTER_*.
    pub filter: u32,
    /// One of AREALIGHT_SHADOW_HISTORY_*.
    pub history: u32,
    /// One of AREALIGHT_OUTPUT_*, for ArealightShadowResources.radiance.
    pub output: u32,
    /// `shadow_rays.comp` with the host's own answer to what blocks a ray, such as an acceleration structure.
    pub module: ArealightModule,
}

/// The host's resources of a shadow pass beyond those of its shade pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightShadowResources {
    /// A storage image (rgba16f) of the frame's size, in VK_IMAGE_LAYOUT_GENERAL. The pass alone writes it.
    pub shadow: ArealightImage,
    /// Where radiance goes: a storage image of ArealightPassOptions.radiance_format. 0: it replaces the
    /// unshadowed one in ArealightResources.radiance.
    pub radiance: ArealightImage,
    /// With a history: arealight_shadow_history_size bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT too, of zeros
    /// before the first frame and after each cut. The pass alone writes it; it is the same for all frames of
    /// a view. Else 0.
    pub history: ArealightBuffer,
    /// ArealightBlockerArrays.nodes. 0 with a module of the host's.
    pub blocker_nodes: ArealightBuffer,
    /// ArealightBlockerArrays.triangles; without triangles, any buffer. 0 with a module of the host's.
    pub blocker_triangles: ArealightBuffer,
}

/// A frame of a shadow pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightShadowFrame {
    /// That of the shade pass. With a history it has `position_from_clip`, also where positions come from an
    /// image, and `seed` counts frames.
    pub frame: *const ArealightFrame,
    /// VkDescriptorSet for set 1 of a module of the host's. Else 0.
    pub host_set: u64,
    /// What is added to positions relative to this frame's origin for positions relative to that of the frame
    /// before. Read only with a history.
    pub origin_shift: [f32; 3],
    /// 0
    pub reserved: u32,
}

/// Arrays of the host for blockers, as the buffers of ArealightShadowResources hold them; aligned to 4 bytes,
/// null to ask for the sizes alone. Sizes become what is needed: set them before each call.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ArealightBlockerArrays {
    /// Where the hierarchy's nodes go.
    pub nodes: *mut c_void,
    /// Where the triangles go.
    pub triangles: *mut c_void,
    /// In: bytes at `nodes`. Out: bytes that are needed.
    pub nodes_size: u64,
    /// In: bytes at `triangles`. Out: bytes that are needed, 48 a triangle.
    pub triangles_size: u64,
}
