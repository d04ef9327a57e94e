#ifndef AREALIGHT_POLYGON_LIGHT_GLSL
#define AREALIGHT_POLYGON_LIGHT_GLSL

#include "arealight/effects.glsl"
#include "arealight/footprint.glsl"
#include "arealight/form_factor.glsl"
#include "arealight/shading_point.glsl"

// The host's bridge to the lights' vertices: the position of vertex `index`, relative to its light's `center`. So a
// light keeps its shape however far from the origin it is.
vec3 arealight_bridge_vertex(uint index);

// Whether lights may be meshes of several faces. A host that says so defines the bridge below, and sets
// AREALIGHT_EFFECT_MESH where a light is one.
#ifndef AREALIGHT_LIGHT_MESHES
#define AREALIGHT_LIGHT_MESHES 0
#endif

#if AREALIGHT_LIGHT_MESHES
// The host's bridge to the faces of meshes: how many vertices the face has whose first vertex is `index`. 0 for a light that
// is one polygon.
uint arealight_bridge_face_size(uint index);
#endif

// A flat, simple polygon of constant radiance, or that shows an image; or a mesh of several, one after another, of constant
// radiance.
struct ArealightPolygonLight {
    vec3 radiance;     // of the front, W/(m^2 sr)
    uint first_vertex; // for arealight_bridge_vertex
    uint vertex_count; // from 3 on; the outline is flat, convex and has at most 4 without AREALIGHT_EFFECT_POLYGON
    vec3 center;       // of the area, relative to the origin of ArealightSurface.position
    float radius;      // of a sphere about the center that holds every vertex; may be generous
    vec3 area;         // area times the normal of the front, over radius^2 (one-point form, and split footprints of any outline)
    bool two_sided;    // the back emits too
    ArealightImage image; // multiplies the radiance (AREALIGHT_EFFECT_TEXTURED alone)
};

// A light before a shading point: scaled by a power of two, so that squares neither overflow nor vanish. That rounds
// nothing.
struct ArealightSeenLight {
    vec3 center;  // from the shading point
    float radius;
    float scale;  // what offsets are still to be multiplied with
    float facing; // minus the product of area vector and center
};

ArealightSeenLight arealight_see(vec3 position, ArealightPolygonLight light) {
    ArealightSeenLight seen;
    vec3 center = light.center - position;
    seen.scale = arealight_power_of_two_scale(arealight_max_component(center) + light.radius);
    seen.center = center * seen.scale;
    seen.radius = light.radius * seen.scale;
    seen.facing = -dot(light.area, seen.center) * seen.radius * seen.radius;
    return seen;
}

// What the form factor of a light in a lobe's cosine space begins with.
struct ArealightLobeView {
    vec3 center;            // of the light, from the shading point
    float extent;           // of the light about it; may be generous
    ArealightAnchor anchor; // at its center
    mat3 transform;         // offsets from the light's center into cosine space
    vec3 normal;            // product with an offset: the vertex's height above the center's, before the transform
    float normal_height;    // the center's height above the surface's horizon
    float height_width;     // heights below this count as zero
};

ArealightLobeView arealight_lobe_view(ArealightCosineSpace space, vec3 normal, ArealightSeenLight seen, int rung) {
    ArealightLobeView view;
    view.center = space.to_cosine * seen.center;
    view.extent = space.stretch * seen.radius;
    view.anchor = arealight_anchor(view.center, view.extent, rung);
    view.anchor.horizon = AREALIGHT_HORIZON_WIDTH * space.flatness;
    view.transform = space.to_cosine * seen.scale;
    view.normal = normal * seen.scale;
    view.normal_height = dot(normal, seen.center);
    view.height_width = 2.0 * AREALIGHT_HORIZON_WIDTH * (abs(view.normal_height) + seen.radius);
    return view;
}

// The height of the vertex at `offset` from the light's center above the surface's horizon. A light in the surface's
// plane has none, whatever the last bit says.
float arealight_vertex_height(ArealightLobeView view, vec3 offset) {
    return arealight_settled_height(view.normal_height + dot(view.normal, offset), view.height_width);
}

