#ifndef AREALIGHT_SURFACE_GLSL
#define AREALIGHT_SURFACE_GLSL

#include "arealight/common.glsl"

// A clear coat above a surface (with AREALIGHT_COAT).
struct ArealightCoat {
    vec3 normal;     // its own, of any length; zero: the surface's (with AREALIGHT_COAT_NORMAL)
    float weight;    // in [0, 1]; 0: none
    float roughness; // perceptual, in [0, 1]
};

// Sheen of a surface (with AREALIGHT_SHEEN): KHR_materials_sheen.
struct ArealightSheen {
    vec3 color;      // in [0, 1]; 0: none
    float roughness; // perceptual, in [0, 1]
};

// A thin film of even thickness on a surface: KHR_materials_iridescence. Of the surface it changes f0, f90
// and those of the interface, which are those of what lies below it (with AREALIGHT_THIN_FILM).
struct ArealightThinFilm {
    float weight;    // how much of the surface it covers, in [0, 1]; 0: none
    float ior;       // index of refraction; counts as one from 1 to 100
    float thickness; // in nanometres; one of 0 is none, above 1e5 it counts as that
};

// A specular lobe of two roughnesses (with AREALIGHT_ANISOTROPY). A highlight is the longer along the tangent
// the more this exceeds ArealightSurface.roughness, which is that across it.
struct ArealightAnisotropy {
    // Of any length, projected onto the surface; zero or along the normal: some direction of the surface
    vec3 tangent;
    float roughness; // perceptual, along the tangent, in [0, 1]
};

// A shading point and its two lobes: Lambert and GGX with Schlick's Fresnel term, added or with
// AREALIGHT_COUPLED coupled; and what lies on them.
struct ArealightSurface {
    vec3 position;       // relative to the host's origin, in the lights' unit of length
    vec3 normal;         // shading normal, of any length
    vec3 view;           // direction to the viewer, of any length
    vec3 diffuse_albedo; // in [0, 1]
    vec3 f0;             // reflectance at normal incidence, in [0, 1]
    float f90;           // reflectance at grazing incidence, in [0, 1]
    float roughness;     // perceptual, in [0, 1]
    // Of the interface that light crosses on its way to the diffuse lobe, whose channels are coupled by the
    // largest; both 0 where there is none. Read with AREALIGHT_COUPLED alone
    float interface_f0;  // reflectance at normal incidence, in [0, 1]
    float interface_f90; // at grazing incidence, in [0, 1]
    // Of EON, in [0, 1]; 0: Lambert's lobe. Read with AREALIGHT_DIFFUSE_ROUGHNESS alone
    float diffuse_roughness;
    ArealightCoat coat;  // read with AREALIGHT_COAT alone
    ArealightAnisotropy anisotropy; // read with AREALIGHT_ANISOTROPY alone
    ArealightSheen sheen; // read with AREALIGHT_SHEEN alone
    ArealightThinFilm film; // read with AREALIGHT_THIN_FILM alone
};

// The shading frame: the normal, the view's projection onto the surface, and their cross product.
struct ArealightFrame {
    vec3 tangent;   // unit, towards the view's side
    vec3 bitangent; // normal x tangent
    vec3 normal;    // unit
    float cos_view; // cosine between normal and view, 0 for a view below the surface
    float sin_view; // its sine, >= 0
};

// The reflectances of a metallic-roughness surface: Material::surface in Rust.
// base_color, metalness, dielectric_f0 and dielectric_f90 in [0, 1].
void arealight_surface_from_metalness(inout ArealightSurface surface, vec3 base_color, float metalness,
                                      vec3 dielectric_f0, float dielectric_f90) {
    surface.diffuse_albedo = base_color * (1.0 - metalness);
    surface.f0 = mix(dielectric_f0, base_color, metalness);
    surface.f90 = mix(dielectric_f90, 1.0, metalness);
    surface.interface_f0 = max(dielectric_f0.r, max(dielectric_f0.g, dielectric_f0.b));
    surface.interface_f90 = dielectric_f90;
}

// What a thin surface lets through, for arealight_other_side: `color`, a part of it as through a pane
// (KHR_materials_transmission, a GGX lobe about the line of sight), the rest diffused. The pane's lobe gets
// what Schlick's term of the interface leaves, exactly: the term is linear, and so is what is left of it.
// All in [0, 1]. Where the grazing reflectance is below 1 the lobe is grey at grazing incidence.
void arealight_surface_let_through(inout ArealightSurface surface, vec3 color, float pane,
                                   vec3 dielectric_f0, float dielectric_f90) {
    arealight_surface_from_metalness(surface, color, pane, dielectric_f0, dielectric_f90);
    surface.f0 = color * pane * (1.0 - dielectric_f0);
    surface.f90 = arealight_luminance(color) * pane * (1.0 - dielectric_f90);
}

