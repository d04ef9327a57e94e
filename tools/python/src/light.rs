//! Lights and materials.

use crate::{Triple, finite};
use arealight::{LightFault, LightShape, TubeEnds};
use arealight_oracle::material;
use glam::{DVec3, Vec3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A light of constant radiance.
#[pyclass(frozen)]
pub struct Light(pub arealight::Light);

impl Light {
    fn new(shape: LightShape, radiance: Triple, two_sided: bool) -> PyResult<Self> {
        let radiance = finite(radiance, "radiance")?.as_vec3();
        let light = arealight::Light { radiance, two_sided, shape, ..arealight::Light::default() };
        let wrong = |fault: LightFault| PyValueError::new_err(fault.to_string());
        light.validate().map_err(wrong)?;
        Ok(Self(light))
    }
}

#[pymethods]
impl Light {
    #[staticmethod]
    #[pyo3(signature = (vertices, radiance = [1.0; 3], two_sided = false))]
    fn polygon(vertices: Vec<Triple>, radiance: Triple, two_sided: bool) -> PyResult<Self> {
        let vertices = vertices.into_iter().map(DVec3::from_array).collect();
        Self::new(LightShape::Polygon(vertices), radiance, two_sided)
    }

    #[staticmethod]
    #[pyo3(signature = (center, axis_u, axis_v, radiance = [1.0; 3], two_sided = false))]
    fn disk(
        center: Triple,
        axis_u: Triple,
        axis_v: Triple,
        radiance: Triple,
        two_sided: bool,
    ) -> PyResult<Self> {
        let [center, axis_u, axis_v] = [center, axis_u, axis_v].map(DVec3::from_array);
        Self::new(LightShape::Disk { center, axis_u, axis_v }, radiance, two_sided)
    }

    #[staticmethod]
    #[pyo3(signature = (center, radius, radiance = [1.0; 3]))]
    fn sphere(center: Triple, radius: f64, radiance: Triple) -> PyResult<Self> {
        Self::new(LightShape::Sphere { center: center.into(), radius }, radiance, false)
    }

    #[staticmethod]
    #[pyo3(signature = (p0, p1, radius, radiance = [1.0; 3], ends = "round"))]
    fn tube(p0: Triple, p1: Triple, radius: f64, radiance: Triple, ends: &str) -> PyResult<Self> {
        let ends = match ends {
            "open" => TubeEnds::Open,
            "flat" => TubeEnds::Flat,
            "round" => TubeEnds::Round,
            other => {
                let message = format!("ends: '{other}' must be 'open', 'flat' or 'round'");
                return Err(PyValueError::new_err(message));
            }
        };
        let [p0, p1] = [p0, p1].map(DVec3::from_array);
        Self::new(LightShape::Tube { p0, p1, radius, ends }, radiance, false)
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0.shape)
    }
}

/// A metallic-roughness material.
#[pyclass(frozen)]
pub struct Material(pub material::Material);

#[pymethods]
impl Material {
    #[new]
    #[pyo3(signature = (base_color = [1.0; 3], metalness = 0.0, roughness = 0.5, dielectric_f0 = 0.04))]
    fn new(base_color: Triple, metalness: f32, roughness: f32, dielectric_f0: f32) -> PyResult<Self> {
        let base_color: Vec3 = finite(base_color, "base_color")?.as_vec3();
        for (value, name) in [
            (base_color.min_element(), "base_color"),
            (base_color.max_element(), "base_color"),
            (metalness, "metalness"),
            (roughness, "roughness"),
            (dielectric_f0, "dielectric_f0"),
        ] {
            if !(0.0..=1.0).contains(&value) {
                return Err(PyValueError::new_err(format!("{name}: {value} must be from 0 to 1")));
            }
        }
        let dielectric_f0 = Vec3::splat(dielectric_f0);
        let material = material::Material::default();
        Ok(Self(material::Material { base_color, metalness, roughness, dielectric_f0, ..material }))
    }

    fn __repr__(&self) -> String {
        let material::Material { base_color, metalness, roughness, dielectric_f0, .. } = self.0;
        let [r, g, b] = base_color.to_array();
        format!(
            "Material(base_color=({r}, {g}, {b}), metalness={metalness}, roughness={roughness}, \
            dielectric_f0={})",
            dielectric_f0.x
        )
    }
}
