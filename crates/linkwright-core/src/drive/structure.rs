//! A machine's structure: what is there, and in which slot of the parameter list each number is found.
//!
//! The numbers come separately, so that a batch of machines shares one structure.

use crate::drive::loads::{Body, ForceElement, Law, Load};
use crate::drive::motor::Drive;
use crate::kernel::formula::Formula;
use crate::kernel::table::Table;
use crate::linkage::mechanism::Mechanism;

/// What a machine consists of.
#[derive(Clone, Debug)]
pub struct Plan {
    pub mechanism: Mechanism,
    pub bodies: Vec<Body>,
    pub loads: Vec<Load>,
    pub force_elements: Vec<ForceElement>,
    pub drive: Drive,
    pub tables: Vec<Table>,
    pub formulas: Vec<Formula>,
    /// Loads that depend on the speed in their own way, or on time.
    pub laws: Vec<Law>,
    /// How many parameters the plan refers to.
    pub n_parameters: usize,
}

impl Plan {
    /// The same without loads that have a potential over the position of the mechanism, whose work over a closed cycle
    /// is zero.
    pub fn without_conservative(&self) -> Plan {
        let mut plan = self.clone();
        plan.loads.retain(|load| !load.is_conservative());
        plan.force_elements.retain(|load| !load.is_conservative());
        plan
    }
}
