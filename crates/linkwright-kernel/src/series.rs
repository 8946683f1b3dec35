//! Series of Legendre polynomials over a step, from values at ten Gauss nodes; collocation at these nodes.
//!
//! ```text
//! f(x) = Σ κ_k P_k(x),   κ_k = (2k + 1)/2 Σ w_j P_k(x_j) f_j,   −1 ≤ x ≤ 1
//! ∫₋₁ˣ P_k = (P_{k+1} − P_{k−1})/(2k + 1),   ∫₋₁ˣ P_0 = P_1 + P_0
//! ```
//!
//! Collocation at n Gauss nodes has order 2n at the end of the step and errs inside it by what the series of the slope has
//! beyond its last term. All numbers stay of the size of the values: no powers of the step occur.
//!
//! Source: Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.7; nodes and weights: Abramowitz,
//! Stegun, *Handbook of Mathematical Functions*, table 25.4.

use crate::real::Real;

/// Nodes.
pub const G: usize = 10;

/// Terms of an integral.
pub const TERMS: usize = G + 1;

/// Places of the nodes, −1 to 1.
const X: [f64; G] = [
    -0.973_906_528_517_171_720,
    -0.865_063_366_688_984_511,
    -0.679_409_568_299_024_406,
    -0.433_395_394_129_247_191,
    -0.148_874_338_981_631_211,
    0.148_874_338_981_631_211,
    0.433_395_394_129_247_191,
    0.679_409_568_299_024_406,
    0.865_063_366_688_984_511,
    0.973_906_528_517_171_720,
];

/// Their weights.
const W: [f64; G] = [
    0.066_671_344_308_688_138,
    0.149_451_349_150_580_593,
    0.219_086_362_515_982_044,
    0.269_266_719_309_996_355,
    0.295_524_224_714_752_870,
    0.295_524_224_714_752_870,
    0.269_266_719_309_996_355,
    0.219_086_362_515_982_044,
    0.149_451_349_150_580_593,
    0.066_671_344_308_688_138,
];

/// Places of the nodes as shares of the step.
pub const SHARES: [f64; G] = shares();

/// Values → terms: `κ_k = Σ ANALYSIS[k][j] f_j`.
const ANALYSIS: [[f64; G]; G] = analysis();

/// Integrals from the start of the step to its nodes, per length of the step: `∫ f = h Σ RISES[i][j] f_j`.
const RISES: [[f64; G]; G] = rises();

const fn shares() -> [f64; G] {
    let (mut c, mut i) = ([0.0; G], 0);
    while i < G {
        c[i] = 0.5 * (1.0 + X[i]);
        i += 1;
    }
    c
}

/// P_0 … P_G at a place, by Bonnet's recursion.
pub(crate) const fn polynomials(x: f64) -> [f64; TERMS] {
    let mut p = [1.0; TERMS];
    p[1] = x;
    let mut k = 1;
    while k < G {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
        k += 1;
    }
    p
}

const fn analysis() -> [[f64; G]; G] {
    let (mut table, mut j) = ([[0.0; G]; G], 0);
    while j < G {
        let (p, mut k) = (polynomials(X[j]), 0);
        while k < G {
            table[k][j] = 0.5 * (2 * k + 1) as f64 * W[j] * p[k];
            k += 1;
        }
        j += 1;
    }
    table
}

const fn rises() -> [[f64; G]; G] {
    let (mut table, mut i) = ([[0.0; G]; G], 0);
    while i < G {
        let (p, mut j) = (polynomials(X[i]), 0);
        while j < G {
            let (mut sum, mut k) = (ANALYSIS[0][j] * (p[1] + p[0]), 1);
            while k < G {
                sum += ANALYSIS[k][j] * (p[k + 1] - p[k - 1]) / (2 * k + 1) as f64;
                k += 1;
            }
            table[i][j] = 0.5 * sum;
            j += 1;
        }
        i += 1;
    }
    table
}

/// Terms of a function by its values at the nodes.
#[inline(always)]
pub fn terms<R: Real>(values: &[R; G]) -> [R; G] {
    let mut terms = [R::splat(0.0); G];
    for k in 0..G {
        for j in 0..G {
            terms[k] = values[j].mul_add(R::splat(ANALYSIS[k][j]), terms[k]);
        }
    }
    terms
}

/// Terms of the integral from the start of a step of length `h`, where it has a value, of a function with given terms.
#[inline(always)]
pub fn integral<R: Real>(start: R, h: R, of: &[R; G]) -> [R; TERMS] {
    let half = h * 0.5;
    let mut rise = [start; TERMS];
    rise[0] = half.mul_add(of[1].mul_add(R::splat(-1.0 / 3.0), of[0]), start);
    for m in 1..TERMS {
        let lower = of[m - 1] * (1.0 / (2 * m - 1) as f64);
        let both =
            if m + 1 < G { of[m + 1].mul_add(R::splat(-1.0 / (2 * m + 3) as f64), lower) } else { lower };
        rise[m] = half * both;
    }
    rise
}

/// The value of a series at a share of the step, by Clenshaw's recursion.
#[inline(always)]
pub fn value<R: Real>(terms: &[R; TERMS], share: R) -> R {
    let x = share.mul_add(R::splat(2.0), R::splat(-1.0));
    let (mut next, mut after) = (R::splat(0.0), R::splat(0.0));
    for k in (0..TERMS).rev() {
        let n = k as f64;
        let by_next = x * ((2.0 * n + 1.0) / (n + 1.0));
        let sum = by_next.mul_add(next, after.mul_add(R::splat(-(n + 1.0) / (n + 2.0)), terms[k]));
        (after, next) = (next, sum);
    }
    next
}

