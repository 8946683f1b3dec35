//! Natural frequencies and mode shapes of a train.
//!
//! All frequencies at once, a lane each: bisection by the count of [`Train::sweep`] until they lie apart, then Newton on
//! the characteristic polynomial, whose zeros are all real, kept inside the bracket that the count proves. A mode shape follows from the disc where the two sweeps, from the leaves and from the root, fit together
//! best: from there outwards all its ratios are stable. Where frequencies coincide, as in trains with equal branches, or a
//! shape does not balance, all shapes are found by Jacobi's rotations instead, which keep them orthogonal.
//!
//! Source: Fernando, *On computing an eigenvector of a tridiagonal matrix*, SIAM J. Matrix Anal. Appl. 18 (1997)
//! 1013–1034, for the fit of two sweeps; Golub and Van Loan, *Matrix Computations*, section 8.5, for Jacobi.

use super::{Train, nudged};
use crate::lanes::{Job, in_lanes};
use crate::real::Real;

/// Frequencies ω \[rad/s\], increasing, and shapes, one row a mode, each with Σ J q² = 1.
#[derive(Clone, Debug)]
pub struct Modes {
    pub omega: Vec<f64>,
    pub shapes: Vec<f64>,
}

/// Bisections before Newton: they part frequencies that differ by a thousandth of the highest.
const PARTED: usize = 12;

/// Steps at most; bisection alone, from the highest frequency to rounding of the lowest, needs some 80.
const STEPS: usize = 200;

/// A step of Newton shorter than this share leaves an error of its square over the distance to the next λ, which is below
/// rounding for any that [`EQUAL`] tells apart.
const QUADRATIC: f64 = 1e-11;

/// A bracket of this share is closed.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Squared frequencies closer than this share of themselves count as equal: their shapes would not be orthogonal.
const EQUAL: f64 = 1e-7;

/// Share of the torques that may be left over in a shape.
const BALANCED: f64 = 1e-11;

/// Natural frequencies and mode shapes.
pub fn modes(train: &Train) -> Modes {
    let n = train.len();
    let lambda = in_lanes(Frequencies { train });
    let omega: Vec<f64> = lambda.iter().map(|x| x.sqrt()).collect();
    if lambda.windows(2).any(|pair| pair[1] - pair[0] < EQUAL * pair[1]) {
        // Newton closes in on a multiple frequency slowly: the rotations know it better.
        return jacobi(train);
    }
    let mut shapes = vec![0.0; n * n];
    let mut sweeps = vec![[0.0; 3]; n];
    for (shape, &lambda) in shapes.chunks_exact_mut(n).zip(&lambda) {
        train.shape(lambda, &mut sweeps, shape);
        if !train.balances(lambda, shape) {
            // What was counted stays exact beside shafts of any stiffness; of the rotations only the shapes are wanted.
            return Modes { omega, ..jacobi(train) };
        }
    }
    Modes { omega, shapes }
}

impl Train {
    /// An upper bound of all λ: twice the stiffness about a disc over its inertia (Gershgorin).
    fn bound(&self) -> f64 {
        let mut about = self.stiffness.clone();
        for c in 1..self.len() {
            about[self.parent[c]] += self.stiffness[c];
        }
        about.iter().zip(&self.inertia).map(|(k, J)| 2.0 * k / J).fold(0.0, f64::max)
    }

