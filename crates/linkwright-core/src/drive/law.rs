//! Loads that follow a law: a formula on a point, a slide or a link, or a damper by a table.
//!
//! What does not depend on the size of the crank's speed is part of the reduction, and so is what is in
//! proportion to it. Everything else is a law: at each stage of a solver the little that it needs is kept
//! ([`LawGeometry`]), and it is evaluated with the speed of that moment.

use crate::drive::loads::{At, FormulaLoad, Load, What};
use crate::drive::structure::Plan;
use crate::kernel::branch::OnBranch;
use crate::kernel::dual::Dual;
use crate::kernel::formula::{Formula, Inputs, Switch, Variable};
use crate::kernel::out_of_line;
use crate::kernel::plane::Vec2;
use crate::kernel::real::{Lift, Real};
use crate::kernel::table::Knot;
use crate::linkage::mechanism::Element;
use crate::linkage::motion::Motion;
use std::f64::consts::TAU;

/// What a law needs to know of the machine at one crank angle.
#[derive(Clone, Copy, Debug)]
pub struct LawGeometry<R> {
    /// Crank angle within the cycle.
    phi: R,
    p: Vec2<R>,
    d1: Vec2<R>,
    s: R,
    /// s′, or |p′|.
    path: R,
    psi: R,
    psi_d1: R,
    /// Transfer function of the way that the load acts along.
    g: R,
}

/// A place where a law has a kink or a jump that depends on the speed, or on time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedKink {
    law: usize,
    at: KinkPlace,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum KinkPlace {
    /// In front of this instruction of the formula.
    Switch(usize),
    /// Where the speed passes this knot.
    Knot(Knot),
}

/// The machine at one place of a motion, with derivatives along it. The angle goes on from revolution to revolution.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    pub phi: Dual<f64>,
    pub omega: Dual<f64>,
    pub time: Dual<f64>,
}

impl Moment {
    /// Of a steady motion, which knows no time.
    pub(super) fn steady(phi: f64, omega: Dual<f64>) -> Self {
        Moment { phi: Dual::variable(phi), omega, time: Dual::constant(f64::NAN) }
    }
}

impl<R: Real> LawGeometry<R> {
    /// With what it is at a reference: the law then keeps to the branch that it has there.
    #[inline(always)]
    pub fn on_branch_of(&self, reference: &Self) -> LawGeometry<OnBranch<R, R>> {
        let on = |value: R, at: R| OnBranch { value, at };
        let both = |v: Vec2<R>, at: Vec2<R>| Vec2 { x: on(v.x, at.x), y: on(v.y, at.y) };
        LawGeometry {
            phi: on(self.phi, reference.phi),
            p: both(self.p, reference.p),
            d1: both(self.d1, reference.d1),
            s: on(self.s, reference.s),
            path: on(self.path, reference.path),
            psi: on(self.psi, reference.psi),
            psi_d1: on(self.psi_d1, reference.psi_d1),
            g: on(self.g, reference.g),
        }
    }

    #[inline(always)]
    fn nothing() -> Self {
        let zero = R::splat(0.0);
        LawGeometry {
            phi: zero,
            p: Vec2::zero(),
            d1: Vec2::zero(),
            s: zero,
            path: zero,
            psi: zero,
            psi_d1: zero,
            g: zero,
        }
    }

    /// The way alone.
    #[inline(always)]
    fn of_way(at: &At, q: &[R], m: &Motion<R>) -> Self {
        LawGeometry { g: at.way(false, q, m).d1, ..LawGeometry::nothing() }
    }

    /// Values of the variables at speed ω and time t.
    #[inline(always)]
    fn inputs<N: Lift<R>>(&self, omega: N, time: N) -> Inputs<N> {
        Inputs {
            phi: N::lift(self.phi),
            omega,
            time,
            x: N::lift(self.p.x),
            y: N::lift(self.p.y),
            vx: N::lift(self.d1.x) * omega,
            vy: N::lift(self.d1.y) * omega,
            v: N::lift(self.path) * omega,
            s: N::lift(self.s),
            psi: N::lift(self.psi),
            psi_dot: N::lift(self.psi_d1) * omega,
        }
    }
}

/// The crank angle within a cycle of some revolutions, from 0 on, which a formula knows.
#[inline(always)]
fn within_cycle<R: Real>(phi: R, turns: u32) -> R {
    let cycle = TAU * f64::from(turns);
    phi.map(
        #[inline(always)]
        |phi| (if (0.0..=cycle).contains(&phi) { phi } else { phi.rem_euclid(cycle) }, 1.0),
    )
}

