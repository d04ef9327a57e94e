//! The panel: every choice as a control, lamps by name, and what the picture costs.

use super::lamps::Edit;
use super::state::{KEYS, Key, Mode, Partner, State};
use super::viewer::Shown;
use crate::means::Distance;
use arealight::Level;
use egui::{Context, Grid, ScrollArea, Slider, Ui, Window};
use std::time::Duration;

impl Shown<'_> {
    /// What a lamp is called.
    pub fn name(&self, lamp: usize) -> String {
        let light = self.scene.lamps.get(lamp).and_then(|lamp| self.scene.lights.get(lamp.lights.start));
        let name = light.map(|light| light.name.clone()).filter(|name| !name.is_empty());
        name.unwrap_or_else(|| format!("lamp {lamp}"))
    }

    /// What there is to say of a picture, in lines.
    pub fn status(&self, state: &State) -> Vec<String> {
        let level = state.level.name();
        let shadows = if state.has_shadows() { "with shadows" } else { "without shadows" };
        let rougher =
            if state.rougher == 0.0 { String::new() } else { format!(", rougher {:+.2}", state.rougher) };
        let fog = state.fog().map_or_else(String::new, |fog| format!(", fog {:.3}", fog.density));
        let mut lines = vec![format!("{level}, {shadows}{fog}{rougher}, exposure {:+.1}", state.exposure)];
        if self.times.iter().any(Option::is_some) {
            let [visibility, shading] = self.times.map(milliseconds);
            lines.push(format!("shading {shading}, visibility {visibility}"));
        }
        if let Some((samples, distance)) = self.truth {
            let off = distance.map_or_else(|| "error not known yet".to_owned(), error);
            lines.push(format!("{off}; {samples} samples of the truth"));
        }
        if !state.panel {
            lines.push("h: panel".to_owned());
        }
        lines
    }
}

/// Shows the panel, and does what is done in it.
pub fn panel(context: &Context, state: &mut State, shown: &Shown<'_>) {
    let height = context.content_rect().height() - 140.0;
    Window::new("Arealight").default_pos([8.0, 8.0]).resizable(false).show(context, |ui| {
        ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
            ui.set_width(232.0);
            ui.spacing_mut().slider_width = 110.0;
            picture(ui, state, shown.scene.has_moving_images());
            ui.separator();
            ui.strong("Lamps");
            list(ui, state, shown);
            if let Some(lamp) = state.picked {
                edit(ui, state, shown, lamp);
            }
            ui.separator();
            ui.small(format!("effects: {}", shown.effects));
            ui.horizontal(|ui| {
                let save = ui.button("Save picture").on_hover_text("and the camera and lamps, for --look");
                state.save |= save.clicked();
                if ui.button("Reset").on_hover_text("lamps, camera, exposure, fog, roughness").clicked() {
                    state.press_key(Key::Reset);
                }
            });
            ui.collapsing("Keys", |ui| {
                Grid::new("keys").num_columns(2).show(ui, |ui| {
                    for (keys, what) in KEYS {
                        ui.monospace(keys);
                        ui.label(what);
                        ui.end_row();
                    }
                });
                ui.label("drag a lamp to move it; the wheel moves it farther");
                ui.label("drag with the second button to slide the view");
            });
        });
    });
}

/// The level, what is shown, and what the whole picture has.
fn picture(ui: &mut Ui, state: &mut State, moves: bool) {
    ui.horizontal_wrapped(|ui| {
        for level in Level::ALL {
            ui.selectable_value(&mut state.level, level, level.name());
        }
    });
    ui.horizontal_wrapped(|ui| {
        let modes = [
            (Mode::Picture, "picture"),
            (Mode::Wipe(Partner::Truth), "wipe: truth"),
            (Mode::Wipe(Partner::Yardstick), "wipe: engines"),
            (Mode::Error, "error map"),
        ];
        for (mode, name) in modes {
            let is_there = mode != Mode::Wipe(Partner::Yardstick) || state.has_yardstick;
            let button = egui::Button::selectable(state.mode == mode, name);
            if ui.add_enabled(is_there, button).clicked() {
                state.mode = mode;
            }
        }
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut state.shadows, "shadows");
        ui.checkbox(&mut state.costs, "costs");
        ui.checkbox(&mut state.is_foggy, "fog");
        if moves {
            ui.checkbox(&mut state.plays, "moves");
        }
    });
    if state.is_foggy {
        let first = state.first_fog.density;
        let densities = 1e-3 * first..=1e3 * first;
        ui.add(Slider::new(&mut state.fog.density, densities).logarithmic(true).text("density"));
    }
    ui.add(
        Slider::new(&mut state.exposure, -10.0..=10.0).clamping(egui::SliderClamping::Edits).text("exposure"),
    );
    ui.add(Slider::new(&mut state.rougher, -1.0..=1.0).text("rougher"));
}

