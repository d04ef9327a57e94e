#ifndef AREALIGHT_SHAPED_LIGHT_GLSL
#define AREALIGHT_SHAPED_LIGHT_GLSL

#include "arealight/form_factor/disk_part.glsl"
#include "arealight/form_factor/sphere.glsl"
#include "arealight/lights/opening.glsl"
#include "arealight/lights/polygon.glsl"

// Flat lights with a profile, a factor of the radiance by the angle from the front's normal
// (arealight::Profile in Rust), behind an opening (lights/opening.glsl), or both: docs/shaped-light.md.
//
// The angle at the light is that of the foot of the perpendicular, seen from the shading point: points of the
// light within an angle are a disk about the foot. So the light is cut into rings by a few levels, and of
// each ring the form factor counts times the profile's mean over it, or over what the light has of it.
// What an opening hides of a ring is clipped away, vertex by vertex.
struct ArealightShapedLight {
    ArealightPolygonLight polygon; // convex, if it has a profile
    vec3 radiance;                 // the polygon's: of the front at a factor of 1, W/(m^2 sr)
    uint profile;                  // the first row, for arealight_bridge_profile
    uint opening;                  // of its opening; with AREALIGHT_OPENINGS either may be AREALIGHT_NO_ROW
};

struct ArealightLocalShaped {
    ArealightLocalPolygon polygon;
    vec3 normal;     // of the front, in the shading frame
    vec3 foot;       // of the perpendicular, from the shading point
    float height;    // squared: of the point over the light's plane
    float nearest;   // squared: from the foot to what is seen of the light, 0 within it
    float farthest;
    bool holds_foot; // whether the foot is within the light
    vec3 low;        // x, factor and sum of its nearest point
    vec3 high;       // and of its farthest
    uint profile;    // the first row
    float scale;
    float piece_scale;
    float wide;      // a fifth of 1 less the cosine of how far around its corners are from its center
    uint azimuth;    // the row of azimuth 0; 0 where the profile is round
    uint levels;     // rows of levels
    uint levels_end;
    ArealightLocalOpening opening;
};

// Whether a light has a profile, by its first row.
bool arealight_has_profile(uint profile) {
    return AREALIGHT_HAS_PROFILES && (!AREALIGHT_HAS_OPENINGS || profile != AREALIGHT_NO_ROW);
}

// A vertex of the light from the foot, in the shading frame.
vec3 arealight_from_foot(ArealightLocalShaped local, uint index) {
    return local.polygon.center - local.foot + local.polygon.to_frame * arealight_bridge_vertex(index);
}

// Takes an edge of what is seen, from the foot, into the range of distances.
void arealight_range_edge(inout ArealightLocalShaped local, vec3 a, vec3 b) {
    vec3 along = b - a;
    float part = clamp(-dot(a, along) / max(dot(along, along), AREALIGHT_LEAST_SQUARE), 0.0, 1.0);
    vec3 nearest = a + part * along;
    local.nearest = min(local.nearest, dot(nearest, nearest));
    local.farthest = max(local.farthest, dot(b, b));
}

// How near and far from the foot what is seen of the light is; false if nothing is.
bool arealight_find_range(inout ArealightLocalShaped local, float height) {
    bool is_clipped = AREALIGHT_HAS_OPENINGS && local.opening.is_between;
    uint count = local.polygon.end - local.polygon.first;
    ArealightOpeningWalk walk = arealight_opening_walk();
    local.nearest = 3e38;
    local.farthest = 0.0;
    local.wide = 0.0;
    vec3 toward = arealight_normalize_or(local.polygon.center - local.foot, vec3(0.0));
    local.holds_foot = true;
    bool begun = !is_clipped;
    vec3 before = arealight_from_foot(local, max(local.polygon.end, 1u) - 1u);
    vec3 a = before;
    vec3 first = before;
    for (uint step = 0u; step < count + uint(is_clipped); step++) {
        bool closes = step == count;
        vec3 vertex = arealight_from_foot(local, local.polygon.first + (closes ? 0u : step));
        local.holds_foot = local.holds_foot && dot(local.normal, cross(before, vertex)) >= 0.0;
        before = vertex;
        ArealightOpeningPart seen = arealight_opening_all(vertex);
        if (is_clipped) {
            seen = arealight_opening_step(walk, local.opening, local.foot + vertex, closes);
        }
        int vertices = arealight_opening_count(seen);
        for (int index = 0; index < vertices; index++) {
            vec3 b = arealight_opening_vertex(local.opening, seen, index);
            b = is_clipped ? b * (height / dot(local.normal, b)) - local.foot : b;
            if (AREALIGHT_HAS_AZIMUTHS) {
                local.wide = max(local.wide, 0.2 - 0.2 * dot(arealight_normalize_or(b, vec3(0.0)), toward));
            }
            if (begun) {
                arealight_range_edge(local, a, b);
            } else {
                first = b;
                begun = true;
            }
            a = b;
        }
    }
    bool sees_foot = local.holds_foot;
    if (is_clipped && begun) {
        arealight_range_edge(local, a, first);
        sees_foot = sees_foot && arealight_is_in_opening(arealight_opening_place(local.opening, local.foot));
    }
    local.nearest = sees_foot ? 0.0 : local.nearest;
    return begun;
}

