//! The camera and the lamps as a person left them, in a file: `render --look` and `view --look` take it.

use super::lamps::Edit;
use super::orbit::Orbit;
use super::state::State;
use crate::failure::Failure;
use arealight_scene::{Camera, Scene};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::path::Path;

/// What a person made of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Look {
    camera: Orbit,
    /// One for each of [`Scene::lamps`].
    lamps: Vec<Edit>,
}

impl Look {
    /// That of what is shown.
    pub fn of(state: &State) -> Self {
        Self { camera: state.orbit, lamps: state.lamps.clone() }
    }

    /// Writes it as JSON.
    pub fn save(&self, path: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(|error| Failure::output(path, error))?;
        crate::output::write(path, (text + "\n").as_bytes())
    }

    /// Reads one for a scene; refuses that of another one, and numbers that the viewer would not make.
    pub fn read(path: &Path, scene: &Scene) -> Result<Self, Failure> {
        let fail = |message: String| Failure::Input { path: path.to_owned(), message };
        let text = crate::memory::read_text(path)?;
        let look: Self = serde_json::from_str(&text).map_err(|error| Failure::input(path, error))?;
        let [count, own] = [look.lamps.len(), scene.lamps.len()];
        if count != own {
            return Err(fail(format!("it is of {count} lamps, and the scene has {own}")));
        }
        let camera = ("camera".to_owned(), look.camera.ranges());
        let lamps = look.lamps.iter().enumerate().map(|(i, lamp)| (format!("lamps[{i}]"), lamp.ranges()));
        for (place, ranges) in std::iter::once(camera).chain(lamps) {
            // NaN is in no range
            if let Some((field, value, range)) =
                ranges.iter().find(|(_, value, range)| !range.contains(value))
            {
                return Err(fail(format!("{place}.{field}: {value} is not within {range:?}")));
            }
        }
        Ok(look)
    }

    /// What is seen so: edits the scene's lamps, and gives the camera.
    pub fn apply(&self, scene: &mut Scene) -> Camera {
        super::lamps::edit(scene, &self.lamps);
        self.camera.camera()
    }

    /// Goes on from here.
    pub fn begin(self, state: &mut State) {
        (state.orbit, state.lamps) = (self.camera, self.lamps);
    }
}

/// A field, its value, and what it may be.
pub type Range = (&'static str, f64, RangeInclusive<f64>);

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn what_is_written_is_read_for_the_same_scene_alone() {
        let bytes = include_bytes!("../../../../scenes/room.glb");
        let mut scene = Scene::from_bytes(bytes, "room").unwrap();
        let mut state = State::new(&scene, &scene.camera(None, 1.5).unwrap(), 0.0, false);
        state.orbit.turn([0.3, -0.1]);
        state.lamps[1] = Edit { is_on: false, ..Edit::NONE };
        state.lamps[0] = Edit { offset: DVec3::new(0.1, -0.2, 1.0 / 3.0), stops: 1.5, ..Edit::NONE };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("look.json");
        let look = Look::of(&state);
        look.save(&path).unwrap();
        assert_eq!(Look::read(&path, &scene).unwrap(), look);

        // What is no look of this scene
        let text = std::fs::read_to_string(&path).unwrap();
        let refused = |text: String, scene: &Scene, words: &str| {
            std::fs::write(&path, text).unwrap();
            let said = Look::read(&path, scene).unwrap_err().to_string();
            assert!(said.contains(words), "{said}");
        };
        refused(text.clone(), &Scene::default(), "it is of 6 lamps, and the scene has 0");
        refused(text.replace("1.5", "9.5"), &scene, "lamps[0].stops: 9.5 is not within -8.0..=8.0");
        refused(text.replace("1.5", "1e999"), &scene, "number out of range");
        refused(text.replace("\"distance\": ", "\"distance\": -"), &scene, "camera.distance: -");
        refused(text.replace("\"yaw\"", "\"jaw\""), &scene, "unknown field `jaw`");

        // As the viewer shows it
        let camera = look.apply(&mut scene);
        assert_eq!(camera, state.orbit.camera());
        let lamp = scene.lamps[1].lights.clone();
        assert!(scene.lights[lamp].iter().all(|light| light.radiance == glam::Vec3::ZERO));
        let mut other = State::new(&scene, &scene.camera(None, 1.5).unwrap(), 0.0, false);
        look.begin(&mut other);
        assert!(other.is_seen_as(&state));
    }
}
