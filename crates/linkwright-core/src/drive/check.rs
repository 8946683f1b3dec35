//! The error of a solved revolution, measured: every step is done again in two halves.
//!
//! From the same start, two steps of half the length give the end of a step and the acceleration there some
//! 500 times more accurately (order 9), so the difference is the error of the step itself. What errs in one
//! step is carried on to the others by their growth and by the closure of the revolution, like any disturbance.
//! Where the motor is steep the curve may change fast behind the start of a step, though its end is right:
//! there the parts of a half, a quarter, … of the step, from which the curve is read, are compared in the
//! same way, down to where the steepness no longer matters.
//!
//! The multiplier errs by the growth of the steps, compared with that of their halves, and by where the motion passes kinks
//! of the drive: a speed that is off passes them at another angle, and the more so the flatter it passes them.

use crate::drive::cycle::{CONVERGED, Machine, Step, Turn, stages_of_part};
use crate::drive::layout::{bundle, unbundle};
use crate::drive::measures::INTEGRALS;
use crate::kernel::radau::S;
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Parts of a step that are looked at: the shortest is 2⁻²⁹ of it.
const LEVELS: usize = 30;

/// Rounding of a value that a few dozen operations lead to, relative.
pub(super) const ROUNDING: f64 = 2e-15;

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
}

impl Check {
    /// Whether no step errs by more than the tolerance.
    pub fn is_good(&self) -> bool {
        self.excess.iter().all(|excess| excess.error <= 1.0)
    }
}

/// Differences of a step from its two halves.
pub(super) struct Differences<R> {
    /// Error of its end, signed.
    defect: R,
    /// Error per tolerance.
    error: R,
    /// Halvings, see [`Excess`].
    halvings: R,
    /// Relative error.
    relative: R,
    /// Errors of its integrals.
    pub(super) integrals: [R; INTEGRALS],
    /// Its growth, and that of its two halves.
    growths: [R; 2],
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

/// What errors are compared with.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Relative accuracy asked for.
    accuracy: f64,
    /// What accelerations count against \[rad/s²\].
    epsilon: f64,
    /// Last correction of a step that is compared.
    correction: f64,
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
        if !(closely || check.is_good()) || !machine.plan.has_rests() {
            return check;
        }
        for (k, of_step) in differences.iter_mut().enumerate() {
            R::out_of_line(
                #[inline(always)]
                || self.add_beside_ends(machine, k, of_step, limits, m),
            );
        }
        self.judged(machine, &differences, &integrals, kinks, limits)
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
        let column = |of: &dyn Fn(usize) -> R| unbundle(&(0..differences.len()).map(of).collect::<Vec<_>>());
        let defect = column(&|k| differences[k].defect);
        let mut check = Check {
            excess: column(&|k| differences[k].error)
                .into_iter()
                .zip(column(&|k| differences[k].halvings))
                .map(|(error, halvings)| Excess { error, halvings: halvings as u32 })
                .collect(),
            reached: column(&|k| differences[k].relative).into_iter().fold(0.0, f64::max),
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

    /// A step against its two halves, and so for its parts from the start on.
    #[inline(always)]
    fn differences(
        &self,
        machine: &Machine<'_, R>,
        k: usize,
        integrals: [R; INTEGRALS],
        ends_on_kink: Option<R>,
        limits: Limits,
        m: &mut Motion<R>,
    ) -> Differences<R> {
        let step = &self.steps[k];
        let zero = R::splat(0.0);
        let steepness = step.steepness();
        let growths = [zero; 2];
        let mut d =
            Differences { defect: zero, error: zero, halvings: zero, relative: zero, integrals, growths };
        let (mut whole, mut x, mut share) = (*step, step.h, 1.0);
        let quintic = step.quintic();
        for level in 0..LEVELS {
            x = x * 0.5;
            share *= 0.5;
            let at = R::splat(share);
            // Growth counts of the whole step.
            let limit = if level == 0 { limits.correction } else { CONVERGED };
            let X = stages_of_part(&quintic, zero, at);
            let (first, geometry) = machine.advance_within(limit, step.phi, step.u, x, X, m);
            let X = stages_of_part(&quintic, at, at);
            let (second, geometry_second) = machine.advance_within(limit, step.phi + x, first.end(), x, X, m);
            if level == 0 {
                d.defect = second.end() - whole.end();
                d.growths = [step.growth, first.growth * second.growth];
                if let Some(flag) = ends_on_kink.filter(|flag| flag.max_lane() > 0.0) {
                    let own = self.geometry_of(machine, k);
                    let [whole, last] = R::out_of_line(
                        #[inline(always)]
                        || {
                            let last = machine.growth_on_side(&second, &geometry_second);
                            [machine.growth_on_side(step, own), first.growth * last]
                        },
                    );
                    d.growths[0] = zero.select_lt(flag, whole, d.growths[0]);
                    d.growths[1] = zero.select_lt(flag, last, d.growths[1]);
                }
                if machine.keeps_branch {
                    let of_speed = (step.u * (2.0 * limits.accuracy)).max(step.u * (4.0 * ROUNDING));
                    let off =
                        machine.off_branch(&first, &geometry) + machine.off_branch(&second, &geometry_second);
                    d.error = d.error.max(off / of_speed);
                    d.relative = d.relative.max(off / step.u * 0.5);
                }
                let halves =
                    [machine.integrals(&first, &geometry), machine.integrals(&second, &geometry_second)];
                for i in 0..INTEGRALS {
                    d.integrals[i] = (halves[0][i] + halves[1][i] - d.integrals[i]).abs();
                }
            }
            d.add_part(&whole, &second, steepness, level, limits);
            whole = first;
            if (steepness * x).max_lane() <= 1.0 {
                break;
            }
        }
        d
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

/// The size of a difference; infinite for a NaN, which steps that do not converge leave.
#[inline(always)]
fn size<R: Real>(difference: R) -> R {
    let infinity = R::splat(f64::INFINITY);
    difference.abs().select_lt(infinity, difference.abs(), infinity)
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

impl<R: Real> Differences<R> {
    /// Adds the difference of a part of the step from its two halves.
    #[inline(always)]
    pub(super) fn add_part(
        &mut self,
        whole: &Step<R>,
        halves: &Step<R>,
        steepness: R,
        level: usize,
        limits: Limits,
    ) {
        let u = whole.u;
        let du = size(halves.end() - whole.end());
        let de = size(halves.K[S - 1] - whole.K[S - 1]);
        let of_speed = u * (2.0 * limits.accuracy).max(4.0 * ROUNDING);
        let error = (du / of_speed).max(de / limits.of_acceleration(u, steepness));
        self.halvings = R::splat(1.0).select_lt(error, R::splat(level as f64), self.halvings);
        self.error = self.error.max(error);
        self.relative = self.relative.max((du / u * 0.5).max(de * (1.0 / limits.epsilon)));
    }

    /// Adds an error of the acceleration in a step.
    #[inline(always)]
    pub(super) fn add_acceleration(&mut self, step: &Step<R>, off: R, limits: Limits) {
        let off = size(off);
        self.error = self.error.max(off / limits.of_acceleration(step.u, step.steepness()));
        self.relative = self.relative.max(off * (1.0 / limits.epsilon));
    }
}

impl Limits {
    /// Error that an acceleration may have: rounding of the speed leaves some under a steep drive.
    #[inline(always)]
    fn of_acceleration<R: Real>(&self, u: R, steepness: R) -> R {
        let rounding = (steepness + 1.0) * u * (2.0 * ROUNDING);
        R::splat(self.accuracy * self.epsilon).max(rounding)
    }
}
