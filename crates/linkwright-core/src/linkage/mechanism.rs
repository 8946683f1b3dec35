//! The mechanism as a program: one operation per element, in build order.
//!
//! Each element places points and turns links from those before it, with exact first and (where asked)
//! second transfer functions. A further kind of element is one more function and one more arm here.

use super::coupled::{self, AngleOf, Law, Programme, Runner, Turn};
use super::dyads::{self, Rocker, SliderRod};
use super::folding::{self, Folding, FoldingRod};
use super::group::{Bar, Group};
use super::guided::{self, Crossing, GuidedRod, SlottedLever};
use super::motion::{Motion, on_link};
use crate::kernel::out_of_line;
use crate::kernel::plane::{Angle, Heading, Place, Slide, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// A point of the ground.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct GroundPoint {
    pub point: usize,
    pub x: Slot,
    pub y: Slot,
}

/// One element of a mechanism. Point, link and slide fields are indices into [`Motion`]; where a guide may be
/// fixed to the frame, the frame is the link after the last.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Element {
    /// A crank turning with φ + phase about the point `pivot` of the ground; `cos`, `sin` are those of the phase.
    Crank { pin: usize, link: usize, pivot: usize, radius: Slot, cos: Slot, sin: Slot },
    /// A connecting rod from `pin` to a slider on a straight guide: the dyad RRP.
    SliderRod(SliderRod),
    /// A coupler from `pin` and a rocker from `pivot`, joined at `joint`: the dyad RRR.
    Rocker(Rocker),
    /// A point fixed on a link, `along` it from its start and `across` to the left.
    RigidPoint { point: usize, link: usize, origin: usize, along: Slot, across: Slot },
    /// A rod to a slider on a guide that may turn: the dyad RRP.
    GuidedRod(GuidedRod),
    /// A lever whose slot is moved by a pin: the dyad RPR.
    SlottedLever(SlottedLever),
    /// Where two guides cross: the dyads PRP and RPP.
    Crossing(Crossing),
    /// A link whose angle is a sum of other coordinates.
    Turn(Turn),
    /// A point on a guide whose coordinate is a sum of others.
    Runner(Runner),
    /// The continuous angle of a link.
    AngleOf(AngleOf),
    /// The dyad RRR through its change points.
    Folding(Folding),
    /// The dyad RRP through its change points.
    FoldingRod(FoldingRod),
    /// A group solved together.
    Group(Group),
    /// A link between two points that are placed already.
    Bar(Bar),
    /// A coordinate by a formula of the crank angle.
    Law(Law),
    /// A coordinate that follows a motion law in pieces.
    Programme(Programme),
}

/// Points of the ground, the elements in build order, and how many points, links, slides and dyads they make.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Mechanism {
    pub ground: Vec<GroundPoint>,
    pub elements: Vec<Element>,
    pub n_points: usize,
    pub n_links: usize,
    pub n_slides: usize,
    pub n_gaps: usize,
}

impl<R: Real> Motion<R> {
    /// Room for the motion of a mechanism with parameters `q`; the points of the ground are in place.
    #[inline(always)]
    pub fn new(mechanism: &Mechanism, q: &[R]) -> Self {
        let zero = R::splat(0.0);
        let mut motion = Motion {
            points: vec![Place::fixed(Vec2::zero()); mechanism.n_points],
            // The frame is the link after the last, and stays as it is.
            links: vec![
                Heading { e: Vec2::new(R::splat(1.0), zero), d1: zero, d2: zero };
                mechanism.n_links + 1
            ],
            slides: vec![Slide { s: zero, d1: zero, d2: zero }; mechanism.n_slides],
            gaps: vec![zero; mechanism.n_gaps],
        };
        motion.ground(mechanism, q);
        motion
    }

    /// Puts the points of the ground in place, for other parameters.
    #[inline(always)]
    pub fn ground(&mut self, mechanism: &Mechanism, q: &[R]) {
        for fixed in &mechanism.ground {
            self.points[fixed.point] = Place::fixed(Vec2::new(q[fixed.x], q[fixed.y]));
        }
    }
}

