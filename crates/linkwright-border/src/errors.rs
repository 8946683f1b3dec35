//! The core's errors as Python's.

use linkwright_kernel::error::PlanError;
use pyo3::PyErr;
use pyo3::exceptions::{PyIndexError, PyValueError};

/// A plan that contradicts itself: an index out of range, or a value that makes no sense.
pub(crate) fn plan_error(error: PlanError) -> PyErr {
    let text = error.to_string();
    if is_index(&error) { PyIndexError::new_err(text) } else { PyValueError::new_err(text) }
}

fn is_index(error: &PlanError) -> bool {
    match error {
        PlanError::Missing { .. } | PlanError::Order { .. } => true,
        PlanError::In { error, .. } => is_index(error),
        PlanError::Length { .. } | PlanError::Load | PlanError::MotionLaw => false,
    }
}
