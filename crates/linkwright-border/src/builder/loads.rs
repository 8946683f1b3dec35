//! Bodies and loads: `drive::loads` of the core, with the same names.

use linkwright_core::drive::loads::{At as CoreAt, Body as CoreBody, What as CoreWhat};
use linkwright_core::plan::builder::Builder;
use linkwright_kernel::error::PlanError;
use pyo3::prelude::*;

use super::numbers::{Formula, Knots};

/// A body: a mass at a point, or a link with its centre of mass.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum Body {
    #[pyo3(constructor = (*, point, mass))]
    Point { point: usize, mass: usize },
    #[pyo3(constructor = (*, link, origin, along, across, mass, inertia))]
    Link { link: usize, origin: usize, along: usize, across: usize, mass: usize, inertia: usize },
}

impl Body {
    pub(super) fn core(&self) -> CoreBody {
        match *self {
            Body::Point { point, mass } => CoreBody::Point { point, mass },
            Body::Link { link, origin, along, across, mass, inertia } => {
                CoreBody::Link { link, origin, along, across, mass, inertia }
            }
        }
    }
}

/// Where a load acts.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum At {
    #[pyo3(constructor = (*, cos, sin))]
    Bodies { cos: usize, sin: usize },
    #[pyo3(constructor = ())]
    Crank {},
    #[pyo3(constructor = (*, slide, point))]
    Slide { slide: usize, point: usize },
    #[pyo3(constructor = (*, point))]
    Point { point: usize },
    #[pyo3(constructor = (*, point, cos, sin))]
    Toward { point: usize, cos: usize, sin: usize },
    #[pyo3(constructor = (*, point, link, cos, sin))]
    Along { point: usize, link: usize, cos: usize, sin: usize },
    #[pyo3(constructor = (*, link))]
    Link { link: usize },
    #[pyo3(constructor = (*, start, end))]
    Between { start: usize, end: usize },
    #[pyo3(constructor = (*, link, other, cos, sin))]
    BetweenLinks { link: usize, other: Option<usize>, cos: usize, sin: usize },
}

impl At {
    pub(super) fn core(&self) -> CoreAt {
        match *self {
            At::Bodies { cos, sin } => CoreAt::Bodies { cos, sin },
            At::Crank {} => CoreAt::Crank,
            At::Slide { slide, point } => CoreAt::Slide { slide, point },
            At::Point { point } => CoreAt::Point { point },
            At::Toward { point, cos, sin } => CoreAt::Toward { point, cos, sin },
            At::Along { point, link, cos, sin } => CoreAt::Along { point, link, cos, sin },
            At::Link { link } => CoreAt::Link { link },
            At::Between { start: from, end: to } => CoreAt::Between { from, to },
            At::BetweenLinks { link, other, cos, sin } => CoreAt::BetweenLinks { link, other, cos, sin },
        }
    }
}

/// What a load is. Tables and formulas come along.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum What {
    #[pyo3(constructor = (*, size))]
    Constant { size: usize },
    #[pyo3(constructor = (*, size))]
    Dry { size: usize },
    #[pyo3(constructor = (*, damping))]
    Viscous { damping: usize },
    #[pyo3(constructor = (*, stiffness, free_length, preload))]
    Spring { stiffness: usize, free_length: usize, preload: usize },
    #[pyo3(constructor = (*, force, length, column, exponent))]
    Gas { force: usize, length: usize, column: usize, exponent: usize },
    #[pyo3(constructor = (*, table))]
    Curve { table: Knots },
    #[pyo3(constructor = (*, forward, back))]
    Resistance { forward: Knots, back: Knots },
    #[pyo3(constructor = (*, table, turns))]
    OverAngle { table: Knots, turns: u32 },
    #[pyo3(constructor = (*, table))]
    OverSpeed { table: Knots },
    #[pyo3(constructor = (*, formula, turns))]
    Formula { formula: Formula, turns: u32 },
}

impl What {
    /// Of a plan, which takes the tables and the formula.
    pub(super) fn core(&self, plan: &mut Builder) -> Result<CoreWhat, PlanError> {
        let mut put = |table: &Knots| plan.table(table.0.clone());
        Ok(match *self {
            What::Constant { size } => CoreWhat::Constant { size },
            What::Dry { size } => CoreWhat::Dry { size },
            What::Viscous { damping } => CoreWhat::Viscous { damping },
            What::Spring { stiffness, free_length, preload } => {
                CoreWhat::Spring { stiffness, free_length, preload }
            }
            What::Gas { force, length, column, exponent } => {
                CoreWhat::Gas { force, length, column, exponent }
            }
            What::Curve { ref table } => CoreWhat::Curve { table: put(table) },
            What::Resistance { ref forward, ref back } => {
                CoreWhat::Resistance { forward: put(forward), back: put(back) }
            }
            What::OverAngle { ref table, turns } => CoreWhat::OverAngle { table: put(table), turns },
            What::OverSpeed { ref table } => CoreWhat::OverSpeed { table: put(table) },
            What::Formula { ref formula, turns } => {
                CoreWhat::Formula { formula: plan.formula(formula.0.clone())?, turns }
            }
        })
    }
}
