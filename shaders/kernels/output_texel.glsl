#ifndef OUTPUT_TEXEL_GLSL
#define OUTPUT_TEXEL_GLSL

// Texels of the images that radiance goes to. The including kernel has the constant OUTPUT: bits; 0
// overwrites one image of 32-bit floats.

#include "half.glsl"

// The same as ShadeOptions::output_bits in Rust (a test compares them).
const int OUTPUT_ADD = 1;   // to what is there; pixels without a surface stay as they are
const int OUTPUT_APART = 2; // the glossy lobe's radiance goes to an image of its own
// The images are rgba16f: so the recorder writes it into the module, Kernel::words_for
const int OUTPUT_HALF = 4;

// A texel as it is stored; `coverage` is the part that has a surface. Clamped to the largest half float: an
// infinite texel would spread over the picture in later filters.
vec4 output_texel(vec3 radiance, bool hit, float coverage) {
    if ((OUTPUT & OUTPUT_HALF) != 0) {
        radiance = round_to_half(vec4(min(radiance, vec3(LARGEST_HALF)), 0.0)).rgb;
    }
    return hit ? vec4(radiance, coverage) : vec4(0.0);
}

#endif
