//! Torques on the masses at one instant, and the rates of a state.
//!
//! A state has the twist and the speed of every mass against the crank, the speed of the crank, as [`Chain`] counts them, then
//! the angle of the crank, and works: of the motor at its shaft, the integral of its torque, work behind the gearbox, of the
//! loads, and what each link turns into heat.
//!
//! The torque on a mass may jump where its speed changes its sign: on the crank by dry loads, on the mass of the motor by the
//! losses of the gearbox. A step takes the torque of one direction, or holds the mass at rest.

use super::start::Start;
use crate::chain::Chain;
use crate::equation::Equation;
use linkwright_core::drive::law::{LawGeometry, SpeedKink};
use linkwright_core::drive::transient::reduced::{Reduced, ReducedCurves};
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::plane::Angle;

/// Works before those of the links: see the numbers below.
const WORKS: usize = 5;

/// Share of the working speed at which laws are taken at rest.
const SLOW: f64 = 1e-11;

/// Places in a state.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Masses but the crank.
    pub others: usize,
    /// Speed of the crank.
    pub omega: usize,
    /// Angle of the crank.
    pub phi: usize,
    /// Work of the motor at its shaft.
    pub shaft: usize,
    /// Integral of the motor's torque over time, at the speed of the crank.
    pub impulse: usize,
    /// Work behind the gearbox.
    pub drive: usize,
    /// Work that the loads take.
    pub load: usize,
    /// Work that brakes take.
    pub brake: usize,
    /// First of what links turn into heat.
    pub heat: usize,
    /// Numbers of a state.
    pub size: usize,
}

impl Layout {
    /// Of a driveline.
    pub fn of(chain: &Chain) -> Self {
        let others = chain.masses() - 1;
        let works = 2 * others + 2;
        Layout {
            others,
            omega: 2 * others,
            phi: 2 * others + 1,
            shaft: works,
            impulse: works + 1,
            drive: works + 2,
            load: works + 3,
            brake: works + 4,
            heat: works + WORKS,
            size: works + WORKS + chain.links.len(),
        }
    }
}

/// A driveline with its mechanism, and what holds for the step that is taken.
pub struct System<'a> {
    /// The machine.
    pub equation: Equation<'a>,
    /// Places in a state.
    pub layout: Layout,
    /// Mass of the motor.
    pub driven: usize,
    /// Direction in which the motor drives, +1 or −1.
    pub motor: f64,
    /// Torque of the brake on every mass \[N m\].
    pub brakes: Vec<f64>,
    /// Direction of every mass whose torque jumps at rest: +1, −1, or 0 where it is held.
    pub senses: Vec<f64>,
    /// Crank angles between two kinks, in which the step is.
    pub between: [f64; 2],
    /// Speed that counts as none \[rad/s\].
    pub slow: f64,
    /// Kinks of laws over speed and time.
    pub law_kinks: Vec<SpeedKink>,
    /// Torque on every mass, of the last state \[N m\].
    pub net: Vec<f64>,
    /// The motor's torque at its shaft, times the ratio \[N m\].
    pub shaft: f64,
    /// Torque behind the gearbox \[N m\].
    pub drive: f64,
    /// Torque of the loads \[N m\].
    pub load: f64,
    /// Inertia at the crank \[kg m²\].
    pub crank_inertia: f64,
    /// Evaluations so far.
    pub evaluations: usize,
    curves: [Option<ReducedCurves>; 2],
    motion: Motion<f64>,
    geometry: Vec<LawGeometry<f64>>,
}

impl<'a> System<'a> {
    /// Of a machine with kinks at crank angles of its cycle.
    pub fn new(equation: Equation<'a>, kinks: &[f64], start: &Start) -> Self {
        let Equation { plan, q, chain } = equation;
        let Start { speed, motor, accuracy, .. } = *start;
        System {
            equation,
            layout: Layout::of(chain),
            driven: chain.drivers.first().map_or(0, |driver| driver.mass),
            motor,
            brakes: start.brakes.clone(),
            senses: vec![1.0; chain.masses()],
            between: [f64::NEG_INFINITY, f64::INFINITY],
            slow: SLOW * speed,
            law_kinks: plan.speed_kinks(),
            net: vec![0.0; chain.masses()],
            shaft: 0.0,
            drive: 0.0,
            load: 0.0,
            crank_inertia: 0.0,
            evaluations: 0,
            curves: [-1.0, 1.0].map(|sense| ReducedCurves::new(plan, kinks, sense, accuracy)),
            motion: Motion::new(&plan.mechanism, q),
            geometry: Vec::new(),
        }
    }

    /// Number of the crank's mass.
    pub fn crank(&self) -> usize {
        self.layout.others
    }

