//! The mechanism as a program: one operation per element, in build order.
//!
//! Each element places points and turns links from those before it, with exact first and (where asked)
//! second transfer functions. A further kind of element is one more function and one more arm here.
//!
//! | module | elements |
//! | --- | --- |
//! | here | crank, rod on a fixed guide (RRP), rocker (RRR), point of a link |
//! | [`guided`] | guides that may turn: RRP, RPR, PRP, RPP |
//! | [`coupled`] | gears, belts, racks, cables, linear drivers, cam followers |
//! | [`folding`] | the dyads RRR and RRP through their change points |
//! | [`arm`] | where the pin of a dyad RRR passes over its pivot there |
//! | [`in_line`] | where change points are, and what is known of the motion there beforehand |
//! | [`group`] | groups that do not split into dyads |
//! | [`trace`] | what groups need to know of the motion beforehand |
//!
//! Source of the method: Assur groups solved in closed form, e.g. Artobolevsky, *Theory of Mechanisms and
//! Machines*, chapters 4–5; the derivatives follow by differentiating the loop equations written at each
//! function. A group that cannot be assembled gives NaN from its square root; its [`Motion::gaps`] entry,
//! the radicand, says by how much.

pub mod arm;
pub mod coupled;
pub mod folding;
pub mod group;
pub mod guided;
pub mod in_line;
pub mod trace;

use coupled::{AngleOf, Law, Programme, Runner, Turn};
use folding::{Folding, FoldingRod};
use group::{Bar, Group};
use guided::{Crossing, GuidedRod, Line, SlottedLever};

use crate::plane::{Angle, Heading, Place, Slide, Vec2};
use crate::real::Real;

/// Index of a number in the machine's list of parameters.
pub type Slot = usize;

/// A point of the ground.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    pub point: usize,
    pub x: Slot,
    pub y: Slot,
}

/// One element of a mechanism. Point, link and slide fields are indices into [`Motion`]; where a guide may be
/// fixed to the frame, the frame is the link after the last.
#[derive(Clone, Debug)]
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

/// Fields of the dyad RRP. The guide has direction (`cos`, `sin`) and passes `offset` to the left of point
/// `through`; `sign` is +1 or −1 for the slider on the positive or negative side of the pin's foot.
#[derive(Clone, Copy, Debug)]
pub struct SliderRod {
    pub point: usize,
    pub link: usize,
    pub slide: usize,
    pub gap: usize,
    pub pin: usize,
    pub through: usize,
    pub rod: Slot,
    /// 1/rod.
    pub inverse_rod: Slot,
    pub offset: Slot,
    pub cos: Slot,
    pub sin: Slot,
    pub sign: Slot,
}

/// Fields of the dyad RRR; `sign` is +1 or −1 for the joint to the left or right of the line pin → pivot.
#[derive(Clone, Copy, Debug)]
pub struct Rocker {
    pub joint: usize,
    pub coupler_link: usize,
    pub rocker_link: usize,
    pub gap: usize,
    pub pin: usize,
    pub pivot: usize,
    pub coupler: Slot,
    pub rocker: Slot,
    /// 1/coupler.
    pub inverse_coupler: Slot,
    /// 1/rocker.
    pub inverse_rocker: Slot,
    pub sign: Slot,
}

/// Points of the ground, the elements in build order, and how many points, links, slides and dyads they make.
#[derive(Clone, Debug, Default)]
pub struct Mechanism {
    pub ground: Vec<Fixed>,
    pub elements: Vec<Element>,
    pub n_points: usize,
    pub n_links: usize,
    pub n_slides: usize,
    pub n_gaps: usize,
}

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

