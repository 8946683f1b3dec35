//! A link at one instant: its twist, and how the masses that it joins change that.
//!
//! ```text
//! Δ = n(θ_a − θ_b) + (ψ − φ)        behind a Hooke's joint, tan ψ = tan φ/cos α, φ = nθ_a + β
//! Δ = Σ s_i θ_i                      of a mesh whose bearings a third mass carries
//! ```
//!
//! By virtual work the torque T of the twist acts on each mass with −T ∂Δ/∂θ_i: behind a joint the first end feels ψ′T.
//!
//! Sources: Willis, *Principles of Mechanism* (1841), for meshes on a carrier; Seherr-Thoss, Schmelz and Aucktor, *Universal
//! Joints and Driveshafts*, ch. 1, for the joint. Damping in contact: Modelica Standard Library, Rotational, ElastoBacklash.

use super::system::{Joint, Link, System};

/// Masses that a link joins, with the ground instead of one that is missing, and its twist.
#[derive(Clone, Copy, Debug)]
pub struct Bond {
    pub masses: [usize; 3],
    /// ∂Δ/∂θ of each mass.
    pub gradient: [f64; 3],
    pub twist: f64,
    pub rate: f64,
    /// Change of the gradient at the first end with its angle: ψ″n².
    pub bend: f64,
    /// Whether both ends count alike.
    is_pair: bool,
}

/// Torque of the teeth or of the twist, and its parts.
#[derive(Clone, Copy, Debug, Default)]
pub struct BondTorque {
    pub torque: f64,
    /// Of the damper.
    pub friction: f64,
    /// Derivatives by twist and by its rate.
    pub by_twist: f64,
    pub by_rate: f64,
}

impl Joint {
    /// ψ − φ, ψ′ and ψ″ at an angle.
    fn at(&self, phi: f64) -> [f64; 3] {
        let (s, c) = phi.sin_cos();
        let k = self.cosine;
        let below = k * k * c * c + s * s;
        let ahead = ((1.0 - k) * s * c).atan2(k * c * c + s * s);
        [ahead, k / below, -k * 2.0 * s * c * (1.0 - k * k) / (below * below)]
    }
}

impl Link {
    /// Whether it is a spring and a damper between two masses, and no more.
    pub fn is_plain(&self) -> bool {
        self.curve.is_none() && self.manner == super::system::Manner::default()
    }

    /// Masses of its two ends and of what carries it; the ground where there is none.
    pub fn masses(&self, ground: usize) -> [usize; 3] {
        let [a, b] = self.ends;
        [a, b, self.manner.carrier.map_or(ground, |carrier| carrier.mass)]
    }

    /// Parts of their angles in the twist, but for a joint.
    pub fn shares(&self) -> [f64; 3] {
        self.manner.carrier.map_or([self.ratio, -self.ratio, 0.0], |carrier| carrier.shares)
    }

    /// At an instant: from angles and speeds of the masses, less those of the first where they are counted from it, and from the
    /// angle of the first end itself.
    #[inline(always)]
    pub fn bond(
        &self,
        ground: usize,
        angle: impl Fn(usize) -> f64,
        speed: impl Fn(usize) -> f64,
        lead: impl Fn(usize) -> [f64; 2],
    ) -> Bond {
        let (masses, mut gradient) = (self.masses(ground), self.shares());
        let at = |mass: usize, of: &dyn Fn(usize) -> f64| if mass == ground { 0.0 } else { of(mass) };
        let [mut twist, mut rate] = [&angle as &dyn Fn(usize) -> f64, &speed].map(|of| {
            let [a, b, c] = masses.map(|mass| at(mass, of));
            // Of nearly equal angles the difference keeps its digits.
            if self.manner.carrier.is_none() {
                self.ratio * (a - b)
            } else {
                gradient[0] * a + gradient[1] * b + gradient[2] * c
            }
        });
        let mut bend = 0.0;
        if let Some(joint) = self.manner.joint {
            let [theta, omega] = lead(masses[0]);
            let [ahead, d1, d2] = joint.at(self.ratio * theta + joint.phase);
            twist += ahead;
            rate += self.ratio * (d1 - 1.0) * omega;
            gradient[0] = self.ratio * d1;
            bend = self.ratio * self.ratio * d2;
        }
        let is_pair = self.manner.carrier.is_none() && self.manner.joint.is_none();
        Bond { masses, gradient, twist, rate, bend, is_pair }
    }

    /// Torque at a twist and its rate; none of what is rigid.
    #[inline(always)]
    pub fn pulls(&self, system: &System, twist: f64, rate: f64) -> BondTorque {
        let (curved, slope) = match self.curve {
            None => (0.0, 0.0),
            Some(curve) => system.curves[curve].at(twist),
        };
        let (elastic, by_twist) = (self.stiffness * twist + curved, self.stiffness + slope);
        let friction = self.damping * rate;
        if self.manner.contact && friction.abs() > elastic.abs() {
            // At the limit the damper doubles the torque of the flanks or takes all of it.
            let sense = if friction * elastic > 0.0 { 1.0 } else { -1.0 };
            return BondTorque {
                torque: elastic + sense * elastic,
                friction: sense * elastic,
                by_twist: by_twist * (1.0 + sense),
                by_rate: 0.0,
            };
        }
        BondTorque { torque: elastic + friction, friction, by_twist, by_rate: self.damping }
    }
}

impl Bond {
    /// Second derivative of the twist from the accelerations of the masses, and the speed of the first end.
    pub fn twist_acceleration(&self, acceleration: impl Fn(usize) -> f64, omega: f64) -> f64 {
        let [a, b, c] = self.masses.map(acceleration);
        if self.is_pair {
            return self.gradient[0] * (a - b);
        }
        let [by_a, by_b, by_c] = self.gradient;
        by_a * a + by_b * b + by_c * c + self.bend * omega * omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ψ of the joint solves its equation over a revolution, goes on behind a right angle, and its slopes are those of ψ.
    #[test]
    fn joint_turns_by_its_equation() {
        let joint = Joint { cosine: 0.8, phase: 0.0 };
        let (step, psi) = (1e-5, |phi: f64| phi + joint.at(phi)[0]);
        for i in 0..60 {
            let phi = -3.0 + 0.17 * f64::from(i);
            let [_, d1, d2] = joint.at(phi);
            assert!(
                (psi(phi).tan() * 0.8 - phi.tan()).abs() < 1e-9 * (1.0 + phi.tan().abs().powi(2)),
                "at {phi}"
            );
            assert!((psi(phi) - phi).abs() < 0.2, "no jump at {phi}");
            assert!(((psi(phi + step) - psi(phi - step)) / (2.0 * step) - d1).abs() < 1e-9, "slope at {phi}");
            let turned = (joint.at(phi + step)[1] - joint.at(phi - step)[1]) / (2.0 * step);
            assert!((turned - d2).abs() < 1e-8, "bend at {phi}");
        }
    }
}