    /// The shape of a mode: discs in order, Σ J q² = 1, the largest positive.
    fn shape(&self, lambda: f64, sweeps: &mut [[f64; 3]], shape: &mut [f64]) {
        let n = self.len();
        // What each disc and all that hangs on it answers; what the rest answers at the disc that it hangs on.
        for (sweep, J) in sweeps.iter_mut().zip(&self.inertia) {
            sweep[0] = -lambda * J;
        }
        for c in (1..n).rev() {
            let (k, x) = (self.stiffness[c], sweeps[c][0]);
            sweeps[self.parent[c]][0] += k * x / nudged(k + x, k);
        }
        // Whole: all that acts on the disc, zero in a mode.
        sweeps[0][2] = sweeps[0][0] + self.stiffness[0];
        let mut best = 0;
        for c in 1..n {
            let (k, x) = (self.stiffness[c], sweeps[c][0]);
            let rest = sweeps[self.parent[c]][2] - k * x / nudged(k + x, k);
            sweeps[c][1] = rest;
            sweeps[c][2] = x + k * rest / nudged(k + rest, k);
            let fits = |i: usize| (sweeps[i][2] / self.inertia[i]).abs();
            if fits(c) < fits(best) || fits(best).is_nan() {
                best = c;
            }
        }
        shape.fill(0.0);
        shape[best] = 1.0;
        let mut at = best;
        while at > 0 {
            let k = self.stiffness[at];
            let up = self.parent[at];
            shape[up] = shape[at] * k / nudged(k + sweeps[at][1], k);
            at = up;
        }
        for c in 1..n {
            if shape[c] == 0.0 {
                let k = self.stiffness[c];
                shape[c] = shape[self.parent[c]] * k / nudged(k + sweeps[c][0], k);
            }
        }
        self.normalise(shape);
    }

    /// Whether all torques of a shape balance but for rounding. They do not where a disc between tuned branches is at rest: its
    /// amplitude is rounding alone, and the branches beyond it follow from that.
    fn balances(&self, lambda: f64, shape: &[f64]) -> bool {
        let mut torque: Vec<[f64; 2]> =
            shape.iter().zip(&self.inertia).map(|(q, J)| [-lambda * J * q, lambda * J * q.abs()]).collect();
        torque[0][0] += self.stiffness[0] * shape[0];
        torque[0][1] += self.stiffness[0] * shape[0].abs();
        for c in 1..self.len() {
            let (k, up) = (self.stiffness[c], self.parent[c]);
            let twist = k * (shape[c] - shape[up]);
            torque[c][0] += twist;
            torque[up][0] -= twist;
            torque[c][1] += k * (shape[c].abs() + shape[up].abs());
        }
        let largest = |part: usize| torque.iter().map(|each| each[part].abs()).fold(0.0, f64::max);
        largest(0) <= BALANCED * largest(1)
    }

    fn normalise(&self, shape: &mut [f64]) {
        let largest = shape.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
        let mass: f64 = shape.iter().zip(&self.inertia).map(|(q, J)| J * (q / largest).powi(2)).sum();
        let factor = 1.0 / (largest * mass.sqrt());
        shape.iter_mut().for_each(|q| *q *= factor);
    }
}

/// All λ = ω², increasing.
struct Frequencies<'a> {
    train: &'a Train,
}

impl Job for Frequencies<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<f64> {
        let n = self.train.len();
        let free = self.train.stiffness[0] == 0.0;
        let mut lambda = vec![0.0; n + R::LANES];
        let mut x = vec![[R::splat(0.0); 2]; n];
        let mut numbers = vec![0.0; R::LANES];
        // A free train has one λ of zero exactly.
        for first in (usize::from(free)..n).step_by(R::LANES) {
            for (lane, number) in numbers.iter_mut().enumerate() {
                *number = (first + lane).min(n - 1) as f64 + 0.5;
            }
            let number = R::load(&numbers);
            let found = R::outline(
                #[inline(always)]
                || self.bracket(number, &mut x),
            );
            found.store(&mut lambda[first..]);
        }
        lambda.truncate(n);
        lambda
    }
}

