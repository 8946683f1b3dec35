//! A machine as data for the library of an FMU.

use linkwright_exchange::data::rigid;
use linkwright_exchange::{Data, Model, Parameter, Purpose};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::Floats;
use crate::builder::Plan;
use crate::driveline_chain::Driveline;
use crate::guard::guarded;

/// A value and what it changes: slots, factors and powers.
type Setting = (f64, Vec<(usize, f64, f64)>);

/// A machine as data, and how many states and event indicators it has.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct FmuMachine {
    data: Py<PyBytes>,
    states: usize,
    event_indicators: usize,
}

#[pyfunction]
#[pyo3(signature = (plan, q, *, motor, start, accuracy, parameters, token, driveline=None, brake=None, scales=Vec::new(), ranges=Vec::new()))]
pub(crate) fn fmu_machine(
    py: Python<'_>,
    plan: &Plan,
    q: Floats<'_>,
    motor: i8,
    start: (f64, f64),
    accuracy: f64,
    parameters: Vec<Setting>,
    token: String,
    driveline: Option<Driveline<'_>>,
    brake: Option<usize>,
    scales: Vec<(u32, f64)>,
    ranges: Vec<(u32, f64, f64)>,
) -> PyResult<FmuMachine> {
    let chain = driveline.map_or_else(|| Ok(rigid()), |driveline| driveline.chain())?;
    let data = Data {
        brake: brake.unwrap_or(chain.masses() - 1),
        scales,
        ranges,
        q: plan.parameters(&q)?.to_vec(),
        plan: plan.0.clone(),
        chain,
        motor: f64::from(motor),
        start: [start.0, start.1],
        accuracy,
        parameters: parameters.into_iter().map(|(value, effects)| Parameter { value, effects }).collect(),
        token,
    };
    let (bytes, states, event_indicators) = guarded(py, "FMU", || {
        let bytes = data.to_bytes()?;
        let mut model = Model::new(data, Purpose::Exchange);
        Ok((bytes, model.states(), model.indicator_count()))
    })?
    .map_err(|fault: linkwright_exchange::Fault| PyValueError::new_err(fault.to_string()))?;
    Ok(FmuMachine { data: PyBytes::new(py, &bytes).unbind(), states, event_indicators })
}
