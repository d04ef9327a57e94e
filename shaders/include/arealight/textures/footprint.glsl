#ifndef AREALIGHT_FOOTPRINT_GLSL
#define AREALIGHT_FOOTPRINT_GLSL

#include "arealight/common.glsl"
#include "arealight/options.glsl"

// What a lobe sees of the image that a light shows.
//
// In a lobe's cosine space, with q the foot of the perpendicular from the point onto the light's plane and h
// its length, a place x of the plane, from q, counts (c + b . x) h / (x^2 + h^2)^2: c + b . x is its height.
// So the mean colour is a ratio of two linear forms, of the image over what the light covers:
//
//     c A + h b . B,  A = L * K,  B = L * x K / h,  K = h^2 / (pi (x^2 + h^2)^2)
//
// with convolutions over the image, which is zero outside: K is that of Heitz et al. 2016 (eq. 35), B its
// companion. Both are filtered beforehand for heights an octave apart, with coverage in alpha
// (texture_kernel.comp), so three fetches are exact for a Lambert surface whose horizon does not cut the
// light, but for the filter: 2 % of the mean, .5 % on images like noise. A lobe's kernel is not round on the
// light as the filter's is. Another place, height and weight stand for what is above a horizon that cuts,
// where the weight would be negative below (arealight_image_place). Errors are in docs/textures.md.

// The height of level 0, in texels along the layer's longer side.
const float AREALIGHT_FINEST_HEIGHT = 6.0;

// The layer of a light without an image.
const uint AREALIGHT_NO_IMAGE = 0xffffffffu;

// An image's place on a light: GpuLight in Rust. The box of the image that the light shows is spanned by two
// axes; box coordinates run from 0 to 1 along them.
struct ArealightImage {
    uint layer;  // of the light textures, or AREALIGHT_NO_IMAGE
    vec3 corner; // where the box begins, from the light's center
    vec3 axis_u; // along its rows
    vec3 axis_v; // along its columns
    vec2 low;    // texture coordinates of the box's corner
    vec2 size;   // and its extent in them
    float longer; // side of the whole layer on the light, in roots of its area; at least 1
};

#if AREALIGHT_LIGHT_TEXTURES

// The host's bridge to the light textures: part `part` of layer `layer`, trilinear and clamped to the edge,
// at normalised coordinates, level explicit; textureLod of an array image. Part 0 is the image with its mips,
// 1 is A, 2 and 3 are B along rows and columns; with AREALIGHT_FOOTPRINT_MIPS there is part 0 alone. Alpha is
// coverage, 1 in an image: colours are divided by it.
vec4 arealight_bridge_light_texture(uint layer, uint part, vec2 coordinate, float level);
// Width and height of level 0, in texels.
int arealight_bridge_light_texture_side();

// An image in a lobe's cosine space.
struct ArealightLobeImage {
    uint layer;
    vec2 low;
    vec2 size;
    float longer;
    vec3 corner; // from the shading point
    vec3 axis_u; // of the whole layer
    vec3 axis_v;
};

// `center` is the light's, from the shading point in cosine space; `transform` takes offsets from the center
// there.
ArealightLobeImage arealight_lobe_image(ArealightImage image, vec3 center, mat3 transform) {
    ArealightLobeImage seen;
    seen.layer = image.layer;
    seen.low = image.low;
    seen.size = image.size;
    seen.longer = image.longer;
    seen.axis_u = transform * (image.axis_u / image.size.x);
    seen.axis_v = transform * (image.axis_v / image.size.y);
    seen.corner = center + transform * image.corner - image.low.x * seen.axis_u - image.low.y * seen.axis_v;
    return seen;
}

// x clamped to [low, high]; low for NaN.
vec2 arealight_clamp_coordinate(vec2 x, vec2 low, vec2 high) {
    return vec2(x.x > low.x ? min(x.x, high.x) : low.x, x.y > low.y ? min(x.y, high.y) : low.y);
}

// Where A and B are looked up, and how they are weighed.
struct ArealightImagePlace {
    vec2 coordinate; // of the layer
    float height;    // in units in which the layer's area is 1
    float weight;    // of A
    vec2 slope;      // of B
    float least;     // of the sum over A's share of it
};

