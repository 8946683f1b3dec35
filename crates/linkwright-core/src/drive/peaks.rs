//! Where the acceleration of a steady motion has its extremes, as exact as its derivatives need.
//!
//! A derivative is that of the curve at the place of the extreme. Under a steep drive rounding of the speed is acceleration,
//! and the slope of the acceleration by what is read tells that place badly. A step that is turned on as a whole tells it:
//! its start by dφ, the speed there by ε dφ. What rounding takes from that ε dies out along the step, as it does of the
//! speed, and ε at its end has the slope, with no differences.

use crate::drive::cycle::{Machine, Step, stages_of_part};
use crate::drive::extremes::Extreme;
use crate::drive::reading::Mark;
use crate::drive::steady::Steady;
use crate::drive::structure::Plan;
use crate::kernel::dual::Dual;
use crate::kernel::radau::S;
use crate::linkage::motion::Motion;

/// An angle this near to the end of a step \[rad\] is that end.
pub(super) const AT_END: f64 = 1e-12;

/// Share of a step within which a peak at its end is a corner.
const AT_CORNER: f64 = 4e-6;

/// Share of a step by which the first secant is long. So many secants lead to where the slope of the acceleration is zero,
/// unless that lies farther off than so many times the share.
const ASIDE: f64 = 4e-3;
const SECANTS: usize = 3;
const FAR: f64 = 4.0;

/// Where an extreme of the acceleration is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Peak {
    /// At an end of a step, with its number and the acceleration there.
    Corner(usize, f64),
    /// Within a step, at a crank angle \[rad\].
    Inside(f64),
}

/// The solution at the starts of its steps, and the motion that it begins there.
struct MarkedMotion<'a> {
    machine: Machine<'a, Dual<f64>>,
    marks: &'a [Mark],
}

/// Where extremes of the acceleration are.
pub(super) fn peaks_of_acceleration<const N: usize>(
    plan: &Plan,
    q: &[f64],
    steady: &Steady,
    marks: &[Mark],
    extremes: [&Extreme<f64>; N],
) -> [Peak; N] {
    let constants: Vec<Dual<f64>> = q.iter().copied().map(Dual::constant).collect();
    let machine = Machine::new(plan, &constants).keeping_branch(plan.may_jump());
    let mut m = Motion::new(&plan.mechanism, &constants);
    let marked = MarkedMotion { machine, marks };
    extremes.map(|extreme| match corner_near(extreme.phi, marks, steady) {
        Some(edge) => Peak::Corner(edge, extreme.value),
        None => Peak::Inside(marked.place(extreme.phi, &mut m)),
    })
}

/// Number of the steps before the one that a crank angle lies in.
pub(super) fn steps_before(marks: &[Mark], phi: f64) -> usize {
    marks.partition_point(|mark| mark.phi < phi - AT_END).max(1) - 1
}

/// The end of a step that an extreme of the acceleration lies at: the nearest, or one at which the motion passes a kink, beside
/// which there may be steps that are shorter than the kink is known to.
fn corner_near(phi: f64, marks: &[Mark], steady: &Steady) -> Option<usize> {
    let (k, last) = (steps_before(marks, phi), marks.len() - 1);
    let edge = |k: usize| if k > last { marks[last].phi + marks[last].h } else { marks[k].phi };
    let longest = marks[k.saturating_sub(1)].h.max(marks[k].h).max(marks[(k + 1).min(last)].h);
    let off = |k: usize| (edge(k) - phi).abs();
    let is_kink = |k: usize| steady.crossings.iter().any(|kink| (kink.phi - edge(k)).abs() < AT_END);
    let mut around = k.saturating_sub(1)..=(k + 2).min(last + 1);
    let on_kink = around.find(|&k| is_kink(k) && off(k) < AT_CORNER * longest);
    let nearest = if off(k) < off(k + 1) { k } else { k + 1 };
    on_kink.or((off(nearest) < AT_CORNER * marks[k].h).then_some(nearest))
}

impl MarkedMotion<'_> {
    /// Where the acceleration has its extreme, from where it was read.
    fn place(&self, phi: f64, m: &mut Motion<Dual<f64>>) -> f64 {
        let k = steps_before(self.marks, phi);
        let (low, high) = (self.marks[k].phi, self.marks[k].phi + self.marks[k].h);
        let aside = ASIDE * (0.5 * (high + low) - phi).signum() * (high - low);
        let mut places = [phi, phi + aside];
        let mut slopes = places.map(|place| self.slope(k, place, m));
        for _ in 0..SECANTS {
            let next = places[1] - slopes[1] * (places[1] - places[0]) / (slopes[1] - slopes[0]);
            // There is none where the acceleration is constant, nor beyond the end of the step.
            if !((next - phi).abs() < FAR * aside.abs() && low < next && next < high) {
                break;
            }
            (places, slopes) = ([places[1], next], [slopes[1], self.slope(k, next, m)]);
        }
        if slopes[1].abs() < slopes[0].abs() { places[1] } else { places[0] }
    }

    /// Derivative of the acceleration by φ along the motion, within a step.
    fn slope(&self, k: usize, phi: f64, m: &mut Motion<Dual<f64>>) -> f64 {
        let mark = &self.marks[k];
        let whole = Step { X: mark.X, ..Step::unsolved(mark.phi, mark.h, mark.u) };
        let length = phi - mark.phi;
        let near = stages_of_part(&whole.quintic(), 0.0, length / mark.h).map(Dual::constant);
        let start = Dual::variable(mark.phi);
        let (still, geometry) =
            self.machine.advance_near(start, Dual::constant(mark.u), Dual::constant(length), near, m);
        let u = Dual { value: mark.u, d: self.machine.start_on_branch(&still, &geometry, m).value };
        self.machine.advance_near(still.phi, u, still.h, still.X, m).0.K[S - 1].d
    }
}
