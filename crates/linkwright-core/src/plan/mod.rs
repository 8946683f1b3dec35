//! How a machine's structure is put together: elements, bodies, loads and the drive one after another, each checked
//! where it is added.
//!
//! | module | checks |
//! | --- | --- |
//! | [`Builder`] | the plan as it grows; indices that are used and made |
//! | `elements` | elements of the mechanism: each is made of what was made before it |
//! | `loads` | bodies, loads, laws, the drive |
//!
//! Points, links, slides and dyads are numbered from zero in the order in which elements make them, so that an element
//! can be placed from what stands before it, and nothing is left without a place. A plan says *what* is there and in
//! which slot of the parameter list each number is found; the numbers come separately, so that a batch of machines
//! shares one plan.

mod elements;
mod loads;

use crate::drive::loads::{Body, ForceElement, Law, Load};
use crate::drive::motor::Drive;
use crate::drive::structure::Plan;
use crate::kernel::error::PlanError;
use crate::kernel::formula::Formula;
use crate::kernel::slot::Slot;
use crate::kernel::table::Table;
use crate::linkage::mechanism::Mechanism;

/// Number of the language in which machines, cams and trains cross the border: names of classes and of their fields,
/// order of lists and of results. It goes up with every change of these, here and in
/// `linkwright.kernel.core.core_format`.
pub const FORMAT: u32 = 12;

/// Link of a line that is fixed to the frame, until it is known how many links there are.
pub const FRAME: usize = usize::MAX;

/// A plan that grows.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    /// Elements so far; its numbers of points, links, slides and dyads count what they make.
    mechanism: Mechanism,
    bodies: Vec<Body>,
    loads: Vec<Load>,
    force_elements: Vec<ForceElement>,
    speed_loads: Vec<usize>,
    laws: Vec<Law>,
    tables: Vec<Table>,
    formulas: Vec<Formula>,
    n_parameters: usize,
}

fn below(value: usize, bound: usize, what: &'static str) -> Result<(), PlanError> {
    if value < bound { Ok(()) } else { Err(PlanError::Missing { what, value, made: bound }) }
}

fn all_below(values: &[usize], bound: usize, what: &'static str) -> Result<(), PlanError> {
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
        Builder { n_parameters, ..Builder::default() }
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

    /// The plan.
    ///
    /// # Errors
    /// The drive refers to what does not exist.
    pub fn build(mut self, mut drive: Drive) -> Result<Plan, PlanError> {
        self.check_drive(&drive)?;
        drive.speed_loads.append(&mut self.speed_loads);
        let frame = self.mechanism.n_links;
        for line in self.mechanism.elements.iter_mut().flat_map(elements::lines_of) {
            if line.link == FRAME {
                line.link = frame;
            }
        }
        Ok(Plan {
            mechanism: self.mechanism,
            bodies: self.bodies,
            loads: self.loads,
            force_elements: self.force_elements,
            drive,
            tables: self.tables,
            formulas: self.formulas,
            laws: self.laws,
            n_parameters: self.n_parameters,
        })
    }

    fn slots(&self, slots: &[Slot]) -> Result<(), PlanError> {
        all_below(slots, self.n_parameters, "parameter")
    }

    fn points(&self, points: &[usize]) -> Result<(), PlanError> {
        all_below(points, self.mechanism.n_points, "point")
    }

    fn links(&self, links: &[usize]) -> Result<(), PlanError> {
        all_below(links, self.mechanism.n_links, "link")
    }

    fn slides(&self, slides: &[usize]) -> Result<(), PlanError> {
        all_below(slides, self.mechanism.n_slides, "slide")
    }

    fn tables(&self, tables: &[usize]) -> Result<(), PlanError> {
        all_below(tables, self.tables.len(), "table")
    }

    fn check_formula(&self, formula: &Formula) -> Result<(), PlanError> {
        formula.slots().try_for_each(|slot| self.slots(&[slot]))
    }

    /// Counts what an element makes.
    fn makes(
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
