#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Traces the shadow rays that the shade kernel picked a light and a lobe for: each is drawn from that lobe
// over that light, so that its visibility is an unbiased estimate of what arrives of the pixel's unshadowed
// radiance.

#include "shadow_resources.glsl"

#include "table_image.glsl"
#include "light_textures.glsl"
#include "arealight/material.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "arealight/shadows/sequence.glsl"
#define PICKS_ACCESS readonly
#include "shadow_picks.glsl"
#include "picked_light.glsl"
#include "shaping.glsl"

#include "blocker_bridge.glsl"

// The pixel's lobe that a ray of its specular pick is drawn from: where there are several, by what each
// reflects of the light.
int chosen_lobe(ArealightPoint point, PickedLight light, inout float random) {
    if (!AREALIGHT_HAS_COAT && !AREALIGHT_HAS_SHEEN && !AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
        return AREALIGHT_LOBE_SPECULAR;
    }
    int chosen = AREALIGHT_LOBE_SPECULAR;
    float sum = 0.0;
    for (int lobe = AREALIGHT_LOBE_SPECULAR; lobe < AREALIGHT_LOBE_END; lobe++) {
        if (arealight_has_lobe(lobe)) {
            ArealightLobe fitted = arealight_lobe_at(point, lobe);
            float weight = arealight_luminance(fitted.albedo)
                * picked_light_weight(light, fitted.space * point.to_frame);
            if (weight > 0.0 && arealight_choose(random, sum, weight)) {
                chosen = lobe;
            }
        }
    }
    return chosen;
}

// The offset to a pixel's neighbour along an axis, of the two the nearer one.
vec3 offset_along(ivec2 pixel, ivec2 size, ivec2 axis, vec3 position) {
    vec3 nearest = vec3(0.0);
    float least = 3e38;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 neighbour = pixel + side * axis;
        vec3 there;
        if (all(greaterThanEqual(neighbour, ivec2(0))) && all(lessThan(neighbour,
                                                                       size)) && load_position(neighbour,
                                                                                               size, there)) {
            vec3 offset = there - position;
            if (dot(offset, offset) < least) {
                least = dot(offset, offset);
                nearest = float(side) * offset;
            }
        }
    }
    return nearest;
}

// The normal of the surface's geometry towards the viewer: across its neighbours' positions; the shading
// normal where those are of another surface.
vec3 geometric_normal(ivec2 pixel, ivec2 size, ArealightSurface surface) {
    vec3 shading = arealight_normalize_or(surface.normal, vec3(0.0, 0.0, 1.0));
    vec3 across = cross(offset_along(pixel, size, ivec2(1, 0), surface.position),
                        offset_along(pixel, size, ivec2(0, 1), surface.position));
    vec3 normal = arealight_normalize_or(across, shading);
    normal = dot(normal, shading) < 0.0 ? -normal : normal;
    normal = dot(normal, shading) < 0.7 ? shading : normal;
    return dot(normal, surface.view) < 0.0 ? -normal : normal;
}

// By how much a position may be wrong beyond its own rounding: by that of its triangle's vertices, whose
// coordinates are taken to be as large as the camera is far, 32 units in the last place; from depth, by one
// of depth.
float position_step(ivec2 pixel, ivec2 size, vec3 position) {
    float rounding = 3.814697265625e-6 * camera_distance(position);
    if (POSITION_SOURCE != POSITION_FROM_DEPTH) {
        return rounding;
    }
    float depth = texelFetch(g_position, pixel, 0).x;
    return max(rounding, distance(position_at_depth(pixel, size, depth * (1.0 - 1.1920929e-7)), position));
}

// How wide the penumbra of a blocker is, by the part of a ray that is before it. A lobe narrower than the
// light makes it no wider than the lobe.
float penumbra_width(PickedLight light, float part, float distance, float alpha) {
    float size = min(light.size, 2.0 * distance * alpha);
    return min(size * part / max(1.0 - part, 1e-3), size * 16.0);
}

