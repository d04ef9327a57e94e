//! The errors of shadows in short form: rays are unbiased, the filter takes most of their noise away, and
//! without shadows the error is far above. `arealight bench shadows` is the long form.

use arealight_benches::shadow_levels::{Level, LevelResult, Options, SceneResult, run};
use arealight_engine::host::testing::device_or_skip;
use arealight_scene::Scene;

const SCENES: [(&str, &[u8]); 2] = [
    ("shadows.glb", include_bytes!("../../../scenes/shadows.glb")),
    ("shadows-glossy.glb", include_bytes!("../../../scenes/shadows-glossy.glb")),
];

fn find(scene: &SceneResult, level: Level) -> &LevelResult {
    scene.levels.iter().find(|result| result.level == level).expect("every level is there")
}

/// How much of the error of rays is left, of all lit pixels or in penumbra, whichever is more.
fn left(result: &LevelResult, rays: &LevelResult) -> f64 {
    let (result, rays) = (result.errors, rays.errors);
    (result.rmse / rays.rmse).max(result.penumbra_rmse / rays.penumbra_rmse)
}

#[test]
fn every_level_errs_as_little_as_it_is_for() {
    let Some(host) = device_or_skip() else { return };
    let scenes = SCENES.map(|(name, bytes)| Scene::from_bytes(bytes, name).unwrap());
    let options = Options { size: 96, samples: 64, rounds: 1 };
    let found = run(&host, &arealight::LightTable::ggx(), &scenes, &options, &|_| {}).unwrap();
    println!("{}", found.to_text());
    for scene in &found.scenes {
        let rmse = |level| find(scene, level).errors.rmse;
        for result in &scene.levels {
            assert_eq!((result.errors.not_finite, result.errors.radiance.not_finite), (0, 0), "{result:?}");
        }
        // Of 5,000 lit pixels, each with the noise of one ray, .2: four standard deviations of their mean
        for rays in [1, 2, 4] {
            let bias = find(scene, Level::Rays(rays)).errors.bias;
            assert!(bias.abs() < 0.012, "{}: {rays} rays are off by {bias}", scene.name);
        }
        // Less noise than of as many independent rays, which would leave .71 and .5
        let one = rmse(Level::Rays(1));
        assert!(rmse(Level::Rays(2)) < 0.7 * one && rmse(Level::Rays(4)) < 0.48 * one, "{}", scene.name);
        // So coarse a picture has few pixels in a penumbra to take a mean over, and four rays leave less to
        // take away: .31, .38 and .5 were seen
        for (rays, most) in [(1, 0.4), (2, 0.48), (4, 0.6)] {
            let (plain, filtered) = (find(scene, Level::Rays(rays)), find(scene, Level::Filtered(rays)));
            let left = left(filtered, plain);
            assert!(left < most, "{}: of {rays} rays, filtered, {left} is left", scene.name);
            // The twin: rays that are said to be filtered, and are not
            assert!(self::left(plain, plain) > most);
        }
        let off = find(scene, Level::Off).errors;
        assert!(off.rmse > 3.0 * rmse(Level::Filtered(1)) && off.bias > 0.08, "{}: {off:?}", scene.name);
    }
}
