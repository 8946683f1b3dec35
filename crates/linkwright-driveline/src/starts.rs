//! The periodic solution roughly: from where Newton's method begins, and what it comes to.
//!
//! It begins with the crank at one speed, on few steps from kink to kink. Where it does not converge from there, the driveline has
//! more damping and no backlash at first, which are taken away and given back step by step; else the motion is followed from cycle to
//! cycle, which also tells where a machine stalls, and after how many cycles its motion repeats.

use crate::chain::{Chain, Source};
use crate::crossings::crossings;
use crate::cycle::{Cycle, Stop, monodromy};
use crate::equation::Equation;
use crate::error::errors;
use crate::finer::{STEPS_MAX, finer_edges};
use crate::mesh::{Mesh, Solution};
use crate::request::{Failure, Request};
use crate::scale::scales;
use linkwright_kernel::radau::S;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// Steps of a revolution at first, and where Newton's method does not converge on them.
pub(crate) const STEPS: f64 = 16.0;
/// See [`STEPS`].
const FINE_STEPS: f64 = 48.0;

/// Steps of a revolution at most where a motion is followed.
const FOLLOWED_STEPS_MAX: f64 = 600.0;

/// Factor by which steps are shorter where a motion does not repeat on longer ones.
const SHORTER: f64 = 6.0;

/// Phase \[rad\] of a vibration in a step where a motion is followed.
const FOLLOWED_ANGLE: f64 = 1.5;

/// Cycles that are followed between attempts of Newton's method.
const CYCLES_AT_ONCE: usize = 10;

/// Difference between cycles, over the scale of the state, from which on they repeat.
const REPEATS: f64 = 1e-3;

/// Difference of a periodic motion from the cycles that led to it, likewise, up to which it is the one that they come to.
const SAME_MOTION: f64 = 0.05;

/// Attempts of Newton's method behind cycles that repeat.
const ATTEMPTS: usize = 4;

/// Times that steps end at the kinks that a followed motion passes, the error to which they are divided, and cycles that it is
/// followed on them each time.
const ROUNDS_BEHIND: usize = 4;
/// See [`ROUNDS_BEHIND`].
const ROUGHLY: f64 = 1e-5;
/// See [`ROUNDS_BEHIND`].
const CYCLES_BEHIND: usize = 5;

/// Cycles over which the growth of a disturbance is measured, behind those in which it turns to where it grows most.
const CYCLES_PARTING: usize = 100;
/// See [`CYCLES_PARTING`].
const CYCLES_SETTLING: usize = 10;

/// Squarings of a matrix for its largest eigenvalue, to a hundredth.
const SQUARINGS: u32 = 10;

/// Damping that is added at first, and its smallest step, as shares of k/ω.
const DAMPED: f64 = 1.0;
/// See [`DAMPED`].
const LEAST_STEP: f64 = 1e-3;

/// Sweeps behind which corrections from a motion that is near fall; those between two forms of a law may alternate.
pub(crate) const PATIENCE: usize = 3;

/// A periodic solution on its first mesh.
pub struct Rough {
    /// Steps.
    pub mesh: Mesh,
    /// Motion on them.
    pub solution: Solution,
    /// Derivative of its end by its start.
    pub monodromy: Vec<f64>,
    /// Cycles that were followed.
    pub cycles: usize,
    /// Cycles after which it repeats.
    pub multiple: usize,
}

