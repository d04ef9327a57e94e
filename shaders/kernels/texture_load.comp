#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Resamples a part of an image into level 0 of a layer of the light textures.
// crates/arealight/src/texture_part.rs makes the constants.

layout(local_size_x = 32, local_size_y = 2) in;

#include "half.glsl"
#include "image_layers.glsl"
#include "srgb.glsl"

layout(set = 0, binding = 0) uniform texture2D source;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

layout(push_constant, std430) uniform TextureLoadConstants {
    ivec2 first_texel;  // of the source: where the middle of our first texel is, from the middle of texel 0;
    vec2 first_offset;  // and what is left of it, within 0 to 1
    vec2 stride;        // texels of the source from one texel of ours to the next
    uint flags;
    uint layer;
    float factor;       // of every texel
} constants;

// What the pipeline can do besides copying texels one to one, by bits; unused steps cost nothing.
layout(constant_id = 9) const uint LOAD_STEPS = 3u;
const uint STEP_RESAMPLING = 1u;
const uint STEP_DECODING = 2u;

const uint LOAD_SRGB = 1u;
const uint LOAD_CLAMP_U = 2u;
const uint LOAD_CLAMP_V = 4u;
const uint LOAD_MIRROR_U = 8u;
const uint LOAD_MIRROR_V = 16u;

// The texel of a row or column of `size` that stands at `texel`. In float32, which is exact to 2^21 texels:
// software divides integers one by one.
int wrap_texel(int texel, int size, bool clamped, bool mirrored) {
    int period = mirrored ? 2 * size : size;
    int wrapped = texel - period * int(floor((float(texel) + 0.5) / float(period)));
    wrapped = wrapped < size ? wrapped : period - 1 - wrapped;
    return clamp(clamped ? texel : wrapped, 0, size - 1);
}

// The texel of the source that stands at `place`.
ivec2 wrap(ivec2 place) {
    ivec2 size = textureSize(source, 0);
    return ivec2(
        wrap_texel(place.x, size.x, (constants.flags & LOAD_CLAMP_U) != 0u,
                   (constants.flags & LOAD_MIRROR_U) != 0u),
        wrap_texel(place.y, size.y, (constants.flags & LOAD_CLAMP_V) != 0u,
                   (constants.flags & LOAD_MIRROR_V) != 0u));
}

// A texel in linear light times the factor: NaN and negative numbers are zero, and what sixteen bits cannot
// hold is what they can.
vec3 fetch_linear(ivec2 texel) {
    vec3 color = texelFetch(source, texel, 0).rgb;
    if ((LOAD_STEPS & STEP_DECODING) != 0u && (constants.flags & LOAD_SRGB) != 0u) {
        color = linear_from_srgb(color);
    }
    color *= constants.factor;
    return mix(vec3(0.0), min(color, LARGEST_HALF), greaterThan(color, vec3(0.0)));
}

// The color at a texel of ours: the mean under a tent, which is as wide as two texels of the source or, where
// it is minified, of ours.
vec3 resampled(ivec2 texel) {
    // Place the tent on the source
    vec2 place = constants.first_offset + vec2(texel) * constants.stride;
    vec2 middle = place - floor(place);
    ivec2 base = constants.first_texel + ivec2(floor(place));
    vec2 radius = max(constants.stride, vec2(1.0));
    ivec2 first = ivec2(floor(middle - radius)) + 1;
    ivec2 last = ivec2(ceil(middle + radius)) - 1;

    // Sum the texels under it
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = first.y; y <= last.y; y++) {
        float row_weight = 1.0 - abs(float(y) - middle.y) / radius.y;
        for (int x = first.x; x <= last.x; x++) {
            float weight = row_weight * (1.0 - abs(float(x) - middle.x) / radius.x);
            sum += weight * fetch_linear(wrap(base + ivec2(x, y)));
            weights += weight;
        }
    }
    return min(sum / weights, LARGEST_HALF);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 extent = imageSize(out_level).xy;
    if (any(greaterThanEqual(texel, extent))) {
        return;
    }
    vec3 color = (LOAD_STEPS & STEP_RESAMPLING) != 0u
        ? resampled(texel) : fetch_linear(wrap(constants.first_texel + texel));
    imageStore(out_level, ivec3(texel, IMAGE_LAYERS * constants.layer), round_to_half(vec4(color, 1.0)));
}
