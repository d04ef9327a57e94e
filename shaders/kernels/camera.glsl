#ifndef CAMERA_GLSL
#define CAMERA_GLSL

// From where surfaces are seen. The including kernel has the specialisation constant VIEW, g_buffer.glsl, and
// the camera in its push constants. The bit is that of arealight::plan::ShadeOptions::view_bits.
const uint VIEW_ORTHOGRAPHIC = 1u;

const bool IS_ORTHOGRAPHIC = (VIEW & VIEW_ORTHOGRAPHIC) != 0u;

// The surface of a texel of the G-buffer.
ArealightSurface load_seen_surface(ivec2 texel, vec3 position) {
    ArealightSurface surface = load_surface(texel, position, constants.camera);
    if (IS_ORTHOGRAPHIC) {
        surface.view = constants.camera;
    }
    return surface;
}

#endif
