#ifndef LIGHT_TEXTURES_GLSL
#define LIGHT_TEXTURES_GLSL

// The lights' textures for the library. The including kernel defines LIGHT_TEXTURES_BINDING, and AREALIGHT_LIGHT_TEXTURES as 1.

layout(set = 0, binding = LIGHT_TEXTURES_BINDING) uniform sampler2DArray light_textures;

vec3 arealight_bridge_light_texture(uint layer, vec2 coordinate, float level) {
    return textureLod(light_textures, vec3(coordinate, float(layer)), level).rgb;
}

ivec2 arealight_bridge_light_texture_size() {
    return textureSize(light_textures, 0).xy;
}

#endif
