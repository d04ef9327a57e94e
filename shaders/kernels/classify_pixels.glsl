#ifndef CLASSIFY_PIXELS_GLSL
#define CLASSIFY_PIXELS_GLSL

// Bounds over the pixels of a tile: an invocation reads a pixel, and the workgroup reduces what they found.
//
// Horizons. That of Lambert's lobe is the surface. That of a fitted lobe is a plane through the point as
// well: its normal is proportional to mirror + q across (table.glsl), with the ratio q = z / w of the texel
// that the table gives. With p = q / sin, and the unit normal n, the unit vector v to the viewer and the
// cosine c between them, that normal is
//
//     (2 c + p (1 - 2 c^2)) n + (p c - 1) v.
//
// LobeHorizons holds the least and the largest p of each cell of the table for both of its lobes; a mixture
// of the two, by the reflectance, has a weighted mean of theirs. So the table is not read here. The planes of
// a tile are held by the box of their normals and by the range of their offsets, which makes them sharp on a
// flat floor however far it extends; the range of p is a spread of the normals. A coat's lobe is that of the
// table without Fresnel term, about the coat's own normal.

#include "arealight/lobes/diffuse.glsl"
#include "arealight/thin_film.glsl"
#include "tile_bounds.glsl"
#include "tile_contribution.glsl"
#include "tile_reduction.glsl"

// What the kernel knows of a cell of the table: LobeHorizon in Rust.
struct ArealightGpuLobeHorizon {
    vec2 lobe;     // the least and the largest p of the lobe without Fresnel term
    vec2 schlick;  // of the lobe of Schlick's weight
    vec2 weight;   // what a mixture of the two is weighed by, its ends
    vec2 envelope; // tile_contribution.glsl
    float schlick_albedo;
    float reserved0;
    float reserved1;
    float reserved2;
};

layout(set = 0, binding = LOBE_HORIZONS_BINDING, std430) readonly buffer LobeHorizons {
    ArealightGpuLobeHorizon lobe_horizons[];
};

// The pairs of tile_maxima. The least of a value is held as the largest of its negative.
const int SURFACE_PAIR = 0;    // of the planes of the surfaces: normal and offset, their negatives
const int LOBE_PAIR = 1;       // of the horizons of the glossy lobes, likewise
// Position and distance, negative position and the spread of the lobes' horizons
const int POSITION_PAIR = 2;
const int REFLECTION_PAIR = 3; // whether some diffuse albedo is not zero; TileReflection's
const int MIRROR_PAIR = 4;     // of the planes whose normals are the mirror directions of the view, with CULL
// With coats: as LOBE_PAIR and MIRROR_PAIR; and the spread of the horizons and TileReflection's. Pixels
// without a coat have none.
const int COAT_PAIR = 5;
const int COAT_MIRROR_PAIR = 6;
const int COAT_REFLECTION_PAIR = 7;

// The cell of the table that a roughness and a view are looked up in.
ArealightGpuLobeHorizon lobe_horizon(float roughness, float cosine) {
    roughness = arealight_clamped_roughness(roughness, sqrt(AREALIGHT_MIN_ALPHA));
    vec2 place = vec2(roughness, sqrt(max(1.0 - cosine, 0.0))) * float(constants.horizon_cells);
    // Of whole numbers, so that NaN is a cell too
    uvec2 cell = min(uvec2(place), uvec2(constants.horizon_cells - 1u));
    return lobe_horizons[cell.y * constants.horizon_cells + cell.x];
}

// The range of p for a lobe with this Fresnel term, f0 being the mean of its channels.
vec2 horizon_range(float f0, float f90, ArealightGpuLobeHorizon horizon) {
    // What part of the ratio Schlick's lobe has, by arealight_schlick_share and the lobes' heights
    vec2 part = vec2(0.0, 1.0);
    if (!AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
        vec2 weight = (f90 - f0) * horizon.weight;
        part = f0 >= 0.0 && f90 > f0 ? weight / (f0 + weight + 1e-30) : vec2(0.0, f0 <= 1.0 ? 0.0 : 1.0);
    }
    vec4 ends = mix(vec4(horizon.lobe, horizon.lobe), vec4(horizon.schlick, horizon.schlick), part.xxyy);
    return vec2(min(ends.x, ends.z), max(ends.y, ends.w));
}

