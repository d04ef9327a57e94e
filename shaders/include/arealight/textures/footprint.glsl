#ifndef AREALIGHT_FOOTPRINT_GLSL
#define AREALIGHT_FOOTPRINT_GLSL

#include "arealight/common.glsl"
#include "arealight/options.glsl"

// What a lobe sees of the image that a light shows.
//
// A lobe in its cosine space weighs the points of the light's plane with (cosine of the lobe) x (cosine of
// the light) / distance^2: a bump around a point, which we take for a Gaussian. So the image is blurred
// beforehand, by ever wider Gaussians (arealight::pyramid in Rust), and looked up where the mean direction of
// the clipped light meets its plane, at the level whose blur is that of the bump. With the distance d to that
// point and the area A of the image in cosine space, in units where A is 1, the variance is
//
//     d^2 / (1.5 A + 6 d^2)
//
// Heitz et al. 2016 (eq. 35) have r^2 / 2 with the distance r to the plane. The point where the mean
// direction meets the plane is a better place than the plane's foot, and as the light ends, so must the
// footprint: the widest is that of an even spread, nearly, as the image is mirrored at its ends. The bump is
// longer than wide where the plane is seen at an angle; better quality levels fetch along its longer axis,
// and split the light (split.glsl). The numbers were found by search, against the integral of image times
// lobe: errors are in docs/textures.md.

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
};

#if AREALIGHT_LIGHT_TEXTURES

// The host's bridge to the light textures: layer `layer`, trilinear and clamped to the edge, at normalised
// coordinates, level explicit; textureLod of an array image.
vec3 arealight_bridge_light_texture(uint layer, vec2 coordinate, float level);
// Width and height of level 0, in texels.
int arealight_bridge_light_texture_side();

// ArealightLobeImage.end of lights that fill the box of their image, and of ellipses in its middle.
const float AREALIGHT_IMAGE_END = 6.0;
const float AREALIGHT_ELLIPSE_IMAGE_END = 10.0;

// An image in a lobe's cosine space.
struct ArealightLobeImage {
    uint layer;
    vec2 low;
    vec2 size;
    vec3 corner; // from the shading point
    vec3 axis_u;
    vec3 axis_v;
    vec3 normal;  // axis_u x axis_v
    vec2 texels;  // of the box
    float last;   // level
    float end;    // inverse of the widest variance of a blur, in units of the box's area
};

// `center` is the light's, from the shading point in cosine space; `transform` takes offsets from the center
// there.
ArealightLobeImage arealight_lobe_image(ArealightImage image, vec3 center, mat3 transform) {
    ArealightLobeImage seen;
    seen.layer = image.layer;
    seen.low = image.low;
    seen.size = image.size;
    seen.corner = center + transform * image.corner;
    seen.axis_u = transform * image.axis_u;
    seen.axis_v = transform * image.axis_v;
    seen.normal = cross(seen.axis_u, seen.axis_v);
    int side = arealight_bridge_light_texture_side();
    seen.texels = float(side) * image.size;
    // The last level is four texels wide
    seen.last = float(findMSB(side) - 2);
    seen.end = AREALIGHT_IMAGE_END;
    return seen;
}

// x clamped to [low, high]; low for NaN.
vec2 arealight_clamp_coordinate(vec2 x, vec2 low, vec2 high) {
    return vec2(x.x > low.x ? min(x.x, high.x) : low.x, x.y > low.y ? min(x.y, high.y) : low.y);
}

// x where what is beyond low or high is mirrored there once; at most an end.
vec2 arealight_mirror_coordinate(vec2 x, vec2 low, vec2 high) {
    return arealight_clamp_coordinate(high - abs(high - low - abs(x - low)), low, high);
}

// The level of the pyramid whose blur is `square`, a variance in squares of level 0's texels, between two
// levels; PyramidSize::level_of in Rust.
float arealight_texture_level(float square, float last) {
    const float TENT = 0.1666666667;    // variance that bilinear lookup adds, in texels
    const float REGULAR = 0.8891666667; // of a level's blur and of bilinear lookup, in its own texels
    const float FIRST = 4.0 * REGULAR - TENT;
    if (!(square >= FIRST)) {
        return square > 0.0 ? 3.0 * square / (FIRST + 2.0 * square) : 0.0;
    }
    float octaves = 0.5 * log2((square + TENT) / REGULAR);
    float regular = last - 3.0;
    float level = min(min(octaves, regular) + max(octaves - regular, 0.0) * 0.83687, last);
    float fraction = fract(level);
    return level - 0.2 * fraction * (1.0 - fraction);
}

