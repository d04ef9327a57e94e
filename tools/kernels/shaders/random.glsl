#ifndef RANDOM_GLSL
#define RANDOM_GLSL

// Random numbers for the reference: pcg3d (Jarzynski and Olano 2020) over pixel and sample, then pcg steps.

struct RandomState {
    uint state;
};

uint random_hash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

RandomState random_begin(uvec3 where, uint seed) {
    uvec3 v = where * 1664525u + 1013904223u + seed * 2654435769u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return RandomState(v.x ^ random_hash(v.y) ^ random_hash(v.z + 0x9e3779b9u));
}

// Uniform in [0, 1).
float random_float(inout RandomState random) {
    random.state = random.state * 747796405u + 2891336453u;
    uint word = ((random.state >> ((random.state >> 28) + 4u)) ^ random.state) * 277803737u;
    word = (word >> 22) ^ word;
    return float(word >> 8) * (1.0 / 16777216.0);
}

#endif
