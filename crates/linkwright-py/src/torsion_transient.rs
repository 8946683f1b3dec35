//! Trains in motion at the border.

use linkwright_core::torsion::transient::course::{self, End, Method, Request};
use linkwright_core::torsion::transient::rates::Rates;
use linkwright_core::torsion::transient::system::{Encoded, System};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::column;
use crate::errors::plan_error;
use crate::guard::{guarded, require_room, zeros};
use crate::{Floats, Ints, Table};

/// The motion of a train in time.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionMotion {
    end: &'static str,
    method: &'static str,
    steps: usize,
    rejected: usize,
    evaluations: usize,
    time: f64,
    fastest: f64,
    /// Kinetic and potential energy at the start, then at the end.
    energies: (f64, f64, f64, f64),
    samples: Py<PyArray2<f64>>,
    extremes: Py<PyArray2<f64>>,
    work: Py<PyArray1<f64>>,
}

fn method_of(name: &str) -> PyResult<Method> {
    match name {
        "auto" => Ok(Method::Auto),
        "explicit" => Ok(Method::Explicit),
        "implicit" => Ok(Method::Implicit),
        other => Err(PyValueError::new_err(format!("there is no method {other}"))),
    }
}

fn name_of(method: Method) -> &'static str {
    match method {
        Method::Auto => "auto",
        Method::Explicit => "explicit",
        Method::Implicit => "implicit",
    }
}

fn word_for(end: End) -> &'static str {
    match end {
        End::Time => "time",
        End::TooManySteps => "too many steps",
        End::Inaccurate => "inaccurate",
        End::NotFinite => "not finite",
        End::Rounded => "rounded",
    }
}

/// A train in motion, decoded and checked.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TorsionSystem(System);

impl TorsionSystem {
    fn fits(&self, what: &str, found: usize, expected: usize) -> PyResult<()> {
        if found == expected {
            Ok(())
        } else {
            Err(PyValueError::new_err(format!("{what} holds {found} numbers, {expected} are needed")))
        }
    }
}

#[pymethods]
impl TorsionSystem {
    #[new]
    fn new(
        py: Python<'_>,
        inertia: Floats<'_>,
        damping: Floats<'_>,
        swing_damping: Floats<'_>,
        links: Ints<'_>,
        link_numbers: Floats<'_>,
        rotors: Ints<'_>,
        rotor_numbers: Floats<'_>,
        torques: Ints<'_>,
        torque_numbers: Floats<'_>,
        table_starts: Ints<'_>,
        periods: Floats<'_>,
        knots: Floats<'_>,
        curve_starts: Ints<'_>,
        points: Floats<'_>,
    ) -> PyResult<Self> {
        let code = Encoded {
            masses: [inertia.as_slice()?, damping.as_slice()?, swing_damping.as_slice()?],
            links: links.as_slice()?,
            link_numbers: link_numbers.as_slice()?,
            rotors: rotors.as_slice()?,
            rotor_numbers: rotor_numbers.as_slice()?,
            torques: torques.as_slice()?,
            torque_numbers: torque_numbers.as_slice()?,
            table_starts: table_starts.as_slice()?,
            periods: periods.as_slice()?,
            knots: knots.as_slice()?,
            curve_starts: curve_starts.as_slice()?,
            points: points.as_slice()?,
        };
        guarded(py, "translation of the train", || System::decode(&code))?
            .map(TorsionSystem)
            .map_err(plan_error)
    }

    fn follow(
        &self,
        py: Python<'_>,
        angle: Floats<'_>,
        speed: Floats<'_>,
        times: Floats<'_>,
        start: f64,
        duration: f64,
        accuracy: f64,
        method: &str,
        steps_max: usize,
    ) -> PyResult<TorsionMotion> {
        let method = method_of(method)?;
        let (angle, speed, times) = (angle.as_slice()?, speed.as_slice()?, times.as_slice()?);
        self.fits("angle", angle.len(), self.0.len())?;
        self.fits("speed", speed.len(), self.0.len())?;
        let request = Request { angle, speed, times, start, duration, accuracy, method, steps_max };
        let analysis = "torsional motion in time";
        require_room(analysis, [2 * self.0.len() + self.0.links.len() + 2, times.len()])?;
        let found = guarded(py, analysis, || course::follow(&self.0, &request))?;
        let rows = found.samples.len() / times.len().max(1);
        let samples = zeros(py, analysis, [rows, times.len()])?;
        samples.readwrite().as_slice_mut()?.copy_from_slice(&found.samples);
        let extremes = zeros(py, analysis, [found.extremes.len(), 4])?;
        extremes.readwrite().as_slice_mut()?.copy_from_slice(found.extremes.as_flattened());
        Ok(TorsionMotion {
            end: word_for(found.end),
            method: name_of(found.method),
            steps: found.steps,
            rejected: found.rejected,
            evaluations: found.evaluations,
            time: found.time,
            fastest: found.fastest,
            energies: found.energies.into(),
            samples: samples.unbind(),
            extremes: extremes.unbind(),
            work: column(py, found.work).unbind(),
        })
    }

    fn net_torques<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        angle: PyReadonlyArray2<'_, f64>,
        speed: Floats<'_>,
    ) -> PyResult<(Table<'py>, Table<'py>)> {
        let (n, speed) = (self.0.len(), speed.as_slice()?);
        let rows = angle.as_array().nrows();
        self.fits("angle", angle.as_array().ncols(), n)?;
        self.fits("speed", speed.len(), n)?;
        let analysis = "torques on a train";
        let (net, inertia) = (zeros(py, analysis, [rows, n])?, zeros(py, analysis, [rows, n])?);
        {
            let (mut net, mut inertia) = (net.readwrite(), inertia.readwrite());
            let lists = net
                .as_slice_mut()?
                .chunks_exact_mut(n.max(1))
                .zip(inertia.as_slice_mut()?.chunks_exact_mut(n.max(1)));
            let angles = angle.as_slice()?.chunks_exact(n.max(1));
            guarded(py, analysis, || {
                let mut rates = Rates::new(&self.0);
                rates.enter(t);
                for (angle, (net, inertia)) in angles.zip(lists) {
                    rates.net_torques(t, angle, speed, net, inertia);
                }
            })?;
        }
        Ok((net, inertia))
    }
}
