#ifndef AREALIGHT_MATERIAL_GLSL
#define AREALIGHT_MATERIAL_GLSL

#include "arealight/lobes/anisotropy.glsl"
#include "arealight/lobes/coat.glsl"
#include "arealight/lobes/diffuse.glsl"
#include "arealight/lobes/half_vectors.glsl"
#include "arealight/lobes/rescattered.glsl"
#include "arealight/lobes/sheen.glsl"
#include "arealight/lobes/specular.glsl"
#include "arealight/thin_film.glsl"

// Which lobes a surface has. No kind of light knows of this, and no lobe of another.

const int AREALIGHT_LOBE_DIFFUSE = 0;
const int AREALIGHT_LOBE_SPECULAR = 1;
const int AREALIGHT_LOBE_SECOND = 2; // of two specular lobes, or of a surface that has sheen its second
const int AREALIGHT_LOBE_COAT = 3;
const int AREALIGHT_LOBE_SHEEN = 4;
const int AREALIGHT_LOBES = 5;

// The lobes before this one may be there: what a loop over them goes through.
const int AREALIGHT_LOBE_END = AREALIGHT_HAS_SHEEN ? AREALIGHT_LOBES : AREALIGHT_HAS_COAT
    ? AREALIGHT_LOBE_SHEEN : AREALIGHT_LOBE_COAT;

// A surface made ready for any number of lights: all that does not depend on the light.
struct ArealightPoint {
    vec3 position;
    mat3 to_frame; // offsets from the point into the shading frame: x to the viewer's side, z the normal
    ArealightLobe lobes[AREALIGHT_LOBES];
    // Of the specular lobe and of the coat's, with AREALIGHT_HALF_VECTORS
    ArealightHalfVectors half_vectors;
    ArealightHalfVectors coat_half_vectors;
};

// Whether surfaces have a lobe before AREALIGHT_LOBE_END: constant for a literal `lobe`.
bool arealight_has_lobe(int lobe) {
    return lobe == AREALIGHT_LOBE_DIFFUSE ? AREALIGHT_HAS_DIFFUSE
         : lobe == AREALIGHT_LOBE_COAT ? AREALIGHT_HAS_COAT
         : lobe == AREALIGHT_LOBE_SHEEN ? AREALIGHT_HAS_SHEEN
         : AREALIGHT_HAS_TWO_SHEEN_LOBES && lobe == AREALIGHT_LOBE_SECOND ? true
         : AREALIGHT_HAS_SPECULAR && (lobe == AREALIGHT_LOBE_SPECULAR || AREALIGHT_HAS_TWO_SPECULAR_LOBES);
}

// The lobe of an index that a loop counts: by choices, since compilers keep all that an index reaches in
// memory, all of the point with it.
ArealightLobe arealight_lobe_at(ArealightPoint point, int index) {
    ArealightLobe lobe = point.lobes[AREALIGHT_LOBE_DIFFUSE];
    if (index == AREALIGHT_LOBE_SPECULAR) {
        lobe = point.lobes[AREALIGHT_LOBE_SPECULAR];
    } else if (index == AREALIGHT_LOBE_SECOND) {
        lobe = point.lobes[AREALIGHT_LOBE_SECOND];
    } else if (index == AREALIGHT_LOBE_COAT) {
        lobe = point.lobes[AREALIGHT_LOBE_COAT];
    } else if (index == AREALIGHT_LOBE_SHEEN) {
        lobe = point.lobes[AREALIGHT_LOBE_SHEEN];
    }
    return lobe;
}

// Whether the specular lobe of a surface is two, whose sheen has this colour: one that has any leaves the
// second place to that.
bool arealight_has_two_specular_lobes(vec3 sheen) {
    return AREALIGHT_HAS_SHEEN && sheen != vec3(0.0) ? false : AREALIGHT_HAS_TWO_SPECULAR_LOBES;
}

// Puts two specular lobes of these spaces into `point`, exact in the reflectance and its colour:
// TableSample::lobes.
void arealight_put_two_lobes(inout ArealightPoint point, ArealightSurface surface, ArealightTableSample table,
                             mat3 first, mat3 second) {
    vec3 albedo = arealight_specular_albedo(table, surface.f0, surface.f90);
    vec3 second_albedo = arealight_second_albedo(table, surface.f0, surface.f90, albedo);
    point.lobes[AREALIGHT_LOBE_SPECULAR] = arealight_lobe(first, albedo - second_albedo);
    point.lobes[AREALIGHT_LOBE_SECOND] = arealight_lobe(second, second_albedo);
}

