//! Gauss–Legendre collocation with four stages: order 8, A-stable, all stages inside the step.
//!
//! Chosen for the motion over the crank angle because (1) its stages never fall on a step's ends, so a kink
//! or jump there needs no one-sided values; (2) it stays stable however steep the motor's characteristic;
//! (3) it needs 4 evaluations of the mechanism a step where an explicit method of order 8 needs 11.
//!
//! Source: Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.7; Hairer, Wanner, *II*,
//! IV.5. Coefficients are integrals of the Lagrange polynomials on the zeros of P₄(2c − 1), to 18 digits.

use crate::real::Real;

/// Stages.
pub const S: usize = 4;

/// Places of the stages in the step.
pub const C: [f64; S] = [
    0.069_431_844_202_973_712,
    0.330_009_478_207_571_868,
    0.669_990_521_792_428_132,
    0.930_568_155_797_026_288,
];

/// Weights of the quadrature.
pub const B: [f64; S] = [
    0.173_927_422_568_726_929,
    0.326_072_577_431_273_071,
    0.326_072_577_431_273_071,
    0.173_927_422_568_726_929,
];

/// Weights of the stage values.
pub const A: [[f64; S]; S] = [
    [
        0.086_963_711_284_363_464,
        -0.026_604_180_084_998_793,
        0.012_627_462_689_404_725,
        -0.003_555_149_685_795_683,
    ],
    [
        0.188_118_117_499_868_072,
        0.163_036_288_715_636_536,
        -0.027_880_428_602_470_895,
        0.006_735_500_594_538_156,
    ],
    [
        0.167_191_921_974_188_773,
        0.353_953_006_033_743_967,
        0.163_036_288_715_636_536,
        -0.014_190_694_931_141_143,
    ],
    [
        0.177_482_572_254_522_612,
        0.313_445_114_741_868_347,
        0.352_676_757_516_271_865,
        0.086_963_711_284_363_464,
    ],
];

/// One Newton step for the stages of `x′ = f`, with the start of the step still free.
///
/// With f and its slope D at the present stage values X, the corrections of the stages are `p + u·δ` for a
/// correction δ of the start, and the end of the step is `end + growth·δ`.
#[derive(Clone, Copy, Debug)]
pub struct StageNewton<R> {
    /// Correction of the stages for the start as it is.
    pub p: [R; S],
    /// Correction of the stages per unit of correction of the start.
    pub u: [R; S],
    /// End of the step for the start as it is.
    pub end: R,
    /// Derivative of the end by the start.
    pub growth: R,
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
        for j in 0..S {
            p[i] = hf[j].mul_add(R::splat(A[i][j]), p[i]);
            let entry = hd[j] * -A[i][j];
            matrix[i][j] = if i == j { entry + 1.0 } else { entry };
        }
        p[i] = p[i] - X[i];
    }
    eliminate(&mut matrix, &mut p, &mut u);
    let (mut end, mut growth) = (x, one);
    for j in 0..S {
        end = (hf[j] + hd[j] * p[j]).mul_add(R::splat(B[j]), end);
        growth = (hd[j] * u[j]).mul_add(R::splat(B[j]), growth);
    }
    StageNewton { p, u, end, growth }
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
        for q in 0..8_u32 {
            let sum: f64 = (0..S).map(|j| B[j] * C[j].powi(q as i32)).sum();
            // Quadrature of degree 7 is exact: B(8) of Butcher's simplifying conditions.
            assert!((sum - 1.0 / f64::from(q + 1)).abs() < 4e-16, "B({q}): {sum}");
        }
        for i in 0..S {
            for q in 0..4_u32 {
                let sum: f64 = (0..S).map(|j| A[i][j] * C[j].powi(q as i32)).sum();
                let exact = C[i].powi(q as i32 + 1) / f64::from(q + 1);
                assert!((sum - exact).abs() < 4e-16, "C(4) in row {i}, power {q}: {sum} for {exact}");
            }
        }
    }

    /// x′ = −x²: one Newton step from the exact stages returns the end to order 8 (error ∝ h⁹ a step).
    #[test]
    fn order_is_eight() {
        let step = |h: f64| {
            let mut X = [1.0; S];
            let mut end = 1.0;
            for _ in 0..8 {
                let f = X.map(|x| -x * x);
                let d = X.map(|x| -2.0 * x);
                let newton = stage_newton(1.0, h, &f, &d, &X);
                for i in 0..S {
                    X[i] += newton.p[i];
                }
                end = newton.end;
            }
            (end - 1.0 / (1.0 + h)).abs()
        };
        let order = (step(0.8) / step(0.4)).log2();
        assert!((order - 9.0).abs() < 0.7, "local error falls with power {order}");
    }
}
