//! Arealight's truth, fitter and tables for Python: what `arealight.pyi` describes.

#![expect(clippy::needless_pass_by_value, reason = "arguments come from Python by value")]

mod brdf;
mod light;
mod table;

use arealight::{LightTable, Quality};
use arealight_oracle::cubature::Settings;
use arealight_oracle::frame::SurfaceFrame;
use arealight_oracle::ggx::Ggx;
use arealight_oracle::shading::{
    Directions, RelativeLight, Truth, density_truth, ltc_on, shape_density_truth, shape_ltc_on,
    shape_seen_from, shape_truth, truth,
};
use brdf::Called;
use glam::DVec3;
use light::{Light, Material};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
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

/// Where a surface is and how it is seen.
struct Seen {
    position: DVec3,
    normal: DVec3,
    view: DVec3,
}

/// Three numbers, or rows of three: as many as the other arguments have, or one for all.
#[derive(FromPyObject)]
pub(crate) enum Triples {
    One(Triple),
    Rows(Vec<Triple>),
}

impl Triples {
    fn rows(&self) -> &[Triple] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Rows(rows) => rows,
        }
    }
}

/// The points that are asked for, and whether there are rows of them.
struct Points {
    seen: Vec<Seen>,
    is_rows: bool,
}

impl Points {
    fn new(position: &Triples, normal: &Triples, view: &Triples) -> PyResult<Self> {
        let all = [("position", position), ("normal", normal), ("view", view)];
        let of_rows = all.iter().find(|(_, triples)| matches!(triples, Triples::Rows(_)));
        let count = of_rows.map_or(1, |(_, triples)| triples.rows().len());
        for (name, triples) in &all {
            let rows = triples.rows().len();
            if matches!(triples, Triples::Rows(_)) && rows != count {
                return Err(PyValueError::new_err(format!("{name}: {rows} rows, where others have {count}")));
            }
        }
        let at = |triples: &Triples, index: usize| triples.rows()[index.min(triples.rows().len() - 1)];
        let seen = |index| {
            let (view, normal) =
                (direction(at(view, index), "view")?, direction(at(normal, index), "normal")?);
            Ok(Seen { position: finite(at(position, index), "position")?, normal, view })
        };
        let seen = (0..count).map(seen).collect::<PyResult<_>>()?;
        Ok(Self { seen, is_rows: of_rows.is_some() })
    }

    /// What was found at each, as Python gets it: three numbers, or an array of rows (a list without numpy).
    fn answer<'py>(&self, py: Python<'py>, found: &[DVec3]) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<Triple> = found.iter().map(DVec3::to_array).collect();
        match (self.is_rows, py.import("numpy")) {
            (false, _) => rows[0].into_bound_py_any(py),
            (true, Ok(numpy)) => numpy.call_method1("array", (rows,))?.call_method1("reshape", (-1, 3)),
            (true, Err(_)) => rows.into_bound_py_any(py),
        }
    }
}

/// The table that is built in, which takes a while to read.
static BUILT_IN: LazyLock<LightTable> = LazyLock::new(LightTable::ggx);

/// What a surface reflects of a light, by a fitted table in float64.
#[pyfunction]
#[pyo3(signature = (light, material, view, position = ORIGIN, normal = UP, table = None))]
fn radiance<'py>(
    py: Python<'py>,
    light: &Light,
    material: &Material,
    view: Triples,
    position: Triples,
    normal: Triples,
    table: Option<&Table>,
) -> PyResult<Bound<'py, PyAny>> {
    let points = Points::new(&position, &normal, &view)?;
    let (quality, surface, light) = (Quality::default(), material.0.surface(), &light.0);
    let table = table.map(|table| &table.0);
    let found: Vec<DVec3> = py.detach(|| {
        let table = table.unwrap_or_else(|| &BUILT_IN);
        let at = |&Seen { position, normal, view }: &Seen| {
            let shape = shape_seen_from(light, position);
            shape_ltc_on(quality, table, &surface, normal, view, &shape).unwrap_or_else(|| {
                ltc_on(quality, table, &surface, normal, view, &RelativeLight::new(light, position))
            })
        };
        points.seen.par_iter().map(at).collect()
    });
    points.answer(py, &found)
}

/// The same by adaptive cubature of the true BRDF, and the estimate of its error; or of a function's.
#[pyfunction(name = "truth")]
#[pyo3(signature = (light, material, view, position = ORIGIN, normal = UP, tolerance = 1e-6))]
fn true_radiance<'py>(
    py: Python<'py>,
    light: &Light,
    material: Reflecting,
    view: Triples,
    position: Triples,
    normal: Triples,
    tolerance: f64,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let points = Points::new(&position, &normal, &view)?;
    let light = &light.0;
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(PyValueError::new_err(format!("tolerance: {tolerance} must be above 0 and below 1")));
    }
    let settings = Settings { relative_tolerance: tolerance, ..Settings::default() };
    let found: Vec<Truth> = match material {
        Reflecting::Material(material) => {
            let surface = material.get().0.surface();
            let at = |&Seen { position, normal, view }: &Seen| {
                let shape = shape_seen_from(light, position);
                shape_truth(&surface, normal, view, &shape, &settings).unwrap_or_else(|| {
                    truth(&surface, normal, view, &RelativeLight::new(light, position), &settings)
                })
            };
            py.detach(|| points.seen.par_iter().map(at).collect())
        }
        Reflecting::Function(function) => {
            let called = Called::new("function", function);
            let at = |&Seen { position, normal, view }: &Seen| {
                let frame = SurfaceFrame::new(normal, view);
                let density = |to| called.reflected(frame.view(), to);
                let shape = shape_seen_from(light, position);
                let found = shape_density_truth(&frame, &shape, &settings, Directions::Above, density);
                found.unwrap_or_else(|| {
                    let light = RelativeLight::new(light, position);
                    density_truth(&frame, &light, &settings, Directions::Above, density)
                })
            };
            let found = points.seen.iter().map(at).collect();
            called.raise()?;
            found
        }
    };
    let [values, errors]: [Vec<DVec3>; 2] =
        [found.iter().map(|it| it.radiance).collect(), found.iter().map(|it| it.error).collect()];
    Ok((points.answer(py, &values)?, points.answer(py, &errors)?))
}

/// What reflects: a material, or a function of view and light.
#[derive(FromPyObject)]
enum Reflecting {
    Material(Py<Material>),
    Function(Py<PyAny>),
}

const ORIGIN: Triples = Triples::One([0.0; 3]);
const UP: Triples = Triples::One([0.0, 0.0, 1.0]);

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
