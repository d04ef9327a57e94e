//! Lights far larger than their distance, and lights in the plane of the point: which side of its plane a
//! point is on is told by the plane in the world, not by vertices, whose heights drown in their lengths.

use arealight_benches::pictures;
use arealight_oracle::stream::Stream;
use arealight_tests::prelude::*;

const CASES: u64 = 120;

/// Which plane coordinate is the light's height, and where its front is.
#[derive(Clone, Copy)]
struct Axes {
    up: usize,
    sign: f64,
}

impl Axes {
    fn random(stream: &mut Stream) -> Self {
        Self { up: stream.below(3), sign: if stream.below(2) == 0 { 1.0 } else { -1.0 } }
    }

    /// A position at a place over the point, `height` to the light's front.
    fn at(self, place: DVec2, height: f64) -> DVec3 {
        let mut position = DVec3::ZERO;
        position[self.up] = height * self.sign;
        position[(self.up + 1) % 3] = f64::from(place.x as f32);
        position[(self.up + 2) % 3] = f64::from(place.y as f32);
        position
    }
}

/// A convex light of 3 to 8 vertices about the point, which shines down on it from `height`; float32 holds
/// every coordinate.
fn ceiling(stream: &mut Stream, axes: Axes, size: f64, height: f64) -> Light {
    let count = 3 + stream.below(6);
    // The point stays a tenth of the light's size from its edges
    let center = DVec2::from(stream.circle()) * 0.3 * size * stream.unit();
    let turn = stream.unit();
    let corner = |index: usize| {
        let angle = TAU * (index as f64 + turn) / count as f64;
        // Counter-clockwise from below is clockwise from above
        let way = DVec2::new(angle.cos(), -angle.sin() * axes.sign);
        axes.at(center + way * size, height)
    };
    let outline = (0..count).map(corner).collect();
    Light { radiance: Vec3::ONE, shape: LightShape::Polygon(outline), ..Light::default() }
}

/// A direction at most some 78 degrees from the light's height.
fn tilted(stream: &mut Stream, axes: Axes) -> DVec3 {
    loop {
        let normal = stream.direction();
        if normal[axes.up] * axes.sign > 0.2 {
            return normal;
        }
    }
}

/// The diffuse lobe alone, and a rough metal's alone.
fn surfaces(stream: &mut Stream) -> [Surface; 2] {
    let metal = Surface { f0: DVec3::ONE, f90: 1.0, alpha: stream.power(-2.0, 0.0), ..Surface::default() };
    [Surface { diffuse_albedo: DVec3::ONE, ..Surface::default() }, metal]
}

/// Points under ceilings 10 to 1e7 times as large as high, from their fronts and from two-sided ones' backs.
fn points(is_tilted: bool) -> Vec<EvalPoint> {
    let mut points = vec![];
    for index in 0..CASES {
        let stream = &mut Stream::new(if is_tilted { "tilted" } else { "parallel" }, index, 1);
        let axes = Axes::random(stream);
        let height = f64::from(stream.power(-10.0, 1.0) as f32);
        let size = height * stream.power(3.3, 23.3);
        let mut light = ceiling(stream, axes, size, height);
        if stream.one_in(2) {
            light.shape.vertices_mut().reverse();
            light.two_sided = true;
        }
        let normal = if is_tilted { tilted(stream, axes) } else { axes.at(DVec2::ZERO, 1.0) };
        let view = view(stream, normal);
        let point =
            |surface| EvalPoint { surface, position: DVec3::ZERO, normal, view, light: light.clone() };
        points.extend(surfaces(stream).map(point));
    }
    points
}

/// A direction over a surface.
fn view(stream: &mut Stream, normal: DVec3) -> DVec3 {
    loop {
        let view = stream.direction();
        if view.dot(normal) > 0.05 {
            return view;
        }
    }
}