/// The periodic solution by Newton's method, or behind cycles that are followed.
pub(crate) fn rough(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Result<Rough, Failure> {
    if request.cycles_first == 0 {
        let found = at_once(equation, kinks, request).or_else(|| from_damped(equation, kinks, request));
        if let Some((mesh, solution, monodromy)) = found {
            return Ok(Rough { mesh, solution, monodromy, cycles: 0, multiple: 1 });
        }
    }
    match followed(equation, kinks, request, 1.0) {
        // A step in which a law changes its form is solved roughly: a motion that repeats may wander on such steps.
        Err(Failure::NotFound { .. }) if !equation.chain.is_linear() => {
            followed(equation, kinks, request, SHORTER)
        }
        found => found,
    }
}

/// Even steps from kink to kink.
pub(crate) fn first_edges(kinks: &[f64], steps: f64) -> Vec<f64> {
    let mut edges = vec![0.0];
    for pair in kinks.windows(2) {
        let length = pair[1] - pair[0];
        let parts = (length * steps / TAU - 1e-9).ceil().max(1.0);
        edges.extend((1..=parts as usize).map(|i| pair[0] + length * (i as f64 / parts)));
    }
    edges
}

/// Ends of steps over several cycles.
fn repeated(edges: &[f64], multiple: usize) -> Vec<f64> {
    let cycle = edges[edges.len() - 1];
    let mut all = vec![edges[0]];
    (0..multiple).for_each(|n| all.extend(edges[1..].iter().map(|edge| edge + n as f64 * cycle)));
    all
}

/// Where the search begins: a given state, or the crank at one speed with nothing twisted; and what twists and speeds are measured
/// with before anything is known, a radian and the speed.
pub(crate) fn beginning(chain: &Chain, request: &Request) -> (Vec<f64>, Vec<f64>) {
    let held = chain.drivers.iter().find_map(|driver| match driver.source {
        Source::Held(speed) => Some(speed),
        _ => None,
    });
    let speed = held.unwrap_or(request.speed);
    let (m, others) = (chain.states(), chain.masses() - 1);
    let even = || (0..m).map(|r| if r + 1 < m { 0.0 } else { speed }).collect();
    let start = request.start.clone().unwrap_or_else(even);
    let scale = (0..m).map(|r| if r < others { 1.0 } else { speed }).collect();
    (start, scale)
}

type Found = (Mesh, Solution, Vec<f64>);

/// The periodic solution by Newton's method alone.
fn at_once(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Option<Found> {
    let mesh = Mesh::new(&equation, first_edges(kinks, STEPS));
    let (start, scale) = beginning(equation.chain, request);
    let mut solution = Solution::constant(mesh.steps(), &start);
    let monodromy = Cycle::new(equation, &mesh).periodic(&mut solution, &scale, usize::MAX)?;
    Some((mesh, solution, monodromy))
}

/// The periodic solution from that of a driveline with more damping, c + α k/ω, and a share 1 − α of its backlash, of which α is
/// taken away step by step: near a resonance the damped motion is near the rigid one, and the other grows out of it.
fn from_damped(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Option<Found> {
    let mesh = Mesh::new(&equation, first_edges(kinks, FINE_STEPS));
    let (start, scale) = beginning(equation.chain, request);
    let omega = scale[scale.len() - 1];
    let patience = if equation.chain.is_linear() { PATIENCE } else { usize::MAX };
    let solved = |guess: &Solution, alpha: f64| {
        let mut chain = equation.chain.clone();
        for link in &mut chain.links {
            link.law.damping += alpha * link.law.stiffness / omega;
            link.law.gap *= 1.0 - alpha;
        }
        let mut solution = guess.clone();
        let monodromy = Cycle::new(Equation { chain: &chain, ..equation }, &mesh).periodic(
            &mut solution,
            &scale,
            patience,
        )?;
        Some((solution, monodromy))
    };
    let (mut alpha, mut step) = (DAMPED, 0.5 * DAMPED);
    let mut known = solved(&Solution::constant(mesh.steps(), &start), alpha)?.0;
    while step > LEAST_STEP {
        // Below the last step nothing is left to take away.
        let next = if alpha - step < LEAST_STEP { 0.0 } else { alpha - step };
        match solved(&known, next) {
            Some((solution, monodromy)) if next == 0.0 => return Some((mesh, solution, monodromy)),
            Some((solution, _)) => {
                (alpha, known) = (next, solution);
                step = (1.5 * step).min(0.5 * alpha).max(2.0 * LEAST_STEP);
            }
            None => step *= 0.4,
        }
    }
    None
}

/// Whether one motion is known, and another is looked for: why there is none is not asked then, and where a machine stalls neither.
fn seeks_another(chain: &Chain, request: &Request) -> bool {
    chain.is_linear() && request.cycles_first > 0
}

/// Steps of a revolution where a motion is followed: with kinks of links it must be followed as it is, vibrations included.
fn followed_steps(chain: &Chain, request: &Request, omega: f64) -> f64 {
    let vibrations = request.fastest * TAU / (omega * FOLLOWED_ANGLE);
    if !chain.is_linear() {
        return vibrations.clamp(FINE_STEPS, FOLLOWED_STEPS_MAX);
    }
    if seeks_another(chain, request) { vibrations.clamp(STEPS, FINE_STEPS) } else { FINE_STEPS }
}

/// The periodic solution behind cycles that are followed.
fn followed(
    equation: Equation<'_>,
    kinks: &[f64],
    request: &Request,
    shorter: f64,
) -> Result<Rough, Failure> {
    let (start, mut scale) = beginning(equation.chain, request);
    let steps = shorter * followed_steps(equation.chain, request, scale[scale.len() - 1]);
    let edges = first_edges(kinks, steps);
    let mesh = Mesh::new(&equation, edges.clone());
    let mut cycle = Cycle::new(equation, &mesh);
    let mut last: VecDeque<Solution> = VecDeque::new();
    let (mut next, mut cycles, mut passed) = (Solution::constant(mesh.steps(), &start), 0, None);
    let mut attempts = 0;
    loop {
        for _ in 0..CYCLES_AT_ONCE {
            let turned = cycles as f64 * mesh.edges[mesh.steps()];
            let stop = |stop: Stop| Failure::Stops(Stop { phi: stop.phi + turned, ..stop });
            cycle.follow(&mut next, &scale).map_err(stop)?;
            last.push_back(next.clone());
            if last.len() > 2 * request.multiples {
                last.pop_front();
            }
            next.start = next.stage(mesh.steps() - 1, S - 1).to_vec();
            cycles += 1;
        }
        scale = scales(&next, equation.chain);
        let is_last = cycles >= request.cycles_max;
        if cycles >= request.cycles_first {
            let repeats = repetition(&last, &next.start, &scale, request.multiples);
            // Where Newton's method has failed some times behind cycles that repeat, more of them do not help.
            attempts += usize::from(repeats.is_some_and(|(_, off)| off < REPEATS));
            let close = repeats.is_some_and(|(_, off)| off < REPEATS);
            let multiple = match repeats {
                Some(_) if attempts > ATTEMPTS && request.multiples > 1 => 0,
                Some((multiple, _)) if close || is_last || request.multiples == 1 => multiple,
                Some(_) => 0,
                None => 1,
            };
            let found = if multiple > 0 {
                periodic_behind(equation, &edges, &last, multiple, &scale, close)
            } else {
                None
            };
            if let Some((mesh, solution, monodromy)) = found {
                let near = distance(&solution.start, &next.start, &scale) < SAME_MOTION;
                let settles = near && largest_multiplier(&monodromy) < 1.0;
                let rough = Rough { mesh, solution, monodromy, cycles, multiple };
                if settles || request.multiples == 1 {
                    return Ok(rough);
                }
                // A motion that the machine passes by and leaves again is one, but not that to which it comes; unstable ones of
                // several cycles are many where it does not repeat, and any of them is near by chance.
                passed = passed.or(if near && multiple == 1 { Some(rough) } else { None });
            }
        }
        if is_last {
            if let Some(rough) = passed {
                return Ok(rough);
            }
            let repeats = repetition(&last, &next.start, &scale, request.multiples);
            let off = repeats.map_or(f64::NAN, |(_, off)| off);
            let parting = if seeks_another(equation.chain, request) {
                f64::NAN
            } else {
                parting(&mut cycle, next, &scale).map_err(Failure::Stops)?
            };
            return Err(Failure::NotFound { off, parting });
        }
    }
}

/// Newton's method from the last cycles that were followed. Where a law changes its form within a step it may alternate between both:
/// steps then end there, and the motion is followed on these.
fn periodic_behind(
    equation: Equation<'_>,
    edges: &[f64],
    last: &VecDeque<Solution>,
    multiple: usize,
    scale: &[f64],
    repeats: bool,
) -> Option<Found> {
    let mut mesh = Mesh::new(&equation, repeated(edges, multiple));
    let cycles = last.range(last.len() - multiple..);
    let start = cycles.clone().next()?.start.clone();
    let mut solution = Solution { start, stages: cycles.flat_map(|one| one.stages.clone()).collect() };
    let mut placed = Vec::new();
    for _ in 0..ROUNDS_BEHIND {
        let mut tried = solution.clone();
        if let Some(monodromy) = Cycle::new(equation, &mesh).periodic(&mut tried, scale, usize::MAX) {
            return Some((mesh, tried, monodromy));
        }
        if equation.chain.is_linear() || !repeats {
            return None;
        }
        let errors = errors(&equation, &mesh, &solution, scale);
        let crossings = crossings(&equation, &mesh, &solution, scale);
        let edges = finer_edges(&mesh, &errors, &crossings, ROUGHLY, &mut placed);
        if edges.len() > STEPS_MAX {
            return None;
        }
        let finer = Mesh::new(&equation, edges).with_kinks(&placed);
        solution = solution.on(&mesh.edges, &finer.edges);
        mesh = finer;
        let mut cycle = Cycle::new(equation, &mesh);
        for _ in 0..CYCLES_BEHIND {
            cycle.follow(&mut solution, scale).ok()?;
            solution.start = solution.stage(mesh.steps() - 1, S - 1).to_vec();
        }
    }
    None
}

/// Factor by which motions close to one that is followed part in a cycle: the mean growth of a disturbance, its size over the scale.
/// Its logarithm is the largest Lyapunov exponent.
///
/// Source: Benettin, Galgani, Giorgilli, Strelcyn, *Meccanica* 15 (1980) 9–30.
fn parting(cycle: &mut Cycle<'_>, mut next: Solution, scale: &[f64]) -> Result<f64, Stop> {
    let (m, mut growth) = (next.states(), 0.0);
    let mut off = scale.to_vec();
    for n in 0..CYCLES_SETTLING + CYCLES_PARTING {
        cycle.follow(&mut next, scale)?;
        let (_, end) = cycle.linear(&next, &[]);
        let matrix = monodromy(&end, m);
        let moved = |r: usize| (0..m).map(|c| matrix[r * m + c] * off[c]).sum::<f64>();
        off = (0..m).map(moved).collect();
        let size = off.iter().zip(scale).map(|(off, scale)| (off / scale).abs()).fold(0.0, f64::max);
        off.iter_mut().for_each(|off| *off /= size);
        if n >= CYCLES_SETTLING {
            growth += size.ln() / CYCLES_PARTING as f64;
        }
        next.start = next.stages[next.stages.len() - m..].to_vec();
    }
    Ok(growth.exp())
}

/// Difference of two states over their scale.
fn distance(a: &[f64], b: &[f64], scale: &[f64]) -> f64 {
    a.iter().zip(b).zip(scale).map(|((a, b), scale)| (a - b).abs() / scale).fold(0.0, f64::max)
}

/// Number of cycles after which the last ones repeat best, the smallest that is good enough, with what they differ by.
fn repetition(
    last: &VecDeque<Solution>,
    end: &[f64],
    scale: &[f64],
    multiples: usize,
) -> Option<(usize, f64)> {
    let off = |n: usize| distance(&last[last.len() - n].start, end, scale);
    let found: Vec<_> = (1..=multiples.min(last.len())).map(|n| (n, off(n))).collect();
    let best = found.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(found.into_iter().find(|&(_, off)| off < REPEATS).unwrap_or(best))
}

/// Size of the largest eigenvalue of a square matrix, row by row, from a high power of it.
pub(crate) fn largest_multiplier(matrix: &[f64]) -> f64 {
    let m = matrix.len().isqrt();
    let mut power = matrix.to_vec();
    let mut log = 0.0;
    for k in 0..SQUARINGS {
        let size = power.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        if size == 0.0 {
            return 0.0;
        }
        log += size.ln() / f64::from(1_u32 << k);
        power.iter_mut().for_each(|x| *x /= size);
        let square = |i: usize| (0..m).map(|j| power[i / m * m + j] * power[j * m + i % m]).sum();
        power = (0..m * m).map(square).collect();
    }
    log.exp()
}
