//! The machine reduced to the crank as polynomials over the angle: a motion of several revolutions evaluates it a thousand
//! times, each of which would place the mechanism.
//!
//! From kink to kink the crank angle is divided into pieces. A piece is made when the motion first comes there, together
//! with those ahead of it: samples at Chebyshev's zeros, in lanes, give polynomials of inertia, its derivative, load and
//! viscous coefficient. Samples between the zeros tell whether they are as exact as the motion asks; a piece that is not is
//! halved, and where that does not help the mechanism is placed as ever.

use crate::drive::reduce::reductions;
use crate::drive::structure::Plan;
use std::f64::consts::TAU;

/// Zeros of Chebyshev's polynomial, and coefficients of a polynomial through values there.
const N: usize = 12;

/// Zeros of Chebyshev's polynomial of degree [`N`].
const ZEROS: [f64; N] = [
    -0.991_444_861_373_810_4,
    -0.923_879_532_511_286_8,
    -0.793_353_340_291_235_2,
    -0.608_761_429_008_720_7,
    -0.382_683_432_365_089_8,
    -0.130_526_192_220_051_6,
    0.130_526_192_220_051_6,
    0.382_683_432_365_089_8,
    0.608_761_429_008_720_7,
    0.793_353_340_291_235_2,
    0.923_879_532_511_286_8,
    0.991_444_861_373_810_4,
];

/// Places between the zeros, at which the polynomials are compared.
const WATCHED: [f64; 4] = [-0.998_5, 0.0, 0.5, 0.998_5];

/// Samples of a piece.
const SAMPLES: usize = N + WATCHED.len();

/// Values at the zeros → coefficients of Chebyshev's polynomials.
const ANALYSIS: [[f64; N]; N] = analysis();

/// Coefficients of the powers in Chebyshev's polynomials: from values straight to powers rounding would grow a thousandfold.
const POWERS: [[f64; N]; N] = powers();

/// Pieces that are made at once.
const AHEAD: usize = 4;

/// Pieces a revolution, before any is halved.
const PIECES: f64 = 12.0;

/// A piece this short \[rad\] is not halved any more.
const SHORTEST: f64 = 0.1;

/// Error of the polynomials, as a share of the accuracy of the motion, and the smallest that rounding allows.
const SHARE: f64 = 0.01;
/// See [`SHARE`].
const LEAST: f64 = 1e-13;

/// How far inside an interval the piece at its end is looked for \[rad\].
const INSIDE: f64 = 1e-9;

/// Share of half a piece up to which its polynomials are continued.
const BEYOND: f64 = 1.5;

/// Inertia J \[kg m²\], J′ \[kg m²/rad\], load torque that resists whatever the speed \[N m\], viscous coefficient
/// \[N m s/rad\], as the crank turns.
pub type Reduced = [f64; 4];

/// What is known of a piece.
#[derive(Clone, Copy)]
enum Piece {
    /// Nothing yet.
    Unknown,
    /// The number of its polynomials.
    Polynomials(usize),
    /// Polynomials are not exact enough.
    Exact,
}

/// The machine over the angle, piece by piece.
pub struct ReducedCurves {
    /// Ends of the pieces, from 0 to the end of the cycle \[rad\].
    edges: Vec<f64>,
    pieces: Vec<Piece>,
    /// Coefficients of polynomials over the length of a piece, from −1 to 1.
    polynomials: Vec<[Reduced; N]>,
    /// Angle after which they repeat.
    cycle: f64,
    /// Direction in which the crank turns.
    sense: f64,
    /// Relative error that polynomials may have.
    tolerance: f64,
    /// The piece read last, and the angle at which its cycle starts.
    last: (usize, f64),
}

