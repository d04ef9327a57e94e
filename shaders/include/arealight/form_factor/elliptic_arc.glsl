#ifndef AREALIGHT_ELLIPTIC_ARC_GLSL
#define AREALIGHT_ELLIPTIC_ARC_GLSL

#include "arealight/form_factor/ellipse.glsl"
#include "arealight/options.glsl"

// Arcs of an ellipse, and with them the form factor of an ellipse clipped exactly at the horizon, in closed
// form.
//
// The cone of directions under which an ellipse is seen is elliptic: in its own frame it is
// (a cos(t), b sin(t), c). The contour integral of Lambert's formula over an arc of it, the vector
//
//     I = integral of p x dp / |p|^2,
//
// is elementary: its components are two arctangents and one logarithm, taken at the arc's middle and half
// width, where neither short nor nearly full arcs cancel.

// An elliptic cone of directions.
struct ArealightCone {
    // Columns: unit directions of the longer axis, the shorter axis and the cone's own, in the ellipse's
    mat3 frame;
                // frame; right-handed
    float a;    // half axes of the cross section at the distance c: a >= b
    float b;
    float c;
};

// An arc of a cone's outline, from middle - half to middle + half in the parameter t, 0 <= half <= pi.
struct ArealightArcSpan {
    vec2 middle; // cosine and sine
    vec2 half_width;
};

// The cone of an ellipse; `root` by arealight_confocal_root.
//
// The planes through the point that touch the ellipse have normals n with n.D n = 0, D = a^2 uu + b^2 vv - cc
// for the principal half axes and the center c. The eigenvalues of D are the cone's a^2, b^2 and -c^2 (the
// last one -root), the axis being the eigenvector of the last one; b follows from the determinant, where it
// does not cancel. Across that axis, w of the length |w|, D equals
//
//     |w|^2 / root (a^2 uu + b^2 vv) + a^2 b^2 jj,    j = y / (b^2 + root) u - x / (a^2 + root) v,
//
// for the center (x, y, h) in the ellipse's frame: a sum in which nothing cancels, where the one above loses
// all digits before a needle's tip.
ArealightCone arealight_ellipse_cone(ArealightEllipse ellipse, float root) {
    ArealightCone cone;
    float a2 = ellipse.major * ellipse.major;
    float b2 = ellipse.minor * ellipse.minor;
    vec3 axis = arealight_ellipse_cone_axis(ellipse, root);
    float square = dot(axis, axis);
    axis *= inversesqrt(square);
    // Two perpendiculars, along which no component cancels: the second has none along the ellipse's longer
    // axis
    float across = sqrt(axis.y * axis.y + axis.z * axis.z);
    float reciprocal = 1.0 / max(across, 1e-37);
    vec3 first = vec3(across, -axis.x * axis.y * reciprocal, -axis.x * axis.z * reciprocal);
    vec3 second = vec3(0.0, axis.z * reciprocal, -axis.y * reciprocal);
    // D between them: all of a sum's terms have one sign
    float c_reciprocal = inversesqrt(root);
    square *= c_reciprocal * c_reciprocal;
    vec2 place = ellipse.center.xy * arealight_confocal_reciprocals(ellipse, root);
    float along_first = place.y * first.x - place.x * first.y;
    float along_second = -place.x * second.y;
    float m11 = square * (a2 * first.x * first.x + b2 * first.y * first.y) + a2 * b2 * along_first
        * along_first;
    float m12 = b2 * (square * first.y * second.y + a2 * along_first * along_second);
    float m22 = b2 * (square * second.y * second.y + a2 * along_second * along_second);
    // Its eigenvectors, by one rotation of Jacobi's
    float difference = m22 - m11;
    float hypotenuse = sqrt(difference * difference + 4.0 * m12 * m12);
    float tangent = 2.0 * m12 / (abs(difference) + hypotenuse + 1e-37);
    float cosine = inversesqrt(1.0 + tangent * tangent);
    float sine = cosine * tangent;
    cone.a = sqrt(max(0.5 * (m11 + m22 + hypotenuse), 1e-37));
    cone.c = root * c_reciprocal;
    cone.b = min(ellipse.center.z * ellipse.major * ellipse.minor * c_reciprocal / cone.a, cone.a);
    vec2 turn = difference > 0.0 ? vec2(sine, cosine) : vec2(cosine, sine);
    cone.frame = mat3(turn.x * first + turn.y * second, turn.x * second - turn.y * first, axis);
    return cone;
}

