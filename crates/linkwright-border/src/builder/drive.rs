//! The driveline: `drive::motor` of the core, with the same names.

use linkwright_core::drive::motor::{self, Motor as CoreMotor};
use linkwright_core::plan::builder::Builder;
use pyo3::prelude::*;

use super::numbers::Knots;

/// A cubic of the curve below breakdown, level at its right end, or at both.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct Span {
    x0: usize,
    y0: usize,
    x1: usize,
    y1: usize,
    inverse_width: usize,
    is_level: bool,
}

#[pymethods]
impl Span {
    #[new]
    #[pyo3(signature = (*, x0, y0, x1, y1, inverse_width, is_level))]
    fn new(x0: usize, y0: usize, x1: usize, y1: usize, inverse_width: usize, is_level: bool) -> Self {
        Span { x0, y0, x1, y1, inverse_width, is_level }
    }
}

impl Span {
    fn core(self) -> motor::Span {
        let Span { x0, y0, x1, y1, inverse_width, is_level } = self;
        motor::Span { x0, y0, x1, y1, inverse_width, is_level }
    }
}

/// Torque against speed at the motor shaft.
#[pyclass(frozen, from_py_object, module = "linkwright._core")]
#[derive(Clone)]
pub(crate) enum Motor {
    #[pyo3(constructor = (*, torque))]
    Constant { torque: usize },
    #[pyo3(constructor = (*, torque, inverse_speed))]
    Line { torque: usize, inverse_speed: usize },
    #[pyo3(constructor = (*, inverse_synchronous, torque, slip, resistance, spans))]
    Induction { inverse_synchronous: usize, torque: usize, slip: usize, resistance: usize, spans: Vec<Span> },
    #[pyo3(constructor = (*, table))]
    Table { table: Knots },
}

impl Motor {
    fn core(&self, builder: &mut Builder) -> CoreMotor {
        match *self {
            Motor::Constant { torque } => CoreMotor::Constant { torque },
            Motor::Line { torque, inverse_speed } => CoreMotor::Line { torque, inverse_speed },
            Motor::Induction { inverse_synchronous, torque, slip, resistance, ref spans } => {
                let spans = spans.iter().copied().map(Span::core).collect();
                CoreMotor::Induction { inverse_synchronous, torque, slip, resistance, spans }
            }
            Motor::Table { ref table } => CoreMotor::Table { table: builder.table(table.0.clone()) },
        }
    }
}

/// Motor, gearbox, and the inertia that turns with the crank.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct Drive {
    motor: Option<Motor>,
    ratio: usize,
    forward: usize,
    reverse: usize,
    inertia: usize,
    speed_start: usize,
}

#[pymethods]
impl Drive {
    #[new]
    #[pyo3(signature = (*, motor, ratio, forward, reverse, inertia, speed_start))]
    fn new(
        motor: Option<Motor>,
        ratio: usize,
        forward: usize,
        reverse: usize,
        inertia: usize,
        speed_start: usize,
    ) -> Self {
        Drive { motor, ratio, forward, reverse, inertia, speed_start }
    }
}

impl Drive {
    pub(super) fn core(&self, builder: &mut Builder) -> motor::Drive {
        let &Drive { ref motor, ratio, forward, reverse, inertia, speed_start } = self;
        let motor = motor.as_ref().map_or(CoreMotor::Off, |motor| motor.core(builder));
        motor::Drive { motor, ratio, forward, reverse, inertia, speed_start, speed_loads: Vec::new() }
    }
}
