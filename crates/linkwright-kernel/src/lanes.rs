//! SIMD lanes.
//!
//! [`V`] is one register ([`crate::registers`]) of the instruction set found at run time, [`Pair`] two of them side by side,
//! which hides the latency of square root and division. A [`Job`] is a piece of work generic over
//! [`Real`]; [`in_lanes`] runs it on the widest registers this processor has, [`in_common_lanes`] on those that all have,
//! [`scalar`] on `f64`.

use crate::out_of_line;
use crate::real::{COEFFICIENTS, Real};
#[cfg(not(target_arch = "x86_64"))]
use crate::registers::Plain as Common;
use crate::registers::Register;
#[cfg(target_arch = "x86_64")]
use crate::registers::{Avx2 as Common, Avx512};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A piece of work that can be done in any number of lanes.
pub trait Job {
    /// What it returns.
    type Output;
    /// Does the work with numbers of kind `R`.
    fn run<R: Real>(self) -> Self::Output;
}

/// Runs the job two registers at a time on the widest registers that this processor has.
pub fn in_lanes<J: Job>(job: J) -> J::Output {
    #[cfg(target_arch = "x86_64")]
    if Avx512::is_here() {
        return out_of_line!(V<Avx512>, job.run::<Pair<V<Avx512>>>());
    }
    assert!(is_supported(), "{NEEDS}");
    out_of_line!(V<Common>, job.run::<Pair<V<Common>>>())
}

/// The same one register at a time: for numbers that carry derivatives along, two of which fill the processor as two registers
/// do, in half the code.
pub fn in_single_lanes<J: Job>(job: J) -> J::Output {
    #[cfg(target_arch = "x86_64")]
    if Avx512::is_here() {
        return out_of_line!(V<Avx512>, job.run::<V<Avx512>>());
    }
    in_common_lanes(job)
}

/// The same on registers of the one kind that all processors of an architecture have: for large kernels that are not hot, which
/// are compiled once then.
pub fn in_common_lanes<J: Job>(job: J) -> J::Output {
    assert!(is_supported(), "{NEEDS}");
    out_of_line!(V<Common>, job.run::<V<Common>>())
}

/// What a processor needs: kernels for one without would be a third of all code.
pub const NEEDS: &str = "Linkwright needs a processor with AVX2 and FMA: Intel since 2013, AMD since 2015";

/// Whether this processor has it.
pub fn is_supported() -> bool {
    Common::is_here()
}

/// Runs the job on plain `f64`: the truth that lanes are measured against.
pub fn scalar<J: Job>(job: J) -> J::Output {
    job.run::<f64>()
}

/// One register.
#[derive(Clone, Copy)]
pub struct V<S>(S);

/// Two bundles side by side.
#[derive(Clone, Copy)]
pub struct Pair<R>(R, R);

macro_rules! operator {
    ($S:ty, $op:ident, $method:ident) => {
        impl $op for V<$S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                V(self.0.$method(other.0))
            }
        }
        impl $op for Pair<V<$S>> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Pair(V(self.0.0.$method(other.0.0)), V(self.1.0.$method(other.1.0)))
            }
        }
    };
}

macro_rules! with_plain_number {
    ($S:ty, $op:ident, $method:ident) => {
        impl $op<f64> for V<$S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                V(self.0.$method(<$S>::splat(other)))
            }
        }
        impl $op<f64> for Pair<V<$S>> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                let other = <$S>::splat(other);
                Pair(V(self.0.0.$method(other)), V(self.1.0.$method(other)))
            }
        }
    };
}