// The integral of p x dp / |p|^2 over an arc of a cone's outline, in the cone's frame. Absolute error: some
// 2^-23 for components up to 2 pi.
vec3 arealight_elliptic_arc(ArealightCone cone, ArealightArcSpan arc) {
    float cs = arc.middle.x;
    float ss = arc.middle.y;
    float ch = arc.half_width.x;
    float sh = arc.half_width.y;
    float a = cone.a;
    float b = cone.b;
    float c = cone.c;
    float p = c * c + a * a;
    float q = c * c + b * b;
    float e = (a - b) * (a + b);
    // Sines and cosines of the ends: their products as products, not as differences of squares
    float cos_end = cs * ch - ss * sh;
    float cos_begin = cs * ch + ss * sh;
    float sin_end = ss * ch + cs * sh;
    float sin_begin = ss * ch - cs * sh;
    float cos_cos = cos_end * cos_begin;
    float sin_sin = sin_end * sin_begin;
    vec3 integral;
    // Along the axis: an angle that is more than pi for more than half of the outline
    float pq_reciprocal = inversesqrt(max(p * q, 1e-37));
    float turn = arealight_arctangent(2.0 * sh * ch * (p * q * pq_reciprocal), p * cos_cos + q * sin_sin);
    turn = ch < 0.0 ? turn + 2.0 * AREALIGHT_PI : turn;
    integral.z = a * b * turn * pq_reciprocal;
    // Along the shorter axis: an arctangent over its own argument, which vanishes for a round cone
    float eq = sqrt(e * q);
    float denominator = q + e * cos_cos;
    float lean = arealight_arctangent(-2.0 * ss * sh * eq, denominator);
    integral.y = a * c * (eq > 1e-6 * q ? lean / eq : -2.0 * ss * sh / denominator);
    // Along the longer axis: a hyperbolic arctangent over its own argument
    float sum = q + e * (cs * cs + sh * sh);
    float sum_reciprocal = 1.0 / max(sum, 1e-37);
    float ratio = 2.0 * abs(cs) * sh * sqrt(e * p) * sum_reciprocal;
    float ratio2 = ratio * ratio;
    float series = 1.0 + ratio2 * (0.33333333 + ratio2 * (0.2 + ratio2 * 0.14285714));
    float end = inversesqrt(max(q + e * cos_end * cos_end, 1e-37));
    float begin = inversesqrt(max(q + e * cos_begin * cos_begin, 1e-37));
    float logarithm = log((1.0 + ratio) * sum * (end * begin));
    integral.x = -2.0 * b * c * cs * sh * sum_reciprocal * (ratio < 0.15 ? series : logarithm / ratio);
    return integral;
}

// The solid angle of a whole ellipse, of either side: in [0, 2 pi]. With the cone's half axes A and B at a
// distance of 1 it is the integral over a quarter turn of
//
//     4 A B / (S + S^2),    S^2 = 1 + A^2 cos^2 + B^2 sin^2,
//
// a complete elliptic integral of the third kind without its cancellation. Stretched so that its two scales
// are as far from 1, by midpoints: error 1e-6 of it where A < 20 (1 + B), 2e-4 where it is a line.
float arealight_ellipse_solid_angle(vec3 center, vec3 axis_u, vec3 axis_v) {
    const int COUNT = 8;
    ArealightEllipse ellipse = arealight_ellipse(center, axis_u, axis_v);
    ArealightCone cone = arealight_ellipse_cone(ellipse, arealight_confocal_root(ellipse));
    float p = cone.c * cone.c + cone.a * cone.a;
    float q = cone.c * cone.c + cone.b * cone.b;
    float ratio = max(sqrt(q / p), 1e-12);
    // cos^2 of the midpoint, from one to the next by a rotation of an eighth of a half turn
    vec2 turn = vec2(0.980785280, 0.195090322);
    float sum = 0.0;
    for (int i = 0; i < COUNT; i++) {
        float cosine = 0.5 + 0.5 * turn.x;
        float sine = 0.5 - 0.5 * turn.x;
        float above = p * (cosine + ratio * sine);
        sum += 1.0 / (above + cone.c * sqrt(above * (cosine + sine / ratio)));
        turn = vec2(turn.x * 0.923879533 - turn.y * 0.382683432, turn.x * 0.382683432 + turn.y * 0.923879533);
    }
    float covered = cone.a * cone.b * inversesqrt(ratio) * sum / float(COUNT);
    return 2.0 * AREALIGHT_PI * arealight_guarded_form_factor(covered, ellipse.square);
}

