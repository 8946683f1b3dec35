//! What lies between an end of a step and the stages next to it, looked at.
//!
//! What a formula makes of the speed may change within so small an angle that no stage sees it, neither of the step nor of its
//! halves: behind a dead centre, at which steps end, or anywhere that an end of a step happens to lie. There the parts of the
//! step next to its ends, each half as long as the one before, are compared with halves of their own; and where the shortest
//! begins, the acceleration is compared with what its stages make of it.

use crate::drive::cycle::Turn;
use crate::drive::differences::{Differences, Limits};
use crate::drive::equation::Machine;
use crate::drive::law::LawGeometry;
use crate::drive::measures::INTEGRALS;
use crate::drive::step::{CONVERGED, Step, stages_of_part};
use crate::kernel::out_of_line;
use crate::kernel::radau::{BEHIND, N, S, TO_START, value};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Parts at each end: the shortest is 2⁻¹⁰ of the step, some 1e-4 rad, and its first stage lies at a 17th of that. A friction
/// that is unseen within such an angle x of a dead centre takes x²/8 of its work at most.
const PARTS: u32 = 9;

/// A part of a step, its place in it, and what laws know at its stages.
struct Part<'a, R> {
    step: Step<R>,
    geometry: Vec<LawGeometry<R>>,
    /// As shares of the whole step, whose quintic tells where to start.
    from: f64,
    length: f64,
    quintic: &'a [R; N],
}

impl<R: Real> Turn<R> {
    /// Adds the differences of the parts beside both ends of a step from their halves.
    #[inline(always)]
    pub(super) fn add_beside_ends(
        &self,
        machine: &Machine<'_, R>,
        k: usize,
        to: &mut Differences<R>,
        limits: Limits,
        m: &mut Motion<R>,
    ) {
        out_of_line!(R, {
            let step = &self.steps[k];
            let (quintic, geometry) = (step.quintic(), self.geometry_of(machine, k).to_vec());
            let whole = Part { step: *step, geometry, from: 0.0, length: 1.0, quintic: &quintic };
            let [mut first, mut last] = whole.halves(machine, m);
            for _ in 0..PARTS {
                let [ahead, beside] = last.halves(machine, m);
                last.add(machine, [&ahead, &beside], 0, to, limits);
                last = beside;
            }
            for level in 0..PARTS {
                let [beside, behind] = first.halves(machine, m);
                first.add(machine, [&beside, &behind], level as usize + 1, to, limits);
                first = beside;
            }
            if !machine.keeps_branch {
                to.add_acceleration(&first.step, first.off_at_start(machine, m), limits);
            }
        })
    }
}

impl<'a, R: Real> Part<'a, R> {
    /// Its halves, solved one after the other.
    #[inline(always)]
    fn halves(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> [Part<'a, R>; 2] {
        let first = self.half(machine, (self.step.phi, self.step.u), self.from, m);
        let middle = (self.step.phi + first.step.h, first.step.end());
        let second = self.half(machine, middle, self.from + first.length, m);
        [first, second]
    }

    /// Half of it from (φ, u) on.
    #[inline(always)]
    fn half(&self, machine: &Machine<'_, R>, (phi, u): (R, R), from: f64, m: &mut Motion<R>) -> Part<'a, R> {
        out_of_line!(R, {
            let (quintic, length) = (self.quintic, 0.5 * self.length);
            let X = stages_of_part(quintic, R::splat(from), R::splat(length));
            let (step, geometry) = machine.advance_within(CONVERGED, phi, u, self.step.h * 0.5, X, m);
            Part { step, geometry, from, length, quintic }
        })
    }

    /// Adds by what it differs from its halves.
    #[inline(always)]
    fn add(
        &self,
        machine: &Machine<'_, R>,
        halves: [&Part<'a, R>; 2],
        level: usize,
        to: &mut Differences<R>,
        limits: Limits,
    ) {
        out_of_line!(R, {
            to.add_part(&self.step, &halves[1].step, self.step.steepness(), level, limits);
            let [own, first, second] =
                [self, halves[0], halves[1]].map(|part| machine.integrals(&part.step, &part.geometry));
            for i in 0..INTEGRALS {
                to.integrals[i] = to.integrals[i] + (first[i] + second[i] - own[i]).abs();
            }
        })
    }

    /// By what the acceleration where it begins differs from what its stages make of it.
    #[inline(always)]
    fn off_at_start(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> R {
        out_of_line!(R, {
            let (step, zero, mut geometry) = (&self.step, R::splat(0.0), Vec::new());
            // On the very start rounding would decide on which side of a kink it lies.
            let row = machine.row(step.h.mul_add(R::splat(BEHIND), step.phi), m, &mut geometry);
            let u = value(&step.quintic(), R::splat(BEHIND));
            let mut off = machine.acceleration(&row, &geometry, u).value;
            for i in 0..S {
                off = off - step.K[i] * TO_START[i];
            }
            // A lane may be filled up by a step of no length.
            zero.select_lt(step.h, off.abs(), zero)
        })
    }
}