/// The edges' own rounding, as of lights of ordinary size; of the metal's lobe its alpha of at least 1/4
/// makes four times that.
fn bound(point: &EvalPoint) -> f64 {
    if point.surface.diffuse_albedo == DVec3::ZERO { 2e-6 } else { 1e-6 }
}

#[test]
fn ceilings_of_any_size_stay_lit() {
    let Some(engine) = TestEngine::new() else { return };
    for is_tilted in [false, true] {
        let quality = Quality::default();
        let points = points(is_tilted);
        let what = format!("tilted: {is_tilted}");
        engine.beside_polygon_twin(what, quality, &points, bound).assert_all();
        let bright = points.iter().filter(|point| polygon_twin(quality, point).x > 0.3).count();
        assert!(bright > points.len() / 2, "{bright} are lit");
    }
}

#[test]
fn with_both_horizons_too_where_the_surface_is_parallel() {
    let Some(engine) = TestEngine::new() else { return };
    let quality = Quality { horizon: Horizon::Both, ..Quality::default() };
    engine.assert_follows_polygon_twin("parallel", quality, &points(false), bound, |surface| {
        // The twin: another roughness, and another albedo
        let diffuse_albedo = 0.9 * surface.diffuse_albedo;
        Surface { alpha: 0.9 * surface.alpha, f0: 0.9 * surface.f0, diffuse_albedo, ..*surface }
    });
}

#[test]
fn a_light_is_lit_from_just_above_its_plane_and_not_in_it() {
    let Some(engine) = TestEngine::new() else { return };
    let axes = Axes { up: 2, sign: 1.0 };
    let mut stream = Stream::new("sweep", 0, 1);
    let [diffuse, _] = surfaces(&mut stream);
    let heights =
        [-1.0, -1e-3, -1e-20, 0.0, 1e-30, 1e-20, 1e-10, 1e-3, 1.0].map(|height| f64::from(height as f32));
    let points = heights.map(|height| {
        let light = ceiling(&mut Stream::new("sweep", 1, 1), axes, 1e7, height);
        EvalPoint { surface: diffuse, position: DVec3::ZERO, normal: DVec3::Z, view: DVec3::Z, light }
    });
    let answers = engine.eval(&points, Quality::default()).unwrap();
    for (height, answer) in heights.into_iter().zip(answers) {
        let expected = if height > 0.0 { 1.0 } else { 0.0 };
        // All of a hemisphere but the light's edge
        assert!((answer.x - expected).abs() < 1e-6, "at {height:e}: {answer}");
    }
}

/// Lights of ordinary size whose planes go through the point: `beside` times their radius away.
fn in_plane(beside: f64) -> Vec<EvalPoint> {
    let one = |index| {
        let stream = &mut Stream::new("plane", index, 1);
        let (u, v) = stream.direction().any_orthonormal_pair();
        let count = 3 + stream.below(6);
        let corner = |index: usize| {
            let angle = TAU * index as f64 / count as f64;
            (angle.cos() + beside) * u + angle.sin() * v
        };
        let shape = LightShape::Polygon((0..count).map(corner).collect());
        let light = Light { radiance: Vec3::ONE, shape, two_sided: stream.one_in(2), ..Light::default() };
        let normal = stream.direction();
        let surface = surfaces(stream)[stream.below(2)];
        EvalPoint { surface, position: DVec3::ZERO, normal, view: view(stream, normal), light }
    };
    (0..4 * CASES).map(one).collect()
}

#[test]
fn a_light_in_the_plane_of_its_point_sends_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    for beside in [0.2, 1.5, 30.0] {
        let answers = engine.eval(&in_plane(beside), Quality::default()).unwrap();
        let lit = answers.iter().filter(|answer| **answer != Vec3::ZERO).count();
        assert_eq!(lit, 0, "{beside} radii away");
    }
    // The twin: a millionth of their size before them
    let before = in_plane(0.2).into_iter().map(|point| {
        let LightShape::Polygon(outline) = &point.light.shape else { unreachable!("a polygon") };
        let normal = (outline[1] - outline[0]).cross(outline[2] - outline[0]).normalize_or_zero();
        EvalPoint { position: 1e-6 * normal, ..point }
    });
    let before: Vec<_> = before.collect();
    let answers = engine.eval(&before, Quality::default()).unwrap();
    assert!(answers.iter().filter(|answer| answer.x > 0.1).count() > before.len() / 4, "the twin");
}

