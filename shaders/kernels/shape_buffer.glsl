#ifndef SHAPE_BUFFER_GLSL
#define SHAPE_BUFFER_GLSL

// The list of shapes as the library sees them. The including kernel defines SHAPES_BINDING.

#include "arealight/shapes.glsl"

// The CPU writes it: crates/arealight/src/gpu.rs has the same, and a test compares the offsets.
struct ArealightGpuShape {
    vec3 radiance;
    uint kind;
    vec3 center;
    float radius;
    vec3 axis_u;
    uint detail; // of a tube: its ends; of an ellipse: the layer that it shows
    vec3 axis_v;
    uint flags;
};

// Some light is a shape: Effects::SHAPES in Rust.
const uint ANY_SHAPE = AREALIGHT_EFFECT_ELLIPSE | AREALIGHT_EFFECT_SPHERE | AREALIGHT_EFFECT_TUBE;

const uint SHAPE_TWO_SIDED = 1u;
// Each shape is what its record says
const int SHAPE_ANY = 3;

layout(set = 0, binding = SHAPES_BINDING, std430) readonly buffer Shapes {
    ArealightGpuShape shapes[];
};

// The record of a shape.
ArealightGpuShape shape_record(uint index) {
    return shapes[index];
}

// `kind`: what all shapes are, as a specialisation constant, or SHAPE_ANY.
ArealightShape load_shape(uint index, int kind) {
    ArealightGpuShape record = shape_record(index);
    return ArealightShape(kind == SHAPE_ANY ? int(record.kind) : kind, record.radiance, record.center, record.axis_u,
                          record.axis_v, record.radius, int(record.detail), (record.flags & SHAPE_TWO_SIDED) != 0u,
                          record.detail);
}

#endif
