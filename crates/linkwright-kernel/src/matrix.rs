//! Small dense systems of equations, real or complex, by elimination with pivots in the column.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    pub re: f64,
    pub im: f64,
}

/// What a matrix may hold.
pub trait Number:
    Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// How large it is, for pivots.
    fn size(self) -> f64;
    /// A real number as one of these.
    fn real(x: f64) -> Self;
}

impl Number for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
    fn real(x: f64) -> Self {
        x
    }
}

impl Number for Complex {
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
    fn real(x: f64) -> Self {
        Complex { re: x, im: 0.0 }
    }
}

impl Add for Complex {
    type Output = Complex;
    fn add(self, b: Complex) -> Complex {
        Complex { re: self.re + b.re, im: self.im + b.im }
    }
}

impl Sub for Complex {
    type Output = Complex;
    fn sub(self, b: Complex) -> Complex {
        Complex { re: self.re - b.re, im: self.im - b.im }
    }
}

impl Neg for Complex {
    type Output = Complex;
    fn neg(self) -> Complex {
        Complex { re: -self.re, im: -self.im }
    }
}

impl Mul for Complex {
    type Output = Complex;
    fn mul(self, b: Complex) -> Complex {
        Complex { re: self.re * b.re - self.im * b.im, im: self.re * b.im + self.im * b.re }
    }
}

impl Div for Complex {
    type Output = Complex;
    fn div(self, b: Complex) -> Complex {
        // The larger part is divided by first, so that nothing overflows (Smith, Comm. ACM 5 (1962) 435).
        if b.re.abs() >= b.im.abs() {
            let ratio = b.im / b.re;
            let below = b.re + b.im * ratio;
            Complex { re: (self.re + self.im * ratio) / below, im: (self.im - self.re * ratio) / below }
        } else {
            let ratio = b.re / b.im;
            let below = b.re * ratio + b.im;
            Complex { re: (self.re * ratio + self.im) / below, im: (self.im * ratio - self.re) / below }
        }
    }
}

/// A square matrix, taken apart into two triangles.
#[derive(Clone, Debug)]
pub struct LuFactors<T> {
    n: usize,
    rows: Vec<T>,
    pivots: Vec<usize>,
}

impl<T: Number> LuFactors<T> {
    /// Room for n equations.
    pub fn new(n: usize) -> Self {
        LuFactors { n, rows: vec![T::default(); n * n], pivots: vec![0; n] }
    }

    /// Takes apart the matrix whose entries are given by row and column.
    pub fn factor(&mut self, entry: impl Fn(usize, usize) -> T) {
        let n = self.n;
        for i in 0..n {
            for j in 0..n {
                self.rows[i * n + j] = entry(i, j);
            }
        }
        for k in 0..n {
            let size = |i: usize| self.rows[i * n + k].size();
            let pivot = (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            self.pivots[k] = pivot;
            if pivot != k {
                for j in 0..n {
                    self.rows.swap(k * n + j, pivot * n + j);
                }
            }
            self.eliminate(k);
        }
    }

    /// Takes the pivot's row out of those below it; links join few masses, so that most factors are zero.
    fn eliminate(&mut self, k: usize) {
        let n = self.n;
        let (above, below) = self.rows.split_at_mut((k + 1) * n);
        let pivot = &above[k * n..];
        for row in below.chunks_exact_mut(n) {
            if row[k] != T::default() {
                let factor = row[k] / pivot[k];
                row[k] = factor;
                for (x, p) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                    *x = *x - factor * *p;
                }
            }
        }
    }

    /// Solves for one right side, in its place.
    pub fn solve(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        for i in 1..n {
            let row = &self.rows[i * n..i * n + i];
            b[i] = row.iter().zip(b.iter()).fold(b[i], |sum, (a, x)| sum - *a * *x);
        }
        for i in (0..n).rev() {
            let row = &self.rows[i * n..(i + 1) * n];
            let sum = row[i + 1..].iter().zip(&b[i + 1..]).fold(b[i], |sum, (a, x)| sum - *a * *x);
            b[i] = sum / row[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<T: Number>(n: usize, entry: impl Fn(usize, usize) -> T) {
        let wanted: Vec<T> = (0..n).map(|i| T::real(i as f64 - 1.5)).collect();
        let product = |i: usize| (0..n).fold(T::default(), |sum, j| sum + entry(i, j) * wanted[j]);
        let mut b: Vec<T> = (0..n).map(product).collect();
        let mut matrix = LuFactors::new(n);
        matrix.factor(entry);
        matrix.solve(&mut b);
        for (found, wanted) in b.iter().zip(&wanted) {
            // Rounding times a condition of some hundreds.
            assert!((*found - *wanted).size() < 1e-12, "solution");
        }
    }

    #[test]
    fn solves_what_needs_pivots() {
        let uneven = |i: usize, j: usize| ((7 * i + 3 * j + i * j) % 11) as f64;
        check(5, |i, j| if i == j { 0.0 } else { uneven(i, j) });
        check(6, |i, j| Complex { re: uneven(i, j), im: if i == j { 3.0 } else { -uneven(j, i) } });
    }

    #[test]
    fn complex_division_is_the_inverse_of_multiplication() {
        for (re, im) in [(3.0, -4.0), (0.2, 9.0), (1e-200, 2e-200)] {
            let (a, b) = (Complex { re: 1.5, im: -0.5 }, Complex { re, im });
            assert!((a * b / b - a).size() < 1e-15, "{re} + {im}i");
        }
    }
}
