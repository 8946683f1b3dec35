//! Reduction to the crank: all masses and loads of a mechanism as functions of the crank angle.
//!
//! ```text
//! J_red(φ) = J₀ + Σ m |p′|² + J ψ′²          J′_red = 2 Σ m p′·p″ + J ψ′ ψ″
//! M_red(φ) = Σ F·p′ + Σ M ψ′                 (virtual work)
//! ```
//!
//! Source: e.g. Artobolevsky, *Theory of Mechanisms and Machines*, ch. 15 (reduced mass and force);
//! paper 1, equations (5) and (10), for the slider-crank with rod.

use crate::law::FormulaLoad;
use crate::linkage::{Motion, Slot, on_link};
use crate::plan::Plan;
use crate::plane::{Angle, Place, Vec2};
use crate::real::Real;

/// A body: a mass at a point, or a link with its centre of mass `along`, `across` from the link's start.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    Point { point: usize, mass: Slot },
    Link { link: usize, origin: usize, along: Slot, across: Slot, mass: Slot, inertia: Slot },
}

/// A load. `Dry*` have a constant size and oppose the motion; `Viscous*` are proportional to speed.
#[derive(Clone, Copy, Debug)]
pub enum Load {
    DrySlide {
        slide: usize,
        force: Slot,
    },
    DryPoint {
        point: usize,
        force: Slot,
    },
    DryLink {
        link: usize,
        torque: Slot,
    },
    DryCrank {
        torque: Slot,
    },
    ViscousSlide {
        slide: usize,
        damping: Slot,
    },
    ViscousPoint {
        point: usize,
        damping: Slot,
    },
    ViscousLink {
        link: usize,
        damping: Slot,
    },
    /// A force fixed in direction and size.
    Force {
        point: usize,
        x: Slot,
        y: Slot,
    },
    /// A force of fixed size that turns with a link: `along` it, and `across` to its left.
    Follow {
        point: usize,
        link: usize,
        along: Slot,
        across: Slot,
    },
    /// A torque on a link, counter-clockwise positive.
    Torque {
        link: usize,
        torque: Slot,
    },
    /// Weight of every body; `x`, `y` is the acceleration of free fall.
    Gravity {
        x: Slot,
        y: Slot,
    },
    Spring {
        from: usize,
        to: usize,
        stiffness: Slot,
        free_length: Slot,
        /// Pull at the free length.
        preload: Slot,
    },
    /// Pull by a table over the length.
    SpringTable {
        from: usize,
        to: usize,
        table: usize,
    },
    /// Resistance in proportion to the speed at which two points part.
    Damper {
        from: usize,
        to: usize,
        damping: Slot,
    },
    /// Push `force`·(column/(column − way))ⁿ after being pressed in by the way from `length`.
    GasSpring {
        from: usize,
        to: usize,
        force: Slot,
        length: Slot,
        column: Slot,
        exponent: Slot,
    },
    /// Torque against the turning of a link from where it stands at the free angle (`cos`, `sin`) to
    /// another, or to the frame.
    TorsionSpring {
        link: usize,
        other: Option<usize>,
        stiffness: Slot,
        cos: Slot,
        sin: Slot,
    },
    /// Torque in proportion to the speed of a link against another, or against the frame.
    TorsionDamper {
        link: usize,
        other: Option<usize>,
        damping: Slot,
    },
    /// Force opposing the motion of a slide by tables over its position, one for each direction.
    ForcePosition {
        slide: usize,
        forward: usize,
        back: usize,
    },
    /// Torque on the crankshaft opposing positive rotation by a periodic table over φ.
    TorqueAngle {
        table: usize,
    },
    /// A formula that does not depend on the size of the speed.
    Formula(FormulaLoad),
    /// A formula in proportion to the speed.
    ViscousFormula(FormulaLoad),
}

