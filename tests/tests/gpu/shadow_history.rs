//! Shadows over frames: a still picture loses its noise, a moved camera finds its pixels again, and what
//! changes is not dragged along.

use arealight::plan::{ShadowFilter, ShadowHistory};
use arealight_engine::ShadowedView;
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [96, 72];

fn scene() -> Scene {
    let block = box_of(DVec3::new(-0.5, 0.5, -0.4), DVec3::new(0.4, 0.8, 0.3));
    scene_of(&[&square(0.0, 3.0)[..], &block].concat(), without_textures(lambert(0.8)))
}

/// A camera on an orbit, at an angle in degrees.
fn camera(degrees: f64) -> Camera {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let forward = DVec3::new(-sin, -1.4, -cos);
    let bounds = [DVec3::new(-1.5, 0.0, -1.5), DVec3::new(1.5, 0.0, 1.5)].into_iter().collect();
    Camera::framing("", bounds, forward, DVec3::Y, 4.0 / 3.0)
}

/// A scene that is looked at frame by frame.
struct Film<'a> {
    buffers: SceneBuffers,
    renderer: SceneRenderer<'a>,
    view: ShadowedView,
}

impl<'a> Film<'a> {
    fn new(engine: &'a TestEngine, rays: u32, history: ShadowHistory) -> Self {
        let scene = scene();
        let buffers = SceneBuffers::new(&scene, DVec3::ZERO).unwrap();
        let constants = buffers.constants(&camera(0.0), SIZE, Vec3::ZERO);
        let renderer =
            SceneRenderer::new(engine, &buffers, &[quad_light(DVec3::Y * 2.0)], constants, SIZE).unwrap();
        let options = ShadeOptions { shadow_rays: rays, ..ShadeOptions::default() };
        let view = renderer.shadowed(&buffers, options, (ShadowFilter::Off, history)).unwrap();
        Self { buffers, renderer, view }
    }

    /// What arrives at each pixel, in a frame from an angle.
    fn frame(&mut self, degrees: f64, seed: u32) -> Vec<f64> {
        self.renderer.look(self.buffers.constants(&camera(degrees), SIZE, Vec3::ZERO));
        self.renderer.visibility().unwrap();
        self.renderer.shade_shadowed(&self.view, seed).unwrap();
        let unshadowed = self.view.unshadowed().unwrap();
        let radiance = self.renderer.radiance().unwrap();
        radiance.iter().zip(&unshadowed).map(|(a, b)| f64::from(a.y / b.y.max(1e-6))).collect()
    }

    /// The mean of many frames, of a film without history.
    fn truth(&mut self, degrees: f64) -> Vec<f64> {
        const FRAMES: u32 = 64;
        let mut sum = vec![0.0; (SIZE[0] * SIZE[1]) as usize];
        for seed in 0..FRAMES {
            for (sum, part) in sum.iter_mut().zip(self.frame(degrees, 1000 + seed)) {
                *sum += part / f64::from(FRAMES);
            }
        }
        sum
    }
}

fn rms(found: &[f64], truth: &[f64]) -> f64 {
    let squares = found.iter().zip(truth).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / found.len() as f64).sqrt()
}

#[test]
fn a_still_picture_loses_its_noise() {
    let Some(engine) = TestEngine::new() else { return };
    let truth = Film::new(&engine, 4, ShadowHistory::Off).truth(0.0);
    let errors = |history| {
        let mut film = Film::new(&engine, 1, history);
        let errors: Vec<f64> = (0..24).map(|seed| rms(&film.frame(0.0, seed), &truth)).collect();
        (errors[0], errors[23])
    };
    let (first, last) = errors(ShadowHistory::Camera);
    println!("{first:.3} to {last:.3}");
    // A mean of sixteen: a quarter, or less, as rays of frames after one another are spread evenly
    assert!(last < 0.3 * first, "{first} to {last}");
    // The twin: without history it stays
    let (first, last) = errors(ShadowHistory::Off);
    assert!(last > 0.9 * first, "{first} to {last}");
}

