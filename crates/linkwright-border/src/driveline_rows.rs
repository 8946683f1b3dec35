//! Steady motion of many elastic drivelines of one structure at the border.

use linkwright_core::drive::batch::Rows;
use linkwright_driveline::batch::{Batch, Motion};
use linkwright_driveline::reading::{Extremes, Measures};
use linkwright_driveline::request::Request;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arrays::{as_indices, column};
use crate::builder::Plan;
use crate::driveline::rows;
use crate::driveline_chain::Driveline;
use crate::guard::{guarded, require_room};
use crate::{Floats, Ints};

type Array = Py<PyArray1<f64>>;
type Table = Py<PyArray2<f64>>;
type Columns<'py> = PyReadonlyArray2<'py, f64>;

const ANALYSIS: &str = "steady motion of many drivelines";

/// Extremes of masses, links or drivers of every machine, (parts, n).
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineExtremes {
    least: Table,
    greatest: Table,
}

/// Steady motion of n drivelines, (n,) or (parts, n); NaN where it was not found.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineRows {
    period: Array,
    speed: Py<DrivelineExtremes>,
    acceleration: Py<DrivelineExtremes>,
    twist: Py<DrivelineExtremes>,
    torque: Py<DrivelineExtremes>,
    torque_mean: Table,
    torque_rms: Table,
    loss: Table,
    torque_drive: Py<DrivelineExtremes>,
    torque_drive_mean: Table,
    energy_drive: Table,
    energy_load: Array,
    monodromy: Table,
    accuracy: Array,
}

/// Results of every machine as columns.
struct Found(Vec<Option<Motion>>);

impl Found {
    fn one(&self, py: Python<'_>, of: impl Fn(&Motion) -> f64) -> Array {
        let number = |motion: &Option<Motion>| motion.as_ref().map_or(f64::NAN, &of);
        column(py, self.0.iter().map(number).collect()).unbind()
    }

    fn parts(&self, py: Python<'_>, parts: usize, of: impl Fn(&Motion, usize) -> f64) -> PyResult<Table> {
        let number = |part: usize, motion: &Option<Motion>| motion.as_ref().map_or(f64::NAN, |m| of(m, part));
        let all = (0..parts).flat_map(|part| self.0.iter().map(move |motion| (part, motion)));
        rows(py, all.map(|(part, motion)| number(part, motion)).collect(), parts)
    }

    fn extremes(
        &self,
        py: Python<'_>,
        parts: usize,
        of: fn(&Measures) -> &[Extremes],
    ) -> PyResult<Py<DrivelineExtremes>> {
        let least = self.parts(py, parts, |motion, part| of(&motion.measures)[part].min)?;
        let greatest = self.parts(py, parts, |motion, part| of(&motion.measures)[part].max)?;
        Py::new(py, DrivelineExtremes { least, greatest })
    }
}

#[pyfunction]
#[pyo3(signature = (plan, q, slots, values, chain, *, numbers, accuracy, speed, fastest, cycles_max, multiples))]
pub(crate) fn driveline_rows(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: Columns<'_>,
    chain: Driveline<'_>,
    numbers: Columns<'_>,
    accuracy: f64,
    speed: Floats<'_>,
    fastest: Floats<'_>,
    cycles_max: usize,
    multiples: usize,
) -> PyResult<DrivelineRows> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let varied = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let chain = chain.chain()?;
    let (speed, fastest, count) = (speed.as_slice()?, fastest.as_slice()?, chain.numbers().len());
    if [speed.len(), fastest.len(), numbers.as_array().nrows()] != [n; 3]
        || numbers.as_array().ncols() != count
    {
        return Err(PyIndexError::new_err("drivelines: numbers for every row are needed"));
    }
    let (masses, links, states) = (chain.masses(), chain.links.len(), chain.states());
    let drivers = chain.drivers.len();
    require_room(ANALYSIS, [n, 5 + 4 * (masses + drivers) + 7 * links + states * states])?;
    let request = |(&speed, &fastest): (&f64, &f64)| Request {
        accuracy,
        speed,
        fastest,
        cycles_first: 0,
        cycles_max,
        multiples,
        start: None,
    };
    let requests: Vec<Request> = speed.iter().zip(fastest).map(request).collect();
    let numbers = numbers.as_slice()?;
    let batch = Batch { plan: &plan.0, rows: &varied, chain: &chain, numbers, requests: &requests };
    let found = Found(guarded(py, ANALYSIS, || batch.motions())?);
    Ok(DrivelineRows {
        period: found.one(py, |motion| motion.measures.period),
        speed: found.extremes(py, masses, |m| &m.speed)?,
        acceleration: found.extremes(py, masses, |m| &m.acceleration)?,
        twist: found.extremes(py, links, |m| &m.twist)?,
        torque: found.extremes(py, links, |m| &m.torque)?,
        torque_mean: found.parts(py, links, |motion, link| motion.measures.torque_mean[link])?,
        torque_rms: found.parts(py, links, |motion, link| motion.measures.torque_rms[link])?,
        loss: found.parts(py, links, |motion, link| motion.measures.loss[link])?,
        torque_drive: found.extremes(py, drivers, |m| &m.drive)?,
        torque_drive_mean: found.parts(py, drivers, |motion, driver| motion.measures.drive_mean[driver])?,
        energy_drive: found.parts(py, drivers, |motion, driver| motion.measures.drive_work[driver])?,
        energy_load: found.one(py, |motion| motion.measures.load_work),
        monodromy: found.parts(py, states * states, |motion, at| motion.monodromy[at])?,
        accuracy: found.one(py, |motion| motion.reached),
    })
}

/// Minimum inertia reduced to the crank over some angles, of n machines \[kg m²\].
#[pyfunction]
pub(crate) fn least_inertias<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: Columns<'_>,
    phi: Floats<'_>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let varied = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let phi = phi.as_slice()?;
    let found = guarded(py, ANALYSIS, || linkwright_driveline::batch::least_inertias(&plan.0, &varied, phi))?;
    Ok(column(py, found))
}
