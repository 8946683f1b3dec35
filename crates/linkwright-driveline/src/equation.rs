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
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;

/// A driver that keeps its speed corrects it within this share of a radian of the crank; the periodic motion has none to correct.
const CORRECTION: f64 = 0.01;

/// The mechanism at one crank angle.
#[derive(Clone, Copy)]
pub struct Row<'a, N = f64> {
    /// Inertia and loads.
    pub reduced: Reduction<N>,
    /// What laws need to know there.
    pub geometry: &'a [LawGeometry<N>],
}

/// A machine with its driveline.
#[derive(Clone, Copy)]
pub struct Equation<'a, N = f64> {
    /// Its structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [N],
    /// Its driveline.
    pub chain: &'a Chain<N>,
}

/// Rates of a state by the crank angle, their derivatives by the state, and what they are made of.
#[derive(Clone, Debug)]
pub struct Rates<N = f64> {
    /// Accelerations of all masses \[rad/s²\].
    pub acceleration: Vec<N>,
    /// dy/dφ.
    pub rate: Vec<N>,
    /// ∂(dy/dφ)/∂y, row by row.
    pub jacobian: Vec<N>,
    slopes: Vec<N>,
}

impl<N: Real> Rates<N> {
    /// Room for a driveline.
    pub fn new(chain: &Chain<N>) -> Self {
        let (n, m, zero) = (chain.masses(), chain.states(), N::splat(0.0));
        Rates {
            acceleration: vec![zero; n],
            rate: vec![zero; m],
            jacobian: vec![zero; m * m],
            slopes: vec![zero; n * m],
        }
    }
}

impl<N: Real> Equation<'_, N> {
    /// Torque of the motor at a mass with this speed \[N m\], through the gearbox, and its derivative.
    #[inline(always)]
    pub fn motor(&self, speed: N) -> Dual<N> {
        let drive = &self.plan.drive;
        drive.geared_torque(self.q, drive.motor_torque(&self.plan.tables, self.q, Dual::variable(speed)))
    }

    /// Torque of the loads at the crank \[N m\], and its derivative by the speed.
    #[inline(always)]
    pub fn load(&self, row: &Row<'_, N>, omega: N) -> Dual<N> {
        let (plan, r, omega) = (self.plan, &row.reduced, Dual::variable(omega));
        let mut load = omega * Dual::constant(r.viscous) + Dual::constant(r.load + r.dry);
        if !plan.drive.speed_loads.is_empty() {
            load = load + plan.drive.speed_load(&plan.tables, self.q, omega);
        }
        if !plan.laws.is_empty() {
            // A steady motion knows no time.
            let never = Dual::splat(f64::NAN);
            load = load + plan.law_torque::<N, N, Dual<N>>(self.q, row.geometry, omega, never);
        }
        load
    }

    /// Accelerations of a state, with their derivatives.
    #[inline(always)]
    fn accelerations(&self, row: &Row<'_, N>, y: &[N], to: &mut Rates<N>) {
        let chain = self.chain;
        let (n, m, crank) = (chain.masses(), chain.states(), chain.masses() - 1);
        to.acceleration.fill(N::splat(0.0));
        to.slopes.fill(N::splat(0.0));
        for link in &chain.links {
            let torque = chain.torque(link, y);
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                to.acceleration[mass] = to.acceleration[mass] + torque * sign;
                let slopes = &mut to.slopes[mass * m..][..m];
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < crank {
                        slopes[end] = slopes[end] + link.stiffness * side;
                        slopes[crank + end] = slopes[crank + end] + link.damping * side;
                    }
                }
            }
        }
        let speed = chain.speed(chain.driven, y);
        if let Driver::Motor = chain.driver {
            let motor = self.motor(speed);
            to.acceleration[chain.driven] = to.acceleration[chain.driven] + motor.value;
            self.add_speed_slope(chain.driven, motor.d, &mut to.slopes);
        }
        let (r, omega) = (&row.reduced, y[m - 1]);
        let load = self.load(row, omega);
        to.acceleration[crank] = to.acceleration[crank] - (load.value + r.J_d1 * omega * omega * 0.5);
        self.add_speed_slope(crank, -(load.d + r.J_d1 * omega), &mut to.slopes);
        for mass in 0..n {
            let inverse = (if mass == crank { r.J - chain.apart } else { chain.inertia[mass] }).recip();
            to.acceleration[mass] = to.acceleration[mass] * inverse;
            for slope in &mut to.slopes[mass * m..][..m] {
                *slope = *slope * inverse;
            }
        }
        if let Driver::Held(held) = chain.driver {
            let rate = held * (1.0 / CORRECTION);
            to.acceleration[chain.driven] = rate * (held - speed);
            to.slopes[chain.driven * m..][..m].fill(N::splat(0.0));
            self.add_speed_slope(chain.driven, -rate, &mut to.slopes);
        }
    }

    /// Adds the derivative of something that acts on a mass by the speed of that mass.
    #[inline(always)]
    fn add_speed_slope(&self, mass: usize, slope: N, slopes: &mut [N]) {
        let (m, crank) = (self.chain.states(), self.chain.masses() - 1);
        let mut add = |at: usize| slopes[at] = slopes[at] + slope;
        add(mass * m + m - 1);
        if mass < crank {
            add(mass * m + crank + mass);
        }
    }

    /// Rates of a state and their Jacobian.
    #[inline(always)]
    pub fn rates(&self, row: &Row<'_, N>, y: &[N], to: &mut Rates<N>) {
        out_of_line!(N, self.rates_inline(row, y, to));
    }

    #[inline(always)]
    fn rates_inline(&self, row: &Row<'_, N>, y: &[N], to: &mut Rates<N>) {
        self.accelerations(row, y, to);
        let (m, crank) = (self.chain.states(), self.chain.masses() - 1);
        let inverse = y[m - 1].recip();
        let a = to.acceleration[crank];
        to.jacobian.fill(N::splat(0.0));
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
            to.jacobian[row * m + m - 1] = to.jacobian[row * m + m - 1] - to.rate[row] * inverse;
        }
        to.rate[m - 1] = a * inverse;
        for j in 0..m {
            to.jacobian[(m - 1) * m + j] = own[j] * inverse;
        }
        to.jacobian[m * m - 1] = to.jacobian[m * m - 1] - to.rate[m - 1] * inverse;
    }
}