// The outline of a light's opening from a point, if that is beyond it and looks smaller than the light.
bool smaller_opening(ArealightGpuLight record, vec3 position, out ArealightShadowOutline outline) {
    uint row = shaping_rows(record).y;
    if (!AREALIGHT_HAS_OPENINGS || row == AREALIGHT_NO_ROW) {
        return false;
    }
    vec3 center = arealight_bridge_profile(row).xyz - position;
    vec3 axis_u = arealight_bridge_profile(row + 1u).xyz;
    vec3 axis_v = arealight_bridge_profile(row + 2u).xyz;
    outline = arealight_rectangle_outline(center, axis_u, axis_v);
    vec3 to_light = record.center - position;
    vec2 distances = vec2(length(center), length(to_light));
    vec2 heights = vec2(4.0 * dot(cross(axis_u, axis_v), center),
                        abs(dot(record.normal, to_light)) * record.area * record.radius * record.radius);
    vec2 sizes = heights / (distances * distances * distances);
    return arealight_opening_height(row, 0u, position) > 0.0 && sizes.x < sizes.y;
}

// Of a light with a profile, the box in its plane that holds what of it a point is within the cone of: about
// the foot of the perpendicular from the point, along the light's first edge. False where the profile has no
// cone, or the box has six tenths of the light's own: places over the outline meet it as well then.
bool box_in_cone(ArealightGpuLight record, vec3 position, out ArealightShadowOutline outline) {
    uint row = shaping_rows(record).x;
    if (!AREALIGHT_HAS_PROFILES || row == AREALIGHT_NO_ROW || arealight_bridge_profile(row).x <= 1.0) {
        return false;
    }
    vec3 to_light = record.center - position;
    uint first = record.first_vertex;
    vec3 edge = arealight_bridge_vertex(first + 1u) - arealight_bridge_vertex(first);
    vec3 along = arealight_normalize_or(edge, vec3(1.0, 0.0, 0.0));
    vec3 across = cross(record.normal, along);
    vec2 low = vec2(1e30);
    vec2 high = vec2(-1e30);
    for (uint index = 0u; index < record.vertex_count; index++) {
        vec3 vertex = arealight_bridge_vertex(first + index);
        vec2 place = vec2(dot(vertex, along), dot(vertex, across));
        low = min(low, place);
        high = max(high, place);
    }
    vec2 foot = -vec2(dot(to_light, along), dot(to_light, across));
    float reach = abs(dot(to_light, record.normal)) * inversesqrt(arealight_bridge_profile(row).x - 1.0);
    vec2 from = max(low, foot - reach);
    vec2 to = min(high, foot + reach);
    vec2 middle = 0.5 * (from + to);
    vec2 half_size = 0.5 * max(to - from, 0.0);
    vec3 center = to_light + middle.x * along + middle.y * across;
    outline = arealight_rectangle_outline(center, half_size.x * along, half_size.y * across);
    return half_size.x * half_size.y < 0.15 * (high.x - low.x) * (high.y - low.y);
}

// The mean of a piece of a light's image, of `part` of its side about a place, as a part of the light's
// radiance. A little of the whole mean is everywhere: a level has no texel for what is small in it.
float image_factor(ArealightImage image, vec2 at, float part) {
    float top = log2(float(arealight_bridge_light_texture_side()));
    vec2 middle = image.low + 0.5 * image.size;
    vec2 there = image.low + clamp(at, 0.0, 1.0) * image.size;
    vec3 mean = arealight_bridge_light_texture(image.layer, 0u, middle, top).rgb;
    vec3 texel = arealight_bridge_light_texture(image.layer, 0u, there, max(top + log2(part), 0.0)).rgb;
    return arealight_luminance(texel + 0.01 * mean);
}

// Texels to a side of what a light's image is drawn by.
const float IMAGE_SIDE = 8.0;

// The same of such a texel about a place in the light's plane, from its center; of no image 1.
float texel_factor(ArealightImage image, vec3 place) {
    if (!AREALIGHT_HAS_TEXTURED_POLYGONS || image.layer == AREALIGHT_NO_IMAGE) {
        return 1.0;
    }
    vec3 normal = cross(image.axis_u, image.axis_v);
    vec3 from = place - image.corner;
    vec2 at = vec2(dot(from, cross(image.axis_v, normal)), dot(from, cross(normal, image.axis_u)))
            / max(dot(normal, normal), 1e-37);
    return image_factor(image, at, 1.0 / IMAGE_SIDE);
}

