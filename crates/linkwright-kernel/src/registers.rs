//! Registers that hold several numbers: the only file with `unsafe`.
//!
//! | register | numbers | processor |
//! | --- | --- | --- |
//! | [`Avx512`] | 8 | x86-64 with AVX-512 |
//! | [`Avx2`] | 4 | x86-64 with AVX2 and FMA: Intel since 2013, AMD since 2015 |
//! | [`Plain`] | 4 | any other: arrays, which the compiler puts into its registers |
//!
//! An instruction of a set is a function that only another one compiled for that set can inline. Work on registers therefore
//! runs in [`Register::call`], and everything inside it is inlined: outside of it each operation is a call.
#![allow(unsafe_code)]

/// A register full of numbers. Values exist only on processors that have the registers, as [`Register::is_here`] tells.
pub trait Register: Copy {
    /// How many numbers it holds.
    const LANES: usize;
    /// One truth a lane.
    type Mask: Copy;
    /// Whether this processor has it.
    fn is_here() -> bool;
    /// Does work as a function of its own, compiled for the instruction set.
    fn call<T>(work: impl FnOnce() -> T) -> T;
    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// The first lanes of a slice.
    fn load(from: &[f64]) -> Self;
    /// Into the start of a slice.
    fn store(self, to: &mut [f64]);
    /// Sum.
    fn add(self, o: Self) -> Self;
    /// Difference.
    fn sub(self, o: Self) -> Self;
    /// Product.
    fn mul(self, o: Self) -> Self;
    /// Quotient.
    fn div(self, o: Self) -> Self;
    /// `self · b + c`.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// With the sign turned.
    fn neg(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Where it is below the other.
    fn less_than(self, o: Self) -> Self::Mask;
    /// Where the bits of the number as an integer, plus `more`, have a bit.
    fn has_bit(self, more: i64, bit: i64) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether the mask is true in some lane.
    fn any(mask: Self::Mask) -> bool;
}

#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::Register;
    use std::arch::x86_64::*;
    use std::sync::LazyLock;

    /// Four numbers.
    #[derive(Clone, Copy)]
    pub struct Avx2(__m256d);

    /// Eight numbers.
    #[derive(Clone, Copy)]
    pub struct Avx512(__m512d);

    // Asked once: short work asks for every call.
    static AVX2: LazyLock<bool> = LazyLock::new(|| {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt")
    });
    static AVX512: LazyLock<bool> = LazyLock::new(|| {
        Avx2::is_here()
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512cd")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
    });

    /// Functions that are one instruction each.
    macro_rules! instructions {
        ($($name:ident($($of:ident),*) = $instruction:ident;)*) => {$(
            #[inline(always)]
            fn $name(self, $($of: Self),*) -> Self {
                // SAFETY: registers exist only where the processor has them.
                Self(unsafe { $instruction(self.0, $($of.0),*) })
            }
        )*};
    }

    // Not inlined: every unit of the compiler that calls it would have its own.
    #[inline(never)]
    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    fn with_avx2<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    #[inline(never)]
    #[target_feature(enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    fn with_avx512<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    impl Register for Avx2 {
        const LANES: usize = 4;
        type Mask = __m256d;

