#ifndef AREALIGHT_SEQUENCE_GLSL
#define AREALIGHT_SEQUENCE_GLSL

// Random numbers for the rays of an image: neighbouring pixels, and frames after one another, get numbers
// that fill the unit interval or square evenly. Over pixels they are lattices, over rays the golden ratio's
// multiples and the sequence R2 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
//
// Of the variance that random numbers give to a Gaussian mean of 0s and 1s over pixels, the share of the unit
// square that is on one side of a line or in a circle, the lattice leaves .25 for a standard deviation of 1
// pixel, .11 for 2 and .06 for 3 (two masks of blue noise .34, .22, .21; R2 along a Hilbert curve .43, .27,
// .18). Its coefficients are the best of a random search for that.

// A number of 32 bits after the point, in [0, 1).
float arealight_fraction(uint bits) {
    return float(bits >> 8u) * 5.9604644775390625e-8;
}

// Uniform in [0, 1), for a ray of a pixel; rays count on from frame to frame.
float arealight_sequence(uvec2 pixel, uint ray) {
    return arealight_fraction(3242174889u * pixel.x + 2447445414u * pixel.y + 2654435769u * ray);
}

// The same, uniform in [0, 1)^2.
vec2 arealight_sequence_2d(uvec2 pixel, uint ray) {
    uvec2 place = uvec2(2680578941u, 503431629u) * pixel.x + uvec2(2340746611u, 2748584165u) * pixel.y;
    place += uvec2(3242174889u, 2447445414u) * ray;
    return vec2(arealight_fraction(place.x), arealight_fraction(place.y));
}

#endif
