//! Centrifugal pendulums that swing without rotation of their own (bifilar), exactly for any swing.
//!
//! The mass m moves on a circle of the radius l about a point of its disc at the radius R. With the angle χ = θ + ψ l/(R + l)
//! beside that of the disc, θ, and u = 1 − cos ψ,
//!
//! ```text
//! T = ½ (J + 2mR² u) θ̇² − mR(R + l) u θ̇χ̇ + ½ m(R + l)² χ̇²        ψ = (χ − θ)(R + l)/l
//! ```
//!
//! For small swings u vanishes: a ring of m(R + l)², which Ω² drives back, as linear vibration has it.
//!
//! Source: Den Hartog, *Mechanical Vibrations*, 4th ed. 1956, ch. 5; kinetic energy of a point on two circles, Lagrange.

/// A pendulum: mass of its disc, and mass that its angle χ is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    pub disc: usize,
    pub bob: usize,
    /// 2mR² and −mR(R + l), times the square of the speed of the disc over that of its mass \[kg m²\].
    pub of_disc: f64,
    pub of_both: f64,
    /// ψ over χ − θ of the masses.
    pub swing: f64,
}

/// What it adds at an instant: to the inertia of its disc and between both, and torques on both.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Added {
    pub(super) disc: f64,
    pub(super) both: f64,
    pub(super) torque: [f64; 2],
}

impl Pendulum {
    /// Of a mass on two radii, R and l, on a disc `ratio` times as fast as its mass.
    pub fn new([disc, bob]: [usize; 2], ratio: f64, mass: f64, [radius, length]: [f64; 2]) -> Self {
        let scale = ratio * ratio * mass * radius;
        Pendulum {
            disc,
            bob,
            of_disc: 2.0 * scale * radius,
            of_both: -scale * (radius + length),
            swing: ratio * (radius + length) / length,
        }
    }

    /// From the lead of χ over θ and both speeds.
    pub(super) fn at(&self, lead: f64, [theta, chi]: [f64; 2]) -> Added {
        let (sine, u) = of_swing(self.swing * lead);
        let (a, b, s) = (self.of_disc, self.of_both, self.swing);
        let rate = s * (chi - theta);
        let lagrange = s * sine * (0.5 * a * theta + b * chi) * theta;
        Added {
            disc: a * u,
            both: b * u,
            torque: [
                -(sine * rate * (a * theta + b * chi) + lagrange),
                -(sine * rate * b * theta - lagrange),
            ],
        }
    }

    /// Kinetic energy beyond that of the disc and the ring.
    pub fn energy(&self, lead: f64, [theta, chi]: [f64; 2]) -> f64 {
        let (_, u) = of_swing(self.swing * lead);
        u * theta * (0.5 * self.of_disc * theta + self.of_both * chi)
    }

    /// Derivatives of the torques on both by the lead of χ and by both speeds, at accelerations of both: of all that depends on
    /// the swing, inertias included.
    pub(super) fn slopes(&self, lead: f64, [theta, chi]: [f64; 2], [disc, bob]: [f64; 2]) -> [[f64; 3]; 2] {
        let (psi, s) = (self.swing * lead, self.swing);
        let (a, b, rate) = (self.of_disc, self.of_both, self.swing * (chi - theta));
        let (sine, cosine) = psi.sin_cos();
        let lagrange = (0.5 * a * theta + b * chi) * theta;
        let both = a * theta + b * chi;
        [
            [
                -s * (sine * (a * disc + b * bob) + cosine * (rate * both + s * lagrange)),
                -sine * rate * a,
                -sine * (s * both + rate * b + s * b * theta),
            ],
            [
                -s * (sine * b * disc + cosine * (rate * b * theta - s * lagrange)),
                -sine * (b * (rate - s * theta) - s * both),
                0.0,
            ],
        ]
    }
}

/// sin ψ and 1 − cos ψ, which keeps its digits.
fn of_swing(psi: f64) -> (f64, f64) {
    let half = (0.5 * psi).sin();
    (psi.sin(), 2.0 * half * half)
}
