//! Bodies and loads on the mechanism.

use super::builder::{Builder, all_below};
use crate::drive::loads::{At, Body, Load, What};
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

    /// Adds a load to those of the reduction, or to the laws that are evaluated with the speed of the moment. A formula is a
    /// law by its degree in the speed of the crank.
    ///
    /// # Errors
    /// What it acts on, a table, the formula or a parameter does not exist; or it cannot act there.
    pub fn load(&mut self, load: Load) -> Result<(), PlanError> {
        let Load { at, what } = load;
        self.check_at(at)?;
        let (slots, tables) = what.numbers();
        self.slots(&slots)?;
        self.tables(&tables)?;
        if !load.fits() {
            return Err(PlanError::Load);
        }
        let mut is_law = what.is_law();
        match what {
            What::Formula { formula, turns } => {
                all_below(&[formula], self.formulas.len(), "formula")?;
                if self.formulas[formula].reads(Variable::Phi) {
                    self.repeats_after(turns)?;
                }
                is_law = !matches!(self.formulas[formula].degree, Degree::Any | Degree::Of(0 | 1));
            }
            What::OverAngle { turns, .. } => self.repeats_after(turns)?,
            What::OverSpeed { table } if at == At::Crank => {
                self.speed_loads.push(table);
                return Ok(());
            }
            _ => {}
        }
        if is_law {
            self.laws.push(load)
        } else {
            self.loads.push(load)
        }
        Ok(())
    }

    fn check_at(&self, at: At) -> Result<(), PlanError> {
        match at {
            At::Bodies { cos, sin } => self.slots(&[cos, sin]),
            At::Crank => Ok(()),
            At::Slide { slide, point } => {
                self.slides(&[slide])?;
                self.points(&[point])
            }
            At::Point { point } => self.points(&[point]),
            At::Toward { point, cos, sin } => {
                self.points(&[point])?;
                self.slots(&[cos, sin])
            }
            At::Along { point, link, cos, sin } => {
                self.points(&[point])?;
                self.links(&[link])?;
                self.slots(&[cos, sin])
            }
            At::Link { link } => self.links(&[link]),
            At::Between { from, to } => self.points(&[from, to]),
            At::BetweenLinks { link, other, cos, sin } => {
                self.links(&[link, other.unwrap_or(link)])?;
                self.slots(&[cos, sin])
            }
        }
    }
}
