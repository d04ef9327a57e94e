#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Marks the froxels that pixels look through, for medium_scatter: what surfaces hide need not be shaded. An
// invocation per column.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 2) const int POSITION_SOURCE = 0;

#define G_BUFFER_SAMPLES 1
#include "froxels.glsl"
layout(set = 0, binding = G_BUFFER_BINDING) uniform texture2D g_position;
int g_buffer_sample = 0;
#include "position.glsl"

void main() {
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    ivec3 counts = froxel_counts();
    if (any(greaterThanEqual(column, counts.xy))) {
        return;
    }
    // medium_compose takes of a pixel's own column and of those beside it, half a column away
    ivec2 size = textureSize(g_position, 0);
    vec2 pixels = vec2(size) / vec2(counts.xy);
    ivec2 low = max(ivec2((vec2(column) - 0.5) * pixels) - 1, ivec2(0));
    ivec2 high = min(ivec2((vec2(column) + 1.5) * pixels) + 1, size);
    float away = 0.0;
    for (int y = low.y; y < high.y && away < constants.farthest; y++) {
        for (int x = low.x; x < high.x; x++) {
            vec3 position;
            bool hit = load_position(ivec2(x, y), size, position);
            // NaN hides nothing
            float here = hit ? distance(position, constants.camera) : constants.farthest;
            away = here <= away ? away : here;
        }
    }
    float last = distance_slice(min(away, constants.farthest));
    for (int slice = 0; slice < counts.z; slice++) {
        imageStore(froxels, ivec3(column, slice), vec4(float(slice) > last ? 0.0 : 1.0));
    }
}
