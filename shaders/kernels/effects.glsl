#ifndef EFFECTS_GLSL
#define EFFECTS_GLSL

// The options of the library by the bits of arealight::Effects in Rust (a test compares them). The including
// kernel has the specialisation constants EFFECTS, HORIZON, SPECULAR_LOBES, LOBES and FOOTPRINT,
// or defines the option of one that it lacks; what EFFECTS lacks is not in the pipeline.

const uint EFFECT_DIFFUSE = 1u;
const uint EFFECT_GLOSSY = 2u;
// Some light emits from both sides.
const uint EFFECT_TWO_SIDED = 4u;
// The G-buffer has a dielectric reflectance of its own.
const uint EFFECT_SPECULAR_INPUT = 8u;
// Some light is concave, not quite flat, or has more than four vertices.
const uint EFFECT_POLYGON = 16u;
// Some polygon light is textured.
const uint EFFECT_TEXTURED = 32u;
const uint EFFECT_ELLIPSE = 256u;
const uint EFFECT_SPHERE = 512u;
const uint EFFECT_TUBE = 1024u;
// Some light has several faces.
const uint EFFECT_MESH = 2048u;
// Some disk is textured; EFFECT_ELLIPSE is set then, too.
const uint EFFECT_TEXTURED_ELLIPSE = 4096u;
// Some surface has a clear coat.
const uint EFFECT_COAT = 8192u;
// Some coat has a normal of its own; EFFECT_COAT is set then, too.
const uint EFFECT_COAT_NORMAL = 16384u;
// Diffuse lobes are coupled with the Fresnel term above them.
const uint EFFECT_COUPLED = 32768u;
// They are by the specular lobe's albedo; EFFECT_COUPLED is set then, too.
const uint EFFECT_COUPLED_BY_ALBEDO = 65536u;
// Coats are layered by their albedo; EFFECT_COAT is set then, too.
const uint EFFECT_COAT_BY_ALBEDO = 131072u;
// Some diffuse lobe is rough.
const uint EFFECT_DIFFUSE_ROUGHNESS = 262144u;
// Some surface has sheen.
const uint EFFECT_SHEEN = 524288u;
// Some surface's specular lobe is stretched along a tangent.
const uint EFFECT_ANISOTROPY = 1048576u;
// What specular lobes' facets reflect more than once is added.
const uint EFFECT_MULTIPLE_SCATTERING = 2097152u;
// The pass is of light that thin surfaces let through: what the G-buffer holds is seen from behind.
const uint EFFECT_TRANSMISSION = 4194304u;
// Some surface has a thin film.
const uint EFFECT_THIN_FILM = 8388608u;
// Some thin surface is glass: for the host, which has the pass over the other side reflect specularly.
const uint EFFECT_GLASS = 16777216u;
// Some light has a profile.
const uint EFFECT_PROFILE = 33554432u;
// Some light is seen through an opening.
const uint EFFECT_OPENING = 67108864u;
// Some light shines on surfaces of some groups alone, which the G-buffer has in its stencil.
const uint EFFECT_LINKED = 134217728u;
// Some profile is not round; EFFECT_PROFILE is set then, too.
const uint EFFECT_AZIMUTH = 268435456u;

// Some light has a profile or an opening.
const uint EFFECTS_OF_SHAPED = EFFECT_PROFILE | EFFECT_OPENING;
// Some polygon is not a convex quad without an image, a profile or an opening: Effects::BEYOND_QUADS in Rust.
const uint EFFECTS_OF_POLYGONS = EFFECT_POLYGON | EFFECT_TEXTURED | EFFECT_MESH | EFFECTS_OF_SHAPED;
// Some light is a disk, sphere or tube: Effects::SHAPES in Rust.
const uint EFFECTS_OF_SHAPES = EFFECT_ELLIPSE | EFFECT_SPHERE | EFFECT_TUBE;

