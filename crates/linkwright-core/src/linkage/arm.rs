//! The arm from pin to joint of a dyad RRR whose pin passes over its pivot, or closely by, while coupler and rocker
//! are folded: rhombi and kites, and what is nearly one.
//!
//! With u from pin to pivot, coupler a and rocker b, the arm is e = P u + Q u⊥ (module [`super::folding`]). Where u
//! is short, its direction is known to rounding over |u| only, and P and Q are large. But of the two arms that
//! cross at such a change point one at least hardly turns: the coupler of a parallelogram does not turn at all,
//! however near the parallelogram is to a rhombus; in rhombus and kite both arms are smooth. A smooth arm is taken
//! from a polynomial through its places on both sides, where u is long enough:
//!
//! ```text
//! e = Σ c_k T_k(t),    t = sin(φ − φ_c)/w,    |t| < 1
//! ```
//!
//! fitted in Chebyshev's nodes, with S changing its sign in the middle. The arm of an antiparallelogram that is
//! nearly a rhombus goes round once while the pin passes: no polynomial holds that, and the general form serves.
//!
//! Source of the fit: discrete orthogonality of Chebyshev polynomials, e.g. Trefethen, *Approximation Theory and
//! Approximation Practice*, chapters 3–4; evaluation by Clenshaw's recurrence.

use crate::kernel::plane::Vec2;
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Coefficients kept of each coordinate.
pub const TERMS: usize = 20;

/// Numbers of an arm: 1/w, reach, and both coordinates' coefficients.
pub const NUMBERS: usize = 2 + 2 * TERMS;

/// Nodes of a fit: thrice the terms, so that rounding at the few nodes near the middle averages out. Even: none lies
/// in the middle.
const NODES: usize = 64;

/// Coefficients beyond those kept that must have fallen to rounding.
const BEYOND: usize = 12;

/// Sines of the half-widths tried, the widest first: where the nearest of the nodes is some 0.007 rad from the
/// middle, a direction has lost two digits.
const WIDTHS: [f64; 3] = [0.3, 0.15, 0.075];

/// Share of the length of the arm up to which coefficients beyond those kept count as rounding, where coordinates are
/// no larger than the speed of the pin; else more in proportion.
const ROUNDING: f64 = 2e-14;

/// Share of the length of the arm by which a smooth arm may miss the place of the links folded in line; the arm that
/// goes round misses it by up to twice the length.
const ON_THE_WAY: f64 = 0.1;

/// One arm; it serves where |sin(φ − φ_c)| is below `reach`, which is negative where the arm is not smooth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Arm {
    pub inverse_width: Slot,
    pub reach: Slot,
    pub x: Vec<Slot>,
    pub y: Vec<Slot>,
}

impl Arm {
    /// An arm whose numbers stand in a row, in the order of its fields.
    pub(super) fn stored(first: Slot) -> Self {
        let (x, y) = (first + 2, first + 2 + TERMS);
        Arm {
            inverse_width: first,
            reach: first + 1,
            x: (x..x + TERMS).collect(),
            y: (y..y + TERMS).collect(),
        }
    }
}

/// The arms with S > 0 and with S < 0 after the change point.
pub type Arms = [Arm; 2];

/// Σ c_k T_k(t) with two derivatives by t.
#[inline(always)]
fn clenshaw<R: Real>(t: R, coefficients: &[R]) -> [R; 3] {
    let zero = R::splat(0.0);
    let twice = t + t;
    // The recurrence, and what it gives when it is differentiated once and twice.
    let (mut b, mut b1) = ([zero; 3], [zero; 3]);
    for &c in coefficients.iter().rev() {
        let b2 = b1;
        b1 = b;
        b = [
            twice.mul_add(b1[0], c - b2[0]),
            twice.mul_add(b1[1], b1[0] * 2.0 - b2[1]),
            twice.mul_add(b1[2], b1[1] * 4.0 - b2[2]),
        ];
    }
    // c_0 counts once: Σ = b_0 − t b_1.
    [b[0] - t * b1[0], b[1] - b1[0] - t * b1[1], b[2] - b1[1] * 2.0 - t * b1[2]]
}

