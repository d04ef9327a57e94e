//! What a run found, as text and as Markdown.

use super::{FIRST, FilmErrors, Motion, SceneFilms, Scheme, ShadowMotion};
use crate::table::Table;
use std::fmt::Write as _;

/// What the tables' columns are.
const MEASURES: &str = "Errors of *S* times 100: the root of the mean square over lit pixels of the judged \
frames; over those in a penumbra; over those whose surface the frame before did not see; and of the worst \
frame. The lag is how many frames shadows are behind, where the light alone moves. The truth of each frame \
is the mean of many frames of four rays as they are, with the same lobes; its noise, known from its halves, \
is taken out of the squares. At `camera` the camera goes about the scene by 1 degree a frame, at `light` the \
light moves by 4 cm and turns by 1 degree a frame, at `both` they do so at once. At `fast light` the light \
goes the same way four times as fast, in a quarter of the frames.";

fn cells(film: &FilmErrors) -> Vec<String> {
    let number = |error: f64| format!("{:.2}", 100.0 * error);
    vec![
        format!("{}, {}", film.motion.name(), film.scheme.name()),
        number(film.rmse),
        number(film.penumbra),
        film.uncovered.map_or_else(String::new, number),
        number(film.worst),
        film.lag.map_or_else(String::new, |lag| format!("{lag:.2}")),
    ]
}

impl SceneFilms {
    fn table(&self) -> Table {
        let heads = "motion, level | S, RMSE x 100 | in penumbra | uncovered | worst frame | \
            lag, frames";
        let order = Motion::ALL.iter().flat_map(|motion| Scheme::ALL.map(|scheme| (*motion, scheme)));
        Table::new(heads, order.filter_map(|(motion, scheme)| self.find(motion, scheme)).map(cells))
    }
}

impl ShadowMotion {
    fn how(&self) -> String {
        let Self { size: [width, height], frames, judged, .. } = self;
        let noise: Vec<String> =
            self.scenes.iter().map(|scene| format!("{:.2}", 100.0 * scene.noise)).collect();
        format!(
            "Films of {frames} frames of {width} x {height} pixels, of which {judged} were judged, from \
            frame {FIRST} on. The noise of the truths was {}.",
            noise.join(", ")
        )
    }

    /// Tables for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for scene in &self.scenes {
            let _ = write!(text, "{}\n{}\n", scene.name, scene.table().to_text());
        }
        text + &self.how() + "\n"
    }

    /// A section of a document. `command` is what made it.
    pub fn to_markdown(&self, command: &str) -> String {
        let mut text = format!("Made by `{command}` on {}. {}\n\n{MEASURES}\n", self.device, self.how());
        for scene in &self.scenes {
            let _ = write!(text, "\n### {}, in motion\n\n{}", scene.name, scene.table().to_markdown());
        }
        text
    }
}
