#ifndef POSITION_GLSL
#define POSITION_GLSL

// Where a pixel's surface is, from a position image or from depth. The including kernel has g_buffer.glsl, the
// specialisation constant POSITION_SOURCE, and push constants with position_from_clip.

const int POSITION_FROM_DEPTH = 1;

// The position of a pixel's centre at a depth.
vec3 position_at_depth(ivec2 pixel, ivec2 size, float depth) {
    // Vulkan's clip space has y down, as pixels have
    vec2 clip = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec4 homogeneous = constants.position_from_clip * vec4(clip, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// The position relative to the origin that a texel of the G-buffer holds for a pixel; false where there is no surface.
bool load_position_of(ivec2 texel, ivec2 pixel, ivec2 size, out vec3 position) {
    vec4 found = texelFetch(g_position, texel, 0);
    if (POSITION_SOURCE != POSITION_FROM_DEPTH) {
        position = found.xyz;
        return found.w != 0.0;
    }
    position = position_at_depth(pixel, size, found.x);
    return found.x > 0.0 && found.x < 1.0;
}

// Likewise, of the texel at the pixel's own place.
bool load_position(ivec2 pixel, ivec2 size, out vec3 position) {
    return load_position_of(pixel, pixel, size, position);
}

#endif
