//! A further mechanism, whose crank stands where the state of the driveline has it.
//!
//! With the angle θ and the speed w of its mass its crank is at ψ = r θ + β and turns at Ω = r w. At the mass it counts as
//!
//! ```text
//! I = r² J(ψ),   I a + ½ I′ w² + r M(ψ, Ω) = T,   I′ = r³ dJ/dψ
//! ```
//!
//! Its angle is a number of the state, so that Newton's method asks for derivatives by it: duals of ψ carry them through the mechanism.
//! Where the numbers of the driveline carry derivatives themselves, each quantity goes along by its slopes over ψ and Ω.
//!
//! Source: e.g. Dresig, Holzweißig, *Dynamics of Machinery*, sections 2.3 and 4.3.

use crate::chain::Station;
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::real::{LANES_MAX, Real};

/// What a mass feels of a mechanism, with derivatives by angle θ and speed w of the mass.
#[derive(Clone, Copy, Debug)]
pub struct Felt<N = f64> {
    /// I \[kg m²\].
    pub inertia: N,
    /// dI/dθ.
    pub inertia_d1: N,
    /// d²I/dθ².
    pub inertia_d2: N,
    /// Torque that the loads ask of the mass \[N m\].
    pub load: N,
    /// Its derivative by θ.
    pub load_by_angle: N,
    /// Its derivative by w.
    pub load_by_speed: N,
}

/// J, J′, J″, M, ∂M/∂ψ and ∂M/∂Ω at the crank of the mechanism.
type Own = [f64; 6];

/// These with their slopes over ψ and over Ω.
type WithSlopes = [[f64; 3]; 6];

/// Room to place a mechanism.
pub struct Place {
    q: Vec<Dual<f64>>,
    motion: Motion<Dual<f64>>,
    geometry: Vec<LawGeometry<Dual<f64>>>,
}

impl Place {
    /// Room for a mechanism.
    pub fn new<N>(station: &Station<N>) -> Self {
        let q: Vec<_> = station.part.q.iter().map(|&x| Dual::constant(x)).collect();
        Place { motion: Motion::new(&station.part.plan.mechanism, &q), q, geometry: Vec::new() }
    }

    /// What a mass at an angle, with a speed, feels of its mechanism, as that is a little `before` \[rad\].
    #[inline(always)]
    pub fn felt<N: Real>(&mut self, station: &Station<N>, theta: N, speed: N, before: f64) -> Felt<N> {
        let r = station.ratio;
        let (psi, omega) = (r * theta + station.phase, r * speed);
        let [J, J_d1, J_d2, load, by_angle, by_speed] = self.along(&station.part.plan, psi - before, omega);
        let (J, J_d1, load) = (J + J_d1 * before, J_d1 + J_d2 * before, load + by_angle * before);
        let square = r * r;
        Felt {
            inertia: square * J,
            inertia_d1: square * r * J_d1,
            inertia_d2: square * square * J_d2,
            load: r * load,
            load_by_angle: square * by_angle,
            load_by_speed: square * by_speed,
        }
    }

    /// What the mechanism has at an angle and a speed that may be duals, or lanes.
    #[inline(always)]
    fn along<N: Real>(&mut self, plan: &Plan, psi: N, omega: N) -> [N; 6] {
        let mut at = [[0.0; LANES_MAX]; 2];
        psi.store(&mut at[0]);
        omega.store(&mut at[1]);
        let mut values = [[[0.0; LANES_MAX]; 3]; 6];
        for lane in 0..N::LANES {
            let own = [at[0][lane], at[1][lane]];
            let found = if lane > 0 && own == [at[0][lane - 1], at[1][lane - 1]] {
                values.map(|of| of.map(|lanes| lanes[lane - 1]))
            } else if N::IS_PLAIN {
                self.own(plan, own).map(|value| [value, 0.0, 0.0])
            } else {
                with_slopes(plan, &self.q, own)
            };
            for (to, from) in values.iter_mut().flatten().zip(found.into_iter().flatten()) {
                to[lane] = from;
            }
        }
        // Without derivatives of their own both are zero.
        let (d_psi, d_omega) = (psi - N::load(&at[0]), omega - N::load(&at[1]));
        values.map(|[value, by_psi, by_omega]| {
            let slopes = N::load(&by_psi) * d_psi + N::load(&by_omega) * d_omega;
            N::load(&value) + slopes
        })
    }

