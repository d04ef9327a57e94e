#ifndef VIEW_GLSL
#define VIEW_GLSL

// Where a pixel of the frame is in the host's images, and from where it is seen. The including kernel has the
// specialisation constant VIEW, position.glsl, g_buffer.glsl and shade_constants.glsl; it defines
// STENCIL_BINDING where frames may have a stencil, and has effects.glsl. The bits are those of
// arealight::plan::ShadeOptions::view_bits.
#include "camera.glsl"
const uint VIEW_RECTANGLE = 2u;
const uint VIEW_STENCIL = 4u;
const int VIEW_TEXELS_SHIFT = 8; // from here on: texels of the G-buffer to a pixel's side, less one

// Where a pixel's radiance goes.
ivec2 radiance_texel(ivec2 pixel) {
    return (VIEW & VIEW_RECTANGLE) != 0u ? pixel + ivec2(constants.offset) : pixel;
}

// What a pixel sees of the G-buffer: the first of its texels.
ivec2 g_buffer_texel(ivec2 pixel) {
    return radiance_texel(pixel) * int((VIEW >> VIEW_TEXELS_SHIFT) + 1u);
}

#ifdef STENCIL_BINDING
layout(set = 0, binding = STENCIL_BINDING) uniform utexture2D g_stencil;
#endif

// Whether a texel of the G-buffer passes the frame's stencil test: its stencil is equal to the reference in
// the bits of the compare mask.
bool passes_stencil(ivec2 texel) {
#ifdef STENCIL_BINDING
    if ((VIEW & VIEW_STENCIL) != 0u) {
        uint compare_mask = constants.stencil & 0xffu;
        uint reference = constants.stencil >> 8u;
        return ((texelFetch(g_stencil, texel, g_buffer_sample).r ^ reference) & compare_mask) == 0u;
    }
#endif
    return true;
}

// The groups of a texel's surface: the bits of its stencil.
uint surface_groups(ivec2 texel) {
#ifdef STENCIL_BINDING
    if (HAS_LINKS) {
        return texelFetch(g_stencil, texel, g_buffer_sample).r;
    }
#endif
    return 0xffu;
}

#endif
