#ifndef TILE_BOUNDS_GLSL
#define TILE_BOUNDS_GLSL

// Bounds over the pixels of a tile, and how lights lie to them, by interval arithmetic: what holds for the
// bounds holds for every pixel. A range is a vec2, its ends in order. Positions are relative to the camera.

const float TILE_FAR = 3e38;
const float TILE_PI = 3.1415927;

// Its pixels, an invocation each; memory that they share: values of theirs, eight at a time, and then free
// for other use.
const uint TILE_PIXELS = 64u;
shared vec4 tile_scratch[2u * TILE_PIXELS];
shared float tile_parts[TILE_PIXELS];

// Vectors between two corners.
struct TileBox {
    vec3 low;
    vec3 high;
};

// The products of a vector with those of a box.
vec2 box_dot(TileBox box, vec3 vector) {
    vec3 a = box.low * vector;
    vec3 b = box.high * vector;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    return vec2(low.x + low.y + low.z, high.x + high.y + high.z);
}

// Planes, one through each pixel's position, with unit normals.
struct TilePlanes {
    TileBox normal;
    vec2 offset;  // products of the normals with the positions
    float spread; // normals may differ by as much from those of the box
};

// A light of either list, as it is tested against the bounds of a tile.
struct TileLight {
    vec3 center;
    float radius;    // it lies within this distance of its center
    vec3 normal;     // unit; zero where it is not flat
    bool two_sided;  // else a flat light lights what is in front of it
    float radiance;  // the sum of the channels
    float area;      // no larger area of it faces any point; a sphere's is that of its disk
    float least;     // the area that its least contribution is proportional to, or 0 where that is not known
    uint links;      // the groups of surfaces that it shines on; 0 for all
    bool over_half_vectors; // its specular lobes are GGX itself, not the fitted ones
    bool is_bounded; // whether its contribution has bounds: it shows no image, and no parts of it overlap
    float distance;  // no pixel is farther from its center
    float margin;    // what heights may err by
};

// How bounds are rounded, generously.
const float TILE_ROUNDING = 1.001;

// How far lights may stand out of the plane of their normal, over their radius.
const float TILE_FLATNESS = 1e-3;

// The heights of a light's points above the planes, the least and the largest. A flat light within `radius`
// of its center extends at most radius sqrt(1 - (h.m)^2) along a unit vector h, for its unit normal m: the
// disk of that radius does.
vec2 tile_heights(TilePlanes planes, TileLight light) {
    vec2 height = box_dot(planes.normal, light.center) - planes.offset.yx;
    vec2 along = box_dot(planes.normal, light.normal);
    float least = max(max(along.x, -along.y) - planes.spread, 0.0);
    float extent = light.radius * (sqrt(max(1.0 - least * least, 0.0)) + TILE_FLATNESS) + light.margin
                 + planes.spread * light.distance;
    return height + vec2(-extent, extent);
}

#endif
