//! The Monte Carlo reference with shadows, against the oracle's exact visibility.

use arealight_oracle::cubature::Settings;
use arealight_oracle::shading::truth;
use arealight_oracle::visibility::visible_parts;
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [32, 24];

type Triangle = [DVec3; 3];

/// A floor at a height.
fn floor(height: f64) -> Vec<Triangle> {
    square(height, 3.0).to_vec()
}

/// A box above the floor.
fn blocker() -> Vec<Triangle> {
    box_of(DVec3::new(-0.5, 0.4, -0.4), DVec3::new(0.4, 0.7, 0.3))
}

fn light(shape: LightShape) -> Light {
    Light { radiance: Vec3::splat(5.0), shape, ..Light::default() }
}

/// A quad at a height.
fn quad(height: f64) -> Light {
    quad_light(DVec3::Y * height)
}

/// A metal of low roughness: what the BRDF's samples are for.
fn glossy() -> Material {
    Material { metalness: 1.0, roughness: 0.3, ..lambert(0.8) }
}

/// What a camera above sees of a scene.
struct View {
    scene: Scene,
    camera: Camera,
    buffers: SceneBuffers,
}

/// A pixel of a picture.
struct Pixel {
    position: DVec3,
    normal: DVec3,
    radiance: f64,
}

impl View {
    fn new(triangles: &[Triangle], material: Material) -> Self {
        let scene = scene_of(triangles, without_textures(material));
        let bounds = floor(0.0).into_iter().flatten().collect();
        let camera = Camera::framing("", bounds, DVec3::new(-0.2, -1.0, -0.7), DVec3::Y, 4.0 / 3.0);
        let buffers = SceneBuffers::new(&scene, camera.position).expect("it fits");
        Self { scene, camera, buffers }
    }

    fn reference(&self, engine: &TestEngine, lights: &[Light], samples: u32, shadows: bool) -> Vec<Pixel> {
        let constants = self.buffers.constants(&self.camera, SIZE, Vec3::ZERO);
        let renderer = SceneRenderer::new(engine, &self.buffers, lights, constants, SIZE);
        let mut renderer = renderer.expect("it fits");
        let reference = Reference { samples, seed: 5, shadows, coupled: false, ..Reference::default() };
        renderer.reference(reference, |_| {}).expect("it samples");
        let radiance = renderer.radiance().expect("a picture");
        let download =
            |image: &Image| -> Vec<[f32; 4]> { image.download(Usage::COMPUTE_READ).expect("a picture") };
        let (positions, normals) =
            (download(&renderer.g_buffer()[Plane::Position]), download(&renderer.g_buffer()[Plane::Normal]));
        let vector = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
        let pixels =
            positions.into_iter().zip(normals).zip(radiance).filter(|((place, _), _)| place[3] > 0.0);
        pixels
            .map(|((place, normal), radiance)| Pixel {
                position: vector(place) + self.buffers.origin,
                normal: vector(normal),
                radiance: radiance.x.into(),
            })
            .collect()
    }

    /// The radiance of a pixel under a quad behind triangles.
    fn exact(&self, pixel: &Pixel, quad: &Light, blockers: &[Triangle]) -> f64 {
        let LightShape::Polygon(vertices) = &quad.shape else { panic!("a quad") };
        let relative: Vec<_> = vertices.iter().map(|vertex| *vertex - pixel.position).collect();
        let blockers: Vec<_> = blockers.iter().map(|t| t.map(|vertex| vertex - pixel.position)).collect();
        let settings = Settings { relative_tolerance: 1e-3, ..Settings::default() };
        let surface = self.scene.materials[0].material.surface();
        let lit = |part: Vec<DVec3>| {
            let light = Light { shape: LightShape::Polygon(part), ..quad.clone() };
            let light = RelativeLight::new(&light, DVec3::ZERO);
            truth(&surface, pixel.normal, self.camera.position - pixel.position, &light, &settings).radiance.x
        };
        visible_parts(&relative, &blockers).into_iter().map(lit).sum()
    }
}

/// The root mean square of the differences, and their mean, over the mean of what is right.
fn errors(pixels: &[(f64, f64)]) -> (f64, f64) {
    let count = pixels.len() as f64;
    let mean = pixels.iter().map(|(_, right)| right).sum::<f64>() / count;
    let square = pixels.iter().map(|(found, right)| (found - right).powi(2)).sum::<f64>() / count;
    let bias = pixels.iter().map(|(found, right)| found - right).sum::<f64>() / count;
    (square.sqrt() / mean, bias / mean)
}