// Perceptual roughness along the tangent, of KHR_materials_anisotropy: of a roughness, which is that across
// it, and an anisotropyStrength, both in [0, 1].
float arealight_gltf_anisotropy(float roughness, float strength) {
    return sqrt(mix(roughness * roughness, 1.0, strength * strength));
}

// Perceptual roughness along the tangent and across it of OpenPBR's specular_roughness and
// specular_roughness_anisotropy, both in [0, 1]. The sum of the squared alphas is that of the isotropic lobe.
vec2 arealight_openpbr_anisotropy(float roughness, float anisotropy) {
    float aspect = 1.0 - anisotropy;
    float along = roughness * roughness * sqrt(2.0 / (1.0 + aspect * aspect));
    return sqrt(vec2(min(along, 1.0), aspect * along));
}

// What a coat reflects at normal incidence: that of an index of refraction of 1.5.
const float AREALIGHT_COAT_F0 = 0.04;

// The part of the light that a coat reflects instead of what is below, in [0, weight]: Schlick's term of the
// view, `cos_view` being the cosine between the view and the coat's normal, on either side. What is below
// gets the rest: multiply emission by it.
float arealight_coat_share(ArealightCoat coat, float cos_view) {
    float from_normal = 1.0 - abs(cos_view);
    float square = from_normal * from_normal;
    return coat.weight * (AREALIGHT_COAT_F0 + (1.0 - AREALIGHT_COAT_F0) * (square * square * from_normal));
}

// The frame of a normal and a view, of any length. Orthonormal to 3e-7 for every input, also a view parallel
// to the normal (any tangent will do there, and within 1e-6 of it, where rounding would make one: sin_view is
// exact to 1e-6), zero vectors and NaN (which count as the z axis).
// Gram-Schmidt twice: one pass leaves an error of 1 where the view is within 1e-7 of the normal.
ArealightFrame arealight_surface_frame(vec3 normal, vec3 view) {
    ArealightFrame frame;
    frame.normal = arealight_normalize_or(normal, vec3(0.0, 0.0, 1.0));
    vec3 to_viewer = arealight_normalize_or(view, frame.normal);

    // Project the view onto the surface; where nothing is left, take the axis farthest from the normal
    vec3 tangent = to_viewer - frame.normal * dot(frame.normal, to_viewer);
    if (dot(tangent, tangent) < 1e-12) {
        vec3 axis = abs(frame.normal.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
        tangent = axis - frame.normal * dot(frame.normal, axis);
    }
    tangent = tangent * inversesqrt(dot(tangent, tangent));

    // Once more, to remove what rounding left along the normal
    tangent = tangent - frame.normal * dot(frame.normal, tangent);
    frame.tangent = tangent * inversesqrt(dot(tangent, tangent));
    frame.bitangent = cross(frame.normal, frame.tangent);

    // Take the sine from the tangent: from the cosine it would be wrong by 3e-4 near the normal
    float cosine = dot(frame.normal, to_viewer);
    frame.cos_view = clamp(cosine, 0.0, 1.0);
    frame.sin_view = cosine > 0.0 ? clamp(dot(frame.tangent, to_viewer), 0.0, 1.0) : 1.0;
    return frame;
}

// A thin surface from behind, for light that it lets through to the viewer: it faces away from the viewer,
// who is as far behind it as before it. Its members but normal and view are for the caller to set to what is
// let through (arealight_surface_let_through, or of a sheet that diffuses it diffuse_albedo alone). What it
// reflects so is the mirror image of what the front would, exactly.
ArealightSurface arealight_other_side(ArealightSurface surface) {
    surface.normal = -surface.normal;
    surface.view += surface.normal * (-2.0
                                      * dot(surface.normal,
                                            surface.view) / max(dot(surface.normal, surface.normal),
                                                                AREALIGHT_TINY));
    return surface;
}

// The matrix that takes offsets from the shading point into the frame: rows tangent, bitangent, normal.
mat3 arealight_frame_matrix(ArealightFrame frame) {
    return transpose(mat3(frame.tangent, frame.bitangent, frame.normal));
}

#endif
