#ifndef CELL_LIGHTS_GLSL
#define CELL_LIGHTS_GLSL

// The lights of a cell, 8 x 8 froxels of a slice, which a workgroup fills: listed in memory that it shares,
// with MEDIUM_LISTS. What is found holds for every point of the cell:
//
// - A light is left out where none is before it, in the cone of its profile, or beyond its opening.
// - Lights are left out too whose contributions add up to no more than a radiance: at most a solid angle's,
//   times the phase function's most at the angles that there are between the light's and the cell's points,
//   dimmed as over the least distance by the least of the froxels' extinctions. A pixel loses no more than
//   that times the albedo, since what is let through times scattering along a ray adds up to no more.
//
// Where more lights stay than a list holds, the cell has all lights of the frame.

// As lists of tiles know them: arealight::gpu::LightCounts.
uint light_count() {
    return constants.light_count;
}
uint shape_count() {
    return constants.shape_count;
}
uint quad_count() {
    return constants.quad_count;
}

#include "tile_light.glsl"

struct Cell {
    TileBox position; // relative to the camera, as what follows
    vec3 center;
    float radius;     // no point is farther from it
    vec3 away;        // from the camera through the middle
    float spread;     // directions through it differ by as much
    float farthest;   // from the camera
    float extinction; // the least of its froxels
};
Cell cell;

TileBox tile_position() {
    return cell.position;
}
float tile_distance() {
    return cell.farthest;
}
vec3 tile_origin() {
    return constants.camera;
}

// The direction from the camera through a place in the grid's columns.
vec3 column_direction(vec2 column, ivec3 counts) {
    vec4 homogeneous = constants.position_from_clip * vec4(column / vec2(counts.xy) * 2.0 - 1.0, 0.5, 1.0);
    return arealight_normalize_or(homogeneous.xyz / homogeneous.w - constants.camera, vec3(0.0, 0.0, 1.0));
}

// The workgroup's cell. Directions through it are within its corners', on the sphere: they are beyond the
// corners' box by their sagitta at most.
void find_cell(ivec3 counts, float extinction) {
    vec2 first = vec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy);
    float slice = float(gl_WorkGroupID.z);
    float near = slice_distance(slice);
    cell.farthest = slice_distance(slice + 1.0);
    cell.away = column_direction(first + 0.5 * vec2(gl_WorkGroupSize.xy), counts);
    cell.position = TileBox(near * cell.away, near * cell.away);
    float across = 0.0;
    for (uint corner = 0u; corner < 4u; corner++) {
        vec2 place = first + vec2((uvec2(corner) >> uvec2(0u, 1u) & 1u) * gl_WorkGroupSize.xy);
        vec3 direction = column_direction(place, counts);
        vec3 side = direction - cell.away;
        across = max(across, dot(side, side));
        vec3 a = near * direction;
        vec3 b = cell.farthest * direction;
        cell.position.low = min(cell.position.low, min(a, b));
        cell.position.high = max(cell.position.high, max(a, b));
    }
    float sagitta = 0.5 * cell.farthest * across + MARGIN * cell.farthest;
    cell.position.low -= sagitta;
    cell.position.high += sagitta;
    cell.center = 0.5 * (cell.position.low + cell.position.high);
    vec3 half_box = cell.position.high - cell.center;
    cell.radius = sqrt(dot(half_box, half_box));
    cell.spread = sqrt(across);
    cell.extinction = extinction;
}

// The least of the froxels' extinctions.
float least_extinction(float extinction) {
    if (MEDIUM_IMAGE) {
        tile_parts[gl_LocalInvocationIndex] = extinction;
        barrier();
        for (uint place = 0u; place < TILE_PIXELS; place++) {
            extinction = min(extinction, tile_parts[place]);
        }
        barrier();
    }
    return extinction;
}

// The lobes that stand for the phase function are no more than that times this (a test of the oracle's).
const float PHASE_EXCESS = 1.16;

// The most of the phase function between the cell's points and those of a light so far from its center.
float phase_most(TileLight light, vec3 offset, float distance) {
    // Two directions differ by the chord of an angle whose sine is at most radius over distance
    float radius = light.radius + light.margin + cell.radius;
    float spread = cell.spread + (radius < distance ? 1.4143 * radius / distance : 2.0);
    float cosine = dot(offset, cell.away) / max(distance, 1e-30);
    float g = constants.anisotropy;
    float along = min((g < 0.0 ? -cosine : cosine) + spread, 1.0);
    return PHASE_EXCESS * arealight_henyey_greenstein(min(abs(g), AREALIGHT_MAX_ANISOTROPY), along);
}

// For list_lights.glsl.
vec2 contribution(uint index) {
    if (index >= light_total()) {
        return vec2(0.0, -1.0);
    }
    TileLight light = tile_light(index);
    vec2 behind = tile_behind(light);
    if (is_turned_away(index, light, behind) || light.radiance == 0.0) {
        return vec2(0.0, -1.0);
    }
    TileSpan span = tile_span(light, behind);
    float solid_angle = span.is_apart ? span.solid_angle.y : 4.0 * TILE_PI;
    vec3 offset = light.center - cell.center;
    float distance = sqrt(dot(offset, offset));
    float dimmed = exp(-cell.extinction * max(distance - cell.radius, 0.0));
    float most = light.radiance * solid_angle * phase_most(light, offset, distance) * dimmed * TILE_ROUNDING;
    // NaN is neither little nor much
    return vec2(0.0, light.is_bounded && most >= 0.0 ? most : TILE_FAR);
}

float cull_budget(float least) {
    return uintBitsToFloat(constants.slices_cull & 0xffff0000u);
}

const uint CELL_CAPACITY = 1024u;
shared uint cell_lights[CELL_CAPACITY];

#define LISTED(place) cell_lights[place]
#define LIST_CAPACITY CELL_CAPACITY
#include "list_lights.glsl"

// How many quads, polygons and shapes the cell has, and whether they are listed.
struct CellList {
    uint quad_count;
    uint light_count;
    uint shape_count;
    bool is_listed;
};

CellList all_lights() {
    return CellList(quad_count(), light_count(), shape_count(), false);
}

// Lists the lights: of all invocations of the workgroup, whether or not they have a froxel.
CellList list_cell(ivec3 counts, float extinction) {
    find_cell(counts, least_extinction(extinction));
    uvec3 listed_counts = list_lights();
    barrier();
    if (listed_counts.z > CELL_CAPACITY) {
        return all_lights();
    }
    return CellList(listed_counts.x, listed_counts.y, listed_counts.z - listed_counts.y, true);
}

// The index of a light at a place of all of a cell's, polygons and then shapes.
uint cell_light(CellList list, uint place) {
    uint first_shape = list.light_count;
    return list.is_listed ? cell_lights[place] : place < first_shape ? place : place - first_shape;
}

#endif
