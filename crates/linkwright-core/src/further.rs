//! Further loads of the reduction, which few machines have: following forces, springs by a curve, gas springs,
//! torsional springs, dampers, formulas. They have a loop of their own, so that other machines do not pay for
//! them.
//!
//! A load along the line of two points at distance L has the torque F L′ on the crank, with F its pull; one
//! that turns a link against another has M (ψ′ − ψ′_other). Gas at pressure p and volume V keeps p Vⁿ, e.g.
//! Baehr, Kabelac, *Thermodynamik*, on polytropic changes of state: a gas spring of rod area A pushes with
//! F₁ (V₁/(V₁ − A way))ⁿ, the pressure outside being neglected against that inside.

use crate::law::FormulaLoad;
use crate::linkage::{Motion, Slot};
use crate::plan::Plan;
use crate::plane::Vec2;
use crate::real::Real;

/// A load that few machines have.
#[derive(Clone, Copy, Debug)]
pub enum Further {
    /// A force of fixed size that turns with a link: `along` it, and `across` to its left.
    Follow { point: usize, link: usize, along: Slot, across: Slot },
    /// Pull by a table over the length.
    SpringTable { from: usize, to: usize, table: usize },
    /// Resistance in proportion to the speed at which two points part.
    Damper { from: usize, to: usize, damping: Slot },
    /// Push `force`·(column/(column − way))ⁿ after being pressed in by the way from `length`.
    GasSpring { from: usize, to: usize, force: Slot, length: Slot, column: Slot, exponent: Slot },
    /// Torque against the turning of a link from where it stands at the free angle (`cos`, `sin`) to
    /// another, or to the frame.
    TorsionSpring { link: usize, other: Option<usize>, stiffness: Slot, cos: Slot, sin: Slot },
    /// Torque in proportion to the speed of a link against another, or against the frame.
    TorsionDamper { link: usize, other: Option<usize>, damping: Slot },
    /// A formula that does not depend on the size of the speed.
    Formula(FormulaLoad),
    /// A formula in proportion to the speed.
    ViscousFormula(FormulaLoad),
}

impl Plan {
    /// Resisting torque and viscous coefficient of all further loads.
    #[inline(always)]
    pub(crate) fn further_loads<R: Real>(&self, q: &[R], phi: R, sense: f64, m: &Motion<R>) -> (R, R) {
        let (mut torque, mut viscous) = (R::splat(0.0), R::splat(0.0));
        for load in &self.further {
            let own = self.further_load(load, q, phi, sense, m);
            (torque, viscous) = (torque + own.0, viscous + own.1);
        }
        (torque, viscous)
    }

    /// Resisting torque and viscous coefficient of a load.
    #[inline(always)]
    fn further_load<R: Real>(&self, load: &Further, q: &[R], phi: R, sense: f64, m: &Motion<R>) -> (R, R) {
        let zero = R::splat(0.0);
        match *load {
            Further::Follow { point, link, along, across } => {
                let e = m.links[link].e;
                let force = (e * q[along]).plus(e.left(), q[across]);
                (-m.points[point].d1.dot(force), zero)
            }
            Further::SpringTable { from, to, table } => {
                let (length, length1) = stretch(m, from, to);
                let pull = length.map(
                    #[inline(always)]
                    |x| self.tables[table].held(x),
                );
                (pull * length1, zero)
            }
            Further::Damper { from, to, damping } => (zero, stretch(m, from, to).1.squared() * q[damping]),
            Further::GasSpring { from, to, force, length, column, exponent } => {
                let (now, length1) = stretch(m, from, to);
                let left = q[column] - (q[length] - now);
                let push = q[force] * ((q[column] / left).ln() * q[exponent]).exp();
                (-(push * length1), zero)
            }
            Further::TorsionSpring { link, other, stiffness, cos, sin } => {
                let turned = turned(m, link, other, Vec2::new(q[cos], q[sin]));
                (turned * q[stiffness] * relative(m, link, other), zero)
            }
            Further::TorsionDamper { link, other, damping } => {
                (zero, relative(m, link, other).squared() * q[damping])
            }
            Further::Formula(ref load) => (self.formula_torque(load, q, phi, sense, m), zero),
            Further::ViscousFormula(ref load) => (zero, self.formula_torque(load, q, phi, sense, m) * sense),
        }
    }

    /// Those that are formulas.
    pub(crate) fn formula_loads(&self) -> impl Iterator<Item = FormulaLoad> + '_ {
        self.further.iter().filter_map(|load| match *load {
            Further::Formula(load) | Further::ViscousFormula(load) => Some(load),
            _ => None,
        })
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
