#ifndef IMAGE_LAYERS_GLSL
#define IMAGE_LAYERS_GLSL

// Array layers of a light's image: itself, A, and B along its rows and columns (textures/footprint.glsl).
const uint IMAGE_LAYERS = 4u;

#endif
