#ifndef LIGHT_RECORDS_GLSL
#define LIGHT_RECORDS_GLSL

// The records of polygon lights. The including kernel defines LIGHTS_BINDING.

#include "buffers.glsl"
#include "together.glsl"

#if READ_TOGETHER

layout(set = 0, binding = LIGHTS_BINDING, std430) readonly buffer Lights {
    uvec4 lights[]; // eight rows a light
};

// The record of a light, which is the same for all of the subgroup.
ArealightGpuLight light_record(uint index) {
    uvec4 row = lights[index * 8u + row_to_read(8u)];
    uvec4 place = subgroupShuffle(row, 1u);
    uvec4 area = subgroupShuffle(row, 2u);
    uvec4 kind = subgroupShuffle(row, 3u);
    uvec4 corner = subgroupShuffle(row, 4u);
    uvec4 axis_u = subgroupShuffle(row, 5u);
    uvec4 axis_v = subgroupShuffle(row, 6u);
    vec4 box = uintBitsToFloat(subgroupShuffle(row, 7u));
    row = subgroupShuffle(row, 0u);
    return ArealightGpuLight(uintBitsToFloat(row.xyz), row.w, uintBitsToFloat(place.xyz), uintBitsToFloat(place.w),
                             uintBitsToFloat(area.xyz), area.w, kind.x, kind.y, kind.z, kind.w,
                             uintBitsToFloat(corner.xyz), corner.w, uintBitsToFloat(axis_u.xyz), axis_u.w,
                             uintBitsToFloat(axis_v.xyz), axis_v.w, box.xy, box.zw);
}

#else

layout(set = 0, binding = LIGHTS_BINDING, std430) readonly buffer Lights {
    ArealightGpuLight lights[];
};

// The record of a light.
ArealightGpuLight light_record(uint index) {
    return lights[index];
}

#endif

#endif
