//! Collocation Radau IIA with five stages: order 9, L-stable, the last stage at the end of the step.
//!
//! Chosen for the motion over the crank angle because (1) whatever the motor's characteristic holds back at
//! once is gone at the end of the step, however long the step is: with a steep motor the end lies on the
//! quasi-steady motion; (2) the solution is read between the steps by a step of its own, which is as good;
//! (3) five evaluations of the mechanism a step, where an explicit method of order 8 needs 11.
//!
//! The last stage lies on the end of the step, where a torque may jump: it is taken a little before, so that
//! it belongs to the step that ends there.
//!
//! Source: Hairer, Wanner, *Solving Ordinary Differential Equations II*, IV.5. The coefficients are
//! integrals of the Lagrange polynomials on the zeros of P₄(2c − 1) − P₅(2c − 1), to 18 digits.

use crate::real::Real;

/// Stages.
pub const S: usize = 5;

/// How far before the end of the step its last stage lies, as a share of the step: more than the rounding of
/// an angle, and a displacement that no result shows.
const ASIDE: f64 = 1e-13;

/// Places of the stages in the step.
pub const C: [f64; S] = [
    0.057_104_196_114_517_682,
    0.276_843_013_638_123_828,
    0.583_590_432_368_916_820,
    0.860_240_135_656_219_448,
    1.0 - ASIDE,
];

/// Weights of the stage values.
pub const A: [[f64; S]; S] = [
    [
        0.072_998_864_317_903_324,
        -0.026_735_331_107_945_572,
        0.018_676_929_763_984_354,
        -0.012_879_106_093_306_440,
        0.005_042_839_233_882_015,
    ],
    [
        0.153_775_231_479_182_469,
        0.146_214_867_847_493_507,
        -0.036_444_568_905_128_090,
        0.021_233_063_119_304_719,
        -0.007_935_579_902_728_778,
    ],
    [
        0.140_063_045_684_809_872,
        0.298_967_129_491_283_479,
        0.167_585_070_135_248_963,
        -0.033_969_101_686_617_747,
        0.010_944_288_744_192_252,
    ],
    [
        0.144_894_308_109_534_758,
        0.276_500_068_760_159_228,
        0.325_797_922_910_421_030,
        0.128_756_753_254_909_761,
        -0.015_708_917_378_805_328,
    ],
    B,
];

/// Weights of the quadrature over the step: those of its end, which is the last stage.
pub const B: [f64; S] = [
    0.143_713_560_791_225_941,
    0.281_356_015_149_462_060,
    0.311_826_522_975_741_254,
    0.223_103_901_083_570_744,
    0.04,
];

/// Samples of a step: its start and its stages.
pub const N: usize = S + 1;

/// Their places in the step.
pub const AT: [f64; N] = [0.0, C[0], C[1], C[2], C[3], 1.0];

/// A place just behind the start of the step.
pub const BEHIND: f64 = 1e-6;

/// Weights with which values at the stages give that just behind the start, by the polynomial through them.
pub const TO_START: [f64; S] = to_start();

const fn to_start() -> [f64; S] {
    let mut weights = [1.0; S];
    let mut i = 0;
    while i < S {
        let mut k = 0;
        while k < S {
            if k != i {
                weights[i] *= (C[k] - BEHIND) / (C[k] - C[i]);
            }
            k += 1;
        }
        i += 1;
    }
    weights
}

/// Coefficients of the quintic through the samples of a step: `a_p = Σ POWERS[p][j] y_j`.
const POWERS: [[f64; N]; N] = powers();

/// Expands the Lagrange polynomials of the samples' places into powers.
const fn powers() -> [[f64; N]; N] {
    let mut table = [[0.0; N]; N];
    let mut j = 0;
    while j < N {
        // Product of (x − x_k)/(x_j − x_k), one factor after the other.
        let mut a = [0.0; N];
        a[0] = 1.0;
        let mut k = 0;
        while k < N {
            if k != j {
                let mut p = N - 1;
                while p > 0 {
                    a[p] = (a[p - 1] - AT[k] * a[p]) / (AT[j] - AT[k]);
                    p -= 1;
                }
                a[0] = -AT[k] * a[0] / (AT[j] - AT[k]);
            }
            k += 1;
        }
        let mut p = 0;
        while p < N {
            table[p][j] = a[p];
            p += 1;
        }
        j += 1;
    }
    table
}

/// Coefficients of the quintic through values at the samples of a step, over the share of the step.
#[inline(always)]
pub fn through<R: Real>(values: &[R; N]) -> [R; N] {
    let mut a = [R::splat(0.0); N];
    for p in 0..N {
        for j in 0..N {
            a[p] = values[j].mul_add(R::splat(POWERS[p][j]), a[p]);
        }
    }
    a
}

/// The quintic at a share of the step.
#[inline(always)]
pub fn value<R: Real>(a: &[R; N], at: R) -> R {
    let mut sum = a[N - 1];
    for p in (0..N - 1).rev() {
        sum = sum.mul_add(at, a[p]);
    }
    sum
}

/// Its slope, and half of its second derivative.
#[inline(always)]
pub fn slope_and_bend<R: Real>(a: &[R; N], at: R) -> (R, R) {
    let (mut slope, mut bend) = (R::splat(0.0), R::splat(0.0));
    for p in (1..N).rev() {
        bend = bend.mul_add(at, slope);
        slope = slope.mul_add(at, a[p] * p as f64);
    }
    (slope, bend)
}

/// One Newton step for the stages of `x′ = f`, with the start of the step still free.
///
/// With f and its slope D at the present stage values X, the corrections of the stages are `p + u·δ` for a
/// correction δ of the start. The end of the step is the last stage: p and u of the last are its own.
#[derive(Clone, Copy, Debug)]
pub struct StageNewton<R> {
    /// Correction of the stages for the start as it is.
    pub p: [R; S],
    /// Correction of the stages per unit of correction of the start.
    pub u: [R; S],
}

