// Arealight: analytic area lights, recorded into your Vulkan command buffer.
//
// Made from crates/arealight-capi by `cargo run -p xtask -- header`: change it there.
//
// An ArealightAreaLights owns all that shading needs: create it, shade in each frame, destroy it. All else is the recorder
// below it, which allocates no memory or descriptor sets of Vulkan. Neither submits, waits, or makes a barrier for your
// images. vulkan.h is not needed: handles that are pointers everywhere (VkInstance, VkPhysicalDevice, VkDevice,
// VkCommandBuffer) are void *, all others uint64_t.
//
// Conventions: SI radiometry, linear Rec. 709. Right-handed; matrices are column-major. Positions are relative to an
// origin near the camera that you choose; lights are packed with the same. A light's front is where its vertices run
// counter-clockwise.
//
// Every function that returns an ArealightResult checks what it can, records nothing where it fails (but
// arealight_area_lights_shade), writes nothing but the sizes that are needed and a null handle, and leaves a message for
// arealight_last_error.
//
// Threads: functions that take an object as const may be called for it by several at once, each with command buffers, sets and
// arrays of its own; all others, and arealight_..._destroy, by one while no other uses the object. Objects are independent.
// C99 or C++11, or later.

#ifndef AREALIGHT_H
#define AREALIGHT_H

#include <stddef.h>
#include <stdint.h>

// The version of structs and functions: of the header that a host was compiled with, and of the library that
// it runs with. They must be equal; arealight_create refuses another. On ELF systems the shared library's
// SONAME ends in it.
#define AREALIGHT_ABI_VERSION 2

// The Lambert lobe: some surface has a metalness below one and a base colour that is not black.
#define AREALIGHT_EFFECT_DIFFUSE 1

// The GGX lobe: some surface reflects specularly.
#define AREALIGHT_EFFECT_GLOSSY 2

// Some light lights both of its sides.
#define AREALIGHT_EFFECT_TWO_SIDED 4

// Some surface has a dielectric reflectance of its own: AREALIGHT_PLANE_SPECULAR is read.
#define AREALIGHT_EFFECT_SPECULAR_INPUT 8

// Some light is concave, not quite flat, or has more than four vertices.
#define AREALIGHT_EFFECT_POLYGON 16

// Some polygon is textured: ArealightResources.light_textures is read.
#define AREALIGHT_EFFECT_TEXTURED 32

// Some light is a disk or an ellipse.
#define AREALIGHT_EFFECT_ELLIPSE 256

// Some light is a sphere.
#define AREALIGHT_EFFECT_SPHERE 512

// Some light is a cylinder or a capsule.
#define AREALIGHT_EFFECT_TUBE 1024

// Some light has several faces: a mesh.
#define AREALIGHT_EFFECT_MESH 2048

// Some disk or ellipse is textured: ArealightResources.light_textures is read. AREALIGHT_EFFECT_ELLIPSE is
// set then, too.
#define AREALIGHT_EFFECT_TEXTURED_ELLIPSE 4096

// Some surface has a clear coat: AREALIGHT_PLANE_COAT is read.
#define AREALIGHT_EFFECT_COAT 8192

// Some coat has a normal of its own. AREALIGHT_EFFECT_COAT is set then, too.
#define AREALIGHT_EFFECT_COAT_NORMAL 16384

// Diffuse lobes get what the Fresnel term above them leaves, as in glTF; else they are added to the specular
// lobe.
#define AREALIGHT_EFFECT_COUPLED 32768

// They get what the specular lobe's albedo leaves, as in OpenPBR. AREALIGHT_EFFECT_COUPLED is set then, too.
#define AREALIGHT_EFFECT_COUPLED_BY_ALBEDO 65536

// What is below a coat gets what the coat's albedo leaves, as in OpenPBR. AREALIGHT_EFFECT_COAT is set then,
// too.
#define AREALIGHT_EFFECT_COAT_BY_ALBEDO 131072

// Some diffuse lobe is rough: AREALIGHT_PLANE_ANISOTROPY is read.
#define AREALIGHT_EFFECT_DIFFUSE_ROUGHNESS 262144

// Some surface has sheen: AREALIGHT_PLANE_SHEEN is read.
#define AREALIGHT_EFFECT_SHEEN 524288

// Some surface's specular lobe has two roughnesses: AREALIGHT_PLANE_ANISOTROPY is read.
#define AREALIGHT_EFFECT_ANISOTROPY 1048576

// What specular lobes' facets reflect more than once is added, as in OpenPBR; else it is lost, as in glTF.
#define AREALIGHT_EFFECT_MULTIPLE_SCATTERING 2097152

// The pass is of light that thin surfaces let through: what the G-buffer holds is shaded from behind, for a
// pass of its own whose base colour is the part of the light that is let through.
#define AREALIGHT_EFFECT_TRANSMISSION 4194304

// Some surface has a thin film that its reflectances lack: AREALIGHT_PLANE_FILM is read.
#define AREALIGHT_EFFECT_THIN_FILM 8388608

// Some thin surface is glass. A pass ignores it: give the pass with AREALIGHT_EFFECT_TRANSMISSION
// AREALIGHT_EFFECT_GLOSSY, and put the part of its base colour that is not diffused into its metalness.
#define AREALIGHT_EFFECT_GLASS 16777216

// Some light has a profile.
#define AREALIGHT_EFFECT_PROFILE 33554432

// Some light is seen through an opening.
#define AREALIGHT_EFFECT_OPENING 67108864

// Lights shine on surfaces of some groups alone, ArealightLight.links: AREALIGHT_PLANE_STENCIL is read.
#define AREALIGHT_EFFECT_LINKED 134217728

// Some profile is not round about the normal.
#define AREALIGHT_EFFECT_AZIMUTH 268435456

// Polygons are clipped at the horizon of the lobe's cosine space.
#define AREALIGHT_HORIZON_COSINE 0

// And at the surface's horizon: nothing leaks from behind the surface.
#define AREALIGHT_HORIZON_BOTH 1

// One integral a light and specular lobe.
#define AREALIGHT_SPECULAR_LOBES_ONE 0

// Two, at .6 to .8 times the error, exact in the reflectance and its colour.
#define AREALIGHT_SPECULAR_LOBES_TWO 1

// GGX itself over half vectors, of polygons and meshes without an image: lobes of two roughnesses at a tenth
// of two lobes' error.
#define AREALIGHT_SPECULAR_LOBES_HALF_VECTORS 2

// The glossy lobe is the table's.
#define AREALIGHT_LOBES_TABLE 0

// Formulas instead, without a texture, at 1.2 to 1.35 times the error.
#define AREALIGHT_LOBES_FORMULA 1

// A light's image is looked up with three fetches of what a lobe sees of it.
#define AREALIGHT_FOOTPRINT_KERNEL 0

// With one of its mips.
#define AREALIGHT_FOOTPRINT_MIPS 1

// Positions relative to the origin in xyz, 0 in w where there is no surface (rgba32f); or depth (d32f). As
// the next ones, an index into ArealightResources.planes.
#define AREALIGHT_PLANE_POSITION 0

// Shading normal in xyz, of any length; perceptual roughness in w (rgba16f, rgba32f for mirrors). By
// AREALIGHT_G_BUFFER_*, as the next two.
#define AREALIGHT_PLANE_NORMAL 1

// Linear base colour in rgb, metalness in a (rgba8).
#define AREALIGHT_PLANE_BASE_COLOR 2

// Dielectric F0 in rgb, F90 in a (rgba8). May be 0 without AREALIGHT_EFFECT_SPECULAR_INPUT, in a pass with
// AREALIGHT_G_BUFFER_AREALIGHT.
#define AREALIGHT_PLANE_SPECULAR 3

// Of clear coats: weight in r, perceptual roughness in g (rg8), and with AREALIGHT_EFFECT_COAT_NORMAL the
// coat's normal in ba, as its place in [-1, 1] x [-1, 1] on an unfolded octahedron (rgba16f). May be 0
// without AREALIGHT_EFFECT_COAT.
#define AREALIGHT_PLANE_COAT 4

// Of sheen: linear colour in rgb, perceptual roughness in a (rgba8). May be 0 without
// AREALIGHT_EFFECT_SHEEN.
#define AREALIGHT_PLANE_SHEEN 5

// Of lobes of two roughnesses: the tangent in rg, as its place in [-1, 1] x [-1, 1] on an unfolded
// octahedron, perceptual roughness along it in b, 0 where there is one roughness; and the roughness of the
// diffuse lobe in a (rgba16f). May be 0 without AREALIGHT_EFFECT_ANISOTROPY and _DIFFUSE_ROUGHNESS.
#define AREALIGHT_PLANE_ANISOTROPY 6

// Of thin films: how much of the surface one covers in r, its index of refraction in g, its thickness in
// nanometres in b (rgba16f). May be 0 without AREALIGHT_EFFECT_THIN_FILM.
#define AREALIGHT_PLANE_FILM 7

// A stencil for each texel: the stencil aspect (s8_uint) or unsigned integers (r8_uint). May be 0 without
// ArealightPassOptions.stencil and AREALIGHT_EFFECT_LINKED.
#define AREALIGHT_PLANE_STENCIL 8

// Where a pixel's point was in the frame before less where it is, in parts of the image's width and height
// (rg16f). May be 0 but for a shadow pass with AREALIGHT_SHADOW_HISTORY_MOTION.
#define AREALIGHT_PLANE_MOTION 9

// How many planes there are.
#define AREALIGHT_PLANE_COUNT 10

// AREALIGHT_PLANE_POSITION holds positions; w = 0 where there is no surface.
#define AREALIGHT_POSITION_IMAGE 0

// It holds depth as stored; exactly 0 or 1 where there is no surface.
#define AREALIGHT_POSITION_DEPTH 1

