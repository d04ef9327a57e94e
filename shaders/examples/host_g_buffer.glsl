// A G-buffer of a host's own, for our kernel shade.comp: four words a pixel in one image (rgba32ui) at
// binding 4. What the bindings 5 and 6 hold is up to the host; nothing here reads them.

// doc: bridge
layout(set = 0, binding = 4) uniform utexture2D packed_surfaces;

ArealightSurface arealight_bridge_surface(ivec2 pixel) {
    uvec4 words = texelFetch(packed_surfaces, pixel, g_buffer_sample); // 0, but of multisampled images
    vec2 z_roughness = unpackSnorm2x16(words.y);
    vec4 base_color_metalness = unpackUnorm4x8(words.z);
    ArealightSurface surface; // the kernel sets position and view
    surface.normal = vec3(unpackSnorm2x16(words.x), z_roughness.x);
    surface.roughness = z_roughness.y;
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04),
                                     1.0);
    return surface;
}
// doc end
