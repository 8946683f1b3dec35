//! Equations of motion over the crank angle φ.
//!
//! ```text
//! J_i a_i = M_d(w_i) + Σ T,   J(φ) a + ½ J′(φ) ω² = Σ T − M_r(φ, ω)
//! dδ_i/dφ = v_i/ω,   dv_i/dφ = (a_i − a)/ω,   dω/dφ = a/ω
//! ```
//!
//! with the twist δ_i and the speed v_i = w_i − ω of mass i against the crank: where links are stiff these are small, and known as
//! exactly as the torque of the links. The angle φ is the independent variable, since the mechanism and its kinks are functions of
//! it and the cycle closes there; the crank must turn forward. Further mechanisms are where the twists have them ([`crate::station`]).
//!
//! Source: e.g. Dresig, Holzweißig, *Dynamics of Machinery*, sections 2.3 and 4.3.

use crate::chain::{Chain, Source, Torque};
use crate::station::{Felt, Place};
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::reduce::Reduction;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::dual::Dual;

/// A driver that keeps its speed corrects it within this share of a radian of the crank; the periodic motion has none to correct.
const CORRECTION: f64 = 0.01;

/// The mechanism at one crank angle.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    /// The angle \[rad\].
    pub phi: f64,
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
pub struct Rates {
    /// Accelerations of all masses \[rad/s²\].
    pub acceleration: Vec<f64>,
    /// Torques of the drivers on their masses \[N m\].
    pub drive: Vec<f64>,
    /// Torque of all loads, referred to the crank \[N m\].
    pub load: f64,
    /// Power that loads and damping from outside take \[W\].
    pub load_power: f64,
    /// dy/dφ.
    pub rate: Vec<f64>,
    /// ∂(dy/dφ)/∂y, row by row.
    pub jacobian: Vec<f64>,
    slopes: Vec<f64>,
    /// Inertias of the masses, and their derivatives by the angles of the masses.
    inertia: Vec<[f64; 2]>,
    places: Vec<Place>,
}

impl Rates {
    /// Room for a driveline.
    pub fn new(chain: &Chain) -> Self {
        let (n, m) = (chain.masses(), chain.states());
        Rates {
            acceleration: vec![0.0; n],
            drive: vec![0.0; chain.drivers.len()],
            load: 0.0,
            load_power: 0.0,
            rate: vec![0.0; m],
            jacobian: vec![0.0; m * m],
            slopes: vec![0.0; n * m],
            inertia: vec![[0.0; 2]; n],
            places: chain.stations.iter().map(Place::new).collect(),
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

    /// Torque on a mass with this speed from outside \[N m\], and its derivative; nothing of one that keeps its speed.
    fn outside(&self, torque: &Torque, speed: f64) -> Dual<f64> {
        match &torque.source {
            Source::Own => self.motor(speed),
            Source::Held(_) => Dual::constant(0.0),
            Source::Motor(part) => {
                let drive = &part.plan.drive;
                let motor = drive.motor_torque(&part.plan.tables, &part.q, Dual::variable(speed));
                drive.geared_torque(&part.q, motor)
            }
            Source::Power { torque, speed: at, exponent } => {
                let share = speed / at;
                let value = torque * share.abs().powf(*exponent);
                let slope = if *exponent == 0.0 { 0.0 } else { exponent * value / speed };
                let sense = share.signum();
                Dual { value: sense * value, d: sense * slope }
            }
        }
    }

    /// Accelerations of a state, with their derivatives.
    fn accelerations(&self, row: &Row<'_>, y: &[f64], to: &mut Rates) {
        let chain = self.chain;
        let (n, m, crank) = (chain.masses(), chain.states(), chain.masses() - 1);
        to.acceleration.fill(0.0);
        to.slopes.fill(0.0);
        for link in &chain.links {
            let torque = chain.torque(link, y);
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                to.acceleration[mass] += sign * torque;
                let slopes = &mut to.slopes[mass * m..][..m];
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < crank {
                        slopes[end] += side * link.stiffness;
                        slopes[crank + end] += side * link.damping;
                    }
                }
            }
        }
        for (k, driver) in chain.drivers.iter().enumerate() {
            let torque = self.outside(driver, chain.speed(driver.mass, y));
            to.drive[k] = torque.value;
            to.acceleration[driver.mass] += torque.value;
            self.add_speed_slope(driver.mass, torque.d, &mut to.slopes);
        }
        (to.load, to.load_power) = (0.0, 0.0);
        self.add_loads(y, to);
        for mass in 0..crank {
            to.inertia[mass] = [chain.inertia[mass], 0.0];
        }
        let (r, omega) = (&row.reduced, y[m - 1]);
        let load = self.load(row, omega);
        to.inertia[crank] = [r.J - chain.apart, 0.0];
        to.acceleration[crank] -= load.value + 0.5 * r.J_d1 * omega * omega;
        to.slopes[crank * m + m - 1] -= load.d + r.J_d1 * omega;
        (to.load, to.load_power) = (to.load + load.value, to.load_power + load.value * omega);
        self.add_stations(row, y, to);
        for mass in 0..n {
            let [inertia, inertia_d1] = to.inertia[mass];
            let inverse = 1.0 / inertia;
            to.acceleration[mass] *= inverse;
            let slopes = &mut to.slopes[mass * m..][..m];
            if mass < crank {
                slopes[mass] -= inertia_d1 * to.acceleration[mass];
            }
            slopes.iter_mut().for_each(|slope| *slope *= inverse);
        }
        self.hold(y, to);
    }