        fn is_here() -> bool {
            *AVX2
        }
        #[inline(always)]
        fn call<T>(work: impl FnOnce() -> T) -> T {
            // SAFETY: as above; who begins asks `is_here` first.
            unsafe { with_avx2(work) }
        }
        #[inline(always)]
        fn splat(x: f64) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm256_set1_pd(x) })
        }
        #[inline(always)]
        fn load(from: &[f64]) -> Self {
            // SAFETY: as above; the slice has four numbers.
            Self(unsafe { _mm256_loadu_pd(from[..4].as_ptr()) })
        }
        #[inline(always)]
        fn store(self, to: &mut [f64]) {
            // SAFETY: as above; the slice has four numbers.
            unsafe { _mm256_storeu_pd(to[..4].as_mut_ptr(), self.0) }
        }
        instructions! {
            add(o) = _mm256_add_pd;
            sub(o) = _mm256_sub_pd;
            mul(o) = _mm256_mul_pd;
            div(o) = _mm256_div_pd;
            mul_add(b, c) = _mm256_fmadd_pd;
            sqrt() = _mm256_sqrt_pd;
        }
        #[inline(always)]
        fn neg(self) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
        }
        #[inline(always)]
        fn abs(self) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
        }
        #[inline(always)]
        fn less_than(self, o: Self) -> __m256d {
            // SAFETY: as above.
            unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, o.0) }
        }
        #[inline(always)]
        fn has_bit(self, more: i64, bit: i64) -> __m256d {
            // SAFETY: as above.
            unsafe {
                let bit = _mm256_set1_epi64x(bit);
                let bits = _mm256_add_epi64(_mm256_castpd_si256(self.0), _mm256_set1_epi64x(more));
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, bit), bit))
            }
        }
        #[inline(always)]
        fn select(mask: __m256d, yes: Self, no: Self) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm256_blendv_pd(no.0, yes.0, mask) })
        }
        #[inline(always)]
        fn any(mask: __m256d) -> bool {
            // SAFETY: as above.
            unsafe { _mm256_movemask_pd(mask) != 0 }
        }
    }

    impl Register for Avx512 {
        const LANES: usize = 8;
        type Mask = __mmask8;

        fn is_here() -> bool {
            *AVX512
        }
        #[inline(always)]
        fn call<T>(work: impl FnOnce() -> T) -> T {
            // SAFETY: as above; who begins asks `is_here` first.
            unsafe { with_avx512(work) }
        }
        #[inline(always)]
        fn splat(x: f64) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm512_set1_pd(x) })
        }
        #[inline(always)]
        fn load(from: &[f64]) -> Self {
            // SAFETY: as above; the slice has eight numbers.
            Self(unsafe { _mm512_loadu_pd(from[..8].as_ptr()) })
        }
        #[inline(always)]
        fn store(self, to: &mut [f64]) {
            // SAFETY: as above; the slice has eight numbers.
            unsafe { _mm512_storeu_pd(to[..8].as_mut_ptr(), self.0) }
        }
        instructions! {
            add(o) = _mm512_add_pd;
            sub(o) = _mm512_sub_pd;
            mul(o) = _mm512_mul_pd;
            div(o) = _mm512_div_pd;
            mul_add(b, c) = _mm512_fmadd_pd;
            sqrt() = _mm512_sqrt_pd;
            abs() = _mm512_abs_pd;
        }
        #[inline(always)]
        fn neg(self) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(-0.0)) })
        }
        #[inline(always)]
        fn less_than(self, o: Self) -> __mmask8 {
            // SAFETY: as above.
            unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, o.0) }
        }
        #[inline(always)]
        fn has_bit(self, more: i64, bit: i64) -> __mmask8 {
            // SAFETY: as above.
            unsafe {
                let bits = _mm512_add_epi64(_mm512_castpd_si512(self.0), _mm512_set1_epi64(more));
                _mm512_test_epi64_mask(bits, _mm512_set1_epi64(bit))
            }
        }
        #[inline(always)]
        fn select(mask: __mmask8, yes: Self, no: Self) -> Self {
            // SAFETY: as above.
            Self(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
        }
        #[inline(always)]
        fn any(mask: __mmask8) -> bool {
            mask != 0
        }
    }
}

/// Four numbers as an array.
#[derive(Clone, Copy)]
pub struct Plain([f64; 4]);

impl Plain {
    #[inline(always)]
    fn with(self, o: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self;
        for lane in 0..4 {
            result.0[lane] = f(self.0[lane], o.0[lane]);
        }
        result
    }
}

impl Register for Plain {
    const LANES: usize = 4;
    type Mask = [bool; 4];

    fn is_here() -> bool {
        true
    }
    #[inline(never)]
    fn call<T>(work: impl FnOnce() -> T) -> T {
        work()
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        Self([from[0], from[1], from[2], from[3]])
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[..4].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.with(o, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.with(o, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.with(o, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.with(o, |a, b| a / b)
    }
    // Fused where the target has the instruction; elsewhere that would be a call.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        let mut result = self;
        for lane in 0..4 {
            let [x, b, c] = [self.0[lane], b.0[lane], c.0[lane]];
            result.0[lane] = if cfg!(target_arch = "aarch64") { x.mul_add(b, c) } else { x * b + c };
        }
        result
    }
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self, |x, _| -x)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.with(self, |x, _| x.abs())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self, |x, _| x.sqrt())
    }
    #[inline(always)]
    fn less_than(self, o: Self) -> [bool; 4] {
        std::array::from_fn(|lane| self.0[lane] < o.0[lane])
    }
    #[inline(always)]
    fn has_bit(self, more: i64, bit: i64) -> [bool; 4] {
        self.0.map(|x| x.to_bits().cast_signed().wrapping_add(more) & bit != 0)
    }
    #[inline(always)]
    fn select(mask: [bool; 4], yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|lane| if mask[lane] { yes.0[lane] } else { no.0[lane] }))
    }
    #[inline(always)]
    fn any(mask: [bool; 4]) -> bool {
        mask.contains(&true)
    }
}
