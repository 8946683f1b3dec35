//! Steady motion of torsionally flexible drivelines at the border.

use linkwright_derivatives::elastic::ElasticGradient;
use linkwright_driveline::branch::{BranchPoint, End, Family, branch};
use linkwright_driveline::chain::Chain;
use linkwright_driveline::equation::Equation;
use linkwright_driveline::reading::{Extremes as CoreExtremes, Measures, Reading};
use linkwright_driveline::request::{Failure, Request};
use linkwright_driveline::search::steady;
use linkwright_driveline::steady::Steady;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::builder::Plan;
use crate::driveline_chain::Driveline;
use crate::driveline_gradient::DrivelineGradient;
use crate::guard::{guarded, require_room};
use crate::torsion::Extremes;

pub(crate) type Array = Py<PyArray1<f64>>;
pub(crate) type Table = Py<PyArray2<f64>>;
type Directions<'py> = PyReadonlyArray2<'py, f64>;

const ANALYSIS: &str = "steady motion of the driveline";
const DERIVATIVES: &str = "derivatives of the driveline";

/// Curves of a driveline over crank angles, a row a part.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineCurves {
    time: Array,
    speed: Table,
    acceleration: Table,
    twist: Table,
    torque: Table,
    torque_drive: Table,
    torque_load: Array,
}

/// Steady motion of a driveline, an array over its masses or links each.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct DrivelineMotion {
    #[pyo3(get)]
    period: f64,
    #[pyo3(get)]
    speed: Py<Extremes>,
    #[pyo3(get)]
    acceleration: Py<Extremes>,
    #[pyo3(get)]
    twist: Py<Extremes>,
    #[pyo3(get)]
    torque: Py<Extremes>,
    #[pyo3(get)]
    torque_mean: Array,
    #[pyo3(get)]
    torque_rms: Array,
    #[pyo3(get)]
    loss: Array,
    #[pyo3(get)]
    torque_drive: Py<Extremes>,
    #[pyo3(get)]
    torque_drive_mean: Array,
    #[pyo3(get)]
    energy_drive: Array,
    #[pyo3(get)]
    energy_load: f64,
    #[pyo3(get)]
    monodromy: Table,
    #[pyo3(get)]
    accuracy: f64,
    #[pyo3(get)]
    steps: usize,
    #[pyo3(get)]
    cycles: usize,
    #[pyo3(get)]
    multiple: usize,
    plan: Py<Plan>,
    q: Vec<f64>,
    chain: Chain,
    steady: Steady,
    measures: Measures,
}

/// Why a driveline has no steady motion.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct NoDrivelineMotion {
    reason: &'static str,
    crank_angle: f64,
    speed: f64,
    accuracy: f64,
    parting: f64,
}

/// Either of them.
#[derive(IntoPyObject)]
pub(crate) enum DrivelineOutcome {
    Motion(Py<DrivelineMotion>),
    None(NoDrivelineMotion),
}

pub(crate) fn extremes(py: Python<'_>, list: &[CoreExtremes]) -> PyResult<Py<Extremes>> {
    let of = |part: fn(&CoreExtremes) -> f64| column(py, list.iter().map(part).collect()).unbind();
    let (greatest, greatest_at) = (of(|each| each.max), of(|each| each.max_at));
    let (least, least_at) = (of(|each| each.min), of(|each| each.min_at));
    Py::new(py, Extremes { greatest, greatest_at, least, least_at })
}

pub(crate) fn rows(py: Python<'_>, list: Vec<f64>, rows: usize) -> PyResult<Table> {
    let columns = list.len() / rows.max(1);
    Ok(column(py, list).reshape([rows, columns])?.unbind())
}

