//! Where a mass passes a speed at which the characteristic of its motor, or a load over its speed, has a kink.

use crate::chain::Source;
use crate::equation::Equation;
use crate::mesh::Solution;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::radau::value;

/// Steps with the crank angles at which a mass passes a speed at which a characteristic of its motor, or a load over its speed, has a kink.
pub(crate) fn speed_kinks(equation: &Equation<'_>, edges: &[f64], solution: &Solution) -> Vec<(usize, f64)> {
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
                    found.push((k, edges[k] + (edges[k + 1] - edges[k]) * crossing(at)));
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
