#ifndef LIGHT_TEXTURES_GLSL
#define LIGHT_TEXTURES_GLSL

// The lights' textures for the library. The including kernel defines LIGHT_TEXTURES_BINDING, and
// AREALIGHT_LIGHT_TEXTURES as 1; also LIGHT_SAMPLER_BINDING where the image and its sampler are bound apart.

#include "image_layers.glsl"

#ifdef LIGHT_SAMPLER_BINDING
layout(set = 0, binding = LIGHT_TEXTURES_BINDING) uniform texture2DArray light_images;
layout(set = 0, binding = LIGHT_SAMPLER_BINDING) uniform sampler light_sampler;

vec4 arealight_bridge_light_texture(uint layer, uint part, vec2 coordinate, float level) {
    vec3 place = vec3(coordinate, float(IMAGE_LAYERS * layer + part));
    return textureLod(sampler2DArray(light_images, light_sampler), place, level);
}

int arealight_bridge_light_texture_side() {
    return textureSize(light_images, 0).x;
}

#else
layout(set = 0, binding = LIGHT_TEXTURES_BINDING) uniform sampler2DArray light_textures;

vec4 arealight_bridge_light_texture(uint layer, uint part, vec2 coordinate, float level) {
    return textureLod(light_textures, vec3(coordinate, float(IMAGE_LAYERS * layer + part)), level);
}

int arealight_bridge_light_texture_side() {
    return textureSize(light_textures, 0).x;
}
#endif

#endif