void reduce_planes(int pair, vec3 normal, vec3 position, bool has_surface) {
    vec4 plane = vec4(normal, dot(normal, position));
    tile_reduce(pair, has_surface ? plane : vec4(-TILE_FAR), has_surface ? -plane : vec4(-TILE_FAR));
}

// A fitted lobe at a pixel.
struct PixelLobe {
    vec3 horizon;  // the normal of its horizon, unit
    float spread;  // that may differ by as much; TILE_FAR where nothing is known of it
    vec3 mirror;   // the mirror direction of the view
    vec2 envelope; // TileReflection's
};

// `range`: that of p, of a lobe of the cell about a normal, `cosine` from the view.
PixelLobe pixel_lobe(vec3 normal, vec3 view, float cosine, ArealightGpuLobeHorizon cell, vec2 range) {
    float p = 0.5 * (range.x + range.y);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float scale = inversesqrt(1.0 + p * p * sine * sine);
    vec3 horizon = (normal * (2.0 * cosine + p * (1.0 - 2.0 * cosine * cosine)) + view * (p * cosine - 1.0))
        * scale;
    // The cells do not hold for views from below. NaN, of a cell without a horizon, fails every comparison
    float spread = cosine > 0.0 && range.y - range.x < TILE_FAR ? 0.5 * (range.y - range.x) * sine : TILE_FAR;
    // What is left of a lobe above the surface is more than half of it, and has all of its albedo
    float gain = AREALIGHT_CLIPS_AT_SURFACE ? 2.0 : 1.0;
    return PixelLobe(horizon, spread, 2.0 * cosine * normal - view,
                     vec2(cell.envelope.x * gain, cell.envelope.y));
}

// The density of a coupled diffuse lobe over that of Lambert's with the same albedo, at least and at most:
// the singular values of arealight_coupled_diffuse_lobe's space for the views where it differs most give
// 0.874 and 1.151.
const vec2 COUPLED_DENSITY = vec2(0.87, 1.16);

// The least and the most of its diffuse albedo that a surface reflects, as density over Lambert's.
vec2 diffuse_part(ArealightSurface surface, float cosine, ArealightGpuLobeHorizon cell) {
    if (!AREALIGHT_COUPLES_DIFFUSE) {
        return vec2(1.0);
    }
    if (AREALIGHT_COUPLES_BY_ALBEDO) {
        float most = surface.interface_f0 + max(surface.interface_f90 - surface.interface_f0, 0.0)
            * cell.schlick_albedo;
        return vec2(HAS_HORIZON ? max(1.0 - most, 0.0) : 0.0, 1.0);
    }
    float part = arealight_coupled_part(clamp(cosine, 0.0, 1.0), surface.interface_f0, surface.interface_f90);
    return part * COUPLED_DENSITY;
}

// Finds the bounds of a coat's lobe, and takes from the lobes below what the coat reflects: from the diffuse
// one's bounds, `part`, and from the specular one. `cosine`: of the surface's normal.
void reduce_coat(inout ArealightSurface surface, inout vec2 part, vec3 normal, vec3 view, float cosine,
                 vec3 position, bool has_surface) {
    vec3 own_normal = AREALIGHT_HAS_COAT_NORMAL ? arealight_normalize_or(surface.coat.normal, normal)
        : normal;
    float own_cosine = dot(own_normal, view);
    // What it keeps at least from the lobes below, and what it reflects at most
    float kept = AREALIGHT_COATS_BY_ALBEDO ? 0.0 : arealight_coat_share(surface.coat, own_cosine);
    float share = AREALIGHT_COATS_BY_ALBEDO ? surface.coat.weight : kept;
    bool has_coat = has_surface && surface.coat.weight != 0.0;
    ArealightGpuLobeHorizon cell = lobe_horizon(surface.coat.roughness, own_cosine);
    vec2 range = AREALIGHT_COATS_BY_ALBEDO ? horizon_range(AREALIGHT_COAT_F0, 1.0, cell) : cell.lobe;
    PixelLobe lobe = pixel_lobe(own_normal, view, own_cosine, cell, range);
    // A view from below the surface counts as grazing, for the coat too
    float spread = HAS_COAT_HORIZON && cosine > 0.0 ? lobe.spread : TILE_FAR;
    reduce_planes(COAT_PAIR, lobe.horizon, position, has_coat);
    if (CULL != 0u) {
        reduce_planes(COAT_MIRROR_PAIR, lobe.mirror, position, has_coat);
        part *= 1.0 - vec2(share, kept);
        surface.f0 *= 1.0 - kept;
        surface.f90 *= 1.0 - kept;
    }
    vec4 reflection = vec4(spread, lobe.envelope.x, -lobe.envelope.y, share);
    tile_reduce(COAT_REFLECTION_PAIR, has_coat ? reflection : vec4(-TILE_FAR), vec4(-TILE_FAR));
}

