#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Makes a level of A and B of an image on a light (textures/footprint.glsl) from its mips and from coarser
// levels. A node has the height 6 / side of its level's texels; the light fills a layer's middle half.
//
// From afar K of height h is 5/16 of K of 2 h less 1/64 of K of 4 h, and B 5/8 less 1/16: what is left falls
// as 1 / x^8, and is summed over a mip within three heights. The coarse levels are summed as a whole.
//
// Each invocation makes two by two nodes, which read the same texels.

layout(local_size_x = 8, local_size_y = 8) in;

#include "half.glsl"
#include "image_layers.glsl"

layout(set = 0, binding = 0) uniform texture2DArray all_levels;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

layout(push_constant, std430) uniform TextureKernelConstants {
    uint layer;
    int level;
    float aspect;    // of the light: width over height
    uint is_ellipse; // which touches the image's edges
} constants;

const float PI = 3.141592654;
const float FINEST_HEIGHT = 6.0; // of level 0, in texels of the layer

// Levels of at most so many nodes are summed as a whole, over the mip of so many texels.
const int WHOLE = 32;

// Where a node is, in sides of the light from its corner.
vec2 node_place(vec2 coordinate) {
    vec2 from_middle = abs(coordinate - 0.5);
    vec2 share = clamp(4.0 * from_middle - 1.0, 0.0, 1.0); // of the quarter outside
    vec2 outside = 0.5 * share / max(1.0 - share, 1e-6);
    vec2 place = mix(2.0 * from_middle, 0.5 + outside, greaterThan(from_middle, vec2(0.25)));
    return 0.5 + sign(coordinate - 0.5) * place;
}

// What stored sums are multiplied by, so that mixing is fair and sixteen bits are enough: h / D over the
// light's share of K, about h^2 / (D (D + d) + pi D^4), `outside`, d, being how far the place is outside.
float scale_at(float outside, float height) {
    float distance = sqrt(outside * outside + height * height);
    return (distance + outside + PI * distance * distance * distance) / height;
}

// A coarser level between its nodes, as it is stored.
vec4 between_nodes(uint layer, vec2 coordinate, int level) {
    int nodes = textureSize(all_levels, level).x;
    vec2 place = clamp(coordinate * float(nodes) - 0.5, vec2(0.0), vec2(float(nodes - 1)));
    ivec2 low = ivec2(place);
    ivec2 high = min(low + 1, ivec2(nodes - 1));
    vec2 part = place - vec2(low);
    vec4 above = mix(texelFetch(all_levels, ivec3(low, layer), level),
                     texelFetch(all_levels, ivec3(high.x, low.y, layer), level), part.x);
    vec4 below = mix(texelFetch(all_levels, ivec3(low.x, high.y, layer), level),
                     texelFetch(all_levels, ivec3(high, layer), level), part.x);
    return mix(above, below, part.y);
}

void store(uint layer, ivec2 node, vec4 sum) {
    imageStore(out_level, ivec3(node, layer),
               round_to_half(clamp(sum, vec4(-LARGEST_HALF), vec4(LARGEST_HALF))));
}

// pi h^2 times K of a squared distance, in heights.
float kernel(float q) {
    return 1.0 / ((q + 1.0) * (q + 1.0));
}

// What is left of it by coarser levels; the same for B.
float kernel_left(float q) {
    float product = (q + 1.0) * (q + 4.0) * (q + 16.0);
    return 135.0 * ((q + 14.0) * q + 28.0) / (product * product);
}

// How much of a texel is light, of so many a side.
float coverage(ivec2 texel, int side) {
    vec2 from_middle = vec2(texel) + 0.5 - 0.5 * float(side);
    float inside = 0.5 * float(side) - sqrt(dot(from_middle, from_middle));
    return constants.is_ellipse == 0u ? 1.0 : clamp(inside + 0.5, 0.0, 1.0);
}

const int BLOCK = 4; // nodes
vec2 places[BLOCK];
vec4 a[BLOCK];
vec4 b_u[BLOCK];
vec4 b_v[BLOCK];

