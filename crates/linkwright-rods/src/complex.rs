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
        let ((sin, cos), grown) = (self.0.sin_cos(), self.1.exp());
        let (cosh, sinh) = ((grown + grown.recip()) * 0.5, (grown - grown.recip()) * 0.5);
        (Complex(cos * cosh, -(sin * sinh)), Complex(sin * cosh, cos * sinh))
    }
}

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
