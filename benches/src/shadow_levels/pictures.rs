//! Pictures of what surfaces reflect, one after the other of the same view.

use crate::shadows::SizeError;
use arealight_engine::{Engine, EngineError, SceneRenderer, ShadowedView};
use arealight_scene::{Camera, Scene, SceneBuffers};
use glam::{DVec3, Vec3, Vec4};

/// Why there are no pictures of a scene, or none that compare.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PicturesError {
    /// The device, or a scene that does not fit it.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Pictures of different sizes.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A scene without a camera and without anything to frame.
    #[error("{scene}: nothing to see")]
    NoCamera {
        /// Its name.
        scene: String,
    },
}

/// A view whose radiance is read without what the camera sees of lamps.
pub(crate) struct Pictures<'a> {
    pub renderer: SceneRenderer<'a>,
    emission: Vec<DVec3>,
}

fn colors(texels: Vec<Vec4>) -> Vec<DVec3> {
    texels.into_iter().map(|texel| texel.truncate().as_dvec3()).collect()
}

impl<'a> Pictures<'a> {
    /// Of a scene by its first camera, with what is on the device of it.
    pub fn new(
        engine: &'a Engine,
        scene: &Scene,
        size: [u32; 2],
    ) -> Result<(Self, SceneBuffers, Camera), PicturesError> {
        let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
        let camera = scene
            .camera(None, aspect)
            .ok_or_else(|| PicturesError::NoCamera { scene: scene.name.clone() })?;
        let buffers = SceneBuffers::new(scene, camera.position).map_err(EngineError::from)?;
        let constants = buffers.constants(&camera, size, Vec3::ZERO);
        let renderer = SceneRenderer::new(engine, &buffers, &scene.lights, constants, size)?;
        let mut pictures = Self { renderer, emission: vec![] };
        pictures.look_again()?;
        Ok((pictures, buffers, camera))
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
