#version 450
#extension GL_GOOGLE_include_directive : require

// What arrives of a medium's light along each column, from the camera on: in the place of what medium_scatter
// wrote. An invocation per column. Light and extinction are even within a froxel, and its integral is exact:
// what is scattered in a thick one is dimmed on its own way (Hillaire 2015).

layout(local_size_x = 8, local_size_y = 8) in;

#include "froxels.glsl"

void main() {
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    ivec3 counts = froxel_counts();
    if (any(greaterThanEqual(column, counts.xy))) {
        return;
    }
    vec3 radiance = vec3(0.0);
    float transmittance = 1.0;
    float begin = 0.0;
    for (int slice = 0; slice < counts.z; slice++) {
        ivec3 froxel = ivec3(column, slice);
        vec4 scattered = imageLoad(froxels, froxel);
        float end = slice_distance(float(slice) + 1.0);
        float depth = scattered.a * (end - begin);
        // (1 - exp(-depth)) / depth, which cancels where little is dimmed
        float share = depth > 1e-2 ? (1.0 - exp(-depth)) / depth : 1.0 - depth * (0.5 - depth * 0.16666667);
        radiance += transmittance * share * (end - begin) * scattered.rgb;
        transmittance *= exp(-depth);
        imageStore(froxels, froxel, vec4(min(radiance, vec3(65504.0)), transmittance));
        begin = end;
    }
}
