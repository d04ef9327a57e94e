#ifndef AREALIGHT_AREALIGHT_GLSL
#define AREALIGHT_AREALIGHT_GLSL

// Everything that shading needs. Define the bridges of table.glsl and polygon_light.glsl after this.
#include "arealight/polygon_light.glsl"

#endif
