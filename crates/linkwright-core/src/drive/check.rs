//! The error of a solved revolution, measured: every step is done again in two halves ([`crate::drive::differences`]), and the
//! parts beside its ends where a formula may hide something there ([`crate::drive::beside`]).
//!
//! What errs in one step is carried on to the others by their growth and by the closure of the revolution, like any
//! disturbance.
//!
//! The multiplier errs by the growth of the steps, compared with that of their halves, and by where the motion passes kinks
//! of the drive: a speed that is off passes them at another angle, and the more so the flatter it passes them.

use crate::drive::cycle::Turn;
use crate::drive::differences::{Differences, Limits, ROUNDING, size};
use crate::drive::equation::Machine;
use crate::drive::layout::{bundle, unbundle};
use crate::drive::measures::INTEGRALS;
use crate::drive::step::{CONVERGED, Step};
use crate::kernel::out_of_line;
use crate::kernel::radau::S;
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Accelerations count against their peak, but at least against this share of ω², and torques and work
/// against what makes it: at constant speed there is none, and rounding is all that there is.
pub(super) const EVEN: f64 = 1e-4;

/// Accelerations count at least against this share of what the drive alone would give: where a machine creeps, drive and
/// loads balance to so many digits that rounding of the speed leaves no more of their difference.
const BALANCED: f64 = 1e-6;

/// Share of the accuracy that the multiplier may lose by the last correction of a solution.
const GROWTH_SHARE: f64 = 0.1;

/// The smallest correction that is asked for: rounding does not undo it.
const FINEST: f64 = 1e-13;

/// What is wrong with a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excess {
    /// Error per tolerance; good up to 1.
    pub error: f64,
    /// Halvings down to the shortest part of the step whose error exceeds the tolerance.
    pub halvings: u32,
}

/// The measured error of a revolution.
#[derive(Clone, Debug)]
pub struct Check {
    /// For each step.
    pub excess: Vec<Excess>,
    /// Largest relative error of all speeds, accelerations and integrals.
    pub reached: f64,
    /// What rounding of the speed makes of accelerations under a steep drive, relative: no finer step takes it away, and halves
    /// of a step may agree to more digits than either has.
    pub rounding: f64,
}

impl Check {
    /// Whether no step errs by more than the tolerance.
    pub fn is_good(&self) -> bool {
        self.excess.iter().all(|excess| excess.error <= 1.0)
    }
}

/// A kink at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct KinkAtEnd {
    /// Number of the step.
    pub step: usize,
    /// What is missing in the exponent of growth, since the kink is passed beside the end.
    pub exponent: f64,
    /// Change of the exponent per error of u there, which passes the kink at another angle.
    pub per_u: f64,
    /// The most that it changes the exponent by.
    pub most: f64,
}

/// Relative correction after which a solution with a multiplier has converged: the growth of its steps is that before the
/// correction, and its exponent is off by about as much.
pub fn last_correction(multiplier: f64, accuracy: f64) -> f64 {
    let size = multiplier.abs().clamp(f64::MIN_POSITIVE, 1.0);
    (GROWTH_SHARE * accuracy / (size * (1.0 - size.ln()))).clamp(FINEST, CONVERGED)
}

impl<R: Real> Turn<R> {
    /// Measures the error of a solved revolution of one machine. A revolution that is not good is looked at `closely` only where
    /// it is to be the answer all the same.
    #[inline(always)]
    pub fn check(
        &self,
        machine: &Machine<'_, R>,
        kinks: &[KinkAtEnd],
        accuracy: f64,
        closely: bool,
        m: &mut Motion<R>,
    ) -> Check {
        out_of_line!(R, {
            let correction = last_correction(self.multiplier.max_lane(), accuracy);
            let limits = Limits { accuracy, epsilon: self.acceleration_scale(machine), correction };
            let (mut differences, mut integrals) = (Vec::new(), Vec::new());
            let ends_on_kink = self.ends_on_kink(kinks);
            for (k, step) in self.steps.iter().enumerate() {
                let whole = machine.integrals(step, self.geometry_of(machine, k));
                let of_step = self.differences(machine, k, whole, ends_on_kink.get(k).copied(), limits, m);
                differences.push(of_step);
                integrals.push(whole);
            }
            let check = self.judged(machine, &differences, &integrals, kinks, limits);
            if !(closely || check.is_good()) || !machine.plan.may_hide() {
                return check;
            }
            for (k, of_step) in differences.iter_mut().enumerate() {
                self.add_beside_ends(machine, k, of_step, limits, m);
            }
            self.judged(machine, &differences, &integrals, kinks, limits)
        })
    }

