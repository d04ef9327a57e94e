#ifndef AREALIGHT_RESCATTERED_GLSL
#define AREALIGHT_RESCATTERED_GLSL

#include "arealight/lobes/table.glsl"

// Light that the facets of a specular lobe reflect more than once, which GGX loses: of white rough metals up
// to 60 %. With AREALIGHT_MULTIPLE_SCATTERING part of it is added in the lobe's own shape (Turquin 2019), the
// rest as from a Lambert lobe (after Fdez-Aguera 2019): a metal has that lobe then, too. A white surface
// sends all that it gets. Error against random walks on the microsurface: docs/materials.md.

// How much of it has the specular lobe's shape.
const float AREALIGHT_RESCATTERED_SPECULAR = 0.4;

// What it adds to the lobes of a surface.
struct ArealightRescattered {
    vec3 scale;   // what the specular lobe is multiplied with
    vec3 diffuse; // what is added to the diffuse lobe's albedo
};

// 1 less the albedo of a white lobe, averaged over the cosine of views: error 8e-4, for alpha = roughness^2
// in [0, 1].
float arealight_missing_albedo(float alpha) {
    float roughness = sqrt(alpha);
    float missing = -0.0064 + roughness * (0.2948 + roughness
                                           * (3.1516 + roughness * (-4.5023 + roughness * 1.6532)));
    return clamp(alpha * missing, 0.0, 1.0);
}

ArealightRescattered arealight_rescattered(ArealightTableSample table, vec3 f0, float f90) {
    float albedo = clamp(table.albedo, 1e-3, 1.0);
    float missing = arealight_missing_albedo(table.alpha);
    // Schlick's term, averaged over the cosine
    vec3 fresnel = f0 + (vec3(f90) - f0) * (1.0 / 21.0);
    vec3 more = fresnel * fresnel * (1.0 - missing) / max(vec3(1.0) - fresnel * missing, vec3(1e-3));
    return ArealightRescattered(vec3(1.0) + AREALIGHT_RESCATTERED_SPECULAR * (1.0 - albedo) / albedo * f0,
                                (1.0 - AREALIGHT_RESCATTERED_SPECULAR) * (1.0 - albedo) * more);
}

#endif
