//! The machine reduced to its crank, and its motion: calls and results.

use linkwright_core::drive::batch::{self, Outcome, QUANTITIES, Rows};
use linkwright_core::drive::kinks as core_kinks;
use linkwright_core::drive::reading::{Curves, ReadCurves};
use linkwright_core::drive::reduce::{self, Reduction};
use linkwright_core::drive::steady::{Failure, Steady, steady_with_others};
use linkwright_core::drive::transient::{End, Start, Turning, follow};
use linkwright_derivatives::along;
use linkwright_derivatives::gradient::{CURVES, CurvesAlong, Gradient, NUMBERS, SolutionAlong};
use linkwright_derivatives::variation::{SolvedMotion, Variation};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arrays::{as_indices, column};
use crate::builder::Plan;
use crate::guard::{filled, guarded, require_room};
use crate::linkage::directions;
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

/// Steady motion of one machine: curves over the crank angles asked for, extremes and integrals of the revolution.
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
    torque_motor_min: f64,
    torque_motor_max: f64,
    power_motor_max: f64,
    accuracy: f64,
    sweeps: u32,
    steps: usize,
    others: Vec<OtherMotion>,
    away_from: f64,
    undecided_above: f64,
    undecided_below: f64,
    solution: Py<SteadySolution>,
}

impl SteadyMotion {
    fn of(py: Python<'_>, plan: Py<Plan>, q: &[f64], found: Steady, curves: Curves) -> PyResult<Self> {
        let (extremes, totals) = (&found.extremes, &found.totals);
        let [slowest, fastest] = [extremes.speed_min.value, extremes.speed_max.value];
        let motor = plan.get().0.motor_extremes(q, slowest, fastest);
        let other = |each: &linkwright_core::drive::steady::OtherMotion| OtherMotion {
            speed_min: each.speed_min,
            speed_max: each.speed_max,
            period: each.period,
            multiplier: each.multiplier,
        };
        Ok(SteadyMotion {
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
            torque_motor_min: motor.torque_min,
            torque_motor_max: motor.torque_max,
            power_motor_max: motor.power_max,
            accuracy: found.reached.max(found.rounding),
            sweeps: found.sweeps,
            steps: found.marks.len(),
            others: found.others.iter().map(other).collect(),
            away_from: found.beyond.away_from,
            undecided_above: found.beyond.undecided_above,
            undecided_below: found.beyond.undecided_below,
            solution: Py::new(py, SteadySolution { plan, q: q.to_vec(), steady: found })?,
        })
    }
}

/// The solution of a revolution, with the machine that it is of.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct SteadySolution {
    plan: Py<Plan>,
    q: Vec<f64>,
    steady: Steady,
}

/// Curves of steady motion, or their derivatives, over crank angles.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct SteadyCurves {
    time: Py<PyArrayDyn<f64>>,
    speed: Py<PyArrayDyn<f64>>,
    acceleration: Py<PyArrayDyn<f64>>,
    torque_motor: Py<PyArrayDyn<f64>>,
    torque_drive: Py<PyArrayDyn<f64>>,
    torque_load: Py<PyArrayDyn<f64>>,
    inertia_reduced: Py<PyArrayDyn<f64>>,
}

impl SteadyCurves {
    /// Of lists in the order of `drive::gradient`, in one shape.
    fn of(py: Python<'_>, lists: [&[f64]; CURVES], shape: &[usize]) -> PyResult<Self> {
        let curve = |list: &[f64]| Ok::<_, PyErr>(PyArray1::from_slice(py, list).reshape(shape)?.unbind());
        let [time, speed, acceleration, motor, drive, load, inertia] = lists;
        Ok(SteadyCurves {
            time: curve(time)?,
            speed: curve(speed)?,
            acceleration: curve(acceleration)?,
            torque_motor: curve(motor)?,
            torque_drive: curve(drive)?,
            torque_load: curve(load)?,
            inertia_reduced: curve(inertia)?,
        })
    }
}

#[pymethods]
impl SteadySolution {
    fn curves(&self, py: Python<'_>, phi: Floats<'_>) -> PyResult<SteadyCurves> {
        let (plan, q, phi) = (&self.plan.get().0, &self.q, phi.as_slice()?);
        let analysis = "curves of steady motion";
        require_room(analysis, [CURVES, phi.len()])?;
        let (marks, between) = (&self.steady.marks, self.steady.between.as_deref());
        let read = guarded(py, analysis, || ReadCurves { plan, q, marks, between, phi }.curves())?;
        let Curves { time, omega, epsilon, motor_torque, drive_torque, load_torque, J } = &read;
        let lists = [time, omega, epsilon, motor_torque, drive_torque, load_torque, J];
        SteadyCurves::of(py, lists.map(Vec::as_slice), &[phi.len()])
    }

