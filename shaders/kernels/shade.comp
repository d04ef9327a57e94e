#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shades a G-buffer with every light of two buffers: polygons, and shapes.

#include "shade_main.glsl"