impl FormulaLoad {
    /// The machine at one angle, as the formula needs it.
    #[inline(always)]
    fn geometry<R: Real>(&self, formula: &Formula, q: &[R], phi: R, m: &Motion<R>) -> LawGeometry<R> {
        let mut geometry = LawGeometry::of_way(&self.at, q, m);
        if formula.reads(Variable::Phi) {
            geometry.phi = within_cycle(phi, self.turns);
        }
        match self.at {
            At::Slide { slide, point } => {
                let slide = &m.slides[slide];
                (geometry.s, geometry.path) = (slide.s, slide.d1);
                (geometry.p, geometry.d1) = (m.points[point].p, m.points[point].d1);
            }
            At::Point { point } | At::Toward { point, .. } => geometry.on_point(point, m),
            At::Along { point, link, .. } => {
                geometry.on_point(point, m);
                geometry.on_link(link, formula, m);
            }
            At::Link { link } => geometry.on_link(link, formula, m),
            _ => {}
        }
        geometry
    }

    /// Derivatives by φ of what the formula needs, for the zeros of its switches; at speed 1.
    #[inline(always)]
    fn over_angle<R: Real>(&self, formula: &Formula, phi: R, m: &Motion<R>) -> Inputs<Dual<R>> {
        let one = R::splat(1.0);
        let dual = Inputs {
            phi: Dual {
                value: if formula.reads(Variable::Phi) { within_cycle(phi, self.turns) } else { phi },
                d: one,
            },
            ..LawGeometry::<Dual<R>>::nothing().inputs(Dual::constant(one), Dual::constant(one))
        };
        match self.at {
            At::Slide { slide, point } => {
                let slide = &m.slides[slide];
                let (s, v) = (Dual { value: slide.s, d: slide.d1 }, Dual { value: slide.d1, d: slide.d2 });
                Inputs { s, v, ..with_point(dual, point, m) }
            }
            At::Point { point } | At::Toward { point, .. } => with_point(dual, point, m),
            At::Along { point, link, .. } => with_link(with_point(dual, point, m), link, formula, m),
            At::Link { link } => with_link(dual, link, formula, m),
            _ => dual,
        }
    }

    /// What the formula needs along a motion.
    pub(super) fn along(&self, formula: &Formula, at: &Moment, m: &Motion<f64>) -> Inputs<Dual<f64>> {
        let &Moment { phi, omega, time } = at;
        let unit = self.over_angle(formula, phi.value, m);
        let unit = unit.map(|by_phi| Dual { d: by_phi.d * phi.d, ..by_phi });
        let [vx, vy, v, psi_dot] =
            [unit.vx, unit.vy, unit.v, unit.psi_dot].map(|per_speed| per_speed * omega);
        Inputs { omega, time, vx, vy, v, psi_dot, ..unit }
    }
}

impl<R: Real> LawGeometry<R> {
    #[inline(always)]
    fn on_point(&mut self, point: usize, m: &Motion<R>) {
        let place = &m.points[point];
        (self.p, self.d1) = (place.p, place.d1);
        self.path = place.d1.dot(place.d1).sqrt();
    }

    #[inline(always)]
    fn on_link(&mut self, link: usize, formula: &Formula, m: &Motion<R>) {
        let heading = &m.links[link];
        self.psi_d1 = heading.d1;
        if formula.reads(Variable::Psi) {
            self.psi = heading.e.y.atan2(heading.e.x);
        }
    }
}

/// The inputs with those of a point, and their derivatives by φ.
#[inline(always)]
fn with_point<R: Real>(inputs: Inputs<Dual<R>>, point: usize, m: &Motion<R>) -> Inputs<Dual<R>> {
    let place = &m.points[point];
    let size = place.d1.dot(place.d1).sqrt();
    Inputs {
        x: Dual { value: place.p.x, d: place.d1.x },
        y: Dual { value: place.p.y, d: place.d1.y },
        vx: Dual { value: place.d1.x, d: place.d2.x },
        vy: Dual { value: place.d1.y, d: place.d2.y },
        v: Dual { value: size, d: place.d1.dot(place.d2) / size },
        ..inputs
    }
}

/// The inputs with those of a link, and their derivatives by φ.
#[inline(always)]
fn with_link<R: Real>(
    inputs: Inputs<Dual<R>>,
    link: usize,
    formula: &Formula,
    m: &Motion<R>,
) -> Inputs<Dual<R>> {
    let heading = &m.links[link];
    let psi = if formula.reads(Variable::Psi) { heading.e.y.atan2(heading.e.x) } else { inputs.psi.value };
    Inputs {
        psi: Dual { value: psi, d: heading.d1 },
        psi_dot: Dual { value: heading.d1, d: heading.d2 },
        ..inputs
    }
}

impl Plan {
    /// Torque on the crank that resists, by a formula of degree 0 (per unit of speed, of degree 1), at the
    /// speed `sense` = ±1.
    #[inline(always)]
    pub fn formula_torque<R: Real>(
        &self,
        load: &FormulaLoad,
        q: &[R],
        phi: R,
        sense: f64,
        m: &Motion<R>,
    ) -> R {
        let formula = &self.formulas[load.formula];
        let geometry = load.geometry(formula, q, phi, m);
        let sense = R::splat(sense);
        -(formula.value(q, &geometry.inputs(sense, R::splat(f64::NAN))) * geometry.g)
    }

