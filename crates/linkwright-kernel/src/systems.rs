//! Many systems of equations of one shape, A x = b, side by side: one a lane, by elimination with pivots in the column.
//!
//! Each lane has its own pivots: rows change places where a lane needs it. Rows and columns that hold zeros in all lanes
//! are passed over, since a member of a machine touches few others. What comes out of a lane depends on that lane alone.

use crate::call::poll;
use crate::lanes::{Job, in_single_lanes};
use crate::out_of_line;
use crate::real::{Real, load_part, store_part};

/// Systems of n equations with some right sides each; numbers of all systems follow each other.
pub struct Systems<'a> {
    /// Equations a system.
    pub equations: usize,
    /// Right sides a system.
    pub sides: usize,
    /// How many systems.
    pub n: usize,
    /// A, by (column, row, system).
    pub matrix: &'a [f64],
    /// b, by (right side, row, system).
    pub right: &'a mut [f64],
}

impl Systems<'_> {
    /// Puts x in the place of b: NaN or infinite where a matrix is singular, NaN where numbers of a system are none.
    pub fn solve(self) {
        in_single_lanes(self);
    }
}

impl Job for Systems<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Systems { equations, sides, n, matrix, right } = self;
        let width = equations + sides;
        let mut block = Block {
            equations,
            width,
            rows: vec![R::splat(0.0); equations * width],
            inverse: vec![R::splat(0.0); equations],
            columns: Vec::with_capacity(width),
        };
        for at in (0..n).step_by(R::LANES) {
            poll();
            out_of_line!(R, {
                let none = block.load(at, n, matrix, right);
                block.eliminate();
                block.substitute();
                block.store(at, n, none, right);
            });
        }
    }
}

/// A system a lane: rows of A and b.
struct Block<R> {
    equations: usize,
    width: usize,
    rows: Vec<R>,
    /// One over each pivot.
    inverse: Vec<R>,
    /// Columns of a row in which some lane is not zero.
    columns: Vec<usize>,
}

impl<R: Real> Block<R> {
    /// Takes systems from one on; zero for lanes whose numbers are all finite, NaN for others.
    #[inline(always)]
    fn load(&mut self, at: usize, n: usize, matrix: &[f64], right: &[f64]) -> R {
        let mut none = R::splat(0.0);
        for (i, row) in self.rows.chunks_exact_mut(self.width).enumerate() {
            for (j, to) in row.iter_mut().enumerate() {
                let systems = match j.checked_sub(self.equations) {
                    None => &matrix[(j * self.equations + i) * n..],
                    Some(side) => &right[(side * self.equations + i) * n..],
                };
                let x = load_part::<R>(&systems[at..n]);
                none = none + x * 0.0;
                *to = x;
            }
        }
        none
    }

    /// Turns A into an upper triangle.
    #[inline(always)]
    fn eliminate(&mut self) {
        for k in 0..self.equations {
            self.pivot(k);
            let (above, below) = self.rows.split_at_mut((k + 1) * self.width);
            let top = &above[k * self.width..];
            self.inverse[k] = top[k].recip();
            self.columns.clear();
            for j in k + 1..self.width {
                if is_anywhere(top[j]) {
                    self.columns.push(j);
                }
            }
            for row in below.chunks_exact_mut(self.width) {
                if is_anywhere(row[k]) {
                    let factor = -(row[k] * self.inverse[k]);
                    for &j in &self.columns {
                        row[j] = factor.mul_add(top[j], row[j]);
                    }
                }
            }
        }
    }

    /// Brings the largest number of column k from row k on into row k, lane by lane.
    #[inline(always)]
    fn pivot(&mut self, k: usize) {
        let width = self.width;
        let (above, below) = self.rows.split_at_mut((k + 1) * width);
        let top = &mut above[k * width..];
        let (mut largest, mut chosen) = (top[k].abs(), R::splat(-1.0));
        for (i, row) in below.chunks_exact(width).enumerate() {
            let size = row[k].abs();
            chosen = largest.select_lt(size, R::splat(i as f64), chosen);
            largest = largest.select_lt(size, size, largest);
        }
        for (i, row) in below.chunks_exact_mut(width).enumerate() {
            let apart = (chosen - i as f64).abs();
            let near = R::splat(0.5);
            if apart.any_below(near) {
                for (a, b) in top[k..].iter_mut().zip(&mut row[k..]) {
                    (*a, *b) = (apart.select_lt(near, *b, *a), apart.select_lt(near, *a, *b));
                }
            }
        }
    }

