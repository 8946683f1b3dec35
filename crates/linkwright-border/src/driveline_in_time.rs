//! Motion in time of torsionally flexible drivelines at the border.

use linkwright_driveline::chain::{Chain, Source};
use linkwright_driveline::equation::Equation;
use linkwright_driveline::in_time::events::Event;
use linkwright_driveline::in_time::follow;
use linkwright_driveline::in_time::reading::Reading;
use linkwright_driveline::in_time::start::Start;
use linkwright_driveline::in_time::system::Layout;
use linkwright_driveline::in_time::trajectory::{End, Trajectory};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::builder::Plan;
use crate::driveline::{Array, Table, extremes, rows};
use crate::driveline_chain::Driveline;
use crate::guard::{guarded, require_room};
use crate::torsion::Extremes;

const ANALYSIS: &str = "motion in time of the driveline";

/// Curves of a driveline over time, a row a part.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineInTimeCurves {
    angle: Table,
    speed: Table,
    acceleration: Table,
    twist: Table,
    torque: Table,
    torque_drive: Table,
    torque_load: Array,
    energy_kinetic: Array,
    energy_elastic: Array,
    work_shaft: Array,
    impulse: Table,
    work_drive: Array,
    work_load: Array,
    work_brake: Array,
    heat: Table,
}

/// Motion in time of a driveline, at the ends of its steps; extremes over its masses or links each.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct DrivelineInTime {
    #[pyo3(get)]
    time: Array,
    #[pyo3(get)]
    crank_angle: Array,
    /// State at the end, without works.
    #[pyo3(get)]
    state: Array,
    #[pyo3(get)]
    end: &'static str,
    #[pyo3(get)]
    torque_drive_end: f64,
    #[pyo3(get)]
    torque_load_end: f64,
    #[pyo3(get)]
    speed: Py<Extremes>,
    #[pyo3(get)]
    acceleration: Py<Extremes>,
    #[pyo3(get)]
    twist: Py<Extremes>,
    #[pyo3(get)]
    torque: Py<Extremes>,
    #[pyo3(get)]
    energy_error: f64,
    #[pyo3(get)]
    evaluations: usize,
    /// Steps by the implicit method.
    #[pyo3(get)]
    implicit: usize,
    /// Number of the end of a step, what happened, and the mass of it, if it is of one.
    #[pyo3(get)]
    events: Vec<(usize, &'static str, Option<usize>)>,
    plan: Py<Plan>,
    q: Vec<f64>,
    chain: Chain,
    start: Start,
    trajectory: Trajectory,
}

fn word(end: End) -> &'static str {
    match end {
        End::Time => "time",
        End::Turns => "turns",
        End::Rest => "rest",
        End::DoesNotClose => "does not close",
        End::Inaccurate => "inaccurate",
    }
}

fn named(&(at, event): &(usize, Event)) -> (usize, &'static str, Option<usize>) {
    match event {
        Event::Kink(..) => (at, "kink", None),
        Event::Bound(..) | Event::Limit(..) => (at, "link", None),
        Event::Last(_) => (at, "end", None),
        Event::Speed(mass, _) => (at, "speed", Some(mass)),
        Event::Rest(mass) => (at, "rest", Some(mass)),
        Event::Slip(mass, _) => (at, "slip", Some(mass)),
        Event::Law(_) => (at, "law", None),
    }
}

