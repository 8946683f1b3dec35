//! Harmonics of real samples of a period, and back: x(t) = c₀ + 2 Re Σ cₙ exp(2πint/T).
//!
//! The transform of n samples is that of n/2 complex numbers, even samples with odd ones beside them; that is split by the
//! factors 4, 2, 3 and 5 of its length (Cooley and Tukey, *Math. Comp.* 19 (1965) 297).

use crate::complex::Complex;
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
    pub fn forward<R: Real>(&self, samples: &[R], room: &mut Room<R>, to: &mut [Complex<R>]) {
        let half = self.samples / 2;
        for (packed, pair) in room.packed.iter_mut().zip(samples.chunks_exact(2)) {
            *packed = Complex(pair[0], pair[1]);
        }
        self.split(&room.packed, 1, &mut room.turned, 0);
        let scale = 0.5 / self.samples as f64;
        for k in 0..=half {
            let (here, there) = (room.turned[k % half], room.turned[(half - k) % half].conj());
            let odd = (here - there) * self.root(k);
            to[k] = (here + there + Complex(odd.1, -odd.0)) * scale;
        }
    }

    /// Samples of coefficients cₙ.
    pub fn backward<R: Real>(&self, coefficients: &[Complex<R>], room: &mut Room<R>, to: &mut [R]) {
        let half = self.samples / 2;
        for k in 0..half {
            let (here, there) = (coefficients[k], coefficients[half - k].conj());
            let odd = ((here - there) * self.root(k).conj()).turned();
            // Its conjugate, of which the forward transform is the conjugate of the inverse.
            room.packed[k] = (here + there + odd).conj();
        }
        self.split(&room.packed, 1, &mut room.turned, 0);
        for (pair, turned) in to.chunks_exact_mut(2).zip(&room.turned) {
            (pair[0], pair[1]) = (turned.0, -turned.1);
        }
    }

    /// The transform of every `stride`-th number of a list by the factors from `level` on.
    fn split<R: Real>(&self, list: &[Complex<R>], stride: usize, to: &mut [Complex<R>], level: usize) {
        let Some(&parts) = self.factors.get(level) else {
            to[0] = list[0];
            return;
        };
        let length = to.len() / parts;
        for (part, room) in to.chunks_exact_mut(length).enumerate() {
            self.split(&list[part * stride..], stride * parts, room, level + 1);
        }
        // Roots of this length lie `apart` places apart.
        let apart = 2 * stride;
        for k in 0..length {
            let mut terms = [Complex::splat(0.0, 0.0); 5];
            for part in 0..parts {
                terms[part] = to[part * length + k] * self.root(part * k * apart);
            }
            match parts {
                2 => (to[k], to[length + k]) = (terms[0] + terms[1], terms[0] - terms[1]),
                4 => {
                    let (sum, difference) = (terms[0] + terms[2], terms[0] - terms[2]);
                    let (other, turned) = (terms[1] + terms[3], (terms[1] - terms[3]).turned());
                    (to[k], to[2 * length + k]) = (sum + other, sum - other);
                    (to[length + k], to[3 * length + k]) = (difference - turned, difference + turned);
                }
                _ => {
                    for row in 0..parts {
                        let sum = |sum, part| sum + terms[part] * self.root(part * row * length * apart);
                        to[row * length + k] = (1..parts).fold(terms[0], sum);
                    }
                }
            }
        }
    }
}

/// Room for a transform.
pub struct Room<R> {
    packed: Vec<Complex<R>>,
    turned: Vec<Complex<R>>,
}

impl<R: Real> Room<R> {
    /// Room for the transform of a number of samples.
    pub fn new(samples: usize) -> Self {
        let list = || vec![Complex::splat(0.0, 0.0); samples / 2];
        Room { packed: list(), turned: list() }
    }
}
