//! All natural frequencies of a train, as λ = ω².
//!
//! The counts of [`Holzer::sweep`] at places all over the range, and a few halvings, say roughly where the λ are. From there
//! Aberth's iteration takes all of them at once to the last digit but one,
//!
//! ```text
//! λ_i ← λ_i − 1/(p′/p − Σ 1/(λ_i − λ_j))        over all other λ_j
//! ```
//!
//! which is Newton on p with all other zeros divided out, and converges with the third power. About every λ_i there is a
//! zero of p no farther than n/|p′/p|; once these n intervals are apart, each holds one. Where they stay together, as they do
//! about a multiple zero, all λ are halved in by their counts.
//!
//! Source: Aberth, *Iteration methods for finding all zeros of a polynomial simultaneously*, Math. Comp. 27 (1973) 339–344; Bini,
//! Gemignani, Tisseur, *The Ehrlich–Aberth method for the nonsymmetric tridiagonal eigenvalue problem*, SIAM J. Matrix
//! Anal. Appl. 27 (2005) 153–175.

use super::holzer::Holzer;
use linkwright_kernel::call::poll;
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;

/// Halvings at most before Aberth's iteration.
const HALVINGS: usize = 8;

/// Steps of Aberth's iteration at most: from crude starts it needs some ten, in trains of very uneven parts thirty.
const STEPS: usize = 48;

/// Distance of λ from its zero over that from its neighbours before the last step, of which the third power is left.
const NEAR: f64 = 3e-5;

/// A bracket of this share is closed.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Halvings until all brackets are closed: from the highest frequency to rounding of the lowest some eighty.
const CLOSINGS: usize = 2000;

/// What a search found.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// All λ, increasing; that of a free train as a whole is zero exactly.
    pub squares: Vec<f64>,
    /// How often all lanes were swept.
    pub sweeps: usize,
}

/// Finds all λ.
pub fn find(holzer: &Holzer) -> Spectrum {
    in_lanes(FrequencyJob { holzer })
}

struct FrequencyJob<'a> {
    holzer: &'a Holzer,
}

impl Job for FrequencyJob<'_> {
    type Output = Spectrum;

    #[inline(always)]
    fn run<R: Real>(self) -> Spectrum {
        let n = self.holzer.positive();
        let width = n.next_multiple_of(R::LANES);
        let (side, values) = (self.holzer.room::<R>(), vec![0.0; width]);
        let mut search = Search { holzer: self.holzer, n, width, side, values, sweeps: 0 };
        let mut brackets = search.brackets();
        let mut squares = search.starts(&brackets);
        if !search.aberth(&mut squares) {
            search.close(&mut brackets);
            squares = brackets.into_iter().map(|[low, high]| 0.5 * (low + high)).collect();
        }
        squares.truncate(n);
        if self.holzer.is_free {
            squares.insert(0, 0.0);
        }
        Spectrum { squares, sweeps: search.sweeps }
    }
}

/// A search for all λ above zero.
struct Search<'a, R> {
    holzer: &'a Holzer,
    /// How many there are.
    n: usize,
    /// The same in whole bundles of lanes.
    width: usize,
    side: Vec<[R; 2]>,
    /// What the last sweep found.
    values: Vec<f64>,
    sweeps: usize,
}

