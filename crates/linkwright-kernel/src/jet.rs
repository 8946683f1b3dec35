//! Truncated Taylor series: a value and its derivatives up to order N − 1 by one quantity.
//!
//! `x(t) = x₀ + x₁ t + x₂ t² + …`; products are convolutions, the other operations follow from differential
//! equations of the functions, coefficient by coefficient. One evaluation of a kernel with jets of the crank
//! angle gives every derivative by it: the third for the jerk, many for the motion through a change point.
//!
//! Every operation is a function of its own (`R::out_of_line`): a kernel in jets is long, and written out it would be
//! too long to optimise.
//!
//! Source: e.g. Griewank and Walther, *Evaluating Derivatives*, 2nd ed., chapter 13, table 13.2.

use crate::out_of_line;
use crate::real::{COEFFICIENTS, Lift, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The coefficients of a series; `c[k]` is the k-th derivative over k!.
#[derive(Clone, Copy, Debug)]
pub struct Jet<R, const N: usize> {
    /// Coefficients from the constant on.
    pub c: [R; N],
}

impl<R: Real, const N: usize> Jet<R, N> {
    /// A quantity that does not change.
    #[inline(always)]
    pub fn constant(value: R) -> Self {
        let mut c = [R::splat(0.0); N];
        c[0] = value;
        Jet { c }
    }

    /// The quantity by which is differentiated, at a value.
    #[inline(always)]
    pub fn variable(value: R) -> Self {
        let mut jet = Self::constant(value);
        if N > 1 {
            jet.c[1] = R::splat(1.0);
        }
        jet
    }

    /// The same with each coefficient by itself.
    #[inline(always)]
    fn each(self, f: impl Fn(R) -> R) -> Self {
        let mut c = self.c;
        for x in &mut c {
            *x = f(*x);
        }
        Jet { c }
    }
}

/// Σ a_i b_{k−i} for i from `from` to `to`, both included.
#[inline(always)]
fn convolve<R: Real>(a: &[R], b: &[R], k: usize, from: usize, to: usize) -> R {
    let mut sum = R::splat(0.0);
    for i in from..=to {
        sum = a[i].mul_add(b[k - i], sum);
    }
    sum
}

impl<R: Real, const N: usize> Lift<R> for Jet<R, N> {
    #[inline(always)]
    fn lift(constant: R) -> Self {
        Jet::constant(constant)
    }
}

impl<R: Real, const N: usize> Add for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        out_of_line!(R, {
            let mut c = self.c;
            for k in 0..N {
                c[k] = c[k] + o.c[k];
            }
            Jet { c }
        })
    }
}
impl<R: Real, const N: usize> Sub for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        out_of_line!(R, {
            let mut c = self.c;
            for k in 0..N {
                c[k] = c[k] - o.c[k];
            }
            Jet { c }
        })
    }
}
impl<R: Real, const N: usize> Mul for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        out_of_line!(R, {
            let mut c = self.c;
            for k in 0..N {
                c[k] = convolve(&self.c, &o.c, k, 0, k);
            }
            Jet { c }
        })
    }
}
impl<R: Real, const N: usize> Div for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        out_of_line!(R, {
            let inverse = o.c[0].recip();
            let mut c = self.c;
            for k in 0..N {
                if k > 0 {
                    c[k] = c[k] - convolve(&c, &o.c, k, 0, k - 1);
                }
                c[k] = c[k] * inverse;
            }
            Jet { c }
        })
    }
}
impl<R: Real, const N: usize> Neg for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(
            #[inline(always)]
            |x| -x,
        )
    }
}
impl<R: Real, const N: usize> Add<f64> for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: f64) -> Self {
        let mut c = self.c;
        c[0] = c[0] + o;
        Jet { c }
    }
}
impl<R: Real, const N: usize> Sub<f64> for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: f64) -> Self {
        self + (-o)
    }
}
impl<R: Real, const N: usize> Mul<f64> for Jet<R, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: f64) -> Self {
        self.each(
            #[inline(always)]
            |x| x * o,
        )
    }
}