impl<R: Real> Motion<R> {
    /// Room for the motion of a mechanism with parameters `q`; the points of the ground are in place.
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
    fn place_first<R: Real, const ORDER: u8>(&self, n: usize, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
        for element in &self.elements[..n] {
            match *element {
                Element::Crank { pin, link, pivot, radius, cos, sin } => {
                    let heading = crank_heading(q[cos], q[sin], angle);
                    let arm = heading.e * q[radius];
                    let p = m.points[pivot].p + arm;
                    m.points[pin].set(p, arm.left(), arm * R::splat(-1.0));
                    m.links[link].set(heading.e, heading.d1, heading.d2);
                }
                Element::SliderRod(ref e) => slider_rod::<R, ORDER>(e, q, m),
                Element::Rocker(ref e) => rocker::<R, ORDER>(e, q, m),
                Element::RigidPoint { point, link, origin, along, across } => {
                    let place = on_link::<R, ORDER>(&m.points[origin], &m.links[link], q[along], q[across]);
                    m.points[point].set(place.p, place.d1, place.d2);
                }
                // A function of their own keeps the loop over the common elements small.
                _ => R::outline(
                    #[inline(always)]
                    || element.place_rarer::<R, ORDER>(q, angle, m),
                ),
            }
        }
    }
}

impl SliderRod {
    /// The same on a guide like any other, which is fixed to the frame.
    fn guided(&self, frame: usize) -> GuidedRod {
        let line =
            Line { through: self.through, link: frame, cos: self.cos, sin: self.sin, offset: self.offset };
        GuidedRod {
            point: self.point,
            link: self.link,
            slide: self.slide,
            gap: self.gap,
            pin: self.pin,
            line,
            rod: self.rod,
            inverse_rod: self.inverse_rod,
            sign: self.sign,
        }
    }
}

impl Element {
    /// Places an element of the rarer kinds.
    #[inline(always)]
    fn place_rarer<R: Real, const ORDER: u8>(&self, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
        match self {
            Element::GuidedRod(e) => guided::guided_rod::<R, ORDER>(e, q, m),
            Element::SlottedLever(e) => guided::slotted_lever::<R, ORDER>(e, q, m),
            Element::Crossing(e) => guided::crossing::<R, ORDER>(e, q, m),
            Element::Turn(e) => coupled::turn(e, q, angle, m),
            Element::Runner(e) => coupled::runner::<R, ORDER>(e, q, angle, m),
            Element::AngleOf(e) => coupled::angle_of(e, q, angle, m),
            Element::Folding(e) => folding::folding(e, q, angle, m),
            Element::FoldingRod(e) => folding::folding_rod::<R, ORDER>(e, q, angle, m),
            Element::Group(e) => e.place::<R, ORDER>(q, angle, m),
            Element::Bar(e) => {
                let (from, to) = (m.points[e.from], m.points[e.to]);
                guided::bar(m, e.link, &from, &to, q[e.inverse_length]);
            }
            Element::Law(e) => coupled::law(e, q, angle, m),
            Element::Programme(e) => coupled::programme(e, q, angle, m),
            Element::Crank { .. }
            | Element::SliderRod(_)
            | Element::Rocker(_)
            | Element::RigidPoint { .. } => {}
        }
    }
}

