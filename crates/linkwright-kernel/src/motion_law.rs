//! A motion law in pieces: the lift of a cam's follower over the crank angle, repeated every revolution.
//!
//! Each piece counts its own u = (φ − start)/length from 0 to 1 and is Σ cᵢ uⁱ + Σ (a cos ku + b sin ku), the form
//! that every law of the textbooks has. Values come as Taylor coefficients of any order, so that the same
//! law serves transfer functions, derivatives by parameters and series at change points.
//!
//! The numbers of the pieces may be parameters of a machine as well: then duals work a piece out in its own arithmetic, of those
//! parameters, and derivatives follow them.

use crate::out_of_line;
use crate::real::Real;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::ops::{Add, Mul, Range};

/// One piece.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    pub start: f64,
    pub length: f64,
    /// Coefficients of powers of u, from the constant on.
    pub polynomial: Vec<f64>,
    /// k, a, b of each harmonic.
    pub harmonics: Vec<[f64; 3]>,
}

/// A law over one revolution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionLaw {
    pieces: Vec<Piece>,
    /// First of the parameters that the numbers of each piece are as well; none where they are no parameters.
    slots: Vec<usize>,
}

/// The numbers of a piece that its course is made of.
struct Course<'a, C> {
    length: C,
    polynomial: &'a [C],
    /// k, a, b of each harmonic, one behind the other.
    harmonics: &'a [C],
}

