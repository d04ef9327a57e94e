#ifndef SCENE_GLSL
#define SCENE_GLSL

// Triangles, materials and textures of a scene: tools/kernels/src/gpu.rs has the same structures, and a
// test compares the offsets. The including kernel defines SCENE_BINDING, the first of five, and SCENE_SET
// where that is not 0; the first of them is the hierarchy's, if it has none of its own.
#ifndef SCENE_SET
#define SCENE_SET 0
#endif
#ifndef BVH_NODES_BINDING
#define BVH_NODES_BINDING SCENE_BINDING
#endif
#include "arealight/lobes/sheen.glsl"
#include "arealight/thin_film.glsl"
#include "bvh.glsl"
#include "octahedron.glsl"
#include "srgb.glsl"

// Whether a material has alpha. Where none has, none is asked for: the test would be half of a ray's time.
layout(constant_id = 102) const bool HAS_ALPHA = true;

struct ArealightGpuTriangle {
    vec3 p0;
    uint material;
    vec3 p1;
    float v0;
    vec3 p2;
    float v1;
    vec3 n0;
    float u0;
    vec3 n1;
    float u1;
    vec3 n2;
    float u2;
    float v2;
    uint flags;
    uint tangent0;
    uint tangent1;
    uint tangent2;
    uint color0;
    uint color1;
    uint color2;
};

struct ArealightGpuMaterial {
    vec3 base_color;
    float metalness;
    vec3 emission;
    float roughness;
    vec3 dielectric_f0;
    float dielectric_f90;
    uint base_color_texture;
    uint metallic_roughness_texture;
    uint normal_texture;
    float normal_scale;
    uint flags;
    float alpha_cutoff;
    float base_alpha;
    uint emission_texture;
    float coat;
    float coat_roughness;
    uint coat_texture;
    uint coat_roughness_texture;
    uint coat_normal_texture;
    float coat_normal_scale;
    uint sheen_color_texture;
    uint sheen_roughness_texture;
    vec3 sheen_color;
    float sheen_roughness;
    uint anisotropy_texture;
    float anisotropy_strength;
    vec2 anisotropy_direction;
    float film_weight;
    float film_ior;
    float film_least_thickness;
    float film_thickness;
    uint film_texture;
    uint film_thickness_texture;
    uint transmission_texture;
    uint transmission_color_texture;
    vec3 transmission_color;
    float transmission;
    uint specular_texture;
    uint specular_color_texture;
    uint glass_texture;
    float glass;
};

struct ArealightGpuTexture {
    uint first_texel;
    uint width;
    uint height;
    uint flags;
};

const uint NO_TEXTURE = 0xffffffffu;
const uint TRIANGLE_TANGENTS = 1u;
const uint TRIANGLE_MIRRORED = 2u;
const uint TRIANGLE_COLORS = 4u;
const uint TRIANGLE_GROUPS_SHIFT = 8u; // the groups that it is in
const uint MATERIAL_DOUBLE_SIDED = 1u;
const uint MATERIAL_ALPHA_MASK = 2u;
const uint MATERIAL_ALPHA_BLEND = 4u;
const uint MATERIAL_UNLIT = 8u;
const uint TEXTURE_SRGB = 1u;
const uint TEXTURE_CLAMP_U = 2u;
const uint TEXTURE_CLAMP_V = 4u;
const uint TEXTURE_MIRROR_U = 8u;
const uint TEXTURE_MIRROR_V = 16u;

layout(set = SCENE_SET, binding = SCENE_BINDING + 1, std430) readonly buffer Triangles {
    ArealightGpuTriangle triangles[];
};
layout(set = SCENE_SET, binding = SCENE_BINDING + 2, std430) readonly buffer Materials {
    ArealightGpuMaterial materials[];
};
layout(set = SCENE_SET, binding = SCENE_BINDING + 3, std430) readonly buffer Textures {
    ArealightGpuTexture textures[];
};
layout(set = SCENE_SET, binding = SCENE_BINDING + 4, std430) readonly buffer Texels {
    uint texels[];
};

struct ScenePoint {
    vec3 position;
    vec3 normal;
    vec3 base_color;
    float metalness;
    float roughness;
    vec3 dielectric_f0;
    float dielectric_f90;
    vec3 emission;
    ArealightCoat coat; // its normal is unit
    ArealightSheen sheen;
    ArealightAnisotropy anisotropy; // its roughness is 0 where there is none
    ArealightThinFilm film;
    // Albedo of what is let through; the base colour of what is not metal is less by that part
    vec3 transmitted;
    float pane; // how much of that is not diffused
};

