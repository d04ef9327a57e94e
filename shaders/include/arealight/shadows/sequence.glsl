#ifndef AREALIGHT_SEQUENCE_GLSL
#define AREALIGHT_SEQUENCE_GLSL

// Random numbers for the rays of an image: neighbouring pixels, and frames after one another, get numbers that fill the unit interval or
// square evenly. Pixels are numbered along a Hilbert curve, and numbers are those of the R sequences (Roberts 2018, "The unreasonable
// effectiveness of quasirandom sequences").

// Pixels to a side of the curve, after which it begins again.
const uint AREALIGHT_CURVE_SIDE = 64u;
// What is between the numbers of a pixel in frames after one another: no multiple of it is near one of the curve's length for 64 frames.
const uint AREALIGHT_CURVE_STEP = 2531u;

// A pixel's place on a Hilbert curve, in [0, 4096).
uint arealight_curve_place(uvec2 pixel) {
    uvec2 rest = pixel % AREALIGHT_CURVE_SIDE;
    uint place = 0u;
    for (uint side = AREALIGHT_CURVE_SIDE / 2u; side > 0u; side /= 2u) {
        uvec2 quadrant = uvec2((rest.x & side) != 0u, (rest.y & side) != 0u);
        place += side * side * ((3u * quadrant.x) ^ quadrant.y);
        // Turn the quadrant so that the curve enters it at its origin
        if (quadrant.y == 0u) {
            rest = quadrant.x == 1u ? (AREALIGHT_CURVE_SIDE - 1u) - rest.yx : rest.yx;
        }
    }
    return place;
}

// The number in the sequences of a ray of a pixel: `ray` counts on from frame to frame.
uint arealight_sequence_index(uvec2 pixel, uint ray) {
    return arealight_curve_place(pixel) + AREALIGHT_CURVE_STEP * ray;
}

// Uniform in [0, 1): the golden ratio's multiples.
float arealight_sequence(uint index) {
    return float((0x80000000u + 2654435769u * index) >> 8u) * 5.9604644775390625e-8;
}

// Uniform in [0, 1)^2: R2.
vec2 arealight_sequence_2d(uint index) {
    return vec2((uvec2(0x80000000u) + uvec2(3242174889u, 2447445414u) * index) >> 8u) * 5.9604644775390625e-8;
}

#endif
