//! A dense system of equations for several right sides at once.

use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::real::Real;

/// Solves A X = B in the rows (A | B) of a table, by elimination with pivots in the column; X replaces B. Rows hold `n` numbers of A
/// and `sides` of B.
pub(crate) fn solve(table: &mut [f64], n: usize, sides: usize) {
    in_common_lanes(Elimination { table, n, width: n + sides });
}

/// Rows of numbers, of which registers take some at once.
struct Elimination<'a> {
    table: &'a mut [f64],
    n: usize,
    width: usize,
}

impl Job for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        eliminate(self.table, self.n, self.width);
    }
}

#[inline(always)]
fn eliminate(table: &mut [f64], n: usize, width: usize) {
    for k in 0..n {
        let size = |i: usize| table[i * width + k].abs();
        let pivot = (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
        if pivot != k {
            let (above, below) = table.split_at_mut(pivot * width);
            above[k * width..][..width].swap_with_slice(&mut below[..width]);
        }
        let (above, below) = table.split_at_mut((k + 1) * width);
        let row = &above[k * width + k..];
        let inverse = 1.0 / row[0];
        for other in below.chunks_exact_mut(width) {
            let factor = -other[k] * inverse;
            if factor != 0.0 {
                for (x, &p) in other[k..].iter_mut().zip(row) {
                    *x = factor.mul_add(p, *x);
                }
            }
        }
    }
    for k in (0..n).rev() {
        let (above, from) = table.split_at_mut(k * width);
        let inverse = 1.0 / from[k];
        let solved = &mut from[n..width];
        solved.iter_mut().for_each(|x| *x *= inverse);
        for other in above.chunks_exact_mut(width) {
            let factor = -other[k];
            if factor != 0.0 {
                for (x, &s) in other[n..].iter_mut().zip(&*solved) {
                    *x = factor.mul_add(s, *x);
                }
            }
        }
    }
}