// The texel within the image, for texel coordinates from -1 to two repeats and one.
int wrap_texel(int texel, int size, bool mirrored) {
    int period = mirrored ? 2 * size : size;
    int wrapped = (texel + 2 * size) % period;
    return wrapped < size ? wrapped : period - 1 - wrapped;
}

// One axis of a texture coordinate, brought to where texel coordinates are exact: clamped to the image, or
// within two repeats, which hold the period of a mirrored texture. NaN becomes zero.
float wrap_coordinate(float coordinate, bool clamped) {
    float wrapped = clamped ? clamp(coordinate, 0.0, 1.0) : coordinate - 2.0 * floor(0.5 * coordinate);
    return wrapped > 0.0 ? min(wrapped, 2.0) : 0.0;
}

vec4 fetch_texel(ArealightGpuTexture image, ivec2 texel) {
    ivec2 last = ivec2(image.width, image.height) - 1;
    int x = (image.flags & TEXTURE_CLAMP_U) != 0u
        ? clamp(texel.x, 0, last.x) : wrap_texel(texel.x, last.x + 1, (image.flags & TEXTURE_MIRROR_U) != 0u);
    int y = (image.flags & TEXTURE_CLAMP_V) != 0u
        ? clamp(texel.y, 0, last.y) : wrap_texel(texel.y, last.y + 1, (image.flags & TEXTURE_MIRROR_V) != 0u);
    vec4 color = unpackUnorm4x8(texels[image.first_texel + uint(y) * image.width + uint(x)]);
    return (image.flags & TEXTURE_SRGB) != 0u ? vec4(linear_from_srgb(color.rgb), color.a) : color;
}

// Bilinear, decoded to linear before filtering.
vec4 sample_image(ArealightGpuTexture image, vec2 uv) {
    vec2 wrapped = vec2(wrap_coordinate(uv.x, (image.flags & TEXTURE_CLAMP_U) != 0u),
                        wrap_coordinate(uv.y, (image.flags & TEXTURE_CLAMP_V) != 0u));
    vec2 position = wrapped * vec2(image.width, image.height) - 0.5;
    vec2 node = floor(position);
    vec2 weight = position - node;
    ivec2 texel = ivec2(node);
    vec4 top = mix(fetch_texel(image, texel), fetch_texel(image, texel + ivec2(1, 0)), weight.x);
    vec4 bottom = mix(fetch_texel(image, texel + ivec2(0, 1)), fetch_texel(image, texel + ivec2(1, 1)),
                      weight.x);
    return mix(top, bottom, weight.y);
}

// The part of a texture that a pixel sees: a parallelogram about `uv`, by its sides.
struct TextureFootprint {
    vec2 uv;
    vec2 along;
    vec2 across;
};

// The most places of a long footprint; a longer one is blurred instead.
const float MOST_PLACES = 8.0;

// Level `level` of an image; the last one where there are fewer.
ArealightGpuTexture texture_level(ArealightGpuTexture image, int level) {
    for (int i = 0; i < level && max(image.width, image.height) > 1u; i++) {
        image.first_texel += image.width * image.height;
        image.width = max(image.width / 2u, 1u);
        image.height = max(image.height / 2u, 1u);
    }
    return image;
}

// The mean over a footprint: as many places along its longer side as the shorter one goes into it, each
// between the two levels whose texels are about as wide.
vec4 sample_footprint(uint index, TextureFootprint footprint) {
    ArealightGpuTexture image = textures[index];
    vec2 size = vec2(image.width, image.height);
    float along = length(footprint.along * size);
    float across = length(footprint.across * size);
    vec2 longer = along > across ? footprint.along : footprint.across;
    float most = max(along, across);
    float places = clamp(ceil(most / max(min(along, across), 1.0)), 1.0, MOST_PLACES);
    float level = clamp(log2(max(max(most / places, min(along, across)), 1.0)), 0.0, 16.0);
    ArealightGpuTexture fine = texture_level(image, int(level));
    ArealightGpuTexture coarse = texture_level(image, int(level) + 1);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 2 * int(places); i++) {
        float weight = (i & 1) == 0 ? 1.0 - fract(level) : fract(level);
        if (weight > 0.0) {
            vec2 uv = footprint.uv + ((float(i >> 1) + 0.5) / places - 0.5) * longer;
            sum += weight * sample_image((i & 1) == 0 ? fine : coarse, uv);
        }
    }
    return sum / places;
}

