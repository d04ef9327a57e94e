#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts tiles of 8 x 8 pixels into classes by the lights that matter to them and by how those are to be clipped.

#include "classify_main.glsl"
