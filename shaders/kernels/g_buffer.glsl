#ifndef G_BUFFER_GLSL
#define G_BUFFER_GLSL

// Reading a G-buffer. The including kernel defines G_BUFFER_BINDING, the first of four; COAT_BINDING,
// SHEEN_BINDING, ANISOTROPY_BINDING and FILM_BINDING where it shades coats, sheen, specular lobes of two
// roughnesses or rough diffuse ones, and thin films; G_BUFFER_LAYOUT where it knows other layouts than our
// own; and HAS_SPECULAR_INPUT: whether the dielectric reflectance is an image of its own. With effects.glsl
// base colour and metalness may be of what is let through, arealight_surface_let_through.

#include "arealight/options.glsl"
#include "arealight/surface.glsl"
#include "arealight/thin_film.glsl"
#include "octahedron.glsl"

#ifndef EFFECTS_GLSL
const bool IS_TRANSMITTED = false;
#endif

// How surfaces are stored: the same as arealight::plan::GBufferLayout, which says what each image holds.
const int G_BUFFER_AREALIGHT = 0;
const int G_BUFFER_UNREAL = 1;
const int G_BUFFER_UNITY = 2;
const int G_BUFFER_OCTAHEDRAL = 3;

#ifndef G_BUFFER_LAYOUT
#define G_BUFFER_LAYOUT G_BUFFER_AREALIGHT
#endif

// 1: the host's own shader says how its surfaces are stored.
#ifndef AREALIGHT_HOST_G_BUFFER
#define AREALIGHT_HOST_G_BUFFER 0
#endif

// How many samples its texels have. The module says 1; with more the recorder makes its images multisampled
// ones, Kernel::words_for.
#ifndef G_BUFFER_SAMPLES
#define G_BUFFER_SAMPLES 1
#endif
// The sample that is read; of one the level, which is 0.
int g_buffer_sample = 0;

layout(set = 0, binding = G_BUFFER_BINDING) uniform texture2D g_position;

#if AREALIGHT_HOST_G_BUFFER

// Of the host: declares the images of the next three bindings, of COAT_BINDING, SHEEN_BINDING,
// ANISOTROPY_BINDING and FILM_BINDING as it likes, and defines arealight_bridge_surface, which sets all but
// position and view of the surface that a pixel sees, its coat with AREALIGHT_HAS_COAT, its sheen with
// AREALIGHT_HAS_SHEEN, its anisotropy with AREALIGHT_HAS_ANISOTROPY, its diffuse roughness with
// AREALIGHT_HAS_ROUGH_DIFFUSE, its film with AREALIGHT_HAS_THIN_FILM alone. It reads g_buffer_sample, so that
// images may have several samples. It lies in an include folder of the host's compiler.
ArealightSurface arealight_bridge_surface(ivec2 pixel);
#include "host_g_buffer.glsl"

ArealightSurface load_surface(ivec2 pixel, vec3 position, vec3 camera) {
    ArealightSurface surface = arealight_bridge_surface(pixel);
    surface.position = position;
    surface.view = camera - position;
    return surface;
}

#else

layout(set = 0, binding = G_BUFFER_BINDING + 1) uniform texture2D g_normal;
layout(set = 0, binding = G_BUFFER_BINDING + 2) uniform texture2D g_base_color;
layout(set = 0, binding = G_BUFFER_BINDING + 3) uniform texture2D g_specular;
#ifdef COAT_BINDING
layout(set = 0, binding = COAT_BINDING) uniform texture2D g_coat;
#endif
#ifdef SHEEN_BINDING
layout(set = 0, binding = SHEEN_BINDING) uniform texture2D g_sheen;
#endif
#ifdef ANISOTROPY_BINDING
layout(set = 0, binding = ANISOTROPY_BINDING) uniform texture2D g_anisotropy;
#endif
#ifdef FILM_BINDING
layout(set = 0, binding = FILM_BINDING) uniform texture2D g_film;
#endif

// The coat that a pixel sees, in every layout: its weight, its roughness, and its own normal's place on the
// octahedron.
ArealightCoat load_coat(ivec2 pixel) {
    ArealightCoat coat = ArealightCoat(vec3(0.0), 0.0, 0.0);
#ifdef COAT_BINDING
    if (AREALIGHT_HAS_COAT) {
        vec4 texel = texelFetch(g_coat, pixel, g_buffer_sample);
        coat = ArealightCoat(AREALIGHT_HAS_COAT_NORMAL ? from_octahedron(texel.ba) : vec3(0.0), texel.r,
                             texel.g);
    }
#endif
    return coat;
}

