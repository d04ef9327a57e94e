#ifndef AREALIGHT_ARC_GLSL
#define AREALIGHT_ARC_GLSL

#include "arealight/common.glsl"

// Edges of polygons as arcs of great circles between two directions.
//
// The form factor is -1 / (2 pi) times z of the sum, around an outline, of (angle between the ends) x (unit
// normal of the edge's plane) (Baum et al. 1989): counter-clockwise from the light's front is clockwise about
// the direction to the light. All of the vector points to where the light comes from (Arvo 1995); what a
// caller does not read costs nothing.
//
// For unit vectors a and b at the angle theta the arc is (a x b) theta / sin(theta), taken here at the half
// angle: with m = a + b and y = |m| = 2 cos(theta / 2),
//
//     a x b = a x m,    theta / sin(theta) = 2 G(y / 2) / y,    G(c) = acos(c) / sqrt(1 - c^2).
//
// G is smooth on [0, 1], so one rational function serves every angle up to pi; and where a and b are nearly
// opposite, a x m and y are as small as each other, so that rounding is as if an end had moved by 2^-24.
// Acute arcs have a x (b - a), whose rounding is as small as they are. Nothing branches.

// What the sum of arcs is multiplied with.
const float AREALIGHT_PER_ARC = -AREALIGHT_INVERSE_TWO_PI;

// Squared lengths below this count as this: float32's smallest normal number, 2^-126.
const float AREALIGHT_LEAST_SQUARE = 1.17549435e-38;

// The direction of v, for lengths from 1.1e-19 to 1.8e19; 0 for zero, NaN where a component is.
vec3 arealight_unit(vec3 v) {
    return v * inversesqrt(max(dot(v, v), AREALIGHT_LEAST_SQUARE));
}

// The angle from a to b, unit vectors, times the unit normal of their plane, radians. Error 5e-7 of one
// radian or of the angle, whichever is larger; for ends within 2e-3 of opposite as if one of them had moved
// by 2^-24. The weight of s is within 7e-8 of 2 G(y / 2) / y before rounding, for y from
// sqrt(AREALIGHT_LEAST_SQUARE) to 2.
vec3 arealight_arc(vec3 a, vec3 b) {
    vec3 middle = a + b;
    float square = dot(middle, middle);
    vec3 s = cross(a, b + (square > 2.0 ? -1.0 : 1.0) * a);
    float y = sqrt(square + AREALIGHT_LEAST_SQUARE);
    return s * (3.1415925 + y * (1.1001613 + y * (0.028413607 - y * 0.00084628159)))
         / (y + y * y * (0.66850024 + y * 0.096849829));
}

// The angle of the cosine x over its sine, for x in [0, 1]: acos(x) / sqrt(1 - x^2), with a relative error of
// 5.6e-7. Source: minimax rational function, by the exchange algorithm.
float arealight_acute_weight(float x) {
    return (1.57079545 + x * (0.905811694 + x * 0.0260320425))
         / (1.0 + x * (1.21323771 + x * 0.289400083));
}

// What rounding makes of the sine of a half turn: that of vectors that both moved by 2 x 2^-24.
const float AREALIGHT_HALF_TURN = 2.4e-7;

// The arc along the horizon from a to b, unit vectors on it: z is the angle, in [-pi, pi]. An obtuse angle is
// pi less the acute one: here rounding of y would turn the arc, not move its end.
//
// It closes the sum of an outline's other arcs. `front`: 1 where the outline is known to be seen from its
// front, -1 from its back: an obtuse arc then runs the way that closes such an outline, whatever rounding has
// done to the ends, as it does where the point is almost in the plane of a light far larger than its height
// over it. 0 where it is not known: then s tells, and of a half turn, where rounding alone tells the side, it
// is the one that `half_turn` has the sign of. -z of the sum of the other arcs is the sign to give: the
// smaller of the two sums is the form factor of one of the sides; the larger one, where rounding put the
// other arcs on the other side, of neither.
vec3 arealight_horizon_arc(vec2 a, vec2 b, float half_turn, float front) {
    float cosine = dot(a, b);
    vec2 along = b - a;
    float s = a.x * along.y - a.y * along.x;
    float acute = s * arealight_acute_weight(abs(cosine));
    float side = front != 0.0 ? -front : abs(s) > AREALIGHT_HALF_TURN ? s : half_turn;
    return vec3(0.0, 0.0, cosine < 0.0 ? (side < 0.0 ? -AREALIGHT_PI : AREALIGHT_PI) - acute : acute);
}

// The direction in which the edge from `above` to `below`, points of any length on either side of the
// horizon, meets it: a sum of two vectors, which cancel only where the ends are opposite.
vec2 arealight_crossing(vec3 above, vec3 below) {
    vec2 point = below.xy * above.z - above.xy * below.z;
    return point * inversesqrt(max(dot(point, point), AREALIGHT_LEAST_SQUARE));
}

// The point in which that edge meets the horizon.
vec3 arealight_cut(vec3 above, vec3 below) {
    return vec3((below.xy * above.z - above.xy * below.z) / (above.z - below.z), 0.0);
}

// A form factor from z of a vector form factor: in [0, 1] for any bits, 0 for NaN. It compares bits, where no
// compiler may assume that there is no NaN: the patterns of [0, 1] are those up to 0x3f800000, infinity is
// 0x7f800000, and everything negative or NaN lies beyond.
float arealight_form_factor(vec3 vector) {
    uint bits = floatBitsToUint(vector.z);
    return bits < 0x7f800000u ? uintBitsToFloat(min(bits, 0x3f800000u)) : 0.0;
}

#endif
