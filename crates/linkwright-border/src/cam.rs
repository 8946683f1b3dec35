//! Cams at the border.

use linkwright_cam::along::CamAlong;
use linkwright_cam::crossing::{Crossing, crossings};
use linkwright_cam::search::{Cams, RESULTS, search};
use linkwright_cam::shape::{self, NAMES, Quantity, ROWS};
use linkwright_cam::{Cam as CoreCam, Dimensions, Kind};
use linkwright_kernel::motion_law::MotionLaw;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::Floats;
use crate::arrays::{by_column, column};
use crate::guard::{guarded, require_room};

/// A law and the kind of cam that follows it.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct Cam {
    law: MotionLaw,
    kind: Kind,
    sense: f64,
    side: f64,
}

/// Lengths and angles of cam and follower.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamDimensions {
    base_radius: f64,
    roller_radius: f64,
    offset: f64,
    distance: f64,
    arm: f64,
    tilt: f64,
}

#[pymethods]
impl CamDimensions {
    #[new]
    #[pyo3(signature = (*, base_radius, roller_radius, offset, distance, arm, tilt))]
    fn new(base_radius: f64, roller_radius: f64, offset: f64, distance: f64, arm: f64, tilt: f64) -> Self {
        CamDimensions { base_radius, roller_radius, offset, distance, arm, tilt }
    }
}

impl CamDimensions {
    fn core(&self) -> Dimensions<f64> {
        let &CamDimensions { base_radius, roller_radius, offset, distance, arm, tilt } = self;
        Dimensions { base_radius, roller_radius, offset, distance, arm, tilt }
    }
}

/// A maximum or minimum, and the cam angle where it is.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct CamExtreme {
    angle: f64,
    value: f64,
}

impl From<shape::Extreme> for CamExtreme {
    fn from(extreme: shape::Extreme) -> Self {
        CamExtreme { angle: extreme.phi, value: extreme.value }
    }
}

/// Where a row passes a level, and its sign behind.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamPasses {
    angle: Py<PyArray1<f64>>,
    sign: Py<PyArray1<f64>>,
}

/// A contact over a revolution.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamShape {
    angle: Py<PyArray1<f64>>,
    piece: Py<PyArray1<u32>>,
    rows: Py<PyDict>,
    greatest: Py<PyDict>,
    least: Py<PyDict>,
    /// For each level asked for.
    passes: Vec<Py<CamPasses>>,
}

/// A curve beside the pitch curve with two derivatives by the cam angle.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamOffset {
    place: Py<PyArray2<f64>>,
    d1: Py<PyArray2<f64>>,
    d2: Py<PyArray2<f64>>,
}

/// Many cams, an array over them each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamSearch {
    tan_pressure_angle: Py<PyArray1<f64>>,
    soundness: Py<PyArray1<f64>>,
    bend_max: Py<PyArray1<f64>>,
    bend_min: Py<PyArray1<f64>>,
}

/// Where sides of a polygon cross, an array over the places each.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct CamCrossings {
    first: Py<PyArray1<f64>>,
    second: Py<PyArray1<f64>>,
    x: Py<PyArray1<f64>>,
    y: Py<PyArray1<f64>>,
}

/// Rows by name.
fn rows_by_name<'a>(py: Python<'_>, rows: impl Iterator<Item = &'a [f64]>) -> PyResult<Py<PyDict>> {
    let named = PyDict::new(py);
    for (name, row) in NAMES.into_iter().zip(rows) {
        named.set_item(name, PyArray1::from_slice(py, row))?;
    }
    Ok(named.unbind())
}

fn row_named(name: &str) -> PyResult<usize> {
    let place = NAMES.iter().position(|&known| known == name);
    place.ok_or_else(|| PyValueError::new_err(format!("there is no row {name}")))
}

#[pymethods]
impl Cam {
    #[new]
    #[pyo3(signature = (law, *, is_oscillating, is_roller, sense, side))]
    fn new(
        law: PyRef<'_, crate::builder::numbers::MotionLaw>,
        is_oscillating: bool,
        is_roller: bool,
        sense: f64,
        side: f64,
    ) -> Self {
        Cam { law: law.0.clone(), kind: Kind::of(is_oscillating, is_roller), sense, side }
    }

