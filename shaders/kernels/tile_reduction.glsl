#ifndef TILE_REDUCTION_GLSL
#define TILE_REDUCTION_GLSL

// Maxima over the 64 pixels of a tile, in memory that the workgroup shares.

// The maxima, in pairs of vectors: those of coats come after what every tile has, and then the groups.
const int GROUPS_PAIR = AREALIGHT_HAS_COAT ? 8 : 5;
const int TILE_PAIRS = HAS_LINKS ? GROUPS_PAIR + 1 : GROUPS_PAIR;
shared vec4 tile_maxima[2 * TILE_PAIRS];

// Finds the maxima of eight values of each invocation's pixel: in two steps of eight. They are there after
// the next barrier. With several samples a pixel, of those from the first to the one that is read.
void tile_reduce(int pair, vec4 first, vec4 second) {
    uint invocation = gl_LocalInvocationIndex;
    tile_scratch[invocation] = first;
    tile_scratch[TILE_PIXELS + invocation] = second;
    barrier();
    // Eight invocations a value, which take every eighth pixel: no two of a bank at a time
    uint value = invocation >> 3u;
    uint from = (value >> 2u) * TILE_PIXELS + (invocation & 7u);
    float largest = -TILE_FAR;
    for (uint step = 0u; step < 8u; step++) {
        largest = max(tile_scratch[from + 8u * step][value & 3u], largest);
    }
    tile_parts[invocation] = largest;
    barrier();
    if (invocation < 8u) {
        int place = 2 * pair + int(invocation >> 2u);
        largest = g_buffer_sample > 0 ? tile_maxima[place][invocation & 3u] : -TILE_FAR;
        for (uint step = 0u; step < 8u; step++) {
            largest = max(tile_parts[8u * invocation + step], largest);
        }
        tile_maxima[place][invocation & 3u] = largest;
    }
}

#endif