// Puts the specular lobes of a surface into `point`, and returns their albedos: without Fresnel term, and of
// Schlick's weight. Optional features are branches, so that the pruner removes them.
ArealightTableSample arealight_put_specular_lobes(inout ArealightPoint point, ArealightFrame frame,
                                                  ArealightSurface surface) {
    bool has_two = arealight_has_two_specular_lobes(surface.sheen.color);
    if (AREALIGHT_HAS_ANISOTROPY && surface.anisotropy.roughness != surface.roughness) {
        ArealightStretchedSample stretched = arealight_stretched_sample(frame, surface, has_two);
        if (AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
            if (has_two) {
                arealight_put_two_lobes(point, surface, stretched.table, stretched.space,
                                        stretched.schlick_space);
                return stretched.table;
            }
        }
        point.lobes[AREALIGHT_LOBE_SPECULAR] = arealight_anisotropic_lobe(stretched, surface.f0, surface.f90);
        return stretched.table;
    }
    ArealightTableSample table = arealight_specular_sample(frame, surface.roughness, has_two);
    if (AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
        if (has_two) {
            arealight_put_two_lobes(point, surface, table,
                                    arealight_table_space(frame, table.matrix, table.alpha),
                                    arealight_table_space(frame, table.schlick_matrix, table.alpha));
            return table;
        }
    }
    point.lobes[AREALIGHT_LOBE_SPECULAR] = arealight_specular_lobe(frame, table, surface.f0, surface.f90);
    return table;
}

// What the lobes below a layer keep.
void arealight_dim_base(inout ArealightPoint point, float base) {
    point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo *= base;
    point.lobes[AREALIGHT_LOBE_SPECULAR].albedo *= base;
    point.lobes[AREALIGHT_LOBE_SECOND].albedo *= base;
    if (AREALIGHT_HAS_HALF_VECTORS) {
        arealight_scale_half_vectors(point.half_vectors, vec3(base));
    }
}

// Prepares a surface: its frame, and one lookup in the table (or the formula) where it has a specular lobe.
ArealightPoint arealight_point(ArealightSurface surface) {
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    ArealightPoint point;
    point.position = surface.position;
    point.to_frame = arealight_frame_matrix(frame);
    ArealightSurface with_film = surface;
    if (AREALIGHT_HAS_THIN_FILM) {
        surface = arealight_without_film(surface, frame.cos_view);
    }
    point.lobes[AREALIGHT_LOBE_DIFFUSE] = arealight_surface_diffuse_lobe(frame, surface);
    if (AREALIGHT_RESCATTERS && !bool(AREALIGHT_DIFFUSE)) {
        point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo = vec3(0.0); // what is rescattered comes to it
    }
    if (AREALIGHT_HAS_SPECULAR) {
        ArealightTableSample table = arealight_put_specular_lobes(point, frame, surface);
        if (AREALIGHT_HAS_HALF_VECTORS) {
            point.half_vectors = arealight_specular_half_vectors(frame, with_film, surface, table);
        }
        if (AREALIGHT_COUPLES_DIFFUSE && AREALIGHT_COUPLES_BY_ALBEDO) {
            vec3 reflected = arealight_specular_albedo(table, vec3(surface.interface_f0),
                                                       surface.interface_f90);
            point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo *= 1.0 - reflected.x;
        }
        if (AREALIGHT_RESCATTERS) {
            ArealightRescattered more = arealight_rescattered(table, surface.f0, surface.f90);
            point.lobes[AREALIGHT_LOBE_SPECULAR].albedo *= more.scale;
            point.lobes[AREALIGHT_LOBE_SECOND].albedo *= more.scale;
            if (AREALIGHT_HAS_HALF_VECTORS) {
                arealight_scale_half_vectors(point.half_vectors, more.scale);
            }
            point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo += more.diffuse;
        }
    }
    if (AREALIGHT_HAS_SHEEN) {
        ArealightSheenLayer sheen = arealight_sheen_layer(frame, surface.sheen);
        arealight_dim_base(point, sheen.base);
        point.lobes[AREALIGHT_LOBE_SHEEN] = sheen.lobe;
        if (AREALIGHT_HAS_TWO_SHEEN_LOBES && !arealight_has_two_specular_lobes(surface.sheen.color)) {
            point.lobes[AREALIGHT_LOBE_SECOND] = sheen.hole;
        }
    }
    if (AREALIGHT_HAS_COAT) {
        ArealightLayer coat = arealight_coat_layer(frame, surface.coat);
        arealight_dim_base(point, coat.base);
        point.lobes[AREALIGHT_LOBE_COAT] = coat.lobe;
        if (AREALIGHT_HAS_SHEEN) {
            point.lobes[AREALIGHT_LOBE_SHEEN].albedo *= coat.base;
        }
        if (AREALIGHT_HAS_HALF_VECTORS) {
            point.coat_half_vectors = arealight_coat_half_vectors(frame, surface.coat);
        }
    }
    return point;
}

