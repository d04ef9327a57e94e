//! Light tables.

use crate::{BUILT_IN, Triple};
use arealight::LightTable;
use glam::DMat3;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;

/// A light table.
#[pyclass(frozen)]
pub struct Table(pub LightTable);

/// What a table holds for a roughness and a view.
#[pyclass(frozen, get_all)]
pub struct Lobe {
    inverse: [Triple; 3],
    schlick_inverse: [Triple; 3],
    albedo: f64,
    schlick: f64,
}

fn rows(matrix: DMat3) -> [Triple; 3] {
    matrix.transpose().to_cols_array_2d()
}

#[pymethods]
impl Table {
    /// The table of GGX that is built in.
    #[new]
    fn new() -> Self {
        Self(BUILT_IN.clone())
    }

    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let found = arealight_table::load(&path);
        found.map(Self).map_err(|error| PyValueError::new_err(format!("{}: {error}", path.display())))
    }

    fn save(&self, path: PathBuf) -> PyResult<()> {
        let saved = arealight_table::save(&self.0, &path);
        saved.map_err(|error| PyOSError::new_err(format!("{}: {error}", path.display())))
    }

    #[getter]
    fn size(&self) -> u32 {
        self.0.size()
    }

    #[getter]
    fn brdf(&self) -> &str {
        &self.0.description().brdf
    }

    /// The layers of texels as float32, each of size x size x 4.
    fn texels<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let bytes: Vec<u8> = self.0.texels().into_iter().flatten().flat_map(f32::to_le_bytes).collect();
        PyBytes::new(py, &bytes)
    }

    fn lookup(&self, roughness: f64, cos_view: f64) -> PyResult<Lobe> {
        for (value, name) in [(roughness, "roughness"), (cos_view, "cos_view")] {
            if !(0.0..=1.0).contains(&value) {
                return Err(PyValueError::new_err(format!("{name}: {value} must be from 0 to 1")));
            }
        }
        let found = self.0.lookup(roughness, cos_view);
        let (inverse, schlick_inverse) = (rows(found.inverse), rows(found.schlick_inverse));
        Ok(Lobe { inverse, schlick_inverse, albedo: found.albedo, schlick: found.schlick })
    }

    fn __repr__(&self) -> String {
        format!("Table('{}', {} nodes a side)", self.brdf(), self.size())
    }
}

#[pymethods]
impl Lobe {
    /// The density of the lobe, a steradian, in a direction of the surface's frame: the view lies in its xz
    /// plane.
    fn density(&self, direction: Triple) -> PyResult<f64> {
        let direction = crate::direction(direction, "direction")?;
        let inverse = DMat3::from_cols_array_2d(&self.inverse).transpose();
        let cosine_space = inverse * direction;
        let length = cosine_space.length();
        Ok(cosine_space.z.max(0.0) / length * inverse.determinant().abs()
            / (std::f64::consts::PI * length.powi(3)))
    }

    fn __repr__(&self) -> String {
        format!("Lobe(albedo={}, schlick={})", self.albedo, self.schlick)
    }
}