// The textures of a material, in this order.
const int BASE_COLOR_TEXEL = 0;
const int METALLIC_ROUGHNESS_TEXEL = 1;
const int NORMAL_TEXEL = 2;
const int EMISSION_TEXEL = 3;
const int COAT_TEXEL = 4;
const int COAT_ROUGHNESS_TEXEL = 5;
const int COAT_NORMAL_TEXEL = 6;
const int SHEEN_COLOR_TEXEL = 7;
const int SHEEN_ROUGHNESS_TEXEL = 8;
const int ANISOTROPY_TEXEL = 9;
const int SPECULAR_TEXEL = 10;
const int SPECULAR_COLOR_TEXEL = 11;
const int FILM_TEXEL = 12;
const int FILM_THICKNESS_TEXEL = 13;
const int TRANSMISSION_TEXEL = 14;
const int TRANSMISSION_COLOR_TEXEL = 15;
const int GLASS_TEXEL = 16;
const int TEXELS = 17;

// What a pixel sees of each, in one place: drivers compile it once, and pixels without textures skip it.
vec4[TEXELS] material_texels(ArealightGpuMaterial material, TextureFootprint seen) {
    uint indices[TEXELS] = uint[TEXELS](
        material.base_color_texture, material.metallic_roughness_texture, material.normal_texture,
        material.emission_texture, material.coat_texture, material.coat_roughness_texture,
        material.coat_normal_texture, material.sheen_color_texture, material.sheen_roughness_texture,
        material.anisotropy_texture, material.specular_texture, material.specular_color_texture,
        material.film_texture, material.film_thickness_texture, material.transmission_texture,
        material.transmission_color_texture, material.glass_texture);
    vec4 texels_seen[TEXELS];
    uint left = 0u;
    for (int i = 0; i < TEXELS; i++) {
        texels_seen[i] = vec4(1.0);
        left |= indices[i] == NO_TEXTURE ? 0u : 1u << i;
    }
    for (; left != 0u; left &= left - 1u) {
        int i = findLSB(left);
        texels_seen[i] = sample_footprint(indices[i], seen);
    }
    return texels_seen;
}

vec2 hit_uv(ArealightGpuTriangle triangle, vec2 barycentric) {
    return vec2(triangle.u0, triangle.v0) * (1.0 - barycentric.x - barycentric.y)
         + vec2(triangle.u1, triangle.v1) * barycentric.x + vec2(triangle.u2, triangle.v2) * barycentric.y;
}

// What the vertices' colours multiply the base colour and alpha by at a hit.
vec4 vertex_color(ArealightGpuTriangle triangle, vec2 barycentric) {
    if ((triangle.flags & TRIANGLE_COLORS) == 0u) {
        return vec4(1.0);
    }
    vec4 colors[3] = vec4[3](unpackUnorm4x8(triangle.color0), unpackUnorm4x8(triangle.color1),
                             unpackUnorm4x8(triangle.color2));
    for (int vertex = 0; vertex < 3; vertex++) {
        colors[vertex].rgb *= colors[vertex].rgb;
    }
    return colors[0] * (1.0 - barycentric.x - barycentric.y) + colors[1] * barycentric.x + colors[2]
        * barycentric.y;
}

// What part of a triangle is there at a place: all, or by the material's alpha, of a mask all or nothing.
float surface_alpha(ArealightGpuTriangle triangle, vec2 barycentric) {
    ArealightGpuMaterial material = materials[triangle.material];
    if (!HAS_ALPHA || (material.flags & (MATERIAL_ALPHA_MASK | MATERIAL_ALPHA_BLEND)) == 0u) {
        return 1.0;
    }
    float alpha = material.base_color_texture == NO_TEXTURE ? 1.0
        : sample_image(textures[material.base_color_texture], hit_uv(triangle, barycentric)).a;
    alpha *= material.base_alpha * vertex_color(triangle, barycentric).a;
    return (material.flags & MATERIAL_ALPHA_BLEND) != 0u ? alpha : alpha < material.alpha_cutoff ? 0.0 : 1.0;
}