// The sheen that a pixel sees, in every layout: its colour, and its roughness.
ArealightSheen load_sheen(ivec2 pixel) {
    ArealightSheen sheen = ArealightSheen(vec3(0.0), 0.0);
#ifdef SHEEN_BINDING
    if (AREALIGHT_HAS_SHEEN) {
        vec4 texel = texelFetch(g_sheen, pixel, g_buffer_sample);
        sheen = ArealightSheen(texel.rgb, texel.a);
    }
#endif
    return sheen;
}

// Sets what a pixel has of two roughnesses, in every layout: the tangent's place on the octahedron, the
// perceptual roughness along it, 0 where it is the surface's, and the roughness of the diffuse lobe.
void load_anisotropy(ivec2 pixel, inout ArealightSurface surface) {
    surface.diffuse_roughness = 0.0;
    surface.anisotropy = ArealightAnisotropy(vec3(0.0), surface.roughness);
#ifdef ANISOTROPY_BINDING
    if (AREALIGHT_HAS_ANISOTROPY || AREALIGHT_HAS_ROUGH_DIFFUSE) {
        vec4 texel = texelFetch(g_anisotropy, pixel, g_buffer_sample);
        surface.diffuse_roughness = texel.a;
        surface.anisotropy = ArealightAnisotropy(from_octahedron(texel.rg), texel.b > 0.0 ? texel.b
                                                 : surface.roughness);
    }
#endif
}

// The thin film that a pixel sees, in every layout: how much of it there is, its index of refraction, and its
// thickness in nanometres.
ArealightThinFilm load_film(ivec2 pixel) {
    ArealightThinFilm film = ArealightThinFilm(0.0, 1.0, 0.0);
#ifdef FILM_BINDING
    if (AREALIGHT_HAS_THIN_FILM) {
        vec4 texel = texelFetch(g_film, pixel, g_buffer_sample);
        film = ArealightThinFilm(texel.r, texel.g, texel.b);
    }
#endif
    return film;
}

// The surface that a pixel sees from `camera`, at `position`.
ArealightSurface load_surface(ivec2 pixel, vec3 position, vec3 camera) {
    vec4 normal = texelFetch(g_normal, pixel, g_buffer_sample);
    vec4 base_color = texelFetch(g_base_color, pixel, g_buffer_sample);
    vec4 specular = vec4(0.04, 0.04, 0.04, 1.0);
    if (G_BUFFER_LAYOUT != G_BUFFER_AREALIGHT || HAS_SPECULAR_INPUT) {
        specular = texelFetch(g_specular, pixel, g_buffer_sample);
    }
    ArealightSurface surface;
    surface.position = position;
    surface.view = camera - position;
    surface.coat = load_coat(pixel);
    surface.sheen = load_sheen(pixel);
    surface.film = load_film(pixel);
    vec3 f0 = vec3(0.04);
    float f90 = 1.0;
    float metalness;
    if (G_BUFFER_LAYOUT == G_BUFFER_UNREAL) {
        surface.normal = normal.xyz * 2.0 - 1.0;
        surface.roughness = specular.b;
        metalness = specular.r;
        f0 = vec3(0.08 * specular.g);
    } else if (G_BUFFER_LAYOUT == G_BUFFER_UNITY) {
        surface.normal = normal.xyz;
        surface.roughness = 1.0 - normal.w;
        metalness = clamp((specular.r - 0.04) * (1.0 / 0.96), 0.0, 1.0);
    } else if (G_BUFFER_LAYOUT == G_BUFFER_OCTAHEDRAL) {
        surface.normal = from_octahedron(normal.xy);
        surface.roughness = specular.g;
        metalness = specular.b;
    } else {
        surface.normal = normal.xyz;
        surface.roughness = normal.w;
        metalness = base_color.a;
        f0 = specular.rgb;
        f90 = specular.a;
    }
    if (IS_TRANSMITTED) {
        arealight_surface_let_through(surface, base_color.rgb, metalness, f0, f90);
        // A pane's lobe has no film, and what is diffused has it at its interface alone
        surface.film.weight *= 1.0 - metalness;
#ifdef FILM_BINDING
        if (AREALIGHT_HAS_THIN_FILM) {
            float cos_view = arealight_surface_frame(surface.normal, surface.view).cos_view;
            arealight_put_film_on_interface(surface, surface.film, cos_view);
            surface.film = AREALIGHT_NO_FILM;
        }
#endif
    } else {
        arealight_surface_from_metalness(surface, base_color.rgb, metalness, f0, f90);
    }
    load_anisotropy(pixel, surface);
    return surface;
}

#endif

#endif
