#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "arealight/self_test.glsl"

// Says whether the table is loaded as it should be: dispatch it once when your engine starts, and read the
// word back.

layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform texture2DArray table; // tables/ggx.ktx2
layout(set = 0, binding = 1, std430) writeonly buffer Result { uint wrong_points; }; // 0: all is right

// doc: test
// Your bridges, as in your other shaders: they are what is tested
vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }

void main() {
    wrong_points = arealight_self_test();
}
// doc end
