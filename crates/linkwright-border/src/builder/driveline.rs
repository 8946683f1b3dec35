//! What acts on the masses of a driveline: `chain` of the core's driveline, with the same names.

use linkwright_driveline::chain::{Part, Source, Station, Torque};
use pyo3::prelude::*;
use std::sync::Arc;

use super::Plan;
use crate::Floats;

/// A torque on a mass from outside.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct DrivelineTorque(Torque);

#[pymethods]
impl DrivelineTorque {
    /// The motor of the plan at the crank.
    #[staticmethod]
    fn own(mass: usize) -> Self {
        DrivelineTorque(Torque { mass, source: Source::Own })
    }

    /// A motor that keeps a speed.
    #[staticmethod]
    fn held(mass: usize, speed: f64) -> Self {
        DrivelineTorque(Torque { mass, source: Source::Held(speed) })
    }

    /// The motor of another plan, through its gearbox.
    #[staticmethod]
    fn motor(mass: usize, plan: PyRef<'_, Plan>, q: Floats<'_>) -> PyResult<Self> {
        Ok(DrivelineTorque(Torque { mass, source: Source::Motor(part(&plan, &q)?) }))
    }

    /// A power of the speed.
    #[staticmethod]
    #[pyo3(signature = (mass, *, torque, speed, exponent))]
    fn power(mass: usize, torque: f64, speed: f64, exponent: f64) -> Self {
        DrivelineTorque(Torque { mass, source: Source::Power { torque, speed, exponent } })
    }
}

impl DrivelineTorque {
    pub(crate) fn core(&self) -> Torque {
        self.0.clone()
    }
}

/// A further mechanism on a mass.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct DrivelineStation(Station);

#[pymethods]
impl DrivelineStation {
    #[new]
    #[pyo3(signature = (mass, plan, q, *, ratio, phase))]
    fn new(mass: usize, plan: PyRef<'_, Plan>, q: Floats<'_>, ratio: f64, phase: f64) -> PyResult<Self> {
        Ok(DrivelineStation(Station { mass, part: part(&plan, &q)?, ratio, phase }))
    }
}

impl DrivelineStation {
    pub(crate) fn core(&self) -> Station {
        self.0.clone()
    }
}

fn part(plan: &Plan, q: &Floats<'_>) -> PyResult<Part> {
    Ok(Part { q: plan.parameters(q)?.to_vec(), plan: Arc::new(plan.0.clone()) })
}
