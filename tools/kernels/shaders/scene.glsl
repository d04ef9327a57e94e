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
const uint TRIANGLE_LAMP = 1u;
const uint TRIANGLE_TANGENTS = 2u;
const uint TRIANGLE_MIRRORED = 4u;
const uint TRIANGLE_COLORS = 8u;
const uint MATERIAL_DOUBLE_SIDED = 1u;
const uint MATERIAL_ALPHA_MASK = 2u;
const uint MATERIAL_ALPHA_BLEND = 4u;
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

// Bilinear, decoded to linear before filtering; white where there is no texture.
vec4 sample_texture(uint index, vec2 uv) {
    if (index == NO_TEXTURE) {
        return vec4(1.0);
    }
    ArealightGpuTexture image = textures[index];
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
    if ((material.flags & (MATERIAL_ALPHA_MASK | MATERIAL_ALPHA_BLEND)) == 0u) {
        return 1.0;
    }
    float alpha = sample_texture(material.base_color_texture, hit_uv(triangle, barycentric)).a
        * material.base_alpha * vertex_color(triangle, barycentric).a;
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

// The shading normal bent by a tangent-space normal texture.
vec3 bend_normal(TangentAxes axes, uint normal_texture, float scale, vec3 normal, vec2 uv) {
    if (normal_texture == NO_TEXTURE || axes.tangent == vec3(0.0)) {
        return normal;
    }
    vec3 bend = sample_texture(normal_texture, uv).xyz * 2.0 - 1.0;
    bend.xy *= scale;
    return arealight_normalize_or(axes.tangent * bend.x + axes.bitangent * bend.y + normal * bend.z, normal);
}

// KHR_materials_anisotropy: the texture's direction and the factor's rotation, and both strengths.
ArealightAnisotropy scene_anisotropy(ArealightGpuMaterial material, TangentAxes axes, float roughness,
                                     vec2 uv) {
    vec3 texel = vec3(1.0, 0.5, 1.0);
    if (material.anisotropy_texture != NO_TEXTURE) {
        texel = sample_texture(material.anisotropy_texture, uv).rgb;
    }
    vec2 direction = texel.rg * 2.0 - 1.0;
    vec2 turn = material.anisotropy_direction;
    direction = vec2(turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x
                     * direction.y);
    float strength = material.anisotropy_strength * texel.b;
    vec3 along = axes.tangent * direction.x + axes.bitangent * direction.y;
    return ArealightAnisotropy(along, strength > 0.0 ? arealight_gltf_anisotropy(roughness, strength) : 0.0);
}

ScenePoint scene_point(BvhHit hit) {
    ArealightGpuTriangle triangle = triangles[hit.triangle];
    ArealightGpuMaterial material = materials[triangle.material];
    float u = hit.barycentric.x;
    float v = hit.barycentric.y;
    vec2 uv = hit_uv(triangle, hit.barycentric);

    ScenePoint point;
    // From the vertices, not from the ray: its error does not grow with the distance
    point.position = triangle.p0 + (triangle.p1 - triangle.p0) * u + (triangle.p2 - triangle.p0) * v;
    vec3 face = cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0);
    vec3 smooth_normal = triangle.n0 * (1.0 - u - v) + triangle.n1 * u + triangle.n2 * v;
    vec3 normal = arealight_normalize_or(smooth_normal, arealight_normalize_or(face, vec3(0.0, 0.0, 1.0)));
    float side = hit.back ? -1.0 : 1.0;
    TangentAxes axes = tangent_axes(triangle, hit.barycentric, normal);
    point.normal = side * bend_normal(axes, material.normal_texture, material.normal_scale, normal, uv);
    point.coat.normal = side * bend_normal(axes, material.coat_normal_texture, material.coat_normal_scale,
                                           normal, uv);
    point.coat.weight = material.coat * sample_texture(material.coat_texture, uv).r;
    point.coat.roughness = material.coat_roughness * sample_texture(material.coat_roughness_texture, uv).g;
    point.sheen.color = material.sheen_color * sample_texture(material.sheen_color_texture, uv).rgb;
    point.sheen.roughness = material.sheen_roughness * sample_texture(material.sheen_roughness_texture, uv).a;

    vec4 metallic_roughness = sample_texture(material.metallic_roughness_texture, uv);
    point.base_color = material.base_color * sample_texture(material.base_color_texture, uv).rgb
                     * vertex_color(triangle, hit.barycentric).rgb;
    point.metalness = material.metalness * metallic_roughness.b;
    point.roughness = material.roughness * metallic_roughness.g;
    point.anisotropy = scene_anisotropy(material, axes, point.roughness, uv);
    // KHR_materials_specular: min(reflectance by index and colour, 1) times the weight, which is the grazing
    // reflectance
    float specular_weight = sample_texture(material.specular_texture, uv).a;
    point.dielectric_f90 = material.dielectric_f90 * specular_weight;
    point.dielectric_f0 = min(material.dielectric_f0 * specular_weight
                              * sample_texture(material.specular_color_texture, uv).rgb,
                              vec3(point.dielectric_f90));
    point.film.weight = material.film_weight * sample_texture(material.film_texture, uv).r;
    point.film.ior = material.film_ior;
    point.film.thickness = mix(material.film_least_thickness, material.film_thickness,
                               sample_texture(material.film_thickness_texture, uv).g);
    float transmission = material.transmission * sample_texture(material.transmission_texture, uv).a
        * (1.0 - point.metalness);
    point.transmitted = transmission * material.transmission_color
        * sample_texture(material.transmission_color_texture, uv).rgb;
    // KHR_materials_transmission takes the place of what is diffused, on either side
    float glass = material.glass * sample_texture(material.glass_texture, uv).r * (1.0 - point.metalness);
    vec3 pane = glass * point.base_color;
    point.transmitted = (1.0 - glass) * point.transmitted + pane;
    point.pane = arealight_luminance(pane) / max(arealight_luminance(point.transmitted), 1e-30);
    point.base_color *= (1.0 - glass) * (1.0 - transmission);
    point.emission = material.emission * sample_texture(material.emission_texture, uv).rgb;
    return point;
}

#endif
