//! What the rounding of angles leaves of the torques that twists tell.
//!
//! Steps that follow the swings of a shaft have its torque from the difference of two angles. Every step rounds these, and a
//! shaft that is not damped goes on with what it was struck by, so that n steps gather
//!
//! ```text
//! δT = k ε (|θ_a| + |θ_b|) √n
//! ```
//!
//! as a walk at random does. Angles are those of the state, counted from the first mass.

use super::extremes::Extreme;
use super::stepper::torque_counted;
use super::system::{Link, System};

/// Accuracy below which nothing is promised: a motion is then as exact as rounding lets it be.
const FINEST: f64 = 1e-11;

/// Sizes of the angles whose difference is the twist of each link.
#[derive(Clone, Debug)]
pub struct Rounding {
    sizes: Vec<f64>,
}

impl Rounding {
    /// Of a system that has not moved yet.
    pub fn new(system: &System) -> Self {
        Rounding { sizes: vec![0.0; system.links.len()] }
    }

    /// Takes note of a state.
    pub fn note(&mut self, system: &System, relative: bool, state: &[f64]) {
        let n = system.len();
        let aside = |i: usize| if i == n || (i == 0 && relative) { 0.0 } else { state[i].abs() };
        for (size, link) in self.sizes.iter_mut().zip(&system.links) {
            *size = size.max(link.ratio.abs() * (aside(link.ends[0]) + aside(link.ends[1])));
        }
    }

    /// Whether the torque of some link is lost in it, after some steps, against an accuracy and the extremes of the links.
    pub fn hides(&self, system: &System, steps: usize, accuracy: f64, extremes: &[Extreme]) -> bool {
        let sizes: Vec<f64> = extremes[..self.sizes.len()].iter().map(|row| row[0].max(-row[2])).collect();
        let greatest = sizes.iter().copied().fold(0.0, f64::max);
        let hidden = |((link, size), torque): ((&Link, &f64), &f64)| {
            let lost = link.stiffness * f64::EPSILON * size * (steps as f64).sqrt();
            lost > accuracy.max(FINEST) * torque_counted(*torque, greatest)
        };
        system.links.iter().zip(&self.sizes).zip(&sizes).any(hidden)
    }
}
