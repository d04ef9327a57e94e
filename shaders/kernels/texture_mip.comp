#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Makes a mip of images on lights: the mean of four texels, coverage too.

layout(local_size_x = 16, local_size_y = 4) in;

#include "half.glsl"
#include "image_layers.glsl"

layout(set = 0, binding = 0) uniform texture2DArray finer_level;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

layout(push_constant, std430) uniform TextureMipConstants {
    uint first_layer;
} constants;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int layer = int(IMAGE_LAYERS * (constants.first_layer + gl_GlobalInvocationID.z));
    if (any(greaterThanEqual(texel, imageSize(out_level).xy))) {
        return;
    }
    vec4 sum = texelFetch(finer_level, ivec3(2 * texel, layer), 0)
             + texelFetch(finer_level, ivec3(2 * texel + ivec2(1, 0), layer), 0)
             + texelFetch(finer_level, ivec3(2 * texel + ivec2(0, 1), layer), 0)
             + texelFetch(finer_level, ivec3(2 * texel + ivec2(1, 1), layer), 0);
    imageStore(out_level, ivec3(texel, layer), round_to_half(0.25 * sum));
}
