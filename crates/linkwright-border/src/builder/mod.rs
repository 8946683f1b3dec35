//! A machine's structure from Python: values of named classes, of which the core's plan is built.
//!
//! | module | |
//! | --- | --- |
//! | `numbers` | tables, formulas, motion laws |
//! | `parts` | guides, sums, bars, change points: what elements consist of |
//! | `elements` | elements of the mechanism |
//! | `loads` | bodies and loads |
//! | `drive` | motor and driveline |
//! | `train` | masses, links and torques of a train in motion |

pub(crate) mod drive;
pub(crate) mod driveline;
pub(crate) mod elements;
pub(crate) mod loads;
pub(crate) mod numbers;
pub(crate) mod parts;
pub(crate) mod train;

use drive::Drive;
use elements::{Element, GroundPoint};
use linkwright_core::drive::loads::Load;
use linkwright_core::drive::structure::Plan as CorePlan;
use linkwright_core::plan::builder::Builder;
use loads::{At, Body, What};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;
use crate::errors::plan_error;

/// A machine's structure, checked.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct Plan(pub(crate) CorePlan);

#[pymethods]
impl Plan {
    #[new]
    #[pyo3(signature = (*, parameters, ground, elements, bodies, loads, drive))]
    fn new(
        parameters: usize,
        ground: Vec<PyRef<'_, GroundPoint>>,
        elements: Vec<PyRef<'_, Element>>,
        bodies: Vec<PyRef<'_, Body>>,
        loads: Vec<(PyRef<'_, At>, PyRef<'_, What>)>,
        drive: PyRef<'_, Drive>,
    ) -> PyResult<Self> {
        let mut builder = Builder::new(parameters);
        for point in ground {
            builder.fixed(point.core()).map_err(plan_error)?;
        }
        for element in elements {
            builder.element(element.core()).map_err(plan_error)?;
        }
        for body in bodies {
            builder.body(body.core()).map_err(plan_error)?;
        }
        for (at, what) in loads {
            let what = what.core(&mut builder).map_err(plan_error)?;
            builder.load(Load { at: at.core(), what }).map_err(plan_error)?;
        }
        let drive = drive.core(&mut builder);
        builder.into_plan(drive).map(Plan).map_err(plan_error)
    }

    /// Whether loads depend on both angle and speed in their own way, or on time.
    #[getter]
    fn has_laws(&self) -> bool {
        !self.0.laws.is_empty()
    }

    /// Revolutions of the crank after which all loads repeat.
    #[getter]
    fn turns(&self) -> u32 {
        self.0.turns
    }

    /// The same over at least so many revolutions, as many as loads and these have in common.
    fn over_turns(&self, turns: u32) -> PyResult<Plan> {
        self.0.over_turns(turns).map(Plan).map_err(plan_error)
    }

    fn without_conservative(&self) -> Plan {
        Plan(self.0.without_conservative())
    }
}

impl Plan {
    pub(crate) fn parameters<'a>(&self, q: &'a Floats<'_>) -> PyResult<&'a [f64]> {
        let q = q.as_slice()?;
        let n = self.0.n_parameters;
        if q.len() == n {
            Ok(q)
        } else {
            Err(PyValueError::new_err(format!("{} parameters given, the plan has {n}", q.len())))
        }
    }
}
