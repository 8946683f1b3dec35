//! Complex numbers of any kind of number.

use linkwright_kernel::real::Real;
use std::ops::{Add, Mul, Sub};

/// A complex number.
#[derive(Clone, Copy, Debug)]
pub struct Complex<R>(pub R, pub R);

impl<R: Real> Complex<R> {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(re: f64, im: f64) -> Self {
        Complex(R::splat(re), R::splat(im))
    }

    /// The conjugate.
    #[inline(always)]
    pub fn conj(self) -> Self {
        Complex(self.0, -self.1)
    }

    /// `i` times it.
    #[inline(always)]
    pub fn turned(self) -> Self {
        Complex(-self.1, self.0)
    }

    /// A real multiple.
    #[inline(always)]
    pub fn times(self, factor: R) -> Self {
        Complex(self.0 * factor, self.1 * factor)
    }

    /// Square of the absolute value.
    #[inline(always)]
    pub fn norm(self) -> R {
        self.0 * self.0 + self.1 * self.1
    }

    /// One over it.
    #[inline(always)]
    pub fn recip(self) -> Self {
        self.conj().times(self.norm().recip())
    }

    /// Cosine and sine.
    #[inline(always)]
    pub fn cos_sin(self) -> (Self, Self) {
        let ((sin, cos), grown) = (self.0.sin_cos(), exp(self.1));
        let (cosh, sinh) = ((grown + grown.recip()) * 0.5, (grown - grown.recip()) * 0.5);
        (Complex(cos * cosh, -(sin * sinh)), Complex(sin * cosh, cos * sinh))
    }
}

/// eˣ by its series, which lanes sum side by side, and squares of it; of larger numbers than any damping has, lane by lane.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    let size = x.abs().max_lane();
    let squares = match size {
        ..1.0 => 2,
        ..64.0 => 8,
        _ => return x.exp(),
    };
    // Of a quarter at most: the term of order 13 is below 1e-17.
    let x = x * 0.5_f64.powi(squares);
    let mut sum = R::splat(1.0);
    for inverse in INVERSES {
        sum = (x * inverse).mul_add(sum, R::splat(1.0));
    }
    for _ in 0..squares {
        sum = sum.squared();
    }
    sum
}

/// 1/12 to 1.
const INVERSES: [f64; 12] = {
    let mut list = [0.0; 12];
    let mut n = 0;
    while n < 12 {
        list[n] = 1.0 / (12 - n) as f64;
        n += 1;
    }
    list
};

impl<R: Real> Add for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Complex(self.0 + other.0, self.1 + other.1)
    }
}

impl<R: Real> Sub for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Complex(self.0 - other.0, self.1 - other.1)
    }
}

impl<R: Real> Mul for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Complex(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl<R: Real> Mul<f64> for Complex<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Complex(self.0 * factor, self.1 * factor)
    }
}
