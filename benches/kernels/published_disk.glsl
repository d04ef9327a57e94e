// The disk as it is published and shipped: Heitz and Hill 2017, "Real-time line- and disk-light shading with
// linearly transformed cosines", written anew from the method. The cone's eigenvalues are the roots of a
// cubic (Blinn 2007); the horizon is that of a sphere of the same form factor. A yardstick: nothing is
// guarded.

#include "clipped_sphere.glsl"

// The roots of x^3 + c.z x^2 + c.y x + c.x, the middle one in y.
vec3 published_cubic(vec3 c) {
    float b = c.z / 3.0;
    float third = c.y / 3.0;
    float d = c.x;
    vec3 delta = vec3(third - b * b, d - third * b, b * d - third * third);
    // Kept from being negative, as is often done
    float root = sqrt(max(4.0 * delta.x * delta.z - delta.y * delta.y, 0.0));
    // The largest root, and the smallest as the reciprocal of the reversed equation's largest
    const float THIRD_OF_TURN = 2.0943951;
    float theta = atan(root, 2.0 * b * delta.x - delta.y) / 3.0;
    float size = 2.0 * sqrt(-delta.x);
    vec2 ends = size * vec2(cos(theta), cos(theta + THIRD_OF_TURN));
    vec2 large = vec2((ends.x + ends.y > 2.0 * b ? ends.x : ends.y) - b, 1.0);
    theta = atan(d * root, d * delta.y - 2.0 * third * delta.z) / 3.0;
    size = 2.0 * sqrt(-delta.z);
    ends = size * vec2(cos(theta), cos(theta + THIRD_OF_TURN));
    vec2 small = vec2(-d, (ends.x + ends.y < 2.0 * third ? ends.x : ends.y) + third);
    float e = large.y * small.y;
    float f = -large.x * small.y - large.y * small.x;
    float g = large.x * small.x;
    vec2 middle = vec2(third * f - b * g, third * e - b * f);
    vec3 roots = vec3(small.x / small.y, middle.x / middle.y, large.x / large.y);
    if (roots.x < roots.y && roots.x < roots.z) {
        return roots.yxz;
    }
    return roots.z < roots.x && roots.z < roots.y ? roots.xzy : roots;
}

// x: as it is; y: as (length^2 + z) / (length + 1), the cheap horizon.
vec2 published_disk(vec3 center, vec3 axis_u, vec3 axis_v) {
    float d11 = dot(axis_u, axis_u);
    float d22 = dot(axis_v, axis_v);
    float d12 = dot(axis_u, axis_v);
    float a, b;
    vec3 v1, v2;
    if (abs(d12) / sqrt(d11 * d22) > 0.0001) {
        float trace = d11 + d22;
        float determinant = sqrt(d11 * d22 - d12 * d12);
        float u = 0.5 * sqrt(trace - 2.0 * determinant);
        float v = 0.5 * sqrt(trace + 2.0 * determinant);
        float e_max = (u + v) * (u + v);
        float e_min = (u - v) * (u - v);
        v1 = d11 > d22 ? d12 * axis_u + (e_max - d11) * axis_v : d12 * axis_v + (e_max - d22) * axis_u;
        v2 = d11 > d22 ? d12 * axis_u + (e_min - d11) * axis_v : d12 * axis_v + (e_min - d22) * axis_u;
        a = 1.0 / e_max;
        b = 1.0 / e_min;
        v1 = normalize(v1);
        v2 = normalize(v2);
    } else {
        a = 1.0 / d11;
        b = 1.0 / d22;
        v1 = axis_u * sqrt(a);
        v2 = axis_v * sqrt(b);
    }
    vec3 v3 = cross(v1, v2);
    v3 = dot(center, v3) < 0.0 ? -v3 : v3;
    float height = dot(v3, center);
    float x = dot(v1, center) / height;
    float y = dot(v2, center) / height;
    a *= height * height;
    b *= height * height;
    vec3 e = published_cubic(vec3(a * b, a * b * (1.0 + x * x + y * y) - a - b,
                                  1.0 - a * (1.0 + x * x) - b * (1.0 + y * y)));
    vec3 mean = normalize(mat3(v1, v2, v3) * vec3(a * x / (a - e.y), b * y / (b - e.y), 1.0));
    float l1 = sqrt(-e.y / e.z);
    float l2 = sqrt(-e.y / e.x);
    float whole = l1 * l2 * inversesqrt((1.0 + l1 * l1) * (1.0 + l2 * l2));
    return vec2(clipped_sphere(whole, mean.z), max(0.0, (whole * whole + mean.z * whole) / (whole + 1.0)));
}
