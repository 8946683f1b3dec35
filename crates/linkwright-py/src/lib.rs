//! `linkwright._core`: converts arrays, lets the interpreter lock go, calls the core, converts back.
//! There is no arithmetic here.
// The functions' arguments are the border itself; each is described in `_core.pyi`.
#![allow(missing_docs, clippy::too_many_arguments)]

mod arrays;
mod cam;
mod errors;
mod guard;
mod topper;
mod torsion;
mod torsion_transient;

use arrays::{as_indices, below, channels, column};
use errors::plan_error;
use guard::{filled, guarded, keep_panics, zeros};
use linkwright_core::drive::batch::{self, QUANTITIES, Rows};
use linkwright_core::drive::kinks as core_kinks;
use linkwright_core::drive::reading::ReadCurves;
use linkwright_core::drive::steady::{Failure, steady_with_others};
use linkwright_core::drive::structure::Plan as CorePlan;
use linkwright_core::drive::transient::{Start, follow};
use linkwright_core::kernel::lanes::in_lanes;
use linkwright_core::linkage::in_line::InLine as CoreInLine;
use linkwright_core::linkage::trace;
use linkwright_core::plan::Encoded;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

type InLine = (usize, f64, f64, Vec<f64>, Vec<f64>, (bool, bool));
type Ints<'py> = PyReadonlyArray1<'py, i32>;
type Floats<'py> = PyReadonlyArray1<'py, f64>;

/// A machine's structure, decoded and checked.
#[pyclass(frozen, module = "linkwright._core")]
struct Plan(CorePlan);

#[pymethods]
impl Plan {
    #[new]
    fn new(
        py: Python<'_>,
        sizes: Ints<'_>,
        elements: Ints<'_>,
        bodies: Ints<'_>,
        loads: Ints<'_>,
        drive: Ints<'_>,
        table_starts: Ints<'_>,
        table_x: Floats<'_>,
        table_y: Floats<'_>,
        formulas: Ints<'_>,
        motion_laws: Floats<'_>,
    ) -> PyResult<Self> {
        let code = Encoded {
            sizes: sizes.as_slice()?,
            elements: elements.as_slice()?,
            bodies: bodies.as_slice()?,
            loads: loads.as_slice()?,
            drive: drive.as_slice()?,
            table_starts: table_starts.as_slice()?,
            table_x: table_x.as_slice()?,
            table_y: table_y.as_slice()?,
            formulas: formulas.as_slice()?,
            motion_laws: motion_laws.as_slice()?,
        };
        guarded(py, "translation of the machine", || CorePlan::decode(&code))?.map(Plan).map_err(plan_error)
    }

    #[getter]
    fn has_laws(&self) -> bool {
        !self.0.laws.is_empty()
    }
}

impl Plan {
    fn parameters<'a>(&self, q: &'a Floats<'_>) -> PyResult<&'a [f64]> {
        let q = q.as_slice()?;
        let n = self.0.n_parameters;
        if q.len() == n {
            Ok(q)
        } else {
            Err(PyValueError::new_err(format!("{} parameters given, the plan has {n}", q.len())))
        }
    }
}

type Curve<'py> = Bound<'py, PyArray1<f64>>;
type Table<'py> = Bound<'py, PyArray2<f64>>;
/// Status, scalars, curves.
type Solved<'py> = (u8, Curve<'py>, Option<Table<'py>>);
/// Status and scalars of every row, and turns swept.
type SolvedRows<'py> = (Bound<'py, PyArray1<u8>>, Table<'py>, u64);
/// How it ended, torques there, evaluations, and t, φ, ω, ε, and the polynomials of the steps.
type Followed<'py> = (u8, [f64; 2], usize, Vec<Curve<'py>>);

/// Crank angles, x and y of each joint there, and the turns after which the motion repeats.
type Traced<'py> = (Curve<'py>, Vec<Curve<'py>>, Option<u32>);

