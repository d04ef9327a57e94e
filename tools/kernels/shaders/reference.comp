#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The yardstick: integrates the true BRDF (Lambert + GGX, sheen and a coat above them) over the same lights
// by Monte Carlo, at the same G-buffer as the shade kernel: without visibility, as that one, or with shadows.
// For each light one direction drawn from its area and the sample's one direction drawn from the BRDF are
// combined by the balance heuristic (Veach and Guibas 1995); with shadows each of them is a ray, and what is
// blocked adds nothing.

layout(local_size_x = 8, local_size_y = 8) in;

#define LIGHTS_BINDING 0
#define G_BUFFER_BINDING 4
#define LIGHT_TEXTURES_BINDING 9
#define SHAPES_BINDING 10
#define COAT_BINDING 11
#define SHEEN_BINDING 12
#define ANISOTROPY_BINDING 13
#define FILM_BINDING 14
#define TRANSMITTED_BINDING 15
#define SCENE_BINDING 16
#define AREALIGHT_COAT 1
#define AREALIGHT_COAT_NORMAL 1
#define AREALIGHT_SHEEN 1
#define AREALIGHT_ANISOTROPY 1
#define AREALIGHT_THIN_FILM 1
#define AREALIGHT_LIGHT_TEXTURES 1
#define AREALIGHT_POLYGONS 1
#define AREALIGHT_MESHES 1
#define AREALIGHT_OPENINGS 1
#define AREALIGHT_AZIMUTHS 1
#define AREALIGHT_DISKS 1
#define AREALIGHT_SPHERES 1
#define AREALIGHT_TUBES 1
const bool HAS_SPECULAR_INPUT = true;

// 1: triangles of the scene block light.
layout(constant_id = 100) const uint SHADOWS = 0u;
// 1: the Lambert lobe gets what the Fresnel term leaves, as in glTF; 2: what the lobe above leaves of all
// light, and so below a coat; else it is added.
layout(constant_id = 101) const uint COUPLED = 0u;
const uint COUPLED_BY_ALBEDO = 2u;

#include "arealight/ggx.glsl"
#include "arealight/thin_film.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "polygon_lights.glsl"
#include "g_buffer.glsl"
#include "random.glsl"
#include "scene_blocker.glsl"
#include "shape_sampling.glsl"

#include "light_sampling.glsl"
#include "layers.glsl"

layout(set = 0, binding = 8, rgba32f) uniform image2D radiance_image;

layout(push_constant, std430) uniform ReferenceConstants {
    vec3 camera;
    uint light_count;
    uint first_sample;
    uint sample_count;
    float weight;
    uint seed;
    uint shape_count;
} constants;

// A coat, whose frame goes from the surface's.
struct CoatLobe {
    mat3 to_coat;
    vec3 view;         // in its frame
    float alpha;
    vec2 reflectances; // at normal and at grazing incidence, of all that it covers
    float share;       // of the light that it takes from what is below
    float probability; // of drawing from it
};

// Charlie above the base, of the view alone but for the light's direction.
struct SheenLobe {
    vec3 color;
    float roughness;
    float base; // of the light that the lobes below get
};

layout(set = 0, binding = TRANSMITTED_BINDING) uniform texture2D g_transmitted;

// A surface with its frame: directions below are in the frame, z being the normal.
struct Lobes {
    vec3 position;
    vec3 ray_origins[2]; // of shadow rays: on the side that is seen, and on the other
    mat3 to_surface;
    vec3 view;
    vec3 diffuse_albedo;
    vec2 above_diffuse; // its reflectances above the Lambert lobe, at normal and at grazing incidence
    float reflected; // what they reflect of light all around, with COUPLED_BY_ALBEDO
    vec3 f0;
    float f90;
    vec2 axis;  // of the GGX lobe, of length 1: what its first alpha is along
    vec2 alpha; // of the GGX lobe, along its axis and across it
    float glossy_probability; // of drawing from it, where not from the coat's
    CoatLobe coat;
    SheenLobe sheen;
    ArealightThinFilm film; // above the reflectances
    vec3 transmitted; // albedo of what is let through and diffused, below the interface
    vec3 pane; // of what is let through by the GGX lobe about the line of sight
    vec4 above_pane; // its interface's reflectances at normal incidence, and at grazing incidence
    float transmission_probability; // of drawing from either
    float pane_probability; // and then of drawing from the second
};

