//! Reduction to the crank: all masses and loads of a mechanism as functions of the crank angle.
//!
//! ```text
//! J_red(φ) = J₀ + Σ m |p′|² + J ψ′²          J′_red = 2 Σ m p′·p″ + J ψ′ ψ″
//! M_red(φ) = Σ F·p′ + Σ M ψ′                 (virtual work)
//! ```
//!
//! Source: e.g. Artobolevsky, *Theory of Mechanisms and Machines*, ch. 15 (reduced mass and force);
//! paper 1, equations (5) and (10), for the slider-crank with rod.

use crate::drive::loads::{At, Body, FormulaLoad, Load, What};
use crate::drive::structure::Plan;
use crate::drive::way::Way;
use crate::kernel::call::poll;
use crate::kernel::formula::Degree;
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::out_of_line;
use crate::kernel::plane::{Angle, Place, Vec2};
use crate::kernel::real::Real;
use crate::linkage::motion::{Motion, on_link};
use std::f64::consts::TAU;

/// The machine reduced to the crank at one angle. The load torque at speed ω is
/// `load + sense·dry + viscous·ω`, with `sense` the direction of rotation.
#[derive(Clone, Copy, Debug)]
pub struct Reduction<R> {
    /// J_red \[kg m²\], motor and gearbox included.
    pub J: R,
    /// dJ_red/dφ \[kg m²/rad\]; zero at order 1.
    pub J_d1: R,
    /// Load torque of loads that do not ask for the direction \[N m\].
    pub load: R,
    /// Load torque of dry loads, not negative when they are true resistances \[N m\].
    pub dry: R,
    /// Viscous coefficient \[N m s/rad\].
    pub viscous: R,
}

/// The machine reduced to its crank at each of some angles; `sense` is the direction of rotation.
pub fn reductions(plan: &Plan, q: &[f64], angles: &[f64], sense: f64) -> Vec<Reduction<f64>> {
    in_lanes(ReductionJob { plan, q, angles, sense })
}

struct ReductionJob<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    angles: &'a [f64],
    sense: f64,
}

impl Job for ReductionJob<'_> {
    type Output = Vec<Reduction<f64>>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let ReductionJob { plan, q, angles, sense } = self;
        let q: Vec<R> = q.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(&plan.mechanism, &q);
        let (mut lanes, mut numbers) = (vec![0.0; R::LANES], vec![0.0; 5 * R::LANES]);
        let mut found = Vec::with_capacity(angles.len());
        for angles in angles.chunks(R::LANES) {
            poll();
            lanes.fill(angles[0]);
            lanes[..angles.len()].copy_from_slice(angles);
            let r = out_of_line!(R, plan.reduce::<R, 2>(&q, Angle::new(R::load(&lanes)), sense, &mut m));
            let columns = numbers.chunks_exact_mut(R::LANES);
            for (number, to) in [r.J, r.J_d1, r.load, r.dry, r.viscous].into_iter().zip(columns) {
                number.store(to);
            }
            let of = |number: usize, lane: usize| numbers[number * R::LANES + lane];
            found.extend((0..angles.len()).map(|lane| Reduction {
                J: of(0, lane),
                J_d1: of(1, lane),
                load: of(2, lane),
                dry: of(3, lane),
                viscous: of(4, lane),
            }));
        }
        found
    }
}

impl Plan {
    /// Places the mechanism and reduces it. `sense` is +1 or −1, the direction of rotation, which decides
    /// between the forward and the back table of a force over position.
    #[inline(always)]
    pub fn reduce<R: Real, const ORDER: u8>(
        &self,
        q: &[R],
        angle: Angle<R>,
        sense: f64,
        m: &mut Motion<R>,
    ) -> Reduction<R> {
        self.mechanism.place::<R, ORDER>(q, angle, m);
        let zero = R::splat(0.0);
        let mut r = Reduction { J: q[self.drive.inertia], J_d1: zero, load: zero, dry: zero, viscous: zero };
        let mut gravity = Vec2::zero();
        for load in &self.loads {
            if let (At::Bodies { cos, sin }, What::Constant { size }) = (load.at, load.what) {
                gravity = gravity + Vec2::new(q[cos], q[sin]) * q[size];
            }
        }
        for body in &self.bodies {
            add_body::<R, ORDER>(body, q, gravity, m, &mut r);
        }
        for load in &self.loads {
            self.add_load(load, q, angle, sense, m, &mut r);
        }
        for &gap in &m.gaps {
            // A dyad without mass leaves no trace in J: where it does not close there is no motion either.
            r.J = gap.select_lt(R::splat(0.0), R::splat(f64::NAN), r.J + gap * 0.0);
        }
        r
    }