/// A change of a derivative at a break below this share of its size in the law is rounding.
const NO_JUMP: f64 = 1e-9;

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
        ((end - TAU).abs() < CLOSED).then_some(MotionLaw { pieces, slots: Vec::new() })
    }

    /// The law whose numbers are parameters as well, piece by piece from the first on: start and length, the polynomial,
    /// then k, a, b of each harmonic.
    #[must_use]
    pub fn with_parameters(self, first: usize) -> Self {
        let mut next = first;
        let mut slots = Vec::with_capacity(self.pieces.len());
        for piece in &self.pieces {
            slots.push(next);
            next = next.saturating_add(piece.count());
        }
        MotionLaw { slots, ..self }
    }

    /// The parameters that its numbers are.
    pub fn parameters(&self) -> Range<usize> {
        let ends = self.slots.first().zip(self.slots.last().zip(self.pieces.last()));
        ends.map_or(0..0, |(&first, (&last, piece))| first..last.saturating_add(piece.count()))
    }

    /// Where a piece starts, as a number of the machine; it moves with its parameter.
    #[inline(always)]
    pub fn start<R: Real>(&self, nth: usize, q: &[R]) -> R {
        match self.slots.get(nth) {
            Some(&slot) if R::IS_DUAL => q[slot],
            _ => R::splat(self.pieces[nth].start),
        }
    }

    /// Of each piece whether velocity or acceleration jump where it starts.
    pub fn jumps(&self) -> Vec<bool> {
        let at = |piece: &Piece, u: f64| piece.at::<f64, 3>(piece.length.mul_add(u, piece.start));
        let read: Vec<[[f64; 3]; 4]> =
            self.pieces.iter().map(|piece| [0.0, 0.2, 0.6, 1.0].map(|u| at(piece, u))).collect();
        let size = |order: usize| read.iter().flatten().map(|at| at[order].abs()).fold(0.0, f64::max);
        let sizes = [1, 2].map(|order| (order, NO_JUMP * size(order)));
        let jumps = |nth: usize| {
            let [before, behind] = [read[(nth + read.len() - 1) % read.len()][3], read[nth][0]];
            sizes.iter().any(|&(order, size)| (behind[order] - before[order]).abs() > size)
        };
        (0..read.len()).map(jumps).collect()
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The piece that an angle falls into, and the angle within the revolution; at a break the later piece counts, or the
    /// earlier one if `before`.
    #[inline]
    pub fn piece(&self, phi: f64, before: bool) -> (&Piece, f64) {
        let (nth, phi) = self.place(phi, before);
        (&self.pieces[nth], phi)
    }

    /// The number of that piece, and the angle.
    #[inline]
    fn place(&self, phi: f64, before: bool) -> (usize, f64) {
        let inside = (0.0..TAU).contains(&phi) || (before && phi == TAU);
        let phi = if inside { phi } else { phi.rem_euclid(TAU) };
        let phi = if before && phi == 0.0 { TAU } else { phi };
        let after =
            self.pieces.partition_point(|piece| if before { piece.start < phi } else { piece.start <= phi });
        (after.max(1) - 1, phi)
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

    /// The same with derivatives by the parameters that its numbers are.
    #[inline(always)]
    pub fn at_numbers<R: Real, const N: usize>(&self, phi: R, q: &[R]) -> [R; N] {
        if !R::IS_DUAL || self.slots.is_empty() {
            return self.at(phi);
        }
        out_of_line!(R, self.along(phi, q))
    }

    /// Each lane on its piece, of which there is one where all lanes are at one angle.
    #[inline(always)]
    fn along<R: Real, const N: usize>(&self, phi: R, q: &[R]) -> [R; N] {
        let number = phi.map(|phi| (self.place(phi, false).0 as f64, 0.0));
        let within = phi.map(|phi| (self.place(phi, false).1, 1.0));
        let [first, last] = [-(-number).max_lane(), number.max_lane()].map(|nth| nth as usize);
        let mut found = [R::splat(0.0); N];
        for nth in first..=last {
            let (own, harmonics) = q[self.slots[nth]..][..self.pieces[nth].count()]
                .split_at(2 + self.pieces[nth].polynomial.len());
            let course = Course { length: own[1], polynomial: &own[2..], harmonics };
            let mut series = [R::splat(0.0); N];
            course.series((within - own[0]) / own[1], &mut series);
            for (found, own) in found.iter_mut().zip(series) {
                *found = number.select_lt(R::splat(nth as f64), *found, own);
            }
        }
        times_factorials(found)
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
        let harmonics = self.harmonics.as_flattened();
        Course { length: self.length, polynomial: &self.polynomial, harmonics }.series(u, to);
    }

    /// How many numbers it has.
    fn count(&self) -> usize {
        2 + self.polynomial.len() + 3 * self.harmonics.len()
    }
}

impl<C: Real> Course<'_, C> {
    /// Taylor coefficients by φ at u.
    #[inline(always)]
    fn series<R: Real + Add<C, Output = R> + Mul<C, Output = R>>(&self, u: R, to: &mut [R]) {
        to.fill(R::splat(0.0));
        // Horner for the polynomial and all its derivatives over k! at once.
        for &c in self.polynomial.iter().rev() {
            for k in (1..to.len()).rev() {
                to[k] = to[k] * u + to[k - 1];
            }
            to[0] = to[0] * u + c;
        }
        for wave in self.harmonics.chunks_exact(3) {
            let (frequency, a, b) = (wave[0], wave[1], wave[2]);
            let (sin, cos) = (u * frequency).sin_cos();
            // Each derivative of a cos + b sin is b cos − a sin, times the frequency.
            let (mut value, mut next) = (cos * a + sin * b, cos * b - sin * a);
            let mut scale = C::splat(1.0);
            for (k, x) in to.iter_mut().enumerate() {
                *x = *x + value * scale;
                (value, next) = (next, -value);
                scale = scale * (frequency / C::splat((k + 1) as f64));
            }
        }
        let inverse = C::splat(1.0) / self.length;
        let mut scale = inverse;
        for x in &mut to[1..] {
            *x = *x * scale;
            scale = scale * inverse;
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

    /// By start, length, coefficients and harmonics of a piece, of lift, velocity and acceleration: what differences of laws with
    /// other numbers say; lanes may be on different pieces.
    #[test]
    fn numbers_move_a_law_as_differences_do() {
        let lift = to_and_fro();
        let numbers = |law: &MotionLaw| -> Vec<f64> {
            let of = |piece: &Piece| {
                let course = piece.polynomial.iter().chain(piece.harmonics.as_flattened());
                [piece.start, piece.length].into_iter().chain(course.copied()).collect::<Vec<_>>()
            };
            law.pieces.iter().flat_map(of).collect()
        };
        let start: Vec<f64> = [7.0].into_iter().chain(numbers(&lift)).collect();
        let with = lift.clone().with_parameters(1);
        assert_eq!(with.parameters(), 1..start.len());
        let read = |q: &[f64], phi| -> [f64; 3] {
            let mut law = lift.clone();
            let mut next = q[1..].iter().copied();
            for piece in &mut law.pieces {
                let own = [&mut piece.start, &mut piece.length].into_iter();
                let course = piece.polynomial.iter_mut().chain(piece.harmonics.as_flattened_mut());
                own.chain(course).zip(&mut next).for_each(|(to, number)| *to = number);
            }
            law.at(phi)
        };
        for phi in [0.3, 2.9, 4.0] {
            assert_eq!(with.at_numbers::<f64, 3>(phi, &start), lift.at::<f64, 3>(phi), "plain at {phi}");
            for way in 1..start.len() {
                let (mut low, mut high) = (start.clone(), start.clone());
                (low[way], high[way]) = (low[way] - 1e-5, high[way] + 1e-5);
                let mut q: Vec<Dual<f64>> = start.iter().copied().map(Dual::constant).collect();
                q[way].d = 1.0;
                let found: [Dual<f64>; 3] = with.at_numbers(Dual::constant(phi), &q);
                for ((found, low), high) in found.iter().zip(read(&low, phi)).zip(read(&high, phi)) {
                    let difference = (high - low) / 2e-5;
                    assert!(
                        (found.d - difference).abs() < 1e-8,
                        "{found:?} for {difference} by {way} at {phi}"
                    );
                }
            }
        }
        assert_eq!(with.start(1, &start), PI);
        assert_eq!(to_and_fro().jumps(), [false, false]);
    }

    #[test]
    fn pieces_must_make_a_turn() {
        assert!(MotionLaw::new(vec![cycloidal(0.0, PI, 0.0, 0.3)]).is_none(), "half a turn");
        let dwell = Piece { start: 0.0, length: TAU, polynomial: vec![5.0], harmonics: vec![] };
        let whole = MotionLaw::new(vec![dwell]).expect("a dwell");
        assert_eq!(whole.at::<f64, 2>(1.0), [5.0, 0.0], "a dwell");
        let half = |start, polynomial| Piece { start, length: PI, polynomial, harmonics: vec![] };
        let hops = MotionLaw::new(vec![half(0.0, vec![0.0, 4.0, -4.0]), half(PI, vec![0.0])]);
        assert_eq!(hops.expect("a whole turn").jumps(), [true, true], "a parabola meets a dwell");
    }
}