impl<R: Real> Search<'_, R> {
    /// Counts, or p′/p, at as many places as there are lanes.
    #[inline(always)]
    fn sweep<const SLOPE: bool>(&mut self, places: &[f64]) {
        self.sweeps += 1;
        for first in (0..self.width).step_by(R::LANES) {
            poll();
            let lambda = R::load(&places[first..]);
            let found = out_of_line!(R, self.holzer.sweep::<R, SLOPE>(lambda, &mut self.side));
            found.store(&mut self.values[first..]);
        }
    }

    /// Where each λ is, between places that lie as the λ of an even chain do, which are close at both ends.
    #[inline(always)]
    fn brackets(&mut self) -> Vec<[f64; 2]> {
        let (width, bound) = (self.width, self.holzer.bound);
        let place = |i: usize| {
            let x = i as f64 / (width + 1) as f64;
            bound * x * x * (3.0 - 2.0 * x)
        };
        let places: Vec<f64> = (1..=width).map(place).collect();
        self.sweep::<false>(&places);
        let mut brackets = vec![[0.0, bound]; width];
        let mut next = 0;
        for (nth, bracket) in brackets.iter_mut().enumerate() {
            // The zero of a free train counts, too.
            let number = (nth + self.holzer.len() - self.n) as f64;
            while next < width && self.values[next] <= number {
                next += 1;
            }
            let low = if next == 0 { 0.0 } else { places[next - 1] };
            *bracket = [low, if next == width { bound } else { places[next] }];
        }
        for _ in 0..HALVINGS {
            if !are_crowded(&brackets[..self.n]) {
                break;
            }
            self.halve(&mut brackets);
        }
        brackets
    }

    /// Cuts every bracket in two.
    #[inline(always)]
    fn halve(&mut self, brackets: &mut [[f64; 2]]) {
        let middles: Vec<f64> = brackets.iter().map(between).collect();
        self.sweep::<false>(&middles);
        for (nth, (bracket, middle)) in brackets.iter_mut().zip(middles).enumerate() {
            let number = (nth + self.holzer.len() - self.n) as f64;
            bracket[usize::from(self.values[nth] > number)] = middle;
        }
    }

    /// Halves until nothing is left but rounding.
    #[inline(always)]
    fn close(&mut self, brackets: &mut [[f64; 2]]) {
        for _ in 0..CLOSINGS {
            if brackets[..self.n].iter().all(|[low, high]| high - low <= ROUNDING * high) {
                break;
            }
            self.halve(brackets);
        }
    }

    /// A place in every bracket; those that share one lie evenly.
    fn starts(&self, brackets: &[[f64; 2]]) -> Vec<f64> {
        let mut starts = Vec::with_capacity(self.width);
        for alike in brackets[..self.n].chunk_by(|a, b| a == b) {
            let [low, high] = alike[0];
            let step = (high - low) / alike.len() as f64;
            starts.extend((0..alike.len()).map(|i| low + step * (i as f64 + 0.5)));
        }
        starts
    }

    /// Aberth's iteration; whether it has proved that it found every λ.
    #[inline(always)]
    fn aberth(&mut self, found: &mut Vec<f64>) -> bool {
        let n = self.n;
        // Written twice in a row, so that lanes find the others of each λ side by side.
        let mut ring = vec![0.5 * self.holzer.bound; n + self.width + R::LANES];
        // Near, and all intervals apart by twice their radius, of which one is the other's.
        let enough = (1.0 / NEAR).max(2.0 * self.holzer.len() as f64);
        found.resize(self.width, 0.0);
        for _ in 0..STEPS {
            ring[..n].copy_from_slice(&found[..n]);
            ring[n..2 * n].copy_from_slice(&found[..n]);
            self.sweep::<true>(&ring);
            for first in (0..self.width).step_by(R::LANES) {
                let slope = R::load(&self.values[first..]);
                let (next, gap) = out_of_line!(R, self.step(slope, &ring[first..]));
                next.store(&mut found[first..]);
                (gap * slope.abs()).store(&mut self.values[first..]);
            }
            sort(&mut found[..n]);
            if self.values[..n].iter().all(|&each| each > enough) {
                return true;
            }
        }
        false
    }

    /// The next λ, and the distance of the present one from its neighbours and from zero.
    #[inline(always)]
    fn step(&self, slope: R, ring: &[f64]) -> (R, R) {
        let bound = R::splat(self.holzer.bound);
        let at = R::load(ring);
        // From zero at most, so that small ones have as many digits.
        let (mut sum, mut gap) = (R::splat(0.0), at);
        if self.holzer.is_free {
            sum = at.recip();
        }
        for r in [1, self.n - 1] {
            if r % self.n != 0 {
                gap = gap.min((at - R::load(&ring[r..])).abs());
            }
        }
        // Four reciprocals with one division.
        let mut r = 1;
        while r + 4 <= self.n {
            let [a, b, c, d] = [r, r + 1, r + 2, r + 3].map(|r| at - R::load(&ring[r..]));
            let (ab, cd) = (a * b, c * d);
            sum = sum + (a + b).mul_add(cd, (c + d) * ab) / (ab * cd);
            r += 4;
        }
        for r in r..self.n {
            sum = sum + (at - R::load(&ring[r..])).recip();
        }
        let next = at - (slope - sum).recip();
        // Back into the range; a comparison with NaN is false.
        let next = R::splat(0.0).select_lt(next, next, at * 0.0625);
        (next.select_lt(bound, next, (at + bound) * 0.5), gap)
    }
}

