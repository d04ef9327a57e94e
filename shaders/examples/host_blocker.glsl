// What blocks shadow rays in an engine: here one rectangle, as a stand-in for its own scene.
// shaders/kernels/shadow_rays.comp includes it with AREALIGHT_HOST_BLOCKER 1.

layout(set = 1, binding = 0, std430) readonly buffer HostBlocker {
    vec4 rectangle[2]; // its corners of least and of largest x and y, at the height of the first
};

float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance) {
    float there = (rectangle[0].z - origin.z) / direction.z;
    vec2 place = origin.xy + there * direction.xy;
    bool is_within = all(greaterThan(place, rectangle[0].xy)) && all(lessThan(place, rectangle[1].xy));
    return there > 0.0 && is_within ? min(there, distance) : distance;
}
