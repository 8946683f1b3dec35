//! The periodic solution to a wanted accuracy.
//!
//! Newton's method begins with the crank at one speed, on few steps from kink to kink; steps whose error is too large are divided.
//! Where it does not converge the motion is followed from cycle to cycle first, which also tells where a machine stalls.

use crate::chain::{Chain, Source};
use crate::cycle::{Cycle, Stop};
use crate::equation::Equation;
use crate::error::errors;
use crate::mesh::{Mesh, Solution};
use crate::station_kinks::station_kinks;
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::radau::{S, value};

/// Steps of a revolution at first, and where Newton's method does not converge on them.
const STEPS: f64 = 16.0;
/// See [`STEPS`].
const FINE_STEPS: f64 = 48.0;

/// Steps of a cycle at most.
pub const STEPS_MAX: usize = 20_000;

/// Times that steps are divided.
const ROUNDS_MAX: usize = 40;

/// Parts of a step at once.
const PARTS_MAX: f64 = 6.0;

/// The error of quintics falls with this power of the length of their step.
const POWER: f64 = 6.0;

/// Phase \[rad\] of a vibration in a step: the method errs by 2.2·10⁻⁹ times its tenth power.
const ANGLE_OF_VIBRATION: f64 = 1.3;

/// Cycles that are followed between attempts of Newton's method.
const CYCLES_AT_ONCE: usize = 10;

/// Twists \[rad\] that count as none.
const NO_TWIST: f64 = 1e-12;

/// Damping that is added at first, and its smallest step, as shares of k/ω.
const DAMPED: f64 = 1.0;
/// See [`DAMPED`].
const LEAST_STEP: f64 = 1e-3;

/// Angles \[rad\] that are one.
const SAME_ANGLE: f64 = 1e-9;

/// A steady motion.
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
}

/// Why there is none.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// The crank comes to rest, or turns back.
    Stops(Stop),
    /// Neither Newton's method nor the motion in time comes to a periodic motion.
    NotFound,
    /// Steps cannot be divided further.
    Inaccurate(f64),
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Relative accuracy.
    pub accuracy: f64,
    /// Speed of the crank to begin with \[rad/s\].
    pub speed: f64,
    /// Size of the fastest eigenvalue of the driveline whose disturbances last for a cycle \[1/s\].
    pub fastest: f64,
    /// Cycles that are followed before Newton's method is tried.
    pub cycles_first: usize,
    /// Cycles that are followed at most.
    pub cycles_max: usize,
}

/// Steady motion of a machine with its driveline.
///
/// # Errors
/// None is found, or not as exactly as asked for.
pub fn steady(plan: &Plan, q: &[f64], chain: &Chain, request: &Request) -> Result<Steady, Failure> {
    let equation = Equation { plan, q, chain };
    let kinks = kinks(plan, q);
    let mut mesh = Mesh::new(&equation, first_edges(&kinks, STEPS));
    let found = match at_once(equation, &mesh, request) {
        Some(found) => found,
        None => {
            mesh = Mesh::new(&equation, first_edges(&kinks, FINE_STEPS));
            found_roughly(equation, &mesh, request)?
        }
    };
    refined(equation, mesh, found, request)
}

