#ifndef AREALIGHT_OPENING_GLSL
#define AREALIGHT_OPENING_GLSL

#include "arealight/lights/profile.glsl"

// An opening that a light is seen through (arealight::Opening in Rust): a parallelogram in an opaque plane
// with all of the light on one side. A window, the end of a lamp's doors, a cell of a grid.
//
// From a shading point on the other side, directions have a place in the opening's space: its four sides are
// the planes |x| = z and |y| = z. An outline is clipped there in one walk along its edges, without an array:
// what is inside goes on, and where the outline left the opening and came back, the corners that it went
// around follow. They are counted with their sign, so the winding stays that of the outline, whatever its
// side, and concave outlines are clipped, too.

// Rows, by arealight_bridge_profile: (center, 1 if housed), (half axis u, 0), (half axis v, 0), relative to
// the origin of ArealightSurface.position. u x v points to the light. Then planes, (normal, distance from the
// origin), of points that the light may reach: that of the opening itself, and one by each side, for points
// beyond it.
const uint AREALIGHT_OPENING_PLANES = 3u;
const uint AREALIGHT_OPENING_ROWS = 8u;

// The first row of a light without a profile or an opening.
const uint AREALIGHT_NO_ROW = 0xffffffffu;

struct ArealightLocalOpening {
    // In the shading frame, from the shading point, times one number
    vec3 center;
    vec3 axis_u;
    vec3 axis_v;
    bool is_between; // the point and the light
};

// How far a point is beyond a plane of an opening.
float arealight_opening_height(uint opening, uint plane, vec3 position) {
    vec4 row = arealight_bridge_profile(opening + AREALIGHT_OPENING_PLANES + plane);
    return dot(row.xyz, position) - row.w;
}

// An opening from a shading point; false if it hides the light.
bool arealight_to_local(mat3 to_frame, vec3 position, uint opening, out ArealightLocalOpening local) {
    vec4 center = arealight_bridge_profile(opening);
    local.center = to_frame * (center.xyz - position);
    local.axis_u = to_frame * arealight_bridge_profile(opening + 1u).xyz;
    local.axis_v = to_frame * arealight_bridge_profile(opening + 2u).xyz;
    vec3 largest = max(abs(local.center), max(abs(local.axis_u), abs(local.axis_v)));
    float scale = 1.0 / max(max(largest.x, largest.y), max(largest.z, AREALIGHT_LEAST_SQUARE));
    local.center *= scale;
    local.axis_u *= scale;
    local.axis_v *= scale;
    local.is_between = arealight_opening_height(opening, 0u, position) > 0.0;
    if (!local.is_between) {
        return center.w == 0.0;
    }
    float least = 0.0;
    for (uint side = 1u; side <= 4u; side++) {
        least = min(least, arealight_opening_height(opening, side, position));
    }
    return least == 0.0;
}

// A direction from the shading point in the opening's space.
vec3 arealight_opening_place(ArealightLocalOpening opening, vec3 direction) {
    return vec3(dot(cross(opening.axis_v, opening.center), direction),
                dot(cross(opening.center, opening.axis_u), direction),
                dot(cross(opening.axis_u, opening.axis_v), direction));
}

// The heights of a place over the four sides, counter-clockwise from that of -y. All are positive inside.
vec4 arealight_opening_heights(vec3 place) {
    return vec4(place.z + place.y, place.z - place.x, place.z - place.y, place.z + place.x);
}

bool arealight_is_in_opening(vec3 place) {
    return all(greaterThanEqual(arealight_opening_heights(place), vec4(0.0)));
}

// Whether what a light's point sends to a position, which it is `offset` from, arrives: 1 or 0.
float arealight_opening_factor(uint opening, vec3 position, vec3 offset) {
    ArealightLocalOpening local;
    if (!arealight_to_local(mat3(1.0), position, opening, local)) {
        return 0.0;
    }
    return !local.is_between || arealight_is_in_opening(arealight_opening_place(local, offset)) ? 1.0 : 0.0;
}

// The side that a place outside is at.
int arealight_opening_side(vec3 place) {
    return abs(place.x) > abs(place.y) ? (place.x > 0.0 ? 1 : 3) : place.y < 0.0 ? 0 : 2;
}

// How many sides are gone on, counter-clockwise, by an edge outside from one place to another.
int arealight_opening_turns(int from_side, int to_side, vec3 from, vec3 to) {
    int turns = (to_side - from_side) & 3;
    return turns == 3 ? -1 : turns == 2 && from.x * to.y < from.y * to.x ? -2 : turns;
}

// A walk along an outline.
struct ArealightOpeningWalk {
    vec3 vertex; // the last one, in the shading frame
    vec3 place;  // and in the opening's space
    int side;    // that it is at, or -1 inside
    int left;    // the side where the outline went out
    int turns;   // since then
    int first_turns; // before it first came in
    bool begun;
    bool has_entered;
};

