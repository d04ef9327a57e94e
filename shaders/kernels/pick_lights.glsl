#ifndef PICK_LIGHTS_GLSL
#define PICK_LIGHTS_GLSL

// Chooses a light and a lobe for each shadow ray of a pixel, as the lights come. The including kernel has
// push constants with `seed`.

#include "arealight/shadows/choose.glsl"
#include "arealight/shadows/sequence.glsl"
#include "arealight/surface.glsl"
#define PICKS_ACCESS writeonly
#include "shadow_picks.glsl"

uint picked[MOST_SHADOW_RAYS];
float pick_random[MOST_SHADOW_RAYS];
// The luminance of what the lights so far add.
float pick_sum;

void begin_picks(ivec2 pixel) {
    pick_sum = 0.0;
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        picked[ray] = NO_PICK;
        pick_random[ray] = arealight_sequence(uvec2(pixel), constants.seed * uint(SHADOW_RAYS) + uint(ray));
    }
}

// Takes the light at an index, of PICK_SHAPE or 0, into account; what it adds by diffuse and specular lobes.
void pick_light(uint light, vec3 diffuse, vec3 specular) {
    float diffuse_part = arealight_luminance(diffuse);
    float part = diffuse_part + arealight_luminance(specular);
    if (!(part > 0.0)) {
        return;
    }
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        float sum = pick_sum;
        if (arealight_choose(pick_random[ray], sum, part)) {
            float of_lobes = diffuse_part;
            bool is_specular = part > diffuse_part && arealight_choose(pick_random[ray], of_lobes, part
                                                                       - diffuse_part);
            picked[ray] = light | (is_specular ? PICK_SPECULAR : 0u);
        }
    }
    pick_sum += part;
}

void store_picks(ivec2 pixel, ivec2 size) {
    uint first = first_pick(pixel, size);
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        shadow_picks[first + uint(ray)] = picked[ray];
    }
}

#endif