impl Frequencies<'_> {
    /// The λ with so many below it, half counted.
    #[inline(always)]
    fn bracket<R: Real>(&self, number: R, x: &mut [[R; 2]]) -> R {
        let mut low = R::splat(0.0);
        let mut high = R::splat(self.train.bound() * (1.0 + 1e-12));
        for _ in 0..PARTED {
            let middle = between(low, high);
            let (below, _) = self.train.sweep::<R, false>(middle, x);
            low = below.select_lt(number, middle, low);
            high = below.select_lt(number, high, middle);
        }
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let (mut at, mut open) = (between(low, high), one);
        for _ in 0..STEPS {
            let (below, slope) = self.train.sweep::<R, true>(at, x);
            low = below.select_lt(number, at, low);
            high = below.select_lt(number, high, at);
            let (newton, middle) = (at - slope.recip(), between(low, high));
            // Inside the bracket, or halve it: a comparison with NaN is false, which halves too.
            let inside = low.select_lt(newton, newton.select_lt(high, one, zero), zero);
            let next = zero.select_lt(inside, newton, middle);
            let left =
                zero.select_lt(inside, (newton - at).abs() - next * QUADRATIC, high - low - next * ROUNDING);
            // A lane that has arrived stays: where a pivot vanishes, another step would lead away.
            at = zero.select_lt(open, next, at);
            open = zero.select_lt(left, open, zero);
            if open.max_lane() <= 0.0 {
                break;
            }
        }
        at
    }
}

/// Where a bracket is cut: in the middle, or, while it reaches down to nearly nothing, at a thousandth of its top. Beside
/// a shaft as good as rigid the others' λ are smaller by many orders.
#[inline(always)]
fn between<R: Real>(low: R, high: R) -> R {
    low.select_lt(high * 1e-6, high * 1e-3, (low + high) * 0.5)
}

/// All modes by rotations of J^(−1/2) K J^(−1/2), for trains whose frequencies coincide.
fn jacobi(train: &Train) -> Modes {
    let n = train.len();
    let root: Vec<f64> = train.inertia.iter().map(|J| J.sqrt()).collect();
    let mut a = vec![0.0; n * n];
    let mut v = vec![0.0; n * n];
    a[0] = train.stiffness[0];
    for i in 0..n {
        v[i * n + i] = 1.0;
    }
    for c in 1..n {
        let (k, p) = (train.stiffness[c], train.parent[c]);
        a[c * n + c] += k;
        a[p * n + p] += k;
        a[c * n + p] -= k;
        a[p * n + c] -= k;
    }
    for i in 0..n {
        for j in 0..n {
            a[i * n + j] /= root[i] * root[j];
        }
    }
    while rotate_all(&mut a, &mut v, n) {}
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i * n + i].total_cmp(&a[j * n + j]));
    let free = train.stiffness[0] == 0.0;
    let mut shapes = Vec::with_capacity(n * n);
    for &m in &order {
        let start = shapes.len();
        shapes.extend((0..n).map(|i| v[i * n + m] / root[i]));
        train.normalise(&mut shapes[start..]);
    }
    let omega = order
        .iter()
        .enumerate()
        .map(|(nth, &m)| if nth == 0 && free { 0.0 } else { a[m * n + m].max(0.0).sqrt() })
        .collect();
    Modes { omega, shapes }
}

