//! Shadows of scenes from a micrometre to ten kilometres are alike, by rays and by Monte Carlo.

use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [96, 72];

#[derive(Clone, Copy)]
enum Method {
    Unshadowed,
    Rays(ShadowFilter),
    Reference,
}

/// What a camera sees of a floor with a box on it and one above it, of a size in metres, turned so that
/// nothing is along an axis; positions are relative to the camera, or to the middle of the floor.
fn picture(engine: &TestEngine, scale: f64, from_camera: bool, method: Method) -> Vec<f64> {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.2);
    let place = |p: DVec3| turn * p * scale;
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mut triangles = square(0.0, 3.0).to_vec();
    triangles.extend(box_of(corner(-0.5, 0.5, -0.4), corner(0.4, 0.8, 0.3)));
    triangles.extend(box_of(corner(0.8, 0.0, -0.2), corner(1.1, 0.5, 0.2)));
    let triangles: Vec<_> = triangles.into_iter().map(|t| t.map(place)).collect();
    let scene = scene_of(&triangles, without_textures(lambert(0.8)));
    let mut light = quad_light(DVec3::Y * 2.0);
    light.shape.vertices_mut().iter_mut().for_each(|vertex| *vertex = place(*vertex));
    let bounds = [DVec3::splat(-scale), DVec3::splat(scale)].into_iter().collect();
    let camera = Camera::framing("", bounds, turn * corner(-0.2, -1.4, -1.0), turn * DVec3::Y, 4.0 / 3.0);
    let origin = if from_camera { camera.position } else { DVec3::ZERO };
    let buffers = SceneBuffers::new(&scene, origin).unwrap();
    let constants = buffers.constants(&camera, SIZE, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &buffers, &[light], constants, SIZE).unwrap();
    if let Method::Reference = method {
        let reference =
            Reference { samples: 16, seed: 1, shadows: true, coupled: false, ..Reference::default() };
        renderer.reference(reference, |_| {}).unwrap();
    } else {
        let surfaces = Effects::DIFFUSE;
        let options = ShadeOptions { surfaces, shadow_rays: 4, ..ShadeOptions::default() };
        let filter = if let Method::Rays(filter) = method { filter } else { ShadowFilter::Off };
        let view = renderer.shadowed(&buffers, options, (filter, ShadowHistory::Off)).unwrap();
        renderer.shade_shadowed(&view, 1).unwrap();
        if let Method::Unshadowed = method {
            return view.unshadowed().unwrap().into_iter().map(|pixel| pixel.x.into()).collect();
        }
    }
    renderer.radiance().unwrap().into_iter().map(|pixel| pixel.x.into()).collect()
}

/// The root mean square of the difference, over the mean.
fn apart(picture: &[f64], other: &[f64]) -> f64 {
    let square: f64 = picture.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum();
    (square / other.len() as f64).sqrt() / (other.iter().sum::<f64>() / other.len() as f64)
}

#[test]
fn a_scene_of_any_size_has_the_same_shadows() {
    let Some(engine) = TestEngine::new() else { return };
    for from_camera in [true, false] {
        for method in [Method::Rays(ShadowFilter::Off), Method::Rays(ShadowFilter::Gather), Method::Reference]
        {
            let metres = picture(&engine, 1.0, from_camera, method);
            for scale in [1e-6, 1e-3, 1e4] {
                // Rounding makes 7e-7; a ray that grazes an edge and passes on its other side .003, as one of
                // four of a pixel's in the root of 6,912 pixels, and of ten of them is room
                let found = apart(&picture(&engine, scale, from_camera, method), &metres);
                println!("scale {scale}, from the camera {from_camera}: {found:.2e} apart");
                assert!(found < 0.01, "scale {scale}, from the camera {from_camera}: {found}");
            }
            // The twin: without shadows
            assert!(apart(&picture(&engine, 1.0, from_camera, Method::Unshadowed), &metres) > 0.1);
        }
    }
}