// Sheen's second lobe takes light away, of a small light more than there is by 3e-3 of its radiance: no light
// is reflected as less than none.
#define AREALIGHT_FROM_ZERO(sum)                                                      \
    if (AREALIGHT_HAS_TWO_SHEEN_LOBES) {                                              \
        sum.specular = max(sum.specular, vec3(0.0));                                  \
    }

// Adds what each lobe reflects, its albedo times arealight_lobe_weight: one after the other, or in a loop.
// For light_kind.glsl.
#define AREALIGHT_UNROLLED_LOBES(sum, point, local)                                  \
    vec3 diffuse = arealight_lobe_weight(point, AREALIGHT_LOBE_DIFFUSE, local);       \
    vec3 specular = arealight_lobe_weight(point, AREALIGHT_LOBE_SPECULAR, local);     \
    vec3 second = arealight_lobe_weight(point, AREALIGHT_LOBE_SECOND, local);        \
    vec3 coat = vec3(0.0);                                                            \
    if (AREALIGHT_HAS_COAT) {                                                         \
        coat = arealight_lobe_weight(point, AREALIGHT_LOBE_COAT, local);              \
    }                                                                                 \
    vec3 sheen = vec3(0.0);                                                           \
    if (AREALIGHT_HAS_SHEEN) {                                                        \
        sheen = arealight_lobe_weight(point, AREALIGHT_LOBE_SHEEN, local);            \
    }                                                                                 \
    sum.diffuse = diffuse * point.lobes[AREALIGHT_LOBE_DIFFUSE].albedo;               \
    if (arealight_has_lobe(AREALIGHT_LOBE_SPECULAR)) {                                \
        sum.specular = specular * arealight_lobe_albedo(point, AREALIGHT_LOBE_SPECULAR, local); \
    }                                                                                 \
    if (arealight_has_lobe(AREALIGHT_LOBE_SECOND)) {                                 \
        sum.specular += second * point.lobes[AREALIGHT_LOBE_SECOND].albedo;          \
    }                                                                                 \
    if (AREALIGHT_HAS_COAT) {                                                         \
        sum.specular += coat * arealight_lobe_albedo(point, AREALIGHT_LOBE_COAT, local); \
    }                                                                                 \
    if (AREALIGHT_HAS_SHEEN) {                                                        \
        sum.specular += sheen * point.lobes[AREALIGHT_LOBE_SHEEN].albedo;             \
    }                                                                                 \
    AREALIGHT_FROM_ZERO(sum)
#define AREALIGHT_LOOPED_LOBES(sum, point, local)                                    \
    for (int i = 0; i < AREALIGHT_LOBE_END; i++) {                                    \
        if (!arealight_has_lobe(i)) {                                                 \
            continue;                                                                 \
        }                                                                             \
        vec3 reflected = arealight_lobe_albedo(point, i, local) * arealight_lobe_weight(point, i, local); \
        if (i == AREALIGHT_LOBE_DIFFUSE) {                                            \
            sum.diffuse = reflected;                                                  \
        } else {                                                                      \
            sum.specular += reflected;                                                \
        }                                                                             \
    }                                                                                 \
    AREALIGHT_FROM_ZERO(sum)

#endif
