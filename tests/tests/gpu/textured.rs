//! Textured lights: energy, orientation, and the cases that have no easy answer.

use arealight_benches::pictures;
use arealight_engine::{Engine, Of, SourceImage, SourceTexels};
use arealight_oracle::polygon::vector_form_factor;
use arealight_oracle::shading::footprint;
use arealight_oracle::texture::Pyramid;
use arealight_tests::prelude::*;
use std::sync::Arc;

const FOOTPRINTS: [Footprint; 2] = [Footprint::Kernel, Footprint::Mips];

/// Layers of the test's textures.
const WHITE: u32 = 0;
const SPLIT: u32 = 1;
const HUGE: u32 = 2;

const SIZE: u32 = 64;

/// The colors of a texel of the layer [`SPLIT`].
fn split(column: u32, row: u32) -> [f32; 4] {
    let half = |index: u32| if index < SIZE / 2 { 1.0 } else { 0.0 };
    [half(column), 1.0 - half(column), half(row), 1.0]
}

/// White; red on the left half, green on the right, and blue added to the upper half; and texels of 0 and
/// 65,504 in turn.
fn engine() -> Option<TestEngine> {
    let mut engine = TestEngine::new()?;
    let picture = |texel: &dyn Fn(u32, u32) -> [f32; 4]| -> Vec<[f32; 4]> {
        (0..SIZE * SIZE).map(|index| texel(index % SIZE, index / SIZE)).collect()
    };
    let white = picture(&|_, _| [1.0; 4]);
    let split = picture(&split);
    let huge = picture(&|column, row| [if (column + row) % 2 == 0 { 65_504.0 } else { 0.0 }; 4]);
    let part = TexturePart::default();
    let image = |texels| SourceImage { texels: SourceTexels::Linear(texels), size: [SIZE, SIZE], part };
    let size = PyramidSize::new(SIZE).unwrap();
    engine.load_textures(size, &[image(&white), image(&split), image(&huge)]).unwrap();
    Some(engine)
}

/// The image laid onto the polygon: its box in the polygon's plane shows all of it.
fn shown(light: &mut Light, layer: u32) {
    let normal = light.shape.area_vector().normalize_or(DVec3::Z);
    let u = (light.shape.vertices()[1] - light.shape.vertices()[0]).normalize_or(DVec3::X);
    let v = normal.cross(u);
    let flat: Vec<DVec2> = light.shape.vertices().iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
    let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let uvs = flat.iter().map(|p| (*p - low) / (high - low)).collect();
    light.texture = Some(LightTexture { layer, uvs });
}

/// A rectangle around `center` that faces the origin.
fn rectangle(random: &mut Random, center: DVec3, size: f64) -> Vec<DVec3> {
    let towards = random.direction();
    let normal = if towards.dot(center) > 0.0 { -towards } else { towards };
    let (u, v) = normal.any_orthonormal_pair();
    let (u, v) = (u * size * random.between(0.3, 1.0), v * size * random.between(0.3, 1.0));
    vec![center - u - v, center + u - v, center + u + v, center - u + v]
}

/// Points under rectangles, under polygons of up to seven vertices, and under such with a hole: over all
/// angles, distances and roughnesses.
fn points(seed: u64, layer: u32, count: usize) -> Vec<EvalPoint> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|index| {
            let distance = 10.0_f64.powf(random.between(-1.0, 2.0));
            let center = random.direction() * distance;
            let size = distance * random.between(0.05, 1.5);
            let vertices = if index % 2 == 0 {
                rectangle(&mut random, center, size)
            } else {
                random.polygon(center, 3 + index / 2 % 5, size * 0.3, size)
            };
            let cos_view = random.between(0.02, 1.0);
            let view = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
            let surface = if index % 3 == 0 {
                lambert_surface()
            } else {
                glossy_surface(10.0_f64.powf(random.between(-3.0, 0.0)))
            };
            let mut given = point(surface, view, vertices, index % 5 == 0);
            shown(&mut given.light, layer);
            if index % 4 == 1 {
                // A ring: what is nearer to the middle of a star is within it
                let hole =
                    given.light.shape.vertices().iter().map(|vertex| center.lerp(*vertex, 0.5)).collect();
                given.light.cut_holes(&[hole]).expect("a hole within its outline");
            }
            given
        })
        .collect()
}