    #[inline(always)]
    fn add_load<R: Real>(
        &self,
        load: &Load,
        q: &[R],
        angle: Angle<R>,
        sense: f64,
        m: &Motion<R>,
        r: &mut Reduction<R>,
    ) {
        let way = load.at.way(load.what.knows_position(), q, m);
        match load.what {
            What::Constant { size } => r.load = r.load - way.d1 * q[size],
            What::Dry { size } => r.dry = way.d1.abs().mul_add(q[size], r.dry),
            What::Viscous { damping } => r.viscous = way.squared.mul_add(q[damping], r.viscous),
            What::Spring { stiffness, free_length, preload } => {
                let pull = (way.position - q[free_length]).mul_add(q[stiffness], q[preload]);
                r.load = pull.mul_add(way.d1, r.load);
            }
            What::Resistance { forward, back } => {
                let ahead = self.tables[forward].held_at(way.position, q);
                let behind = self.tables[back].held_at(way.position, q);
                let force = (way.d1 * sense).select_lt(R::splat(0.0), behind, ahead);
                r.dry = way.d1.abs().mul_add(force, r.dry);
            }
            What::OverAngle { table, turns } => {
                let force = self.tables[table].periodic_at(angle.phi, TAU * f64::from(turns), q);
                r.load = r.load - force * way.d1;
            }
            _ => {
                let (load, viscous) = out_of_line!(R, self.rarer(load, way, q, angle.phi, sense, m));
                (r.load, r.viscous) = (r.load + load, r.viscous + viscous);
            }
        }
    }

    /// Load torque and viscous coefficient of what few machines have: others do not pay for it.
    ///
    /// Gas at pressure p and volume V keeps p Vⁿ, e.g. Baehr, Kabelac, *Thermodynamik*, on polytropic changes of state: a gas
    /// spring of rod area A pushes with F₁ (V₁/(V₁ − A way))ⁿ, the pressure outside being neglected against that inside.
    #[inline(always)]
    fn rarer<R: Real>(&self, load: &Load, way: Way<R>, q: &[R], phi: R, sense: f64, m: &Motion<R>) -> (R, R) {
        let zero = R::splat(0.0);
        match load.what {
            What::Curve { table } => (self.tables[table].held_at(way.position, q) * way.d1, zero),
            What::Gas { force, length, column, exponent } => {
                let left = q[column] - (q[length] - way.position);
                let push = q[force] * ((q[column] / left).ln() * q[exponent]).exp();
                (-(push * way.d1), zero)
            }
            What::Formula { formula, turns } => {
                let load = FormulaLoad { formula, at: load.at, turns };
                let torque = self.formula_torque(&load, q, phi, sense, m);
                if self.formulas[formula].degree == Degree::Of(1) {
                    (zero, torque * sense)
                } else {
                    (torque, zero)
                }
            }
            _ => (zero, zero),
        }
    }
}

#[inline(always)]
fn add_body<R: Real, const ORDER: u8>(
    body: &Body,
    q: &[R],
    gravity: Vec2<R>,
    m: &Motion<R>,
    r: &mut Reduction<R>,
) {
    match *body {
        Body::Point { point, mass } => add_mass::<R, ORDER>(&m.points[point], q[mass], gravity, r),
        Body::Link { link, origin, along, across, mass, inertia } => {
            let heading = &m.links[link];
            r.J = heading.d1.squared().mul_add(q[inertia], r.J);
            if ORDER > 1 {
                r.J_d1 = (heading.d1 * heading.d2 * 2.0).mul_add(q[inertia], r.J_d1);
            }
            let centre = on_link::<R, ORDER>(&m.points[origin], heading, q[along], q[across]);
            add_mass::<R, ORDER>(&centre, q[mass], gravity, r);
        }
    }
}

#[inline(always)]
fn add_mass<R: Real, const ORDER: u8>(place: &Place<R>, mass: R, gravity: Vec2<R>, r: &mut Reduction<R>) {
    r.J = place.d1.dot(place.d1).mul_add(mass, r.J);
    if ORDER > 1 {
        r.J_d1 = (place.d1.dot(place.d2) * 2.0).mul_add(mass, r.J_d1);
    }
    r.load = r.load - place.d1.dot(gravity) * mass;
}
