#ifndef LIGHT_RECORDS_GLSL
#define LIGHT_RECORDS_GLSL

// The records of polygon lights. The including kernel defines LIGHTS_BINDING.

#include "buffers.glsl"

layout(set = 0, binding = LIGHTS_BINDING, std430) readonly buffer Lights {
    ArealightGpuLight lights[];
};

// The record of a light.
ArealightGpuLight light_record(uint index) {
    return lights[index];
}

#endif