fn without_texture(points: &[EvalPoint]) -> Vec<EvalPoint> {
    let plain = |point: &EvalPoint| {
        let light = Light { texture: None, ..point.light.clone() };
        EvalPoint { light, ..point.clone() }
    };
    points.iter().map(plain).collect()
}

/// Levels with textures; the dearest with the dearest of the other choices. A software driver takes a second
/// for each pipeline, and there are four for a quality: of quads and of polygons, with and without images.
fn qualities() -> [Quality; 3] {
    let level = |footprint| Quality { footprint, ..Quality::default() };
    let [kernel, mips] = FOOTPRINTS.map(level);
    let dear = Quality { specular_lobes: SpecularLobes::Two, horizon: Horizon::Both, ..kernel };
    [kernel, mips, dear]
}

#[test]
fn a_white_image_changes_nothing() {
    let Some(engine) = engine() else { return };
    let textured = points(1, WHITE, 600);
    let plain = without_texture(&textured);
    for quality in qualities() {
        let with = engine.eval(&textured, quality).unwrap();
        let without = engine.eval(&plain, quality).unwrap();
        let mut comparison = Comparison::new(format!("{quality:?}"));
        let mut lit = 0;
        for (index, (with, without)) in with.iter().zip(&without).enumerate() {
            // White is what it covers, to float32's rounding
            let bound = 1e-5 * f64::from(without.x) + 1e-6;
            comparison.add(with.x.into(), without.x.into(), bound, || format!("point {index}"));
            lit += usize::from(without.x > 0.01);
        }
        comparison.assert_all();
        assert!(lit > 100, "{lit} lit points tell something");
    }
    // The twin: another image does change it
    let other = engine.eval(&points(1, SPLIT, 600), Quality::default()).unwrap();
    let plain = engine.eval(&plain, Quality::default()).unwrap();
    let changed = other.iter().zip(&plain).filter(|(a, b)| (a.x - b.x).abs() > 1e-2 * b.x).count();
    assert!(changed > 200, "{changed}");
}

#[test]
fn lookups_are_those_of_their_float64_twins() {
    let Some(engine) = engine() else { return };
    let pyramid = downloaded(&engine, SPLIT);
    // Under Lambert's lobe cosine space is the surface's: nothing else differs
    let mut given = points(4, SPLIT, 900);
    given.retain(|point| point.surface == lambert_surface());
    for one in FOOTPRINTS {
        let quality = Quality { footprint: one, ..Quality::default() };
        let answers = engine.eval(&given, quality).unwrap();
        let plain = engine.eval(&without_texture(&given), quality).unwrap();
        let mut comparison = Comparison::new(format!("{one:?}"));
        let mut twin = 0;
        for (index, (point, (answer, plain))) in given.iter().zip(answers.iter().zip(&plain)).enumerate() {
            let light = &point.light;
            let map = light.texture.as_ref().unwrap().map(&light.shape).unwrap();
            let vector = vector_form_factor(light.shape.vertices());
            let vector = vector * vector.z.signum();
            let answer_of = |of| footprint::seen(of, &map, vector, &pyramid) * f64::from(plain.x);
            let expected = answer_of(one);
            let other = answer_of(FOOTPRINTS[usize::from(one == FOOTPRINTS[0])]);
            // Levels' share and place to 1/256 between texels that differ by one, and of A and B as much
            let bound = 1e-2 * f64::from(plain.x) + 2e-5;
            for axis in 0..3 {
                comparison.add(f64::from(answer[axis]), expected[axis], bound, || format!("point {index}"));
            }
            twin += usize::from((other - answer.as_dvec3()).abs().max_element() > bound);
        }
        comparison.assert_all();
        assert!(twin > 20, "{one:?}: another lookup's answers are told from these: {twin}");
    }
}

