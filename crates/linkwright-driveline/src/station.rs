//! A further mechanism, whose crank stands where the state of the driveline has it.
//!
//! With the angle θ and the speed w of its mass its crank is at ψ = r θ + β and turns at r w. At the mass it counts as
//!
//! ```text
//! I = r² J(ψ),   I a + ½ I′ w² + r M(ψ, r w) = T,   I′ = r³ dJ/dψ
//! ```
//!
//! Its angle is a number of the state, so that Newton's method asks for derivatives by it: duals of ψ carry them through the mechanism.
//!
//! Source: e.g. Dresig, Holzweißig, *Dynamics of Machinery*, sections 2.3 and 4.3.

use crate::chain::Station;
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::plane::Angle;

type Number = Dual<f64>;

/// What a mass feels of a mechanism, with derivatives by angle θ and speed w of the mass.
#[derive(Clone, Copy, Debug)]
pub struct Felt {
    /// I \[kg m²\].
    pub inertia: f64,
    /// dI/dθ.
    pub inertia_d1: f64,
    /// d²I/dθ².
    pub inertia_d2: f64,
    /// Torque that the loads ask of the mass \[N m\].
    pub load: f64,
    /// Its derivative by θ.
    pub load_by_angle: f64,
    /// Its derivative by w.
    pub load_by_speed: f64,
}

/// Room to place a mechanism.
pub struct Place {
    q: Vec<Number>,
    motion: Motion<Number>,
    geometry: Vec<LawGeometry<Number>>,
}

impl Place {
    /// Room for a mechanism.
    pub fn new(station: &Station) -> Self {
        let q: Vec<Number> = station.part.q.iter().map(|&x| Dual::constant(x)).collect();
        Place { motion: Motion::new(&station.part.plan.mechanism, &q), q, geometry: Vec::new() }
    }

    /// What a mass at an angle, with a speed, feels of its mechanism.
    pub fn felt(&mut self, station: &Station, theta: f64, speed: f64) -> Felt {
        let (plan, r) = (&station.part.plan, station.ratio);
        let psi = (r * theta + station.phase).rem_euclid(plan.cycle());
        let at = Dual::variable(psi);
        let reduced = plan.reduce::<Number, 2>(&self.q, Angle::new(at), 1.0, &mut self.motion);
        let omega = r * speed;
        let load = reduced.viscous * omega + reduced.load + reduced.dry;
        let mut felt = Felt {
            inertia: r * r * reduced.J.value,
            inertia_d1: r.powi(3) * reduced.J_d1.value,
            inertia_d2: r.powi(4) * reduced.J_d1.d,
            load: r * load.value,
            load_by_angle: r * r * load.d,
            load_by_speed: r * r * reduced.viscous.value,
        };
        if !plan.drive.speed_loads.is_empty() {
            let torque = plan.drive.speed_load(&plan.tables, &station.part.q, Dual::variable(omega));
            (felt.load, felt.load_by_speed) =
                (felt.load + r * torque.value, felt.load_by_speed + r * r * torque.d);
        }
        if !plan.laws.is_empty() {
            self.geometry.clear();
            plan.add_geometry(&self.q, at, &self.motion, &mut self.geometry);
            // By the speed outside, by the angle inside; a steady motion knows no time.
            let speed = Dual::variable(Dual::constant(omega));
            let never = Dual::constant(Dual::constant(f64::NAN));
            let torque =
                plan.law_torque::<Number, Number, Dual<Number>>(&self.q, &self.geometry, speed, never);
            felt.load += r * torque.value.value;
            felt.load_by_angle += r * r * torque.value.d;
            felt.load_by_speed += r * r * torque.d.value;
        }
        felt
    }
}
