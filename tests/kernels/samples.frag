#version 450

// Writes to three images what a buffer holds for one sample of each pixel.

struct Texel {
    vec4 position;
    vec4 normal;
    vec4 color;
};

layout(set = 0, binding = 0, std430) readonly buffer Texels {
    Texel texels[];
};

layout(push_constant, std430) uniform Constants {
    uint width;
    uint samples;
    uint index; // of the sample
} constants;

layout(location = 0) out vec4 position;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 color;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Texel texel = texels[(pixel.y * constants.width + pixel.x) * constants.samples + constants.index];
    position = texel.position;
    normal = texel.normal;
    color = texel.color;
}
