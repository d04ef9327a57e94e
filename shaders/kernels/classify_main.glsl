#ifndef CLASSIFY_MAIN_GLSL
#define CLASSIFY_MAIN_GLSL

// Sorts tiles of 8 x 8 pixels into classes by the lights that matter to them: an item a
// tile. It goes over the tile's pixels once, for bounds of what they are, and holds each light against the bounds, not
// the pixels. Nothing is shared. What is found holds for every pixel of the tile:
//
// - A light is left out where it is nothing to each lobe: it is wholly below the lobe's horizon, or the pixel is behind
//   a light of one side.
// - With CULL lights are left out too which together send less than the fraction `negligible` of what the others do, from each
//   pixel, in the sum of the channels (tile_reach.glsl).
// - Shapes have no lists: a tile is shaded by all of them, if one of them reaches it.
//
// Horizons. Lambert's is the surface. That of a fitted lobe is a plane through the point as well: its normal is
// proportional to mirror + q across (table.glsl), with the ratio q = z / w of the texel that the table gives. With p = q / sin,
// and the unit normal n, the unit vector v to the viewer and the cosine c between them, that normal is
//
//     (2 c + p (1 - 2 c^2)) n + (p c - 1) v.
//
// LobeHorizons holds the least and the largest p of each cell of the table for both of its lobes; a mixture of the two, by
// the reflectance, has a weighted mean of theirs. So the table is not read here. The planes of a tile are held by the box of
// their normals and by the range of their offsets, which makes them sharp on a flat floor however far it reaches; what p leaves
// open is a spread of the normals.
//
// Margins: 1e-5 of the distances, which is a hundred times what positions and planes are rounded by, and 1e-3 of
// the radius for lights that are flat to 1e-4 of it. Comparisons are such that NaN clips, and leaves nothing out.

layout(local_size_x = 32) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 14) const uint CULL = 0u; // whether lights are left out that send little

#define LIGHTS_BINDING 1
#define SHAPES_BINDING 2
#define G_BUFFER_BINDING 3
#define G_BUFFER_LAYOUT LAYOUT
#define TILE_LISTS_BINDING 7
#define TILE_LISTS_ACCESS
#include "g_buffer.glsl"
#include "light_records.glsl"
#include "shape_buffer.glsl"
#include "tile_reach.glsl"
#include "tiles.glsl"
#include "position.glsl"

// What the kernel knows of a cell of the table: LobeHorizon in Rust.
struct ArealightGpuLobeHorizon {
    vec2 lobe;     // the least and the largest p of the lobe without Fresnel term
    vec2 schlick;  // of the lobe of Schlick's weight
    vec2 weight;   // what a mixture of the two is weighed by, its ends
    vec2 envelope; // tile_reach.glsl
    float schlick_albedo;
    float reserved0;
    float reserved1;
    float reserved2;
};

layout(set = 0, binding = 0, std430) readonly buffer LobeHorizons {
    ArealightGpuLobeHorizon lobe_horizons[];
};

const float MARGIN = 1e-5;

const bool HAS_DIFFUSE = (EFFECTS & AREALIGHT_EFFECT_DIFFUSE) != 0u;
const bool HAS_SHAPES = (EFFECTS & ANY_SHAPE) != 0u;
const bool HAS_GLOSSY = (EFFECTS & AREALIGHT_EFFECT_GLOSSY) != 0u;
// Whether the horizon of the glossy lobe can be known: the table's cells say nothing of the formula's.
const bool HAS_HORIZON = HAS_GLOSSY && LOBES != AREALIGHT_LOBES_FORMULA;

// What is known of a tile's pixels. Positions are relative to the camera.
struct TileBounds {
    bool has_surface;
    bool is_known;   // else some pixel's numbers are none: nothing below holds
    bool has_lobe;   // the horizon of every pixel's glossy lobe is known
    bool is_diffuse; // some diffuse albedo is not zero
    TilePlanes surface;
    TilePlanes lobe;
    TileBox position;
    float distance;  // the largest, to the camera
    TileReflection reflection; // with CULL alone
};

// The cell of the table that a surface is looked up in.
ArealightGpuLobeHorizon lobe_horizon(ArealightSurface surface, float cosine) {
    float smallest = sqrt(AREALIGHT_MIN_ALPHA);
    float roughness = surface.roughness > smallest ? min(surface.roughness, 1.0) : smallest;
    float cells = float(constants.horizon_cells);
    vec2 cell = clamp(floor(vec2(roughness, sqrt(max(1.0 - cosine, 0.0))) * cells), vec2(0.0), vec2(cells - 1.0));
    return lobe_horizons[uint(cell.y) * constants.horizon_cells + uint(cell.x)];
}

