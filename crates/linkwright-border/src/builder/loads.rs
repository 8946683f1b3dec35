//! Bodies and loads: `drive::loads` of the core, with the same names.

use linkwright_core::drive::loads::{Body as CoreBody, Carrier, ForceElement, FormulaLoad, Load as CoreLoad};
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

/// A load. Tables and formulas come along.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum Load {
    #[pyo3(constructor = (*, slide, force))]
    DrySlide { slide: usize, force: usize },
    #[pyo3(constructor = (*, point, force))]
    DryPoint { point: usize, force: usize },
    #[pyo3(constructor = (*, link, torque))]
    DryLink { link: usize, torque: usize },
    #[pyo3(constructor = (*, torque))]
    DryCrank { torque: usize },
    #[pyo3(constructor = (*, slide, damping))]
    ViscousSlide { slide: usize, damping: usize },
    #[pyo3(constructor = (*, point, damping))]
    ViscousPoint { point: usize, damping: usize },
    #[pyo3(constructor = (*, link, damping))]
    ViscousLink { link: usize, damping: usize },
    #[pyo3(constructor = (*, point, x, y))]
    Force { point: usize, x: usize, y: usize },
    #[pyo3(constructor = (*, link, torque))]
    Torque { link: usize, torque: usize },
    #[pyo3(constructor = (*, x, y))]
    Gravity { x: usize, y: usize },
    #[pyo3(constructor = (*, start, end, stiffness, free_length, preload))]
    Spring { start: usize, end: usize, stiffness: usize, free_length: usize, preload: usize },
    #[pyo3(constructor = (*, slide, forward, back))]
    ForcePosition { slide: usize, forward: Knots, back: Knots },
    #[pyo3(constructor = (*, table, turns))]
    TorqueAngle { table: Knots, turns: u32 },
    #[pyo3(constructor = (*, slide, table, turns))]
    ForceAngle { slide: usize, table: Knots, turns: u32 },
    #[pyo3(constructor = (*, table))]
    TorqueSpeed { table: Knots },
    #[pyo3(constructor = (*, point, link, along, across))]
    Follow { point: usize, link: usize, along: usize, across: usize },
    #[pyo3(constructor = (*, start, end, damping))]
    Damper { start: usize, end: usize, damping: usize },
    #[pyo3(constructor = (*, start, end, table))]
    DamperTable { start: usize, end: usize, table: Knots },
    #[pyo3(constructor = (*, start, end, table))]
    SpringTable { start: usize, end: usize, table: Knots },
    #[pyo3(constructor = (*, link, other, stiffness, cos, sin))]
    TorsionSpring { link: usize, other: Option<usize>, stiffness: usize, cos: usize, sin: usize },
    #[pyo3(constructor = (*, link, other, damping))]
    TorsionDamper { link: usize, other: Option<usize>, damping: usize },
    #[pyo3(constructor = (*, start, end, force, length, column, exponent))]
    GasSpring { start: usize, end: usize, force: usize, length: usize, column: usize, exponent: usize },
    #[pyo3(constructor = (*, formula, slide, point, turns))]
    FormulaOnSlide { formula: Formula, slide: usize, point: usize, turns: u32 },
    #[pyo3(constructor = (*, formula, point, cos, sin, turns))]
    FormulaOnPoint { formula: Formula, point: usize, cos: usize, sin: usize, turns: u32 },
    #[pyo3(constructor = (*, formula, point, link, cos, sin, turns))]
    FormulaAlong { formula: Formula, point: usize, link: usize, cos: usize, sin: usize, turns: u32 },
    #[pyo3(constructor = (*, formula, link, turns))]
    FormulaOnLink { formula: Formula, link: usize, turns: u32 },
}

