//! Torques, accelerations and outputs at one instant: the equation of [`linkwright_driveline::in_time`] with the mechanism placed as it
//! is, in plain numbers, or in duals for derivatives by states, inputs and numbers of the machine.
//!
//! ```text
//! J_i a_i = M_d(w_i) + Σ T,   J(φ) a + ½ J′(φ) ω² = Σ T − M_r(φ, ω, t)
//! ```

use crate::outside::Outside;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::chain::{Chain, Source, Torque};
use linkwright_driveline::equation::Equation;
use linkwright_driveline::law::Zone;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::real::Real;

/// What acts from outside, and the form of all laws.
pub struct Around<'a, N> {
    /// Time \[s\].
    pub time: f64,
    /// Direction in which the motors drive.
    pub motor: f64,
    /// Share of their torque that is there.
    pub supply: f64,
    /// Torques and the speed of a load.
    pub outside: Outside<N>,
    /// Mass on which the brake acts.
    pub braked: usize,
    /// Speed below which laws are taken at rest \[rad/s\].
    pub slow: f64,
    /// Direction of every mass; 0 where it is held.
    pub senses: &'a [f64],
    /// Form of the law of every link.
    pub zones: &'a [Zone],
}

/// A machine at one instant.
pub struct Instant<N> {
    /// Twists and speeds of the masses against the crank, its speed and angle.
    pub y: Vec<N>,
    /// Mechanism at the crank.
    pub motion: Motion<N>,
    /// Angle of every mass, the crank last \[rad\].
    pub angle: Vec<N>,
    /// Their speeds \[rad/s\].
    pub speed: Vec<N>,
    /// Their accelerations \[rad/s²\].
    pub acceleration: Vec<N>,
    /// Twist \[rad\] and torque \[N m\] of every link.
    pub links: Vec<[N; 2]>,
    /// Speed of the motor at the crank \[rad/s\].
    motor_speed: N,
    /// Torque of the motor at its shaft \[N m\].
    motor: N,
    /// Power of all motors at their shafts \[W\].
    power: N,
    /// Torque of all motors behind their gearboxes \[N m\].
    drive: N,
    /// Torque of the loads, referred to the crank \[N m\].
    load: N,
    /// Torque of the coupling with the load on the crank \[N m\].
    coupled: N,
    /// Inertia of the mechanism and the drive at the crank \[kg m²\].
    inertia: N,
    /// Kinetic energy \[J\].
    kinetic: N,
}

fn direction(sense: f64) -> f64 {
    if sense < 0.0 { -1.0 } else { 1.0 }
}

/// What a mass feels of its mechanism: inertia, ½ J′ w² and the torque of the loads.
fn felt<N: Real>(
    plan: &Plan,
    q: &[N],
    [psi, omega]: [N; 2],
    (sense, slow, time): (f64, f64, f64),
    motion: &mut Motion<N>,
) -> [N; 3] {
    let r = plan.reduce::<N, 2>(q, Angle::new(psi), sense, motion);
    let over_speed = plan.drive.speed_load::<N, N>(&plan.tables, q, omega * sense);
    let mut load = r.load + (r.dry + over_speed) * sense + r.viscous * omega;
    if !plan.laws.is_empty() {
        let mut geometry = Vec::new();
        plan.add_geometry(q, psi, motion, &mut geometry);
        let at = (omega * sense).max(N::splat(slow)) * sense;
        load = load + plan.law_torque::<N, N, N>(q, &geometry, at, N::splat(time));
    }
    [r.J, r.J_d1 * omega.squared() * 0.5, load]
}

impl<N: Real> Instant<N> {
    /// Of a machine in a state.
    pub fn of(plan: &Plan, q: &[N], chain: &Chain<N>, y: Vec<N>, around: &Around<'_, N>) -> Self {
        let (n, zero) = (chain.masses(), N::splat(0.0));
        let (phi, omega, outside) = (y[2 * (n - 1) + 1], chain.speed(n - 1, &y), &around.outside);
        let coupled = outside.coupled(omega);
        let torque = outside.torque + coupled;
        let braking = outside.brake * direction(around.senses[around.braked]);
        let mut instant = Instant {
            motion: Motion::new(&plan.mechanism, q),
            angle: (0..n).map(|mass| chain.angle(mass, phi, &y)).collect(),
            speed: (0..n).map(|mass| chain.speed(mass, &y)).collect(),
            acceleration: vec![zero; n],
            links: Vec::new(),
            motor_speed: omega * q[plan.drive.ratio],
            motor: zero,
            power: zero,
            drive: zero,
            load: braking - torque,
            coupled,
            inertia: zero,
            kinetic: zero,
            y,
        };
        let mut net = vec![zero; n];
        net[n - 1] = torque;
        net[around.braked] = net[around.braked] - braking;
        instant.add_links(chain, around, &mut net);
        let equation = Equation { plan, q, chain };
        chain.drivers.iter().for_each(|driver| instant.add_driver(equation, driver, around, &mut net));
        chain.loads.iter().for_each(|load| instant.add_load(equation, load, around, &mut net));
        instant.add_swing(chain, &mut net);
        let mut inertia = chain.inertia.clone();
        inertia.push(-chain.apart);
        instant.add_mechanisms(plan, q, chain, around, (&mut inertia, &mut net));
        for mass in 0..n {
            instant.kinetic = instant.kinetic + inertia[mass] * instant.speed[mass].squared() * 0.5;
            if around.senses[mass] != 0.0 {
                instant.acceleration[mass] = net[mass] / inertia[mass];
            }
        }
        instant
    }

