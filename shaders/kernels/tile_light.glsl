#ifndef TILE_LIGHT_GLSL
#define TILE_LIGHT_GLSL

// A frame's lights, as they are tested against the bounds of a tile. The including kernel has the bounds:
// tile_position, tile_distance, and tile_origin, which positions are relative to.
//
// Margins: 1e-5 of the distances, which is a hundred times what positions and planes are rounded by, and 1e-3
// of the radius for lights that are flat to 1e-4 of it.

#include "shaping.glsl"
#include "tile_bounds.glsl"

TileBox tile_position();
float tile_distance(); // the largest from the origin
vec3 tile_origin();

const float MARGIN = 1e-5;

// The lights of a frame, polygons and then shapes.
uint light_total() {
    return light_count() + (HAS_SHAPES ? shape_count() : 0u);
}

float sum_of(vec3 radiance) {
    return radiance.x + radiance.y + radiance.z;
}

TileLight polygon_light(uint index) {
    ArealightGpuLight record = lights[index];
    bool is_flat = (record.flags & LIGHT_FLAT) != 0u;
    TileLight light;
    light.center = record.center;
    light.radius = record.radius;
    light.normal = is_flat ? record.normal : vec3(0.0);
    light.two_sided = (EFFECTS & EFFECT_TWO_SIDED) != 0u && (record.flags & LIGHT_TWO_SIDED) != 0u;
    light.radiance = sum_of(record.radiance);
    light.area = record.area * (record.radius * record.radius);
    light.least = light.area;
    if (HAS_SHAPED && (record.flags & LIGHT_SHAPED) != 0u) {
        light.least = 0.0;
    }
    light.links = HAS_LINKS ? light_links(record.flags) : 0u;
    // What an image shows may be brighter than the light, or black
    bool has_image = (EFFECTS & EFFECT_TEXTURED) != 0u && record.texture_layer != NO_LIGHT_TEXTURE;
    light.over_half_vectors = AREALIGHT_HAS_HALF_VECTORS && !has_image;
    light.is_bounded = light.normal != vec3(0.0) && !has_image && !light.over_half_vectors;
    return light;
}

TileLight shape_light(uint index) {
    ArealightGpuShape shape = shapes[index];
    TileLight light;
    light.center = shape.center;
    light.radius = shape.radius;
    light.normal = vec3(0.0);
    light.two_sided = (shape.flags & SHAPE_TWO_SIDED) != 0u;
    light.radiance = sum_of(shape.radiance);
    light.area = TILE_PI * (shape.radius * shape.radius);
    light.least = light.area;
    light.links = HAS_LINKS ? light_links(shape.flags) : 0u;
    light.over_half_vectors = false;
    light.is_bounded = true;
    if (shape.kind == SHAPE_DISK) {
        vec3 area = cross(shape.axis_u, shape.axis_v);
        light.normal = arealight_normalize_or(area, vec3(0.0));
        light.area = TILE_PI * sqrt(dot(area, area));
        light.least = light.area;
        bool has_image = (EFFECTS & EFFECT_TEXTURED_ELLIPSE) != 0u && shape.detail != NO_LIGHT_TEXTURE;
        light.is_bounded = light.normal != vec3(0.0) && !has_image;
    } else if (shape.kind == SHAPE_TUBE) {
        // Half of a capsule's surface; those with flat ends or none have less
        float half_length = sqrt(dot(shape.axis_u, shape.axis_u));
        light.radius += half_length;
        light.area = 2.0 * TILE_PI * shape.radius * light.radius;
        light.least = 0.0;
    }
    return light;
}

// Whether all of a tile is outside of the cone of a light with a profile, within an angle of its normal;
// `before`: how far its farthest pixel is before the light's center.
bool is_outside_cone(uint index, TileLight light, float before) {
    uint flags = lights[index].flags;
    if ((flags & LIGHT_PROFILE) == 0u || light.two_sided || light.normal == vec3(0.0)) {
        return false;
    }
    TileBox position = tile_position();
    vec3 side = max(max(position.low - light.center, light.center - position.high), vec3(0.0));
    float nearest = sqrt(dot(side, side)) - light.radius - light.margin;
    float highest = before + TILE_FLATNESS * light.radius + light.margin;
    return nearest > 0.0 && highest < float(flags >> 16) * (1.0 / 65535.0) * nearest;
}