// `base`: about what the lobes below the coat reflect.
CoatLobe load_coat_lobe(ArealightFrame frame, ArealightCoat coat, float base) {
    vec3 view = vec3(frame.sin_view, 0.0, frame.cos_view);
    ArealightFrame own = arealight_coat_frame(frame, coat, view);
    float alpha = max(coat.roughness * coat.roughness, AREALIGHT_MIN_ALPHA);
    vec3 own_view = vec3(own.sin_view, 0.0, own.cos_view);
    float share = arealight_coat_share(coat, dot(own.normal, view));
    vec2 reflectances = vec2(share);
    if (COUPLED == COUPLED_BY_ALBEDO && coat.weight > 0.0) {
        reflectances = coat.weight * vec2(AREALIGHT_COAT_F0, 1.0);
        share = reflected(own_view, vec2(alpha), reflectances, AREALIGHT_NO_FILM);
    }
    float rest = (1.0 - share) * base;
    float probability = share > 0.0 ? clamp(share / (share + rest), 0.25, rest > 0.0 ? 0.75 : 1.0) : 0.0;
    return CoatLobe(arealight_frame_matrix(own), own_view, alpha, reflectances, share, probability);
}

// Where shadow rays start from a surface: off the triangle's own plane, on the side that is seen and on the
// other.
vec3[2] load_ray_origins(ArealightSurface surface, uint index) {
    if (SHADOWS == 0u) {
        return vec3[2](surface.position, surface.position);
    }
    ArealightGpuTriangle triangle = triangles[index];
    vec3 face = cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0);
    vec3 normal = arealight_normalize_or(face, surface.normal);
    normal = dot(normal, surface.view) < 0.0 ? -normal : normal;
    // Rounding of the vertices, towards the normal: 8 units in the last place of each coordinate
    vec3 largest = max(max(abs(triangle.p0), abs(triangle.p1)), abs(triangle.p2));
    float step = 9.5367431640625e-7 * dot(abs(normal), largest);
    return vec3[2](arealight_ray_origin(surface.position, normal, step),
                   arealight_ray_origin(surface.position, -normal, step));
}

// Whether light arrives by a way that is `offset` from the surface.
bool arrives(Lobes lobes, vec3 offset) {
    if (SHADOWS == 0u) {
        return true;
    }
    vec3 origin = lobes.ray_origins[(lobes.to_surface * offset).z < 0.0 ? 1 : 0];
    vec3 way = offset + (lobes.position - origin);
    float distance = length(way);
    return arealight_bridge_blocker(origin, arealight_normalize_or(way, vec3(0.0)), distance) >= distance;
}

SheenLobe load_sheen_lobe(ArealightFrame frame, ArealightSheen sheen) {
    if (sheen.color == vec3(0.0)) {
        return SheenLobe(vec3(0.0), 1.0, 1.0);
    }
    float roughness = max(sheen.roughness, AREALIGHT_SHEEN_MIN_ROUGHNESS);
    float albedo = sheen_true_albedo(vec3(frame.sin_view, 0.0,
                                          max(frame.cos_view, AREALIGHT_FORMULA_MIN_COS_VIEW)), roughness);
    return SheenLobe(sheen.color, roughness, max(1.0 - arealight_max_component(sheen.color) * albedo, 0.0));
}

// A direction of the surface's frame in the frame of its GGX lobe, and back.
vec3 to_axis(vec2 axis, vec3 direction) {
    return vec3(dot(axis, direction.xy), axis.x * direction.y - axis.y * direction.x, direction.z);
}
vec3 to_axis(Lobes lobes, vec3 direction) {
    return to_axis(lobes.axis, direction);
}
vec3 from_axis(Lobes lobes, vec3 direction) {
    return vec3(lobes.axis * direction.x + vec2(-lobes.axis.y, lobes.axis.x) * direction.y, direction.z);
}

