//! The equation of motion of the crank, and the balance of torques at standstill.

use super::reduced::{Reduced, ReducedCurves};
use crate::drive::equation::Machine;
use crate::drive::law::{LawGeometry, SpeedKink};
use crate::drive::steep::Steepness;
use crate::kernel::dual::Dual;
use crate::kernel::plane::Angle;
use crate::kernel::real::Lift;
use crate::linkage::motion::Motion;

/// Angle and speed of the crank in the direction in which it turns.
pub type Y = [f64; 2];

/// Difference of speeds, as a share of the working speed, that rounding may leave.
pub(super) const AT_REST: f64 = 1e-11;

/// Directions of rotation: +1 counter-clockwise, −1 clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// In which the crank turns, or starts to from rest.
    pub crank: f64,
    /// In which the motor drives the crank.
    pub motor: f64,
}

impl Turning {
    /// The crank turns counter-clockwise, and the motor drives it so.
    pub const FORWARD: Turning = Turning { crank: 1.0, motor: 1.0 };

    /// +1 where the crank turns as the motor drives it, −1 where it turns against it.
    pub fn with_motor(self) -> f64 {
        self.crank * self.motor
    }
}

/// Distance of the speed from a jump of a law, as a share, at which its two sides are looked at.
const ASIDE: f64 = 1e-6;

/// What the motion comes to where a law may jump.
#[derive(Clone, Copy, Debug)]
pub struct Jump {
    /// By how much the acceleration changes from the lower speed to the higher, or at one over time alone \[rad/s²\].
    pub leap: f64,
    /// Whether the torques of both sides drive the motion back to it.
    pub holds: bool,
}

/// A machine with room for what its equation of motion needs.
pub struct Equation<'a> {
    pub machine: Machine<'a, f64>,
    /// Kinks and jumps of laws whose angle depends on the speed.
    pub law_kinks: Vec<SpeedKink>,
    pub motion: Motion<f64>,
    pub geometry: Vec<LawGeometry<f64>>,
    pub speed_scale: f64,
    pub turning: Turning,
    pub evaluations: usize,
    /// The machine over the angle, where polynomials can do.
    pub(super) curves: Option<ReducedCurves>,
    /// Laws that may be steep over speed or time.
    pub(super) steep: Vec<Steepness<'a>>,
}

