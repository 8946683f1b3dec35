//! The machine reduced to its crank, and its motion: calls and results.

use linkwright_core::drive::batch::{self, QUANTITIES, Rows};
use linkwright_core::drive::gradient::{CURVES, Gradient, NUMBERS};
use linkwright_core::drive::kinks as core_kinks;
use linkwright_core::drive::reading::{Curves, ReadCurves};
use linkwright_core::drive::steady::{Failure, Steady, steady, steady_with_others};
use linkwright_core::drive::transient::{End, Start, follow};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arrays::{as_indices, column};
use crate::builder::Plan;
use crate::guard::{filled, guarded, require_room};
use crate::status::Status;
use crate::{Curve, Floats, Ints, Table};

type Array = Py<PyArray1<f64>>;

fn kept(py: Python<'_>, list: Vec<f64>) -> Array {
    column(py, list).unbind()
}

/// A motion that repeats besides the one that was found.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct OtherMotion {
    speed_min: f64,
    speed_max: f64,
    period: f64,
    multiplier: f64,
}

/// Steady motion of one machine: curves over the crank angles asked for, extremes and integrals of the turn.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct SteadyMotion {
    time: Array,
    speed: Array,
    acceleration: Array,
    torque_motor: Array,
    torque_drive: Array,
    torque_load: Array,
    inertia_reduced: Array,
    speed_min: f64,
    speed_max: f64,
    speed_min_angle: f64,
    speed_max_angle: f64,
    acceleration_min: f64,
    acceleration_max: f64,
    acceleration_min_angle: f64,
    acceleration_max_angle: f64,
    period: f64,
    multiplier: f64,
    energy_motor: f64,
    energy_drive: f64,
    energy_load: f64,
    torque_motor_mean: f64,
    torque_motor_rms: f64,
    accuracy: f64,
    sweeps: u32,
    steps: usize,
    others: Vec<OtherMotion>,
}

impl SteadyMotion {
    fn of(py: Python<'_>, found: Steady, curves: Curves) -> Self {
        let (extremes, totals) = (&found.extremes, &found.totals);
        let other = |each: &linkwright_core::drive::steady::Other| OtherMotion {
            speed_min: each.speed_min,
            speed_max: each.speed_max,
            period: each.period,
            multiplier: each.multiplier,
        };
        SteadyMotion {
            time: kept(py, curves.time),
            speed: kept(py, curves.omega),
            acceleration: kept(py, curves.epsilon),
            torque_motor: kept(py, curves.motor_torque),
            torque_drive: kept(py, curves.drive_torque),
            torque_load: kept(py, curves.load_torque),
            inertia_reduced: kept(py, curves.J),
            speed_min: extremes.speed_min.value,
            speed_max: extremes.speed_max.value,
            speed_min_angle: extremes.speed_min.phi,
            speed_max_angle: extremes.speed_max.phi,
            acceleration_min: extremes.acceleration_min.value,
            acceleration_max: extremes.acceleration_max.value,
            acceleration_min_angle: extremes.acceleration_min.phi,
            acceleration_max_angle: extremes.acceleration_max.phi,
            period: totals.period,
            multiplier: found.multiplier,
            energy_motor: totals.motor_work,
            energy_drive: totals.crank_work,
            energy_load: totals.load_work,
            torque_motor_mean: totals.torque_mean,
            torque_motor_rms: totals.torque_rms,
            accuracy: found.reached,
            sweeps: found.sweeps,
            steps: found.marks.len(),
            others: found.others.iter().map(other).collect(),
        }
    }
}

/// Why there is no steady motion.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct NoSteadyMotion {
    status: Status,
    crank_angle: f64,
    speed: f64,
    accuracy: f64,
}

/// Either of them.
#[derive(IntoPyObject)]
pub(crate) enum Solved {
    Motion(SteadyMotion),
    None(NoSteadyMotion),
}

#[pyfunction]
pub(crate) fn steady_state(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    accuracy: f64,
    phi: Floats<'_>,
) -> PyResult<Solved> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let plan = &plan.0;
    let analysis = "steady motion";
    require_room(analysis, [7, phi.len()])?;
    let solved = guarded(py, analysis, || {
        let found = steady_with_others(plan, q, accuracy)?;
        let curves = ReadCurves { plan, q, marks: &found.marks, phi }.curves();
        Ok::<_, Failure>((found, curves))
    })?;
    Ok(match solved {
        Ok((found, curves)) => Solved::Motion(SteadyMotion::of(py, found, curves)),
        Err(Failure { status, phi, omega, reached }) => Solved::None(NoSteadyMotion {
            status: status.into(),
            crank_angle: phi,
            speed: omega,
            accuracy: reached,
        }),
    })
}

/// Derivatives of steady motion along directions of the parameters.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct SteadyGradient {
    speed_min: Array,
    speed_max: Array,
    acceleration_min: Array,
    acceleration_max: Array,
    period: Array,
    multiplier: Array,
    energy_motor: Array,
    energy_drive: Array,
    energy_load: Array,
    torque_motor_mean: Array,
    torque_motor_rms: Array,
    curves: Py<PyArray3<f64>>,
}

