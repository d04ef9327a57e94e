#ifndef TILE_REACH_GLSL
#define TILE_REACH_GLSL

#include "buffers.glsl"
#include "tile_bounds.glsl"

// Bounds of what a light sends to the viewer from the pixels of a tile, summed over the channels of radiance.
//
// Above. A lobe's form factor is the integral of its density over the solid angle of the light: no more than the two's largest
// values multiplied. The solid angle is at most area times cosine over the square of the distance, and 2 pi; Lambert's
// density is cosine / pi; a fitted lobe's is below the table's envelope, a / (b + 1 - cos delta)^2 at the angle delta from the
// mirror direction, times the sine of the elevation above the lobe's horizon (LobeHorizon in Rust).
//
// Below. What Lambert's lobe alone reflects of a flat light that is wholly above the surface. All of its points are as far in front
// of a pixel, f, and at least as high above the surface as the lowest, h: so its form factor is at least area f h / pi times the
// mean over its area of 1 / d^4, d being the distance. That is at least 1 / (D^2 + radius^2)^2, for the distance D of its center,
// which is that of its area: 1 / x^2 is convex (Jensen's inequality), and the mean of d^2 is D^2 and that of the squares about the center.

// What is known of the pixels' reflection.
struct TileReflection {
    TilePlanes mirror; // through each pixel, its normal being the mirror direction of the view
    vec2 envelope;     // a and b
    vec2 diffuse;      // the least and the largest channel of the diffuse albedos
    float glossy;      // no channel of a glossy albedo is larger
};

TileReflection tile_reflection_begin() {
    return TileReflection(tile_planes_begin(), vec2(0.0, TILE_FAR), vec2(TILE_FAR, 0.0), 0.0);
}

// How bounds are rounded, generously.
const float TILE_ROUNDING = 1.001;

// The least and the largest that a flat light sends. `surface` and `lobe` are the planes of horizons; `outside` is the range of how
// far its center is from the pixels, along its normal: negative where the front is seen. (Of others nothing is known: the
// faces of a mesh may send more together than what they lie in could.)
vec2 tile_reach(TileReflection reflection, TilePlanes surface, TilePlanes lobe, TileBox position, TileLight light,
                ArealightGpuLight record, vec2 outside, bool two_sided) {
    vec3 to_low = position.low - light.center;
    vec3 to_high = position.high - light.center;
    vec3 near = max(max(to_low, -to_high), vec3(0.0));
    vec3 far = max(abs(to_low), abs(to_high));
    float nearest = sqrt(dot(near, near)) - light.radius - light.margin;
    float farthest = sqrt(dot(far, far)) + light.margin;
    float sum = record.radiance.x + record.radiance.y + record.radiance.z;
    float square = light.radius * light.radius;
    float area = sqrt(dot(record.area, record.area)) * square;
    float per_distance = 1.0 / max(nearest, 1e-30);

    // Above
    vec2 height = tile_heights(surface, light);
    float off_plane = max(abs(outside.x), abs(outside.y)) + TILE_FLATNESS * light.radius + light.margin;
    float light_cosine = min(off_plane * per_distance, 1.0);
    float solid_angle = min((area * per_distance) * (light_cosine * per_distance), 6.2831855);
    solid_angle = nearest > 0.0 ? solid_angle : 6.2831855;
    float surface_cosine = nearest > 0.0 ? clamp(height.y * per_distance, 0.0, 1.0) : 1.0;
    float mirror_height = tile_heights(reflection.mirror, light).y;
    float mirror_cosine = nearest > 0.0 ? clamp(mirror_height * per_distance, 0.0, 1.0) : 1.0;
    float fall = reflection.envelope.y + 1.0 - mirror_cosine;
    float lobe_cosine = nearest > 0.0 ? clamp(tile_heights(lobe, light).y * per_distance, 0.0, 1.0) : 1.0;
    float glossy = min(solid_angle * reflection.envelope.x / (fall * fall) * lobe_cosine, 1.0);
    float diffuse = min(solid_angle * surface_cosine * 0.31830989, 1.0);
    float most = sum * (reflection.diffuse.y * diffuse + reflection.glossy * glossy) * TILE_ROUNDING;

    // Below
    float front = two_sided ? max(max(outside.x, -outside.y), 0.0) : max(-outside.y, 0.0);
    front = max(front - TILE_FLATNESS * light.radius - light.margin, 0.0);
    // None where it is not wholly above the surface
    float least_height = max(height.x, 0.0);
    float per_far = inversesqrt(farthest * farthest + square);
    float least = sum * reflection.diffuse.x * 0.31830989 * (area * per_far * per_far) * (front * per_far)
                * (least_height * per_far);
    return vec2(least / TILE_ROUNDING, most);
}

#endif
