//! How every call goes to the core: without the interpreter lock, stopped by a signal, and with an error for what goes wrong.

use linkwright_kernel::call::{Failure, Reason, keep_panic, run};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::Table;

pyo3::import_exception!(linkwright.kernel.errors, InternalError);
pyo3::import_exception!(linkwright.kernel.errors, InputError);

/// Lets the core work; `analysis` names in messages what is done.
pub(crate) fn guarded<T: Send>(
    py: Python<'_>,
    analysis: &'static str,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    py.detach(|| run(signals, work)).map_err(|failure| match failure {
        Failure::Stopped(reason) => {
            reason.downcast().map_or_else(|_| PyKeyboardInterrupt::new_err(()), |error: Box<PyErr>| *error)
        }
        Failure::Panic(text) => InternalError::new_err((analysis, text)),
    })
}

/// What a signal handler raised. Only the main thread handles signals; others hear of none.
fn signals() -> Option<Reason> {
    Python::attach(|py| py.check_signals()).err().map(|error| Box::new(error) as Reason)
}

/// Keeps panics of the core for their error, in place of a message on standard error.
pub(crate) fn keep_panics() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !keep_panic(info) {
            before(info);
        }
    }));
}

/// A table of zeros, of any size that there is memory for.
pub(crate) fn zeros<'py>(py: Python<'py>, analysis: &str, shape: [usize; 2]) -> PyResult<Table<'py>> {
    let table = py.import("numpy")?.call_method1("zeros", (shape,)).map_err(|_| too_much(analysis, shape))?;
    Ok(table.cast_into::<PyArray2<f64>>()?)
}

/// A table that a kernel fills.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    analysis: &'static str,
    shape: [usize; 2],
    fill: impl FnOnce(&mut [f64]) + Send,
) -> PyResult<Table<'py>> {
    let out = zeros(py, analysis, shape)?;
    {
        let mut to = out.readwrite();
        let to = to.as_slice_mut()?;
        guarded(py, analysis, || fill(to))?;
    }
    Ok(out)
}

/// Refuses a table that there is no memory for, before a kernel makes it.
pub(crate) fn require_room(analysis: &str, shape: [usize; 2]) -> PyResult<()> {
    let numbers = shape[0].checked_mul(shape[1]);
    match numbers.map(|n| Vec::<f64>::new().try_reserve_exact(n)) {
        Some(Ok(())) => Ok(()),
        _ => Err(too_much(analysis, shape)),
    }
}

fn too_much(analysis: &str, [rows, columns]: [usize; 2]) -> PyErr {
    let text =
        format!("{analysis}: {rows} by {columns} numbers do not fit into memory; ask for fewer at once");
    InputError::new_err(text)
}
