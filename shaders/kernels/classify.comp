#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts tiles of 8 x 8 pixels into classes by the lights that contribute to them, and lists those lights: a
// workgroup per tile. Its invocations read a pixel each, and reduce what they found to bounds over the tile;
// then they test every 64th light each against the bounds. With CULL lights are left out too whose
// contributions add up to less than the fraction `cull_threshold` of those of the others, from each pixel, in
// the sum of the channels.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 14) const uint CULL = 0u;
layout(constant_id = 19) const uint VIEW = 0u;
layout(constant_id = 20) const bool LIGHT_COUNTS = false;
layout(constant_id = 21) const int SAMPLES = 1;

#include "bindings.glsl"
#define G_BUFFER_LAYOUT LAYOUT
#define G_BUFFER_SAMPLES SAMPLES
#define TILE_LISTS_ACCESS
#define AREALIGHT_DIFFERENCE 0
#define AREALIGHT_FOOTPRINT 0
#include "effects.glsl"
#include "arealight/options.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "g_buffer.glsl"
#include "light_records.glsl"
#include "tiles.glsl"
#include "light_counts.glsl"
#include "position.glsl"
#include "view.glsl"

const bool HAS_DIFFUSE = AREALIGHT_HAS_DIFFUSE;
const bool HAS_GLOSSY = (EFFECTS & EFFECT_GLOSSY) != 0u;
// Whether the horizon of the glossy lobe can be known: the table's cells do not hold for the formula.
const bool HAS_HORIZON = HAS_GLOSSY && !AREALIGHT_USES_FORMULA;
// Likewise that of the coat's.
const bool HAS_COAT_HORIZON = AREALIGHT_HAS_COAT && !AREALIGHT_USES_FORMULA;

#include "classify_lights.glsl"

// The most that each of the first lights contributes is kept where the pixels' values were; that of others is
// found again
const uint KEPT_LIGHTS = 8u * TILE_PIXELS;

float kept_light(uint index) {
    return tile_scratch[index >> 2u][index & 3u];
}

// The most that the invocation's light contributes, of the 64 lights from `first` on.
float most_of(uint first) {
    uint index = first + gl_LocalInvocationIndex;
    return CULL != 0u && first < KEPT_LIGHTS ? kept_light(index) : contribution(index).y;
}

// The limit below which lights are culled: those below it add up to no more than the threshold allows.
float cull_limit() {
    // Find what all lights contribute at least
    uint invocation = gl_LocalInvocationIndex;
    float least = 0.0;
    for (uint first = 0u; first < light_total(); first += TILE_PIXELS) {
        vec2 bounds = contribution(first + invocation);
        least += bounds.x;
        if (first < KEPT_LIGHTS) {
            tile_scratch[(first + invocation) >> 2u][invocation & 3u] = bounds.y;
        }
    }
    tile_parts[invocation] = least;
    barrier();
    least = 0.0;
    for (uint part = 0u; part < TILE_PIXELS; part++) {
        least += tile_parts[part];
    }
    // What is left out is to be a fraction of what stays
    float budget = least * constants.cull_threshold / (1.0 + constants.cull_threshold) / TILE_ROUNDING;

    // Sum what the lights below each of sixteen limits contribute at most: every fourth light by an
    // invocation
    float limit = budget / float(1u << (invocation & 15u));
    float sum = 0.0;
    for (uint first = 0u; first < light_total(); first += TILE_PIXELS) {
        if (first >= KEPT_LIGHTS) {
            float most = most_of(first);
            barrier();
            tile_parts[invocation] = most;
            barrier();
        }
        for (uint place = invocation >> 4u; place < TILE_PIXELS; place += 4u) {
            float most = first < KEPT_LIGHTS ? kept_light(first + place) : tile_parts[place];
            sum += most < limit ? max(most, 0.0) : 0.0;
        }
    }
    barrier();
    tile_parts[invocation] = sum;
    barrier();

    // Take the largest limit that the budget has room for
    float largest = 0.0;
    for (uint place = 0u; place < 16u; place++) {
        float below = tile_parts[place] + tile_parts[place + 16u] + tile_parts[place + 32u]
            + tile_parts[place + 48u];
        largest = below <= budget ? max(largest, budget / float(1u << place)) : largest;
    }
    return largest;
}