// Whether an opening hides a light from all of a tile.
bool is_outside_opening(uint index, float margin) {
    uint flags = lights[index].flags;
    if ((flags & LIGHT_OPENING) == 0u) {
        return false;
    }
    uint opening = lights[index].shaping;
    bool is_housed = arealight_bridge_profile(opening).w != 0.0;
    bool is_outside = false;
    for (uint plane = 0u; plane <= 4u; plane++) {
        vec4 row = arealight_bridge_profile(opening + AREALIGHT_OPENING_PLANES + plane);
        vec2 heights = box_dot(tile_position(), row.xyz) + (dot(row.xyz, tile_origin()) - row.w);
        if (plane == 0u && !is_housed && heights.x < margin) {
            return false;
        }
        is_outside = is_outside || heights.y < -margin;
    }
    return is_outside;
}

// A light of the frame, as the pixels of the tile have it before them.
TileLight tile_light(uint index) {
    TileLight light;
    if (!HAS_SHAPES || index < light_count()) {
        light = polygon_light(index);
    } else {
        light = shape_light(index - light_count());
    }
    // Not every surface of the tile may have it
    light.least = light.links != 0u ? 0.0 : light.least;
    light.center -= tile_origin();
    light.distance = sqrt(dot(light.center, light.center)) + tile_distance();
    light.margin = MARGIN * (light.distance + light.radius);
    return light;
}

// The range of how far the tile is behind a light's center, along its normal: negative in front of it.
vec2 tile_behind(TileLight light) {
    return vec2(dot(light.normal, light.center)) - box_dot(tile_position(), light.normal).yx;
}

// Whether a light shines to no point of a tile: `behind` is where that is of it.
bool is_turned_away(uint index, TileLight light, vec2 behind) {
    bool is_behind = light.normal != vec3(0.0) && !light.two_sided
                  && behind.x > TILE_FLATNESS * light.radius + light.margin;
    if (is_behind || !HAS_SHAPED || index >= light_count()) {
        return is_behind;
    }
    return is_outside_cone(index, light, -behind.x)
        || (AREALIGHT_HAS_OPENINGS && is_outside_opening(index, light.margin));
}

// Where a light is from the points of a tile, and the least and the most of its solid angle.
//
// It is at most area times cosine over the square of the distance, and 2 pi. A sphere's is at most that of a
// disk of its radius that faces the point at the sphere's nearest point: 2 (1 - cos a) <= tan(a)^2 <= r^2 /
// (D - r)^2 where sin a = r / D. Of a tube no point sees more than half of the surface: of two points
// opposite to each other about its center, one at most.
//
// All points of a flat light are as far in front of a point, f: it is area f times the mean over the area of
// 1 / d^3, d being the distance. That is at least 1 / (D^2 + radius^2)^1.5, for the distance D of its center,
// which is that of its area: 1 / x^1.5 is convex (Jensen's inequality), and the mean of d^2 is D^2 and that
// of the squares about the center. A sphere's is at least pi r^2 / D^2.
struct TileSpan {
    float per_distance; // the inverse of the least distance of a point of it
    float per_far;      // of the largest of its center, and its radius
    bool is_apart;      // whether no point is within its radius
    vec2 solid_angle;
};

TileSpan tile_span(TileLight light, vec2 behind) {
    vec3 to_low = tile_position().low - light.center;
    vec3 to_high = tile_position().high - light.center;
    vec3 near = max(max(to_low, -to_high), vec3(0.0));
    vec3 far = max(abs(to_low), abs(to_high));
    float nearest = sqrt(dot(near, near)) - light.radius - light.margin;
    float farthest = sqrt(dot(far, far)) + light.margin;
    bool is_flat = light.normal != vec3(0.0);
    TileSpan span;
    span.per_distance = 1.0 / max(nearest, 1e-30);
    span.per_far = inversesqrt(farthest * farthest + light.radius * light.radius);
    span.is_apart = nearest > 0.0;

    float off_plane = max(abs(behind.x), abs(behind.y)) + TILE_FLATNESS * light.radius + light.margin;
    float most_cosine = is_flat ? min(off_plane * span.per_distance, 1.0) : 1.0;
    float most = min((light.area * span.per_distance) * (most_cosine * span.per_distance), 2.0 * TILE_PI);

    float front = light.two_sided ? max(max(behind.x, -behind.y), 0.0) : max(-behind.y, 0.0);
    front = max(front - TILE_FLATNESS * light.radius - light.margin, 0.0);
    float least_cosine = is_flat ? front * span.per_far : 1.0;
    float least = light.least * span.per_far * span.per_far * least_cosine;
    span.solid_angle = vec2(least, span.is_apart ? most : 2.0 * TILE_PI);
    return span;
}

#endif
