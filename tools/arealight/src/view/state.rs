//! What a person has chosen, and how keys and the pointer change it. Nothing here draws.

use super::lamps::{self, Edit};
use super::orbit::Orbit;
use crate::picture::MAX_STOPS;
use arealight::Level;
use arealight_scene::{Camera, Scene, SceneFog};
use std::str::FromStr;

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The picture.
    Picture,
    /// The picture to the left of a line, another to the right.
    Wipe(Partner),
    /// How far the picture is from the truth, in false colours.
    Error,
}

/// What the picture is wiped against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Partner {
    /// Monte Carlo, which converges.
    Truth,
    /// What engines ship, with a table of the published one's quality; without shadows.
    Yardstick,
}

/// A key that means something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Key {
    /// A quality level.
    Level(Level),
    Wipe,
    Error,
    Shadows,
    /// Images that move go on, or stand still.
    Play,
    Fog,
    /// Of fog, by a factor.
    Density(f64),
    Costs,
    Panel,
    Save,
    Quit,
    /// Everything as it was.
    Reset,
    /// By a step to the brighter, or the darker.
    Exposure(f32),
    /// By a step to the rougher, or the smoother.
    Roughness(f32),
    /// A drag of the camera, in heights of the picture.
    Turn([f64; 2]),
}

/// Keys as help and scripts name them, and what each does.
pub const KEYS: [(&str, &str); 13] = [
    ("1 to 5", "quality level"),
    ("w", "wipe: against the truth, against what engines ship, off"),
    ("e", "map of the error"),
    ("s", "shadows"),
    ("f , .", "fog: off or on, thinner, denser"),
    ("c", "what each level and effect costs here"),
    ("[ ]", "roughness of every surface: smoother, rougher"),
    ("- +", "exposure"),
    ("space", "images that move stand still, or go on"),
    ("arrows", "turn the camera, as dragging does; the wheel goes nearer"),
    ("r", "everything as it was"),
    ("p", "save the picture, and the camera and lamps"),
    ("h, escape", "this panel; quit"),
];

impl FromStr for Key {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Ok(match name {
            "w" => Self::Wipe,
            "e" => Self::Error,
            "s" => Self::Shadows,
            "space" => Self::Play,
            "f" => Self::Fog,
            "," => Self::Density(0.8),
            "." => Self::Density(1.25),
            "c" => Self::Costs,
            "h" => Self::Panel,
            "p" => Self::Save,
            "r" => Self::Reset,
            "q" | "escape" => Self::Quit,
            "+" | "=" => Self::Exposure(0.5),
            "-" => Self::Exposure(-0.5),
            "]" => Self::Roughness(0.05),
            "[" => Self::Roughness(-0.05),
            "left" => Self::Turn([-0.04, 0.0]),
            "right" => Self::Turn([0.04, 0.0]),
            "up" => Self::Turn([0.0, -0.04]),
            "down" => Self::Turn([0.0, 0.04]),
            _ => match name.parse() {
                Ok(number @ 1..=5) => Self::Level(Level::ALL[number - 1]),
                _ => return Err(format!("'{name}' is no key of the viewer")),
            },
        })
    }
}

/// Something that a person does. Places are parts of the picture's width and height, from its upper left
/// corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A key goes down.
    Key(Key),
    /// A button of the pointer goes down: the second one slides the view.
    Press { at: [f64; 2], second: bool },
    /// The pointer goes to a place.
    Move([f64; 2]),
    /// The button goes up.
    Release,
    /// The wheel turns, forwards by positive steps.
    Wheel(f64),
}

/// What the pointer holds while a button is down.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Grip {
    Nothing,
    View,
    Slide,
    Divider,
    /// A lamp at a distance along the view.
    Lamp(usize, f64),
}

/// What a person has chosen.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// The camera.
    pub orbit: Orbit,
    /// The quality level.
    pub level: Level,
    /// What is shown.
    pub mode: Mode,
    /// Where the line of a wipe is, as a part of the width.
    pub divider: f64,
    /// In stops.
    pub exposure: f32,
    /// Added to the roughness of every surface.
    pub rougher: f32,
    /// Of images that move, in seconds, and whether they do.
    pub time: f64,
    pub plays: bool,
    /// Whether lights have shadows.
    pub shadows: bool,
    /// Whether there is fog.
    pub is_foggy: bool,
    /// What it is where there is some.
    pub fog: SceneFog,
    /// Whether the panel is shown.
    pub panel: bool,
    /// Whether the costs of levels and effects are to be shown.
    pub costs: bool,
    /// The lamp that was picked last, of [`Scene::lamps`].
    pub picked: Option<usize>,
    /// The lamp under the pointer.
    pub hovered: Option<usize>,
    /// What became of each lamp.
    pub lamps: Vec<Edit>,
    /// The picture is to be saved.
    pub save: bool,
    /// There is nothing more to show.
    pub quit: bool,
    /// Whether there is a yardstick for the scene's lights.
    pub has_yardstick: bool,
    /// Whether some surface is in a group, which lamps may be linked to.
    pub has_groups: bool,
    home: Orbit,
    first_exposure: f32,
    pub(super) first_fog: SceneFog,
    pointer: [f64; 2],
    grip: Grip,
}