// The place that stands for the clamped weight: on the way to the foot from the light's middle or, if it is
// cut, from the mean of what is seen, to which the clipped form factor `vector` points; with K's value and
// slope there. It stays as near as the filter is fine, and over the horizon. What is cut is as large as a
// square of the side `seen`: the kernel is no higher than sqrt(1.15 seen^3), lies .24 of the side farther up,
// and B counts `seen`. The numbers were found by search, against sums over what is above.
ArealightImagePlace arealight_image_place(ArealightLobeImage image, vec3 vector) {
    vec3 normal = cross(image.axis_u, image.axis_v);
    float area = max(sqrt(dot(normal, normal)), 1e-30);
    float scale = inversesqrt(area);
    float distance = dot(image.corner, normal);
    float height = max(abs(distance) / area, 1e-30);
    // How steep the plane is, and how the lobe's height rises over it
    float cosine = (distance < 0.0 ? -normal.z : normal.z) / area;
    float to_rise = inversesqrt(max(1.0 - cosine * cosine, 1e-12));
    vec2 rise = vec2(image.axis_u.z, image.axis_v.z);
    float lowest = image.corner.z + min(rise.x, 0.0) + min(rise.y, 0.0);
    float highest = image.corner.z + max(rise.x, 0.0) + max(rise.y, 0.0);
    bool is_mips = AREALIGHT_FOOTPRINT == AREALIGHT_FOOTPRINT_MIPS;
    float below = is_mips ? 0.0 : clamp(-2.5 * lowest / max(highest, 1e-30), 0.0, 1.0);
    float s = cosine * to_rise;
    float turned = below * clamp(1.0 - 0.625 * s, 0.0, 1.0);
    // What has a vector of the plane's coordinates by dot products
    vec3 to_u = cross(image.axis_v, normal) / (area * area);
    vec3 to_v = cross(normal, image.axis_u) / (area * area);
    vec2 foot = -vec2(dot(image.corner, to_u), dot(image.corner, to_v));
    float facing = max(abs(dot(vector, normal)) / area, 1e-30);
    vec2 mean = foot + height / facing * vec2(dot(vector, to_u), dot(vector, to_v));
    mean = arealight_clamp_coordinate(mean, image.low, image.low + image.size);
    mean = mix(image.low + 0.5 * image.size, mean, below);
    vec2 way = foot - mean;
    vec3 aside = scale * (way.x * image.axis_u + way.y * image.axis_v);
    float up = height * scale;
    float square = clamp(up * up + dot(aside, aside), 1e-30, 1e30);
    float seen = min(length(vector) * sqrt(3.141593 * square / facing), 1.0);
    float above = max(image.corner.z + dot(rise, mean), 1e-30);
    float share = min(max(s, 0.0) + 1.2 * inversesqrt(square), 1.0);
    share = min(share, 0.9 * above / max(above - cosine * height, 1e-30));
    share = is_mips ? 1.0 : mix(share, min(share, 1.15 * seen * seen * seen / square), turned);
    ArealightImagePlace found;
    found.coordinate = mean + share * way + 0.24 * turned * seen / scale * to_rise * vec2(to_u.z, to_v.z);
    found.height = sqrt(share * min(up * up + (1.0 - share) * dot(aside, aside), 1e30));
    vec2 weights = vec2(max((image.corner.z + dot(rise, found.coordinate)) * to_rise * scale, 1e-12),
                        mix(1.0, seen, turned) * found.height);
    weights *= inversesqrt(dot(weights, weights));
    found.weight = weights.x;
    found.slope = weights.y * scale * to_rise * rise;
    found.least = mix(0.03, 0.4, below);
    return found;
}

// A layer's coordinate where A and B are: the image fills the middle half along each axis, and what is
// outside, to infinity, the quarters beside it.
float arealight_kernel_coordinate(float x) {
    float outside = max(abs(x - 0.5) - 0.5, 0.0);
    float side = 0.25 + 0.25 * outside / (outside + 0.5);
    return outside > 0.0 ? 0.5 + (x < 0.5 ? -side : side) : 0.25 + 0.5 * x;
}

