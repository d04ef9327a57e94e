//! The textures of materials as pixels see them: near, far, and at a slant.

use arealight_scene::{Image as Picture, Scene, SceneMaterial, Texture, Triangle, Wrap};
use arealight_tests::frame::with_view;
use arealight_tests::prelude::*;
use glam::Vec2;

const SIZE: [u32; 2] = [96, 96];

/// A floor of 128 by 128 metres whose image of 2 by 2 texels repeats every two metres, seen from two metres
/// above it.
fn floor(texels: [u32; 4], material: SceneMaterial, wide: bool) -> (Scene, Camera) {
    let corner = |x: f64, z: f64| DVec3::new(x * 64.0, 0.0, z * 64.0);
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| corner(x, z));
    let triangle = |[a, b, c]: [usize; 3]| Triangle {
        positions: [a, b, c].map(|i| corners[i]),
        normals: [Vec3::Y; 3],
        uvs: [a, b, c].map(|i| Vec2::new(corners[i].x as f32, corners[i].z as f32) * 0.5),
        tangents: [Vec3::X.extend(1.0); 3],
        colors: [Triangle::WHITE; 3],
        material: 0,
        groups: 0,
    };
    let texture = Texture { image: 0, srgb: false, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat };
    let image = Picture { width: 2, height: 2, texels: texels.to_vec(), ..Picture::default() };
    let scene = Scene {
        triangles: [[0, 1, 2], [0, 2, 3]].map(triangle).to_vec(),
        materials: vec![material],
        textures: vec![texture],
        images: vec![image],
        ..Scene::default()
    };
    let towards = if wide { DVec3::new(0.0, -0.15, -1.0) } else { DVec3::new(0.0, -1.0, -0.2) };
    let camera = Camera {
        position: DVec3::new(0.3, 2.0, 40.0),
        half_height: 1.0,
        ..Camera::framing("eye", scene.bounds, towards, DVec3::Y, 1.0)
    };
    (scene, camera)
}

/// The normal and roughness, and the radiance, of each pixel that sees the floor, a row at a time.
fn seen(engine: &TestEngine, (scene, camera): &(Scene, Camera)) -> Vec<Vec<[Vec4; 2]>> {
    with_view(engine, scene, &[], (camera, SIZE), |renderer, _| {
        renderer.visibility().expect("it traces");
        let planes = [Plane::Position, Plane::Normal].map(|plane| {
            let texels: Vec<[f32; 4]> =
                renderer.g_buffer()[plane].download(Usage::COMPUTE_READ).expect("a plane");
            texels.into_iter().map(Vec4::from_array).collect::<Vec<_>>()
        });
        let radiance: Vec<Vec4> = renderer.radiance().expect("radiance");
        let rows = (0..SIZE[1] as usize).map(|row| row * SIZE[0] as usize..(row + 1) * SIZE[0] as usize);
        rows.map(|row| row.filter(|&i| planes[0][i].w > 0.0).map(|i| [planes[1][i], radiance[i]]).collect())
            .collect()
    })
}

fn spread(values: &[f32]) -> (f32, f32) {
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    (mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f32>() / values.len() as f32).sqrt())
}

#[test]
fn far_tiles_are_their_mean_and_near_ones_themselves() {
    let Some(engine) = TestEngine::new() else { return };
    let emission =
        SceneMaterial { emission: Vec3::ONE, emission_texture: Some(0), ..SceneMaterial::default() };
    let rows = seen(&engine, &floor([!0, 0xff00_0000, 0xff00_0000, !0], emission, true));
    let rows: Vec<Vec<f32>> =
        rows.iter().map(|row| row.iter().map(|[_, radiance]| radiance.x).collect()).collect();
    // In the farthest rows a tile is less than a pixel: a bilinear lookup spreads by .29 there
    let whole: Vec<&Vec<f32>> = rows.iter().filter(|row| row.len() == SIZE[0] as usize).collect();
    for row in &whole[..4] {
        let (mean, spread) = spread(row);
        assert!((mean - 0.5).abs() < 0.03 && spread < 0.07, "{mean}, {spread}");
    }
    // The twin: what is near has its contrast
    let (mean, spread) = spread(whole.last().expect("rows"));
    assert!((mean - 0.5).abs() < 0.2 && spread > 0.25, "{mean}, {spread}");
}

#[test]
fn far_bumps_are_roughness() {
    let Some(engine) = TestEngine::new() else { return };
    // Texels that are tilted by 0.3 to either side along u
    let tilted = |slope: f64| {
        let normal = DVec3::new(slope, 0.0, 1.0).normalize_or_zero() * 0.5 + 0.5;
        let [x, y, z] = normal.to_array().map(|value| (value * 255.0).round() as u8);
        u32::from_le_bytes([x, y, z, 0])
    };
    let mut bumps = SceneMaterial { normal_texture: Some(0), normal_scale: 1.0, ..SceneMaterial::default() };
    bumps.material.roughness = 0.1;
    let texels = [tilted(0.3), tilted(-0.3), tilted(0.3), tilted(-0.3)];
    let far = seen(&engine, &floor(texels, bumps.clone(), true));
    let row = far.iter().find(|row| row.len() == SIZE[0] as usize).expect("a row");
    // The variance of slopes of .3 is .09; one axis has it all, the roughness is both's mean
    let expected = (0.1_f32.powi(4) + 2.0 * 0.09 / 2.0).powf(0.25);
    for [normal, _] in row {
        assert!(normal.truncate().distance(Vec3::Y) < 0.02, "{normal}");
        assert!((normal.w - expected).abs() < 0.03, "{} is not {expected}", normal.w);
    }
    // The twin: near ones are bumps, as smooth as the material says, whatever the image has in alpha
    let near = seen(&engine, &floor(texels, bumps, false));
    let row = &near[SIZE[1] as usize / 2];
    assert!(row.iter().any(|[normal, _]| normal.x.abs() > 0.2));
    assert!(row.iter().all(|[normal, _]| (normal.w - 0.1).abs() < 1e-3), "{row:?}");
}
