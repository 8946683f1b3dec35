//! Motions of points, links and slides, and what has to be known of a mechanism beforehand: calls and results.

use linkwright_core::drive::batch::{self, Rows};
use linkwright_core::drive::motions as over_angles;
use linkwright_core::linkage::motion;
use linkwright_core::linkage::trace;
use numpy::{PyArray1, PyReadonlyArray2, PyReadwriteArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{as_indices, below, column};
use crate::builder::Plan;
use crate::guard::{filled, guarded};
use crate::{Floats, Ints, Table};

/// What moves: a point, a link or a slide, by its index.
#[pyclass(frozen, from_py_object, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) enum Channel {
    #[pyo3(constructor = (index))]
    Point { index: usize },
    #[pyo3(constructor = (index))]
    Link { index: usize },
    #[pyo3(constructor = (index))]
    Slide { index: usize },
}

fn channels(list: &[Channel], plan: &Plan) -> PyResult<Vec<motion::Channel>> {
    let m = &plan.0.mechanism;
    let channel = |channel: &Channel| {
        let (index, bound, channel): (_, _, fn(usize) -> motion::Channel) = match *channel {
            Channel::Point { index } => (index, m.n_points, motion::Channel::Point),
            Channel::Link { index } => (index, m.n_links, motion::Channel::Link),
            Channel::Slide { index } => (index, m.n_slides, motion::Channel::Slide),
        };
        below(index, bound).map(|()| channel(index))
    };
    list.iter().map(channel).collect()
}

#[pyfunction]
pub(crate) fn motions(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    slots: Ints<'_>,
    values: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
    what: Vec<Channel>,
    mut out: PyReadwriteArray1<'_, f64>,
) -> PyResult<()> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let channels = channels(&what, plan)?;
    let (phi, out) = (phi.as_slice()?, out.as_slice_mut()?);
    let size = n * phi.len() * channels.iter().map(|c| c.width()).sum::<usize>();
    if out.len() != size {
        return Err(PyValueError::new_err(format!("out holds {} numbers, {size} are needed", out.len())));
    }
    guarded(py, "motions", || over_angles::motions(&plan.0, &rows, phi, &channels, out))
}

#[pyfunction]
pub(crate) fn third<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
    what: Vec<Channel>,
) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let channels = channels(&what, plan)?;
    let width = channels.iter().map(|c| c.third_width()).sum();
    filled(py, "third derivatives", [width, phi.len()], |to| {
        over_angles::third(&plan.0, q, phi, &channels, to)
    })
}

#[pyfunction]
pub(crate) fn gaps<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let shape = [plan.0.mechanism.n_gaps, phi.len()];
    filled(py, "closure", shape, |to| over_angles::gaps(&plan.0, q, phi, to))
}

/// Where the links of a dyad come into line.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct InLine {
    row: usize,
    crank_angle: f64,
    spare: f64,
    series: Vec<f64>,
    arms: Vec<f64>,
    lost: (bool, bool),
}

#[pyfunction]
pub(crate) fn in_line(
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
    let told = |(row, at): (usize, linkwright_core::linkage::in_line::InLine)| InLine {
        row,
        crank_angle: at.phi,
        spare: at.spare,
        series: at.series,
        arms: at.arms,
        lost: at.lost.into(),
    };
    Ok(found.into_iter().map(told).collect())
}

/// The motion of a group as it was followed.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct GroupPath {
    crank_angle: Py<PyArray1<f64>>,
    places: Vec<Vec<f64>>,
    turns: Option<u32>,
}

#[pyfunction]
pub(crate) fn follow_group(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    element: usize,
    phi: f64,
    near: Floats<'_>,
) -> PyResult<Option<GroupPath>> {
    let (q, near) = (plan.parameters(&q)?, near.as_slice()?);
    below(element, plan.0.mechanism.elements.len())?;
    let mechanism = &plan.0.mechanism;
    let found = guarded(py, "assembly of a group", || trace::follow(mechanism, element, q, phi, near))?;
    Ok(found.map(|path| GroupPath {
        crank_angle: column(py, path.phi).unbind(),
        places: path.places,
        turns: path.turns,
    }))
}
