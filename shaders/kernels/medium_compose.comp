#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Puts the medium that medium_integrate has summed before the surfaces of a picture, an invocation per pixel:
// radiance x what is let through + what the medium sends. Without a surface all of the grid is before it.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;

#define G_BUFFER_SAMPLES 1
#include "froxels.glsl"
layout(set = 0, binding = G_BUFFER_BINDING) uniform texture2D g_position;
int g_buffer_sample = 0;
#include "position.glsl"
#include "output_texel.glsl"

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform image2D radiance_image;

// What is summed to the far side of a slice; before the first there is nothing.
vec4 summed(ivec2 column, int slice) {
    return slice < 0 ? vec4(0.0, 0.0, 0.0, 1.0) : imageLoad(froxels, ivec3(column, slice));
}

vec4 summed_between(ivec2 column, float place) {
    int slice = int(floor(place));
    int last = froxel_counts().z - 1;
    return mix(summed(column, min(slice, last)), summed(column, min(slice + 1, last)), place - float(slice));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(radiance_image);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    ivec3 counts = froxel_counts();
    vec3 position;
    bool hit = load_position(pixel, size, position);
    float away = hit ? min(distance(position, constants.camera), constants.farthest) : constants.farthest;
    float slice = distance_slice(away) - 1.0;
    // Between the middles of four columns
    vec2 columns = (vec2(pixel) + 0.5) / vec2(size) * vec2(counts.xy);
    vec2 place = clamp(columns - 0.5, vec2(0.0), vec2(counts.xy - 1));
    ivec2 low = ivec2(place);
    ivec2 high = min(low + 1, counts.xy - 1);
    vec2 part = place - vec2(low);
    vec4 medium = mix(mix(summed_between(low, slice), summed_between(ivec2(high.x, low.y), slice), part.x),
                      mix(summed_between(ivec2(low.x, high.y), slice), summed_between(high, slice), part.x),
                      part.y);
    vec4 before = imageLoad(radiance_image, pixel);
    vec3 after = before.rgb * medium.a + medium.rgb;
    imageStore(radiance_image, pixel, vec4(output_texel(after, true, 1.0).rgb, before.a));
}