// A tangent-space normal's axes at a hit; both zero where the triangle has no tangents.
struct TangentAxes {
    vec3 tangent;   // unit, within the surface
    vec3 bitangent; // where green points
};

// A unit direction from its place on the octahedron, two numbers of 16 bits.
vec3 unpack_direction(uint place) {
    return arealight_normalize_or(from_octahedron(unpackSnorm2x16(place)), vec3(0.0));
}

TangentAxes tangent_axes(ArealightGpuTriangle triangle, vec2 barycentric, vec3 normal) {
    if ((triangle.flags & TRIANGLE_TANGENTS) == 0u) {
        return TangentAxes(vec3(0.0), vec3(0.0));
    }
    vec3 smooth_tangent = unpack_direction(triangle.tangent0) * (1.0 - barycentric.x - barycentric.y)
                        + unpack_direction(triangle.tangent1) * barycentric.x
                            + unpack_direction(triangle.tangent2) * barycentric.y;
    vec3 tangent = arealight_normalize_or(smooth_tangent - normal * dot(normal, smooth_tangent), vec3(0.0));
    return TangentAxes(tangent, cross(normal, tangent)
                       * ((triangle.flags & TRIANGLE_MIRRORED) != 0u ? -1.0 : 1.0));
}

// The length of the mean of normals, from a normal texture's alpha.
float mean_length(float alpha) {
    return 1.0 - (1.0 - alpha) * (1.0 - alpha);
}

// The shading normal bent by a tangent-space normal texture. Where the pixel sees many normals, what their
// mean loses goes to the roughness: GGX's squared alpha is twice the variance of slopes, which is that of a
// von Mises-Fisher lobe whose mean is as long (Toksvig 2005; Banerjee et al. 2005 for the variance).
vec3 bend_normal(TangentAxes axes, uint normal_texture, vec4 texel, float scale, vec3 normal,
                 inout float roughness) {
    if (normal_texture == NO_TEXTURE || axes.tangent == vec3(0.0)) {
        return normal;
    }
    vec3 bend = texel.xyz * 2.0 - 1.0;
    bend.xy *= scale;
    float mean = max(mean_length(texel.a), 0.1);
    float variance = scale * scale * (1.0 - mean * mean) / (mean * (3.0 - mean * mean));
    float square = roughness * roughness;
    roughness = sqrt(sqrt(min(square * square + 2.0 * variance, 1.0)));
    return arealight_normalize_or(axes.tangent * bend.x + axes.bitangent * bend.y + normal * bend.z, normal);
}

// KHR_materials_anisotropy: the texture's direction and the factor's rotation, and both strengths.
ArealightAnisotropy scene_anisotropy(ArealightGpuMaterial material, TangentAxes axes, float roughness,
                                     vec4 texel) {
    bool has_texture = material.anisotropy_texture != NO_TEXTURE;
    vec2 direction = has_texture ? texel.rg * 2.0 - 1.0 : vec2(1.0, 0.0);
    vec2 turn = material.anisotropy_direction;
    direction = vec2(turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x
                     * direction.y);
    float strength = material.anisotropy_strength * texel.b;
    vec3 along = axes.tangent * direction.x + axes.bitangent * direction.y;
    return ArealightAnisotropy(along, strength > 0.0 ? arealight_gltf_anisotropy(roughness, strength) : 0.0);
}

// What of the textures a pixel sees at a hit, `steps` being how its place in the triangle's plane changes
// from pixel to pixel.
TextureFootprint hit_footprint(ArealightGpuTriangle triangle, vec2 barycentric, vec3 steps[2]) {
    vec3 u = triangle.p1 - triangle.p0;
    vec3 v = triangle.p2 - triangle.p0;
    vec3 normal = cross(u, v);
    float square = dot(normal, normal);
    vec2 origin = vec2(triangle.u0, triangle.v0);
    mat2 to_uv = mat2(vec2(triangle.u1, triangle.v1) - origin, vec2(triangle.u2, triangle.v2) - origin);
    vec2 sides[2];
    for (int i = 0; i < 2; i++) {
        vec2 moved = vec2(dot(cross(steps[i], v), normal), dot(cross(u, steps[i]), normal)) / square;
        // NaN and infinity, too, where the triangle or the step has no size
        sides[i] = all(lessThan(abs(moved), vec2(1e6))) ? to_uv * moved : vec2(0.0);
    }
    return TextureFootprint(hit_uv(triangle, barycentric), sides[0], sides[1]);
}

