//! Steady motion of a driveline: by Newton's method, or behind cycles that the machine goes through.
//!
//! What it does in time also tells where it stalls, after how many cycles its motion repeats, and how fast neighbouring motions part.

use crate::chain::Chain;
use crate::cycle::{Cycle, monodromy};
use crate::equation::Equation;
use crate::followed::{Follower, Passed, joined};
use crate::request::{Failure, Request};
use crate::scale::scales;
use crate::starts::{Rough, at_first, beginning, largest_multiplier};
use crate::steady::{Steady, refined};
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::structure::Plan;
use std::collections::VecDeque;

/// Cycles that are followed between attempts of Newton's method.
const CYCLES_AT_ONCE: usize = 10;

/// Difference between cycles, over the scale of the state, from which on they repeat.
const REPEATS: f64 = 1e-3;

/// Difference of a periodic motion from the cycles that led to it, likewise, up to which it is the one that they come to.
const SAME_MOTION: f64 = 0.05;

/// Share of a difference at which Newton's method has failed, at which it is tried again.
const CLOSER: f64 = 0.1;

/// Cycles over which the growth of a disturbance is measured, behind those in which it turns to where it grows most.
const CYCLES_PARTING: usize = 100;
/// See [`CYCLES_PARTING`].
const CYCLES_SETTLING: usize = 10;

/// Steady motion of a machine with its driveline.
///
/// # Errors
/// None is found, or not as exactly as asked for.
pub fn steady(plan: &Plan, q: &[f64], chain: &Chain, request: &Request) -> Result<Steady, Failure> {
    let equation = Equation { plan, q, chain };
    let kinks = kinks(plan, q);
    if request.cycles_first == 0
        && let Some(rough) = at_first(equation, &kinks, request)
    {
        match refined(equation, rough, request) {
            // From the motion on coarse steps none comes; the machine itself may come to one.
            Err(Failure::NotFound { .. }) => {}
            Err(Failure::Inaccurate(_)) if !chain.is_linear() => {}
            found => return found,
        }
    }
    behind_cycles(equation, &kinks, request)
}

/// The periodic solution behind cycles that the machine goes through.
fn behind_cycles(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Result<Steady, Failure> {
    let (mut next, mut scale) = beginning(equation.chain, request);
    let m = next.len();
    let mut follower = Follower::new(equation, kinks, scale[m - 1]);
    let mut last: VecDeque<Passed> = VecDeque::new();
    let (mut cycles, mut near) = (0, REPEATS);
    let (mut beside, mut inaccurate) = (None, None);
    while cycles < request.cycles_max {
        for _ in 0..CYCLES_AT_ONCE {
            let passed = follower.cycle(&next)?;
            next = passed.end(m);
            last.push_back(passed);
            if last.len() > request.multiples {
                last.pop_front();
            }
            cycles += 1;
        }
        scale = scales(&last[last.len() - 1].states(m), equation.chain);
        let (multiple, off) = repetition(&last, &next, &scale);
        let is_wanted = off < near || cycles >= request.cycles_max || request.multiples == 1;
        if cycles < request.cycles_first || !is_wanted {
            continue;
        }
        near = CLOSER * off.min(near);
        let (mesh, mut solution, placed) = joined(&equation, last.range(last.len() - multiple..));
        let found = Cycle::new(equation, &mesh).periodic(&mut solution, &scale, usize::MAX);
        let Some(monodromy) = found else { continue };
        // Whether a motion is stable is known where the kinks of its laws are.
        match refined(equation, Rough { mesh, solution, monodromy, placed, cycles, multiple }, request) {
            Ok(steady) => {
                let is_near = distance(&steady.solution.start, &next, &scale) < SAME_MOTION;
                if request.multiples == 1 || is_near && largest_multiplier(&steady.monodromy) < 1.0 {
                    return Ok(steady);
                }
                // A motion that the machine passes by and leaves again is one, but not that to which it comes; unstable ones of
                // several cycles are many where it does not repeat, and any of them is near by chance.
                beside = beside.or((is_near && multiple == 1).then_some(steady));
            }
            Err(failure @ Failure::Inaccurate(_)) => inaccurate = Some(failure),
            Err(_) => {}
        }
    }
    match (beside, inaccurate) {
        (Some(steady), _) => Ok(steady),
        (None, Some(failure)) => Err(failure),
        (None, None) => {
            let (_, off) = repetition(&last, &next, &scale);
            let parting =
                if request.cycles_first == 0 { parting(&mut follower, next, &scale)? } else { f64::NAN };
            Err(Failure::NotFound { off, parting })
        }
    }
}

/// Factor by which motions close to one that is followed part in a cycle: the mean growth of a disturbance, its size over the scale.
/// Its logarithm is the largest Lyapunov exponent.
///
/// Source: Benettin, Galgani, Giorgilli, Strelcyn, *Meccanica* 15 (1980) 9–30.
fn parting(follower: &mut Follower<'_>, mut next: Vec<f64>, scale: &[f64]) -> Result<f64, Failure> {
    let (m, mut growth) = (next.len(), 0.0);
    let mut off = scale.to_vec();
    for n in 0..CYCLES_SETTLING + CYCLES_PARTING {
        let passed = follower.cycle(&next)?;
        let (mesh, solution, _) = joined(&follower.equation, std::iter::once(&passed));
        let (_, end) = Cycle::new(follower.equation, &mesh).linear(&solution, &[]);
        let matrix = monodromy(&end, m);
        let moved = |r: usize| (0..m).map(|c| matrix[r * m + c] * off[c]).sum::<f64>();
        off = (0..m).map(moved).collect();
        let size = off.iter().zip(scale).map(|(off, scale)| (off / scale).abs()).fold(0.0, f64::max);
        off.iter_mut().for_each(|off| *off /= size);
        if n >= CYCLES_SETTLING {
            growth += size.ln() / CYCLES_PARTING as f64;
        }
        next = passed.end(m);
    }
    Ok(growth.exp())
}

/// Difference of two states over their scale.
fn distance(a: &[f64], b: &[f64], scale: &[f64]) -> f64 {
    a.iter().zip(b).zip(scale).map(|((a, b), scale)| (a - b).abs() / scale).fold(0.0, f64::max)
}

/// Number of cycles after which the last ones repeat best, the smallest that is good enough, with what they differ by.
fn repetition(last: &VecDeque<Passed>, end: &[f64], scale: &[f64]) -> (usize, f64) {
    let off = |n: usize| distance(last[last.len() - n].start(), end, scale);
    let found = (1..=last.len()).map(|n| (n, off(n)));
    let better = |best: (usize, f64), next: (usize, f64)| {
        if best.1 >= REPEATS && next.1 < best.1 { next } else { best }
    };
    found.fold((1, f64::INFINITY), better)
}