bool arealight_to_local(ArealightPoint point, ArealightShapedLight light, out ArealightLocalShaped local) {
    bool lit = arealight_to_local(point, light.polygon, local.polygon);
    local.opening.is_between = false;
    if (AREALIGHT_HAS_OPENINGS && light.opening != AREALIGHT_NO_ROW) {
        lit = arealight_to_local(point.to_frame, point.position, light.opening, local.opening) && lit;
    }
    local.normal = point.to_frame * light.polygon.normal;
    float height = dot(local.normal, local.polygon.center);
    local.foot = height * local.normal;
    local.height = height * height;
    local.profile = light.profile;
    local.azimuth = 0u;
    local.levels = 0u;
    local.levels_end = 0u;
    if (!arealight_has_profile(light.profile)) {
        return lit;
    }
    lit = arealight_find_range(local, height) && lit;
    vec4 head = arealight_bridge_profile(light.profile);
    local.scale = head.x;
    local.piece_scale = head.z;
    local.azimuth = head.w < 0.0 ? arealight_azimuth_row(light.profile, head.y) : 0u;
    local.levels = light.profile + 1u;
    local.levels_end = local.levels + uint(head.y);
    local.low = arealight_profile_place(light.profile, local.nearest, local.height);
    local.high = arealight_profile_place(light.profile, local.farthest, local.height);
    // Outside of the cone nothing arrives
    return lit && local.low.x < 1.0;
}

// The squared radius of a disk that holds any light.
const float AREALIGHT_NO_RIM = 3e38;

// An outline whose vertices come in order, in the shading frame, and which is clipped as the options have it.
struct ArealightPartOutline {
    ArealightClippedOutline clipped;
    vec3 first;
    bool begun;
    ArealightOpeningWalk walk;
};

void arealight_part_vertex(inout ArealightPartOutline part, mat3 space, vec3 vertex) {
    if (!AREALIGHT_CLIPS_AT_SURFACE) {
        arealight_clipped_add(part.clipped, space, vertex);
    } else if (part.begun) {
        arealight_clipped_vertex(part.clipped, space, vertex);
    } else {
        part.first = vertex;
        part.begun = true;
        part.clipped = arealight_clipped_begin(vertex, AREALIGHT_ANYWHERE);
    }
}

// Goes on to its next vertex, as far as it is seen; at last to the first one again, with `closes`.
void arealight_part_seen(inout ArealightPartOutline part, mat3 space, ArealightLocalOpening opening,
                         vec3 vertex, bool closes) {
    ArealightOpeningPart seen = arealight_opening_all(vertex);
    if (AREALIGHT_HAS_OPENINGS && opening.is_between) {
        seen = arealight_opening_step(part.walk, opening, vertex, closes);
    }
    int count = arealight_opening_count(seen);
    for (int index = 0; index < count; index++) {
        arealight_part_vertex(part, space, arealight_opening_vertex(opening, seen, index));
    }
}

