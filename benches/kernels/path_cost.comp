#version 450
#extension GL_GOOGLE_include_directive : require
#include "arealight/arealight.glsl"

// The pixel of deferred_yardstick.comp without branches: each path through a quad light by itself, for a
// compiler's statistics. What branches decide is computed and added to the result, so that no test is
// dropped. Never run.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DArray table;
// Position; normal, roughness; base colour, metalness
layout(set = 0, binding = 1) uniform sampler2D g_buffer[3];
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D radiance_image;
struct Lamp { vec3 radiance; float reserved0; vec3 center; float reserved1; vec3 normal; float reserved2;
    vec4 vertices[4]; vec4 padding; };
layout(set = 0, binding = 3, std430) readonly buffer Lamps { Lamp lamps[]; };
layout(push_constant) uniform Frame { vec3 camera; uint lamp_count; } frame;

// The same values as in benches/src/model/costs.rs.
const int METHOD_EXACT = 0;
const int METHOD_CLIPLESS = 1;
const int PATH_TESTED = 0;     // whether it is above alone
const int PATH_BELOW = 1;
const int PATH_ACUTE = 2;      // above the horizon, in all invocations with acute edges
const int PATH_NOT_ACUTE = 3;  // in none
const int PATH_MIXED = 4;      // in some
const int PATH_CROSSING_1 = 5; // with one vertex above
const int PATH_CROSSING_2 = 6;
const int PATH_CROSSING_3 = 7;

layout(constant_id = 0) const int METHOD = METHOD_EXACT;
layout(constant_id = 1) const bool IN_FRONT = true; // else behind the light
layout(constant_id = 2) const int DIFFUSE = 0;      // PATH_*
layout(constant_id = 3) const int SPECULAR = 0;
layout(constant_id = 4) const bool LOOPS = true; // over the lights; else one light

vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }

#include "yardsticks.glsl"

// arealight_quad_crossing for quads with that many vertices above the horizon.
vec3 crossing(ArealightQuad quad, int above) {
    ArealightQuad turned = arealight_turned(quad);
    vec3 last = arealight_unit(turned.a);
    vec3 next = turned.b;
    vec3 entry = vec3(arealight_crossing(last, turned.d), 0.0);
    vec3 arcs = arealight_arc(entry, last);
    if (above > 1) {
        vec3 b = arealight_unit(turned.b);
        arcs += arealight_arc(last, b);
        last = b;
        next = turned.c;
        if (above > 2) {
            vec3 c = arealight_unit(turned.c);
            arcs += arealight_arc(last, c);
            last = c;
            next = turned.d;
        }
    }
    vec3 exit = vec3(arealight_crossing(last, next), 0.0);
    arcs += arealight_arc(last, exit);
    return arcs + arealight_horizon_arc(exit.xy, entry.xy, -arcs.z, 1.0);
}

// The arcs of a quad above the horizon where the edges of all invocations, none or some are acute.
vec3 arcs_above(ArealightQuad quad, int path) {
    ArealightQuad unit =
        ArealightQuad(quad.a * inversesqrt(dot(quad.a, quad.a)), quad.b * inversesqrt(dot(quad.b, quad.b)),
                      quad.c * inversesqrt(dot(quad.c, quad.c)), quad.d * inversesqrt(dot(quad.d, quad.d)));
    vec4 cosine = vec4(dot(unit.a, unit.b), dot(unit.b, unit.c), dot(unit.c, unit.d), dot(unit.d, unit.a));
    vec3 arcs = vec3(0.0, 0.0, min(min(cosine.x, cosine.y), min(cosine.z, cosine.w)));
    if (path != PATH_NOT_ACUTE) {
        arcs += arealight_acute_arcs(unit, cosine);
    }
    if (path != PATH_ACUTE) {
        arcs += arealight_arc(unit.a, unit.b) + arealight_arc(unit.b, unit.c) + arealight_arc(unit.c, unit.d)
              + arealight_arc(unit.d, unit.a);
    }
    return arcs;
}

vec3 arcs_by(int path, ArealightQuad quad) {
    switch (path) {
    case PATH_ACUTE:
    case PATH_NOT_ACUTE:
    case PATH_MIXED:
        return arcs_above(quad, path);
    case PATH_CROSSING_1:
        return crossing(quad, 1);
    case PATH_CROSSING_2:
        return crossing(quad, 2);
    case PATH_CROSSING_3:
        return crossing(quad, 3);
    default:
        return vec3(0.0);
    }
}

