//! Equations of motion over the crank angle φ.
//!
//! ```text
//! J_i a_i = M_d(w_i) + Σ T,   J(φ) a + ½ J′(φ) ω² = Σ T − M_r(φ, ω)
//! dδ_i/dφ = v_i/ω,   dv_i/dφ = (a_i − a)/ω,   dω/dφ = a/ω
//! ```
//!
//! with the twist δ_i and the speed v_i = w_i − ω of mass i against the crank: where links are stiff these are small, and known as
//! exactly as the torque of the links. The angle φ is the independent variable, since the mechanism and its kinks are functions of
//! it and the cycle closes there; the crank must turn forward.
//!
//! Source: e.g. Dresig, Holzweißig, *Dynamics of Machinery*, sections 2.3 and 4.3.

use crate::chain::{Chain, Driver};
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::reduce::Reduction;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::dual::Dual;

/// A driver that keeps its speed corrects it within this share of a radian of the crank; the periodic motion has none to correct.
const CORRECTION: f64 = 0.01;

/// The mechanism at one crank angle.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    /// Inertia and loads.
    pub reduced: Reduction<f64>,
    /// What laws need to know there.
    pub geometry: &'a [LawGeometry<f64>],
}

/// A machine with its driveline.
#[derive(Clone, Copy)]
pub struct Equation<'a> {
    /// Its structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [f64],
    /// Its driveline.
    pub chain: &'a Chain,
}

/// Rates of a state by the crank angle, their derivatives by the state, and what they are made of.
#[derive(Clone, Debug)]
pub struct Rates {
    /// Accelerations of all masses \[rad/s²\].
    pub acceleration: Vec<f64>,
    /// dy/dφ.
    pub rate: Vec<f64>,
    /// ∂(dy/dφ)/∂y, row by row.
    pub jacobian: Vec<f64>,
    slopes: Vec<f64>,
}

impl Rates {
    /// Room for a driveline.
    pub fn new(chain: &Chain) -> Self {
        let (n, m) = (chain.masses(), chain.states());
        Rates {
            acceleration: vec![0.0; n],
            rate: vec![0.0; m],
            jacobian: vec![0.0; m * m],
            slopes: vec![0.0; n * m],
        }
    }
}

impl Equation<'_> {
    /// Torque of the motor at a mass with this speed \[N m\], through the gearbox, and its derivative.
    pub fn motor(&self, speed: f64) -> Dual<f64> {
        let drive = &self.plan.drive;
        drive.geared_torque(self.q, drive.motor_torque(&self.plan.tables, self.q, Dual::variable(speed)))
    }

    /// Torque of the loads at the crank \[N m\], and its derivative by the speed.
    pub fn load(&self, row: &Row<'_>, omega: f64) -> Dual<f64> {
        let (plan, r, omega) = (self.plan, &row.reduced, Dual::variable(omega));
        let mut load = omega * r.viscous + Dual::constant(r.load + r.dry);
        if !plan.drive.speed_loads.is_empty() {
            load = load + plan.drive.speed_load(&plan.tables, self.q, omega);
        }
        if !plan.laws.is_empty() {
            // A steady motion knows no time.
            let never = Dual::constant(f64::NAN);
            load = load + plan.law_torque::<f64, f64, Dual<f64>>(self.q, row.geometry, omega, never);
        }
        load
    }

    /// Accelerations of a state, with their derivatives.
    fn accelerations(&self, row: &Row<'_>, y: &[f64], like: Option<&[f64]>, to: &mut Rates) {
        let chain = self.chain;
        let (n, m, crank) = (chain.masses(), chain.states(), chain.masses() - 1);
        to.acceleration.fill(0.0);
        to.slopes.fill(0.0);
        for link in &chain.links {
            let torque = like.map_or_else(|| chain.torque(link, y), |near| chain.torque_like(link, y, near));
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                to.acceleration[mass] += sign * torque.value;
                let slopes = &mut to.slopes[mass * m..][..m];
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < crank {
                        slopes[end] += side * torque.by_twist;
                        slopes[crank + end] += side * torque.by_rate;
                    }
                }
            }
        }
        let speed = chain.speed(chain.driven, y);
        if let Driver::Motor = chain.driver {
            let motor = self.motor(speed);
            to.acceleration[chain.driven] += motor.value;
            self.add_speed_slope(chain.driven, motor.d, &mut to.slopes);
        }
        let (r, omega) = (&row.reduced, y[m - 1]);
        let load = self.load(row, omega);
        to.acceleration[crank] -= load.value + 0.5 * r.J_d1 * omega * omega;
        to.slopes[crank * m + m - 1] -= load.d + r.J_d1 * omega;
        for mass in 0..n {
            let inverse = 1.0 / if mass == crank { r.J - chain.apart } else { chain.inertia[mass] };
            to.acceleration[mass] *= inverse;
            to.slopes[mass * m..][..m].iter_mut().for_each(|slope| *slope *= inverse);
        }
        if let Driver::Held(held) = chain.driver {
            let rate = held / CORRECTION;
            to.acceleration[chain.driven] = rate * (held - speed);
            to.slopes[chain.driven * m..][..m].fill(0.0);
            self.add_speed_slope(chain.driven, -rate, &mut to.slopes);
        }
    }

    /// Adds the derivative of something that acts on a mass by the speed of that mass.
    fn add_speed_slope(&self, mass: usize, slope: f64, slopes: &mut [f64]) {
        let (m, crank) = (self.chain.states(), self.chain.masses() - 1);
        slopes[mass * m + m - 1] += slope;
        if mass < crank {
            slopes[mass * m + crank + mass] += slope;
        }
    }

    /// Rates of a state and their Jacobian.
    pub fn rates(&self, row: &Row<'_>, y: &[f64], to: &mut Rates) {
        self.rates_like(row, y, None, to);
    }

    /// The same with laws of links in the form that they have at another state: on a kink, that of the side on which it lies.
    pub fn rates_like(&self, row: &Row<'_>, y: &[f64], like: Option<&[f64]>, to: &mut Rates) {
        self.accelerations(row, y, like, to);
        let (m, crank) = (self.chain.states(), self.chain.masses() - 1);
        let inverse = 1.0 / y[m - 1];
        let a = to.acceleration[crank];
        to.jacobian.fill(0.0);
        let (others, own) = to.slopes.split_at(crank * m);
        for mass in 0..crank {
            let v = y[crank + mass];
            to.rate[mass] = v * inverse;
            to.jacobian[mass * m + crank + mass] = inverse;
            to.jacobian[mass * m + m - 1] = -v * inverse * inverse;
            let row = crank + mass;
            to.rate[row] = (to.acceleration[mass] - a) * inverse;
            for j in 0..m {
                to.jacobian[row * m + j] = (others[mass * m + j] - own[j]) * inverse;
            }
            to.jacobian[row * m + m - 1] -= to.rate[row] * inverse;
        }
        to.rate[m - 1] = a * inverse;
        for j in 0..m {
            to.jacobian[(m - 1) * m + j] = own[j] * inverse;
        }
        to.jacobian[m * m - 1] -= to.rate[m - 1] * inverse;
    }
}