impl<R: Real, const N: usize> Real for Jet<R, N> {
    const LANES: usize = R::LANES;
    // A Newton round doubles the number of coefficients that are right.
    const IS_DUAL: bool = R::IS_DUAL;
    const ROUNDS: usize = R::ROUNDS + N.next_power_of_two().trailing_zeros() as usize;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Jet::constant(R::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        Jet::constant(R::load(from))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.c[0].store(to);
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    /// r² = x: 2 r₀ r_k = x_k − Σ r_i r_{k−i}.
    #[inline(always)]
    fn sqrt(self) -> Self {
        out_of_line!(R, {
            let mut c = self.c;
            c[0] = c[0].sqrt();
            let half = c[0].recip() * 0.5;
            for k in 1..N {
                c[k] = (c[k] - convolve(&c, &c, k, 1, k - 1)) * half;
            }
            Jet { c }
        })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_lt(Self::splat(0.0), -self, self)
    }
    /// s′ = x′ c, c′ = −x′ s.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        out_of_line!(R, {
            let (sin, cos) = self.c[0].sin_cos();
            let (mut s, mut c) = (Self::constant(sin), Self::constant(cos));
            for k in 1..N {
                let (mut up, mut down) = (R::splat(0.0), R::splat(0.0));
                for i in 1..=k {
                    let slope = self.c[i] * i as f64;
                    up = slope.mul_add(c.c[k - i], up);
                    down = slope.mul_add(s.c[k - i], down);
                }
                s.c[k] = up * (1.0 / k as f64);
                c.c[k] = down * (-1.0 / k as f64);
            }
            (s, c)
        })
    }
    /// y′ = x′ y.
    #[inline(always)]
    fn exp(self) -> Self {
        out_of_line!(R, {
            let mut y = Self::constant(self.c[0].exp());
            for k in 1..N {
                let mut sum = R::splat(0.0);
                for i in 1..=k {
                    sum = (self.c[i] * i as f64).mul_add(y.c[k - i], sum);
                }
                y.c[k] = sum * (1.0 / k as f64);
            }
            y
        })
    }
    /// x y′ = x′.
    #[inline(always)]
    fn ln(self) -> Self {
        out_of_line!(R, {
            let inverse = self.c[0].recip();
            let mut y = Self::constant(self.c[0].ln());
            for k in 1..N {
                let mut sum = self.c[k] * k as f64;
                for i in 1..k {
                    sum = sum - y.c[i] * self.c[k - i] * i as f64;
                }
                y.c[k] = sum * inverse * (1.0 / k as f64);
            }
            y
        })
    }
    /// (1 + x²) y′ = x′.
    #[inline(always)]
    fn atan(self) -> Self {
        out_of_line!(R, {
            let w = self * self + 1.0;
            let inverse = w.c[0].recip();
            let mut y = Self::constant(self.c[0].atan());
            for k in 1..N {
                let mut sum = self.c[k] * k as f64;
                for i in 1..k {
                    sum = sum - y.c[i] * w.c[k - i] * i as f64;
                }
                y.c[k] = sum * inverse * (1.0 / k as f64);
            }
            y
        })
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
        let mut c = self.c;
        for k in 0..N {
            c[k] = self.c[0].select_lt(limit.c[0], below.c[k], other.c[k]);
        }
        Jet { c }
    }
    /// Of a table only value and slope are known: it counts as straight.
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        let slope = self.c[0].map(|x| (f(x).1, 0.0));
        let mut c = self.c;
        for x in &mut c[1..] {
            *x = *x * slope;
        }
        c[0] = c[0].map(&f);
        Jet { c }
    }
    /// f(x₀ + δ) = Σ f_j δʲ, and the series of its k-th coefficient likewise, with binomials.
    #[inline(always)]
    fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
        out_of_line!(R, {
            let mut all = [R::splat(0.0); COEFFICIENTS];
            self.c[0].taylor(f, &mut all[..to.len() + N - 1]);
            let mut delta = self;
            delta.c[0] = R::splat(0.0);
            for (k, x) in to.iter_mut().enumerate() {
                *x = Self::splat(0.0);
                for j in (0..N).rev() {
                    let binomial: f64 = (1..=j).map(|i| (k + i) as f64 / i as f64).product();
                    *x = *x * delta + Self::constant(all[k + j] * binomial);
                }
            }
        });
    }
    #[inline(always)]
    fn max_lane(self) -> f64 {
        self.c[0].max_lane()
    }
    #[inline(always)]
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
        R::out_of_line(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives of √(1 + x²)/(2 + sin x) + arctan x² + ln(eˣ + x) against central differences of the next lower one.
    #[test]
    fn every_coefficient_is_the_derivative_of_the_one_before() {
        let f = |at: f64| {
            let x = Jet::<f64, 6>::variable(at);
            (x * x + 1.0).sqrt() / (x.sin_cos().0 + 2.0) + (x * x).atan() + (x.exp() + x).ln()
        };
        let (at, h) = (0.7, 1e-4);
        let (low, mid, high) = (f(at - h), f(at), f(at + h));
        for k in 1..6 {
            let difference = (high.c[k - 1] - low.c[k - 1]) / (2.0 * h * k as f64);
            // Truncation h² times a third derivative of order one; rounding ε/h is less.
            let error = (mid.c[k] - difference).abs();
            assert!(error < 1e-6, "coefficient {k}: {} for {difference}", mid.c[k]);
        }
    }

    #[test]
    fn sine_of_a_line_has_its_series() {
        let (s, c) = Jet::<f64, 5>::variable(0.4).sin_cos();
        let (sin, cos) = 0.4_f64.sin_cos();
        let exact = [sin, cos, -sin / 2.0, -cos / 6.0, sin / 24.0];
        for k in 0..5 {
            // One rounding a step.
            assert!((s.c[k] - exact[k]).abs() < 1e-15, "sine, coefficient {k}");
        }
        assert!((c.c[1] + sin).abs() < 1e-15, "cosine");
    }
}