// Which kinds of lights there may be, apart from convex quads without an image.
const bool HAS_POLYGONS = (EFFECTS & EFFECTS_OF_POLYGONS) != 0u;
const bool HAS_MESHES = (EFFECTS & EFFECT_MESH) != 0u;
const bool HAS_SHAPED = (EFFECTS & EFFECTS_OF_SHAPED) != 0u;
const bool HAS_SHAPES = (EFFECTS & EFFECTS_OF_SHAPES) != 0u;
const bool HAS_DISKS = (EFFECTS & EFFECT_ELLIPSE) != 0u;
const bool HAS_SPHERES = (EFFECTS & EFFECT_SPHERE) != 0u;
const bool HAS_TUBES = (EFFECTS & EFFECT_TUBE) != 0u;
const bool HAS_LINKS = (EFFECTS & EFFECT_LINKED) != 0u;

// Whether surfaces face away from the viewer: arealight_other_side.
const bool IS_TRANSMITTED = (EFFECTS & EFFECT_TRANSMISSION) != 0u;

// Values of the constants of the quality, which are 0 else.
const int HORIZON_BOTH = 1;
const int SPECULAR_LOBES_TWO = 1;
const int SPECULAR_LOBES_HALF_VECTORS = 2;
const int LOBES_FORMULA = 1;

#define AREALIGHT_DIFFUSE ((EFFECTS & EFFECT_DIFFUSE) != 0u)
#define AREALIGHT_SPECULAR ((EFFECTS & EFFECT_GLOSSY) != 0u)
#define AREALIGHT_COUPLED ((EFFECTS & EFFECT_COUPLED) != 0u)
#define AREALIGHT_COUPLED_BY_ALBEDO ((EFFECTS & EFFECT_COUPLED_BY_ALBEDO) != 0u)
#define AREALIGHT_DIFFUSE_ROUGHNESS ((EFFECTS & EFFECT_DIFFUSE_ROUGHNESS) != 0u)
#define AREALIGHT_COAT ((EFFECTS & EFFECT_COAT) != 0u)
#define AREALIGHT_COAT_NORMAL ((EFFECTS & EFFECT_COAT_NORMAL) != 0u)
#define AREALIGHT_COAT_BY_ALBEDO ((EFFECTS & EFFECT_COAT_BY_ALBEDO) != 0u)
#define AREALIGHT_ANISOTROPY ((EFFECTS & EFFECT_ANISOTROPY) != 0u)
#define AREALIGHT_MULTIPLE_SCATTERING ((EFFECTS & EFFECT_MULTIPLE_SCATTERING) != 0u)
#define AREALIGHT_THIN_FILM ((EFFECTS & EFFECT_THIN_FILM) != 0u)
#define AREALIGHT_SHEEN ((EFFECTS & EFFECT_SHEEN) != 0u)
#define AREALIGHT_TWO_SIDED ((EFFECTS & EFFECT_TWO_SIDED) != 0u)
#ifndef AREALIGHT_TEXTURED_POLYGONS
#define AREALIGHT_TEXTURED_POLYGONS ((EFFECTS & EFFECT_TEXTURED) != 0u)
#endif
#define AREALIGHT_TEXTURED_DISKS ((EFFECTS & EFFECT_TEXTURED_ELLIPSE) != 0u)
#define AREALIGHT_PROFILES ((EFFECTS & EFFECT_PROFILE) != 0u)
#define AREALIGHT_AZIMUTHS ((EFFECTS & EFFECT_AZIMUTH) != 0u)
#define AREALIGHT_OPENINGS ((EFFECTS & EFFECT_OPENING) != 0u)
#define AREALIGHT_SURFACE_HORIZON (HORIZON == HORIZON_BOTH)
#define AREALIGHT_TWO_SPECULAR_LOBES (SPECULAR_LOBES == SPECULAR_LOBES_TWO)
#define AREALIGHT_HALF_VECTORS (SPECULAR_LOBES == SPECULAR_LOBES_HALF_VECTORS)
#define AREALIGHT_FORMULA (LOBES == LOBES_FORMULA)
#ifndef AREALIGHT_FOOTPRINT
#define AREALIGHT_FOOTPRINT FOOTPRINT
#endif
#define AREALIGHT_LIGHT_TEXTURES 1
#define AREALIGHT_POLYGONS 1
#define AREALIGHT_MESHES 1
#define AREALIGHT_SHAPED 1
#define AREALIGHT_DISKS 1
#define AREALIGHT_SPHERES 1
#define AREALIGHT_TUBES 1

#endif