#[pymethods]
impl DrivelineInTime {
    fn curves(&self, py: Python<'_>, time: Floats<'_>) -> PyResult<DrivelineInTimeCurves> {
        let (time, n, links) = (time.as_slice()?, self.chain.masses(), self.chain.links.len());
        require_room(ANALYSIS, [8 + 2 * self.chain.drivers.len() + 3 * n + 3 * links, time.len()])?;
        let equation = Equation { plan: &self.plan.get().0, q: &self.q, chain: &self.chain };
        let found =
            guarded(py, ANALYSIS, || Reading::new(equation, &self.start, &self.trajectory).curves(time))?;
        let count = time.len();
        let work = |which: usize| column(py, found.works[which * count..][..count].to_vec()).unbind();
        let [kinetic, elastic] = found.energy;
        let drivers = self.chain.drivers.len();
        let (impulse, heat) = found.works[4 * count..].split_at(drivers * count);
        Ok(DrivelineInTimeCurves {
            work_shaft: work(0),
            work_drive: work(1),
            work_load: work(2),
            work_brake: work(3),
            impulse: rows(py, impulse.to_vec(), drivers)?,
            heat: rows(py, heat.to_vec(), links)?,
            angle: rows(py, found.angle, n)?,
            speed: rows(py, found.speed, n)?,
            acceleration: rows(py, found.acceleration, n)?,
            twist: rows(py, found.twist, links)?,
            torque: rows(py, found.torque, links)?,
            torque_drive: rows(py, found.drive, drivers)?,
            torque_load: column(py, found.load).unbind(),
            energy_kinetic: column(py, kinetic).unbind(),
            energy_elastic: column(py, elastic).unbind(),
        })
    }
}

#[pyfunction]
#[pyo3(signature = (plan, q, chain, *, state, brakes, time, motor, speed, until, turns, accuracy))]
pub(crate) fn driveline_in_time(
    py: Python<'_>,
    plan: Bound<'_, Plan>,
    q: Floats<'_>,
    chain: Driveline<'_>,
    state: Floats<'_>,
    brakes: Floats<'_>,
    time: f64,
    motor: f64,
    speed: f64,
    until: f64,
    turns: f64,
    accuracy: f64,
) -> PyResult<DrivelineInTime> {
    let known = plan.unbind();
    let (q, chain) = (known.get().parameters(&q)?.to_vec(), chain.chain()?);
    if chain.drivers.iter().any(|driver| matches!(driver.source, Source::Held(_))) {
        return Err(PyValueError::new_err("driveline: a motor that keeps its speed has no motion in time"));
    }
    let state = state.as_slice()?.to_vec();
    let layout = Layout::of(&chain);
    let brakes = brakes.as_slice()?.to_vec();
    if state.len() != layout.phi + 1 || brakes.len() != chain.masses() {
        return Err(PyValueError::new_err("driveline: state or brakes have another number of masses"));
    }
    let torques = vec![0.0; brakes.len()];
    let start = Start {
        state,
        brakes,
        torques,
        coupling: 0.0,
        supply: 1.0,
        time,
        motor,
        speed,
        until,
        turns,
        accuracy,
    };
    let (trajectory, measures) = guarded(py, ANALYSIS, || {
        let equation = Equation { plan: &known.get().0, q: &q, chain: &chain };
        let trajectory = follow(equation, &start);
        let measures = Reading::new(equation, &start, &trajectory).measures();
        (trajectory, measures)
    })?;
    let size = layout.size;
    let last = &trajectory.states[trajectory.states.len() - size..][..=layout.phi];
    let angles = trajectory.states.iter().skip(layout.phi).step_by(size).copied().collect();
    Ok(DrivelineInTime {
        time: column(py, trajectory.t.clone()).unbind(),
        crank_angle: column(py, angles).unbind(),
        state: column(py, last.to_vec()).unbind(),
        end: word(trajectory.end),
        torque_drive_end: trajectory.torques[0],
        torque_load_end: trajectory.torques[1],
        speed: extremes(py, &measures.speed)?,
        acceleration: extremes(py, &measures.acceleration)?,
        twist: extremes(py, &measures.twist)?,
        torque: extremes(py, &measures.torque)?,
        energy_error: measures.energy_error,
        evaluations: trajectory.evaluations,
        implicit: trajectory.implicit,
        events: trajectory.events.iter().map(named).collect(),
        plan: known,
        q,
        chain,
        start,
        trajectory,
    })
}
