//! Dyads through their change points: RRR where coupler and rocker come into line, RRP where the rod stands
//! across its guide.
//!
//! There the radicand g = S² touches zero, both assemblies meet, and the motion that goes on without a break is
//! the one where S changes sign: S is smooth, |S| is not. The rates of the links are
//! 0/0 in the loop equations. Near a change point φ_c the root is therefore taken from g's Taylor series,
//!
//! ```text
//! g = δ² h(δ),    S = δ √h(δ),    δ = φ − φ_c
//! ```
//!
//! and positions and rates follow from S, S′, S″ without division by S; for RRR with
//!
//! ```text
//! C = A + P u + Q u⊥    P = ½ + (a² − b²)/(2U)    Q = S/(2U)    U = u², u from pin to pivot
//! ```
//!
//! Away from it S = ±√g with the sign of Π sin((φ − φ_c)/2) over all change points: it changes at each of
//! them and nowhere else. Where the pin passes over its pivot U is zero too, and the joint comes from its own
//! series ([`super::arm`]).

use super::arm::{self, Arm, Arms};
use super::dyads::Rocker;
use super::guided::{GuidedRod, Series, bar, place_rod, rod_radicand};
use super::motion::Motion;
use crate::kernel::plane::{Angle, Place, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// Coefficients kept of the series of S/δ.
pub const TERMS: usize = 12;

/// A change point: cos φ_c, sin φ_c, cos ½φ_c, sin ½φ_c, the distance \[rad\] within which the
/// series is used, negative where a machine of a batch does not have it, and the coefficients of √h, which is
/// positive.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ChangePoint {
    pub cos: Slot,
    pub sin: Slot,
    pub half_cos: Slot,
    pub half_sin: Slot,
    pub reach: Slot,
    pub series: Vec<Slot>,
    /// Where the pin of a dyad RRR passes near its pivot; one or none.
    pub arms: Vec<Arms>,
}

/// Numbers of a change point before those of its arms.
pub const NUMBERS: usize = 5 + TERMS;

impl ChangePoint {
    /// A change point whose numbers stand in a row, in the order of its fields: its own, then those of its two arms if
    /// it `has_arms`.
    pub fn stored(first: Slot, has_arms: bool) -> Self {
        let from = |n: Slot| first + NUMBERS + n * arm::NUMBERS;
        ChangePoint {
            cos: first,
            sin: first + 1,
            half_cos: first + 2,
            half_sin: first + 3,
            reach: first + 4,
            series: (first + 5..first + NUMBERS).collect(),
            arms: if has_arms { vec![[0, 1].map(|n| Arm::stored(from(n)))] } else { Vec::new() },
        }
    }

    /// Sine and cosine of the distance from it, and the size of the sine where the cosine is positive: the opposite
    /// half of the circle has the same sine, and is put out of reach.
    #[inline(always)]
    fn distance<R: Real>(&self, q: &[R], angle: Angle<R>) -> [R; 3] {
        let sine = angle.sin * q[self.cos] - angle.cos * q[self.sin];
        let cosine = angle.cos * q[self.cos] + angle.sin * q[self.sin];
        [sine, cosine, cosine.select_lt(R::splat(0.0), R::splat(1.0), sine.abs())]
    }
}

/// A dyad RRR with its change points; the rocker's `sign` holds where the product of half-angle sines is
/// positive.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Folding {
    pub rocker: Rocker,
    pub change_points: Vec<ChangePoint>,
}

/// A rod on a guide with its change points; its `sign` likewise.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FoldingRod {
    pub rod: GuidedRod,
    pub change_points: Vec<ChangePoint>,
}

/// U = u·u with two derivatives.
#[inline(always)]
pub(super) fn square<R: Real>(pin: &Place<R>, pivot: &Place<R>) -> Series<R> {
    let (u, u1, u2) = (pivot.p - pin.p, pivot.d1 - pin.d1, pivot.d2 - pin.d2);
    [u.dot(u), u.dot(u1) * 2.0, (u1.dot(u1) + u.dot(u2)) * 2.0]
}

/// g = ((a + b)² − U)(U − (a − b)²) with two derivatives: Heron's form loses fewer digits where links of very
/// different length come into line.
#[inline(always)]
pub(super) fn radicand<R: Real>(g: &Rocker, q: &[R], m: &Motion<R>) -> Series<R> {
    let [U, U1, U2] = square(&m.points[g.pin], &m.points[g.pivot]);
    let (a, b) = (q[g.coupler], q[g.rocker]);
    let (stretched, folded) = ((a + b).squared() - U, U - (a - b).squared());
    let slope = stretched - folded;
    [stretched * folded, slope * U1, slope * U2 - U1.squared() * 2.0]
}

/// δ = φ − φ_c by its sine, for |δ| up to a little above 0.03: the next term is below 1e-16.
#[inline(always)]
fn small_angle<R: Real>(sine: R) -> R {
    let z = sine.squared();
    // arcsin x = x (1 + x²/6 + 3x⁴/40 + 15x⁶/336 + 105x⁸/3456 + …)
    let tail = (z * (105.0 / 3456.0) + 15.0 / 336.0) * z + 3.0 / 40.0;
    sine * ((tail * z + 1.0 / 6.0) * z + 1.0)
}

/// δ·p(δ) with two derivatives.
#[inline(always)]
fn near<R: Real>(series: &[Slot], q: &[R], delta: R) -> Series<R> {
    let zero = R::splat(0.0);
    let (mut p, mut p1, mut p2) = (zero, zero, zero);
    for &slot in series.iter().rev() {
        p2 = p2.mul_add(delta, p1 * 2.0);
        p1 = p1.mul_add(delta, p);
        p = p.mul_add(delta, q[slot]);
    }
    [p * delta, p + p1 * delta, p1 * 2.0 + p2 * delta]
}

