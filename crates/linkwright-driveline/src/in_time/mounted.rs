//! A mechanism on a mass, in time: that at the crank, or a further one.
//!
//! With the angle θ and the speed w of its mass its crank is at ψ = r θ + β and turns at r w; at the mass it counts with r² J(ψ),
//! ½ r³ J′ w² and r M(ψ, r w, t), as in [`crate::station`].

use crate::chain::Chain;
use crate::equation::Equation;
use linkwright_core::drive::kinks::{kinks, landings};
use linkwright_core::drive::law::{LawGeometry, SpeedKink};
use linkwright_core::drive::structure::Plan;
use linkwright_core::drive::transient::reduced::{Reduced, ReducedCurves};
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::plane::Angle;

/// What a mass feels of its mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Felt {
    /// Inertia \[kg m²\].
    pub inertia: f64,
    /// Its derivative by the angle of the mass.
    pub slope: f64,
    /// Torque of the loads \[N m\].
    pub load: f64,
}

/// What is known of a mechanism wherever it is: it serves one motion after another.
pub struct Tables {
    /// Angles of its crank between two kinks over its cycle, from 0 to its end.
    kinks: Vec<f64>,
    /// The mechanism over the angle, for both directions.
    curves: [Option<ReducedCurves>; 2],
}

impl Tables {
    /// Of a machine with its numbers, as exact as a motion asks.
    fn new(plan: &Plan, q: &[f64], accuracy: f64) -> Self {
        let kinks = landings(plan, q, kinks(plan, q));
        let curves = [-1.0, 1.0].map(|sense| ReducedCurves::new(plan, &kinks, sense, accuracy));
        Tables { kinks, curves }
    }

    /// Of all mechanisms of a driveline, that at the crank first.
    pub fn all(equation: Equation<'_>, accuracy: f64) -> Vec<Self> {
        let Equation { plan, q, chain } = equation;
        let parts = chain.stations.iter().map(|station| (&*station.part.plan, &station.part.q[..]));
        std::iter::once((plan, q)).chain(parts).map(|(plan, q)| Tables::new(plan, q, accuracy)).collect()
    }
}

/// A mechanism on a mass.
pub struct Mounted<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    /// Its mass.
    pub mass: usize,
    /// Speed of its crank over that of the mass.
    pub ratio: f64,
    /// Its crank angle where that of the mass is 0 \[rad\].
    pub phase: f64,
    /// Angles of its crank between two kinks over its cycle, from 0 to its end.
    pub kinks: Vec<f64>,
    /// Angles of its crank between two kinks, in which the step is.
    pub between: [f64; 2],
    /// Kinks of its laws over speed and time.
    pub law_kinks: Vec<SpeedKink>,
    curves: [Option<ReducedCurves>; 2],
    motion: Motion<f64>,
    geometry: Vec<LawGeometry<f64>>,
}

impl<'a> Mounted<'a> {
    /// All mechanisms of a driveline, that at the crank first, with what is known of them.
    pub fn all(equation: Equation<'a>, tables: Vec<Tables>) -> Vec<Self> {
        let Equation { plan, q, chain } = equation;
        let further = chain.stations.iter().map(|station| {
            let at = (station.mass, station.ratio, station.phase);
            (&*station.part.plan, &station.part.q[..], at)
        });
        let places = std::iter::once((plan, q, (chain.masses() - 1, 1.0, 0.0))).chain(further);
        places.zip(tables).map(|((plan, q, at), tables)| Mounted::new(plan, q, at, tables)).collect()
    }

    fn new(plan: &'a Plan, q: &'a [f64], (mass, ratio, phase): (usize, f64, f64), tables: Tables) -> Self {
        Mounted {
            plan,
            q,
            mass,
            ratio,
            phase,
            between: [f64::NEG_INFINITY, f64::INFINITY],
            law_kinks: plan.speed_kinks(),
            curves: tables.curves,
            motion: Motion::new(&plan.mechanism, q),
            geometry: Vec::new(),
            kinks: tables.kinks,
        }
    }

