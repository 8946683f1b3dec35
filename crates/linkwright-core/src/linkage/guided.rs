//! Dyads with a guide that may turn: a rod on a moving guide (RRP), a slotted lever (RPR), and two guides
//! that cross (PRP, and RPP where the second guide is a slot at a fixed angle to the first).

use super::motion::Motion;
use crate::kernel::plane::{Place, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// A straight guide fixed to a link (or the frame): it passes `offset` to the left of point `through` and is
/// turned from the link's direction by the angle with (`cos`, `sin`).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Line {
    pub through: usize,
    pub link: usize,
    pub cos: Slot,
    pub sin: Slot,
    pub offset: Slot,
}

/// A rod from `pin` to a slider on a guide: the dyad RRP. `sign` is +1 or −1 for the slider on the positive
/// or negative side of the pin's foot.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct GuidedRod {
    pub point: usize,
    pub link: usize,
    pub slide: usize,
    pub gap: usize,
    pub pin: usize,
    pub line: Line,
    pub rod: Slot,
    /// 1/rod.
    pub inverse_rod: Slot,
    pub sign: Slot,
}

/// A lever about `pivot` whose slot, `offset` to the left of the pivot, is moved by `pin`: the dyad RPR.
/// `sign` is +1 or −1 for the pin ahead of or behind the pivot's foot.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct SlottedLever {
    pub link: usize,
    pub slide: usize,
    pub gap: usize,
    pub pin: usize,
    pub pivot: usize,
    pub offset: Slot,
    pub sign: Slot,
}

/// The point where two guides cross, with its coordinate along each: the dyads PRP and RPP.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Crossing {
    pub point: usize,
    pub slides: [usize; 2],
    pub gap: usize,
    pub lines: [Line; 2],
}

/// A guide at one angle: its point `through`, its direction, and the rates of its turning.
#[derive(Clone, Copy)]
struct Guide<R> {
    origin: Place<R>,
    t: Vec2<R>,
    offset: R,
    d1: R,
    d2: R,
}

impl<R: Real> Guide<R> {
    #[inline(always)]
    fn of(line: &Line, q: &[R], m: &Motion<R>) -> Self {
        let link = &m.links[line.link];
        let t = (link.e * q[line.cos]).plus(link.e.left(), q[line.sin]);
        Guide { origin: m.points[line.through], t, offset: q[line.offset], d1: link.d1, d2: link.d2 }
    }

    /// From the origin to the point at coordinate `s`.
    #[inline(always)]
    fn arm(&self, s: R) -> Vec2<R> {
        (self.t * s).plus(self.t.left(), self.offset)
    }

    /// The point's motion without what its sliding adds along t: o′ + ψ′ a⊥.
    #[inline(always)]
    fn carried_d1(&self, arm: Vec2<R>) -> Vec2<R> {
        self.origin.d1.plus(arm.left(), self.d1)
    }

    /// Likewise o″ + ψ″ a⊥ − ψ′² a + 2 s′ ψ′ n.
    #[inline(always)]
    fn carried_d2(&self, arm: Vec2<R>, s1: R) -> Vec2<R> {
        let turned = self.origin.d2.plus(arm.left(), self.d2).plus(arm, -(self.d1.squared()));
        turned.plus(self.t.left(), s1 * self.d1 * 2.0)
    }

    /// The point at a coordinate with given rates.
    #[inline(always)]
    fn point<const ORDER: u8>(&self, s: R, s1: R, s2: R) -> Place<R> {
        let arm = self.arm(s);
        let mut place = Place::fixed(self.origin.p + arm);
        place.d1 = self.carried_d1(arm).plus(self.t, s1);
        if ORDER > 1 {
            place.d2 = self.carried_d2(arm, s1).plus(self.t, s2);
        }
        place
    }
}

/// The point of a guide at a coordinate s with given first and second derivative.
#[inline(always)]
pub(super) fn on_line<R: Real, const ORDER: u8>(
    line: &Line,
    q: &[R],
    m: &Motion<R>,
    [s, s1, s2]: [R; 3],
) -> Place<R> {
    Guide::of(line, q, m).point::<ORDER>(s, s1, s2)
}

/// A quantity with its first and second derivative by φ.
pub(super) type Series<R> = [R; 3];

/// Distance h of a pin from a guide, and its coordinate p along it. With c from the guide's origin to the pin:
///
/// ```text
/// h = n·c − offset    h′ = n·c′ − ψ′ p          h″ = n·c″ − ψ″ p − 2ψ′ t·c′ − ψ′² n·c
/// p = t·c             p′ = t·c′ + ψ′ n·c        p″ = t·c″ + ψ″ n·c + 2ψ′ n·c′ − ψ′² p
/// ```
#[inline(always)]
fn across_and_along<R: Real>(guide: &Guide<R>, pin: &Place<R>) -> [Series<R>; 2] {
    let (t, n) = (guide.t, guide.t.left());
    let (c, c1, c2) = (pin.p - guide.origin.p, pin.d1 - guide.origin.d1, pin.d2 - guide.origin.d2);
    let (p, across) = (t.dot(c), n.dot(c));
    let square = guide.d1.squared();
    let h1 = n.dot(c1) - guide.d1 * p;
    let p1 = t.dot(c1) + guide.d1 * across;
    let h2 = n.dot(c2) - guide.d2 * p - guide.d1 * t.dot(c1) * 2.0 - square * across;
    let p2 = t.dot(c2) + guide.d2 * across + guide.d1 * n.dot(c1) * 2.0 - square * p;
    [[across - guide.offset, h1, h2], [p, p1, p2]]
}

