//! The periodic solution roughly: from where Newton's method begins, and what it comes to.
//!
//! It begins with the crank at one speed, on few steps from kink to kink. Where it does not converge from there, the driveline has
//! more damping and no backlash at first, which are taken away and given back step by step.

use crate::chain::{Chain, Source};
use crate::cycle::Cycle;
use crate::equation::Equation;
use crate::mesh::{Mesh, Solution};
use crate::request::Request;
use std::f64::consts::TAU;

/// Steps of a revolution at first, and where Newton's method does not converge on them.
pub(crate) const STEPS: f64 = 16.0;
/// See [`STEPS`].
const FINE_STEPS: f64 = 48.0;

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
    /// Ends of steps where laws change their form.
    pub placed: Vec<f64>,
    /// Cycles that were followed.
    pub cycles: usize,
    /// Cycles after which it repeats.
    pub multiple: usize,
}

/// The periodic solution by Newton's method alone, on few steps.
pub(crate) fn at_first(equation: Equation<'_>, kinks: &[f64], request: &Request) -> Option<Rough> {
    let found = at_once(equation, kinks, request).or_else(|| from_damped(equation, kinks, request));
    let (mesh, solution, monodromy) = found?;
    Some(Rough { mesh, solution, monodromy, placed: Vec::new(), cycles: 0, multiple: 1 })
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