#[pyfunction]
pub(crate) fn steady_gradient(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    accuracy: f64,
    directions: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
) -> PyResult<Option<SteadyGradient>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let n = directions.as_array().ncols();
    let rows = directions.as_array().nrows();
    if rows != q.len() {
        let text = format!("directions of {rows} numbers, {} parameters", q.len());
        return Err(PyIndexError::new_err(text));
    }
    let directions = directions.as_slice()?;
    let plan = &plan.0;
    let analysis = "derivatives of steady motion";
    require_room(analysis, [n, NUMBERS + CURVES * phi.len()])?;
    let found = guarded(py, analysis, || {
        let steady = steady(plan, q, accuracy).ok()?;
        Some(Gradient { plan, q, directions, steady: &steady, phi }.derivatives())
    })?;
    let Some(found) = found else { return Ok(None) };
    let number = |k: usize| kept(py, found.numbers[k * n..(k + 1) * n].to_vec());
    // In the order of `drive::gradient`.
    Ok(Some(SteadyGradient {
        speed_min: number(0),
        speed_max: number(1),
        acceleration_min: number(2),
        acceleration_max: number(3),
        period: number(4),
        multiplier: number(5),
        energy_motor: number(6),
        energy_drive: number(7),
        energy_load: number(8),
        torque_motor_mean: number(9),
        torque_motor_rms: number(10),
        curves: column(py, found.curves).reshape([CURVES, phi.len(), n])?.unbind(),
    }))
}

/// Steady motion of many machines, an array over them each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct SteadyRows {
    status: Py<PyArray1<u8>>,
    turns_swept: u64,
    speed_min: Array,
    speed_max: Array,
    acceleration_min: Array,
    acceleration_max: Array,
    period: Array,
    multiplier: Array,
    energy_motor: Array,
    energy_drive: Array,
    energy_load: Array,
    torque_motor_mean: Array,
    torque_motor_rms: Array,
    speed_min_angle: Array,
    speed_max_angle: Array,
}

#[pyfunction]
pub(crate) fn steady_rows(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: PyReadonlyArray2<'_, f64>,
    accuracy: f64,
) -> PyResult<SteadyRows> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let analysis = "steady motion of many machines";
    require_room(analysis, [n, 2 * QUANTITIES])?;
    let (status, turns_swept, columns) = guarded(py, analysis, || {
        let mut table = vec![0.0; n * QUANTITIES];
        let (status, turns) = batch::steady_rows(&plan.0, &rows, accuracy, &mut table);
        let column = |k: usize| table.iter().skip(k).step_by(QUANTITIES).copied().collect::<Vec<f64>>();
        (status, turns, std::array::from_fn::<_, QUANTITIES, _>(column))
    })?;
    let status = status.into_iter().map(|status| status as u8).collect();
    // In the order of a row of `drive::batch`.
    let [
        speed_min,
        speed_max,
        acceleration_min,
        acceleration_max,
        period,
        multiplier,
        energy_motor,
        energy_drive,
        energy_load,
        torque_motor_mean,
        torque_motor_rms,
        speed_min_angle,
        speed_max_angle,
    ] = columns.map(|list| kept(py, list));
    Ok(SteadyRows {
        status: PyArray1::from_vec(py, status).unbind(),
        turns_swept,
        speed_min,
        speed_max,
        acceleration_min,
        acceleration_max,
        period,
        multiplier,
        energy_motor,
        energy_drive,
        energy_load,
        torque_motor_mean,
        torque_motor_rms,
        speed_min_angle,
        speed_max_angle,
    })
}

/// Motion in time, at the ends of the solver's steps.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct MotionInTime {
    end: &'static str,
    time: Array,
    crank_angle: Array,
    speed: Array,
    acceleration: Array,
    between: Py<PyArray2<f64>>,
    implicit: Py<PyArray1<bool>>,
    torque_drive_end: f64,
    torque_load_end: f64,
    evaluations: usize,
}

fn name_of(end: End) -> &'static str {
    match end {
        End::Time => "TIME",
        End::Turns => "TURNS",
        End::DoesNotStart => "DOES_NOT_START",
        End::StartsBackwards => "STARTS_BACKWARDS",
        End::Stall => "STALL",
        End::Reversal => "REVERSAL",
        End::DoesNotClose => "DOES_NOT_CLOSE",
        End::Inaccurate => "INACCURATE",
    }
}

#[pyfunction]
pub(crate) fn transient(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    phi: f64,
    omega: f64,
    duration: f64,
    turns: f64,
    accuracy: f64,
) -> PyResult<MotionInTime> {
    let q = plan.parameters(&q)?;
    let start = Start { phi, omega, duration, turns, accuracy };
    let path = guarded(py, "motion in time", || follow(&plan.0, q, &start))?;
    let steps = path.between.len();
    let between = column(py, path.between.into_flattened().into_flattened()).reshape([steps, 14])?;
    Ok(MotionInTime {
        end: name_of(path.end),
        time: kept(py, path.t),
        crank_angle: kept(py, path.phi),
        speed: kept(py, path.omega),
        acceleration: kept(py, path.epsilon),
        between: between.unbind(),
        implicit: PyArray1::from_vec(py, path.implicit).unbind(),
        torque_drive_end: path.drive_torque,
        torque_load_end: path.load_torque,
        evaluations: path.evaluations,
    })
}

#[pyfunction]
pub(crate) fn reductions<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    filled(py, "reduction to the crank", [5, phi.len()], |to| batch::reductions(&plan.0, q, phi, to))
}

#[pyfunction]
pub(crate) fn law_torques<'py>(
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
pub(crate) fn motor_torques<'py>(
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
    Ok((column(py, motor), column(py, crank)))
}

#[pyfunction]
pub(crate) fn kinks<'py>(py: Python<'py>, plan: &Plan, q: Floats<'_>) -> PyResult<Curve<'py>> {
    let q = plan.parameters(&q)?;
    Ok(column(py, guarded(py, "kinks of the motion", || core_kinks::kinks(&plan.0, q))?))
}
