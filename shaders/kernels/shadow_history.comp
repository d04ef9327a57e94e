#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Makes one mean of the shadow rays of frames after one another. How far back it goes is measured: the rays
// of a pixel and its neighbours are coins whose spread is known from their mean, so that what they differ
// from the history by beyond it is change, and shortens the history.

#include "shadow_resources.glsl"
#include "shadow_colors.glsl"
#include "shadow_history.glsl"
#include "shadow_neighbours.glsl"

// 1: the host says where a pixel's point was, in g_motion; else nothing but the camera moves.
layout(constant_id = 17) const int SHADOW_MOTION = 0;

// Where a pixel's point was in the frame before, less where it is, in parts of the image's width and height.
layout(set = 0, binding = MOTION_BINDING) uniform texture2D g_motion;

// The most frames of a mean.
const float MOST_FRAMES = 16.0;
// Pixels to each side that a pixel's rays are compared with, and the standard deviation of their weights.
const int REACH = 6;
const float WIDTH = 3.0;
// Pixels to each side whose change counts as the pixel's.
const int POOL = 2;
// Pixels to a side of what a workgroup loads, and of what it compares.
const int PATCH = 8 + 2 * (REACH + POOL);
const int INNER = 8 + 2 * POOL;
// A pixel of the frame before is of the same surface within this part of the camera's distance out of its
// plane, and this cosine of the normals.
const float SAME_PLANE = 0.01;
const float SAME_NORMAL = 0.9;
// How much more than coins the rays of frames after one another differ: where one frame has too few the next
// has too many, by its numbers.
const float SPREAD = 2.0;
// What is left of the spread of rays that are all alike.
const float LEAST_SPREAD = 1e-5;

// Of each pixel around: the position and what arrives by this frame's rays; (what arrived before, of how many
// frames) as halves; the normal, 0 where there is no light.
shared vec4 patch_texels[PATCH * PATCH];
shared uint patch_before[PATCH * PATCH];
shared uint patch_normals[PATCH * PATCH];
// Of each pixel compared: the squared difference, and the variance that rays alone give it; that is negative
// where there is no history.
shared vec2 differences[INNER * INNER];

// Where a pixel's point was in the image of the frame before, in pixels; false where it was behind the
// camera.
bool place_before(ivec2 pixel, ivec2 size, vec3 position, out vec2 place) {
    if (SHADOW_MOTION != 0) {
        place = vec2(pixel) + 0.5 + texelFetch(g_motion, pixel, 0).xy * vec2(size);
        return true;
    }
    mat4 clip_from_position = mat4(history_head(0u, 1u), history_head(4u, 1u), history_head(8u, 1u),
                                   history_head(12u, 1u));
    vec4 clip = clip_from_position * vec4(position, 1.0);
    place = (0.5 * clip.xy / clip.w + 0.5) * vec2(size);
    return clip.w > 0.0;
}

// A pixel's point and surface in the frame before, to which pixels there are compared.
struct Before {
    vec2 place;    // in pixels
    vec3 position; // relative to that frame's origin
    vec3 normal;
    float tolerance; // out of the surface's plane
};

// Reads the record of a pixel of the frame before; false where that is not of the same surface.
bool load_before(Before before, ivec2 pixel, ivec2 size, out HistoryPixel tap) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) {
        return false;
    }
    tap = load_history(pixel, size, 1u);
    return tap.frames > 0.0 && abs(dot(before.normal, tap.position - before.position)) < before.tolerance &&
           dot(before.normal, tap.normal) > SAME_NORMAL;
}

// Where a point was in the frame before; false where that is behind the camera.
bool find_before(ivec2 pixel, ivec2 size, vec3 position, vec3 normal, out Before before) {
    before.position = position + history_head(16u, 0u).xyz;
    before.normal = normal;
    before.tolerance = SAME_PLANE * camera_distance(position);
    return place_before(pixel, size, before.position, before.place);
}

