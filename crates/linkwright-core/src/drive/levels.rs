//! Whether a machine may have other periodic motions than one that is known.
//!
//! Motions from different starts never cross, so every other motion lies above or below the known one all
//! round. Where the drive's torque falls with speed and that of the loads does not, no other can repeat: two
//! motions would draw nearer each other all round. Elsewhere the mean torque left for acceleration is looked
//! at over levels of energy: at level E the machine has at every angle the kinetic energy of the known motion
//! and E more. A change of sign besides that at E = 0, or no torque at all, tells of another motion. This is exact for slight
//! changes of the motion and for a machine whose inertia outweighs the torques; [`crate::drive::march`] then finds
//! out what there is.

use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::layout::unbundle;
use crate::drive::motor::Motor;
use crate::drive::structure::Plan;
use crate::kernel::out_of_line;
use crate::kernel::radau::{B, S};
use crate::kernel::real::Real;

/// Levels on either side of the known motion, each at half the energy of the one before.
const LEVELS: i32 = 12;

/// As many in place of each where the torque is a table or a law over the speed, which may rise and fall anywhere.
const FINE: i32 = 4;

/// The fastest level has this many times the working speed at its slowest.
const FASTEST: f64 = 3.0;

/// A mean torque below this share of its parts is none.
const NOISE: f64 = 1e-9;

/// The same of levels beside those at which the machine passes a kink.
const BESIDE: f64 = 1e-6;

/// Newton steps to the zero of a quantity that tells a kink, most often a speed, from that of the known motion.
const LEVEL_SWEEPS: usize = 8;

/// Distance of the levels right beside the known motion, as a share of its energy.
const NEAR: f64 = 1e-3;

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

    /// Whether the motor may have the same torque at a range of speeds.
    fn may_be_neutral(&self) -> bool {
        matches!(self.drive.motor, Motor::Off | Motor::Constant { .. } | Motor::Table { .. })
    }

    /// Whether the torque over the speed is drawn or written, so that it may rise and fall anywhere.
    fn is_drawn(&self) -> bool {
        let has_table = matches!(self.drive.motor, Motor::Table { .. }) || !self.drive.speed_loads.is_empty();
        has_table || !self.laws.is_empty()
    }

    /// How many levels there are in place of one.
    fn levels_in_place_of_one(&self) -> i32 {
        if self.is_drawn() { FINE } else { 1 }
    }
}