// Written out for each register, not once for any: what is known when a crate is compiled is inlined there, once.
macro_rules! numbers {
    ($S:ty) => {
        operator!($S, Add, add);
        operator!($S, Sub, sub);
        operator!($S, Mul, mul);
        operator!($S, Div, div);
        with_plain_number!($S, Add, add);
        with_plain_number!($S, Sub, sub);
        with_plain_number!($S, Mul, mul);

        impl Neg for V<$S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                V(self.0.neg())
            }
        }

        impl Real for V<$S> {
            const LANES: usize = <$S>::LANES;
            const IS_PLAIN: bool = true;

            #[inline(always)]
            fn splat(x: f64) -> Self {
                V(<$S>::splat(x))
            }
            #[inline(always)]
            fn load(from: &[f64]) -> Self {
                V(<$S>::load(from))
            }
            #[inline(always)]
            fn store(self, to: &mut [f64]) {
                self.0.store(to);
            }
            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                V(self.0.mul_add(b.0, c.0))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                V(self.0.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                V(self.0.abs())
            }

            /// Cody–Waite reduction to [−π/4, π/4] (three parts of π/2, exact for |x| < 1e5), then the minimax
            /// polynomials of fdlibm (`k_sin.c`, `k_cos.c`), then the quadrant put right without a branch.
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                // 1.5 · 2⁵²: adding it rounds to the nearest whole number, which then sits in the low bits.
                const ROUND: f64 = 6_755_399_441_055_744.0;
                let shifted = self.mul_add(Self::splat(core::f64::consts::FRAC_2_PI), Self::splat(ROUND));
                let quarter = shifted - ROUND;
                let x = quarter.mul_add(Self::splat(-1.570_796_326_734_125_6), self);
                let x = quarter.mul_add(Self::splat(-6.077_100_506_303_966e-11), x);
                let x = quarter.mul_add(Self::splat(-2.022_266_248_795_950_6e-21), x);
                let (s, c) = sin_cos_near_zero(x);
                let (quadrant, [s, c]) = (shifted.0, [s.0, c.0]);
                let is_odd = quadrant.has_bit(0, 1);
                let (sin, cos) = (<$S>::select(is_odd, c, s), <$S>::select(is_odd, s, c));
                let sin = <$S>::select(quadrant.has_bit(0, 2), sin.neg(), sin);
                (V(sin), V(<$S>::select(quadrant.has_bit(1, 2), cos.neg(), cos)))
            }
            /// Reduction to |x| ≤ 0.66 by arctan x = π/4 + arctan (x − 1)/(x + 1) and π/2 − arctan 1/x, then the rational
            /// approximation of Cephes (Moshier, *Methods and Programs for Mathematical Functions*, 1989, `atan.c`).
            #[inline(always)]
            fn atan(self) -> Self {
                const P: [f64; 5] = [
                    -8.750_608_600_031_904e-1,
                    -1.615_753_718_733_365e1,
                    -7.500_855_792_314_705e1,
                    -1.228_866_684_490_136_2e2,
                    -6.485_021_904_942_025e1,
                ];
                const Q: [f64; 6] = [
                    1.0,
                    2.485_846_490_142_306_3e1,
                    1.650_270_098_316_988_5e2,
                    4.328_810_604_912_903e2,
                    4.853_903_996_359_137e2,
                    1.945_506_571_482_614e2,
                ];
                // What π/2 has beyond its double.
                const BEYOND: f64 = 6.123_233_995_736_766e-17;
                let (zero, one, size) = (Self::splat(0.0), Self::splat(1.0), self.abs());
                let (middle, far) = (Self::splat(0.66), Self::splat(2.414_213_562_373_095));
                let pick = |near: Self, between: Self, beyond: Self| {
                    size.select_lt(middle, near, size.select_lt(far, between, beyond))
                };
                let x = pick(size, size - one, -one) / pick(one, size + one, size);
                let start = pick(zero, Self::splat(FRAC_PI_4), Self::splat(FRAC_PI_2));
                let rest = pick(zero, Self::splat(0.5 * BEYOND), Self::splat(BEYOND));
                let z = x * x;
                let horner = |c: &[f64]| {
                    let mut sum = Self::splat(c[0]);
                    for &next in &c[1..] {
                        sum = sum.mul_add(z, Self::splat(next));
                    }
                    sum
                };
                let tail = (x * (z * horner(&P) / horner(&Q)) + rest) + x;
                let found = start + tail;
                self.select_lt(zero, -found, found)
            }
            #[inline(always)]
            fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
                V(<$S>::select(self.0.less_than(limit.0), below.0, other.0))
            }
            #[inline(always)]
            fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
                // The widest register has eight lanes.
                let mut lanes = [0.0; 8];
                self.store(&mut lanes);
                for x in &mut lanes[..Self::LANES] {
                    *x = f(*x).0;
                }
                Self::load(&lanes)
            }
            #[inline(always)]
            fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
                let mut lanes = [0.0; 8];
                self.store(&mut lanes);
                let mut rows = [[0.0; 8]; COEFFICIENTS];
                let mut one = [0.0; COEFFICIENTS];
                for (lane, &x) in lanes[..Self::LANES].iter().enumerate() {
                    f(x, &mut one[..to.len()]);
                    for (row, &c) in rows.iter_mut().zip(&one[..to.len()]) {
                        row[lane] = c;
                    }
                }
                for (to, row) in to.iter_mut().zip(&rows) {
                    *to = Self::load(row);
                }
            }
            #[inline(always)]
            fn max_lane(self) -> f64 {
                let mut lanes = [0.0; 8];
                self.store(&mut lanes);
                lanes[..Self::LANES].iter().copied().fold(f64::NEG_INFINITY, f64::max)
            }
            #[inline(always)]
            fn any_below(self, limit: Self) -> bool {
                <$S>::any(self.0.less_than(limit.0))
            }
            #[inline(always)]
            fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
                <$S>::call(f)
            }
        }

        impl Neg for Pair<V<$S>> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Pair(-self.0, -self.1)
            }
        }

        impl Real for Pair<V<$S>> {
            const LANES: usize = 2 * <V<$S>>::LANES;
            const IS_PLAIN: bool = <V<$S>>::IS_PLAIN;

            #[inline(always)]
            fn splat(x: f64) -> Self {
                Pair(<V<$S>>::splat(x), <V<$S>>::splat(x))
            }
            #[inline(always)]
            fn load(from: &[f64]) -> Self {
                Pair(<V<$S>>::load(from), <V<$S>>::load(&from[<V<$S>>::LANES..]))
            }
            #[inline(always)]
            fn store(self, to: &mut [f64]) {
                self.0.store(to);
                self.1.store(&mut to[<V<$S>>::LANES..]);
            }
            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                Pair(self.0.mul_add(b.0, c.0), self.1.mul_add(b.1, c.1))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Pair(self.0.sqrt(), self.1.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Pair(self.0.abs(), self.1.abs())
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let ((s0, c0), (s1, c1)) = (self.0.sin_cos(), self.1.sin_cos());
                (Pair(s0, s1), Pair(c0, c1))
            }
            #[inline(always)]
            fn atan(self) -> Self {
                Pair(self.0.atan(), self.1.atan())
            }
            #[inline(always)]
            fn select_lt(self, limit: Self, below: Self, other: Self) -> Self {
                Pair(self.0.select_lt(limit.0, below.0, other.0), self.1.select_lt(limit.1, below.1, other.1))
            }
            #[inline(always)]
            fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
                Pair(self.0.map(&f), self.1.map(&f))
            }
            #[inline(always)]
            fn taylor(self, f: &impl Fn(f64, &mut [f64]), to: &mut [Self]) {
                let (mut first, mut second) =
                    ([<V<$S>>::splat(0.0); COEFFICIENTS], [<V<$S>>::splat(0.0); COEFFICIENTS]);
                self.0.taylor(f, &mut first[..to.len()]);
                self.1.taylor(f, &mut second[..to.len()]);
                for (to, (a, b)) in to.iter_mut().zip(first.into_iter().zip(second)) {
                    *to = Pair(a, b);
                }
            }
            #[inline(always)]
            fn max_lane(self) -> f64 {
                self.0.max_lane().max(self.1.max_lane())
            }
            #[inline(always)]
            fn any_below(self, limit: Self) -> bool {
                self.0.any_below(limit.0) || self.1.any_below(limit.1)
            }
            #[inline(always)]
            fn out_of_line<T>(f: impl FnOnce() -> T) -> T {
                <V<$S>>::out_of_line(f)
            }
        }
    };
}
#[cfg(target_arch = "x86_64")]
numbers!(Avx512);
numbers!(Common);
/// sin and cos on [−π/4, π/4]; coefficients of fdlibm's `k_sin.c` and `k_cos.c`.
#[inline(always)]
fn sin_cos_near_zero<R: Real>(x: R) -> (R, R) {
    const SIN: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    const COS: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let z = x * x;
    let horner = |c: &[f64; 6]| {
        let mut sum = R::splat(c[5]);
        for &next in c[..5].iter().rev() {
            sum = sum.mul_add(z, R::splat(next));
        }
        sum
    };
    let sin = (x * z).mul_add(horner(&SIN), x);
    let cos = (z * z).mul_add(horner(&COS), z.mul_add(R::splat(-0.5), R::splat(1.0)));
    (sin, cos)
}