#[pyfunction]
fn steady_state<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    accuracy: f64,
    phi: Floats<'_>,
) -> PyResult<Solved<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let solved = guarded(py, "steady motion", || {
        let found = steady_with_others(&plan.0, q, accuracy)?;
        let curves = in_lanes(ReadCurves { plan: &plan.0, q, marks: &found.marks, phi });
        Ok((found, curves))
    })?;
    let (found, curves) = match solved {
        Ok(solved) => solved,
        Err(failure) => {
            let failure: Failure = failure;
            let places = vec![failure.phi, failure.omega, failure.reached];
            return Ok((failure.status as u8, PyArray1::from_vec(py, places), None));
        }
    };
    let mut scalars = batch::row_of_steady(&found).to_vec();
    scalars.extend([
        found.extremes.acceleration_min.phi,
        found.extremes.acceleration_max.phi,
        found.reached,
        f64::from(found.sweeps),
        found.marks.len() as f64,
    ]);
    for other in &found.others {
        scalars.extend([other.speed_min, other.speed_max, other.period, other.multiplier]);
    }
    let rows = [
        &curves.time,
        &curves.omega,
        &curves.epsilon,
        &curves.motor_torque,
        &curves.drive_torque,
        &curves.load_torque,
        &curves.J,
    ];
    let table = zeros(py, "steady motion", [rows.len(), phi.len()])?;
    {
        let mut to = table.readwrite();
        for (to, from) in to.as_slice_mut()?.chunks_exact_mut(phi.len().max(1)).zip(rows) {
            to.copy_from_slice(from);
        }
    }
    Ok((0, PyArray1::from_vec(py, scalars), Some(table)))
}

#[pyfunction]
fn steady_rows<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: PyReadonlyArray2<'_, f64>,
    accuracy: f64,
) -> PyResult<SolvedRows<'py>> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let analysis = "steady motion of many machines";
    let out = zeros(py, analysis, [n, QUANTITIES])?;
    let (status, turns) = {
        let mut to = out.readwrite();
        let to = to.as_slice_mut()?;
        guarded(py, analysis, || batch::steady_rows(&plan.0, &rows, accuracy, to))?
    };
    let status: Vec<u8> = status.into_iter().map(|s| s as u8).collect();
    Ok((PyArray1::from_vec(py, status), out, turns))
}

#[pyfunction]
fn motions(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
    what: PyReadonlyArray2<'_, i32>,
    mut out: PyReadwriteArray1<'_, f64>,
) -> PyResult<()> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let channels = channels(what.as_slice()?, &plan.0)?;
    let (phi, out) = (phi.as_slice()?, out.as_slice_mut()?);
    let size = n * phi.len() * channels.iter().map(|c| c.width()).sum::<usize>();
    if out.len() != size {
        return Err(PyValueError::new_err(format!("out holds {} numbers, {size} are needed", out.len())));
    }
    guarded(py, "motions", || batch::motions(&plan.0, &rows, phi, &channels, out))
}

#[pyfunction]
fn third<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
    what: PyReadonlyArray2<'_, i32>,
) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let channels = channels(what.as_slice()?, &plan.0)?;
    let width = channels.iter().map(|c| c.third_width()).sum();
    filled(py, "third derivatives", [width, phi.len()], |to| batch::third(&plan.0, q, phi, &channels, to))
}

#[pyfunction]
fn in_line(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: PyReadonlyArray2<'_, f64>,
    element: usize,
) -> PyResult<Vec<InLine>> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    below(element, plan.0.mechanism.elements.len())?;
    let found = guarded(py, "change points", || batch::rows_in_line(&plan.0, &rows, element))?;
    let tuple = |(row, at): (usize, CoreInLine)| (row, at.phi, at.spare, at.series, at.arms, at.lost.into());
    Ok(found.into_iter().map(tuple).collect())
}

