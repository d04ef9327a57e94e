#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Multiplies the unshadowed radiance with what of it arrives: the mean of the pixel's rays, or of those of
// its neighbours in the same plane too, over a part of the penumbra that it is in. Where no neighbour has a
// ray that is hidden nothing is filtered, nor at contact, whose penumbra has no width.
//
// Source of the filter's width: Fernando 2005 (percentage-closer soft shadows), with blockers found by the
// rays themselves.

#include "shadow_resources.glsl"
#include "shadow_history.glsl"
#include "shadow_neighbours.glsl"

layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 16) const int SHADOW_FILTER = 1;
// 1: of the history, else of this frame's rays alone.
layout(constant_id = 18) const int SHADOW_HISTORY = 0;

#include "output_texel.glsl"

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform readonly image2D unshadowed_image;
layout(set = 0, binding = SHADOWED_BINDING, rgba32f) uniform image2D radiance_image;

// Pixels to each side that are searched for blockers, and that the mean is over. Wider means change the error
// by less than a tenth.
const int REACH = 6;
// The standard deviation of the search's weights, in pixels.
const float SEARCH_WIDTH = 3.0;
// Pixels to a side of what a workgroup loads.
const int PATCH = 8 + 2 * REACH;
// The mean's standard deviation as a part of the penumbra's width, and at least, in pixels, for a pixel of
// one ray.
const float PENUMBRA_PART = 0.1;
const float LEAST_WIDTH = 2.0;

// What a workgroup knows of its pixels and those around them: the position, and in w (what arrives, the
// penumbra's width) as halves.
shared vec4 patch_texels[PATCH * PATCH];
// The normal; 0 where there is no light.
shared uint patch_normals[PATCH * PATCH];

// What is known of a pixel, as a texel of shadow_image.
vec4 load_shadow(ivec2 pixel, ivec2 size) {
    if (SHADOW_HISTORY == 0) {
        return imageLoad(shadow_image, pixel);
    }
    HistoryPixel history = load_history(pixel, size, 0u);
    return vec4(history.shadow, sign(history.frames), history.frames * float(SHADOW_RAYS));
}

void load_patch(ivec2 corner, ivec2 size) {
    for (int i = int(gl_LocalInvocationIndex); i < PATCH * PATCH; i += 64) {
        ivec2 pixel = corner + ivec2(i % PATCH, i / PATCH);
        vec3 position = vec3(0.0);
        vec4 shadow = vec4(0.0);
        uint normal = 0u;
        if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)) && load_position(pixel, size,
                                                                                                  position)) {
            shadow = load_shadow(pixel, size);
            uint word = pack_normal(load_normal(pixel, position));
            normal = shadow.b > 0.0 ? word : 0u;
        }
        patch_texels[i] = vec4(position, uintBitsToFloat(packHalf2x16(shadow.rg)));
        patch_normals[i] = normal;
    }
    barrier();
}

// What arrives at a pixel of the patch, and the width of its penumbra.
vec2 patch_shadow(int i) {
    return unpackHalf2x16(floatBitsToUint(patch_texels[i].w));
}

// A pixel of the patch to which its neighbours are compared.
struct Center {
    int place;
    vec3 position;
    vec3 normal;
    float plane_scale;
};

// How much a pixel of the patch counts as of the same surface.
float likeness_of(Center center, int i) {
    return likeness(patch_texels[i].xyz - center.position, unpack_normal(patch_normals[i]), center.normal,
                    center.plane_scale);
}

// The width of the penumbra that a pixel is in, in x; less than 0 where no neighbour has a ray that is
// hidden. In y how far pixels are apart.
vec2 search(Center center) {
    float hidden = 0.0;
    float width = 0.0;
    float spacing = 3e38;
    for (int y = -REACH; y <= REACH; y++) {
        for (int x = -REACH; x <= REACH; x++) {
            int i = center.place + y * PATCH + x;
            if (patch_normals[i] != 0u) {
                vec2 shadow = patch_shadow(i);
                float weight = exp(float(x * x + y * y) * (-0.5 / (SEARCH_WIDTH * SEARCH_WIDTH)))
                    * likeness_of(center, i);
                hidden += weight * (1.0 - shadow.x);
                width += weight * shadow.y;
                if (abs(x) + abs(y) == 1) {
                    spacing = min(spacing, distance(patch_texels[i].xyz, center.position));
                }
            }
        }
    }
    return vec2(hidden > 1e-6 ? width / hidden : -1.0, spacing);
}

// The mean of what arrives at a pixel and its neighbours, by a Gaussian of this standard deviation.
float gathered(Center center, float deviation) {
    float arrives = patch_shadow(center.place).x;
    float sum = 1.0;
    for (int y = -REACH; y <= REACH; y++) {
        for (int x = -REACH; x <= REACH; x++) {
            int i = center.place + y * PATCH + x;
            if (patch_normals[i] != 0u && (x != 0 || y != 0)) {
                vec3 offset = (patch_texels[i].xyz - center.position) / deviation;
                float weight = exp(-0.5 * dot(offset, offset)) * likeness_of(center, i);
                arrives += weight * patch_shadow(i).x;
                sum += weight;
            }
        }
    }
    return arrives / sum;
}

// The part of a pixel's light that arrives; its texel of shadow_image.
float arriving(vec4 shadow) {
    if (SHADOW_FILTER == 0) {
        return shadow.r;
    }
    ivec2 place = ivec2(gl_LocalInvocationID.xy) + REACH;
    int i = place.y * PATCH + place.x;
    vec3 position = patch_texels[i].xyz;
    Center center = Center(i, position, unpack_normal(patch_normals[i]), plane_scale(position));
    vec2 found = search(center);
    if (found.x < 0.0) {
        return 1.0;
    }
    float deviation = max(PENUMBRA_PART * found.x, LEAST_WIDTH * found.y) * pow(shadow.a, -1.0 / 3.0);
    return gathered(center, deviation);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(constants.size);
    if (SHADOW_FILTER != 0) {
        load_patch(ivec2(gl_WorkGroupID.xy) * 8 - REACH, size);
    }
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec4 unshadowed = imageLoad(unshadowed_image, pixel);
    vec3 radiance = unshadowed.rgb;
    vec4 shadow = load_shadow(pixel, size);
    if (shadow.b > 0.0) {
        radiance *= arriving(shadow);
    }
    if ((OUTPUT & OUTPUT_ADD) != 0) {
        if (unshadowed.a == 0.0) {
            return;
        }
        radiance += imageLoad(radiance_image, pixel).rgb;
    }
    imageStore(radiance_image, pixel, output_texel(radiance, unshadowed.a != 0.0, 1.0));
}
