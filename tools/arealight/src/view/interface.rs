//! What is drawn over the picture, by egui on the CPU: the panel, and what labels the picture. It takes the
//! events that are the panel's, in a window and in a recording alike.

use super::lamps;
use super::paint::BAR;
use super::panel::{panel, table};
use super::state::{Event, Mode, Partner, State};
use super::viewer::Shown;
use crate::canvas::Canvas;
use egui::{Align2, Color32, Context, FontId, LayerId, Painter, Pos2, Rect, Stroke, Vec2};
use egui_software_backend::{BufferMutRef, ColorFieldOrder, EguiSoftwareRender};

/// A window's place follows from its size, that from its columns, and theirs from what is in them.
const PASSES: usize = 3;

/// The panel's state, and what draws it.
pub struct Interface {
    context: Context,
    renderer: EguiSoftwareRender,
    /// Since the last frame.
    events: Vec<egui::Event>,
    /// Where the pointer is.
    pointer: Pos2,
    /// A button of the pointer went down on the panel, and is not up again.
    holds: bool,
    /// The panel changes by itself.
    goes_on: bool,
    /// Whether the panel was shown, which lamp it had, and how many rows the table of costs had.
    open: (bool, Option<usize>, Option<usize>),
}

impl Interface {
    /// With so many pixels for one of the panel's.
    pub fn new(scale: f32) -> Self {
        let context = Context::default();
        context.set_zoom_factor(scale);
        context.options_mut(|options| options.max_passes = PASSES.try_into().unwrap_or(options.max_passes));
        context.style_mut(|style| {
            // What is recorded does not depend on time
            style.animation_time = 0.0;
            style.visuals = egui::Visuals::dark();
            style.visuals.window_fill = Color32::from_black_alpha(215);
            style.visuals.window_shadow = egui::Shadow::NONE;
        });
        let renderer = EguiSoftwareRender::new(ColorFieldOrder::Rgba).with_caching(false);
        Self {
            context,
            renderer,
            events: vec![],
            pointer: Pos2::ZERO,
            holds: false,
            goes_on: false,
            open: (false, None, None),
        }
    }

    /// Takes an event for the panel: whether it is the panel's alone. `size` is the picture's, in pixels.
    pub fn takes(&mut self, event: &Event, size: [u32; 2]) -> bool {
        if let Event::Press { at, .. } | Event::Move(at) = *event {
            let pixels = Vec2::new(at[0] as f32 * size[0] as f32, at[1] as f32 * size[1] as f32);
            self.pointer = (pixels / self.context.zoom_factor()).to_pos2();
            self.events.push(egui::Event::PointerMoved(self.pointer));
        }
        let (pos, modifiers) = (self.pointer, egui::Modifiers::NONE);
        let is_panel = self.context.layer_id_at(pos).is_some_and(is_panel);
        let mut press = |second, pressed| {
            let button = if second { egui::PointerButton::Secondary } else { egui::PointerButton::Primary };
            self.events.push(egui::Event::PointerButton { pos, button, pressed, modifiers });
        };
        match *event {
            Event::Key(_) => self.has_keyboard(),
            Event::Press { second, .. } => {
                press(second, true);
                self.holds = is_panel;
                is_panel
            }
            Event::Move(_) => self.holds || is_panel,
            Event::Release => {
                press(false, false);
                press(true, false);
                std::mem::take(&mut self.holds)
            }
            Event::Wheel(steps) => {
                let (unit, delta) = (egui::MouseWheelUnit::Line, Vec2::new(0.0, steps as f32));
                self.events.push(egui::Event::MouseWheel { unit, delta, modifiers });
                is_panel
            }
        }
    }

    /// Whether something was done since the last frame.
    pub fn is_asked(&self) -> bool {
        !self.events.is_empty()
    }

    /// Whether a number of the panel is being typed.
    pub fn has_keyboard(&self) -> bool {
        self.context.wants_keyboard_input()
    }