/// The machine reduced to the crank at one angle. The resisting torque at speed ω is
/// `load + sense·dry + viscous·ω`, with `sense` the direction of rotation.
#[derive(Clone, Copy, Debug)]
pub struct Reduction<R> {
    /// J_red \[kg m²\], motor and gearbox included.
    pub J: R,
    /// dJ_red/dφ \[kg m²/rad\]; zero at order 1.
    pub J_d1: R,
    /// Resisting torque of loads that do not ask for the direction \[N m\].
    pub load: R,
    /// Resisting torque of dry loads, not negative when they are true resistances \[N m\].
    pub dry: R,
    /// Viscous coefficient \[N m s/rad\].
    pub viscous: R,
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
            if let Load::Gravity { x, y } = *load {
                gravity = gravity + Vec2::new(q[x], q[y]);
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
        match *load {
            Load::Gravity { .. } => {}
            Load::DrySlide { slide, force } => r.dry = m.slides[slide].d1.abs().mul_add(q[force], r.dry),
            Load::DryPoint { point, force } => {
                let d1 = m.points[point].d1;
                r.dry = d1.dot(d1).sqrt().mul_add(q[force], r.dry);
            }
            Load::DryLink { link, torque } => r.dry = m.links[link].d1.abs().mul_add(q[torque], r.dry),
            Load::DryCrank { torque } => r.dry = r.dry + q[torque],
            Load::ViscousSlide { slide, damping } => {
                r.viscous = m.slides[slide].d1.squared().mul_add(q[damping], r.viscous);
            }
            Load::ViscousPoint { point, damping } => {
                let d1 = m.points[point].d1;
                r.viscous = d1.dot(d1).mul_add(q[damping], r.viscous);
            }
            Load::ViscousLink { link, damping } => {
                r.viscous = m.links[link].d1.squared().mul_add(q[damping], r.viscous);
            }
            Load::Force { point, x, y } => {
                r.load = r.load - m.points[point].d1.dot(Vec2::new(q[x], q[y]));
            }
            Load::Torque { link, torque } => r.load = r.load - m.links[link].d1 * q[torque],
            Load::Follow { point, link, along, across } => {
                let e = m.links[link].e;
                let force = (e * q[along]).plus(e.left(), q[across]);
                r.load = r.load - m.points[point].d1.dot(force);
            }
            Load::Spring { from, to, stiffness, free_length, preload } => {
                let (length, length1) = stretch(m, from, to);
                let pull = (length - q[free_length]).mul_add(q[stiffness], q[preload]);
                r.load = pull.mul_add(length1, r.load);
            }
            Load::SpringTable { from, to, table } => {
                let (length, length1) = stretch(m, from, to);
                r.load = length.map(|x| self.tables[table].held(x)).mul_add(length1, r.load);
            }
            Load::Damper { from, to, damping } => {
                r.viscous = stretch(m, from, to).1.squared().mul_add(q[damping], r.viscous);
            }
            Load::GasSpring { from, to, force, length, column, exponent } => {
                let (now, length1) = stretch(m, from, to);
                let left = q[column] - (q[length] - now);
                let push = q[force] * ((q[column] / left).ln() * q[exponent]).exp();
                r.load = r.load - push * length1;
            }
            Load::TorsionSpring { link, other, stiffness, cos, sin } => {
                let turned = turned(m, link, other, Vec2::new(q[cos], q[sin]));
                r.load = (turned * q[stiffness]).mul_add(relative(m, link, other), r.load);
            }
            Load::TorsionDamper { link, other, damping } => {
                r.viscous = relative(m, link, other).squared().mul_add(q[damping], r.viscous);
            }
            Load::Formula(ref load) => r.load = r.load + self.formula_torque(load, q, angle.phi, sense, m),
            Load::ViscousFormula(ref load) => {
                let torque = self.formula_torque(load, q, angle.phi, sense, m);
                r.viscous = torque.mul_add(R::splat(sense), r.viscous);
            }
            Load::ForcePosition { slide, forward, back } => {
                let slide = &m.slides[slide];
                let ahead = slide.s.map(|s| self.tables[forward].held(s));
                let behind = slide.s.map(|s| self.tables[back].held(s));
                let force = (slide.d1 * sense).select_lt(R::splat(0.0), behind, ahead);
                r.dry = slide.d1.abs().mul_add(force, r.dry);
            }
            Load::TorqueAngle { table } => {
                r.load = r.load + angle.phi.map(|phi| self.tables[table].periodic(phi));
            }
        }
    }
}

/// Distance of two points and its transfer function L′ = u·u′/L; where the points meet, L′ jumps from −|u′| to
/// |u′|, and zero, the mean, stands for it.
#[inline(always)]
pub(crate) fn stretch<R: Real>(m: &Motion<R>, from: usize, to: usize) -> (R, R) {
    let u = m.points[to].p - m.points[from].p;
    let length = u.dot(u).sqrt();
    // There u·u′ is zero, so any length greater than zero will do.
    let divisor = length.max(R::splat(f64::MIN_POSITIVE));
    (length, u.dot(m.points[to].d1 - m.points[from].d1) / divisor)
}

/// dψ/dφ of a link against another, or against the frame.
#[inline(always)]
fn relative<R: Real>(m: &Motion<R>, link: usize, other: Option<usize>) -> R {
    let own = m.links[link].d1;
    other.map_or(own, |other| own - m.links[other].d1)
}

/// Angle by which a link is turned beyond its free angle to another, or to the frame; within ±π.
#[inline(always)]
fn turned<R: Real>(m: &Motion<R>, link: usize, other: Option<usize>, free: Vec2<R>) -> R {
    let e = m.links[link].e;
    let base = match other {
        Some(other) => m.links[other].e,
        None => Vec2::new(R::splat(1.0), R::splat(0.0)),
    };
    // Where the link would stand without torque: the base turned by the free angle.
    let rest = (base * free.x).plus(base.left(), free.y);
    e.dot(rest.left()).atan2(e.dot(rest))
}

impl Plan {
    /// Loads of the reduction that are formulas.
    pub(crate) fn formula_loads(&self) -> impl Iterator<Item = FormulaLoad> + '_ {
        self.loads.iter().filter_map(|load| match *load {
            Load::Formula(load) | Load::ViscousFormula(load) => Some(load),
            _ => None,
        })
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