// The range of p for a surface.
vec2 horizon_range(ArealightSurface surface, ArealightGpuLobeHorizon horizon) {
    // What part of the ratio Schlick's lobe has, by arealight_schlick_share and the lobes' heights
    vec2 part = vec2(0.0, 1.0);
    if (FRESNEL == AREALIGHT_FRESNEL_BY_F0) {
        float mean = dot(surface.f0, vec3(1.0 / 3.0));
        vec2 weight = (surface.f90 - mean) * horizon.weight;
        part = mean >= 0.0 && surface.f90 > mean ? weight / (mean + weight + 1e-30) : vec2(0.0, mean <= 1.0 ? 0.0 : 1.0);
    }
    vec4 ends = mix(vec4(horizon.lobe, horizon.lobe), vec4(horizon.schlick, horizon.schlick), part.xxyy);
    return vec2(min(ends.x, ends.z), max(ends.y, ends.w));
}

// Adds what is known of a pixel's glossy lobe: its horizon, and what it reflects at most.
void add_lobe(inout TileBounds bounds, ArealightSurface surface, vec3 normal, vec3 view, vec3 position) {
    float cosine = dot(normal, view);
    ArealightGpuLobeHorizon cell = lobe_horizon(surface, cosine);
    vec2 range = horizon_range(surface, cell);
    // The cells say nothing of views from below. NaN, of a cell without a horizon, gets through no comparison
    bounds.has_lobe = bounds.has_lobe && cosine > 0.0 && range.y - range.x < TILE_FAR;
    float p = 0.5 * (range.x + range.y);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float scale = inversesqrt(1.0 + p * p * sine * sine);
    vec3 horizon = (normal * (2.0 * cosine + p * (1.0 - 2.0 * cosine * cosine)) + view * (p * cosine - 1.0)) * scale;
    tile_planes_add(bounds.lobe, horizon, dot(horizon, position), 0.5 * (range.y - range.x) * sine);

    if (CULL != 0u) {
        vec3 mirror = 2.0 * cosine * normal - view;
        tile_planes_add(bounds.reflection.mirror, mirror, dot(mirror, position), 0.0);
        // What is left of a lobe above the surface is more than half of it, and has all of its albedo
        float gain = HORIZON == AREALIGHT_HORIZON_BOTH ? 2.0 : 1.0;
        bounds.reflection.envelope.x = max(bounds.reflection.envelope.x, cell.envelope.x * gain);
        bounds.reflection.envelope.y = min(bounds.reflection.envelope.y, cell.envelope.y);
        // The F0 part's albedo is at most 1
        vec3 albedo = surface.f0 + max(vec3(surface.f90) - surface.f0, vec3(0.0)) * cell.schlick_albedo;
        bounds.reflection.glossy = max(bounds.reflection.glossy, arealight_max_component(albedo));
    }
}

void add_pixel(inout TileBounds bounds, ivec2 pixel) {
    vec3 position;
    if (any(greaterThanEqual(pixel, ivec2(constants.size))) || !load_position(pixel, ivec2(constants.size), position)) {
        return;
    }
    ArealightSurface surface = load_surface(pixel, position, constants.camera, EFFECTS);
    vec3 normal = arealight_normalize_or(surface.normal, vec3(0.0, 0.0, 1.0));
    float distance = sqrt(dot(surface.view, surface.view));
    position = -surface.view;
    bounds.has_surface = true;
    bounds.is_known = bounds.is_known && distance > 0.0 && distance < TILE_FAR;
    bounds.distance = max(bounds.distance, distance);
    bounds.position.low = min(bounds.position.low, position);
    bounds.position.high = max(bounds.position.high, position);
    tile_planes_add(bounds.surface, normal, dot(normal, position), 0.0);
    if (HAS_HORIZON) {
        add_lobe(bounds, surface, normal, surface.view / distance, position);
    }
    if (HAS_DIFFUSE) {
        vec3 albedo = surface.diffuse_albedo;
        bounds.is_diffuse = bounds.is_diffuse || albedo != vec3(0.0);
        if (CULL != 0u) {
            bounds.reflection.diffuse.x = min(bounds.reflection.diffuse.x, min(albedo.r, min(albedo.g, albedo.b)));
            bounds.reflection.diffuse.y = max(bounds.reflection.diffuse.y, arealight_max_component(albedo));
        }
    }
}