// ArealightFrame.camera is the camera's position.
#define AREALIGHT_CAMERA_PERSPECTIVE 0

// It is the direction to the camera, of any length but 0: an orthographic one.
#define AREALIGHT_CAMERA_ORTHOGRAPHIC 1

// Passes read resources by descriptor sets: arealight_pass_set_layout, arealight_pass_write_set,
// arealight_pass_record.
#define AREALIGHT_DESCRIPTORS_SETS 0

// Likewise; the buffers of lights, vertices and shapes are VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, with
// ArealightFrame.light_offsets, and their ArealightBuffer.range is given.
#define AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS 1

// Without sets: arealight_pass_record_pushed. The device was made with VK_KHR_push_descriptor.
#define AREALIGHT_DESCRIPTORS_PUSHED 2

// What AREALIGHT_PLANE_NORMAL, _BASE_COLOR and _SPECULAR hold: normal and roughness; base colour and
// metalness; dielectric F0 and F90.
#define AREALIGHT_G_BUFFER_AREALIGHT 0

// Unreal Engine's `GBufferA`, `GBufferC` and `GBufferB`, of its default shading model.
#define AREALIGHT_G_BUFFER_UNREAL 1

// `GBuffer2`, `GBuffer0` and `GBuffer1` of Unity's Universal Render Pipeline: metallic materials, no
// accurate normals.
#define AREALIGHT_G_BUFFER_UNITY 2

// A signed place on an octahedron; base colour; occlusion (not used), roughness, metalness.
#define AREALIGHT_G_BUFFER_OCTAHEDRAL 3

// Radiance replaces what is in the image.
#define AREALIGHT_OUTPUT_OVERWRITE 0

// Radiance is added to it.
#define AREALIGHT_OUTPUT_ADD 1

// The radiance of both lobes goes to ArealightResources.radiance.
#define AREALIGHT_IMAGES_COMBINED 0

// That of the glossy lobe goes to ArealightResources.glossy instead.
#define AREALIGHT_IMAGES_SEPARATE 1

// Radiance is stored in 32-bit floats.
#define AREALIGHT_RADIANCE_RGBA32F 0

// In 16-bit floats, rounded to the nearest; what is above 65,504 as that.
#define AREALIGHT_RADIANCE_RGBA16F 1

// The mean of a pixel's shadow rays as it is: unbiased, with noise in penumbras.
#define AREALIGHT_SHADOW_FILTER_OFF 0

// A mean over neighbours in the same plane, as wide as a part of the penumbra.
#define AREALIGHT_SHADOW_FILTER_GATHER 1

// One frame's rays.
#define AREALIGHT_SHADOW_HISTORY_OFF 0

// Those of up to sixteen frames, found again by the camera's motion alone.
#define AREALIGHT_SHADOW_HISTORY_CAMERA 1

// Likewise, by motion vectors of the host's.
#define AREALIGHT_SHADOW_HISTORY_MOTION 2

// The table is kept in 32-bit floats, 16 bytes a texel.
#define AREALIGHT_TABLE_RGBA32F 0

// In 16-bit floats, 8 bytes a texel, at 5e-4 of a light more error.
#define AREALIGHT_TABLE_RGBA16F 1

// A flat polygon, convex or concave, without crossing edges; with holes, if it has any.
#define AREALIGHT_LIGHT_POLYGON 0

// Several flat faces.
#define AREALIGHT_LIGHT_MESH 1

// A flat disk or ellipse about `center` with the conjugate half axes `axis_u` and `axis_v`, which shines to
// the side of their cross product.
#define AREALIGHT_LIGHT_DISK 2

// A sphere about `center`.
#define AREALIGHT_LIGHT_SPHERE 3

// A tube about `center`, whose axis goes from `center - axis_u` to `center + axis_u`.
#define AREALIGHT_LIGHT_TUBE 4

// The lateral surface of a tube alone shines.
#define AREALIGHT_TUBE_OPEN 0

// Flat caps shine too.
#define AREALIGHT_TUBE_FLAT 1

// Half spheres about both ends do: a capsule.
#define AREALIGHT_TUBE_ROUND 2

// Beyond the image is its edge.
#define AREALIGHT_WRAP_CLAMP 0

// The image again.
#define AREALIGHT_WRAP_REPEAT 1

// The image again, every other one mirrored.
#define AREALIGHT_WRAP_MIRROR 2

// The range of an ArealightBuffer from its offset to its end.
#define AREALIGHT_WHOLE_SIZE UINT64_MAX

// What became of a call. Whatever is not AREALIGHT_RESULT_OK comes with a message: arealight_last_error.
typedef enum ArealightResult {
    // Done.
    AREALIGHT_RESULT_OK = 0,
    // An argument is null, out of range, NaN, or of an object that is not alive; the message names it.
    AREALIGHT_RESULT_ERROR_ARGUMENT = 1,
    // The host was compiled for another version of the library.
    AREALIGHT_RESULT_ERROR_ABI_VERSION = 2,
    // The device or its Vulkan lacks something; the message names it.
    AREALIGHT_RESULT_ERROR_MISSING_FEATURE = 3,
    // A call of Vulkan failed; the message names it and its result.
    AREALIGHT_RESULT_ERROR_VULKAN = 4,
    // A light cannot be shaded; the message names it and its field.
    AREALIGHT_RESULT_ERROR_LIGHT = 5,
    // The bytes hold no light table, or one of another version.
    AREALIGHT_RESULT_ERROR_TABLE = 6,
    // An array of the host is too small; the size that is needed was written.
    AREALIGHT_RESULT_ERROR_TOO_SMALL = 7,
    // A fault of the library, which is worth a report. The object of the call is good only for being
    // destroyed.
    AREALIGHT_RESULT_ERROR_INTERNAL = 8,
} ArealightResult;

// The library on a device of the host, with a light table.
typedef struct Arealight Arealight;

// The passes of one view with all that they need: table, buffers of lights, descriptor sets, lists of tiles,
// what shadows take, and memory, in blocks of 4 MiB or more. A host that makes none has only its code.
typedef struct ArealightAreaLights ArealightAreaLights;

// Triangles that block shadow rays, in a hierarchy of boxes, for hosts that have none of their own.
typedef struct ArealightBlockers ArealightBlockers;

// A medium, such as fog, before what an ArealightPass shaded.
typedef struct ArealightMediumPass ArealightMediumPass;

// A shade pass, specialised for surfaces and a quality.
typedef struct ArealightPass ArealightPass;

// Shadow rays after a shade pass whose ArealightPassOptions have them.
typedef struct ArealightShadowPass ArealightShadowPass;

// The images of lights on a device, filtered for shading.
typedef struct ArealightTextures ArealightTextures;

// A function of Vulkan, as vkGetInstanceProcAddr returns it.
typedef void (*ArealightFunction)(void);

// vkGetInstanceProcAddr or vkGetDeviceProcAddr, by a cast.
typedef ArealightFunction (*ArealightProcAddr)(void *handle, const char *name);

// The host's Vulkan. All handles stay the host's, and outlive what is made from them.
typedef struct ArealightHost {
    // AREALIGHT_ABI_VERSION.
    uint32_t abi_version;
    // VkApplicationInfo.apiVersion that the instance was made with: Vulkan 1.1 or later.
    uint32_t api_version;
    // vkGetInstanceProcAddr
    ArealightProcAddr get_instance_proc_addr;
    // vkGetDeviceProcAddr
    ArealightProcAddr get_device_proc_addr;
    // VkInstance
    void *instance;
    // VkPhysicalDevice
    void *physical_device;
    // VkDevice, with a queue that computes. No optional feature or extension is needed.
    void *device;
    // VkPipelineCache that pipelines are made with, or 0. It synchronises itself.
    uint64_t pipeline_cache;
} ArealightHost;

// SPIR-V that the host compiled from the sources of `arealight export`. All zero is the library's own.
//
// It is valid SPIR-V of this version's kernel; the layout lives as long as the pass that is made of it.
typedef struct ArealightModule {
    // The words.
    const uint32_t *words;
    // Their bytes.
    size_t size;
    // VkDescriptorSetLayout of set 1, with what the host's own answers read. Else 0.
    uint64_t host_set_layout;
} ArealightModule;

