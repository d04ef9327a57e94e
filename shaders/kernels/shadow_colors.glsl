#ifndef SHADOW_COLORS_GLSL
#define SHADOW_COLORS_GLSL

// What of a pixel's radiance arrives, in each channel, by rays whose picks know light and lobe. The including
// kernel has shadow_resources.glsl.

#define PICKS_ACCESS readonly
#include "shadow_picks.glsl"

// Means over rays of their picks' colours: in columns of what is hidden and of all that the diffuse lobe
// reflects, and the same of the specular lobes. What is hidden of a channel of a lobe is their quotient, or
// the first over the probability of the lobe's picks.
#define ShadowColors mat4x3

// Those of a pixel by this frame's rays: of `shadow`, its texel of shadow_image.
ShadowColors pixel_colors(ivec2 pixel, ivec2 size, vec4 shadow) {
    ShadowColors colors = ShadowColors(0.0);
    uint picks = pixel_picks(pixel, size);
    uint hidden = uint(shadow.b) - 1u;
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        uint at = ray_pick(picks, ray);
        vec3 color = unpack_color(shadow_picks[at + 1u]) / float(SHADOW_RAYS);
        vec3 hidden_color = (hidden >> uint(ray) & 1u) != 0u ? color : vec3(0.0);
        bool is_specular = (shadow_picks[at] & PICK_SPECULAR) != 0u;
        colors[0] += is_specular ? vec3(0.0) : hidden_color;
        colors[1] += is_specular ? vec3(0.0) : color;
        colors[2] += is_specular ? hidden_color : vec3(0.0);
        colors[3] += is_specular ? color : vec3(0.0);
    }
    return colors;
}

uvec4 pack_colors(ShadowColors colors, float rounded) {
    return uvec4(pack_color(colors[0], rounded), pack_color(colors[1], rounded),
                 pack_color(colors[2], rounded), pack_color(colors[3], rounded));
}
ShadowColors unpack_colors(uvec4 words) {
    return ShadowColors(unpack_color(words.x), unpack_color(words.y), unpack_color(words.z),
                        unpack_color(words.w));
}

// The part of the specular lobes in each channel of a pixel's radiance.
vec3 specular_parts(ivec2 pixel, ivec2 size) {
    return unpack_tens(shadow_picks[pixel_picks(pixel, size)]) * (1.0 / 1023.0);
}

// What arrives of a pixel's radiance by its own rays, per channel: right on average, and not always from 0
// to 1.
vec3 arriving_by_chance(ShadowColors colors, vec3 radiance, vec3 specular) {
    float all = pick_size(radiance);
    float of_specular = pick_size(radiance * specular);
    vec3 hidden_diffuse = colors[0] * (1.0 - specular) / max(all - of_specular, 1e-5 * all);
    vec3 hidden_specular = colors[2] * specular / max(of_specular, 1e-5 * all);
    return 1.0 - (hidden_diffuse + hidden_specular) * all;
}

// How many rays of a lobe, as a part of all, count as much as what is hidden of both lobes.
const float FEW_RAYS = 1e-3;

// What arrives by means over pixels, per channel, from 0 to 1: exactly 0 where all rays are hidden, 1 where
// none is. A lobe that no ray is of gets what both lobes get. A history's means of what is hidden may be a
// little more than those of all.
vec3 arriving_by_means(ShadowColors colors, vec3 specular) {
    float hidden = pick_size(colors[0] + colors[2]);
    hidden /= max(pick_size(colors[1] + colors[3]), 1e-37);
    vec3 few = vec3(FEW_RAYS * hidden);
    vec3 hidden_diffuse = (colors[0] + few) / (colors[1] + FEW_RAYS);
    vec3 hidden_specular = (colors[2] + few) / (colors[3] + FEW_RAYS);
    return max(1.0 - (hidden_diffuse + (hidden_specular - hidden_diffuse) * specular), vec3(0.0));
}

#endif
