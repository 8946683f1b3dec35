//! Where further mechanisms pass kinks of their own: as the twists have it, so that the solution tells.

use crate::chain::Chain;
use crate::mesh::{Mesh, Solution};
use linkwright_core::drive::kinks::kinks;
use linkwright_kernel::radau::value;

/// Halvings of a step in which a kink is.
const HALVINGS: usize = 50;

/// Steps with the crank angles at which further mechanisms pass kinks of their own.
pub fn station_kinks(chain: &Chain, mesh: &Mesh, solution: &Solution) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    for station in &chain.stations {
        let own = kinks(&station.part.plan, &station.part.q);
        let cycle = own[own.len() - 1];
        for k in 0..mesh.steps() {
            let (low, h) = (mesh.edges[k], mesh.length(k));
            let twist = (station.mass + 1 < chain.masses()).then(|| solution.quintic(k, station.mass));
            let psi = |share: f64| {
                let twist = twist.as_ref().map_or(0.0, |twist| value(twist, share));
                station.ratio * (low + share * h + twist) + station.phase
            };
            // A crank that turns forward passes what lies between the ends of the step, once.
            let (first, last) = (psi(0.0), psi(1.0));
            for turn in (first / cycle).floor() as i64..=(last / cycle).floor() as i64 {
                let passed = own[1..].iter().map(|kink| kink + cycle * turn as f64);
                for kink in passed.filter(|kink| (first..last).contains(kink)) {
                    found.push((k, low + h * share_of(|share| psi(share) - kink)));
                }
            }
        }
    }
    found
}

/// Share of a step at which something that grows is zero, by bisection.
fn share_of(at: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if at(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
