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
// What the picked light adds by the picked lobe.
vec3 pick_radiance[MOST_SHADOW_RAYS];
// The size of what the lights so far add, and what they add by the diffuse lobe.
float pick_sum;
vec3 pick_diffuse;

void begin_picks(ivec2 pixel) {
    pick_sum = 0.0;
    pick_diffuse = vec3(0.0);
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        picked[ray] = NO_PICK;
        pick_radiance[ray] = vec3(0.0);
        pick_random[ray] = arealight_sequence(uvec2(pixel), constants.seed * uint(SHADOW_RAYS) + uint(ray));
    }
}

// Takes the light at an index, of PICK_SHAPE or 0, into account; what it adds by diffuse and specular lobes.
void pick_light(uint light, vec3 diffuse, vec3 specular) {
    float diffuse_part = pick_size(diffuse);
    float part = diffuse_part + pick_size(specular);
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
            pick_radiance[ray] = is_specular ? specular : diffuse;
        }
    }
    pick_sum += part;
    pick_diffuse += diffuse;
}

// The colour of a radiance, of size 1.
vec3 pick_color(vec3 radiance) {
    return radiance / max(pick_size(radiance), 1e-37);
}

// Stores them, for a pixel that reflects `radiance` without shadows.
void store_picks(ivec2 pixel, ivec2 size, vec3 radiance) {
    uint at = pixel_picks(pixel, size);
    vec3 specular = max(radiance - pick_diffuse, 0.0);
    shadow_picks[at] = pack_tens(1023.0 * specular / max(radiance, 1e-37), 0.5);
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        vec3 all = pick_color((picked[ray] & PICK_SPECULAR) != 0u ? specular : pick_diffuse);
        shadow_picks[ray_pick(at, ray)] = picked[ray];
        // 1 in a channel that has no light
        shadow_picks[ray_pick(at, ray) + 1u] = pack_color((pick_color(pick_radiance[ray]) + 1e-6)
                                                          / (all + 1e-6), 0.5);
    }
}

#endif
