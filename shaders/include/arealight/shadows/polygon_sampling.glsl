#ifndef AREALIGHT_POLYGON_SAMPLING_GLSL
#define AREALIGHT_POLYGON_SAMPLING_GLSL

#include "arealight/form_factor/arctangent.glsl"
#include "arealight/shadows/choose.glsl"

// Directions drawn from a lobe over a polygon: with the density of the clamped cosine in the lobe's cosine
// space, over what of the polygon is above the horizon. The integrand of the unshadowed light over that
// density is its form factor, whatever is drawn. So the mean visibility of the drawn directions is the
// shadow: unbiased from one ray on, with a variance of S (1 - S) per ray, and without noise where nothing or
// everything is hidden.
//
//     ArealightSamplingPolygon polygon = ...;                        // in cosine space, z >= 0, convex
//     ArealightDraw draw = arealight_draw(polygon, random);          // draw.area = pi times the form factor
//     vec3 direction = inverse(space) * draw.direction;              // of any length
//
// Projected along z onto the unit disk the density is uniform. The polygon's projection is cut at the
// azimuths of its vertices into sectors, each between two great circles or, where the zenith is inside of the
// polygon, within one. A sector is chosen by its area, an azimuth in it by the area up to there, and then a
// radius.
//
// Bounds (tests/tests/gpu/polygon_sampling.rs): the areas sum to pi F within 5e-7; directions are inside of
// the polygon to 5e-7; of 1,024 draws the share on either side of a plane through the point is right to 3e-3
// rms, as evenly as the sequence goes, for polygons from a tenth of their distance on. Of the area of smaller
// ones rounding takes a part that grows with the inverse of their size: the areas of two circles cancel.

// The most vertices: a quad, cut at the horizon.
const int AREALIGHT_SAMPLING_VERTICES = 5;

// A convex polygon in a lobe's cosine space, at or above its horizon: from the shading point, in order, of
// either orientation. One of fewer vertices has some of them twice, next to each other.
struct ArealightSamplingPolygon {
    vec3 vertices[AREALIGHT_SAMPLING_VERTICES];
};

// A drawn direction.
struct ArealightDraw {
    vec3 direction; // unit, in the lobe's cosine space; the zenith where there is no area
    float area;     // of the polygon's projection onto the unit disk: pi times its form factor
};

// A sector of the projection: from an azimuth on, between the great circles in two planes.
struct ArealightSector {
    vec2 from;   // azimuth, unit
    vec3 outer;  // unit normal of the plane of the circle farther from the zenith
    vec3 inner;  // of the nearer one; zero where the sector begins at the zenith
    float width; // radians, in [0, pi]
    float area;
};

// Steps of Newton's method. The error of the area up to the azimuth, as a part of the sector's, of quads as
// large as twice their distance: 99 in a hundred 6e-4, rms 4e-4 (4 steps: 4e-6, 3e-5). What is left is a
// direction of the sector all the same.
const int AREALIGHT_SAMPLING_STEPS = 3;

// The sine of an angle in [0, pi / 2]: error 8e-8. Source: minimax polynomial of sin(x) / x in x^2.
float arealight_sine(float x) {
    float x2 = x * x;
    return x * (0.99999999 + x2 * (-0.16666657 + x2
                                   * (0.0083330251 + x2 * (-0.00019807419 + x2 * 2.6019031e-6))));
}

// (cosine, sine) of an angle in [0, pi]. The built-in functions have an error of 2^-11.
vec2 arealight_direction_at(float angle) {
    float half_angle = 0.5 * angle;
    float s = arealight_sine(half_angle);
    float c = arealight_sine(max(0.5 * AREALIGHT_PI - half_angle, 0.0));
    return vec2((c - s) * (c + s), 2.0 * s * c);
}

// The unit vector along v; `fallback` for the zero vector.
vec2 arealight_unit_azimuth(vec2 v, vec2 fallback) {
    float square = dot(v, v);
    return square > 1e-37 ? v * inversesqrt(square) : fallback;
}

// An azimuth turned by an angle whose cosine and sine are given.
vec2 arealight_turned_by(vec2 azimuth, vec2 turn) {
    return vec2(azimuth.x * turn.x - azimuth.y * turn.y, azimuth.x * turn.y + azimuth.y * turn.x);
}

// Of the point of a great circle at an azimuth, with the plane's unit normal: (squared distance from the
// disk's center, squared height), which add up to 1. That of the zero vector is the zenith.
vec2 arealight_circle_squares(vec3 normal, vec2 azimuth) {
    float height = dot(normal.xy, azimuth);
    vec2 squares = vec2(normal.z * normal.z, height * height + 1e-37);
    return squares / (squares.x + squares.y);
}

// The angle along a great circle from one azimuth to another one, which is that one turned by an angle in [0,
// pi] with this cosine and sine. Half of it times the height of the plane's normal is the area between the
// zenith and the circle.
float arealight_circle_angle(vec3 normal, vec2 from, vec2 to, vec2 turn) {
    float across = abs(normal.z) * turn.y;
    float along = normal.z * normal.z * turn.x + dot(normal.xy, from) * dot(normal.xy, to);
    return arealight_arctangent(across, along);
}