/// Where a bracket is cut: in the middle, or, while it reaches down to nearly nothing, at a thousandth of its top. Beside
/// a shaft as good as rigid the others' λ are smaller by many orders.
fn between([low, high]: &[f64; 2]) -> f64 {
    if *low < high * 1e-6 { high * 1e-3 } else { 0.5 * (low + high) }
}

/// Whether brackets are shared that reach over several orders.
fn are_crowded(brackets: &[[f64; 2]]) -> bool {
    brackets.windows(2).any(|pair| pair[0] == pair[1] && pair[0][0] < 0.25 * pair[0][1])
}

/// Few are out of order.
fn sort(list: &mut [f64]) {
    for i in 1..list.len() {
        let mut at = i;
        while at > 0 && list[at] < list[at - 1] {
            list.swap(at, at - 1);
            at -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Train, modes::modes, trees};
    use linkwright_kernel::lanes::scalar;

    fn chain(inertia: &[f64], stiffness: f64) -> Train {
        let n = inertia.len();
        let parent: Vec<usize> = (0..n).map(|c: usize| c.saturating_sub(1)).collect();
        let mut shafts = vec![stiffness; n];
        shafts[0] = 0.0;
        Train::new(&parent, inertia, &shafts).expect("a chain")
    }

    #[test]
    fn they_are_good_before_shapes_improve_them() {
        for train in trees::trees() {
            let found = find(&Holzer::new(&train)).squares;
            for (square, omega) in found.iter().zip(modes(&train).omega) {
                // Rounding of a sweep: some units of the last place for every disc.
                assert!(
                    (square - omega * omega).abs() <= 2e-14 * square,
                    "{square} for {omega} of {train:?}"
                );
            }
        }
    }

    #[test]
    fn few_sweeps_find_them() {
        // Counts, a halving or two, and Aberth's steps, of which each triples the digits.
        let even = find(&Holzer::new(&chain(&[0.5; 50], 2.0)));
        assert!(even.sweeps <= 8, "an even chain took {} sweeps", even.sweeps);
        let inertia: Vec<f64> = (0..50).map(|i| 0.5 + 1.5 * (0.618 * f64::from(i)).fract()).collect();
        let uneven = find(&Holzer::new(&chain(&inertia, 2.0)));
        assert!(uneven.sweeps <= 12, "an uneven chain took {} sweeps", uneven.sweeps);
        for train in trees::trees() {
            let sweeps = find(&Holzer::new(&train)).sweeps;
            assert!(sweeps <= 40, "{sweeps} sweeps for {train:?}");
        }
    }

    #[test]
    fn multiple_ones_are_closed_in() {
        for branches in [2, 3, 7, 20] {
            let mut stiffness = vec![3.0; branches + 1];
            stiffness[0] = 0.0;
            let star =
                Train::new(&vec![0; branches + 1], &vec![1.7; branches + 1], &stiffness).expect("a star");
            let found = find(&Holzer::new(&star)).squares;
            let (single, last) = (3.0 / 1.7, 3.0 / 1.7 * (branches + 1) as f64);
            for square in &found[1..branches] {
                assert!((square - single).abs() <= 1e-15 * single, "{square} of {branches} branches");
            }
            assert!((found[branches] - last).abs() <= 4e-15 * last, "the last of {branches} branches");
        }
    }

    #[test]
    fn lanes_are_plain_numbers() {
        for train in trees::trees() {
            let holzer = Holzer::new(&train);
            let (lanes, scalars) = (find(&holzer).squares, scalar(FrequencyJob { holzer: &holzer }).squares);
            for (a, b) in lanes.iter().zip(&scalars) {
                assert!((a - b).abs() <= 2e-14 * a, "{a} and {b} of {train:?}");
            }
        }
    }
}
