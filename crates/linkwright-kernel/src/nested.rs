//! Ten nodes of a step: its start and four more beside the stages of [`crate::radau`], so that what is known at the stages
//! is used again.
//!
//! ```text
//! f(x) = Σ κ_k P_k(x),   ∫₋₁ˣ P_k = (P_{k+1} − P_{k−1})/(2k + 1),   ∫₋₁ˣ P_0 = P_1 + P_0
//! ```
//!
//! The four places are the zeros of the polynomial E for which x p E is orthogonal to all cubics on the step, p having its
//! zeros at the stages: the quadrature at all ten is then exact up to degree 13, and its weights are positive. That is
//! Kronrod's way to extend a Gauss formula, applied to one of Radau's: Kronrod, *Nodes and Weights of Quadrature Formulas*,
//! 1965; Davis, Rabinowitz, *Methods of Numerical Integration*, 2.7.1.1. The places were computed from their definition in
//! rational numbers and 50 digits.

use crate::radau::{C, S};
use crate::real::Real;
use crate::series::{G, polynomials};

/// How far behind the start of the step its node lies, as a share of the step: a load that jumps there has the value
/// that it has in the step, as at the last stage.
const ASIDE: f64 = 1e-13;

/// Nodes that are no stages: the start, and four inside.
pub const MORE: usize = G - S;

/// Places of the nodes: the stages, the start, the four.
pub const SHARES: [f64; G] = [
    C[0],
    C[1],
    C[2],
    C[3],
    C[4],
    ASIDE,
    0.172_363_570_647_245_987,
    0.403_820_385_641_361_911,
    0.745_844_012_143_400_227,
    0.950_699_304_295_264_600,
];

/// Number of the last stage, which is the end of the step, and of the start among the nodes.
pub const END: usize = S - 1;
/// See [`END`].
pub const START: usize = S;

/// Values → terms of Legendre polynomials: `κ_k = Σ ANALYSIS[k][j] f_j`.
const ANALYSIS: [[f64; G]; G] = analysis();

/// Integrals from the start to the nodes, per length of the step.
const RISES: [[f64; G]; G] = rises();

/// Weights of the quadrature over the step.
pub const WEIGHTS: [f64; G] = weights();

/// Values at the stages → the quartic through them at the other nodes.
const OF_STAGES: [[f64; S]; MORE] = of_stages();

/// The inverse of the matrix of polynomials at the nodes, by Gauss and Jordan; the largest entry of a column is its pivot.
const fn analysis() -> [[f64; G]; G] {
    let (mut a, mut b) = ([[0.0; G]; G], [[0.0; G]; G]);
    let mut i = 0;
    while i < G {
        let p = polynomials(2.0 * SHARES[i] - 1.0);
        let mut k = 0;
        while k < G {
            a[i][k] = p[k];
            k += 1;
        }
        b[i][i] = 1.0;
        i += 1;
    }
    let mut k = 0;
    while k < G {
        let (mut pivot, mut i) = (k, k);
        while i < G {
            if a[i][k].abs() > a[pivot][k].abs() {
                pivot = i;
            }
            i += 1;
        }
        let (row, right) = (a[pivot], b[pivot]);
        (a[pivot], b[pivot]) = (a[k], b[k]);
        let mut j = 0;
        while j < G {
            (a[k][j], b[k][j]) = (row[j] / row[k], right[j] / row[k]);
            j += 1;
        }
        i = 0;
        while i < G {
            let factor = a[i][k];
            j = 0;
            while i != k && j < G {
                a[i][j] -= factor * a[k][j];
                b[i][j] -= factor * b[k][j];
                j += 1;
            }
            i += 1;
        }
        k += 1;
    }
    b
}

/// Integrals from the start to a share of the step of the polynomials that are 1 at one node each.
const fn rises_to(share: f64) -> [f64; G] {
    let (p, mut row, mut j) = (polynomials(2.0 * share - 1.0), [0.0; G], 0);
    while j < G {
        let (mut sum, mut k) = (ANALYSIS[0][j] * (p[1] + p[0]), 1);
        while k < G {
            sum += ANALYSIS[k][j] * (p[k + 1] - p[k - 1]) / (2 * k + 1) as f64;
            k += 1;
        }
        row[j] = 0.5 * sum;
        j += 1;
    }
    row
}

const fn rises() -> [[f64; G]; G] {
    let (mut table, mut i) = ([[0.0; G]; G], 0);
    while i < G {
        table[i] = rises_to(SHARES[i]);
        i += 1;
    }
    table
}

const fn weights() -> [f64; G] {
    rises_to(1.0)
}

