//! Steps of order 5 by Radau IIA with three stages: any stiffness, since what a step does not resolve dies out in it.
//!
//! The 3·2n equations of a step are solved by Newton with the derivatives at its start. The eigenvalues of the method's
//! matrix part them into one real and one complex set of 2n, and the second order of the equations of motion leaves n each:
//! with γ = μ/h, P and Q the derivatives of the accelerations by angles and speeds,
//!
//! ```text
//! (γ² − γQ − P) u = d + γb − Qb        v = γu − b
//! ```
//!
//! for right sides b of the angles and d of the speeds.
//!
//! Source: Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.8, and their program RADAU5, whose
//! transformation, error estimate and choice of steps these are.

use super::explicit::{SAYS_NOTHING, fitting};
use super::rates::Rates;
use super::stepper::{Scale, Stepper};
use linkwright_kernel::matrix::{Complex, LuFactors};

/// √6
const ROOT: f64 = 2.449_489_742_783_178;

const C: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];

/// Weights of the stages over a step.
const WEIGHTS: [f64; 3] = [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0];

/// Eigenvalues of the inverse of the method's matrix: 3 + ∛9 − ∛3, and 3 + (∛3 − ∛9)/2 − i(3^{5/6} + 3^{7/6})/2.
const REAL: f64 = 3.637_834_252_744_496;
const PAIR: Complex = Complex { re: 2.681_082_873_627_752, im: -3.050_430_199_247_411 };

/// The transformation to them, and back.
const TO: [[f64; 3]; 3] = [
    [4.178_718_591_551_904, 0.327_682_820_761_062_37, 0.523_376_445_499_449_5],
    [-4.178_718_591_551_904, -0.327_682_820_761_062_37, 0.476_623_554_500_550_44],
    [0.502_872_634_945_786_8, -2.571_926_949_855_605, 0.596_039_204_828_224_9],
];
const FROM: [[f64; 3]; 3] = [
    [0.094_438_762_488_975_24, -0.141_255_295_020_954_2, 0.030_029_194_105_147_42],
    [0.250_213_122_965_333_3, 0.204_129_352_293_799_93, -0.382_942_112_757_261_9],
    [1.0, 1.0, 0.0],
];

/// Weights of the stages in the estimate of the error.
const ERROR: [f64; 3] = [(-13.0 - 7.0 * ROOT) / 3.0, (-13.0 + 7.0 * ROOT) / 3.0, -1.0 / 3.0];

/// Powers 1 to 3 of the polynomial through the stages.
const POLYNOMIAL: [[f64; 3]; 3] = [
    [13.0 / 3.0 + 7.0 * ROOT / 3.0, -23.0 / 3.0 - 22.0 * ROOT / 3.0, 10.0 / 3.0 + 5.0 * ROOT],
    [13.0 / 3.0 - 7.0 * ROOT / 3.0, -23.0 / 3.0 + 22.0 * ROOT / 3.0, 10.0 / 3.0 - 5.0 * ROOT],
    [1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0],
];

/// Largest error of the polynomial through the stages over the estimate of the step's error. Both have the leading term of
/// p′ − f = K (x − c₁)(x − c₂)(x − 1): its integral over the step is largest at c₁ with 0.0068 K h, and the estimate is h/γ
/// times its value at the start, 0.1 K h/3.64.
const POLYNOMIAL_ERROR: f64 = 0.25;

/// Newton's corrections of a step; RADAU5 allows seven.
const CORRECTIONS: usize = 7;

/// Implicit steps with their stages.
#[derive(Clone, Debug)]
pub struct Implicit {
    n: usize,
    /// Derivatives at the start and at the end.
    start: Vec<f64>,
    end: Vec<f64>,
    by_angle: Vec<f64>,
    by_speed: Vec<f64>,
    real: LuFactors<f64>,
    pair: LuFactors<Complex>,
    /// What the stages are beyond the start, derivatives there, and the same in the eigenvectors' terms.
    beyond: [Vec<f64>; 3],
    slopes: [Vec<f64>; 3],
    parts: [Vec<f64>; 3],
    /// Powers of the polynomial of this step, and the length over which it runs.
    polynomial: [Vec<f64>; 3],
    last: Option<f64>,
    stage: Vec<f64>,
    sides: [Vec<f64>; 3],
    /// An error and the states at both ends, with places for whole registers.
    measured: [Vec<f64>; 3],
    room: [Vec<Complex>; 2],
    h: f64,
    /// Length and error of the step before, for the next length.
    before: Option<(f64, f64)>,
    rejected: usize,
}

