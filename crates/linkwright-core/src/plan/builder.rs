//! The plan as it grows, and the checks of what is used and made.

use crate::drive::loads::{Body, Load};
use crate::drive::structure::together;
use crate::kernel::error::PlanError;
use crate::kernel::formula::Formula;
use crate::kernel::slot::Slot;
use crate::kernel::table::Table;
use crate::linkage::mechanism::Mechanism;
use std::ops::Range;

/// Link of a line that is fixed to the frame, until it is known how many links there are.
pub const FRAME: usize = usize::MAX;

/// A plan that grows.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    /// Elements so far; its numbers of points, links, slides and dyads count what they make.
    pub(super) mechanism: Mechanism,
    pub(super) bodies: Vec<Body>,
    pub(super) loads: Vec<Load>,
    pub(super) speed_loads: Vec<usize>,
    pub(super) laws: Vec<Load>,
    pub(super) tables: Vec<Table>,
    pub(super) formulas: Vec<Formula>,
    pub(super) n_parameters: usize,
    /// Turns after which all loads so far repeat.
    pub(super) turns: u32,
}

fn below(value: usize, bound: usize, what: &'static str) -> Result<(), PlanError> {
    if value < bound { Ok(()) } else { Err(PlanError::Missing { what, value, made: bound }) }
}

pub(super) fn all_below(values: &[usize], bound: usize, what: &'static str) -> Result<(), PlanError> {
    values.iter().try_for_each(|&value| below(value, bound, what))
}

/// Things that are made are counted one by one.
fn count(values: &[usize], counted: &mut usize, what: &'static str) -> Result<(), PlanError> {
    for &value in values {
        if value != *counted {
            return Err(PlanError::Order { what, value, next: *counted });
        }
        *counted += 1;
    }
    Ok(())
}

impl Builder {
    /// An empty plan for a list of parameters.
    pub fn new(n_parameters: usize) -> Self {
        Builder { n_parameters, turns: 1, ..Builder::default() }
    }

    /// Room for one more parameter.
    pub fn parameter(&mut self) -> Slot {
        self.n_parameters += 1;
        self.n_parameters - 1
    }

    /// What was built so far.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// Adds a table; gives its number.
    pub fn table(&mut self, table: Table) -> usize {
        self.tables.push(table);
        self.tables.len() - 1
    }

    /// Adds a formula; gives its number.
    ///
    /// # Errors
    /// A parameter does not exist.
    pub fn formula(&mut self, formula: Formula) -> Result<usize, PlanError> {
        self.check_formula(&formula)?;
        self.formulas.push(formula);
        Ok(self.formulas.len() - 1)
    }

    /// One more load, which repeats after some turns.
    pub(super) fn repeats_after(&mut self, turns: u32) -> Result<(), PlanError> {
        self.turns = together(self.turns, turns)?;
        Ok(())
    }

    pub(super) fn slots(&self, slots: &[Slot]) -> Result<(), PlanError> {
        all_below(slots, self.n_parameters, "parameter")
    }

    pub(super) fn points(&self, points: &[usize]) -> Result<(), PlanError> {
        all_below(points, self.mechanism.n_points, "point")
    }

    pub(super) fn links(&self, links: &[usize]) -> Result<(), PlanError> {
        all_below(links, self.mechanism.n_links, "link")
    }

    pub(super) fn slides(&self, slides: &[usize]) -> Result<(), PlanError> {
        all_below(slides, self.mechanism.n_slides, "slide")
    }

    pub(super) fn tables(&self, tables: &[usize]) -> Result<(), PlanError> {
        all_below(tables, self.tables.len(), "table")?;
        tables.iter().try_for_each(|&table| self.last_of(self.tables[table].parameters()))
    }

    /// Parameters that follow one another exist if the last one does.
    pub(super) fn last_of(&self, mut parameters: Range<usize>) -> Result<(), PlanError> {
        parameters.next_back().map_or(Ok(()), |slot| self.slots(&[slot]))
    }

    pub(super) fn check_formula(&self, formula: &Formula) -> Result<(), PlanError> {
        formula.slots().try_for_each(|slot| self.slots(&[slot]))
    }

    /// Counts what an element makes.
    pub(super) fn makes(
        &mut self,
        points: &[usize],
        links: &[usize],
        slides: &[usize],
        dyads: &[usize],
    ) -> Result<(), PlanError> {
        let m = &mut self.mechanism;
        count(points, &mut m.n_points, "point")?;
        count(links, &mut m.n_links, "link")?;
        count(slides, &mut m.n_slides, "slide")?;
        count(dyads, &mut m.n_gaps, "dyad")
    }
}
