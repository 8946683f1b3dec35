//! The common dyads: a rod on a fixed guide (RRP), coupler and rocker (RRR).

use super::guided::{GuidedRod, Line};
use super::motion::Motion;
use crate::kernel::plane::{Heading, Place, Slide, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// Fields of the dyad RRP. The guide has direction (`cos`, `sin`) and passes `offset` to the left of point
/// `through`; `sign` is +1 or −1 for the slider on the positive or negative side of the pin's foot.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
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

impl SliderRod {
    /// The same on a guide like any other, which is fixed to the frame.
    pub(super) fn guided(&self, frame: usize) -> GuidedRod {
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

/// Numbers of a dyad RRP at one machine (or one per lane).
#[derive(Clone, Copy)]
pub(super) struct Rod<R> {
    pub rod: R,
    pub inverse_rod: R,
    pub sign: R,
    pub offset: R,
    pub t: Vec2<R>,
}

/// What a dyad RRP moves.
pub(super) struct Sliding<R> {
    pub point: Place<R>,
    pub link: Heading<R>,
    pub slide: Slide<R>,
    pub gap: R,
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
pub(super) fn sliding<R: Real, const ORDER: u8>(pin: &Place<R>, through: Vec2<R>, q: &Rod<R>) -> Sliding<R> {
    let (t, n) = (q.t, q.t.left());
    let foot = through.plus(n, q.offset);
    let from_foot = pin.p - foot;

    let (h, h1) = (n.dot(from_foot), n.dot(pin.d1));
    let gap = q.rod.squared() - h.squared();
    let w = gap.sqrt();
    let inverse_w = w.recip();
    let w1 = -(h * h1 * inverse_w);
    let s = t.dot(from_foot) + q.sign * w;
    let s1 = t.dot(pin.d1) + q.sign * w1;
    let inverse_cos = q.sign * inverse_w;
    let beta1 = -(h1 * inverse_cos);

    let point = foot.plus(t, s);
    let mut slide = Slide { s, d1: s1, d2: R::splat(0.0) };
    let mut link = Heading { e: (point - pin.p) * q.inverse_rod, d1: beta1, d2: R::splat(0.0) };
    if ORDER > 1 {
        let h2 = n.dot(pin.d2);
        let w2 = -((h1.squared() + h * h2 + w1.squared()) * inverse_w);
        slide.d2 = t.dot(pin.d2) + q.sign * w2;
        link.d2 = -((h2 - h1 * w1 * inverse_w) * inverse_cos);
    }
    Sliding { point: Place { p: point, d1: t * slide.d1, d2: t * slide.d2 }, link, slide, gap }
}

#[inline(always)]
pub(super) fn slider_rod<R: Real, const ORDER: u8>(e: &SliderRod, q: &[R], m: &mut Motion<R>) {
    let t = Vec2::new(q[e.cos], q[e.sin]);
    let rod = Rod { rod: q[e.rod], inverse_rod: q[e.inverse_rod], sign: q[e.sign], offset: q[e.offset], t };
    let found = sliding::<R, ORDER>(&m.points[e.pin], m.points[e.through].p, &rod);
    m.gaps[e.gap] = found.gap;
    m.links[e.link].set(found.link.e, found.link.d1, found.link.d2);
    m.points[e.point].set(found.point.p, found.point.d1, found.point.d2);
    m.slides[e.slide].set(found.slide.s, found.slide.d1, found.slide.d2);
}

/// Numbers of a dyad RRR at one machine (or one per lane).
#[derive(Clone, Copy)]
pub(super) struct Bars<R> {
    pub coupler: R,
    pub rocker: R,
    pub inverse_coupler: R,
    pub inverse_rocker: R,
    pub sign: R,
}

/// What a dyad RRR moves.
pub(super) struct Rocking<R> {
    pub joint: Place<R>,
    pub coupler: Heading<R>,
    pub rocker: Heading<R>,
    pub gap: R,
}

/// S over u² below which it is zero: rounding of its radicand leaves 1e-8 a/u or nothing.
const IN_LINE: f64 = 1e-30;

/// Dyad RRR between pin A and pivot D, u = D − A, coupler a, rocker b, joint C:
///
/// ```text
/// C = A + [(u² + a² − b²) u ± S u⊥] / (2u²),   S = √(4a²u² − (u² + a² − b²)²)
/// e = (C − A)/a,  f = (C − D)/b,  κ = e × f = ±S/(2ab)
/// a κ ψ_a′ = u′·f             b κ ψ_b′ = u′·e
/// a κ ψ_a″ = w·f              b κ ψ_b″ = w·e,     w = u″ + a ψ_a′² e − b ψ_b′² f
/// ```
#[inline(always)]
pub(super) fn rocking<R: Real, const ORDER: u8>(pin: &Place<R>, pivot: &Place<R>, q: &Bars<R>) -> Rocking<R> {
    let (a, b, sign) = (q.coupler, q.rocker, q.sign);
    let u = pivot.p - pin.p;
    let u1 = pivot.d1 - pin.d1;
    let u_squared = u.dot(u);
    let projected = u_squared + (a - b) * (a + b);
    let gap = (a.squared() * 4.0).mul_add(u_squared, -(projected.squared()));
    let S = gap.sqrt();

    // One division for 1/u² and 1/S, also where links come into line and S is zero.
    let least = u_squared * IN_LINE;
    let some = S.max(least);
    let inverse = (u_squared * some).recip();
    let half_inverse = inverse * some * 0.5;
    let arm = (u * (projected * half_inverse)).plus(u.left(), sign * S * half_inverse);
    let joint = pin.p + arm;
    let e = arm * q.inverse_coupler;
    let f = (arm - u) * q.inverse_rocker;
    let over_S = S.select_lt(least, R::splat(f64::INFINITY), inverse * u_squared);
    let inverse_S = sign * over_S * 2.0;
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
    Rocking { joint: place, coupler, rocker: arm_b, gap }
}

#[inline(always)]
pub(super) fn rocker<R: Real, const ORDER: u8>(g: &Rocker, q: &[R], m: &mut Motion<R>) {
    let bars = Bars {
        coupler: q[g.coupler],
        rocker: q[g.rocker],
        inverse_coupler: q[g.inverse_coupler],
        inverse_rocker: q[g.inverse_rocker],
        sign: q[g.sign],
    };
    let found = rocking::<R, ORDER>(&m.points[g.pin], &m.points[g.pivot], &bars);
    let (coupler, rocker) = (&found.coupler, &found.rocker);
    m.gaps[g.gap] = found.gap;
    m.links[g.coupler_link].set(coupler.e, coupler.d1, coupler.d2);
    m.links[g.rocker_link].set(rocker.e, rocker.d1, rocker.d2);
    m.points[g.joint].set(found.joint.p, found.joint.d1, found.joint.d2);
}
