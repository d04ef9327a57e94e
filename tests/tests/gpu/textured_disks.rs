//! Textured disks: energy, orientation, and how far off the lookups are.

use arealight_benches::pictures;
use arealight_oracle::shading::poses::{Bar, Errors, Family, Pose, poses};
use arealight_oracle::shading::{ltc_on, textured_ellipse};
use arealight_tests::prelude::*;
use std::sync::Arc;

/// Texels a side.
const SIDE: usize = 128;

/// Layers of the test's textures: those that the bars are for, and others.
const JUDGED: std::ops::Range<u32> = 0..3;
const WHITE: u32 = 3;
const HALVES: u32 = 4;
const PICTURES: u32 = 5;

/// The bars' pictures; white; red on the left half, green on the right, and blue added to the upper half.
fn textures() -> Vec<Arc<Texture>> {
    let half = |index: usize| if index < SIDE / 2 { 1.0 } else { 0.0 };
    let halves = |column, row| DVec3::new(half(column), 1.0 - half(column), half(row));
    [
        Texture::checker(SIDE, SIDE, 8),
        Texture::gradient(SIDE, SIDE),
        Texture::noise(SIDE, SIDE, 1),
        Texture::from_fn(SIDE, SIDE, |_, _| DVec3::ONE),
        Texture::from_fn(SIDE, SIDE, halves),
    ]
    .map(Arc::new)
    .into()
}

fn engine() -> Option<TestEngine> {
    let mut engine = TestEngine::new()?;
    let part = TexturePart { is_ellipse: true, ..TexturePart::default() };
    pictures::load_by_aspect(&mut engine, &textures(), part).unwrap();
    Some(engine)
}

fn ellipse(center: DVec3, axis_u: DVec3, axis_v: DVec3, picture: u32) -> Light {
    let layer = pictures::layer_of(picture, PICTURES, axis_u.length() / axis_v.length());
    Light {
        name: "disk".into(),
        radiance: Vec3::ONE,
        two_sided: false,
        texture: Some(LightTexture { layer, uvs: vec![] }),
        shape: LightShape::Disk { center, axis_u, axis_v },
        ..Light::default()
    }
}

/// Points under disks and ellipses all around, of all roughnesses.
fn points(seed: u64, layer: u32, count: usize) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    let mut point = |index: usize| {
        let distance = 10.0_f64.powf(random.between(-1.0, 2.0));
        let (u, v) = random.direction().any_orthonormal_pair();
        let size = distance * random.between(0.05, 1.5);
        let aspect = random.between(1.0, 2.5);
        let (u, v) = (u * size * aspect.sqrt(), v * size / aspect.sqrt());
        let mut light = ellipse(random.direction() * distance, u, v + u * 0.2, layer);
        light.two_sided = index.is_multiple_of(2);
        let surface = match index % 3 {
            0 => lambert_surface(),
            _ => glossy_surface(10.0_f64.powf(random.between(-3.0, 0.0))),
        };
        let view = random.direction();
        let view = view.with_z(view.z.abs() + 0.02);
        EvalPoint { surface, position: DVec3::ZERO, normal: DVec3::Z, view, light }
    };
    (0..count).map(&mut point).collect()
}

/// The same points with lights of another texture.
fn showing(points: &[EvalPoint], texture: Option<u32>) -> Vec<EvalPoint> {
    let light = |light: &Light| match texture {
        None => Light { texture: None, ..light.clone() },
        Some(picture) => {
            let LightShape::Disk { center, axis_u, axis_v } = light.shape else { panic!("a disk") };
            Light { two_sided: light.two_sided, ..ellipse(center, axis_u, axis_v, picture) }
        }
    };
    points.iter().map(|point| EvalPoint { light: light(&point.light), ..point.clone() }).collect()
}

/// The kernel, and of what both horizons leave mips. A software driver takes seconds for each pipeline.
fn qualities() -> [Quality; 2] {
    let mips = Quality { horizon: Horizon::Both, footprint: Footprint::Mips, ..Quality::default() };
    [Quality::default(), mips]
}

#[test]
fn images_multiply_what_disks_send() {
    let Some(engine) = engine() else { return };
    let white = points(1, WHITE, 500);
    let eval = |points: &[EvalPoint], quality| engine.eval(points, quality).unwrap();
    for quality in qualities() {
        // White is exact in binary16, at every level
        let plain = eval(&showing(&white, None), quality);
        let mut comparison = Comparison::new(format!("white, {quality:?}"));
        for (index, (with, without)) in eval(&white, quality).iter().zip(&plain).enumerate() {
            comparison
                .add(with.x.into(), without.x.into(), 1e-6 * f64::from(without.x), || format!("{index}"));
        }
        comparison.assert_all();
        assert!(plain.iter().filter(|radiance| radiance.x > 1e-3).count() > 100);

        // Red and green are all there is, once each; no color is brighter than the image's
        let halves = eval(&showing(&white, Some(HALVES)), quality);
        let mut comparison = Comparison::new(format!("halves, {quality:?}"));
        let mut colored = 0;
        for (index, (shown, plain)) in halves.iter().zip(&plain).enumerate() {
            assert!(shown.is_finite() && shown.min_element() >= 0.0, "{index}: {shown}");
            // What A and B round to in binary16: 5e-4 each, and B counts a few times as much
            let bound = 3e-3 * f64::from(plain.x);
            comparison.add((shown.x + shown.y).into(), plain.x.into(), bound, || format!("{index}"));
            // Where blue is not no channel keeps it from less than nothing
            assert!(shown.max_element() <= 1.2 * plain.x, "{index}: {shown}, {plain}");
            colored += usize::from((shown.x - shown.y).abs() > 0.2 * plain.x);
        }
        comparison.assert_all();
        // The twin: it is an image, not a mean
        assert!(colored > 30, "{colored}");
    }
}