// Options fixed when a pass is created. All zero is both lobes at the exact level.
typedef struct ArealightPassOptions {
    // What the surfaces need: AREALIGHT_EFFECT_DIFFUSE, _GLOSSY, _SPECULAR_INPUT, _COAT, _COAT_NORMAL,
    // _COAT_BY_ALBEDO, _SHEEN, _ANISOTROPY, _DIFFUSE_ROUGHNESS, _COUPLED, _COUPLED_BY_ALBEDO,
    // _MULTIPLE_SCATTERING, _TRANSMISSION, _THIN_FILM and _LINKED. 0 is DIFFUSE and GLOSSY. What lights need
    // is known from ArealightFrame.lights.
    uint32_t surfaces;
    // One of AREALIGHT_HORIZON_*.
    uint32_t horizon;
    // One of AREALIGHT_SPECULAR_LOBES_*.
    uint32_t specular_lobes;
    // One of AREALIGHT_LOBES_*.
    uint32_t lobes;
    // One of AREALIGHT_FOOTPRINT_*.
    uint32_t footprint;
    // One of AREALIGHT_POSITION_*.
    uint32_t position;
    // One of AREALIGHT_OUTPUT_*.
    uint32_t output;
    // One of AREALIGHT_IMAGES_*.
    uint32_t radiance_images;
    // One of AREALIGHT_RADIANCE_*.
    uint32_t radiance_format;
    // One of AREALIGHT_G_BUFFER_*.
    uint32_t g_buffer;
    // 0: a pass without tiles. Else the most lights, of all kinds, that the list of a tile of 8 x 8 pixels
    // holds, such as 128; a tile that more lights contribute to is shaded by all.
    uint32_t tile_capacity;
    // With tiles: lights are culled from a tile that together contribute less than this fraction of what its
    // other lights do, to the radiance of each of its pixels, in the sum of the channels; in [0, 1). 0: only
    // those that contribute nothing.
    float tile_cull_threshold;
    // With tiles: frames of fewer lights, all of them convex quads without a texture, are shaded without,
    // which takes less time; such as 4.
    uint32_t tile_least_quads;
    // How many shadow rays a pixel has, at most 4: the pass picks a light and a lobe for each, for an
    // ArealightShadowPass. 0: no shadows.
    uint32_t shadow_rays;
    // One of AREALIGHT_CAMERA_*.
    uint32_t camera;
    // 1: frames are rectangles of larger images, each from ArealightFrame.offset on, such as views side by
    // side; without shadow rays. Else 0.
    uint32_t rectangle;
    // How many texels of the G-buffer a pixel of radiance has to a side, at most 16; of them the first is
    // shaded: 2 is half resolution. Not with shadow rays. 0 is 1.
    uint32_t texels_per_pixel;
    // How many samples the texels of the G-buffer have: 1, 2, 4 or 8, in Vulkan's standard places. Radiance
    // is the mean over them. Not with shadow rays or half resolution. 0 is 1.
    uint32_t samples;
    // 1: frames have a stencil test, by AREALIGHT_PLANE_STENCIL; pixels that fail it stay as they are;
    // without shadow rays. Else 0.
    uint32_t stencil;
    // 1: how many lights a frame has is read from ArealightResources.light_counts when the commands run;
    // ArealightFrame.lights says the most. Else 0.
    uint32_t light_counts;
    // One of AREALIGHT_DESCRIPTORS_*.
    uint32_t descriptors;
    // `shade.comp` for a G-buffer of the host's: `g_buffer` does not count then, and tiles cannot be had.
    // Images that it does not declare may be any in ArealightResources.
    struct ArealightModule module;
} ArealightPassOptions;

// Which light table.
typedef struct ArealightTable {
    // A file in OpenEXR, KTX2 or DDS, as `arealight fit` and `arealight table convert` write them; null for
    // the table of GGX that is built in.
    const uint8_t *bytes;
    // How many bytes.
    size_t size;
    // One of AREALIGHT_TABLE_*.
    uint32_t format;
    // 0
    uint32_t reserved;
} ArealightTable;

// Options of a medium's pass. All zero: at the middle of each froxel, without shadow rays.
typedef struct ArealightMediumOptions {
    // 1: each sample has a ray over each light; 2: one ray alone, over a light that is drawn by how much of
    // it is scattered there. 0: none.
    uint32_t shadow_rays;
    // At how many points of a froxel light is scattered, each with rays of its own. 0 is 1.
    uint32_t samples;
    // 1: scattering and extinction are read from ArealightMediumResources.medium. Else 0.
    uint32_t by_image;
    // 1: a froxel's distance is drawn within it, by ArealightMediumFrame.seed. Else 0.
    uint32_t jitter;
    // 1: froxels that surfaces hide from every pixel are filled, too. 0: they hold nothing, and positions
    // are of the picture's size.
    uint32_t fill_hidden;
    // `medium_scatter.comp` of the host's, as ArealightShadowOptions.module.
    struct ArealightModule module;
} ArealightMediumOptions;

// What arealight_area_lights_create makes. All zero is both lobes at the exact level, two frames in flight.
typedef struct ArealightAreaLightsInfo {
    // How surfaces are stored and shaded; `descriptors` and `module` are 0.
    struct ArealightPassOptions options;
    // As of arealight_create.
    const struct ArealightTable *table;
    // A medium before the picture, which arealight_area_lights_set_medium says more of before the first
    // frame; its `by_image` and `module` are 0. Null is none.
    const struct ArealightMediumOptions *medium;
    // How many frames may be recorded that are not done yet, at most 8. 0 is 2.
    uint32_t frames_in_flight;
    // With shadow rays, one of AREALIGHT_SHADOW_FILTER_*.
    uint32_t shadow_filter;
    // With shadow rays, one of AREALIGHT_SHADOW_HISTORY_*.
    uint32_t shadow_history;
    // 0
    uint32_t reserved;
} ArealightAreaLightsInfo;

// A light of constant radiance, or a textured one, in world positions. Which fields are read depends on its
// kind.
typedef struct ArealightLight {
    // For messages, UTF-8; may be null.
    const char *name;
    // One of AREALIGHT_LIGHT_*.
    uint32_t kind;
    // 1: the back of a polygon, mesh or disk, or the inside of a sphere, emits too.
    uint32_t two_sided;
    // Radiance of the front or outside, W/(m² sr), linear Rec. 709, not negative.
    float radiance[3];
    // 1: `texture_layer` of the light textures multiplies the radiance of a polygon or disk. Seen from the
    // front of a disk, its rows run along `axis_u` and its top is where `axis_v` points to; the
    // parallelogram of both touches its edges.
    uint32_t textured;
    // Read only with `textured`.
    uint32_t texture_layer;
    // Of a polygon or mesh: how many vertices its outline has, or all faces have; from 3 on.
    uint32_t vertex_count;
    // Of a polygon or mesh: three numbers a vertex; seen from the front, counter-clockwise.
    const double *vertices;
    // Of a textured polygon: two texture coordinates a vertex of the outline, in [0, 1], an affine function
    // of the positions.
    const double *texture_coordinates;
    // Of a polygon: null, or how many vertices each hole has. Their vertices follow the outline's in
    // `vertices`, in either direction; they lie in the light's plane and inside.
    const uint32_t *hole_vertex_counts;
    // Of a mesh: how many vertices each face has, `vertex_count` in all. Faces follow one another in
    // `vertices`, each an outline of its own, such as the three of a triangle. What a face hides of another
    // is added all the same.
    const uint32_t *face_vertex_counts;
    // How many holes.
    uint32_t hole_count;
    // How many faces.
    uint32_t face_count;
    // Of a disk, sphere or tube: the middle.
    double center[3];
    // Of a disk or tube.
    double axis_u[3];
    // Of a disk.
    double axis_v[3];
    // Of a sphere or tube, above zero.
    double radius;
    // Of a tube: one of AREALIGHT_TUBE_*.
    uint32_t ends;
    // How many rows `profile` has.
    uint32_t profile_row_count;
    // How many factors a row has: 0 or 1 of a profile that is round about the front normal. More are at
    // azimuths that divide the circle evenly, from where the outline's first edge goes, or a disk's
    // `axis_u`, counter-clockwise as seen from behind.
    uint32_t profile_azimuth_count;
    // With AREALIGHT_EFFECT_LINKED, at most 255: it shines on surfaces whose stencil has any of these bits;
    // 0: on all.
    uint32_t links;
    // Null, or of a disk or convex polygon: rows of degrees from the front normal, rising from 0 to 90, and
    // factors of the radiance, linear between them, 0 after the last row.
    const double *profile;
    // Read only with `profile`: how many angles divide it, 1 to 180. Of 4 the error is 1 % on Lambert
    // surfaces and 3 % on glossy ones, of 8 less than half of it.
    uint32_t profile_levels;
    // 1: a disk or polygon is seen through the opening below.
    uint32_t has_opening;
    // Read only with `has_opening`, as the next three: the middle of the opening, a parallelogram in an
    // opaque plane with all of the light on one side.
    double opening_center[3];
    // From there to the middle of a side.
    double opening_axis_u[3];
    // And of another.
    double opening_axis_v[3];
    // 1: points on the light's side of the plane see nothing of it, as between a lamp's doors; 0: all of it,
    // as outside of a window.
    uint32_t opening_housed;
    // Of a mesh: 0, or how much of what far faces show on average clusters of them may be off by, .05 say.
    // What they send then takes time by what is seen of them. Ten thousand faces take a fortieth of a
    // second to pack: keep them packed.
    float cluster_error;
} ArealightLight;

// Counts and effects of packed lights: arealight_pack_lights writes it, ArealightFrame takes it.
typedef struct ArealightLightSummary {
    // How many records ArealightPackedLights.lights has: those of polygons and meshes.
    uint32_t light_count;
    // How many of the first are convex quads without a texture.
    uint32_t quad_count;
    // How many records ArealightPackedLights.shapes has: those of disks, spheres and tubes, in this order.
    uint32_t shape_count;
    // AREALIGHT_EFFECT_* that the lights need.
    uint32_t effects;
} ArealightLightSummary;

// A range of a buffer of the host, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT.
typedef struct ArealightBuffer {
    // VkBuffer
    uint64_t buffer;
    // A multiple of minStorageBufferOffsetAlignment.
    uint64_t offset;
    // Bytes, or AREALIGHT_WHOLE_SIZE.
    uint64_t range;
} ArealightBuffer;

// The rectangle of a G-buffer's texels that clip space was drawn to: VkViewport.
typedef struct ArealightViewport {
    // Where x = -1 in clip space is, in texels.
    float x;
    // Where y = -1 in clip space is, in texels: with a negative height the lower edge.
    float y;
    // Above 0.
    float width;
    // Negative where y is up in clip space.
    float height;
    // The depth that is stored of depth 0 in clip space.
    float min_depth;
    // Likewise, of depth 1.
    float max_depth;
} ArealightViewport;