/// A sheet of light of each kind in the plane of two axes, seen from both sides.
fn sheets(u: DVec3, v: DVec3) -> Vec<Light> {
    let outline =
        |corners: &[[f64; 2]]| -> Vec<DVec3> { corners.iter().map(|[x, y]| u * *x + v * *y).collect() };
    let square = outline(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
    let mut mesh = Light::default().shape;
    mesh.add_face(&outline(&[[-1.0, -1.0], [0.0, -1.0], [0.0, 1.0], [-1.0, 1.0]]));
    mesh.add_face(&outline(&[[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]]));
    let notched = outline(&[[-1.0, -1.0], [0.0, -0.5], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
    let disk = LightShape::Disk { center: DVec3::ZERO, axis_u: u, axis_v: v };
    let shapes = [LightShape::Polygon(square.clone()), LightShape::Polygon(notched), mesh, disk];
    let light = |shape| Light { radiance: Vec3::ONE, two_sided: true, shape, ..Light::default() };
    let uvs = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let textured =
        Light { texture: Some(LightTexture { layer: 0, uvs }), ..light(LightShape::Polygon(square)) };
    shapes.into_iter().map(light).chain([textured]).collect()
}

/// How many pixels of a scene a light lights, by the shade pass and by the reference.
fn lit_pixels(engine: &TestEngine, scene: &Scene, camera: &Camera, light: &Light) -> [usize; 2] {
    const SIZE: [u32; 2] = [48, 32];
    [false, true].map(|sampled| {
        with_view(engine, scene, std::slice::from_ref(light), (camera, SIZE), |renderer, _| {
            if sampled {
                let reference = Reference { samples: 2, coupled: false, ..Reference::default() };
                renderer.reference(reference, |_| {}).expect("a reference");
            } else {
                renderer.shade(Effects::DIFFUSE, Quality::default()).expect("a frame");
            }
            let texels = renderer.radiance().expect("a picture");
            texels.iter().filter(|texel| texel.truncate() != Vec3::ZERO).count()
        })
    })
}

#[test]
fn a_two_sided_light_does_not_light_itself() {
    let Some(mut engine) = TestEngine::new() else { return };
    pictures::load(&mut engine, &[Arc::new(Texture::gradient(8, 8))], |_| TexturePart::default())
        .expect("a picture");
    let normal = DVec3::new(0.3, -0.5, 0.8).normalize_or_zero();
    let (u, v) = normal.any_orthonormal_pair();
    // What the camera sees is the light's own sheet; the twin: that is a ten thousandth of its size behind
    let scene = |behind: f64| {
        let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| u * x + v * y + behind * normal);
        scene_of(&[[a, b, c], [a, c, d]], without_textures(lambert(0.8)))
    };
    let own = scene(0.0);
    let framing = own.framing_camera(1.5);
    let twin = scene(1e-4 * framing.forward.dot(normal).signum());
    for (light, distance) in
        sheets(u, v).iter().flat_map(|light| [3.5, 10.0, 40.0].map(|distance| (light, distance)))
    {
        let position = -distance * framing.forward;
        let camera = Camera { position, half_height: 1.0 / distance, ..framing.clone() };
        let [shaded, sampled] = lit_pixels(&engine, &own, &camera, light);
        assert_eq!([shaded, sampled], [0, 0], "from {distance}: {light:?}");
        let [shaded, sampled] = lit_pixels(&engine, &twin, &camera, light);
        assert!(shaded > 300 && sampled > 300, "from {distance}: {shaded}, {sampled}: {light:?}");
    }
}
