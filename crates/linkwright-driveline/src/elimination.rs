//! A dense system of equations for several right sides at once.

/// Solves A X = B in the rows (A | B) of a table, by elimination with pivots in the column; X replaces B. Rows hold `n` numbers of A
/// and `sides` of B.
pub(crate) fn solve(table: &mut [f64], n: usize, sides: usize) {
    let width = n + sides;
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
            let factor = other[k] * inverse;
            if factor != 0.0 {
                for (x, p) in other[k..].iter_mut().zip(row) {
                    *x -= factor * p;
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
            let factor = other[k];
            if factor != 0.0 {
                for (x, s) in other[n..].iter_mut().zip(&*solved) {
                    *x -= factor * s;
                }
            }
        }
    }
}
