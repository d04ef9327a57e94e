#ifndef TABLE_IMAGE_GLSL
#define TABLE_IMAGE_GLSL

// The light table as an array image at binding 0: layer 0 the matrix, layer 1 the magnitudes, layer 2 the
// matrix of Schlick's weight.

#include "arealight/lobes/table.glsl"

layout(set = 0, binding = 0) uniform texture2DArray table_image;

vec4 arealight_bridge_table(int layer, ivec2 texel) {
    return texelFetch(table_image, ivec3(texel, layer), 0);
}

int arealight_bridge_table_size() {
    return textureSize(table_image, 0).x;
}

#endif