    /// What the differences of all steps make of the revolution.
    #[inline(always)]
    fn judged(
        &self,
        machine: &Machine<'_, R>,
        differences: &[Differences<R>],
        integrals: &[[R; INTEGRALS]],
        kinks: &[KinkAtEnd],
        limits: Limits,
    ) -> Check {
        out_of_line!(R, {
            let column =
                |of: &dyn Fn(usize) -> R| unbundle(&(0..differences.len()).map(of).collect::<Vec<_>>());
            let defect = column(&|k| differences[k].defect);
            let mut check = Check {
                excess: column(&|k| differences[k].error)
                    .into_iter()
                    .zip(column(&|k| differences[k].halvings))
                    .map(|(error, halvings)| Excess { error, halvings: halvings as u32 })
                    .collect(),
                reached: column(&|k| differences[k].relative).into_iter().fold(0.0, f64::max),
                rounding: column(&|k| self.steps[k].steepness() * self.steps[k].u)
                    .into_iter()
                    .fold(0.0, f64::max)
                    * (2.0 * ROUNDING / limits.epsilon),
            };
            let growths = [column(&|k| differences[k].growths[0]), column(&|k| differences[k].growths[1])];
            let multiplier = add_growth(&mut check, &growths, limits.accuracy);
            self.add_carried(&mut check, &defect, kinks, multiplier, limits);
            let roundings = self.integral_roundings(machine, integrals);
            for (i, size) in self.integral_sizes(machine, integrals).into_iter().enumerate() {
                let parts = column(&|k| differences[k].integrals[i]);
                add_integral(&mut check, &parts, size, roundings[i], limits.accuracy);
            }
            check
        })
    }

    /// 1 in the lanes of steps that end on a kink, 0 elsewhere; nothing where there is no kink.
    #[inline(always)]
    fn ends_on_kink(&self, kinks: &[KinkAtEnd]) -> Vec<R> {
        if kinks.is_empty() {
            return Vec::new();
        }
        let mut flags = vec![0.0; self.steps.len() * R::LANES];
        for kink in kinks {
            flags[kink.step] = 1.0;
        }
        bundle(&flags)
    }

    /// What the errors of the integrals count against: the sum of their parts' sizes, so that nothing is lost
    /// where they cancel, but at least what the acceleration of [`EVEN`] makes of them. Of a load that takes
    /// nothing, or of a drive that idles, rounding is all that there is.
    #[inline(always)]
    fn integral_sizes(&self, machine: &Machine<'_, R>, integrals: &[[R; INTEGRALS]]) -> [f64; INTEGRALS] {
        let zero = R::splat(0.0);
        let (mut sizes, mut least) = ([zero; INTEGRALS], [zero; INTEGRALS]);
        for (step, parts) in self.steps.iter().zip(integrals) {
            let torque = step.u * (2.0 * EVEN) / step.rows[S - 1].inverse;
            let (at_motor, work) = (torque / machine.q[machine.plan.drive.ratio], torque * step.h);
            let (impulse, heat) = (at_motor * parts[0], at_motor.squared() * parts[0]);
            for (i, part) in [zero, work, work, work, impulse, heat].into_iter().enumerate() {
                (sizes[i], least[i]) = (sizes[i] + parts[i].abs(), least[i] + part);
            }
        }
        let total = |sum: R| unbundle(&[sum]).into_iter().sum::<f64>();
        std::array::from_fn(|i| total(sizes[i]).max(total(least[i])))
    }

    /// What rounding of the speed makes of the integrals, through the torque of a steep motor: δM = J ∂ε/∂u δu.
    #[inline(always)]
    fn integral_roundings(&self, machine: &Machine<'_, R>, integrals: &[[R; INTEGRALS]]) -> [f64; INTEGRALS] {
        let zero = R::splat(0.0);
        let mut sums = [zero; INTEGRALS];
        for (step, parts) in self.steps.iter().zip(integrals) {
            let torque = step.steepness() * step.u * (2.0 * ROUNDING) / step.rows[S - 1].inverse;
            let (at_motor, work) = (torque / machine.q[machine.plan.drive.ratio], torque * step.h);
            let (impulse, heat) = (at_motor * parts[0], at_motor * parts[4].abs() * 2.0);
            for (i, part) in [zero, work, work, work, impulse, heat].into_iter().enumerate() {
                sums[i] = sums[i] + part;
            }
        }
        sums.map(|sum| unbundle(&[sum]).into_iter().sum())
    }

