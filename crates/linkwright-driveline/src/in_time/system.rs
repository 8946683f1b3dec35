//! Torques on the masses at one instant, and the rates of a state.
//!
//! A state has the twist and the speed of every mass against the crank, the speed of the crank, as [`Chain`] counts them, then
//! the angle of the crank, and works: of the drivers at their shafts, behind the gearboxes, of the loads and brakes, the
//! integral of the torque of each driver, and what each link turns into heat.
//!
//! The torque on a mass may jump where its speed changes its sign: by dry loads of its mechanism, by the losses of the gearbox of
//! its motor, by a brake. A step takes the torque of one direction, or holds the mass at rest. A step also takes the laws of links
//! in one form: behind a flank or a point of a curve they go on as before it, and the end of the step is there.

use super::mounted::{Felt, Mounted, Tables};
use super::start::Start;
use crate::chain::{Chain, Source, Torque};
use crate::equation::Equation;
use crate::law::{Transmitted, Zone};
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::dual::Dual;

/// Works before those of drivers and links: see the numbers below.
const WORKS: usize = 4;

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
    /// Work of the drivers at their shafts.
    pub shaft: usize,
    /// Work behind the gearboxes.
    pub drive: usize,
    /// Work that the loads take.
    pub load: usize,
    /// Work that brakes take.
    pub brake: usize,
    /// First of the integrals of the drivers' torques over time, at the speed of the crank.
    pub impulse: usize,
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
        let heat = works + WORKS + chain.drivers.len();
        Layout {
            others,
            omega: 2 * others,
            phi: 2 * others + 1,
            shaft: works,
            drive: works + 1,
            load: works + 2,
            brake: works + 3,
            impulse: works + WORKS,
            heat,
            size: heat + chain.links.len(),
        }
    }
}

/// A driveline with its mechanisms, and what holds for the step that is taken.
pub struct System<'a> {
    /// The machine.
    pub equation: Equation<'a>,
    /// Places in a state.
    pub layout: Layout,
    /// Its mechanisms, that at the crank first.
    pub mounted: Vec<Mounted<'a>>,
    /// Direction in which the drivers drive, +1 or −1.
    pub motor: f64,
    /// Share of the torque of the motors that is there.
    pub supply: f64,
    /// Torque from outside on every mass \[N m\].
    pub torques: Vec<f64>,
    /// Torque that opposes the crank per its speed \[N m s\].
    pub coupling: f64,
    /// Torque of the brake on every mass \[N m\].
    pub brakes: Vec<f64>,
    /// Direction of every mass whose torque jumps at rest: +1, −1, or 0 where it is held.
    pub senses: Vec<f64>,
    /// Form of the law of every link.
    pub zones: Vec<Zone>,
    /// Speed that counts as none \[rad/s\].
    pub slow: f64,
    /// Torque on every mass, of the last state \[N m\].
    pub net: Vec<f64>,
    /// Inertia of every mass \[kg m²\].
    pub inertia: Vec<f64>,
    /// Torque of each driver at its shaft, times its ratio \[N m\].
    pub shafts: Vec<f64>,
    /// Torque of each behind its gearbox \[N m\].
    pub drives: Vec<f64>,
    /// Torque of the loads, referred to the crank \[N m\].
    pub load: f64,
    /// Power that the loads take \[W\].
    pub load_power: f64,
    /// Evaluations so far.
    pub evaluations: usize,
}

fn direction(sense: f64) -> f64 {
    if sense < 0.0 { -1.0 } else { 1.0 }
}

impl<'a> System<'a> {
    /// Of a machine at its start.
    pub fn new(equation: Equation<'a>, start: &Start) -> Self {
        System::with(equation, start, Tables::all(equation, start.accuracy))
    }

    /// The same with what is known of its mechanisms.
    pub fn with(equation: Equation<'a>, start: &Start, tables: Vec<Tables>) -> Self {
        let (chain, drivers) = (equation.chain, equation.chain.drivers.len());
        let Start { speed, motor, supply, .. } = *start;
        let of_link = |link| {
            let [twist, rate] = chain.twist(link, &start.state);
            link.law.zone(twist, rate)
        };
        System {
            equation,
            layout: Layout::of(chain),
            mounted: Mounted::all(equation, tables),
            motor,
            supply,
            torques: start.torques.clone(),
            coupling: start.coupling,
            brakes: start.brakes.clone(),
            senses: vec![1.0; chain.masses()],
            zones: chain.links.iter().map(of_link).collect(),
            slow: SLOW * speed,
            net: vec![0.0; chain.masses()],
            inertia: vec![0.0; chain.masses()],
            shafts: vec![0.0; drivers],
            drives: vec![0.0; drivers],
            load: 0.0,
            load_power: 0.0,
            evaluations: 0,
        }
    }

    /// Number of the crank's mass.
    pub fn crank(&self) -> usize {
        self.layout.others
    }

