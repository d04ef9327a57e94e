//! The errors of shadows in films, in short form: a history takes away noise at rest and in motion, and drags
//! nothing along. `arealight bench shadows --motion` is the long form.

use arealight_benches::shadow_motion::{Motion, Options, Scheme, run};
use arealight_engine::host::testing::device_or_skip;
use arealight_scene::Scene;

#[test]
fn a_history_errs_less_than_none_whatever_moves() {
    let Some(host) = device_or_skip() else { return };
    let scene = include_bytes!("../../../scenes/shadows.glb");
    let scenes = [Scene::from_bytes(scene, "shadows.glb").unwrap()];
    let options = Options { size: [80, 45], frames: 24, every: 8, truth: 12 };
    let found = run(&host, &arealight::LightTable::ggx(), &scenes, &options, &|_| {}).unwrap();
    println!("{}", found.to_text());
    let film = |motion, history| *found.scenes[0].find(motion, Scheme { rays: 1, history }).unwrap();
    let rest = film(Motion::Rest, false);
    for motion in Motion::ALL {
        let (with, without) = (film(motion, true), film(motion, false));
        assert_eq!((with.not_finite, without.not_finite), (0, 0), "{motion:?}");
        // Without history a frame knows of no other: against a truth that did not move along, the camera's
        // film would err by ten times as much
        assert!((0.75..1.33).contains(&(without.rmse / rest.rmse)), "{motion:?}: {without:?}");
        // Half of it, three quarters and four fifths were seen
        let most = if motion == Motion::Rest { 0.6 } else { 0.95 };
        assert!(with.rmse < most * without.rmse, "{motion:?}: {with:?}, without history {without:?}");
        assert!(with.worst < 1.1 * without.worst, "{motion:?}: {with:?}, without history {without:?}");
        // Where a surface comes into sight there is no history: no worse than without one
        if let (Some(with), Some(without)) = (with.uncovered, without.uncovered) {
            assert!(with < 1.15 * without, "{motion:?}: {with}, without history {without}");
        }
    }
    assert!(film(Motion::Camera, true).uncovered.is_some() && rest.uncovered.is_none());
}