// What is known of a pixel's point from the frame before: the mean of those of the four pixels around its
// place that are of its surface.
HistoryPixel reprojected(Before before, ivec2 size) {
    HistoryPixel mean = HistoryPixel(vec2(0.0), 0.0, vec3(0.0), vec3(0.0), ShadowColors(0.0));
    vec2 corner = floor(before.place - 0.5);
    vec2 part = before.place - 0.5 - corner;
    float sum = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        HistoryPixel tap;
        if (load_before(before, ivec2(corner) + step, size, tap)) {
            vec2 weights = mix(1.0 - part, part, vec2(step));
            mean.shadow += weights.x * weights.y * tap.shadow;
            mean.frames += weights.x * weights.y * tap.frames;
            mean.colors += weights.x * weights.y * tap.colors;
            sum += weights.x * weights.y;
        }
    }
    float scale = sum > 1e-3 ? 1.0 / sum : 0.0;
    mean.shadow *= scale;
    mean.frames *= scale;
    mean.colors *= scale;
    return mean;
}

// The cubic weights of four pixels in a row, at a part of the way from the second to the third. Source:
// Catmull and Rom 1974.
vec4 cubic_weights(float part) {
    vec2 squares = vec2(part, part * part) * part;
    return 0.5 * vec4(-part + 2.0 * squares.x - squares.y, 2.0 - 5.0 * squares.x + 3.0 * squares.y,
                      part + 4.0 * squares.x - 3.0 * squares.y, squares.y - squares.x);
}

// Makes what is known by the four pixels around, `mean`, that of the sixteen around, which does not widen
// with every frame; held between what the four have. Leaves the four's where some of the sixteen are of
// another surface.
void sharpen(Before before, ivec2 size, inout HistoryPixel mean) {
    vec2 corner = floor(before.place - 0.5);
    vec2 part = before.place - 0.5 - corner;
    vec4 weights_x = cubic_weights(part.x);
    vec4 weights_y = cubic_weights(part.y);
    vec2 sum = vec2(0.0);
    vec2 least = vec2(3e38);
    vec2 most = vec2(0.0);
    ShadowColors colors = ShadowColors(0.0);
    ShadowColors least_colors = ShadowColors(vec3(3e38), vec3(3e38), vec3(3e38), vec3(3e38));
    ShadowColors most_colors = ShadowColors(0.0);
    for (int i = 0; i < 16; i++) {
        ivec2 step = ivec2(i & 3, i >> 2);
        HistoryPixel tap;
        if (!load_before(before, ivec2(corner) + step - 1, size, tap)) {
            return;
        }
        sum += weights_x[step.x] * weights_y[step.y] * tap.shadow;
        colors += weights_x[step.x] * weights_y[step.y] * tap.colors;
        if ((step.x == 1 || step.x == 2) && (step.y == 1 || step.y == 2)) {
            least = min(least, tap.shadow);
            most = max(most, tap.shadow);
            for (int column = 0; column < 4; column++) {
                least_colors[column] = min(least_colors[column], tap.colors[column]);
                most_colors[column] = max(most_colors[column], tap.colors[column]);
            }
        }
    }
    mean.shadow = clamp(sum, least, most);
    for (int column = 0; column < 4; column++) {
        mean.colors[column] = clamp(colors[column], least_colors[column], most_colors[column]);
    }
}

void load_patch(ivec2 corner, ivec2 size) {
    for (int i = int(gl_LocalInvocationIndex); i < PATCH * PATCH; i += 64) {
        ivec2 pixel = corner + ivec2(i % PATCH, i / PATCH);
        vec3 position = vec3(0.0);
        patch_normals[i] = 0u;
        if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)) && load_position(pixel, size,
                                                                                                  position)) {
            vec4 shadow = imageLoad(shadow_image, pixel);
            if (shadow.b > 0.0) {
                vec3 normal = load_normal(pixel, position);
                Before before;
                vec2 known = vec2(shadow.r, 0.0);
                if (find_before(pixel, size, position, normal, before)) {
                    HistoryPixel mean = reprojected(before, size);
                    known = mean.frames > 0.0 ? vec2(mean.shadow.x, mean.frames) : known;
                }
                patch_texels[i] = vec4(position, shadow.r);
                patch_before[i] = packHalf2x16(known);
                patch_normals[i] = pack_normal(normal);
            }
        }
    }
    barrier();
}