// Adds what all nodes see of a light's part at `middle`; `is_far`: all the same, in A.
void add(vec2 middle, vec4 texel, vec2 stretch, float height, bool is_whole, bool is_far) {
    for (int i = 0; i < BLOCK; i++) {
        vec2 from = (middle - places[i]) / height;
        float q = dot(from * stretch, from * stretch);
        vec4 seen = (is_whole ? kernel(q) : kernel_left(q)) * texel;
        a[i] += is_far ? texel : seen;
        b_u[i] += from.x * seen;
        b_v[i] += from.y * seen;
    }
}

void main() {
    ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    int nodes = imageSize(out_level).x;
    if (any(greaterThanEqual(corner, ivec2(nodes)))) {
        return;
    }
    uint image = IMAGE_LAYERS * constants.layer;
    // Lengths are in units in which the light's area is 1; nodes are as close as a height asks for along the
    // longer side
    vec2 stretch = vec2(sqrt(constants.aspect), inversesqrt(constants.aspect));
    float longer = max(stretch.x, stretch.y);
    int finest = textureSize(all_levels, 0).x;
    float height = longer * FINEST_HEIGHT / float(finest) * exp2(float(constants.level));
    for (int i = 0; i < BLOCK; i++) {
        places[i] = node_place((vec2(corner + ivec2(i & 1, i >> 1)) + 0.5) / float(nodes));
        a[i] = b_u[i] = b_v[i] = vec4(0.0);
    }
    // Sum over the mip with three texels in two heights, or more. Along the shorter side, where texels are
    // closer, so many at once as are as long as one along the longer side, or a 32nd of the light
    bool is_whole = nodes <= WHOLE;
    bool is_far = nodes == 1; // the last level is for all that is farther away, too
    int mip = is_whole ? max(findMSB(finest / WHOLE), 0) : constants.level + 2;
    int side = textureSize(all_levels, mip).x;
    ivec2 step = clamp(ivec2(longer / stretch), 1, max(side / WHOLE, 1));
    vec2 reach = is_whole ? vec2(1e9) : 3.0 * height / stretch;
    ivec2 first = ivec2(max(floor((places[0] - reach) * float(side)), 0.0)) / step * step;
    ivec2 end = ivec2(min(ceil((places[BLOCK - 1] + reach) * float(side)), float(side)));
    bool is_one = step.x * step.y == 1; // most are: a loop less
    for (int y = first.y; y < end.y && is_one; y++) {
        for (int x = first.x; x < end.x; x++) {
            vec4 texel = coverage(ivec2(x, y), side) * texelFetch(all_levels, ivec3(x, y, image), mip);
            add((vec2(x, y) + 0.5) / float(side), texel, stretch, height, is_whole, is_far);
        }
    }
    for (int y = first.y; y < end.y && !is_one; y += step.y) {
        for (int x = first.x; x < end.x; x += step.x) {
            ivec2 last = min(ivec2(x, y) + step, side);
            vec4 sum = vec4(0.0);
            for (int j = y; j < last.y; j++) {
                for (int i = x; i < last.x; i++) {
                    sum += coverage(ivec2(i, j), side) * texelFetch(all_levels, ivec3(i, j, image), mip);
                }
            }
            vec2 middle = 0.5 * vec2(ivec2(x, y) + last) / float(side);
            add(middle, sum, stretch, height, is_whole, is_far);
        }
    }
    float share = 1.0 / (PI * height * height * float(side) * float(side));
    for (int i = 0; i < BLOCK; i++) {
        ivec2 node = corner + ivec2(i & 1, i >> 1);
        vec2 coordinate = (vec2(node) + 0.5) / float(nodes);
        vec2 beyond = max(abs(places[i] - 0.5) - 0.5, 0.0) * stretch;
        float outside = sqrt(dot(beyond, beyond));
        float scale = scale_at(outside, height);
        vec4 sums[3] = vec4[3](scale * share * a[i], scale * share * b_u[i], scale * share * b_v[i]);
        float twice = scale / scale_at(outside, 2.0 * height);
        float four_times = scale / scale_at(outside, 4.0 * height);
        for (uint part = 0u; part < 3u; part++) {
            uint layer = image + part + 1u;
            if (!is_whole) {
                vec2 shares = part == 0u ? vec2(0.3125, -0.015625) : vec2(0.625, -0.0625);
                sums[part] += shares.x * twice * between_nodes(layer, coordinate, constants.level + 1)
                            + shares.y * four_times * between_nodes(layer, coordinate, constants.level + 2);
            }
            store(layer, node, sums[part]);
        }
    }
}
