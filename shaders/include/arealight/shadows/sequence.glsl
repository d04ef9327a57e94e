#ifndef AREALIGHT_SEQUENCE_GLSL
#define AREALIGHT_SEQUENCE_GLSL

// Random numbers for the rays of an image: neighbouring pixels, and frames after one another, get numbers
// that fill the unit interval or square evenly. Over pixels they are lattices, over rays the golden ratio's
// multiples and the sequence R2 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
//
// Of the variance that random numbers give to a Gaussian mean of 0s and 1s over pixels, the share of the unit
// square that is on one side of a line or in a circle, the lattice leaves .25 for a standard deviation of 1
// pixel, .11 for 2 and .06 for 3 (two masks of blue noise .34, .22, .21; R2 along a Hilbert curve .43, .27,
// .18). Its coefficients are the best of a random search for that; those of the number in the interval, of
// one for means over the pixels alone where that is in a half or a fifth of it. A lattice repeats, and an eye
// finds that: so each tile of 16 pixels is moved by random numbers of its own, which leaves .31, .17 and .13,
// and no frequency that stands out of those of random numbers.

// A number of 32 bits after the point, in [0, 1).
float arealight_fraction(uint bits) {
    return float(bits >> 8u) * 5.9604644775390625e-8;
}

// 32 random bits of a pixel's tile. Source: the permutation of PCG, O'Neill 2014.
uint arealight_tile_bits(uvec2 pixel) {
    uint state = ((pixel.x >> 4u) + (pixel.y >> 4u) * 65536u) * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Uniform in [0, 1), for a ray of a pixel; rays count on from frame to frame.
float arealight_sequence(uvec2 pixel, uint ray) {
    return arealight_fraction(2027333275u * pixel.x + 3264946162u * pixel.y + 2654435769u * ray
                              + arealight_tile_bits(pixel));
}

// The same, uniform in [0, 1)^2.
vec2 arealight_sequence_2d(uvec2 pixel, uint ray) {
    uvec2 place = uvec2(2680578941u, 503431629u) * pixel.x + uvec2(2340746611u, 2748584165u) * pixel.y;
    place += uvec2(3242174889u, 2447445414u) * ray;
    place += uvec2(1540483477u, 2246822519u) * arealight_tile_bits(pixel);
    return vec2(arealight_fraction(place.x), arealight_fraction(place.y));
}

// Two other numbers in [0, 1), as if random, by the 24 bits of two. Source: pcg2d, Jarzynski and Olano 2020.
vec2 arealight_other_random(vec2 random) {
    uvec2 bits = uvec2(random * 16777216.0) * 1664525u + 1013904223u;
    for (int round = 0; round < 2; round++) {
        bits.x += bits.y * 1664525u;
        bits.y += bits.x * 1664525u;
        bits ^= bits >> 16u;
    }
    return vec2(arealight_fraction(bits.x), arealight_fraction(bits.y));
}

#endif