// The squared difference of a pixel's rays and history, both means over its neighbours, and the variance of a
// ray's mean there.
vec2 compared(int center, float rays) {
    vec2 before = unpackHalf2x16(patch_before[center]);
    if (patch_normals[center] == 0u || !(before.y > 0.0)) {
        return vec2(0.0, -1.0);
    }
    vec3 position = patch_texels[center].xyz;
    vec3 normal = unpack_normal(patch_normals[center]);
    float scale = plane_scale(position);
    vec4 sums = vec4(0.0); // weights, their squares, this frame's, the history's
    for (int y = -REACH; y <= REACH; y++) {
        for (int x = -REACH; x <= REACH; x++) {
            int i = center + y * PATCH + x;
            if (patch_normals[i] != 0u) {
                float weight = likeness(patch_texels[i].xyz - position, unpack_normal(patch_normals[i]),
                                        normal, scale, float(x * x + y * y) * (0.5 / (WIDTH * WIDTH)));
                sums += weight * vec4(1.0, weight, patch_texels[i].w, unpackHalf2x16(patch_before[i]).x);
            }
        }
    }
    vec2 means = sums.zw / sums.x;
    float difference = means.x - means.y;
    float arrives = (means.x + before.y * means.y) / (1.0 + before.y);
    float variance = arrives * (1.0 - arrives) * sums.y / (rays * sums.x * sums.x) + LEAST_SPREAD;
    return vec2(difference * difference, variance);
}

void compare_patch(float rays) {
    for (int i = int(gl_LocalInvocationIndex); i < INNER * INNER; i += 64) {
        differences[i] = compared((i / INNER + REACH) * PATCH + i % INNER + REACH, rays);
    }
    barrier();
}

// Of how many frames the mean is to be, from 1 on, for a pixel whose history is of `frames`.
float frames_of(ivec2 local, float frames) {
    vec2 sums = vec2(0.0);
    for (int y = 0; y <= 2 * POOL; y++) {
        for (int x = 0; x <= 2 * POOL; x++) {
            ivec2 place = local + ivec2(x, y);
            vec2 found = differences[place.y * INNER + place.x];
            if (found.y >= 0.0) {
                float there = unpackHalf2x16(patch_before[(place.y + REACH) * PATCH + place.x + REACH]).y;
                sums += vec2(found.x - SPREAD * found.y * (1.0 + 1.0 / there), 1.0);
            }
        }
    }
    float change = max(sums.x / max(sums.y, 1.0), 0.0);
    ivec2 center = local + POOL;
    float variance = differences[center.y * INNER + center.x].y;
    float known = change + variance / frames;
    return min(min(1.0 + variance / known, frames + 1.0), MOST_FRAMES);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(constants.size);
    load_patch(ivec2(gl_WorkGroupID.xy) * 8 - (REACH + POOL), size);
    compare_patch(float(SHADOW_RAYS));
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    ivec2 local = ivec2(gl_LocalInvocationID.xy);
    int center = (local.y + REACH + POOL) * PATCH + local.x + REACH + POOL;
    HistoryPixel history = HistoryPixel(vec2(0.0), 0.0, vec3(0.0), vec3(0.0, 0.0, 1.0), ShadowColors(0.0));
    if (patch_normals[center] != 0u) {
        vec3 position = patch_texels[center].xyz;
        vec3 normal = unpack_normal(patch_normals[center]);
        Before before;
        if (find_before(pixel, size, position, normal, before)) {
            history = reprojected(before, size);
            sharpen(before, size, history);
        }
        history.position = position;
        history.normal = normal;
        vec4 now = imageLoad(shadow_image, pixel);
        float frames = history.frames > 0.0 ? frames_of(local, history.frames) : 1.0;
        history.shadow = mix(history.shadow, now.rg, 1.0 / frames);
        history.colors += (pixel_colors(pixel, size, now) - history.colors) * (1.0 / frames);
        history.frames = frames;
    }
    store_history(pixel, size, history);
}
