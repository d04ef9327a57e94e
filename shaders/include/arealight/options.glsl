#ifndef AREALIGHT_OPTIONS_GLSL
#define AREALIGHT_OPTIONS_GLSL

// What a shader uses of the library: options of the translation unit. Define them before the include, as 0 or
// 1, or as an expression of literals and specialisation constants; these here are the defaults. What is off
// is not in the pipeline.

// Lobes.
#ifndef AREALIGHT_DIFFUSE
#define AREALIGHT_DIFFUSE 1
#endif
#ifndef AREALIGHT_SPECULAR
#define AREALIGHT_SPECULAR 1
#endif
// The diffuse lobe gets what the specular one's Fresnel term leaves, as in glTF:
// ArealightSurface.interface_f0, interface_f90. Else the two are added, as many engines do. And by albedo:
// with AREALIGHT_SPECULAR it gets what that lobe does not reflect of the view, as in OpenPBR.
#ifndef AREALIGHT_COUPLED
#define AREALIGHT_COUPLED 0
#endif
#ifndef AREALIGHT_COUPLED_BY_ALBEDO
#define AREALIGHT_COUPLED_BY_ALBEDO 0
#endif
// What the specular lobe's facets reflect more than once is added, as in OpenPBR; else it is lost, as in
// glTF. Metals have a diffuse lobe then.
#ifndef AREALIGHT_MULTIPLE_SCATTERING
#define AREALIGHT_MULTIPLE_SCATTERING 0
#endif
// The diffuse lobe is EON, ArealightSurface.diffuse_roughness.
#ifndef AREALIGHT_DIFFUSE_ROUGHNESS
#define AREALIGHT_DIFFUSE_ROUGHNESS 0
#endif
// A clear coat above both, ArealightSurface.coat; with a normal of its own; and with what is below getting
// what the coat does not reflect of the view, as in OpenPBR, instead of what a Fresnel term of the view
// leaves, as in glTF.
#ifndef AREALIGHT_COAT
#define AREALIGHT_COAT 0
#endif
#ifndef AREALIGHT_COAT_NORMAL
#define AREALIGHT_COAT_NORMAL 0
#endif
#ifndef AREALIGHT_COAT_BY_ALBEDO
#define AREALIGHT_COAT_BY_ALBEDO 0
#endif
// Sheen above the first two and below a coat, ArealightSurface.sheen.
#ifndef AREALIGHT_SHEEN
#define AREALIGHT_SHEEN 0
#endif

// A thin film on the surface, below sheen and a coat, ArealightSurface.film. Without it a host may put films
// into the surface's reflectances itself (thin_film.glsl): they look the same by fitted lobes, and by half
// vectors lack what a light shows of a film at its own angle.
#ifndef AREALIGHT_THIN_FILM
#define AREALIGHT_THIN_FILM 0
#endif

// The specular lobe is stretched along a tangent, ArealightSurface.anisotropy.
#ifndef AREALIGHT_ANISOTROPY
#define AREALIGHT_ANISOTROPY 0
#endif

// Some light emits from both sides: those whose record says so.
#ifndef AREALIGHT_TWO_SIDED
#define AREALIGHT_TWO_SIDED 0
#endif

// Clip lights at the surface's own horizon too, before any lobe: nothing leaks in from below
// (arealight::Horizon::Both).
#ifndef AREALIGHT_SURFACE_HORIZON
#define AREALIGHT_SURFACE_HORIZON 0
#endif

// Two transformed cosines for the specular lobe (arealight::SpecularLobes::Two), at .6 to .8 times the error
// of one.
#ifndef AREALIGHT_TWO_SPECULAR_LOBES
#define AREALIGHT_TWO_SPECULAR_LOBES 0
#endif

// The specular lobe, and a coat's, by half vectors of polygons without an image
// (arealight::SpecularLobes::HalfVectors), in the place of two lobes: lobes/half_vectors.glsl.
#ifndef AREALIGHT_HALF_VECTORS
#define AREALIGHT_HALF_VECTORS 0
#endif

// The specular lobe by formulas (arealight::Lobes::Formula): the table's bridges are not called.
#ifndef AREALIGHT_FORMULA
#define AREALIGHT_FORMULA 0
#endif

// Some light of these kinds is textured (with AREALIGHT_LIGHT_TEXTURES): those whose record says so.
#ifndef AREALIGHT_TEXTURED_POLYGONS
#define AREALIGHT_TEXTURED_POLYGONS 1
#endif
#ifndef AREALIGHT_TEXTURED_DISKS
#define AREALIGHT_TEXTURED_DISKS 1
#endif

// Some light has a profile, and some is seen through an opening (with AREALIGHT_SHAPED): those whose records
// say so.
#ifndef AREALIGHT_PROFILES
#define AREALIGHT_PROFILES 1
#endif
// Some profile is not round.
#ifndef AREALIGHT_AZIMUTHS
#define AREALIGHT_AZIMUTHS 0
#endif
#ifndef AREALIGHT_OPENINGS
#define AREALIGHT_OPENINGS 0
#endif

// How images are looked up, one of AREALIGHT_FOOTPRINT_* (arealight::Footprint).
#ifndef AREALIGHT_FOOTPRINT
#define AREALIGHT_FOOTPRINT 0
#endif

// The remaining options are 0 or 1, and nothing else: they decide which bridges a host has to define.