TileBounds tile_bounds(ivec2 corner) {
    TileBox nothing = TileBox(vec3(TILE_FAR), vec3(-TILE_FAR));
    TileBounds bounds = TileBounds(false, true, HAS_HORIZON || !HAS_GLOSSY, false, tile_planes_begin(),
                                   tile_planes_begin(), nothing, 0.0, tile_reflection_begin());
    if (!HAS_DIFFUSE) {
        bounds.reflection.diffuse = vec2(0.0);
    }
    for (int index = 0; index < TILE_SIDE * TILE_SIDE; index++) {
        add_pixel(bounds, corner + ivec2(index % TILE_SIDE, index / TILE_SIDE));
    }
    return bounds;
}

// Whether some pixel of a tile may need a light.
struct Verdict {
    bool is_needed;
    vec2 reach; // the least and the most that it sends, with CULL alone
};

// A light as a tile sees it, that lies within `radius` of its center; `normal` is zero where it is not flat.
TileLight see(TileBounds bounds, vec3 center, float radius, vec3 normal) {
    TileLight seen = TileLight(center - constants.camera, radius, normal, 0.0, 0.0);
    seen.reach = sqrt(dot(seen.center, seen.center)) + bounds.distance;
    seen.margin = MARGIN * (seen.reach + radius);
    return seen;
}

// How far the pixels are behind a light's center, along its normal.
vec2 distance_behind(TileBounds bounds, TileLight seen) {
    return vec2(dot(seen.normal, seen.center)) - box_dot(bounds.position, seen.normal).yx;
}

Verdict judge_place(TileBounds bounds, TileLight seen, bool two_sided) {
    // A light lights what is in front of it
    bool is_flat = seen.normal != vec3(0.0);
    float behind = distance_behind(bounds, seen).x;
    bool is_behind = is_flat && !two_sided && behind > TILE_FLATNESS * seen.radius + seen.margin;

    TileSide surface = tile_side(bounds.surface, seen);
    bool is_diffuse = HAS_DIFFUSE && bounds.is_diffuse;
    bool is_below = !is_diffuse || surface.below;
    if (HAS_GLOSSY) {
        TileSide lobe = tile_side(bounds.lobe, seen);
        lobe = TileSide(lobe.above && bounds.has_lobe, lobe.below && bounds.has_lobe);
        if (HORIZON == AREALIGHT_HORIZON_BOTH) {
            lobe = TileSide(lobe.above && surface.above, lobe.below || surface.below);
        }
        is_below = is_below && lobe.below;
    }
    return Verdict(!bounds.is_known || !(is_behind || is_below), vec2(0.0, TILE_FAR));
}

Verdict judge(TileBounds bounds, ArealightGpuLight light) {
    bool is_flat = (light.flags & LIGHT_FLAT) != 0u;
    vec3 normal = is_flat ? arealight_normalize_or(light.area, vec3(0.0)) : vec3(0.0);
    bool two_sided = (EFFECTS & AREALIGHT_EFFECT_TWO_SIDED) != 0u && (light.flags & LIGHT_TWO_SIDED) != 0u;
    TileLight seen = see(bounds, light.center, light.radius, normal);
    Verdict verdict = judge_place(bounds, seen, two_sided);
    bool is_dark = light.radiance == vec3(0.0);
    verdict.is_needed = verdict.is_needed && !(is_dark && bounds.is_known);
    if (CULL != 0u) {
        vec2 behind = distance_behind(bounds, seen);
        vec2 sent = tile_reach(bounds.reflection, bounds.surface, bounds.lobe, bounds.position, seen, light, behind, two_sided);
        // What an image shows may be brighter than the light, or black; NaN is neither little nor much
        bool has_image = (EFFECTS & AREALIGHT_EFFECT_TEXTURED) != 0u && light.texture_layer != NO_LIGHT_TEXTURE;
        bool has_bounds = bounds.is_known && bounds.has_lobe && seen.normal != vec3(0.0);
        bool is_sure = has_bounds && !has_image && sent.x >= 0.0 && sent.y < TILE_FAR;
        verdict.reach = is_sure ? sent : verdict.reach;
    }
    return verdict;
}

