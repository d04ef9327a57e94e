#ifndef AREALIGHT_LIGHT_KIND_GLSL
#define AREALIGHT_LIGHT_KIND_GLSL

#include "arealight/material.glsl"
#if AREALIGHT_MEDIA
#include "arealight/medium.glsl"
#else
#define AREALIGHT_IN_MEDIA(Light, Local)
#endif

// The sum of a light over lobes. A kind of light is a record with `radiance`, a type for it in the shading
// frame of a point, and functions:
//
//     // The light in the shading frame; false where it does not shine onto the point's side
//     bool arealight_to_local(ArealightPoint point, Light light, out Local local);
//     // Its vector form factor in a linear space, clipped at that space's horizon: it points to where the
//     // light comes from, and its z is the form factor
//     vec3 arealight_vector_form_factor(mat3 space, Local local);
//     // The vector form factor of facets, over half vectors, and whether there is one: of polygons alone
//     // (with AREALIGHT_HALF_VECTORS). AREALIGHT_WITHOUT_HALF_VECTORS(Local) makes both for other kinds
//     vec3 arealight_facet_form_factor(ArealightFacets facets, Local local);
//     bool arealight_has_facet_form_factor(Local local);
//     // The colour of its image averaged over a lobe, 1 without: what the radiance is multiplied with
//     vec3 arealight_image_average(mat3 space, Local local, vec3 vector);
//     // Its solid angle, in [0, 4 pi] for any bits, of what shines there (with AREALIGHT_SOLID_ANGLES)
//     float arealight_solid_angle(Local local);
//
// AREALIGHT_LIGHT_KIND(Light, Local, EACH_LOBE), the last line of its file, makes of them arealight_reflected
// and arealight_radiance, and with AREALIGHT_MEDIA arealight_in_scattered (medium.glsl). EACH_LOBE is
// AREALIGHT_UNROLLED_LOBES, or for kinds whose form factor is a loop AREALIGHT_LOOPED_LOBES, where one after
// the other costs compilers less than both at once.

// What a surface reflects of a light of unit radiance towards the viewer, per channel.
struct ArealightReflected {
    vec3 diffuse;
    vec3 specular;
};

// For kinds of light without half vectors, whose edges are not straight. Its lobes are the fitted ones.
#define AREALIGHT_WITHOUT_HALF_VECTORS(Local)                                                       \
    bool arealight_has_facet_form_factor(Local local) {                                             \
        return false;                                                                               \
    }                                                                                               \
    vec3 arealight_facet_form_factor(ArealightFacets facets, Local local) {                         \
        return vec3(0.0);                                                                           \
    }

// What AREALIGHT_LIGHT_KIND makes of them:
//
//     arealight_lobe_weight  a lobe's form factor times the image's mean; where the surface's horizon clips
//                            the lobe, times its gain, which keeps its albedo, and at most 1. Over half
//                            vectors what the lobe reflects
//     arealight_lobe_albedo  what that is multiplied with; over half vectors 1
//     arealight_reflected    by lobes, of a light of unit radiance, without visibility
//     arealight_radiance     outgoing radiance towards the viewer of all lobes, W/(m^2 sr)
//
// The diffuse lobe is exact to the form factor's error; the specular lobe is the fitted one: exact for the
// table's lobe, and as close to GGX as the table's fit (docs/fit.md). Source: Heitz et al. 2016, eq. 11.
#define AREALIGHT_LIGHT_KIND(Light, Local, EACH_LOBE)                                               \
    vec3 arealight_lobe_weight(ArealightPoint point, int lobe, Local local) {                       \
        if (!arealight_has_lobe(lobe)) {                                                            \
            return vec3(0.0);                                                                       \
        }                                                                                           \
        /* Conditions one within the other, so that one of them is known before the other */        \
        if (AREALIGHT_HAS_HALF_VECTORS) {                                                           \
            if (arealight_has_facet_form_factor(local)) {                                           \
                if (lobe == AREALIGHT_LOBE_SPECULAR) {                                              \
                    vec3 facets = arealight_facet_form_factor(point.half_vectors.facets, local);    \
                    return arealight_half_vectors_reflected(point.half_vectors, facets, point.lobes[AREALIGHT_LOBE_SPECULAR].albedo); \
                }                                                                                   \
                if (AREALIGHT_HAS_COAT) {                                                           \
                    if (lobe == AREALIGHT_LOBE_COAT) {                                              \
                        vec3 facets = arealight_facet_form_factor(point.coat_half_vectors.facets, local); \
                        return arealight_half_vectors_reflected(point.coat_half_vectors, facets, point.lobes[AREALIGHT_LOBE_COAT].albedo); \
                    }                                                                               \
                }                                                                                   \
            }                                                                                       \
        }                                                                                           \
        mat3 space = arealight_lobe_at(point, lobe).space;                                          \
        vec3 vector = arealight_vector_form_factor(space, local);                                   \
        float gain = AREALIGHT_CLIPS_AT_SURFACE ? arealight_lobe_at(point, lobe).gain : 1.0;        \
        return arealight_form_factor(gain * vector) * arealight_image_average(space, local, vector); \
    }                                                                                               \
    vec3 arealight_lobe_albedo(ArealightPoint point, int lobe, Local local) {                       \
        if (AREALIGHT_HAS_HALF_VECTORS) {                                                           \
            if ((lobe == AREALIGHT_LOBE_SPECULAR || lobe == AREALIGHT_LOBE_COAT) && arealight_has_facet_form_factor(local)) { \
                return vec3(1.0);                                                                   \
            }                                                                                       \
        }                                                                                           \
        return arealight_lobe_at(point, lobe).albedo;                                               \
    }                                                                                               \
    ArealightReflected arealight_reflected(ArealightPoint point, Light light) {                     \
        ArealightReflected sum = ArealightReflected(vec3(0.0), vec3(0.0));                          \
        Local local;                                                                                \
        if (arealight_to_local(point, light, local)) {                                              \
            EACH_LOBE(sum, point, local)                                                            \
        }                                                                                           \
        return sum;                                                                                 \
    }                                                                                               \
    vec3 arealight_radiance(ArealightPoint point, Light light) {                                    \
        ArealightReflected reflected = arealight_reflected(point, light);                           \
        return light.radiance * (reflected.diffuse + reflected.specular);                           \
    }                                                                                               \
    AREALIGHT_IN_MEDIA(Light, Local)

#endif