    /// What is typed into it: a key that means something there, or a text.
    pub fn type_in(&mut self, key: Option<egui::Key>, text: Option<&str>) {
        let modifiers = egui::Modifiers::NONE;
        self.events.extend(match (key, text) {
            (Some(key), _) => {
                Some(egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers })
            }
            (None, text) => text.map(|text| egui::Event::Text(text.to_owned())),
        });
    }

    /// Whether the next frame differs, although nobody does anything.
    pub fn goes_on(&self) -> bool {
        self.goes_on
    }

    /// Draws it over a picture, and does to the state what was done in the panel.
    pub fn draw(&mut self, canvas: &mut Canvas, state: &mut State, shown: &Shown<'_>) {
        let size = canvas.size();
        let scale = self.context.zoom_factor();
        let screen = Vec2::new(size[0] as f32, size[1] as f32) / scale;
        if self.is_asked() {
            // Once a frame, not once an event: it looks at every triangle
            let is_panel = self.context.layer_id_at(self.pointer).is_some_and(is_panel);
            state.hover(shown.scene, f64::from(screen.x / screen.y), is_panel);
        }
        let input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, screen)),
            events: std::mem::take(&mut self.events),
            ..egui::RawInput::default()
        };
        let open = (state.panel, state.picked, state.costs.then_some(shown.costs.len()));
        let opens = std::mem::replace(&mut self.open, open) != open;
        let output = self.context.run(input, |context| {
            if opens && context.current_pass_index() + 1 < PASSES {
                context.request_discard("a window opens");
            }
            let painter = context.layer_painter(LayerId::background());
            label(&painter, state, shown, screen);
            if state.panel {
                panel(context, state, shown);
            }
            if state.costs {
                table(context, shown);
            }
        });
        let repaint = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min();
        self.goes_on = repaint.is_some_and(|delay| delay.is_zero());
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        let mut pixels: Vec<[u8; 4]> =
            canvas.bytes().chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect();
        let mut target = BufferMutRef::new(&mut pixels, size[0] as usize, size[1] as usize);
        self.renderer.render(&mut target, &shapes, &output.textures_delta, output.pixels_per_point);
        let bytes = pixels.iter().flat_map(|&[red, green, blue, _]| [red, green, blue]).collect();
        *canvas = Canvas::of_pixels(size[0], size[1], bytes);
    }
}

/// Whether a layer is of the panel or the table, not of what labels the picture.
fn is_panel(layer: LayerId) -> bool {
    layer.order != egui::Order::Background
}

/// What is left free about text.
const MARGIN: f32 = 8.0;

/// Names what is in the picture: the lamps that are held, the sides of a wipe, the map's colours, what the
/// picture is.
fn label(painter: &Painter, state: &State, shown: &Shown<'_>, screen: Vec2) {
    let middle = Pos2::new(0.5 * screen.x, 0.5 * screen.y);
    let camera = state.orbit.camera();
    for lamp in 0..shown.scene.lamps.len() {
        let is_held = state.hovered == Some(lamp) || state.panel && state.picked == Some(lamp);
        if !is_held && state.mode != Mode::Error {
            continue;
        }
        if let Some(corners) = lamps::seen(shown.scene, &camera, lamp) {
            let [low, high] =
                corners.map(|[x, y]| middle + Vec2::new(x as f32 * screen.y, y as f32 * screen.y));
            let about = Rect::from_min_max(low, high).expand(3.0);
            let color = if is_held { Color32::from_rgb(255, 190, 60) } else { Color32::GRAY };
            let stroke = Stroke::new(1.5, color);
            painter.rect_stroke(about, 2.0, stroke, egui::StrokeKind::Outside);
            if is_held {
                text(painter, about.left_bottom() + Vec2::new(0.0, 4.0), Align2::LEFT_TOP, &shown.name(lamp));
            }
        }
    }
    if let Mode::Wipe(partner) = state.mode {
        let other = match (partner, shown.truth) {
            (Partner::Yardstick, _) => shown.yardstick.to_owned(),
            (Partner::Truth, Some((samples, _))) => format!("truth, {samples} samples"),
            (Partner::Truth, None) => "truth".to_owned(),
        };
        let line = Pos2::new(state.divider as f32 * screen.x, MARGIN);
        text(painter, line - Vec2::new(MARGIN, 0.0), Align2::RIGHT_TOP, "Arealight");
        text(painter, line + Vec2::new(MARGIN, 0.0), Align2::LEFT_TOP, &other);
    }
    if state.mode == Mode::Error {
        let scale = painter.ctx().zoom_factor();
        let above = (BAR[1] + BAR[2]) as f32 / scale + 4.0;
        let corner = Pos2::new(screen.x - BAR[2] as f32 / scale, screen.y - above);
        text(painter, corner, Align2::RIGHT_BOTTOM, "difference, 0.1 % to 100 % of the mean");
    }
    let mut below = Pos2::new(MARGIN, screen.y - MARGIN);
    for line in shown.status(state).iter().rev() {
        below.y = text(painter, below, Align2::LEFT_BOTTOM, line).top() - 4.0;
    }
}

/// Writes a line on a dark ground: where it is.
fn text(painter: &Painter, at: Pos2, align: Align2, line: &str) -> Rect {
    let ink = Color32::from_rgb(240, 242, 246);
    let galley = painter.layout_no_wrap(line.to_owned(), FontId::proportional(13.0), ink);
    let place = align.anchor_size(at, galley.size());
    painter.rect_filled(place.expand(3.0), 2.0, Color32::from_black_alpha(170));
    painter.galley(place.min, galley, ink);
    place
}

