#ifndef AREALIGHT_ELLIPSE_GLSL
#define AREALIGHT_ELLIPSE_GLSL

#include "arealight/form_factor/arctangent.glsl"
#include "arealight/common.glsl"

// The form factor of a flat ellipse that lies wholly above the horizon, in closed form: a disk light, and
// under the transform into a lobe's cosine space the ellipse that it becomes. elliptic_arc.glsl clips it at
// the horizon.
//
// The ellipse is the points center + cos(t) axis_u + sin(t) axis_v. The two axes need not be perpendicular,
// nor of one length: a disk's axes remain axes under any linear transform. Its front is where t runs
// counter-clockwise, as a polygon's; so axis_u x axis_v points to where it shines.
//
// In the ellipse's principal frame, with half axes a and b and the ellipse's center at (x, y, h) from the
// point, the ellipse is the focal one of a family of confocal quadrics, and the ellipsoid of the family that
// passes through the point (its parameter is the largest root l of x^2 / (a^2 + l) + y^2 / (b^2 + l) + h^2 /
// l = 1) has as its normal there the axis of the cone under which the ellipse is seen. All follows from l
// without cancellation; and l is found without iteration, see arealight_confocal_root.

// An ellipse as seen from the point, scaled by a power of two so that its size is of order one.
struct ArealightEllipse {
    // Unit directions of its axes, which with the normal that points away from the point are its frame
    vec3 longer;
    vec3 shorter;
    vec3 center;  // in the frame, the point being its origin; z > 0
    float major;  // half axes
    float minor;
    float height; // of the center over the horizon, as it came in
    float rise;   // of the highest point of the outline over the center
    bool front;   // the point is before the front
    float scale;  // what came in is multiplied with
    float square; // sum of the squares of what came in: not finite where that was not
};

// Heights over the plane of the ellipse below this part of its size or distance count as this.
const float AREALIGHT_ELLIPSE_HEIGHT = 1e-15;

// An ellipse's frame: columns are unit directions of the longer axis, the shorter axis and the normal, which
// is taken where it is needed.
mat3 arealight_ellipse_frame(ArealightEllipse ellipse) {
    return mat3(ellipse.longer, ellipse.shorter, cross(ellipse.longer, ellipse.shorter));
}

// Heights over the horizon z = 0 in an ellipse's frame are products with this.
vec3 arealight_ellipse_up(ArealightEllipse ellipse) {
    mat3 frame = arealight_ellipse_frame(ellipse);
    return vec3(frame[0].z, frame[1].z, frame[2].z);
}

// The principal frame of an ellipse in any space, from the point.
//
// One rotation of Jacobi's makes conjugate half axes principal. Its angle is at most pi / 4, so that the
// longer axis has no cancellation; the shorter one has that of the axes that came in, as if they had moved by
// 2^-24 of their length.
ArealightEllipse arealight_ellipse(vec3 center, vec3 axis_u, vec3 axis_v) {
    ArealightEllipse ellipse;
    float largest = max(arealight_max_component(center),
                        max(arealight_max_component(axis_u), arealight_max_component(axis_v)));
    float scale = arealight_power_of_two_scale(largest);
    center *= scale;
    axis_u *= scale;
    axis_v *= scale;
    float uu = dot(axis_u, axis_u);
    float vv = dot(axis_v, axis_v);
    ellipse.square = uu + vv + dot(center, center);
    ellipse.height = center.z;
    ellipse.rise = sqrt(axis_u.z * axis_u.z + axis_v.z * axis_v.z);
    // Rotate the parameter until the axes are perpendicular
    float difference = vv - uu;
    float twice = 2.0 * dot(axis_u, axis_v);
    float hypotenuse = sqrt(difference * difference + twice * twice);
    float tangent = twice / (abs(difference) + hypotenuse + AREALIGHT_TINY);
    float cosine = inversesqrt(1.0 + tangent * tangent);
    float sine = cosine * tangent;
    bool swapped = difference > 0.0;
    vec3 longer = swapped ? axis_v : axis_u;
    vec3 shorter = swapped ? axis_u : axis_v;
    vec3 major = cosine * longer + sine * shorter;
    vec3 minor = cosine * shorter - sine * longer;
    float reciprocal = inversesqrt(dot(major, major) + AREALIGHT_TINY);
    ellipse.major = dot(major, major) * reciprocal;
    major *= reciprocal;
    // What rounding left along the longer axis may be more than the shorter one
    minor -= major * dot(major, minor);
    float minor_square = dot(minor, minor);
    reciprocal = inversesqrt(max(minor_square, 1e-37));
    ellipse.minor = minor_square * reciprocal;
    minor *= reciprocal;
    float height = dot(center, cross(major, minor));
    // The frame's normal is that of the front, or where axes were swapped of the back
    ellipse.front = (height < 0.0) != swapped;
    // And points away from the point
    minor = height < 0.0 ? -minor : minor;
    ellipse.scale = scale;
    ellipse.longer = major;
    ellipse.shorter = minor;
    ellipse.center = vec3(dot(center, major), dot(center, minor), max(abs(height), AREALIGHT_ELLIPSE_HEIGHT));
    return ellipse;
}

