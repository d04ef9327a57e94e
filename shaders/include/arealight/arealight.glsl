#ifndef AREALIGHT_AREALIGHT_GLSL
#define AREALIGHT_AREALIGHT_GLSL

// Arealight: analytic area lights by linearly transformed cosines.
//
//     radiance = sum over lights L_e(light)
//              x sum over lobes albedo(lobe) x F(light in the lobe's cosine space)
//
// A kind of light knows its vector form factor F in any linear space, and no lobe; a lobe knows its space and
// its albedo, and no light; light_kind.glsl sums over both. Use:
//
//     #define AREALIGHT_DISKS 1                                     // options.glsl has all options
//     #include "arealight/arealight.glsl"
//     vec4 arealight_bridge_table(int layer, ivec2 texel) { ... }   // how the library reads what is yours
//     ...
//     ArealightPoint point = arealight_point(surface);              // once a pixel
//     radiance += arealight_radiance(point, quad);                  // for each light, of any kind
//
// Reading order:
//   common.glsl, options.glsl  conventions; what a translation unit may switch
//   surface.glsl               a shading point's surface and frame
//   thin_film.glsl             what films on it reflect, and the reflectances that stand for them
//   lobes/*                    table.glsl, formula.glsl -> specular.glsl -> anisotropy.glsl, coat.glsl;
//                              diffuse.glsl; sheen.glsl; lobe.glsl
//   material.glsl              which lobes a surface has: ArealightPoint
//   form_factor/*              arcs, quads, outlines, ellipses, spheres, tubes in any linear space
//   lights/*                   a file per kind of light
//   light_kind.glsl            the loop over lobes
//   medium.glsl                a point in fog, smoke or haze: lobes/phase.glsl
//   textures/*                 what a lobe sees of a light's image
// Included by themselves:
//   shadows/*                  rays drawn from the lobes, for hosts that trace: shadow_sampling.glsl
//   reach.glsl                 how far a light is of any matter, for clusters
//   self_test.glsl             whether a host's table is loaded as it should be
#include "arealight/material.glsl"
#if AREALIGHT_QUADS
#include "arealight/lights/quad.glsl"
#endif
#if AREALIGHT_POLYGONS
#include "arealight/lights/polygon.glsl"
#endif
#if AREALIGHT_MESHES
#include "arealight/lights/mesh.glsl"
#endif
#if AREALIGHT_SHAPED
#include "arealight/lights/shaped.glsl"
#endif
#if AREALIGHT_DISKS
#include "arealight/lights/disk.glsl"
#endif
#if AREALIGHT_SPHERES
#include "arealight/lights/sphere.glsl"
#endif
#if AREALIGHT_TUBES
#include "arealight/lights/tube.glsl"
#endif

#endif