    /// What is known of it, for another motion.
    pub fn into_tables(self) -> Tables {
        Tables { kinks: self.kinks, curves: self.curves }
    }

    /// Whether a load knows the time, so that it may move what is at rest.
    pub fn knows_time(&self) -> bool {
        self.plan.knows_time()
    }

    /// Angle of its crank \[rad\].
    pub fn angle(&self, chain: &Chain, phi: f64, y: &[f64]) -> f64 {
        self.ratio * chain.angle(self.mass, phi, y) + self.phase
    }

    /// Speeds of its mass at which a load over the speed has a kink.
    pub fn speed_kinks(&self) -> Vec<f64> {
        if self.plan.drive.speed_loads.is_empty() {
            return Vec::new();
        }
        let own = self.plan.drive.speed_kinks(&self.plan.tables, self.q);
        own.into_iter().map(|speed| speed / self.ratio).collect()
    }

    /// Inertia J, J′, torque that resists and viscous coefficient in a direction.
    fn reduced(&mut self, psi: f64, sense: f64) -> Reduced {
        let (plan, q, between) = (self.plan, self.q, self.between);
        let curves = &mut self.curves[usize::from(sense > 0.0)];
        if let Some(found) = curves.as_mut().and_then(|curves| curves.at_between(plan, q, psi, between)) {
            return found;
        }
        let r = plan.reduce::<f64, 2>(q, Angle::new(psi), sense, &mut self.motion);
        [r.J, r.J_d1, sense * r.load + r.dry, r.viscous]
    }

    /// What its mass feels at an angle of its crank and a speed of the mass, by the loads of a direction; laws have at least the
    /// speed `slow`.
    pub fn felt(&mut self, t: f64, psi: f64, speed: f64, sense: f64, slow: f64) -> Felt {
        let (plan, q, r) = (self.plan, self.q, self.ratio);
        let omega = r * speed;
        let [inertia, slope, resisting, viscous] = self.reduced(psi, sense);
        let over_speed = plan.drive.speed_load::<f64, f64>(&plan.tables, q, sense * omega);
        let mut load = sense * (resisting + over_speed) + viscous * omega;
        if !plan.laws.is_empty() {
            self.place_laws(psi);
            load += plan.law_torque::<f64, f64, f64>(q, &self.geometry, sense * (sense * omega).max(slow), t);
        }
        Felt { inertia: r * r * inertia, slope: r.powi(3) * slope, load: r * load }
    }

    /// Derivative of what brakes its mass by the speed of that, where it was felt last.
    pub fn slope(&mut self, t: f64, psi: f64, speed: f64, sense: f64, slow: f64) -> f64 {
        let (plan, q, r) = (self.plan, self.q, self.ratio);
        let omega = r * speed;
        let [_, slope, _, viscous] = self.reduced(psi, sense);
        let over_speed = plan.drive.speed_load::<f64, _>(&plan.tables, q, Dual::variable(sense * omega)).d;
        let mut load = over_speed + viscous + slope * omega;
        if !plan.laws.is_empty() {
            let (omega, time) = (Dual::variable(sense * (sense * omega).max(slow)), Dual::constant(t));
            load += plan.law_torque::<f64, f64, Dual<f64>>(q, &self.geometry, omega, time).d;
        }
        r * r * load
    }

    /// Laws where the mechanism was placed.
    fn place_laws(&mut self, psi: f64) {
        self.geometry.clear();
        self.plan.add_geometry(self.q, psi, &self.motion, &mut self.geometry);
    }

    /// Adds the quantities whose zeros are kinks of its laws.
    pub fn add_law_kinks(&mut self, t: f64, psi: f64, speed: f64, to: &mut Vec<f64>) {
        if self.law_kinks.is_empty() {
            return;
        }
        let (plan, q, omega) = (self.plan, self.q, self.ratio * speed);
        plan.reduce::<f64, 2>(q, Angle::new(psi), 1.0, &mut self.motion);
        self.place_laws(psi);
        let value = |&kink: &SpeedKink| plan.speed_kink_value(q, kink, &self.geometry, [omega, t]);
        to.extend(self.law_kinks.iter().map(value));
    }
}
