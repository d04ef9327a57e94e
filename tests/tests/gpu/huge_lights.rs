//! Lights far larger than their distance, and lights in the plane of the point: which side of its plane a
//! point is on is told by the plane in the world, not by vertices, whose heights drown in their lengths.

use arealight::{FormFactor, Horizon, Light, LightShape, Quality};
use arealight_engine::EvalPoint;
use arealight_oracle::material::Surface;
use arealight_oracle::stream::Stream;
use arealight_tests::Comparison;
use arealight_tests::TestEngine;
use arealight_tests::materials::polygon_twin;
use glam::{DVec2, DVec3, Vec3};

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
        let angle = std::f64::consts::TAU * (index as f64 + turn) / count as f64;
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

const FORM_FACTORS: [FormFactor; 2] = [FormFactor::Exact, FormFactor::Difference];

#[test]
fn ceilings_of_any_size_stay_lit() {
    let Some(engine) = TestEngine::new() else { return };
    for (is_tilted, form_factor) in
        [false, true].into_iter().flat_map(|tilt| FORM_FACTORS.map(|how| (tilt, how)))
    {
        let quality = Quality { form_factor, ..Quality::default() };
        let points = points(is_tilted);
        let answers = engine.eval(&points, quality).unwrap();
        let mut comparison = Comparison::new(format!("tilted: {is_tilted}, {form_factor:?}"));
        let mut bright = 0;
        for (index, (point, answer)) in points.iter().zip(&answers).enumerate() {
            let expected = polygon_twin(quality, point);
            bright += usize::from(expected.x > 0.3);
            comparison.add_color(*answer, expected, bound(point), || format!("point {index}: {point:?}"));
        }
        comparison.assert_all();
        assert!(bright > points.len() / 2, "{bright} are lit");
    }
}

#[test]
fn with_both_horizons_too_where_the_surface_is_parallel() {
    let Some(engine) = TestEngine::new() else { return };
    for form_factor in FORM_FACTORS {
        let quality = Quality { form_factor, horizon: Horizon::Both, ..Quality::default() };
        engine.assert_follows_polygon_twin("parallel", quality, &points(false), bound, |surface| {
            // The twin: another roughness, and another albedo
            let diffuse_albedo = 0.9 * surface.diffuse_albedo;
            Surface { alpha: 0.9 * surface.alpha, f0: 0.9 * surface.f0, diffuse_albedo, ..*surface }
        });
    }
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
    for form_factor in FORM_FACTORS {
        let answers = engine.eval(&points, Quality { form_factor, ..Quality::default() }).unwrap();
        for (height, answer) in heights.into_iter().zip(answers) {
            let expected = if height > 0.0 { 1.0 } else { 0.0 };
            // All of a hemisphere but the light's edge
            assert!((answer.x - expected).abs() < 1e-6, "{form_factor:?} at {height:e}: {answer}");
        }
    }
}

/// Lights of ordinary size whose planes go through the point: `beside` times their radius away.
fn in_plane(beside: f64) -> Vec<EvalPoint> {
    let one = |index| {
        let stream = &mut Stream::new("plane", index, 1);
        let (u, v) = stream.direction().any_orthonormal_pair();
        let count = 3 + stream.below(6);
        let corner = |index: usize| {
            let angle = std::f64::consts::TAU * index as f64 / count as f64;
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
    for (beside, form_factor) in [0.2, 1.5, 30.0].into_iter().flat_map(|at| FORM_FACTORS.map(|how| (at, how)))
    {
        let points = in_plane(beside);
        let quality = Quality { form_factor, ..Quality::default() };
        let answers = engine.eval(&points, quality).unwrap();
        let lit = answers.iter().filter(|answer| **answer != Vec3::ZERO).count();
        assert_eq!(lit, 0, "{form_factor:?}, {beside} radii away");
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
