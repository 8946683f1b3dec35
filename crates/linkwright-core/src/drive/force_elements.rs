//! Force elements of the reduction: following forces, springs by a curve, gas springs, torsional springs, dampers,
//! formulas. They have a loop of their own, so that other machines do not pay for
//! them.
//!
//! A load along the line of two points at distance L has the torque F L′ on the crank, with F its pull; one
//! that turns a link against another has M (ψ′ − ψ′_other). Gas at pressure p and volume V keeps p Vⁿ, e.g.
//! Baehr, Kabelac, *Thermodynamik*, on polytropic changes of state: a gas spring of rod area A pushes with
//! F₁ (V₁/(V₁ − A way))ⁿ, the pressure outside being neglected against that inside.

use crate::drive::loads::{ForceElement, FormulaLoad};
use crate::drive::structure::Plan;
use crate::kernel::plane::Vec2;
use crate::kernel::real::Real;
use crate::linkage::motion::{Motion, stretch};

impl Plan {
    /// Load torque and viscous coefficient of all force elements.
    #[inline(always)]
    pub(crate) fn force_element_torques<R: Real>(
        &self,
        q: &[R],
        phi: R,
        sense: f64,
        m: &Motion<R>,
    ) -> (R, R) {
        let (mut torque, mut viscous) = (R::splat(0.0), R::splat(0.0));
        for load in &self.force_elements {
            let own = self.force_element_torque(load, q, phi, sense, m);
            (torque, viscous) = (torque + own.0, viscous + own.1);
        }
        (torque, viscous)
    }

    /// Load torque and viscous coefficient of one.
    #[inline(always)]
    fn force_element_torque<R: Real>(
        &self,
        load: &ForceElement,
        q: &[R],
        phi: R,
        sense: f64,
        m: &Motion<R>,
    ) -> (R, R) {
        let zero = R::splat(0.0);
        match *load {
            ForceElement::Follow { point, link, along, across } => {
                let e = m.links[link].e;
                let force = (e * q[along]).plus(e.left(), q[across]);
                (-m.points[point].d1.dot(force), zero)
            }
            ForceElement::SpringTable { from, to, table } => {
                let (length, length1) = stretch(m, from, to);
                (self.tables[table].held_at(length, q) * length1, zero)
            }
            ForceElement::Damper { from, to, damping } => {
                (zero, stretch(m, from, to).1.squared() * q[damping])
            }
            ForceElement::GasSpring { from, to, force, length, column, exponent } => {
                let (now, length1) = stretch(m, from, to);
                let left = q[column] - (q[length] - now);
                let push = q[force] * ((q[column] / left).ln() * q[exponent]).exp();
                (-(push * length1), zero)
            }
            ForceElement::TorsionSpring { link, other, stiffness, cos, sin } => {
                let turned = turned(m, link, other, Vec2::new(q[cos], q[sin]));
                (turned * q[stiffness] * relative(m, link, other), zero)
            }
            ForceElement::TorsionDamper { link, other, damping } => {
                (zero, relative(m, link, other).squared() * q[damping])
            }
            ForceElement::Formula(ref load) => (self.formula_torque(load, q, phi, sense, m), zero),
            ForceElement::ViscousFormula(ref load) => {
                (zero, self.formula_torque(load, q, phi, sense, m) * sense)
            }
        }
    }

    /// Those that are formulas.
    pub(crate) fn formula_loads(&self) -> impl Iterator<Item = FormulaLoad> + '_ {
        self.force_elements.iter().filter_map(|load| match *load {
            ForceElement::Formula(load) | ForceElement::ViscousFormula(load) => Some(load),
            _ => None,
        })
    }
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
