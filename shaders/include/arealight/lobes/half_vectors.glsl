#ifndef AREALIGHT_HALF_VECTORS_GLSL
#define AREALIGHT_HALF_VECTORS_GLSL

#include "arealight/form_factor/half_vectors.glsl"
#include "arealight/lobes/anisotropy.glsl"
#include "arealight/lobes/coat.glsl"
#include "arealight/lobes/formula.glsl"
#include "arealight/thin_film.glsl"

// GGX integrated over half vectors (with AREALIGHT_HALF_VECTORS): no transformed cosine stands for the lobe.
// How much of the visible normals mirrors a light to the viewer is known in closed form, up to the chords'
// error (form_factor/half_vectors.glsl); masking of the light and the Fresnel term, which vary slowly, are
// those of these normals' mean. The more of them a light has the less the mean says: `gain`, in proportion to
// their share, makes of light from everywhere the lobe's albedo. Error: docs/materials.md,
// docs/decisions/0026-half-vectors.md. It needs polygons without an image; of other lights the lobe is the
// fitted one.

// A GGX lobe by its half vectors.
struct ArealightHalfVectors {
    ArealightFacets facets;
    vec3 f0;  // reflectance at normal incidence
    vec3 f90; // at grazing incidence
    // How much more a light counts than its mean normal says, over its share of the visible normals
    vec3 gain;
    // With AREALIGHT_THIN_FILM alone, where the reflectances are those below the film
    ArealightThinFilm film;
    vec3 scale; // of what layers above let through, or more; else it is in the reflectances
};

// The direction to the viewer in a frame, for facets of this alpha, the lesser of two. Of a view along the
// surface half vectors of light that passes straight on have no direction: with less than this for the least
// cosine smooth surfaces lose .3 of a light on average, and with more rough ones .01.
vec3 arealight_facet_view(ArealightFrame frame, float alpha) {
    float least = clamp(1e-5 / alpha, 1e-3, 1e-2);
    return arealight_unit(vec3(frame.sin_view, 0.0, max(frame.cos_view, least)));
}

// The middle of the visible normals where alpha is 1, unit: the stretched view.
vec3 arealight_facet_pole(ArealightFacets facets) {
    vec3 stretched = vec3(facets.alpha, 1.0) * facets.view;
    return arealight_normalize_or(stretched, vec3(0.0, 0.0, 1.0));
}

// What the facet of a normal (where alpha is 1, of any length) reflects towards the viewer, with masking of
// the light: a channel, in [0, f90]; a film's may exceed 1 a little, as colours outside of Rec. 709 do.
vec3 arealight_facet_reflectance(ArealightHalfVectors lobe, vec3 normal) {
    ArealightFacets facets = lobe.facets;
    vec3 stretch = vec3(facets.alpha, 1.0);
    vec3 half_vector = arealight_normalize_or(stretch * normal, vec3(0.0, 0.0, 1.0));
    float cosine = clamp(dot(facets.view, half_vector), 0.0, 1.0);
    vec3 light = (2.0 * cosine) * half_vector - facets.view;
    light.z = max(light.z, 0.0);
    // Height-correlated Smith masking of both over that of the view alone
    float by_view = length(stretch * facets.view);
    float by_light = length(stretch * light);
    float shadowing = (by_view + facets.view.z)
        * light.z / max(by_view * light.z + by_light * facets.view.z, 1e-30);
    float weight = 1.0 - cosine;
    float square = weight * weight;
    vec3 fresnel = lobe.f0 + (lobe.f90 - lobe.f0) * (square * square * weight);
    if (AREALIGHT_HAS_THIN_FILM) {
        if (arealight_is_film(lobe.film)) {
            fresnel = arealight_thin_film_reflectance(lobe.film, lobe.f0, lobe.f90.x, cosine);
        }
        fresnel *= lobe.scale;
    }
    return min(shadowing, 1.0) * fresnel;
}

// The part of the visible normals that a vector form factor of facets is of, in [0, 1]; 0 for one seen from
// behind and for NaN.
float arealight_facet_share(vec3 pole, vec3 vector) {
    return arealight_form_factor(vec3(0.0, 0.0, dot(vector, pole) * 2.0 / (1.0 + pole.z)));
}

// How many times the reflectance of the mean normal the mean reflectance may be: of lobes with an F0 from .04
// on it is less. Below films that reflect next to nothing at the mean normal it would be any.
const float AREALIGHT_MOST_OF_MEAN = 2.0;