    /// Adds loads over the speed, and damping from outside.
    fn add_loads(&self, y: &[f64], to: &mut Rates) {
        let chain = self.chain;
        let (m, crank) = (chain.states(), chain.masses() - 1);
        for load in &chain.loads {
            let speed = chain.speed(load.mass, y);
            let torque = self.outside(load, speed);
            to.acceleration[load.mass] += torque.value;
            self.add_speed_slope(load.mass, torque.d, &mut to.slopes);
            (to.load, to.load_power) = (to.load - torque.value, to.load_power - torque.value * speed);
        }
        let Some(swing) = &chain.swing else { return };
        // The rotation of all together has no part in it: shares add up to one.
        let together: f64 = (0..crank).map(|mass| swing.share[mass] * y[crank + mass]).sum();
        for (mass, &damping) in swing.damping.iter().enumerate().filter(|(_, c)| **c > 0.0) {
            let own = if mass < crank { y[crank + mass] } else { 0.0 };
            let torque = damping * (own - together);
            to.acceleration[mass] -= torque;
            to.load_power += torque * chain.speed(mass, y);
            let slopes = &mut to.slopes[mass * m..][..m];
            for other in 0..crank {
                slopes[crank + other] += damping * swing.share[other];
            }
            if mass < crank {
                slopes[crank + mass] -= damping;
            }
        }
    }

    /// Adds further mechanisms.
    fn add_stations(&self, row: &Row<'_>, y: &[f64], to: &mut Rates) {
        let chain = self.chain;
        let (m, crank) = (chain.states(), chain.masses() - 1);
        for (station, place) in chain.stations.iter().zip(&mut to.places) {
            let mass = station.mass;
            let speed = chain.speed(mass, y);
            let Felt { inertia, inertia_d1, inertia_d2, load, load_by_angle, load_by_speed } =
                place.felt(station, chain.angle(mass, row.phi, y), speed);
            to.acceleration[mass] -= load + 0.5 * inertia_d1 * speed * speed;
            to.inertia[mass][0] += inertia;
            to.inertia[mass][1] += inertia_d1;
            if mass < crank {
                to.slopes[mass * m + mass] -= load_by_angle + 0.5 * inertia_d2 * speed * speed;
            }
            let by_speed = load_by_speed + inertia_d1 * speed;
            self.add_speed_slope(mass, -by_speed, &mut to.slopes);
            (to.load, to.load_power) = (to.load + load, to.load_power + load * speed);
        }
    }

    /// Keeps the speed of a mass whose driver does so; it gives what else its acceleration would ask for.
    fn hold(&self, y: &[f64], to: &mut Rates) {
        let (chain, m) = (self.chain, self.chain.states());
        for (k, driver) in chain.drivers.iter().enumerate() {
            if let Source::Held(held) = driver.source {
                let (mass, rate) = (driver.mass, held / CORRECTION);
                to.drive[k] = -to.acceleration[mass] * to.inertia[mass][0];
                to.acceleration[mass] = rate * (held - chain.speed(mass, y));
                to.slopes[mass * m..][..m].fill(0.0);
                self.add_speed_slope(mass, -rate, &mut to.slopes);
            }
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
        self.accelerations(row, y, to);
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
