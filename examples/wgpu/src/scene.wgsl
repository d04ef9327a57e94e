// The G-buffer of the scene that examples/rust draws.

struct Camera {
    clip_from_view: mat4x4<f32>,
    position: vec3<f32>,
}

@group(0) @binding(0) var<uniform> camera: Camera;

struct Surface {
    @builtin(position) place: vec4<f32>,
    @location(0) @interpolate(flat) normal: vec3<f32>,
    @location(1) @interpolate(flat) base_color_metalness: vec4<f32>,
    @location(2) @interpolate(flat) emission_roughness: vec4<f32>,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) base_color_metalness: vec4<f32>,
    @location(3) emission_roughness: vec4<f32>,
) -> Surface {
    let place = camera.clip_from_view * vec4(position - camera.position, 1.0);
    return Surface(place, normal, base_color_metalness, emission_roughness);
}

struct Targets {
    @location(0) normal_roughness: vec4<f32>,
    @location(1) base_color_metalness: vec4<f32>,
    @location(2) radiance: vec4<f32>,
}

@fragment
fn fragment(surface: Surface) -> Targets {
    return Targets(
        vec4(surface.normal, surface.emission_roughness.w),
        surface.base_color_metalness,
        vec4(surface.emission_roughness.xyz, 1.0),
    );
}
