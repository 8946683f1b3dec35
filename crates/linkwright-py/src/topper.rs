//! Knives of toppers at the border.

use linkwright_core::kernel::motion_law::MotionLaw;
use linkwright_core::topper::heads::{Heads, RESULTS, cover};
use linkwright_core::topper::knife::{Knife, Law};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::plan_error;
use crate::guard::{filled, guarded, require_room};
use crate::{Floats, Table};

/// A knife: its law, as harmonics (a, b, a, b, …) or in pieces, and how it goes.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TopperKnife(Knife);

#[pymethods]
impl TopperKnife {
    #[new]
    fn new(
        py: Python<'_>,
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
            let law = guarded(py, "law of a knife", || MotionLaw::decode(&mut list))?;
            Law::Pieces(law.map_err(plan_error)?)
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
        let analysis = "heads under a knife";
        require_room(analysis, [3, fine])?;
        filled(py, analysis, [n, RESULTS], |to| cover(&self.0, &heads, length, fine, to))
    }
}
