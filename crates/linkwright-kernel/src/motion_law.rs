//! A motion law in pieces: the lift of a cam's follower over the crank angle, repeated every revolution.
//!
//! Each piece counts its own u = (φ − start)/length from 0 to 1 and is Σ cᵢ uⁱ + Σ (a cos ku + b sin ku), the form
//! that every law of the textbooks has. Values come as Taylor coefficients of any order, so that the same
//! law serves transfer functions, derivatives by parameters and series at change points.

use crate::real::Real;
use std::f64::consts::TAU;

/// One piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    pub start: f64,
    pub length: f64,
    /// Coefficients of powers of u, from the constant on.
    pub polynomial: Vec<f64>,
    /// k, a, b of each harmonic.
    pub harmonics: Vec<[f64; 3]>,
}

/// A law over one revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLaw {
    pieces: Vec<Piece>,
}

/// Rounding by which the ends of a revolution may miss it \[rad\].
const CLOSED: f64 = 1e-9;

impl MotionLaw {
    /// From pieces that follow one another over a whole revolution; `None` if they do not.
    pub fn new(pieces: Vec<Piece>) -> Option<Self> {
        let mut end = 0.0;
        for piece in &pieces {
            let numbers = piece.polynomial.iter().chain(piece.harmonics.iter().flatten());
            let sound = piece.length > 0.0 && numbers.into_iter().all(|x| x.is_finite());
            if !sound || (piece.start - end).abs() > CLOSED {
                return None;
            }
            end = piece.start + piece.length;
        }
        ((end - TAU).abs() < CLOSED).then_some(MotionLaw { pieces })
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The piece that an angle falls into, and the angle within the revolution; at a break the later piece counts, or the
    /// earlier one if `before`.
    #[inline]
    pub fn piece(&self, phi: f64, before: bool) -> (&Piece, f64) {
        let inside = (0.0..TAU).contains(&phi) || (before && phi == TAU);
        let phi = if inside { phi } else { phi.rem_euclid(TAU) };
        let phi = if before && phi == 0.0 { TAU } else { phi };
        let after =
            self.pieces.partition_point(|piece| if before { piece.start < phi } else { piece.start <= phi });
        (&self.pieces[after.max(1) - 1], phi)
    }

    /// Taylor coefficients at an angle: the k-th is the k-th derivative over k!.
    pub fn series(&self, phi: f64, to: &mut [f64]) {
        let (piece, phi) = self.piece(phi, false);
        piece.series((phi - piece.start) / piece.length, to);
    }

    /// Lift and its derivatives, as many as there are, in any number.
    #[inline(always)]
    pub fn at<R: Real, const N: usize>(&self, phi: R) -> [R; N] {
        derivatives(phi, &|x: f64, to: &mut [f64]| self.series(x, to))
    }
}

/// Value and derivatives from Taylor coefficients.
#[inline(always)]
fn derivatives<R: Real, const N: usize>(phi: R, series: &impl Fn(f64, &mut [f64])) -> [R; N] {
    let mut found = [R::splat(0.0); N];
    phi.taylor(series, &mut found);
    times_factorials(found)
}

/// Derivatives from Taylor coefficients.
#[inline(always)]
fn times_factorials<R: Real, const N: usize>(mut found: [R; N]) -> [R; N] {
    let mut factorial = 1.0;
    for (k, x) in found.iter_mut().enumerate().skip(2) {
        factorial *= k as f64;
        *x = *x * factorial;
    }
    found
}

impl Piece {
    /// Lift and its derivatives at an angle, the piece going on beyond its ends: one-sided values at a break.
    #[inline(always)]
    pub fn at<R: Real, const N: usize>(&self, phi: R) -> [R; N] {
        if R::IS_PLAIN {
            let mut found = [R::splat(0.0); N];
            self.series((phi - self.start) / R::splat(self.length), &mut found);
            return times_factorials(found);
        }
        derivatives(phi, &|x: f64, to: &mut [f64]| self.series((x - self.start) / self.length, to))
    }

