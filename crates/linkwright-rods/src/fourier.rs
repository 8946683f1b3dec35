//! Harmonics of real samples of a period, and back: x(t) = c₀ + 2 Re Σ cₙ exp(2πint/T).
//!
//! The transform of n samples is that of n/2 complex numbers, even samples with odd ones beside them; that is split by the
//! factors 4, 2, 3 and 5 of its length, in the order of Stockham (Van Loan, *Computational Frameworks for the Fast Fourier
//! Transform*, SIAM 1992, 1.7).

use crate::complex::Complex;
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// Factors of a length.
const FACTORS: [usize; 4] = [4, 2, 3, 5];

/// The transform of a number of samples.
pub struct Fourier {
    /// How many samples.
    pub samples: usize,
    factors: Vec<usize>,
    /// exp(−2πik/samples).
    roots: Vec<[f64; 2]>,
}

impl Fourier {
    /// The transform of an even number of samples without other prime factors than 2, 3 and 5; else `None`.
    pub fn new(samples: usize) -> Option<Self> {
        let mut left = samples / 2;
        let mut factors = Vec::new();
        for factor in FACTORS {
            while left > 0 && left.is_multiple_of(factor) {
                factors.push(factor);
                left /= factor;
            }
        }
        let root = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / samples as f64).sin_cos();
            [cos, -sin]
        };
        (left == 1 && samples.is_multiple_of(2)).then(|| Fourier {
            samples,
            factors,
            roots: (0..samples).map(root).collect(),
        })
    }

    /// How many harmonics samples hold, with the mean and the one at half the rate of sampling.
    pub fn harmonics(&self) -> usize {
        self.samples / 2 + 1
    }

    #[inline(always)]
    fn root<R: Real>(&self, k: usize) -> Complex<R> {
        let [re, im] = self.roots[k % self.samples];
        Complex::splat(re, im)
    }

    /// Coefficients cₙ of samples.
    #[inline(always)]
    pub fn forward<R: Real>(&self, samples: &[R], room: &mut Room<R>, to: &mut [Complex<R>]) {
        out_of_line!(R, {
            let half = self.samples / 2;
            for (packed, pair) in room.packed.iter_mut().zip(samples.chunks_exact(2)) {
                *packed = Complex(pair[0], pair[1]);
            }
            self.transform(room);
            let scale = 0.5 / self.samples as f64;
            for k in 0..=half {
                let (here, there) = (room.packed[k % half], room.packed[(half - k) % half].conj());
                let odd = (here - there) * self.root(k);
                to[k] = (here + there + Complex(odd.1, -odd.0)) * scale;
            }
        });
    }

    /// Samples of coefficients cₙ.
    #[inline(always)]
    pub fn backward<R: Real>(&self, coefficients: &[Complex<R>], room: &mut Room<R>, to: &mut [R]) {
        out_of_line!(R, {
            let half = self.samples / 2;
            for k in 0..half {
                let (here, there) = (coefficients[k], coefficients[half - k].conj());
                let odd = ((here - there) * self.root(k).conj()).turned();
                // Its conjugate, of which the forward transform is the conjugate of the inverse.
                room.packed[k] = (here + there + odd).conj();
            }
            self.transform(room);
            for (pair, turned) in to.chunks_exact_mut(2).zip(&room.packed) {
                (pair[0], pair[1]) = (turned.0, -turned.1);
            }
        });
    }

    /// The transform of what is packed, factor by factor, in order at its end.
    #[inline(always)]
    fn transform<R: Real>(&self, room: &mut Room<R>) {
        let (mut length, mut stride) = (self.samples / 2, 1);
        for &parts in &self.factors {
            length /= parts;
            let Room { packed, turned, .. } = room;
            match parts {
                2 => self.pass::<R, 2>(packed, turned, length, stride),
                3 => self.pass::<R, 3>(packed, turned, length, stride),
                4 => self.pass::<R, 4>(packed, turned, length, stride),
                _ => self.pass::<R, 5>(packed, turned, length, stride),
            }
            std::mem::swap(&mut room.packed, &mut room.turned);
            stride *= parts;
        }
    }

    /// One factor `P`: `stride` transforms side by side, each of `P` times `length` numbers.
    #[inline(always)]
    fn pass<R: Real, const P: usize>(
        &self,
        from: &[Complex<R>],
        to: &mut [Complex<R>],
        length: usize,
        stride: usize,
    ) {
        out_of_line!(R, {
            let none = [Complex::splat(0.0, 0.0); P];
            let mut own = [none; P];
            for (i, row) in own.iter_mut().enumerate() {
                for (j, root) in row.iter_mut().enumerate() {
                    *root = self.root(i * j * (self.samples / P));
                }
            }
            for p in 0..length {
                let mut turns = none;
                for (i, turn) in turns.iter_mut().enumerate() {
                    *turn = self.root(2 * p * i * stride);
                }
                for q in 0..stride {
                    let mut x = none;
                    for (j, x) in x.iter_mut().enumerate() {
                        *x = from[q + stride * (p + length * j)];
                    }
                    let y = combined(&x, &own);
                    for i in 0..P {
                        to[q + stride * (P * p + i)] = y[i] * turns[i];
                    }
                }
            }
        });
    }
}

/// The transform of `P` numbers.
#[inline(always)]
fn combined<R: Real, const P: usize>(x: &[Complex<R>; P], own: &[[Complex<R>; P]; P]) -> [Complex<R>; P] {
    let mut y = *x;
    match P {
        2 => (y[0], y[1]) = (x[0] + x[1], x[0] - x[1]),
        4 => {
            let (sum, difference) = (x[0] + x[2], x[0] - x[2]);
            let (other, turned) = (x[1] + x[3], (x[1] - x[3]).turned());
            (y[0], y[2]) = (sum + other, sum - other);
            (y[1], y[3]) = (difference - turned, difference + turned);
        }
        _ => {
            for i in 0..P {
                y[i] = x[0];
                for j in 1..P {
                    y[i] = y[i] + x[j] * own[i][j];
                }
            }
        }
    }
    y
}

/// Room for a transform.
pub struct Room<R> {
    packed: Vec<Complex<R>>,
    turned: Vec<Complex<R>>,
    /// Coefficients, for who transforms them back.
    pub harmonics: Vec<Complex<R>>,
}

impl<R: Real> Room<R> {
    /// Room for the transform of a number of samples.
    pub fn new(samples: usize) -> Self {
        let list = |n| vec![Complex::splat(0.0, 0.0); n];
        Room { packed: list(samples / 2), turned: list(samples / 2), harmonics: list(samples / 2 + 1) }
    }
}