impl<R: Real> Turn<R> {
    /// 1 in the lanes where motions that repeat may lie above the solved one, 0 elsewhere.
    #[inline(always)]
    pub fn may_have_faster(&self, machine: &Machine<'_, R>) -> R {
        out_of_line!(R, {
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
                let left = self.torque_left(machine, energy);
                may = left.select_lt(zero, may, one);
            }
            if levels == 1 || !machine.plan.is_drawn() {
                return may;
            }
            // However near kinks or jumps over the speed are to each other.
            let near = bottom.energy * NEAR;
            for energy in self.levels_of_kinks(machine) {
                let left = self.torque_left(machine, energy);
                let above = near.select_lt(energy, one, may);
                may = left.select_lt(zero, may, above);
            }
            may
        })
    }

    /// 1 in the lanes where drive and loads leave no torque right beside the motion: whatever is as fast repeats as well.
    #[inline(always)]
    pub fn may_be_neutral(&self, machine: &Machine<'_, R>) -> R {
        out_of_line!(R, {
            let (one, zero) = (R::splat(1.0), R::splat(0.0));
            let mut may = zero;
            if !machine.plan.may_be_neutral() {
                return may;
            }
            let near = self.bottom().energy * NEAR;
            for energy in [-near, near] {
                let left = self.torque_left(machine, energy);
                may = zero.select_lt(left.abs(), may, one);
            }
            may
        })
    }

    /// The same for motions below it.
    #[inline(always)]
    pub fn may_have_slower(&self, machine: &Machine<'_, R>) -> R {
        out_of_line!(R, {
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
                    let left = self.torque_left(machine, energy);
                    may = zero.select_lt(left, may, one);
                }
            }
            may
        })
    }

    /// u at φ = 0 of levels between which motions of one machine may lie, however near kinks or jumps over the speed are to
    /// each other: above the solved motion, and below it.
    #[inline(always)]
    pub fn hints(&self, machine: &Machine<'_, R>) -> [Vec<f64>; 2] {
        out_of_line!(R, {
            let mut hints = [Vec::new(), Vec::new()];
            let first = |x: R| unbundle(&[x])[0];
            // The last stage lies at the end of the cycle, where the machine is as at its start.
            let Some(last) = self.steps.last().filter(|_| machine.plan.is_drawn()) else { return hints };
            let inverse = unbundle(&[last.rows[S - 1].inverse])[R::LANES - 1];
            let (start, least) = (first(self.steps[0].u), -first(self.bottom().energy));
            // Right beside the known motion, from which nothing departs.
            let mut signs = vec![(least * NEAR, 1.0), (-least * NEAR, -1.0)];
            for energy in self.levels_of_kinks(machine) {
                let known = first(energy);
                if known > least && known.abs() > -least * NEAR {
                    let left = self.torque_left(machine, energy);
                    signs.push((known, first(left)));
                }
            }
            signs.sort_by(|a, b| a.0.total_cmp(&b.0));
            for ends in signs.windows(2) {
                let is_known = ends[0].0 < 0.0 && ends[1].0 > 0.0;
                if !is_known && ends[0].1 * ends[1].1 <= 0.0 {
                    hints[usize::from(ends[0].0 < 0.0)]
                        .extend(ends.iter().map(|end| end.0.mul_add(inverse, start)));
                }
            }
            hints
        })
    }

    /// For each kink over the speed the levels right below and above those at which the machine passes it in the revolution.
    #[inline(always)]
    fn levels_of_kinks(&self, machine: &Machine<'_, R>) -> Vec<R> {
        out_of_line!(R, {
            let beside = self.bottom().energy * BESIDE;
            let mut levels = Vec::new();
            let mut take = |low: R, high: R| {
                let (low, high) = (self.layout.lowest(low), self.layout.highest(high));
                levels.extend([low - beside, (low + high) * 0.5, high + beside]);
            };
            let infinity = R::splat(f64::INFINITY);
            for speed in machine.plan.drive.kinks_of_lanes(&machine.plan.tables, machine.q) {
                if !R::splat(0.0).any_below(speed) {
                    continue;
                }
                let (u, mut low, mut high) = (speed.squared() * 0.5, infinity, -infinity);
                for step in &self.steps {
                    for (row, &X) in step.rows.iter().zip(&step.X) {
                        let energy = (u - X) / row.inverse;
                        (low, high) = (low.min(energy), high.max(energy));
                    }
                }
                take(low, high);
            }
            for kink in machine.plan.speed_kinks() {
                let (mut low, mut high) = (infinity, -infinity);
                for (k, step) in self.steps.iter().enumerate() {
                    let geometry = self.geometry_of(machine, k);
                    for i in 0..S {
                        let known = machine.geometry_at(geometry, i);
                        let value = |u: R| {
                            let at = [(u * 2.0).sqrt(), R::splat(f64::NAN)];
                            machine.plan.speed_kink_value(machine.q, kink, known, at)
                        };
                        let u = level_of(value, step.X[i]);
                        let energy = (u - step.X[i]) / step.rows[i].inverse;
                        (low, high) =
                            (energy.select_lt(low, energy, low), high.select_lt(energy, energy, high));
                    }
                }
                take(low, high);
            }
            levels
        })
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
        out_of_line!(R, {
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
        })
    }
}

/// u at which a quantity is zero, by Newton from a known u: most are nearly linear in it. Not finite where there is none.
#[inline(always)]
fn level_of<R: Real>(value: impl Fn(R) -> R, mut u: R) -> R {
    for _ in 0..LEVEL_SWEEPS {
        let aside = u * BESIDE;
        u = u - value(u) * aside * 2.0 / (value(u + aside) - value(u - aside));
    }
    u
}

/// The minimum over a revolution of u, kinetic energy, 1/J and viscous coefficient.
struct Bottom<R> {
    u: R,
    energy: R,
    inverse: R,
    viscous: R,
}
