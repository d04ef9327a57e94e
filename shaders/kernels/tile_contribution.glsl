#ifndef TILE_CONTRIBUTION_GLSL
#define TILE_CONTRIBUTION_GLSL

#include "tile_bounds.glsl"

// Bounds of a light's contribution: of the radiance that the pixels of a tile reflect of it to the viewer,
// summed over the channels.
//
// Above. A lobe's form factor is the integral of its density over the solid angle of the light: no more than
// the largest values of the two multiplied. The solid angle is at most area times cosine over the square of
// the distance, and 2 pi; Lambert's density is cosine / pi; a fitted lobe's is below the table's envelope, a
// / (b + 1 - cos delta)^2 at the angle delta from the mirror direction, times the sine of the elevation above
// the lobe's horizon (LobeHorizon in Rust). A sphere's solid angle is at most that of a disk of its radius
// that faces the pixel at the sphere's nearest point: 2 (1 - cos a) <= tan(a)^2 <= r^2 / (D - r)^2 where sin
// a = r / D. Of a tube no pixel sees more than half of the surface: of two points opposite to each other
// about its center, one at most.
//
// Below. What Lambert's lobe alone reflects of a flat light that is wholly above the surface. All of its
// points are as far in front of a pixel, f, and at least as high above the surface as the lowest, h: so its
// form factor is at least area f h / pi times the mean over its area of 1 / d^4, d being the distance. That
// is at least 1 / (D^2 + radius^2)^2, for the distance D of its center, which is that of its area: 1 / x^2 is
// convex (Jensen's inequality), and the mean of d^2 is D^2 and that of the squares about the center. A
// sphere's is r^2 h / D^3, with the height of its center.

// Bounds of the pixels' fitted lobes.
struct TileLobe {
    vec2 envelope; // a and b
    float albedo;  // no channel of an albedo is larger
};

// Bounds of the pixels' reflection.
struct TileReflection {
    vec2 diffuse; // the least and the largest channel of the diffuse albedos
    TileLobe glossy;
    TileLobe coat; // an albedo of 0 where no pixel has a coat
};

// How bounds are rounded, generously.
const float TILE_ROUNDING = 1.001;

const float TILE_PI = 3.1415927;

// The heights of a light above the planes of a tile: the least and the largest above the surfaces, the
// largest above the horizons of the glossy lobes and along their mirror directions, and of the coats'.
struct TileLightHeights {
    vec2 surface;
    float lobe;
    float mirror;
    vec2 coat;
};

// The most that a fitted lobe reflects of a light of this solid angle whose points have no larger cosines to
// the normal of the lobe's horizon (x) and to its mirror direction (y).
float lobe_contribution(TileLobe lobe, float solid_angle, vec2 cosines) {
    float fall = lobe.envelope.y + 1.0 - cosines.y;
    return lobe.albedo * min(solid_angle * lobe.envelope.x / (fall * fall) * cosines.x, 1.0);
}

// The least and the largest contribution of a light with bounds; `behind` is the range of how far the pixels
// are behind its center, along its normal: negative in front of it.
vec2 tile_contribution(TileReflection reflection, TileBox position, TileLight light, TileLightHeights heights,
                       vec2 behind) {
    vec3 to_low = position.low - light.center;
    vec3 to_high = position.high - light.center;
    vec3 near = max(max(to_low, -to_high), vec3(0.0));
    vec3 far = max(abs(to_low), abs(to_high));
    float nearest = sqrt(dot(near, near)) - light.radius - light.margin;
    float farthest = sqrt(dot(far, far)) + light.margin;
    float per_distance = 1.0 / max(nearest, 1e-30);
    bool is_flat = light.normal != vec3(0.0);
    bool is_apart = nearest > 0.0;

    // Above
    float off_plane = max(abs(behind.x), abs(behind.y)) + TILE_FLATNESS * light.radius + light.margin;
    float light_cosine = is_flat ? min(off_plane * per_distance, 1.0) : 1.0;
    float solid_angle = min((light.area * per_distance) * (light_cosine * per_distance), 2.0 * TILE_PI);
    solid_angle = is_apart ? solid_angle : 2.0 * TILE_PI;
    vec3 cosines = clamp(vec3(heights.surface.y, heights.lobe, heights.mirror) * per_distance, 0.0, 1.0);
    cosines = is_apart ? cosines : vec3(1.0);
    float reflected = reflection.diffuse.y * min(solid_angle * cosines.x / TILE_PI, 1.0)
                    + lobe_contribution(reflection.glossy, solid_angle, cosines.yz);
    if (AREALIGHT_HAS_COAT && reflection.coat.albedo != 0.0) {
        vec2 coat_cosines = is_apart ? clamp(heights.coat * per_distance, 0.0, 1.0) : vec2(1.0);
        reflected += lobe_contribution(reflection.coat, solid_angle, coat_cosines);
    }
    float most = light.radiance * reflected * TILE_ROUNDING;

    // Below
    float front = light.two_sided ? max(max(behind.x, -behind.y), 0.0) : max(-behind.y, 0.0);
    front = max(front - TILE_FLATNESS * light.radius - light.margin, 0.0);
    float least_height = max(heights.surface.x, 0.0); // none where it is not wholly above the surface
    float per_far = inversesqrt(farthest * farthest + light.radius * light.radius);
    float least_cosine = is_flat ? front * per_far : 1.0;
    float least = light.radiance * reflection.diffuse.x / TILE_PI * (light.least * per_far * per_far)
        * least_cosine
                * (least_height * per_far);
    return vec2(least / TILE_ROUNDING, most);
}

#endif