/// How Newton's corrections of a step ended.
enum NewtonOutcome {
    /// After so many corrections.
    After(usize),
    /// Not.
    Diverged,
}

impl Implicit {
    /// For a system.
    pub fn new(rates: &Rates<'_>) -> Self {
        let n = rates.system.len();
        let list = || vec![0.0; 2 * n];
        let three = || [list(), list(), list()];
        Implicit {
            n,
            start: list(),
            end: list(),
            by_angle: vec![0.0; n * n],
            by_speed: vec![0.0; n * n],
            real: LuFactors::new(n),
            pair: LuFactors::new(n),
            beyond: three(),
            slopes: three(),
            parts: three(),
            polynomial: three(),
            last: None,
            stage: list(),
            sides: three(),
            measured: std::array::from_fn(|_| rates.room()),
            room: [vec![Complex::default(); n], vec![Complex::default(); n]],
            h: 0.0,
            before: None,
            rejected: 0,
        }
    }

    /// Takes apart both matrices for a length of step.
    fn factor(&mut self, h: f64) {
        let (n, p, q) = (self.n, &self.by_angle, &self.by_speed);
        let real = REAL / h;
        let pair = Complex { re: PAIR.re / h, im: PAIR.im / h };
        let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        self.real.factor(|i, j| real * real * unit(i, j) - real * q[i * n + j] - p[i * n + j]);
        let square = pair * pair;
        self.pair.factor(|i, j| {
            let (q, p, unit) = (q[i * n + j], p[i * n + j], unit(i, j));
            Complex { re: square.re * unit - pair.re * q - p, im: square.im * unit - pair.im * q }
        });
    }

    /// Solves the real set for a right side, in its place; both count the masses from the first.
    fn solve_real(&mut self, rates: &Rates<'_>, h: f64, side: usize) {
        let (n, gamma) = (self.n, REAL / h);
        let side = &mut self.sides[side];
        rates.to_absolute(side);
        let (b, d) = side.split_at_mut(n);
        for i in 0..n {
            let row = &self.by_speed[i * n..(i + 1) * n];
            d[i] += gamma * b[i] - row.iter().zip(b.iter()).map(|(q, b)| q * b).sum::<f64>();
        }
        self.real.solve(d);
        for (b, d) in b.iter_mut().zip(d) {
            (*b, *d) = (*d, gamma * *d - *b);
        }
        rates.to_relative(side);
    }

    /// The same for the complex set, whose real and imaginary parts are the last two sides.
    fn solve_pair(&mut self, rates: &Rates<'_>, h: f64) {
        let n = self.n;
        let gamma = Complex { re: PAIR.re / h, im: PAIR.im / h };
        let [_, re, im] = &mut self.sides;
        rates.to_absolute(re);
        rates.to_absolute(im);
        let [b, d] = &mut self.room;
        for i in 0..n {
            b[i] = Complex { re: re[i], im: im[i] };
        }
        for i in 0..n {
            let row = &self.by_speed[i * n..(i + 1) * n];
            let sum = row
                .iter()
                .zip(b.iter())
                .fold(Complex::default(), |sum, (&q, &b)| sum + Complex { re: q * b.re, im: q * b.im });
            d[i] = Complex { re: re[n + i], im: im[n + i] } + gamma * b[i] - sum;
        }
        self.pair.solve(d);
        for i in 0..n {
            let v = gamma * d[i] - b[i];
            (re[i], im[i], re[n + i], im[n + i]) = (d[i].re, d[i].im, v.re, v.im);
        }
        rates.to_relative(re);
        rates.to_relative(im);
    }

    /// A first guess of the stages: the last step's polynomial goes on, or nothing changes.
    fn guess(&mut self, h: f64) {
        for (c, beyond) in C.iter().zip(&mut self.beyond) {
            beyond.fill(0.0);
            if let Some(last) = self.last {
                let x = 1.0 + c * h / last;
                for (power, row) in self.polynomial.iter().enumerate() {
                    let factor = x.powi(power as i32 + 1) - 1.0;
                    beyond.iter_mut().zip(row).for_each(|(to, a)| *to += factor * a);
                }
            }
        }
        transform(&TO, &self.beyond, &mut self.parts);
    }