    /// Masses whose torque may jump at rest.
    pub fn holding(&self) -> Vec<usize> {
        let Equation { plan, q, chain } = self.equation;
        let has_losses = q[plan.drive.forward] != q[plan.drive.reverse];
        let holds = |&mass: &usize| {
            mass == self.crank() || self.brakes[mass] > 0.0 || (has_losses && mass == self.driven)
        };
        (0..chain.masses()).filter(holds).collect()
    }

    /// Speed of a mass.
    pub fn speed(&self, mass: usize, y: &[f64]) -> f64 {
        self.equation.chain.speed(mass, y)
    }

    /// Inertia J, J′, torque that resists and viscous coefficient in a direction.
    fn reduced(&mut self, phi: f64, sense: f64) -> Reduced {
        let Equation { plan, q, .. } = self.equation;
        let curves = &mut self.curves[usize::from(sense > 0.0)];
        let between = self.between;
        if let Some(found) = curves.as_mut().and_then(|curves| curves.at_between(plan, q, phi, between)) {
            return found;
        }
        let r = plan.reduce::<f64, 2>(q, Angle::new(phi), sense, &mut self.motion);
        [r.J, r.J_d1, sense * r.load + r.dry, r.viscous]
    }

    /// Torque of the laws where the mechanism was placed.
    fn laws(&mut self, t: f64, phi: f64, omega: f64) -> f64 {
        let Equation { plan, q, .. } = self.equation;
        if plan.laws.is_empty() {
            return 0.0;
        }
        self.geometry.clear();
        plan.add_geometry(q, phi, &self.motion, &mut self.geometry);
        plan.law_torque::<f64, f64, f64>(q, &self.geometry, omega, t)
    }

    /// Torques on all masses at a time and a state.
    pub fn act(&mut self, t: f64, y: &[f64]) {
        let Equation { plan, q, chain } = self.equation;
        let (layout, crank) = (self.layout, self.crank());
        self.evaluations += 1;
        self.net.fill(0.0);
        for link in &chain.links {
            let torque = chain.torque(link, y).value;
            self.net[link.first] -= torque;
            self.net[link.second] += torque;
        }
        let direction = |sense: f64| if sense < 0.0 { -1.0 } else { 1.0 };
        for ((net, brake), &sense) in self.net.iter_mut().zip(&self.brakes).zip(&self.senses) {
            *net -= direction(sense) * brake;
        }
        let speed = chain.speed(self.driven, y);
        let along = direction(self.senses[self.driven]);
        let torque = self.motor * plan.drive.motor_torque::<f64, f64>(&plan.tables, q, self.motor * speed);
        self.shaft = torque * q[plan.drive.ratio];
        self.drive = along * plan.drive.geared_torque::<f64, f64>(q, along * torque);
        self.net[self.driven] += self.drive;
        let (omega, phi, sense) = (y[layout.omega], y[layout.phi], direction(self.senses[crank]));
        let [inertia, slope, resisting, viscous] = self.reduced(phi, sense);
        let over_speed = plan.drive.speed_load::<f64, f64>(&plan.tables, q, sense * omega);
        let by_laws = self.laws(t, phi, sense * (sense * omega).max(self.slow));
        self.load = sense * (resisting + over_speed) + viscous * omega + by_laws;
        self.crank_inertia = inertia - chain.apart;
        self.net[crank] -= self.load + 0.5 * slope * omega * omega;
    }

    /// Acceleration of a mass by the torques that were computed last.
    pub fn acceleration(&self, mass: usize) -> f64 {
        let inertia = self.equation.chain.inertia.get(mass).copied().unwrap_or(self.crank_inertia);
        if self.senses[mass] == 0.0 { 0.0 } else { self.net[mass] / inertia }
    }

    /// Rates of a state.
    pub fn rates(&mut self, t: f64, y: &[f64], to: &mut [f64]) {
        self.act(t, y);
        let (layout, chain) = (self.layout, self.equation.chain);
        let a = self.acceleration(layout.others);
        for mass in 0..layout.others {
            to[mass] = y[layout.others + mass];
            to[layout.others + mass] = self.acceleration(mass) - a;
        }
        let (omega, speed) = (y[layout.omega], self.speed(self.driven, y));
        to[layout.omega] = a;
        to[layout.phi] = omega;
        to[layout.shaft] = self.shaft * speed;
        to[layout.impulse] = self.shaft;
        to[layout.drive] = self.drive * speed;
        to[layout.load] = self.load * omega;
        to[layout.brake] =
            (0..=layout.others).map(|mass| self.brakes[mass] * self.speed(mass, y).abs()).sum();
        for (to, link) in to[layout.heat..].iter_mut().zip(&chain.links) {
            *to = chain.torque(link, y).damper * chain.twist(link, y)[1];
        }
    }