#[test]
fn it_is_the_light_of_the_visible_parts() {
    let Some(engine) = TestEngine::new() else { return };
    let (quad, blocker) = (quad(2.0), blocker());
    let triangles = [floor(0.0), blocker.clone()].concat();
    // Half as much again as the noise of so many samples, .022 and .057; over all pixels it averages out to
    // .002
    for (material, noise) in [(lambert(0.8), 0.03), (glossy(), 0.08)] {
        let view = View::new(&triangles, material);
        let compare = |shadows: bool| -> Vec<(f64, f64)> {
            let pixels = view.reference(&engine, std::slice::from_ref(&quad), 512, shadows);
            // Of the floor, from the middle of the light's shadow outwards
            let near = pixels.iter().filter(|pixel| pixel.position.y < 0.1 && pixel.position.length() < 1.8);
            near.map(|pixel| (pixel.radiance, view.exact(pixel, &quad, &blocker))).collect()
        };
        let compared = compare(true);
        let partly = compared.iter().filter(|(_, right)| *right > 0.0).count();
        assert!(compared.len() > 60 && partly > 30, "{} pixels, {partly} lit", compared.len());
        let (error, bias) = errors(&compared);
        println!("rms {error:.4}, bias {bias:.4}");
        assert!(error < noise && bias.abs() < noise / 4.0, "rms {error}, bias {bias}");
        // The twin: light that passes through the box
        let (error, bias) = errors(&compare(false));
        assert!(error > 0.2 && bias > 0.05, "rms {error}, bias {bias}");
    }
}

#[test]
fn a_surface_does_not_block_its_own_light() {
    let Some(engine) = TestEngine::new() else { return };
    // Whole pictures, alike to the bit where nothing but the floor is there; also far from the origin, and
    // near zero
    for height in [0.0, 0.04, -1.0, 1000.0] {
        let floor = floor(height);
        for origin in [None, Some(DVec3::ZERO)] {
            let mut view = View::new(&floor, lambert(0.8));
            view.camera.position.y += height;
            view.buffers = SceneBuffers::new(&view.scene, origin.unwrap_or(view.camera.position)).unwrap();
            let lights = [quad(height + 2.0)];
            let radiance = |shadows| -> Vec<f64> {
                view.reference(&engine, &lights, 8, shadows).iter().map(|pixel| pixel.radiance).collect()
            };
            let (free, shadowed) = (radiance(false), radiance(true));
            assert!(free.len() > 200 && free.iter().all(|radiance| *radiance > 0.0), "height {height}");
            let apart = free.iter().zip(&shadowed).filter(|(a, b)| a != b).count();
            assert_eq!(apart, 0, "of {} pixels at height {height}", free.len());
        }
    }
}

/// A light of each other kind, about a point.
fn kinds(center: DVec3) -> Vec<Light> {
    let face = |x: f64| {
        vec![center + DVec3::X * x, center + DVec3::new(x, 0.1, 0.3), center + DVec3::new(x, 0.2, -0.3)]
    };
    let mut mesh = LightShape::default();
    mesh.add_face(&face(-0.2));
    mesh.add_face(&face(0.2));
    let half = DVec3::X * 0.3;
    let tube = |ends| LightShape::Tube { p0: center - half, p1: center + half, radius: 0.1, ends };
    let disk = LightShape::Disk { center, axis_u: DVec3::X * 0.4, axis_v: DVec3::Z * 0.3 };
    let shapes = [mesh, disk, LightShape::Sphere { center, radius: 0.3 }];
    let lights = shapes.into_iter().chain([TubeEnds::Open, TubeEnds::Flat, TubeEnds::Round].map(tube));
    lights
        .map(|shape| Light { two_sided: !matches!(shape, LightShape::Tube { .. }), ..light(shape) })
        .collect()
}

#[test]
fn every_kind_of_light_is_blocked_before_it_and_not_behind() {
    let Some(engine) = TestEngine::new() else { return };
    let center = DVec3::Y * 1.5;
    let shell = box_of(center - 0.6, center + 0.6);
    let lid: Vec<Triangle> = box_of(center + DVec3::new(-0.6, 0.6, -0.6), center + 0.7);
    for material in [lambert(0.8), glossy()] {
        let [alone, enclosed, covered] = [vec![], shell.clone(), lid.clone()]
            .map(|more| View::new(&[floor(0.0), more].concat(), material));
        for light in kinds(center) {
            // Of the floor
            let sum = |view: &View, shadows| -> f64 {
                let pixels = view.reference(&engine, std::slice::from_ref(&light), 8, shadows);
                pixels.iter().filter(|pixel| pixel.position.y < 0.1).map(|pixel| pixel.radiance).sum()
            };
            let name = format!("{:?}", light.shape);
            let free = sum(&alone, false);
            assert!(free > 0.1, "{name}");
            // Each sample of the light and of the BRDF arrives, and the same ones
            assert_eq!(sum(&alone, true), free, "{name}");
            // A lid hides pixels of the floor from the camera
            let under = sum(&covered, false);
            assert!(under > 0.05 && sum(&covered, true) == under, "{name}");
            assert_eq!(sum(&enclosed, true), 0.0, "{name}");
        }
    }
}

