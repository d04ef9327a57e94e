#ifndef OUTPUT_GLSL
#define OUTPUT_GLSL

// The images that radiance goes to. The including kernel defines RADIANCE_BINDING, GLOSSY_BINDING and the constant OUTPUT:
// bits, of which none overwrites one image of 32-bit floats.

#include "arealight/light_kind.glsl"
#include "half.glsl"

// The same as ShadeOptions::output_bits in Rust (a test compares them).
const int OUTPUT_ADD = 1;   // to what is there; pixels without a surface stay as they are
const int OUTPUT_APART = 2; // the glossy lobe's radiance goes to an image of its own
const int OUTPUT_HALF = 4;  // the images are rgba16f: so the recorder writes it into the module, Kernel::words_for

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform image2D radiance_image;
layout(set = 0, binding = GLOSSY_BINDING, rgba32f) uniform image2D glossy_image;

// What a pixel reflects so far.
struct PixelRadiance {
    vec3 radiance; // of both lobes, or of the diffuse lobe with OUTPUT_APART
    vec3 glossy;   // of the glossy lobe with OUTPUT_APART, else zero
};

// Adds what is reflected of a light of this radiance.
void add_light(inout PixelRadiance sum, vec3 radiance, ArealightReflected reflected) {
    if ((OUTPUT & OUTPUT_APART) != 0) {
        sum.radiance += radiance * reflected.diffuse;
        sum.glossy += radiance * reflected.specular;
    } else {
        sum.radiance += radiance * (reflected.specular + reflected.diffuse);
    }
}

// A texel as it is stored. What sixteen bits cannot hold becomes the largest number that they can: an infinite texel
// would spread over the picture in whatever filter comes next.
vec4 output_texel(vec3 radiance, bool hit) {
    if ((OUTPUT & OUTPUT_HALF) != 0) {
        radiance = round_to_half(min(radiance, vec3(LARGEST_HALF)));
    }
    return hit ? vec4(radiance, 1.0) : vec4(0.0);
}

// Stores what a pixel reflects; `hit`: it has a surface.
void store_radiance(ivec2 pixel, bool hit, PixelRadiance sum) {
    if ((OUTPUT & OUTPUT_ADD) != 0) {
        if (!hit) {
            return;
        }
        sum.radiance = imageLoad(radiance_image, pixel).rgb + sum.radiance;
        if ((OUTPUT & OUTPUT_APART) != 0) {
            sum.glossy = imageLoad(glossy_image, pixel).rgb + sum.glossy;
        }
    }
    imageStore(radiance_image, pixel, output_texel(sum.radiance, hit));
    if ((OUTPUT & OUTPUT_APART) != 0) {
        imageStore(glossy_image, pixel, output_texel(sum.glossy, hit));
    }
}

#endif
