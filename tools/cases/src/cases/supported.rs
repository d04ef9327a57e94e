//! What of a case can be answered: its light relative to its point, its surface, its image.

use super::{
    Case, CaseLight, CaseMaterial, CaseShape, CaseTexture, MediumCase, ShapeCase, SupportedCase, Unsupported,
};
use arealight::{Light, LightFault, LightShape, LightTexture, TubeEnds};
use arealight_oracle::shading::RelativeLight;
use arealight_oracle::texture::Texture;
use glam::{DAffine3, DVec3};
use std::borrow::Cow;
use std::sync::Arc;

/// Lights, lobes and fields that can be answered.
impl Case {
    /// The case as something that can be answered now: a surface of its lobes under a polygon. See
    /// [`Case::supported_shape`] for other lights.
    ///
    /// `load` gives the image of a path beside the file of cases, linear, or says why it cannot; it is called
    /// for every case that has one, so it should keep what it has loaded.
    ///
    /// # Errors
    /// [`Unsupported`] with the reason, in words.
    pub fn supported(
        &self,
        load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<SupportedCase, Unsupported> {
        let shape = &self.light.shape;
        if !matches!(shape, CaseShape::Polygon { .. }) {
            let reason = format!("light.type \"{}\" is no polygon", shape.name());
            return Err(Unsupported { reason });
        }
        let (light, image) = self.relative_light(load)?;
        let relative = match image {
            Some(image) => RelativeLight::textured(&light, DVec3::ZERO, image).map_err(of_light)?,
            None => RelativeLight::new(&light, DVec3::ZERO),
        };
        Ok(SupportedCase {
            name: self.name.clone(),
            surface: self.material.surface(self.tangent)?,
            normal: self.normal,
            view: self.view,
            light: RelativeLight { radiance: self.light.radiance, ..relative },
            blockers: self.blockers.iter().map(|blocker| blocker.map(|v| v - self.position)).collect(),
        })
    }

    /// The case as [`Case::supported`] has it, if its light is a disk, a sphere or a cylinder. `load` is as
    /// it is there.
    ///
    /// # Errors
    /// [`Unsupported`] with the reason, in words.
    pub fn supported_shape(
        &self,
        load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<ShapeCase, Unsupported> {
        if matches!(self.light.shape, CaseShape::Polygon { .. }) {
            return Err(Unsupported { reason: "the light is a polygon".into() });
        }
        let (light, image) = self.unblocked_light(load)?;
        Ok(ShapeCase {
            name: self.name.clone(),
            surface: self.material.surface(self.tangent)?,
            normal: self.normal,
            view: self.view,
            light,
            image,
        })
    }

    /// The case as [`Case::supported`] has it, if its point is in a medium. `load` is as it is there.
    ///
    /// # Errors
    /// [`Unsupported`] with the reason, in words.
    pub fn supported_medium(
        &self,
        load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<MediumCase, Unsupported> {
        let CaseMaterial::Medium { anisotropy } = self.material else {
            return Err(Unsupported { reason: "the point is on a surface".into() });
        };
        let (light, image) = self.unblocked_light(load)?;
        Ok(MediumCase { name: self.name.clone(), anisotropy, view: self.view, light, image })
    }

    /// The case with the polygon that stands for its light, if that is a disk with a profile or an opening:
    /// [`Light::outlined`].
    pub fn outlined(&self) -> Cow<'_, Self> {
        let CaseShape::Disk { center, axis_u, axis_v, texture: None } = self.light.shape else {
            return Cow::Borrowed(self);
        };
        let (profile, opening) = (self.light.profile.clone(), self.light.opening);
        let shape = LightShape::Disk { center, axis_u, axis_v };
        let disk = Light { profile, opening, shape, ..Light::default() };
        let LightShape::Polygon(vertices) = &disk.outlined().shape else { return Cow::Borrowed(self) };
        let shape = CaseShape::Polygon { vertices: vertices.clone(), texture: None };
        Cow::Owned(Self { light: CaseLight { shape, ..self.light.clone() }, ..self.clone() })
    }

    /// As [`Case::relative_light`], which nothing blocks.
    fn unblocked_light(
        &self,
        load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<(Light, Option<Arc<Texture>>), Unsupported> {
        if !self.blockers.is_empty() {
            let reason = "occluders: before a light that is no polygon, or in a medium".into();
            return Err(Unsupported { reason });
        }
        self.relative_light(load)
    }

    /// The light relative to the point, with its image.
    fn relative_light(
        &self,
        mut load: impl FnMut(&str) -> Result<Arc<Texture>, String>,
    ) -> Result<(Light, Option<Arc<Texture>>), Unsupported> {
        if let Some(field) = self.unknown_fields.first() {
            return Err(Unsupported { reason: format!("the field {field}") });
        }
        let shape = match &self.light.shape {
            CaseShape::Polygon { vertices, .. } => LightShape::Polygon(vertices.clone()),
            &CaseShape::Disk { center, axis_u, axis_v, .. } => LightShape::Disk { center, axis_u, axis_v },
            &CaseShape::Sphere { center, radius } => LightShape::Sphere { center, radius },
            &CaseShape::Cylinder { p0, p1, radius, caps } => {
                // It emits outwards, whatever is said of its sides
                let ends = if caps { TubeEnds::Flat } else { TubeEnds::Open };
                LightShape::Tube { p0, p1, radius, ends }
            }
        };
        let shown = match &self.light.shape {
            CaseShape::Disk { texture: Some(path), .. } => Some((path, vec![])),
            CaseShape::Polygon { texture: Some(CaseTexture { path, uv }), .. } => Some((path, uv.clone())),
            _ => None,
        };
        let image = match &shown {
            Some((path, _)) => {
                let reason = |reason| Unsupported { reason: format!("light.texture: {path}: {reason}") };
                Some(load(path).map_err(reason)?)
            }
            None => None,
        };
        let light = Light {
            name: self.name.clone(),
            radiance: self.light.radiance.as_vec3(),
            two_sided: self.light.two_sided,
            texture: shown.map(|(_, uvs)| LightTexture { layer: 0, uvs }),
            profile: self.light.profile.clone(),
            opening: self.light.opening,
            shape,
            ..Light::default()
        };
        let light = light.moved(&DAffine3::from_translation(-self.position));
        light.validate().map_err(of_light)?;
        Ok((light, image))
    }
}

fn of_light(fault: LightFault) -> Unsupported {
    Unsupported { reason: format!("light.{fault}") }
}
