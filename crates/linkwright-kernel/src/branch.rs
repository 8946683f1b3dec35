//! Numbers that stay on one branch of a function in pieces.
//!
//! At the very end of a step that leads up to a kink or a jump, rounding would decide on which side a torque is
//! evaluated: its slope, or the torque itself, could be that of the next step. So a stage brings a reference along, a
//! state well inside the step. Every choice (`select_lt`, the interval of a table) is made by the reference; the value is
//! that of the piece chosen, continued to where the stage lies. The formulas are the same as for any other number.

use crate::real::{COEFFICIENTS, Lift, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number, and what it is at the reference.
#[derive(Clone, Copy, Debug)]
pub struct OnBranch<N, R> {
    /// The number.
    pub value: N,
    /// The same quantity at the reference: it chooses the branch.
    pub at: R,
}

impl<R: Real, N: Lift<R>> Lift<R> for OnBranch<N, R> {
    #[inline(always)]
    fn lift(constant: R) -> Self {
        OnBranch { value: N::lift(constant), at: constant }
    }
}

/// What has a value and a reference, without a derivative.
impl<R: Real> Lift<OnBranch<R, R>> for OnBranch<crate::dual::Dual<R>, R> {
    #[inline(always)]
    fn lift(constant: OnBranch<R, R>) -> Self {
        OnBranch { value: Lift::<R>::lift(constant.value), at: constant.at }
    }
}

macro_rules! both {
    ($($operation:ident $name:ident),*) => {$(
        impl<R: Real, N: Lift<R>> $operation for OnBranch<N, R> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                OnBranch { value: self.value.$name(other.value), at: self.at.$name(other.at) }
            }
        }
    )*};
}
both!(Add add, Sub sub, Mul mul, Div div);

macro_rules! with_number {
    ($($operation:ident $name:ident),*) => {$(
        impl<R: Real, N: Lift<R>> $operation<f64> for OnBranch<N, R> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                OnBranch { value: self.value.$name(other), at: self.at.$name(other) }
            }
        }
    )*};
}
with_number!(Add add, Sub sub, Mul mul);

impl<R: Real, N: Lift<R>> OnBranch<N, R> {
    /// A result that numbers above zero have. On the branch of such a one a number that rounding took to zero or below lies at
    /// the end of the branch, where the result is known.
    #[inline(always)]
    fn where_defined(self, value: N, at: R, at_zero: f64) -> Self {
        let (zero, end) = (N::splat(0.0), N::splat(at_zero));
        let beside = zero.select_lt(N::lift(self.at), end, value);
        OnBranch { value: zero.select_lt(self.value, value, beside), at }
    }
}

impl<R: Real, N: Lift<R>> Neg for OnBranch<N, R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        OnBranch { value: -self.value, at: -self.at }
    }
}

impl<R: Real, N: Lift<R>> Real for OnBranch<N, R> {
    const LANES: usize = N::LANES;
    const ROUNDS: usize = N::ROUNDS;
    const IS_DUAL: bool = N::IS_DUAL;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        OnBranch { value: N::splat(x), at: R::splat(x) }
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        OnBranch { value: N::load(from), at: R::load(from) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.value.store(to);
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        OnBranch { value: self.value.mul_add(b.value, c.value), at: self.at.mul_add(b.at, c.at) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.where_defined(self.value.sqrt(), self.at.sqrt(), 0.0)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.select_lt(Self::splat(0.0), -self, self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (value, at) = (self.value.sin_cos(), self.at.sin_cos());
        (OnBranch { value: value.0, at: at.0 }, OnBranch { value: value.1, at: at.1 })
    }
    #[inline(always)]
    fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
        OnBranch {
            value: N::lift(self.at).select_lt(N::lift(limit.at), below.value, other.value),
            at: self.at.select_lt(limit.at, below.at, other.at),
        }
    }
    /// Tables are straight lines between points: the line at the reference, continued.
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        let (at, slope) = (self.at.map(&f), self.at.map(|x| (f(x).1, 0.0)));
        OnBranch { value: (self.value - N::lift(self.at)).mul_add(N::lift(slope), N::lift(at)), at }
    }
    #[inline(always)]
    fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
        let (mut values, mut ats) = ([N::splat(0.0); COEFFICIENTS], [R::splat(0.0); COEFFICIENTS]);
        self.value.taylor(f, &mut values[..to.len()]);
        self.at.taylor(f, &mut ats[..to.len()]);
        for (to, (value, at)) in to.iter_mut().zip(values.into_iter().zip(ats)) {
            *to = OnBranch { value, at };
        }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        OnBranch { value: self.value.exp(), at: self.at.exp() }
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.where_defined(self.value.ln(), self.at.ln(), f64::MIN_POSITIVE.ln())
    }
    /// It is written in two pieces, but is one function: there is nothing to choose.
    #[inline(always)]
    fn tanh(self) -> Self {
        OnBranch { value: self.value.tanh(), at: self.at.tanh() }
    }
    #[inline(always)]
    fn atan(self) -> Self {
        OnBranch { value: self.value.atan(), at: self.at.atan() }
    }
    #[inline(always)]
    fn max_lane(self) -> f64 {
        self.value.max_lane()
    }
    #[inline(always)]
    fn any_below(self, limit: Self) -> bool {
        self.at.any_below(limit.at)
    }
    #[inline(always)]
    fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
        N::out_of_line(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::table::Table;

    /// A table is read on the line of the reference, a choice is made by it; derivatives are those of the piece.
    #[test]
    fn the_reference_chooses_the_branch() {
        let table = Table::new(&[0.0, 1.0, 3.0], &[1.0, 3.0, -1.0]).expect("increasing knots");
        let read = |x: f64, at: f64| OnBranch { value: Dual::variable(x), at }.map(|x| table.held(x)).value;
        for (x, at, value, slope) in [(1.0, 0.5, 3.0, 2.0), (1.0, 1.5, 3.0, -2.0), (1.25, 0.5, 3.5, 2.0)] {
            let y = read(x, at);
            assert!((y.value - value).abs() < 1e-15 && (y.d - slope).abs() < 1e-15, "{y:?} at {x} of {at}");
        }
        let size = OnBranch { value: Dual::variable(0.0), at: -1.0 }.abs().value;
        assert!((size.d + 1.0).abs() < 1e-15, "left of zero |x| falls: {size:?}");
    }
}