    /// Masses whose torque may jump at rest.
    pub fn holding(&self) -> Vec<usize> {
        let chain = self.equation.chain;
        let mut holds: Vec<bool> = self.brakes.iter().map(|&brake| brake > 0.0).collect();
        self.mounted.iter().for_each(|one| holds[one.mass] = true);
        for driver in &chain.drivers {
            holds[driver.mass] |=
                self.program(driver).is_some_and(|(plan, q)| q[plan.drive.forward] != q[plan.drive.reverse]);
        }
        for load in &chain.loads {
            holds[load.mass] |= matches!(load.source, Source::Power { exponent, .. } if exponent == 0.0);
        }
        (0..chain.masses()).filter(|&mass| holds[mass]).collect()
    }

    /// Structure and numbers of the machine whose motor a driver is.
    pub fn program<'s>(&'s self, driver: &'s Torque) -> Option<(&'s Plan, &'s [f64])> {
        match &driver.source {
            Source::Own => Some((self.equation.plan, self.equation.q)),
            Source::Motor(part) => Some((&part.plan, &part.q)),
            Source::Held(_) | Source::Power { .. } => None,
        }
    }

    /// Speed of a mass.
    pub fn speed(&self, mass: usize, y: &[f64]) -> f64 {
        self.equation.chain.speed(mass, y)
    }

    /// Angle of the crank of a mechanism.
    pub fn angle(&self, place: usize, y: &[f64]) -> f64 {
        self.mounted[place].angle(self.equation.chain, y[self.layout.phi], y)
    }

    /// Twists between which the form of a link holds.
    pub fn bounds(&self, link: usize) -> [f64; 2] {
        self.equation.chain.links[link].law.bounds(self.zones[link])
    }

    /// Torque of a link by the form of the step.
    pub fn link(&self, link: usize, y: &[f64]) -> Transmitted {
        let chain = self.equation.chain;
        let [twist, rate] = chain.twist(&chain.links[link], y);
        chain.links[link].law.of_zone(self.zones[link], twist, rate)
    }

    /// Torques of a driver at its shaft, times its ratio, and behind its gearbox, with the derivative of that by the speed.
    fn driven(&self, driver: &Torque, speed: f64) -> (f64, Dual<f64>) {
        let along = Dual::constant(direction(self.senses[driver.mass]));
        let (motor, speed) = (Dual::constant(self.motor), Dual::variable(speed));
        let supplied = motor * self.supply;
        if let Some((plan, q)) = self.program(driver) {
            let torque = supplied * plan.drive.motor_torque::<f64, _>(&plan.tables, q, motor * speed);
            let behind = along * plan.drive.geared_torque::<f64, _>(q, along * torque);
            return (torque.value * q[plan.drive.ratio], behind);
        }
        let Source::Power { torque, speed: at, exponent } = driver.source else {
            return (0.0, Dual::constant(0.0));
        };
        // It drives in one direction, whichever way its mass turns.
        let share = speed.value.abs() / at;
        let value = supplied.value * torque * share.powf(exponent);
        let d = if exponent == 0.0 || share == 0.0 { 0.0 } else { exponent * value / speed.value };
        (value, Dual { value, d })
    }

    /// Torque on a mass by a load over its speed, and its derivative.
    fn loaded(&self, load: &Torque, speed: f64) -> Dual<f64> {
        match load.source {
            // Dry: as large at rest as in motion.
            Source::Power { torque, exponent: 0.0, .. } => {
                Dual::constant(direction(self.senses[load.mass]) * torque)
            }
            _ => self.equation.outside(load, speed),
        }
    }

    /// Torques on all masses at a time and a state.
    pub fn act(&mut self, t: f64, y: &[f64]) {
        let Equation { chain, .. } = self.equation;
        self.evaluations += 1;
        self.net.copy_from_slice(&self.torques);
        self.net[self.layout.others] -= self.coupling * y[self.layout.omega];
        self.inertia[..chain.inertia.len()].copy_from_slice(&chain.inertia);
        self.inertia[chain.inertia.len()] = -chain.apart;
        for (k, link) in chain.links.iter().enumerate() {
            let torque = self.link(k, y).value;
            self.net[link.first] -= torque;
            self.net[link.second] += torque;
        }
        for ((net, brake), &sense) in self.net.iter_mut().zip(&self.brakes).zip(&self.senses) {
            *net -= direction(sense) * brake;
        }
        for (k, driver) in chain.drivers.iter().enumerate() {
            let (shaft, behind) = self.driven(driver, self.speed(driver.mass, y));
            (self.shafts[k], self.drives[k]) = (shaft, behind.value);
            self.net[driver.mass] += behind.value;
            if let Source::Held(_) = driver.source {
                // A motor that keeps its speed does so as a mass would that nothing accelerates.
                self.inertia[driver.mass] = f64::INFINITY;
            }
        }
        (self.load, self.load_power) = (0.0, 0.0);
        for load in &chain.loads {
            let speed = self.speed(load.mass, y);
            self.add_load(load.mass, -self.loaded(load, speed).value, speed);
        }
        self.add_swing(y);
        for place in 0..self.mounted.len() {
            let (psi, mass) = (self.angle(place, y), self.mounted[place].mass);
            let (speed, sense) = (self.speed(mass, y), direction(self.senses[mass]));
            let Felt { inertia, slope, load } = self.mounted[place].felt(t, psi, speed, sense, self.slow);
            self.inertia[mass] += inertia;
            self.net[mass] -= 0.5 * slope * speed * speed;
            self.add_load(mass, load, speed);
        }
    }

    fn add_load(&mut self, mass: usize, torque: f64, speed: f64) {
        self.net[mass] -= torque;
        self.load += torque;
        self.load_power += torque * speed;
    }

    /// Damping from outside against the rotation of all together.
    fn add_swing(&mut self, y: &[f64]) {
        let Some(swing) = &self.equation.chain.swing else { return };
        let others = self.layout.others;
        let beside = |mass: usize| if mass < others { y[others + mass] } else { 0.0 };
        let together: f64 = (0..others).map(|mass| swing.share[mass] * beside(mass)).sum();
        for (mass, &damping) in swing.damping.iter().enumerate() {
            let torque = damping * (beside(mass) - together);
            self.net[mass] -= torque;
            self.load_power += torque * self.speed(mass, y);
        }
    }

    /// Acceleration of a mass by the torques that were computed last.
    pub fn acceleration(&self, mass: usize) -> f64 {
        if self.senses[mass] == 0.0 { 0.0 } else { self.net[mass] / self.inertia[mass] }
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
        to[layout.omega] = a;
        to[layout.phi] = y[layout.omega];
        (to[layout.shaft], to[layout.drive]) = (0.0, 0.0);
        for (k, driver) in chain.drivers.iter().enumerate() {
            let speed = self.speed(driver.mass, y);
            to[layout.shaft] += self.shafts[k] * speed;
            to[layout.drive] += self.drives[k] * speed;
            to[layout.impulse + k] = self.shafts[k];
        }
        to[layout.load] = self.load_power;
        to[layout.brake] =
            (0..=layout.others).map(|mass| self.brakes[mass] * self.speed(mass, y).abs()).sum();
        for (k, link) in chain.links.iter().enumerate() {
            to[layout.heat + k] = self.link(k, y).damper * chain.twist(link, y)[1];
        }
    }

    /// Derivatives of the rates by the state but the angle, without works, row by row: what acts over the angle changes slowly.
    pub fn slopes(&mut self, t: f64, y: &[f64], to: &mut [f64]) {
        self.act(t, y);
        let (layout, Equation { chain, .. }) = (self.layout, self.equation);
        let (others, m) = (layout.others, layout.phi + 1);
        to.fill(0.0);
        // First accelerations of all masses, in the rows of their speeds.
        for (k, link) in chain.links.iter().enumerate() {
            let torque = self.link(k, y);
            for (mass, sign) in [(link.first, -1.0), (link.second, 1.0)] {
                for (end, side) in [(link.first, sign), (link.second, -sign)] {
                    if end < others {
                        to[(others + mass) * m + end] += side * torque.by_twist;
                        to[(others + mass) * m + others + end] += side * torque.by_rate;
                    }
                }
            }
        }
        let mut add = |mass: usize, slope: f64| {
            to[(others + mass) * m + layout.omega] += slope;
            if mass < others {
                to[(others + mass) * m + others + mass] += slope;
            }
        };
        add(others, -self.coupling);
        for driver in &chain.drivers {
            add(driver.mass, self.driven(driver, self.speed(driver.mass, y)).1.d);
        }
        for load in &chain.loads {
            add(load.mass, self.loaded(load, self.speed(load.mass, y)).d);
        }
        for place in 0..self.mounted.len() {
            let (psi, mass) = (self.angle(place, y), self.mounted[place].mass);
            let (speed, sense) = (self.speed(mass, y), direction(self.senses[mass]));
            add(mass, -self.mounted[place].slope(t, psi, speed, sense, self.slow));
        }
        if let Some(swing) = &chain.swing {
            for (mass, &damping) in swing.damping.iter().enumerate() {
                let row = &mut to[(others + mass) * m..][..m];
                (0..others).for_each(|other| row[others + other] += damping * swing.share[other]);
                if mass < others {
                    row[others + mass] -= damping;
                }
            }
        }
        for mass in 0..=others {
            let factor = if self.senses[mass] == 0.0 { 0.0 } else { 1.0 / self.inertia[mass] };
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
        let of_mass = |(mass, J): (usize, &f64)| 0.5 * J * self.speed(mass, y).powi(2);
        let kinetic = self.inertia.iter().enumerate().map(of_mass).sum();
        let elastic = chain.links.iter().map(|link| link.law.stored(chain.twist(link, y)[0])).sum();
        [kinetic, elastic]
    }

    /// The quantities whose zeros are kinks of laws, of all mechanisms.
    pub fn at_law_kinks(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut found = Vec::new();
        for place in 0..self.mounted.len() {
            let (psi, speed) = (self.angle(place, y), self.speed(self.mounted[place].mass, y));
            self.mounted[place].add_law_kinks(t, psi, speed, &mut found);
        }
        found
    }
}
