#ifndef AREALIGHT_COMMON_GLSL
#define AREALIGHT_COMMON_GLSL

// Arealight: analytic area lights by linearly transformed cosines.
//
// Conventions of every file here:
// - SI radiometry, linear Rec. 709 colour; radiance in W/(m^2 sr).
// - Right-handed; matrices are column-major and act on column vectors; angles in radians.
// - roughness is perceptual, alpha = roughness^2; GGX with height-correlated Smith masking-shadowing.
// - A light's front is the side from which its vertices run counter-clockwise.
// - Positions are relative to an origin near the camera that the host chooses: float32 world coordinates far
//   from zero lose the result before it gets here.
// - Pure functions: no bindings, no mutable globals. What the host must provide are bridge functions
//   (arealight_bridge_*), declared where they are used; a missing one is a link error that names it.

const float AREALIGHT_PI = 3.14159265358979;
const float AREALIGHT_INVERSE_PI = 0.318309886183791;
const float AREALIGHT_INVERSE_TWO_PI = 0.159154943091895;

// The smallest GGX alpha that is shaded; smaller ones are raised to it. The same as arealight::MIN_ALPHA.
const float AREALIGHT_MIN_ALPHA = 1e-4;

// Squared lengths below this count as zero: 2^-100, far above float32's smallest normal number.
const float AREALIGHT_TINY = 7.8886090522101181e-31;

// The sine of the elevation below which an end of a curved outline counts as on the horizon: 1.7 x 2^-24,
// about what the rounding of a vertex can make of zero. In a lobe's cosine space it is as much narrower as
// heights are lower there: arealight_horizon_width.
const float AREALIGHT_HORIZON_WIDTH = 1e-7;

// The sine of the elevation over a light's plane below which a shading point counts as in it: what rounding
// can make of zero.
const float AREALIGHT_PLANE_WIDTH = 3e-7;

// How far a position may be from where it was meant to be, as a part of the sum of its coordinates' sizes:
// eight units of float32's last place, what rounding makes of a ray's hit or of a depth buffer's depth.
const float AREALIGHT_POSITION_WIDTH = 1e-6;

// The largest absolute component of v.
float arealight_max_component(vec3 v) {
    vec3 a = abs(v);
    return max(a.x, max(a.y, a.z));
}

// A perceptual roughness within [smallest, 1]; NaN counts as the smallest.
float arealight_clamped_roughness(float roughness, float smallest) {
    return roughness > smallest ? min(roughness, 1.0) : smallest;
}

// 2^-e for a positive finite x = m 2^e with 1 <= m < 2: an exact power of two, so that scaling by it rounds
// nothing. x outside [1e-37, 1e37] is clamped.
float arealight_power_of_two_scale(float x) {
    uint exponent = clamp(floatBitsToUint(x) >> 23, 4u, 250u);
    return uintBitsToFloat((254u - exponent) << 23);
}

// v divided by its length, for vectors of any length from 1e-37 to 3e38; `fallback` for the zero vector and
// where a component is NaN or infinite. The result's length is 1 to 2e-7. Where the driver takes denormal
// numbers for zero, as Vulkan allows, components below 1.2e-38 are lost: the direction is exact to 1.2e-7 for
// lengths from 1e-31.
//
// It is scaled by its largest component's power of two, not divided by that: x / x may be less than 1, and
// anything where x is above 2^126, by the precision that Vulkan asks of a division. The factor keeps the root
// of a unit vector's square away from powers of two, above which float32 is coarse.
vec3 arealight_normalize_or(vec3 v, vec3 fallback) {
    float largest = arealight_max_component(v);
    if (!(largest >= 1e-37 && largest <= 3e38)) {
        return fallback;
    }
    vec3 scaled = v * (0.7 * arealight_power_of_two_scale(largest));
    float square = dot(scaled, scaled);
    // NaN in a smaller component reaches the square
    return square >= 0.48 ? scaled * inversesqrt(square) : fallback;
}

// AREALIGHT_HORIZON_WIDTH in a linear space: less where heights become lower than lengths.
float arealight_horizon_width(mat3 space) {
    vec3 height = vec3(space[0].z, space[1].z, space[2].z);
    float longest = max(dot(space[0], space[0]), max(dot(space[1], space[1]), dot(space[2], space[2])));
    return AREALIGHT_HORIZON_WIDTH * sqrt(dot(height, height) / (longest + AREALIGHT_TINY));
}

// Relative luminance of linear Rec. 709 colours.
float arealight_luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// The error of a shading point's position, which is relative to an origin near the camera.
float arealight_position_error(vec3 position) {
    return AREALIGHT_POSITION_WIDTH * dot(abs(position), vec3(1.0));
}

// The side of a light that a shading point is on, if it lights it: 1 before the front, -1 behind a two-sided
// light, else 0. A point in the light's plane is on neither side, so that a light in the plane of a surface
// does not light it by the last bit. `offset` goes from the point to the light's center; `normal` is that of
// the front, unit. 0 where a component of `offset` is not finite.
//
// What rounding makes of a height is in proportion to the coordinates that it is made of. Along those to
// which the normal is perpendicular nothing is added, and nothing rounded: a level ceiling has a side at any
// height, however large it is.
//
// A two-sided light does not light itself: its own points are in its plane but for the error of their
// positions, `error` (arealight_position_error), and one put behind the plane would see nothing else.
float arealight_lit_side(vec3 offset, vec3 normal, bool two_sided, float error) {
    float height = -dot(offset, normal);
    float width = AREALIGHT_PLANE_WIDTH * dot(abs(offset), clamp(1e9 * abs(normal), 0.0, 1.0))
                + (two_sided ? error : 0.0);
    return height > width ? 1.0 : two_sided && -height > width ? -1.0 : 0.0;
}

// Whether x is neither infinite nor NaN, by its bits, so that no compiler can assume it. For a light's
// record, GPUs with scalar units compute this once per wave.
bool arealight_is_finite(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) < 0x7f800000u;
}

// A form factor in [0, 1] for any bits: 0 where it is negative or NaN, or where something of the light is not
// `finite`. The bit patterns of [0, 1] are those up to 0x3f800000; everything negative or NaN lies beyond
// infinity's 0x7f800000.
float arealight_guarded_form_factor(float form_factor, bool finite) {
    uint bits = floatBitsToUint(form_factor);
    return finite && bits < 0x7f800000u ? uintBitsToFloat(min(bits, 0x3f800000u)) : 0.0;
}

// The same where `square`, what is squared of the light's distances, is not finite.
float arealight_guarded_form_factor(float form_factor, float square) {
    return arealight_guarded_form_factor(form_factor, floatBitsToUint(square) < 0x7f800000u);
}

#endif