// What differs from frame to frame.
typedef struct ArealightFrame {
    // How many pixels are shaded, from the first of the radiance image on, or from `offset`. The images may
    // be larger.
    uint32_t width;
    // Likewise.
    uint32_t height;
    // The camera's position relative to the origin of positions and lights; with
    // AREALIGHT_CAMERA_ORTHOGRAPHIC the direction to it. With shadow rays its length is that at which a
    // perspective camera would stand that sees as much.
    float camera[3];
    // ArealightPackedLights.summary of the lights in the set's buffers.
    struct ArealightLightSummary lights;
    // With shadow rays, of their random numbers: one more in each frame. Else 0.
    uint32_t seed;
    // Column-major 4 x 4: the inverse of projection times view, from clip space to positions relative to the
    // origin. May be null with AREALIGHT_POSITION_IMAGE.
    const float *position_from_clip;
    // With tiles, ArealightResources.tile_lists of the set: dispatches are read from it. Else 0.
    struct ArealightBuffer tile_lists;
    // VkDescriptorSet for set 1 of ArealightPassOptions.module, where it has a layout of it. Else 0.
    uint64_t host_set;
    // The viewport that drew the G-buffer, with a negative height where y is up. All 0: just the texels of
    // the frame's pixels, y down. Only positions from depth, and a shadow's history, depend on it.
    struct ArealightViewport viewport;
    // With ArealightPassOptions.rectangle the first pixel that is shaded, x and y. Else 0.
    uint32_t offset[2];
    // The rows of pixels that this record shades, from the first to before the second, of those of `height`:
    // a frame of more work than a driver's watchdog allows is recorded and submitted in parts. Both are
    // multiples of 8, or the second is `height`. 0, 0: all.
    uint32_t rows[2];
    // With ArealightPassOptions.stencil, which bits of the stencil are compared, at most 255: 0 is none, and
    // every pixel is shaded.
    uint32_t stencil_compare_mask;
    // What those bits must be, at most 255.
    uint32_t stencil_reference;
    // With AREALIGHT_DESCRIPTORS_LIGHT_OFFSETS, where the frame's lights, vertices and shapes begin, in
    // bytes after what the set was written with. Else 0.
    uint32_t light_offsets[3];
} ArealightFrame;

// An image of the host, in the layout that it has when the pass runs.
typedef struct ArealightImage {
    // VkImageView
    uint64_t view;
    // VkImageLayout
    uint32_t layout;
    // 0
    uint32_t reserved;
} ArealightImage;

// The host's resources of a pass. The host's barriers make them visible to the compute stage; layouts are
// left as they are.
typedef struct ArealightResources {
    // ArealightPackedLights.lights; without lights, any buffer of 64 bytes or more.
    struct ArealightBuffer lights;
    // ArealightPackedLights.vertices; without lights, any buffer of 64 bytes or more.
    struct ArealightBuffer light_vertices;
    // ArealightPackedLights.shapes. May be 0 where no frame has disks, spheres or tubes.
    struct ArealightBuffer shapes;
    // The G-buffer, by AREALIGHT_PLANE_*. What a pass does not read may be 0.
    struct ArealightImage planes[AREALIGHT_PLANE_COUNT];
    // The lights' images: what arealight_textures_image says, or a 2D array (rgba16f) with the levels that
    // `arealight export` describes. May be 0 where no frame has textured lights.
    struct ArealightImage light_textures;
    // Where radiance goes: a storage image of ArealightPassOptions.radiance_format in
    // VK_IMAGE_LAYOUT_GENERAL.
    struct ArealightImage radiance;
    // Where the glossy lobe's goes with AREALIGHT_IMAGES_SEPARATE: another such image. Else 0.
    struct ArealightImage glossy;
    // What arealight_lobe_horizons wrote. Without tiles 0.
    struct ArealightBuffer lobe_horizons;
    // What arealight_pass_tile_memory asks for: frames that run at the same time need one each. Without
    // tiles 0.
    struct ArealightBuffer tile_lists;
    // Of arealight_pass_shadow_picks_size bytes. Without shadow rays 0.
    struct ArealightBuffer shadow_picks;
    // Three numbers of 32 bits: how many lights, how many shapes, and how many of the first lights are
    // convex quads without a texture. Without ArealightPassOptions.light_counts 0.
    struct ArealightBuffer light_counts;
} ArealightResources;

// A frame of a medium's pass.
typedef struct ArealightMediumFrame {
    // That of the shade pass, of a perspective camera, with `position_from_clip`; its size, camera, matrix
    // and lights count.
    const struct ArealightFrame *frame;
    // VkDescriptorSet for set 1 of a module of the host's. Else 0.
    uint64_t host_set;
    // Across, down and away from the camera, each from 1 to 65535: such as 160 x 90 x 64.
    uint32_t froxels[3];
    // What is scattered per unit of length, a channel: extinction times albedo. From 0.
    float scattering[3];
    // What is scattered or absorbed per unit of length. From 0.
    float extinction;
    // The mean cosine of the angle by which light is turned, in (-1, 1).
    float anisotropy;
    // Slices are even up to about this distance, then each is longer by a factor. Above 0.
    float nearest;
    // Where the last slice ends. Above `nearest`.
    float farthest;
    // Of random numbers: one more in each frame.
    uint32_t seed;
    // Lights are left out of froxels that together add no more than this to a pixel's radiance, in the sum
    // of the channels, for each unit of albedo. 0: only lights that nothing comes of. Frames of fewer than
    // 32 lights leave none out.
    float cull_radiance;
} ArealightMediumFrame;

// What memory an image of the library's needs.
typedef struct ArealightMemory {
    // VkMemoryRequirements of the image.
    uint64_t size;
    // VkMemoryRequirements of the image.
    uint64_t alignment;
    // Of the table: bytes of the staging buffer, VK_BUFFER_USAGE_TRANSFER_SRC_BIT. Of light textures 0.
    uint64_t staging_size;
    // VkMemoryRequirements of the image.
    uint32_t memory_type_bits;
    // 0
    uint32_t reserved;
} ArealightMemory;

// How the table gets to the device.
typedef struct ArealightUpload {
    // The staging buffer's memory at staging_offset, mapped; the texels are written there.
    void *staging_data;
    // Bytes from there on: ArealightMemory.staging_size or more.
    uint64_t staging_size;
    // VkBuffer; it lives until the commands have run.
    uint64_t staging_buffer;
    // Where in it, a multiple of 16.
    uint64_t staging_offset;
    // VkCommandBuffer that is being recorded, outside a render pass, on a queue with graphics or compute.
    void *command_buffer;
} ArealightUpload;

// Arrays of the host for packed lights, as the buffers of ArealightResources hold them; aligned to 4 bytes,
// null to ask for the sizes alone. Sizes become what is needed: set them before each call.
typedef struct ArealightPackedLights {
    // Where polygons and meshes go.
    void *lights;
    // Where their vertices go.
    void *vertices;
    // Where disks, spheres and tubes go.
    void *shapes;
    // In: bytes at `lights`. Out: bytes that are needed, 64 a light.
    uint64_t lights_size;
    // In: bytes at `vertices`. Out: bytes that are needed, 16 a vertex.
    uint64_t vertices_size;
    // In: bytes at `shapes`. Out: bytes that are needed, 64 a light.
    uint64_t shapes_size;
    // Out: for ArealightFrame.lights.
    struct ArealightLightSummary summary;
} ArealightPackedLights;

// How far a light is of any matter: arealight_light_reach.
typedef struct ArealightReach {
    // The light's middle, in world positions.
    double center[3];
    // How far from there it may reflect more than the threshold; infinite where nothing bounds it.
    double radius;
    // The lower corner of a box with the same bound: smaller for flat one-sided lights.
    double low[3];
    // The upper corner.
    double high[3];
} ArealightReach;

// The resources of a descriptor set.
typedef struct ArealightSetLayout {
    // VkDescriptorSetLayout, the library's own.
    uint64_t layout;
    // Descriptors that a set takes from its pool: VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE.
    uint32_t sampled_images;
    // VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
    uint32_t combined_image_samplers;
    // VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
    uint32_t storage_images;
    // VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
    uint32_t storage_buffers;
    // VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC
    uint32_t dynamic_storage_buffers;
    // 0
    uint32_t reserved;
} ArealightSetLayout;

// The host's resources of a medium's pass beyond those of its shade pass.
typedef struct ArealightMediumResources {
    // A 3D storage image (rgba16f) of ArealightMediumFrame.froxels, in VK_IMAGE_LAYOUT_GENERAL. The pass
    // alone writes it: radiance up to a froxel's far side, in a the part that is let through.
    struct ArealightImage froxels;
    // With ArealightMediumOptions.by_image a 3D image of that size: per unit of length scattering in rgb,
    // extinction in a. Else 0.
    struct ArealightImage medium;
    // With shadow rays ArealightBlockerArrays.nodes. 0 with a module of the host's.
    struct ArealightBuffer blocker_nodes;
    // ArealightBlockerArrays.triangles; without triangles, any buffer. 0 with a module of the host's.
    struct ArealightBuffer blocker_triangles;
} ArealightMediumResources;

// The buffer of ArealightResources.tile_lists. The pass alone writes it, with barriers of its own, to frames
// before on the same queue, too.
typedef struct ArealightTileMemory {
    // Bytes; 0 for a pass without tiles.
    uint64_t size;
    // VkBufferUsageFlags that it is made with.
    uint32_t usage;
    // 0
    uint32_t reserved;
} ArealightTileMemory;

// Arrays of the host for blockers, as the buffers of ArealightShadowResources hold them; aligned to 4 bytes,
// null to ask for the sizes alone. Sizes become what is needed: set them before each call.
typedef struct ArealightBlockerArrays {
    // Where the hierarchy's nodes go.
    void *nodes;
    // Where the triangles go.
    void *triangles;
    // In: bytes at `nodes`. Out: bytes that are needed.
    uint64_t nodes_size;
    // In: bytes at `triangles`. Out: bytes that are needed, 48 a triangle.
    uint64_t triangles_size;
} ArealightBlockerArrays;