    /// Taylor coefficients by φ at u; beyond the ends of the piece it goes on as it is.
    #[inline(always)]
    pub fn series<R: Real>(&self, u: R, to: &mut [R]) {
        to.fill(R::splat(0.0));
        // Horner for the polynomial and all its derivatives over k! at once.
        for &c in self.polynomial.iter().rev() {
            for k in (1..to.len()).rev() {
                to[k] = to[k] * u + to[k - 1];
            }
            to[0] = to[0] * u + c;
        }
        for &[frequency, a, b] in &self.harmonics {
            let (sin, cos) = (u * frequency).sin_cos();
            // Each derivative of a cos + b sin is b cos − a sin, times the frequency.
            let (mut value, mut next) = (cos * a + sin * b, cos * b - sin * a);
            let mut scale = 1.0;
            for (k, x) in to.iter_mut().enumerate() {
                *x = *x + value * scale;
                (value, next) = (next, -value);
                scale *= frequency / (k + 1) as f64;
            }
        }
        let inverse = 1.0 / self.length;
        let mut scale = inverse;
        for x in &mut to[1..] {
            *x = *x * scale;
            scale *= inverse;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::jet::Jet;
    use std::f64::consts::PI;

    fn cycloidal(start: f64, length: f64, from: f64, h: f64) -> Piece {
        let harmonics = vec![[TAU, 0.0, -h / TAU]];
        Piece { start, length, polynomial: vec![from, h], harmonics }
    }

    fn to_and_fro() -> MotionLaw {
        let back = Piece {
            start: PI,
            length: PI,
            polynomial: vec![0.3, 0.0, 0.0, -3.0, 4.5, -1.8],
            harmonics: vec![],
        };
        MotionLaw::new(vec![cycloidal(0.0, PI, 0.0, 0.3), back]).expect("a whole turn")
    }

    #[test]
    fn derivatives_are_those_of_the_law() {
        let lift = to_and_fro();
        let [s, s1, s2, s3] = lift.at::<f64, 4>(1.0);
        let (z, beta, h) = (1.0 / PI, PI, 0.3);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} for {b}");
        close(s, h * (z - (TAU * z).sin() / TAU));
        close(s1, h / beta * (1.0 - (TAU * z).cos()));
        close(s2, h / beta.powi(2) * TAU * (TAU * z).sin());
        close(s3, h / beta.powi(3) * TAU * TAU * (TAU * z).cos());
        let z: f64 = 0.25;
        let [s, s1] = lift.at::<f64, 2>(PI + z * PI + 3.0 * TAU);
        close(s, h - h * (10.0 * z.powi(3) - 15.0 * z.powi(4) + 6.0 * z.powi(5)));
        close(s1, -h / beta * 30.0 * (z * (1.0 - z)).powi(2));
    }

    #[test]
    fn duals_and_jets_carry_the_next_derivatives() {
        let lift = to_and_fro();
        for phi in [0.3, 2.9, 4.0] {
            let jets = lift.at::<f64, 6>(phi);
            let [s, s1, s2]: [Dual<f64>; 3] = lift.at(Dual { value: phi, d: 2.0 });
            assert_eq!([s.d, s1.d, s2.d], [jets[1], jets[2], jets[3]].map(|x| 2.0 * x), "duals at {phi}");
            // φ(t) = φ + t + t²: s″(t) = s″ + s‴ t + (s⁗/2 + s‴) t² + …
            let [_, _, s2]: [Jet<f64, 3>; 3] = lift.at(Jet { c: [phi, 1.0, 1.0] });
            let wanted = [jets[2], jets[3], 0.5 * jets[4] + jets[3]];
            for (a, b) in s2.c.iter().zip(wanted) {
                assert!((a - b).abs() < 1e-13 * b.abs().max(1.0), "jets at {phi}: {a} for {b}");
            }
        }
    }

    #[test]
    fn pieces_must_make_a_turn() {
        assert!(MotionLaw::new(vec![cycloidal(0.0, PI, 0.0, 0.3)]).is_none(), "half a turn");
        let dwell = Piece { start: 0.0, length: TAU, polynomial: vec![5.0], harmonics: vec![] };
        let whole = MotionLaw::new(vec![dwell]).expect("a dwell");
        assert_eq!(whole.at::<f64, 2>(1.0), [5.0, 0.0], "a dwell");
    }
}