// The image at box coordinates, blurred by `variance`, in units of the box's area.
vec3 arealight_image_blurred(ArealightLobeImage image, vec2 box, float variance) {
    float level = arealight_texture_level(variance * image.texels.x * image.texels.y, image.last);
    return arealight_bridge_light_texture(image.layer, image.low + image.size * box, level);
}

// The point of the image's plane that the light comes from.
struct ArealightPlaneHit {
    vec2 box;     // its box coordinates, not clamped
    float square; // its squared distance
};

// `toward` is where the light comes from, a vector of any length, either way along it.
ArealightPlaneHit arealight_plane_hit(ArealightLobeImage image, vec3 toward) {
    // Meet the plane along the mean direction
    vec3 direction = toward / max(arealight_max_component(toward), 1e-30);
    float denominator = dot(direction, image.normal);
    float reciprocal = abs(denominator) > 1e-30 ? 1.0 / denominator : 0.0;
    ArealightPlaneHit hit;
    hit.box = reciprocal * vec2(dot(direction, cross(image.axis_v, image.corner)),
                                  dot(direction, cross(image.corner, image.axis_u)));
    float t = dot(image.corner, image.normal) * reciprocal;
    float square = t * t * dot(direction, direction);
    hit.square = square < 1e30 ? square : 1e30;
    return hit;
}

// The footprint's ellipse, in units of the box's area: box coordinates that are stretched so that texels are
// as long in both directions.
struct ArealightFootprintEllipse {
    vec2 axis;   // the longer one's direction, in box coordinates
    float major; // variances
    float minor;
};

// The inverse of the covariance is `bump` over the squared distance, of the lobe, and `end`, in units of the
// box.
ArealightFootprintEllipse arealight_footprint_ellipse(ArealightLobeImage image, float square, float bump,
                                                      float end) {
    float stretch = sqrt(image.texels.x / image.texels.y);
    vec3 u = image.axis_u / stretch;
    vec3 v = image.axis_v * stretch;
    bump /= max(square, AREALIGHT_TINY);
    float xx = bump * dot(u, u) + end / (stretch * stretch);
    float yy = bump * dot(v, v) + end * (stretch * stretch);
    float xy = bump * dot(u, v);
    // Its eigenvalues, the smaller one by the determinant
    float mean = 0.5 * (xx + yy);
    float skew = 0.5 * (xx - yy);
    float spread = sqrt(skew * skew + xy * xy);
    float largest = mean + spread;
    float smallest = max((xx * yy - xy * xy) / largest, 1e-6 * largest);
    vec2 axis = skew < 0.0 ? vec2(spread - skew, -xy) : vec2(-xy, spread + skew);
    ArealightFootprintEllipse ellipse;
    ellipse.axis = axis * inversesqrt(dot(axis, axis) + AREALIGHT_TINY) / vec2(stretch, 1.0 / stretch);
    ellipse.major = 1.0 / smallest;
    ellipse.minor = 1.0 / largest;
    return ellipse;
}

// The mean colour that a lobe sees of a light's image, `toward` being where the light comes from in its
// cosine space: finite and not negative for any input, if the image is. One fetch, or four along the longer
// axis.
vec3 arealight_footprint(ArealightLobeImage image, vec3 toward) {
    ArealightPlaneHit hit = arealight_plane_hit(image, toward);
    vec2 box = arealight_clamp_coordinate(hit.box, vec2(0.0), vec2(1.0));
    if (AREALIGHT_FOOTPRINT == AREALIGHT_FOOTPRINT_ROUND) {
        float area = sqrt(dot(image.normal, image.normal));
        return arealight_image_blurred(image, box, hit.square / (1.5 * area + image.end * hit.square));
    }
    // The variance that the taps lack along the axis lies between them
    ArealightFootprintEllipse ellipse = arealight_footprint_ellipse(image, hit.square, 1.5, image.end);
    float variance = min(ellipse.major, max(ellipse.minor, 0.08265625 * ellipse.major));
    vec2 step = sqrt(ellipse.major - variance) * ellipse.axis;
    vec3 color = vec3(0.0);
    for (int tap = 0; tap < 4; tap++) {
        float offset = (tap & 1) == 0 ? 0.378 : 1.363;
        vec2 place = box + step * (tap < 2 ? offset : -offset);
        color += arealight_image_blurred(image, arealight_mirror_coordinate(place, vec2(0.0), vec2(1.0)),
                                         variance);
    }
    return 0.25 * color;
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
    return arealight_bridge_light_texture(image.layer, image.low + image.size * box, 0.0);
}

#endif
#endif
