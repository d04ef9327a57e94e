//! What of a case can be answered: its light relative to its point, its surface, its image.

use super::{Case, CaseMaterial, SupportedCase};
use arealight::{Light, LightShape};
use arealight_oracle::material::Surface;
use arealight_oracle::shading::{RelativeLight, textured_ellipse};
use arealight_oracle::texture::Texture;
use glam::{DAffine3, DVec3};
use std::sync::Arc;

impl Case {
    /// The case as something that can be answered now.
    ///
    /// `load` gives the image of a path beside the file of cases, linear, or says why it cannot; it is called
    /// for every case that has one, so it should keep what it has loaded.
    ///
    /// # Errors
    /// Why it cannot be, in words.
    pub fn supported(
        &self,
        load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<SupportedCase, String> {
        if let Some(field) = self.unknown_fields.first() {
            return Err(format!("the field {field}"));
        }
        let (surface, medium) = match self.material {
            CaseMaterial::Medium { anisotropy } => (Surface::default(), Some(anisotropy)),
            _ => (self.material.surface(self.tangent)?, None),
        };
        let (light, image) = self.relative_light(load)?;
        if !self.blockers.is_empty() && !matches!(light.shape, LightShape::Polygon(_)) {
            return Err("occluders: before a light that is no polygon".into());
        }
        Ok(SupportedCase {
            name: self.name.clone(),
            surface,
            normal: self.normal,
            medium,
            view: self.view,
            light,
            radiance: self.radiance,
            image,
            blockers: self.blockers.iter().map(|blocker| blocker.map(|v| v - self.position)).collect(),
        })
    }

    /// The light relative to the point, or the polygon that [stands](Light::outlined) for it, with its image.
    fn relative_light(
        &self,
        mut load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<(Light, Option<Arc<Texture>>), String> {
        let load = |path: &String| load(path).map_err(|reason| format!("light.texture: {path}: {reason}"));
        let image = self.image.as_ref().map(load).transpose()?;
        let light = self.light.moved(&DAffine3::from_translation(-self.position));
        light.validate().map_err(|fault| format!("light.{fault}"))?;
        Ok((light.outlined().into_owned(), image))
    }
}

impl SupportedCase {
    /// The light with its image, if it is a polygon or one stands for it.
    pub fn polygon(&self) -> Option<RelativeLight> {
        let relative = match (&self.image, &self.light.shape) {
            (None, LightShape::Polygon(_)) => Some(RelativeLight::new(&self.light, DVec3::ZERO)),
            (None, _) => None,
            (Some(image), LightShape::Disk { .. }) => textured_ellipse(&self.light, Arc::clone(image)),
            (Some(image), _) => RelativeLight::textured(&self.light, DVec3::ZERO, Arc::clone(image)).ok(),
        };
        relative.map(|light| RelativeLight { radiance: self.radiance, ..light })
    }
}
