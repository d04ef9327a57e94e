#ifndef AREALIGHT_THIN_FILM_GLSL
#define AREALIGHT_THIN_FILM_GLSL

#include "arealight/options.glsl"
#include "arealight/surface.glsl"

// Thin films: KHR_materials_iridescence. A film only changes what a facet reflects at each angle and colour:
// it is not a lobe. Two ways lead to it. A host may put it into the reflectances of its surfaces, where they
// are made: no option, and nothing in a pass. Or surfaces have it (AREALIGHT_THIN_FILM): then arealight_point
// does the same, and lobes over half vectors take what it reflects at the angle of the facets that show a
// light.
//
// Source of what a film reflects: Belcour and Barla 2017, A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence.

const ArealightThinFilm AREALIGHT_NO_FILM = ArealightThinFilm(0.0, 1.0, 0.0);

// Whether there is one; not for NaN.
bool arealight_is_film(ArealightThinFilm film) {
    return film.thickness > 0.0 && film.weight > 0.0;
}

float arealight_schlick_of(float f0, float cosine) {
    float from_normal = 1.0 - cosine;
    float square = from_normal * from_normal;
    return f0 + (1.0 - f0) * (square * square * from_normal);
}

// The colour of interference of a path in micrometres, with a phase shift in each channel: Gaussians of the
// colour matching functions in the frequency of interference, in linear Rec. 709.
vec3 arealight_interference(float path, vec3 shift) {
    float phase = 2.0 * AREALIGHT_PI * path;
    vec4 decay = exp(-phase * phase * vec4(4.3278e-3, 9.3046e-3, 6.6121e-3, 4.5282e-3));
    vec3 xyz = vec3(0.84659, 1.0002219, 1.0011225) * cos(vec3(1.681, 1.7953, 2.2084) * phase + shift)
        * decay.xyz;
    xyz.x += 0.1538683 * cos(2.2399 * phase + shift.x) * decay.w;
    return mat3(3.2404542, -0.969266, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.041556,
                1.0572252) * xyz;
}

// What a film that covers everything reflects on a base with reflectances `f0` at normal incidence, where
// light comes in at this cosine, in [0, 1]. Not below 0; a channel may exceed 1 a little, as colours outside
// of Rec. 709 do. Error: 2e-4.
vec3 arealight_thin_film_fresnel(ArealightThinFilm film, vec3 f0, float cosine) {
    float ior = film.ior > 1.0 ? min(film.ior, 100.0) : 1.0;
    float within = 1.0 - (1.0 - cosine * cosine) / (ior * ior);
    if (within < 0.0) {
        return vec3(1.0);
    }
    within = sqrt(within);
    // Reflectances of both of its sides
    float at_normal = (ior - 1.0) / (ior + 1.0);
    float above = arealight_schlick_of(at_normal * at_normal, cosine);
    vec3 root = sqrt(min(f0 + 1e-4, vec3(0.9999)));
    vec3 base = (1.0 + root) / (1.0 - root);
    vec3 step_at_normal = (base - ior) / (base + ior);
    vec3 below = step_at_normal * step_at_normal;
    below = vec3(arealight_schlick_of(below.r, within), arealight_schlick_of(below.g, within),
                 arealight_schlick_of(below.b, within));
    // Light that goes to and fro, the first two orders of its interference
    float through = 1.0 - above;
    vec3 shift = mix(vec3(AREALIGHT_PI), vec3(2.0 * AREALIGHT_PI), lessThan(base, vec3(ior)));
    vec3 both = clamp(above * below, vec3(1e-5), vec3(0.9999));
    vec3 sum = through * through * below / (1.0 - both);
    float path = 2e-3 * ior * min(film.thickness, 1e5) * within;
    vec3 order = (sum - through) * sqrt(both);
    vec3 reflected = above + sum + 2.0 * order * arealight_interference(path, shift);
    order *= sqrt(both);
    return max(reflected + 2.0 * order * arealight_interference(2.0 * path, 2.0 * shift), vec3(0.0));
}

// What a surface with Schlick's term, of reflectances in [0, 1], reflects below a film that there is, where
// light comes in at this cosine, in [0, 1]. Range as for arealight_thin_film_fresnel.
vec3 arealight_thin_film_reflectance(ArealightThinFilm film, vec3 f0, float f90, float cosine) {
    vec3 bare = f0 + (f90 - f0) * arealight_schlick_of(0.0, cosine);
    return mix(bare, arealight_thin_film_fresnel(film, f0, cosine), film.weight);
}