// The output of a shadow pass.
typedef struct ArealightShadowOptions {
    // One of AREALIGHT_SHADOW_FILTER_*.
    uint32_t filter;
    // One of AREALIGHT_SHADOW_HISTORY_*.
    uint32_t history;
    // One of AREALIGHT_OUTPUT_*, for ArealightShadowResources.radiance.
    uint32_t output;
    // `shadow_rays.comp` with the host's own answer to what blocks a ray, such as an acceleration structure.
    struct ArealightModule module;
} ArealightShadowOptions;

// The host's resources of a shadow pass beyond those of its shade pass.
typedef struct ArealightShadowResources {
    // A storage image (rgba16f) of the frame's size, in VK_IMAGE_LAYOUT_GENERAL. The pass alone writes it.
    struct ArealightImage shadow;
    // Where radiance goes: a storage image of ArealightPassOptions.radiance_format. 0: it replaces the
    // unshadowed one in ArealightResources.radiance.
    struct ArealightImage radiance;
    // With a history: arealight_shadow_history_size bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT too, of zeros
    // before the first frame and after each cut. The pass alone writes it; it is the same for all frames of
    // a view. Else 0.
    struct ArealightBuffer history;
    // ArealightBlockerArrays.nodes. 0 with a module of the host's.
    struct ArealightBuffer blocker_nodes;
    // ArealightBlockerArrays.triangles; without triangles, any buffer. 0 with a module of the host's.
    struct ArealightBuffer blocker_triangles;
} ArealightShadowResources;

// A frame of a shadow pass.
typedef struct ArealightShadowFrame {
    // That of the shade pass. With a history it has `position_from_clip`, also where positions come from an
    // image, and `seed` counts frames.
    const struct ArealightFrame *frame;
    // VkDescriptorSet for set 1 of a module of the host's. Else 0.
    uint64_t host_set;
    // What is added to positions relative to this frame's origin for positions relative to that of the frame
    // before. Read only with a history.
    float origin_shift[3];
    // 0
    uint32_t reserved;
} ArealightShadowFrame;

// The lights' images: all of one size, each with its mips and with what lobes see of it.
typedef struct ArealightTextureOptions {
    // Width and height in texels: a power of two from 64 to 4096. Images of other sizes are resampled.
    uint32_t side;
    // How many images, from 1 on.
    uint32_t layers;
} ArealightTextureOptions;

// What light textures need of the host.
typedef struct ArealightTextureNeeds {
    // Of the image.
    struct ArealightMemory memory;
    // Of a set for a level.
    struct ArealightSetLayout level_set;
    // Of a set for an image that is loaded.
    struct ArealightSetLayout source_set;
    // How many sets there are for levels.
    uint32_t level_set_count;
    // 0
    uint32_t reserved;
} ArealightTextureNeeds;

// What light textures are given once.
typedef struct ArealightTextureSetup {
    // VkDeviceMemory for ArealightTextureNeeds.memory; it is freed after arealight_textures_destroy.
    uint64_t memory;
    // Where in it.
    uint64_t memory_offset;
    // VkDescriptorSet each, made with ArealightTextureNeeds.level_set. They live as long as the textures.
    const uint64_t *level_sets;
    // ArealightTextureNeeds.level_set_count.
    uint32_t level_set_count;
    // 0
    uint32_t reserved;
    // VkCommandBuffer that is being recorded, outside a render pass, on a queue with graphics or compute.
    void *command_buffer;
} ArealightTextureSetup;

// An image that replaces a layer. Zero in `part_size` is the whole image, in `divisor` and `aspect` 1.
typedef struct ArealightTextureUpdate {
    // VkDescriptorSet that arealight_textures_write_source_set pointed at the image.
    uint64_t source_set;
    // The texture coordinates of the image that the layer shows at (0, 0), the outer corner of its first
    // texel.
    double part_low[2];
    // What is added to them at (1, 1); positive.
    double part_size[2];
    // Which layer.
    uint32_t layer;
    // The image's width in texels, from 1 to 4096.
    uint32_t source_width;
    // Its height.
    uint32_t source_height;
    // 1: it holds sRGB in a format that does not decode by itself, such as rgba8.
    uint32_t decode_srgb;
    // What is beyond 0 to 1 along u: one of AREALIGHT_WRAP_*.
    uint32_t wrap_u;
    // Along v.
    uint32_t wrap_v;
    // What texels are divided by, where they are brighter or dimmer than half floats hold well (6e-5 to
    // 65,504); from 1e-30 to 1e30. The radiance of lights that show the layer is to be multiplied by it.
    float divisor;
    // How many times as wide as high the light is that shows the layer, as texture coordinates run over it;
    // from 1/1024 to 1024.
    float aspect;
    // 1: a disk or ellipse shows it; what is beyond the ellipse that touches its edges counts nothing.
    uint32_t is_ellipse;
    // 0
    uint32_t reserved;
} ArealightTextureUpdate;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// AREALIGHT_ABI_VERSION of the library, for those that load it at run time.
uint32_t arealight_abi_version(void);

// Makes all that does not depend on the size of pictures. `info` may be null: zeros. `*out` is the host's to
// destroy.
//
// The host sees to it:
// As arealight_create.
enum ArealightResult arealight_area_lights_create(const struct ArealightHost *host,
                                                  const struct ArealightAreaLightsInfo *info,
                                                  struct ArealightAreaLights **out);

// Records a frame into a VkCommandBuffer: lights, which are packed and uploaded, table, passes, and the
// barriers between. Images are used in the compute stage; barriers before and after are the host's.
//
// Frames in flight have a `place` each, from 0 to before ArealightAreaLightsInfo.frames_in_flight. Lights
// are in world positions, and the positions of the G-buffer relative to `origin` (three numbers). Of `frame`
// `lights`, `seed` and `tile_lists` are not read; of `resources` all images are, with
// arealight_textures_image where lights are textured, but of the buffers `light_counts` alone. All may be
// others in each frame. Where it fails, the commands must not be submitted.
//
// The host sees to it:
// Pointers are null or valid, with as many items as their counts say. The command buffer is being recorded,
// outside a render pass; it is submitted to one queue, which computes, in the order of the calls. The frame
// before at this place is done. The images are of the frame's size and outlive the commands.
enum ArealightResult arealight_area_lights_shade(struct ArealightAreaLights *area_lights,
                                                 void *command_buffer,
                                                 uint32_t place,
                                                 const struct ArealightLight *lights,
                                                 uint32_t light_count,
                                                 const double *origin,
                                                 const struct ArealightFrame *frame,
                                                 const struct ArealightResources *resources);

// Says what blocks shadow rays from the next frame on, relative to an origin which those frames have, too:
// by default nothing. It is copied.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_area_lights_set_blockers(struct ArealightAreaLights *area_lights,
                                                        const struct ArealightBlockers *blockers,
                                                        const double *origin);

// Begins the history of shadows anew with the next frame, as after a cut.
//
// The host sees to it:
// The pointer is null or valid.
enum ArealightResult arealight_area_lights_forget_shadows(struct ArealightAreaLights *area_lights);

// Says what the medium is from the next frame on. Of `medium`, `frame`, `host_set` and `seed` are not read.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_area_lights_set_medium(struct ArealightAreaLights *area_lights,
                                                      const struct ArealightMediumFrame *medium);

// Destroys it with all that it owns. Null is nothing.
//
// The host sees to it:
// No commands that it recorded are pending, the device is alive, and no other thread uses the object.
enum ArealightResult arealight_area_lights_destroy(struct ArealightAreaLights *area_lights);

// Makes the library's view of a device. `table` may be null: GGX in 32-bit floats. `*out` is the host's to
// destroy.
//
// The host sees to it:
// Pointers are null or valid. The host's handles are valid and belong together; they outlive what is made.
enum ArealightResult arealight_create(const struct ArealightHost *host,
                                      const struct ArealightTable *table,
                                      struct Arealight **out);

// What memory the table needs.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_table_memory(const struct Arealight *arealight, struct ArealightMemory *out);

// Binds memory to the table, once: `memory` is a VkDeviceMemory that has at `memory_offset` what
// arealight_table_memory asks for, and is freed after arealight_destroy. From then on sets may be written.
// Again with the same memory it is nothing.
//
// The host sees to it:
// The pointer is null or valid, the memory is the host's, large enough, and nothing else uses that part of
// it.
enum ArealightResult arealight_table_bind_memory(struct Arealight *arealight,
                                                 uint64_t memory,
                                                 uint64_t memory_offset);

// Writes the table's texels to the staging buffer, and records the copy, with its barriers. Needed once,
// when the table has memory; the commands run before any that shade. Commands that were never run are made
// good by another call.
//
// The host sees to it:
// Pointers are null or valid, and `upload` is as ArealightUpload says.
enum ArealightResult arealight_table_upload(struct Arealight *arealight,
                                            const struct ArealightUpload *upload);

// How dense, a steradian, the table's lobes are at most on surfaces of at least this perceptual roughness:
// for arealight_light_reach. Ask once.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_lobe_density(const struct Arealight *arealight,
                                            uint32_t specular_lobes,
                                            double roughness,
                                            double *out);

// Writes where the horizons of the table's lobes are, for passes with tiles:
// ArealightResources.lobe_horizons, which is uploaded once. `specular_lobes`: what the passes are made with,
// one of AREALIGHT_SPECULAR_LOBES_*. `*size` comes in as the bytes at `data`, and goes out as the bytes that
// are needed; null for `data` asks for them alone.
//
// The host sees to it:
// Pointers are null or valid, with as many bytes.
enum ArealightResult arealight_lobe_horizons(const struct Arealight *arealight,
                                             uint32_t specular_lobes,
                                             void *data,
                                             uint64_t *size);

// Destroys the library's view of a device, and the table's image. Passes live on, but cannot be given new
// sets. Null is nothing.
//
// The host sees to it:
// No commands that shade are pending, the device is alive, and no other thread uses the object.
enum ArealightResult arealight_destroy(struct Arealight *arealight);

