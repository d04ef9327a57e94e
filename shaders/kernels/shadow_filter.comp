#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Multiplies each channel of the unshadowed radiance with what of it arrives, of each lobe apart: the mean of
// the pixel's rays, or of those of its neighbours in the same plane too, over a part of the penumbra that it
// is in. Where no ray is hidden that a workgroup's pixels reach nothing is filtered, nor at contact, whose
// penumbra has no width.
//
// Source of the filter's width: Fernando 2005 (percentage-closer soft shadows), with blockers found by the
// rays themselves.

#include "shadow_resources.glsl"
#include "shadow_colors.glsl"
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
// The mean ends at so many standard deviations.
const float MEAN_END = 2.5;

// What a workgroup knows of its pixels and those around them: the position, and in w (the part that is
// hidden, the penumbra's width over the distance to the camera times that) as halves.
shared vec4 patch_texels[PATCH * PATCH];
// The normal; 0 where there is no light.
shared uint patch_normals[PATCH * PATCH];
// The parts of the rays that are of the diffuse lobe and hidden, and of it, and the same of the specular
// lobes, as unorms; and pack_colors.
shared uint patch_rays[PATCH * PATCH];
shared uvec4 patch_colors[PATCH * PATCH];
// Whether any of them has a ray that is hidden; and one whose colour is not that of all light of its lobe.
shared bool any_is_hidden;
shared bool any_is_colored;

// What is known of a pixel: a texel of shadow_image, and colours.
struct Shadow {
    vec4 texel;
    ShadowColors colors;
};

Shadow load_shadow(ivec2 pixel, ivec2 size) {
    if (SHADOW_HISTORY == 0) {
        vec4 texel = imageLoad(shadow_image, pixel);
        return Shadow(texel, texel.b > 0.0 ? pixel_colors(pixel, size, texel) : ShadowColors(0.0));
    }
    HistoryPixel history = load_history(pixel, size, 0u);
    return Shadow(vec4(history.shadow, sign(history.frames), history.frames * float(SHADOW_RAYS)),
                  history.colors);
}

// Puts a pixel with light into a place of the patch.
void put_pixel(int place, ivec2 pixel, ivec2 size, vec3 position, Shadow shadow) {
    ShadowColors colors = shadow.colors;
    vec4 greens = vec4(colors[0].g, colors[1].g, colors[2].g, colors[3].g);
    if (shadow.texel.r < 1.0) {
        any_is_hidden = true;
    }
    if (colors != ShadowColors(greens.xxx, greens.yyy, greens.zzz, greens.www)) {
        any_is_colored = true;
    }
    vec2 hidden = vec2(1.0 - shadow.texel.r, shadow.texel.g);
    patch_texels[place] = vec4(position, uintBitsToFloat(packHalf2x16(hidden)));
    patch_normals[place] = pack_normal(load_normal(pixel, position));
    patch_rays[place] = packUnorm4x8(greens);
    patch_colors[place] = pack_colors(colors, 0.5);
}

void load_patch(ivec2 corner, ivec2 size) {
    any_is_hidden = false;
    any_is_colored = false;
    barrier();
    for (int i = int(gl_LocalInvocationIndex); i < PATCH * PATCH; i += 64) {
        ivec2 pixel = corner + ivec2(i % PATCH, i / PATCH);
        vec3 position;
        patch_normals[i] = 0u;
        if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)) && load_position(pixel, size,
                                                                                                  position)) {
            Shadow shadow = load_shadow(pixel, size);
            if (shadow.texel.b > 0.0) {
                put_pixel(i, pixel, size, position, shadow);
            }
        }
    }
    barrier();
}

// A pixel of the patch to which its neighbours are compared.
struct Center {
    int place;
    vec3 position;
    vec3 normal;
    float plane_scale;
};

// How much a pixel of the patch counts as of the same surface, times the exponential of `exponent`.
float weight_of(Center center, int i, vec3 offset, float exponent) {
    return likeness(offset, unpack_normal(patch_normals[i]), center.normal, center.plane_scale, exponent);
}