    /// Newton's corrections.
    fn correct(&mut self, rates: &mut Rates<'_>, at: (f64, &[f64]), h: f64, scale: &Scale) -> NewtonOutcome {
        let (t, state) = at;
        // What Newton leaves must not disturb the estimate of the error (Hairer and Wanner, IV.8).
        let enough = (10.0 * f64::EPSILON / scale.accuracy).max(scale.accuracy.sqrt().min(0.03));
        let mut before: Option<f64> = None;
        let mut shrinking = None;
        for nth in 0..CORRECTIONS {
            self.evaluate(rates, t, state, h);
            let size = self.correction(rates, h, state, scale);
            if !size.is_finite() {
                return NewtonOutcome::Diverged;
            }
            let rate = before.map(|before| size / before);
            let left = (CORRECTIONS - nth) as i32;
            if rate.is_some_and(|r| r >= 1.0 || r.powi(left) / (1.0 - r) * size > enough) {
                return NewtonOutcome::Diverged;
            }
            for (part, side) in self.parts.iter_mut().zip(&self.sides) {
                part.iter_mut().zip(side).for_each(|(x, dx)| *x += dx);
            }
            transform(&FROM, &self.parts, &mut self.beyond);
            shrinking = rate.or(shrinking);
            if size == 0.0 || shrinking.is_some_and(|r| r / (1.0 - r) * size < enough) {
                return NewtonOutcome::After(nth + 1);
            }
            before = Some(size);
        }
        NewtonOutcome::Diverged
    }

    /// Derivatives at the stages.
    fn evaluate(&mut self, rates: &mut Rates<'_>, t: f64, state: &[f64], h: f64) {
        for ((c, beyond), slopes) in C.iter().zip(&self.beyond).zip(&mut self.slopes) {
            sum(&mut self.stage, state, beyond);
            rates.derivative(t + c * h, &self.stage, slopes);
        }
    }

    /// Newton's next correction, left in the sides; its size.
    fn correction(&mut self, rates: &Rates<'_>, h: f64, state: &[f64], scale: &Scale) -> f64 {
        transform(&TO, &self.slopes, &mut self.sides);
        let (real, pair) = (REAL / h, Complex { re: PAIR.re / h, im: PAIR.im / h });
        for i in 0..2 * self.n {
            self.sides[0][i] -= real * self.parts[0][i];
            let part = pair * Complex { re: self.parts[1][i], im: self.parts[2][i] };
            self.sides[1][i] -= part.re;
            self.sides[2][i] -= part.im;
        }
        self.solve_real(rates, h, 0);
        self.solve_pair(rates, h);
        let squares = self.sides.iter().map(|side| scale.norm(side, state).powi(2));
        (squares.sum::<f64>() / 3.0).sqrt()
    }

    /// Error over tolerance; `fresh` if the derivative at the start may have nothing to do with the step.
    fn error(&mut self, rates: &mut Rates<'_>, at: (f64, &[f64]), h: f64, scale: &Scale, fresh: bool) -> f64 {
        let (t, state) = at;
        let estimate = |this: &mut Self, slopes: &[f64]| {
            for i in 0..2 * this.n {
                let stages: f64 = ERROR.iter().zip(&this.beyond).map(|(e, z)| e * z[i]).sum();
                this.sides[0][i] = slopes[i] + stages / h;
            }
        };
        let start = std::mem::take(&mut self.start);
        estimate(self, &start);
        self.start = start;
        self.solve_real(rates, h, 0);
        sum(&mut self.stage, state, &self.beyond[2]);
        let error = scale.norm(&self.sides[0], &self.stage);
        if !fresh || error < 1.0 {
            return error;
        }
        // Filtered once more, so that swings that are much faster than the step do not stop it.
        let mut near = vec![0.0; 2 * self.n];
        let mut slopes = near.clone();
        sum(&mut near, state, &self.sides[0]);
        rates.derivative(t, &near, &mut slopes);
        estimate(self, &slopes);
        self.solve_real(rates, h, 0);
        scale.norm(&self.sides[0], &self.stage)
    }

    /// Factor for the next length, from this error and the one before (Gustafsson).
    fn factor_of(&self, h: f64, error: f64) -> f64 {
        let elementary = error.powf(-0.25);
        match self.before {
            Some((h_before, error_before)) if error > 0.0 => {
                elementary * (h / h_before * (error_before / error).powf(0.25)).min(1.0)
            }
            _ => elementary,
        }
    }
}

