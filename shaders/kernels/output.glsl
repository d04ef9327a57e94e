#ifndef OUTPUT_GLSL
#define OUTPUT_GLSL

// The images that radiance goes to. The including kernel defines RADIANCE_BINDING, GLOSSY_BINDING and the
// constant OUTPUT; and RADIANCE_ACCESS as writeonly where images of floats cannot be read and written:
// without OUTPUT_ADD, then.

#include "arealight/light_kind.glsl"
#include "output_texel.glsl"

#ifdef RADIANCE_ACCESS
#define RADIANCE_IS_READ 0
#else
#define RADIANCE_ACCESS
#define RADIANCE_IS_READ 1
#endif

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) RADIANCE_ACCESS uniform image2D radiance_image;
layout(set = 0, binding = GLOSSY_BINDING, rgba32f) RADIANCE_ACCESS uniform image2D glossy_image;

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

// Stores what a pixel reflects; `hit`: it has a surface, and `coverage` is the part of it that has.
void store_radiance(ivec2 pixel, bool hit, float coverage, PixelRadiance sum) {
#if RADIANCE_IS_READ
    if ((OUTPUT & OUTPUT_ADD) != 0) {
        if (!hit) {
            return;
        }
        sum.radiance = imageLoad(radiance_image, pixel).rgb + sum.radiance;
        if ((OUTPUT & OUTPUT_APART) != 0) {
            sum.glossy = imageLoad(glossy_image, pixel).rgb + sum.glossy;
        }
    }
#endif
    imageStore(radiance_image, pixel, output_texel(sum.radiance, hit, coverage));
    if ((OUTPUT & OUTPUT_APART) != 0) {
        imageStore(glossy_image, pixel, output_texel(sum.glossy, hit, coverage));
    }
}

#endif
