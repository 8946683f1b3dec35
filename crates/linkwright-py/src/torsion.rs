//! Torsional trains at the border.

use linkwright_core::torsion::{Train, modes};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::{Curve, Floats, Ints, Table};

/// Natural frequencies, and mode shapes row by row.
#[pyfunction]
pub(crate) fn torsion_modes<'py>(
    py: Python<'py>,
    parent: Ints<'_>,
    inertia: Floats<'_>,
    stiffness: Floats<'_>,
) -> PyResult<(Curve<'py>, Table<'py>)> {
    let parent: Vec<usize> =
        parent.as_slice()?.iter().map(|&i| usize::try_from(i).unwrap_or(usize::MAX)).collect();
    let train = Train::new(&parent, inertia.as_slice()?, stiffness.as_slice()?).ok_or_else(|| {
        PyValueError::new_err("no train: each disc hangs on an earlier one, all are positive")
    })?;
    let n = train.len();
    let shapes = PyArray2::<f64>::zeros(py, [n, n], false);
    let found = py.detach(|| modes::modes(&train));
    shapes.readwrite().as_slice_mut()?.copy_from_slice(&found.shapes);
    Ok((PyArray1::from_vec(py, found.omega), shapes))
}
