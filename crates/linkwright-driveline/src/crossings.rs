//! Crank angles at which a solution passes a kink of a law, where steps have to end.
//!
//! A law of a link passes from one form to another where its twist meets a flank or a point of its curve, or where its damper is held
//! back; the characteristic of a motor bends at some speeds. These angles follow from the solution, and the solution from them: both
//! are found alternately. The vector field is continuous there, so that an end of a step which is off by d costs an error in proportion
//! to d², and each round doubles the digits.

use crate::chain::Link;
use crate::equation::Equation;
use crate::law::Zone;
use crate::mesh::{Mesh, Solution};
use linkwright_kernel::radau::{N, value};

/// Parts of a step in which the form of a law is looked at.
const LOOKS: usize = 16;

/// Bisections of the place of a crossing, to rounding.
const BISECTIONS: usize = 50;

/// A crossing in a step.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// Crank angle \[rad\].
    pub angle: f64,
    /// Step that holds it.
    pub step: usize,
    /// Error of the solution, over its scale, as long as no step ends there.
    pub error: f64,
    /// Error of its derivatives, likewise.
    pub error_of_slopes: f64,
}

/// All crossings of a solution.
pub fn crossings(equation: &Equation<'_>, mesh: &Mesh, solution: &Solution, scale: &[f64]) -> Vec<Crossing> {
    let mut found = speed_crossings(equation, mesh, solution);
    for link in equation.chain.links.iter().filter(|link| !link.law.is_linear()) {
        let mut before = None;
        for k in 0..mesh.steps() {
            let [first, last] = link_crossings(equation, mesh, solution, scale, (link, k), &mut found);
            // Where a step ends at a kink, rounding decides on which side of it the kink is found.
            if before.is_some_and(|zone| zone != first) {
                found.push(Crossing { angle: mesh.edges[k], step: k, error: 0.0, error_of_slopes: 0.0 });
            }
            before = Some(last);
        }
    }
    found
}

/// Quintics of twist and rate of a link in a step.
fn twist_quintics(equation: &Equation<'_>, solution: &Solution, link: &Link, k: usize) -> [[f64; N]; 2] {
    let others = equation.chain.masses() - 1;
    [0, others].map(|first| {
        let mut sum = [0.0; N];
        for (mass, sign) in [(link.first, 1.0), (link.second, -1.0)] {
            if mass < others {
                let own = solution.quintic(k, first + mass);
                sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += sign * own);
            }
        }
        sum
    })
}

/// Crossings of a link in a step; gives the forms of its law at both ends.
fn link_crossings(
    equation: &Equation<'_>,
    mesh: &Mesh,
    solution: &Solution,
    scale: &[f64],
    (link, k): (&Link, usize),
    found: &mut Vec<Crossing>,
) -> [Zone; 2] {
    let quintics = twist_quintics(equation, solution, link, k);
    let at = |share: f64| quintics.map(|quintic| value(&quintic, share));
    let zone = |share: f64| {
        let [twist, rate] = at(share);
        link.law.zone(twist, rate)
    };
    let first = zone(0.0);
    let mut before = (0.0, first);
    for look in 1..=LOOKS {
        let end = (look as f64 / LOOKS as f64, zone(look as f64 / LOOKS as f64));
        // Between two looks a law may pass several forms.
        while before.1 != end.1 {
            let (low, high) = first_change(before, end.0, &zone);
            let angle = mesh.edges[k] + high * mesh.length(k);
            let forms = (high, before.1, zone(high));
            let [error, error_of_slopes] = missed(equation, mesh, solution, scale, (link, k), forms, &at);
            found.push(Crossing { angle, step: k, error, error_of_slopes });
            if high <= low {
                break;
            }
            before = (high, zone(high));
        }
        before = end;
    }
    [first, before.1]
}

/// Shares before and behind the first change of the form that bisection comes to.
fn first_change((mut low, own): (f64, Zone), mut high: f64, zone: &impl Fn(f64) -> Zone) -> (f64, f64) {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if zone(middle) == own { low = middle } else { high = middle }
    }
    (low, high)
}

/// Errors of a solution, and of its derivatives, whose step ends beside a crossing: between both the law is in the other form.
fn missed(
    equation: &Equation<'_>,
    mesh: &Mesh,
    solution: &Solution,
    scale: &[f64],
    (link, k): (&Link, usize),
    (share, before, behind): (f64, Zone, Zone),
    at: &impl Fn(f64) -> [f64; 2],
) -> [f64; 2] {
    let chain = equation.chain;
    let (others, m) = (chain.masses() - 1, chain.states());
    let end = if share < 0.5 { 0.0 } else { 1.0 };
    let [twist, rate] = at(end);
    let [one, other] = [before, behind].map(|zone| link.law.of_zone(zone, twist, rate));
    let off = (one.value - other.value).abs();
    let row = mesh.rows.row(k * linkwright_kernel::radau::S);
    let inertia = |mass: usize| if mass < others { chain.inertia[mass] } else { row.reduced.J - chain.apart };
    let lightest = inertia(link.first).min(inertia(link.second));
    let finest = scale[others..].iter().copied().fold(f64::INFINITY, f64::min);
    let omega = solution.start_of(k)[m - 1];
    let apart = (share - end).abs() * mesh.length(k) / (lightest * omega);
    // Twists change by a radian of the crank where their rate is that of the crank.
    let bend = (one.by_twist - other.by_twist).abs() / omega + (one.by_rate - other.by_rate).abs();
    [0.5 * apart * off / finest, apart * bend]
}

/// Where the motor, or the crank, passes a speed at which its characteristic has a kink.
fn speed_crossings(equation: &Equation<'_>, mesh: &Mesh, solution: &Solution) -> Vec<Crossing> {
    let (chain, drive) = (equation.chain, &equation.plan.drive);
    let speeds: Vec<f64> = drive.speed_kinks(&equation.plan.tables, equation.q);
    if speeds.is_empty() {
        return Vec::new();
    }
    let mut found = Vec::new();
    let others = chain.masses() - 1;
    for mass in [chain.driven, others] {
        for k in 0..mesh.steps() {
            let mut speed = solution.quintic(k, chain.states() - 1);
            if mass < others {
                let beside = solution.quintic(k, others + mass);
                speed.iter_mut().zip(beside).for_each(|(sum, b)| *sum += b);
            }
            for &kink in &speeds {
                let at = |share: f64| value(&speed, share) - kink;
                if at(0.0) * at(1.0) < 0.0 {
                    let angle = mesh.edges[k] + mesh.length(k) * crossing(at);
                    found.push(Crossing { angle, step: k, error: 0.0, error_of_slopes: 0.0 });
                }
            }
        }
    }
    found
}

/// Share of a step at which something changes its sign, by bisection.
fn crossing(at: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high, sign) = (0.0, 1.0, at(0.0));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if at(middle) * sign > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
