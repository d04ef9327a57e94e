#ifndef BINDINGS_GLSL
#define BINDINGS_GLSL

// The bindings of descriptor set 0, of every kernel that reads a G-buffer: each resource has one number,
// whichever kernel reads it. A pass has those that its kernels declare; arealight::kernels reads them out of
// the modules, and arealight::planes says what the images g_* hold.

#define TABLE_BINDING 0
#define LIGHTS_BINDING 1 // the vertices' is the next
#define G_BUFFER_BINDING 3 // the first of four: g_position, g_normal, g_base_color, g_specular
#define RADIANCE_BINDING 7
#define LIGHT_TEXTURES_BINDING 8
#define SHAPES_BINDING 9
#define GLOSSY_BINDING 10
#define COAT_BINDING 11
#define SHEEN_BINDING 12
#define ANISOTROPY_BINDING 13
#define FILM_BINDING 14
#define PICKS_BINDING 15
#define STENCIL_BINDING 16
#define LIGHT_COUNTS_BINDING 17

// Tiles.
#define TILE_LISTS_BINDING 18
#define LOBE_HORIZONS_BINDING 19

// Shadows. What is at RADIANCE_BINDING is not shadowed yet.
#define SHADOW_BINDING 20
#define SHADOWED_BINDING 21
#define BLOCKER_NODES_BINDING 22
#define BLOCKER_TRIANGLES_BINDING 23
#define HISTORY_BINDING 24
#define MOTION_BINDING 25

// Media.
#define FROXELS_BINDING 26
#define MEDIUM_BINDING 27

#endif
