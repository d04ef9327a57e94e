//! What each level costs in a view, and every effect but one: one is tried a frame.

use super::viewer::{Seen, Viewer, radiance};
use crate::means::{Distance, Means};
use arealight::{Effects, Level, Quality};
use arealight_engine::EngineError;
use glam::DVec3;
use std::time::Duration;

/// What a level, or every effect but one, was found to take.
pub(super) struct Tried {
    name: String,
    milliseconds: Option<f64>,
    radiance: Vec<DVec3>,
}

/// What a level costs, or every effect but one.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// The level's name, or "without" and the effect's.
    pub name: String,
    /// Milliseconds of shading.
    pub milliseconds: Option<f64>,
    /// How far it is from the truth.
    pub distance: Option<Distance>,
}

/// Runs whose fastest is a cost.
const COST_RUNS: usize = 3;

impl Viewer<'_> {
    /// What is tried for costs: each level, and every effect but one.
    fn trials(&self) -> Vec<(String, Effects, Quality)> {
        let surfaces = self.scene().surfaces();
        let levels = Level::ALL.map(|level| (level.name().to_owned(), surfaces, level.quality()));
        let others = (surfaces - Effects::MODEL).iter().filter_map(|effect| {
            let left = without(surfaces, effect);
            let is_lit = left.intersects(Effects::DIFFUSE | Effects::GLOSSY);
            is_lit.then(|| (format!("without {effect}"), left, Quality::default()))
        });
        levels.into_iter().chain(others).collect()
    }

    /// Shades as the next of the trials says.
    pub(super) fn try_next(&mut self, seen: &Seen) -> Result<(), EngineError> {
        let mut tried = match self.tried.take() {
            Some((of, tried)) if of == *seen => tried,
            _ => vec![],
        };
        if let Some((name, surfaces, quality)) = self.trials().into_iter().nth(tried.len()) {
            tried.push(self.try_shading(name, surfaces, quality)?);
        }
        self.tried = Some((seen.clone(), tried));
        Ok(())
    }

    /// How many trials were made for the costs, and how many there are.
    pub fn measured(&self) -> [usize; 2] {
        [self.tried.as_ref().map_or(0, |(_, tried)| tried.len()), self.trials().len()]
    }

    fn try_shading(
        &mut self,
        name: String,
        surfaces: Effects,
        quality: Quality,
    ) -> Result<Tried, EngineError> {
        let mut fastest: Option<Duration> = None;
        for _ in 0..COST_RUNS {
            self.begin()?;
            let took = self.renderer.shade(surfaces, quality)?;
            fastest = fastest.into_iter().chain(took).min();
        }
        let milliseconds = fastest.map(|time| time.as_secs_f64() * 1e3);
        Ok(Tried { name, milliseconds, radiance: radiance(&mut self.renderer)? })
    }

    /// What was tried of a view, by the truth as far as it is known.
    pub(super) fn costs(&self, seen: &Seen, truth: Option<&Means>) -> Vec<Cost> {
        let tried = self.tried.as_ref().filter(|(of, _)| of == seen);
        let cost = |tried: &Tried| Cost {
            name: tried.name.clone(),
            milliseconds: tried.milliseconds,
            distance: truth.and_then(|truth| truth.distance(&tried.radiance, |i| self.is_lit(i))),
        };
        tried.into_iter().flat_map(|(_, tried)| tried).map(cost).collect()
    }
}

/// The set without an effect, and without those that need it.
fn without(surfaces: Effects, effect: Effects) -> Effects {
    let dependent = match effect {
        Effects::DIFFUSE => Effects::DIFFUSE_ROUGHNESS | Effects::COUPLED | Effects::COUPLED_BY_ALBEDO,
        Effects::GLOSSY => {
            Effects::SPECULAR_INPUT
                | Effects::ANISOTROPY
                | Effects::COUPLED
                | Effects::COUPLED_BY_ALBEDO
                | Effects::MULTIPLE_SCATTERING
                | Effects::THIN_FILM
        }
        Effects::COAT => Effects::COAT_NORMAL | Effects::COAT_BY_ALBEDO,
        _ => Effects::empty(),
    };
    surfaces - effect - dependent
}
