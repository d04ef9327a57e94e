#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shades the tiles of one class, that the kernel classify found, with the lights of their lists.

#include "shade_tiles_main.glsl"