// One of the 8 x 8 texels that a light's image casts shadows by, chosen by its radiance and its form factor:
// of 4 x 4 one, then of the four in it. Those whose middle is beyond the light's outline have little of it.
ArealightShadowOutline image_texel(ArealightGpuLight record, vec3 to_light, mat3 to_space,
                                   inout float choice) {
    ArealightImage image = load_image(record);
    vec2 low = vec2(0.0);
    float part = 1.0;
    ArealightShadowOutline chosen;
    for (uint side = 4u; side >= 2u; side -= 2u) {
        part /= float(side);
        vec2 first = low;
        float sum = 0.0;
        for (uint index = 0u; index < side * side; index++) {
            vec2 corner = first + part * vec2(index % side, index / side);
            vec2 at = corner + 0.5 * part;
            vec3 center = image.corner + at.x * image.axis_u + at.y * image.axis_v;
            ArealightShadowOutline texel = arealight_rectangle_outline(
                to_light + center, 0.5 * part * image.axis_u, 0.5 * part * image.axis_v);
            float weight = image_factor(image, at, part) * arealight_outline_weight(texel, to_space)
                * (is_in_light(record, center) ? 1.0 : 0.1);
            bool is_chosen = weight > 0.0 && arealight_choose(choice, sum, weight);
            if (index == 0u || is_chosen) {
                chosen = texel;
                low = corner;
            }
        }
    }
    return chosen;
}

// Some light has places that shine brighter towards a point than others.
const bool HAS_UNEVEN = HAS_SHAPED || AREALIGHT_HAS_TEXTURED_POLYGONS;

bool is_uneven(ArealightGpuLight record) {
    return (HAS_SHAPED && (record.flags & LIGHT_SHAPED) != 0u)
        || (AREALIGHT_HAS_TEXTURED_POLYGONS && record.texture_layer != NO_LIGHT_TEXTURE);
}

// A ray over an outline; to a light with a profile, an opening or an image, of several to where it shines, or
// through all of the opening, one, by the factor of what they meet. The light's `size` becomes that of what
// the opening or the profile's cone shows.
bool draw_ray(uint pick, ArealightShadowOutline outline, ArealightPoint point, mat3 space, vec2 random,
              inout float size, out ArealightShadowRay ray) {
    if (!HAS_UNEVEN) {
        return arealight_draw_ray(outline, point.to_frame, space, random, ray);
    }
    uint light = (pick & PICK_SHAPE) == 0u ? pick & PICK_INDEX : 0u;
    bool uneven = (pick & PICK_SHAPE) == 0u && is_uneven(lights[light]);
    float choice = fract(dot(random, vec2(37.31, 91.73)));
    bool through = false;
    bool is_opened = AREALIGHT_HAS_OPENINGS && uneven && (lights[light].flags & LIGHT_OPENING) != 0u;
    if (uneven) {
        ArealightGpuLight record = lights[light];
        ArealightShadowOutline smaller;
        through = smaller_opening(record, point.position, smaller)
            || box_in_cone(record, point.position, smaller);
        if (through) {
            outline = smaller;
            float area = 2.0 * length(cross(outline.axis_u, outline.axis_v));
            vec3 to_light = record.center - point.position;
            size = min(size, sqrt(area) * length(to_light) / max(length(outline.center), 1e-37));
        } else if (AREALIGHT_HAS_TEXTURED_POLYGONS && !is_opened
                   && record.texture_layer != NO_LIGHT_TEXTURE) {
            vec3 to_light = record.center - point.position;
            outline = image_texel(record, to_light, space * point.to_frame, choice);
            through = true;
        }
    }
    float sum = 0.0;
    bool is_drawn = false;
    int candidates = uneven ? 8 : 0;
    int chosen = 0;
    // At last the one that was chosen once more
    for (int index = 0; index <= candidates; index++) {
        // Spread over the light: the sequence of the plastic number
        int number = index < candidates ? index : chosen;
        vec2 place = fract(random + float(number) * vec2(0.75487767, 0.56984029));
        is_drawn = arealight_draw_ray(outline, point.to_frame, space, place, ray);
        if (uneven && is_drawn) {
            ArealightGpuLight record = lights[light];
            vec3 to_light = record.center - point.position;
            float height = dot(record.normal, to_light) / dot(record.normal, ray.direction);
            ray.distance = through ? clamp(height, 0.0, 1e30) : ray.distance;
            vec3 offset = ray.distance * ray.direction;
            float factor = shaping_factor(record, record.normal, point.position, offset)
                * texel_factor(load_image(record), offset - to_light);
            factor = through && !is_in_light(record, offset - to_light) ? 0.0 : factor;
            if (index < candidates && factor > 0.0 && arealight_choose(choice, sum, factor)) {
                chosen = index;
            }
        }
    }
    // Where none meets what shines the first one stands for all, but not where it would meet what an opening
    // is in
    return is_drawn && (!is_opened || sum > 0.0);
}