#[test]
fn an_image_lies_as_the_axes_say_and_the_back_shows_it_mirrored() {
    let Some(engine) = engine() else { return };
    // Above a mirror-like floor seen from straight above: the point sees what is over it
    let seen = |offset: DVec3, front: f64| {
        // Its front is down, its rows run along x, and its top is where y is negative
        let (center, axis_v) = (DVec3::Z - offset, DVec3::NEG_Y * front);
        let light = Light { two_sided: true, ..ellipse(center, DVec3::X, axis_v, HALVES) };
        let surface = glossy_surface(0.01);
        let point = EvalPoint { surface, position: DVec3::ZERO, normal: DVec3::Z, view: DVec3::Z, light };
        let radiance = engine.eval(&[point], Quality::default()).unwrap()[0];
        assert!(radiance.max_element() > 0.1, "{radiance}");
        radiance / radiance.max_element()
    };
    let [left, right] = [-0.4, 0.4].map(|x| DVec3::X * x);
    let [top, bottom] = [-0.4, 0.4].map(|y| DVec3::Y * y);
    let (red, green) = (Vec3::X, Vec3::Y);
    for (place, expected) in [
        (left + top, red + Vec3::Z),
        (left + bottom, red),
        (right + top, green + Vec3::Z),
        (right + bottom, green),
    ] {
        // The lobe is narrow, and its tail is long: some of the next quarter's light
        assert!(seen(place, 1.0).distance(expected) < 0.1, "{place}: {}", seen(place, 1.0));
        // Turned over about its rows, the back shows the bottom at the top
        let mirrored = DVec3::new(place.x, -place.y, 0.0);
        assert!(seen(mirrored, -1.0).distance(expected) < 0.1, "{place}: {}", seen(mirrored, -1.0));
        assert!(seen(mirrored, 1.0).distance(expected) > 0.5, "the twin");
    }
}

/// The disk in a pose's rectangle.
fn disk(pose: &Pose, layer: u32) -> EvalPoint {
    let [a, b, c, d] = pose.vertices;
    let light = ellipse((a + b + c + d) * 0.25, (b - a) * 0.5, (d - a) * 0.5, layer);
    EvalPoint { surface: pose.surface, position: DVec3::ZERO, normal: DVec3::Z, view: pose.view, light }
}

#[test]
fn lookups_are_within_the_bars_of_polygons() {
    let Some(engine) = engine() else { return };
    let (table, textures) = (LightTable::ggx(), textures());
    // More of them by hand, for the table of docs/textures.md
    let count = std::env::var("AREALIGHT_POSES").ok().and_then(|text| text.parse().ok()).unwrap_or(12);
    for family in Family::ALL {
        let poses = poses(family, count, 1, &table);
        let points: Vec<EvalPoint> =
            JUDGED.flat_map(|layer| poses.iter().map(move |pose| disk(pose, layer))).collect();
        let truth = |point: &EvalPoint| {
            let texture = &textures
                [point.light.texture.as_ref().map_or(0, |texture| texture.layer % PICTURES) as usize];
            let light = textured_ellipse(&point.light, Arc::clone(texture)).expect("a disk");
            ltc_on(Quality::default(), &table, &point.surface, point.normal, point.view, &light)
        };
        let truths: Vec<DVec3> = points.iter().map(truth).collect();
        let errors = |points: &[EvalPoint], footprint| {
            let quality = Quality { footprint, ..Quality::default() };
            let found = engine.eval(points, quality).unwrap();
            let mut errors = Errors::default();
            found.iter().zip(&truths).for_each(|(found, truth)| errors.add(found.as_dvec3(), *truth));
            errors.summary()
        };
        let found = errors(&points, Footprint::Kernel);
        println!("{}: {found:.2?}; mips {:.2?}", family.description(), errors(&points, Footprint::Mips));
        let Some(bar) = Bar::of(Footprint::Kernel, family) else { continue };
        assert!(bar.holds(&found), "{family:?}: {found:?}, {bar:?}");
        // The twin: of one colour
        let plain = errors(&showing(&points, Some(WHITE)), Footprint::Kernel);
        assert!(!bar.holds(&plain), "{family:?}: {plain:?}");
    }
}
