//! What shadows err while things move: of each frame of a film the error beside that frame's own truth.
//!
//! The truth is a mean over many frames of rays as they are: the lobes are the product's own, so that errors
//! are those of rays, filter and history alone, and not of the fit.

mod film;
mod text;

use crate::shadow_levels::PicturesError;
use crate::shadows::{ShadowErrors, ShadowTruth, SizeError};
use arealight::LightTable;
use arealight_engine::Engine;
use arealight_engine::host::Host;
use arealight_scene::Scene;
use arealight_vk::TableFormat;
use film::Film;
use serde::{Deserialize, Serialize};

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Width and height of the pictures.
    pub size: [u32; 2],
    /// Frames of a film.
    pub frames: u32,
    /// Every so many of them is judged, from [`FIRST`] on.
    pub every: u32,
    /// Frames of four rays that a truth is the mean of.
    pub truth: u32,
}

impl Default for Options {
    /// Some four minutes on two processors.
    fn default() -> Self {
        Self { size: [160, 90], frames: 64, every: 4, truth: 64 }
    }
}

/// The first frame that is judged: before it a history is short.
pub const FIRST: u32 = 5;

impl Options {
    /// What progress adds up to over so many scenes.
    pub fn steps(&self, scenes: usize) -> u64 {
        scenes as u64 * Motion::ALL.iter().map(|motion| u64::from(self.frames_of(*motion))).sum::<u64>()
    }

    /// Frames of a film in which something moves.
    fn frames_of(&self, motion: Motion) -> u32 {
        self.frames.div_ceil(motion.speed())
    }

    fn is_judged(&self, motion: Motion, frame: u32) -> bool {
        frame >= FIRST && (frame - FIRST).is_multiple_of(self.every.div_ceil(motion.speed()).max(1))
    }
}

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Motion {
    /// Nothing.
    Rest,
    /// The camera, about the vertical axis through the origin, by 1 degree a frame.
    Camera,
    /// The lights, by 4 cm and 1 degree a frame. What is seen of lamps stays.
    Light,
    /// The lights, along the same way four times as fast, in a quarter of the frames.
    FastLight,
    /// The camera and the lights.
    Both,
}

impl Motion {
    /// Every motion, in the order of the tables.
    pub const ALL: [Self; 5] = [Self::Rest, Self::Camera, Self::Light, Self::FastLight, Self::Both];

    /// A word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Camera => "camera",
            Self::Light => "light",
            Self::FastLight => "fast light",
            Self::Both => "both",
        }
    }

    /// How many times as fast as the others.
    fn speed(self) -> u32 {
        if self == Self::FastLight { 4 } else { 1 }
    }

    fn moves_light(self) -> bool {
        matches!(self, Self::Light | Self::FastLight | Self::Both)
    }

    fn moves_camera(self) -> bool {
        matches!(self, Self::Camera | Self::Both)
    }
}

/// A way to shadows over frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Scheme {
    /// Rays a pixel.
    pub rays: u32,
    /// Whether there is a history, by the camera.
    pub history: bool,
}

impl Scheme {
    /// Every scheme, in the order of the tables; all are filtered.
    pub const ALL: [Self; 4] = [
        Self { rays: 1, history: false },
        Self { rays: 1, history: true },
        Self { rays: 2, history: false },
        Self { rays: 2, history: true },
    ];

    /// As the tables have it.
    pub fn name(self) -> String {
        let history = if self.history { ", history" } else { "" };
        format!("filtered:{}{history}", self.rays)
    }
}

/// The errors of a film: roots of means of squares, without the truth's noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FilmErrors {
    /// What moves.
    pub motion: Motion,
    /// By what.
    pub scheme: Scheme,
    /// Of the judged frames' lit pixels.
    pub rmse: f64,
    /// Of those in a penumbra.
    pub penumbra: f64,
    /// Of the pixels whose surface the frame before did not see; none where there are none.
    pub uncovered: Option<f64>,
    /// Of the frame with the largest error, over its lit pixels.
    pub worst: f64,
    /// How many frames the shadows are behind, where the light alone moves: what is found is the truth and so
    /// much of the way back to that of the frame before, by least squares over lit pixels.
    pub lag: Option<f64>,
    /// Results that are NaN or infinite.
    pub not_finite: usize,
}

