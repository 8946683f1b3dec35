//! Cams at the border.

use linkwright_core::cam::crossing::crossings;
use linkwright_core::cam::search::{Cams, RESULTS, search};
use linkwright_core::cam::shape::{Quantity, ROWS};
use linkwright_core::cam::{Cam as CoreCam, Dimensions, Kind};
use linkwright_core::kernel::motion_law::MotionLaw;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::guard::{filled, guarded, require_room, zeros};
use crate::{Floats, Table};

/// A law and the kind of cam that follows it.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct Cam {
    law: MotionLaw,
    kind: Kind,
    sense: f64,
    side: f64,
}

/// A contact over a turn.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamShape {
    angle: Py<PyArray1<f64>>,
    piece: Py<PyArray1<u32>>,
    rows: Py<PyArray2<f64>>,
    /// Angle and value of the greatest and the least of each quantity in turn.
    extremes: Vec<(f64, f64)>,
    /// Angle and sign, for each level asked for.
    passes: Vec<Py<PyArray2<f64>>>,
}

fn table<'py>(py: Python<'py>, rows: &[Vec<f64>], width: usize) -> PyResult<Table<'py>> {
    let table = zeros(py, "cam", [rows.len(), width])?;
    for (to, from) in table.readwrite().as_slice_mut()?.chunks_exact_mut(width.max(1)).zip(rows) {
        to.copy_from_slice(from);
    }
    Ok(table)
}

fn dimensions(list: &Floats<'_>) -> PyResult<Dimensions<f64>> {
    let &[base_radius, roller_radius, offset, distance, arm, tilt] = list.as_slice()? else {
        return Err(PyValueError::new_err("a cam has six dimensions"));
    };
    Ok(Dimensions { base_radius, roller_radius, offset, distance, arm, tilt })
}

#[pymethods]
impl Cam {
    #[new]
    fn new(
        law: PyRef<'_, crate::builder::numbers::MotionLaw>,
        kind: u8,
        sense: f64,
        side: f64,
    ) -> PyResult<Self> {
        let kind = Kind::of(kind).ok_or_else(|| PyValueError::new_err("no such kind of cam"))?;
        Ok(Cam { law: law.0.clone(), kind, sense, side })
    }

    fn shape(
        &self,
        py: Python<'_>,
        size: Floats<'_>,
        n: usize,
        levels: Vec<(usize, f64)>,
    ) -> PyResult<CamShape> {
        let cam = CoreCam::<f64>::new(self.kind, self.sense, self.side, dimensions(&size)?);
        if levels.iter().any(|&(row, _)| row >= ROWS) {
            return Err(PyValueError::new_err("no such row"));
        }
        require_room("cam", [ROWS + 3, n])?;
        let (shape, extremes, passes) = guarded(py, "cam", || {
            let shape = cam.shape(&self.law, n);
            let mut extremes = Vec::new();
            for &what in Quantity::of_kind(self.kind) {
                for sign in [1.0, -1.0] {
                    let found = cam.extreme(what, sign, &self.law, &shape);
                    extremes.push((found.phi, found.value));
                }
            }
            let passes: Vec<Vec<Vec<f64>>> = levels
                .iter()
                .map(|&(row, level)| {
                    let found = cam.passes(row, level, &self.law, &shape);
                    found.into_iter().map(|(phi, sign)| vec![phi, sign]).collect()
                })
                .collect();
            (shape, extremes, passes)
        })?;
        let width = shape.phi.len();
        let passes = passes.iter().map(|rows| Ok(table(py, rows, 2)?.unbind())).collect::<PyResult<_>>()?;
        Ok(CamShape {
            angle: PyArray1::from_vec(py, shape.phi).unbind(),
            piece: PyArray1::from_vec(py, shape.piece).unbind(),
            rows: table(py, &shape.rows, width)?.unbind(),
            extremes,
            passes,
        })
    }

    /// All rows at cam angles; at a joint from after it, or from before.
    fn rows<'py>(
        &self,
        py: Python<'py>,
        size: Floats<'_>,
        phi: Floats<'_>,
        before: bool,
    ) -> PyResult<Table<'py>> {
        let cam = CoreCam::new(self.kind, self.sense, self.side, dimensions(&size)?);
        let phi = phi.as_slice()?;
        filled(py, "cam", [ROWS, phi.len()], |to| cam.rows(&self.law, phi, before, to))
    }

    /// Place, first and second derivative of a curve beside the pitch curve, seen from the cam.
    fn curve<'py>(
        &self,
        py: Python<'py>,
        size: Floats<'_>,
        phi: Floats<'_>,
        before: bool,
        away: f64,
    ) -> PyResult<Table<'py>> {
        let cam = CoreCam::new(self.kind, self.sense, self.side, dimensions(&size)?);
        let phi = phi.as_slice()?;
        filled(py, "profile of a cam", [6, phi.len()], |to| cam.curves(&self.law, phi, before, away, to))
    }

    /// Results of many cams; each column has one entry or one a cam.
    fn search<'py>(
        &self,
        py: Python<'py>,
        columns: Vec<Floats<'py>>,
        n: usize,
        per_turn: usize,
    ) -> PyResult<Table<'py>> {
        let columns = columns.iter().map(|column| column.as_slice()).collect::<Result<Vec<_>, _>>()?;
        if columns.iter().any(|column| column.len() != 1 && column.len() != n) {
            return Err(PyValueError::new_err("columns of one entry, or one for each cam"));
        }
        let &[base_radius, roller_radius, offset, distance, arm, tilt, lift] = columns.as_slice() else {
            return Err(PyValueError::new_err("six dimensions and the factor on the lift"));
        };
        let size = Dimensions { base_radius, roller_radius, offset, distance, arm, tilt };
        let analysis = "search of cams";
        require_room(analysis, [3, per_turn])?;
        let cams = Cams { kind: self.kind, sense: self.sense, side: self.side, size, lift, n };
        filled(py, analysis, [n, RESULTS], |to| search(&self.law, &cams, per_turn, to))
    }
}

/// Sides of a closed polygon that cross: share of each and the place, (n, 4).
#[pyfunction]
pub(crate) fn cam_crossings<'py>(py: Python<'py>, x: Floats<'_>, y: Floats<'_>) -> PyResult<Table<'py>> {
    let (x, y) = (x.as_slice()?, y.as_slice()?);
    if x.len() != y.len() {
        return Err(PyValueError::new_err("as many x as y"));
    }
    let found = guarded(py, "crossings of a profile", || crossings(x, y))?;
    let rows: Vec<Vec<f64>> = found.iter().map(|c| vec![c.first, c.second, c.x, c.y]).collect();
    table(py, &rows, 4)
}
