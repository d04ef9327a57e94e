#ifndef AREALIGHT_POLYGON_LIGHT_GLSL
#define AREALIGHT_POLYGON_LIGHT_GLSL

#include "arealight/effects.glsl"
#include "arealight/footprint.glsl"
#include "arealight/form_factor.glsl"
#include "arealight/light_view.glsl"
#include "arealight/outlines.glsl"
#include "arealight/shading_point.glsl"

// The arcs around a convex outline of up to four vertices, clipped as `quality` says; see form_factor.glsl.
ArealightArcs arealight_lobe_quad(ArealightLobeView view, ArealightQuad quad, ArealightQuality quality) {
    mat3 transform = view.transform;
    ArealightQuad cosine =
        ArealightQuad(transform * quad.v0, transform * quad.v1, transform * quad.v2, transform * quad.v3);
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        vec4 height = vec4(arealight_vertex_height(view, quad.v0), arealight_vertex_height(view, quad.v1),
                           arealight_vertex_height(view, quad.v2), arealight_vertex_height(view, quad.v3));
        return arealight_quad_both_horizons(view.anchor, cosine, height, quality.form_factor);
    }
    return arealight_quad_clipped(view.anchor, cosine, quality.form_factor);
}

// The outline of a light of three or four vertices. A triangle's last vertex comes twice, which changes nothing.
ArealightQuad arealight_light_quad(ArealightPolygonLight light) {
    uint last = clamp(light.vertex_count, 1u, 4u) - 1u;
    return ArealightQuad(arealight_bridge_vertex(light.first_vertex), arealight_bridge_vertex(light.first_vertex + 1u),
                         arealight_bridge_vertex(light.first_vertex + min(2u, last)),
                         arealight_bridge_vertex(light.first_vertex + last));
}

// The arcs around a polygon light in a lobe's cosine space: `walked` with AREALIGHT_EFFECT_POLYGON, around `quad` without.
ArealightArcs arealight_lobe_arcs(ArealightLobeView view, ArealightArcs walked, ArealightQuad quad, uint effects,
                                  ArealightQuality quality) {
    if ((effects & AREALIGHT_EFFECT_POLYGON) != 0u) {
        return walked;
    }
    return arealight_lobe_quad(view, quad, quality);
}

#if AREALIGHT_LIGHT_TEXTURES

// Whether a light shows an image.
bool arealight_shows_image(ArealightPolygonLight light, uint effects) {
    return (effects & AREALIGHT_EFFECT_TEXTURED) != 0u && light.image.layer != AREALIGHT_NO_IMAGE;
}

// A convex part of a light, of up to four vertices (offsets from the light's center), and where on its image they are.
struct ArealightPart {
    ArealightQuad quad;
    vec4 u;
    vec4 v;
};

// The part in column `x` and row `y` of `count` by `count` that a part is split into.
ArealightPart arealight_split_part(ArealightPart whole, vec2 cell, float count) {
    vec4 s = vec4(cell.x, cell.x + 1.0, cell.x + 1.0, cell.x) / count;
    vec4 t = vec4(cell.y, cell.y, cell.y + 1.0, cell.y + 1.0) / count;
    ArealightQuad quad = whole.quad;
    ArealightPart part;
    part.quad = ArealightQuad(mix(mix(quad.v0, quad.v1, s.x), mix(quad.v3, quad.v2, s.x), t.x),
                              mix(mix(quad.v0, quad.v1, s.y), mix(quad.v3, quad.v2, s.y), t.y),
                              mix(mix(quad.v0, quad.v1, s.z), mix(quad.v3, quad.v2, s.z), t.z),
                              mix(mix(quad.v0, quad.v1, s.w), mix(quad.v3, quad.v2, s.w), t.w));
    part.u = mix(mix(whole.u.xxxx, whole.u.yyyy, s), mix(whole.u.wwww, whole.u.zzzz, s), t);
    part.v = mix(mix(whole.v.xxxx, whole.v.yyyy, s), mix(whole.v.wwww, whole.v.zzzz, s), t);
    return part;
}

// What a lobe sees of a part of a light in `count` by `count` pieces, each with a form factor and a footprint of its own:
// the sum of form factors times colours, and of form factors.
vec4 arealight_part_color(ArealightLobeView view, ArealightSeenImage image, ArealightPart whole, float count,
                          float parts, bool two_sided, ArealightQuality quality) {
    vec4 sum = vec4(0.0);
    for (float y = 0.0; y < count; y += 1.0) {
        for (float x = 0.0; x < count; x += 1.0) {
            ArealightPart part = arealight_split_part(whole, vec2(x, y), count);
            ArealightArcs arcs = arealight_lobe_quad(view, part.quad, quality);
            vec2 low = vec2(min(min(part.u.x, part.u.y), min(part.u.z, part.u.w)),
                            min(min(part.v.x, part.v.y), min(part.v.z, part.v.w)));
            vec2 high = vec2(max(max(part.u.x, part.u.y), max(part.u.z, part.u.w)),
                             max(max(part.v.x, part.v.y), max(part.v.z, part.v.w)));
            vec3 color = arealight_footprint_of_part(image, arcs.sum, low, high, parts);
            sum += arealight_form_factor(arcs, two_sided) * vec4(color, 1.0);
        }
    }
    return sum;
}