// The arcs around a convex outline of up to four vertices, clipped as `quality` says; see form_factor.glsl.
ArealightArcs arealight_lobe_quad(ArealightLobeView view, ArealightQuad quad, ArealightQuality quality) {
    mat3 transform = view.transform;
    ArealightQuad cosine =
        ArealightQuad(transform * quad.v0, transform * quad.v1, transform * quad.v2, transform * quad.v3);
    if (quality.horizon == AREALIGHT_HORIZON_BARE) {
        return arealight_quad_bare(view.anchor, cosine, quality.form_factor);
    }
    if (quality.horizon == AREALIGHT_HORIZON_ABOVE) {
        return arealight_quad_above(view.anchor, cosine, quality.form_factor);
    }
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        vec4 height = vec4(arealight_vertex_height(view, quad.v0), arealight_vertex_height(view, quad.v1),
                           arealight_vertex_height(view, quad.v2), arealight_vertex_height(view, quad.v3));
        return arealight_quad_both_horizons(view.anchor, cosine, height, quality.form_factor);
    }
    return arealight_quad_clipped(view.anchor, cosine, quality.form_factor);
}

// The arcs around any outline.
ArealightArcs arealight_lobe_walk(ArealightLobeView view, ArealightPolygonLight light, ArealightQuality quality) {
    uint end = light.first_vertex + light.vertex_count;
    vec3 last = arealight_bridge_vertex(end - 1u);
    int rung = quality.form_factor;
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        float height = arealight_vertex_height(view, last);
        ArealightSurfaceWalk walk = arealight_surface_walk_begin(view.transform * last, height);
        for (uint index = light.first_vertex; index < end; index++) {
            vec3 vertex = arealight_bridge_vertex(index);
            height = arealight_vertex_height(view, vertex);
            arealight_surface_walk_to(walk, view.anchor, view.transform * vertex, height, rung);
        }
        return arealight_surface_walk_end(walk, view.anchor, rung);
    }
    ArealightWalk walk = arealight_walk_begin();
    ArealightVertex from = arealight_vertex(view.anchor, view.transform * last, rung);
    bool bare = quality.horizon == AREALIGHT_HORIZON_BARE;
    bool unclipped = bare || quality.horizon == AREALIGHT_HORIZON_ABOVE;
    // Tested before it runs: where pixels of a group end at different vertices, lavapipe (Mesa 22.3) takes what a loop that
    // tests after it ran computed last, for all of them
    for (uint index = light.first_vertex; index < end; index++) {
        ArealightVertex to = arealight_vertex(view.anchor, view.transform * arealight_bridge_vertex(index), rung);
        if (unclipped) {
            walk.sum += bare ? arealight_acute_arc(from, to, rung) : arealight_arc(from, to, rung);
            walk.squares += to.square;
        } else {
            arealight_walk_edge(walk, view.anchor, from, to, rung);
        }
        from = to;
    }
    return unclipped ? ArealightArcs(walk.sum, walk.squares) : arealight_walk_end(walk, view.anchor, rung);
}

#if AREALIGHT_LIGHT_MESHES

// Whether a light has several faces.
bool arealight_is_mesh(ArealightPolygonLight light, uint effects) {
    return (effects & AREALIGHT_EFFECT_MESH) != 0u && arealight_bridge_face_size(light.first_vertex) != 0u;
}

// The arcs around the faces of a mesh that face the shading point; of a two-sided one around all, each as if it did. Each face
// is clipped and closed by itself. The sum is of what each sends: where one hides another, both count.
ArealightArcs arealight_lobe_mesh(ArealightLobeView view, ArealightPolygonLight light, ArealightQuality quality) {
    ArealightArcs arcs = ArealightArcs(vec3(0.0), 0.0);
    uint end = light.first_vertex + light.vertex_count;
    ArealightPolygonLight face = light;
    for (face.first_vertex = light.first_vertex; face.first_vertex < end; face.first_vertex += face.vertex_count) {
        uint rest = end - face.first_vertex;
        uint size = arealight_bridge_face_size(face.first_vertex);
        face.vertex_count = size == 0u ? rest : min(size, rest);
        ArealightArcs around = arealight_lobe_walk(view, face, quality);
        // Seen from the back an outline goes around the other way
        float side = around.sum.z <= 0.0 ? 1.0 : (light.two_sided ? -1.0 : 0.0);
        arcs.sum += side * around.sum;
        arcs.squares += around.squares;
    }
    return arcs;
}

#endif

