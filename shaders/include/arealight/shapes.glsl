#ifndef AREALIGHT_SHAPES_GLSL
#define AREALIGHT_SHAPES_GLSL

#include "arealight/effects.glsl"
#include "arealight/footprint.glsl"
#include "arealight/form_factor.glsl"
#include "arealight/rim.glsl"
#include "arealight/shading_point.glsl"
#include "arealight/sphere.glsl"
#include "arealight/tube_horizons.glsl"

// Disks, spheres and tubes as lights: from a light's record to the radiance that a surface reflects of it, as
// polygon_light.glsl has it for polygons.

// What a shape is. Where the effects of a pass have one kind alone, the record's is not looked at.
const int AREALIGHT_SHAPE_ELLIPSE = 0; // a flat disk or ellipse
const int AREALIGHT_SHAPE_SPHERE = 1;
const int AREALIGHT_SHAPE_TUBE = 2; // a cylinder or capsule

// Whether any light is a shape.
bool arealight_has_shapes(uint effects) {
    return (effects & (AREALIGHT_EFFECT_ELLIPSE | AREALIGHT_EFFECT_SPHERE | AREALIGHT_EFFECT_TUBE)) != 0u;
}

// Whether a shape whose record says `kind` is of the kind that has the bit `effect` of the effects: known without the
// record where no other kind is among them, and false where that kind is not.
bool arealight_shape_is(int wanted, uint effect, int kind, uint effects) {
    uint kinds = effects & (AREALIGHT_EFFECT_ELLIPSE | AREALIGHT_EFFECT_SPHERE | AREALIGHT_EFFECT_TUBE);
    return kinds == effect || ((kinds & effect) != 0u && kind == wanted);
}

bool arealight_is_sphere(int kind, uint effects) {
    return arealight_shape_is(AREALIGHT_SHAPE_SPHERE, AREALIGHT_EFFECT_SPHERE, kind, effects);
}

bool arealight_is_tube(int kind, uint effects) {
    return arealight_shape_is(AREALIGHT_SHAPE_TUBE, AREALIGHT_EFFECT_TUBE, kind, effects);
}

// A light of constant radiance; or an ellipse that shows an image. Its rows run along axis_u, and the top row is where axis_v points
// to, seen from the front; the parallelogram of both axes touches its edges.
struct ArealightShape {
    int kind;       // one of AREALIGHT_SHAPE_*
    vec3 radiance;  // of the front or outside, W/(m^2 sr)
    vec3 center;    // relative to the origin of ArealightSurface.position
    vec3 axis_u;    // ellipse: a half axis; tube: half of its axis, from the center to one end
    vec3 axis_v;    // ellipse: the conjugate half axis; axis_u x axis_v points to where the front shines
    float radius;   // of a sphere or tube; of an ellipse the longer half axis, or more
    int ends;       // of a tube: one of AREALIGHT_TUBE_*
    bool two_sided; // ellipse: the back emits too; sphere: so does the inside
    uint image;     // ellipse: a layer, or AREALIGHT_NO_IMAGE; multiplies the radiance (AREALIGHT_EFFECT_TEXTURED_ELLIPSE alone)
};

// A shape before a shading point, made ready for any number of lobes: scaled by a power of two, in the surface's space.
struct ArealightSeenShape {
    vec3 center; // an ellipse, that of a sphere being its silhouette: from the shading point
    vec3 axis_u;
    vec3 axis_v;
    bool inside; // the point is in the sphere
    vec3 sphere; // a sphere's center and radius
    float radius;
    ArealightTube tube;
};

ArealightSeenShape arealight_see_shape(vec3 position, ArealightShape shape, uint effects) {
    ArealightSeenShape seen;
    vec3 center = shape.center - position;
    if (arealight_is_tube(shape.kind, effects)) {
        seen.tube = arealight_tube(center, shape.axis_u, shape.radius, shape.ends);
        return seen;
    }
    float scale = arealight_power_of_two_scale(arealight_max_component(center) + shape.radius);
    seen.center = center * scale;
    seen.axis_u = shape.axis_u * scale;
    seen.axis_v = shape.axis_v * scale;
    seen.sphere = seen.center;
    seen.radius = shape.radius * scale;
    seen.inside = false;
    if (arealight_is_sphere(shape.kind, effects)) {
        ArealightSilhouette silhouette = arealight_sphere_silhouette(seen.sphere, seen.radius);
        seen.center = silhouette.center;
        seen.axis_u = silhouette.axis_u;
        seen.axis_v = silhouette.axis_v;
        seen.inside = silhouette.inside;
    }
    return seen;
}

// The form factor of an ellipse, or of a sphere's silhouette, in a lobe's cosine space. `normal` is the surface's.
float arealight_lobe_ellipse(ArealightLobe lobe, vec3 normal, ArealightSeenShape seen, bool two_sided,
                             ArealightQuality quality) {
    vec3 center = lobe.space.to_cosine * seen.center;
    vec3 axis_u = lobe.space.to_cosine * seen.axis_u;
    vec3 axis_v = lobe.space.to_cosine * seen.axis_v;
    int rung = quality.form_factor;
    // Whether a light in the surface's plane is above or below must not hang on the last bit
    float horizon = AREALIGHT_HORIZON_WIDTH * lobe.space.flatness;
    float across = arealight_max_component(axis_u) + arealight_max_component(axis_v);
    center.z = arealight_settled_height(center.z, horizon * (arealight_max_component(center) + across));
    axis_u.z = arealight_settled_height(axis_u.z, horizon * across);
    axis_v.z = arealight_settled_height(axis_v.z, horizon * across);
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        float size = arealight_max_component(seen.center) + seen.radius;
        vec3 heights = vec3(dot(normal, seen.center), dot(normal, seen.axis_u), dot(normal, seen.axis_v));
        heights.x = arealight_settled_height(heights.x, 2.0 * AREALIGHT_HORIZON_WIDTH * size);
        heights.y = arealight_settled_height(heights.y, 2.0 * AREALIGHT_HORIZON_WIDTH * seen.radius);
        heights.z = arealight_settled_height(heights.z, 2.0 * AREALIGHT_HORIZON_WIDTH * seen.radius);
        return arealight_ellipse_both_horizons(center, axis_u, axis_v, heights, two_sided, horizon, rung);
    }
    return arealight_ellipse_form_factor(center, axis_u, axis_v, two_sided, rung);
}