impl DrivelineMotion {
    fn new(
        py: Python<'_>,
        plan: &Py<Plan>,
        (q, chain): (Vec<f64>, Chain),
        steady: Steady,
        measures: Measures,
    ) -> PyResult<Self> {
        Ok(DrivelineMotion {
            period: measures.period,
            speed: extremes(py, &measures.speed)?,
            acceleration: extremes(py, &measures.acceleration)?,
            twist: extremes(py, &measures.twist)?,
            torque: extremes(py, &measures.torque)?,
            torque_mean: column(py, measures.torque_mean.clone()).unbind(),
            torque_rms: column(py, measures.torque_rms.clone()).unbind(),
            loss: column(py, measures.loss.clone()).unbind(),
            torque_drive: extremes(py, &measures.drive)?,
            torque_drive_mean: column(py, measures.drive_mean.clone()).unbind(),
            energy_drive: column(py, measures.drive_work.clone()).unbind(),
            energy_load: measures.load_work,
            monodromy: rows(py, steady.monodromy.clone(), chain.states())?,
            accuracy: steady.reached,
            steps: steady.mesh.steps(),
            cycles: steady.cycles,
            multiple: steady.multiple,
            plan: plan.clone_ref(py),
            q,
            chain,
            steady,
            measures,
        })
    }
}

#[pymethods]
impl DrivelineMotion {
    /// State at the start of the cycle.
    #[getter]
    fn start(&self, py: Python<'_>) -> Array {
        column(py, self.steady.solution.start.clone()).unbind()
    }

    fn curves(&self, py: Python<'_>, phi: Floats<'_>) -> PyResult<DrivelineCurves> {
        let (phi, n, links) = (phi.as_slice()?, self.chain.masses(), self.chain.links.len());
        let drivers = self.chain.drivers.len();
        require_room(ANALYSIS, [2 + drivers + 2 * (n + links), phi.len()])?;
        let equation = Equation { plan: &self.plan.get().0, q: &self.q, chain: &self.chain };
        let found = guarded(py, ANALYSIS, || Reading { equation, steady: &self.steady }.curves(phi))?;
        Ok(DrivelineCurves {
            time: column(py, found.time).unbind(),
            speed: rows(py, found.speed, n)?,
            acceleration: rows(py, found.acceleration, n)?,
            twist: rows(py, found.twist, links)?,
            torque: rows(py, found.torque, links)?,
            torque_drive: rows(py, found.drive, drivers)?,
            torque_load: column(py, found.load).unbind(),
        })
    }

    fn gradient(&self, py: Python<'_>, directions: Directions<'_>) -> PyResult<DrivelineGradient> {
        let numbers = self.numbers();
        let values = self.along(&directions, &numbers)?;
        let found =
            guarded(py, DERIVATIVES, || self.derivation(&numbers, &values).derivatives(&self.measures))?;
        DrivelineGradient::new(py, found, &self.chain)
    }

    fn curves_along(&self, py: Python<'_>, directions: Directions<'_>, phi: Floats<'_>) -> PyResult<Table> {
        let (numbers, phi) = (self.numbers(), phi.as_slice()?);
        let values = self.along(&directions, &numbers)?;
        let curves = 2 * (self.chain.masses() + self.chain.links.len()) + self.chain.drivers.len();
        require_room(DERIVATIVES, [curves * phi.len(), values.len() / numbers.len()])?;
        let found = guarded(py, DERIVATIVES, || self.derivation(&numbers, &values).curves(phi))?;
        rows(py, found, curves * phi.len())
    }
}

impl DrivelineMotion {
    /// Numbers of the machine, and behind them those of the driveline.
    fn numbers(&self) -> Vec<f64> {
        self.q.iter().copied().chain(self.chain.numbers()).collect()
    }

    /// Directions of all numbers.
    fn along(&self, directions: &Directions<'_>, numbers: &[f64]) -> PyResult<Vec<f64>> {
        if directions.shape()[0] != numbers.len() || directions.shape()[1] == 0 {
            return Err(PyValueError::new_err(
                "directions: one or more are needed, with a row for every number",
            ));
        }
        Ok(directions.as_slice()?.to_vec())
    }

    fn derivation<'a>(&'a self, numbers: &'a [f64], directions: &'a [f64]) -> ElasticGradient<'a> {
        let (plan, chain, steady) = (&self.plan.get().0, &self.chain, &self.steady);
        ElasticGradient { plan, numbers, chain, steady, directions }
    }
}