// Which invocations have a light of the tile, a bit each: of three groups of 64 lights in turn, so that a
// barrier per group is enough.
shared uint listed[3][2];

// How many of the first `count` invocations, up to 64, have a light.
uint listed_below(uvec2 bits, uint count) {
    uint low = bitfieldExtract(bits.x, 0, int(min(count, 32u)));
    uint high = bitfieldExtract(bits.y, 0, int(max(count, 32u) - 32u));
    return uint(bitCount(low) + bitCount(high));
}

// How many lights from `first` on are before `end`, up to 64.
uint before(uint first, uint end) {
    return min(max(first, end) - first, TILE_PIXELS);
}

// Lists the lights of the tile in the order of the buffers. How many are convex quads, polygons in all, and
// lights in all.
uvec3 list_lights(uint list, float limit) {
    uint invocation = gl_LocalInvocationIndex;
    uvec3 counts = uvec3(0u);
    uint group = 0u;
    for (uint first = 0u; first < light_total(); first += TILE_PIXELS) {
        float most = most_of(first);
        bool contributes = most >= 0.0 && !(most < limit);
        if (contributes) {
            atomicOr(listed[group][invocation >> 5u], 1u << (invocation & 31u));
        }
        uint next = group == 2u ? 0u : group + 1u;
        if (invocation < 2u) {
            listed[next][invocation] = 0u;
        }
        barrier();
        uvec2 bits = uvec2(listed[group][0], listed[group][1]);
        uint place = counts.z + listed_below(bits, invocation);
        uint index = first + invocation;
        if (contributes && place < constants.capacity) {
            tile_lists[list + place] = index < light_count() ? index : index - light_count();
        }
        counts += uvec3(listed_below(bits, before(first, quad_count())),
                        listed_below(bits, before(first, light_count())), listed_below(bits, TILE_PIXELS));
        group = next;
    }
    return counts;
}

// Writes the list of the lights that contribute to a tile. The cheapest class that shades it.
uint write_record(uvec2 tile) {
    float limit = CULL != 0u ? cull_limit() : 0.0;
    uint record = tile_record(tile);
    uvec3 counts = list_lights(record + TILE_RECORD_HEADER, limit);
    bool is_listed = counts.z <= constants.capacity;
    if (gl_LocalInvocationIndex == 0u) {
        tile_lists[record] = is_listed ? counts.x : TILE_ALL_LIGHTS;
        tile_lists[record + 1u] = is_listed ? counts.y : TILE_ALL_LIGHTS;
        tile_lists[record + 2u] = is_listed ? counts.z - counts.y : TILE_ALL_LIGHTS;
    }
    if (!is_listed) {
        return quad_count() < light_total() ? CLASS_ANY : CLASS_QUADS;
    }
    return counts.z == 0u ? CLASS_EMPTY : (counts.x == counts.z ? CLASS_QUADS : CLASS_ANY);
}

// Adds the tile to the list of a class, and a workgroup to the class's dispatch.
void append(uvec2 tile, uint tile_class) {
    uint dispatch = tile_class * TILE_CLASS_WORDS;
    uint place = atomicAdd(tile_lists[dispatch + 3u], 1u);
    tile_lists[class_list(tile_class) + place] = pack_tile(tile);
    atomicMax(tile_lists[dispatch], min(place + 1u, TILE_ROW));
    if (place % TILE_ROW == 0u) {
        atomicAdd(tile_lists[dispatch + 1u], 1u);
    }
}

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    if (gl_LocalInvocationIndex < 2u) {
        listed[0][gl_LocalInvocationIndex] = 0u;
    }
    reduce_pixels(ivec2(gl_GlobalInvocationID.xy));
    barrier();

    uint tile_class = CLASS_EMPTY;
    if (tile_distance() >= 0.0) {
        tile_class = write_record(tile);
    }
    if (gl_LocalInvocationIndex == 0u) {
        append(tile, tile_class);
    }
}