    /// What a formula gives at a speed of the crank; NaN where it asks for the time.
    #[inline(always)]
    pub fn force<R: Real>(&self, load: &FormulaLoad, q: &[R], phi: R, omega: R, m: &Motion<R>) -> R {
        let formula = &self.formulas[load.formula];
        formula.value(q, &load.geometry(formula, q, phi, m).inputs(omega, R::splat(f64::NAN)))
    }

    /// Adds what each law needs to know at an angle at which the mechanism has been placed.
    #[inline(always)]
    pub fn add_geometry<R: Real>(&self, q: &[R], phi: R, m: &Motion<R>, to: &mut Vec<LawGeometry<R>>) {
        for law in &self.laws {
            to.push(out_of_line!(
                R,
                match law.formula() {
                    Some(load) => load.geometry(&self.formulas[load.formula], q, phi, m),
                    None => LawGeometry::of_way(&law.at, q, m),
                }
            ));
        }
    }

    /// Torque of all laws that resists \[N m\] at crank speed ω and time t.
    #[inline(always)]
    pub fn law_torque<R, G, N>(&self, q: &[R], geometry: &[LawGeometry<G>], omega: N, time: N) -> N
    where
        R: Real,
        G: Real,
        N: Lift<R> + Lift<G>,
    {
        let mut sum = N::splat(0.0);
        for (law, geometry) in self.laws.iter().zip(geometry) {
            let g: N = Lift::<G>::lift(geometry.g);
            sum = match law.what {
                What::Formula { formula, .. } => {
                    let inputs = geometry.inputs(omega, time);
                    sum - self.formulas[formula].value::<R, N>(q, &inputs) * g
                }
                What::OverSpeed { table } => self.tables[table].held_at(g * omega, q) * g + sum,
                _ => sum,
            };
        }
        sum
    }

    /// Laws that are formulas.
    pub(super) fn formula_laws(&self) -> impl Iterator<Item = FormulaLoad> + '_ {
        self.laws.iter().filter_map(Load::formula)
    }

    /// Whether some law depends on time, so that no turn repeats another.
    pub fn knows_time(&self) -> bool {
        self.formulas.iter().any(|formula| formula.reads(Variable::Time))
    }

    /// Whether the acceleration may jump at an angle: by a formula, or where a motion law goes from piece to piece.
    pub fn jumps_over_angle(&self) -> bool {
        self.switches_over_angle(|switch| switch.jumps)
    }

    /// Whether it may jump or bend at an angle, so that its derivatives jump.
    pub fn bends_over_angle(&self) -> bool {
        self.switches_over_angle(|_| true)
    }

    fn switches_over_angle(&self, is_one: impl Fn(&Switch) -> bool) -> bool {
        let mut switches = self.formulas.iter().flat_map(|formula| &formula.switches);
        switches.any(|switch| switch.is_still() && is_one(switch))
            || self.mechanism.elements.iter().any(|element| matches!(element, Element::Programme(_)))
    }

    /// Whether some law has kinks, or jumps, whose angle depends on the speed.
    pub fn may_jump(&self) -> bool {
        !self.speed_kinks().is_empty()
    }

    /// Kinks of laws whose angle depends on the speed.
    pub fn speed_kinks(&self) -> Vec<SpeedKink> {
        let mut found = Vec::new();
        for (law, each) in self.laws.iter().enumerate() {
            match each.what {
                What::Formula { formula, .. } => {
                    let switches = self.formulas[formula].switches.iter();
                    let moving = switches.filter(|switch| !switch.is_still());
                    found.extend(moving.map(|s| SpeedKink { law, at: KinkPlace::Switch(s.at) }));
                }
                What::OverSpeed { table } => {
                    let knots = self.tables[table].moving_knots().filter(|knot| knot.x != 0.0);
                    found.extend(knots.map(|knot| SpeedKink { law, at: KinkPlace::Knot(knot) }));
                }
                _ => {}
            }
        }
        found
    }

    /// The quantity whose zero is a moving kink; of a steady motion, whose laws know no time, that is NaN.
    #[inline(always)]
    pub fn speed_kink_value<R: Real>(
        &self,
        q: &[R],
        kink: SpeedKink,
        geometry: &[LawGeometry<R>],
        [omega, time]: [R; 2],
    ) -> R {
        let geometry = &geometry[kink.law];
        match (kink.at, self.laws[kink.law].what) {
            (KinkPlace::Switch(at), What::Formula { formula, .. }) => {
                self.formulas[formula].switch(at, q, &geometry.inputs(omega, time))
            }
            (KinkPlace::Knot(knot), _) => geometry.g * omega - knot.number(q),
            (KinkPlace::Switch(_), _) => R::splat(f64::NAN),
        }
    }

    /// The argument of a switch and its derivative by φ, at speed 1.
    #[inline(always)]
    pub fn switch_over_angle<R: Real>(
        &self,
        (load, at): (FormulaLoad, usize),
        q: &[R],
        phi: R,
        m: &Motion<R>,
    ) -> (R, R) {
        let formula = &self.formulas[load.formula];
        let value: Dual<R> = formula.switch(at, q, &load.over_angle(formula, phi, m));
        (value.value, value.d)
    }
}
