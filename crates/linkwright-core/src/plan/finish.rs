//! The drive, and the plan as a whole.

use super::builder::{Builder, FRAME};
use super::elements::lines_of;
use crate::drive::motor::{Drive, Motor};
use crate::drive::structure::Plan;
use crate::kernel::error::PlanError;

impl Builder {
    /// The plan.
    ///
    /// # Errors
    /// The drive refers to what does not exist.
    pub fn into_plan(mut self, mut drive: Drive) -> Result<Plan, PlanError> {
        self.check_drive(&drive)?;
        drive.speed_loads.append(&mut self.speed_loads);
        let frame = self.mechanism.n_links;
        for line in self.mechanism.elements.iter_mut().flat_map(lines_of) {
            if line.link == FRAME {
                line.link = frame;
            }
        }
        Ok(Plan {
            mechanism: self.mechanism,
            bodies: self.bodies,
            loads: self.loads,
            drive,
            tables: self.tables,
            formulas: self.formulas,
            laws: self.laws,
            n_parameters: self.n_parameters,
            turns: self.turns,
        })
    }

    fn check_drive(&self, drive: &Drive) -> Result<(), PlanError> {
        let Drive { motor, ratio, forward, reverse, inertia, speed_start, speed_loads } = drive;
        self.slots(&[*ratio, *forward, *reverse, *inertia, *speed_start])?;
        self.tables(speed_loads)?;
        match motor {
            Motor::Off => Ok(()),
            Motor::Constant { torque } => self.slots(&[*torque]),
            Motor::Line { torque, inverse_speed } => self.slots(&[*torque, *inverse_speed]),
            Motor::Induction { inverse_synchronous, torque, slip, resistance, spans } => {
                self.slots(&[*inverse_synchronous, *torque, *slip, *resistance])?;
                spans.iter().try_for_each(|s| self.slots(&[s.x0, s.y0, s.x1, s.y1, s.inverse_width]))
            }
            Motor::Table { table } => self.tables(&[*table]),
        }
    }
}
