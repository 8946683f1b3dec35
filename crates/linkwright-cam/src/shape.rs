//! A cam over the whole revolution: contacts at many angles, extremes and zeros located to rounding.
//!
//! Each piece of the law is looked at by itself, both ends included: a derivative that jumps at a joint has two
//! values there, and both count. Between neighbouring angles an extreme is a zero of the exact derivative (dual
//! numbers), and every zero is enclosed before it is refined.

use super::{Cam, Contact, Kind};
use linkwright_kernel::dual::Dual;
use linkwright_kernel::jet::Jet;
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::motion_law::{MotionLaw, Piece};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// What is known at each angle.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Cam angles, increasing; each joint of the law twice, from before and from after.
    pub phi: Vec<f64>,
    /// Piece of the law that each angle belongs to.
    pub piece: Vec<u32>,
    /// One row each of [`ROWS`].
    pub rows: Vec<Vec<f64>>,
}

/// Lift and derivatives; pitch point and normal seen from the cam; pressure angle; bend, soundness and place
/// along the face as in [`super`].
pub const ROWS: usize = NAMES.len();

/// Names of the rows in their order.
pub const NAMES: [&str; 12] = [
    "lift",
    "lift_d1",
    "lift_d2",
    "lift_d3",
    "pitch_x",
    "pitch_y",
    "normal_x",
    "normal_y",
    "pressure_angle",
    "bend",
    "soundness",
    "along",
];

/// Quantities whose extremes and zeros are located.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// γ.
    PressureAngle,
    /// Curvature of the pitch curve, or radius of curvature under a flat face.
    Bend,
    /// Place of the contact on a flat face.
    Along,
}

/// Where a quantity is largest or smallest, and its value there.
#[derive(Clone, Copy, Debug)]
pub struct Extreme {
    pub phi: f64,
    pub value: f64,
}

/// Angles of a piece, both ends included: its share of n per revolution.
pub(super) fn angles(piece: &Piece, n: usize) -> impl Iterator<Item = f64> + use<> {
    let steps = ((n as f64 * piece.length / TAU).round() as usize).max(LEAST);
    let (start, step) = (piece.start, piece.length / steps as f64);
    (0..=steps).map(move |i| start + step * i as f64)
}

/// Minimum number of intervals in a piece; a shorter one still shows its extremes.
const LEAST: usize = 16;

impl Cam<f64> {
    /// Contacts at about n angles per revolution, piece by piece, in lanes.
    pub fn shape(&self, law: &MotionLaw, n: usize) -> Shape {
        in_lanes(Sampling { cam: self, law, n })
    }

    /// A curve seen from the cam, `away` from the pitch curve along its normal: place, and first and second
    /// derivative by the cam angle.
    pub fn curve(&self, piece: &Piece, phi: f64, away: f64) -> [[f64; 2]; 3] {
        let cam = self.map(Jet::<f64, 3>::constant);
        let at = Jet::variable(phi);
        let contact = cam.contact(piece.at(at));
        let [p] = cam.from_cam([contact.pitch.plus(contact.normal, Jet::constant(away))], at);
        [[p.x.c[0], p.y.c[0]], [p.x.c[1], p.y.c[1]], [2.0 * p.x.c[2], 2.0 * p.y.c[2]]]
    }

    /// All rows at cam angles, at a joint from after it, or from `before`: row by row into `to`.
    pub fn rows(&self, law: &MotionLaw, phi: &[f64], before: bool, to: &mut [f64]) {
        row_by_row(phi, to, |phi| {
            let (piece, at) = law.piece(phi, before);
            self.row(piece, at)
        });
    }

    /// The same of a curve `away` from the pitch curve: x, y, and their first and second derivatives.
    pub fn curves(&self, law: &MotionLaw, phi: &[f64], before: bool, away: f64, to: &mut [f64]) {
        row_by_row(phi, to, |phi| {
            let (piece, at) = law.piece(phi, before);
            let [[x, y], [x1, y1], [x2, y2]] = self.curve(piece, at, away);
            [x, y, x1, y1, x2, y2]
        });
    }

    /// A quantity and its derivative by the cam angle.
    fn quantity(&self, what: Quantity, piece: &Piece, phi: f64) -> (f64, f64) {
        let cam = self.map(Dual::constant);
        let contact = cam.contact(piece.at(Dual { value: phi, d: 1.0 }));
        let found = what.of(&contact);
        (found.value, found.d)
    }