// In x the width of the penumbra that a pixel is in, over the distance to the camera; in y how far pixels are
// apart. By every fourth neighbour, and then those that touch the pixel.
vec2 search(Center center) {
    const int FOURTHS = REACH * REACH;
    vec2 sum = vec2(0.0);
    float spacing = 3e38;
    for (int number = 0; number < FOURTHS + 4; number++) {
        int side = (number & 2) - 1;
        ivec2 touching = (number & 1) == 0 ? ivec2(side, 0) : ivec2(0, side);
        bool touches = number >= FOURTHS;
        ivec2 at = touches ? touching : 2 * ivec2(number % REACH, number / REACH) + 1 - REACH;
        int i = center.place + at.y * PATCH + at.x;
        if (patch_normals[i] != 0u) {
            vec3 offset = patch_texels[i].xyz - center.position;
            float exponent = float(at.x * at.x + at.y * at.y) * (0.5 / (SEARCH_WIDTH * SEARCH_WIDTH));
            vec2 found = unpackHalf2x16(floatBitsToUint(patch_texels[i].w));
            sum += weight_of(center, i, offset, exponent) * found;
            spacing = touches ? min(spacing, length(offset)) : spacing;
        }
    }
    return vec2(sum.y / max(sum.x, 1e-6), spacing);
}

// The mean of the colours of a pixel and its neighbours, by a Gaussian of this standard deviation over
// `reach` pixels to each side.
ShadowColors gathered(Center center, float deviation, int reach) {
    ShadowColors colors = ShadowColors(0.0);
    vec4 rays = vec4(0.0);
    float scale = 0.5 / max(deviation * deviation, 1e-37);
    for (int y = -reach; y <= reach; y++) {
        for (int x = -reach; x <= reach; x++) {
            int i = center.place + y * PATCH + x;
            if (patch_normals[i] != 0u) {
                vec3 offset = patch_texels[i].xyz - center.position;
                float weight = weight_of(center, i, offset, dot(offset, offset) * scale);
                if (any_is_colored) {
                    colors += weight * unpack_colors(patch_colors[i]);
                } else {
                    rays += weight * unpackUnorm4x8(patch_rays[i]);
                }
            }
        }
    }
    colors = any_is_colored ? colors : ShadowColors(rays.xxx, rays.yyy, rays.zzz, rays.www);
    return colors / max(pick_size(colors[1] + colors[3]), 1e-37);
}

// The part of each channel of a pixel's light that arrives, by means over its neighbours.
vec3 filtered(float rays, vec3 specular) {
    ivec2 place = ivec2(gl_LocalInvocationID.xy) + REACH;
    int i = place.y * PATCH + place.x;
    vec3 position = patch_texels[i].xyz;
    Center center = Center(i, position, unpack_normal(patch_normals[i]), plane_scale(position));
    vec2 found = search(center);
    float penumbra = found.x * camera_distance(position);
    float deviation = max(PENUMBRA_PART * penumbra, LEAST_WIDTH * found.y) * pow(rays, -1.0 / 3.0);
    int reach = int(ceil(min(MEAN_END * deviation / max(found.y, 1e-37), float(REACH))));
    return arriving_by_means(gathered(center, deviation, reach), specular);
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
    Shadow shadow = load_shadow(pixel, size);
    if (shadow.texel.b > 0.0) {
        vec3 specular = specular_parts(pixel, size);
        if (SHADOW_FILTER == 0) {
            radiance *= arriving_by_chance(shadow.colors, radiance, specular);
        } else if (any_is_hidden) {
            radiance *= filtered(shadow.texel.a, specular);
        }
    }
    if ((OUTPUT & OUTPUT_ADD) != 0) {
        if (unshadowed.a == 0.0) {
            return;
        }
        radiance += imageLoad(radiance_image, pixel).rgb;
    }
    imageStore(radiance_image, pixel, output_texel(radiance, unshadowed.a != 0.0, 1.0));
}
