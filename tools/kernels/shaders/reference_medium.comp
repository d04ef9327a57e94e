#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The yardstick of media: puts an even one before a picture by Monte Carlo. A sample is of each light a
// distance along the pixel's ray and a point of the light, from which light comes through the medium and,
// with shadows, past the scene's triangles. It is scattered once.

layout(local_size_x = 8, local_size_y = 8) in;

#define LIGHTS_BINDING 0
#define G_BUFFER_BINDING 4
#define LIGHT_TEXTURES_BINDING 9
#define SHAPES_BINDING 10
#define SCENE_BINDING 16
#define AREALIGHT_LIGHT_TEXTURES 1
#define AREALIGHT_POLYGONS 1
#define AREALIGHT_MESHES 1
#define AREALIGHT_SHAPED 1
#define AREALIGHT_OPENINGS 1
#define AREALIGHT_AZIMUTHS 1
#define AREALIGHT_DISKS 1
#define AREALIGHT_SPHERES 1
#define AREALIGHT_TUBES 1

// 1: triangles of the scene block light.
layout(constant_id = 100) const uint SHADOWS = 0u;

#include "polygon_lights.glsl"
#include "arealight/lobes/phase.glsl"
#include "scene_blocker.glsl"
#include "shape_sampling.glsl"
#include "light_sampling.glsl"

layout(set = 0, binding = G_BUFFER_BINDING) uniform texture2D g_position;
layout(set = 0, binding = 8, rgba32f) uniform image2D radiance_image;

layout(push_constant, std430) uniform MediumReferenceConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    vec3 scattering;
    float extinction;
    uint shape_count;
    uint first_sample;
    uint sample_count;
    float weight;
    float anisotropy;
    float farthest;
    uint seed;
    uint reserved;
} constants;

// What part of the light of a point, `offset` away, arrives, if nothing but its light is beyond `part` of the
// way.
float arriving(vec3 position, vec3 offset, float part) {
    float away = length(offset);
    float end = part * away;
    bool is_hidden = SHADOWS != 0u
        && arealight_bridge_blocker(position, arealight_normalize_or(offset, vec3(0.0)), end) < end;
    return is_hidden ? 0.0 : exp(-constants.extinction * away);
}

// The pixel's ray up to its surface, and the part that the medium lets through.
struct Ray {
    vec3 away;
    float end;
    float let_through;
    float random; // the same for all samples, whose places are even so
};

// A distance along the ray, and what is let through to there over its density: half of them are drawn as the
// medium dims light, half by equal angles as a light's center sees them (Kulla and Fajardo 2012).
vec2 draw_distance(Ray ray, vec3 center, uint index) {
    float stratum = 2.0 * fract(ray.random + 0.618033989 * float(index));
    float nearest = dot(center - constants.camera, ray.away);
    float off = max(distance(center - constants.camera, nearest * ray.away), 1e-3 * ray.end);
    float first = atan(-nearest, off);
    float angles = atan(ray.end - nearest, off) - first;
    float extinction = constants.extinction;
    float dimmed = 1.0 - ray.let_through;
    float t = stratum >= 1.0 ? nearest + off * tan(first + (stratum - 1.0) * angles)
        : extinction > 0.0 ? -log(1.0 - stratum * dimmed) / extinction : stratum * ray.end;
    t = clamp(t, 0.0, ray.end);
    float through = exp(-extinction * t);
    float density = extinction > 0.0 ? extinction * through / dimmed : 1.0 / ray.end;
    density = 0.5 * (density + off / (angles * (off * off + (t - nearest) * (t - nearest))));
    return vec2(t, through / density);
}

vec3 scattered(Ray ray, uint sample_index, inout RandomState random) {
    vec3 axis = ray.away;
    vec3 sum = vec3(0.0);
    for (uint index = 0u; index < constants.light_count; index++) {
        ArealightPolygonLight light = load_polygon(lights[index]);
        ArealightGpuLightSampling sampling = light_sampling[index];
        if (sampling.triangle_count == 0u) {
            continue;
        }
        vec2 drawn = draw_distance(ray, light.center, sample_index);
        vec3 position = constants.camera + drawn.x * ray.away;
        LightPoint point = sample_point(sampling, random);
        vec3 offset = point.offset + (light.center - position);
        float density = light_density(light, sampling.area, point.normal, offset, position);
        if (density > 0.0) {
            float phase = arealight_henyey_greenstein(constants.anisotropy, dot(axis, normalize(offset)));
            float weight = drawn.y * phase * arriving(position, offset, 1.0) / density;
            sum += light_radiance(index, light, point, offset) * weight;
        }
    }
    for (uint index = 0u; index < constants.shape_count; index++) {
        ArealightGpuShape shape = shapes[index];
        vec2 drawn = draw_distance(ray, shape.center, sample_index);
        vec3 position = constants.camera + drawn.x * ray.away;
        ShapeSample point = sample_shape(shape, position, random);
        if (point.density > 0.0) {
            float cosine = dot(axis, normalize(point.offset));
            float phase = arealight_henyey_greenstein(constants.anisotropy, cosine);
            vec3 color = shape.radiance * shape_color(shape, position, point.offset);
            float arrives = arriving(position, point.offset, part_before(shape, position, point.offset));
            sum += color * (drawn.y * phase * arrives / point.density);
        }
    }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(radiance_image);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec2 clip = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec4 homogeneous = constants.position_from_clip * vec4(clip, 0.5, 1.0);
    vec3 away = normalize(homogeneous.xyz / homogeneous.w - constants.camera);
    vec4 seen = texelFetch(g_position, pixel, 0);
    float end = constants.farthest;
    if (seen.w != 0.0) {
        end = min(end, distance(seen.xyz, constants.camera));
    }
    RandomState of_pixel = random_begin(uvec3(pixel, 0xffffffffu), constants.seed);
    Ray ray = Ray(away, end, exp(-constants.extinction * end), random_float(of_pixel));
    vec3 sum = vec3(0.0);
    for (uint index = 0u; index < constants.sample_count; index++) {
        RandomState random = random_begin(uvec3(pixel, constants.first_sample + index), constants.seed);
        sum += scattered(ray, constants.first_sample + index, random);
    }
    vec4 before = imageLoad(radiance_image, pixel);
    vec3 radiance = constants.first_sample == 0u ? before.rgb * ray.let_through : before.rgb;
    vec3 mean = sum / float(max(constants.sample_count, 1u));
    imageStore(radiance_image, pixel,
               vec4(radiance + constants.scattering * mean * constants.weight, before.a));
}
