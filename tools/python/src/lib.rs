//! Arealight's truth, fitter and tables for Python: what `arealight.pyi` describes.

#![expect(clippy::needless_pass_by_value, reason = "arguments come from Python by value")]

mod brdf;
mod light;
mod table;

use arealight::{LightTable, Quality};
use arealight_oracle::cubature::Settings;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::shading::{RelativeLight, ltc_on, shape_ltc_on, shape_seen_from, shape_truth, truth};
use glam::DVec3;
use light::{Light, Material};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::LazyLock;
use table::Table;

/// Three numbers.
pub(crate) type Triple = [f64; 3];

/// A number that may be of any size, but is one.
fn finite(vector: Triple, name: &str) -> PyResult<DVec3> {
    let vector = DVec3::from_array(vector);
    if !vector.is_finite() {
        return Err(PyValueError::new_err(format!("{name}: {vector} must be finite")));
    }
    Ok(vector)
}

/// A direction of any length but zero, as a unit vector.
fn direction(vector: Triple, name: &str) -> PyResult<DVec3> {
    let vector = finite(vector, name)?;
    let wrong = || PyValueError::new_err(format!("{name}: {vector} is no direction"));
    vector.try_normalize().ok_or_else(wrong)
}

/// Where a surface is and how it is seen, as arguments have it.
struct Seen {
    position: DVec3,
    normal: DVec3,
    view: DVec3,
}

impl Seen {
    fn new(position: Triple, normal: Triple, view: Triple) -> PyResult<Self> {
        let (view, normal) = (direction(view, "view")?, direction(normal, "normal")?);
        Ok(Self { position: finite(position, "position")?, normal, view })
    }
}

/// The table that is built in, which takes a while to read.
static BUILT_IN: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

/// What a surface reflects of a light, by a fitted table in float64.
#[pyfunction]
#[pyo3(signature = (light, material, view, position = [0.0; 3], normal = [0.0, 0.0, 1.0], table = None))]
fn radiance(
    py: Python<'_>,
    light: &Light,
    material: &Material,
    view: Triple,
    position: Triple,
    normal: Triple,
    table: Option<&Table>,
) -> PyResult<Triple> {
    let Seen { position, normal, view } = Seen::new(position, normal, view)?;
    let (quality, surface, light) = (Quality::default(), material.0.surface(), &light.0);
    let table = table.map(|table| &table.0);
    let found = py.detach(|| {
        let table = table.unwrap_or_else(|| &BUILT_IN);
        let shape = shape_seen_from(light, position);
        shape_ltc_on(quality, table, &surface, normal, view, &shape).unwrap_or_else(|| {
            let light = RelativeLight::new(light, position);
            ltc_on(quality, table, &surface, normal, view, &light)
        })
    });
    Ok(found.to_array())
}

/// The same by adaptive cubature of the true BRDF, and the estimate of its error.
#[pyfunction(name = "truth")]
#[pyo3(signature = (light, material, view, position = [0.0; 3], normal = [0.0, 0.0, 1.0], tolerance = 1e-6))]
fn true_radiance(
    py: Python<'_>,
    light: &Light,
    material: &Material,
    view: Triple,
    position: Triple,
    normal: Triple,
    tolerance: f64,
) -> PyResult<(Triple, Triple)> {
    let Seen { position, normal, view } = Seen::new(position, normal, view)?;
    let light = &light.0;
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(PyValueError::new_err(format!("tolerance: {tolerance} must be above 0 and below 1")));
    }
    let (surface, settings) =
        (material.0.surface(), Settings { relative_tolerance: tolerance, ..Settings::default() });
    let found = py.detach(|| {
        let shape = shape_seen_from(light, position);
        shape_truth(&surface, normal, view, &shape, &settings)
            .unwrap_or_else(|| truth(&surface, normal, view, &RelativeLight::new(light, position), &settings))
    });
    Ok((found.radiance.to_array(), found.error.to_array()))
}

/// GGX with height-correlated masking and shadowing, without a Fresnel term, times the cosine of the light.
#[pyfunction]
fn ggx(alpha: f64, view: Triple, light: Triple) -> PyResult<f64> {
    let (view, light) = (direction(view, "view")?, direction(light, "light")?);
    if !(arealight::MIN_ALPHA..=1.0).contains(&alpha) {
        return Err(PyValueError::new_err(format!(
            "alpha: {alpha} must be from {} to 1",
            arealight::MIN_ALPHA
        )));
    }
    Ok(Ggx { alpha }.evaluate(view, light))
}

/// Area lights by linearly transformed cosines.
#[pymodule(name = "arealight")]
fn python_module(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Table>()?;
    module.add_class::<table::Lobe>()?;
    module.add_class::<Light>()?;
    module.add_class::<Material>()?;
    module.add_function(wrap_pyfunction!(radiance, module)?)?;
    module.add_function(wrap_pyfunction!(true_radiance, module)?)?;
    module.add_function(wrap_pyfunction!(ggx, module)?)?;
    module.add_function(wrap_pyfunction!(brdf::fit, module)?)
}