/// Discrete orthogonality: c_k = 2/N Σ T_k(x_j) y_j, half of it for k = 0.
const fn analysis() -> [[f64; N]; N] {
    let (mut table, mut j) = ([[0.0; N]; N], 0);
    while j < N {
        let (mut before, mut t, mut k) = (ZEROS[j], 1.0, 0);
        while k < N {
            table[k][j] = if k == 0 { 1.0 / N as f64 } else { 2.0 * t / N as f64 };
            (before, t) = (t, 2.0 * ZEROS[j] * t - before);
            k += 1;
        }
        j += 1;
    }
    table
}

/// T_{k+1} = 2 x T_k − T_{k−1}.
const fn powers() -> [[f64; N]; N] {
    let mut table = [[0.0; N]; N];
    (table[0][0], table[1][1]) = (1.0, 1.0);
    let mut k = 2;
    while k < N {
        let mut p = 0;
        while p <= k {
            let raised = if p == 0 { 0.0 } else { 2.0 * table[p - 1][k - 1] };
            table[p][k] = raised - table[p][k - 2];
            p += 1;
        }
        k += 1;
    }
    table
}

/// A matrix times numbers in rows.
fn times(matrix: &[[f64; N]; N], rows: &[Reduced]) -> [Reduced; N] {
    let mut sums = [[0.0; 4]; N];
    for (sum, weights) in sums.iter_mut().zip(matrix) {
        for (row, weight) in rows.iter().zip(weights) {
            for i in 0..row.len() {
                sum[i] += weight * row[i];
            }
        }
    }
    sums
}

impl ReducedCurves {
    /// Of a machine with kinks at given angles of its cycle; `None` where polynomials cannot do.
    pub fn new(plan: &Plan, kinks: &[f64], sense: f64, accuracy: f64) -> Option<Self> {
        let tolerance = accuracy * SHARE;
        if !plan.laws.is_empty() || tolerance < LEAST {
            return None;
        }
        let mut edges = vec![0.0];
        for ends in kinks.windows(2) {
            let length = ends[1] - ends[0];
            let parts = (length / (TAU / PIECES) - 1e-9).ceil().max(1.0);
            edges.extend((1..=parts as usize).map(|i| ends[0] + length * (i as f64 / parts)));
        }
        let pieces = vec![Piece::Unknown; edges.len() - 1];
        let cycle = edges[edges.len() - 1];
        let polynomials = Vec::new();
        let of_turn = ReducedCurves { edges, pieces, polynomials, cycle, sense, tolerance, last: (0, 0.0) };
        (cycle > 0.0).then_some(of_turn)
    }

    /// The machine at a crank angle; `None` where it is to be evaluated itself.
    pub fn at(&mut self, plan: &Plan, q: &[f64], phi: f64) -> Option<Reduced> {
        self.by_piece_at(plan, q, phi, phi)
    }

    /// The same within an interval between two kinks, and beyond its ends by the polynomials before them: a step that ends on a
    /// kink sees nothing of what lies behind it.
    pub fn at_between(&mut self, plan: &Plan, q: &[f64], phi: f64, [low, high]: [f64; 2]) -> Option<Reduced> {
        self.by_piece_at(plan, q, phi.max(low + INSIDE).min(high - INSIDE), phi)
    }

    /// The polynomials of the piece at `inside`, at a crank angle.
    fn by_piece_at(&mut self, plan: &Plan, q: &[f64], inside: f64, phi: f64) -> Option<Reduced> {
        loop {
            let (k, start) = self.last;
            let (low, high) = (self.edges[k], self.edges[k + 1]);
            let local = inside - start;
            if !(low..=high).contains(&local) {
                if !phi.is_finite() {
                    return None;
                }
                let start = (inside / self.cycle).floor() * self.cycle;
                let after = self.edges.partition_point(|&edge| edge <= inside - start);
                self.last = (after.clamp(1, self.pieces.len()) - 1, start);
                let (k, _) = self.last;
                // Rounding may leave an angle a little outside the cycle.
                if !(self.edges[k]..=self.edges[k + 1]).contains(&(inside - start)) {
                    return None;
                }
                continue;
            }
            match self.pieces[k] {
                Piece::Exact => return None,
                Piece::Polynomials(number) => {
                    let share = (2.0 * (phi - start) - low - high) / (high - low);
                    return Some(value(&self.polynomials[number], share.clamp(-BEYOND, BEYOND)));
                }
                Piece::Unknown => self.make(plan, q, k),
            }
        }
    }