#if AREALIGHT_LIGHT_TEXTURES

// The image of an ellipse, and where it is.
ArealightImage arealight_ellipse_image(ArealightShape shape) {
    return ArealightImage(shape.image, shape.axis_v - shape.axis_u, 2.0 * shape.axis_u, -2.0 * shape.axis_v, vec2(0.0),
                          vec2(1.0));
}

// The mean colour that a lobe sees of an ellipse's image: where the light comes from in its cosine space, as of polygons
// (arealight_footprint). SPLIT is ELLIPSE here.
vec3 arealight_lobe_ellipse_image(ArealightLobe lobe, ArealightSeenShape seen, ArealightShape shape,
                                  ArealightQuality quality) {
    mat3 transform = lobe.space.to_cosine;
    vec3 axis_u = transform * seen.axis_u;
    vec3 axis_v = transform * seen.axis_v;
    vec3 center = transform * seen.center;
    vec3 direction = arealight_ellipse_mean_direction(center, axis_u, axis_v, quality.form_factor);
    shape.axis_u = seen.axis_u;
    shape.axis_v = seen.axis_v;
    ArealightSeenImage image = arealight_see_image(arealight_ellipse_image(shape), center, transform);
    image.end = AREALIGHT_ELLIPSE_IMAGE_END;
    return arealight_footprint(image, direction, min(quality.footprint, AREALIGHT_FOOTPRINT_ELLIPSE));
}

#endif

// What a lobe reflects of a shape of unit radiance, a channel: its albedo times the form factor in its cosine space, times what
// it sees of the shape's image. `keeps_lengths`: the lobe is Lambert's.
vec3 arealight_lobe_shape(ArealightLobe lobe, vec3 normal, ArealightSeenShape seen, ArealightShape shape,
                          bool keeps_lengths, uint effects, ArealightQuality quality) {
    float form_factor;
    if (arealight_is_tube(shape.kind, effects)) {
        float horizon = AREALIGHT_HORIZON_WIDTH * lobe.space.flatness;
        if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
            form_factor = arealight_tube_both_horizons(seen.tube, normal, lobe.space.to_cosine, horizon,
                                                       quality.form_factor);
        } else {
            form_factor = arealight_tube_form_factor(seen.tube, lobe.space.to_cosine, horizon, quality.form_factor);
        }
    } else if (arealight_is_sphere(shape.kind, effects) && keeps_lengths) {
        form_factor = arealight_sphere_form_factor(lobe.space.to_cosine * seen.sphere, seen.radius, shape.two_sided,
                                                   quality.form_factor);
    } else {
        form_factor = arealight_lobe_ellipse(lobe, normal, seen, shape.two_sided, quality);
        form_factor = seen.inside ? (shape.two_sided ? 1.0 : 0.0) : form_factor;
    }
    vec3 color = vec3(min(form_factor * lobe.gain, 1.0));
#if AREALIGHT_LIGHT_TEXTURES
    bool shows = shape.kind == AREALIGHT_SHAPE_ELLIPSE && shape.image != AREALIGHT_NO_IMAGE;
    if ((effects & AREALIGHT_EFFECT_TEXTURED_ELLIPSE) != 0u && shows) {
        color *= arealight_lobe_ellipse_image(lobe, seen, shape, quality);
    }
#endif
    return lobe.albedo * color;
}

// What a surface reflects of one shape of unit radiance towards the viewer, without visibility, lobe by lobe. Errors: as
// those of the shape's form factor; see arealight_polygon_reflected.
ArealightReflected arealight_shape_reflected(ArealightShadingPoint point, ArealightShape shape, uint effects,
                                             ArealightQuality quality) {
    shape.two_sided = shape.two_sided && (effects & AREALIGHT_EFFECT_TWO_SIDED) != 0u;
    ArealightSeenShape seen = arealight_see_shape(point.position, shape, effects);
    ArealightReflected reflected = ArealightReflected(vec3(0.0), vec3(0.0));
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        reflected.glossy = arealight_lobe_shape(point.glossy, point.normal, seen, shape, false, effects, quality);
        if (quality.fresnel == AREALIGHT_FRESNEL_SPLIT) {
            reflected.glossy += arealight_lobe_shape(point.schlick, point.normal, seen, shape, false, effects, quality);
            reflected.glossy = max(reflected.glossy, vec3(0.0));
        }
    }
    if ((effects & AREALIGHT_EFFECT_DIFFUSE) != 0u) {
        reflected.diffuse = arealight_lobe_shape(point.diffuse, point.normal, seen, shape, true, effects,
                                                 arealight_diffuse_quality(quality));
    }
    return reflected;
}

// Outgoing radiance towards the viewer from one shape, W/(m^2 sr), without visibility: of both lobes.
vec3 arealight_shape_radiance(ArealightShadingPoint point, ArealightShape shape, uint effects,
                              ArealightQuality quality) {
    ArealightReflected reflected = arealight_shape_reflected(point, shape, effects, quality);
    return shape.radiance * (reflected.glossy + reflected.diffuse);
}

#endif
