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
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;

/// A driver that keeps its speed corrects it within this share of a radian of the crank; the periodic motion has none to correct.
const CORRECTION: f64 = 0.01;

/// How far before a kink \[rad\] a mechanism is read, from where its values are taken on by their slopes.
const BEFORE: f64 = 1e-7;

/// State whose forms laws of links have, and how far before a kink further mechanisms are read.
type Side<'y, N> = (Option<&'y [N]>, f64);

/// The mechanism at one crank angle.
#[derive(Clone, Copy)]
pub struct Row<'a, N = f64> {
    /// The angle \[rad\].
    pub phi: N,
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
pub struct Rates<N = f64> {
    /// Accelerations of all masses \[rad/s²\].
    pub acceleration: Vec<N>,
    /// Torques of the drivers on their masses \[N m\].
    pub drive: Vec<N>,
    /// Torque of all loads, referred to the crank \[N m\].
    pub load: N,
    /// Power that loads and damping from outside take \[W\].
    pub load_power: N,
    /// dy/dφ.
    pub rate: Vec<N>,
    /// ∂(dy/dφ)/∂y, row by row.
    pub jacobian: Vec<N>,
    slopes: Vec<N>,
    /// Inertias of the masses, and their derivatives by the angles of the masses.
    inertia: Vec<[N; 2]>,
    places: Vec<Place>,
}

impl<N: Real> Rates<N> {
    /// Room for a driveline.
    pub fn new(chain: &Chain<N>) -> Self {
        let (n, m, zero) = (chain.masses(), chain.states(), N::splat(0.0));
        Rates {
            acceleration: vec![zero; n],
            drive: vec![zero; chain.drivers.len()],
            load: zero,
            load_power: zero,
            rate: vec![zero; m],
            jacobian: vec![zero; m * m],
            slopes: vec![zero; n * m],
            inertia: vec![[zero; 2]; n],
            places: chain.stations.iter().map(Place::new).collect(),
        }
    }

    /// Takes rates on from one state to another that is near, by their derivatives.
    pub fn take_on(&mut self, from: &[N], to: &[N]) {
        let m = from.len();
        for (rate, slopes) in self.rate.iter_mut().zip(self.jacobian.chunks_exact(m)) {
            for ((&slope, &from), &to) in slopes.iter().zip(from).zip(to) {
                *rate = *rate + slope * (to - from);
            }
        }
    }

    /// Inertia of a mass \[kg m²\].
    pub fn inertia(&self, mass: usize) -> N {
        self.inertia[mass][0]
    }

    fn add_load(&mut self, torque: N, speed: N) {
        self.load = self.load + torque;
        self.load_power = self.load_power + torque * speed;
    }
}

/// Adds to a number in a list.
#[inline(always)]
fn add<N: Real>(list: &mut [N], at: usize, x: N) {
    list[at] = list[at] + x;
}

/// T₀ (ω/ω₀)^p with its derivative by the speed; it is odd in the speed.
#[inline(always)]
fn power<N: Real>(torque: N, at: N, exponent: N, speed: N) -> Dual<N> {
    let share = speed / at;
    let p = exponent.max_lane();
    let raised = |by: f64| {
        let slope = move |x: f64| if by == 0.0 { 0.0 } else { by * x.powf(by - 1.0) };
        let plain = share.abs().map(|x| (x.powf(by), slope(x)));
        if N::IS_PLAIN {
            return plain;
        }
        // What the exponent differs by, as lanes or as a derivative.
        plain * ((exponent - p) * share.abs().ln()).exp()
    };
    let sense = share.select_lt(N::splat(0.0), N::splat(-1.0), N::splat(1.0));
    let slope = if p == 0.0 { N::splat(0.0) } else { torque * exponent * raised(p - 1.0) / at };
    Dual { value: sense * torque * raised(p), d: slope }
}

