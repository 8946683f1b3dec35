//! Lists and indices between numpy and the core.

use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

/// A list of numbers as a numpy array.
pub(crate) fn column(py: Python<'_>, list: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, list)
}

/// The columns of a table of rows of N numbers.
pub(crate) fn by_column<const N: usize>(py: Python<'_>, table: &[f64]) -> [Py<PyArray1<f64>>; N] {
    std::array::from_fn(|k| column(py, table.iter().skip(k).step_by(N).copied().collect()).unbind())
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
    let index = |&value: &i32| {
        usize::try_from(value)
            .ok()
            .filter(|&i| i < bound)
            .ok_or_else(|| PyIndexError::new_err(format!("index {value} is not below {bound}")))
    };
    list.iter().map(index).collect()
}
