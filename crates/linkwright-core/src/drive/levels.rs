//! Whether a machine may have other periodic motions than one that is known.
//!
//! Motions from different starts never cross, so every other motion lies above or below the known one all
//! round. Where the drive's torque falls with speed and that of the loads does not, no other can repeat: two
//! motions would draw nearer each other all round. Elsewhere the mean torque left for acceleration is looked
//! at over levels of energy: at level E the machine has at every angle the kinetic energy of the known motion
//! and E more. A change of sign besides that at E = 0 tells of another motion. This is exact for slight
//! changes of the motion and for a machine whose inertia outweighs the torques; [`crate::drive::march`] then finds
//! out what there is.

use crate::drive::cycle::{Machine, Turn};
use crate::drive::motor::Motor;
use crate::drive::structure::Plan;
use crate::kernel::radau::{B, S};
use crate::kernel::real::Real;

/// Levels on either side of the known motion, each at half the energy of the one before.
const LEVELS: i32 = 12;

/// As many in place of each where the torque is a table or a law over the speed, which may rise and fall anywhere.
const FINE: i32 = 4;

/// The fastest level has this many times the working speed at its slowest.
const FASTEST: f64 = 3.0;

/// A level at which the mean torque is below this share of its parts tells nothing.
const NOISE: f64 = 1e-9;

impl Plan {
    /// Crank speed from which the net torque of drive and loads does not rise with speed, up to where the
    /// motor brakes as hard as it can; infinite where that is not known.
    #[inline(always)]
    fn falls_from<R: Real>(&self, q: &[R]) -> R {
        if !self.laws.is_empty() {
            return R::splat(f64::INFINITY);
        }
        let motor = match &self.drive.motor {
            Motor::Off | Motor::Constant { .. } | Motor::Line { .. } => R::splat(0.0),
            Motor::Induction { inverse_synchronous, slip, spans, .. } => {
                let mut last = (R::splat(1.0) - q[*slip]) / q[*inverse_synchronous];
                for span in spans {
                    last = last.max(q[span.x1]);
                }
                last
            }
            Motor::Table { table } => R::splat(self.tables[*table].last_change(1.0)),
        };
        let loads = self.drive.speed_loads.iter().map(|&load| self.tables[load].last_change(-1.0));
        (motor / q[self.drive.ratio]).max(R::splat(loads.fold(0.0, f64::max)))
    }

    /// How many levels there are in place of one.
    fn levels_in_place_of_one(&self) -> i32 {
        let is_drawn = matches!(self.drive.motor, Motor::Table { .. }) || !self.drive.speed_loads.is_empty();
        if is_drawn || !self.laws.is_empty() { FINE } else { 1 }
    }
}

impl<R: Real> Turn<R> {
    /// 1 in the lanes where motions that repeat may lie above the solved one, 0 elsewhere.
    #[inline(always)]
    pub fn may_have_faster(&self, machine: &Machine<'_, R>) -> R {
        let (one, zero) = (R::splat(1.0), R::splat(0.0));
        let bottom = self.bottom();
        let working = machine.q[machine.plan.drive.speed_start].squared() * 0.5;
        let top = working * (FASTEST * FASTEST) / bottom.inverse;
        // Where nothing rises from here on, the top level alone tells of a load that drives.
        let rises = bottom.viscous.select_lt(zero, one, zero);
        let rises = (bottom.u * 2.0).sqrt().select_lt(machine.plan.falls_from(machine.q), one, rises);
        let fine = machine.plan.levels_in_place_of_one();
        let levels = if rises.max_lane() > 0.5 { LEVELS * fine } else { 1 };
        let mut may = zero;
        for level in 0..levels {
            let energy = top * 0.5_f64.powf(f64::from(level) / f64::from(fine));
            let left = R::out_of_line(
                #[inline(always)]
                || self.torque_left(machine, energy),
            );
            may = zero.select_lt(left, one, may);
        }
        may
    }

    /// The same for motions below it.
    #[inline(always)]
    pub fn may_have_slower(&self, machine: &Machine<'_, R>) -> R {
        let (one, zero) = (R::splat(1.0), R::splat(0.0));
        let bottom = self.bottom();
        let rises = bottom.viscous.select_lt(zero, one, zero);
        let rises = zero.select_lt(machine.plan.falls_from(machine.q), one, rises);
        let fine = machine.plan.levels_in_place_of_one();
        let levels = if rises.max_lane() > 0.5 { LEVELS * fine } else { 0 };
        let mut may = zero;
        for level in 1..=levels {
            // Down to where the machine comes to rest at some angle, and close to the known motion.
            let near = 0.5_f64.powf(f64::from(level) / f64::from(fine));
            for share in [near, 1.0 - near] {
                let energy = bottom.energy * -share;
                let left = R::out_of_line(
                    #[inline(always)]
                    || self.torque_left(machine, energy),
                );
                may = left.select_lt(zero, one, may);
            }
        }
        may
    }

    /// The minimum of some quantities over the revolution.
    #[inline(always)]
    fn bottom(&self) -> Bottom<R> {
        let infinity = R::splat(f64::INFINITY);
        let mut bottom = Bottom { u: infinity, energy: infinity, inverse: infinity, viscous: infinity };
        for step in &self.steps {
            for (row, &u) in step.rows.iter().zip(&step.X) {
                bottom.u = bottom.u.min(u);
                bottom.energy = bottom.energy.min(u / row.inverse);
                bottom.inverse = bottom.inverse.min(row.inverse);
                bottom.viscous = bottom.viscous.min(row.viscous);
            }
        }
        Bottom {
            u: self.layout.lowest(bottom.u),
            energy: self.layout.lowest(bottom.energy),
            inverse: self.layout.lowest(bottom.inverse),
            viscous: self.layout.lowest(bottom.viscous),
        }
    }

    /// Work over the revolution that drive and loads leave at a level of energy \[J\], zero where it is noise.
    #[inline(always)]
    fn torque_left(&self, machine: &Machine<'_, R>, level: R) -> R {
        let zero = R::splat(0.0);
        let (mut left, mut parts) = (zero, zero);
        for (k, step) in self.steps.iter().enumerate() {
            let geometry = self.geometry_of(machine, k);
            for i in 0..S {
                let row = &step.rows[i];
                let u = level.mul_add(row.inverse, step.X[i]);
                let omega = (u * 2.0).sqrt();
                let torque = machine.plan.drive.torque(&machine.plan.tables, machine.q, omega);
                let mut drag = row.viscous.mul_add(omega, row.load);
                if !geometry.is_empty() {
                    drag = drag + machine.laws(machine.geometry_at(geometry, i), omega);
                }
                let dphi = step.h * B[i];
                left = (torque - drag).mul_add(dphi, left);
                parts = (torque.abs() + drag.abs()).mul_add(dphi, parts);
            }
        }
        let (left, parts) = (self.layout.total(left), self.layout.total(parts));
        (parts * NOISE).select_lt(left.abs(), left, zero)
    }
}

/// The minimum over a revolution of u, kinetic energy, 1/J and viscous coefficient.
struct Bottom<R> {
    u: R,
    energy: R,
    inverse: R,
    viscous: R,
}
