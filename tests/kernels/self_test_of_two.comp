#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The self-test as a host of two lobes runs it, with options that don't matter to it.

#define AREALIGHT_TWO_SPECULAR_LOBES 1
#define AREALIGHT_SURFACE_HORIZON 1
#define AREALIGHT_MULTIPLE_SCATTERING 1
#include "arealight/self_test.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform texture2DArray table;
layout(set = 0, binding = 1, std430) writeonly buffer Result { uint wrong_points; };

vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }

void main() {
    wrong_points = arealight_self_test();
}