// The message of this thread's last failed call, in UTF-8: what is wrong, where, and what to do. Empty where
// none has. At most 4,095 bytes, in a buffer that the thread keeps until it ends: the next call of this
// thread that fails writes its own message there.
const char *arealight_last_error(void);

// Packs lights relative to `origin` (three numbers, in world positions) into arrays of the host, which
// uploads them to its buffers, and says what a frame needs to know of them. With null arrays, only says how
// large they must be.
//
// The host sees to it:
// Pointers are null or valid, with as many items as their counts say.
enum ArealightResult arealight_pack_lights(const struct ArealightLight *lights,
                                           uint32_t light_count,
                                           const double *origin,
                                           struct ArealightPackedLights *packed);

// Says how far a light is of any matter, for hosts with clusters of their own: outside of `*out` no surface
// reflects more of it than `threshold`, in W/(m² sr), in any channel. `density`, a steradian, is of the
// surfaces' lobes times their albedos where they are densest: 1/pi for surfaces without specular lobe, else
// that and arealight_lobe_density of the least roughness. What several lights add up to may be more.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_light_reach(const struct ArealightLight *light,
                                           double threshold,
                                           double density,
                                           struct ArealightReach *out);

// Makes a medium's pass, after shade passes of `options`: their position, radiance_format and quality are
// read. Its rays meet ArealightMediumResources.blocker_nodes. `*out` is the host's to destroy.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_medium_pass_create(const struct Arealight *arealight,
                                                  const struct ArealightPassOptions *options,
                                                  const struct ArealightMediumOptions *medium,
                                                  struct ArealightMediumPass **out);

// What descriptor sets of the pass are made with.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_medium_pass_set_layout(const struct ArealightMediumPass *pass,
                                                      struct ArealightSetLayout *out);

// Points a VkDescriptorSet, made with arealight_medium_pass_set_layout, at resources: of `shade` the lights,
// AREALIGHT_PLANE_POSITION and the radiance that the medium is put before.
//
// The host sees to it:
// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
enum ArealightResult arealight_medium_pass_write_set(const struct ArealightMediumPass *pass,
                                                     const struct Arealight *arealight,
                                                     uint64_t set,
                                                     const struct ArealightResources *shade,
                                                     const struct ArealightMediumResources *resources);

// Makes the pipelines for frames whose lights need what this one's do, if they are not made yet: what
// arealight_medium_pass_record would take a moment for otherwise.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_medium_pass_prepare(const struct ArealightMediumPass *pass,
                                                   const struct ArealightFrame *frame);

// Records the pass into a VkCommandBuffer, after the frame's radiance: three dispatches, with barriers
// between them. The barrier for what was shaded is the host's, and so is one after.
//
// The host sees to it:
// As arealight_pass_record.
enum ArealightResult arealight_medium_pass_record(const struct ArealightMediumPass *pass,
                                                  void *command_buffer,
                                                  uint64_t set,
                                                  const struct ArealightMediumFrame *frame);

// Destroys a pass, before or after the object that it was made from. Null is nothing.
//
// The host sees to it:
// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
enum ArealightResult arealight_medium_pass_destroy(struct ArealightMediumPass *pass);

// Makes a pass. Its pipelines are made when the first frame is recorded whose lights need them, or ahead by
// arealight_pass_prepare. `*out` is the host's to destroy.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_pass_create(const struct Arealight *arealight,
                                           const struct ArealightPassOptions *options,
                                           struct ArealightPass **out);

// What descriptor sets of the pass are made with.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_pass_set_layout(const struct ArealightPass *pass,
                                               struct ArealightSetLayout *out);

// Points a VkDescriptorSet, made with arealight_pass_set_layout, at resources; `arealight` is the one with
// the table, which was uploaded.
//
// The host sees to it:
// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
enum ArealightResult arealight_pass_write_set(const struct ArealightPass *pass,
                                              const struct Arealight *arealight,
                                              uint64_t set,
                                              const struct ArealightResources *resources);

// What the buffer of the lists of tiles needs, for radiance images of `width` x `height` pixels.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_pass_tile_memory(const struct ArealightPass *pass,
                                                uint32_t width,
                                                uint32_t height,
                                                struct ArealightTileMemory *out);

// Records the pass into a VkCommandBuffer: binding, push constants, one dispatch; with tiles, what begins
// their lists, a dispatch that classifies them, one for each class, and the barriers between. Barriers
// before and after are the host's.
//
// The host sees to it:
// Pointers are null or valid. The command buffer is being recorded, outside a render pass, on a queue that
// computes. The set was written, with images of the frame's size and buffers of the lights that
// `frame.lights` is of.
enum ArealightResult arealight_pass_record(const struct ArealightPass *pass,
                                           void *command_buffer,
                                           uint64_t set,
                                           const struct ArealightFrame *frame);

// As arealight_pass_record, of a pass with AREALIGHT_DESCRIPTORS_PUSHED: the resources, with the table of
// `arealight`, are pushed, and no descriptor set is needed.
//
// The host sees to it:
// As arealight_pass_record. The resources outlive the commands.
enum ArealightResult arealight_pass_record_pushed(const struct ArealightPass *pass,
                                                  const struct Arealight *arealight,
                                                  void *command_buffer,
                                                  const struct ArealightResources *resources,
                                                  const struct ArealightFrame *frame);

// Makes the pipeline for frames whose lights need what this one's do, if it is not made yet: what
// arealight_pass_record would take a moment for otherwise.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_pass_prepare(const struct ArealightPass *pass,
                                            const struct ArealightFrame *frame);

// Destroys a pass, before or after the object that it was made from. Null is nothing.
//
// The host sees to it:
// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
enum ArealightResult arealight_pass_destroy(struct ArealightPass *pass);

// Builds the hierarchy of triangles: nine numbers each, relative to the origin that lights are packed with,
// in any vertex order. It takes a microsecond or two a triangle. `alphas`, or null, holds of each triangle
// the number by which shadow rays ask the host what is there of it (arealight_bridge_alpha of a module
// compiled with AREALIGHT_HOST_ALPHA); 0: all of it, as without such a module. `*out` is the host's to
// destroy.
//
// The host sees to it:
// Pointers are null or valid, with as many items as the count says.
enum ArealightResult arealight_blockers_create(const float *vertices,
                                               const uint32_t *alphas,
                                               uint32_t triangle_count,
                                               struct ArealightBlockers **out);

// Copies the hierarchy into arrays of the host, which uploads them to its buffers. With null arrays, only
// says how large they must be.
//
// The host sees to it:
// Pointers are null or valid, with as many bytes as their sizes say.
enum ArealightResult arealight_blockers_read(const struct ArealightBlockers *blockers,
                                             struct ArealightBlockerArrays *arrays);

// Destroys a hierarchy, whose copies stay. Null is nothing.
//
// The host sees to it:
// No other thread uses it.
enum ArealightResult arealight_blockers_destroy(struct ArealightBlockers *blockers);

// Makes a shadow pass, after shade passes of `options`; its rays meet
// ArealightShadowResources.blocker_nodes. `*out` is the host's to destroy.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_shadow_pass_create(const struct Arealight *arealight,
                                                  const struct ArealightPassOptions *options,
                                                  const struct ArealightShadowOptions *shadows,
                                                  struct ArealightShadowPass **out);

// How many bytes ArealightResources.shadow_picks needs, for images of `width` x `height` pixels; 0 for a
// pass without shadow rays.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_pass_shadow_picks_size(const struct ArealightPass *pass,
                                                      uint32_t width,
                                                      uint32_t height,
                                                      uint64_t *out);

// How many bytes ArealightShadowResources.history needs, for images of `width` x `height` pixels.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_shadow_history_size(uint32_t width, uint32_t height, uint64_t *out);

// What descriptor sets of the pass are made with.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_shadow_pass_set_layout(const struct ArealightShadowPass *pass,
                                                      struct ArealightSetLayout *out);

// Points a VkDescriptorSet, made with arealight_shadow_pass_set_layout, at resources: `shade` are those of
// the shade pass before.
//
// The host sees to it:
// Pointers are null or valid. No pending commands use the set, and the resources outlive those that will.
enum ArealightResult arealight_shadow_pass_write_set(const struct ArealightShadowPass *pass,
                                                     const struct Arealight *arealight,
                                                     uint64_t set,
                                                     const struct ArealightResources *shade,
                                                     const struct ArealightShadowResources *resources);

// Makes the pipelines for frames whose lights need what this one's do, if they are not made yet: what
// arealight_shadow_pass_record would take a moment for otherwise.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_shadow_pass_prepare(const struct ArealightShadowPass *pass,
                                                   const struct ArealightFrame *frame);

// Records the pass into a VkCommandBuffer, for the frame that the shade pass recorded: two dispatches, or
// three with a history, with barriers between them. The barrier for what the shade pass wrote is the host's,
// and so is one after. `resources` are those that the set was written with.
//
// The host sees to it:
// Pointers are null or valid. As arealight_pass_record; with a history, the frame before of this view was
// recorded earlier on the same queue.
enum ArealightResult arealight_shadow_pass_record(const struct ArealightShadowPass *pass,
                                                  void *command_buffer,
                                                  uint64_t set,
                                                  const struct ArealightShadowResources *resources,
                                                  const struct ArealightShadowFrame *frame);

// Destroys a pass, before or after the object that it was made from. Null is nothing.
//
// The host sees to it:
// No commands of the pass are pending, the device is alive, and no other thread uses the pass.
enum ArealightResult arealight_shadow_pass_destroy(struct ArealightShadowPass *pass);

// Makes an image for what lights show, without memory. `*out` is the host's to destroy.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_textures_create(const struct Arealight *arealight,
                                               const struct ArealightTextureOptions *options,
                                               struct ArealightTextures **out);

