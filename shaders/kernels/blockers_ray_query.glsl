#ifndef BLOCKERS_RAY_QUERY_GLSL
#define BLOCKERS_RAY_QUERY_GLSL

// What blocks light, from an acceleration structure of the host's, on devices with VK_KHR_ray_query: at
// binding 0 of descriptor set 1, one VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR for the compute stage. Its
// instances are relative to the origin that lights and positions are relative to. Both faces of a triangle
// block, of instances whose mask has its lowest bit. With AREALIGHT_HOST_ALPHA 1 the host's shader is asked
// of triangles that are not opaque by the flags of their geometry and instance; else all are.
#extension GL_EXT_ray_query : require
#ifndef AREALIGHT_HOST_ALPHA
#define AREALIGHT_HOST_ALPHA 0
#endif
#if AREALIGHT_HOST_ALPHA
#include "blocker_alpha.glsl"
#endif

layout(set = 1, binding = 0) uniform accelerationStructureEXT blocker_structure;

float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance) {
    rayQueryEXT query;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT;
#if !AREALIGHT_HOST_ALPHA
    flags |= gl_RayFlagsOpaqueEXT;
#endif
    rayQueryInitializeEXT(query, blocker_structure, flags, 1u, origin, 0.0, direction, distance);
#if AREALIGHT_HOST_ALPHA
    while (rayQueryProceedEXT(query)) {
        if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT) {
            uint instance = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false)
                                 + rayQueryGetIntersectionGeometryIndexEXT(query, false));
            uint triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
            vec2 barycentric = rayQueryGetIntersectionBarycentricsEXT(query, false);
            if (blocker_hides(instance, triangle, barycentric, direction)) {
                rayQueryConfirmIntersectionEXT(query);
            }
        }
    }
#else
    rayQueryProceedEXT(query);
#endif
    bool is_hidden = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    return is_hidden ? rayQueryGetIntersectionTEXT(query, true) : distance;
}

#endif
