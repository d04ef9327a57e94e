#version 450
#extension GL_EXT_samplerless_texture_functions : require

// The yardstick of the light textures' filter: a plain chain of mips, each texel the mean of SIDE x SIDE of
// the level before. With SIDE 1, a copy.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int SIDE = 2;

layout(set = 0, binding = 0) uniform texture2DArray finer_level;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(out_level).xy))) {
        return;
    }
    vec4 sum = vec4(0.0);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            sum += texelFetch(finer_level, ivec3(texel * SIDE + ivec2(x, y), 0), 0);
        }
    }
    imageStore(out_level, ivec3(texel, 0), sum * (1.0 / float(SIDE * SIDE)));
}
