//! Trains in motion at the border.

use linkwright_torsion::transient::course::{self, End, Method, Request, Tally};
use linkwright_torsion::transient::extremes::Extreme;
use linkwright_torsion::transient::rates::Rates;
use linkwright_torsion::transient::system::System;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::builder::train::{
    TorsionController, TorsionFriction, TorsionLink, TorsionMass, TorsionPendulum, TorsionRotor,
    TorsionTorque, system,
};
use crate::errors::plan_error;
use crate::guard::{guarded, require_room, zeros};
use crate::torsion::Extremes;

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
    kinetic_start: f64,
    potential_start: f64,
    kinetic_end: f64,
    potential_end: f64,
    angle: Py<PyArray2<f64>>,
    speed: Py<PyArray2<f64>>,
    torque: Py<PyArray2<f64>>,
    kinetic: Py<PyArray1<f64>>,
    potential: Py<PyArray1<f64>>,
    torque_extremes: Py<Extremes>,
    speed_extremes: Py<Extremes>,
    work: Py<PyArray1<f64>>,
    loss_links: Py<PyArray1<f64>>,
    loss_masses: Py<PyArray1<f64>>,
    loss_frictions: Py<PyArray1<f64>>,
    friction_torque: Py<PyArray2<f64>>,
    friction_state: Py<PyArray2<f64>>,
    friction_extremes: Py<Extremes>,
    power_extremes: Py<Extremes>,
    engagements: Vec<usize>,
    slip_time: Py<PyArray1<f64>>,
    stuck_time: Py<PyArray1<f64>>,
}

/// Net torque and inertia of each mass.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct NetTorques {
    torque: Py<PyArray2<f64>>,
    inertia: Py<PyArray2<f64>>,
}

/// Rows of samples as a table.
fn table(py: Python<'_>, analysis: &str, list: &[f64], rows: usize) -> PyResult<Py<PyArray2<f64>>> {
    let table = zeros(py, analysis, [rows, list.len() / rows.max(1)])?;
    table.readwrite().as_slice_mut()?.copy_from_slice(list);
    Ok(table.unbind())
}

fn extremes(py: Python<'_>, rows: &[Extreme]) -> PyResult<Py<Extremes>> {
    let of = |k: usize| column(py, rows.iter().map(|row| row[k]).collect()).unbind();
    Py::new(py, Extremes { greatest: of(0), greatest_at: of(1), least: of(2), least_at: of(3) })
}

fn part(py: Python<'_>, list: &[f64]) -> Py<PyArray1<f64>> {
    PyArray1::from_slice(py, list).unbind()
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
        End::Unsettled => "unsettled",
    }
}

/// A train in motion, checked.
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
    #[pyo3(signature = (*, masses, links, rotors, torques, pendulums=Vec::new(), controllers=Vec::new(), frictions=Vec::new()))]
    fn new(
        py: Python<'_>,
        masses: Vec<PyRef<'_, TorsionMass>>,
        links: Vec<PyRef<'_, TorsionLink>>,
        rotors: Vec<PyRef<'_, TorsionRotor>>,
        torques: Vec<PyRef<'_, TorsionTorque>>,
        pendulums: Vec<PyRef<'_, TorsionPendulum>>,
        controllers: Vec<PyRef<'_, TorsionController>>,
        frictions: Vec<PyRef<'_, TorsionFriction>>,
    ) -> PyResult<Self> {
        let others = (&pendulums[..], &controllers[..], &frictions[..]);
        let system = system(py, &masses, &links, &rotors, &torques, others);
        system.check().map_err(plan_error)?;
        Ok(TorsionSystem(system))
    }

    #[pyo3(signature = (*, angle, speed, times, start, duration, accuracy, method, steps_max))]
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
        let f = self.0.frictions.len();
        require_room(analysis, [2 * (self.0.len() + f) + self.0.links.len() + 2, times.len()])?;
        let found = guarded(py, analysis, || course::follow(&self.0, &request))?;
        let (n, m, k) = (self.0.len(), self.0.links.len(), self.0.torques.len() + self.0.controllers.len());
        let at = |row: usize| row * times.len();
        let mut next = 0;
        let [angle, speed, torque, kinetic, potential, rubbing, states] = [n, n, m, 1, 1, f, f].map(|rows| {
            next += rows;
            &found.samples[at(next - rows)..at(next)]
        });
        let (of_links, rest) = found.extremes.split_at(m);
        let (of_masses, of_frictions) = rest.split_at(n);
        let times_of = |time: fn(&Tally) -> f64| -> Vec<f64> { found.tallies.iter().map(time).collect() };
        let [kinetic_start, potential_start, kinetic_end, potential_end] = found.energies;
        Ok(TorsionMotion {
            end: word_for(found.end),
            method: name_of(found.method),
            steps: found.steps,
            rejected: found.rejected,
            evaluations: found.evaluations,
            time: found.time,
            fastest: found.fastest,
            kinetic_start,
            potential_start,
            kinetic_end,
            potential_end,
            angle: table(py, analysis, angle, n)?,
            speed: table(py, analysis, speed, n)?,
            torque: table(py, analysis, torque, m)?,
            kinetic: part(py, kinetic),
            potential: part(py, potential),
            torque_extremes: extremes(py, of_links)?,
            speed_extremes: extremes(py, of_masses)?,
            work: part(py, &found.work[..k]),
            loss_links: part(py, &found.work[k..k + m]),
            loss_masses: part(py, &found.work[k + m..k + m + n]),
            loss_frictions: part(py, &found.work[k + m + n..]),
            friction_torque: table(py, analysis, rubbing, f)?,
            friction_state: table(py, analysis, states, f)?,
            friction_extremes: extremes(py, &of_frictions[..f])?,
            power_extremes: extremes(py, &of_frictions[f..])?,
            engagements: found.tallies.iter().map(|tally| tally.engagements).collect(),
            slip_time: part(py, &times_of(|tally| tally.slipping)),
            stuck_time: part(py, &times_of(|tally| tally.stuck)),
        })
    }

    fn net_torques(
        &self,
        py: Python<'_>,
        t: f64,
        angle: PyReadonlyArray2<'_, f64>,
        speed: Floats<'_>,
    ) -> PyResult<NetTorques> {
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
        Ok(NetTorques { torque: net.unbind(), inertia: inertia.unbind() })
    }
}
