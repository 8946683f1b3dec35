//! The core's errors as Python's.

use linkwright_core::kernel::error::PlanError;
use pyo3::PyErr;
use pyo3::exceptions::{PyIndexError, PyValueError};

/// A plan that contradicts itself: an index out of range, or a value that makes no sense.
pub(crate) fn plan_error(error: PlanError) -> PyErr {
    let text = error.to_string();
    match error {
        PlanError::Index { .. } | PlanError::Missing { .. } | PlanError::Order { .. } => {
            PyIndexError::new_err(text)
        }
        PlanError::Length { .. }
        | PlanError::Kind { .. }
        | PlanError::Table { .. }
        | PlanError::In { .. }
        | PlanError::MotionLaw => PyValueError::new_err(text),
    }
}
