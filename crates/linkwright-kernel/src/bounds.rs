//! Bounds of a quantity and of its slope over a piece of what it depends on: an interval for each.
//!
//! They run through the same code as any number. A choice that is not the same over the whole piece leaves what either
//! side gives, and a slope without bounds: the quantity may jump there.

use crate::interval::Interval;
use crate::real::{Lift, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All values of a quantity over a piece, and all its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub value: Interval,
    pub slope: Interval,
}

/// No bounds at all.
const ANYTHING: Bounds = Bounds { value: Interval::EVERYTHING, slope: Interval::EVERYTHING };

impl Bounds {
    /// The value of a function with slopes `times` those of its argument.
    fn chain(self, value: Interval, times: Interval) -> Self {
        Bounds { value, slope: self.slope * times }
    }

    /// What either gives.
    fn hull(self, other: Self) -> Self {
        Bounds { value: self.value.hull(other.value), slope: self.slope.hull(other.slope) }
    }
}

impl Lift<f64> for Bounds {
    fn lift(constant: f64) -> Self {
        Bounds { value: Interval::at(constant), slope: Interval::at(0.0) }
    }
}

impl Add for Bounds {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Bounds { value: self.value + o.value, slope: self.slope + o.slope }
    }
}
impl Sub for Bounds {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Bounds { value: self.value - o.value, slope: self.slope - o.slope }
    }
}
impl Mul for Bounds {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Bounds { value: self.value * o.value, slope: self.slope * o.value + self.value * o.slope }
    }
}
impl Div for Bounds {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let inverse = o.value.recip();
        let value = self.value * inverse;
        Bounds { value, slope: (self.slope - value * o.slope) * inverse }
    }
}
impl Neg for Bounds {
    type Output = Self;
    fn neg(self) -> Self {
        Bounds { value: -self.value, slope: -self.slope }
    }
}
impl Add<f64> for Bounds {
    type Output = Self;
    fn add(self, o: f64) -> Self {
        self + Bounds::splat(o)
    }
}
impl Sub<f64> for Bounds {
    type Output = Self;
    fn sub(self, o: f64) -> Self {
        self - Bounds::splat(o)
    }
}
impl Mul<f64> for Bounds {
    type Output = Self;
    fn mul(self, o: f64) -> Self {
        self * Bounds::splat(o)
    }
}

impl Real for Bounds {
    const LANES: usize = 1;

    fn splat(x: f64) -> Self {
        Bounds::lift(x)
    }
    fn load(from: &[f64]) -> Self {
        Bounds::lift(from[0])
    }
    /// The middle.
    fn store(self, to: &mut [f64]) {
        to[0] = 0.5 * (self.value.low + self.value.high);
    }
    fn mul_add(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, (root + root).recip())
    }
    fn abs(self) -> Self {
        if self.value.low >= 0.0 {
            self
        } else if self.value.high <= 0.0 {
            -self
        } else {
            Bounds { value: self.value.abs(), slope: self.slope.hull(-self.slope) }
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = (self.value.sin(), self.value.cos());
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
        let (a, b) = (self.value, limit.value);
        if a.is_empty() || b.is_empty() || a.low >= b.high {
            other
        } else if a.high < b.low {
            below
        } else if below.value.is_empty() || other.value.is_empty() {
            // Where one side has no value, it may be that all that follows takes another way.
            ANYTHING
        } else {
            Bounds { value: below.value.hull(other.value), slope: Interval::EVERYTHING }
        }
    }
    /// Of a function of which no more than values at single numbers is known.
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        if self.value.low == self.value.high {
            let (value, slope) = f(self.value.low);
            return self.chain(Interval::at(value), Interval::at(slope));
        }
        ANYTHING
    }
    fn taylor(self, _: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
        to.fill(ANYTHING);
    }
    fn max_lane(self) -> f64 {
        self.value.high
    }
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
        f()
    }
    fn max(self, other: Self) -> Self {
        if self.value.low >= other.value.high {
            self
        } else if other.value.low >= self.value.high {
            other
        } else {
            Bounds { value: self.value.max(other.value), ..self.hull(other) }
        }
    }
    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }
    fn squared(self) -> Self {
        self.chain(self.value.squared(), self.value + self.value)
    }
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.max(Interval::at(0.0)).recip())
    }
    fn tanh(self) -> Self {
        self.chain(self.value.tanh(), self.value.tanh_slope())
    }
    fn atan(self) -> Self {
        self.chain(self.value.atan(), (self.value.squared() + Interval::at(1.0)).recip())
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        if self.value.meets_cut(x.value) {
            return Bounds { value, slope: Interval::EVERYTHING };
        }
        let across = self.slope * x.value - self.value * x.slope;
        Bounds { value, slope: across / (self.value.squared() + x.value.squared()) }
    }
}