// Three cosines of incidence on the facets of a GGX surface that count alike: their mean at a view, and a
// deviation times the root of 1.5 to either side. Least squares over 18 roughnesses and 28 views: to .05 and
// .04, .009 on average.
vec3 arealight_facet_cosines(float cos_view, float roughness) {
    vec3 powers = vec3(1.0, roughness, roughness * roughness);
    vec3 means = powers * mat3(0.1884, 1.8039, -1.3492, -1.5012, -0.3352, 1.1703, 1.4204, -2.0118, 0.5161);
    vec3 deviations = powers * mat3(0.8436, -0.8253, 0.1986, -1.5907, 3.363, -1.8894, 0.8714, -2.5266,
                                    1.6257);
    vec3 views = roughness * vec3(1.0, cos_view, cos_view * cos_view);
    float mean = cos_view + dot(views, means);
    float deviation = 1.2247449 * max(dot(views, deviations), 0.0);
    return clamp(vec3(mean - deviation, mean, mean + deviation), 0.0, 1.0);
}

// The same of the facets that reflect what a Lambert lobe scatters from everywhere, which are those between
// the view and each direction: the deviation is that of the cosine between these two.
vec3 arealight_coupled_cosines(float cos_view) {
    float mean = cos_view * (2.0 / 3.0);
    float deviation = sqrt(0.375 - 0.2916667 * cos_view * cos_view);
    return sqrt(0.5 + 0.5 * vec3(mean - deviation, mean, mean + deviation));
}

// Replaces reflectances at normal and at grazing incidence by those that stand for a film on the surface, on
// facets at three cosines of incidence.
void arealight_thin_film_schlick_at(ArealightThinFilm film, vec3 cosines, inout vec3 f0, inout float f90) {
    if (!arealight_is_film(film)) {
        return;
    }
    vec3 mean = vec3(0.0);
    float weight = 0.0;
    for (int i = 0; i < 3; i++) {
        mean += arealight_thin_film_fresnel(film, f0, cosines[i]) * (1.0 / 3.0);
        weight += arealight_schlick_of(0.0, cosines[i]) * (1.0 / 3.0);
    }
    float grazing = clamp(min(mean.r, min(mean.g, mean.b)) / max(weight, 1e-6), 0.0, 1.0);
    vec3 normal = clamp((mean - weight * grazing) / max(1.0 - weight, 1e-3), 0.0, 1.0);
    f0 = mix(f0, normal, film.weight);
    f90 = mix(f90, grazing, film.weight);
}

// Replaces reflectances at normal and at grazing incidence by those that stand for a film on the surface, at
// a view: `cos_view` is the cosine between the shading normal and the direction to the viewer, in [0, 1];
// `roughness` perceptual, in [0, 1].
//
// A facet's angle is not the view's: three angles count, so that what the film reflects of light from
// everywhere has an error of 1.4e-3 on dielectrics and 4.7e-3 on metals (Schlick's term through the film at
// the view's own angle: 7.9e-3 and 31e-3).
void arealight_thin_film_schlick(ArealightThinFilm film, float cos_view, float roughness, inout vec3 f0,
                                 inout float f90) {
    arealight_thin_film_schlick_at(film, arealight_facet_cosines(cos_view, roughness), f0, f90);
}

// Does so for the interface above a surface's diffuse lobe, whose other members but the layers are set.
void arealight_put_film_on_interface(inout ArealightSurface surface, ArealightThinFilm film, float cos_view) {
    vec3 f0 = vec3(surface.interface_f0);
    vec3 cosines = AREALIGHT_COUPLES_BY_ALBEDO ? arealight_facet_cosines(cos_view, surface.roughness)
        : arealight_coupled_cosines(cos_view);
    arealight_thin_film_schlick_at(film, cosines, f0, surface.interface_f90);
    surface.interface_f0 = arealight_max_component(f0);
}

// Puts a film on a surface whose other members but the layers above are set: its specular lobe's
// reflectances, and its interface's.
void arealight_put_thin_film(inout ArealightSurface surface, ArealightThinFilm film) {
    float cos_view = arealight_surface_frame(surface.normal, surface.view).cos_view;
    arealight_thin_film_schlick(film, cos_view, surface.roughness, surface.f0, surface.f90);
    arealight_put_film_on_interface(surface, film, cos_view);
}

// The surface with reflectances that stand for its own film, at the cosine between its shading normal and the
// direction to the viewer, in [0, 1] (with AREALIGHT_THIN_FILM). Those of an interface that has nothing below
// stay.
ArealightSurface arealight_without_film(ArealightSurface surface, float cos_view) {
    arealight_thin_film_schlick(surface.film, cos_view, surface.roughness, surface.f0, surface.f90);
    if (AREALIGHT_COUPLES_DIFFUSE && surface.diffuse_albedo != vec3(0.0)) {
        arealight_put_film_on_interface(surface, surface.film, cos_view);
    }
    return surface;
}

#endif