ArealightOpeningWalk arealight_opening_walk() {
    return ArealightOpeningWalk(vec3(0.0), vec3(0.0), -1, 0, 0, 0, false, false);
}

// What is seen of an outline on the way to its next vertex: corners of the opening, an edge, and corners.
struct ArealightOpeningPart {
    vec3 from;
    vec3 to;
    bool has_from;
    bool has_to;
    ivec2 corners; // how many before and after, counter-clockwise
    ivec2 sides;   // where those begin
};

// All of it.
ArealightOpeningPart arealight_opening_all(vec3 vertex) {
    return ArealightOpeningPart(vertex, vertex, false, true, ivec2(0), ivec2(0));
}

int arealight_opening_count(ArealightOpeningPart part) {
    return abs(part.corners.x) + abs(part.corners.y) + int(part.has_from) + int(part.has_to);
}

// Vertex `index` of a part, in the shading frame.
vec3 arealight_opening_vertex(ArealightLocalOpening opening, ArealightOpeningPart part, int index) {
    int before = abs(part.corners.x);
    int at_edge = before + int(part.has_from) + int(part.has_to);
    if (index >= before && index < at_edge) {
        return index == before && part.has_from ? part.from : part.to;
    }
    bool is_before = index < before;
    int turned = is_before ? index : index - at_edge;
    int side = is_before ? part.sides.x : part.sides.y;
    bool is_forward = (is_before ? part.corners.x : part.corners.y) > 0;
    // Corner k is the end of side k
    int corner = (is_forward ? side + turned : side - 1 - turned) & 3;
    return opening.center + (corner < 2 ? opening.axis_u : -opening.axis_u)
         + (corner == 1 || corner == 2 ? opening.axis_v : -opening.axis_v);
}

// Goes on to the next vertex; at the end to the first one again, with `closes`.
ArealightOpeningPart arealight_opening_step(inout ArealightOpeningWalk walk, ArealightLocalOpening opening,
                                            vec3 vertex, bool closes) {
    vec3 place = arealight_opening_place(opening, vertex);
    bool is_inside = arealight_is_in_opening(place);
    ArealightOpeningPart part = arealight_opening_all(vertex);
    if (!walk.begun) {
        part.has_to = is_inside;
        walk = ArealightOpeningWalk(vertex, place, is_inside ? -1 : arealight_opening_side(place), 0, 0, 0,
                                    true, is_inside);
        return part;
    }
    vec4 heights = arealight_opening_heights(walk.place);
    vec4 next = arealight_opening_heights(place);
    vec2 range = vec2(0.0, 1.0);
    ivec2 sides = ivec2(walk.side, -1); // where the edge comes in and goes out
    for (int side = 0; side < 4; side++) {
        float at = heights[side] / (heights[side] - next[side]);
        if (heights[side] < 0.0) {
            at = next[side] < 0.0 ? 2.0 : at;
            sides.x = at > range.x ? side : sides.x;
            range.x = max(range.x, at);
        } else if (next[side] < 0.0) {
            sides.y = at < range.y ? side : sides.y;
            range.y = min(range.y, at);
        }
    }
    bool was_inside = walk.side < 0;
    bool is_met = was_inside || is_inside || range.x <= range.y;
    part.has_from = is_met && !was_inside;
    part.has_to = is_met && !(closes && is_inside);
    part.from = walk.vertex + range.x * (vertex - walk.vertex);
    part.to = is_inside ? vertex : walk.vertex + range.y * (vertex - walk.vertex);
    vec3 along = place - walk.place;
    if (part.has_from) {
        walk.turns += arealight_opening_turns(walk.side, sides.x, walk.place, walk.place + range.x * along);
        part.corners.x = walk.has_entered ? walk.turns : 0;
        part.sides.x = walk.left;
        walk.first_turns = walk.has_entered ? walk.first_turns : walk.turns;
        walk.has_entered = true;
    }
    if (is_met && !is_inside) {
        // An edge that leaves by rounding alone leaves where its end is
        walk.left = sides.y < 0 ? arealight_opening_side(place) : sides.y;
        walk.side = walk.left;
        walk.turns = 0;
        walk.place += range.y * along;
    }
    if (!is_inside) {
        int side = arealight_opening_side(place);
        walk.turns += arealight_opening_turns(walk.side, side, walk.place, place);
        walk.side = side;
        if (closes) {
            // An outline that never came in may be around all of the opening
            part.corners.y = walk.has_entered ? walk.turns + walk.first_turns : walk.turns;
            part.sides.y = walk.has_entered ? walk.left : side;
        }
    } else {
        walk.side = -1;
    }
    walk.vertex = vertex;
    walk.place = place;
    return part;
}

#endif
