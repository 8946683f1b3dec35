//! Strings of sucker rods at the border.

use linkwright_rods::cards::{Cards, cards, top_of};
use linkwright_rods::fourier::Fourier;
use linkwright_rods::prediction::{Request, predict};
use linkwright_rods::pump::Pump;
use linkwright_rods::string::Section;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::guard::{guarded, require_room};

const ANALYSIS: &str = "motion of the rod string";

/// Sections of a string from the polished rod to the pump.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct RodString(Vec<Section<f64>>);

/// Cards along a string, a row a station: tops of sections, then the pump.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct RodCards {
    position: Py<PyArray2<f64>>,
    load: Py<PyArray2<f64>>,
    work: Py<PyArray1<f64>>,
    loss: Py<PyArray1<f64>>,
}

/// The periodic motion of a string with its pump.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct RodMotion {
    cards: Py<RodCards>,
    wave: Py<PyArray1<f64>>,
    sweeps: usize,
    change: f64,
}

/// The transform of samples; how many there may be is the caller's to know.
fn transform(samples: usize) -> PyResult<Fourier> {
    let without = || PyValueError::new_err("samples: an even number of factors 2, 3 and 5 is needed");
    Fourier::new(samples).ok_or_else(without)
}

fn handed(py: Python<'_>, found: Cards<f64>, samples: usize) -> PyResult<RodCards> {
    let stations = found.work.len();
    let table = |list| Ok::<_, PyErr>(column(py, list).reshape([stations, samples])?.unbind());
    Ok(RodCards {
        position: table(found.position)?,
        load: table(found.load)?,
        work: column(py, found.work).unbind(),
        loss: column(py, found.loss).unbind(),
    })
}

#[pymethods]
impl RodString {
    #[new]
    #[pyo3(signature = (*, rigidity, mass, damping, length))]
    fn new(
        rigidity: Floats<'_>,
        mass: Floats<'_>,
        damping: Floats<'_>,
        length: Floats<'_>,
    ) -> PyResult<Self> {
        let [rigidity, mass, damping, length] =
            [rigidity.as_slice()?, mass.as_slice()?, damping.as_slice()?, length.as_slice()?];
        let n = rigidity.len();
        if n == 0 || [mass.len(), damping.len(), length.len()] != [n; 3] {
            return Err(PyValueError::new_err("rod string: arrays of one length are needed"));
        }
        let section = |i: usize| Section {
            rigidity: rigidity[i],
            mass: mass[i],
            damping: damping[i],
            length: length[i],
        };
        Ok(RodString((0..n).map(section).collect()))
    }

    /// The cards by samples of position and load at the polished rod, of which `harmonics` count.
    #[pyo3(signature = (*, period, position, load, harmonics))]
    fn cards(
        &self,
        py: Python<'_>,
        period: f64,
        position: Floats<'_>,
        load: Floats<'_>,
        harmonics: usize,
    ) -> PyResult<RodCards> {
        let (position, load) = (position.as_slice()?, load.as_slice()?);
        let fourier = transform(position.len())?;
        if load.len() != fourier.samples {
            return Err(PyValueError::new_err("cards: position and load need one length"));
        }
        require_room(ANALYSIS, [4 * (self.0.len() + 1), fourier.samples])?;
        let found = guarded(py, ANALYSIS, || {
            let top = top_of(position, load, harmonics + 1, &fourier);
            cards(&self.0, period, &top, &fourier)
        })?;
        handed(py, found, fourier.samples)
    }

    /// The periodic motion under samples of the polished rod's position.
    #[pyo3(signature = (
        *, period, motion, load, compliance, compressibility, slip, fillage, discharge, softness, start, tolerance, sweeps
    ))]
    fn predict(
        &self,
        py: Python<'_>,
        period: f64,
        motion: Floats<'_>,
        load: f64,
        compliance: f64,
        compressibility: f64,
        slip: f64,
        fillage: f64,
        discharge: f64,
        softness: f64,
        start: Option<Floats<'_>>,
        tolerance: f64,
        sweeps: usize,
    ) -> PyResult<RodMotion> {
        let motion = motion.as_slice()?;
        let fourier = transform(motion.len())?;
        let start = start.as_ref().map(|wave| wave.as_slice()).transpose()?;
        if start.is_some_and(|wave| wave.len() != fourier.samples) {
            return Err(PyValueError::new_err("predict: motion and start need one length"));
        }
        require_room(ANALYSIS, [4 * (self.0.len() + 2), fourier.samples])?;
        let impedance = self.0[self.0.len() - 1].impedance();
        let pump = Pump { load, impedance, compliance, compressibility, slip, fillage, discharge, softness };
        let request = Request { tolerance, sweeps };
        let (found, along) = guarded(py, ANALYSIS, || {
            let found = predict(&self.0, &pump, period, motion, start, request, &fourier);
            let along = cards(&self.0, period, &found.top, &fourier);
            (found, along)
        })?;
        Ok(RodMotion {
            cards: Py::new(py, handed(py, along, fourier.samples)?)?,
            wave: column(py, found.wave).unbind(),
            sweeps: found.sweeps,
            change: found.change,
        })
    }
}
