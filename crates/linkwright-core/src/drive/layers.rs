//! Steps in which derivatives are as exact as the motion.
//!
//! Behind a kink that the motion passes its derivatives leap or bend, and where the drive is steep they then come near
//! what holds them within a small part of a step: exp(−∫ |∂ε/∂u| dφ) of what they were off is left. The motion itself may
//! change so little there that its steps need not be short. Those in which the derivatives change fast are cut, into
//! parts that double from the start on.
//!
//! The kinks themselves lie at the ends of steps to a small share of these, which changes the motion by the square of that
//! alone. Derivatives behind a kink are off by |∂ε/∂u| times that length: so the ends go to where the motion passes.

use crate::drive::cycle::{Machine, Step, stages_of_part};
use crate::drive::events::Events;
use crate::drive::mesh::Crossing;
use crate::drive::reading::Mark;
use crate::drive::steady::Steady;
use crate::drive::structure::Plan;
use crate::kernel::radau::S;
use crate::linkage::motion::Motion;

/// Longest step over which derivatives change fast, as h |∂ε/∂u|: the method of order 9 errs by some 1e-9 of them there.
const SHORT: f64 = 1.0;

/// After this ∫ |∂ε/∂u| dφ nothing is left of what leapt: exp(−37) is rounding.
const GONE: f64 = 37.0;

/// An end of a step this near to a kink \[rad\] is the kink's.
const AT_END: f64 = 1e-12;

/// An end of a step this near to a kink of loads or motion \[rad\] stays on it.
pub(super) const ON_KINK: f64 = 1e-8;

/// The motion passes the kink at the end of a step beside it by less than this share of the steps there.
const NEARLY: f64 = 1e-3;

/// The solution at the starts of steps that resolve its derivatives, and where it passes kinks; `kinks` of loads and motion
/// stay where they are.
pub(super) fn resolved(plan: &Plan, q: &[f64], steady: &Steady, kinks: &[f64]) -> (Vec<Mark>, Vec<Crossing>) {
    if steady.crossings.is_empty() {
        return (steady.marks.clone(), Vec::new());
    }
    let machine = Machine::new(plan, q).keeping_branch(plan.may_jump());
    let mut m = Motion::new(&plan.mechanism, q);
    let mut steps = Vec::with_capacity(steady.marks.len());
    for mark in &steady.marks {
        steps.push(machine.advance_near(mark.phi, mark.u, mark.h, mark.X, &mut m).0);
    }
    let (late, crossings) = passed_late(&machine, &steps, steady, kinks, &mut m);
    let steps = moved(&machine, &steps, &late, &mut m);
    let mut marks = Vec::with_capacity(steps.len());
    let starts = steady.marks.iter().zip(&late).map(|(mark, late)| mark.t + late / (2.0 * mark.u).sqrt());
    for ((step, is_fast), t) in steps.iter().zip(changing_fast(&steps, &crossings)).zip(starts) {
        let change = step.steepness() * step.h;
        let halvings = if is_fast && change > SHORT { (change / SHORT).log2().ceil() as i32 } else { 0 };
        add_parts(&machine, step, (halvings, t), &mut m, &mut marks);
    }
    (marks, crossings)
}

/// How far behind the starts of steps, and the end of the last, the motion passes the kinks there \[rad\], and the kinks where it
/// passes them. The ends of the cycle stay.
fn passed_late(
    machine: &Machine<'_, f64>,
    steps: &[Step<f64>],
    steady: &Steady,
    kinks: &[f64],
    m: &mut Motion<f64>,
) -> (Vec<f64>, Vec<Crossing>) {
    let events = Events::new(*machine);
    let (mut late, mut crossings) = (vec![0.0; steps.len() + 1], steady.crossings.clone());
    for crossing in &mut crossings {
        let at = steady.marks.partition_point(|mark| mark.phi < crossing.phi - AT_END);
        let stays = kinks.iter().any(|kink| (kink - crossing.phi).abs() < ON_KINK);
        if at == 0 || at == steps.len() || stays {
            continue;
        }
        // Of several kinks at one end the first stands for all.
        if late[at] == 0.0 {
            let (step, next) = (&steps[at - 1], &steps[at]);
            let epsilon = step.K[S - 1];
            let passage = events.passage(events.nth(crossing.nth), next.phi, step.end(), [epsilon; 2], m);
            let by = passage.late();
            late[at] = if by.abs() < NEARLY * step.h.min(next.h) { by } else { 0.0 };
        }
        crossing.phi += late[at];
    }
    (late, crossings)
}

/// The steps with their ends moved.
fn moved(
    machine: &Machine<'_, f64>,
    steps: &[Step<f64>],
    late: &[f64],
    m: &mut Motion<f64>,
) -> Vec<Step<f64>> {
    let mut all = Vec::with_capacity(steps.len());
    for (k, step) in steps.iter().enumerate() {
        let [start, end] = [late[k], late[k + 1]];
        if start == 0.0 && end == 0.0 {
            all.push(step.clone());
            continue;
        }
        let u = if start == 0.0 { step.u } else { steps[k - 1].K[S - 1].mul_add(start, steps[k - 1].end()) };
        let h = step.h - start + end;
        let X = stages_of_part(&step.quintic(), start / step.h, h / step.h);
        all.push(machine.advance_near(step.phi + start, u, h, X, m).0);
    }
    all
}

/// Of each step whether something is left there of what leapt at kinks; what is left at the end of the revolution is there
/// at its start.
fn changing_fast(steps: &[Step<f64>], crossings: &[Crossing]) -> Vec<bool> {
    let is_kink = |phi: f64| crossings.iter().any(|kink| (kink.phi - phi).abs() < AT_END);
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
