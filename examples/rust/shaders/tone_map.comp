#version 450

// From radiance to what a screen takes: brightness is compressed (Reinhard) and encoded as sRGB.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D shown_image;

vec3 srgb(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
               lessThanEqual(linear, vec3(0.0031308)));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shown_image)))) {
        return;
    }
    vec3 radiance = imageLoad(radiance_image, pixel).rgb;
    imageStore(shown_image, pixel, vec4(srgb(radiance / (1.0 + radiance)), 1.0));
}
