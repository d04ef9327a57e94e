#ifndef TILE_BOUNDS_GLSL
#define TILE_BOUNDS_GLSL

// Bounds of what the pixels of a tile are, and of how lights lie to them, by interval arithmetic: what holds for the
// bounds holds for every pixel. A range is a vec2, its ends in order. Positions are relative to the camera.

const float TILE_FAR = 3e38;

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
    float spread; // normals may differ by as much from what was added
};

TilePlanes tile_planes_begin() {
    return TilePlanes(TileBox(vec3(TILE_FAR), vec3(-TILE_FAR)), vec2(TILE_FAR, -TILE_FAR), 0.0);
}

void tile_planes_add(inout TilePlanes planes, vec3 normal, float offset, float spread) {
    planes.normal.low = min(planes.normal.low, normal);
    planes.normal.high = max(planes.normal.high, normal);
    planes.offset = vec2(min(planes.offset.x, offset), max(planes.offset.y, offset));
    planes.spread = max(planes.spread, spread);
}

// A light as the planes see it.
struct TileLight {
    vec3 center;
    float radius;
    vec3 normal;  // unit; zero where it is not flat
    float reach;  // no pixel is farther from its center
    float margin; // what heights may err by
};

// How a light lies to planes: wholly above each of them, wholly below each of them, or neither.
struct TileSide {
    bool above;
    bool below;
};

// How far lights may stand out of the plane of their normal, over their radius.
const float TILE_FLATNESS = 1e-3;

// The heights of a light's points above the planes, the least and the largest. A flat light within `radius` of its center
// reaches at most radius sqrt(1 - (h.m)^2) along a unit vector h, for its unit normal m: the disk of that radius does.
vec2 tile_heights(TilePlanes planes, TileLight light) {
    vec2 height = box_dot(planes.normal, light.center) - planes.offset.yx;
    vec2 along = box_dot(planes.normal, light.normal);
    float least = max(max(along.x, -along.y) - planes.spread, 0.0);
    float extent = light.radius * (sqrt(max(1.0 - least * least, 0.0)) + TILE_FLATNESS) + light.margin
                 + planes.spread * light.reach;
    return height + vec2(-extent, extent);
}

TileSide tile_side(TilePlanes planes, TileLight light) {
    vec2 heights = tile_heights(planes, light);
    return TileSide(heights.x > 0.0, heights.y < 0.0);
}

#endif