    fn own(&mut self, plan: &Plan, [psi, omega]: [f64; 2]) -> Own {
        let at = Dual::variable(psi.rem_euclid(plan.cycle()));
        let reduced = plan.reduce::<Dual<f64>, 2>(&self.q, Angle::new(at), 1.0, &mut self.motion);
        let load = reduced.viscous * omega + reduced.load + reduced.dry;
        let (mut value, mut by_angle, mut by_speed) = (load.value, load.d, reduced.viscous.value);
        if !plan.drive.speed_loads.is_empty() {
            let q: Vec<f64> = self.q.iter().map(|x| x.value).collect();
            let torque = plan.drive.speed_load(&plan.tables, &q, Dual::variable(omega));
            (value, by_speed) = (value + torque.value, by_speed + torque.d);
        }
        if !plan.laws.is_empty() {
            self.geometry.clear();
            plan.add_geometry(&self.q, at, &self.motion, &mut self.geometry);
            // By the speed outside, by the angle inside; a steady motion knows no time.
            let torque: Dual<Dual<f64>> = plan.law_torque::<Dual<f64>, Dual<f64>, _>(
                &self.q,
                &self.geometry,
                Dual::variable(Dual::constant(omega)),
                Dual::splat(f64::NAN),
            );
            value += torque.value.value;
            by_angle += torque.value.d;
            by_speed += torque.d.value;
        }
        [reduced.J.value, reduced.J.d, reduced.J_d1.d, value, by_angle, by_speed]
    }
}

/// The same with slopes, by duals of duals.
fn with_slopes(plan: &Plan, q: &[Dual<f64>], [psi, omega]: [f64; 2]) -> WithSlopes {
    type Twice = Dual<Dual<f64>>;
    let q: Vec<Twice> = q.iter().map(|&x| Dual::constant(x)).collect();
    let mut motion = Motion::new(&plan.mechanism, &q);
    let at: Twice = Dual::variable(Dual::variable(psi.rem_euclid(plan.cycle())));
    let reduced = plan.reduce::<Twice, 2>(&q, Angle::new(at), 1.0, &mut motion);
    let viscous = reduced.viscous;
    let load = viscous * omega + reduced.load + reduced.dry;
    let (J, J_d1) = (reduced.J, reduced.J_d1);
    let mut found = [
        [J.value.value, J.d.value, 0.0],
        [J_d1.value.value, J_d1.d.value, 0.0],
        [J_d1.d.value, J_d1.d.d, 0.0],
        [load.value.value, load.d.value, viscous.value.value],
        [load.d.value, load.d.d, viscous.d.value],
        [viscous.value.value, viscous.d.value, 0.0],
    ];
    let mut add = |by: [[f64; 3]; 3]| {
        for (to, from) in found[3..].iter_mut().flatten().zip(by.into_iter().flatten()) {
            *to += from;
        }
    };
    if !plan.drive.speed_loads.is_empty() {
        let numbers: Vec<Dual<f64>> = q.iter().map(|x| x.value).collect();
        let speed = Dual::variable(Dual::variable(omega));
        let torque: Twice = plan.drive.speed_load(&plan.tables, &numbers, speed);
        add([[torque.value.value, 0.0, torque.d.value], [0.0; 3], [torque.d.value, 0.0, torque.d.d]]);
    }
    if !plan.laws.is_empty() {
        let mut geometry = Vec::new();
        plan.add_geometry(&q, at, &motion, &mut geometry);
        let never = Dual::splat(f64::NAN);
        // By the speed outside, by the angle inside; twice by the speed where that is what is asked for.
        let torque: Dual<Twice> = plan.law_torque::<Twice, Twice, _>(
            &q,
            &geometry,
            Dual::variable(Dual::constant(Dual::constant(omega))),
            never,
        );
        let (value, by_speed) = (torque.value, torque.d);
        let bend = law_bend(plan, &q, &geometry, omega);
        add([
            [value.value.value, value.d.value, by_speed.value.value],
            [value.d.value, value.d.d, by_speed.d.value],
            [by_speed.value.value, by_speed.d.value, bend],
        ]);
    }
    found
}

/// Second derivative of the torque of laws by the speed.
fn law_bend(
    plan: &Plan,
    q: &[Dual<Dual<f64>>],
    geometry: &[LawGeometry<Dual<Dual<f64>>>],
    omega: f64,
) -> f64 {
    let speed = Dual::variable(Dual::variable(Dual::constant(omega)));
    let torque: Dual<Dual<Dual<f64>>> =
        plan.law_torque::<Dual<Dual<f64>>, Dual<Dual<f64>>, _>(q, geometry, speed, Dual::splat(f64::NAN));
    torque.d.d.value
}
