#ifndef LIST_LIGHTS_GLSL
#define LIST_LIGHTS_GLSL

// Lists the lights that contribute to a tile, by a workgroup of 64 invocations: each tests every 64th light.
// With CULL lights are left out too whose contributions add up to no more than a budget, in the sum of the
// channels.
//
// The including kernel has `vec2 contribution(uint index)`: the least and the most that a light contributes,
// negative where that is nothing or there is no such light; and `float cull_budget(float least)`, of what the
// invocation's lights contribute at least. It defines LISTED(place), where a light's index is stored, of
// LIST_CAPACITY places.

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

// The limit below which lights are culled: those below it add up to no more than the budget.
float cull_limit() {
    uint invocation = gl_LocalInvocationIndex;
    float least = 0.0;
    for (uint first = 0u; first < light_total(); first += TILE_PIXELS) {
        vec2 bounds = contribution(first + invocation);
        least += bounds.x;
        if (first < KEPT_LIGHTS) {
            tile_scratch[(first + invocation) >> 2u][invocation & 3u] = bounds.y;
        }
    }
    barrier();
    float budget = cull_budget(least);

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

// Lists the lights in the order of the buffers. How many are convex quads, polygons in all, and lights in
// all.
uvec3 list_lights() {
    uint invocation = gl_LocalInvocationIndex;
    if (invocation < 2u) {
        listed[0][invocation] = 0u;
    }
    float limit = 0.0;
    if (CULL != 0u) {
        limit = cull_limit();
    } else {
        barrier();
    }
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
        if (contributes && place < LIST_CAPACITY) {
            LISTED(place) = index < light_count() ? index : index - light_count();
        }
        counts += uvec3(listed_below(bits, before(first, quad_count())),
                        listed_below(bits, before(first, light_count())), listed_below(bits, TILE_PIXELS));
        group = next;
    }
    return counts;
}

#endif
