#ifndef OCTAHEDRON_GLSL
#define OCTAHEDRON_GLSL

// Directions as places on an unfolded octahedron.

// A direction, of any length, from its place in [-1, 1]^2 on an unfolded octahedron. Source: Cigolle et al.
// 2014.
vec3 from_octahedron(vec2 place) {
    vec3 direction = vec3(place, 1.0 - abs(place.x) - abs(place.y));
    float below = max(-direction.z, 0.0);
    direction.x += direction.x >= 0.0 ? -below : below;
    direction.y += direction.y >= 0.0 ? -below : below;
    return direction;
}

// A direction's place, of any length, 0 for none, in [-1, 1]^2 on an unfolded octahedron. Source: Cigolle et
// al. 2014.
vec2 to_octahedron(vec3 direction) {
    vec2 place = direction.xy / max(abs(direction.x) + abs(direction.y) + abs(direction.z), 1e-30);
    vec2 sides = vec2(place.x >= 0.0 ? 1.0 : -1.0, place.y >= 0.0 ? 1.0 : -1.0);
    return direction.z >= 0.0 ? place : (1.0 - abs(place.yx)) * sides;
}

#endif
