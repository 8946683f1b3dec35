//! Bodies, loads and laws on the mechanism.

use super::builder::{Builder, all_below};
use crate::drive::loads::{Body, Carrier, ForceElement, FormulaLoad, Law, Load};
use crate::kernel::error::PlanError;
use crate::kernel::formula::{Degree, Variable};

impl Builder {
    /// Adds a body.
    ///
    /// # Errors
    /// Its carrier or a parameter does not exist.
    pub fn body(&mut self, body: Body) -> Result<(), PlanError> {
        match body {
            Body::Point { point, mass } => {
                self.points(&[point])?;
                self.slots(&[mass])?;
            }
            Body::Link { link, origin, along, across, mass, inertia } => {
                self.links(&[link])?;
                self.points(&[origin])?;
                self.slots(&[along, across, mass, inertia])?;
            }
        }
        self.bodies.push(body);
        Ok(())
    }

    /// Adds a load.
    ///
    /// # Errors
    /// Its carrier, a table or a parameter does not exist.
    pub fn load(&mut self, load: Load) -> Result<(), PlanError> {
        match load {
            Load::DrySlide { slide, force: size } | Load::ViscousSlide { slide, damping: size } => {
                self.slides(&[slide])?;
                self.slots(&[size])?;
            }
            Load::DryPoint { point, force: size } | Load::ViscousPoint { point, damping: size } => {
                self.points(&[point])?;
                self.slots(&[size])?;
            }
            Load::DryLink { link, torque: size }
            | Load::ViscousLink { link, damping: size }
            | Load::Torque { link, torque: size } => {
                self.links(&[link])?;
                self.slots(&[size])?;
            }
            Load::DryCrank { torque } => self.slots(&[torque])?,
            Load::Force { point, x, y } => {
                self.points(&[point])?;
                self.slots(&[x, y])?;
            }
            Load::Gravity { x, y } => self.slots(&[x, y])?,
            Load::Spring { from, to, stiffness, free_length, preload } => {
                self.points(&[from, to])?;
                self.slots(&[stiffness, free_length, preload])?;
            }
            Load::ForcePosition { slide, forward, back } => {
                self.slides(&[slide])?;
                self.tables(&[forward, back])?;
            }
            Load::TorqueAngle { table, turns } => {
                self.tables(&[table])?;
                self.repeats_after(turns)?;
            }
            Load::ForceAngle { slide, table, turns } => {
                self.slides(&[slide])?;
                self.tables(&[table])?;
                self.repeats_after(turns)?;
            }
        }
        self.loads.push(load);
        Ok(())
    }

    /// Adds a force element; formulas are sorted by [`Builder::formula_load`].
    ///
    /// # Errors
    /// As [`Builder::load`].
    pub fn force_element(&mut self, load: ForceElement) -> Result<(), PlanError> {
        match load {
            ForceElement::Follow { point, link, along, across } => {
                self.points(&[point])?;
                self.links(&[link])?;
                self.slots(&[along, across])?;
            }
            ForceElement::SpringTable { from, to, table } => {
                self.points(&[from, to])?;
                self.tables(&[table])?;
            }
            ForceElement::Damper { from, to, damping } => {
                self.points(&[from, to])?;
                self.slots(&[damping])?;
            }
            ForceElement::GasSpring { from, to, force, length, column, exponent } => {
                self.points(&[from, to])?;
                self.slots(&[force, length, column, exponent])?;
            }
            ForceElement::TorsionSpring { link, other, stiffness, cos, sin } => {
                self.links(&[link, other.unwrap_or(link)])?;
                self.slots(&[stiffness, cos, sin])?;
            }
            ForceElement::TorsionDamper { link, other, damping } => {
                self.links(&[link, other.unwrap_or(link)])?;
                self.slots(&[damping])?;
            }
            ForceElement::Formula(load) | ForceElement::ViscousFormula(load) => {
                self.check_formula_load(&load)?;
            }
        }
        self.force_elements.push(load);
        Ok(())
    }

    /// Adds a formula's load where its degree in the speed of the crank has it belong.
    ///
    /// # Errors
    /// As [`Builder::load`]; or the formula does not exist.
    pub fn formula_load(&mut self, load: FormulaLoad) -> Result<(), PlanError> {
        self.check_formula_load(&load)?;
        match self.formulas[load.formula].degree {
            Degree::Any | Degree::Of(0) => self.force_elements.push(ForceElement::Formula(load)),
            Degree::Of(1) => self.force_elements.push(ForceElement::ViscousFormula(load)),
            _ => self.laws.push(Law::Formula(load)),
        }
        Ok(())
    }

    /// Adds a damper by a table over the speed at which two points part.
    ///
    /// # Errors
    /// As [`Builder::load`].
    pub fn damper(&mut self, from: usize, to: usize, table: usize) -> Result<(), PlanError> {
        self.points(&[from, to])?;
        self.tables(&[table])?;
        self.laws.push(Law::Damper { from, to, table });
        Ok(())
    }

    /// Adds a load torque by a table over the speed of the crank.
    ///
    /// # Errors
    /// The table does not exist.
    pub fn speed_load(&mut self, table: usize) -> Result<(), PlanError> {
        self.tables(&[table])?;
        self.speed_loads.push(table);
        Ok(())
    }

    fn check_formula_load(&mut self, load: &FormulaLoad) -> Result<(), PlanError> {
        all_below(&[load.formula], self.formulas.len(), "formula")?;
        if self.formulas[load.formula].reads(Variable::Phi) {
            self.repeats_after(load.turns)?;
        }
        match load.carrier {
            Carrier::Slide { slide, point } => {
                self.slides(&[slide])?;
                self.points(&[point])
            }
            Carrier::Point { point, cos, sin } => {
                self.points(&[point])?;
                self.slots(&[cos, sin])
            }
            Carrier::Along { point, link, cos, sin } => {
                self.points(&[point])?;
                self.links(&[link])?;
                self.slots(&[cos, sin])
            }
            Carrier::Link { link } => self.links(&[link]),
        }
    }
}