// What other processors run is tested on this one.
#[cfg(all(test, target_arch = "x86_64"))]
numbers!(crate::registers::Plain);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registers::Plain;

    /// Sine and cosine of every lane against libm.
    struct SinCos<'a>(&'a [f64]);
    impl Job for SinCos<'_> {
        type Output = f64;
        #[inline(always)]
        fn run<R: Real>(self) -> f64 {
            let mut worst = 0.0_f64;
            let (mut sin, mut cos) = (vec![0.0; R::LANES], vec![0.0; R::LANES]);
            for x in self.0.chunks_exact(R::LANES) {
                let (s, c) = R::load(x).sin_cos();
                s.store(&mut sin);
                c.store(&mut cos);
                for i in 0..R::LANES {
                    worst = worst.max((sin[i] - x[i].sin()).abs()).max((cos[i] - x[i].cos()).abs());
                }
            }
            worst
        }
    }

    #[test]
    fn sine_and_cosine_agree_with_libm() {
        let angles: Vec<f64> = (0..160_000).map(|i| (f64::from(i) - 80_000.0) * 0.012_345).collect();
        let error = in_lanes(SinCos(&angles));
        // Both are good to an ulp of a number below one: 2.2e-16 each.
        assert!(error < 4.5e-16, "lanes differ from libm by {error:e}");
        // Without a fused product the reduction of large angles errs by roundings of the angle: 1000 · 1.1e-16.
        let plain = SinCos(&angles[75_000..85_000]).run::<Pair<V<Plain>>>();
        assert!(plain < 2e-14, "arrays differ from libm by {plain:e}");
    }

    /// Arc tangent of every lane against libm, relative to its size.
    struct Atan<'a>(&'a [f64]);
    impl Job for Atan<'_> {
        type Output = f64;
        #[inline(always)]
        fn run<R: Real>(self) -> f64 {
            let (mut worst, mut lanes) = (0.0_f64, vec![0.0; R::LANES]);
            for x in self.0.chunks_exact(R::LANES) {
                R::load(x).atan().store(&mut lanes);
                for i in 0..R::LANES {
                    worst = worst.max(((lanes[i] - x[i].atan()) / x[i].atan().abs().max(1e-300)).abs());
                }
            }
            worst
        }
    }

    #[test]
    fn arc_tangent_agrees_with_libm() {
        let sizes: Vec<f64> = (0..80_000).map(|i| (f64::from(i) * 7e-4 - 28.0).exp()).collect();
        let both: Vec<f64> = sizes.iter().flat_map(|&x| [x, -x]).collect();
        let error = in_lanes(Atan(&both));
        // Two ulps of the result.
        assert!(error < 4.5e-16, "lanes differ from libm by {error:e}");
        assert_eq!(in_lanes(Atan(&[f64::INFINITY; 16])), 0.0, "at infinity");
    }

    struct Choice;
    impl Job for Choice {
        type Output = (f64, f64, f64);
        #[inline(always)]
        fn run<R: Real>(self) -> Self::Output {
            let (one, two, nan) = (R::splat(1.0), R::splat(2.0), R::splat(f64::NAN));
            (one.max(two).max_lane(), one.min(two).max_lane(), nan.select_lt(two, one, two).max_lane())
        }
    }

    #[test]
    fn choices_are_the_scalar_ones() {
        assert_eq!(in_lanes(Choice), (2.0, 1.0, 2.0), "lanes");
        assert_eq!(Choice.run::<Pair<V<Plain>>>(), (2.0, 1.0, 2.0), "arrays");
        assert_eq!(scalar(Choice), (2.0, 1.0, 2.0), "scalar");
    }
}