    fn shape(
        &self,
        py: Python<'_>,
        size: &CamDimensions,
        n: usize,
        levels: Vec<(String, f64)>,
    ) -> PyResult<CamShape> {
        let cam = CoreCam::<f64>::new(self.kind, self.sense, self.side, size.core());
        let levels = levels.into_iter().map(|(name, level)| Ok((row_named(&name)?, level)));
        let levels: Vec<(usize, f64)> = levels.collect::<PyResult<_>>()?;
        require_room("cam", [ROWS + 3, n])?;
        let quantities = Quantity::of_kind(self.kind);
        let (shape, extremes, passes) = guarded(py, "cam", || {
            let shape = cam.shape(&self.law, n);
            let extreme = |what, sign| cam.extreme(what, sign, &self.law, &shape);
            let extremes: Vec<_> =
                quantities.iter().map(|&what| (extreme(what, 1.0), extreme(what, -1.0))).collect();
            let passes: Vec<Vec<(f64, f64)>> =
                levels.iter().map(|&(row, level)| cam.passes(row, level, &self.law, &shape)).collect();
            (shape, extremes, passes)
        })?;
        let (greatest, least) = (PyDict::new(py), PyDict::new(py));
        for (quantity, (high, low)) in quantities.iter().zip(extremes) {
            greatest.set_item(quantity.name(), CamExtreme::from(high))?;
            least.set_item(quantity.name(), CamExtreme::from(low))?;
        }
        let passes = passes.into_iter().map(|list| {
            let (angle, sign) = list.into_iter().unzip();
            Py::new(py, CamPasses { angle: column(py, angle).unbind(), sign: column(py, sign).unbind() })
        });
        Ok(CamShape {
            rows: rows_by_name(py, shape.rows.iter().map(Vec::as_slice))?,
            angle: PyArray1::from_vec(py, shape.phi).unbind(),
            piece: PyArray1::from_vec(py, shape.piece).unbind(),
            greatest: greatest.unbind(),
            least: least.unbind(),
            passes: passes.collect::<PyResult<_>>()?,
        })
    }

    /// All rows at cam angles by name; at a joint from after it, or from before.
    fn rows(
        &self,
        py: Python<'_>,
        size: &CamDimensions,
        phi: Floats<'_>,
        before: bool,
    ) -> PyResult<Py<PyDict>> {
        let cam = CoreCam::new(self.kind, self.sense, self.side, size.core());
        let phi = phi.as_slice()?;
        require_room("cam", [ROWS, phi.len()])?;
        let mut rows = vec![0.0; ROWS * phi.len()];
        guarded(py, "cam", || cam.rows(&self.law, phi, before, &mut rows))?;
        rows_by_name(py, (0..ROWS).map(|k| &rows[k * phi.len()..(k + 1) * phi.len()]))
    }

    /// Derivatives of all rows at cam angles by directions of dimensions (6, n), of the lift and its first three
    /// derivatives (4, angles, n) and of the angles (angles, n); flat (rows, angles, n).
    #[allow(clippy::too_many_arguments)]
    fn rows_along(
        &self,
        py: Python<'_>,
        size: &CamDimensions,
        phi: Floats<'_>,
        before: bool,
        size_d: Floats<'_>,
        lift_d: Floats<'_>,
        phi_d: Floats<'_>,
    ) -> PyResult<Py<PyDict>> {
        let (phi, size_d) = (phi.as_slice()?, size_d.as_slice()?);
        let (lift_d, phi_d) = (lift_d.as_slice()?, phi_d.as_slice()?);
        let n = size_d.len() / 6;
        let each = phi.len() * n;
        if size_d.len() != 6 * n || lift_d.len() != 4 * each || phi_d.len() != each {
            return Err(PyValueError::new_err("directions of another number of angles or dimensions"));
        }
        let &Cam { ref law, kind, sense, side } = self;
        let of =
            CamAlong { kind, sense, side, size: size.core(), law, phi, before, n, size_d, lift_d, phi_d };
        require_room("derivatives of a cam", [ROWS, each])?;
        let mut rows = vec![0.0; ROWS * each];
        guarded(py, "derivatives of a cam", || of.rows(&mut rows))?;
        rows_by_name(py, rows.chunks_exact(each.max(1)))
    }

