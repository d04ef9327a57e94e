#version 450

// The scene's vertices, for both engines.

layout(location = 0) in vec3 position; // in the world
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 base_color_metalness;
layout(location = 3) in vec4 emission_roughness;

layout(location = 0) out vec3 out_position; // from the camera: what is near to it keeps its precision
layout(location = 1) flat out vec3 out_normal;
layout(location = 2) flat out vec4 out_base_color_metalness;
layout(location = 3) flat out vec4 out_emission_roughness;

layout(push_constant, std430) uniform Camera {
    mat4 clip_from_view;
    vec3 position;
} camera;

void main() {
    out_position = position - camera.position;
    out_normal = normal;
    out_base_color_metalness = base_color_metalness;
    out_emission_roughness = emission_roughness;
    gl_Position = camera.clip_from_view * vec4(out_position, 1.0);
}