impl Stepper for Implicit {
    fn begin(&mut self, rates: &mut Rates<'_>, t: f64, state: &[f64], first: f64) {
        rates.derivative(t, state, &mut self.start);
        self.h = first;
        self.last = None;
        self.before = None;
    }

    fn step(
        &mut self,
        rates: &mut Rates<'_>,
        (t, state): (f64, &Vec<f64>),
        longest: f64,
        scale: &Scale,
        end: &mut Vec<f64>,
    ) -> Option<f64> {
        let mut wasted = self.last.is_none();
        // The last evaluation may have been inside the step before.
        rates.derivative(t, state, &mut self.start);
        rates.jacobian(t, &mut self.by_angle, &mut self.by_speed);
        // Forty halvings reach any length that still changes t.
        for _ in 0..40 {
            let h = fitting(self.h, longest);
            self.factor(h);
            self.guess(h);
            let NewtonOutcome::After(corrections) = self.correct(rates, (t, state), h, scale) else {
                self.h = 0.5 * h;
                wasted = true;
                self.rejected += 1;
                continue;
            };
            let error = self.error(rates, (t, state), h, scale, wasted);
            let many = 2 * CORRECTIONS + 1;
            let safety = 0.9 * many as f64 / (many - 1 + corrections) as f64;
            if error <= 1.0 {
                sum(end, state, &self.beyond[2]);
                let factor = (safety * self.factor_of(h, error)).clamp(0.2, 8.0);
                // After a step in vain the next is no longer; a step cut short says nothing about the next.
                let grown = h * if wasted && self.last.is_some() { factor.min(1.0) } else { factor };
                self.before = Some((h, error.max(1e-4)));
                self.h = if h < self.h { grown.max(self.h) } else { grown };
                self.last = Some(h);
                transpose(&self.beyond, &mut self.polynomial);
                return Some(h);
            }
            self.h = h * (safety * self.factor_of(h, error)).clamp(0.2, 0.9);
            wasted = true;
            self.rejected += 1;
        }
        None
    }

    fn accept(&mut self, rates: &mut Rates<'_>, t_end: f64, end: &[f64]) {
        rates.derivative(t_end, end, &mut self.end);
    }

    fn fill(
        &mut self,
        rates: &mut Rates<'_>,
        (_, state): (f64, &Vec<f64>),
        h: f64,
        scale: &Scale,
        end: &[f64],
    ) -> f64 {
        // The first sides still hold the estimate.
        for (list, to) in [&self.sides[0][..], state, end].into_iter().zip(&mut self.measured) {
            rates.copy(list, to);
        }
        let [error, from, to] = &self.measured;
        let worst = POLYNOMIAL_ERROR * scale.worst(rates.system, error, [from, to]);
        if worst > SAYS_NOTHING {
            self.h = self.h.min(h * shortened(worst));
        }
        worst
    }

    fn retake(&mut self) {
        // The polynomial of a step that was not taken does not go on.
        self.last = None;
        self.before = None;
    }

    fn shorten(&mut self, h: f64, error: f64) {
        self.h = h * shortened(error).min(0.9);
        self.retake();
        self.rejected += 1;
    }

    fn component(&self, share: f64, state: &[f64], i: usize) -> f64 {
        let [a, b, c] = &self.polynomial;
        state[i] + share * (a[i] + share * (b[i] + share * c[i]))
    }

    fn slope(&self, share: f64, h: f64, i: usize) -> f64 {
        let [a, b, c] = &self.polynomial;
        (a[i] + share * (2.0 * b[i] + share * 3.0 * c[i])) / h
    }

    fn work(&mut self, rates: &mut Rates<'_>, (t, state): (f64, &Vec<f64>), h: f64, to: &mut [f64]) {
        for k in 0..3 {
            sum(&mut self.stage, state, &self.beyond[k]);
            rates.derivative(t + C[k] * h, &self.stage, &mut self.slopes[k]);
            to.iter_mut().zip(&rates.powers).for_each(|(to, power)| *to += h * WEIGHTS[k] * power);
        }
    }

    fn advance(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
    }

    fn rejected(&self) -> usize {
        self.rejected
    }
}

/// Factor for a step whose polynomial had an error, which falls with h⁴.
fn shortened(error: f64) -> f64 {
    if error.is_nan() { 0.2 } else { (0.9 * error.powf(-0.25)).clamp(0.2, 8.0) }
}

