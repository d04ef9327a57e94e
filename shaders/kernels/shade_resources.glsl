#ifndef SHADE_RESOURCES_GLSL
#define SHADE_RESOURCES_GLSL

// What shading reads and writes, of whole frames (shade.comp) and by tiles (shade_tiles.comp), and its specialisation constants.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 15) const int SHADOW_RAYS = 0;

#define LIGHTS_BINDING 1
#define G_BUFFER_BINDING 3
#define G_BUFFER_LAYOUT LAYOUT
#define RADIANCE_BINDING 7
#define LIGHT_TEXTURES_BINDING 8
#define SHAPES_BINDING 9
#define GLOSSY_BINDING 10
#define COAT_BINDING 11
#define PICKS_BINDING 12
#include "effects.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "g_buffer.glsl"
#include "output.glsl"

#endif
