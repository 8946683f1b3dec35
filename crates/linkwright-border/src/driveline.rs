//! Steady motion of torsionally flexible drivelines at the border.

use linkwright_driveline::branch::{BranchPoint, End, Family, branch};
use linkwright_driveline::chain::{Chain, Driver, Link};
use linkwright_driveline::equation::Equation;
use linkwright_driveline::law::{Curve, Law};
use linkwright_driveline::reading::{Extremes as CoreExtremes, Measures, Reading};
use linkwright_driveline::request::{Failure, Request};
use linkwright_driveline::steady::{Steady, steady};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{as_indices, column};
use crate::builder::Plan;
use crate::guard::{guarded, require_room};
use crate::torsion::Extremes;
use crate::{Floats, Ints};

type Array = Py<PyArray1<f64>>;
type Table = Py<PyArray2<f64>>;

const ANALYSIS: &str = "steady motion of the driveline";

/// Curves of a driveline over crank angles, a row a part.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineCurves {
    time: Array,
    speed: Table,
    acceleration: Table,
    twist: Table,
    torque: Table,
    torque_drive: Array,
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
    energy_drive: f64,
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
}

/// Why a driveline has no steady motion.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct NoDrivelineMotion {
    reason: &'static str,
    crank_angle: f64,
    speed: f64,
    accuracy: f64,
}

/// Either of them.
#[derive(IntoPyObject)]
pub(crate) enum DrivelineOutcome {
    Motion(Py<DrivelineMotion>),
    None(NoDrivelineMotion),
}

fn extremes(py: Python<'_>, list: &[CoreExtremes]) -> PyResult<Py<Extremes>> {
    let of = |part: fn(&CoreExtremes) -> f64| column(py, list.iter().map(part).collect()).unbind();
    let (greatest, greatest_at) = (of(|each| each.max), of(|each| each.max_at));
    let (least, least_at) = (of(|each| each.min), of(|each| each.min_at));
    Py::new(py, Extremes { greatest, greatest_at, least, least_at })
}

fn rows(py: Python<'_>, list: Vec<f64>, rows: usize) -> PyResult<Table> {
    let columns = list.len() / rows.max(1);
    Ok(column(py, list).reshape([rows, columns])?.unbind())
}

impl DrivelineMotion {
    fn new(
        py: Python<'_>,
        plan: &Py<Plan>,
        (q, chain): (Vec<f64>, Chain),
        steady: Steady,
        measures: &Measures,
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
            energy_drive: measures.drive_work,
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
        require_room(ANALYSIS, [3 + 2 * (n + links), phi.len()])?;
        let equation = Equation { plan: &self.plan.get().0, q: &self.q, chain: &self.chain };
        let found = guarded(py, ANALYSIS, || Reading { equation, steady: &self.steady }.curves(phi))?;
        Ok(DrivelineCurves {
            time: column(py, found.time).unbind(),
            speed: rows(py, found.speed, n)?,
            acceleration: rows(py, found.acceleration, n)?,
            twist: rows(py, found.twist, links)?,
            torque: rows(py, found.torque, links)?,
            torque_drive: column(py, found.drive).unbind(),
            torque_load: column(py, found.load).unbind(),
        })
    }
}

/// Twists, torques and slopes at the points of a link's curve; none of a straight spring.
type Points = Option<[Vec<f64>; 3]>;

/// The law of a link from its stiffness, damping and half of its backlash, and the points of a curve.
fn law([stiffness, damping, gap]: [f64; 3], points: Points) -> PyResult<Law> {
    let wrong = || PyValueError::new_err("links: a curve has to rise from zero");
    let curve = points.map(|[x, y, slope]| Curve::new(&x, &y, &slope).ok_or_else(wrong)).transpose()?;
    Ok(Law { stiffness, damping, gap, curve })
}