// `through`: the albedo of what is let through, and the part of it that is not diffused; `dielectric`: the
// reflectances of its interface.
Lobes load_lobes(ArealightSurface surface, vec3 ray_origins[2], vec4 through, vec4 dielectric) {
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    vec2 roughness = vec2(surface.anisotropy.roughness, surface.roughness);
    vec2 alpha = max(roughness * roughness, vec2(AREALIGHT_MIN_ALPHA));
    vec2 axis = alpha.x == alpha.y ? vec2(1.0, 0.0)
        : arealight_surface_axis(frame, surface.anisotropy.tangent);
    float diffuse = dot(surface.diffuse_albedo, vec3(1.0 / 3.0));
    float glossy = dot(mix(surface.f0, vec3(surface.f90), 0.1), vec3(1.0 / 3.0));
    float let_through = dot(through.rgb, vec3(1.0 / 3.0));
    float transmission_probability = let_through > 0.0
        ? clamp(let_through / (let_through + glossy + diffuse), 0.25, 0.75) : 0.0;
    float probability = glossy > 0.0 ? clamp(glossy / (glossy + diffuse), 0.25, diffuse > 0.0 ? 0.9 : 1.0)
        : 0.0;
    vec3 view = vec3(frame.sin_view, 0.0, frame.cos_view);
    vec2 above_diffuse = vec2(surface.interface_f0, surface.interface_f90);
    float taken = COUPLED == COUPLED_BY_ALBEDO && diffuse + let_through > 0.0
        ? min(reflected(to_axis(axis, view), alpha, above_diffuse, surface.film), 1.0) : 0.0;
    return Lobes(surface.position, ray_origins, arealight_frame_matrix(frame), view,
                 surface.diffuse_albedo, above_diffuse, taken, surface.f0, surface.f90, axis, alpha,
                 probability, load_coat_lobe(frame, surface.coat, glossy + diffuse),
                     load_sheen_lobe(frame, surface.sheen), surface.film,
                 through.rgb * (1.0 - through.a), through.rgb * through.a, dielectric,
                 transmission_probability, through.a);
}

// The part of light from a direction that arrives below an interface that reflects `above` of it.
float arrives_below(Lobes lobes, float above) {
    return COUPLED == 0u ? 1.0 : 1.0 - (COUPLED == COUPLED_BY_ALBEDO ? lobes.reflected : above);
}

// f cos of light from behind, which the interface reflects as much of as of that from the mirror image of its
// direction.
vec3 evaluate_transmitted(Lobes lobes, vec3 light) {
    vec3 mirrored = vec3(light.xy, -light.z);
    vec3 half_vector = arealight_normalize_or(lobes.view + mirrored, vec3(0.0, 0.0, 1.0));
    float above = above_lambert(lobes.above_diffuse, lobes.film, lobes.view, half_vector);
    vec3 diffused = lobes.transmitted * (AREALIGHT_INVERSE_PI * max(mirrored.z, 0.0)
                                         * arrives_below(lobes, above));
    vec3 lobe = arealight_ggx_evaluate(to_axis(lobes, lobes.view), to_axis(lobes, mirrored), lobes.alpha,
                                       1.0 - lobes.above_pane.rgb, 1.0 - lobes.above_pane.a);
    return diffused + lobes.pane * lobe;
}

