//! Strings of sucker rods at the border.

use linkwright_rods::fourier::Fourier;
use linkwright_rods::prediction::Request;
use linkwright_rods::wells::{Found, Wells};
use numpy::{PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::guard::{guarded, require_room};

/// A table of rows.
type Rows<'py> = PyReadonlyArray2<'py, f64>;

const ANALYSIS: &str = "motion of the rod string";

/// Periodic motions of strings with their pumps, a row a string.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct RodMotions {
    position: Py<PyArray3<f64>>,
    load: Py<PyArray3<f64>>,
    work: Py<PyArray2<f64>>,
    wave: Py<PyArray2<f64>>,
    ends: Py<PyArray2<f64>>,
    sweeps: usize,
}

/// The transform of samples; how many there may be is the caller's to know.
fn transform(samples: usize) -> PyResult<Fourier> {
    let without = || PyValueError::new_err("samples: an even number of factors 2, 3 and 5 is needed");
    Fourier::new(samples).ok_or_else(without)
}

/// Those of a number of samples, of twice as many, and of a quarter or, where that cannot be, of all.
fn transforms(samples: usize) -> PyResult<[Fourier; 3]> {
    let coarse = if samples.is_multiple_of(8) { samples / 4 } else { samples };
    Ok([transform(samples)?, transform(2 * samples)?, transform(coarse)?])
}

/// The periodic motions of strings of equally many sections, a row of numbers and of samples of the polished rod each.
#[pyfunction]
#[pyo3(signature = (*, sections, numbers, motion, start, tolerance, sweeps))]
pub(crate) fn predict_rods(
    py: Python<'_>,
    sections: usize,
    numbers: Rows<'_>,
    motion: Rows<'_>,
    start: Option<Rows<'_>>,
    tolerance: f64,
    sweeps: usize,
) -> PyResult<RodMotions> {
    let samples = motion.shape()[1];
    let fourier = transforms(samples)?;
    let (numbers, motion) = (numbers.as_slice()?, motion.as_slice()?);
    let start = start.as_ref().map(|wave| wave.as_slice()).transpose()?;
    let request = Request { tolerance, sweeps };
    let wells = Wells { sections, numbers, motion, start, request, fourier: &fourier };
    let rows = required(&wells, numbers, motion, start)?;
    let found = guarded(py, ANALYSIS, || wells.solved())?;
    in_rows(py, &found, rows, &wells)
}

/// Cards by samples of position and load at the polished rod, of which `harmonics` count, a row a string.
#[pyfunction]
#[pyo3(signature = (*, sections, numbers, position, load, harmonics))]
pub(crate) fn rod_cards(
    py: Python<'_>,
    sections: usize,
    numbers: Rows<'_>,
    position: Rows<'_>,
    load: Rows<'_>,
    harmonics: usize,
) -> PyResult<RodMotions> {
    let samples = position.shape()[1];
    let fourier = [transform(samples)?, transform(samples)?, transform(samples)?];
    let (numbers, motion, load) = (numbers.as_slice()?, position.as_slice()?, load.as_slice()?);
    let request = Request { tolerance: 0.0, sweeps: 0 };
    let wells = Wells { sections, numbers, motion, start: None, request, fourier: &fourier };
    let rows = required(&wells, numbers, motion, Some(load))?;
    let found = guarded(py, ANALYSIS, || wells.carried(load, harmonics))?;
    in_rows(py, &found, rows, &wells)
}

/// Derivatives of the periodic motion of a string, of which `start` is the wave, by directions of its numbers and of its motion.
#[pyfunction]
#[pyo3(signature = (*, sections, numbers, motion, start, numbers_along, motion_along, tolerance, sweeps))]
pub(crate) fn rods_along(
    py: Python<'_>,
    sections: usize,
    numbers: Floats<'_>,
    motion: Floats<'_>,
    start: Floats<'_>,
    numbers_along: Rows<'_>,
    motion_along: Rows<'_>,
    tolerance: f64,
    sweeps: usize,
) -> PyResult<RodMotions> {
    let (numbers, motion, start) = (numbers.as_slice()?, motion.as_slice()?, start.as_slice()?);
    let fourier = transforms(motion.len())?;
    let request = Request { tolerance, sweeps };
    let wells = Wells { sections, numbers, motion, start: Some(start), request, fourier: &fourier };
    required(&wells, numbers, motion, Some(start))?;
    let (numbers, motion) = (numbers_along.as_slice()?, motion_along.as_slice()?);
    let rows = required(&wells, numbers, motion, None)?;
    let found = guarded(py, ANALYSIS, || wells.along(numbers, motion))?;
    in_rows(py, &found, rows, &wells)
}

/// How many rows tables have, which fit a string.
fn required(wells: &Wells<'_>, numbers: &[f64], motion: &[f64], start: Option<&[f64]>) -> PyResult<usize> {
    let samples = wells.fourier[0].samples;
    let rows = motion.len() / samples;
    let fits = wells.sections > 0 && rows > 0 && numbers.len() == rows * wells.width();
    if !fits || start.is_some_and(|start| start.len() != motion.len()) {
        return Err(PyValueError::new_err("rods: numbers, motion and start need one number of rows"));
    }
    require_room(ANALYSIS, [rows * 4 * (wells.sections + 1), 2 * samples])?;
    Ok(rows)
}

fn in_rows(py: Python<'_>, found: &[Found], rows: usize, wells: &Wells<'_>) -> PyResult<RodMotions> {
    let table = |of: &dyn Fn(&Found) -> &Vec<f64>| {
        let list: Vec<f64> = found.iter().flat_map(|found| of(found).iter().copied()).collect();
        let width = list.len() / rows;
        Ok::<_, PyErr>(column(py, list).reshape([rows, width])?.unbind())
    };
    let stations = [rows, wells.sections + 1, wells.fourier[1].samples];
    let cards = |which: usize| {
        let list: Vec<f64> = found.iter().flat_map(|found| found.cards[which].iter().copied()).collect();
        Ok::<_, PyErr>(column(py, list).reshape(stations)?.unbind())
    };
    Ok(RodMotions {
        position: cards(0)?,
        load: cards(1)?,
        work: table(&|found| &found.work)?,
        wave: table(&|found| &found.wave)?,
        ends: table(&|found| &found.ends)?,
        sweeps: found.iter().map(|found| found.sweeps).max().unwrap_or(0),
    })
}