// What the textures need of the host: memory, and descriptor sets from pools of the host.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_textures_needs(const struct ArealightTextures *textures,
                                              struct ArealightTextureNeeds *out);

// Binds memory, writes the sets of the levels, and records that every layer is black. Needed once; the
// commands run before any others that use the textures. Commands that were never run are made good by
// another call with the same memory.
//
// The host sees to it:
// Pointers are null or valid, and `setup` is as ArealightTextureSetup says. No pending commands use the
// textures or sets.
enum ArealightResult arealight_textures_setup(struct ArealightTextures *textures,
                                              const struct ArealightTextureSetup *setup);

// Points a VkDescriptorSet, made with ArealightTextureNeeds.source_set, at an image to load: a 2D view with
// VK_IMAGE_USAGE_SAMPLED_BIT, of a format that is sampled as numbers, whose first level is read.
//
// The host sees to it:
// The pointer is null or valid. No pending commands use the set, and the image outlives those that will.
enum ArealightResult arealight_textures_write_source_set(const struct ArealightTextures *textures,
                                                         uint64_t set,
                                                         struct ArealightImage source);

// Records that images replace layers and are filtered, with the barriers between and around: afterwards they
// are visible to shaders. The cost is that of the layers given. The host's barriers make the images visible
// to compute shaders before. Frames that are recorded later on the same queue see the new layers, those
// before the old ones; nothing waits.
//
// The host sees to it:
// Pointers are null or valid. The command buffer is being recorded, outside a render pass, on a queue that
// computes, after the commands of arealight_textures_setup.
enum ArealightResult arealight_textures_update(const struct ArealightTextures *textures,
                                               void *command_buffer,
                                               const struct ArealightTextureUpdate *updates,
                                               uint32_t update_count);

// The textures as ArealightResources.light_textures takes them.
//
// The host sees to it:
// Pointers are null or valid.
enum ArealightResult arealight_textures_image(const struct ArealightTextures *textures,
                                              struct ArealightImage *out);

// Checks that the layer of every textured light is there: passes do not know what will be bound.
//
// The host sees to it:
// Pointers are null or valid, with as many items as their counts say.
enum ArealightResult arealight_textures_check_lights(const struct ArealightTextures *textures,
                                                     const struct ArealightLight *lights,
                                                     uint32_t light_count);

// Destroys textures, before or after the object that they were made from. Null is nothing.
//
// The host sees to it:
// No commands that use them are pending, the device is alive, and no other thread uses the object.
enum ArealightResult arealight_textures_destroy(struct ArealightTextures *textures);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

