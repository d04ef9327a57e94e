#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The kernel shade for whole frames, with what WebGPU, Direct3D 12 and Metal bind alike: constants of a frame
// in a uniform block, images apart from their sampler, radiance that is written and not read. It is frozen
// and translated by `arealight export --target`.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 11) const bool HAS_QUADS = true;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 19) const uint VIEW = 0u;
// Lights are picked for no shadow ray
const int SHADOW_RAYS = 0;

#include "bindings.glsl"
// What no frame of these has: stencils
#undef STENCIL_BINDING
#define G_BUFFER_LAYOUT LAYOUT
#define RADIANCE_ACCESS writeonly
#define SHADE_CONSTANTS_BINDING 17
#define LIGHT_SAMPLER_BINDING 18
#include "effects.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "shade_constants.glsl"
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "g_buffer.glsl"
#include "output.glsl"

const bool HAS_LIGHTS = true;

// The lights of a pixel: those of the frame.
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
};
uint light_at(LightList list, uint index) {
    return index;
}
uint shape_at(LightList list, uint index) {
    return index;
}

#include "shade_pixel.glsl"

void main() {
    uint quad_count = HAS_POLYGONS ? constants.quad_count : constants.light_count;
    shade_pixel(ivec2(gl_GlobalInvocationID.xy),
                LightList(quad_count, constants.light_count, constants.shape_count));
}
