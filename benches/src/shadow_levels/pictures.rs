//! Pictures of what surfaces reflect, one after the other of the same view.

use arealight_engine::{EngineError, SceneRenderer, ShadowedView};
use glam::{DVec3, Vec4};

/// A view whose radiance is read without what the camera sees of lamps.
pub(crate) struct Pictures<'a> {
    pub renderer: SceneRenderer<'a>,
    emission: Vec<DVec3>,
}

fn colors(texels: Vec<Vec4>) -> Vec<DVec3> {
    texels.into_iter().map(|texel| texel.truncate().as_dvec3()).collect()
}

impl<'a> Pictures<'a> {
    pub fn new(mut renderer: SceneRenderer<'a>) -> Result<Self, EngineError> {
        renderer.visibility()?;
        let emission = colors(renderer.radiance()?);
        Ok(Self { renderer, emission })
    }

    /// As [`Pictures::begin`], for a view that has changed.
    pub fn look_again(&mut self) -> Result<(), EngineError> {
        self.begin()?;
        self.emission = colors(self.renderer.radiance()?);
        Ok(())
    }

    /// Begins a picture: the radiance has nothing yet of what surfaces reflect.
    pub fn begin(&mut self) -> Result<(), EngineError> {
        self.renderer.visibility().map(drop)
    }

    /// What surfaces reflect; black where lamps are seen, which would hide it by their rounding.
    pub fn radiance(&mut self) -> Result<Vec<DVec3>, EngineError> {
        let radiance = colors(self.renderer.radiance()?);
        let reflected = radiance.into_iter().zip(&self.emission);
        Ok(reflected
            .map(|(all, emission)| if *emission == DVec3::ZERO { all } else { DVec3::ZERO })
            .collect())
    }
}

/// The radiance without shadows of the last frame.
pub(crate) fn unshadowed(passes: &ShadowedView) -> Result<Vec<DVec3>, EngineError> {
    Ok(colors(passes.unshadowed()?))
}