/// ψ = φ + phase, so ψ′ = 1 and ψ″ = 0.
#[inline(always)]
fn crank_heading<R: Real>(cos: R, sin: R, angle: Angle<R>) -> Heading<R> {
    let e = Vec2::new(angle.cos * cos - angle.sin * sin, angle.sin * cos + angle.cos * sin);
    Heading { e, d1: R::splat(1.0), d2: R::splat(0.0) }
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

/// Dyad RRP. With t along and n to the left of the guide, G its foot and B the pin:
///
/// ```text
/// h = n·(B − G)        distance of the pin from the guide
/// w = √(l² − h²)       s = t·(B − G) ± w        the slider
/// w′ = −h h′/w         w″ = −(h′² + h h″ + w′²)/w
/// sin β = −h/l         β′ = −h′/(±w)             β″ = −(h″ − h′ w′/w)/(±w)
/// ```
#[inline(always)]
fn slider_rod<R: Real, const ORDER: u8>(e: &SliderRod, q: &[R], m: &mut Motion<R>) {
    let (pin, through) = (&m.points[e.pin], &m.points[e.through]);
    let (rod, sign) = (q[e.rod], q[e.sign]);
    let t = Vec2::new(q[e.cos], q[e.sin]);
    let n = t.left();
    let foot = through.p.plus(n, q[e.offset]);
    let from_foot = pin.p - foot;

    let (h, h1) = (n.dot(from_foot), n.dot(pin.d1));
    let gap = rod.squared() - h.squared();
    let w = gap.sqrt();
    let inverse_w = w.recip();
    let w1 = -(h * h1 * inverse_w);
    let s = t.dot(from_foot) + sign * w;
    let s1 = t.dot(pin.d1) + sign * w1;
    let inverse_cos = sign * inverse_w;
    let beta1 = -(h1 * inverse_cos);

    let mut slide = Slide { s, d1: s1, d2: R::splat(0.0) };
    let mut heading = Heading { e: Vec2::zero(), d1: beta1, d2: R::splat(0.0) };
    let point = foot.plus(t, s);
    heading.e = (point - pin.p) * q[e.inverse_rod];
    if ORDER > 1 {
        let h2 = n.dot(pin.d2);
        let w2 = -((h1.squared() + h * h2 + w1.squared()) * inverse_w);
        slide.d2 = t.dot(pin.d2) + sign * w2;
        heading.d2 = -((h2 - h1 * w1 * inverse_w) * inverse_cos);
    }
    m.gaps[e.gap] = gap;
    m.links[e.link].set(heading.e, heading.d1, heading.d2);
    m.points[e.point].set(point, t * slide.d1, t * slide.d2);
    m.slides[e.slide].set(slide.s, slide.d1, slide.d2);
}

/// Dyad RRR between pin A and pivot D, u = D − A, coupler a, rocker b, joint C:
///
/// ```text
/// C = A + [(u² + a² − b²) u ± S u⊥] / (2u²),   S = √(4a²u² − (u² + a² − b²)²)
/// e = (C − A)/a,  f = (C − D)/b,  κ = e × f = ±S/(2ab)
/// a κ ψ_a′ = u′·f             b κ ψ_b′ = u′·e
/// a κ ψ_a″ = w·f              b κ ψ_b″ = w·e,     w = u″ + a ψ_a′² e − b ψ_b′² f
/// ```
#[inline(always)]
fn rocker<R: Real, const ORDER: u8>(g: &Rocker, q: &[R], m: &mut Motion<R>) {
    let (pin, pivot) = (&m.points[g.pin], &m.points[g.pivot]);
    let (a, b, sign) = (q[g.coupler], q[g.rocker], q[g.sign]);
    let u = pivot.p - pin.p;
    let u1 = pivot.d1 - pin.d1;
    let u_squared = u.dot(u);
    let projected = u_squared + (a - b) * (a + b);
    let gap = (a.squared() * 4.0).mul_add(u_squared, -(projected.squared()));
    let S = gap.sqrt();

    let half_inverse = (u_squared + u_squared).recip();
    let arm = (u * (projected * half_inverse)).plus(u.left(), sign * S * half_inverse);
    let joint = pin.p + arm;
    let (inverse_a, inverse_b) = (q[g.inverse_coupler], q[g.inverse_rocker]);
    let e = arm * inverse_a;
    let f = (arm - u) * inverse_b;
    let inverse_S = sign * (S.recip() * 2.0);
    // 1/(aκ) and 1/(bκ)
    let (to_a, to_b) = (b * inverse_S, a * inverse_S);
    let (psi_a1, psi_b1) = (u1.dot(f) * to_a, u1.dot(e) * to_b);

    let mut coupler = Heading { e, d1: psi_a1, d2: R::splat(0.0) };
    let mut arm_b = Heading { e: f, d1: psi_b1, d2: R::splat(0.0) };
    let mut place = Place { p: joint, d1: pin.d1.plus(arm.left(), psi_a1), d2: Vec2::zero() };
    if ORDER > 1 {
        let w = (pivot.d2 - pin.d2).plus(e, a * psi_a1.squared()).plus(f, -(b * psi_b1.squared()));
        coupler.d2 = w.dot(f) * to_a;
        arm_b.d2 = w.dot(e) * to_b;
        place.d2 = pin.d2.plus(arm.left(), coupler.d2).plus(arm, -(psi_a1.squared()));
    }
    m.gaps[g.gap] = gap;
    m.links[g.coupler_link].set(coupler.e, coupler.d1, coupler.d2);
    m.links[g.rocker_link].set(arm_b.e, arm_b.d1, arm_b.d2);
    m.points[g.joint].set(place.p, place.d1, place.d2);
}