/// Sets up and solves `(I − hAD) (p, u) = (r, 1)`, `r = x + hAf − X`.
#[inline(always)]
pub fn stage_newton<R: Real>(x: R, h: R, f: &[R; S], d: &[R; S], X: &[R; S]) -> StageNewton<R> {
    let one = R::splat(1.0);
    let (mut hf, mut hd) = (*f, *d);
    for i in 0..S {
        (hf[i], hd[i]) = (f[i] * h, d[i] * h);
    }
    let mut p = [x; S];
    let mut u = [one; S];
    let mut matrix = [[one; S]; S];
    for i in 0..S {
        p[i] = x - X[i];
        for j in 0..S {
            p[i] = hf[j].mul_add(R::splat(A[i][j]), p[i]);
            let entry = hd[j] * -A[i][j];
            matrix[i][j] = if i == j { entry + 1.0 } else { entry };
        }
    }
    eliminate(&mut matrix, &mut p, &mut u);
    StageNewton { p, u }
}

/// Gauss elimination for two right-hand sides. No pivoting: all principal minors of A are positive, so where
/// the motion is stable (D ≤ 0) all pivots of I − hAD are too; elsewhere h D is small.
#[inline(always)]
fn eliminate<R: Real>(m: &mut [[R; S]; S], p: &mut [R; S], u: &mut [R; S]) {
    let mut inverse = [R::splat(1.0); S];
    for k in 0..S {
        inverse[k] = m[k][k].recip();
        for i in k + 1..S {
            let factor = -(m[i][k] * inverse[k]);
            for j in k + 1..S {
                m[i][j] = factor.mul_add(m[k][j], m[i][j]);
            }
            p[i] = factor.mul_add(p[k], p[i]);
            u[i] = factor.mul_add(u[k], u[i]);
        }
    }
    for k in (0..S).rev() {
        for j in k + 1..S {
            p[k] = p[k] - m[k][j] * p[j];
            u[k] = u[k] - m[k][j] * u[j];
        }
        p[k] = p[k] * inverse[k];
        u[k] = u[k] * inverse[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_satisfy_the_order_conditions() {
        for q in 0..9_u32 {
            let sum: f64 = (0..S).map(|j| B[j] * C[j].powi(q as i32)).sum();
            // Quadrature of degree 8 is exact: B(9) of Butcher's simplifying conditions; the last stage lies
            // 1e-13 aside.
            assert!((sum - 1.0 / f64::from(q + 1)).abs() < 1e-13, "B({q}): {sum}");
        }
        for i in 0..S {
            for q in 0..5_u32 {
                let sum: f64 = (0..S).map(|j| A[i][j] * C[j].powi(q as i32)).sum();
                let exact = C[i].powi(q as i32 + 1) / f64::from(q + 1);
                assert!((sum - exact).abs() < 2e-13, "C(5) in row {i}, power {q}: {sum} for {exact}");
            }
        }
    }

    #[test]
    fn stages_give_the_start_of_polynomials() {
        for q in 0..5 {
            let sum: f64 = (0..S).map(|j| TO_START[j] * (1.0 + C[j]).powi(q)).sum();
            assert!((sum - (1.0 + BEHIND).powi(q)).abs() < 1e-12, "power {q}: {sum}");
        }
    }

    /// Stage values and end of a step of x′ = f(x).
    fn step(x: f64, h: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
        let mut X = [x; S];
        for _ in 0..12 {
            let (values, slopes) = (X.map(|x| f(x).0), X.map(|x| f(x).1));
            let newton = stage_newton(x, h, &values, &slopes, &X);
            for i in 0..S {
                X[i] += newton.p[i];
            }
        }
        X[S - 1]
    }

    /// x′ = −x²: error ∝ h¹⁰ a step.
    #[test]
    fn order_is_nine() {
        let error = |h: f64| (step(1.0, h, |x| (-x * x, -2.0 * x)) - 1.0 / (1.0 + h)).abs();
        let order = (error(0.8) / error(0.4)).log2();
        assert!((order - 10.0).abs() < 0.7, "local error falls with power {order}");
    }

    /// x′ = −λ (x − 1): what is held back at once is gone at the end of the step.
    #[test]
    fn stiff_disturbances_die_within_the_step() {
        for decade in 2..13 {
            let rate = 10_f64.powi(decade);
            let left = (step(2.0, 1.0, |x| (-rate * (x - 1.0), -rate)) - 1.0).abs();
            // R(z) of Radau IIA falls like 5/z.
            assert!(left < 6.0 / rate + 1e-15, "rate {rate:e} leaves {left:e}");
        }
    }

    #[test]
    fn quintic_goes_through_its_samples() {
        let y: [f64; N] = std::array::from_fn(|i| (1.3 * AT[i] + 0.2).powi(5) - AT[i].powi(2));
        let a = through(&y);
        for i in 0..N {
            // Rounding of a sum is at most a few ulps of the sum of its terms' sizes.
            let size: f64 = (0..N).map(|p| (0..N).map(|j| (POWERS[p][j] * y[j]).abs()).sum::<f64>()).sum();
            let found = value(&a, AT[i]);
            assert!((found - y[i]).abs() < 4.0 * f64::EPSILON * size, "sample {i}: {found} for {}", y[i]);
        }
        let (slope, _) = slope_and_bend(&a, 0.5);
        let exact = 6.5 * (1.3 * 0.5_f64 + 0.2).powi(4) - 1.0;
        assert!((slope - exact).abs() < 1e-12, "{slope} for {exact}");
    }
}