    fn gradient(
        slf: Bound<'_, Self>,
        directions: PyReadonlyArray2<'_, f64>,
        sizes: Floats<'_>,
    ) -> PyResult<SteadyGradient> {
        let (py, own) = (slf.py(), slf.get());
        let (plan, q, sizes) = (&own.plan.get().0, &own.q, sizes.as_slice()?);
        let [rows, n] = [directions.as_array().nrows(), directions.as_array().ncols()];
        if rows != q.len() {
            let text = format!("directions of {rows} numbers, {} parameters", q.len());
            return Err(PyIndexError::new_err(text));
        }
        if sizes.len() != n {
            return Err(PyIndexError::new_err(format!("{} sizes, {n} directions", sizes.len())));
        }
        let directions = directions.as_slice()?;
        require_room(DERIVATIVES, [n, NUMBERS])?;
        let steady = &own.steady;
        let found =
            guarded(py, DERIVATIVES, || Gradient { plan, q, directions, sizes, steady }.derivatives())?;
        // In the order of `drive::gradient`.
        let number = |k: usize| kept(py, found.numbers[k * n..(k + 1) * n].to_vec());
        Ok(SteadyGradient {
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
            lost: kept(py, found.lost.clone()),
            directions: directions.to_vec(),
            sizes: sizes.to_vec(),
            along: found.along,
            of: slf.unbind(),
        })
    }
}

/// Why there is no steady motion.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct NoSteadyMotion {
    status: Status,
    crank_angle: f64,
    speed: f64,
    speed_slowest: f64,
    accuracy: f64,
}

/// Either of them.
#[derive(IntoPyObject)]
pub(crate) enum SteadyOutcome {
    Motion(Py<SteadyMotion>),
    None(NoSteadyMotion),
}

#[pyfunction]
pub(crate) fn steady_state(
    py: Python<'_>,
    plan: Bound<'_, Plan>,
    q: Floats<'_>,
    accuracy: f64,
    phi: Floats<'_>,
) -> PyResult<SteadyOutcome> {
    let known = plan.unbind();
    let (q, phi) = (known.get().parameters(&q)?, phi.as_slice()?);
    let plan = &known.get().0;
    let analysis = "steady motion";
    require_room(analysis, [7, phi.len()])?;
    let solved = guarded(py, analysis, || {
        let found = steady_with_others(plan, q, accuracy)?;
        let curves =
            ReadCurves { plan, q, marks: &found.marks, between: found.between.as_deref(), phi }.curves();
        Ok::<_, Failure>((found, curves))
    })?;
    Ok(match solved {
        Ok((found, curves)) => {
            let motion = SteadyMotion::of(py, known.clone_ref(py), q, found, curves)?;
            SteadyOutcome::Motion(Py::new(py, motion)?)
        }
        Err(Failure { status, phi, omega, slowest, reached }) => SteadyOutcome::None(NoSteadyMotion {
            status: status.into(),
            crank_angle: phi,
            speed: omega,
            speed_slowest: slowest,
            accuracy: reached,
        }),
    })
}

/// The analysis of derivatives, in messages.
const DERIVATIVES: &str = "derivatives of steady motion";

/// Derivatives of steady motion along directions of the parameters.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct SteadyGradient {
    #[pyo3(get)]
    speed_min: Array,
    #[pyo3(get)]
    speed_max: Array,
    #[pyo3(get)]
    acceleration_min: Array,
    #[pyo3(get)]
    acceleration_max: Array,
    #[pyo3(get)]
    period: Array,
    #[pyo3(get)]
    multiplier: Array,
    #[pyo3(get)]
    energy_motor: Array,
    #[pyo3(get)]
    energy_drive: Array,
    #[pyo3(get)]
    energy_load: Array,
    #[pyo3(get)]
    torque_motor_mean: Array,
    #[pyo3(get)]
    torque_motor_rms: Array,
    #[pyo3(get)]
    lost: Array,
    of: Py<SteadySolution>,
    directions: Vec<f64>,
    sizes: Vec<f64>,
    along: SolutionAlong,
}