/// How near to the line of a wipe a press takes hold of it, as a part of the width.
const HOLD: f64 = 0.02;

impl State {
    /// As a scene is first shown.
    pub fn new(scene: &Scene, camera: &Camera, exposure: f32, has_yardstick: bool) -> Self {
        let home = Orbit::new(camera, scene.bounds);
        // Half of the light goes through as much as the scene is long
        let density = 0.7 / scene.bounds.diagonal().max(1e-3);
        let fog = scene.fog.unwrap_or(SceneFog { density, anisotropy: 0.3, albedo: 1.0 });
        Self {
            orbit: home,
            level: Level::for_surfaces(scene.surfaces()),
            mode: Mode::Picture,
            divider: 0.5,
            exposure,
            rougher: 0.0,
            time: 0.0,
            plays: true,
            shadows: true,
            is_foggy: scene.fog.is_some(),
            fog,
            panel: false,
            costs: false,
            picked: None,
            hovered: None,
            lamps: vec![Edit::NONE; scene.lamps.len()],
            save: false,
            quit: false,
            has_yardstick,
            has_groups: scene.triangles.iter().any(|triangle| triangle.groups != 0),
            home,
            first_exposure: exposure,
            first_fog: fog,
            pointer: [0.5; 2],
            grip: Grip::Nothing,
        }
    }

    /// Whether the picture has shadows. Yardsticks have none, and are wiped against a picture without; what
    /// they cost is the same on every level.
    pub fn has_shadows(&self) -> bool {
        self.shadows && self.is_complete()
    }

    /// The fog of the picture. Yardsticks and the measured costs are without.
    pub fn fog(&self) -> Option<SceneFog> {
        (self.is_foggy && self.is_complete()).then_some(self.fog)
    }

    fn is_complete(&self) -> bool {
        self.mode != Mode::Wipe(Partner::Yardstick) && !self.costs
    }

    /// Whether both show the same of the scene, whatever is shown beside it.
    pub fn is_seen_as(&self, other: &Self) -> bool {
        let same = |state: &Self| (state.orbit, state.rougher, state.time, state.fog(), state.shadows);
        same(self) == same(other) && self.lamps == other.lamps
    }

    /// Lets images that move go on by so many seconds.
    pub fn play(&mut self, scene: &Scene, seconds: f64) {
        if self.plays && scene.has_moving_images() {
            self.time += seconds;
        }
    }

    /// Whether the truth is shown, or what is far from it.
    pub fn needs_truth(&self) -> bool {
        self.costs || matches!(self.mode, Mode::Wipe(Partner::Truth) | Mode::Error)
    }

    /// Does what an event asks for. `scene` is the one that is shown, with its lamps where they are; `aspect`
    /// is the picture's width over its height.
    pub fn apply(&mut self, event: Event, scene: &Scene, aspect: f64) {
        match event {
            Event::Key(key) => self.press_key(key),
            Event::Press { at, second } => {
                self.pointer = at;
                self.grip = self.take(at, second, scene, aspect);
            }
            Event::Move(at) => {
                let drag = [(at[0] - self.pointer[0]) * aspect, at[1] - self.pointer[1]];
                self.pointer = at;
                self.drag(drag);
            }
            Event::Release => self.grip = Grip::Nothing,
            Event::Wheel(steps) => match self.grip {
                // A lamp that is held goes farther along the view
                Grip::Lamp(lamp, distance) => {
                    let forward = self.orbit.camera().forward;
                    let farther = distance * 0.05 * steps;
                    self.lamps[lamp].move_by(forward * farther);
                    self.grip = Grip::Lamp(lamp, distance + farther);
                }
                _ => self.orbit.approach(steps),
            },
        }
    }