    /// Puts x in the place of b.
    #[inline(always)]
    fn substitute(&mut self) {
        let (n, width) = (self.equations, self.width);
        for k in (0..n).rev() {
            let (above, below) = self.rows.split_at_mut((k + 1) * width);
            let row = &mut above[k * width..];
            for (j, known) in (k + 1..n).zip(below.chunks_exact(width)) {
                let entry = -row[j];
                if is_anywhere(entry) {
                    for (x, y) in row[n..].iter_mut().zip(&known[n..]) {
                        *x = entry.mul_add(*y, *x);
                    }
                }
            }
            for x in &mut row[n..] {
                *x = *x * self.inverse[k];
            }
        }
    }

    /// Writes x of the systems from one on.
    #[inline(always)]
    fn store(&self, at: usize, n: usize, none: R, right: &mut [f64]) {
        for (i, row) in self.rows.chunks_exact(self.width).enumerate() {
            for (side, x) in row[self.equations..].iter().enumerate() {
                store_part(*x + none, &mut right[(side * self.equations + i) * n..][at..n]);
            }
        }
    }
}

/// Whether a number is not zero in some lane.
#[inline(always)]
fn is_anywhere<R: Real>(x: R) -> bool {
    R::splat(0.0).any_below(x.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::scalar;
    use crate::matrix::LuFactors;

    /// Entries that need pivots, which differ from system to system.
    fn entry(i: usize, j: usize, system: usize) -> f64 {
        let number = ((7 * i + 3 * j + i * j + 5 * system * (i + 2 * j)) % 11) as f64;
        if (i + system) % 5 == j || (i * j) % 4 == 3 { 0.0 } else { number - 4.5 }
    }

    fn systems(equations: usize, sides: usize, n: usize) -> (Vec<f64>, Vec<f64>) {
        let mut matrix = vec![0.0; equations * equations * n];
        let mut right = vec![0.0; equations * sides * n];
        for s in 0..n {
            for i in 0..equations {
                (0..equations).for_each(|j| matrix[(j * equations + i) * n + s] = entry(i, j, s));
                (0..sides)
                    .for_each(|j| right[(j * equations + i) * n + s] = (i as f64 - 1.5) * (j + s + 1) as f64);
            }
        }
        (matrix, right)
    }

    #[test]
    fn each_lane_solves_its_own_system() {
        let (equations, sides, n) = (7, 3, 21);
        let (matrix, before) = systems(equations, sides, n);
        let mut right = before.clone();
        Systems { equations, sides, n, matrix: &matrix, right: &mut right }.solve();
        for s in 0..n {
            let mut one = LuFactors::new(equations);
            one.factor(|i, j| matrix[(j * equations + i) * n + s]);
            for side in 0..sides {
                let at = |i: usize| (side * equations + i) * n + s;
                let mut x: Vec<f64> = (0..equations).map(|i| before[at(i)]).collect();
                one.solve(&mut x);
                let size = x.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                for (i, x) in x.iter().enumerate() {
                    // Rounding times a condition of some hundreds.
                    assert!((right[at(i)] - x).abs() < 1e-11 * size, "system {s}, side {side}, unknown {i}");
                }
            }
        }
    }

    #[test]
    fn a_system_depends_on_no_other() {
        let (equations, sides, n) = (7, 2, 21);
        let (mut matrix, mut right) = systems(equations, sides, n);
        let solved = |matrix: &[f64], right: &[f64]| {
            let mut right = right.to_vec();
            Systems { equations, sides, n, matrix, right: &mut right }.solve();
            right
        };
        let before = solved(&matrix, &right);
        // One without pivots, one whose numbers are none, one with a right side that is infinite.
        (0..equations).for_each(|j| matrix[(2 * equations + j) * n + 3] = 0.0);
        matrix[8 * n + 9] = f64::NAN;
        right[20] = f64::INFINITY;
        let after = solved(&matrix, &right);
        for (k, (a, b)) in before.iter().zip(&after).enumerate() {
            match k % n {
                3 => {}
                9 | 20 => assert!(b.is_nan(), "system {}", k % n),
                s => assert_eq!(a, b, "system {s}"),
            }
        }
        assert!((0..sides * equations).any(|k| !after[k * n + 3].is_finite()), "a singular matrix");
    }

    #[test]
    fn lanes_are_the_scalar_truth() {
        let (equations, sides, n) = (6, 2, 13);
        let (matrix, right) = systems(equations, sides, n);
        let (mut wide, mut plain) = (right.clone(), right);
        Systems { equations, sides, n, matrix: &matrix, right: &mut wide }.solve();
        scalar(Systems { equations, sides, n, matrix: &matrix, right: &mut plain });
        for (a, b) in wide.iter().zip(&plain) {
            // Fused products round once less, times a condition of some hundreds.
            assert!((a - b).abs() <= 1e-11 * b.abs().max(1.0), "{a} and {b}");
        }
    }
}
