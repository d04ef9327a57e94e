#ifndef TILE_CONTRIBUTION_GLSL
#define TILE_CONTRIBUTION_GLSL

#include "tile_light.glsl"

// Bounds of a light's contribution: of the radiance that the pixels of a tile reflect of it to the viewer,
// summed over the channels.
//
// Above. A lobe's form factor is the integral of its density over the solid angle of the light: no more than
// the largest values of the two multiplied. Lambert's density is cosine / pi; a fitted lobe's is below the
// table's envelope, a / (b + 1 - cos delta)^2 at the angle delta from the mirror direction, times the sine of
// the elevation above the lobe's horizon (LobeHorizon in Rust).
//
// Below. What Lambert's lobe alone reflects of a light that is wholly above the surface: the least solid
// angle times the least cosine, by the same inequality of Jensen's with 1 / x^2. A sphere's is r^2 h / D^3,
// with the height of its center.

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

// The least and the largest contribution of a light with bounds.
vec2 tile_contribution(TileReflection reflection, TileLight light, TileLightHeights heights, TileSpan span) {
    vec3 cosines = clamp(vec3(heights.surface.y, heights.lobe, heights.mirror) * span.per_distance, 0.0, 1.0);
    cosines = span.is_apart ? cosines : vec3(1.0);
    float reflected = reflection.diffuse.y * min(span.solid_angle.y * cosines.x / TILE_PI, 1.0)
                    + lobe_contribution(reflection.glossy, span.solid_angle.y, cosines.yz);
    if (AREALIGHT_HAS_COAT && reflection.coat.albedo != 0.0) {
        vec2 coat_cosines = span.is_apart ? clamp(heights.coat * span.per_distance, 0.0, 1.0) : vec2(1.0);
        reflected += lobe_contribution(reflection.coat, span.solid_angle.y, coat_cosines);
    }
    float least_height = max(heights.surface.x, 0.0); // none where it is not wholly above the surface
    float least = reflection.diffuse.x / TILE_PI * span.solid_angle.x * (least_height * span.per_far);
    return light.radiance * vec2(least / TILE_ROUNDING, reflected * TILE_ROUNDING);
}

#endif