/// Sign of S where the root would be positive: that of `side` times the half-angle sines of all change points.
/// Just after change point `passed` its sine is that of a small angle, times ±1 by the half of the circle: the cosine.
#[inline(always)]
fn sign_of<R: Real>(
    change_points: &[ChangePoint],
    side: R,
    q: &[R],
    (half_sin, half_cos): (R, R),
    passed: Option<usize>,
) -> R {
    let mut product = side;
    for (k, at) in change_points.iter().enumerate() {
        let factor = if passed == Some(k) {
            half_cos * q[at.half_cos] + half_sin * q[at.half_sin]
        } else {
            half_sin * q[at.half_cos] - half_cos * q[at.half_sin]
        };
        // One that a machine of a batch does not have.
        product = product * q[at.reach].select_lt(R::splat(0.0), R::splat(1.0), factor);
    }
    // A side that is not known is NaN, and so is all that depends on it.
    let unknown = side * 0.0;
    product.select_lt(R::splat(0.0), R::splat(-1.0), R::splat(1.0)) + unknown
}

/// S with two derivatives at any crank angle, from g and the side where the product of half-angle sines is
/// positive; and g, which rounding does not make negative at a change point.
#[inline(always)]
fn root<R: Real>(
    change_points: &[ChangePoint],
    side: R,
    q: &[R],
    angle: Angle<R>,
    g: Series<R>,
) -> (Series<R>, R) {
    let halves = (angle.phi * 0.5).sin_cos();
    let S = sign_of(change_points, side, q, halves, None) * g[0].sqrt();
    let half = (S + S).recip();
    let S1 = g[1] * half;
    let mut found = [S, S1, (g[2] - S1.squared() * 2.0) * half];
    let mut gap = g[0];
    for (nth, at) in change_points.iter().enumerate() {
        let [sine, _, distance] = at.distance(q, angle);
        let sign = sign_of(change_points, side, q, halves, Some(nth));
        let close = near(&at.series, q, small_angle(sine));
        for k in 0..3 {
            found[k] = distance.select_lt(q[at.reach], close[k] * sign, found[k]);
        }
        gap = distance.select_lt(q[at.reach], close[0].squared(), gap);
    }
    (found, gap)
}

#[inline(always)]
pub(super) fn folding_rod<R: Real, const ORDER: u8>(
    e: &FoldingRod,
    q: &[R],
    angle: Angle<R>,
    m: &mut Motion<R>,
) {
    let (w, gap) = root(&e.change_points, q[e.rod.sign], q, angle, rod_radicand(&e.rod, q, m));
    place_rod::<R, ORDER>(&e.rod, q, m, w);
    m.gaps[e.rod.gap] = gap;
}

#[inline(always)]
pub(super) fn folding<R: Real>(e: &Folding, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let g = &e.rocker;
    let (pin, pivot) = (m.points[g.pin], m.points[g.pivot]);
    let (S, gap) = root(&e.change_points, q[g.sign], q, angle, radicand(g, q, m));
    let (a, b) = (q[g.coupler], q[g.rocker]);
    let [U, U1, U2] = square(&pin, &pivot);
    let inverse = U.recip();
    let (u, u1, u2) = (pivot.p - pin.p, pivot.d1 - pin.d1, pivot.d2 - pin.d2);
    // P − ½ = k/U
    let k = (a - b) * (a + b) * inverse * 0.5;
    let (rate, bend) = (U1 * inverse, U2 * inverse);
    let P = [k + 0.5, -(k * rate), k * (rate.squared() * 2.0 - bend)];
    let Q0 = S[0] * inverse * 0.5;
    let Q1 = S[1] * inverse * 0.5 - Q0 * rate;
    let Q2 = S[2] * inverse * 0.5 - Q0 * bend - Q1 * rate * 2.0;
    let arm = (u * P[0]).plus(u.left(), Q0);
    let arm1 = (u * P[1]).plus(u1, P[0]).plus(u.left(), Q1).plus(u1.left(), Q0);
    let bent = (u * P[2]).plus(u1, P[1] * 2.0).plus(u2, P[0]);
    let arm2 = bent.plus(u.left(), Q2).plus(u1.left(), Q1 * 2.0).plus(u2.left(), Q0);
    let arm = passing_the_pivot(e, q, angle, [arm, arm1, arm2]);
    let mut joint = Place::fixed(pin.p + arm[0]);
    joint.d1 = pin.d1 + arm[1];
    joint.d2 = pin.d2 + arm[2];
    m.gaps[g.gap] = gap;
    m.points[g.joint].set(joint.p, joint.d1, joint.d2);
    bar(m, g.coupler_link, &pin, &joint, q[g.inverse_coupler]);
    bar(m, g.rocker_link, &pivot, &joint, q[g.inverse_rocker]);
}

/// The arm from pin to joint, taken from its own series where the pin passes near the pivot.
#[inline(always)]
fn passing_the_pivot<R: Real>(
    e: &Folding,
    q: &[R],
    angle: Angle<R>,
    mut found: [Vec2<R>; 3],
) -> [Vec2<R>; 3] {
    for (nth, at) in e.change_points.iter().enumerate() {
        for arms in &at.arms {
            let [sine, cosine, distance] = at.distance(q, angle);
            let halves = (angle.phi * 0.5).sin_cos();
            let after = sign_of(&e.change_points, q[e.rocker.sign], q, halves, Some(nth));
            let (close, reach) = arm::at(arms, q, after, sine, cosine);
            for (found, close) in found.iter_mut().zip(close) {
                found.x = distance.select_lt(reach, close.x, found.x);
                found.y = distance.select_lt(reach, close.y, found.y);
            }
        }
    }
    found
}
