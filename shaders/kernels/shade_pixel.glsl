#ifndef SHADE_PIXEL_GLSL
#define SHADE_PIXEL_GLSL

// Shades a pixel with a list of lights. The including kernel, shade.comp or shade_portable.comp, has a struct
// LightList with quad_count, light_count and shape_count, and
// - uint light_at(LightList list, uint index): a polygon of the list; the first quad_count are convex quads
//   without an image;
// - uint shape_at(LightList list, uint index): a disk, sphere or tube of the list;
// - HAS_LIGHTS, HAS_QUADS, HAS_POLYGONS, HAS_SHAPES: whether a pixel may have any light, such quads, other
//   polygons and meshes, shapes.

#include "pick_lights.glsl"
#include "position.glsl"
#include "view.glsl"

#include "visibility_bridge.glsl"
#if AREALIGHT_HOST_VISIBILITY
ivec2 visibility_pixel;
vec3 visibility_position;
#endif

// The groups of the surface that is shaded.
uint shaded_groups = 0xffu;

// Whether a light of these flags shines on that.
bool shines(uint flags) {
    return !HAS_LINKS || is_linked(flags, shaded_groups);
}

// Adds what is reflected of the light of this radiance at an index, of PICK_SHAPE or 0.
void add_light_at(inout PixelRadiance sum, uint index, vec3 radiance, ArealightReflected reflected) {
#if AREALIGHT_HOST_VISIBILITY
    radiance *= arealight_bridge_visibility(visibility_pixel, visibility_position, index & PICK_INDEX,
                                            (index & PICK_SHAPE) != 0u);
#endif
    add_light(sum, radiance, reflected);
    if (HAS_SHADOWS) {
        pick_light(index, radiance * reflected.diffuse, radiance * reflected.specular);
    }
}

void shade_polygon(inout PixelRadiance sum, ArealightPoint point, uint index) {
    ArealightGpuLight record = lights[index];
    if (!shines(record.flags)) {
        return;
    }
    if (HAS_SHAPED && (record.flags & LIGHT_SHAPED) != 0u) {
        add_light_at(sum, index, record.radiance, arealight_reflected(point, load_shaped(record)));
    } else if (HAS_MESHES && (record.flags & LIGHT_MESH) != 0u) {
        add_light_at(sum, index, record.radiance, arealight_reflected(point, load_mesh(record)));
    } else if ((EFFECTS & (EFFECT_POLYGON | EFFECT_TEXTURED)) != 0u) {
        add_light_at(sum, index, record.radiance, arealight_reflected(point, load_polygon(record)));
    }
}

void shade_shape(inout PixelRadiance sum, ArealightPoint point, uint index) {
    ArealightGpuShape record = shapes[index];
    uint pick = PICK_SHAPE | index;
    if (!shines(record.flags)) {
        return;
    }
    if (HAS_TUBES && record.kind == SHAPE_TUBE) {
        add_light_at(sum, pick, record.radiance, arealight_reflected(point, load_tube(record)));
    } else if (HAS_SPHERES && record.kind == SHAPE_SPHERE) {
        add_light_at(sum, pick, record.radiance, arealight_reflected(point, load_sphere(record)));
    } else if (HAS_DISKS && record.kind == SHAPE_DISK) {
        add_light_at(sum, pick, record.radiance, arealight_reflected(point, load_disk(record)));
    }
}

PixelRadiance shade_surface(ivec2 pixel, ArealightSurface surface, LightList list) {
#if AREALIGHT_HOST_VISIBILITY
    visibility_pixel = radiance_texel(pixel);
    visibility_position = surface.position;
#endif
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));
    if (IS_TRANSMITTED) {
        // Most surfaces are opaque
        if (!AREALIGHT_HAS_SPECULAR && surface.diffuse_albedo == vec3(0.0)) {
            return sum;
        }
        surface = arealight_other_side(surface);
    }
    ArealightPoint point = arealight_point(surface);
    if (HAS_QUADS) {
        for (uint index = 0u; index < list.quad_count; index++) {
            uint light = light_at(list, index);
            ArealightGpuLight record = lights[light];
            if (shines(record.flags)) {
                add_light_at(sum, light, record.radiance, arealight_reflected(point, load_quad(record)));
            }
        }
    }
    if (HAS_POLYGONS) {
        for (uint index = list.quad_count; index < list.light_count; index++) {
            shade_polygon(sum, point, light_at(list, index));
        }
    }
    if (HAS_SHAPES) {
        for (uint index = 0u; index < list.shape_count; index++) {
            shade_shape(sum, point, shape_at(list, index));
        }
    }
    return sum;
}

