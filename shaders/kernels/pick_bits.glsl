#ifndef PICK_BITS_GLSL
#define PICK_BITS_GLSL

// How a ray's light is named: its index in its buffer with these bits.

const uint PICK_SPECULAR = 0x80000000u; // of the specular lobes, else of the diffuse one
const uint PICK_SHAPE = 0x40000000u;    // a disk, sphere or tube, else a polygon or mesh
const uint PICK_INDEX = 0x3fffffffu;
const uint NO_PICK = 0xffffffffu;

#endif