    /// Derivatives of the rates by the state but the angle, without works, row by row: what acts over the angle changes slowly.
    pub fn slopes(&mut self, t: f64, y: &[f64], to: &mut [f64]) {
        self.act(t, y);
        let (layout, Equation { chain, .. }) = (self.layout, self.equation);
        let (others, m) = (layout.others, layout.phi + 1);
        to.fill(0.0);
        // First accelerations of all masses, in the rows of their speeds.
        for link in &chain.links {
            let torque = chain.torque(link, y);
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < others {
                        to[(others + mass) * m + end] += side * torque.by_twist;
                        to[(others + mass) * m + others + end] += side * torque.by_rate;
                    }
                }
            }
        }
        let (driver, load) = self.speed_slopes(t, y);
        for column in [others + self.driven, layout.omega] {
            to[(others + self.driven) * m + column] += driver;
        }
        to[layout.omega * m + layout.omega] -= load;
        for mass in 0..=others {
            let inertia = chain.inertia.get(mass).copied().unwrap_or(self.crank_inertia);
            let factor = if self.senses[mass] == 0.0 { 0.0 } else { 1.0 / inertia };
            to[(others + mass) * m..][..m].iter_mut().for_each(|slope| *slope *= factor);
        }
        for mass in 0..others {
            for column in 0..m {
                to[(others + mass) * m + column] -= to[layout.omega * m + column];
            }
            to[mass * m + others + mass] = 1.0;
        }
        to[layout.phi * m + layout.omega] = 1.0;
    }

    /// Derivatives of the torque behind the gearbox by the speed of its mass, and of what brakes the crank by its own, where the
    /// torques were computed last.
    fn speed_slopes(&mut self, t: f64, y: &[f64]) -> (f64, f64) {
        let Equation { plan, q, chain } = self.equation;
        let direction = |sense: f64| if sense < 0.0 { -1.0 } else { 1.0 };
        let (along, sense) = (direction(self.senses[self.driven]), direction(self.senses[self.crank()]));
        let speed = Dual::variable(chain.speed(self.driven, y));
        let motor = Dual::constant(self.motor);
        let torque = motor * plan.drive.motor_torque::<f64, _>(&plan.tables, q, motor * speed);
        let driver = plan.drive.geared_torque::<f64, _>(q, Dual::constant(along) * torque).d * along;
        let (omega, phi) = (y[self.layout.omega], y[self.layout.phi]);
        let [_, slope, _, viscous] = self.reduced(phi, sense);
        let over_speed = plan.drive.speed_load::<f64, _>(&plan.tables, q, Dual::variable(sense * omega)).d;
        let mut load = over_speed + viscous + slope * omega;
        if !plan.laws.is_empty() {
            let (omega, never) = (Dual::variable(sense * (sense * omega).max(self.slow)), Dual::constant(t));
            load += plan.law_torque::<f64, f64, Dual<f64>>(q, &self.geometry, omega, never).d;
        }
        (driver, load)
    }

    /// Torque on a mass that would turn in a direction \[N m\].
    pub fn net_towards(&mut self, t: f64, y: &[f64], mass: usize, sense: f64) -> f64 {
        let known = std::mem::replace(&mut self.senses[mass], sense);
        self.act(t, y);
        self.senses[mass] = known;
        self.net[mass]
    }

    /// Direction in which a mass leaves rest; 0 where it is held.
    pub fn way_from_rest(&mut self, t: f64, y: &[f64], mass: usize) -> f64 {
        if self.net_towards(t, y, mass, 1.0) > 0.0 {
            1.0
        } else if self.net_towards(t, y, mass, -1.0) < 0.0 {
            -1.0
        } else {
            0.0
        }
    }

    /// Kinetic energy and what the links store \[J\].
    pub fn energy(&mut self, t: f64, y: &[f64]) -> [f64; 2] {
        self.act(t, y);
        let chain = self.equation.chain;
        let inertia = chain.inertia.iter().copied().chain([self.crank_inertia]).enumerate();
        let kinetic = inertia.map(|(mass, J)| 0.5 * J * self.speed(mass, y).powi(2)).sum();
        let elastic = chain.links.iter().map(|link| link.law.stored(chain.twist(link, y)[0])).sum();
        [kinetic, elastic]
    }

    /// The quantities whose zeros are kinks of laws.
    pub fn at_law_kinks(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        if self.law_kinks.is_empty() {
            return Vec::new();
        }
        let Equation { plan, q, .. } = self.equation;
        let (omega, phi) = (y[self.layout.omega], y[self.layout.phi]);
        plan.reduce::<f64, 2>(q, Angle::new(phi), 1.0, &mut self.motion);
        self.geometry.clear();
        plan.add_geometry(q, phi, &self.motion, &mut self.geometry);
        let value = |&kink: &SpeedKink| plan.speed_kink_value(q, kink, &self.geometry, [omega, t]);
        self.law_kinks.iter().map(value).collect()
    }
}
