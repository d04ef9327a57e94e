#ifndef AREALIGHT_DIFFUSE_GLSL
#define AREALIGHT_DIFFUSE_GLSL

#include "arealight/lobes/rough_diffuse.glsl"

// Lambert's lobe: the clamped cosine itself. `albedo` per channel, in [0, 1].
ArealightLobe arealight_diffuse_lobe(vec3 albedo) {
    return ArealightLobe(mat3(1.0), albedo, 1.0);
}

// What Schlick's Fresnel term of the half vector leaves of a Lambert lobe's albedo, F = f0 + (f90 - f0) (1 -
// cos theta_vh)^5 being the interface's: a function of the view's cosine in [0, 1]. In [0, 1]; error 1e-5.
float arealight_coupled_part(float cos_view, float f0, float f90) {
    float x = 1.0 - cos_view;
    float schlick = 8.19e-5 + x * (2.0063e-3 + x * (9.3423e-3 + x * (7.707e-3 + x * 9.0207e-3)));
    return (1.0 - f0) - (f90 - f0) * schlick;
}

// The shear that the Fresnel term makes of the cosine.
mat3 arealight_coupled_space(ArealightFrame frame, float f0, float f90) {
    // How much of the Fresnel term varies, of what arrives
    float varies = clamp((f90 - f0) / max(1.0 - f0, 1e-3), -1.0, 1.0);
    float square = (1.0 - frame.cos_view) * (1.0 - frame.cos_view);
    float stretch = 1.0 + varies * square * (0.028841 + 0.011653 * square);
    float shear = -varies * square * (0.012844 + 0.013407 * square);
    return mat3(stretch, 0.0, 0.0, 0.0, 1.0, 0.0, shear, 0.0, 1.0);
}

// Lambert's lobe below an interface with Schlick's Fresnel term of the half vector, as glTF couples the two:
// albedo / pi (1 - F) with F = f0 + (f90 - f0) (1 - cos theta_vh)^5. f0, f90 in [0, 1]; where both are 0 it
// is Lambert's lobe to the bit.
//
// The integral of the Fresnel term depends on the view's angle alone, and so does the lobe's shape: a shear
// towards the viewer, whose horizon stays the surface's. With an albedo of 1 and f0 = 0.04 the mean error of
// the reflected radiance is 0.26e-3 over quads of unit radiance, 3.3e-3 at the 99th percentile; Lambert's
// lobe with the same albedo has 0.61e-3, one that is not coupled 5.2e-3. Source: a least squares on the
// lobe's density (docs/decisions/0018-coupled-diffuse.md).
ArealightLobe arealight_coupled_diffuse_lobe(ArealightFrame frame, vec3 albedo, float f0, float f90) {
    return ArealightLobe(arealight_coupled_space(frame, f0, f90), albedo
                         * arealight_coupled_part(frame.cos_view, f0, f90), 1.0);
}

// The diffuse lobe of a surface. A rough one below an interface is sheared before it leans; its part above
// the surface stays.
ArealightLobe arealight_surface_diffuse_lobe(ArealightFrame frame, ArealightSurface surface) {
    ArealightLobe lobe = AREALIGHT_HAS_ROUGH_DIFFUSE
        ? arealight_rough_diffuse_lobe(frame, surface.diffuse_albedo, surface.diffuse_roughness)
        : arealight_diffuse_lobe(surface.diffuse_albedo);
    if (AREALIGHT_COUPLES_DIFFUSE && !AREALIGHT_COUPLES_BY_ALBEDO) {
        ArealightLobe coupled = arealight_coupled_diffuse_lobe(frame, lobe.albedo, surface.interface_f0,
                                                               surface.interface_f90);
        lobe.space = AREALIGHT_HAS_ROUGH_DIFFUSE ? lobe.space * coupled.space : coupled.space;
        lobe.albedo = coupled.albedo;
    }
    return lobe;
}

#endif