/// What the device has for a layer.
fn downloaded(engine: &Engine, layer: u32) -> Pyramid {
    let of = |number| [Of::Image, Of::A, Of::BRows, Of::BColumns][number as usize];
    Pyramid::from_levels(PyramidSize::new(SIZE).unwrap(), |number, level| {
        engine.download_level(layer, of(number), level).unwrap()
    })
}

#[test]
fn twice_the_radiance_is_twice_the_answer() {
    let Some(engine) = engine() else { return };
    let once = points(2, SPLIT, 300);
    let bright = |point: &EvalPoint| Light { radiance: Vec3::splat(2.0), ..point.light.clone() };
    let twice: Vec<_> = once.iter().map(|one| EvalPoint { light: bright(one), ..one.clone() }).collect();
    for footprint in FOOTPRINTS {
        let quality = Quality { footprint, ..Quality::default() };
        let (once, twice) = (engine.eval(&once, quality).unwrap(), engine.eval(&twice, quality).unwrap());
        // A power of two rounds nothing
        assert!(once.iter().zip(&twice).all(|(once, twice)| *once * 2.0 == *twice), "{footprint:?}");
        assert!(once.iter().any(|answer| answer.x > 0.1));
    }
}

/// A floor of roughness `alpha` under a screen that stands at y = 2 and shows its red half at x < 0, its blue
/// half above; seen so that the mirror direction meets the screen at (x, z).
fn screen(alpha: f64, x: f64, z: f64) -> EvalPoint {
    let corner = |x: f64, z: f64| DVec3::new(x, 2.0, z);
    // The front is towards the point: u runs to +x and v runs down
    let vertices = vec![corner(-1.0, 0.5), corner(1.0, 0.5), corner(1.0, 2.5), corner(-1.0, 2.5)];
    let view = DVec3::new(-x, -2.0, z);
    let mut point = point(glossy_surface(alpha), view, vertices, false);
    let area = point.light.shape.area_vector();
    assert!(area.y < 0.0, "the front is towards the point: {area}");
    let uvs = vec![DVec2::Y, DVec2::ONE, DVec2::X, DVec2::ZERO];
    point.light.texture = Some(LightTexture { layer: SPLIT, uvs });
    point
}

#[test]
fn a_mirror_shows_the_image_the_right_way_round() {
    let Some(engine) = engine() else { return };
    for footprint in FOOTPRINTS {
        let quality = Quality { footprint, ..Quality::default() };
        let seen: Vec<EvalPoint> =
            [(-0.6, 2.1), (0.6, 2.1), (-0.6, 0.9), (0.6, 0.9)].map(|(x, z)| screen(1e-3, x, z)).into();
        let colors = engine.eval(&seen, quality).unwrap();
        let is = |color: Vec3, red: bool, blue: bool| {
            (color.x > 0.9) == red
                && (color.y > 0.9) != red
                && (color.z > 0.9) == blue
                && color.min_element() < 0.02
        };
        assert!(is(colors[0], true, true), "{footprint:?}: upper left: {}", colors[0]);
        assert!(is(colors[1], false, true), "{footprint:?}: upper right: {}", colors[1]);
        assert!(is(colors[2], true, false), "{footprint:?}: lower left: {}", colors[2]);
        assert!(is(colors[3], false, false), "{footprint:?}: lower right: {}", colors[3]);
    }
}

