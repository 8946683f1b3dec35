//! Knives of toppers at the border.

use linkwright_topper::heads::{Heads, RESULTS, cover};
use linkwright_topper::knife::{Knife, Law};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::arrays::column;
use crate::builder::numbers::MotionLaw;
use crate::guard::{guarded, require_room};

/// A knife: its law, as harmonics (a, b, a, b, …) or in pieces, and how it goes.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TopperKnife(Knife);

/// Pieces, or harmonics (a, b, a, b, …).
#[derive(FromPyObject)]
enum KnifeLaw<'py> {
    Pieces(PyRef<'py, MotionLaw>),
    Harmonics(Floats<'py>),
}

/// Heads under a knife, an array over them each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TopperCover {
    length: Py<PyArray1<f64>>,
    last_x: Py<PyArray1<f64>>,
    last_y: Py<PyArray1<f64>>,
    uncut_right: Py<PyArray1<f64>>,
    uncut_left: Py<PyArray1<f64>>,
    uncut_between: Py<PyArray1<f64>>,
}

#[pymethods]
impl TopperKnife {
    #[new]
    #[pyo3(signature = (law, *, corners, angle, forward, rate, drift, reach, slowest, fastest))]
    fn new(
        law: KnifeLaw<'_>,
        corners: Vec<f64>,
        angle: f64,
        forward: f64,
        rate: f64,
        drift: f64,
        reach: f64,
        slowest: f64,
        fastest: f64,
    ) -> PyResult<Self> {
        let law = match law {
            KnifeLaw::Pieces(law) => Law::Pieces(law.0.clone()),
            KnifeLaw::Harmonics(list) => {
                Law::Harmonics(list.as_slice()?.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
            }
        };
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
    #[pyo3(signature = (*, radius, offset, phase, n, length, fine))]
    fn cover(
        &self,
        py: Python<'_>,
        radius: Floats<'_>,
        offset: Floats<'_>,
        phase: Floats<'_>,
        n: usize,
        length: Option<f64>,
        fine: usize,
    ) -> PyResult<TopperCover> {
        let [radius, offset, phase] = [radius.as_slice()?, offset.as_slice()?, phase.as_slice()?];
        if [radius, offset, phase].iter().any(|column| column.len() != 1 && column.len() != n) {
            return Err(PyValueError::new_err("columns of one entry, or one for each head"));
        }
        let heads = Heads { radius, offset, phase, n };
        let analysis = "heads under a knife";
        require_room(analysis, [3, fine])?;
        require_room(analysis, [RESULTS, n])?;
        let mut columns: [Vec<f64>; RESULTS] = std::array::from_fn(|_| vec![0.0; n]);
        let out = columns.each_mut().map(Vec::as_mut_slice);
        guarded(py, analysis, || cover(&self.0, &heads, length, fine, out))?;
        // In the order of `topper::heads`.
        let [length, last_x, last_y, uncut_right, uncut_left, uncut_between] =
            columns.map(|list| column(py, list).unbind());
        Ok(TopperCover { length, last_x, last_y, uncut_right, uncut_left, uncut_between })
    }
}