// Finds the bounds over the sample that is read, and those before.
void reduce_sample(ivec2 pixel) {
    vec3 position;
    bool is_inside = all(lessThan(pixel, ivec2(constants.size)));
    pixel = min(pixel, ivec2(constants.size) - 1);
    ivec2 texel = g_buffer_texel(pixel);
    bool has_surface = load_position_of(texel, pixel, ivec2(constants.size),
                                        position) && is_inside && passes_stencil(texel);
    ArealightSurface surface = load_seen_surface(texel, position);
    position = IS_ORTHOGRAPHIC ? position : -surface.view;
    if (IS_TRANSMITTED) {
        surface = arealight_other_side(surface);
    }
    vec3 normal = arealight_normalize_or(surface.normal, vec3(0.0, 0.0, 1.0));
    float distance = sqrt(dot(position, position));
    // Where numbers are infinite or NaN, nothing is known of the tile
    float known_distance = distance > 0.0 && distance < TILE_FAR ? distance : TILE_FAR;
    reduce_planes(SURFACE_PAIR, normal, position, has_surface);
    if (HAS_LINKS) {
        uvec4 bits = uvec4(1u, 2u, 4u, 8u) & (has_surface ? surface_groups(texel) : 0u);
        uvec4 others = uvec4(16u, 32u, 64u, 128u) & (has_surface ? surface_groups(texel) : 0u);
        tile_reduce(GROUPS_PAIR, vec4(bits), vec4(others));
    }

    vec3 view = surface.view / (IS_ORTHOGRAPHIC ? sqrt(dot(surface.view, surface.view)) : distance);
    float cosine = dot(normal, view);
    if (AREALIGHT_HAS_THIN_FILM) {
        surface = arealight_without_film(surface, clamp(cosine, 0.0, 1.0));
    }
    ArealightGpuLobeHorizon cell;
    if (HAS_HORIZON) {
        cell = lobe_horizon(surface.roughness, cosine);
    }
    vec2 part = diffuse_part(surface, cosine, cell);
    if (AREALIGHT_HAS_COAT) {
        reduce_coat(surface, part, normal, view, cosine, position, has_surface);
    }

    // The glossy lobe: its horizon, and what it reflects at most
    float spread = 0.0;
    bool has_sheen = AREALIGHT_HAS_SHEEN && surface.sheen.color != vec3(0.0);
    vec3 reflection = vec3(0.0, -TILE_FAR, 0.0);
    if (HAS_HORIZON) {
        PixelLobe lobe = pixel_lobe(normal, view, cosine, cell,
                                    horizon_range(dot(surface.f0, vec3(1.0 / 3.0)), surface.f90, cell));
        spread = lobe.spread;
        reduce_planes(LOBE_PAIR, lobe.horizon, position, has_surface);

        if (CULL != 0u) {
            reduce_planes(MIRROR_PAIR, lobe.mirror, position, has_surface);
            // The F0 part's albedo is at most 1
            vec3 albedo = surface.f0 + max(vec3(surface.f90) - surface.f0, vec3(0.0)) * cell.schlick_albedo;
            reflection = vec3(lobe.envelope.x, -lobe.envelope.y, arealight_max_component(albedo));
        }
    }
    // Of the lobe of sheen nothing is known, nor of one of two roughnesses: the table's cells do not hold for
    // it
    bool is_stretched = AREALIGHT_HAS_ANISOTROPY && surface.anisotropy.roughness != surface.roughness;
    spread = has_sheen || is_stretched ? TILE_FAR : spread;
    tile_reduce(POSITION_PAIR, has_surface ? vec4(position, known_distance) : vec4(-TILE_FAR),
                has_surface ? vec4(-position, spread) : vec4(-TILE_FAR));

    if (HAS_DIFFUSE || CULL != 0u) {
        vec3 albedo = HAS_DIFFUSE ? surface.diffuse_albedo : vec3(0.0);
        bool is_rescattered = AREALIGHT_RESCATTERS && surface.f0 != vec3(0.0);
        float is_diffuse = albedo != vec3(0.0) || is_rescattered ? 1.0 : 0.0;
        vec2 diffuse = vec2(-min(albedo.r, min(albedo.g, albedo.b)), arealight_max_component(albedo)) * part;
        tile_reduce(REFLECTION_PAIR, has_surface ? vec4(is_diffuse, reflection) : vec4(-TILE_FAR),
                    has_surface ? vec4(diffuse, 0.0, 0.0) : vec4(-TILE_FAR));
    }
}