#[test]
fn the_back_of_a_two_sided_light_shows_it_mirrored() {
    let Some(engine) = engine() else { return };
    // Turned about: what was to the left is still there, seen from behind
    let mut behind = screen(1e-3, -0.6, 2.1);
    behind.light.shape.vertices_mut().reverse();
    behind.light.texture.as_mut().unwrap().uvs.reverse();
    let one_sided = behind.clone();
    behind.light.two_sided = true;
    for footprint in FOOTPRINTS {
        let quality = Quality { footprint, ..Quality::default() };
        let colors = engine.eval(&[behind.clone(), one_sided.clone()], quality).unwrap();
        assert!(colors[0].x > 0.9 && colors[0].y < 0.02 && colors[0].z > 0.9, "{footprint:?}: {}", colors[0]);
        assert_eq!(colors[1], Vec3::ZERO, "{footprint:?}: one side alone is dark from behind");
    }
}

/// The largest step of a sweep's answers, over their largest value.
fn largest_step(engine: &TestEngine, sweep: &[EvalPoint], quality: Quality) -> f32 {
    let answers = engine.eval(sweep, quality).unwrap();
    assert!(answers.iter().all(|answer| answer.is_finite() && answer.min_element() >= 0.0), "{quality:?}");
    let largest = answers.iter().map(|answer| answer.max_element()).fold(0.0, f32::max);
    let steps = answers.windows(2).map(|pair| (pair[1] - pair[0]).abs().max_element());
    steps.fold(0.0, f32::max) / largest
}

#[test]
fn sweeps_have_no_seams() {
    const STEPS: u32 = 2000;
    let Some(engine) = engine() else { return };
    let share = |step: u32| f64::from(step) / f64::from(STEPS);
    // Roughness from a mirror to the end; a hit point that crosses the image and leaves it; a light that
    // sets; the surface that rises past the light's plane
    let roughness: Vec<EvalPoint> =
        (0..=STEPS).map(|step| screen((0.03 + 0.97 * share(step)).powi(2), 0.3, 1.0)).collect();
    let across: Vec<EvalPoint> = (0..=STEPS).map(|step| screen(0.2, 3.0 * share(step) - 1.5, 1.0)).collect();
    let moved = |surface, by: &dyn Fn(f64) -> DVec3| -> Vec<EvalPoint> {
        let at = |step| {
            let mut point = EvalPoint { surface, ..screen(0.3, 0.2, 1.0) };
            point.light.two_sided = true;
            point.light.shape.vertices_mut().iter_mut().for_each(|vertex| *vertex += by(share(step)));
            point
        };
        (0..=STEPS).map(at).collect()
    };
    let setting = moved(lambert_surface(), &|share| DVec3::Z * (-3.0 * share));
    let through = moved(glossy_surface(0.3), &|share| DVec3::Y * (2.0 * share - 3.0));
    for footprint in FOOTPRINTS {
        let quality = Quality { footprint, ..Quality::default() };
        // A thousandth of the way moves the answer by a few thousandths; a seam between levels or parts would
        // be a step as large as the image's contrast
        let bound = 0.01;
        for (name, sweep) in [("roughness", &roughness), ("across", &across), ("setting", &setting)] {
            let step = largest_step(&engine, sweep, quality);
            assert!(step < bound, "{footprint:?}: {name}: {step}");
        }
        // Where the plane passes the point the light's side changes, and with it which points are lit: at one
        // point only
        let answers = engine.eval(&through, quality).unwrap();
        assert!(answers.iter().all(|answer| answer.is_finite() && answer.min_element() >= 0.0));
    }
    // The twin: a step is seen
    let mut broken = roughness;
    broken[1000] = screen(1e-3, -0.6, 2.1);
    assert!(largest_step(&engine, &broken, Quality::default()) > 0.1);
}