/// g = l² − h² with two derivatives.
#[inline(always)]
pub(super) fn rod_radicand<R: Real>(e: &GuidedRod, q: &[R], m: &Motion<R>) -> Series<R> {
    let [h, _] = across_and_along(&Guide::of(&e.line, q, m), &m.points[e.pin]);
    let g2 = (h[1].squared() + h[0] * h[2]) * -2.0;
    [q[e.rod].squared() - h[0].squared(), h[0] * h[1] * -2.0, g2]
}

/// Dyad RRP on a guide that turns: w = ±√g, w′ = g′/2w, w″ = (g″ − 2w′²)/2w.
#[inline(always)]
pub(super) fn guided_rod<R: Real, const ORDER: u8>(e: &GuidedRod, q: &[R], m: &mut Motion<R>) {
    let g = rod_radicand(e, q, m);
    let w = q[e.sign] * g[0].sqrt();
    let half = (w + w).recip();
    let w1 = g[1] * half;
    place_rod::<R, ORDER>(e, q, m, [w, w1, (g[2] - w1.squared() * 2.0) * half]);
    m.gaps[e.gap] = g[0];
}

/// The slider at s = p + w, and its rod.
#[inline(always)]
pub(super) fn place_rod<R: Real, const ORDER: u8>(e: &GuidedRod, q: &[R], m: &mut Motion<R>, w: Series<R>) {
    let guide = Guide::of(&e.line, q, m);
    let pin = m.points[e.pin];
    let [_, p] = across_and_along(&guide, &pin);
    let s = [p[0] + w[0], p[1] + w[1], p[2] + w[2]];
    let place = guide.point::<ORDER>(s[0], s[1], s[2]);
    m.slides[e.slide].set(s[0], s[1], s[2]);
    m.points[e.point].set(place.p, place.d1, place.d2);
    bar::<R>(m, e.link, &pin, &place, q[e.inverse_rod]);
}

/// The link between two points of known motion: e = u/l, ψ′ = e⊥·u′/l, ψ″ = e⊥·u″/l.
#[inline(always)]
pub(super) fn bar<R: Real>(m: &mut Motion<R>, link: usize, from: &Place<R>, to: &Place<R>, inverse: R) {
    let e = (to.p - from.p) * inverse;
    let normal = e.left() * inverse;
    m.links[link].set(e, normal.dot(to.d1 - from.d1), normal.dot(to.d2 - from.d2));
}

/// Dyad RPR: c = s f + o f⊥ from the pivot to the pin.
///
/// ```text
/// s = ±√(c² − o²)             f = (s c − o c⊥)/c²
/// ψ′ = f⊥·c′/s                s′ = f·c′ + o ψ′
/// ψ″ = (f⊥·c″ − 2 s′ψ′ + o ψ′²)/s        s″ = f·c″ + s ψ′² + o ψ″
/// ```
#[inline(always)]
pub(super) fn slotted_lever<R: Real, const ORDER: u8>(e: &SlottedLever, q: &[R], m: &mut Motion<R>) {
    let (pin, pivot) = (&m.points[e.pin], &m.points[e.pivot]);
    let o = q[e.offset];
    let (c, c1, c2) = (pin.p - pivot.p, pin.d1 - pivot.d1, pin.d2 - pivot.d2);
    let square = c.dot(c);
    let gap = square - o.squared();
    let s = q[e.sign] * gap.sqrt();
    let f = (c * s).plus(c.left(), -o) * square.recip();
    let inverse_s = s.recip();
    let psi1 = f.left().dot(c1) * inverse_s;
    let s1 = f.dot(c1) + o * psi1;
    let (mut psi2, mut s2) = (R::splat(0.0), R::splat(0.0));
    if ORDER > 1 {
        let square1 = psi1.squared();
        psi2 = (f.left().dot(c2) - s1 * psi1 * 2.0 + o * square1) * inverse_s;
        s2 = f.dot(c2) + s * square1 + o * psi2;
    }
    m.gaps[e.gap] = gap;
    m.links[e.link].set(f, psi1, psi2);
    m.slides[e.slide].set(s, s1, s2);
}

/// s₁ t₁ − s₂ t₂ = d, solved for both; `inverse` is 1/(t₁ × t₂).
#[inline(always)]
fn along_both<R: Real>(t: [Vec2<R>; 2], inverse: R, d: Vec2<R>) -> [R; 2] {
    let n = d.left();
    [n.dot(t[1]) * inverse, n.dot(t[0]) * inverse]
}

/// Dyads PRP and RPP: P = o₁ + a₁(s₁) = o₂ + a₂(s₂), linear in s₁, s₂ and in their derivatives.
#[inline(always)]
pub(super) fn crossing<R: Real, const ORDER: u8>(e: &Crossing, q: &[R], m: &mut Motion<R>) {
    let zero = R::splat(0.0);
    let [a, b] = [Guide::of(&e.lines[0], q, m), Guide::of(&e.lines[1], q, m)];
    let t = [a.t, b.t];
    let cross = a.t.left().dot(b.t);
    let inverse = cross.recip();
    let s = along_both(t, inverse, (b.origin.p + b.arm(zero)) - (a.origin.p + a.arm(zero)));
    let arms = [a.arm(s[0]), b.arm(s[1])];
    let s1 = along_both(t, inverse, b.carried_d1(arms[1]) - a.carried_d1(arms[0]));
    let mut s2 = [zero; 2];
    if ORDER > 1 {
        s2 = along_both(t, inverse, b.carried_d2(arms[1], s1[1]) - a.carried_d2(arms[0], s1[0]));
    }
    let place = a.point::<ORDER>(s[0], s1[0], s2[0]);
    m.gaps[e.gap] = cross.squared();
    m.points[e.point].set(place.p, place.d1, place.d2);
    for k in 0..2 {
        m.slides[e.slides[k]].set(s[k], s1[k], s2[k]);
    }
}