/// The lamps, each with its switch.
fn list(ui: &mut Ui, state: &mut State, shown: &Shown<'_>) {
    ScrollArea::vertical().id_salt("lamps").max_height(104.0).show(ui, |ui| {
        for lamp in 0..state.lamps.len() {
            let row = ui.horizontal(|ui| {
                ui.checkbox(&mut state.lamps[lamp].is_on, "");
                ui.selectable_value(&mut state.picked, Some(lamp), shown.name(lamp))
            });
            if row.inner.hovered() {
                state.hovered = Some(lamp);
            }
        }
    });
}

/// What one lamp is.
fn edit(ui: &mut Ui, state: &mut State, shown: &Shown<'_>, lamp: usize) {
    let step = 2e-3 * shown.scene.bounds.diagonal().max(1e-6);
    let Some(edit) = state.lamps.get_mut(lamp) else { return };
    ui.horizontal(|ui| {
        ui.add(Slider::new(&mut edit.stops, Edit::STOPS).text("stops"));
        ui.color_edit_button_rgb(&mut edit.color);
    });
    ui.add(Slider::new(&mut edit.size, Edit::SIZE).logarithmic(true).text("size"));
    let beam = Slider::new(&mut edit.beam, Edit::BEAM).suffix("°").text("beam");
    ui.add(beam).on_hover_text("of flat lamps: beyond this angle from the front no light goes");
    for ((degrees, range), name) in edit.turn.iter_mut().zip(Edit::TURN).zip(["turn", "tilt"]) {
        ui.add(Slider::new(degrees, range).suffix("°").text(name));
    }
    if state.has_groups {
        let lights = &shown.scene.lamps[lamp].lights;
        let links = shown.scene.lights.get(lights.start).map_or(0, |light| light.links);
        ui.horizontal(|ui| {
            for bit in (0..8).map(|group| 1 << group) {
                if ui.checkbox(&mut (links & bit != 0), "").changed() {
                    edit.links ^= bit;
                }
            }
            ui.label("links").on_hover_text("groups of surfaces that it lights; none: all");
        });
    }
    ui.horizontal(|ui| {
        for side in edit.offset.as_mut() {
            // Within a range nan and inf, which can be typed, are numbers
            ui.add(egui::DragValue::new(side).range(Edit::OFFSET).speed(step).max_decimals(3));
        }
        ui.label("moved");
        if ui.small_button("undo").on_hover_text("this lamp as it was").clicked() {
            *edit = Edit::NONE;
        }
    });
}

/// What levels and effects cost, as far as it is measured.
pub fn table(context: &Context, shown: &Shown<'_>) {
    let corner = egui::Align2::RIGHT_TOP;
    let window = Window::new("Costs").anchor(corner, [-8.0, 8.0]).resizable(false).collapsible(false);
    window.show(context, |ui| {
        Grid::new("costs").num_columns(3).striped(true).show(ui, |ui| {
            for head in ["", "shading", "error"] {
                ui.strong(head);
            }
            ui.end_row();
            for cost in &shown.costs {
                ui.label(&cost.name);
                ui.monospace(
                    cost.milliseconds.map_or_else(|| "-".to_owned(), |time| format!("{time:.1} ms")),
                );
                ui.monospace(percent(cost.distance));
                ui.end_row();
            }
        });
        let [done, all] = shown.measured;
        if done < all {
            ui.add(
                egui::ProgressBar::new(done as f32 / all as f32).text(format!("measured {done} of {all}")),
            );
        }
    });
}

/// An error beside the noise of the truth that it is of.
fn error(distance: Distance) -> String {
    format!("error {}, the truth's noise {:.1} %", percent(Some(distance)), distance.noise * 100.0)
}

/// An error as far as it is known.
fn percent(distance: Option<Distance>) -> String {
    match distance {
        None => "-".to_owned(),
        Some(Distance { error: None, .. }) => "in noise".to_owned(),
        Some(Distance { error: Some(error), .. }) => format!("{:.1} %", error * 100.0),
    }
}

fn milliseconds(time: Option<Duration>) -> String {
    time.map_or_else(|| "time not known".to_owned(), |time| format!("{:.1} ms", time.as_secs_f64() * 1e3))
}