/// The arm with two derivatives by φ, and within which sine it serves; `after` has the sign of S after the change
/// point, `sine` and `cosine` are those of the distance from it.
#[inline(always)]
pub(super) fn at<R: Real>(arms: &Arms, q: &[R], after: R, sine: R, cosine: R) -> ([Vec2<R>; 3], R) {
    let ([plus, minus], zero) = (arms, R::splat(0.0));
    let scale = after.select_lt(zero, q[minus.inverse_width], q[plus.inverse_width]);
    let reach = after.select_lt(zero, q[minus.reach], q[plus.reach]);
    let (t, rate) = (sine * scale, cosine * scale);
    let (mut x, mut y) = ([zero; TERMS], [zero; TERMS]);
    for k in 0..TERMS {
        x[k] = after.select_lt(zero, q[minus.x[k]], q[plus.x[k]]);
        y[k] = after.select_lt(zero, q[minus.y[k]], q[plus.y[k]]);
    }
    let ([x, x1, x2], [y, y1, y2]) = (clenshaw(t, &x), clenshaw(t, &y));
    // t′ = cos/w, t″ = −t.
    let square = rate.squared();
    let second = Vec2::new(x2 * square - x1 * t, y2 * square - y1 * t);
    ([Vec2::new(x, y), Vec2::new(x1, y1) * rate, second], reach)
}

/// A dyad where it folds: coupler, rocker less coupler is −`excess`, its place there, and the rounding of u.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fold {
    pub coupler: f64,
    pub rocker: f64,
    /// a − b; zero where it counts as zero.
    pub excess: f64,
    /// From pin to pivot at the change point.
    pub u: Vec2<f64>,
    /// Largest coordinate over the speed u′.
    pub far: f64,
}

impl Fold {
    /// The arm where u has some value; `side` is the sign of S there.
    fn arm(&self, u: Vec2<f64>, side: f64) -> Vec2<f64> {
        // A pin that meets its pivot to rounding does so exactly.
        let u = if self.excess == 0.0 { u - self.u } else { u };
        let U = u.dot(u);
        let sum = self.coupler + self.rocker;
        let P = 0.5 + 0.5 * self.excess * sum / U;
        let g = (sum * sum - U) * (U - self.excess * self.excess);
        (u * P).plus(u.left(), 0.5 * side * g.sqrt() / U)
    }

    /// Numbers of the arm that has S of sign `after` behind the change point: 1/w, reach, coefficients. `u` gives u at
    /// a distance [rad].
    pub(super) fn fit(&self, after: f64, u: impl Fn(f64) -> Vec2<f64>) -> [f64; NUMBERS] {
        WIDTHS.iter().find_map(|&width| self.fit_within(width, after, &u)).unwrap_or_else(|| {
            let mut none = [0.0; NUMBERS];
            (none[0], none[1]) = (1.0, -1.0);
            none
        })
    }

    fn fit_within(&self, width: f64, after: f64, u: impl Fn(f64) -> Vec2<f64>) -> Option<[f64; NUMBERS]> {
        let angle = |j: usize| PI * (j as f64 + 0.5) / NODES as f64;
        let node = |j: usize| {
            let t = angle(j).cos();
            self.arm(u((width * t).asin()), after * t.signum())
        };
        let places: Vec<Vec2<f64>> = (0..NODES).map(node).collect();
        let coefficient = |k: usize| {
            let term =
                |sum: Vec2<f64>, (j, p): (usize, &Vec2<f64>)| sum.plus(*p, (k as f64 * angle(j)).cos());
            let sum = places.iter().enumerate().fold(Vec2::zero(), term);
            sum * (if k == 0 { 1.0 } else { 2.0 } / NODES as f64)
        };
        let limit = ROUNDING * (self.coupler + self.rocker) * self.far.max(1.0);
        // Written so that NaN is refused too.
        let is_rounding = |c: Vec2<f64>| c.x.abs() <= limit && c.y.abs() <= limit;
        if !(TERMS..TERMS + BEYOND).all(|k| is_rounding(coefficient(k))) {
            return None;
        }
        let mut numbers = [0.0; NUMBERS];
        (numbers[0], numbers[1]) = (1.0 / width, width);
        for k in 0..TERMS {
            let c = coefficient(k);
            (numbers[2 + k], numbers[2 + TERMS + k]) = (c.x, c.y);
        }
        self.passes_the_fold(&numbers).then_some(numbers)
    }

    /// Whether the fitted arm lies along u in the middle, as the links do when they are folded.
    fn passes_the_fold(&self, numbers: &[f64; NUMBERS]) -> bool {
        if self.excess == 0.0 {
            // Folded in every direction while the pin lies over the pivot.
            return true;
        }
        let x = clenshaw(0.0, &numbers[2..2 + TERMS])[0];
        let y = clenshaw(0.0, &numbers[2 + TERMS..])[0];
        let folded = self.u * (self.coupler * self.excess.signum() / self.u.dot(self.u).sqrt());
        let off = Vec2::new(x, y) - folded;
        off.dot(off).sqrt() <= ON_THE_WAY * self.coupler
    }
}

/// Whether a fit found no smooth arm.
pub(super) fn is_missing(numbers: &[f64; NUMBERS]) -> bool {
    numbers[1] < 0.0
}
