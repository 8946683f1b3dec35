//! Pendulums in the equations of motion: their torques, and the inertia that they share with their discs.

use super::pendulums::{Added, Pendulum};
use super::rates::Rates;

impl Rates<'_> {
    /// Lead of χ over θ, and both speeds, of a pendulum at the instant.
    fn swing(&self, pendulum: &Pendulum) -> (f64, [f64; 2]) {
        let Pendulum { disc, bob, .. } = *pendulum;
        (self.aside[bob + 1] - self.aside[disc + 1], [self.omega[disc], self.omega[bob]])
    }

    /// Torques of the pendulums on the masses, and what they add to inertias.
    pub(super) fn swing_pendulums(&mut self) {
        let system = self.system;
        self.bobs.clear();
        for pendulum in &system.pendulums {
            let (lead, speeds) = self.swing(pendulum);
            let Added { disc, both, torque } = pendulum.at(lead, speeds);
            self.outer[pendulum.disc] += torque[0];
            self.outer[pendulum.bob] += torque[1];
            self.bobs.push([disc, both]);
        }
    }

    /// Accelerations of the masses from those that torque over own inertia would give: each disc feels its pendulums.
    pub(super) fn share_with_pendulums(&self, acceleration: &mut [f64]) {
        let (pendulums, inertia) = (&self.system.pendulums, &self.inertia);
        for (first, one) in pendulums.iter().enumerate() {
            if pendulums[..first].iter().any(|other| other.disc == one.disc) {
                continue;
            }
            let on_disc = || pendulums.iter().zip(&self.bobs).filter(|(other, _)| other.disc == one.disc);
            let i = one.disc;
            let (mut own, mut torque) = (inertia[i], inertia[i] * acceleration[i]);
            for (pendulum, [disc, both]) in on_disc() {
                own += disc - both * both / inertia[pendulum.bob];
                torque -= both * acceleration[pendulum.bob];
            }
            acceleration[i] = torque / own;
            for (pendulum, [_, both]) in on_disc() {
                acceleration[pendulum.bob] -= both / inertia[pendulum.bob] * acceleration[i];
            }
        }
    }

    /// Inertia torque of a mass at accelerations, beyond its own inertia times its acceleration.
    pub(super) fn torque_of_bobs(&self, mass: usize, acceleration: impl Fn(usize) -> f64) -> f64 {
        let of = |(pendulum, [disc, both]): (&Pendulum, &[f64; 2])| match mass {
            i if i == pendulum.disc => disc * acceleration(i) + both * acceleration(pendulum.bob),
            i if i == pendulum.bob => both * acceleration(pendulum.disc),
            _ => 0.0,
        };
        self.system.pendulums.iter().zip(&self.bobs).map(of).sum()
    }

    /// Adds to the derivatives of the torques, row by row, by angles and speeds.
    pub(super) fn pendulum_slopes(&self, by_angle: &mut [f64], by_speed: &mut [f64]) {
        let n = self.system.len();
        for pendulum in &self.system.pendulums {
            let [i, j] = [pendulum.disc, pendulum.bob];
            let (lead, speeds) = self.swing(pendulum);
            let slopes = pendulum.slopes(lead, speeds, [self.acceleration[i], self.acceleration[j]]);
            for (row, [by_lead, by_disc, by_bob]) in [i, j].into_iter().zip(slopes) {
                by_angle[row * n + j] += by_lead;
                by_angle[row * n + i] -= by_lead;
                by_speed[row * n + i] += by_disc;
                by_speed[row * n + j] += by_bob;
            }
        }
    }
}