// The mean colour that a lobe sees of a light's image, whose clipped form factor is `vector`: finite and not
// negative for any input, if the image is.
vec3 arealight_footprint(ArealightLobeImage image, vec3 vector) {
    float side = float(arealight_bridge_light_texture_side());
    ArealightImagePlace place = arealight_image_place(image, vector);
    vec2 inside = arealight_clamp_coordinate(place.coordinate, image.low, image.low + image.size);
    // Of a light that shows a piece of the layer the rest is not seen, from afar either; the less there is of
    // the rest, the less it matters
    float area = min(image.size.x * image.size.y, 1.0);
    float margin = area * area * area * area / max(1.0 - area, 1e-6);
    place.coordinate = arealight_clamp_coordinate(place.coordinate, image.low - 0.25 * margin,
                                                  image.low + image.size + 0.25 * margin);
    place.height = min(place.height, 0.35 * sqrt(area) * (1.0 + margin));
    float height = place.height * side;
    if (AREALIGHT_FOOTPRINT == AREALIGHT_FOOTPRINT_MIPS) {
        // The variance h^2 / 2 of eq. 35, by mips, whose texels have a twelfth
        float level = log2(max(2.449490 * height, 1.0));
        vec4 color = arealight_bridge_light_texture(image.layer, 0u, inside, level);
        return color.rgb / max(color.a, 1e-30);
    }
    height /= image.longer;
    float level = log2(max(height, AREALIGHT_FINEST_HEIGHT) / AREALIGHT_FINEST_HEIGHT);
    vec2 coordinate = vec2(arealight_kernel_coordinate(place.coordinate.x),
                           arealight_kernel_coordinate(place.coordinate.y));
    vec4 a = arealight_bridge_light_texture(image.layer, 1u, coordinate, level);
    vec4 b_u = arealight_bridge_light_texture(image.layer, 2u, coordinate, level);
    vec4 b_v = arealight_bridge_light_texture(image.layer, 3u, coordinate, level);
    // Beyond the last level all of the image counts alike
    place.slope *= min(AREALIGHT_FINEST_HEIGHT * side / height, 1.0);
    // As much of the slope as leaves no colour below zero, and enough of what is covered
    vec4 slope = place.slope.x * b_u + place.slope.y * b_v;
    vec4 most = place.weight * vec4(vec3(1.0), 1.0 - place.least) * a / max(-slope, 1e-30);
    vec4 sum = place.weight * a + min(min(min(most.x, most.y), min(most.z, most.w)), 1.0) * slope;
    if (height < AREALIGHT_FINEST_HEIGHT) {
        // From the finest level on to the image itself
        vec4 sharp = arealight_bridge_light_texture(image.layer, 0u, inside, log2(max(height, 1.0)));
        sum = mix(sharp * (sum.a / max(sharp.a, 1e-30)), sum, height / AREALIGHT_FINEST_HEIGHT);
    }
    vec3 color = sum.rgb / max(sum.a, 1e-30);
    return mix(vec3(0.0), color, greaterThan(color, vec3(0.0)));
}

// Box coordinates of an offset from the light's center, in its plane.
vec2 arealight_image_coordinate(ArealightImage image, vec3 offset) {
    // Scaled, so that the fourth power of a length is a number
    float longest = max(arealight_max_component(image.axis_u), arealight_max_component(image.axis_v));
    float scale = arealight_power_of_two_scale(longest);
    vec3 axis_u = image.axis_u * scale;
    vec3 axis_v = image.axis_v * scale;
    vec3 from_corner = (offset - image.corner) * scale;
    vec3 normal = cross(axis_u, axis_v);
    float square = max(dot(normal, normal), 1e-37);
    return vec2(dot(cross(from_corner, axis_v), normal), dot(cross(axis_u, from_corner), normal)) / square;
}

// The image itself at an offset from the light's center, in its plane.
vec3 arealight_image_color(ArealightImage image, vec3 offset) {
    vec2 box = arealight_clamp_coordinate(arealight_image_coordinate(image, offset), vec2(0.0), vec2(1.0));
    vec4 color = arealight_bridge_light_texture(image.layer, 0u, image.low + image.size * box, 0.0);
    return color.rgb / max(color.a, 1e-30);
}

#endif
#endif
