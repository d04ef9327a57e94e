#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Multiplies the unshadowed radiance with what of it arrives: the mean of the pixel's rays, or of those of its neighbours in the same plane too,
// over a part of the penumbra that it is in. Where no neighbour has a ray that is hidden nothing is filtered, nor at contact, whose penumbra has
// no width.
//
// Source of the filter's width: Fernando 2005 (percentage-closer soft shadows), with blockers found by the rays themselves.

#include "shadow_resources.glsl"

layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 16) const int SHADOW_FILTER = 1;

#include "output_texel.glsl"

layout(set = 0, binding = UNSHADOWED_BINDING, rgba32f) uniform readonly image2D unshadowed_image;
layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform image2D radiance_image;

// Pixels to each side of the search for blockers, and the standard deviation of its weights.
const int SEARCH = 6;
const float SEARCH_WIDTH = 3.0;
// Pixels to a side of what a workgroup loads.
const int PATCH = 8 + 2 * SEARCH;
// The filter's standard deviation as a part of the penumbra's width, and at least, in pixels, for a pixel of one ray.
const float PENUMBRA_PART = 0.12;
const float LEAST_WIDTH = 2.0;
// The farthest neighbour, in pixels; steps to it on each side.
const float FARTHEST = 20.0;
const int STEPS = 20;
// Neighbours count as of the same surface by this part of the camera's distance out of its plane, and by this power of their normals' cosine.
const float PLANE_PART = 0.004;
const float NORMAL_POWER = 32.0;

// What is known of a pixel.
struct Pixel {
    vec3 position;
    vec3 normal; // unit
    vec4 shadow; // a texel of shadow_image
};

shared vec4 patch_position[PATCH * PATCH]; // and in w the shadow's first two numbers
shared uint patch_normal[PATCH * PATCH];   // 0 where no light is

Pixel load_pixel(ivec2 pixel, ivec2 size) {
    Pixel loaded = Pixel(vec3(0.0), vec3(0.0), vec4(0.0));
    if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)) && load_position(pixel, size, loaded.position)) {
        loaded.shadow = imageLoad(shadow_image, pixel);
        loaded.normal = arealight_normalize_or(load_surface(pixel, loaded.position, constants.camera).normal, vec3(0.0, 0.0, 1.0));
    }
    return loaded;
}

void load_patch(ivec2 corner, ivec2 size) {
    for (int i = int(gl_LocalInvocationIndex); i < PATCH * PATCH; i += 64) {
        Pixel pixel = load_pixel(corner + ivec2(i % PATCH, i / PATCH), size);
        patch_position[i] = vec4(pixel.position, uintBitsToFloat(packHalf2x16(pixel.shadow.rg)));
        vec3 normal = 0.5 * pixel.normal + 0.5;
        patch_normal[i] = pixel.shadow.b > 0.0 ? packUnorm4x8(vec4(normal, 1.0)) : 0u;
    }
    barrier();
}

// How much a neighbour counts as of the same surface.
float likeness(Pixel pixel, vec3 position, vec3 normal, float distance) {
    float plane = abs(dot(pixel.normal, position - pixel.position)) / (PLANE_PART * distance);
    return exp(-plane) * pow(clamp(dot(pixel.normal, normal), 0.0, 1.0), NORMAL_POWER);
}

// The width of the penumbra that a pixel is in, in x; less than 0 where no neighbour has a ray that is hidden. In y how far pixels are apart.
vec2 search(Pixel pixel, ivec2 place, float distance) {
    float hidden = 0.0;
    float width = 0.0;
    float spacing = 3e38;
    for (int y = -SEARCH; y <= SEARCH; y++) {
        for (int x = -SEARCH; x <= SEARCH; x++) {
            int i = (place.y + y) * PATCH + place.x + x;
            if (patch_normal[i] != 0u) {
                vec4 there = patch_position[i];
                vec3 normal = normalize(2.0 * unpackUnorm4x8(patch_normal[i]).xyz - 1.0);
                vec2 shadow = unpackHalf2x16(floatBitsToUint(there.w));
                float weight = exp(float(x * x + y * y) * (-0.5 / (SEARCH_WIDTH * SEARCH_WIDTH))) * likeness(pixel, there.xyz, normal, distance);
                hidden += weight * (1.0 - shadow.x);
                width += weight * shadow.y;
                if (abs(x) + abs(y) == 1) {
                    spacing = min(spacing, length(there.xyz - pixel.position));
                }
            }
        }
    }
    return vec2(hidden > 1e-6 ? width / hidden : -1.0, spacing);
}

// The mean of what arrives at a pixel and its neighbours, by weights of this standard deviation.
float gathered(Pixel pixel, ivec2 place, ivec2 size, float deviation, float spacing, float distance) {
    float reach = min(2.5 * deviation / spacing, FARTHEST);
    int stride = max(int(ceil(reach / float(STEPS))), 1);
    int steps = int(reach) / stride;
    float arrives = pixel.shadow.r;
    float sum = 1.0;
    for (int y = -steps; y <= steps; y++) {
        for (int x = -steps; x <= steps; x++) {
            Pixel there = load_pixel(place + stride * ivec2(x, y), size);
            if (there.shadow.b > 0.0 && (x != 0 || y != 0)) {
                vec3 offset = there.position - pixel.position;
                float weight = exp(-0.5 * dot(offset, offset) / (deviation * deviation)) * likeness(pixel, there.position, there.normal, distance);
                arrives += weight * there.shadow.r;
                sum += weight;
            }
        }
    }
    return arrives / sum;
}

// The part of a pixel's light that arrives.
float arriving(Pixel pixel, ivec2 place, ivec2 size) {
    if (SHADOW_FILTER == 0) {
        return pixel.shadow.r;
    }
    float distance = length(constants.camera - pixel.position);
    vec2 found = search(pixel, ivec2(gl_LocalInvocationID.xy) + SEARCH, distance);
    if (found.x < 0.0) {
        return 1.0;
    }
    float deviation = max(PENUMBRA_PART * found.x, LEAST_WIDTH * found.y) * pow(pixel.shadow.a, -1.0 / 3.0);
    return gathered(pixel, place, size, deviation, found.y, distance);
}

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(constants.size);
    if (SHADOW_FILTER != 0) {
        load_patch(ivec2(gl_WorkGroupID.xy) * 8 - SEARCH, size);
    }
    if (any(greaterThanEqual(place, size))) {
        return;
    }
    vec4 texel = imageLoad(unshadowed_image, place);
    if (texel.a == 0.0) {
        if ((OUTPUT & OUTPUT_ADD) == 0) {
            imageStore(radiance_image, place, vec4(0.0));
        }
        return;
    }
    Pixel pixel = load_pixel(place, size);
    vec3 radiance = texel.rgb;
    if (pixel.shadow.b > 0.0) {
        radiance *= arriving(pixel, place, size);
    }
    if ((OUTPUT & OUTPUT_ADD) != 0) {
        radiance += imageLoad(radiance_image, place).rgb;
    }
    imageStore(radiance_image, place, output_texel(radiance, true));
}
