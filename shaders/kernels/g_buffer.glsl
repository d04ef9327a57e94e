#ifndef G_BUFFER_GLSL
#define G_BUFFER_GLSL

// Reading a G-buffer. The including kernel defines G_BUFFER_BINDING, the first of four.

#include "arealight/effects.glsl"
#include "arealight/surface.glsl"

layout(set = 0, binding = G_BUFFER_BINDING) uniform texture2D g_position;
layout(set = 0, binding = G_BUFFER_BINDING + 1) uniform texture2D g_normal;
layout(set = 0, binding = G_BUFFER_BINDING + 2) uniform texture2D g_base_color;
layout(set = 0, binding = G_BUFFER_BINDING + 3) uniform texture2D g_specular;

// The surface that a pixel sees from `camera`, at `position`.
ArealightSurface load_surface(ivec2 pixel, vec3 position, vec3 camera, uint effects) {
    vec4 normal = texelFetch(g_normal, pixel, 0);
    vec4 base_color = texelFetch(g_base_color, pixel, 0);
    vec4 specular = vec4(0.04, 0.04, 0.04, 1.0);
    if ((effects & AREALIGHT_EFFECT_SPECULAR_INPUT) != 0u) {
        specular = texelFetch(g_specular, pixel, 0);
    }
    ArealightSurface surface;
    surface.position = position;
    surface.normal = normal.xyz;
    surface.view = camera - position;
    surface.roughness = normal.w;
    arealight_surface_from_metalness(surface, base_color.rgb, base_color.a, specular.rgb, specular.a);
    return surface;
}

#endif