const fn of_stages() -> [[f64; S]; MORE] {
    let (mut table, mut i) = ([[1.0; S]; MORE], 0);
    while i < MORE {
        let mut j = 0;
        while j < S {
            let mut k = 0;
            while k < S {
                if k != j {
                    table[i][j] *= (SHARES[S + i] - C[k]) / (C[j] - C[k]);
                }
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    table
}

/// Terms of a function by its values at the nodes.
#[inline(always)]
pub fn terms<R: Real>(values: &[R; G]) -> [R; G] {
    times(&ANALYSIS, values)
}

/// Integrals from the start to the nodes of a function by its values there, per length of the step.
#[inline(always)]
pub fn rises_of<R: Real>(values: &[R; G]) -> [R; G] {
    times(&RISES, values)
}

/// Integral over the step of a function by its values at the nodes, per length of the step.
#[inline(always)]
pub fn whole<R: Real>(values: &[R; G]) -> R {
    let mut sum = R::splat(0.0);
    for j in 0..G {
        sum = values[j].mul_add(R::splat(WEIGHTS[j]), sum);
    }
    sum
}

/// Values at all nodes by those at the stages, on the quartic through them.
#[inline(always)]
pub fn spread<R: Real>(stages: &[R; S]) -> [R; G] {
    let mut all = [R::splat(0.0); G];
    all[..S].copy_from_slice(stages);
    for i in 0..MORE {
        for j in 0..S {
            all[S + i] = stages[j].mul_add(R::splat(OF_STAGES[i][j]), all[S + i]);
        }
    }
    all
}

#[inline(always)]
fn times<R: Real>(matrix: &[[f64; G]; G], values: &[R; G]) -> [R; G] {
    let mut sums = [R::splat(0.0); G];
    for k in 0..G {
        for j in 0..G {
            sums[k] = values[j].mul_add(R::splat(matrix[k][j]), sums[k]);
        }
    }
    sums
}

/// Corrections of a solution of x′ = f at the nodes.
#[derive(Clone, Copy, Debug)]
pub struct Correction<R> {
    /// For the start as it is.
    pub p: [R; G],
    /// Per unit of correction of the start.
    pub u: [R; G],
}

/// Half of the number of halvings of the exponent in [`growth`].
const HALVINGS: i32 = 3;

/// e^q and e^−q for exponents up to some 4 in size, to 1e-6 or better: even and odd part of Taylor's series of the eighth of
/// the exponent, squared three times.
#[inline(always)]
fn growth<R: Real>(q: R) -> [R; 2] {
    let t = q * 0.5_f64.powi(HALVINGS);
    let s = t.squared();
    let even = s
        .mul_add(R::splat(1.0 / 720.0), R::splat(1.0 / 24.0))
        .mul_add(s, R::splat(0.5))
        .mul_add(s, R::splat(1.0));
    let odd = s.mul_add(R::splat(1.0 / 120.0), R::splat(1.0 / 6.0)).mul_add(s, R::splat(1.0)) * t;
    let (mut up, mut down) = (even + odd, even - odd);
    for _ in 0..HALVINGS {
        (up, down) = (up.squared(), down.squared());
    }
    [up, down]
}

/// What the integral of a series lacks beyond its last terms: twice what they are, the last two taken together, times the
/// share to which the two before them have fallen.
#[inline(always)]
pub fn unresolved<R: Real>(h: R, of: &[R; G]) -> R {
    let last = of[G - 2].abs() + of[G - 1].abs();
    let before = (of[G - 4].abs() + of[G - 3].abs()).max(last).max(R::splat(f64::MIN_POSITIVE));
    h * last * (last / before) * (1.0 / (2 * G - 1) as f64)
}

/// What the solution `x` of `x′ = f` misses at the nodes: `r = start + h ∫f − x`.
#[inline(always)]
pub fn residual<R: Real>(start: R, h: R, f: &[R; G], x: &[R; G]) -> [R; G] {
    let mut missing = rises_of(f);
    for i in 0..G {
        missing[i] = h.mul_add(missing[i], start - x[i]);
    }
    missing
}

/// The linear variation `e′ = d e`, `e = r + ∫ d e`, solved by its integrating factor: with g = exp ∫d,
/// e = r + g ∫ d r/g. It is a correction of Newton where d and r/g are resolved by the nodes.
#[inline(always)]
pub fn correction<R: Real>(h: R, d: &[R; G], r: &[R; G]) -> Correction<R> {
    let exponents = rises_of(d);
    let (mut u, mut drive) = (*d, *d);
    for i in 0..G {
        let [up, down] = growth(exponents[i] * h);
        (u[i], drive[i]) = (up, d[i] * r[i] * down);
    }
    let mut p = rises_of(&drive);
    for i in 0..G {
        p[i] = (u[i] * h).mul_add(p[i], r[i]);
    }
    Correction { p, u }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radau::{stage_newton, through, value};
    use crate::series::{integral, value as on_series};

    #[test]
    fn quadrature_is_exact_up_to_degree_thirteen() {
        for q in 0..14_i32 {
            let sum: f64 = (0..G).map(|j| WEIGHTS[j] * SHARES[j].powi(q)).sum();
            // Two nodes lie 1e-13 aside; ten roundings.
            assert!((sum - 1.0 / f64::from(q + 1)).abs() < 2e-13, "power {q}: {sum}");
        }
        let sum: f64 = (0..G).map(|j| WEIGHTS[j] * SHARES[j].powi(14)).sum();
        assert!((sum - 1.0 / 15.0).abs() > 1e-9, "degree 14 is not: {sum}");
        assert!(WEIGHTS.iter().all(|&w| w > 0.0), "{WEIGHTS:?}");
    }

    #[test]
    fn series_are_exact_for_polynomials() {
        let f = |s: f64| 1.0 - 3.0 * s.powi(3) + 2.0 * s.powi(9);
        let rise = |s: f64| s - 0.75 * s.powi(4) + 0.2 * s.powi(10);
        let series = integral(0.5, 2.0, &terms(&SHARES.map(f)));
        let rises = rises_of(&SHARES.map(f));
        for i in 0..G {
            let s = SHARES[i];
            // Sums of ten numbers of size 5.
            assert!((on_series(&series, s) - 0.5 - 2.0 * rise(s)).abs() < 1e-13, "series at {s}");
            assert!((rises[i] - rise(s)).abs() < 1e-14, "rise to {s}");
        }
        let quartic = |s: f64| 2.0 - s + 3.0 * s.powi(4);
        let all = spread(&C.map(quartic));
        for i in 0..G {
            assert!((all[i] - quartic(SHARES[i])).abs() < 1e-13, "quartic at node {i}");
        }
    }

    /// x′ = −6 (x − cos): from the solution of a step by Radau to that at ten nodes, against the closed form
    /// x = (36 cos t + 6 sin t)/37 + c e^{−6t}.
    #[test]
    fn one_correction_takes_the_error_of_the_stages_away() {
        let (h, rate) = (0.4, 6.0);
        let exact = |t: f64| (36.0 * t.cos() + 6.0 * t.sin()) / 37.0 + 0.3 * (-rate * t).exp();
        let f = |t: f64, x: f64| -rate * (x - t.cos());
        let (start, slope) = (exact(0.0), [-rate; S]);
        let mut X = [start; S];
        for _ in 0..3 {
            let values = std::array::from_fn(|i| f(h * C[i], X[i]));
            let newton = stage_newton(start, h, &values, &slope, &X);
            for i in 0..S {
                X[i] += newton.p[i];
            }
        }
        let mut samples = [start; S + 1];
        samples[1..].copy_from_slice(&X);
        let quintic = through(&samples);
        let mut x: [f64; G] = std::array::from_fn(|i| if i < S { X[i] } else { value(&quintic, SHARES[i]) });
        let values = std::array::from_fn(|i| f(h * SHARES[i], x[i]));
        let r = residual(start, h, &values, &x);
        let found = correction(h, &spread(&slope), &r);
        let before = (0..G).map(|i| (x[i] - exact(h * SHARES[i])).abs()).fold(0.0, f64::max);
        for i in 0..G {
            x[i] += found.p[i];
        }
        let after = (0..G).map(|i| (x[i] - exact(h * SHARES[i])).abs()).fold(0.0, f64::max);
        let values = std::array::from_fn(|i| f(h * SHARES[i], x[i]));
        let left = residual(start, h, &values, &x).into_iter().fold(0.0, |most: f64, r| most.max(r.abs()));
        let claimed = left + unresolved(h, &terms(&values));
        // The correction has an error where its integrand, with e^{2.4 s}, has terms of degree 10 and more.
        assert!(before > 1e-6 && after < 1e-3 * before, "{before:e} before, {after:e} after");
        // e = r + ∫ d e, and ∫|d| g is less than 1 for d < 0: an error is less than twice what is lacking.
        assert!(after < 2.0 * claimed && claimed < 100.0 * after, "{claimed:e} claimed of {after:e}");
        assert!((found.u[END] - (-rate * h).exp()).abs() < 1e-6, "growth {}", found.u[END]);
    }
}
