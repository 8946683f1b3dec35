//! Motions of points, links and slides, and what has to be known of a mechanism beforehand: calls and results.

use linkwright_core::drive::batch::{self, Rows};
use linkwright_core::drive::motions as over_angles;
use linkwright_core::linkage::motion;
use linkwright_core::linkage::trace;
use linkwright_derivatives::along::{Directions, motions_along as core_motions_along};
use numpy::{
    PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadwriteArray3, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{as_indices, below, column};
use crate::builder::Plan;
use crate::guard::{filled, guarded, require_room};
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
    mut out: PyReadwriteArray3<'_, f64>,
) -> PyResult<bool> {
    let n = values.as_array().ncols();
    let slots = as_indices(slots.as_slice()?, plan.0.n_parameters)?;
    let rows = Rows { base: plan.parameters(&q)?, slots: &slots, values: values.as_slice()?, n };
    let channels = channels(&what, plan)?;
    let phi = phi.as_slice()?;
    let shape = [n, channels.iter().map(|c| c.width()).sum(), phi.len()];
    if out.shape() != shape {
        return Err(PyValueError::new_err(format!("out has shape {:?}, {shape:?} is needed", out.shape())));
    }
    let out = out.as_slice_mut()?;
    guarded(py, "motions", || over_angles::motions(&plan.0, &rows, phi, &channels, out))
}

/// Third derivatives by the crank angle of points, links and slides.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct ThirdDerivatives {
    points: Py<PyArray3<f64>>,
    links: Py<PyArray2<f64>>,
    slides: Py<PyArray2<f64>>,
}

#[pyfunction]
#[pyo3(signature = (plan, q, phi, *, points, links, slides))]
pub(crate) fn third(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    phi: Floats<'_>,
    points: Vec<usize>,
    links: Vec<usize>,
    slides: Vec<usize>,
) -> PyResult<ThirdDerivatives> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let n = [points.len(), links.len(), slides.len(), phi.len()];
    let point = points.into_iter().map(|index| Channel::Point { index });
    let link = links.into_iter().map(|index| Channel::Link { index });
    let slide = slides.into_iter().map(|index| Channel::Slide { index });
    let channels = channels(&point.chain(link).chain(slide).collect::<Vec<_>>(), plan)?;
    let analysis = "third derivatives";
    require_room(analysis, [2 * n[0] + n[1] + n[2], n[3]])?;
    let mut points = vec![0.0; (2 * n[0] + n[1] + n[2]) * n[3]];
    guarded(py, analysis, || over_angles::third(&plan.0, q, phi, &channels, &mut points))?;
    let mut links = points.split_off(2 * n[0] * n[3]);
    let slides = links.split_off(n[1] * n[3]);
    Ok(ThirdDerivatives {
        points: column(py, points).reshape([n[0], 2, n[3]])?.unbind(),
        links: column(py, links).reshape([n[1], n[3]])?.unbind(),
        slides: column(py, slides).reshape([n[2], n[3]])?.unbind(),
    })
}

/// Directions (parameters, n) of a machine's numbers.
pub(crate) fn directions<'a>(
    plan: &'a Plan,
    q: &'a [f64],
    values: &'a PyReadonlyArray2<'_, f64>,
) -> PyResult<Directions<'a>> {
    let [rows, n] = [values.as_array().nrows(), values.as_array().ncols()];
    if rows == q.len() {
        Ok(Directions { plan: &plan.0, q, values: values.as_slice()?, n })
    } else {
        let text = format!("directions of {rows} numbers, {} parameters", q.len());
        Err(PyIndexError::new_err(text))
    }
}

#[pyfunction]
pub(crate) fn motions_along<'py>(
    py: Python<'py>,
    plan: &Plan,
    q: Floats<'_>,
    values: PyReadonlyArray2<'_, f64>,
    phi: Floats<'_>,
    what: Vec<Channel>,
) -> PyResult<Table<'py>> {
    let (q, phi) = (plan.parameters(&q)?, phi.as_slice()?);
    let of = directions(plan, q, &values)?;
    let channels = channels(&what, plan)?;
    let width: usize = channels.iter().map(|c| c.width()).sum();
    filled(py, "derivatives of motions", [width, phi.len() * of.n], |to| {
        core_motions_along(of, phi, &channels, to)
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
    lost_positive: bool,
    lost_negative: bool,
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
        lost_positive: at.lost[0],
        lost_negative: at.lost[1],
    };
    Ok(found.into_iter().map(told).collect())
}

/// The motion of a group as it was followed.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct GroupPath {
    crank_angle: Py<PyArray1<f64>>,
    x: Vec<Vec<f64>>,
    y: Vec<Vec<f64>>,
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
        x: path.places.iter().step_by(2).cloned().collect(),
        y: path.places.into_iter().skip(1).step_by(2).collect(),
        turns: path.turns,
    }))
}
