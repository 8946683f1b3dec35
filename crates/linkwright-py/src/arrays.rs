//! Lists and indices between numpy and the core.

use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Channel;
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

/// A list of numbers as a numpy array.
pub(crate) fn column(py: Python<'_>, list: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, list)
}

fn checked(value: i32, bound: usize) -> PyResult<usize> {
    usize::try_from(value)
        .ok()
        .filter(|&i| i < bound)
        .ok_or_else(|| PyIndexError::new_err(format!("index {value} is not below {bound}")))
}

/// Refuses an index that is not below a bound.
pub(crate) fn below(value: usize, bound: usize) -> PyResult<()> {
    if value < bound {
        Ok(())
    } else {
        Err(PyIndexError::new_err(format!("index {value} is not below {bound}")))
    }
}

/// Indices below a bound.
pub(crate) fn as_indices(list: &[i32], bound: usize) -> PyResult<Vec<usize>> {
    list.iter().map(|&value| checked(value, bound)).collect()
}

/// Rows of two, kind and index: 0 point, 1 link, 2 slide.
pub(crate) fn channels(list: &[i32], plan: &Plan) -> PyResult<Vec<Channel>> {
    let m = &plan.mechanism;
    let channel = |row: &[i32]| match row[0] {
        0 => checked(row[1], m.n_points).map(Channel::Point),
        1 => checked(row[1], m.n_links).map(Channel::Link),
        2 => checked(row[1], m.n_slides).map(Channel::Slide),
        kind => Err(PyIndexError::new_err(format!("there is no channel of kind {kind}"))),
    };
    list.chunks_exact(2).map(channel).collect()
}
