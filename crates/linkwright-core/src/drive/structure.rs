//! A machine's structure: what is there, and in which slot of the parameter list each number is found.
//!
//! The numbers come separately, so that a batch of machines shares one structure.

use crate::drive::loads::{Body, Load};
use crate::drive::motor::Drive;
use crate::kernel::error::PlanError;
use crate::kernel::formula::Formula;
use crate::kernel::table::Table;
use crate::linkage::mechanism::Mechanism;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Most turns of a cycle: its steps are kept in memory.
const TURNS_MAX: u64 = 1000;

/// Turns after which two motions repeat together: the least common multiple.
///
/// # Errors
/// No turn, or too many.
pub fn together(first: u32, second: u32) -> Result<u32, PlanError> {
    let (mut divisor, mut rest) = (first, second);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    let turns = u64::from(first / divisor.max(1)) * u64::from(second);
    let outside = PlanError::Missing { what: "turn", value: turns as usize, made: TURNS_MAX as usize };
    u32::try_from(turns).ok().filter(|_| (1..=TURNS_MAX).contains(&turns)).ok_or(outside)
}

/// What a machine consists of.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Plan {
    pub mechanism: Mechanism,
    pub bodies: Vec<Body>,
    /// Loads that belong to the reduction.
    pub loads: Vec<Load>,
    pub drive: Drive,
    pub tables: Vec<Table>,
    pub formulas: Vec<Formula>,
    /// Loads that depend on the speed in their own way, or on time.
    pub laws: Vec<Load>,
    /// How many parameters the plan refers to.
    pub n_parameters: usize,
    /// Revolutions of the crank after which all loads repeat.
    pub turns: u32,
}

impl Plan {
    /// Angle of the crank after which all loads repeat \[rad\].
    pub fn cycle(&self) -> f64 {
        TAU * f64::from(self.turns)
    }

    /// The same over a cycle of which the given turns are a part too: those after which the mechanism repeats.
    ///
    /// # Errors
    /// No turn, or too many.
    pub fn over_turns(&self, turns: u32) -> Result<Plan, PlanError> {
        Ok(Plan { turns: together(self.turns, turns)?, ..self.clone() })
    }

    /// The same without loads that have a potential over the position of the mechanism, whose work over a closed cycle
    /// is zero.
    pub fn without_conservative(&self) -> Plan {
        let mut plan = self.clone();
        plan.loads.retain(|load| !load.is_conservative());
        plan
    }
}