    pub(super) fn press_key(&mut self, key: Key) {
        match key {
            Key::Level(level) => self.level = level,
            Key::Wipe => {
                self.mode = match self.mode {
                    Mode::Wipe(Partner::Truth) if self.has_yardstick => Mode::Wipe(Partner::Yardstick),
                    Mode::Wipe(_) => Mode::Picture,
                    Mode::Picture | Mode::Error => Mode::Wipe(Partner::Truth),
                };
            }
            Key::Error => {
                self.mode = if self.mode == Mode::Error { Mode::Picture } else { Mode::Error };
            }
            Key::Shadows => self.shadows = !self.shadows,
            Key::Play => self.plays = !self.plays,
            Key::Fog => self.is_foggy = !self.is_foggy,
            Key::Density(factor) => {
                let first = self.first_fog.density;
                self.fog.density = (self.fog.density * factor).clamp(1e-3 * first, 1e3 * first);
            }
            Key::Costs => self.costs = !self.costs,
            Key::Panel => self.panel = !self.panel,
            Key::Save => self.save = true,
            Key::Quit => self.quit = true,
            Key::Reset => {
                (self.orbit, self.exposure, self.rougher) = (self.home, self.first_exposure, 0.0);
                self.fog = self.first_fog;
                self.lamps.fill(Edit::NONE);
            }
            Key::Exposure(step) => self.exposure = (self.exposure + step).clamp(-MAX_STOPS, MAX_STOPS),
            Key::Roughness(step) => self.rougher = (self.rougher + step).clamp(-1.0, 1.0),
            Key::Turn(drag) => self.orbit.turn(drag),
        }
    }

    /// What a press takes hold of.
    fn take(&mut self, at: [f64; 2], second: bool, scene: &Scene, aspect: f64) -> Grip {
        if second {
            return Grip::Slide;
        }
        if matches!(self.mode, Mode::Wipe(_)) && (at[0] - self.divider).abs() < HOLD {
            return Grip::Divider;
        }
        match self.lamp_at(at, scene, aspect) {
            Some((lamp, distance)) => {
                self.picked = Some(lamp);
                Grip::Lamp(lamp, distance)
            }
            None => Grip::View,
        }
    }

    /// Finds the lamp under the pointer, where nothing is held; none where it is over the panel.
    pub fn hover(&mut self, scene: &Scene, aspect: f64, is_panel: bool) {
        if self.grip == Grip::Nothing {
            let lamp = if is_panel { None } else { self.lamp_at(self.pointer, scene, aspect) };
            self.hovered = lamp.map(|(lamp, _)| lamp);
        }
    }

    /// The lamp that is seen at a place, and how far along the view.
    fn lamp_at(&self, at: [f64; 2], scene: &Scene, aspect: f64) -> Option<(usize, f64)> {
        lamps::pick(scene, &self.orbit.camera(), [(at[0] - 0.5) * aspect, at[1] - 0.5])
    }