#[pymethods]
impl SteadyGradient {
    fn curves(&self, py: Python<'_>, phi: Floats<'_>) -> PyResult<SteadyCurves> {
        let (own, phi, n) = (self.of.get(), phi.as_slice()?, self.sizes.len());
        require_room(DERIVATIVES, [n, CURVES * phi.len()])?;
        let (plan, q, steady, along) = (&own.plan.get().0, &own.q, &own.steady, &self.along);
        let (directions, sizes) = (&self.directions, &self.sizes);
        let of = Gradient { plan, q, directions, sizes, steady };
        let found = guarded(py, DERIVATIVES, || CurvesAlong { of, along, phi }.curves())?;
        let size = phi.len() * n;
        SteadyCurves::of(py, std::array::from_fn(|k| &found[k * size..(k + 1) * size]), &[phi.len(), n])
    }
}

/// Steady motion of many machines, an array over them each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct SteadyRows {
    status: Py<PyArray1<u8>>,
    fast_starts: Py<PyArray1<u8>>,
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
    let (outcome, columns) = guarded(py, analysis, || {
        let mut table = vec![0.0; n * QUANTITIES];
        let outcome = batch::steady_rows(&plan.0, &rows, accuracy, &mut table);
        let column = |k: usize| table.iter().skip(k).step_by(QUANTITIES).copied().collect::<Vec<f64>>();
        (outcome, std::array::from_fn::<_, QUANTITIES, _>(column))
    })?;
    let Outcome { status, fast_starts, sweeps: turns_swept } = outcome;
    let status = status.into_iter().map(|status| status as u8).collect();
    let fast_starts = fast_starts.into_iter().map(|starts| starts as u8).collect();
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
        fast_starts: PyArray1::from_vec(py, fast_starts).unbind(),
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
    factors: Py<PyArray3<f64>>,
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
        End::Slides => "SLIDES",
    }
}

#[pyfunction]
pub(crate) fn transient(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    start: (f64, f64),
    turning: (i8, i8),
    duration: f64,
    turns: f64,
    accuracy: f64,
) -> PyResult<MotionInTime> {
    let q = plan.parameters(&q)?;
    let (phi, omega) = start;
    let turning = Turning { crank: f64::from(turning.0), motor: f64::from(turning.1) };
    let start = Start { phi, omega, turning, duration, turns, accuracy };
    let path = guarded(py, "motion in time", || follow(&plan.0, q, &start))?;
    let steps = path.between.len();
    let factors = path.between.into_iter().flatten().flatten().collect();
    let factors = column(py, factors).reshape([steps, 2, 7])?.unbind();
    Ok(MotionInTime {
        end: name_of(path.end),
        time: kept(py, path.t),
        crank_angle: kept(py, path.phi),
        speed: kept(py, path.omega),
        acceleration: kept(py, path.epsilon),
        factors,
        implicit: PyArray1::from_vec(py, path.implicit).unbind(),
        torque_drive_end: path.drive_torque,
        torque_load_end: path.load_torque,
        evaluations: path.evaluations,
    })
}

/// Angles and speeds of a motion in time at some instants within it.
#[pyfunction]
pub(crate) fn motion_at<'py>(
    py: Python<'py>,
    time: Floats<'_>,
    angle: Floats<'_>,
    speed: Floats<'_>,
    factors: PyReadonlyArray3<'_, f64>,
    at: Floats<'_>,
) -> PyResult<(Curve<'py>, Curve<'py>)> {
    let (t, phi, omega) = (time.as_slice()?, angle.as_slice()?, speed.as_slice()?);
    let steps = t.len().saturating_sub(1);
    if steps == 0 || [phi.len(), omega.len()] != [t.len(); 2] || factors.as_array().shape() != [steps, 2, 7] {
        let text = format!("factors of shape {:?} for {} times", factors.as_array().shape(), t.len());
        return Err(PyIndexError::new_err(text));
    }
    let (between, at) = (factors.as_slice()?, at.as_slice()?);
    let analysis = "motion in time";
    require_room(analysis, [at.len(), 2])?;
    let [angle, speed] = guarded(py, analysis, || SolvedMotion { t, phi, omega, between }.read(at))?;
    Ok((column(py, angle), column(py, speed)))
}

/// Derivatives of a motion in time at some instants along directions of the parameters.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct MotionVariations {
    crank_angle: Py<PyArray2<f64>>,
    speed: Py<PyArray2<f64>>,
    acceleration: Array,
}

