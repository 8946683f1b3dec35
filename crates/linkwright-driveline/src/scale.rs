//! What errors of a solution are compared with.

use crate::chain::Chain;
use crate::mesh::Solution;

/// Twists \[rad\] that count as none.
const NO_TWIST: f64 = 1e-12;

/// What errors of the numbers of a state are compared with: the largest of each over the cycle. A speed against the crank counts
/// beside the speed itself, and beside the torque that dampers make of it.
pub fn scales(solution: &Solution, chain: &Chain) -> Vec<f64> {
    let (m, others) = (chain.states(), chain.masses() - 1);
    let mut largest = vec![0.0_f64; m];
    let mut torques = vec![0.0_f64; chain.links.len()];
    for y in solution.stages.chunks_exact(m) {
        for (largest, y) in largest.iter_mut().zip(y) {
            *largest = largest.max(y.abs());
        }
        for (largest, link) in torques.iter_mut().zip(&chain.links) {
            *largest = largest.max(chain.torque(link, y).value.abs());
        }
    }
    let damped = chain.links.iter().zip(&torques).filter(|(link, _)| link.law.damping > 0.0);
    let beside = damped.map(|(link, torque)| torque / link.law.damping).fold(largest[m - 1], f64::min);
    let floor = |r: usize| if r < others { NO_TWIST } else { beside };
    (0..m).map(|r| largest[r].max(floor(r))).collect()
}
