//! The motion of a mechanism at one crank angle, and what follows from it: points of links, distances of points.

use crate::kernel::plane::{Heading, Place, Slide, Vec2};
use crate::kernel::real::Real;

/// Everything that moves, at one crank angle (or one per lane).
#[derive(Clone, Debug)]
pub struct Motion<R> {
    pub points: Vec<Place<R>>,
    pub links: Vec<Heading<R>>,
    pub slides: Vec<Slide<R>>,
    /// Radicand of each dyad's assembly \[m² for a rod and a slotted lever, m⁴ for a rocker, none for two guides
    /// that cross, a power of m for a group\]: negative where it does not close, zero where its motion is not
    /// determined.
    pub gaps: Vec<R>,
}

/// What is asked of a motion at every angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Position, first and second transfer function of a point: x, y, x′, y′, x″, y″.
    Point(usize),
    /// Direction of a link as cos ψ, sin ψ, and ψ′, ψ″.
    Link(usize),
    /// A slide's s, s′, s″.
    Slide(usize),
}

impl Channel {
    /// How many numbers it gives at each angle.
    pub fn width(self) -> usize {
        match self {
            Channel::Point(_) => 6,
            Channel::Link(_) => 4,
            Channel::Slide(_) => 3,
        }
    }
}

/// A point of a link: p = o + a, p′ = o′ + ψ′ a⊥, p″ = o″ + ψ″ a⊥ − ψ′² a, with a = along·e + across·e⊥.
#[inline(always)]
pub fn on_link<R: Real, const ORDER: u8>(
    origin: &Place<R>,
    link: &Heading<R>,
    along: R,
    across: R,
) -> Place<R> {
    let a = (link.e * along).plus(link.e.left(), across);
    let normal = a.left();
    let mut place = Place { p: origin.p + a, d1: origin.d1.plus(normal, link.d1), d2: Vec2::zero() };
    if ORDER > 1 {
        place.d2 = origin.d2.plus(normal, link.d2).plus(a, -(link.d1.squared()));
    }
    place
}

/// Distance of two points and its transfer function L′ = u·u′/L; where the points meet, L′ jumps from −|u′| to
/// |u′|, and zero, the mean, stands for it.
#[inline(always)]
pub fn stretch<R: Real>(m: &Motion<R>, from: usize, to: usize) -> (R, R) {
    let u = m.points[to].p - m.points[from].p;
    let length = u.dot(u).sqrt();
    // There u·u′ is zero, so any length greater than zero will do.
    let divisor = length.max(R::splat(f64::MIN_POSITIVE));
    (length, u.dot(m.points[to].d1 - m.points[from].d1) / divisor)
}