// f cos, all lobes.
vec3 evaluate(Lobes lobes, vec3 light) {
    if (light.z < 0.0) {
        return evaluate_transmitted(lobes, light);
    }
    vec3 diffuse = lobes.diffuse_albedo * (AREALIGHT_INVERSE_PI * max(light.z, 0.0));
    vec3 half_vector = arealight_normalize_or(lobes.view + light, vec3(0.0, 0.0, 1.0));
    vec3 f0 = lobes.f0;
    float f90 = lobes.f90;
    vec3 fresnel = film_fresnel(lobes.film, f0, f90, lobes.view, half_vector);
    float above = above_lambert(lobes.above_diffuse, lobes.film, lobes.view, half_vector);
    if (arealight_is_film(lobes.film)) {
        f0 = vec3(1.0);
        f90 = 1.0;
    }
    diffuse *= arrives_below(lobes, above);
    vec3 glossy = fresnel * arealight_ggx_evaluate(to_axis(lobes, lobes.view), to_axis(lobes, light),
                                                   lobes.alpha, f0, f90);
    vec3 base = diffuse + glossy;
    if (lobes.sheen.color != vec3(0.0)) {
        vec3 view = vec3(lobes.view.xy, max(lobes.view.z, AREALIGHT_FORMULA_MIN_COS_VIEW));
        base = base * lobes.sheen.base + lobes.sheen.color
            * sheen_evaluate(view, light, lobes.sheen.roughness);
    }
    CoatLobe coat = lobes.coat;
    return base * (1.0 - coat.share)
        + arealight_ggx_evaluate(coat.view, coat.to_coat * light, vec2(coat.alpha), vec3(coat.reflectances.x),
                                 coat.reflectances.y);
}

// Zero where no lobe reflects light from there: below an opaque surface, and below its coat.
float density(Lobes lobes, vec3 light) {
    if (light.z < 0.0) {
        float lobe = arealight_ggx_density(to_axis(lobes, lobes.view),
                                           to_axis(lobes, vec3(light.xy, -light.z)), lobes.alpha);
        return mix(AREALIGHT_INVERSE_PI * -light.z, lobe, lobes.pane_probability)
            * lobes.transmission_probability;
    }
    float diffuse = AREALIGHT_INVERSE_PI * max(light.z, 0.0);
    float base = mix(diffuse, arealight_ggx_density(to_axis(lobes, lobes.view), to_axis(lobes, light),
                                                    lobes.alpha), lobes.glossy_probability);
    float above = arealight_ggx_density(lobes.coat.view, lobes.coat.to_coat * light, vec2(lobes.coat.alpha));
    return mix(base, above, lobes.coat.probability) * (1.0 - lobes.transmission_probability);
}

// Of the density of a cosine.
vec3 sample_cosine(vec2 u) {
    float radius = sqrt(u.x);
    float phi = 2.0 * AREALIGHT_PI * u.y;
    return vec3(radius * cos(phi), radius * sin(phi), sqrt(max(0.0, 1.0 - u.x)));
}

vec3 sample_direction(Lobes lobes, inout RandomState random) {
    float choice = random_float(random);
    vec2 u = vec2(random_float(random), random_float(random));
    if (choice < lobes.transmission_probability) {
        if (choice >= lobes.transmission_probability * lobes.pane_probability) {
            return -sample_cosine(u);
        }
        vec3 mirrored = from_axis(lobes, arealight_ggx_sample(to_axis(lobes, lobes.view), lobes.alpha, u));
        return vec3(mirrored.xy, -mirrored.z);
    }
    choice = (choice - lobes.transmission_probability) / (1.0 - lobes.transmission_probability);
    CoatLobe coat = lobes.coat;
    if (choice < coat.probability) {
        return arealight_ggx_sample(coat.view, vec2(coat.alpha), u) * coat.to_coat;
    }
    choice = (choice - coat.probability) / (1.0 - coat.probability);
    if (choice < lobes.glossy_probability) {
        return from_axis(lobes, arealight_ggx_sample(to_axis(lobes, lobes.view), lobes.alpha, u));
    }
    return sample_cosine(u);
}

