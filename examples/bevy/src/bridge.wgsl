// Between Bevy's images and ours: what a G-buffer holds, and radiance that is added to a picture.

@group(0) @binding(0) var deferred: texture_2d<u32>;
@group(0) @binding(1) var normal_roughness: texture_storage_2d<rgba32float, write>;
@group(0) @binding(2) var base_color_metalness: texture_storage_2d<rgba16float, write>;
@group(0) @binding(3) var reflectances: texture_storage_2d<rgba16float, write>;
@group(0) @binding(4) var coat: texture_storage_2d<rgba16float, write>;

// A direction by its place on the octahedron, from 0 to 1.
fn from_octahedron(place: vec2<f32>) -> vec3<f32> {
    let folded = place * 2.0 - 1.0;
    let z = 1.0 - abs(folded.x) - abs(folded.y);
    let below = max(-z, 0.0);
    return normalize(vec3(folded - select(vec2(-below), vec2(below), folded >= vec2(0.0)), z));
}

// Unpacks a pixel of Bevy's G-buffer, of four words: colour to the power of 1 / 2.2, and roughness; emission;
// reflectance, metalness, occlusion, and weight and roughness of the coat, four bits each; 12 bits for each
// axis of the normal's place on the octahedron, and flags, of which the first says that it is unlit.
@compute @workgroup_size(8, 8)
fn unpack(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = id.xy;
    if any(pixel >= textureDimensions(deferred)) {
        return;
    }
    let words = textureLoad(deferred, pixel, 0);
    let color_roughness = unpack4x8unorm(words.x);
    let material = unpack4x8unorm(words.z);
    // Zeros are of what is not deferred, since its occlusion would be 1
    let is_lit = f32(any(words != vec4(0u)) && (words.w >> 24u & 1u) == 0u);
    let place = vec2(words.w & 0xfffu, words.w >> 12u & 0xfffu);
    let f0 = 0.16 * material.x * material.x;
    let coat_bits = words.z >> 24u;
    let normal = from_octahedron(vec2<f32>(place) / 4095.0);
    textureStore(normal_roughness, pixel, vec4(normal, color_roughness.w));
    textureStore(base_color_metalness, pixel,
                 is_lit * vec4(pow(color_roughness.rgb, vec3(2.2)), material.y));
    textureStore(reflectances, pixel, is_lit * vec4(vec3(f0), min(50.0 * f0, 1.0)));
    let coat_weight = is_lit * f32(coat_bits & 0xfu) / 15.0;
    textureStore(coat, pixel, vec4(coat_weight, f32(coat_bits >> 4u) / 30.0, 0.0, 0.0));
}

// A triangle that covers the picture.
struct Covered {
    @builtin(position) place: vec4<f32>,
    @location(0) coordinate: vec2<f32>,
}

@vertex
fn cover(@builtin(vertex_index) index: u32) -> Covered {
    let corner = vec2(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Covered(vec4(corner * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0), corner);
}

@group(0) @binding(0) var radiance: texture_2d<f32>;

// What is added to a pixel: no more than half floats hold.
@fragment
fn add(covered: Covered) -> @location(0) vec4<f32> {
    let texel = textureLoad(radiance, vec2<u32>(covered.place.xy), 0);
    return vec4(min(texel.rgb, vec3(65504.0)), 0.0);
}

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var bilinear: sampler;

// A texel of a smaller image: the mean of a grid of places, at most two texels of the image apart.
@fragment
fn shrink(covered: Covered) -> @location(0) vec4<f32> {
    let texel = fwidth(covered.coordinate);
    let grid = vec2<u32>(max(ceil(texel * vec2<f32>(textureDimensions(image)) / 2.0), vec2(1.0)));
    var sum = vec4(0.0);
    for (var y = 0u; y < grid.y; y++) {
        for (var x = 0u; x < grid.x; x++) {
            let place = (vec2(f32(x), f32(y)) + 0.5) / vec2<f32>(grid) - 0.5;
            sum += textureSampleLevel(image, bilinear, covered.coordinate + place * texel, 0.0);
        }
    }
    return sum / f32(grid.x * grid.y);
}