// Structs are laid out as the library's.
#if UINTPTR_MAX == UINT64_MAX
#ifdef __cplusplus
#define AREALIGHT_ASSERT(condition) static_assert(condition, #condition)
#else
#define AREALIGHT_ASSERT(condition) _Static_assert(condition, #condition)
#endif
AREALIGHT_ASSERT(sizeof(ArealightAreaLightsInfo) == 144);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, options) == 0);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, table) == 112);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, medium) == 120);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, frames_in_flight) == 128);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, shadow_filter) == 132);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, shadow_history) == 136);
AREALIGHT_ASSERT(offsetof(ArealightAreaLightsInfo, reserved) == 140);
AREALIGHT_ASSERT(sizeof(ArealightMediumOptions) == 48);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, shadow_rays) == 0);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, samples) == 4);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, by_image) == 8);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, jitter) == 12);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, fill_hidden) == 16);
AREALIGHT_ASSERT(offsetof(ArealightMediumOptions, module) == 24);
AREALIGHT_ASSERT(sizeof(ArealightMediumResources) == 80);
AREALIGHT_ASSERT(offsetof(ArealightMediumResources, froxels) == 0);
AREALIGHT_ASSERT(offsetof(ArealightMediumResources, medium) == 16);
AREALIGHT_ASSERT(offsetof(ArealightMediumResources, blocker_nodes) == 32);
AREALIGHT_ASSERT(offsetof(ArealightMediumResources, blocker_triangles) == 56);
AREALIGHT_ASSERT(sizeof(ArealightMediumFrame) == 64);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, frame) == 0);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, host_set) == 8);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, froxels) == 16);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, scattering) == 28);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, extinction) == 40);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, anisotropy) == 44);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, nearest) == 48);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, farthest) == 52);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, seed) == 56);
AREALIGHT_ASSERT(offsetof(ArealightMediumFrame, cull_radiance) == 60);
AREALIGHT_ASSERT(sizeof(ArealightTextureOptions) == 8);
AREALIGHT_ASSERT(offsetof(ArealightTextureOptions, side) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTextureOptions, layers) == 4);
AREALIGHT_ASSERT(sizeof(ArealightTextureNeeds) == 104);
AREALIGHT_ASSERT(offsetof(ArealightTextureNeeds, memory) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTextureNeeds, level_set) == 32);
AREALIGHT_ASSERT(offsetof(ArealightTextureNeeds, source_set) == 64);
AREALIGHT_ASSERT(offsetof(ArealightTextureNeeds, level_set_count) == 96);
AREALIGHT_ASSERT(offsetof(ArealightTextureNeeds, reserved) == 100);
AREALIGHT_ASSERT(sizeof(ArealightTextureSetup) == 40);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, memory) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, memory_offset) == 8);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, level_sets) == 16);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, level_set_count) == 24);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, reserved) == 28);
AREALIGHT_ASSERT(offsetof(ArealightTextureSetup, command_buffer) == 32);
AREALIGHT_ASSERT(sizeof(ArealightTextureUpdate) == 80);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, source_set) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, part_low) == 8);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, part_size) == 24);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, layer) == 40);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, source_width) == 44);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, source_height) == 48);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, decode_srgb) == 52);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, wrap_u) == 56);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, wrap_v) == 60);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, divisor) == 64);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, aspect) == 68);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, is_ellipse) == 72);
AREALIGHT_ASSERT(offsetof(ArealightTextureUpdate, reserved) == 76);
AREALIGHT_ASSERT(sizeof(ArealightHost) == 56);
AREALIGHT_ASSERT(offsetof(ArealightHost, abi_version) == 0);
AREALIGHT_ASSERT(offsetof(ArealightHost, api_version) == 4);
AREALIGHT_ASSERT(offsetof(ArealightHost, get_instance_proc_addr) == 8);
AREALIGHT_ASSERT(offsetof(ArealightHost, get_device_proc_addr) == 16);
AREALIGHT_ASSERT(offsetof(ArealightHost, instance) == 24);
AREALIGHT_ASSERT(offsetof(ArealightHost, physical_device) == 32);
AREALIGHT_ASSERT(offsetof(ArealightHost, device) == 40);
AREALIGHT_ASSERT(offsetof(ArealightHost, pipeline_cache) == 48);
AREALIGHT_ASSERT(sizeof(ArealightTable) == 24);
AREALIGHT_ASSERT(offsetof(ArealightTable, bytes) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTable, size) == 8);
AREALIGHT_ASSERT(offsetof(ArealightTable, format) == 16);
AREALIGHT_ASSERT(offsetof(ArealightTable, reserved) == 20);
AREALIGHT_ASSERT(sizeof(ArealightMemory) == 32);
AREALIGHT_ASSERT(offsetof(ArealightMemory, size) == 0);
AREALIGHT_ASSERT(offsetof(ArealightMemory, alignment) == 8);
AREALIGHT_ASSERT(offsetof(ArealightMemory, staging_size) == 16);
AREALIGHT_ASSERT(offsetof(ArealightMemory, memory_type_bits) == 24);
AREALIGHT_ASSERT(offsetof(ArealightMemory, reserved) == 28);
AREALIGHT_ASSERT(sizeof(ArealightUpload) == 40);
AREALIGHT_ASSERT(offsetof(ArealightUpload, staging_data) == 0);
AREALIGHT_ASSERT(offsetof(ArealightUpload, staging_size) == 8);
AREALIGHT_ASSERT(offsetof(ArealightUpload, staging_buffer) == 16);
AREALIGHT_ASSERT(offsetof(ArealightUpload, staging_offset) == 24);
AREALIGHT_ASSERT(offsetof(ArealightUpload, command_buffer) == 32);
AREALIGHT_ASSERT(sizeof(ArealightModule) == 24);
AREALIGHT_ASSERT(offsetof(ArealightModule, words) == 0);
AREALIGHT_ASSERT(offsetof(ArealightModule, size) == 8);
AREALIGHT_ASSERT(offsetof(ArealightModule, host_set_layout) == 16);
AREALIGHT_ASSERT(sizeof(ArealightPassOptions) == 112);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, surfaces) == 0);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, horizon) == 4);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, specular_lobes) == 8);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, lobes) == 12);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, footprint) == 16);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, position) == 20);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, output) == 24);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, radiance_images) == 28);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, radiance_format) == 32);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, g_buffer) == 36);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, tile_capacity) == 40);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, tile_cull_threshold) == 44);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, tile_least_quads) == 48);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, shadow_rays) == 52);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, camera) == 56);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, rectangle) == 60);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, texels_per_pixel) == 64);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, samples) == 68);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, stencil) == 72);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, light_counts) == 76);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, descriptors) == 80);
AREALIGHT_ASSERT(offsetof(ArealightPassOptions, module) == 88);
AREALIGHT_ASSERT(sizeof(ArealightSetLayout) == 32);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, layout) == 0);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, sampled_images) == 8);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, combined_image_samplers) == 12);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, storage_images) == 16);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, storage_buffers) == 20);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, dynamic_storage_buffers) == 24);
AREALIGHT_ASSERT(offsetof(ArealightSetLayout, reserved) == 28);
AREALIGHT_ASSERT(sizeof(ArealightLight) == 272);
AREALIGHT_ASSERT(offsetof(ArealightLight, name) == 0);
AREALIGHT_ASSERT(offsetof(ArealightLight, kind) == 8);
AREALIGHT_ASSERT(offsetof(ArealightLight, two_sided) == 12);
AREALIGHT_ASSERT(offsetof(ArealightLight, radiance) == 16);
AREALIGHT_ASSERT(offsetof(ArealightLight, textured) == 28);
AREALIGHT_ASSERT(offsetof(ArealightLight, texture_layer) == 32);
AREALIGHT_ASSERT(offsetof(ArealightLight, vertex_count) == 36);
AREALIGHT_ASSERT(offsetof(ArealightLight, vertices) == 40);
AREALIGHT_ASSERT(offsetof(ArealightLight, texture_coordinates) == 48);
AREALIGHT_ASSERT(offsetof(ArealightLight, hole_vertex_counts) == 56);
AREALIGHT_ASSERT(offsetof(ArealightLight, face_vertex_counts) == 64);
AREALIGHT_ASSERT(offsetof(ArealightLight, hole_count) == 72);
AREALIGHT_ASSERT(offsetof(ArealightLight, face_count) == 76);
AREALIGHT_ASSERT(offsetof(ArealightLight, center) == 80);
AREALIGHT_ASSERT(offsetof(ArealightLight, axis_u) == 104);
AREALIGHT_ASSERT(offsetof(ArealightLight, axis_v) == 128);
AREALIGHT_ASSERT(offsetof(ArealightLight, radius) == 152);
AREALIGHT_ASSERT(offsetof(ArealightLight, ends) == 160);
AREALIGHT_ASSERT(offsetof(ArealightLight, profile_row_count) == 164);
AREALIGHT_ASSERT(offsetof(ArealightLight, profile_azimuth_count) == 168);
AREALIGHT_ASSERT(offsetof(ArealightLight, links) == 172);
AREALIGHT_ASSERT(offsetof(ArealightLight, profile) == 176);
AREALIGHT_ASSERT(offsetof(ArealightLight, profile_levels) == 184);
AREALIGHT_ASSERT(offsetof(ArealightLight, has_opening) == 188);
AREALIGHT_ASSERT(offsetof(ArealightLight, opening_center) == 192);
AREALIGHT_ASSERT(offsetof(ArealightLight, opening_axis_u) == 216);
AREALIGHT_ASSERT(offsetof(ArealightLight, opening_axis_v) == 240);
AREALIGHT_ASSERT(offsetof(ArealightLight, opening_housed) == 264);
AREALIGHT_ASSERT(offsetof(ArealightLight, cluster_error) == 268);
AREALIGHT_ASSERT(sizeof(ArealightReach) == 80);
AREALIGHT_ASSERT(offsetof(ArealightReach, center) == 0);
AREALIGHT_ASSERT(offsetof(ArealightReach, radius) == 24);
AREALIGHT_ASSERT(offsetof(ArealightReach, low) == 32);
AREALIGHT_ASSERT(offsetof(ArealightReach, high) == 56);
AREALIGHT_ASSERT(sizeof(ArealightLightSummary) == 16);
AREALIGHT_ASSERT(offsetof(ArealightLightSummary, light_count) == 0);
AREALIGHT_ASSERT(offsetof(ArealightLightSummary, quad_count) == 4);
AREALIGHT_ASSERT(offsetof(ArealightLightSummary, shape_count) == 8);
AREALIGHT_ASSERT(offsetof(ArealightLightSummary, effects) == 12);
AREALIGHT_ASSERT(sizeof(ArealightPackedLights) == 64);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, lights) == 0);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, vertices) == 8);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, shapes) == 16);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, lights_size) == 24);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, vertices_size) == 32);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, shapes_size) == 40);
AREALIGHT_ASSERT(offsetof(ArealightPackedLights, summary) == 48);
AREALIGHT_ASSERT(sizeof(ArealightImage) == 16);
AREALIGHT_ASSERT(offsetof(ArealightImage, view) == 0);
AREALIGHT_ASSERT(offsetof(ArealightImage, layout) == 8);
AREALIGHT_ASSERT(offsetof(ArealightImage, reserved) == 12);
AREALIGHT_ASSERT(sizeof(ArealightBuffer) == 24);
AREALIGHT_ASSERT(offsetof(ArealightBuffer, buffer) == 0);
AREALIGHT_ASSERT(offsetof(ArealightBuffer, offset) == 8);
AREALIGHT_ASSERT(offsetof(ArealightBuffer, range) == 16);
AREALIGHT_ASSERT(sizeof(ArealightResources) == 376);
AREALIGHT_ASSERT(offsetof(ArealightResources, lights) == 0);
AREALIGHT_ASSERT(offsetof(ArealightResources, light_vertices) == 24);
AREALIGHT_ASSERT(offsetof(ArealightResources, shapes) == 48);
AREALIGHT_ASSERT(offsetof(ArealightResources, planes) == 72);
AREALIGHT_ASSERT(offsetof(ArealightResources, light_textures) == 232);
AREALIGHT_ASSERT(offsetof(ArealightResources, radiance) == 248);
AREALIGHT_ASSERT(offsetof(ArealightResources, glossy) == 264);
AREALIGHT_ASSERT(offsetof(ArealightResources, lobe_horizons) == 280);
AREALIGHT_ASSERT(offsetof(ArealightResources, tile_lists) == 304);
AREALIGHT_ASSERT(offsetof(ArealightResources, shadow_picks) == 328);
AREALIGHT_ASSERT(offsetof(ArealightResources, light_counts) == 352);
AREALIGHT_ASSERT(sizeof(ArealightViewport) == 24);
AREALIGHT_ASSERT(offsetof(ArealightViewport, x) == 0);
AREALIGHT_ASSERT(offsetof(ArealightViewport, y) == 4);
AREALIGHT_ASSERT(offsetof(ArealightViewport, width) == 8);
AREALIGHT_ASSERT(offsetof(ArealightViewport, height) == 12);
AREALIGHT_ASSERT(offsetof(ArealightViewport, min_depth) == 16);
AREALIGHT_ASSERT(offsetof(ArealightViewport, max_depth) == 20);
AREALIGHT_ASSERT(sizeof(ArealightFrame) == 144);
AREALIGHT_ASSERT(offsetof(ArealightFrame, width) == 0);
AREALIGHT_ASSERT(offsetof(ArealightFrame, height) == 4);
AREALIGHT_ASSERT(offsetof(ArealightFrame, camera) == 8);
AREALIGHT_ASSERT(offsetof(ArealightFrame, lights) == 20);
AREALIGHT_ASSERT(offsetof(ArealightFrame, seed) == 36);
AREALIGHT_ASSERT(offsetof(ArealightFrame, position_from_clip) == 40);
AREALIGHT_ASSERT(offsetof(ArealightFrame, tile_lists) == 48);
AREALIGHT_ASSERT(offsetof(ArealightFrame, host_set) == 72);
AREALIGHT_ASSERT(offsetof(ArealightFrame, viewport) == 80);
AREALIGHT_ASSERT(offsetof(ArealightFrame, offset) == 104);
AREALIGHT_ASSERT(offsetof(ArealightFrame, rows) == 112);
AREALIGHT_ASSERT(offsetof(ArealightFrame, stencil_compare_mask) == 120);
AREALIGHT_ASSERT(offsetof(ArealightFrame, stencil_reference) == 124);
AREALIGHT_ASSERT(offsetof(ArealightFrame, light_offsets) == 128);
AREALIGHT_ASSERT(sizeof(ArealightTileMemory) == 16);
AREALIGHT_ASSERT(offsetof(ArealightTileMemory, size) == 0);
AREALIGHT_ASSERT(offsetof(ArealightTileMemory, usage) == 8);
AREALIGHT_ASSERT(offsetof(ArealightTileMemory, reserved) == 12);
AREALIGHT_ASSERT(sizeof(ArealightShadowOptions) == 40);
AREALIGHT_ASSERT(offsetof(ArealightShadowOptions, filter) == 0);
AREALIGHT_ASSERT(offsetof(ArealightShadowOptions, history) == 4);
AREALIGHT_ASSERT(offsetof(ArealightShadowOptions, output) == 8);
AREALIGHT_ASSERT(offsetof(ArealightShadowOptions, module) == 16);
AREALIGHT_ASSERT(sizeof(ArealightShadowResources) == 104);
AREALIGHT_ASSERT(offsetof(ArealightShadowResources, shadow) == 0);
AREALIGHT_ASSERT(offsetof(ArealightShadowResources, radiance) == 16);
AREALIGHT_ASSERT(offsetof(ArealightShadowResources, history) == 32);
AREALIGHT_ASSERT(offsetof(ArealightShadowResources, blocker_nodes) == 56);
AREALIGHT_ASSERT(offsetof(ArealightShadowResources, blocker_triangles) == 80);
AREALIGHT_ASSERT(sizeof(ArealightShadowFrame) == 32);
AREALIGHT_ASSERT(offsetof(ArealightShadowFrame, frame) == 0);
AREALIGHT_ASSERT(offsetof(ArealightShadowFrame, host_set) == 8);
AREALIGHT_ASSERT(offsetof(ArealightShadowFrame, origin_shift) == 16);
AREALIGHT_ASSERT(offsetof(ArealightShadowFrame, reserved) == 28);
AREALIGHT_ASSERT(sizeof(ArealightBlockerArrays) == 32);
AREALIGHT_ASSERT(offsetof(ArealightBlockerArrays, nodes) == 0);
AREALIGHT_ASSERT(offsetof(ArealightBlockerArrays, triangles) == 8);
AREALIGHT_ASSERT(offsetof(ArealightBlockerArrays, nodes_size) == 16);
AREALIGHT_ASSERT(offsetof(ArealightBlockerArrays, triangles_size) == 24);
#undef AREALIGHT_ASSERT
#endif

#endif  /* AREALIGHT_H */