#[test]
fn a_light_that_fills_the_sky_gives_its_colors() {
    let Some(engine) = engine() else { return };
    let far = 1e4;
    let corner = |x: f64, y: f64| DVec3::new(x * far, y * far, 1.0);
    let vertices = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let mut sky = point(lambert_surface(), DVec3::Z, vertices, false);
    let uvs = vec![DVec2::ZERO, DVec2::Y, DVec2::ONE, DVec2::X];
    sky.light.texture = Some(LightTexture { layer: SPLIT, uvs });
    for footprint in FOOTPRINTS {
        let answer = engine.eval(&[sky.clone()], Quality { footprint, ..Quality::default() }).unwrap()[0];
        // The point is under the middle: half of each. The middle of the image is bilinear between its
        // halves; the fit of Lambert's lobe has no error
        assert!((answer - Vec3::splat(0.5)).abs().max_element() < 0.01, "{footprint:?}: {answer}");
    }
}

#[test]
fn the_largest_numbers_stay_finite_and_within_the_image() {
    let Some(engine) = engine() else { return };
    let given = points(3, HUGE, 300);
    let plain = without_texture(&given);
    for quality in qualities() {
        let answers = engine.eval(&given, quality).unwrap();
        let plain = engine.eval(&plain, quality).unwrap();
        for (answer, plain) in answers.iter().zip(&plain) {
            assert!(answer.is_finite() && answer.min_element() >= 0.0, "{quality:?}: {answer}");
            assert!(answer.x <= 65_504.0 * (plain.x * 1.001 + 2e-5), "{quality:?}: {answer} of {plain}");
        }
    }
}

/// What a surface sees of a far light, relative to the image's mean.
fn far_light(engine: &TestEngine, surface: &Surface, footprint: Footprint) -> Vec3 {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 1e3);
    let vertices = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let mut far = point(*surface, DVec3::Z, vertices, false);
    let quality = Quality { footprint, ..Quality::default() };
    let plain = engine.eval(&[far.clone()], quality).unwrap()[0];
    let uvs = vec![DVec2::ZERO, DVec2::Y, DVec2::ONE, DVec2::X];
    far.light.texture = Some(LightTexture { layer: SPLIT, uvs });
    engine.eval(&[far], quality).unwrap()[0] / plain / Vec3::splat(0.5)
}

#[test]
fn a_far_light_shows_its_mean() {
    let Some(engine) = engine() else { return };
    for footprint in FOOTPRINTS {
        for surface in [lambert_surface(), glossy_surface(0.5)] {
            let ratio = far_light(&engine, &surface, footprint);
            // Of halves alike about the middle the mean, but for binary16's and the sampler's rounding
            assert!((ratio - Vec3::ONE).abs().max_element() < 4e-3, "{footprint:?}: {ratio}");
        }
    }
}

#[test]
fn a_light_that_shows_nearly_all_of_a_layer_shows_it_as_one_that_shows_all() {
    let Some(mut engine) = TestEngine::new() else { return };
    pictures::load(&mut engine, &[bars([256, 256], false)], |_| TexturePart::default()).unwrap();
    for distance in [0.5, 2.0, 30.0] {
        let seen = |low: f64, size: f64| {
            let corner = |u: f64, v: f64| DVec3::new(u - 0.5, v - 0.5, distance);
            let uvs = [DVec2::ZERO, DVec2::Y, DVec2::ONE, DVec2::X];
            let mut given =
                point(lambert_surface(), DVec3::Z, uvs.map(|uv| corner(uv.x, uv.y)).to_vec(), false);
            let uvs = uvs.map(|uv| low + size * uv).to_vec();
            given.light.texture = Some(LightTexture { layer: 0, uvs });
            engine.eval(&[given], Quality::default()).unwrap()[0]
        };
        let all = seen(0.0, 1.0);
        // Half a texel, and two: what is left out is a few percent of the outermost bars
        for (inset, bound) in [(1.0 / 512.0, 0.005), (2.0 / 256.0, 0.02)] {
            let off = (seen(inset, 1.0 - 2.0 * inset) / all - 1.0).abs().max_element();
            assert!(off < bound, "{inset} at {distance}: {off}");
        }
        // The twin: a half does matter
        assert!((seen(0.0, 0.5) / all - 1.0).abs().max_element() > 0.1);
    }
}

