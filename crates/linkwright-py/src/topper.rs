//! Knives of toppers at the border.

use linkwright_core::topper::heads::{Heads, RESULTS, cover};
use linkwright_core::topper::knife::{Knife, Law};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::builder::numbers::MotionLaw;
use crate::guard::{filled, require_room};
use crate::{Floats, Table};

/// A knife: its law, as harmonics (a, b, a, b, …) or in pieces, and how it goes.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TopperKnife(Knife);

/// Pieces, or harmonics (a, b, a, b, …).
#[derive(FromPyObject)]
enum KnifeLaw<'py> {
    Pieces(PyRef<'py, MotionLaw>),
    Harmonics(Floats<'py>),
}

#[pymethods]
impl TopperKnife {
    #[new]
    fn new(
        law: KnifeLaw<'_>,
        corners: Vec<f64>,
        angle: f64,
        forward: f64,
        rate: f64,
        drift: f64,
        bounds: [f64; 3],
    ) -> PyResult<Self> {
        let law = match law {
            KnifeLaw::Pieces(law) => Law::Pieces(law.0.clone()),
            KnifeLaw::Harmonics(list) => {
                Law::Harmonics(list.as_slice()?.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
            }
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
        let analysis = "heads under a knife";
        require_room(analysis, [3, fine])?;
        filled(py, analysis, [n, RESULTS], |to| cover(&self.0, &heads, length, fine, to))
    }
}
