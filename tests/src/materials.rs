//! What the tests of materials share: shading points, and comparisons with the float64 twins.

use crate::one_pixel::{LAYOUTS, OnePixel, under_lamp};
use crate::{Comparison, Random, TestEngine, point};
use arealight::plan::GBufferLayout;
use arealight::{
    Effects, Horizon, Light, LightShape, LightTable, Lobes, Plane, Quality, SpecularLobes, TubeEnds,
};
use arealight_engine::EvalPoint;
use arealight_oracle::material::Surface;
use arealight_oracle::shading::{RelativeLight, ltc_on, shape_ltc_on};
use arealight_vk::ash::vk::Format;
use glam::{DVec3, Vec3, Vec4};
use std::sync::LazyLock;

/// The built-in table.
pub static TABLE: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

/// The ways to a surface's lobes: both horizons, two lobes, half vectors, formulas.
pub fn lobe_qualities() -> [Quality; 5] {
    let quality = Quality::default();
    [
        quality,
        Quality { horizon: Horizon::Both, ..quality },
        Quality { specular_lobes: SpecularLobes::Two, ..quality },
        Quality { specular_lobes: SpecularLobes::HalfVectors, ..quality },
        Quality { lobes: Lobes::Formula, ..quality },
    ]
}

/// A point under a polygon of 3 to 8 vertices anywhere, above, across or below its horizon; every third has
/// two sides.
pub fn under_polygon(random: &mut Random, index: usize, surface: Surface, view: DVec3) -> EvalPoint {
    let center = random.direction();
    let size = random.between(0.1, 1.5);
    let vertices = random.polygon(center, 3 + index % 6, size * 0.3, size);
    point(surface, view, vertices, index.is_multiple_of(3))
}

/// Points under polygons anywhere of surfaces that a function draws, each seen at a cosine from `least` on.
pub fn points_of(
    seed: u64,
    count: usize,
    least: f64,
    mut surface: impl FnMut(&mut Random, usize) -> Surface,
) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let one = |index| {
        let surface = surface(&mut random, index);
        let cos_view = random.between(least, 1.0);
        let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
        under_polygon(&mut random, index, surface, view)
    };
    (0..count).map(one).collect()
}

/// The same points under `shape_lights`.
pub fn under_shapes(seed: u64, points: impl IntoIterator<Item = EvalPoint>) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let under =
        |point: EvalPoint| shape_lights(&mut random).map(|light| EvalPoint { light, ..point.clone() });
    points.into_iter().flat_map(under).collect()
}

/// The points with their surfaces changed.
pub fn changed(points: &[EvalPoint], change: impl Fn(&Surface) -> Surface) -> Vec<EvalPoint> {
    points.iter().map(|point| EvalPoint { surface: change(&point.surface), ..point.clone() }).collect()
}

/// A disk, a sphere and a tube about as large as they are far.
fn shape_lights(random: &mut Random) -> [Light; 3] {
    let center = random.direction() * 2.0;
    let (axis_u, axis_v) = center.normalize_or(DVec3::Z).any_orthonormal_pair();
    let light = |shape| Light { shape, radiance: Vec3::ONE, two_sided: true, ..Light::default() };
    let ends = TubeEnds::Round;
    [
        light(LightShape::Disk { center, axis_u: axis_u * 0.7, axis_v }),
        light(LightShape::Sphere { center, radius: 0.6 }),
        light(LightShape::Tube { p0: center - axis_u, p1: center + axis_u, radius: 0.2, ends }),
    ]
}

/// The inside of a box about the point.
fn box_faces() -> Vec<Vec<DVec3>> {
    let corner = |axis: usize, side: f64, u: f64, v: f64| {
        let mut corner = DVec3::splat(side);
        (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v * side);
        corner
    };
    let face = |axis, side| {
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(u, v)| corner(axis, side, u, v)).to_vec()
    };
    (0..3).flat_map(|axis| [face(axis, 1.0), face(axis, -1.0)]).collect()
}

/// The answer of the fitted lobes in float64 to a point under a polygon.
pub fn polygon_twin(quality: Quality, given: &EvalPoint) -> DVec3 {
    let light = RelativeLight::new(&given.light, given.position);
    ltc_on(quality, &TABLE, &given.surface, given.normal, given.view, &light)
}