// What a lobe of the gain `gain` sees of a light that shows an image, by parts: those of a convex quad, or the triangles about
// the center of any other outline. No more than the image, as the parts of a flat outline make up no more than all there is.
vec3 arealight_lobe_parts(ArealightLobeView view, float gain, ArealightSeenImage image, ArealightPolygonLight light,
                          ArealightSeenLight seen, ArealightQuad quad, uint effects, ArealightQuality quality) {
    const float parts = 4.0;
    ArealightPart part;
    if ((effects & AREALIGHT_EFFECT_POLYGON) == 0u) {
        part.quad = quad;
        arealight_image_coordinates(light.image, quad, part.u, part.v);
        vec4 sum = arealight_part_color(view, image, part, parts, parts, light.two_sided, quality);
        return sum.rgb * gain / max(sum.a * gain, 1.0);
    }
    if (seen.facing <= 0.0 && !light.two_sided) {
        return vec3(0.0);
    }
    // Triangles that run against the outline are taken away again
    vec4 sum = vec4(0.0);
    uint end = light.first_vertex + light.vertex_count;
    vec3 last = arealight_bridge_vertex(end - 1u);
    for (uint index = light.first_vertex; index < end; index++) {
        vec3 next = arealight_bridge_vertex(index);
        part.quad = ArealightQuad(vec3(0.0), last, next, next);
        arealight_image_coordinates(light.image, part.quad, part.u, part.v);
        vec4 color = arealight_part_color(view, image, part, 0.5 * parts, parts, true, quality);
        sum += dot(cross(last, next), light.area) < 0.0 ? -color : color;
        last = next;
    }
    return max(sum.rgb, vec3(0.0)) * gain / max(sum.a * gain, 1.0);
}

#endif

// What a lobe reflects of a polygon light of unit radiance, a channel: its albedo times the form factor in its cosine space
// (error: form_factor.glsl), times what it sees of the light's image (error: footprint.glsl). `walked` are the arcs around the
// light with AREALIGHT_EFFECT_POLYGON, `quad` is its outline without.
vec3 arealight_lobe_polygon(ArealightLobe lobe, ArealightLobeView view, ArealightSeenLight seen, ArealightPolygonLight light,
                            ArealightArcs walked, ArealightQuad quad, uint effects, ArealightQuality quality) {
#if AREALIGHT_LIGHT_TEXTURES
    bool textured = arealight_shows_image(light, effects);
    ArealightSeenImage image = arealight_see_image(light.image, view.center, view.transform);
    if (quality.footprint == AREALIGHT_FOOTPRINT_SPLIT && textured) {
        return lobe.albedo * arealight_lobe_parts(view, lobe.gain, image, light, seen, quad, effects, quality);
    }
#endif
    ArealightArcs arcs = arealight_lobe_arcs(view, walked, quad, effects, quality);
    vec3 color = vec3(min(arealight_form_factor(arcs, light.two_sided) * lobe.gain, 1.0));
#if AREALIGHT_LIGHT_TEXTURES
    if (textured) {
        color *= arealight_footprint(image, arcs.sum, quality.footprint);
    }
#endif
    return lobe.albedo * color;
}

// Whether the outline of a light is walked: not where its image is looked at by parts.
bool arealight_is_walked(ArealightPolygonLight light, uint effects, ArealightQuality quality) {
    if ((effects & AREALIGHT_EFFECT_POLYGON) == 0u) {
        return false;
    }
#if AREALIGHT_LIGHT_TEXTURES
    return !(quality.footprint == AREALIGHT_FOOTPRINT_SPLIT && arealight_shows_image(light, effects));
#else
    return true;
#endif
}

// What a surface reflects of one polygon light of unit radiance towards the viewer, without visibility, lobe by lobe; a
// lobe that `effects` lacks reflects nothing.
//
// The Lambert lobe is exact to the form factor's error; the GGX lobe is the fitted one: exact for the table's lobe, and
// as close to GGX as the table's fit (docs/fit.md). Source: Heitz et al. 2016, eq. 11.
ArealightReflected arealight_polygon_reflected(ArealightShadingPoint point, ArealightPolygonLight light, uint effects,
                                               ArealightQuality quality) {
    // What is fixed comes first in each condition: compilers drop the rest
    light.two_sided = (effects & AREALIGHT_EFFECT_TWO_SIDED) != 0u && light.two_sided;
    ArealightSeenLight seen = arealight_see(point.position, light);
    ArealightLobeViews views = arealight_lobe_views(point, seen, quality.form_factor);

    // The vertices are read once for all lobes
    ArealightQuad quad = ArealightQuad(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    if ((effects & AREALIGHT_EFFECT_POLYGON) == 0u) {
        quad = arealight_light_quad(light);
    }
    ArealightLobeArcs walked = arealight_no_arcs();
    if (arealight_is_walked(light, effects, quality)) {
        walked = arealight_walk_light(views, light, effects, quality);
    }

    ArealightReflected reflected = ArealightReflected(vec3(0.0), vec3(0.0));
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        reflected.glossy =
            arealight_lobe_polygon(point.glossy, views.glossy, seen, light, walked.glossy, quad, effects, quality);
    }
    if (arealight_has_schlick(effects, quality)) {
        reflected.glossy +=
            arealight_lobe_polygon(point.schlick, views.schlick, seen, light, walked.schlick, quad, effects, quality);
        // Where F90 is below F0 its part is negative
        reflected.glossy = max(reflected.glossy, vec3(0.0));
    }
    if ((effects & AREALIGHT_EFFECT_DIFFUSE) != 0u) {
        reflected.diffuse = arealight_lobe_polygon(point.diffuse, views.diffuse, seen, light, walked.diffuse, quad, effects,
                                                   arealight_diffuse_quality(quality));
    }
    return reflected;
}

// Outgoing radiance towards the viewer from one polygon light, W/(m^2 sr), without visibility: of both lobes.
vec3 arealight_polygon_radiance(ArealightShadingPoint point, ArealightPolygonLight light, uint effects,
                                ArealightQuality quality) {
    ArealightReflected reflected = arealight_polygon_reflected(point, light, effects, quality);
    return light.radiance * (reflected.glossy + reflected.diffuse);
}

#endif