impl Mechanism {
    /// Places everything at the given crank angle. `ORDER` is 1 or 2: the highest derivative wanted
    /// (second derivatives stay zero at order 1). `q` are the machine's parameters.
    #[inline(always)]
    pub fn place<R: Real, const ORDER: u8>(&self, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
        self.place_first::<R, ORDER>(self.elements.len(), q, angle, m);
    }

    /// Places the first `n` elements.
    #[inline(always)]
    pub(super) fn place_first<R: Real, const ORDER: u8>(
        &self,
        n: usize,
        q: &[R],
        angle: Angle<R>,
        m: &mut Motion<R>,
    ) {
        for element in &self.elements[..n] {
            match *element {
                Element::Crank { pin, link, pivot, radius, cos, sin } => {
                    let (place, heading) = crank(m.points[pivot].p, q[radius], [q[cos], q[sin]], angle);
                    m.points[pin].set(place.p, place.d1, place.d2);
                    m.links[link].set(heading.e, heading.d1, heading.d2);
                }
                Element::SliderRod(ref e) => dyads::slider_rod::<R, ORDER>(e, q, m),
                Element::Rocker(ref e) => dyads::rocker::<R, ORDER>(e, q, m),
                Element::RigidPoint { point, link, origin, along, across } => {
                    let place = on_link::<R, ORDER>(&m.points[origin], &m.links[link], q[along], q[across]);
                    m.points[point].set(place.p, place.d1, place.d2);
                }
                _ => element.place_rarer::<R, ORDER>(q, angle, m),
            }
        }
    }
}

impl Element {
    /// Places an element of the rarer kinds, each by a function of its own: the loop over the common elements stays small.
    #[inline(always)]
    fn place_rarer<R: Real, const ORDER: u8>(&self, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
        match self {
            Element::GuidedRod(e) => out_of_line!(R, guided::guided_rod::<R, ORDER>(e, q, m)),
            Element::SlottedLever(e) => out_of_line!(R, guided::slotted_lever::<R, ORDER>(e, q, m)),
            Element::Crossing(e) => out_of_line!(R, guided::crossing::<R, ORDER>(e, q, m)),
            Element::Turn(e) => out_of_line!(R, coupled::turn(e, q, angle, m)),
            Element::Runner(e) => out_of_line!(R, coupled::runner::<R, ORDER>(e, q, angle, m)),
            Element::AngleOf(e) => out_of_line!(R, coupled::angle_of(e, q, angle, m)),
            Element::Folding(e) => out_of_line!(R, folding::folding(e, q, angle, m)),
            Element::FoldingRod(e) => out_of_line!(R, folding::folding_rod::<R, ORDER>(e, q, angle, m)),
            Element::Group(e) => out_of_line!(R, e.place::<R, ORDER>(q, angle, m)),
            Element::Bar(e) => {
                let (from, to) = (m.points[e.from], m.points[e.to]);
                guided::bar(m, e.link, &from, &to, q[e.inverse_length]);
            }
            Element::Law(e) => out_of_line!(R, coupled::law(e, q, angle, m)),
            Element::Programme(e) => out_of_line!(R, coupled::programme(e, q, angle, m)),
            Element::Crank { .. }
            | Element::SliderRod(_)
            | Element::Rocker(_)
            | Element::RigidPoint { .. } => {}
        }
    }
}

/// A crank with its pin: ψ = φ + phase, so ψ′ = 1 and ψ″ = 0.
#[inline(always)]
pub(super) fn crank<R: Real>(
    pivot: Vec2<R>,
    radius: R,
    [cos, sin]: [R; 2],
    angle: Angle<R>,
) -> (Place<R>, Heading<R>) {
    let e = Vec2::new(angle.cos * cos - angle.sin * sin, angle.sin * cos + angle.cos * sin);
    let arm = e * radius;
    let place = Place { p: pivot + arm, d1: arm.left(), d2: arm * R::splat(-1.0) };
    (place, Heading { e, d1: R::splat(1.0), d2: R::splat(0.0) })
}
