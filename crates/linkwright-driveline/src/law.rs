//! Torque of a link over its twist and the rate of its twist.
//!
//! ```text
//! T = S(Δ) + D,   S: spring, straight or by a curve, behind half of the backlash on either side
//! D = c Δ˙ without backlash;   D = c Δ˙ within −|S| … |S| with backlash
//! ```
//!
//! With backlash the damper acts in contact only and never pulls: T has the sign of S, and is zero between the flanks. It grows from
//! zero at contact, so that the torque is continuous in twist and rate, and with it the vector field.
//!
//! Source: Modelica Standard Library 4.0, `Modelica.Mechanics.Rotational.Components.ElastoBacklash`; curves: Fritsch, Butland,
//! *SIAM J. Sci. Stat. Comput.* 5 (1984) 300–304.

/// An odd curve from zero: cubics between points, straight beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Twists of the points, the first zero \[rad\].
    x: Vec<f64>,
    /// Powers 0 to 3 of the distance from the left point; the last piece is the line beyond.
    pieces: Vec<[f64; 4]>,
}

impl Curve {
    /// Through points from zero with slopes there; `None` unless they increase from zero and are as many of each.
    pub fn new(x: &[f64], y: &[f64], slope: &[f64]) -> Option<Self> {
        let n = x.len();
        let rise = |list: &[f64]| {
            list.first() == Some(&0.0) && list.windows(2).all(|p| p[0] < p[1] && p[1].is_finite())
        };
        if n < 2 || y.len() != n || slope.len() != n || !rise(x) || !rise(y) {
            return None;
        }
        let cubic = |i: usize| {
            let h = x[i] - x[i - 1];
            let (chord, before, after) = ((y[i] - y[i - 1]) / h, slope[i - 1], slope[i]);
            [
                y[i - 1],
                before,
                (3.0 * chord - 2.0 * before - after) / h,
                (before + after - 2.0 * chord) / (h * h),
            ]
        };
        let mut pieces: Vec<_> = (1..n).map(cubic).collect();
        pieces.push([y[n - 1], slope[n - 1], 0.0, 0.0]);
        Some(Curve { x: x.to_vec(), pieces })
    }

    /// Value and slope in a piece at a distance from zero.
    fn of_piece(&self, piece: usize, at: f64) -> [f64; 2] {
        let z = at - self.x[piece];
        let [a, b, c, d] = self.pieces[piece];
        [a + z * (b + z * (c + z * d)), b + z * (2.0 * c + 3.0 * z * d)]
    }
}

/// What a link does with its twist and its rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// k of a straight spring; of a curve the steepest slope \[N m/rad\].
    pub stiffness: f64,
    /// c \[N m s/rad\].
    pub damping: f64,
    /// Half of the backlash \[rad\].
    pub gap: f64,
    /// The spring where it is not straight.
    pub curve: Option<Curve>,
}

/// In which of its forms a law is. Between forms the torque is continuous and its slopes are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zone {
    /// Piece of the spring, from 1 on, with the sign of the twist; 0 between the flanks.
    piece: i32,
    /// Whether the damper is held back: 1 where it doubles the spring, −1 where it cancels it, 0 where it is free.
    held: i8,
}

/// Torque of a link \[N m\], its slopes, and the part of the damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torque {
    /// T.
    pub value: f64,
    /// ∂T/∂Δ.
    pub by_twist: f64,
    /// ∂T/∂Δ˙.
    pub by_rate: f64,
    /// D.
    pub damper: f64,
}

impl Law {
    /// A spring with a damper.
    pub fn linear(stiffness: f64, damping: f64) -> Self {
        Law { stiffness, damping, gap: 0.0, curve: None }
    }

    /// Whether it is a straight spring with a damper.
    pub fn is_linear(&self) -> bool {
        self.gap == 0.0 && self.curve.is_none()
    }

    /// Appends its numbers to a list.
    pub(crate) fn add_numbers(&self, list: &mut Vec<f64>) {
        list.extend([self.stiffness, self.damping, self.gap]);
        if let Some(curve) = &self.curve {
            list.extend(curve.x.iter().chain(curve.pieces.iter().flatten()));
        }
    }

    /// Gives it other numbers, in the same order.
    pub(crate) fn set_numbers(&mut self, next: &mut impl FnMut(&mut f64)) {
        [&mut self.stiffness, &mut self.damping, &mut self.gap].into_iter().for_each(&mut *next);
        if let Some(curve) = &mut self.curve {
            curve.x.iter_mut().chain(curve.pieces.iter_mut().flatten()).for_each(next);
        }
    }

    /// Its form at a twist and a rate.
    pub fn zone(&self, twist: f64, rate: f64) -> Zone {
        let over = twist.abs() - self.gap;
        if self.is_linear() {
            return Zone { piece: 1, held: 0 };
        }
        if self.gap > 0.0 && over <= 0.0 {
            return Zone { piece: 0, held: 0 };
        }
        let piece = self.curve.as_ref().map_or(1, |curve| curve.x.partition_point(|&x| x <= over).max(1));
        let piece = if twist < 0.0 { -(piece as i32) } else { piece as i32 };
        let free = Zone { piece, held: 0 };
        if self.gap == 0.0 {
            return free;
        }
        let (spring, damper) = (self.spring(free, twist)[0], self.damping * rate);
        let held = if damper.abs() < spring.abs() {
            0
        } else if (damper > 0.0) == (spring > 0.0) {
            1
        } else {
            -1
        };
        Zone { piece, held }
    }

    /// Torque of the spring and its slope in a form.
    fn spring(&self, zone: Zone, twist: f64) -> [f64; 2] {
        if zone.piece == 0 {
            return [0.0; 2];
        }
        let sign = f64::from(zone.piece.signum());
        let over = sign * twist - self.gap;
        match &self.curve {
            // A straight spring without backlash has no sides.
            None if self.gap == 0.0 => [self.stiffness * twist, self.stiffness],
            None => [sign * self.stiffness * over, self.stiffness],
            Some(curve) => {
                let [value, slope] = curve.of_piece(zone.piece.unsigned_abs() as usize - 1, over);
                [sign * value, slope]
            }
        }
    }

    /// The torque of a form, also where the law is in another.
    pub fn of_zone(&self, zone: Zone, twist: f64, rate: f64) -> Torque {
        let [spring, slope] = self.spring(zone, twist);
        if zone.piece == 0 {
            return Torque { value: 0.0, by_twist: 0.0, by_rate: 0.0, damper: 0.0 };
        }
        match zone.held {
            0 => {
                let damper = self.damping * rate;
                Torque { value: spring + damper, by_twist: slope, by_rate: self.damping, damper }
            }
            held => {
                let share = f64::from(held);
                let damper = share * spring;
                Torque { value: spring + damper, by_twist: (1.0 + share) * slope, by_rate: 0.0, damper }
            }
        }
    }

    /// Torque at a twist and a rate.
    pub fn torque(&self, twist: f64, rate: f64) -> Torque {
        self.of_zone(self.zone(twist, rate), twist, rate)
    }
}