/// Coloured bars side by side, or above one another, in an image of so many texels.
fn bars([width, height]: [usize; 2], stacked: bool) -> Arc<Texture> {
    Arc::new(Texture::from_fn(width, height, |column, row| {
        let bar = if stacked { row * 8 / height } else { column * 8 / width };
        DVec3::from_array([4, 2, 1].map(|bit| if bar & bit == 0 { 1.0 } else { 0.05 }))
    }))
}

/// What a wall sees, over what it should, of a picture that is one unit high and so far before it, as a sum
/// over fifteen places; it should see that share of its width and height, from a corner.
fn wall(engine: &TestEngine, layer: u32, picture: &Texture, distance: f64, shown: DVec2) -> DVec3 {
    let wide = picture.width() as f64 / picture.height() as f64;
    let places = [-0.8, -0.3, 0.1, 0.5, 0.9].map(|x| [-0.7, 0.1, 0.6].map(|y| DVec2::new(x, y)));
    let extent = 0.5 * (wide.max(1.0) + distance);
    let (mut points, mut expected) = (vec![], DVec3::ZERO);
    for place in places.as_flattened() {
        let corner =
            |u: f64, v: f64| DVec3::new((u - 0.5) * wide, v - 0.5, distance) - place.extend(0.0) * extent;
        let uvs = vec![DVec2::ZERO, DVec2::Y, DVec2::ONE, DVec2::X];
        let vertices = uvs.iter().map(|uv| corner(uv.x, uv.y)).collect();
        let mut point = point(lambert_surface(), DVec3::Z, vertices, false);
        for (x, y) in (0..64).flat_map(|y| (0..256).map(move |x| (x, y))) {
            let (u, v) = (shown.x * (f64::from(x) + 0.5) / 256.0, shown.y * (f64::from(y) + 0.5) / 64.0);
            let kernel = (distance / corner(u, v).length_squared()).powi(2) / std::f64::consts::PI;
            expected += picture.sample(DVec2::new(u, v)) * kernel * wide / (256.0 * 64.0);
        }
        point.light.texture = Some(LightTexture { layer, uvs });
        points.push(point);
    }
    let found: Vec3 = engine.eval(&points, Quality::default()).unwrap().iter().sum();
    let unit = points[0].surface.diffuse_albedo * points[0].light.radiance.as_dvec3();
    found.as_dvec3() / (expected * unit)
}

#[test]
fn screens_of_any_aspect_show_their_colours_beside_others() {
    let Some(mut engine) = TestEngine::new() else { return };
    let sizes = [[256, 144], [256, 128], [64, 192], [512, 32], [256, 256]];
    let screens: Vec<_> = sizes.map(|size| (size, false)).into_iter().chain([([512, 32], true)]).collect();
    let pictures: Vec<_> = screens.iter().map(|&(size, stacked)| bars(size, stacked)).collect();
    let aspect = |layer: usize| pictures[layer].width() as f32 / pictures[layer].height() as f32;
    let part = |layer| TexturePart { aspect: aspect(layer), ..TexturePart::default() };
    pictures::load(&mut engine, &pictures, part).unwrap();
    for ((layer, picture), (size, stacked)) in (0..).zip(&pictures).zip(screens) {
        // Bars along 16:1 are as narrow as nodes of the filter. The twin: a blur to half of the picture
        let (bound, half) = if stacked { (0.03, [1.0, 0.5]) } else { (0.02, [0.5, 1.0]) };
        for distance in [0.5, 2.0, 8.0, 16.0, 32.0] {
            let off = |shown| (wall(&engine, layer, picture, distance, shown) - 1.0).abs().max_element();
            let [all, half] = [DVec2::ONE, half.into()].map(off);
            println!("{size:?} at {distance}: {all:.4}");
            assert!(all < bound, "{size:?} at {distance}: {all}");
            assert!(half > 0.1, "{size:?} at {distance}: {half}");
        }
    }
}
