//! Where the acceleration of a steady motion has its extremes, as exact as its derivatives need.
//!
//! A derivative is that of the curve at the place of the extreme. Under a steep drive rounding of the speed is acceleration,
//! and the slope of the acceleration by what is read tells that place badly. A step that is turned on as a whole tells it:
//! its start by dφ, the speed there by ε dφ. What rounding takes from that ε dies out along the step, as it does of the
//! speed, and ε at its end has the slope, with no differences.

use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::extremes::Extreme;
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::reading::Mark;
use linkwright_core::drive::steady::Steady;
use linkwright_core::drive::step::{Step, stages_of_part};
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::radau::S;

/// An angle this near to the end of a step \[rad\] is that end.
pub(crate) const AT_END: f64 = 1e-12;

/// Share of a step within which a peak at its end is a corner.
const AT_CORNER: f64 = 4e-6;

/// Share of a step behind its start at which the acceleration is read on the side of the step.
const JUST_BEHIND: f64 = 1e-8;

/// Two sides of an end of a step that differ by more than this share of the acceleration have a jump between them: the two are
/// read from one solution, to its rounding.
pub(crate) const SIDES: f64 = 1e-7;

/// Share of a step by which the first secant is long. So many secants lead to where the slope of the acceleration is zero,
/// unless that lies farther off than so many times the share.
const ASIDE: f64 = 4e-3;
const SECANTS: usize = 3;
const FAR: f64 = 4.0;

/// Where an extreme of the acceleration is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Peak {
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

/// A step with its derivatives, and what its laws needed.
type StepOfLaws = (Step<Dual<f64>>, Vec<LawGeometry<Dual<f64>>>);

/// Where the smallest and the largest acceleration are.
pub(crate) fn peaks_of_acceleration(
    plan: &Plan,
    q: &[f64],
    steady: &Steady,
    marks: &[Mark],
    extremes: [&Extreme<f64>; 2],
) -> [Peak; 2] {
    let constants: Vec<Dual<f64>> = q.iter().copied().map(Dual::constant).collect();
    let machine = Machine::new(plan, &constants).keeping_sides().keeping_branch(plan.may_jump());
    let mut m = Motion::new(&plan.mechanism, &constants);
    let marked = MarkedMotion { machine, marks };
    [0, 1].map(|k| {
        let (Extreme { phi, value }, upwards) = (*extremes[k], [-1.0, 1.0][k]);
        match corner_near(phi, marks, steady) {
            Some((edge, true)) => Peak::Corner(edge, value),
            Some((edge, false)) => marked.at_end_or_beside(edge, value, upwards, &mut m),
            None => Peak::Inside(marked.place(steps_before(marks, phi), phi, &mut m)),
        }
    })
}

/// Number of the steps before the one that a crank angle lies in.
pub(crate) fn steps_before(marks: &[Mark], phi: f64) -> usize {
    marks.partition_point(|mark| mark.phi < phi - AT_END).max(1) - 1
}

/// The end of a step that an extreme of the acceleration lies at, and whether the motion passes a kink there: the nearest, or
/// a kink, beside which there may be steps that are shorter than the kink is known to.
fn corner_near(phi: f64, marks: &[Mark], steady: &Steady) -> Option<(usize, bool)> {
    let (k, last) = (steps_before(marks, phi), marks.len() - 1);
    let edge = |k: usize| if k > last { marks[last].phi + marks[last].h } else { marks[k].phi };
    let longest = marks[k.saturating_sub(1)].h.max(marks[k].h).max(marks[(k + 1).min(last)].h);
    let off = |k: usize| (edge(k) - phi).abs();
    let is_kink = |k: usize| steady.crossings.iter().any(|kink| (kink.phi - edge(k)).abs() < AT_END);
    let mut around = k.saturating_sub(1)..=(k + 2).min(last + 1);
    let on_kink = around.find(|&k| is_kink(k) && off(k) < AT_CORNER * longest);
    let nearest = if off(k) < off(k + 1) { k } else { k + 1 };
    let at_end = || (off(nearest) < AT_CORNER * marks[k].h).then_some((nearest, false));
    on_kink.map(|edge| (edge, true)).or_else(at_end)
}

impl MarkedMotion<'_> {
    /// An extreme at an end of a step, or so near beside it that it was read there: where the acceleration is continuous and still
    /// goes `upwards`, to its extreme, beyond the end.
    fn at_end_or_beside(&self, edge: usize, value: f64, upwards: f64, m: &mut Motion<Dual<f64>>) -> Peak {
        let n = self.marks.len();
        let [before, behind] = [(edge + n - 1) % n, edge % n];
        let (end, start) = (self.marks[before].phi + self.marks[before].h, self.marks[behind].phi);
        let end_before = self.acceleration(before, end, m);
        if (end_before.value - self.start(behind, m)).abs() > SIDES * value.abs() {
            return Peak::Corner(edge, value);
        }
        if end_before.d * upwards < 0.0 {
            return Peak::Inside(self.place(before, end, m));
        }
        let just_behind = self.marks[behind].h.mul_add(JUST_BEHIND, start);
        if self.acceleration(behind, just_behind, m).d * upwards > 0.0 {
            return Peak::Inside(self.place(behind, just_behind, m));
        }
        Peak::Corner(edge, value)
    }

    /// Where the acceleration has its extreme within a step, from where it was read.
    fn place(&self, k: usize, phi: f64, m: &mut Motion<Dual<f64>>) -> f64 {
        let (low, high) = (self.marks[k].phi, self.marks[k].phi + self.marks[k].h);
        let aside = ASIDE * (0.5 * (high + low) - phi).signum() * (high - low);
        let mut places = [phi, phi + aside];
        let mut slopes = places.map(|place| self.acceleration(k, place, m).d);
        for _ in 0..SECANTS {
            let next = places[1] - slopes[1] * (places[1] - places[0]) / (slopes[1] - slopes[0]);
            // There is none where the acceleration is constant, nor beyond the end of the step.
            if !((next - phi).abs() < FAR * aside.abs() && low < next && next < high) {
                break;
            }
            (places, slopes) = ([places[1], next], [slopes[1], self.acceleration(k, next, m).d]);
        }
        if slopes[1].abs() < slopes[0].abs() { places[1] } else { places[0] }
    }

    /// The acceleration at the start of a step, on its side.
    fn start(&self, k: usize, m: &mut Motion<Dual<f64>>) -> f64 {
        let (still, geometry) = self.part(k, self.marks[k].h, m);
        self.machine.start(&still, &geometry, m).value
    }

    /// The acceleration within a step, and its derivative by φ along the motion.
    fn acceleration(&self, k: usize, phi: f64, m: &mut Motion<Dual<f64>>) -> Dual<f64> {
        let (still, geometry) = self.part(k, phi - self.marks[k].phi, m);
        let u = Dual { value: self.marks[k].u, d: self.machine.start(&still, &geometry, m).value };
        self.machine.advance_near(still.phi, u, still.h, still.X, m).0.K[S - 1]
    }

    /// A step up to a length, of which the start is varied alone, and what its laws needed.
    fn part(&self, k: usize, length: f64, m: &mut Motion<Dual<f64>>) -> StepOfLaws {
        let mark = &self.marks[k];
        let whole = Step { X: mark.X, ..Step::unsolved(mark.phi, mark.h, mark.u) };
        let near = stages_of_part(&whole.quintic(), 0.0, length / mark.h).map(Dual::constant);
        let start = Dual::variable(mark.phi);
        self.machine.advance_near(start, Dual::constant(mark.u), Dual::constant(length), near, m)
    }
}
