//! Torsional trains at the border.

use linkwright_torsion::forest::Forest;
use linkwright_torsion::{Train, forced, modes, waves};
use numpy::{
    Complex64, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyReadwriteArray3, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::column;
use crate::guard::{guarded, require_room};
use crate::{Floats, Ints};

/// Natural frequencies, and mode shapes row by row.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionModes {
    omega: Py<PyArray1<f64>>,
    shapes: Py<PyArray2<f64>>,
}

/// Natural frequencies and mode shapes; `None` where shafts close a loop.
#[pyfunction]
pub(crate) fn torsion_modes(
    py: Python<'_>,
    inertia: Floats<'_>,
    ends: PyReadonlyArray2<'_, i32>,
    stiffness: Floats<'_>,
) -> PyResult<Option<TorsionModes>> {
    let (inertia, stiffness) = (inertia.as_slice()?, stiffness.as_slice()?);
    let (ends, _) = ends.as_slice()?.as_chunks();
    let analysis = "natural frequencies";
    let parts = match guarded(py, analysis, || Forest::new(inertia, ends, stiffness))? {
        Forest::Trees(parts) => parts,
        Forest::Loops => return Ok(None),
        Forest::Wrong => {
            return Err(PyValueError::new_err("no train: inertias are positive, stiffnesses not negative"));
        }
    };
    require_room(analysis, [inertia.len(); 2])?;
    let found = guarded(py, analysis, || modes::modes_of_parts(&parts))?;
    let omega = PyArray1::from_slice(py, &found.omega);
    // The core has a row a disc.
    let shapes = PyArray2::<f64>::zeros(py, [inertia.len(); 2], true);
    shapes.readwrite().as_slice_mut()?.copy_from_slice(&found.shapes);
    Ok(Some(TorsionModes { omega: omega.unbind(), shapes: shapes.unbind() }))
}
/// A row a disc, a column a speed.
type Rows<'py> = PyReadonlyArray2<'py, f64>;

/// A train, its discs in an order in which each is connected to an earlier one.
fn tree(parent: &Ints<'_>, inertia: &Floats<'_>, stiffness: &[f64]) -> PyResult<Train> {
    let parent: Vec<usize> =
        parent.as_slice()?.iter().map(|&i| usize::try_from(i).unwrap_or(usize::MAX)).collect();
    Train::new(&parent, inertia.as_slice()?, stiffness)
        .ok_or_else(|| PyValueError::new_err("no train: each disc hangs on an earlier one, all are positive"))
}

/// Amplitudes (orders, discs, speeds) in place of torques. Tables have a row a disc, a column a speed: k, c and ηk of the
/// shaft above each disc, c of the disc against the ground.
#[pyfunction]
#[pyo3(signature = (*, parent, inertia, speeds, stiffness, damping, loss, disc_damping, orders, torques))]
pub(crate) fn torsion_forced(
    py: Python<'_>,
    parent: Ints<'_>,
    inertia: Floats<'_>,
    speeds: Floats<'_>,
    stiffness: Rows<'_>,
    damping: Rows<'_>,
    loss: Rows<'_>,
    disc_damping: Rows<'_>,
    orders: Floats<'_>,
    mut torques: PyReadwriteArray3<'_, Complex64>,
) -> PyResult<()> {
    // What the shafts are is in the tables.
    let train = tree(&parent, &inertia, &vec![1.0; inertia.as_slice()?.len()])?;
    let at = forced::Damping {
        speeds: speeds.as_slice()?,
        stiffness: stiffness.as_slice()?,
        shaft: damping.as_slice()?,
        loss: loss.as_slice()?,
        ground: disc_damping.as_slice()?,
    };
    let orders = orders.as_slice()?;
    // Lengths alone would take rows for columns.
    let shape = [orders.len(), inertia.len(), speeds.len()];
    let tables = [&stiffness, &damping, &loss, &disc_damping];
    let fits = torques.shape() == shape && tables.iter().all(|rows| rows.shape() == &shape[1..]);
    let torques = torques.as_slice_mut()?;
    if fits && guarded(py, "forced vibration", || forced::forced(&train, &at, orders, torques))? {
        return Ok(());
    }
    Err(PyValueError::new_err("tables and torques do not have a place for every disc and speed"))
}

/// Extremes and where they are, an array over waves, shafts or masses each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct Extremes {
    pub(crate) greatest: Py<PyArray1<f64>>,
    pub(crate) greatest_at: Py<PyArray1<f64>>,
    pub(crate) least: Py<PyArray1<f64>>,
    pub(crate) least_at: Py<PyArray1<f64>>,
}

/// Extremes of waves and their places. Coefficients (harmonics, waves).
#[pyfunction]
pub(crate) fn torsion_waves(
    py: Python<'_>,
    coefficients: PyReadonlyArray2<'_, Complex64>,
) -> PyResult<Extremes> {
    let (harmonics, waves) = coefficients.as_array().dim();
    let coefficients = coefficients.as_slice()?;
    let analysis = "extremes of vibration";
    // Cosines and sines of each harmonic at the places where waves are sampled, some four for each harmonic.
    require_room(analysis, [harmonics, 4 * harmonics + 4])?;
    let found = guarded(py, analysis, || waves::extremes(coefficients, waves))?;
    let each = |of: fn(&waves::Extremes) -> f64| column(py, found.iter().map(of).collect()).unbind();
    Ok(Extremes {
        greatest: each(|wave| wave.max),
        greatest_at: each(|wave| wave.at_max),
        least: each(|wave| wave.min),
        least_at: each(|wave| wave.at_min),
    })
}
