//! The periodic solution to a wanted accuracy.
//!
//! Steps whose error is too large are divided, and end where the solution passes a kink of a law, until neither changes.

use crate::crossings::{Crossing, crossings};
use crate::cycle::Cycle;
use crate::equation::Equation;
use crate::error::errors;
use crate::finer::{POWER, STEPS_MAX, finer_edges};
use crate::mesh::{Mesh, Solution};
use crate::request::{Failure, Request};
use crate::scale::scales;
use crate::starts::Rough;

/// Times that steps are divided.
pub(crate) const ROUNDS_MAX: usize = 40;

/// Rounds in which steps with a crossing inside are not divided: they end there in the next one.
const KINKS_FIRST: usize = 12;

/// Rounds in which crossings have to stand so exactly that derivatives by the start err by no more than [`SLOPES`].
const SLOPES_FIRST: usize = 8;
/// See [`SLOPES_FIRST`].
const SLOPES: f64 = 1e-8;

/// Newton's method fails.
const NOT_FOLLOWED: Failure = Failure::NotFound { off: f64::NAN, parting: f64::NAN };

/// Phase \[rad\] of a vibration in a step: the method errs by 2.2·10⁻⁹ times its tenth power.
const ANGLE_OF_VIBRATION: f64 = 1.3;

/// A steady motion.
#[derive(Clone)]
pub struct Steady {
    /// Steps.
    pub mesh: Mesh,
    /// Motion on them.
    pub solution: Solution,
    /// Derivative of the state at the end of the cycle by that at its start, row by row.
    pub monodromy: Vec<f64>,
    /// Error that was reached, over the scale of the state.
    pub reached: f64,
    /// Cycles that were followed before Newton's method converged.
    pub cycles: usize,
    /// Cycles of the mechanism after which it repeats.
    pub multiple: usize,
}

/// A periodic solution to the wanted accuracy.
pub(crate) fn refined(equation: Equation<'_>, rough: Rough, request: &Request) -> Result<Steady, Failure> {
    let Rough { mut mesh, mut solution, mut monodromy, mut placed, cycles, multiple } = rough;
    let mut reached = f64::INFINITY;
    for round in 0..ROUNDS_MAX {
        let scale = scales(&solution, equation.chain);
        let found = errors(&equation, &mesh, &solution, &scale);
        let crossings = crossings(&equation, &mesh, &solution, &scale);
        let (errors, worst) = worst_error(found, &crossings, &mesh, &solution, request, round);
        reached = worst;
        if reached <= request.accuracy {
            return Ok(Steady { mesh, solution, monodromy, reached, cycles, multiple });
        }
        let edges = finer_edges(&mesh, &errors, &crossings, request.accuracy, &mut placed);
        if edges.len() > STEPS_MAX {
            break;
        }
        let finer = Mesh::new(&equation, edges).with_kinks(&placed);
        solution = solution.on(&mesh.edges, &finer.edges);
        mesh = finer;
        let found = Cycle::new(equation, &mesh).periodic(&mut solution, &scale, usize::MAX);
        monodromy = found.ok_or(NOT_FOLLOWED)?;
    }
    Err(Failure::Inaccurate(reached))
}

/// Errors by which steps are divided, and the largest error of the solution.
pub(crate) fn worst_error(
    mut errors: Vec<f64>,
    crossings: &[Crossing],
    mesh: &Mesh,
    solution: &Solution,
    request: &Request,
    round: usize,
) -> (Vec<f64>, f64) {
    add_vibration(&mut errors, mesh, solution, request);
    // Where a law is only touched the place is known to half of the digits, and derivatives by the start are as uncertain.
    let counts = if round < SLOPES_FIRST { request.accuracy / SLOPES } else { 0.0 };
    let missed = |crossing: &Crossing| crossing.error.max(counts * crossing.error_of_slopes);
    let worst = errors.iter().copied().chain(crossings.iter().map(missed)).fold(0.0, f64::max);
    if round < KINKS_FIRST {
        for crossing in crossings.iter().filter(|crossing| missed(crossing) > request.accuracy) {
            errors[crossing.step] = errors[crossing.step].min(request.accuracy);
        }
    }
    (errors, worst)
}

/// Lets steps be divided in which the method would damp a vibration that lasts: the motion may have none of it, the multipliers do.
pub(crate) fn add_vibration(errors: &mut [f64], mesh: &Mesh, solution: &Solution, request: &Request) {
    let m = solution.states();
    for (k, error) in errors.iter_mut().enumerate() {
        let angle = request.fastest * mesh.length(k) / solution.start_of(k)[m - 1];
        if angle > ANGLE_OF_VIBRATION {
            *error = error.max(request.accuracy * (angle / ANGLE_OF_VIBRATION).powf(POWER));
        }
    }
}