// The outline of a light of three or four vertices. A triangle's last vertex comes twice, which changes nothing.
ArealightQuad arealight_light_quad(ArealightPolygonLight light) {
    uint last = clamp(light.vertex_count, 1u, 4u) - 1u;
    return ArealightQuad(arealight_bridge_vertex(light.first_vertex), arealight_bridge_vertex(light.first_vertex + 1u),
                         arealight_bridge_vertex(light.first_vertex + min(2u, last)),
                         arealight_bridge_vertex(light.first_vertex + last));
}

// The arcs around a polygon light in a lobe's cosine space. `quad` is read without AREALIGHT_EFFECT_POLYGON, the light's
// vertices with it.
ArealightArcs arealight_lobe_arcs(ArealightLobe lobe, ArealightLobeView view, ArealightSeenLight seen,
                                  ArealightPolygonLight light, ArealightQuad quad, uint effects,
                                  ArealightQuality quality) {
    // A far light of which the surface hides a part is no matter of one point
    bool is_whole = quality.horizon != AREALIGHT_HORIZON_BOTH || view.normal_height > seen.radius;
#if AREALIGHT_LIGHT_MESHES
    if (arealight_is_mesh(light, effects)) {
        return arealight_lobe_mesh(view, light, quality);
    }
#endif
    if ((effects & AREALIGHT_EFFECT_FAR) != 0u && (quality.form_factor & AREALIGHT_FORM_FACTOR_ONE_POINT) != 0
        && is_whole && arealight_is_far(view.center, view.extent)) {
        return arealight_one_point(view.center, seen.facing * lobe.space.determinant);
    }
    if ((effects & AREALIGHT_EFFECT_POLYGON) != 0u) {
        return arealight_lobe_walk(view, light, quality);
    }
    return arealight_lobe_quad(view, quad, quality);
}

#if AREALIGHT_LIGHT_TEXTURES

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
    float parts = quality.footprint == AREALIGHT_FOOTPRINT_SPLIT_FOUR ? 4.0 : 2.0;
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
// (error: form_factor.glsl), times what it sees of the light's image (error: footprint.glsl).
vec3 arealight_lobe_polygon(ArealightLobe lobe, vec3 normal, ArealightSeenLight seen, ArealightPolygonLight light,
                            ArealightQuad quad, uint effects, ArealightQuality quality) {
    ArealightLobeView view = arealight_lobe_view(lobe.space, normal, seen, quality.form_factor);
#if AREALIGHT_LIGHT_TEXTURES
    bool textured = (effects & AREALIGHT_EFFECT_TEXTURED) != 0u && light.image.layer != AREALIGHT_NO_IMAGE;
    ArealightSeenImage image = arealight_see_image(light.image, view.center, view.transform);
    if (quality.footprint >= AREALIGHT_FOOTPRINT_SPLIT_TWO && textured) {
        return lobe.albedo * arealight_lobe_parts(view, lobe.gain, image, light, seen, quad, effects, quality);
    }
#endif
    ArealightArcs arcs = arealight_lobe_arcs(lobe, view, seen, light, quad, effects, quality);
    vec3 color = vec3(min(arealight_form_factor(arcs, light.two_sided) * lobe.gain, 1.0));
#if AREALIGHT_LIGHT_TEXTURES
    if (textured) {
        color *= arealight_footprint(image, arcs.sum, quality.footprint);
    }
#endif
    return lobe.albedo * color;
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
    // The vertices are read once for all lobes
    ArealightSeenLight seen = arealight_see(point.position, light);
    ArealightQuad quad = ArealightQuad(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    if ((effects & AREALIGHT_EFFECT_POLYGON) == 0u) {
        quad = arealight_light_quad(light);
    }
    ArealightReflected reflected = ArealightReflected(vec3(0.0), vec3(0.0));
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        reflected.glossy = arealight_lobe_polygon(point.glossy, point.normal, seen, light, quad, effects, quality);
        if (quality.fresnel == AREALIGHT_FRESNEL_SPLIT) {
            // Where F90 is below F0 this part is negative
            reflected.glossy +=
                arealight_lobe_polygon(point.schlick, point.normal, seen, light, quad, effects, quality);
            reflected.glossy = max(reflected.glossy, vec3(0.0));
        }
    }
    if ((effects & AREALIGHT_EFFECT_DIFFUSE) != 0u) {
        // The surface's horizon is that of the Lambert lobe's cosine space
        if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
            quality.horizon = AREALIGHT_HORIZON_COSINE;
        }
        reflected.diffuse = arealight_lobe_polygon(point.diffuse, point.normal, seen, light, quad, effects, quality);
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
