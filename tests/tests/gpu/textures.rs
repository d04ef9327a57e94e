//! Textures of the visibility kernel, near the image and far from it, against a float64 twin.

use arealight::gpu::GpuBvhNode;
use arealight_scene::SceneMaterial;
use arealight_tests::prelude::*;
use arealight_tool_kernels::gpu::{GpuMaterial, GpuTexture, GpuTriangle, VisibilityConstants};

/// For each texture coordinate a triangle before the pixel of a row of pixels, with that coordinate all over.
fn scene(uvs: &[[f32; 2]], texture: GpuTexture, texels: &[u32]) -> SceneBuffers {
    let step = 2.0 / uvs.len() as f32;
    let triangle = |(i, &[u, v]): (usize, &[f32; 2])| {
        let left = -1.0 + i as f32 * step;
        let up = [0.0, 0.0, 1.0];
        GpuTriangle {
            p0: [left, -9.0, -1.0],
            p1: [left + step, -9.0, -1.0],
            p2: [left + 0.5 * step, 9.0, -1.0],
            n0: up,
            n1: up,
            n2: up,
            u0: u,
            u1: u,
            u2: u,
            v0: v,
            v1: v,
            v2: v,
            color0: u32::MAX,
            color1: u32::MAX,
            color2: u32::MAX,
            ..bytemuck::Zeroable::zeroed()
        }
    };
    SceneBuffers {
        origin: DVec3::ZERO,
        nodes: vec![GpuBvhNode {
            min: [-9.0, -9.0, -1.0],
            first: 0,
            max: [9.0, 9.0, -1.0],
            count: uvs.len() as u32,
        }],
        triangles: uvs.iter().enumerate().map(triangle).collect(),
        // Linear, so that the texel's green and blue come out as they are
        materials: vec![
            (&SceneMaterial {
                material: Material { metalness: 1.0, ..Material::default() },
                base_alpha: 1.0,
                metallic_roughness_texture: Some(0),
                ..SceneMaterial::default()
            })
                .into(),
        ],
        textures: vec![texture],
        texels: texels.to_vec(),
    }
}

/// What sees the triangles of [`scene`], whose G-buffer is filled.
fn renderer<'a>(engine: &'a TestEngine, scene: &SceneBuffers) -> SceneRenderer<'a> {
    let camera = VisibilityConstants {
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        forward: [0.0, 0.0, -1.0],
        ..bytemuck::Zeroable::zeroed()
    };
    let mut renderer =
        SceneRenderer::new(engine, scene, &[], camera, [scene.triangles.len() as u32, 1]).unwrap();
    renderer.visibility().unwrap();
    renderer
}

/// The roughness that the kernel finds at each pixel of the row: the green channel, bilinear.
fn sampled(engine: &TestEngine, scene: &SceneBuffers) -> Vec<f64> {
    let renderer = renderer(engine, scene);
    let normal: Vec<[f32; 4]> = renderer.g_buffer()[Plane::Normal].download(Usage::COMPUTE_READ).unwrap();
    normal.iter().map(|texel| texel[3].into()).collect()
}

/// The twin: each texel coordinate wrapped in integers, in float64.
fn expected(uv: [f32; 2], texture: GpuTexture, texels: &[u32]) -> f64 {
    let size = [i64::from(texture.width), i64::from(texture.height)];
    let wrap = |texel: i64, axis: usize| {
        let (clamp, mirror) =
            [(GpuTexture::CLAMP_U, GpuTexture::MIRROR_U), (GpuTexture::CLAMP_V, GpuTexture::MIRROR_V)][axis];
        if texture.flags & clamp != 0 {
            return texel.clamp(0, size[axis] - 1);
        }
        let mirrored = texture.flags & mirror != 0;
        let period = if mirrored { 2 * size[axis] } else { size[axis] };
        let wrapped = texel.rem_euclid(period);
        if wrapped < size[axis] { wrapped } else { period - 1 - wrapped }
    };
    let position = [0, 1].map(|axis| f64::from(uv[axis]) * size[axis] as f64 - 0.5);
    let node = position.map(f64::floor);
    let green = |dx: i64, dy: i64| {
        let (x, y) = (wrap(node[0] as i64 + dx, 0), wrap(node[1] as i64 + dy, 1));
        f64::from(texels[(y * size[0] + x) as usize] >> 8 & 0xff) / 255.0
    };
    let (s, t) = (position[0] - node[0], position[1] - node[1]);
    let top = green(0, 0) * (1.0 - s) + green(1, 0) * s;
    let bottom = green(0, 1) * (1.0 - s) + green(1, 1) * s;
    top * (1.0 - t) + bottom * t
}