    /// Peak acceleration of the stages, or what counts in its place.
    #[inline(always)]
    pub(super) fn acceleration_scale(&self, machine: &Machine<'_, R>) -> f64 {
        let (mut epsilon, mut u, mut driven) = (R::splat(0.0), R::splat(0.0), R::splat(0.0));
        for step in &self.steps {
            for (i, row) in step.rows.iter().enumerate() {
                let omega = (step.X[i] * 2.0).sqrt();
                let torque = machine.plan.drive.torque(&machine.plan.tables, machine.q, omega);
                driven = driven.max((torque * row.inverse).abs());
                epsilon = epsilon.max(step.K[i].abs());
                u = u.max(step.X[i]);
            }
        }
        epsilon.max_lane().max(2.0 * EVEN * u.max_lane()).max(BALANCED * driven.max_lane())
    }

    /// Adds what the errors of all steps make of the solution in each, carried on from step to step and
    /// closed, and of the multiplier, which changes with the angles at which the motion passes kinks.
    #[inline(always)]
    fn add_carried(
        &self,
        check: &mut Check,
        defect: &[f64],
        kinks: &[KinkAtEnd],
        multiplier: f64,
        limits: Limits,
    ) {
        let mut growth: Vec<R> = self.steps.iter().map(|step| step.growth).collect();
        for (growth, &[scale, _]) in growth.iter_mut().zip(&self.passed) {
            *growth = *growth * scale;
        }
        let sizes: Vec<f64> = defect.iter().map(|d| d.abs()).collect();
        let (carried, _) = self.layout.close(&growth, &bundle(&sizes));
        let u: Vec<f64> = unbundle(&self.steps.iter().map(|step| step.u).collect::<Vec<_>>());
        let steepness = unbundle(&self.steps.iter().map(Step::steepness).collect::<Vec<_>>());
        let worst = sizes.iter().copied().fold(0.0, f64::max);
        let mut is_bad = false;
        let carried: Vec<f64> = unbundle(&carried).into_iter().map(f64::abs).collect();
        let of_kink =
            |kink: &KinkAtEnd| (kink.per_u * carried[(kink.step + 1) % carried.len()]).min(kink.most);
        let of_kinks = multiplier.min(1.0) * kinks.iter().map(of_kink).sum::<f64>();
        check.reached = check.reached.max(of_kinks);
        is_bad |= of_kinks > limits.accuracy;
        for (k, &delta) in carried.iter().enumerate() {
            let relative = (0.5 * delta / u[k]).max(steepness[k] * delta / limits.epsilon);
            check.reached = check.reached.max(relative);
            is_bad |= relative > limits.accuracy;
        }
        if is_bad {
            for (k, excess) in check.excess.iter_mut().enumerate() {
                let is_rounding = sizes[k] <= 4.0 * ROUNDING * u[k];
                if sizes[k] >= 0.3 * worst && !is_rounding {
                    excess.error = excess.error.max(2.0);
                }
            }
        }
    }
}

/// Adds the errors of the multiplier by the growth of each step, which count against the multiplier, but at least against 1.
/// Returns the multiplier.
fn add_growth(check: &mut Check, [whole, halves]: &[Vec<f64>; 2], accuracy: f64) -> f64 {
    let most = |(a, b): (&f64, &f64)| a.abs().max(b.abs());
    let pairs = || whole.iter().zip(halves);
    let multiplier: f64 = pairs().map(most).product();
    let part = |(a, b)| if most((a, b)) == 0.0 { 0.0 } else { multiplier * (a - b).abs() / most((a, b)) };
    let parts: Vec<f64> = pairs().map(part).collect();
    add_integral(check, &parts, multiplier.max(1.0), 0.0, accuracy);
    multiplier
}

/// Adds the errors of an integral; its size is that of its parts, so that nothing is lost where they cancel. What the
/// rounding of speeds makes of it is reported, but no finer step would take it away.
fn add_integral(check: &mut Check, parts: &[f64], size: f64, rounding: f64, accuracy: f64) {
    let parts: Vec<f64> = parts.iter().map(|&part| self::size(part)).collect();
    let sum: f64 = parts.iter().sum();
    if size <= 0.0 || sum <= ROUNDING * size {
        return;
    }
    check.reached = check.reached.max(sum / size);
    if sum > (accuracy * size).max(rounding) {
        let worst = parts.iter().copied().fold(0.0, f64::max);
        for (excess, part) in check.excess.iter_mut().zip(parts) {
            if part >= 0.3 * worst && part > ROUNDING * size {
                excess.error = excess.error.max(2.0);
            }
        }
    }
}