/// The films of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneFilms {
    /// The scene.
    pub name: String,
    /// A film for each motion and scheme.
    pub films: Vec<FilmErrors>,
    /// The noise of a truth, over lit pixels, that was taken out of the squares.
    pub noise: f64,
}

impl SceneFilms {
    /// The film of a motion and a scheme.
    pub fn find(&self, motion: Motion, scheme: Scheme) -> Option<&FilmErrors> {
        self.films.iter().find(|film| film.motion == motion && film.scheme == scheme)
    }
}

/// What a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShadowMotion {
    /// The device.
    pub device: String,
    /// [`Options::size`].
    pub size: [u32; 2],
    /// [`Options::frames`].
    pub frames: u32,
    /// How many of them were judged.
    pub judged: usize,
    /// Each scene.
    pub scenes: Vec<SceneFilms>,
}

/// Runs every scheme over films of each scene. `progress` is told of frames done.
pub fn run(
    host: &Host,
    table: &LightTable,
    scenes: &[Scene],
    options: &Options,
    progress: &dyn Fn(u64),
) -> Result<ShadowMotion, PicturesError> {
    let engine = Engine::new(host.clone(), table, TableFormat::default())?;
    let run_scene = |scene: &Scene| -> Result<SceneFilms, PicturesError> {
        let (mut films, mut noise) = (vec![], (0.0, 0));
        for motion in Motion::ALL {
            let mut sums = [Sums::default(); Scheme::ALL.len()];
            let mut film = Film::new(&engine, scene, motion, options)?;
            let mut before = None;
            for frame in 0..options.frames_of(motion) {
                film.advance(frame)?;
                let is_judged = options.is_judged(motion, frame);
                let truth = if is_judged { Some(film.truth(options.truth)?) } else { None };
                for (place, sums) in sums.iter_mut().enumerate() {
                    let found = film.shadows(place, frame)?;
                    if let Some(truth) = &truth {
                        sums.add(truth, &found, film.uncovered())?;
                        if let Some(before) = &before {
                            sums.add_lag(before, truth, &found);
                        }
                    }
                }
                before = None;
                let moves_light_alone = motion.moves_light() && !motion.moves_camera();
                if moves_light_alone && options.is_judged(motion, frame + 1) {
                    before = Some(film.truth(options.truth)?);
                }
                if let Some(truth) = &truth {
                    let errors = truth.errors(&truth.half)?;
                    noise.0 += errors.rmse.powi(2) * errors.lit as f64;
                    noise.1 += errors.lit;
                }
                progress(1);
            }
            films.extend(Scheme::ALL.iter().zip(sums).map(|(scheme, sums)| sums.errors(motion, *scheme)));
        }
        Ok(SceneFilms { name: scene.name.clone(), films, noise: root(noise) })
    };
    Ok(ShadowMotion {
        device: host.device_name(),
        size: options.size,
        frames: options.frames,
        judged: (0..options.frames).filter(|frame| options.is_judged(Motion::Rest, *frame)).count(),
        scenes: scenes.iter().map(run_scene).collect::<Result<_, _>>()?,
    })
}

/// The truth of a frame.
struct FrameTruth {
    mean: ShadowTruth,
    /// The means of its first half: from the whole they are as far as the whole is from what is right.
    half: Vec<f64>,
}

impl FrameTruth {
    fn errors(&self, parts: &[f64]) -> Result<ShadowErrors, SizeError> {
        self.mean.errors(parts, &self.mean.radiance)
    }
}

/// Sums over the frames of a film: of squares of errors and how many they are.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    all: (f64, usize),
    penumbra: (f64, usize),
    uncovered: (f64, usize),
    worst: f64,
    /// Products of what was found beyond the truth with the way back to the truth before, and of that way
    /// with itself.
    lag: [f64; 2],
    not_finite: usize,
}

fn root((square, count): (f64, usize)) -> f64 {
    (square.max(0.0) / count.max(1) as f64).sqrt()
}

