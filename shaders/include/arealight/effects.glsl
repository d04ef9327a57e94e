#ifndef AREALIGHT_EFFECTS_GLSL
#define AREALIGHT_EFFECTS_GLSL

// What a scene calls for, as bits: pass them as a specialisation constant or a literal, so that the compiler
// removes the code of the others. The same bits as arealight::Effects in Rust (a test compares them).

// The Lambert lobe.
const uint AREALIGHT_EFFECT_DIFFUSE = 1u;
// The GGX lobe.
const uint AREALIGHT_EFFECT_GLOSSY = 2u;
// Some light lights both of its sides.
const uint AREALIGHT_EFFECT_TWO_SIDED = 4u;
// The G-buffer has a dielectric reflectance of its own.
const uint AREALIGHT_EFFECT_SPECULAR_INPUT = 8u;
// Some light is concave, not quite flat, or has more than four vertices.
const uint AREALIGHT_EFFECT_POLYGON = 16u;
// Some light shows an image.
const uint AREALIGHT_EFFECT_TEXTURED = 32u;
// Some light is a disk or an ellipse.
const uint AREALIGHT_EFFECT_ELLIPSE = 256u;
// Some light is a sphere.
const uint AREALIGHT_EFFECT_SPHERE = 512u;
// Some light is a cylinder or a capsule.
const uint AREALIGHT_EFFECT_TUBE = 1024u;
// Some light has several faces; AREALIGHT_EFFECT_POLYGON is set then, too.
const uint AREALIGHT_EFFECT_MESH = 2048u;
// Some disk or ellipse shows an image; AREALIGHT_EFFECT_ELLIPSE is set then, too.
const uint AREALIGHT_EFFECT_TEXTURED_ELLIPSE = 4096u;

// How edges are integrated, see form_factor.glsl. The same as arealight::FormFactor.
const int AREALIGHT_FORM_FACTOR_EXACT = 0;
const int AREALIGHT_FORM_FACTOR_DIFFERENCE = 1; // relative precision for small lights

// Where polygons are clipped. The same as arealight::Horizon.
const int AREALIGHT_HORIZON_COSINE = 0; // at the horizon of cosine space
const int AREALIGHT_HORIZON_BOTH = 1;   // at the surface's horizon too, before the lobe's transform

// How Schlick's Fresnel term enters. The same as arealight::Fresnel.
const int AREALIGHT_FRESNEL_BY_F0 = 0; // one integral, of the lobe between the table's two that the reflectance calls for
const int AREALIGHT_FRESNEL_SPLIT = 1; // two integrals, one of each lobe

// Where the glossy lobe comes from. The same as arealight::Lobes.
const int AREALIGHT_LOBES_TABLE = 0;   // the host's table
const int AREALIGHT_LOBES_FORMULA = 1; // formulas: no texture is read; the table's bridges are not called

// How a light's texture is looked up, see footprint.glsl. The same as arealight::Footprint.
const int AREALIGHT_FOOTPRINT_ROUND = 0;      // one fetch
const int AREALIGHT_FOOTPRINT_ELLIPSE = 1;    // four fetches along the longer axis
const int AREALIGHT_FOOTPRINT_SPLIT = 2;      // four by four parts of the light, two fetches each

// How a pass shades. Make the fields from specialisation constants or literals.
struct ArealightQuality {
    int form_factor; // one of AREALIGHT_FORM_FACTOR_*
    int horizon;     // one of AREALIGHT_HORIZON_*
    int fresnel;     // one of AREALIGHT_FRESNEL_*
    int lobes;       // one of AREALIGHT_LOBES_*
    int footprint;   // one of AREALIGHT_FOOTPRINT_*
};

// The quality of the Lambert lobe: the surface's horizon is that of its cosine space.
ArealightQuality arealight_diffuse_quality(ArealightQuality quality) {
    return ArealightQuality(quality.form_factor, AREALIGHT_HORIZON_COSINE, quality.fresnel, quality.lobes, quality.footprint);
}

#endif