// Clears from the bits `samples` of a texel those that show the same surface, and returns how many: equal
// numbers, and a position no farther from its plane than half the samples' distance across the view, as a
// fragment with a bent normal writes them.
int take_samples_of(ivec2 texel, ivec2 pixel, ArealightSurface surface, inout uint samples) {
    int count = 0;
    for (int index = 1; index < G_BUFFER_SAMPLES; index++) {
        g_buffer_sample = index;
        vec3 position;
        if ((samples & (1u << index)) == 0u || !load_position_of(texel, pixel, ivec2(constants.size),
                                                                 position)) {
            continue;
        }
        vec3 offset = position - surface.position;
        float height = dot(offset, surface.normal);
        vec3 across = cross(offset, surface.view);
        bool is_near = 4.0 * height * height * dot(surface.view, surface.view)
                    <= dot(across, across) * dot(surface.normal, surface.normal);
        if (is_near && load_seen_surface(texel, surface.position) == surface) {
            samples &= ~(1u << index);
            count++;
        }
    }
    return count;
}

// Adds the sample that is read to those of a texel that have a surface, a bit each, if it does; whether it
// passes the stencil test.
bool find_sample(ivec2 texel, ivec2 pixel, inout uint samples) {
    if (!passes_stencil(texel)) {
        return false;
    }
    vec3 position;
    if (load_position_of(texel, pixel, ivec2(constants.size), position)) {
        samples |= 1u << g_buffer_sample;
    }
    return true;
}

// The samples of a texel that have a surface; whether any passes the stencil test. What follows the first is
// apart, here and below: without several samples no loop is around a pixel's work, which some drivers'
// compilers take long for.
uint find_samples(ivec2 texel, ivec2 pixel, out bool any_passes) {
    uint samples = 0u;
    any_passes = find_sample(texel, pixel, samples);
    if (G_BUFFER_SAMPLES > 1) {
        for (int index = 1; index < G_BUFFER_SAMPLES; index++) {
            g_buffer_sample = index;
            any_passes = find_sample(texel, pixel, samples) || any_passes;
        }
    }
    return samples;
}

// Shades the first surface of a texel's samples, and takes its samples out of them.
PixelRadiance shade_samples(ivec2 texel, ivec2 pixel, LightList list, inout uint samples) {
    g_buffer_sample = G_BUFFER_SAMPLES > 1 ? findLSB(samples) : 0;
    samples &= samples - 1u;
    vec3 position;
    load_position_of(texel, pixel, ivec2(constants.size), position);
    ArealightSurface surface = load_seen_surface(texel, position);
    shaded_groups = surface_groups(texel);
    PixelRadiance one = shade_surface(pixel, surface, list);
    if (G_BUFFER_SAMPLES > 1) {
        float part = float(1 + take_samples_of(texel, pixel, surface, samples)) / float(G_BUFFER_SAMPLES);
        one.radiance *= part;
        one.glossy *= part;
    }
    return one;
}

// Shades a pixel of the frame, if it is one that passes the stencil test, and stores it. Of several samples
// that is their mean; each surface of them is shaded once.
void shade_pixel(ivec2 pixel, LightList list) {
    ivec2 size = ivec2(constants.size);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    ivec2 texel = g_buffer_texel(pixel);
    bool any_passes;
    uint samples = find_samples(texel, pixel, any_passes);
    if (!any_passes) {
        return;
    }
    bool hit = samples != 0u;
    float coverage = float(bitCount(samples)) / float(G_BUFFER_SAMPLES);
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));
    if (HAS_SHADOWS) {
        begin_picks(pixel);
    }
    if (HAS_LIGHTS && hit) {
        sum = shade_samples(texel, pixel, list, samples);
        if (G_BUFFER_SAMPLES > 1) {
            while (samples != 0u) {
                PixelRadiance one = shade_samples(texel, pixel, list, samples);
                sum.radiance += one.radiance;
                sum.glossy += one.glossy;
            }
        }
    }
    if (HAS_SHADOWS) {
        store_picks(pixel, size, sum.radiance);
    }
    store_radiance(radiance_texel(pixel), hit, G_BUFFER_SAMPLES > 1 ? coverage : 1.0, sum);
}

#endif
