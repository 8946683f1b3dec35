//! Speed controllers: proportional and integral, with a limit of the torque.
//!
//! ```text
//! e = ω_s(t) − ω        u = M₀ + k_p (e + v)        M = u within the limits
//! dv/dt = (e + (M − u)/k_p)/T_i                     T_i = k_p/k_i
//! ```
//!
//! At a limit the integral follows what the limit lets through, with its own time constant, and does not wind up. Its state
//! v is the speed of a mass that nothing else moves.
//!
//! Source: Åström and Hägglund, *PID Controllers: Theory, Design, and Tuning*, 2nd ed. 1995, section 3.5: back-calculation.

use super::curve::Curve;
use super::torque::Stretch;

/// A controller of the speed of a mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    pub mass: usize,
    /// The mass whose speed is v.
    pub integral: usize,
    /// Speed of the part over that of the mass.
    pub ratio: f64,
    /// k_p \[N m s/rad\]
    pub gain: f64,
    /// k_i/k_p \[1/s\]
    pub inverse_time: f64,
    /// M₀ \[N m\]
    pub offset: f64,
    /// Without bound where there is none \[N m\].
    pub limit: f64,
    /// Curve of ω_s over time.
    pub set_point: usize,
}

/// Torque on the mass, dv/dt, and whether the torque is within its limits.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    pub torque: f64,
    pub rate: f64,
    pub is_free: bool,
}

impl Controller {
    /// At a time, from the speed of its mass and v.
    pub fn at(&self, curves: &[Curve], stretch: &Stretch, t: f64, [omega, v]: [f64; 2]) -> Command {
        let missing = stretch.at(curves, self.set_point, t) - self.ratio * omega;
        let wanted = self.offset + self.gain * (missing + v);
        let torque = wanted.clamp(-self.limit, self.limit);
        let rate = (missing + (torque - wanted) / self.gain) * self.inverse_time;
        Command { torque: self.ratio * torque, rate, is_free: torque == wanted }
    }

    /// Derivatives of the torque and of dv/dt by the speed of its mass and by v.
    pub fn slopes(&self, is_free: bool) -> [[f64; 2]; 2] {
        let Controller { ratio: n, gain, inverse_time, .. } = *self;
        if is_free {
            [[-n * n * gain, n * gain], [-n * inverse_time, 0.0]]
        } else {
            [[0.0; 2], [0.0, -inverse_time]]
        }
    }
}