/// The value of a series at a share of the step and its first three derivatives by the share, by
/// P′_{k+1} = P′_{k−1} + (2k + 1) P_k.
#[inline(always)]
pub fn derivatives<R: Real>(terms: &[R; TERMS], share: R) -> [R; 4] {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let x = share.mul_add(R::splat(2.0), R::splat(-1.0));
    // The polynomial and its derivatives, of the last degree and of the one before.
    let (mut before, mut last) = ([one, zero, zero, zero], [x, one, zero, zero]);
    let mut sums = [terms[1].mul_add(x, terms[0]), terms[1], zero, zero];
    for k in 1..G {
        let n = k as f64;
        let mut next = before;
        next[0] = (x * ((2.0 * n + 1.0) / (n + 1.0))).mul_add(last[0], before[0] * (-n / (n + 1.0)));
        for i in 1..4 {
            next[i] = last[i - 1].mul_add(R::splat(2.0 * n + 1.0), before[i]);
        }
        for i in 0..4 {
            sums[i] = terms[k + 1].mul_add(next[i], sums[i]);
        }
        (before, last) = (last, next);
    }
    [sums[0], sums[1] * 2.0, sums[2] * 4.0, sums[3] * 8.0]
}

/// What may be missing in the integral of a series, seen by its last terms: those beyond are a hundredth of the last but
/// one, and less than the last, where the function is resolved at all.
#[inline(always)]
pub fn missing<R: Real>(h: R, of: &[R; G]) -> R {
    let beyond = of[G - 2].abs().mul_add(R::splat(0.1), of[G - 1].abs());
    h * beyond * (0.5 / (2 * G - 1) as f64)
}

/// Newton's corrections of x at the nodes for `x′ = f` from a start, with f and its slope d at the present x.
#[inline(always)]
pub fn newton<R: Real>(start: R, h: R, f: &[R; G], d: &[R; G], x: &[R; G]) -> [R; G] {
    let mut right = [start; G];
    let mut matrix = [[start; G]; G];
    for i in 0..G {
        let mut rise = R::splat(0.0);
        for j in 0..G {
            rise = f[j].mul_add(R::splat(RISES[i][j]), rise);
            let entry = h * d[j] * -RISES[i][j];
            matrix[i][j] = if i == j { entry + 1.0 } else { entry };
        }
        right[i] = h.mul_add(rise, start - x[i]);
    }
    // No pivoting: where |h d| is not small against 1 the series is not used.
    for k in 0..G {
        let inverse = matrix[k][k].recip();
        for i in k + 1..G {
            let factor = -(matrix[i][k] * inverse);
            for j in k + 1..G {
                matrix[i][j] = factor.mul_add(matrix[k][j], matrix[i][j]);
            }
            right[i] = factor.mul_add(right[k], right[i]);
        }
        matrix[k][k] = inverse;
    }
    for k in (0..G).rev() {
        for j in k + 1..G {
            right[k] = right[k] - matrix[k][j] * right[j];
        }
        right[k] = right[k] * matrix[k][k];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_exact_for_polynomials() {
        let f = |s: f64| 1.0 - 3.0 * s.powi(3) + 2.0 * s.powi(9);
        let rise = |s: f64| s - 0.75 * s.powi(4) + 0.2 * s.powi(10);
        let series = integral(0.5, 2.0, &terms(&SHARES.map(f)));
        for i in 0..=20 {
            let s = f64::from(i) / 20.0;
            // Some dozen roundings of numbers of size 1.
            assert!((value(&series, s) - 0.5 - 2.0 * rise(s)).abs() < 1e-14, "at {s}");
        }
        let [u, first, second, third] = derivatives(&series, 0.3);
        // f, its slope and its bend by the share; the third sums numbers of some hundred.
        let exact = [value(&series, 0.3), 2.0 * f(0.3), 2.0 * (18.0 * 0.3_f64.powi(8) - 9.0 * 0.09)];
        for (found, exact) in [u, first, second].into_iter().zip(exact) {
            assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
        }
        assert!((third - 2.0 * (144.0 * 0.3_f64.powi(7) - 18.0 * 0.3)).abs() < 1e-10, "{third}");
        for i in 0..G {
            let sum: f64 = (0..G).map(|j| RISES[i][j] * f(SHARES[j])).sum();
            assert!((sum - rise(SHARES[i])).abs() < 1e-15, "to node {i}");
        }
    }

    /// x′ = −x²: the solution and its end to rounding, from a guess that is off by a thousandth.
    #[test]
    fn collocation_meets_a_closed_form() {
        let (h, start) = (0.5, 1.0);
        let exact = |s: f64| 1.0 / (1.0 + h * s);
        let mut x = SHARES.map(|s| exact(s) * 1.001);
        for _ in 0..4 {
            let delta = newton(start, h, &x.map(|x| -x * x), &x.map(|x| -2.0 * x), &x);
            for i in 0..G {
                x[i] += delta[i];
            }
        }
        let slope = terms(&x.map(|x| -x * x));
        let series = integral(start, h, &slope);
        let off = |i: u32| (value(&series, f64::from(i) / 50.0) - exact(f64::from(i) / 50.0)).abs();
        let worst = (0..=50).map(off).fold(0.0, f64::max);
        // The slope has a double pole at −5 of (−1, 1), so that its terms fall to a tenth each, by 5 − √24; the first that
        // is left out, of degree 10, is 4.6e-9, and its integral h 4.6e-9/21 = 1.1e-10 at most.
        assert!(worst < 1.1e-10 && worst <= missing(h, &slope), "{worst:e} of {:e}", missing(h, &slope));
        assert!((value(&series, 1.0) - exact(1.0)).abs() < 1e-14);
    }
}