#[cfg(test)]
mod tests {
    use super::*;
    use arealight::Effects;
    use arealight_scene::Scene;
    use glam::DVec3;
    use std::time::Duration;

    const SIZE: [u32; 2] = [640, 520];

    struct Desk {
        scene: Scene,
        state: State,
        interface: Interface,
    }

    fn desk() -> Desk {
        let scene = Scene::from_bytes(include_bytes!("../../../../scenes/demo.glb"), "demo").unwrap();
        let camera = scene.camera(None, 1.6).unwrap();
        let state = State::new(&scene, &camera, 0.0, true);
        Desk { scene, state, interface: Interface::new(1.0) }
    }

    impl Desk {
        fn draw(&mut self, milliseconds: Option<u64>) -> Vec<u8> {
            let pixels = (SIZE[0] * SIZE[1]) as usize;
            let (ours, emission) = (vec![DVec3::splat(0.2); pixels], vec![DVec3::ZERO; pixels]);
            let shown = Shown {
                scene: &self.scene,
                size: SIZE,
                ours: &ours,
                other: None,
                emission: &emission,
                times: [None, milliseconds.map(Duration::from_millis)],
                effects: Effects::DIFFUSE,
                truth: None,
                yardstick: "yardstick",
                costs: vec![],
                measured: [2, 9],
            };
            let mut canvas = Canvas::new(SIZE[0], SIZE[1], [60; 3]);
            self.interface.draw(&mut canvas, &mut self.state, &shown);
            canvas.bytes().to_vec()
        }

        fn press(&mut self, at: [f64; 2]) -> bool {
            let events = [Event::Move(at), Event::Press { at, second: false }, Event::Release];
            let taken = events.map(|event| self.interface.takes(&event, SIZE));
            assert_eq!(taken[0], taken[1]);
            taken[1]
        }
    }

    /// How many bytes of the upper left quarter, where the panel is, are not the picture's.
    fn covered(pixels: &[u8]) -> usize {
        let row = 3 * SIZE[0] as usize;
        let rows = pixels.chunks_exact(row).take(SIZE[1] as usize / 2);
        rows.flat_map(|row| &row[..row.len() / 2]).filter(|byte| **byte != 60).count()
    }

    #[test]
    fn the_panel_covers_the_picture_where_it_is_asked_for_and_takes_what_is_done_there() {
        let mut desk = desk();
        let on = [0.1, 0.1];
        assert_eq!(covered(&desk.draw(None)), 0);
        assert!(!desk.press(on), "there is none");
        desk.state.panel = true;
        let shown = desk.draw(None);
        assert!(covered(&shown) > shown.len() / 20);
        // Legible: light letters on a dark ground
        assert!(shown.iter().any(|byte| *byte > 200) && shown.iter().any(|byte| *byte < 20));
        assert!(desk.press(on) && !desk.press([0.9, 0.9]));
        desk.state.panel = false;
        assert_eq!(covered(&desk.draw(None)), 0);
    }

    /// Somewhere in the panel each choice is: a search by clicks.
    #[test]
    fn a_click_in_the_panel_chooses() {
        let mut desk = desk();
        desk.state.panel = true;
        let first = desk.state.clone();
        let mut found: Vec<State> = vec![];
        // Below the title, which folds it
        for at in (0..36 * 9).map(|i| [f64::from(i % 9) * 0.04, 0.1 + f64::from(i / 9) * 0.025]) {
            desk.state = first.clone();
            desk.draw(None);
            desk.press(at);
            desk.draw(None);
            found.push(desk.state.clone());
        }
        let changes = |chosen: fn(&State) -> bool| found.iter().any(chosen);
        assert!(changes(|state| state.level == arealight::Level::TwoLobes));
        assert!(changes(|state| !state.shadows));
        assert!(changes(|state| state.mode == Mode::Wipe(Partner::Truth)));
        assert!(changes(|state| state.lamps.iter().any(|lamp| !lamp.is_on)));
        assert!(changes(|state| state.picked.is_some()));
        assert!(changes(|state| state.save));
        assert!(!changes(|state| state.quit), "the twin: nothing in it quits");
    }

    /// What is recorded shows no times, and is the same on a busy machine.
    #[test]
    fn a_frame_without_times_says_nothing_of_them() {
        let mut desk = desk();
        let [fast, slow, none, again] = [Some(3), Some(4), None, None].map(|time| desk.draw(time));
        assert!(fast != slow && fast != none);
        assert_eq!(none, again);
    }
}