    /// Moves what is held by a drag in heights of the picture.
    fn drag(&mut self, drag: [f64; 2]) {
        match self.grip {
            Grip::Nothing => {}
            Grip::View => self.orbit.turn(drag),
            Grip::Slide => self.orbit.slide(drag),
            Grip::Divider => self.divider = self.pointer[0].clamp(0.0, 1.0),
            Grip::Lamp(lamp, distance) => self.lamps[lamp].move_by(self.orbit.offset(drag, distance)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f64 = 1.5;

    fn first(glb: &[u8]) -> (Scene, State) {
        let scene = Scene::from_bytes(glb, "scene").unwrap();
        let camera = scene.camera(None, ASPECT).unwrap();
        let state = State::new(&scene, &camera, 0.0, true);
        (scene, state)
    }

    fn shown() -> (Scene, State) {
        first(include_bytes!("../../../../scenes/demo.glb"))
    }

    fn keys(names: &[&str]) -> State {
        let (scene, mut state) = shown();
        for name in names {
            state.apply(Event::Key(name.parse().unwrap()), &scene, ASPECT);
        }
        state
    }

    #[test]
    fn keys_choose_what_is_shown() {
        assert_eq!(keys(&["4"]).level, Level::HalfVectors);
        // Brushed metal begins there
        let (_, brushed) = first(include_bytes!("../../../../scenes/product.glb"));
        assert_eq!((shown().1.level, brushed.level), (Level::Exact, Level::HalfVectors));
        assert!(
            Level::ALL.iter().enumerate().all(|(i, level)| keys(&[&(i + 1).to_string()]).level == *level)
        );
        assert_eq!(keys(&["w"]).mode, Mode::Wipe(Partner::Truth));
        assert_eq!(keys(&["w", "w"]).mode, Mode::Wipe(Partner::Yardstick));
        assert_eq!(keys(&["w", "w", "w"]).mode, Mode::Picture);
        assert_eq!(keys(&["w", "e"]).mode, Mode::Error);
        assert_eq!(keys(&["+", "+", "-"]).exposure, 0.5);
        assert_eq!(keys(&["s"]).shadows, !keys(&[]).shadows);
        assert_eq!((keys(&[]).plays, keys(&["space"]).plays), (true, false));
        assert!(keys(&["h", "p", "escape"]) != keys(&[]));
        let (clear, foggy) = (keys(&[]).fog(), keys(&["f"]).fog().unwrap());
        assert_eq!((clear, keys(&["f", "w", "w"]).fog(), keys(&["f", "f"]).fog()), (None, None, None));
        assert!(keys(&["f", ","]).fog().unwrap().density < foggy.density);
        assert_eq!(keys(&["f", ".", "r"]).fog(), Some(foggy));
        assert_eq!((keys(&["]"]).rougher, keys(&["[", "["]).rougher), (0.05, -0.1));
        assert_eq!(keys(&["]", "left", "+", "r"]), keys(&[]));
        assert!("f13".parse::<Key>().unwrap_err().contains("'f13'") && "7".parse::<Key>().is_err());
    }

    #[test]
    fn a_yardstick_is_offered_where_there_is_one_and_has_no_shadows() {
        let (scene, with) = shown();
        let mut without = State { has_yardstick: false, ..with };
        for expected in [Mode::Wipe(Partner::Truth), Mode::Picture] {
            without.apply(Event::Key(Key::Wipe), &scene, ASPECT);
            assert_eq!(without.mode, expected);
        }
        assert!(keys(&["w"]).has_shadows() && !keys(&["w", "w"]).has_shadows());
    }

    #[test]
    fn a_drag_moves_the_lamp_that_it_begins_on_or_the_view() {
        let (scene, mut state) = shown();
        // Where a lamp is seen
        let camera = state.orbit.camera();
        let seen = |heights: [f64; 2]| lamps::pick(&scene, &camera, heights);
        let places = (0..40 * 40).map(|i| [f64::from(i % 40) / 39.0, f64::from(i / 40) / 39.0]);
        let on = |at: &[f64; 2]| seen([(at[0] - 0.5) * ASPECT, at[1] - 0.5]);
        let (lit, dark): (Vec<_>, Vec<_>) = places.partition(|at| on(at).is_some());
        let (lit, dark) = (lit[0], dark[0]);
        let (lamp, distance) = on(&lit).unwrap();

        state.apply(Event::Press { at: lit, second: false }, &scene, ASPECT);
        state.apply(Event::Move([lit[0] + 0.1, lit[1]]), &scene, ASPECT);
        assert_eq!(state.picked, Some(lamp));
        let expected = camera.right * (0.1 * ASPECT * 2.0 * camera.half_height * distance);
        assert!((state.lamps[lamp].offset - expected).length() < 1e-9);
        assert_eq!(state.orbit, state.home);
        state.apply(Event::Wheel(1.0), &scene, ASPECT);
        assert!((state.lamps[lamp].offset - expected).dot(camera.forward) > 0.0);
        state.apply(Event::Release, &scene, ASPECT);
        let lamps = state.lamps.clone();

        state.apply(Event::Move([0.5, 0.5]), &scene, ASPECT);
        assert_eq!((state.orbit, &state.lamps), (state.home, &lamps), "nothing is held");
        state.hover(&scene, ASPECT, false);
        assert_eq!(state.hovered, on(&[0.5, 0.5]).map(|(lamp, _)| lamp));
        state.apply(Event::Press { at: dark, second: false }, &scene, ASPECT);
        state.apply(Event::Move([dark[0] + 0.1, dark[1]]), &scene, ASPECT);
        assert_eq!(state.lamps, lamps);
        assert_ne!(state.orbit, state.home);
    }

    #[test]
    fn the_line_of_a_wipe_is_dragged() {
        let (scene, _) = shown();
        let mut state = keys(&["w"]);
        state.apply(Event::Press { at: [0.505, 0.9], second: false }, &scene, ASPECT);
        state.apply(Event::Move([0.25, 0.9]), &scene, ASPECT);
        assert_eq!(state.divider, 0.25);
        state.apply(Event::Move([-1.0, 0.9]), &scene, ASPECT);
        assert_eq!(state.divider, 0.0);
    }
}