impl Load {
    /// Adds it to a plan, with its tables and its formula.
    pub(super) fn add_to(&self, to: &mut Builder) -> Result<(), PlanError> {
        match *self {
            Load::DrySlide { slide, force } => to.load(CoreLoad::DrySlide { slide, force }),
            Load::DryPoint { point, force } => to.load(CoreLoad::DryPoint { point, force }),
            Load::DryLink { link, torque } => to.load(CoreLoad::DryLink { link, torque }),
            Load::DryCrank { torque } => to.load(CoreLoad::DryCrank { torque }),
            Load::ViscousSlide { slide, damping } => to.load(CoreLoad::ViscousSlide { slide, damping }),
            Load::ViscousPoint { point, damping } => to.load(CoreLoad::ViscousPoint { point, damping }),
            Load::ViscousLink { link, damping } => to.load(CoreLoad::ViscousLink { link, damping }),
            Load::Force { point, x, y } => to.load(CoreLoad::Force { point, x, y }),
            Load::Torque { link, torque } => to.load(CoreLoad::Torque { link, torque }),
            Load::Gravity { x, y } => to.load(CoreLoad::Gravity { x, y }),
            Load::Spring { start: from, end, stiffness, free_length, preload } => {
                to.load(CoreLoad::Spring { from, to: end, stiffness, free_length, preload })
            }
            Load::ForcePosition { slide, ref forward, ref back } => {
                let (forward, back) = (to.table(forward.0.clone()), to.table(back.0.clone()));
                to.load(CoreLoad::ForcePosition { slide, forward, back })
            }
            Load::TorqueAngle { ref table, turns } => {
                let table = to.table(table.0.clone());
                to.load(CoreLoad::TorqueAngle { table, turns })
            }
            Load::ForceAngle { slide, ref table, turns } => {
                let table = to.table(table.0.clone());
                to.load(CoreLoad::ForceAngle { slide, table, turns })
            }
            Load::TorqueSpeed { ref table } => {
                let table = to.table(table.0.clone());
                to.speed_load(table)
            }
            Load::Follow { .. }
            | Load::Damper { .. }
            | Load::DamperTable { .. }
            | Load::SpringTable { .. }
            | Load::TorsionSpring { .. }
            | Load::TorsionDamper { .. }
            | Load::GasSpring { .. } => self.add_between(to),
            Load::FormulaOnSlide { ref formula, slide, point, turns } => {
                by_formula(to, formula, turns, Carrier::Slide { slide, point })
            }
            Load::FormulaOnPoint { ref formula, point, cos, sin, turns } => {
                by_formula(to, formula, turns, Carrier::Point { point, cos, sin })
            }
            Load::FormulaAlong { ref formula, point, link, cos, sin, turns } => {
                by_formula(to, formula, turns, Carrier::Along { point, link, cos, sin })
            }
            Load::FormulaOnLink { ref formula, link, turns } => {
                by_formula(to, formula, turns, Carrier::Link { link })
            }
        }
    }

    /// The same for springs by a curve, dampers, and what turns with a link.
    fn add_between(&self, to: &mut Builder) -> Result<(), PlanError> {
        let element = match *self {
            Load::Follow { point, link, along, across } => {
                ForceElement::Follow { point, link, along, across }
            }
            Load::Damper { start: from, end: to, damping } => ForceElement::Damper { from, to, damping },
            Load::DamperTable { start, end, ref table } => {
                let table = to.table(table.0.clone());
                return to.damper(start, end, table);
            }
            Load::SpringTable { start: from, end, ref table } => {
                ForceElement::SpringTable { from, to: end, table: to.table(table.0.clone()) }
            }
            Load::TorsionSpring { link, other, stiffness, cos, sin } => {
                ForceElement::TorsionSpring { link, other, stiffness, cos, sin }
            }
            Load::TorsionDamper { link, other, damping } => {
                ForceElement::TorsionDamper { link, other, damping }
            }
            Load::GasSpring { start: from, end: to, force, length, column, exponent } => {
                ForceElement::GasSpring { from, to, force, length, column, exponent }
            }
            _ => unreachable!("sorted by `add_to`"),
        };
        to.force_element(element)
    }
}

fn by_formula(to: &mut Builder, formula: &Formula, turns: u32, carrier: Carrier) -> Result<(), PlanError> {
    let formula = to.formula(formula.0.clone())?;
    to.formula_load(FormulaLoad { formula, carrier, turns })
}
