//! Derivatives of the steady motion of elastic drivelines at the border.

use linkwright_derivatives::elastic::ElasticDerivatives;
use linkwright_driveline::chain::Chain;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::column;
use crate::driveline::rows;

type Array = Py<PyArray1<f64>>;
type Table = Py<PyArray2<f64>>;

/// Derivatives along n directions, (n,), or (masses, links or drivers, n).
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct DrivelineGradient {
    period: Array,
    energy_drive: Table,
    torque_drive_mean: Table,
    torque_drive_min: Table,
    torque_drive_max: Table,
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
    /// From the core's.
    pub(crate) fn new(py: Python<'_>, found: ElasticDerivatives, chain: &Chain) -> PyResult<Self> {
        let states = chain.states();
        let one = |list: Vec<f64>| column(py, list).unbind();
        let of_masses = |list: Vec<f64>| rows(py, list, chain.masses());
        let of_links = |list: Vec<f64>| rows(py, list, chain.links.len());
        let of_drivers = |list: Vec<f64>| rows(py, list, chain.drivers.len());
        let [speed_min, speed_max] = found.speed;
        let [acceleration_min, acceleration_max] = found.acceleration;
        let [twist_min, twist_max] = found.twist;
        let [torque_min, torque_max] = found.torque;
        let [torque_drive_min, torque_drive_max] = found.drive;
        Ok(DrivelineGradient {
            period: one(found.period),
            energy_drive: of_drivers(found.drive_work)?,
            torque_drive_mean: of_drivers(found.drive_mean)?,
            torque_drive_min: of_drivers(torque_drive_min)?,
            torque_drive_max: of_drivers(torque_drive_max)?,
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
