#ifndef CASES_GLSL
#define CASES_GLSL

// A list of shading points, and where their radiance goes. Their lights' centers are relative to them. The
// including kernel defines CASES_BINDING; the results are at the binding after it.

struct ArealightGpuCase {
    vec3 normal;
    float roughness;
    vec3 view;
    float f90;
    vec3 diffuse_albedo;
    uint light;
    vec3 f0;
    float coat_weight;
    vec3 coat_normal;
    float coat_roughness;
    vec3 sheen_color;
    float sheen_roughness;
    float interface_f0;
    float interface_f90;
    float diffuse_roughness;
    float reserved;
    vec3 tangent;
    float tangent_roughness;
    float film_weight;
    float film_ior;
    float film_thickness;
    float reserved1;
};

layout(set = 0, binding = CASES_BINDING, std430) readonly buffer Cases {
    ArealightGpuCase cases[];
};
layout(set = 0, binding = CASES_BINDING + 1, std430) writeonly buffer Results {
    vec4 results[];
};

layout(push_constant, std430) uniform EvalConstants {
    uint case_count;
} constants;

ArealightSurface case_surface(ArealightGpuCase given) {
    return ArealightSurface(vec3(0.0), given.normal, given.view, given.diffuse_albedo, given.f0, given.f90,
                            given.roughness, given.interface_f0, given.interface_f90, given.diffuse_roughness,
                            ArealightCoat(given.coat_normal, given.coat_weight, given.coat_roughness),
                            ArealightAnisotropy(given.tangent, given.tangent_roughness),
                            ArealightSheen(given.sheen_color, given.sheen_roughness),
                            ArealightThinFilm(given.film_weight, given.film_ior, given.film_thickness));
}

#endif
