#ifndef AREALIGHT_CHOOSE_GLSL
#define AREALIGHT_CHOOSE_GLSL

// Chooses among parts as they come: whether to take the one that brings the sum of weights from `sum` to
// `sum + weight`, weight > 0. `random` in [0, 1) is used up by as much as the choice takes, and is uniform
// again.
bool arealight_choose(inout float random, inout float sum, float weight) {
    sum += weight;
    float probability = weight / sum;
    bool is_taken = random < probability;
    random = is_taken ? random / probability : (random - probability) / (1.0 - probability);
    random = clamp(random, 0.0, 0.99999994);
    return is_taken;
}

#endif
