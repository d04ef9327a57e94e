//! The paths through a quad's code that a device counts, in a scene where they are known.

use arealight_benches::many_lights;
use arealight_benches::model::{Counts, LobePaths, ModelError, Paths, count_scene};
use arealight_tests::prelude::*;

const SIZE: [u32; 2] = [64, 40];

/// Half of the floor's side in metres.
const HALF: f64 = 4.0;

/// A floor at the height 0 alone, seen from above under `lights`.
fn floor(lights: Vec<Light>) -> Scene {
    Scene { lights, ..many_lights::floor(0.9, 2.0 * HALF, 1.6, 0.5) }
}

/// A light with the corners center ± u ± v, whose front is to the side of u x v.
fn light(center: DVec3, u: DVec3, v: DVec3) -> Light {
    let vertices = vec![center - u - v, center + u - v, center + u + v, center - u + v];
    Light { shape: LightShape::Polygon(vertices), radiance: Vec3::ONE, ..Light::default() }
}

fn counted(engine: &TestEngine, lights: Vec<Light>) -> Counts {
    let [counts, _] = count_scene(engine, &floor(lights), SIZE).expect("the paths are counted");
    assert!(counts.waves > 20, "{} waves see the floor", counts.waves);
    counts
}

/// What the waves do of a light.
fn paths_of(counts: &Counts, light: usize) -> Vec<Paths> {
    counts.by_light.keys().filter(|(place, _)| *place == light).map(|(_, paths)| *paths).collect()
}

#[test]
fn paths_are_those_of_the_lights() {
    let Some(engine) = TestEngine::new() else { return };
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let small = 0.1;
    let wall = DVec3::new(0.0, 0.0, -HALF - 1.0);
    let cases = [
        ("above", light(3.0 * y, x * small, z * small), LobePaths::ACUTE),
        ("above, long", light(3.0 * y, x * 10.0, z * 40.0), LobePaths::NOT_ACUTE),
        ("below", light(-3.0 * y, z * small, x * small), LobePaths::BELOW),
        ("through the floor", light(wall, x, y), LobePaths::CROSSING[1]),
        // A rhombus, of which a corner is above or below
        ("with a corner above", light(wall - 0.8 * y, (x + y) * 0.5, (y - x) * 0.5), LobePaths::CROSSING[0]),
        ("with a corner below", light(wall + 0.8 * y, (x + y) * 0.5, (y - x) * 0.5), LobePaths::CROSSING[2]),
    ];
    let lights: Vec<Light> = cases.iter().map(|(_, light, _)| light.clone()).collect();
    let counts = counted(&engine, lights.clone());
    for (place, (name, _, path)) in cases.into_iter().enumerate() {
        let found: Vec<Paths> = paths_of(&counts, place);
        let is_right = |paths: &Paths| !paths.has(Paths::BEHIND) && paths.lobe(0) == path;
        assert!(!found.is_empty() && found.iter().all(is_right), "{name}: {found:?}");
    }
    // The twin: turned over, every wave is behind all of them
    let turned = lights.into_iter().map(|mut light| {
        light.shape.vertices_mut().reverse();
        light
    });
    let counts = counted(&engine, turned.collect());
    for place in 0..counts.quads {
        assert_eq!(paths_of(&counts, place), [Paths::BEHIND]);
    }
}

#[test]
fn pictures_that_are_no_whole_workgroups_are_refused() {
    let Some(engine) = TestEngine::new() else { return };
    let found = count_scene(&engine, &floor(vec![]), [60, 40]);
    assert!(matches!(found, Err(ModelError::Size(60, 40))), "{found:?}");
    assert!(count_scene(&engine, &floor(vec![]), SIZE).is_ok(), "the twin");
}