impl<N: Real> Equation<'_, N> {
    /// Torque of the motor at a mass with this speed \[N m\], through the gearbox, and its derivative.
    #[inline(always)]
    pub fn motor(&self, speed: N) -> Dual<N> {
        geared(self.plan, self.q, speed)
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

    /// Torque on a mass with this speed from outside \[N m\], and its derivative; nothing of one that keeps its speed.
    #[inline(always)]
    pub fn outside(&self, torque: &Torque<N>, speed: N) -> Dual<N> {
        match &torque.source {
            Source::Own => self.motor(speed),
            Source::Held(_) => Dual::splat(0.0),
            Source::Motor(part) => geared(&part.plan, &part.q, speed),
            Source::Power { torque, speed: at, exponent } => power(*torque, *at, *exponent, speed),
        }
    }

    /// Accelerations of a state, with their derivatives.
    #[inline(always)]
    fn accelerations(&self, row: &Row<'_, N>, y: &[N], (like, before): Side<'_, N>, to: &mut Rates<N>) {
        let chain = self.chain;
        let (n, m, crank, zero) = (chain.masses(), chain.states(), chain.masses() - 1, N::splat(0.0));
        to.acceleration.fill(zero);
        to.slopes.fill(zero);
        for link in &chain.links {
            let torque = match like {
                None => chain.torque(link, y),
                Some(near) => chain.torque_like(link, y, near),
            };
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                add(&mut to.acceleration, mass, torque.value * sign);
                let slopes = &mut to.slopes[mass * m..][..m];
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < crank {
                        add(slopes, end, torque.by_twist * side);
                        add(slopes, crank + end, torque.by_rate * side);
                    }
                }
            }
        }
        for (k, driver) in chain.drivers.iter().enumerate() {
            let torque = self.outside(driver, chain.speed(driver.mass, y));
            to.drive[k] = torque.value;
            add(&mut to.acceleration, driver.mass, torque.value);
            self.add_speed_slope(driver.mass, torque.d, &mut to.slopes);
        }
        (to.load, to.load_power) = (zero, zero);
        self.add_loads(y, to);
        for mass in 0..crank {
            to.inertia[mass] = [chain.inertia[mass], zero];
        }
        let (r, omega) = (&row.reduced, y[m - 1]);
        let load = self.load(row, omega);
        to.inertia[crank] = [r.J - chain.apart, zero];
        add(&mut to.acceleration, crank, -(load.value + r.J_d1 * omega * omega * 0.5));
        add(&mut to.slopes, crank * m + m - 1, -(load.d + r.J_d1 * omega));
        to.add_load(load.value, omega);
        self.add_stations(row, y, before, to);
        for mass in 0..n {
            let [inertia, inertia_d1] = to.inertia[mass];
            let inverse = inertia.recip();
            to.acceleration[mass] = to.acceleration[mass] * inverse;
            let slopes = &mut to.slopes[mass * m..][..m];
            if mass < crank {
                slopes[mass] = slopes[mass] - inertia_d1 * to.acceleration[mass];
            }
            for slope in slopes {
                *slope = *slope * inverse;
            }
        }
        self.hold(y, to);
    }

    /// Adds loads over the speed, and damping from outside.
    #[inline(always)]
    fn add_loads(&self, y: &[N], to: &mut Rates<N>) {
        let chain = self.chain;
        let (m, crank) = (chain.states(), chain.masses() - 1);
        for load in &chain.loads {
            let speed = chain.speed(load.mass, y);
            let torque = self.outside(load, speed);
            add(&mut to.acceleration, load.mass, torque.value);
            self.add_speed_slope(load.mass, torque.d, &mut to.slopes);
            to.add_load(-torque.value, speed);
        }
        let Some(swing) = &chain.swing else { return };
        // The rotation of all together has no part in it: shares add up to one.
        let mut together = N::splat(0.0);
        for mass in 0..crank {
            together = together + swing.share[mass] * y[crank + mass];
        }
        for (mass, &damping) in swing.damping.iter().enumerate() {
            if damping.max_lane() == 0.0 {
                continue;
            }
            let own = if mass < crank { y[crank + mass] } else { N::splat(0.0) };
            let torque = damping * (own - together);
            add(&mut to.acceleration, mass, -torque);
            to.load_power = to.load_power + torque * chain.speed(mass, y);
            let slopes = &mut to.slopes[mass * m..][..m];
            for other in 0..crank {
                add(slopes, crank + other, damping * swing.share[other]);
            }
            if mass < crank {
                add(slopes, crank + mass, -damping);
            }
        }
    }

    /// Adds further mechanisms.
    #[inline(always)]
    fn add_stations(&self, row: &Row<'_, N>, y: &[N], before: f64, to: &mut Rates<N>) {
        let chain = self.chain;
        let (m, crank) = (chain.states(), chain.masses() - 1);
        for (at, station) in chain.stations.iter().enumerate() {
            let mass = station.mass;
            let speed = chain.speed(mass, y);
            let Felt { inertia, inertia_d1, inertia_d2, load, load_by_angle, load_by_speed } =
                to.places[at].felt(station, chain.angle(mass, row.phi, y), speed, before);
            add(&mut to.acceleration, mass, -(load + inertia_d1 * speed * speed * 0.5));
            let [own, own_d1] = to.inertia[mass];
            to.inertia[mass] = [own + inertia, own_d1 + inertia_d1];
            if mass < crank {
                add(&mut to.slopes, mass * m + mass, -(load_by_angle + inertia_d2 * speed * speed * 0.5));
            }
            self.add_speed_slope(mass, -(load_by_speed + inertia_d1 * speed), &mut to.slopes);
            to.add_load(load, speed);
        }
    }

    /// Keeps the speed of a mass whose driver does so; it gives what else its acceleration would ask for.
    #[inline(always)]
    fn hold(&self, y: &[N], to: &mut Rates<N>) {
        let (chain, m) = (self.chain, self.chain.states());
        for (k, driver) in chain.drivers.iter().enumerate() {
            if let Source::Held(held) = driver.source {
                let (mass, rate) = (driver.mass, held * (1.0 / CORRECTION));
                to.drive[k] = -(to.acceleration[mass] * to.inertia[mass][0]);
                to.acceleration[mass] = rate * (held - chain.speed(mass, y));
                to.slopes[mass * m..][..m].fill(N::splat(0.0));
                self.add_speed_slope(mass, -rate, &mut to.slopes);
            }
        }
    }

    /// Adds the derivative of something that acts on a mass by the speed of that mass.
    #[inline(always)]
    fn add_speed_slope(&self, mass: usize, slope: N, slopes: &mut [N]) {
        let (m, crank) = (self.chain.states(), self.chain.masses() - 1);
        add(slopes, mass * m + m - 1, slope);
        if mass < crank {
            add(slopes, mass * m + crank + mass, slope);
        }
    }

    /// Rates of a state and their Jacobian.
    #[inline(always)]
    pub fn rates(&self, row: &Row<'_, N>, y: &[N], to: &mut Rates<N>) {
        out_of_line!(N, self.rates_inline(row, y, (None, 0.0), to));
    }

    /// The same before a kink, at the end of a step: further mechanisms as they are just before, and laws of links in the form that
    /// they have at another state, if one is given.
    #[inline(always)]
    pub fn rates_before(&self, row: &Row<'_, N>, y: &[N], like: Option<&[N]>, to: &mut Rates<N>) {
        out_of_line!(N, self.rates_inline(row, y, (like, BEFORE), to));
    }

    #[inline(always)]
    fn rates_inline(&self, row: &Row<'_, N>, y: &[N], side: Side<'_, N>, to: &mut Rates<N>) {
        self.accelerations(row, y, side, to);
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

/// Torque of the motor of a plan through its gearbox at a mass with this speed \[N m\], and its derivative.
#[inline(always)]
fn geared<N: Real>(plan: &Plan, q: &[N], speed: N) -> Dual<N> {
    let drive = &plan.drive;
    drive.geared_torque(q, drive.motor_torque(&plan.tables, q, Dual::variable(speed)))
}
