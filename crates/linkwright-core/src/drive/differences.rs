//! A step against its two halves.
//!
//! From the same start, two steps of half the length give the end of a step and the acceleration there some 500 times more
//! accurately (order 9), so the difference is the error of the step itself. Where the motor is steep the curve may change fast
//! behind the start of a step, though its end is right: there the parts of a half, a quarter, … of the step, from which the
//! curve is read, are compared in the same way, down to where the steepness no longer matters.

use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::measures::INTEGRALS;
use crate::drive::step::{CONVERGED, Step, stages_of_part};
use crate::kernel::out_of_line;
use crate::kernel::radau::S;
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Parts of a step that are looked at: the shortest is 2⁻²⁹ of it.
const LEVELS: usize = 30;

/// Rounding of a value that a few dozen operations lead to, relative.
pub(super) const ROUNDING: f64 = 2e-15;

/// Differences of a step from its two halves.
pub(super) struct Differences<R> {
    /// Error of its end, signed.
    pub(super) defect: R,
    /// Error per tolerance.
    pub(super) error: R,
    /// Halvings, see [`Excess`].
    pub(super) halvings: R,
    /// Relative error.
    pub(super) relative: R,
    /// Errors of its integrals.
    pub(super) integrals: [R; INTEGRALS],
    /// Its growth, and that of its two halves.
    pub(super) growths: [R; 2],
}

/// What errors are compared with.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Relative accuracy asked for.
    pub(super) accuracy: f64,
    /// What accelerations count against \[rad/s²\].
    pub(super) epsilon: f64,
    /// Last correction of a step that is compared.
    pub(super) correction: f64,
}

impl<R: Real> Turn<R> {
    /// A step against its two halves, and so for its parts from the start on.
    #[inline(always)]
    pub(super) fn differences(
        &self,
        machine: &Machine<'_, R>,
        k: usize,
        integrals: [R; INTEGRALS],
        ends_on_kink: Option<R>,
        limits: Limits,
        m: &mut Motion<R>,
    ) -> Differences<R> {
        out_of_line!(R, {
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
                let (mut second, geometry_second) =
                    machine.advance_within(limit, step.phi + x, first.end(), x, X, m);
                if level == 0 {
                    if ends_on_kink.is_some() {
                        machine.settle(&mut second, &geometry_second);
                    }
                    d.defect = second.end() - whole.end();
                    d.growths = [step.growth, first.growth * second.growth];
                    if let Some(flag) = ends_on_kink.filter(|flag| flag.max_lane() > 0.0) {
                        let own = self.geometry_of(machine, k);
                        let [whole, last] = out_of_line!(R, {
                            let last = machine.growth_on_side(&second, &geometry_second);
                            [machine.growth_on_side(step, own), first.growth * last]
                        });
                        d.growths[0] = zero.select_lt(flag, whole, d.growths[0]);
                        d.growths[1] = zero.select_lt(flag, last, d.growths[1]);
                    }
                    if machine.keeps_branch {
                        let of_speed = (step.u * (2.0 * limits.accuracy)).max(step.u * (4.0 * ROUNDING));
                        let off = machine.off_branch(&first, &geometry)
                            + machine.off_branch(&second, &geometry_second);
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
        })
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
        let (u, zero) = (whole.u, R::splat(0.0));
        // Parts at the start count where a disturbance dies out within them; shorter ones are those of other lanes.
        let counts = if level == 0 { R::splat(f64::INFINITY) } else { steepness * whole.h };
        let one = R::splat(1.0);
        let du = one.select_lt(counts, size(halves.end() - whole.end()), zero);
        let de = one.select_lt(counts, size(halves.K[S - 1] - whole.K[S - 1]), zero);
        let of_speed = u * (2.0 * limits.accuracy).max(4.0 * ROUNDING);
        let error = (du / of_speed).max(de / limits.of_acceleration(u, steepness));
        self.halvings = one.select_lt(error, R::splat(level as f64), self.halvings);
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

/// The size of a difference; infinite for a NaN, which steps that do not converge leave.
#[inline(always)]
pub(super) fn size<R: Real>(difference: R) -> R {
    let infinity = R::splat(f64::INFINITY);
    difference.abs().select_lt(infinity, difference.abs(), infinity)
}