/// The periodic solution to the wanted accuracy, from one on a mesh with its monodromy matrix and the cycles that were followed.
pub(crate) fn refined(
    equation: Equation<'_>,
    mut mesh: Mesh,
    (mut solution, mut monodromy, cycles): (Solution, Vec<f64>, usize),
    request: &Request,
) -> Result<Steady, Failure> {
    let chain = equation.chain;
    let mut reached = f64::INFINITY;
    for _ in 0..ROUNDS_MAX {
        let scale = scales(&solution, chain);
        let mut errors = errors(&equation, &mesh, &solution, &scale);
        add_vibration(&mut errors, &mesh, &solution, request);
        reached = errors.iter().copied().fold(0.0, f64::max);
        let mut kinks = station_kinks(chain, &mesh, &solution);
        if reached <= request.accuracy && kinks.iter().all(|&kink| mesh.has_edge(kink)) {
            return Ok(Steady { mesh, solution, monodromy, reached, cycles });
        }
        kinks.extend(speed_kinks(&equation, &mesh.edges, &solution));
        let edges = divided(&mesh.edges, &errors, request.accuracy, &kinks);
        if edges.len() > STEPS_MAX {
            break;
        }
        let finer = Mesh::new(&equation, edges);
        solution = solution.on(&mesh, &finer);
        mesh = finer;
        monodromy = Cycle::new(equation, &mesh).periodic(&mut solution, &scale).ok_or(Failure::NotFound)?;
    }
    Err(Failure::Inaccurate(reached))
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

/// Even steps from kink to kink.
fn first_edges(kinks: &[f64], steps: f64) -> Vec<f64> {
    let mut edges = vec![0.0];
    for pair in kinks.windows(2) {
        let length = pair[1] - pair[0];
        let parts = (length * steps / std::f64::consts::TAU - 1e-9).ceil().max(1.0);
        edges.extend((1..=parts as usize).map(|i| pair[0] + length * (i as f64 / parts)));
    }
    edges
}

/// Where the search begins: the crank at one speed, nothing twisted; and what twists and speeds are measured with before anything is
/// known, a radian and the speed.
fn beginning(chain: &Chain, request: &Request) -> (Vec<f64>, Vec<f64>) {
    let held = chain.drivers.iter().find_map(|driver| match driver.source {
        Source::Held(speed) => Some(speed),
        _ => None,
    });
    let speed = held.unwrap_or(request.speed);
    let (m, others) = (chain.states(), chain.masses() - 1);
    let start = (0..m).map(|r| if r + 1 < m { 0.0 } else { speed }).collect();
    let scale = (0..m).map(|r| if r < others { 1.0 } else { speed }).collect();
    (start, scale)
}

/// The periodic solution by Newton's method alone, unless cycles are to be followed first.
fn at_once(equation: Equation<'_>, mesh: &Mesh, request: &Request) -> Option<(Solution, Vec<f64>, usize)> {
    if request.cycles_first > 0 {
        return None;
    }
    let (start, scale) = beginning(equation.chain, request);
    let mut solution = Solution::constant(mesh, &start);
    let monodromy = Cycle::new(equation, mesh).periodic(&mut solution, &scale)?;
    Some((solution, monodromy, 0))
}

/// The periodic solution from that of a driveline with more damping, or behind cycles that are followed.
fn found_roughly(
    equation: Equation<'_>,
    mesh: &Mesh,
    request: &Request,
) -> Result<(Solution, Vec<f64>, usize), Failure> {
    let (start, mut scale) = beginning(equation.chain, request);
    let constant = Solution::constant(mesh, &start);
    if request.cycles_first == 0 {
        let found = from_damped(equation, mesh, &constant, &scale);
        if let Some((solution, monodromy)) = found {
            return Ok((solution, monodromy, 0));
        }
    }
    let mut cycle = Cycle::new(equation, mesh);
    let (mut followed, mut cycles) = (constant, 0);
    loop {
        if cycles > 0 && cycles >= request.cycles_first {
            let mut tried = followed.clone();
            if let Some(monodromy) = cycle.periodic(&mut tried, &scale) {
                return Ok((tried, monodromy, cycles));
            }
        }
        if cycles >= request.cycles_max {
            return Err(Failure::NotFound);
        }
        for _ in 0..CYCLES_AT_ONCE {
            let turned = cycles as f64 * mesh.edges[mesh.steps()];
            let stop = |stop: Stop| Failure::Stops(Stop { phi: stop.phi + turned, ..stop });
            cycle.follow(&mut followed, &scale).map_err(stop)?;
            followed.start = followed.stage(mesh.steps() - 1, S - 1).to_vec();
            cycles += 1;
        }
        scale = scales(&followed, equation.chain);
    }
}

/// The periodic solution from that of a driveline with more damping, c + α k/ω, of which it is taken away step by step: near a resonance the damped motion is near the rigid one, and the other grows out of it.
fn from_damped(
    equation: Equation<'_>,
    mesh: &Mesh,
    guess: &Solution,
    scale: &[f64],
) -> Option<(Solution, Vec<f64>)> {
    let omega = scale[scale.len() - 1];
    let solved = |guess: &Solution, alpha: f64| {
        let mut chain = equation.chain.clone();
        for link in &mut chain.links {
            link.damping += alpha * link.stiffness / omega;
        }
        let mut solution = guess.clone();
        let monodromy =
            Cycle::new(Equation { chain: &chain, ..equation }, mesh).periodic(&mut solution, scale)?;
        Some((solution, monodromy))
    };
    let (mut alpha, mut step) = (DAMPED, 0.5 * DAMPED);
    let mut known = solved(guess, alpha)?.0;
    while step > LEAST_STEP {
        // Below the last step nothing is left to take away.
        let next = if alpha - step < LEAST_STEP { 0.0 } else { alpha - step };
        match solved(&known, next) {
            Some((solution, monodromy)) if next == 0.0 => return Some((solution, monodromy)),
            Some((solution, _)) => {
                (alpha, known) = (next, solution);
                step = (1.5 * step).min(0.5 * alpha).max(2.0 * LEAST_STEP);
            }
            None => step *= 0.4,
        }
    }
    None
}

/// What errors of the numbers of a state are compared with: the largest of each over the cycle. A speed against the crank counts
/// beside the speed itself, and beside the torque that dampers make of it.
pub(crate) fn scales(solution: &Solution, chain: &Chain) -> Vec<f64> {
    let (m, others) = (chain.states(), chain.masses() - 1);
    let mut largest = vec![0.0_f64; m];
    let mut torques = vec![0.0_f64; chain.links.len()];
    for y in solution.stages.chunks_exact(m) {
        for (largest, y) in largest.iter_mut().zip(y) {
            *largest = largest.max(y.abs());
        }
        for (largest, link) in torques.iter_mut().zip(&chain.links) {
            *largest = largest.max(chain.torque(link, y).abs());
        }
    }
    let damped = chain.links.iter().zip(&torques).filter(|(link, _)| link.damping > 0.0);
    let beside = damped.map(|(link, torque)| torque / link.damping).fold(largest[m - 1], f64::min);
    let floor = |r: usize| if r < others { NO_TWIST } else { beside };
    (0..m).map(|r| largest[r].max(floor(r))).collect()
}

/// Parts into which a step with an error is divided.
pub(crate) fn parts_of_step(error: f64, accuracy: f64) -> usize {
    let excess = 2.0 * error / accuracy;
    if excess <= 2.0 { 1 } else { excess.powf(1.0 / POWER).ceil().clamp(2.0, PARTS_MAX) as usize }
}

/// Ends of steps after those with too large an error are divided, with one at each of some kinks.
fn divided(edges: &[f64], errors: &[f64], accuracy: f64, kinks: &[f64]) -> Vec<f64> {
    let mut finer = vec![edges[0]];
    for (pair, error) in edges.windows(2).zip(errors) {
        let parts = parts_of_step(*error, accuracy);
        let length = pair[1] - pair[0];
        finer.extend((1..=parts).map(|i| pair[0] + length * (i as f64 / parts as f64)));
    }
    for &kink in kinks {
        let behind = finer.partition_point(|&edge| edge < kink);
        let near = |i: usize| finer.get(i).is_some_and(|edge| (edge - kink).abs() < SAME_ANGLE);
        if !(near(behind) || behind > 0 && near(behind - 1)) {
            finer.insert(behind, kink);
        }
    }
    finer
}

/// Crank angles at which a mass passes a speed at which a characteristic of its motor, or a load over its speed, has a kink.
pub(crate) fn speed_kinks(equation: &Equation<'_>, edges: &[f64], solution: &Solution) -> Vec<f64> {
    let (chain, others) = (equation.chain, equation.chain.masses() - 1);
    let mut found = Vec::new();
    for (mass, speeds) in speeds_with_kinks(equation) {
        for k in 0..edges.len() - 1 {
            let mut speed = solution.quintic(k, chain.states() - 1);
            if mass < others {
                let beside = solution.quintic(k, others + mass);
                speed.iter_mut().zip(beside).for_each(|(sum, b)| *sum += b);
            }
            for &kink in &speeds {
                let at = |share: f64| value(&speed, share) - kink;
                if at(0.0) * at(1.0) < 0.0 {
                    found.push(edges[k] + (edges[k + 1] - edges[k]) * crossing(at));
                }
            }
        }
    }
    found
}

/// Masses with the speeds at which what acts on them has a kink.
fn speeds_with_kinks(equation: &Equation<'_>) -> Vec<(usize, Vec<f64>)> {
    let chain = equation.chain;
    let of = |plan: &Plan, q: &[f64]| plan.drive.speed_kinks(&plan.tables, q);
    let own: Vec<f64> = of(equation.plan, equation.q);
    let mut found = vec![(chain.masses() - 1, own.clone())];
    for driver in &chain.drivers {
        match &driver.source {
            Source::Own => found.push((driver.mass, own.clone())),
            Source::Motor(part) => found.push((driver.mass, of(&part.plan, &part.q))),
            Source::Held(_) | Source::Power { .. } => {}
        }
    }
    for station in &chain.stations {
        let speeds = of(&station.part.plan, &station.part.q);
        found.push((station.mass, speeds.into_iter().map(|speed| speed / station.ratio).collect()));
    }
    found.retain(|(_, speeds)| !speeds.is_empty());
    found
}

/// Share of a step at which something changes its sign, by bisection.
fn crossing(at: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high, sign) = (0.0, 1.0, at(0.0));
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if at(middle) * sign > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