#[test]
fn a_moved_camera_finds_its_pixels_again() {
    let Some(engine) = TestEngine::new() else { return };
    let mut film = Film::new(&engine, 1, ShadowHistory::Camera);
    let mut plain = Film::new(&engine, 1, ShadowHistory::Off);
    let degrees = |frame: u32| f64::from(frame);
    for frame in 0..20 {
        film.frame(degrees(frame), frame);
    }
    let truth = Film::new(&engine, 4, ShadowHistory::Off).truth(degrees(20));
    let error = rms(&film.frame(degrees(20), 20), &truth);
    let without = rms(&plain.frame(degrees(20), 20), &truth);
    println!("{error:.3}, without {without:.3}");
    assert!(error < 0.45 * without, "{error}, without {without}");
    // The twin: a jump by a quarter turn is new for most pixels, and none is wrong
    let truth = Film::new(&engine, 4, ShadowHistory::Off).truth(degrees(110));
    let jumped = rms(&film.frame(degrees(110), 21), &truth);
    let without = rms(&plain.frame(degrees(110), 21), &truth);
    println!("after a jump {jumped:.3}, without {without:.3}");
    assert!(jumped < 1.05 * without, "{jumped}, without {without}");
}

#[test]
fn a_shadow_whose_blocker_is_gone_goes() {
    let Some(engine) = TestEngine::new() else { return };
    let mut film = Film::new(&engine, 1, ShadowHistory::Camera);
    let mut before = Vec::new();
    for frame in 0..24 {
        before = film.frame(0.0, frame);
    }
    film.view.set_blockers(&[]).unwrap();
    let hidden = |parts: &[f64]| -> f64 {
        let dark = before.iter().zip(parts).filter(|(before, _)| **before < 0.2);
        let parts: Vec<f64> = dark.map(|(_, part)| 1.0 - part).collect();
        parts.iter().sum::<f64>() / parts.len() as f64
    };
    let ghost: Vec<f64> = (24..28).map(|frame| hidden(&film.frame(0.0, frame))).collect();
    println!("ghost {ghost:.3?}");
    assert!(hidden(&before) > 0.8);
    // A mean of a fixed sixteen frames would leave (15/16)^4 of it, .77
    assert!(ghost[0] < 0.5 && ghost[3] < 0.1, "{ghost:?}");
}

#[test]
fn nothing_is_darker_than_black() {
    let Some(engine) = TestEngine::new() else { return };
    let size = [384, 288];
    // Coloured lamps, in a view that moves: of a channel, means of what is hidden and of all are two
    let scene = Scene::from_bytes(include_bytes!("../../../scenes/demo.glb"), "demo").unwrap();
    let mut camera = scene.camera(None, 4.0 / 3.0).unwrap();
    let buffers = SceneBuffers::new(&scene, camera.position).unwrap();
    let constants = buffers.constants(&camera, size, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(&engine, &buffers, &scene.lights, constants, size).unwrap();
    let options = ShadeOptions { shadow_rays: 1, surfaces: scene.surfaces(), ..ShadeOptions::default() };
    let of = (ShadowFilter::Gather, ShadowHistory::Camera);
    let view = renderer.shadowed(&buffers, options, of).unwrap();
    for frame in 0..4 {
        camera.position.x += 0.0625;
        renderer.look(buffers.constants(&camera, size, Vec3::ZERO));
        renderer.visibility().unwrap();
        let lamps = renderer.radiance().unwrap();
        renderer.shade_shadowed(&view, frame).unwrap();
        let shaded = renderer.radiance().unwrap();
        // Adding to a lamp's radiance rounds
        let least = shaded.iter().zip(lamps).map(|(shaded, lamp)| (*shaded - lamp).truncate().min_element());
        let least = least.fold(0.0, f32::min);
        assert!(least >= 0.0, "{least} in frame {frame}");
    }
}