impl Sums {
    /// Adds a frame, less its truth's noise.
    fn add(&mut self, truth: &FrameTruth, found: &[f64], uncovered: &[bool]) -> Result<(), PicturesError> {
        let (errors, noise) = (truth.errors(found)?, truth.errors(&truth.half)?);
        let rest = |error: f64, noise: f64| error * error - noise * noise;
        let all = rest(errors.rmse, noise.rmse);
        self.worst = self.worst.max(all.max(0.0).sqrt());
        self.all.0 += all * errors.lit as f64;
        self.all.1 += errors.lit;
        self.penumbra.0 += rest(errors.penumbra_rmse, noise.penumbra_rmse) * errors.penumbra as f64;
        self.penumbra.1 += errors.penumbra;
        self.not_finite += errors.not_finite;
        let pixels = truth.mean.parts.iter().zip(found.iter().zip(&truth.half)).zip(uncovered);
        for ((part, (found, half)), uncovered) in pixels {
            if let (Some(part), true) = (part, uncovered) {
                self.uncovered.0 += rest(found - part, half - part);
                self.uncovered.1 += 1;
            }
        }
        Ok(())
    }

    /// Adds what a frame is behind. Halves of either truth are multiplied with each other alone, so that
    /// their noise is in no product.
    fn add_lag(&mut self, before: &FrameTruth, truth: &FrameTruth, found: &[f64]) {
        let halves = |truth: &FrameTruth, pixel: usize| {
            let whole = truth.mean.parts.get(pixel).copied().flatten()?;
            let first = *truth.half.get(pixel)?;
            Some([first, 2.0 * whole - first])
        };
        for (pixel, found) in found.iter().enumerate().filter(|(_, found)| found.is_finite()) {
            if let (Some(now), Some(then)) = (halves(truth, pixel), halves(before, pixel)) {
                let back = [then[0] - now[0], then[1] - now[1]];
                self.lag[0] += 0.5 * ((found - now[0]) * back[1] + (found - now[1]) * back[0]);
                self.lag[1] += back[0] * back[1];
            }
        }
    }

    fn errors(self, motion: Motion, scheme: Scheme) -> FilmErrors {
        FilmErrors {
            motion,
            scheme,
            rmse: root(self.all),
            penumbra: root(self.penumbra),
            uncovered: (self.uncovered.1 > 0).then(|| root(self.uncovered)),
            worst: self.worst,
            lag: (self.lag[1] > 0.0).then(|| self.lag[0] / self.lag[1]),
            not_finite: self.not_finite,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A truth with a step of shadow from left to right, begun at a pixel, and noise that its halves do not
    /// share.
    fn truth(begin: f64, seed: usize) -> FrameTruth {
        let part = |i: usize| ((i as f64 - begin) / 20.0).clamp(0.0, 1.0);
        let mut random = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed as u64 + 1);
        let mut noise = || {
            random = random.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            ((random >> 33) % 1000) as f64 * 4e-5 - 0.02
        };
        let half: Vec<f64> = (0..400).map(|i| part(i) + noise()).collect();
        let parts = (0..400).map(|i| Some(0.5 * (half[i] + part(i) + noise()))).collect();
        FrameTruth { mean: ShadowTruth { parts, radiance: vec![] }, half }
    }

    #[test]
    fn shadows_that_are_behind_are_found_to_be() {
        // The edge moves by two pixels a frame
        let found = |begin: f64| -> Vec<f64> {
            (0..400).map(|i| ((f64::from(i) - begin) / 20.0).clamp(0.0, 1.0)).collect()
        };
        for lag in [0.0, 0.5, 1.0] {
            let mut sums = Sums::default();
            sums.add_lag(&truth(198.0, 1), &truth(200.0, 2), &found(200.0 - 2.0 * lag));
            let measured = sums.errors(Motion::Light, Scheme::ALL[0]).lag.unwrap();
            // The truths' noise averages out to so much over this edge; squared it would add a quarter
            assert!((measured - lag).abs() < 0.08, "{lag}: {measured}");
        }
    }
}