#[pyfunction]
#[pyo3(signature = (plan, q, chain, *, accuracy, speed, fastest, cycles_first, cycles_max, multiples, start))]
pub(crate) fn driveline_motion(
    py: Python<'_>,
    plan: Bound<'_, Plan>,
    q: Floats<'_>,
    chain: Driveline<'_>,
    accuracy: f64,
    speed: f64,
    fastest: f64,
    cycles_first: usize,
    cycles_max: usize,
    multiples: usize,
    start: Option<Floats<'_>>,
) -> PyResult<DrivelineOutcome> {
    let known = plan.unbind();
    let (q, chain) = (known.get().parameters(&q)?.to_vec(), chain.chain()?);
    let plan = &known.get().0;
    let start = start.map(|start| start.as_slice().map(<[f64]>::to_vec)).transpose()?;
    if start.as_ref().is_some_and(|start| start.len() != chain.states()) {
        return Err(PyValueError::new_err("driveline: a start has a number for each of the state"));
    }
    let request = Request { accuracy, speed, fastest, cycles_first, cycles_max, multiples, start };
    let solved = guarded(py, ANALYSIS, || {
        let found = steady(plan, &q, &chain, &request)?;
        let equation = Equation { plan, q: &q, chain: &chain };
        let measures = Reading { equation, steady: &found }.measures();
        Ok::<_, Failure>((found, measures))
    })?;
    let none = |reason, [crank_angle, speed, accuracy, parting]: [f64; 4]| {
        Ok(DrivelineOutcome::None(NoDrivelineMotion { reason, crank_angle, speed, accuracy, parting }))
    };
    let unknown = f64::NAN;
    match solved {
        Err(Failure::Stops(stop)) => none("stops", [stop.phi, stop.omega, unknown, unknown]),
        Err(Failure::NotFound { off, parting }) => none("not found", [unknown, unknown, off, parting]),
        Err(Failure::Inaccurate(reached)) => none("inaccurate", [unknown, unknown, reached, unknown]),
        Ok((steady, measures)) => {
            let motion = DrivelineMotion::new(py, &known, (q, chain), steady, measures)?;
            Ok(DrivelineOutcome::Motion(Py::new(py, motion)?))
        }
    }
}

/// A branch of steady motions over a parameter: parameter, whether it turns back there, and the motion; and why it ends.
type Branch = (Vec<(f64, bool, Py<DrivelineMotion>)>, &'static str);

#[pyfunction]
#[pyo3(signature = (plan, *, nodes, machines, accuracy, fastest, parameter, start, direction, points_max))]
pub(crate) fn driveline_branch(
    py: Python<'_>,
    plan: Bound<'_, Plan>,
    nodes: Vec<f64>,
    machines: Vec<(Vec<f64>, Driveline<'_>)>,
    accuracy: f64,
    fastest: f64,
    parameter: f64,
    start: Py<DrivelineMotion>,
    direction: f64,
    points_max: usize,
) -> PyResult<Branch> {
    let known = plan.unbind();
    let chains: PyResult<Vec<_>> =
        machines.into_iter().map(|(q, driveline)| Ok((q, driveline.chain()?))).collect();
    let machines = chains?;
    let alike = |(q, chain): &(Vec<f64>, Chain)| {
        let (first, own) = &machines[0];
        [q.len(), chain.states(), chain.numbers().len()] == [first.len(), own.states(), own.numbers().len()]
    };
    if machines.is_empty() || machines.len() != nodes.len() || !machines.iter().all(alike) {
        return Err(PyValueError::new_err("driveline: machines of one structure, one for each parameter"));
    }
    let family = Family { plan: &known.get().0, nodes, machines };
    let request =
        Request { accuracy, speed: 1.0, fastest, cycles_first: 0, cycles_max: 0, multiples: 1, start: None };
    let first = start.get().steady.clone();
    let (points, end) = guarded(py, ANALYSIS, || {
        let (points, end) = branch(&family, &request, (first, parameter), direction, points_max);
        let read = |point: BranchPoint| {
            let equation = Equation { plan: family.plan, q: &point.q, chain: &point.chain };
            let measures = Reading { equation, steady: &point.steady }.measures();
            (point, measures)
        };
        (points.into_iter().map(read).collect::<Vec<_>>(), end)
    })?;
    let listed = points.into_iter().map(|(point, measures)| {
        let BranchPoint { parameter, q, chain, steady, is_fold } = point;
        let motion = DrivelineMotion::new(py, &known, (q, chain), steady, measures)?;
        Ok((parameter, is_fold, Py::new(py, motion)?))
    });
    let end = match end {
        End::Range => "range",
        End::Points => "points",
        End::Short => "short",
    };
    Ok((listed.collect::<PyResult<_>>()?, end))
}