// Finds the bounds. They are there after the next barrier.
void reduce_pixels(ivec2 pixel) {
    reduce_sample(pixel);
    // The first has a call of its own: within a loop, compilers would unroll less of what it calls
    if (G_BUFFER_SAMPLES > 1) {
        for (int index = 1; index < G_BUFFER_SAMPLES; index++) {
            g_buffer_sample = index;
            reduce_sample(pixel);
        }
    }
}

// The largest distance of a pixel to the camera: negative where no pixel has a surface.
float tile_distance() {
    return tile_maxima[2 * POSITION_PAIR].w;
}

// Whether the numbers of every pixel are finite: else no bound holds.
bool tile_is_known() {
    return tile_distance() < TILE_FAR;
}

// Whether the horizons of every pixel's glossy lobe are known: none is stretched, and none has sheen.
bool tile_has_lobe() {
    return HAS_HORIZON || (AREALIGHT_HAS_SHEEN && !HAS_GLOSSY)
        ? tile_maxima[2 * POSITION_PAIR + 1].w < TILE_FAR : !HAS_GLOSSY;
}

// The spread of the horizons of the coats: negative where no pixel has a coat.
float tile_coat_spread() {
    return AREALIGHT_HAS_COAT ? tile_maxima[2 * COAT_REFLECTION_PAIR].x : -TILE_FAR;
}

// Whether they are known of every pixel that has a coat.
bool tile_has_coat_horizon() {
    return tile_coat_spread() < TILE_FAR;
}

// The groups of its surfaces.
uint tile_groups() {
    vec4 bits = vec4(255.0, vec3(0.0));
    if (HAS_LINKS) {
        bits = tile_maxima[2 * GROUPS_PAIR] + tile_maxima[2 * GROUPS_PAIR + 1];
    }
    return uint(bits.x + bits.y + bits.z + bits.w);
}

bool tile_is_diffuse() {
    return HAS_DIFFUSE && tile_maxima[2 * REFLECTION_PAIR].x > 0.0;
}

vec3 tile_origin() {
    return IS_ORTHOGRAPHIC ? vec3(0.0) : constants.camera;
}

TileBox tile_position() {
    return TileBox(-tile_maxima[2 * POSITION_PAIR + 1].xyz, tile_maxima[2 * POSITION_PAIR].xyz);
}

TilePlanes tile_planes(int pair) {
    vec4 high = tile_maxima[2 * pair];
    vec4 low = -tile_maxima[2 * pair + 1];
    float spread = pair == LOBE_PAIR ? tile_maxima[2 * POSITION_PAIR + 1].w : pair == COAT_PAIR
        ? tile_coat_spread() : 0.0;
    return TilePlanes(TileBox(low.xyz, high.xyz), vec2(low.w, high.w), spread);
}

TileReflection tile_reflection() {
    vec4 glossy = tile_maxima[2 * REFLECTION_PAIR];
    vec2 diffuse = tile_maxima[2 * REFLECTION_PAIR + 1].xy;
    TileLobe coat = TileLobe(vec2(0.0), 0.0);
    if (tile_coat_spread() >= 0.0) {
        vec4 most = tile_maxima[2 * COAT_REFLECTION_PAIR];
        coat = TileLobe(vec2(most.y, -most.z), most.w);
    }
    return TileReflection(vec2(-diffuse.x, diffuse.y), TileLobe(vec2(glossy.y, -glossy.z), glossy.w), coat);
}

#endif