    /// Makes a piece and those that follow in the direction of the motion.
    fn make(&mut self, plan: &Plan, q: &[f64], k: usize) {
        let n = self.pieces.len();
        let follow = |i: usize| if self.sense > 0.0 { (k + i) % n } else { (k + n - i) % n };
        let mut some: Vec<usize> = (0..AHEAD.min(n)).map(follow).collect();
        some.retain(|&k| matches!(self.pieces[k], Piece::Unknown));
        let mut angles = Vec::with_capacity(some.len() * SAMPLES);
        for &k in &some {
            let (middle, half) =
                (0.5 * (self.edges[k] + self.edges[k + 1]), 0.5 * (self.edges[k + 1] - self.edges[k]));
            angles.extend(ZEROS.iter().chain(&WATCHED).map(|share| middle + share * half));
        }
        let sense = self.sense;
        let samples: Vec<Reduced> = reductions(plan, q, &angles, sense)
            .into_iter()
            .map(|r| [r.J, r.J_d1, r.load * sense + r.dry, r.viscous])
            .collect();
        let mut split = Vec::new();
        for (&k, samples) in some.iter().zip(samples.chunks_exact(SAMPLES)) {
            self.pieces[k] = match polynomials(samples, self.tolerance) {
                Some(coefficients) => {
                    self.polynomials.push(coefficients);
                    Piece::Polynomials(self.polynomials.len() - 1)
                }
                None if self.edges[k + 1] - self.edges[k] > SHORTEST => {
                    split.push(k);
                    Piece::Unknown
                }
                None => Piece::Exact,
            };
        }
        split.sort_unstable();
        for k in split.into_iter().rev() {
            self.edges.insert(k + 1, 0.5 * (self.edges[k] + self.edges[k + 1]));
            self.pieces.insert(k + 1, Piece::Unknown);
        }
    }
}

/// The polynomials at a place from −1 to 1: even and odd powers beside each other.
fn value(coefficients: &[Reduced; N], at: f64) -> Reduced {
    let square = at * at;
    let (mut even, mut odd) = (coefficients[N - 2], coefficients[N - 1]);
    for p in (0..N / 2 - 1).rev() {
        for i in 0..even.len() {
            even[i] = even[i] * square + coefficients[2 * p][i];
            odd[i] = odd[i] * square + coefficients[2 * p + 1][i];
        }
    }
    for i in 0..even.len() {
        even[i] += at * odd[i];
    }
    even
}

/// Polynomials through samples at the zeros, if those at the places watched lie on them.
fn polynomials(samples: &[Reduced], tolerance: f64) -> Option<[Reduced; N]> {
    let (zeros, watched) = samples.split_at(N);
    let coefficients = times(&POWERS, &times(&ANALYSIS, zeros));
    let mut sizes = [0.0_f64; 4];
    for sample in samples {
        for i in 0..sizes.len() {
            sizes[i] = sizes[i].max(sample[i].abs());
        }
    }
    // A change of inertia by radian counts beside inertia itself.
    let least = samples.iter().map(|sample| sample[0]).fold(f64::INFINITY, f64::min);
    let allowed = [least, least, sizes[2], sizes[3]].map(|size| size * tolerance);
    for (&share, sample) in WATCHED.iter().zip(watched) {
        let found = value(&coefficients, share);
        for i in 0..found.len() {
            let off = (found[i] - sample[i]).abs();
            // A NaN is not within its limit.
            if off.is_nan() || off > allowed[i] {
                return None;
            }
        }
    }
    Some(coefficients)
}
