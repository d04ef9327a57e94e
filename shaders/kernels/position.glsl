#ifndef POSITION_GLSL
#define POSITION_GLSL

// Where a pixel's surface is, from a position image or from depth. The including kernel has g_buffer.glsl,
// the specialisation constant POSITION_SOURCE, and push constants with position_from_clip.

const int POSITION_FROM_DEPTH = 1;

// Where in its pixel the sample lies that is read of the G-buffer, 0 to 1: Vulkan's standard locations of 2,
// 4 and 8 samples.
vec2 sample_location() {
    if (G_BUFFER_SAMPLES == 1) {
        return vec2(0.5);
    }
    const vec2 sixteenths[14] = vec2[](
        vec2(12.0, 12.0), vec2(4.0, 4.0),
        vec2(6.0, 2.0), vec2(14.0, 6.0), vec2(2.0, 10.0), vec2(10.0, 14.0),
        vec2(9.0, 5.0), vec2(7.0, 11.0), vec2(13.0, 9.0), vec2(5.0, 3.0),
        vec2(3.0, 13.0), vec2(1.0, 7.0), vec2(11.0, 15.0), vec2(15.0, 1.0)
    );
    return sixteenths[G_BUFFER_SAMPLES - 2 + g_buffer_sample] / 16.0;
}

// The position of a pixel at a depth.
vec3 position_at_depth(ivec2 pixel, ivec2 size, float depth) {
    // Vulkan's clip space has y down, as pixels have
    vec2 clip = (vec2(pixel) + sample_location()) / vec2(size) * 2.0 - 1.0;
    vec4 homogeneous = constants.position_from_clip * vec4(clip, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// The position relative to the origin that a texel of the G-buffer holds for a pixel; false where there is no
// surface.
bool load_position_of(ivec2 texel, ivec2 pixel, ivec2 size, out vec3 position) {
    vec4 found = texelFetch(g_position, texel, g_buffer_sample);
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