/// One sweep of rotations over all pairs; whether any was needed.
fn rotate_all(a: &mut [f64], v: &mut [f64], n: usize) -> bool {
    let mut rotated = false;
    for p in 0..n {
        for q in p + 1..n {
            let off = a[p * n + q];
            let (app, aqq) = (a[p * n + p], a[q * n + q]);
            if off.abs() <= 0.5 * f64::EPSILON * (app * aqq).abs().sqrt() || off == 0.0 {
                continue;
            }
            rotated = true;
            let theta = (aqq - app) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            for i in 0..n {
                let (x, y) = (a[i * n + p], a[i * n + q]);
                (a[i * n + p], a[i * n + q]) = (c * x - s * y, s * x + c * y);
            }
            for i in 0..n {
                let (x, y) = (a[p * n + i], a[q * n + i]);
                (a[p * n + i], a[q * n + i]) = (c * x - s * y, s * x + c * y);
                let (x, y) = (v[i * n + p], v[i * n + q]);
                (v[i * n + p], v[i * n + q]) = (c * x - s * y, s * x + c * y);
            }
            (a[p * n + q], a[q * n + p]) = (0.0, 0.0);
        }
    }
    rotated
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn laws(train: &Train, tolerance: f64) {
        let n = train.len();
        let found = modes(train);
        let mut trace = train.stiffness[0] / train.inertia[0];
        for c in 1..n {
            trace += train.stiffness[c] * (1.0 / train.inertia[c] + 1.0 / train.inertia[train.parent[c]]);
        }
        let sum: f64 = found.omega.iter().map(|w| w * w).sum();
        assert!((sum - trace).abs() < tolerance * trace, "the sum of squares {sum} is the trace {trace}");
        for i in 0..n {
            for j in 0..n {
                let (a, b) = (&found.shapes[i * n..][..n], &found.shapes[j * n..][..n]);
                let mass: f64 = (0..n).map(|k| train.inertia[k] * a[k] * b[k]).sum();
                let wanted = if i == j { 1.0 } else { 0.0 };
                assert!((mass - wanted).abs() < tolerance * 1e3, "modes {i} and {j}: {mass}");
            }
        }
    }

    #[test]
    fn an_even_chain_has_its_closed_form() {
        for n in [2, 3, 10, 50] {
            let parent: Vec<usize> = (0..n).map(|i: usize| i.saturating_sub(1)).collect();
            let mut stiffness = vec![2.0; n];
            stiffness[0] = 0.0;
            let train = Train::new(&parent, &vec![0.5; n], &stiffness).expect("a chain");
            let found = modes(&train);
            for (m, omega) in found.omega.iter().enumerate() {
                let closed = 2.0 * (2.0f64 / 0.5).sqrt() * (0.5 * PI * m as f64 / n as f64).sin();
                assert!(
                    (omega - closed).abs() < 1e-14 * closed.max(1e-3),
                    "{n} discs, mode {m}: {omega} for {closed}"
                );
            }
            laws(&train, 1e-13);
        }
    }

    #[test]
    fn a_shaft_as_good_as_rigid_leaves_the_others_their_digits() {
        let chain = |stiff: f64| {
            let stiffness = [0.0, 1.0, 3.0, stiff, 2.0, 1.5];
            Train::new(&[0, 0, 1, 2, 3, 4], &[1.0, 0.5, 2.0, 0.3, 0.8, 1.2], &stiffness).expect("a chain")
        };
        let rigid = Train::new(&[0, 0, 1, 2, 3], &[1.0, 0.5, 2.3, 0.8, 1.2], &[0.0, 1.0, 3.0, 2.0, 1.5]);
        let limit = modes(&rigid.expect("a chain")).omega;
        let found = modes(&chain(1e13)).omega;
        for (a, b) in found.iter().zip(&limit) {
            // The limit is approached with k/10¹³.
            assert!((a - b).abs() <= 1e-12 * b, "{a} for {b}");
        }
    }

    #[test]
    fn branches_and_supports_keep_the_laws() {
        let uneven = Train::new(
            &[0, 0, 1, 1, 0, 4, 5, 4],
            &[3.0, 0.1, 2.0, 0.03, 1.5, 0.7, 20.0, 0.4],
            &[0.0, 1e3, 4e5, 2e2, 7e3, 9e4, 3e3, 1e4],
        );
        laws(&uneven.expect("a tree"), 1e-13);
        let held = Train::new(&[0, 0, 0], &[1.0, 2.0, 3.0], &[5.0, 7.0, 11.0]).expect("a held tree");
        laws(&held, 1e-13);
        // Three equal branches: two modes of one frequency in which the root stands.
        let star = Train::new(&[0, 0, 0, 0], &[2.0, 1.0, 1.0, 1.0], &[0.0, 8.0, 8.0, 8.0]).expect("a star");
        laws(&star, 1e-13);
        let omega = modes(&star).omega;
        assert!((omega[1] - 8.0f64.sqrt()).abs() < 1e-14 && (omega[2] - omega[1]).abs() < 1e-14, "{omega:?}");
    }
}