// Whether a tile needs the shapes.
bool judge_shapes(TileBounds bounds) {
    bool is_needed = false;
    for (uint index = 0u; index < constants.shape_count; index++) {
        ArealightShape shape = load_shape(index, SHAPE_ANY);
        bool is_ellipse = shape.kind == AREALIGHT_SHAPE_ELLIPSE;
        bool is_tube = shape.kind == AREALIGHT_SHAPE_TUBE;
        vec3 normal = is_ellipse ? arealight_normalize_or(cross(shape.axis_u, shape.axis_v), vec3(0.0)) : vec3(0.0);
        float radius = shape.radius + (is_tube ? sqrt(dot(shape.axis_u, shape.axis_u)) : 0.0);
        // Spheres and tubes have no back
        Verdict verdict = judge_place(bounds, see(bounds, shape.center, radius, normal), shape.two_sided);
        is_needed = is_needed || verdict.is_needed;
    }
    return is_needed;
}

// What a light may send at most to be left out: so much that those below it together are negligible beside the rest.
float negligible_reach(TileBounds bounds) {
    if (CULL == 0u) {
        return 0.0;
    }
    // At least as much is sent by all lights
    float least = 0.0;
    for (uint index = 0u; index < constants.light_count; index++) {
        Verdict verdict = judge(bounds, light_record(index));
        least += verdict.is_needed ? verdict.reach.x : 0.0;
    }
    // What is left out is to be a fraction of what stays
    float budget = least * constants.negligible / (1.0 + constants.negligible) / TILE_ROUNDING;

    // How much is sent by the lights below each of sixteen limits
    vec4 limits[4];
    vec4 sums[4];
    for (int place = 0; place < 4; place++) {
        limits[place] = budget / vec4(1.0, 2.0, 4.0, 8.0) / float(1 << (4 * place));
        sums[place] = vec4(0.0);
    }
    for (uint index = 0u; index < constants.light_count; index++) {
        Verdict verdict = judge(bounds, light_record(index));
        float most = verdict.is_needed ? verdict.reach.y : 0.0;
        for (int place = 0; place < 4; place++) {
            sums[place] += mix(vec4(0.0), vec4(most), lessThan(vec4(most), limits[place]));
        }
    }
    float limit = 0.0;
    for (int place = 15; place >= 0; place--) {
        limit = sums[place / 4][place % 4] <= budget ? limits[place / 4][place % 4] : limit;
    }
    return limit;
}

// Writes the list of the lights that a tile needs. The cheapest class that shades it.
uint write_record(TileBounds bounds, uvec2 tile) {
    uint first = tile_record(tile);
    uint quads = 0u;
    uint total = 0u;
    bool has_shapes = HAS_SHAPES && judge_shapes(bounds);
    float negligible = negligible_reach(bounds);
    for (uint index = 0u; index < constants.light_count; index++) {
        Verdict verdict = judge(bounds, light_record(index));
        if (verdict.is_needed && !(verdict.reach.y < negligible)) {
            if (total < constants.capacity) {
                tile_lists[first + TILE_RECORD_HEADER + total] = index;
            }
            total++;
            quads += index < constants.quad_count ? 1u : 0u;
        }
    }
    bool is_listed = total <= constants.capacity;
    tile_lists[first] = is_listed ? quads : TILE_ALL_LIGHTS;
    tile_lists[first + 1u] = is_listed ? total : TILE_ALL_LIGHTS;
    if (!is_listed) {
        return constants.quad_count < constants.light_count ? CLASS_ANY : CLASS_QUADS;
    }
    if (total == 0u && !has_shapes) {
        return CLASS_EMPTY;
    }
    return quads == total ? CLASS_QUADS : CLASS_ANY;
}

// Adds the tile to the list of a class, and a group to the class's dispatch.
void append(uvec2 tile, uint tile_class) {
    uint dispatch = tile_class * TILE_CLASS_WORDS;
    uint place = atomicAdd(tile_lists[dispatch + 3u], 1u);
    tile_lists[class_list(tile_class) + place] = pack_tile(tile);
    atomicMax(tile_lists[dispatch], min(place + 1u, TILE_ROW));
    if (place % TILE_ROW == 0u) {
        atomicAdd(tile_lists[dispatch + 1u], 1u);
    }
}

void main() {
    uint item = gl_GlobalInvocationID.x;
    uvec2 counts = tile_counts();
    if (item >= counts.x * counts.y) {
        return;
    }

    // Find out what the tile's pixels are
    uvec2 tile = uvec2(item % counts.x, item / counts.x);
    TileBounds bounds = tile_bounds(ivec2(tile) * TILE_SIDE);

    // Write down its lights
    uint tile_class = CLASS_EMPTY;
    if (bounds.has_surface) {
        tile_class = write_record(bounds, tile);
    }
    append(tile, tile_class);
}

#endif
