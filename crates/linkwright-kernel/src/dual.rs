//! Dual numbers: a value and its derivative by one quantity, carried through the same code.
//!
//! `(a + a′ε)(b + b′ε) = ab + (a′b + ab′)ε`, ε² = 0. The derivative is exact to rounding, which is what
//! lets Newton's method converge quadratically without a second description of any formula.

use crate::real::{COEFFICIENTS, Lift, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with its derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual<R> {
    /// The number.
    pub value: R,
    /// Its derivative.
    pub d: R,
}

impl<R: Real> Dual<R> {
    /// The quantity by which is differentiated.
    #[inline(always)]
    pub fn variable(value: R) -> Self {
        Dual { value, d: R::splat(1.0) }
    }
    /// A quantity that does not depend on it.
    #[inline(always)]
    pub fn constant(value: R) -> Self {
        Dual { value, d: R::splat(0.0) }
    }
}

impl<R: Real> Lift<R> for Dual<R> {
    #[inline(always)]
    fn lift(constant: R) -> Self {
        Dual::constant(constant)
    }
}

impl<R: Real> Add for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Dual { value: self.value + o.value, d: self.d + o.d }
    }
}
impl<R: Real> Sub for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Dual { value: self.value - o.value, d: self.d - o.d }
    }
}
impl<R: Real> Mul for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Dual { value: self.value * o.value, d: self.d.mul_add(o.value, self.value * o.d) }
    }
}
impl<R: Real> Div for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let inverse = o.value.recip();
        let value = self.value * inverse;
        let d = (self.d - value * o.d) * inverse;
        // A divisor that overflows, as 1 + exp x, leaves nothing: 0 ∞ is no slope.
        let nothing = R::splat(0.0);
        Dual { value, d: inverse.abs().select_lt(R::splat(f64::MIN_POSITIVE), nothing, d) }
    }
}
impl<R: Real> Neg for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { value: -self.value, d: -self.d }
    }
}
impl<R: Real> Add<f64> for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        Dual { value: self.value + o, d: self.d }
    }
}
impl<R: Real> Sub<f64> for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: f64) -> Self {
        Dual { value: self.value - o, d: self.d }
    }
}
impl<R: Real> Mul<f64> for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        Dual { value: self.value * o, d: self.d * o }
    }
}

impl<R: Real> Real for Dual<R> {
    const LANES: usize = R::LANES;
    const ROUNDS: usize = R::ROUNDS + 1;
    const IS_DUAL: bool = true;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Dual::constant(R::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        Dual::constant(R::load(from))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.value.store(to);
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        Dual {
            value: self.value.mul_add(b.value, c.value),
            d: self.d.mul_add(b.value, self.value.mul_add(b.d, c.d)),
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Dual { value: root, d: self.d * 0.5 / root }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_lt(Self::splat(0.0), -self, self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (Dual { value: s, d: c * self.d }, Dual { value: c, d: -(s * self.d) })
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
        Dual {
            value: self.value.select_lt(limit.value, below.value, other.value),
            d: self.value.select_lt(limit.value, below.d, other.d),
        }
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        let slope = self.value.map(|x| (f(x).1, 0.0));
        Dual { value: self.value.map(&f), d: slope * self.d }
    }
    /// The slope of a coefficient is the next one, times its order.
    #[inline(always)]
    fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
        let mut all = [R::splat(0.0); COEFFICIENTS];
        self.value.taylor(f, &mut all[..to.len() + 1]);
        for (k, x) in to.iter_mut().enumerate() {
            *x = Dual { value: all[k], d: all[k + 1] * (k + 1) as f64 * self.d };
        }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.value.exp();
        Dual { value: e, d: e * self.d }
    }
    #[inline(always)]
    fn ln(self) -> Self {
        Dual { value: self.value.ln(), d: self.d / self.value }
    }
    #[inline(always)]
    fn atan(self) -> Self {
        Dual { value: self.value.atan(), d: self.d / (self.value.squared() + 1.0) }
    }
    #[inline(always)]
    fn max_lane(self) -> f64 {
        self.value.max_lane()
    }
    #[inline(always)]
    fn any_below(self, limit: Self) -> bool {
        self.value.any_below(limit.value)
    }
    #[inline(always)]
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
        R::out_of_line(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivative_is_the_analytic_one() {
        let x = Dual::variable(0.7);
        let f = (x * x + 1.0).sqrt() / (x.sin_cos().0 + 2.0);
        let (s, c) = 0.7_f64.sin_cos();
        let root = (0.49_f64 + 1.0).sqrt();
        let exact = 0.7 / root / (s + 2.0) - root * c / (s + 2.0).powi(2);
        // Ten operations of one ulp each.
        assert!((f.d - exact).abs() < 1e-15, "{} against {exact}", f.d);
    }
}
