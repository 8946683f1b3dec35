//! Knives of toppers at the border.

use linkwright_core::motion_law::MotionLaw;
use linkwright_core::topper::heads::{Heads, RESULTS, cover};
use linkwright_core::topper::knife::{Knife, Law};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::plan_error;
use crate::{Floats, Table};

/// A knife: its law, as harmonics (a, b, a, b, …) or in pieces, and how it goes.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TopperKnife(Knife);

#[pymethods]
impl TopperKnife {
    #[new]
    fn new(
        law: Floats<'_>,
        in_pieces: bool,
        corners: Vec<f64>,
        angle: f64,
        forward: f64,
        rate: f64,
        drift: f64,
        bounds: [f64; 3],
    ) -> PyResult<Self> {
        let mut list = law.as_slice()?;
        let law = if in_pieces {
            Law::Pieces(MotionLaw::decode(&mut list).map_err(plan_error)?)
        } else {
            Law::Harmonics(list.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
        };
        let [reach, slowest, fastest] = bounds;
        Ok(TopperKnife(Knife {
            law,
            corners,
            direction: angle.sin_cos().into(),
            forward,
            rate,
            drift,
            reach,
            speeds: [slowest, fastest],
        }))
    }

    /// Results of heads; each column has one entry or one a head.
    fn cover<'py>(
        &self,
        py: Python<'py>,
        columns: [Floats<'py>; 3],
        n: usize,
        length: Option<f64>,
        fine: usize,
    ) -> PyResult<Table<'py>> {
        let [radius, offset, phase] = &columns;
        let [radius, offset, phase] = [radius.as_slice()?, offset.as_slice()?, phase.as_slice()?];
        if [radius, offset, phase].iter().any(|column| column.len() != 1 && column.len() != n) {
            return Err(PyValueError::new_err("columns of one entry, or one for each head"));
        }
        let heads = Heads { radius, offset, phase, n };
        let out = PyArray2::<f64>::zeros(py, [n, RESULTS], false);
        {
            let mut to = out.readwrite();
            let to = to.as_slice_mut()?;
            py.detach(|| cover(&self.0, &heads, length, fine, to));
        }
        Ok(out)
    }
}