// Lights may be textured: textures/footprint.glsl declares the bridges.
#ifndef AREALIGHT_LIGHT_TEXTURES
#define AREALIGHT_LIGHT_TEXTURES 0
#endif

// Points in a medium, by Henyey and Greenstein's phase function: medium.glsl. It has no
// AREALIGHT_SURFACE_HORIZON, nor have surfaces beside it.
#ifndef AREALIGHT_MEDIA
#define AREALIGHT_MEDIA 0
#endif
// Lights say their solid angles, which those need.
#ifndef AREALIGHT_SOLID_ANGLES
#define AREALIGHT_SOLID_ANGLES AREALIGHT_MEDIA
#endif
#if AREALIGHT_MEDIA && !AREALIGHT_SOLID_ANGLES
#error AREALIGHT_MEDIA needs AREALIGHT_SOLID_ANGLES: leave that undefined, or define it as 1
#endif

// The kinds of lights that arealight.glsl includes.
#ifndef AREALIGHT_QUADS
#define AREALIGHT_QUADS 1
#endif
#ifndef AREALIGHT_POLYGONS
#define AREALIGHT_POLYGONS 0
#endif
#ifndef AREALIGHT_MESHES
#define AREALIGHT_MESHES 0
#endif
#ifndef AREALIGHT_SHAPED
#define AREALIGHT_SHAPED 0
#endif
#ifndef AREALIGHT_DISKS
#define AREALIGHT_DISKS 0
#endif
#ifndef AREALIGHT_SPHERES
#define AREALIGHT_SPHERES 0
#endif
#ifndef AREALIGHT_TUBES
#define AREALIGHT_TUBES 0
#endif

const bool AREALIGHT_RESCATTERS = bool(AREALIGHT_MULTIPLE_SCATTERING);
const bool AREALIGHT_HAS_DIFFUSE = AREALIGHT_RESCATTERS ? true : bool(AREALIGHT_DIFFUSE);
const bool AREALIGHT_HAS_SPECULAR = bool(AREALIGHT_SPECULAR);
const bool AREALIGHT_COUPLES_DIFFUSE = bool(AREALIGHT_COUPLED);
const bool AREALIGHT_COUPLES_BY_ALBEDO = bool(AREALIGHT_COUPLED_BY_ALBEDO);
const bool AREALIGHT_HAS_ROUGH_DIFFUSE = bool(AREALIGHT_DIFFUSE_ROUGHNESS);
const bool AREALIGHT_HAS_COAT = bool(AREALIGHT_COAT);
const bool AREALIGHT_HAS_COAT_NORMAL = bool(AREALIGHT_COAT_NORMAL);
const bool AREALIGHT_COATS_BY_ALBEDO = bool(AREALIGHT_COAT_BY_ALBEDO);
const bool AREALIGHT_HAS_ANISOTROPY = bool(AREALIGHT_ANISOTROPY);
const bool AREALIGHT_HAS_SHEEN = bool(AREALIGHT_SHEEN);
const bool AREALIGHT_HAS_THIN_FILM = bool(AREALIGHT_THIN_FILM);
const bool AREALIGHT_HAS_TWO_SIDED = bool(AREALIGHT_TWO_SIDED);
const bool AREALIGHT_HAS_TEXTURED_POLYGONS = bool(AREALIGHT_TEXTURED_POLYGONS);
const bool AREALIGHT_HAS_TEXTURED_DISKS = bool(AREALIGHT_TEXTURED_DISKS);
const bool AREALIGHT_HAS_PROFILES = bool(AREALIGHT_PROFILES);
const bool AREALIGHT_HAS_AZIMUTHS = bool(AREALIGHT_AZIMUTHS);
const bool AREALIGHT_HAS_OPENINGS = bool(AREALIGHT_OPENINGS);
// Points in a medium have no horizon.
const bool AREALIGHT_CLIPS_AT_SURFACE = bool(AREALIGHT_MEDIA) ? false : bool(AREALIGHT_SURFACE_HORIZON);
const bool AREALIGHT_USES_FORMULA = bool(AREALIGHT_FORMULA);
const bool AREALIGHT_HAS_HALF_VECTORS = bool(AREALIGHT_HALF_VECTORS);
// Not with half vectors, nor by formulas, which make one. A choice, no logical operators: compilers would
// make branches of those.
const bool AREALIGHT_HAS_TWO_SPECULAR_LOBES = AREALIGHT_USES_FORMULA ? false
    : AREALIGHT_HAS_HALF_VECTORS ? false : bool(AREALIGHT_TWO_SPECULAR_LOBES);
// Sheen is two lobes wherever the level asks for more than one specular lobe.
const bool AREALIGHT_WANTS_TWO_SHEEN_LOBES = AREALIGHT_HAS_HALF_VECTORS ? true
    : bool(AREALIGHT_TWO_SPECULAR_LOBES);
const bool AREALIGHT_HAS_TWO_SHEEN_LOBES = AREALIGHT_HAS_SHEEN ? AREALIGHT_WANTS_TWO_SHEEN_LOBES : false;

const int AREALIGHT_FOOTPRINT_KERNEL = 0; // three fetches of levels by the lobe's own kernel
const int AREALIGHT_FOOTPRINT_MIPS = 1;   // the article's: one fetch of the image's mips

#endif