// The vector form factor, in a space, of what is seen of the light within a disk about the foot that holds
// some of it; all of it with AREALIGHT_NO_RIM. Error: that of an outline of as many corners, and of the rim's
// chords, whose area is the disk's: up to 1e-3 of the disk's.
vec3 arealight_level_vector(mat3 space, ArealightLocalShaped local, float square, float front) {
    uint count = local.polygon.end - local.polygon.first;
    // Begin where the outline comes into the disk; without such an edge all of the disk is in the light
    uint start = count;
    vec2 part;
    vec3 a = arealight_from_foot(local, local.polygon.end - 1u);
    for (uint index = 0u; AREALIGHT_HAS_PROFILES && index < count && start == count; index++) {
        vec3 b = arealight_from_foot(local, local.polygon.first + index);
        start = dot(a, a) >= square && arealight_edge_in_disk(a, b, square, part) ? index : start;
        a = b;
    }
    bool has_rim = AREALIGHT_HAS_PROFILES && (!AREALIGHT_HAS_OPENINGS || square < AREALIGHT_NO_RIM);
    bool is_whole = has_rim && start == count;
    if (is_whole && !local.holds_foot) {
        return vec3(0.0);
    }
    start = has_rim ? start : 0u;
    ArealightPartOutline outline = ArealightPartOutline(
        arealight_clipped_begin(vec3(0.0), AREALIGHT_ANYWHERE), vec3(0.0), false, arealight_opening_walk());
    bool is_first = true;
    vec3 first = vec3(0.0);
    vec3 left = vec3(0.0); // where the outline left the disk
    float outside = 0.0;   // how far it has been since then
    uint last = start == 0u ? count : start;
    a = arealight_from_foot(local, local.polygon.first + last - 1u);
    for (uint step = is_whole ? count : 0u; step <= count; step++) {
        uint index = is_whole ? 0u : start + step;
        index -= index < count ? 0u : count;
        vec3 b = arealight_from_foot(local, local.polygon.first + index);
        bool is_met = !AREALIGHT_HAS_PROFILES || arealight_edge_in_disk(a, b, square, part);
        part = AREALIGHT_HAS_PROFILES ? part : vec2(0.0, 1.0);
        bool comes = is_whole || (AREALIGHT_HAS_PROFILES && dot(a, a) >= square);
        vec3 from = a + part.x * (b - a);
        vec3 to = a + part.y * (b - a);
        if (is_met || is_whole) {
            ArealightDiskArc arc = ArealightDiskArc(vec2(1.0, 0.0), 1.0, 1);
            vec3 corner = left;
            if (is_whole) {
                arc = arealight_whole_disk();
                vec3 other;
                arealight_perpendiculars(local.normal, corner, other);
                corner *= sqrt(square);
            } else if (comes && step > 0u) {
                arc = arealight_disk_arc(left, from, local.normal, square,
                                         local.holds_foot ? outside / square : 0.0);
            }
            int arcs = arc.chords - 1;
            bool closes = AREALIGHT_HAS_OPENINGS && step == count && local.opening.is_between;
            int vertices = arcs + (step == count ? int(closes) : comes ? 2 : 1);
            for (int vertex = 0; vertex < vertices; vertex++) {
                corner = arealight_disk_arc_turned(arc, local.normal, corner);
                vec3 place = vertex < arcs ? arc.scale * corner : comes && vertex == arcs ? from : to;
                bool is_end = closes && vertex == arcs;
                place = is_end ? first : place;
                first = is_first ? place : first;
                is_first = false;
                arealight_part_seen(outline, space, local.opening, local.foot + place, is_end);
            }
            left = to;
            outside = 0.0;
        }
        outside = max(outside, dot(b, b) - square);
        a = b;
    }
    if (AREALIGHT_CLIPS_AT_SURFACE && outline.begun) {
        arealight_clipped_vertex(outline.clipped, space, outline.first);
    }
    return arealight_clipped_vector(outline.clipped, front);
}

// A lobe's space, as a profile's mean over a ring needs it.
struct ArealightRingLobe {
    mat3 from_space; // transposed
    float determinant;
};

// No `inverse`, which not every language that the library is translated to has.
ArealightRingLobe arealight_ring_lobe(mat3 space) {
    mat3 cofactors = mat3(cross(space[1], space[2]), cross(space[2], space[0]), cross(space[0], space[1]));
    float determinant = dot(space[0], cofactors[0]);
    return ArealightRingLobe(cofactors * (1.0 / determinant), abs(determinant));
}

// The tangent of the half angle of a place of a profile.
float arealight_half_tangent(float x, float scale) {
    float square = min(x / scale, 1.0);
    return sqrt(square) / (1.0 + sqrt(1.0 - square));
}