impl Equation<'_> {
    /// (ω, ε)
    pub fn derivative(&mut self, t: f64, y: &Y) -> Y {
        let Machine { plan, q, .. } = self.machine;
        self.evaluations += 1;
        let (sense, along) = (self.turning.crank, self.turning.with_motor());
        let (phi, speed) = (sense * y[0], y[1]);
        let [J, J_d1, load, viscous] = self.reduced(phi);
        let mut resisting = load + viscous * speed;
        if !plan.laws.is_empty() {
            resisting += sense * self.laws(t, phi, sense * speed);
        }
        let drive = plan.drive.torque_turning(&plan.tables, q, speed, along);
        let net = drive - resisting - 0.5 * sense * J_d1 * speed * speed;
        [speed, net / J]
    }

    /// The machine at a crank angle.
    fn reduced(&mut self, phi: f64) -> Reduced {
        let Machine { plan, q, .. } = self.machine;
        if let Some(found) = self.curves.as_mut().and_then(|curves| curves.at(plan, q, phi)) {
            return found;
        }
        let sense = self.turning.crank;
        let r = plan.reduce::<f64, 2>(q, Angle::new(phi), sense, &mut self.motion);
        [r.J, r.J_d1, sense * r.load + r.dry, r.viscous]
    }

    /// ε, and ∂ε/∂ω.
    pub fn acceleration(&mut self, t: f64, y: &Y) -> (f64, f64) {
        let Machine { plan, q, .. } = self.machine;
        self.evaluations += 1;
        let (sense, along) = (self.turning.crank, self.turning.with_motor());
        let (phi, speed) = (sense * y[0], Dual::variable(y[1]));
        let [J, J_d1, load, viscous] = self.reduced(phi);
        let mut net = plan.drive.torque_turning(&plan.tables, q, speed, along)
            - Dual::constant(load)
            - speed * viscous
            - speed * speed * (0.5 * sense * J_d1);
        if !plan.laws.is_empty() {
            net = net - self.laws(Dual::constant(t), phi, speed * sense) * sense;
        }
        (net.value / J, net.d / J)
    }

    /// The quantities whose zeros are kinks of laws, at a time and a state.
    pub fn at_law_kinks(&mut self, t: f64, y: &Y) -> Vec<f64> {
        if self.law_kinks.is_empty() {
            return Vec::new();
        }
        let Machine { plan, q, .. } = self.machine;
        let phi = self.turning.crank * y[0];
        plan.reduce::<f64, 2>(q, Angle::new(phi), self.turning.crank, &mut self.motion);
        self.geometry.clear();
        plan.add_geometry(q, phi, &self.motion, &mut self.geometry);
        let omega = self.turning.crank * y[1];
        let value = |&kink: &SpeedKink| plan.speed_kink_value(q, kink, &self.geometry, [omega, t]);
        self.law_kinks.iter().map(value).collect()
    }

    /// The kink of a law with a number, at a state that lies on it. Beside it the quantity whose zero it is goes with
    /// g_φ ω + g_ω ε.
    pub fn jump(&mut self, nth: usize, t: f64, y: &Y) -> Jump {
        let near = |share: f64| [y[0], y[1] * (1.0 + share)];
        let by_omega = self.at_law_kinks(t, &near(ASIDE))[nth] - self.at_law_kinks(t, &near(-ASIDE))[nth];
        let by_omega = by_omega / (2.0 * ASIDE * y[1]);
        let turned = |angle: f64| [y[0] + angle, y[1]];
        let by_phi = self.at_law_kinks(t, &turned(ASIDE))[nth] - self.at_law_kinks(t, &turned(-ASIDE))[nth];
        let by_phi = by_phi / (2.0 * ASIDE);
        let [below, above] = [-ASIDE, ASIDE]
            .map(|side| 2.0 * self.derivative(t, &near(side))[1] - self.derivative(t, &near(2.0 * side))[1]);
        // How fast the speed leaves the kink on either side.
        let [from_below, from_above] = [below, above].map(|epsilon| epsilon + by_phi / by_omega * y[1]);
        // One over time has both its sides at the same speed.
        let later = ASIDE / self.speed_scale;
        let [before, behind] = [-later, later]
            .map(|by| 2.0 * self.derivative(t + by, y)[1] - self.derivative(t + 2.0 * by, y)[1]);
        let leap = if by_omega == 0.0 { behind - before } else { above - below };
        Jump { leap, holds: from_below > 0.0 && from_above < 0.0 }
    }

    /// Torque of the laws at an angle for which the mechanism has been placed.
    #[inline(never)]
    fn laws<N: Lift<f64>>(&mut self, t: N, phi: f64, omega: N) -> N {
        let Machine { plan, q, .. } = self.machine;
        self.geometry.clear();
        plan.add_geometry(q, phi, &self.motion, &mut self.geometry);
        plan.law_torque::<f64, f64, N>(q, &self.geometry, omega, t)
    }

    /// Drive's and needed torque at standstill, and which way the machine goes from there: +1 as it turned, 0
    /// or −1 back. Laws count as at a vanishing speed in that direction, so that one with a jump at rest holds there.
    pub fn balance_at_rest(&mut self, t: f64, angle: f64) -> (f64, f64, i8) {
        let Machine { plan, q, .. } = self.machine;
        let (sense, along) = (self.turning.crank, self.turning.with_motor());
        let phi = sense * angle;
        let slow = AT_REST * self.speed_scale;
        let mut ahead = plan.reduce::<f64, 1>(q, Angle::new(phi), sense, &mut self.motion);
        ahead.load = sense * (ahead.load + self.laws(t, phi, sense * slow));
        let mut back = plan.reduce::<f64, 1>(q, Angle::new(phi), -sense, &mut self.motion);
        back.load = sense * (back.load + self.laws(t, phi, -sense * slow));
        let drive = plan.drive.geared_torque(q, along * plan.drive.motor_torque(&plan.tables, q, 0.0));
        // At rest a load over speed holds in either direction, like a dry one; a driving one drives.
        let over_speed: f64 = plan.drive.speed_load(&plan.tables, q, 0.0);
        let holding = over_speed.max(0.0);
        let free = drive - over_speed.min(0.0);
        let way = if free - ahead.load > ahead.dry + holding {
            1
        } else if free - back.load < -(back.dry + holding) {
            -1
        } else {
            0
        };
        (drive, ahead.load + ahead.dry + over_speed, way)
    }
}