    fn add_links(&mut self, chain: &Chain<N>, around: &Around<'_, N>, net: &mut [N]) {
        for (link, &zone) in chain.links.iter().zip(around.zones) {
            let [twist, rate] = chain.twist(link, &self.y);
            let torque = link.law.of_zone(zone, twist, rate).value;
            net[link.first] = net[link.first] - torque;
            net[link.second] = net[link.second] + torque;
            self.links.push([twist, torque]);
        }
    }

    fn add_driver(
        &mut self,
        equation: Equation<'_, N>,
        driver: &Torque<N>,
        around: &Around<'_, N>,
        net: &mut [N],
    ) {
        let (mass, speed) = (driver.mass, self.speed[driver.mass]);
        let (along, supplied) = (direction(around.senses[mass]), around.motor * around.supply);
        let geared = |plan: &Plan, q: &[N]| {
            let torque = plan.drive.motor_torque::<N, N>(&plan.tables, q, speed * around.motor) * supplied;
            (torque, q[plan.drive.ratio], plan.drive.geared_torque::<N, N>(q, torque * along) * along)
        };
        let (torque, ratio, behind) = match &driver.source {
            Source::Own => geared(equation.plan, equation.q),
            Source::Motor(part) => geared(&part.plan, &part.q),
            // It drives in one direction, whichever way its mass turns.
            _ => {
                let odd = equation.outside(driver, speed).value;
                let torque = speed.select_lt(N::splat(0.0), -odd, odd) * supplied;
                (torque, N::splat(1.0), torque)
            }
        };
        if matches!(driver.source, Source::Own) {
            (self.motor, self.motor_speed) = (torque, speed * ratio);
        }
        self.power = self.power + torque * ratio * speed;
        self.drive = self.drive + behind;
        net[mass] = net[mass] + behind;
    }

    fn add_load(
        &mut self,
        equation: Equation<'_, N>,
        load: &Torque<N>,
        around: &Around<'_, N>,
        net: &mut [N],
    ) {
        let torque = match load.source {
            // Dry: as large at rest as in motion.
            Source::Power { torque, exponent, .. } if exponent.max_lane() == 0.0 => {
                torque * -direction(around.senses[load.mass])
            }
            _ => -equation.outside(load, self.speed[load.mass]).value,
        };
        net[load.mass] = net[load.mass] - torque;
        self.load = self.load + torque;
    }

    fn add_swing(&self, chain: &Chain<N>, net: &mut [N]) {
        let Some(swing) = &chain.swing else { return };
        let others = chain.masses() - 1;
        let zero = N::splat(0.0);
        let beside = |mass: usize| if mass < others { self.y[others + mass] } else { zero };
        let together = (0..others).fold(zero, |sum, mass| sum + swing.share[mass] * beside(mass));
        for (mass, &damping) in swing.damping.iter().enumerate() {
            net[mass] = net[mass] - damping * (beside(mass) - together);
        }
    }

    fn add_mechanisms(
        &mut self,
        plan: &Plan,
        q: &[N],
        chain: &Chain<N>,
        around: &Around<'_, N>,
        (inertia, net): (&mut [N], &mut [N]),
    ) {
        let crank = chain.masses() - 1;
        let at = |mass: usize| (direction(around.senses[mass]), around.slow, around.time);
        let place = [self.angle[crank], self.speed[crank]];
        let [J, swung, load] = felt(plan, q, place, at(crank), &mut self.motion);
        self.inertia = J;
        inertia[crank] = inertia[crank] + J;
        net[crank] = net[crank] - swung - load;
        self.load = self.load + load;
        for station in &chain.stations {
            let (r, mass, plan) = (station.ratio, station.mass, &station.part.plan);
            let q: Vec<N> = station.part.q.iter().map(|&x| N::splat(x)).collect();
            let place = [r * self.angle[mass] + station.phase, r * self.speed[mass]];
            let mut motion = Motion::new(&plan.mechanism, &q);
            let [J, swung, load] = felt(plan, &q, place, at(mass), &mut motion);
            inertia[mass] = inertia[mass] + r * r * J;
            net[mass] = net[mass] - r * (swung + load);
            self.load = self.load + r * load;
        }
    }

    /// Place of a state in `y`: angle and speed of the crank come first.
    pub fn place(n: usize, others: usize) -> usize {
        match n {
            0 => 2 * others + 1,
            1 => 2 * others,
            n => n - 2,
        }
    }

    /// A state by number.
    pub fn state(&self, n: usize) -> Option<N> {
        self.y.get(Self::place(n, self.speed.len() - 1)).copied().filter(|_| n < self.y.len())
    }

    /// The rate of a state by number.
    pub fn rate(&self, n: usize) -> Option<N> {
        let others = self.speed.len() - 1;
        let crank = self.acceleration[others];
        match n {
            0 => Some(self.speed[others]),
            1 => Some(crank),
            n if n - 2 < others => Some(self.y[others + n - 2]),
            n => self.acceleration[..others].get(n - 2 - others).map(|&a| a - crank),
        }
    }

    /// Torque of the motor at its shaft, torque at the crank behind the gearbox, load torque, inertia at the crank, power at the
    /// shafts, kinetic energy, speed of the motor, torque of the coupling with the load.
    pub fn crank(&self, n: usize) -> Option<N> {
        let Instant { motor, drive, load, inertia, power, kinetic, motor_speed, coupled, .. } = *self;
        [motor, drive, load, inertia, power, kinetic, motor_speed, coupled].get(n).copied()
    }
}