    /// The maximum of sign·quantity over the revolution.
    pub fn extreme(&self, what: Quantity, sign: f64, law: &MotionLaw, shape: &Shape) -> Extreme {
        let values: Vec<f64> = what.column(shape).iter().map(|x| sign * x).collect();
        let mut best = Extreme { phi: f64::NAN, value: f64::NEG_INFINITY };
        for (&phi, &value) in shape.phi.iter().zip(&values) {
            if value > best.value {
                best = Extreme { phi, value };
            }
        }
        let inner = peaks(&values, &shape.piece, best.value).into_iter().map(|i| (i - 1, i + 1));
        for (low, high) in inner.chain(edges(&shape.piece)) {
            let piece = &law.pieces()[shape.piece[low] as usize];
            let slope = |phi: f64| sign * self.quantity(what, piece, phi).1;
            if slope(shape.phi[low]) > 0.0 && slope(shape.phi[high]) < 0.0 {
                let phi = zero(slope, shape.phi[low], shape.phi[high]);
                let value = sign * self.quantity(what, piece, phi).0;
                if value > best.value {
                    best = Extreme { phi, value };
                }
            }
        }
        Extreme { phi: best.phi, value: sign * best.value }
    }

    /// Angles where a sampled row passes a level, with the sign of what comes after: +1 where it is above.
    /// A joint where it jumps over the level counts as such, also that of the last piece with the first.
    pub fn passes(&self, row: usize, level: f64, law: &MotionLaw, shape: &Shape) -> Vec<(f64, f64)> {
        let (values, n) = (&shape.rows[row], shape.phi.len());
        let mut found = Vec::new();
        for i in 0..n {
            let before = (i + n - 1) % n;
            let (a, b) = (values[before] - level, values[i] - level);
            if (a < 0.0) == (b < 0.0) || a.is_nan() || b.is_nan() {
                continue;
            }
            let piece = &law.pieces()[shape.piece[i] as usize];
            let phi = if i > 0 && shape.piece[i] == shape.piece[before] {
                zero(|phi| self.row(piece, phi)[row] - level, shape.phi[before], shape.phi[i])
            } else {
                shape.phi[i]
            };
            found.push((phi, if b < 0.0 { -1.0 } else { 1.0 }));
        }
        found
    }
}

impl<R: Real> Cam<R> {
    /// All rows at angles of a piece.
    #[inline(always)]
    pub fn row(&self, piece: &Piece, phi: R) -> [R; ROWS] {
        self.row_of(piece.at(phi), phi)
    }

    /// The same where lift and its first three derivatives are known.
    #[inline(always)]
    pub fn row_of(&self, [s, s1, s2, s3]: [R; 4], phi: R) -> [R; ROWS] {
        let contact = self.contact([s, s1, s2]);
        let [pitch, normal] = self.from_cam([contact.pitch, contact.normal], phi);
        let gamma = contact.lead.y.atan2(contact.lead.x);
        let sound = self.soundness(&contact);
        [s, s1, s2, s3, pitch.x, pitch.y, normal.x, normal.y, gamma, contact.bend, sound, contact.along]
    }
}

/// The numbers of each angle as columns of N rows end to end.
fn row_by_row<const N: usize>(phi: &[f64], to: &mut [f64], numbers: impl Fn(f64) -> [f64; N]) {
    for (i, &phi) in phi.iter().enumerate() {
        for (k, x) in numbers(phi).into_iter().enumerate() {
            to[k * (to.len() / N) + i] = x;
        }
    }
}

/// All angles of a shape; a lane is an angle.
struct Sampling<'a> {
    cam: &'a Cam<f64>,
    law: &'a MotionLaw,
    n: usize,
}

impl Job for Sampling<'_> {
    type Output = Shape;

    #[inline(always)]
    fn run<R: Real>(self) -> Shape {
        let cam = self.cam.map(
            #[inline(always)]
            |x| R::splat(x),
        );
        let mut shape = Shape::default();
        for (number, piece) in self.law.pieces().iter().enumerate() {
            shape.phi.extend(angles(piece, self.n));
            shape.piece.resize(shape.phi.len(), number as u32);
        }
        let n = shape.phi.len();
        // Lanes may reach beyond the last angle.
        shape.rows = vec![vec![0.0; n + R::LANES]; ROWS];
        shape.phi.resize(n + R::LANES, 0.0);
        let mut at = 0;
        for (number, piece) in self.law.pieces().iter().enumerate() {
            let end = at + shape.piece[at..].partition_point(|&each| each == number as u32);
            // What a bundle writes beyond its piece, the next piece writes over.
            for first in (at..end).step_by(R::LANES) {
                let rows = out_of_line!(R, cam.row(piece, R::load(&shape.phi[first..])));
                for (to, x) in shape.rows.iter_mut().zip(rows) {
                    x.store(&mut to[first..]);
                }
            }
            at = end;
        }
        shape.phi.truncate(n);
        shape.rows.iter_mut().for_each(|row| row.truncate(n));
        shape
    }
}