/// Links of a driveline from arrays over them: stiffness, damping and half of the backlash.
fn links(
    ends: [&Ints<'_>; 2],
    numbers: [&Floats<'_>; 3],
    curves: Vec<Points>,
    masses: usize,
) -> PyResult<Vec<Link>> {
    let [first, second] =
        [as_indices(ends[0].as_slice()?, masses)?, as_indices(ends[1].as_slice()?, masses)?];
    let [stiffness, damping, gap] = [numbers[0].as_slice()?, numbers[1].as_slice()?, numbers[2].as_slice()?];
    if [first.len(), second.len(), stiffness.len(), damping.len(), gap.len()] != [curves.len(); 5] {
        return Err(PyValueError::new_err("links: arrays of one length are needed"));
    }
    let link = |(i, points): (usize, Points)| {
        let law = law([stiffness[i], damping[i], gap[i]], points)?;
        Ok(Link { first: first[i], second: second[i], law })
    };
    curves.into_iter().enumerate().map(link).collect()
}

#[pyfunction]
#[pyo3(signature = (
    plan, q, *, inertia, apart, first, second, stiffness, damping, gap, curves, driven, held,
    accuracy, speed, fastest, cycles_first, cycles_max, multiples, start
))]
pub(crate) fn driveline_motion(
    py: Python<'_>,
    plan: Bound<'_, Plan>,
    q: Floats<'_>,
    inertia: Floats<'_>,
    apart: f64,
    first: Ints<'_>,
    second: Ints<'_>,
    stiffness: Floats<'_>,
    damping: Floats<'_>,
    gap: Floats<'_>,
    curves: Vec<Points>,
    driven: usize,
    held: Option<f64>,
    accuracy: f64,
    speed: f64,
    fastest: f64,
    cycles_first: usize,
    cycles_max: usize,
    multiples: usize,
    start: Option<Floats<'_>>,
) -> PyResult<DrivelineOutcome> {
    let known = plan.unbind();
    let q = known.get().parameters(&q)?.to_vec();
    let inertia = inertia.as_slice()?.to_vec();
    let links = links([&first, &second], [&stiffness, &damping, &gap], curves, inertia.len() + 1)?;
    let driver = held.map_or(Driver::Motor, Driver::Held);
    let chain = Chain { inertia, apart, links, driven, driver };
    if !chain.fits() {
        return Err(PyIndexError::new_err("driveline: a link or the motor is at no mass"));
    }
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
    let none = |reason, crank_angle, speed, accuracy| {
        Ok(DrivelineOutcome::None(NoDrivelineMotion { reason, crank_angle, speed, accuracy }))
    };
    match solved {
        Err(Failure::Stops(stop)) => none("stops", stop.phi, stop.omega, f64::NAN),
        Err(Failure::NotFound(off)) => none("not found", f64::NAN, f64::NAN, off),
        Err(Failure::Inaccurate(reached)) => none("inaccurate", f64::NAN, f64::NAN, reached),
        Ok((steady, measures)) => {
            let motion = DrivelineMotion::new(py, &known, (q, chain), steady, &measures)?;
            Ok(DrivelineOutcome::Motion(Py::new(py, motion)?))
        }
    }
}

/// Numbers of a driveline, as `driveline_motion` takes them one by one.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ChainNumbers {
    inertia: Vec<f64>,
    apart: f64,
    first: Vec<usize>,
    second: Vec<usize>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    gap: Vec<f64>,
    curves: Vec<Points>,
    driven: usize,
    held: Option<f64>,
}

impl ChainNumbers {
    fn chain(self) -> PyResult<Chain> {
        let wrong =
            || PyValueError::new_err("driveline: arrays of one length are needed, and ends at masses");
        let links = self.first.len();
        if [self.second.len(), self.stiffness.len(), self.damping.len(), self.gap.len(), self.curves.len()]
            != [links; 5]
        {
            return Err(wrong());
        }
        let mut laws = Vec::with_capacity(links);
        for (i, points) in self.curves.into_iter().enumerate() {
            let law = law([self.stiffness[i], self.damping[i], self.gap[i]], points)?;
            laws.push(Link { first: self.first[i], second: self.second[i], law });
        }
        let driver = self.held.map_or(Driver::Motor, Driver::Held);
        let chain =
            Chain { inertia: self.inertia, apart: self.apart, links: laws, driven: self.driven, driver };
        if chain.fits() { Ok(chain) } else { Err(wrong()) }
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
    machines: Vec<(Vec<f64>, ChainNumbers)>,
    accuracy: f64,
    fastest: f64,
    parameter: f64,
    start: Py<DrivelineMotion>,
    direction: f64,
    points_max: usize,
) -> PyResult<Branch> {
    let known = plan.unbind();
    let chains: PyResult<Vec<_>> =
        machines.into_iter().map(|(q, numbers)| Ok((q, numbers.chain()?))).collect();
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
        let motion = DrivelineMotion::new(py, &known, (q, chain), steady, &measures)?;
        Ok((parameter, is_fold, Py::new(py, motion)?))
    });
    let end = match end {
        End::Range => "range",
        End::Points => "points",
        End::Short => "short",
    };
    Ok((listed.collect::<PyResult<_>>()?, end))
}