// The contour of the part of a cone above the horizon of a unit `normal`, given in the cone's frame:
// arealight_elliptic_arc of its outline, and what closes it along the horizon, a vector along the normal of
// the length w. The cone must cross the horizon.
vec4 arealight_cone_contour_above_horizon(ArealightCone cone, vec3 normal) {
    // Where on the outline the height a n.x cos(t) + b n.y sin(t) + c n.z is positive
    vec2 slope = vec2(cone.a * normal.x, cone.b * normal.y);
    float steepness = sqrt(dot(slope, slope));
    float reciprocal = 1.0 / max(steepness, 1e-37);
    ArealightArcSpan arc;
    arc.middle = slope * reciprocal;
    float cosine = clamp(-cone.c * normal.z * reciprocal, -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    arc.half_width = vec2(cosine, sine);
    vec3 integral = arealight_elliptic_arc(cone, arc);
    // Back along the horizon: the angle between the arc's ends
    float cos_cos = (arc.middle.x * cosine - arc.middle.y * sine)
        * (arc.middle.x * cosine + arc.middle.y * sine);
    float sin_sin = (arc.middle.y * cosine - arc.middle.x * sine)
        * (arc.middle.y * cosine + arc.middle.x * sine);
    float closing = arealight_arctangent(2.0 * cone.a * cone.b * cone.c * sine * reciprocal,
                                         cone.c * cone.c + cone.a * cone.a * cos_cos + cone.b * cone.b
                                             * sin_sin);
    return vec4(integral, closing);
}

// The form factor of that part, in [-2^-20, 1]. Source: Lambert's formula.
float arealight_cone_above_horizon(ArealightCone cone, vec3 normal) {
    vec4 contour = arealight_cone_contour_above_horizon(cone, normal);
    return (dot(normal, contour.xyz) + contour.w) * AREALIGHT_INVERSE_TWO_PI;
}

// The part of a small ellipse above the horizon.
struct ArealightEllipseSegment {
    vec3 middle;   // centroid of the heights above the horizon, in the ellipse's frame
    // The integral of the height over the segment of the unit disk to which the axes map it, over the rise
    float moment;
};

// `up` is the horizon's normal in the ellipse's frame. The ellipse must cross the horizon.
ArealightEllipseSegment arealight_ellipse_segment(ArealightEllipse ellipse, vec3 up) {
    float reciprocal = 1.0 / max(ellipse.rise, 1e-37);
    // Half the arc above the horizon
    float cosine = clamp(-ellipse.height * reciprocal, -1.0, 1.0);
    float sine = sqrt(max((ellipse.rise - ellipse.height) * (ellipse.rise + ellipse.height), 0.0))
        * reciprocal;
    float angle = arealight_arctangent(sine, cosine);
    float w = angle * angle;
    // The moment, and the mean height, weighed with the height, over the rise
    float moment;
    float mean;
    if (w < 1.0) {
        float series = 0.99999947 + w * (-0.26188854 + w
                                         * (0.03364939 + w * (-0.0026387374 + w * 8.501425e-5)));
        moment = 0.13333333 * w * w * angle * series;
        mean = 0.99999957 + w * (-0.21427264 + w * (0.02119492 + w * (-0.00068659094 - w * 4.4518310e-5)));
    } else {
        float area = angle - sine * cosine;
        float first = 0.66666667 * sine * sine * sine;
        float second = 0.25 * (angle - sine * cosine * (2.0 * cosine * cosine - 1.0));
        moment = first - cosine * area;
        mean = (second - cosine * first) / moment;
    }
    vec2 half_axes = vec2(ellipse.major, ellipse.minor);
    vec3 middle = ellipse.center + vec3(half_axes * half_axes * up.xy * (mean * reciprocal), 0.0);
    return ArealightEllipseSegment(middle, moment);
}

// The form factor of a small ellipse that crosses the horizon, with relative precision: its radiance all
// comes from the centroid of its segment. Arguments as above. Relative error: 2 (major / distance)^2.
float arealight_small_ellipse_crossing(ArealightEllipse ellipse, vec3 up) {
    ArealightEllipseSegment segment = arealight_ellipse_segment(ellipse, up);
    float square = dot(segment.middle, segment.middle);
    float area = ellipse.center.z * ellipse.major * ellipse.minor;
    return area * ellipse.rise * segment.moment * AREALIGHT_INVERSE_PI / (square * square);
}

// Whether an ellipse is so small that its segment stands for it where it crosses the horizon.
bool arealight_is_small_ellipse(ArealightEllipse ellipse) {
    return ellipse.major * ellipse.major < 4e-4 * dot(ellipse.center, ellipse.center);
}

// The form factor of an ellipse, clipped at the horizon z = 0: in [0, 1]; one-sided: 0 for one seen from its
// back. All vectors in a space whose z axis is the normal, the center from the shading point, in any unit.
// For any bits the result is a finite number in [0, 1].
//
// Error: within 6e-7 of the interval of values of the ellipses whose center and axes differ by 4 x 2^-24 of
// their lengths. A far ellipse keeps relative precision; one that crosses the horizon 3e-6 + 2 (size /
// distance)^2.
float arealight_ellipse_form_factor(vec3 center, vec3 axis_u, vec3 axis_v, bool two_sided) {
    ArealightEllipse ellipse = arealight_ellipse(center, axis_u, axis_v);
    float root = arealight_confocal_root(ellipse);
    vec3 up = arealight_ellipse_up(ellipse);
    float form_factor;
    // An ellipse in the horizon's plane is below it
    if (ellipse.height <= -ellipse.rise) {
        form_factor = 0.0;
    } else if (ellipse.height >= ellipse.rise) {
        form_factor = arealight_whole_ellipse(ellipse, root);
    } else if (arealight_is_small_ellipse(ellipse)) {
        form_factor = arealight_small_ellipse_crossing(ellipse, up);
    } else {
        ArealightCone cone = arealight_ellipse_cone(ellipse, root);
        form_factor = arealight_cone_above_horizon(cone, up * cone.frame);
    }
    return arealight_guarded_form_factor(two_sided || ellipse.front ? form_factor : 0.0, ellipse.square);
}

#endif
