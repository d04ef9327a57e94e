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

// Rungs of the form factor, see form_factor.glsl. The same numbers as arealight::FormFactor.
const int AREALIGHT_FORM_FACTOR_EXACT = 0;
const int AREALIGHT_FORM_FACTOR_FAST = 1;

#endif
