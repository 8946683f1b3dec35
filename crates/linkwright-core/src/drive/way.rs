//! How what a load acts on moves: the transfer function g of the way along it. A force F has the torque F g on the crank.
//!
//! For a force of direction t on a point g is t·p′, on a slide s′, for a torque on a link ψ′, for a force that drives two
//! points at distance L apart L′, for a torque that turns a link against another ψ′ − ψ′_other.

use crate::drive::loads::At;
use crate::kernel::plane::Vec2;
use crate::kernel::real::Real;
use crate::linkage::motion::{Motion, stretch};

/// The way of a load at one crank angle.
#[derive(Clone, Copy, Debug)]
pub struct Way<R> {
    /// Place on a guide, distance of two points, angle from the free angle within ±π; zero if nobody asked.
    pub position: R,
    /// g; on the path of a point |p′|.
    pub d1: R,
    /// g².
    pub squared: R,
}

impl At {
    /// The way here, with its position if that is asked for.
    #[inline(always)]
    pub fn way<R: Real>(&self, with_position: bool, q: &[R], m: &Motion<R>) -> Way<R> {
        let (position, d1) = match *self {
            At::Bodies { .. } => (R::splat(0.0), R::splat(0.0)),
            At::Crank => (R::splat(0.0), R::splat(1.0)),
            At::Slide { slide, .. } => (m.slides[slide].s, m.slides[slide].d1),
            At::Point { point } => {
                let d1 = m.points[point].d1;
                let squared = d1.dot(d1);
                return Way { position: R::splat(0.0), d1: squared.sqrt(), squared };
            }
            At::Toward { point, cos, sin } => {
                (R::splat(0.0), Vec2::new(q[cos], q[sin]).dot(m.points[point].d1))
            }
            At::Along { point, link, cos, sin } => {
                (R::splat(0.0), turning_with(link, [cos, sin], q, m).dot(m.points[point].d1))
            }
            At::Link { link } => (R::splat(0.0), m.links[link].d1),
            At::Between { from, to } => stretch(m, from, to),
            At::BetweenLinks { link, other, cos, sin } => {
                let free = Vec2::new(q[cos], q[sin]);
                let position = if with_position { turned(m, link, other, free) } else { R::splat(0.0) };
                (position, m.links[link].d1 - other.map_or(R::splat(0.0), |other| m.links[other].d1))
            }
        };
        Way { position, d1, squared: d1.squared() }
    }

    /// A quantity that is zero where what is here turns back, and its derivative by φ.
    #[inline(always)]
    pub fn turning<R: Real>(&self, q: &[R], m: &Motion<R>) -> (R, R) {
        match *self {
            At::Bodies { .. } | At::Crank => (R::splat(1.0), R::splat(0.0)),
            At::Slide { slide, .. } => (m.slides[slide].d1, m.slides[slide].d2),
            At::Point { point } => {
                let place = &m.points[point];
                // ½ d|p′|²/dφ; where the point rests p′·p‴ is none of its slope.
                (place.d1.dot(place.d2), place.d2.dot(place.d2))
            }
            At::Toward { point, cos, sin } => {
                let t = Vec2::new(q[cos], q[sin]);
                (t.dot(m.points[point].d1), t.dot(m.points[point].d2))
            }
            At::Along { point, link, cos, sin } => {
                let (t, place) = (turning_with(link, [cos, sin], q, m), &m.points[point]);
                (t.dot(place.d1), t.left().dot(place.d1).mul_add(m.links[link].d1, t.dot(place.d2)))
            }
            At::Link { link } => (m.links[link].d1, m.links[link].d2),
            At::Between { from, to } => {
                // ½ d(L²)/dφ.
                let (a, b) = (&m.points[from], &m.points[to]);
                let (u, u1, u2) = (b.p - a.p, b.d1 - a.d1, b.d2 - a.d2);
                (u.dot(u1), u1.dot(u1) + u.dot(u2))
            }
            At::BetweenLinks { link, other, .. } => {
                let own = &m.links[link];
                other.map_or((own.d1, own.d2), |other| {
                    (own.d1 - m.links[other].d1, own.d2 - m.links[other].d2)
                })
            }
        }
    }
}

/// A direction that turns with a link.
#[inline(always)]
pub(super) fn turning_with<R: Real>(link: usize, [cos, sin]: [usize; 2], q: &[R], m: &Motion<R>) -> Vec2<R> {
    let e = m.links[link].e;
    (e * q[cos]).plus(e.left(), q[sin])
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