#[test]
fn textures_wrap_wherever_the_coordinate_is() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(31);
    let (width, height) = (300, 7);
    let texels: Vec<u32> = (0..width * height).map(|_| (random.unit() * 4e9) as u32).collect();
    let mut comparison = Comparison::new("texture wrap");
    for flags in [
        0,
        GpuTexture::CLAMP_U,
        GpuTexture::CLAMP_V,
        GpuTexture::MIRROR_U | GpuTexture::MIRROR_V,
        GpuTexture::CLAMP_U | GpuTexture::MIRROR_V,
    ] {
        let texture = GpuTexture { first_texel: 0, width, height, flags };
        let near_and_far = [
            [0.3, 0.6],
            [0.0, 1.0],
            [-0.25, 1.75],
            [-3.5, 2.001],
            [300.125, -400.25],
            [999.5, 7.75],
            // Beyond, no texel is hit for certain, and none may be read that is not there: GPU-assisted
            // validation looks
            [20000.3, -5000.7],
            [-1e6, 1e6],
            [1e30, -f32::MAX],
            [f32::NAN, f32::INFINITY],
        ];
        let found = sampled(&engine, &scene(&near_and_far, texture, &texels));
        for (uv, found) in near_and_far.into_iter().zip(found) {
            assert!((0.0..=1.0).contains(&found), "{uv:?} {flags}: {found}");
            // The coordinate is interpolated from three equal ones, which rounds it by 2^-23 of itself; the
            // steepest gradient is one a texel
            let texel =
                f64::from(uv[0].abs()) * f64::from(width) + f64::from(uv[1].abs()) * f64::from(height);
            let bound = 1e-4 + texel * 2.0_f64.powi(-22);
            if bound < 0.1 {
                comparison.add(found, expected(uv, texture, &texels), bound, || format!("{uv:?} {flags}"));
            }
        }
    }
    comparison.assert_all();
}

#[test]
fn textures_multiply_a_dielectrics_reflectances() {
    let Some(engine) = TestEngine::new() else { return };
    // The colour is sRGB, the weight is not. Red is cut off where the weight is 1, before the weight
    let (texel, weight) = (0x8040_80ff, f64::from(0x80) / 255.0);
    let linear = |byte: f64| ((byte / 255.0 + 0.055) / 1.055).powf(2.4);
    let color = [1.0, linear(128.0), linear(64.0)];
    let (f0, f90) = ([0.9, 0.04, 0.25], 0.5);
    let texture = GpuTexture { first_texel: 0, width: 1, height: 1, flags: 0 };
    let found = |specular_texture: u32, specular_color_texture: u32| {
        let mut scene = scene(&[[0.5; 2]], texture, &[texel]);
        scene.textures.push(GpuTexture { flags: GpuTexture::SRGB, ..texture });
        let material = &mut scene.materials[0];
        (material.dielectric_f0, material.dielectric_f90) = (f0.map(|f| f as f32), f90 as f32);
        (material.specular_texture, material.specular_color_texture) =
            (specular_texture, specular_color_texture);
        let specular: Vec<[f32; 4]> =
            renderer(&engine, &scene).g_buffer()[Plane::Specular].download(Usage::COMPUTE_READ).unwrap();
        specular[0].map(f64::from)
    };
    let none = GpuMaterial::NO_TEXTURE;
    let mut comparison = Comparison::new("reflectances of a dielectric");
    for (specular, color_texture) in [(none, none), (0, none), (none, 1), (0, 1)] {
        let weight = if specular == none { 1.0 } else { weight };
        let color = if color_texture == none { [1.0; 3] } else { color };
        let [r, g, b] = [0, 1, 2].map(|c| (f0[c] * color[c]).min(f90) * weight);
        for (found, expected) in found(specular, color_texture).into_iter().zip([r, g, b, f90 * weight]) {
            // Bytes are decoded by a power of 2.4: a few of its last places, of numbers below 1
            comparison.add(found, expected, 1e-6, || format!("{specular} {color_texture}"));
        }
    }
    comparison.assert_all();
}