impl Quantity {
    fn of<R: Real>(self, contact: &Contact<R>) -> R {
        match self {
            Quantity::PressureAngle => contact.lead.y.atan2(contact.lead.x),
            Quantity::Bend => contact.bend,
            Quantity::Along => contact.along,
        }
    }

    /// The same from a shape.
    fn column(self, shape: &Shape) -> &[f64] {
        match self {
            Quantity::PressureAngle => &shape.rows[8],
            Quantity::Bend => &shape.rows[9],
            Quantity::Along => &shape.rows[11],
        }
    }

    /// The name of its row.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::PressureAngle => "pressure_angle",
            Quantity::Bend => "bend",
            Quantity::Along => "along",
        }
    }

    /// All that a kind of follower has.
    pub fn of_kind(kind: Kind) -> &'static [Quantity] {
        if kind.is_roller() {
            &[Quantity::PressureAngle, Quantity::Bend]
        } else {
            &[Quantity::PressureAngle, Quantity::Bend, Quantity::Along]
        }
    }
}

/// Samples inside pieces that are higher than the one before and not lower than the one after, and whose
/// parabola reaches the highest sample.
fn peaks(values: &[f64], piece: &[u32], highest: f64) -> Vec<usize> {
    let is_peak = |v: &[f64]| v[1] > v[0] && v[1] >= v[2];
    // The parabola may fall short of the peak: one that nearly reaches is looked at too.
    let nearly = |v: &[f64]| {
        let bend = 2.0 * v[1] - v[0] - v[2];
        let more = if bend > 0.0 { (v[2] - v[0]).powi(2) / (8.0 * bend) } else { 0.0 };
        v[1] + more + more.abs() >= highest
    };
    let looked_at = values.windows(3).zip(piece.windows(3)).enumerate();
    looked_at.filter(|(_, (v, p))| is_peak(v) && p[0] == p[2] && nearly(v)).map(|(i, _)| i + 1).collect()
}

/// The first and the last interval of each piece: a peak in it may lie above neighbours of which the end is the higher.
fn edges(piece: &[u32]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let n = piece.len();
    (1..n)
        .filter(move |&i| {
            let first = i == 1 || piece[i - 2] != piece[i - 1];
            let last = i + 1 == n || piece[i + 1] != piece[i];
            piece[i - 1] == piece[i] && (first || last)
        })
        .map(|i| (i - 1, i))
}

/// A zero between two angles where the signs differ, else the end where the function is nearest to zero.
///
/// # Source
/// Chandrupatla, *Advances in Engineering Software* 28 (1997) 145–149.
pub fn zero(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut a, mut b) = (high, low);
    let (mut fa, mut fb) = (f(a), f(b));
    if (fa < 0.0) == (fb < 0.0) {
        return if fa.abs() <= fb.abs() { a } else { b };
    }
    let mut share = 0.5;
    for _ in 0..ROUNDS {
        let x = a + share * (b - a);
        let fx = f(x);
        let (c, fc) = if (fx < 0.0) == (fa < 0.0) {
            (a, fa)
        } else {
            let old = (b, fb);
            (b, fb) = (a, fa);
            old
        };
        (a, fa) = (x, fx);
        let near = if fa.abs() < fb.abs() { a } else { b };
        let least = (2.0 * f64::EPSILON * near.abs() + 1e-16) / (b - a).abs();
        if least > 0.5 || fa == 0.0 || fb == 0.0 {
            break;
        }
        share = inverse_quadratic([a, b, c], [fa, fb, fc]).clamp(least, 1.0 - least);
    }
    if fa.abs() < fb.abs() { a } else { b }
}

/// Rounds at most; bisection alone, from a degree to rounding, needs 50.
const ROUNDS: usize = 100;

/// Where between a and b to look next: by inverse quadratic interpolation where that is safe, else in the middle.
fn inverse_quadratic([a, b, c]: [f64; 3], [fa, fb, fc]: [f64; 3]) -> f64 {
    let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
    if phi * phi < xi && (1.0 - phi).powi(2) < 1.0 - xi {
        fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    } else {
        0.5
    }
}
