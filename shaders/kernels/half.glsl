#ifndef HALF_GLSL
#define HALF_GLSL

// The largest finite number of sixteen bits.
const float LARGEST_HALF = 65504.0;

// Numbers of at most LARGEST_HALF, rounded to the nearest of sixteen bits, ties to even; below 2^-14 ties up.
// A store to an rgba16f image may cut bits off instead, and a light would lose a thousandth at each level.
vec4 round_to_half(vec4 value) {
    uvec4 bits = floatBitsToUint(value);
    vec4 normal = uintBitsToFloat((bits + 0xfffu + ((bits >> 13) & 1u)) & ~0x1fffu);
    vec4 small = floor(value * 16777216.0 + 0.5) * (1.0 / 16777216.0);
    return mix(normal, small, lessThan(abs(value), vec4(6.103515625e-5)));
}

#endif
