//! The periodic solution roughly: from where Newton's method begins, and what it comes to.
//!
//! It begins with the crank at one speed, on few steps from kink to kink. Where it does not converge from there, the driveline has
//! more damping and no backlash at first, which are taken away and given back step by step; else the motion is followed from cycle to
//! cycle, which also tells where a machine stalls, and after how many cycles its motion repeats.

use crate::chain::{Chain, Source};
use crate::cycle::{Cycle, Stop};
use crate::equation::Equation;
use crate::mesh::{Mesh, Solution};
use crate::request::{Failure, Request};
use crate::scale::scales;
use linkwright_kernel::radau::S;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// Steps of a revolution at first, and where Newton's method does not converge on them.
const STEPS: f64 = 16.0;
/// See [`STEPS`].
const FINE_STEPS: f64 = 48.0;

/// Steps of a revolution at most where a motion is followed.
const FOLLOWED_STEPS_MAX: f64 = 600.0;

/// Phase \[rad\] of a vibration in a step where a motion is followed.
const FOLLOWED_ANGLE: f64 = 1.5;

/// Cycles that are followed between attempts of Newton's method.
const CYCLES_AT_ONCE: usize = 10;

/// Difference between cycles, over the scale of the state, from which on they repeat.
const REPEATS: f64 = 1e-3;

/// Difference of a periodic motion from the cycles that led to it, likewise, up to which it is the one that they come to.
const SAME_MOTION: f64 = 0.05;

/// Squarings of a matrix for its largest eigenvalue, to a hundredth.
const SQUARINGS: u32 = 10;

/// Damping that is added at first, and its smallest step, as shares of k/ω.
const DAMPED: f64 = 1.0;
/// See [`DAMPED`].
const LEAST_STEP: f64 = 1e-3;

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
    followed(equation, kinks, request)
}

/// Even steps from kink to kink.
fn first_edges(kinks: &[f64], steps: f64) -> Vec<f64> {
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
fn beginning(chain: &Chain, request: &Request) -> (Vec<f64>, Vec<f64>) {
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
    let mut solution = Solution::constant(&mesh, &start);
    let monodromy = Cycle::new(equation, &mesh).periodic(&mut solution, &scale)?;
    Some((mesh, solution, monodromy))
}

/// The periodic solution from that of a driveline with more damping, c + α k/ω, and a share 1 − α of its backlash, of which α is
/// taken away step by step: near a resonance the damped motion is near the rigid one, and the other grows out of it.
fn from_damped(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Option<Found> {
    let mesh = Mesh::new(&equation, first_edges(kinks, FINE_STEPS));
    let (start, scale) = beginning(equation.chain, request);
    let omega = scale[scale.len() - 1];
    let solved = |guess: &Solution, alpha: f64| {
        let mut chain = equation.chain.clone();
        for link in &mut chain.links {
            link.law.damping += alpha * link.law.stiffness / omega;
            link.law.gap *= 1.0 - alpha;
        }
        let mut solution = guess.clone();
        let monodromy =
            Cycle::new(Equation { chain: &chain, ..equation }, &mesh).periodic(&mut solution, &scale)?;
        Some((solution, monodromy))
    };
    let (mut alpha, mut step) = (DAMPED, 0.5 * DAMPED);
    let mut known = solved(&Solution::constant(&mesh, &start), alpha)?.0;
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

/// Steps of a revolution where a motion is followed: with kinks of links it must be followed as it is, vibrations included.
fn followed_steps(chain: &Chain, request: &Request, omega: f64) -> f64 {
    if chain.is_linear() {
        return FINE_STEPS;
    }
    (request.fastest * TAU / (omega * FOLLOWED_ANGLE)).clamp(FINE_STEPS, FOLLOWED_STEPS_MAX)
}

/// The periodic solution behind cycles that are followed.
fn followed(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Result<Rough, Failure> {
    let (start, mut scale) = beginning(equation.chain, request);
    let steps = followed_steps(equation.chain, request, scale[scale.len() - 1]);
    let edges = first_edges(kinks, steps);
    let mesh = Mesh::new(&equation, edges.clone());
    let mut cycle = Cycle::new(equation, &mesh);
    let mut last: VecDeque<Solution> = VecDeque::new();
    let (mut next, mut cycles, mut passed) = (Solution::constant(&mesh, &start), 0, None);
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
            let multiple = match repeats {
                Some((multiple, off)) if off < REPEATS || is_last || request.multiples == 1 => multiple,
                Some(_) => 0,
                None => 1,
            };
            let found =
                if multiple > 0 { periodic_behind(equation, &edges, &last, multiple, &scale) } else { None };
            if let Some((mesh, solution, monodromy)) = found {
                let near = distance(&solution.start, &next.start, &scale) < SAME_MOTION;
                let settles = near && largest_multiplier(&monodromy) < 1.0;
                let rough = Rough { mesh, solution, monodromy, cycles, multiple };
                if settles || request.multiples == 1 {
                    return Ok(rough);
                }
                // A motion that the machine passes by and leaves again is one, but not that to which it comes.
                passed = passed.or(if near { Some(rough) } else { None });
            }
        }
        if is_last {
            if let Some(rough) = passed {
                return Ok(rough);
            }
            let repeats = repetition(&last, &next.start, &scale, request.multiples);
            return Err(Failure::NotFound(repeats.map_or(f64::NAN, |(_, off)| off)));
        }
    }
}

/// Newton's method from the last cycles that were followed.
fn periodic_behind(
    equation: Equation<'_>,
    edges: &[f64],
    last: &VecDeque<Solution>,
    multiple: usize,
    scale: &[f64],
) -> Option<Found> {
    let mesh = Mesh::new(&equation, repeated(edges, multiple));
    let cycles = last.range(last.len() - multiple..);
    let start = cycles.clone().next()?.start.clone();
    let mut solution = Solution { start, stages: cycles.flat_map(|one| one.stages.clone()).collect() };
    let monodromy = Cycle::new(equation, &mesh).periodic(&mut solution, scale)?;
    Some((mesh, solution, monodromy))
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
fn largest_multiplier(matrix: &[f64]) -> f64 {
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