    /// A curve beside the pitch curve, seen from the cam.
    fn curve(
        &self,
        py: Python<'_>,
        size: &CamDimensions,
        phi: Floats<'_>,
        before: bool,
        away: f64,
    ) -> PyResult<CamOffset> {
        let cam = CoreCam::new(self.kind, self.sense, self.side, size.core());
        let (phi, analysis) = (phi.as_slice()?, "profile of a cam");
        let n = phi.len();
        require_room(analysis, [6, n])?;
        let mut place = vec![0.0; 6 * n];
        guarded(py, analysis, || cam.curves(&self.law, phi, before, away, &mut place))?;
        let mut d1 = place.split_off(2 * n);
        let d2 = d1.split_off(2 * n);
        let of = |rows: Vec<f64>| -> PyResult<_> { Ok(column(py, rows).reshape([2, n])?.unbind()) };
        Ok(CamOffset { place: of(place)?, d1: of(d1)?, d2: of(d2)? })
    }

    /// Results of many cams; each column has one entry or one a cam.
    #[pyo3(signature = (*, base_radius, roller_radius, offset, distance, arm, tilt, lift, n, per_turn))]
    fn search(
        &self,
        py: Python<'_>,
        base_radius: Floats<'_>,
        roller_radius: Floats<'_>,
        offset: Floats<'_>,
        distance: Floats<'_>,
        arm: Floats<'_>,
        tilt: Floats<'_>,
        lift: Floats<'_>,
        n: usize,
        per_turn: usize,
    ) -> PyResult<CamSearch> {
        let size = Dimensions {
            base_radius: base_radius.as_slice()?,
            roller_radius: roller_radius.as_slice()?,
            offset: offset.as_slice()?,
            distance: distance.as_slice()?,
            arm: arm.as_slice()?,
            tilt: tilt.as_slice()?,
        };
        let lift = lift.as_slice()?;
        let columns =
            [size.base_radius, size.roller_radius, size.offset, size.distance, size.arm, size.tilt, lift];
        if columns.iter().any(|column| column.len() != 1 && column.len() != n) {
            return Err(PyValueError::new_err("columns of one entry, or one for each cam"));
        }
        let analysis = "search of cams";
        require_room(analysis, [3, per_turn])?;
        require_room(analysis, [2 * RESULTS, n])?;
        let cams = Cams { kind: self.kind, sense: self.sense, side: self.side, size, lift, n };
        let mut table = vec![0.0; n * RESULTS];
        guarded(py, analysis, || search(&self.law, &cams, per_turn, &mut table))?;
        // In the order of a row of `cam::search`.
        let [tan_pressure_angle, soundness, bend_max, bend_min] = by_column::<RESULTS>(py, &table);
        Ok(CamSearch { tan_pressure_angle, soundness, bend_max, bend_min })
    }
}

/// Sides of a closed polygon that cross: side and share along it of both, and the place.
#[pyfunction]
pub(crate) fn cam_crossings(py: Python<'_>, x: Floats<'_>, y: Floats<'_>) -> PyResult<CamCrossings> {
    let (x, y) = (x.as_slice()?, y.as_slice()?);
    if x.len() != y.len() {
        return Err(PyValueError::new_err("as many x as y"));
    }
    let found = guarded(py, "crossings of a profile", || crossings(x, y))?;
    let list = |of: fn(&Crossing) -> f64| column(py, found.iter().map(of).collect()).unbind();
    Ok(CamCrossings {
        first: list(|c| c.first),
        second: list(|c| c.second),
        x: list(|c| c.x),
        y: list(|c| c.y),
    })
}
