//! Intervals: all that a quantity can be while what it depends on runs through a piece of its range.
//!
//! What follows from intervals encloses every value that follows from numbers in them (Moore, *Interval Analysis*, 1966). A
//! quantity that occurs twice counts as two, so that an enclosure may be too wide; it narrows with the piece. Ends are
//! rounded to the nearest number, not outwards: enclosures here tell changes of a thousandth, not of some ulps.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `low` to `high`; none where `low` is above `high`, as of a root of negative numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    /// Anything.
    pub const EVERYTHING: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// No number.
    pub const NOTHING: Interval = Interval { low: f64::INFINITY, high: f64::NEG_INFINITY };

    /// One number; none for a NaN.
    pub fn at(x: f64) -> Self {
        if x.is_nan() { Interval::NOTHING } else { Interval { low: x, high: x } }
    }

    /// From two ends. One that is no number, as ∞ − ∞, may be anything.
    fn between(low: f64, high: f64) -> Self {
        Interval {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
        }
    }

    /// Around all of some numbers; a NaN counts for nothing.
    pub fn around(numbers: impl IntoIterator<Item = f64>) -> Self {
        numbers.into_iter().fold(Interval::NOTHING, |all, x| all.hull(Interval::at(x)))
    }

    /// Around both.
    pub fn hull(self, other: Self) -> Self {
        Interval { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether there is no number in it.
    pub fn is_empty(self) -> bool {
        self.low > self.high
    }

    /// From the lowest number to the highest; 0 where there is none.
    pub fn width(self) -> f64 {
        (self.high - self.low).max(0.0)
    }

    /// Whether a number lies in it.
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// With both ends moved out.
    #[must_use]
    pub fn widened(self, by: f64) -> Self {
        Interval::between(self.low - by, self.high + by)
    }

    /// Of a function that rises.
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        let (low, high) = (f(self.low), f(self.high));
        // The function may have no value for any of them.
        if self.is_empty() || low.is_nan() && high.is_nan() {
            return Interval::NOTHING;
        }
        Interval::between(low, high)
    }

    /// Sizes.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.is_empty() || self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Interval { low: 0.0, high: self.high.max(-self.low) }
        }
    }

    /// Squares: of a quantity times itself.
    #[must_use]
    pub fn squared(self) -> Self {
        self.abs().rising(|x| x * x)
    }

    /// The larger of two quantities.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Interval::NOTHING;
        }
        Interval { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    /// Square roots; anything where some numbers have none.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.low < 0.0 && self.high >= 0.0 { Interval::EVERYTHING } else { self.rising(f64::sqrt) }
    }

    /// eˣ.
    #[must_use]
    pub fn exp(self) -> Self {
        self.rising(f64::exp)
    }

    /// Natural logarithms; anything where some numbers have none.
    #[must_use]
    pub fn ln(self) -> Self {
        if self.low < 0.0 && self.high >= 0.0 { Interval::EVERYTHING } else { self.rising(f64::ln) }
    }

    /// Hyperbolic tangents.
    #[must_use]
    pub fn tanh(self) -> Self {
        self.rising(f64::tanh)
    }

    /// Slopes of the hyperbolic tangent, 1/cosh², which fall on both sides of zero.
    #[must_use]
    pub fn tanh_slope(self) -> Self {
        let slope = |x: f64| x.cosh().powi(-2);
        let size = self.abs();
        if size.is_empty() { size } else { Interval::between(slope(size.high), slope(size.low)) }
    }

    /// Arc tangents.
    #[must_use]
    pub fn atan(self) -> Self {
        self.rising(f64::atan)
    }

    /// Angles of vectors (x, y): those of the corners, unless the rectangle contains the null vector or meets the cut at ±π.
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        if self.is_empty() || x.is_empty() {
            return Interval::NOTHING;
        }
        if self.meets_cut(x) {
            return Interval { low: -PI, high: PI };
        }
        Interval::around([self.low, self.high].into_iter().flat_map(|y| [y.atan2(x.low), y.atan2(x.high)]))
    }

    /// Whether the angle of a vector (x, y) may jump.
    pub fn meets_cut(self, x: Self) -> bool {
        x.low <= 0.0 && self.low <= 0.0 && self.high >= 0.0
    }

    /// Sines: ±1 where a crest or a trough lies inside.
    #[must_use]
    pub fn sin(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let crest = |at: f64| ((self.high - at) / TAU).floor() * TAU + at >= self.low;
        // An infinite end leaves a NaN, which is no crest.
        if self.high - self.low < TAU {
            let (a, b) = (self.low.sin(), self.high.sin());
            let low = if crest(-FRAC_PI_2) { -1.0 } else { a.min(b) };
            Interval { low, high: if crest(FRAC_PI_2) { 1.0 } else { a.max(b) } }
        } else {
            Interval { low: -1.0, high: 1.0 }
        }
    }

    /// Cosines.
    #[must_use]
    pub fn cos(self) -> Self {
        (self + Interval::at(FRAC_PI_2)).sin()
    }

    /// One over it: everything where it goes through zero.
    #[must_use]
    pub fn recip(self) -> Self {
        if self.is_empty() {
            self
        } else if self.low > 0.0 || self.high < 0.0 {
            Interval { low: 1.0 / self.high, high: 1.0 / self.low }
        } else if self.low == 0.0 && self.high > 0.0 {
            Interval { low: 1.0 / self.high, high: f64::INFINITY }
        } else if self.high == 0.0 && self.low < 0.0 {
            Interval { low: f64::NEG_INFINITY, high: 1.0 / self.low }
        } else {
            Interval::EVERYTHING
        }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Interval::NOTHING;
        }
        Interval::between(self.low + o.low, self.high + o.high)
    }
}
impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}
impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Interval { low: -self.high, high: -self.low }
    }
}
impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        if self.is_empty() || o.is_empty() {
            return Interval::NOTHING;
        }
        // Zero times anything, however large, is zero.
        let times = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        Interval::around([self.low, self.high].into_iter().flat_map(|a| [times(a, o.low), times(a, o.high)]))
    }
}
impl Div for Interval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let inverse = o.recip();
        self.mul(inverse)
    }
}
