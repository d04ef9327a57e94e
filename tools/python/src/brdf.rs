//! A BRDF that Python knows, fitted.

use crate::table::Table;
use arealight_fit::brdf::view_direction;
use arealight_fit::{Brdf, Magnitude, Settings, half_vector_magnitude};
use arealight_oracle::ggx::Ggx;
use glam::DVec3;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::f64::consts::{FRAC_1_PI, TAU};
use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// A function of alpha, view and light, or of the last two, that returns `f cos theta_light`.
pub struct Called {
    name: String,
    function: Py<PyAny>,
    /// What the function raised first: it is asked no more then.
    raised: Mutex<Option<PyErr>>,
}

impl Called {
    fn raised(&self) -> std::sync::MutexGuard<'_, Option<PyErr>> {
        self.raised.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn new(name: &str, function: Py<PyAny>) -> Self {
        Self { name: name.to_owned(), function, raised: Mutex::default() }
    }

    /// What the function raised, if it did.
    pub fn raise(&self) -> PyResult<()> {
        self.raised().take().map_or(Ok(()), Err)
    }

    /// The value of a function of view and light.
    pub fn reflected(&self, view: DVec3, light: DVec3) -> f64 {
        let (view, light) = (above(view).to_array(), light.to_array());
        self.value(
            |py, function| function.call1(py, (view, light)),
            || format!("view {view:?}, light {light:?}"),
        )
    }

    /// The function's value, or 0 where it has none.
    fn value(
        &self,
        call: impl FnOnce(Python<'_>, &Py<PyAny>) -> PyResult<Py<PyAny>>,
        place: impl FnOnce() -> String,
    ) -> f64 {
        if self.raised().is_some() {
            return 0.0;
        }
        let called = Python::attach(|py| {
            let value: f64 = call(py, &self.function)?.extract(py)?;
            if !(value >= 0.0 && value.is_finite()) {
                let message = format!("brdf: {value} for {}: must be finite and not negative", place());
                return Err(PyValueError::new_err(message));
            }
            Ok(value)
        });
        called.unwrap_or_else(|error| {
            self.raised().get_or_insert(error);
            0.0
        })
    }
}

/// The view, or one that BRDFs can divide by the cosine of.
fn above(view: DVec3) -> DVec3 {
    if view.z < LEAST_COSINE { view_direction(LEAST_COSINE) } else { view }
}

impl Brdf for Called {
    fn name(&self) -> &str {
        &self.name
    }

    fn evaluate(&self, alpha: f64, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 {
            return 0.0;
        }
        let (view, light) = (above(view).to_array(), light.to_array());
        let place = || format!("alpha {alpha}, view {view:?}, light {light:?}");
        self.value(|py, function| function.call1(py, (alpha, view, light)), place)
    }

    /// Half by GGX of this alpha, half by the cosine.
    fn sample(&self, alpha: f64, view: DVec3, u: [f64; 2]) -> DVec3 {
        if u[0] < 0.5 {
            return Ggx { alpha }.sample(view, [2.0 * u[0], u[1]]);
        }
        let square = 2.0 * u[0] - 1.0;
        let (sin, cos) = (TAU * u[1]).sin_cos();
        DVec3::new(square.sqrt() * cos, square.sqrt() * sin, (1.0 - square).max(0.0).sqrt())
    }

    fn density(&self, alpha: f64, view: DVec3, light: DVec3) -> f64 {
        if light.z <= 0.0 {
            return 0.0;
        }
        0.5 * (Ggx { alpha }.density(view, light) + light.z * FRAC_1_PI)
    }

    fn magnitude(&self, alpha: f64, cos_view: f64) -> Magnitude {
        let view = view_direction(cos_view);
        half_vector_magnitude(alpha, view, |_, light| {
            (self.evaluate(alpha, view, light), self.schlick_weight(view, light))
        })
    }
}

/// Fits a table to a BRDF.
#[pyfunction]
#[pyo3(signature = (brdf, size = 16, name = "python", progress = None))]
pub fn fit(
    py: Python<'_>,
    brdf: Py<PyAny>,
    size: u32,
    name: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<Table> {
    let called = Called::new(name, brdf);
    let settings = Settings { size, pairs: false, ..Settings::default() };
    let tell = |done: u64, steps: u64| {
        let Some(progress) = &progress else { return };
        if let Err(error) = Python::attach(|py| progress.call1(py, (done, steps)).map(drop)) {
            called.raised().get_or_insert(error);
        }
    };
    // One thread: Python answers one at a time, and several would wait for each other
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let (send, receive) = std::sync::mpsc::channel();
    let fitted = std::thread::scope(|scope| {
        let (pool, called, settings, tell) = (&pool, &called, &settings, &tell);
        scope.spawn(move || {
            // The other end waits as long as this one is there
            let fit = || arealight_fit::fit(called, settings, tell);
            // A thread that was attached before is attached again at little cost
            let _ = send.send(pool.install(|| Python::attach(|py| py.detach(fit))));
        });
        // Wait, and let Ctrl-C through meanwhile
        let mut receive = receive;
        loop {
            let (answer, back) = py.detach(move || (receive.recv_timeout(SIGNALS), receive));
            receive = back;
            match answer {
                Ok(fitted) => return Some(fitted),
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = py.check_signals() {
                        called.raised().get_or_insert(error);
                    }
                }
            }
        }
    });
    called.raise()?;
    let fitted = fitted.ok_or_else(|| PyRuntimeError::new_err("the fitter has panicked"))?;
    fitted.map(Table).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// How often the waiting thread looks for signals.
const SIGNALS: Duration = Duration::from_millis(100);

/// The view is never nearer to the surface, where BRDFs divide by the cosine.
const LEAST_COSINE: f64 = 1e-4;
