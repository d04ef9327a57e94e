#ifndef LIGHT_TEXTURES_GLSL
#define LIGHT_TEXTURES_GLSL

// The lights' textures as the library sees them. The including kernel defines LIGHT_TEXTURES_BINDING.

#define AREALIGHT_LIGHT_TEXTURES 1

layout(set = 0, binding = LIGHT_TEXTURES_BINDING) uniform sampler2DArray light_textures;

vec3 arealight_bridge_light_texture(uint layer, vec2 coordinate, float level) {
    return textureLod(light_textures, vec3(coordinate, float(layer)), level).rgb;
}

ivec2 arealight_bridge_light_texture_size() {
    return textureSize(light_textures, 0).xy;
}

#endif