#[pyfunction]
fn follow_group<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    element: usize,
    phi: f64,
    near: Floats<'_>,
) -> PyResult<Option<Traced<'py>>> {
    let (q, near) = (plan.parameters(&q)?, near.as_slice()?);
    below(element, plan.0.mechanism.elements.len())?;
    let mechanism = &plan.0.mechanism;
    let found = guarded(py, "assembly of a group", || trace::follow(mechanism, element, q, phi, near))?;
    Ok(found.map(|path| {
        let places = path.places.into_iter().map(|list| column(py, list)).collect();
        (column(py, path.phi), places, path.turns)
    }))
}

#[pyfunction]
fn gaps<'py>(py: Python<'py>, plan: &Plan, q: Floats<'_>, phi: Floats<'_>) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let shape = [plan.0.mechanism.n_gaps, phi.len()];
    filled(py, "closure", shape, |to| batch::gaps(&plan.0, q, phi, to))
}

#[pyfunction]
fn reductions<'py>(py: Python<'py>, plan: &Plan, q: Floats<'_>, phi: Floats<'_>) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    filled(py, "reduction to the crank", [5, phi.len()], |to| batch::reductions(&plan.0, q, phi, to))
}

#[pyfunction]
fn law_torques<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
    omega: Floats<'_>,
) -> PyResult<Table<'py>> {
    let (q, phi, omega) = (plan.parameters(&q)?, phi.as_slice()?, omega.as_slice()?);
    let shape = [omega.len(), phi.len()];
    filled(py, "torques of the laws", shape, |to| batch::law_torques(&plan.0, q, phi, omega, to))
}

#[pyfunction]
fn motor_torques<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    omega: Floats<'_>,
) -> PyResult<(Curve<'py>, Curve<'py>)> {
    let q = plan.parameters(&q)?;
    let omega = omega.as_slice()?;
    let (motor, crank) = guarded(py, "torques of the motor", || {
        let motor: Vec<f64> =
            omega.iter().map(|&omega| plan.0.drive.motor_torque(&plan.0.tables, q, omega)).collect();
        let crank = motor.iter().map(|&torque| plan.0.drive.geared_torque(q, torque)).collect();
        (motor, crank)
    })?;
    Ok((PyArray1::from_vec(py, motor), PyArray1::from_vec(py, crank)))
}

#[pyfunction]
fn transient<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: f64,
    omega: f64,
    duration: f64,
    turns: f64,
    accuracy: f64,
) -> PyResult<Followed<'py>> {
    let q = plan.parameters(&q)?;
    let start = Start { phi, omega, duration, turns, accuracy };
    let path = guarded(py, "motion in time", || follow(&plan.0, q, &start))?;
    let between = path.between.into_flattened().into_flattened();
    let curves = [path.t, path.phi, path.omega, path.epsilon, between].map(|list| column(py, list));
    let torques = [path.drive_torque, path.load_torque];
    Ok((path.end as u8, torques, path.evaluations, curves.into()))
}

#[pyfunction]
fn kinks<'py>(py: Python<'py>, plan: &Plan, q: Floats<'_>) -> PyResult<Curve<'py>> {
    let q = plan.parameters(&q)?;
    Ok(column(py, guarded(py, "kinks of the motion", || core_kinks::kinks(&plan.0, q))?))
}

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    const FORMAT: u32 = linkwright_core::plan::FORMAT;

    #[pymodule_init]
    #[allow(clippy::unnecessary_wraps)] // pyo3 has it so.
    fn init(_module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        super::keep_panics();
        Ok(())
    }

    #[pymodule_export]
    use super::cam::{Cam, cam_crossings};
    #[pymodule_export]
    use super::topper::TopperKnife;
    #[pymodule_export]
    use super::torsion::{torsion_forced, torsion_modes, torsion_waves};
    #[pymodule_export]
    use super::torsion_transient::TorsionSystem;
    #[pymodule_export]
    use super::{
        Plan, follow_group, gaps, in_line, kinks, law_torques, motions, motor_torques, reductions,
        steady_rows, steady_state, third, transient,
    };
}