/// Three times what the twin changes where a point is moved by 2e-6, some ten roundings of float32: over half
/// vectors an edge's parts are halved or not in steps of about 1e-4 of a lobe, and narrow lobes at grazing
/// views magnify rounding by both. Nothing on other levels.
pub fn step_within_rounding(quality: Quality, given: &EvalPoint) -> f64 {
    if quality.specular_lobes != SpecularLobes::HalfVectors {
        return 0.0;
    }
    let here = polygon_twin(quality, given);
    let distance =
        given.light.shape.vertices().iter().map(|v| v.distance(given.position)).fold(0.0, f64::max);
    let moved = |by: DVec3| {
        let position = given.position + by * (2e-6 * distance);
        let view = (given.view.normalize_or(given.normal) + DVec3::new(by.y, by.z, by.x) * 2e-6)
            * given.view.length();
        (polygon_twin(quality, &EvalPoint { position, view, ..given.clone() }) - here).abs().max_element()
    };
    [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| [moved(axis), moved(-axis)])
        .fold(0.0, |most, change| f64::max(most, 3.0 * change))
}

impl TestEngine {
    /// Answers to points under polygons beside their float64 twins.
    pub fn beside_polygon_twin(
        &self,
        what: impl Into<String>,
        quality: Quality,
        points: &[EvalPoint],
        bound: impl Fn(&EvalPoint) -> f64,
    ) -> Comparison {
        let answers = self.eval(points, quality).unwrap();
        assert_eq!(answers.len(), points.len());
        let mut comparison = Comparison::new(what);
        for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
            let place = || format!("point {index}: {given:?}");
            comparison.add_color(*answer, polygon_twin(quality, given), bound(given), place);
        }
        comparison
    }

    /// Compares points under polygons with their float64 twins. The twin's twin: of more than a tenth of them
    /// it notices a `change` of the surface.
    pub fn assert_follows_polygon_twin(
        &self,
        what: &str,
        quality: Quality,
        points: &[EvalPoint],
        bound: impl Fn(&EvalPoint) -> f64,
        change: impl Fn(&Surface) -> Surface,
    ) {
        let answers = self.eval(points, quality).unwrap();
        let mut comparison = Comparison::new(format!("{what}, {quality:?}"));
        let mut noticed = 0;
        for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
            let expected = polygon_twin(quality, given);
            let bound = bound(given) + step_within_rounding(quality, given);
            comparison.add_color(*answer, expected, bound, || format!("point {index}: {given:?}"));
            let other = EvalPoint { surface: change(&given.surface), ..given.clone() };
            let difference = polygon_twin(quality, &other) - answer.as_dvec3();
            noticed += usize::from(difference.abs().max_element() > bound);
        }
        comparison.assert_all();
        assert!(noticed > points.len() / 10, "{what}, {quality:?}: {noticed} points notice another surface");
    }

    /// Compares points under disks, spheres and tubes with their float64 twins.
    pub fn assert_follows_shape_twin(
        &self,
        what: &str,
        points: &[EvalPoint],
        bound: impl Fn(&EvalPoint) -> f64,
    ) {
        let quality = Quality::default();
        let answers = self.eval(points, quality).unwrap();
        let mut comparison = Comparison::new(what);
        for (index, (given, answer)) in points.iter().zip(&answers).enumerate() {
            let EvalPoint { surface, normal, view, light, .. } = given;
            let expected = shape_ltc_on(quality, &TABLE, surface, *normal, *view, light).unwrap();
            comparison.add_color(*answer, expected, bound(given), || format!("point {index}: {given:?}"));
        }
        comparison.assert_all();
    }

    /// How far radiance spreads over views on a circle about the normal, whose tangent is `tilt`.
    pub fn spread_about_the_normal(&self, surface: Surface, vertices: &[DVec3], tilt: f64) -> f32 {
        let at = |index: u32| {
            let (sin, cos) = (f64::from(index) * 0.1).sin_cos();
            point(surface, DVec3::new(cos * tilt, sin * tilt, 1.0), vertices.to_vec(), true)
        };
        let answers = self.eval(&(0..64).map(at).collect::<Vec<_>>(), Quality::default()).unwrap();
        let most = answers.iter().fold(Vec3::MIN, |most, answer| most.max(*answer));
        (most - answers.iter().fold(Vec3::MAX, |least, answer| least.min(*answer))).max_element()
    }

    /// Asserts that surfaces with a layer of no weight are those without, to the bit or [`Self::rounding`].
    /// The twin: most with the layer are not.
    pub fn assert_none_to_the_bit(
        &self,
        qualities: &[Quality],
        [weightless, without, with]: [&[EvalPoint]; 3],
    ) {
        for &quality in qualities {
            let [weightless, without, with] =
                [weightless, without, with].map(|points| self.eval(points, quality).unwrap());
            let brightest = without.iter().fold(0.0, |most: f32, one| most.max(one.max_element()));
            for (one, other) in weightless.iter().zip(&without) {
                assert!(self.is_same(*one, *other, brightest), "{quality:?}: {one} and {other}");
            }
            let same = with.iter().zip(&without).filter(|(with, without)| with == without).count();
            assert!(same < with.len() / 2, "{quality:?}: {same} points are the same");
        }
    }

    /// Asserts that every layout reads a plane where an effect needs it: texels that mean none change
    /// nothing, and others do. In our own layout it shows what the surface at [`under_lamp`] does, within
    /// `bound`.
    pub fn assert_plane(
        &self,
        (plane, effects): (Plane, Effects),
        nones: &[[f32; 4]],
        texels: &[[f32; 4]],
        (surface, bound): (Surface, f32),
    ) {
        let shade = |layout, effects, texel: [f32; 4]| {
            let mut pixel = OnePixel::new(self, Vec4::W, 1.0);
            pixel.set(plane, Format::R32G32B32A32_SFLOAT, texel);
            pixel.shade_under_lamp(layout, effects)
        };
        for layout in LAYOUTS {
            let without = shade(layout, Effects::empty(), texels[0]);
            for none in nones {
                let found = shade(layout, effects, *none);
                assert!(
                    self.is_same(found, without, without.max_element()),
                    "{plane:?}, {layout:?}: {none:?} is none"
                );
            }
            for texel in texels {
                assert_ne!(shade(layout, effects, *texel), without, "{plane:?}, {layout:?}: {texel:?}");
            }
        }
        let expected = self.eval(&[under_lamp(surface)], Quality::default()).unwrap()[0];
        let found = shade(GBufferLayout::Arealight, effects, texels[0]);
        assert!((found - expected).abs().max_element() < bound, "{plane:?}: {found} and {expected}");
    }

    /// Whether answers are the same: to the bit, or where other code may round in another way to that. NaN is
    /// near to nothing.
    fn is_same(&self, one: Vec3, other: Vec3, brightest: f32) -> bool {
        let bits = |answer: Vec3| answer.to_array().map(f32::to_bits);
        let bound = self.rounding() * brightest;
        bits(one) == bits(other) || bound > 0.0 && (one - other).abs().cmple(Vec3::splat(bound)).all()
    }

    /// What surfaces send of white light from everywhere, in the first channel. It is no more than they get.
    pub fn light_from_everywhere(&self, surfaces: &[(Surface, DVec3)], quality: Quality) -> Vec<f32> {
        let faces = box_faces();
        let under = |&(surface, view): &(Surface, DVec3)| {
            faces.iter().map(move |face| point(surface, view, face.clone(), false))
        };
        let points: Vec<EvalPoint> = surfaces.iter().flat_map(under).collect();
        let answers = self.eval(&points, quality).unwrap();
        assert!(answers.iter().all(|answer| answer.is_finite()), "{quality:?}");
        let sums: Vec<f32> =
            answers.chunks_exact(faces.len()).map(|faces| faces.iter().map(|face| face.x).sum()).collect();
        assert_eq!(sums.len(), surfaces.len());
        for (sum, given) in sums.iter().zip(surfaces) {
            // Six faces and a lobe of each, 1e-6 every one; and the lobe's gain. Over half vectors the chords
            // of six faces
            let chords = if quality.specular_lobes == SpecularLobes::HalfVectors { 1e-2 } else { 0.0 };
            assert!((0.0..=1.0 + 2e-5 + chords).contains(sum), "{quality:?}: {sum} of {given:?}");
        }
        sums
    }
}