// A profile's mean over a ring between two places, `vector` being the ring's vector form factor in the lobe's
// space: over the angles about the mean direction of what the lobe sees of the ring, as far as the lobe is
// wide there. In all of the ring, where the lobe is wider than it.
float arealight_profile_mean(ArealightLocalShaped local, ArealightRingLobe lobe, vec3 from, vec3 to,
                             vec3 vector) {
    // In the lobe's space the ring is taken for a cap that has its vector: the mean of cosine times direction
    float form_factor = length(vector);
    vec3 axis = vector / max(form_factor, AREALIGHT_LEAST_SQUARE);
    float cosine = sqrt(max(1.0 - form_factor, 0.0));
    float spread = cosine + cosine * cosine;
    vec3 mean = 3.0 * spread * axis.z * axis + vec3(0.0, 0.0, 2.0 - spread);
    vec3 direction = mean * lobe.from_space;
    float square = dot(direction, direction);
    float height = abs(dot(direction, local.normal));
    vec3 side = direction - dot(direction, local.normal) * local.normal;
    // By tangents of half angles, which are nearly as the angles
    float first = arealight_half_tangent(from.x, local.scale);
    float last = arealight_half_tangent(to.x, local.scale);
    float apart = length(side) / max(sqrt(square) + height, AREALIGHT_LEAST_SQUARE);
    float middle = clamp(apart, first, last);
    // A quarter of the angle that the lobe is wide: the root of how its space shrinks solid angles
    float ratio = dot(mean, mean) / max(square, AREALIGHT_LEAST_SQUARE);
    float shrunk = ratio * sqrt(ratio) / lobe.determinant;
    float width = sqrt(shrunk) * (0.25 + 0.25 * middle * middle);
    vec2 ends = vec2(max(middle - width, first), min(middle + width, last));
    // What the ring cuts off at one end goes from the other, too: the mean is to stay
    float narrow = 0.5 * max(1.0 - width / max(last - first, AREALIGHT_LEAST_SQUARE), 0.0);
    ends += narrow * vec2(middle + width - ends.y, middle - width - ends.x);
    bool is_known = square > 0.0 && square < 3e38;
    float about = 1.0;
    if (AREALIGHT_HAS_AZIMUTHS && is_known && local.azimuth > 0u) {
        // How far around the light is, or what the lobe sees of it, the less of both; and of what is seen all
        // around the mean is nearer to the axis
        float sine = 2.0 * middle / (1.0 + middle * middle);
        float seen = 0.25 * shrunk / max(sine * sine, 1e-18);
        float gathered = min(apart / max(middle, 1e-18), 1.0)
            * exp(-local.wide * seen / max(local.wide + seen, 1e-18));
        about = arealight_profile_azimuth(local.azimuth, local.polygon.to_frame, local.normal, -side,
                                          arealight_profile_part(0.5 * (ends.x + ends.y), local.piece_scale),
                                          gathered);
    }
    vec2 squares = ends * ends;
    vec2 rests = (1.0 - squares) * (1.0 - squares);
    if (is_known && ends.x > first) {
        from = arealight_profile_place(local.profile, 4.0 * squares.x, rests.x);
    }
    if (is_known && ends.y < last) {
        to = arealight_profile_place(local.profile, 4.0 * squares.y, rests.y);
    }
    float range = to.x - from.x;
    return about * (range > 1e-3 ? (to.z - from.z) / range : 0.5 * (from.y + to.y));
}

// The solid angle over 2 pi of a cap that has a vector form factor.
float arealight_cap(vec3 vector) {
    return 1.0 - sqrt(max(1.0 - length(vector), 0.0));
}

