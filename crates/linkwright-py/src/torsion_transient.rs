//! Trains in motion at the border.

use linkwright_core::torsion::transient::course::{self, Method, Request};
use linkwright_core::torsion::transient::rates::Rates;
use linkwright_core::torsion::transient::system::{Encoded, System};
use numpy::{PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::column;
use crate::errors::plan_error;
use crate::guard::{guarded, require_room, zeros};
use crate::{Curve, Floats, Ints, Table};

/// How it ended, by which method; steps, rejected, evaluations; time reached, bound of the fastest swing, energies at start
/// and end; samples, extremes, work.
type Moved<'py> = (u8, u8, [usize; 3], [f64; 6], Table<'py>, Table<'py>, Curve<'py>);

/// A train in motion, decoded and checked.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct TorsionSystem(System);

impl TorsionSystem {
    fn fits(&self, what: &str, found: usize, expected: usize) -> PyResult<()> {
        if found == expected {
            Ok(())
        } else {
            Err(PyValueError::new_err(format!("{what} holds {found} numbers, {expected} are needed")))
        }
    }
}

#[pymethods]
impl TorsionSystem {
    #[new]
    fn new(
        py: Python<'_>,
        inertia: Floats<'_>,
        damping: Floats<'_>,
        swing_damping: Floats<'_>,
        links: Ints<'_>,
        link_numbers: Floats<'_>,
        rotors: Ints<'_>,
        rotor_numbers: Floats<'_>,
        torques: Ints<'_>,
        torque_numbers: Floats<'_>,
        table_starts: Ints<'_>,
        periods: Floats<'_>,
        knots: Floats<'_>,
        curve_starts: Ints<'_>,
        points: Floats<'_>,
    ) -> PyResult<Self> {
        let code = Encoded {
            masses: [inertia.as_slice()?, damping.as_slice()?, swing_damping.as_slice()?],
            links: links.as_slice()?,
            link_numbers: link_numbers.as_slice()?,
            rotors: rotors.as_slice()?,
            rotor_numbers: rotor_numbers.as_slice()?,
            torques: torques.as_slice()?,
            torque_numbers: torque_numbers.as_slice()?,
            table_starts: table_starts.as_slice()?,
            periods: periods.as_slice()?,
            knots: knots.as_slice()?,
            curve_starts: curve_starts.as_slice()?,
            points: points.as_slice()?,
        };
        guarded(py, "translation of the train", || System::decode(&code))?
            .map(TorsionSystem)
            .map_err(plan_error)
    }

    fn follow<'py>(
        &self,
        py: Python<'py>,
        angle: Floats<'_>,
        speed: Floats<'_>,
        times: Floats<'_>,
        start: f64,
        duration: f64,
        accuracy: f64,
        method: u8,
        steps_max: usize,
    ) -> PyResult<Moved<'py>> {
        let method = match method {
            0 => Method::Auto,
            1 => Method::Explicit,
            2 => Method::Implicit,
            other => return Err(PyValueError::new_err(format!("there is no method {other}"))),
        };
        let (angle, speed, times) = (angle.as_slice()?, speed.as_slice()?, times.as_slice()?);
        self.fits("angle", angle.len(), self.0.len())?;
        self.fits("speed", speed.len(), self.0.len())?;
        let request = Request { angle, speed, times, start, duration, accuracy, method, steps_max };
        let analysis = "torsional motion in time";
        require_room(analysis, [2 * self.0.len() + self.0.links.len() + 2, times.len()])?;
        let found = guarded(py, analysis, || course::follow(&self.0, &request))?;
        let rows = found.samples.len() / times.len().max(1);
        let samples = zeros(py, analysis, [rows, times.len()])?;
        samples.readwrite().as_slice_mut()?.copy_from_slice(&found.samples);
        let extremes = zeros(py, analysis, [found.extremes.len(), 4])?;
        extremes.readwrite().as_slice_mut()?.copy_from_slice(found.extremes.as_flattened());
        let [t0, v0, t1, v1] = found.energies;
        Ok((
            found.end as u8,
            found.method as u8,
            [found.steps, found.rejected, found.evaluations],
            [found.time, found.fastest, t0, v0, t1, v1],
            samples,
            extremes,
            column(py, found.work),
        ))
    }

    fn net_torques<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        angle: PyReadonlyArray2<'_, f64>,
        speed: Floats<'_>,
    ) -> PyResult<(Table<'py>, Table<'py>)> {
        let (n, speed) = (self.0.len(), speed.as_slice()?);
        let rows = angle.as_array().nrows();
        self.fits("angle", angle.as_array().ncols(), n)?;
        self.fits("speed", speed.len(), n)?;
        let analysis = "torques on a train";
        let (net, inertia) = (zeros(py, analysis, [rows, n])?, zeros(py, analysis, [rows, n])?);
        {
            let (mut net, mut inertia) = (net.readwrite(), inertia.readwrite());
            let lists = net
                .as_slice_mut()?
                .chunks_exact_mut(n.max(1))
                .zip(inertia.as_slice_mut()?.chunks_exact_mut(n.max(1)));
            let angles = angle.as_slice()?.chunks_exact(n.max(1));
            guarded(py, analysis, || {
                let mut rates = Rates::new(&self.0);
                rates.enter(t);
                for (angle, (net, inertia)) in angles.zip(lists) {
                    rates.net_torques(t, angle, speed, net, inertia);
                }
            })?;
        }
        Ok((net, inertia))
    }
}
