#ifndef BLOCKERS_RAY_QUERY_GLSL
#define BLOCKERS_RAY_QUERY_GLSL

// What blocks light, from an acceleration structure of the host's, on devices with VK_KHR_ray_query: at
// binding 0 of descriptor set 1, one VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR for the compute stage. Its
// instances are relative to the origin that lights and positions are relative to. Both faces of a triangle
// block, whatever its geometry's flags; lamps are left out by the mask: they are instances without its lowest
// bit.
#extension GL_EXT_ray_query : require

layout(set = 1, binding = 0) uniform accelerationStructureEXT blocker_structure;

float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance) {
    rayQueryEXT query;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsOpaqueEXT;
    rayQueryInitializeEXT(query, blocker_structure, flags, 1u, origin, 0.0, direction, distance);
    rayQueryProceedEXT(query);
    bool is_hidden = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    return is_hidden ? rayQueryGetIntersectionTEXT(query, true) : distance;
}

#endif
