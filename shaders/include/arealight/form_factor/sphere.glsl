#ifndef AREALIGHT_SPHERE_GLSL
#define AREALIGHT_SPHERE_GLSL

#include "arealight/form_factor/elliptic_arc.glsl"

// The form factor of a sphere: for Lambert's lobe in closed form, for a fitted lobe by the disk that looks
// the same. A sphere shines outwards; from inside, or on it, a one-sided sphere gives 0 and a two-sided one
// 1.

// (angle - sin(angle) cos(angle)) for an angle of [0, pi / 2] whose sine times cosine is `product`: relative
// error 3e-7.
float arealight_circle_segment(float angle, float product) {
    float w = 4.0 * angle * angle;
    float series = 1.0 - w * (0.05 - w * (0.0011904762 - w * (1.6534392e-5 - w * 1.5031265e-7)));
    return w < 1.0 ? 0.66666667 * angle * angle * angle * series : angle - product;
}

// The form factor of a sphere, clipped at the horizon z = 0: in [0, 1]. `center` is from the shading point,
// in a space whose z axis is the normal and which keeps lengths, in any unit; for any bits the result is a
// finite number.
//
// Error: 2e-7, and 3e-6 relative to the whole sphere's at any distance; in contact as if center and radius
// were moved by 4 x 2^-24. Source: the closed form for a spherical source (Snyder 1996), its terms rearranged
// so that they do not cancel.
float arealight_sphere_form_factor(vec3 center, float radius, bool two_sided) {
    float scale = arealight_power_of_two_scale(max(arealight_max_component(center), radius));
    center *= scale;
    radius *= scale;
    float square = dot(center, center);
    float reciprocal = inversesqrt(max(square, AREALIGHT_TINY));
    float distance = square * reciprocal;
    // The angle that the sphere covers, and its center's height, over the distance
    float sine = radius * reciprocal;
    float cosine = sqrt(max((distance - radius) * (distance + radius), 0.0)) * reciprocal;
    float z = center.z * reciprocal;
    float form_factor = sine * sine * z;
    if (abs(z) < sine) {
        float q = sqrt((sine - z) * (sine + z));
        float across = q * q + cosine * cosine;
        float angle = arealight_arctangent(q, cosine);
        float part = cosine / max(across, 1e-37);
        float beyond = form_factor * arealight_arctangent(q, -cosine * z) + q * part * z * z;
        form_factor = (beyond + arealight_circle_segment(angle, q * part)) * AREALIGHT_INVERSE_PI;
    }
    form_factor = distance > radius ? form_factor : two_sided ? 1.0 : 0.0;
    return arealight_guarded_form_factor(form_factor, square + radius * radius);
}

// The solid angle of a sphere seen from outside, in [0, 2 pi]; relative error 1e-6.
float arealight_sphere_solid_angle(vec3 center, float radius) {
    float scale = arealight_power_of_two_scale(max(arealight_max_component(center), radius));
    center *= scale;
    radius *= scale;
    float square = max(dot(center, center), AREALIGHT_TINY);
    float distance = sqrt(square);
    float cosine = sqrt(max((distance - radius) * (distance + radius), 0.0)) / distance;
    float covered = radius * radius / (square * (1.0 + cosine));
    return 2.0 * AREALIGHT_PI * arealight_guarded_form_factor(covered, square + radius * radius);
}

// Two unit vectors with axis = x x y, for a unit axis. Source: Duff et al. 2017.
void arealight_perpendiculars(vec3 axis, out vec3 x, out vec3 y) {
    float side = axis.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + axis.z);
    float b = axis.x * axis.y * a;
    x = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    y = vec3(b, side + axis.y * axis.y * a, -axis.y);
}

// The disk that covers the same directions as a sphere, as an ellipse's arguments: transform each of the
// three by a lobe's matrix. Its front is to the point. In the space of `center`, which keeps lengths.
struct ArealightSilhouette {
    vec3 center;
    vec3 axis_u;
    vec3 axis_v;
    bool inside; // the point is in the sphere or on it: there is none
};

// The silhouette of a sphere. The radius stays, the center comes nearer, so that in contact neither vanishes.
ArealightSilhouette arealight_sphere_silhouette(vec3 center, float radius) {
    ArealightSilhouette silhouette;
    vec3 axis = arealight_normalize_or(center, vec3(0.0, 0.0, 1.0));
    float distance = dot(axis, center);
    silhouette.inside = !(distance > radius);
    float cosine = sqrt(max((distance - radius) * (distance + radius), 0.0)) / distance;
    silhouette.center = center * cosine;
    // Turning clockwise about the direction to the sphere
    arealight_perpendiculars(axis, silhouette.axis_v, silhouette.axis_u);
    silhouette.axis_u *= radius;
    silhouette.axis_v *= radius;
    return silhouette;
}

#endif