// Where the integral of a density that is linear from `from` to `to` on [0, 1] is `part` of the whole.
float arealight_linear_quantile(float from, float to, float part) {
    float root = sqrt(max(from * from + part * (to * to - from * from), 0.0));
    float sum = from + root;
    return sum > 0.0 ? min(part * (from + to) / sum, 1.0) : part;
}

// The azimuth up to which a sector without an inner circle has this area: the angle along the outer circle is
// in proportion to it.
vec2 arealight_azimuth_around_zenith(ArealightSector sector, float area) {
    vec3 normal = sector.outer.z < 0.0 ? -sector.outer : sector.outer;
    vec3 start = vec3(normal.z * sector.from, -dot(normal.xy, sector.from));
    start *= inversesqrt(max(dot(start, start), 1e-37));
    vec2 turn = arealight_direction_at(min(2.0 * area / max(normal.z, 1e-37), AREALIGHT_PI));
    return arealight_unit_azimuth(turn.x * start.xy + turn.y * cross(normal, start).xy, sector.from);
}

// The area of a sector up to an angle from its first azimuth on, and its derivative by the angle.
vec2 arealight_sector_area(ArealightSector sector, float angle) {
    vec2 turn = arealight_direction_at(angle);
    vec2 to = arealight_turned_by(sector.from, turn);
    float outer = abs(sector.outer.z) * arealight_circle_angle(sector.outer, sector.from, to, turn);
    float inner = abs(sector.inner.z) * arealight_circle_angle(sector.inner, sector.from, to, turn);
    float density = arealight_circle_squares(sector.outer, to).x
        - arealight_circle_squares(sector.inner, to).x;
    return 0.5 * vec2(outer - inner, max(density, 0.0));
}

// The azimuth up to which a sector between two circles has this part of its area: by Newton's method in a
// bracket, from where it would be for a linear density. A step that rounding takes out of the bracket by
// nothing must not end in its middle: the bracket is closed.
vec2 arealight_azimuth_between(ArealightSector sector, float part) {
    float low = 0.0;
    float high = sector.width;
    float first = arealight_sector_area(sector, 0.0).y;
    float last = arealight_sector_area(sector, high).y;
    float angle = high * arealight_linear_quantile(first, last, part);
    for (int i = 0; i < AREALIGHT_SAMPLING_STEPS; i++) {
        vec2 area = arealight_sector_area(sector, angle) - vec2(part * sector.area, 0.0);
        low = area.x < 0.0 ? angle : low;
        high = area.x < 0.0 ? high : angle;
        float next = angle - area.x / area.y;
        // Not for NaN either
        angle = next >= low && next <= high ? next : 0.5 * (low + high);
    }
    return arealight_turned_by(sector.from, arealight_direction_at(angle));
}

// The direction in a sector whose azimuth has `random.x` of the area before it, and whose squared radius is
// `random.y` on the way from the inner circle to the outer one.
vec3 arealight_draw_in_sector(ArealightSector sector, vec2 random) {
    vec2 azimuth = sector.inner == vec3(0.0) ? arealight_azimuth_around_zenith(sector, random.x * sector.area)
                                             : arealight_azimuth_between(sector, random.x);
    vec2 squares = mix(arealight_circle_squares(sector.inner, azimuth),
                       arealight_circle_squares(sector.outer, azimuth),
                       random.y);
    return vec3(azimuth * sqrt(squares.x), sqrt(squares.y));
}

// The polygon's edges as planes, and its vertices' azimuths.
struct ArealightSamplingEdges {
    vec3 normals[AREALIGHT_SAMPLING_VERTICES];  // unit, to the inside; zero for an edge without length
    vec2 azimuths[AREALIGHT_SAMPLING_VERTICES]; // of the vertices, unit
    float keys[AREALIGHT_SAMPLING_VERTICES];    // rise with the azimuth from that of the polygon's middle
    bool has_zenith;                            // the zenith is inside
};

ArealightSamplingEdges arealight_sampling_edges(ArealightSamplingPolygon polygon) {
    vec3 middle = vec3(0.0);
    vec3 units[AREALIGHT_SAMPLING_VERTICES];
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        vec3 vertex = polygon.vertices[i];
        units[i] = vertex * inversesqrt(max(dot(vertex, vertex), 1e-37));
        middle += units[i];
    }
    vec2 toward = arealight_unit_azimuth(middle.xy, vec2(1.0, 0.0));

    ArealightSamplingEdges edges;
    float inside = 0.0;
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        // a x (b - a) is a x b without its rounding
        vec3 next = units[(i + 1) % AREALIGHT_SAMPLING_VERTICES];
        vec3 normal = cross(units[i], next - units[i]);
        float square = dot(normal, normal);
        edges.normals[i] = square > 1e-37 ? normal * inversesqrt(square) : vec3(0.0);
        inside += dot(edges.normals[i], middle);

        vec2 azimuth = arealight_unit_azimuth(units[i].xy, toward);
        edges.azimuths[i] = azimuth;
        float side = toward.x * azimuth.y - toward.y * azimuth.x;
        edges.keys[i] = side / max(1.0 + dot(toward, azimuth), 1e-7);
    }

    // Of either orientation the normals are to point inwards
    edges.has_zenith = true;
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        edges.normals[i] = inside < 0.0 ? -edges.normals[i] : edges.normals[i];
        bool is_edge = edges.normals[i] != vec3(0.0);
        edges.has_zenith = edges.has_zenith && (!is_edge || edges.normals[i].z > 0.0);
    }
    return edges;
}

