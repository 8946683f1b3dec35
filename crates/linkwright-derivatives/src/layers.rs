//! Steps in which derivatives are as exact as the motion.
//!
//! Behind a kink that the motion passes its derivatives leap or bend, and where the drive is steep they then come near
//! what holds them within a small part of a step: exp(−∫ |∂ε/∂u| dφ) of what they were off is left. The motion itself may
//! change so little there that its steps need not be short. Those in which the derivatives change fast are cut, into
//! parts that double from the start on.

use crate::peaks::AT_END;
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::reading::Mark;
use linkwright_core::drive::steady::Steady;
use linkwright_core::drive::step::{Step, stages_of_part};
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;

/// Longest step over which derivatives change fast, as h |∂ε/∂u|: the method of order 9 errs by some 1e-9 of them there.
const SHORT: f64 = 1.0;

/// After this ∫ |∂ε/∂u| dφ nothing is left of what leapt: exp(−37) is rounding.
const GONE: f64 = 37.0;

/// The solution at the starts of steps that resolve its derivatives.
pub(crate) fn resolved(plan: &Plan, q: &[f64], steady: &Steady) -> Vec<Mark> {
    if steady.crossings.is_empty() {
        return steady.marks.clone();
    }
    let machine = Machine::new(plan, q).keeping_branch(plan.may_jump());
    let mut m = Motion::new(&plan.mechanism, q);
    let mut steps = Vec::with_capacity(steady.marks.len());
    for mark in &steady.marks {
        steps.push(machine.advance_near(mark.phi, mark.u, mark.h, mark.X, &mut m).0);
    }
    let mut marks = Vec::with_capacity(steps.len());
    let starts = steady.marks.iter().map(|mark| mark.t);
    for ((step, is_fast), t) in steps.iter().zip(changing_fast(&steps, steady)).zip(starts) {
        let change = step.steepness() * step.h;
        let halvings = if is_fast && change > SHORT { (change / SHORT).log2().ceil() as i32 } else { 0 };
        add_parts(&machine, step, (halvings, t), &mut m, &mut marks);
    }
    marks
}

/// Of each step whether something is left there of what leapt at kinks; what is left at the end of the revolution is there
/// at its start.
fn changing_fast(steps: &[Step<f64>], steady: &Steady) -> Vec<bool> {
    let is_kink = |phi: f64| steady.crossings.iter().any(|kink| (kink.phi - phi).abs() < AT_END);
    let mut left = 0.0;
    let mut round = || -> Vec<bool> {
        let is_fast = |step: &Step<f64>| {
            let before = if is_kink(step.phi) { GONE } else { left };
            left = before - step.steepness() * step.h;
            before > 0.0
        };
        steps.iter().map(is_fast).collect()
    };
    round();
    round()
}

/// Adds the parts of a step, of which the first has its length over 2 by the number of halvings, and each other is as long
/// as all before it.
fn add_parts(
    machine: &Machine<'_, f64>,
    step: &Step<f64>,
    (halvings, start): (i32, f64),
    m: &mut Motion<f64>,
    marks: &mut Vec<Mark>,
) {
    let ends = (0..=halvings).map(|k| 0.5_f64.powi(halvings - k));
    let (quintic, mut from, mut u) = (step.quintic(), 0.0_f64, step.u);
    let mut t = start;
    for to in ends {
        let phi = from.mul_add(step.h, step.phi);
        let X = stages_of_part(&quintic, from, to - from);
        let part = machine.advance_near(phi, u, (to - from) * step.h, X, m).0;
        marks.push(Mark { phi, u, t, h: part.h, X: part.X });
        (from, u, t) = (to, part.end(), t + part.duration());
    }
}
