#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_shuffle : require

// As shade_tiles.comp, where the items of a subgroup read lights together.

#define READ_TOGETHER 1
#include "shade_tiles_main.glsl"