// cos(acos(k) / 3), from c = cos(acos(k) / 2) in [0, 1]: relative error 3e-8 before rounding.
float arealight_third_of_angle(float c) {
    float high = -0.030570029 + c * (0.016541836 + c * (-0.0064513453 + c * 0.0012316345));
    return 0.50000001 + c * (0.5773481 + c * (-0.11105764 + c * (0.052957459 + c * high)));
}

// The largest root l of x^2 / (a^2 + l) + y^2 / (b^2 + l) + h^2 / l = 1: positive.
//
// As a cubic, l^3 + p l^2 + q l - r = 0 with r > 0 has three real roots, one positive. Viete's formula gives
// the root that is largest in size without cancellation: where p <= 0 it is the one that is wanted, else the
// other two have a quadratic equation that gives it. The coefficients are differences of squares, taken as
// products. Relative error in exact arithmetic: 5e-8; what the form factor has of it is less, and rounding is
// as if the ellipse had moved by 2^-24 of its distance.
float arealight_confocal_root(ArealightEllipse ellipse) {
    float x = abs(ellipse.center.x);
    float y = abs(ellipse.center.y);
    float a2 = ellipse.major * ellipse.major;
    float b2 = ellipse.minor * ellipse.minor;
    float y2 = y * y;
    float h2 = ellipse.center.z * ellipse.center.z;
    float x_room = (ellipse.major - x) * (ellipse.major + x);
    float y_room = (ellipse.minor - y) * (ellipse.minor + y);
    float p = x_room + y_room - h2;
    float q = b2 * x_room - a2 * y2 - h2 * (a2 + b2);
    float r = a2 * b2 * h2;
    // The root of the largest size
    float size = abs(p);
    float radius_square = max(p * p - 3.0 * q, 0.0) * (1.0 / 9.0);
    float radius = sqrt(radius_square);
    float cube = (size * (2.0 * p * p - 9.0 * q) + (p > 0.0 ? -27.0 : 27.0) * r) * (1.0 / 54.0);
    float k = clamp(cube / max(radius_square * radius, 1e-37), -1.0, 1.0);
    float largest = 2.0 * radius * arealight_third_of_angle(sqrt(0.5 + 0.5 * k)) + size * (1.0 / 3.0);
    // Where that is negative, the others' quadratic equation l^2 - sum l - product = 0
    float reciprocal = 1.0 / max(largest, 1e-37);
    float product = r * reciprocal;
    float sum = -(q + product) * reciprocal;
    float root = sqrt(sum * sum + 4.0 * product);
    float other = sum < 0.0 ? 2.0 * product / max(root - sum, 1e-37) : 0.5 * (root + sum);
    float l = p > 0.0 ? other : largest;
    return clamp(l, h2, h2 + y2 + x * x);
}

// 1 / (a^2 + l) and 1 / (b^2 + l).
vec2 arealight_confocal_reciprocals(ArealightEllipse ellipse, float root) {
    return 1.0 / (vec2(ellipse.major * ellipse.major, ellipse.minor * ellipse.minor) + root);
}

// The axis of the cone under which the ellipse is seen, in its frame: the normal of the confocal ellipsoid of
// parameter `root`, of no particular length.
vec3 arealight_ellipse_cone_axis(ArealightEllipse ellipse, float root) {
    return vec3(ellipse.center.xy * (root * arealight_confocal_reciprocals(ellipse, root)), ellipse.center.z);
}

// The form factor of an ellipse that lies wholly above the horizon, of either side. Error: 4e-7, relative
// 2e-6 at any distance, for an ellipse as it rounds: its center and axes are as if moved by 4 x 2^-24 of
// their lengths.
float arealight_whole_ellipse(ArealightEllipse ellipse, float root) {
    float a2 = ellipse.major * ellipse.major;
    float b2 = ellipse.minor * ellipse.minor;
    vec3 up = arealight_ellipse_up(ellipse);
    vec3 axis = arealight_ellipse_cone_axis(ellipse, root);
    // The cone's axis is the center less what is small for a far ellipse: so its height keeps the center's
    // precision
    vec2 less = ellipse.center.xy * vec2(a2, b2) * arealight_confocal_reciprocals(ellipse, root);
    float height = root > a2 ? ellipse.height - dot(less, up.xy) : dot(axis, up);
    float area = ellipse.center.z * ellipse.major * ellipse.minor;
    return height * (area * inversesqrt((a2 + root) * (b2 + root)) / dot(axis, axis));
}

#endif