/// The sum over the floor that is seen, by the reference or by a ray a pixel.
fn lit(engine: &TestEngine, view: &View, lights: &[Light], traced: bool, shadows: bool) -> f64 {
    if !traced {
        return view.reference(engine, lights, 8, shadows).iter().map(|pixel| pixel.radiance).sum();
    }
    let constants = view.buffers.constants(&view.camera, SIZE, Vec3::ZERO);
    let mut renderer = SceneRenderer::new(engine, &view.buffers, lights, constants, SIZE).unwrap();
    renderer.visibility().unwrap();
    let options = ShadeOptions { shadow_rays: 1, ..ShadeOptions::default() };
    let of = (ShadowFilter::Off, ShadowHistory::Off);
    let shadowed = renderer.shadowed(&view.buffers, options, of).unwrap();
    renderer.shade_shadowed(&shadowed, 0).unwrap();
    let radiance = if shadows { renderer.radiance() } else { shadowed.unshadowed() };
    radiance.unwrap().iter().map(|pixel| f64::from(pixel.x)).sum()
}

#[test]
fn a_lamp_hides_the_light_of_others_and_not_its_own() {
    let Some(engine) = TestEngine::new() else { return };
    let sphere = LightShape::Sphere { center: DVec3::Y * 2.0, radius: 0.3 };
    let ends = [-0.7, 0.7].map(|x| DVec3::new(x, 2.0, 0.0));
    let tube = |ends_are| LightShape::Tube { p0: ends[0], p1: ends[1], radius: 0.2, ends: ends_are };
    // Facets whose corners are so many radii out
    let ball = |radii: f64| box_about(DVec3::splat(0.3 * radii / 3.0_f64.sqrt()));
    let rod =
        |radii: f64| box_about(DVec3::new(0.7, 0.2 * radii / 2.0_f64.sqrt(), 0.2 * radii / 2.0_f64.sqrt()));
    let seen = |lamp: &[Triangle]| {
        let mut view = View::new(&[&floor(0.0), lamp].concat(), lambert(0.8));
        // A quad's back is not seen
        view.scene.materials[0].double_sided = false;
        view.buffers = SceneBuffers::new(&view.scene, view.buffers.origin).unwrap();
        view
    };
    for traced in [false, true] {
        let lit = |view: &View, light: &Light, shadows| {
            lit(&engine, view, std::slice::from_ref(light), traced, shadows)
        };
        for (shape, lamp, large) in [
            (sphere.clone(), ball(1.12), ball(2.2)),
            (tube(TubeEnds::Flat), rod(1.12), rod(2.2)),
            (tube(TubeEnds::Open), rod(1.12), rod(2.2)),
            (tube(TubeEnds::Round), rod(1.12), rod(2.2)),
            (quad(2.0).shape, quad_faces(2.0), quad_faces(1.99)),
            // So near that a ray's origin is higher than its end is before the light
            (quad(0.05).shape, quad_faces(0.05), quad_faces(0.04)),
        ] {
            let (own, other) = (light(shape), quad(3.0));
            let view = seen(&lamp);
            let name = format!("{:?}, traced: {traced}", own.shape);
            assert_eq!(lit(&view, &own, true), lit(&view, &own, false), "{name}");
            let [part, all] = [true, false].map(|shadows| lit(&view, &other, shadows));
            assert!(part < 0.97 * all, "{name}: {part} of {all}");
            // The twin: faces that are farther out
            let view = seen(&large);
            let [part, all] = [true, false].map(|shadows| lit(&view, &own, shadows));
            assert!(part < 0.6 * all, "{name}: {part} of {all}");
        }
    }
}

/// A box about the place of the lamp.
fn box_about(half: DVec3) -> Vec<Triangle> {
    box_of(DVec3::Y * 2.0 - half, DVec3::Y * 2.0 + half)
}

/// The faces of a quad.
fn quad_faces(height: f64) -> Vec<Triangle> {
    let LightShape::Polygon(corners) = quad(height).shape else { panic!("a quad") };
    vec![[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
}
