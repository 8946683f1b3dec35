//! Systems of equations at the border.

use linkwright_kernel::systems::Systems;
use numpy::{PyReadonlyArray3, PyReadwriteArray3};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::guard::guarded;

/// Solves systems in place: A by (column, row, system), b and x by (right side, row, system).
#[pyfunction]
pub(crate) fn solve_systems(
    py: Python<'_>,
    matrix: PyReadonlyArray3<'_, f64>,
    mut right: PyReadwriteArray3<'_, f64>,
) -> PyResult<()> {
    let (columns, rows, systems) = matrix.as_array().dim();
    let (sides, equations, n) = right.as_array().dim();
    if [columns, rows, systems] != [equations, equations, n] {
        let text = format!("{rows} by {columns} by {systems} numbers for {equations} equations, {n} systems");
        return Err(PyIndexError::new_err(text));
    }
    let (matrix, right) = (matrix.as_slice()?, right.as_slice_mut()?);
    guarded(py, "systems of equations", || Systems { equations, sides, n, matrix, right }.solve())
}