// A lobe whose albedo is `albedo`: what it reflects of light from everywhere.
ArealightHalfVectors arealight_half_vectors(ArealightFacets facets, vec3 f0, vec3 f90, ArealightThinFilm film,
                                            vec3 albedo) {
    ArealightHalfVectors lobe = ArealightHalfVectors(facets, f0, f90, vec3(0.0), film, vec3(1.0));
    vec3 sky = arealight_facet_sky(facets);
    float share = max(arealight_facet_share(arealight_facet_pole(facets), sky), 1e-6);
    vec3 mean = albedo / share / max(arealight_facet_reflectance(lobe, sky), vec3(1e-30));
    lobe.gain = (min(mean, vec3(AREALIGHT_MOST_OF_MEAN)) - 1.0) / share;
    return lobe;
}

// The specular lobe of a surface; `table` has its albedos, and `without_film` what they are of: the surface
// with reflectances that stand for a film, itself without AREALIGHT_THIN_FILM.
ArealightHalfVectors arealight_specular_half_vectors(ArealightFrame frame, ArealightSurface surface,
                                                     ArealightSurface without_film,
                                                     ArealightTableSample table) {
    ArealightFacets facets = ArealightFacets(mat3(1.0), vec2(table.alpha),
                                             arealight_facet_view(frame, table.alpha));
    if (AREALIGHT_HAS_ANISOTROPY && surface.anisotropy.roughness != surface.roughness) {
        vec2 roughness = arealight_axis_roughness(surface);
        vec2 axis = arealight_surface_axis(frame, surface.anisotropy.tangent);
        facets.alpha = roughness * roughness;
        facets.to_axes = mat3(axis.x, -axis.y, 0.0, axis.y, axis.x, 0.0, 0.0, 0.0, 1.0);
        facets.view = facets.to_axes
            * arealight_facet_view(frame, min(facets.alpha.x, facets.alpha.y));
    }
    vec3 albedo = arealight_specular_albedo(table, without_film.f0, without_film.f90);
    ArealightThinFilm film = AREALIGHT_NO_FILM;
    if (AREALIGHT_HAS_THIN_FILM) {
        film = surface.film;
    }
    return arealight_half_vectors(facets, surface.f0, vec3(surface.f90), film, albedo);
}

// That of a coat, in the shading frame of what is below it: clipped at its own horizon.
ArealightHalfVectors arealight_coat_half_vectors(ArealightFrame frame, ArealightCoat coat) {
    vec3 view = vec3(frame.sin_view, 0.0, frame.cos_view);
    ArealightFrame own = arealight_coat_frame(frame, coat, view);
    ArealightTableSample table = arealight_specular_sample(own, coat.roughness, false);
    vec2 reflectance = vec2(arealight_coat_share(coat, dot(own.normal, view)));
    if (AREALIGHT_COATS_BY_ALBEDO) {
        reflectance = coat.weight * vec2(AREALIGHT_COAT_F0, 1.0);
    }
    ArealightFacets facets = ArealightFacets(mat3(1.0), vec2(table.alpha),
                                             arealight_facet_view(own, table.alpha));
    if (AREALIGHT_HAS_COAT_NORMAL) {
        facets.to_axes = arealight_frame_matrix(own);
    }
    vec3 albedo = arealight_specular_albedo(table, vec3(reflectance.x), reflectance.y);
    return arealight_half_vectors(facets, vec3(reflectance.x), vec3(reflectance.y), AREALIGHT_NO_FILM,
                                  albedo);
}

// The lobe below a layer that lets this part of the light through, or reflecting more.
void arealight_scale_half_vectors(inout ArealightHalfVectors lobe, vec3 by) {
    if (AREALIGHT_HAS_THIN_FILM) {
        lobe.scale *= by;
    } else {
        lobe.f0 *= by;
        lobe.f90 *= by;
    }
}

// What the lobe reflects of a light of unit radiance with this vector form factor of its facets, a channel,
// in [0, albedo], `albedo` being what it reflects of light from everywhere; 0 for one seen from behind and
// for NaN.
vec3 arealight_half_vectors_reflected(ArealightHalfVectors lobe, vec3 vector, vec3 albedo) {
    float share = arealight_facet_share(arealight_facet_pole(lobe.facets), vector);
    return min(share * arealight_facet_reflectance(lobe, vector) * (1.0 + lobe.gain * share), albedo);
}

#endif