#[pyfunction]
pub(crate) fn transient_along(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    values: PyReadonlyArray2<'_, f64>,
    start: PyReadonlyArray2<'_, f64>,
    time: Floats<'_>,
    states: PyReadonlyArray2<'_, f64>,
    between: PyReadonlyArray3<'_, f64>,
    at: Floats<'_>,
) -> PyResult<MotionVariations> {
    let q = plan.parameters(&q)?;
    let of = directions(plan, q, &values)?;
    let (n, at, t) = (of.n, at.as_slice()?, time.as_slice()?);
    let shapes = [start.as_array().shape(), states.as_array().shape(), between.as_array().shape()].concat();
    let steps = t.len().saturating_sub(1);
    if steps == 0 || shapes != [2, n, 2, t.len(), steps, 2, 7] {
        let text = format!("start, states, steps of shapes {shapes:?} for {n} directions, {} times", t.len());
        return Err(PyIndexError::new_err(text));
    }
    let (phi, omega) = states.as_slice()?.split_at(t.len());
    let (start, motion) = (start.as_slice()?, SolvedMotion { t, phi, omega, between: between.as_slice()? });
    let analysis = "derivatives of motion in time";
    require_room(analysis, [at.len(), 2 * n])?;
    let found = guarded(py, analysis, || Variation { of, start, motion, at }.derivatives())?;
    let table = |list: Vec<f64>| Ok::<_, PyErr>(column(py, list).reshape([at.len(), n])?.unbind());
    Ok(MotionVariations {
        crank_angle: table(found.phi)?,
        speed: table(found.omega)?,
        acceleration: kept(py, found.epsilon),
    })
}

/// The machine reduced to its crank, at crank angles.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct Reductions {
    inertia: Array,
    inertia_slope: Array,
    load: Array,
    dry: Array,
    viscous: Array,
}

#[pyfunction]
pub(crate) fn reductions(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
) -> PyResult<Reductions> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let (analysis, n) = ("reduction to the crank", phi.len());
    require_room(analysis, [10, n])?;
    let found = guarded(py, analysis, || reduce::reductions(&plan.0, q, phi, 1.0))?;
    let column = |of: fn(&Reduction<f64>) -> f64| kept(py, found.iter().map(of).collect());
    Ok(Reductions {
        inertia: column(|r| r.J),
        inertia_slope: column(|r| r.J_d1),
        load: column(|r| r.load),
        dry: column(|r| r.dry),
        viscous: column(|r| r.viscous),
    })
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

/// Torque of the motor at its shaft and at the crank.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct MotorTorques {
    motor: Array,
    crank: Array,
}

#[pyfunction]
pub(crate) fn motor_torques(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    omega: Floats<'_>,
) -> PyResult<MotorTorques> {
    let q = plan.parameters(&q)?;
    let omega = omega.as_slice()?;
    let (motor, crank) = guarded(py, "torques of the motor", || {
        let motor: Vec<f64> =
            omega.iter().map(|&omega| plan.0.drive.motor_torque(&plan.0.tables, q, omega)).collect();
        let crank = motor.iter().map(|&torque| plan.0.drive.geared_torque(q, torque)).collect();
        (motor, crank)
    })?;
    Ok(MotorTorques { motor: kept(py, motor), crank: kept(py, crank) })
}

#[pyfunction]
pub(crate) fn kinks<'py>(py: Python<'py>, plan: &Plan, q: Floats<'_>) -> PyResult<Curve<'py>> {
    let q = plan.parameters(&q)?;
    Ok(column(py, guarded(py, "kinks of the motion", || core_kinks::kinks(&plan.0, q))?))
}

/// Derivatives of crank angles by directions, where they are kinks, (angles, n).
#[pyfunction]
pub(crate) fn kinks_along<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    values: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
) -> PyResult<Table<'py>> {
    let of = directions(plan, plan.parameters(&q)?, &values)?;
    let phi = phi.as_slice()?;
    filled(py, "derivatives of kinks", [phi.len(), of.n], |to| along::kinks_along(of, phi, to))
}

/// Derivatives of the reduced inertia and of its slope by directions at crank angles, (2 × angles, n).
#[pyfunction]
pub(crate) fn inertias_along<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    values: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
) -> PyResult<Table<'py>> {
    let of = directions(plan, plan.parameters(&q)?, &values)?;
    let phi = phi.as_slice()?;
    filled(py, "derivatives of the inertia", [2 * phi.len(), of.n], |to| along::inertias_along(of, phi, to))
}