// A lobe's form factor by a path, behind the tests of arealight_quad_vector that lead there.
float lobe_form_factor(int path, mat3 space, ArealightLocalQuad local) {
    ArealightQuad quad = arealight_transformed(space, local.quad);
    float tested = arealight_lowest(quad);
    if (path == PATH_BELOW || path >= PATH_CROSSING_1) {
        tested = tested > 0.0 ? tested : arealight_highest(quad);
    }
    return arealight_form_factor(AREALIGHT_PER_ARC * (vec3(0.0, 0.0, tested) + arcs_by(path, quad)));
}

vec3 exact(ArealightPoint point, uint index) {
    ArealightQuad quad = ArealightQuad(lamps[index].vertices[0].xyz, lamps[index].vertices[1].xyz,
                                       lamps[index].vertices[2].xyz, lamps[index].vertices[3].xyz);
    vec3 offset = lamps[index].center - point.position;
    float side = arealight_lit_side(offset, lamps[index].normal, false, 0.0);
    vec3 radiance = vec3(side, 0.0, 0.0);
    if (IN_FRONT) {
        // Scalar units do this beside the rest; by itself it would be what the compiler's estimate tells
        radiance.x = arealight_is_finite(quad) ? side : 0.0;
        ArealightLocalQuad local;
        local.quad = arealight_quad_in_frame(point.to_frame, point.to_frame * offset, quad);
        ArealightLobe diffuse = point.lobes[AREALIGHT_LOBE_DIFFUSE];
        ArealightLobe specular = point.lobes[AREALIGHT_LOBE_SPECULAR];
        radiance += lamps[index].radiance * (diffuse.albedo * lobe_form_factor(DIFFUSE, diffuse.space, local)
                                             + specular.albedo
                                                 * lobe_form_factor(SPECULAR, specular.space, local));
    }
    return radiance;
}

// As in deferred_yardstick.comp.
vec3 clipless(ArealightPoint point, mat3 specular_space, uint index) {
    vec3 center = lamps[index].center - point.position;
    vec3 radiance = vec3(dot(lamps[index].normal, center) < 0.0 ? 1.0 : 0.0, 0.0, 0.0);
    if (IN_FRONT) {
        vec3 v0 = center + lamps[index].vertices[0].xyz;
        vec3 v1 = center + lamps[index].vertices[1].xyz;
        vec3 v2 = center + lamps[index].vertices[2].xyz;
        vec3 v3 = center + lamps[index].vertices[3].xyz;
        mat3 s = specular_space, d = point.to_frame;
        float specular = yardstick_quad(YARDSTICK_CLIPLESS, s * v0, s * v1, s * v2, s * v3);
        float diffuse = yardstick_quad(YARDSTICK_CLIPLESS, d * v0, d * v1, d * v2, d * v3);
        radiance += lamps[index].radiance * (point.lobes[AREALIGHT_LOBE_SPECULAR].albedo * specular
                                             + point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo * diffuse);
    }
    return radiance;
}

vec3 shaded(ArealightPoint point, mat3 specular_space, uint index) {
    if (METHOD == METHOD_CLIPLESS) {
        return clipless(point, specular_space, index);
    }
    return exact(point, index);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec4 normal_roughness = texelFetch(g_buffer[1], pixel, 0);
    vec4 base_color_metalness = texelFetch(g_buffer[2], pixel, 0);
    ArealightSurface surface;
    surface.position = texelFetch(g_buffer[0], pixel, 0).xyz;
    surface.normal = normal_roughness.xyz;
    surface.view = frame.camera - surface.position;
    surface.roughness = normal_roughness.w;
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04),
                                     1.0);

    ArealightPoint point = arealight_point(surface);
    mat3 specular_space = point.lobes[AREALIGHT_LOBE_SPECULAR].space * point.to_frame;
    vec3 radiance = vec3(0.0);
    if (LOOPS) {
        for (uint i = 0u; i < frame.lamp_count; i++) {
            radiance += shaded(point, specular_space, i);
        }
    } else {
        radiance = shaded(point, specular_space, frame.lamp_count);
    }
    imageStore(radiance_image, pixel, vec4(radiance, 1.0));
}