// Whether a point of a light's plane, relative to its center, lies within its outline: the even-odd rule,
// along the two axes in which the polygon is widest.
bool inside_outline(ArealightPolygonLight light, vec3 normal, vec3 point) {
    vec3 size = abs(normal);
    uint axis_u = size.x >= size.y && size.x >= size.z ? 1u : 0u;
    uint axis_v = size.z > size.x && size.z > size.y ? 1u : 2u;
    bool inside = false;
    uint end = light.first_vertex + light.vertex_count;
    vec3 a = arealight_bridge_vertex(end - 1u);
    for (uint index = light.first_vertex; index < end; index++) {
        vec3 b = arealight_bridge_vertex(index);
        if ((a[axis_v] > point[axis_v]) != (b[axis_v] > point[axis_v])) {
            float t = (point[axis_v] - a[axis_v]) / (b[axis_v] - a[axis_v]);
            inside = inside != (point[axis_u] < a[axis_u] + t * (b[axis_u] - a[axis_u]));
        }
        a = b;
    }
    return inside;
}

// One sample of one light: a point of it, weighed against the BRDF's density.
vec3 estimate_by_light(Lobes lobes, uint index, ArealightPolygonLight light,
                       ArealightGpuLightSampling sampling, inout RandomState random) {
    LightPoint point = sample_point(sampling, random);
    vec3 offset = point.offset + (light.center - lobes.position);
    float by_light = light_density(light, sampling.area, point.normal, offset, lobes.position);
    vec3 direction = lobes.to_surface * arealight_normalize_or(offset, vec3(0.0));
    float by_brdf = density(lobes, direction);
    if (by_light <= 0.0 || by_brdf <= 0.0 || !arrives(lobes, offset)) {
        return vec3(0.0);
    }
    return light_radiance(index, light, point, offset) * evaluate(lobes, direction) / (by_light + by_brdf);
}

// The sample's BRDF direction, where it meets the light, weighed against the light's density.
vec3 estimate_by_brdf(Lobes lobes, vec3 direction, float by_brdf, uint index,
                      ArealightPolygonLight light,
                      ArealightGpuLightSampling sampling) {
    // Meet the light's plane, in front of the surface
    vec3 ray = direction * lobes.to_surface;
    float speed = dot(sampling.normal, ray);
    vec3 center = light.center - lobes.position;
    float distance = dot(sampling.normal, center) / speed;
    if (!(distance > 0.0 && distance < 1e30)) {
        return vec3(0.0);
    }
    vec3 offset = ray * distance;
    float by_light = light_density(light, sampling.area, sampling.normal, offset, lobes.position);
    if (by_light <= 0.0 || !inside_outline(light, sampling.normal, offset - center) || !arrives(lobes,
                                                                                                offset)) {
        return vec3(0.0);
    }
    LightPoint met = LightPoint(offset - center, sampling.normal);
    return light_radiance(index, light, met, offset) * evaluate(lobes, direction) / (by_light + by_brdf);
}

// The same for a mesh: every triangle that the direction meets. As in the shade kernel, none hides another.
vec3 estimate_mesh_by_brdf(Lobes lobes, vec3 direction, float by_brdf, ArealightPolygonLight light,
                           ArealightGpuLightSampling sampling) {
    vec3 ray = direction * lobes.to_surface;
    vec3 center = light.center - lobes.position;
    float sum = 0.0;
    uint end = sampling.first_triangle + sampling.triangle_count;
    for (uint index = sampling.first_triangle; index < end; index++) {
        ArealightGpuLightTriangle triangle = light_triangles[index];
        vec3 a = center + arealight_bridge_vertex(triangle.vertex0);
        vec3 b = center + arealight_bridge_vertex(triangle.vertex1);
        vec3 c = center + arealight_bridge_vertex(triangle.vertex2);
        // On the same side of the three planes through the surface's point and an edge each
        vec3 volumes = vec3(dot(cross(a, b), ray), dot(cross(b, c), ray), dot(cross(c, a), ray));
        bool inside = all(greaterThanEqual(volumes, vec3(0.0))) || all(lessThanEqual(volumes, vec3(0.0)));
        vec3 normal = triangle_normal(sampling, a, b, c);
        float distance = dot(normal, a) / dot(normal, ray);
        if (inside && distance > 0.0 && distance < 1e30) {
            float by_light = light_density(light, sampling.area, normal, ray * distance, lobes.position);
            sum += by_light > 0.0 && arrives(lobes, ray * distance) ? 1.0 / (by_light + by_brdf) : 0.0;
        }
    }
    return light.radiance * evaluate(lobes, direction) * sum;
}

