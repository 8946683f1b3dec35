//! What another program applies: a torque on the crank, a brake, and a load that turns at a speed of its own behind a coupling, which
//! transmits a torque in proportion to the difference of speeds.
//!
//! ```text
//! T = T_e + c (ω_L − ω)
//! ```

use linkwright_kernel::dual::Dual;
use linkwright_kernel::real::Real;
use serde::{Deserialize, Serialize};

/// Torques and speeds from outside, counter-clockwise positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outside<N> {
    /// Torque on the crank \[N m\].
    pub torque: N,
    /// Torque of the brake, referred to the crank \[N m\].
    pub brake: N,
    /// Speed of the load behind the coupling \[rad/s\].
    pub speed: N,
    /// Torque of the coupling per difference of speeds \[N m s\].
    pub coupling: N,
}

impl<N: Real> Outside<N> {
    /// Torque of the coupling on the crank at its speed.
    pub fn coupled(&self, omega: N) -> N {
        self.coupling * (self.speed - omega)
    }

    /// A part by its number.
    pub fn part(&mut self, n: usize) -> Option<&mut N> {
        [&mut self.torque, &mut self.brake, &mut self.speed, &mut self.coupling].into_iter().nth(n)
    }
}

impl Outside<f64> {
    /// With derivatives, which are zero so far.
    pub fn lifted(self) -> Outside<Dual<f64>> {
        let [torque, brake, speed, coupling] =
            [self.torque, self.brake, self.speed, self.coupling].map(Dual::constant);
        Outside { torque, brake, speed, coupling }
    }
}