fn sum(to: &mut [f64], a: &[f64], b: &[f64]) {
    for ((to, a), b) in to.iter_mut().zip(a).zip(b) {
        *to = a + b;
    }
}

/// Each row of a matrix times three lists.
fn transform(matrix: &[[f64; 3]; 3], from: &[Vec<f64>; 3], to: &mut [Vec<f64>; 3]) {
    let [a, b, c] = from;
    for (row, to) in matrix.iter().zip(to) {
        for i in 0..a.len() {
            to[i] = row[0] * a[i] + row[1] * b[i] + row[2] * c[i];
        }
    }
}

/// The polynomial's powers from what the stages are beyond the start.
fn transpose(beyond: &[Vec<f64>; 3], to: &mut [Vec<f64>; 3]) {
    let columns = std::array::from_fn(|power| std::array::from_fn(|stage| POLYNOMIAL[stage][power]));
    transform(&columns, beyond, to);
}

#[cfg(test)]
mod tests {
    use super::super::system::{Link, Manner, System};
    use super::*;

    /// The constants are those of the method: T A⁻¹ T⁻¹ holds the eigenvalues, A being Radau IIA's matrix.
    #[test]
    fn transformation_parts_the_stages() {
        let r = ROOT;
        let a = [
            [(88.0 - 7.0 * r) / 360.0, (296.0 - 169.0 * r) / 1800.0, (-2.0 + 3.0 * r) / 225.0],
            [(296.0 + 169.0 * r) / 1800.0, (88.0 + 7.0 * r) / 360.0, (-2.0 - 3.0 * r) / 225.0],
            [WEIGHTS[0], WEIGHTS[1], WEIGHTS[2]],
        ];
        let apart = [[REAL, 0.0, 0.0], [0.0, PAIR.re, -PAIR.im], [0.0, PAIR.im, PAIR.re]];
        let product = |x: &[[f64; 3]; 3], y: &[[f64; 3]; 3]| {
            let entry = |i: usize, j: usize| (0..3).map(|k| x[i][k] * y[k][j]).sum::<f64>();
            std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
        };
        let unit = product(&product(&FROM, &product(&apart, &TO)), &a);
        for (i, row) in unit.iter().enumerate() {
            for (j, &x) in row.iter().enumerate() {
                let wanted = if i == j { 1.0 } else { 0.0 };
                // Rounding of entries of size ten.
                assert!((x - wanted).abs() < 2e-14, "entry {i}, {j}: {x}");
            }
        }
    }

    /// Two discs swing against each other; steps of even length err with their fifth power.
    #[test]
    fn order_is_five() {
        let link = Link {
            ends: [0, 1],
            ratio: 1.0,
            stiffness: 6.0,
            damping: 0.0,
            curve: None,
            manner: Manner::default(),
        };
        let system = System {
            inertia: vec![3.0, 2.0],
            damping: vec![0.0; 2],
            swing_damping: vec![0.0; 2],
            links: vec![link],
            rotors: Vec::new(),
            torques: Vec::new(),
            tables: Vec::new(),
            curves: Vec::new(),
            ..System::default()
        };
        let omega = 5.0_f64.sqrt();
        let error = |steps: u32| {
            let mut rates = Rates::new(&system);
            rates.enter(0.0);
            let mut state = rates.state(&[0.0, 1.0], &[0.0; 2]);
            let mut end = state.clone();
            let (h, scale) = (1.0 / f64::from(steps), Scale::new([1e-3; 2], &rates, omega));
            let mut stepper = Implicit::new(&rates);
            stepper.begin(&mut rates, 0.0, &state, h);
            for i in 0..steps {
                let at = f64::from(i) * h;
                assert_eq!(stepper.step(&mut rates, (at, &state), h, &scale, &mut end), Some(h));
                std::mem::swap(&mut state, &mut end);
            }
            (state[1] - omega.cos()).abs()
        };
        let order = (error(10) / error(20)).log2();
        assert!((order - 5.0).abs() < 0.2, "the error falls with power {order}");
    }

    /// The polynomial takes the stages at their places.
    #[test]
    fn polynomial_goes_through_the_stages() {
        for (stage, &c) in C.iter().enumerate() {
            for other in 0..3 {
                let value: f64 = (0..3).map(|p| POLYNOMIAL[other][p] * c.powi(p as i32 + 1)).sum();
                let wanted = if other == stage { 1.0 } else { 0.0 };
                assert!((value - wanted).abs() < 1e-13, "stage {other} at {c}");
            }
        }
    }
}