// As both estimates above, of a shape.
vec3 estimate_shape(Lobes lobes, vec3 direction, float by_brdf, ArealightGpuShape shape,
                    inout RandomState random) {
    vec3 sum = vec3(0.0);
    ShapeSample drawn = sample_shape(shape, lobes.position, random);
    vec3 towards = lobes.to_surface * arealight_normalize_or(drawn.offset, vec3(0.0));
    float towards_density = density(lobes, towards);
    if (drawn.density > 0.0 && towards_density > 0.0
        && arrives(lobes, part_before(shape, lobes.position, drawn.offset) * drawn.offset)) {
        vec3 color = shape_color(shape, lobes.position, drawn.offset);
        sum += color * evaluate(lobes, towards) / (drawn.density + towards_density);
    }
    if (by_brdf > 0.0) {
        vec3 ray = direction * lobes.to_surface;
        ShapeSample met = meet_shape(shape, lobes.position, ray);
        if (met.density > 0.0
            && arrives(lobes, part_before(shape, lobes.position, met.offset) * met.offset)) {
            sum += shape_color(shape, lobes.position, ray)
                * evaluate(lobes, direction) / (met.density + by_brdf);
        }
    }
    return shape.radiance * sum;
}

// Whether a light of these flags shines on a triangle.
bool shines_on(uint flags, uint triangle) {
    return light_links(flags) == 0u || is_linked(flags, triangles[triangle].flags >> TRIANGLE_GROUPS_SHIFT);
}

vec3 estimate(Lobes lobes, uint triangle, inout RandomState random) {
    vec3 direction = sample_direction(lobes, random);
    float by_brdf = density(lobes, direction);
    vec3 radiance = vec3(0.0);
    for (uint index = 0u; index < constants.light_count; index++) {
        ArealightPolygonLight light = load_polygon(lights[index]);
        ArealightGpuLightSampling sampling = light_sampling[index];
        if (sampling.triangle_count == 0u || !shines_on(lights[index].flags, triangle)) {
            continue;
        }
        radiance += estimate_by_light(lobes, index, light, sampling, random);
        if (by_brdf > 0.0 && sampling.normal == vec3(0.0)) {
            radiance += estimate_mesh_by_brdf(lobes, direction, by_brdf, light, sampling);
        } else if (by_brdf > 0.0) {
            radiance += estimate_by_brdf(lobes, direction, by_brdf, index, light, sampling);
        }
    }
    for (uint index = 0u; index < constants.shape_count; index++) {
        if (shines_on(shapes[index].flags, triangle)) {
            radiance += estimate_shape(lobes, direction, by_brdf, shapes[index], random);
        }
    }
    return radiance;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 position = texelFetch(g_position, pixel, 0);
    if (position.w == 0.0) {
        return;
    }
    ArealightSurface surface = load_surface(pixel, position.xyz, constants.camera);
    Lobes lobes = load_lobes(surface, load_ray_origins(surface, uint(position.w) - 1u),
                             texelFetch(g_transmitted, pixel, 0), texelFetch(g_specular, pixel, 0));
    vec3 sum = vec3(0.0);
    for (uint index = 0u; index < constants.sample_count; index++) {
        RandomState random = random_begin(uvec3(pixel, constants.first_sample + index), constants.seed);
        sum += estimate(lobes, uint(position.w) - 1u, random);
    }
    vec4 before = imageLoad(radiance_image, pixel);
    vec3 mean = sum / float(max(constants.sample_count, 1u));
    imageStore(radiance_image, pixel, vec4(before.rgb + mean * constants.weight, 1.0));
}
