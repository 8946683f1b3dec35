//! Crank angles at which a solution passes a kink of a law, where steps have to end.
//!
//! A law of a link passes from one form to another where its twist meets a flank or a point of its curve, or where its damper is held
//! back; the characteristic of a motor bends at some speeds; further mechanisms have kinks of their own. These angles follow from the solution, and the solution from them: both
//! are found alternately. The vector field is continuous there, so that an end of a step which is off by d costs an error in proportion
//! to d², and each round doubles the digits.

use crate::chain::Link;
use crate::equation::{Equation, Rates};
use crate::law::Zone;
use crate::mesh::{Mesh, Solution};
use crate::speed_kinks::speed_kinks;
use crate::station_kinks::station_kinks;
use linkwright_kernel::radau::{N, value};

/// Parts of a step in which the form of a law is looked at.
const LOOKS: usize = 16;

/// Distance \[rad\] from the end of a step that rounding leaves.
const ROUNDING: f64 = 1e-12;

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
    let on_step = |(step, angle): (usize, f64)| Crossing { angle, step, error: 0.0, error_of_slopes: 0.0 };
    let mut found: Vec<Crossing> =
        speed_kinks(equation, &mesh.edges, solution).into_iter().map(on_step).collect();
    for kink in station_kinks(equation.chain, mesh, solution) {
        // Loads of a mechanism may jump at its kink.
        let error = (mesh.to_edge(kink.1) - ROUNDING).max(0.0);
        found.push(Crossing { error, ..on_step(kink) });
    }
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
    let mut rates = Rates::new(chain);
    let stage = k * linkwright_kernel::radau::S;
    equation.rates(&mesh.rows.row(stage), solution.stage(k, 0), &mut rates);
    let end = if share < 0.5 { 0.0 } else { 1.0 };
    let [twist, rate] = at(end);
    let [one, other] = [before, behind].map(|zone| link.law.of_zone(zone, twist, rate));
    let off = (one.value - other.value).abs();
    let lightest = rates.inertia(link.first).min(rates.inertia(link.second));
    let finest = scale[others..].iter().copied().fold(f64::INFINITY, f64::min);
    let omega = solution.start_of(k)[m - 1];
    let apart = (share - end).abs() * mesh.length(k) / (lightest * omega);
    // Twists change by a radian of the crank where their rate is that of the crank.
    let bend = (one.by_twist - other.by_twist).abs() / omega + (one.by_rate - other.by_rate).abs();
    [0.5 * apart * off / finest, apart * bend]
}
