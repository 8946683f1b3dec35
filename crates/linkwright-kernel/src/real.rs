//! What a kernel may do with a number.
//!
//! Every kernel of this crate is written once, generic over [`Real`]. With `f64` it is the truth that
//! anyone can check; with SIMD lanes ([`crate::lanes`]) it does many crank angles or many machines at
//! once; with [`crate::dual::Dual`] it carries an exact derivative along.
//!
//! There are no masks: a choice is [`Real::select_lt`], so a lane that goes wrong (NaN) stays alone.

use std::f64::consts::FRAC_PI_2;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Most Taylor coefficients that a number can ask for: the series at a change point, and the few beyond it.
pub const COEFFICIENTS: usize = 24;

/// A real number, or a bundle of them that is worked on together.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// How many plain numbers the bundle holds.
    const LANES: usize;
    /// Whether it is numbers alone, without derivatives: then a function of it is done in its own arithmetic.
    const IS_PLAIN: bool = false;
    /// Whether it carries a derivative by what the numbers of a machine vary with: then what is known beforehand of a function,
    /// as the points of a table, is read from those numbers. Only duals do.
    const IS_DUAL: bool = false;
    /// Rounds of Newton's method, after the value has converged, until all derivatives carried along have.
    const ROUNDS: usize = 0;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// Reads `LANES` numbers from the start of a slice.
    fn load(from: &[f64]) -> Self;
    /// Writes `LANES` numbers to the start of a slice.
    fn store(self, to: &mut [f64]);
    /// `self · b + c`; fused where the machine has it, so lanes and scalar may differ by an ulp.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Square root; NaN for a negative number, which is how a linkage that does not close shows itself.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `(sin, cos)`, to about an ulp for |x| < 1e5.
    fn sin_cos(self) -> (Self, Self);
    /// Lane by lane: `below` where `self < limit`, else `other` (also where `self` is NaN).
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self;
    /// Applies a scalar function `x ↦ (value, slope)` lane by lane; only tables need it.
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self;
    /// Taylor coefficients at `self` of a scalar function, lane by lane: `f` fills in as many as there is room
    /// for. Only motion laws need it.
    fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]);
    /// Largest lane; of several lanes a NaN is passed over.
    fn max_lane(self) -> f64;
    /// Whether some lane lies below that of a limit; one that is no number does not.
    #[inline(always)]
    fn any_below(self, limit: Self) -> bool {
        (limit - self).max_lane() > 0.0
    }
    /// Runs `f` as a function of its own, compiled for the same instruction set. Cuts kernels at their
    /// natural joints: one body of many thousand instructions would no longer be optimised well.
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T;

    /// The larger of the two, lane by lane.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select_lt(other, other, self)
    }

    /// The smaller of the two, lane by lane.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        other.select_lt(self, other, self)
    }

    /// The square.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }

    /// One over it.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::splat(1.0) / self
    }

    /// eˣ. Like [`Real::ln`] and, but for lanes, [`Real::atan`] it is done lane by lane with one derivative; a number that
    /// carries more of them brings its own three, and everything below follows from those.
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(
            #[inline(always)]
            |x| {
                let e = x.exp();
                (e, e)
            },
        )
    }

    /// Natural logarithm; NaN below zero.
    #[inline(always)]
    fn ln(self) -> Self {
        self.map(
            #[inline(always)]
            |x| (x.ln(), 1.0 / x),
        )
    }

    /// Hyperbolic tangent, to some ulps of itself: (1 − e⁻²ˣ)/(1 + e⁻²ˣ), whose digits cancel near zero; there the
    /// seventh convergent of x/(1 + x²/(3 + x²/(5 + …))), Abramowitz and Stegun 4.5.70, which errs by x¹⁴/(15 · 135135²).
    #[inline(always)]
    fn tanh(self) -> Self {
        let (square, size) = (self.squared(), self.abs());
        let above = ((square + 378.0) * square + 17_325.0) * square + 135_135.0;
        let below = ((square * 28.0 + 3150.0) * square + 62_370.0) * square + 135_135.0;
        let e = (size * -2.0).exp();
        let far = (Self::splat(1.0) - e) / (e + 1.0);
        let far = self.select_lt(Self::splat(0.0), -far, far);
        size.select_lt(Self::splat(TANH_NEAR), self * above / below, far)
    }

    /// Arc tangent, in (−π/2, π/2).
    #[inline(always)]
    fn atan(self) -> Self {
        self.map(
            #[inline(always)]
            |x| (x.atan(), 1.0 / (1.0 + x * x)),
        )
    }

    /// Angle of the vector (`x`, `self`), in (−π, π]; NaN for the null vector, which has none.
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let (y, zero) = (self, Self::splat(0.0));
        let (size, other) = (x.abs(), y.abs());
        // Beyond 45° from the x axis the angle is counted from the y axis, so that quotients stay below 1.
        let quotient = size.select_lt(other, -x, y) / size.select_lt(other, y, x);
        let half = y.select_lt(zero, Self::splat(-FRAC_PI_2), Self::splat(FRAC_PI_2));
        let whole = x.select_lt(zero, half + half, zero);
        size.select_lt(other, half, whole) + quotient.atan()
    }
}

/// An expression worked out by a function of its own ([`Real::out_of_line`]), compiled once for each kind of number.
#[macro_export]
macro_rules! out_of_line {
    ($number:ty, $work:expr) => {
        <$number as $crate::real::Real>::out_of_line(
            #[inline(always)]
            || $work,
        )
    };
}

/// Below this size the hyperbolic tangent is a quotient of polynomials.
const TANH_NEAR: f64 = 0.5;

/// Most lanes of a bundle.
pub const LANES_MAX: usize = 16;

/// The first lanes of a list, zeros beyond its end.
#[inline(always)]
pub fn load_part<R: Real>(list: &[f64]) -> R {
    if list.len() >= R::LANES {
        return R::load(list);
    }
    let mut lanes = [0.0; LANES_MAX];
    lanes[..list.len()].copy_from_slice(list);
    R::load(&lanes)
}

/// Writes the first lanes into a list, as many as there is room for.
#[inline(always)]
pub fn store_part<R: Real>(x: R, to: &mut [f64]) {
    if to.len() >= R::LANES {
        return x.store(to);
    }
    let mut lanes = [0.0; LANES_MAX];
    x.store(&mut lanes);
    to.copy_from_slice(&lanes[..to.len()]);
}

/// A kind of number that plain ones of kind `R` can be turned into as constants: `R` itself or a dual.
pub trait Lift<R>: Real {
    /// The constant.
    fn lift(constant: R) -> Self;
}

impl<R: Real> Lift<R> for R {
    #[inline(always)]
    fn lift(constant: R) -> Self {
        constant
    }
}

impl Real for f64 {
    const LANES: usize = 1;
    const IS_PLAIN: bool = true;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }
    // Not `f64::mul_add`: without FMA in the build target that is a call into libm.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
        if self < limit { below } else { other }
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        f(self).0
    }
    #[inline(always)]
    fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
        f(self, to);
    }
    #[inline(always)]
    fn max_lane(self) -> f64 {
        self
    }
    #[inline(never)]
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
        #[inline(never)]
        fn call<T>(f: impl FnOnce() -> T) -> T {
            f()
        }
        call(f)
    }
}