// The sector between two azimuths, `to` after `from` by at most pi.
ArealightSector arealight_sector(vec2 from, vec2 to, vec3 outer, vec3 inner) {
    vec2 turn = vec2(dot(from, to), max(from.x * to.y - from.y * to.x, 0.0));
    float area = 0.5 * (abs(outer.z) * arealight_circle_angle(outer, from, to, turn)
                        - abs(inner.z) * arealight_circle_angle(inner, from, to, turn));
    return ArealightSector(from, outer, inner, arealight_arctangent(turn.y, turn.x), area);
}

// The sector of an edge of a polygon around the zenith.
ArealightSector arealight_sector_of_edge(ArealightSamplingEdges edges, int i) {
    vec2 from = edges.azimuths[i];
    vec2 to = edges.azimuths[(i + 1) % AREALIGHT_SAMPLING_VERTICES];
    bool is_ahead = from.x * to.y - from.y * to.x > 0.0;
    return arealight_sector(is_ahead ? from : to, is_ahead ? to : from, edges.normals[i], vec3(0.0));
}

// Puts two vertices in the order of their azimuths.
void arealight_order(inout vec3 a, inout vec3 b) {
    vec3 lower = a.z <= b.z ? a : b;
    b = a.z <= b.z ? b : a;
    a = lower;
}

// The azimuths with their keys in z, in order. (A network of 9 comparisons; Knuth 1998, 5.3.4.)
void arealight_sort(inout vec3 v[AREALIGHT_SAMPLING_VERTICES]) {
    arealight_order(v[0], v[3]); arealight_order(v[1], v[4]);
    arealight_order(v[0], v[2]); arealight_order(v[1], v[3]);
    arealight_order(v[0], v[1]); arealight_order(v[2], v[4]);
    arealight_order(v[1], v[2]); arealight_order(v[3], v[4]);
    arealight_order(v[2], v[3]);
}

// The sector between neighbours in azimuth of a polygon that the zenith is outside of: of the two edges that
// span it the lower one in the middle is the outer circle.
ArealightSector arealight_sector_between(ArealightSamplingEdges edges, vec3 from, vec3 to) {
    vec2 middle = arealight_unit_azimuth(from.xy + to.xy, from.xy);
    vec3 outer = vec3(0.0);
    vec3 inner = vec3(0.0);
    float lowest = 2.0;
    float highest = -1.0;
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        float a = edges.keys[i];
        float b = edges.keys[(i + 1) % AREALIGHT_SAMPLING_VERTICES];
        if (edges.normals[i] != vec3(0.0) && min(a, b) <= from.z && max(a, b) >= to.z) {
            float height = arealight_circle_squares(edges.normals[i], middle).y;
            outer = height < lowest ? edges.normals[i] : outer;
            lowest = min(lowest, height);
            inner = height > highest ? edges.normals[i] : inner;
            highest = max(highest, height);
        }
    }
    return arealight_sector(from.xy, to.xy, outer, inner);
}

// Draws a direction from the clamped cosine over a polygon. `random` in [0, 1)^2, uniform.
ArealightDraw arealight_draw(ArealightSamplingPolygon polygon, vec2 random) {
    ArealightSamplingEdges edges = arealight_sampling_edges(polygon);
    vec3 sorted[AREALIGHT_SAMPLING_VERTICES];
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        sorted[i] = vec3(edges.azimuths[i], edges.keys[i]);
    }
    arealight_sort(sorted);

    // Choose a sector by its area; one without area is skipped, as it would use up the random number
    ArealightSector chosen = ArealightSector(vec2(1.0, 0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
    float sum = 0.0;
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        ArealightSector sector = chosen;
        sector.area = 0.0;
        if (edges.has_zenith) {
            if (edges.normals[i] != vec3(0.0)) {
                sector = arealight_sector_of_edge(edges, i);
            }
        } else if (i + 1 < AREALIGHT_SAMPLING_VERTICES && sorted[i + 1].z > sorted[i].z) {
            sector = arealight_sector_between(edges, sorted[i], sorted[i + 1]);
        }
        if (sector.area > 0.0 && arealight_choose(random.x, sum, sector.area)) {
            chosen = sector;
        }
    }
    if (sum == 0.0) {
        return ArealightDraw(vec3(0.0, 0.0, 1.0), 0.0);
    }
    return ArealightDraw(arealight_draw_in_sector(chosen, random), sum);
}

#endif
