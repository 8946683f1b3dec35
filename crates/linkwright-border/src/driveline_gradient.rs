//! Derivatives of the steady motion of elastic drivelines at the border.

use linkwright_derivatives::elastic::ElasticDerivatives;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::column;
use crate::driveline::rows;

type Array = Py<PyArray1<f64>>;
type Table = Py<PyArray2<f64>>;

/// Derivatives along n directions, (n,), or (masses or links, n).
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineGradient {
    period: Array,
    energy_drive: Array,
    energy_load: Array,
    torque_mean: Table,
    torque_rms: Table,
    loss: Table,
    speed_min: Table,
    speed_max: Table,
    acceleration_min: Table,
    acceleration_max: Table,
    twist_min: Table,
    twist_max: Table,
    torque_min: Table,
    torque_max: Table,
    monodromy: Table,
}

impl DrivelineGradient {
    /// From the core's, for so many masses, links and numbers of a state.
    pub(crate) fn new(
        py: Python<'_>,
        found: ElasticDerivatives,
        [masses, links, states]: [usize; 3],
    ) -> PyResult<Self> {
        let one = |list: Vec<f64>| column(py, list).unbind();
        let of_masses = |list: Vec<f64>| rows(py, list, masses);
        let of_links = |list: Vec<f64>| rows(py, list, links);
        let [speed_min, speed_max] = found.speed;
        let [acceleration_min, acceleration_max] = found.acceleration;
        let [twist_min, twist_max] = found.twist;
        let [torque_min, torque_max] = found.torque;
        Ok(DrivelineGradient {
            period: one(found.period),
            energy_drive: one(found.drive_work),
            energy_load: one(found.load_work),
            torque_mean: of_links(found.torque_mean)?,
            torque_rms: of_links(found.torque_rms)?,
            loss: of_links(found.loss)?,
            speed_min: of_masses(speed_min)?,
            speed_max: of_masses(speed_max)?,
            acceleration_min: of_masses(acceleration_min)?,
            acceleration_max: of_masses(acceleration_max)?,
            twist_min: of_links(twist_min)?,
            twist_max: of_links(twist_max)?,
            torque_min: of_links(torque_min)?,
            torque_max: of_links(torque_max)?,
            monodromy: rows(py, found.monodromy, states * states)?,
        })
    }
}
