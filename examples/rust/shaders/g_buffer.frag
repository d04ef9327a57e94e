#version 450

// The deferred engine's G-buffer: what the surface is, and what it emits.

layout(location = 1) flat in vec3 normal;
layout(location = 2) flat in vec4 base_color_metalness;
layout(location = 3) flat in vec4 emission_roughness;

layout(location = 0) out vec4 out_normal_roughness;
layout(location = 1) out vec4 out_base_color_metalness;
layout(location = 2) out vec4 out_radiance;

void main() {
    out_normal_roughness = vec4(normal, emission_roughness.w);
    out_base_color_metalness = base_color_metalness;
    out_radiance = vec4(emission_roughness.rgb, 1.0);
}
