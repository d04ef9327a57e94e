#version 450
#extension GL_GOOGLE_include_directive : require
#include "arealight/arealight.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DArray table; // tables/ggx.ktx2; or texture2DArray and a sampler
// Position; normal, roughness; base colour, metalness
layout(set = 0, binding = 1) uniform sampler2D g_buffer[3];
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D radiance_image;
// 128 bytes: of a stride that is no power of two Adreno's compiler (Mesa 22.3) fuses no multiply and add
struct Lamp { vec3 radiance; float reserved0; vec3 center; float reserved1; vec3 normal; float reserved2;
    vec4 vertices[4]; vec4 padding; };
layout(set = 0, binding = 3, std430) readonly buffer Lamps { Lamp lamps[]; };
layout(push_constant) uniform Frame { vec3 camera; uint lamp_count; } frame;

// doc: bridges
// The bridges: how the library reads what is yours
vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }
// doc end

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 normal_roughness = texelFetch(g_buffer[1], pixel, 0);
    if (normal_roughness.xyz == vec3(0.0)) {
        return; // the background stays as it is
    }
    vec4 base_color_metalness = texelFetch(g_buffer[2], pixel, 0);
    ArealightSurface surface;
    surface.position = texelFetch(g_buffer[0], pixel, 0).xyz;
    surface.normal = normal_roughness.xyz;
    surface.view = frame.camera - surface.position;
    surface.roughness = normal_roughness.w;
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04),
                                     1.0);

    // doc: lights
    ArealightPoint point = arealight_point(surface);
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.lamp_count; i++) {
        ArealightQuadLight light;
        light.radiance = lamps[i].radiance;
        light.center = lamps[i].center; // relative to the origin of positions, as frame.camera is
        light.normal = lamps[i].normal; // of the front, unit
        light.quad = ArealightQuad(lamps[i].vertices[0].xyz, lamps[i].vertices[1].xyz,
                                   lamps[i].vertices[2].xyz,
                                   lamps[i].vertices[3].xyz); // from the center
        light.two_sided = false;
        radiance += arealight_radiance(point, light);
    }
    // doc end
    imageStore(radiance_image, pixel, vec4(radiance, 1.0));
}