// The vector form factor, and in w the solid angle over 2 pi, of what is seen: `whole` without the profile.
// Error beyond the form factors': of the profile within a ring, where it is its mean.
vec4 arealight_sum_of_rings(mat3 space, ArealightLocalShaped local, float whole) {
    float front = AREALIGHT_HAS_TWO_SIDED ? local.polygon.side : 1.0;
    if (!AREALIGHT_HAS_PROFILES) {
        return vec4(front * arealight_level_vector(space, local, AREALIGHT_NO_RIM, front), whole);
    }
    vec3 all = AREALIGHT_HAS_OPENINGS ? vec3(0.0)
        : arealight_outline_form_factor(space, local.polygon.center, local.polygon.to_frame,
                                        local.polygon.first, local.polygon.end, front);
    float cap_of_all = max(arealight_cap(all), 1e-30);
    ArealightRingLobe lobe = arealight_ring_lobe(space);
    vec4 sum = vec4(0.0);
    vec4 within = vec4(0.0);
    vec3 from = local.low;
    // The last ring ends where the light does
    for (uint row = local.levels; row <= local.levels_end; row++) {
        vec3 vector = all;
        vec3 to = local.high;
        float square = AREALIGHT_NO_RIM;
        bool is_last = row == local.levels_end;
        if (!is_last) {
            vec4 level = arealight_bridge_profile(row);
            square = level.w * local.height;
            if (square <= local.nearest) {
                continue;
            }
            is_last = square >= local.farthest;
            if (!is_last) {
                to = level.xyz;
                // With openings all that is seen goes the same way
                vector = AREALIGHT_HAS_OPENINGS ? all : arealight_level_vector(space, local, square, front);
            }
        }
        if (AREALIGHT_HAS_OPENINGS) {
            vector = arealight_level_vector(space, local, is_last ? AREALIGHT_NO_RIM : square, front);
        }
        float cap = arealight_cap(vector);
        // What edges cut off of a cap, it has as all of the light does
        cap *= AREALIGHT_HAS_OPENINGS ? 1.0 : mix(1.0, whole / cap_of_all, cap / cap_of_all);
        vec4 outer = vec4(vector, is_last ? whole : min(cap, whole));
        float mean = 1.0;
        if (arealight_has_profile(local.profile)) {
            mean = arealight_profile_mean(local, lobe, from, to, outer.xyz - within.xyz);
        }
        sum += mean * (outer - within);
        if (is_last) {
            break;
        }
        within = outer;
        from = to;
    }
    return vec4(front * sum.xyz, sum.w);
}

vec3 arealight_vector_form_factor(mat3 space, ArealightLocalShaped local) {
    return arealight_sum_of_rings(space, local, 0.0).xyz;
}

vec3 arealight_image_average(mat3 space, ArealightLocalShaped local, vec3 vector) {
    return arealight_image_average(space, local.polygon, vector);
}

#if AREALIGHT_SOLID_ANGLES
// Of what an opening leaves of the outline: a fan about the first of its vertices.
float arealight_seen_solid_angle(ArealightLocalShaped local) {
    float height = dot(local.normal, local.polygon.center);
    uint count = local.polygon.end - local.polygon.first;
    ArealightOpeningWalk walk = arealight_opening_walk();
    bool begun = false;
    vec3 origin = vec3(0.0);
    ArealightFanVertex from = ArealightFanVertex(vec3(0.0), vec3(0.0));
    vec3 apex = from.unit;
    vec2 turn = vec2(1.0, 0.0);
    for (uint step = 0u; step <= count; step++) {
        bool closes = step == count;
        vec3 vertex = local.foot + arealight_from_foot(local, local.polygon.first + (closes ? 0u : step));
        ArealightOpeningPart seen = arealight_opening_step(walk, local.opening, vertex, closes);
        int vertices = arealight_opening_count(seen);
        for (int index = 0; index < vertices; index++) {
            vec3 b = arealight_opening_vertex(local.opening, seen, index);
            b *= height / dot(local.normal, b);
            origin = begun ? origin : b;
            ArealightFanVertex to = arealight_fan_vertex(b, b - origin);
            apex = begun ? apex : to.unit;
            turn = begun ? arealight_fan_turned(turn, apex, from, to) : turn;
            from = to;
            begun = true;
        }
    }
    return arealight_fan_solid_angle(turn);
}

// Of what is seen, ring by ring times the profile's mean there: a ring's is that between caps that have the
// vector form factors of what it is between, and the last one's what is left.
float arealight_solid_angle(ArealightLocalShaped local) {
    bool is_clipped = AREALIGHT_HAS_OPENINGS && local.opening.is_between;
    float whole = is_clipped ? arealight_seen_solid_angle(local) : arealight_solid_angle(local.polygon);
    if (!arealight_has_profile(local.profile)) {
        return whole;
    }
    vec3 center = local.polygon.center;
    mat3 space = arealight_frame_matrix(arealight_surface_frame(center, center));
    return 2.0 * AREALIGHT_PI * arealight_sum_of_rings(space, local, whole / (2.0 * AREALIGHT_PI)).w;
}
#endif

AREALIGHT_WITHOUT_HALF_VECTORS(ArealightLocalShaped)
AREALIGHT_LIGHT_KIND(ArealightShapedLight, ArealightLocalShaped, AREALIGHT_LOOPED_LOBES)

#endif