// What a ray finds: in x 1 if it arrives, else 0, and the width of the penumbra in y.
vec2 traced(uint pick, ArealightPoint point, float alpha, vec3 origin, vec2 random) {
    PickedLight light = picked_light(pick, point.position);
    bool is_specular = (pick & PICK_SPECULAR) != 0u;
    int lobe = is_specular ? chosen_lobe(point, light, random.x) : AREALIGHT_LOBE_DIFFUSE;
    mat3 space = arealight_lobe_at(point, lobe).space;
    ArealightShadowOutline outline = chosen_outline(light, space * point.to_frame, random.x);
    ArealightShadowRay ray;
    if (!draw_ray(pick, outline, point, space, random, light.size, ray)) {
        return vec2(1.0, 0.0);
    }
    turn_to_side(light, outline, ray);
    // What is below the surface does not arrive; where its geometry is above its shading, the ray meets it
    if ((point.to_frame * ray.direction).z <= 0.0) {
        return vec2(0.0);
    }
    // From the origin, which is not the position, to the same place of the light
    vec3 way = ray.distance * ray.direction + (point.position - origin);
    float distance = max(length(way), 1e-37);
    float end = distance * AREALIGHT_RAY_PART;
    float blocker = arealight_bridge_blocker(origin, way / distance, end);
    bool is_hidden = blocker < end;
    float width = penumbra_width(light, blocker / distance, distance, is_specular ? alpha : 1e9);
    return vec2(is_hidden ? 0.0 : 1.0, is_hidden ? width : 0.0);
}

vec4 pixel_shadow(ivec2 pixel, ivec2 size) {
    vec3 position;
    uint picks = pixel_picks(pixel, size);
    if (!load_position(pixel, size, position) || shadow_picks[ray_pick(picks, 0)] == NO_PICK) {
        return vec4(0.0);
    }
    ArealightSurface surface = load_seen_surface(pixel, position);
    if (IS_TRANSMITTED) {
        surface = arealight_other_side(surface);
    }
    ArealightPoint point = arealight_point(surface);
    vec3 normal = geometric_normal(pixel, size, surface);
    vec3 origin = arealight_ray_origin(position, normal, position_step(pixel, size, position));
    float alpha = surface.roughness * surface.roughness;
    vec2 sum = vec2(0.0);
    uint hidden = 0u;
    for (int ray = 0; ray < SHADOW_RAYS; ray++) {
        vec2 random = arealight_sequence_2d(uvec2(pixel), constants.seed * uint(SHADOW_RAYS) + uint(ray));
        vec2 found = traced(shadow_picks[ray_pick(picks, ray)], point, alpha, origin, random);
        sum += found;
        hidden |= found.x > 0.0 ? 0u : 1u << uint(ray);
    }
    sum /= float(SHADOW_RAYS);
    // No half is larger; a width of so many distances to the camera is the whole picture's anyway
    float width = min(sum.y / camera_distance(position), 6e4);
    return vec4(sum.x, width, float(1u + hidden), float(SHADOW_RAYS));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(constants.size);
    if (all(lessThan(pixel, size))) {
        imageStore(shadow_image, pixel, pixel_shadow(pixel, size));
    }
}