ScenePoint scene_point(BvhHit hit, vec3 steps[2]) {
    ArealightGpuTriangle triangle = triangles[hit.triangle];
    ArealightGpuMaterial material = materials[triangle.material];
    float u = hit.barycentric.x;
    float v = hit.barycentric.y;
    vec4 texel[TEXELS] = material_texels(material, hit_footprint(triangle, hit.barycentric, steps));

    ScenePoint point;
    // From the vertices, not from the ray: its error does not grow with the distance
    point.position = triangle.p0 + (triangle.p1 - triangle.p0) * u + (triangle.p2 - triangle.p0) * v;
    vec3 face = cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0);
    vec3 smooth_normal = triangle.n0 * (1.0 - u - v) + triangle.n1 * u + triangle.n2 * v;
    vec3 normal = arealight_normalize_or(smooth_normal, arealight_normalize_or(face, vec3(0.0, 0.0, 1.0)));
    float side = hit.back ? -1.0 : 1.0;
    TangentAxes axes = tangent_axes(triangle, hit.barycentric, normal);
    point.coat.weight = material.coat * texel[COAT_TEXEL].r;
    point.coat.roughness = material.coat_roughness * texel[COAT_ROUGHNESS_TEXEL].g;
    point.sheen.color = material.sheen_color * texel[SHEEN_COLOR_TEXEL].rgb;
    point.sheen.roughness = material.sheen_roughness * texel[SHEEN_ROUGHNESS_TEXEL].a;
    point.coat.normal = side * bend_normal(axes, material.coat_normal_texture, texel[COAT_NORMAL_TEXEL],
                                           material.coat_normal_scale, normal, point.coat.roughness);
    point.base_color = material.base_color * texel[BASE_COLOR_TEXEL].rgb
                     * vertex_color(triangle, hit.barycentric).rgb;
    point.metalness = material.metalness * texel[METALLIC_ROUGHNESS_TEXEL].b;
    point.roughness = material.roughness * texel[METALLIC_ROUGHNESS_TEXEL].g;
    point.normal = side * bend_normal(axes, material.normal_texture, texel[NORMAL_TEXEL],
                                      material.normal_scale, normal, point.roughness);
    point.anisotropy = scene_anisotropy(material, axes, point.roughness, texel[ANISOTROPY_TEXEL]);
    // KHR_materials_specular: min(reflectance by index and colour, 1) times the weight, which is the grazing
    // reflectance
    float specular_weight = texel[SPECULAR_TEXEL].a;
    point.dielectric_f90 = material.dielectric_f90 * specular_weight;
    point.dielectric_f0 = min(material.dielectric_f0 * specular_weight * texel[SPECULAR_COLOR_TEXEL].rgb,
                              vec3(point.dielectric_f90));
    point.film.weight = material.film_weight * texel[FILM_TEXEL].r;
    point.film.ior = material.film_ior;
    point.film.thickness = mix(material.film_least_thickness, material.film_thickness,
                               texel[FILM_THICKNESS_TEXEL].g);
    float transmission = material.transmission * texel[TRANSMISSION_TEXEL].a;
    point.transmitted = transmission * material.transmission_color * texel[TRANSMISSION_COLOR_TEXEL].rgb;
    // KHR_materials_transmission takes the place of what is diffused, on either side
    float glass = material.glass * texel[GLASS_TEXEL].r;
    vec3 pane = glass * point.base_color;
    point.transmitted = (1.0 - point.metalness) * ((1.0 - glass) * point.transmitted + pane);
    pane *= 1.0 - point.metalness;
    point.pane = arealight_luminance(pane) / max(arealight_luminance(point.transmitted), 1e-30);
    // Metal has its own colour still
    float left = mix((1.0 - glass) * (1.0 - transmission), 1.0, point.metalness);
    point.base_color *= left;
    point.metalness /= max(left, 1e-6);
    point.emission = material.emission * texel[EMISSION_TEXEL].rgb;
    if ((material.flags & MATERIAL_UNLIT) != 0u) {
        point.emission = point.base_color;
        point.base_color = vec3(0.0);
    }
    return point;
}

#endif
