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

use linkwright_kernel::real::Real;
use serde::{Deserialize, Serialize};

/// An odd curve from zero: cubics between points, straight beyond the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve<N = f64> {
    /// Twist, torque and slope of each point, the first at zero.
    points: Vec<[N; 3]>,
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
        Some(Curve { points: (0..n).map(|i| [x[i], y[i], slope[i]]).collect() })
    }
}

impl Curve {
    /// Work in a piece up to a distance from zero \[J\]: Simpson's rule is exact for cubics.
    fn work(&self, piece: usize, at: f64) -> f64 {
        let low = self.points[piece][0];
        let high = self.points.get(piece + 1).map_or(at, |end| at.min(end[0]));
        let torque = |at: f64| self.of_piece(piece, at)[0];
        (high - low) / 6.0 * (torque(low) + 4.0 * torque(0.5 * (low + high)) + torque(high))
    }
}

impl<N: Real> Curve<N> {
    /// Value and slope in a piece at a distance from zero; the last piece is the line beyond.
    #[inline(always)]
    fn of_piece(&self, piece: usize, at: N) -> [N; 2] {
        let [x, y, before] = self.points[piece];
        let z = at - x;
        let Some(&[end, high, after]) = self.points.get(piece + 1) else {
            return [y + z * before, before];
        };
        let inverse = (end - x).recip();
        let chord = (high - y) * inverse;
        let square = (chord * 3.0 - before * 2.0 - after) * inverse;
        let cube = (before + after - chord * 2.0) * inverse * inverse;
        [y + z * (before + z * (square + z * cube)), before + z * (square * 2.0 + z * cube * 3.0)]
    }
}

/// What a link does with its twist and its rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Law<N = f64> {
    /// k of a straight spring; of a curve the steepest slope \[N m/rad\].
    pub stiffness: N,
    /// c \[N m s/rad\].
    pub damping: N,
    /// Half of the backlash \[rad\].
    pub gap: N,
    /// The spring where it is not straight.
    pub curve: Option<Curve<N>>,
}

/// In which of its forms a law is. Between forms the torque is continuous and its slopes are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Zone {
    /// Piece of the spring, from 1 on, with the sign of the twist; 0 between the flanks.
    piece: i32,
    /// Whether the damper is held back: 1 where it doubles the spring, −1 where it cancels it, 0 where it is free.
    held: i8,
}

/// Torque of a link \[N m\], its slopes, and the part of the damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmitted<N = f64> {
    /// T.
    pub value: N,
    /// ∂T/∂Δ.
    pub by_twist: N,
    /// ∂T/∂Δ˙.
    pub by_rate: N,
    /// D.
    pub damper: N,
}

impl Law {
    /// A spring with a damper.
    pub fn linear(stiffness: f64, damping: f64) -> Self {
        Law { stiffness, damping, gap: 0.0, curve: None }
    }

    /// The same law with other numbers, in their order.
    pub(crate) fn with<N: Real>(&self, next: &mut impl FnMut() -> N) -> Law<N> {
        let [stiffness, damping, gap] = [next(), next(), next()];
        let curve = self
            .curve
            .as_ref()
            .map(|curve| Curve { points: curve.points.iter().map(|_| [next(), next(), next()]).collect() });
        Law { stiffness, damping, gap, curve }
    }
}

impl Law {
    /// Twists between which a form holds \[rad\].
    pub fn bounds(&self, zone: Zone) -> [f64; 2] {
        if self.is_linear() {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        let Some(piece) = (zone.piece.unsigned_abs() as usize).checked_sub(1) else {
            return [-self.gap, self.gap];
        };
        let point = |at: usize| match &self.curve {
            None => (at == 0).then_some(0.0),
            Some(curve) => curve.points.get(at).map(|point| point[0]),
        };
        let [low, high] = [piece, piece + 1].map(|at| point(at).map_or(f64::INFINITY, |x| self.gap + x));
        if zone.piece < 0 { [-high, -low] } else { [low, high] }
    }

    /// The form behind the upper or the lower end of one, which the twist passes with a rate.
    pub fn beyond(&self, zone: Zone, way: i32, rate: f64) -> Zone {
        let piece = zone.piece + way;
        if piece == 0 && self.gap > 0.0 {
            return Zone { piece, held: 0 };
        }
        let piece = if piece == 0 { way } else { piece };
        // At contact the spring has no torque: a damper that would add to it doubles it.
        let meets = zone.piece == 0 && self.damping * rate * f64::from(piece) > 0.0;
        Zone { piece, held: if meets { 1 } else { zone.held } }
    }

    /// Side on which the damper is of the torque of the spring, or of its opposite: positive where it exceeds it away from the
    /// middle; nothing where there is no such limit.
    pub fn over_spring(&self, zone: Zone, twist: f64, rate: f64, limit: i8) -> f64 {
        let sign = f64::from(zone.piece.signum());
        sign * (self.damping * rate - f64::from(limit) * self.spring(zone, twist)[0])
    }

    /// Sign of [`Law::over_spring`] in a form; 0 where the limit is not the next one.
    pub fn side_of_limit(&self, zone: Zone, limit: i8) -> f64 {
        match zone.held {
            _ if zone.piece == 0 => 0.0,
            0 => f64::from(-limit),
            held if held == limit => f64::from(limit),
            _ => 0.0,
        }
    }

    /// The form behind a limit of the damper.
    pub fn behind_limit(&self, zone: Zone, limit: i8) -> Zone {
        Zone { held: if zone.held == 0 { limit } else { 0 }, ..zone }
    }

    /// Whether its damper is held back somewhere.
    pub fn has_limits(&self) -> bool {
        self.gap > 0.0 && self.damping > 0.0
    }

    /// What its spring stores at a twist \[J\].
    pub fn stored(&self, twist: f64) -> f64 {
        let over = (twist.abs() - self.gap).max(0.0);
        let Some(curve) = &self.curve else { return 0.5 * self.stiffness * over * over };
        let pieces = curve.points.iter().enumerate().take_while(|(_, point)| point[0] < over);
        pieces.map(|(piece, _)| curve.work(piece, over)).sum()
    }
}

impl<N: Real> Law<N> {
    /// Whether it is a straight spring with a damper.
    #[inline(always)]
    pub fn is_linear(&self) -> bool {
        self.curve.is_none() && self.gap.max_lane() == 0.0
    }

    /// Appends its numbers to a list.
    pub(crate) fn add_numbers(&self, list: &mut Vec<N>) {
        list.extend([self.stiffness, self.damping, self.gap]);
        if let Some(curve) = &self.curve {
            list.extend(curve.points.iter().flatten());
        }
    }

    /// Its form at a twist and a rate, the same in all lanes.
    #[inline(always)]
    pub fn zone(&self, twist: N, rate: N) -> Zone {
        if self.is_linear() {
            return Zone { piece: 1, held: 0 };
        }
        let (at, gap) = (twist.max_lane(), self.gap.max_lane());
        let over = at.abs() - gap;
        if gap > 0.0 && over <= 0.0 {
            return Zone { piece: 0, held: 0 };
        }
        let piece = self
            .curve
            .as_ref()
            .map_or(1, |curve| curve.points.partition_point(|point| point[0].max_lane() <= over).max(1));
        let free = Zone { piece: if at < 0.0 { -(piece as i32) } else { piece as i32 }, held: 0 };
        if gap == 0.0 {
            return free;
        }
        let (spring, damper) = (self.spring(free, twist)[0].max_lane(), (self.damping * rate).max_lane());
        let held = if damper.abs() < spring.abs() {
            0
        } else if (damper > 0.0) == (spring > 0.0) {
            1
        } else {
            -1
        };
        Zone { held, ..free }
    }

    /// Torque of the spring and its slope in a form.
    #[inline(always)]
    pub fn spring(&self, zone: Zone, twist: N) -> [N; 2] {
        if zone.piece == 0 {
            return [N::splat(0.0); 2];
        }
        let sign = f64::from(zone.piece.signum());
        let over = twist * sign - self.gap;
        match &self.curve {
            // A straight spring without backlash has no sides.
            None if self.is_linear() => [self.stiffness * twist, self.stiffness],
            None => [self.stiffness * over * sign, self.stiffness],
            Some(curve) => {
                let [value, slope] = curve.of_piece(zone.piece.unsigned_abs() as usize - 1, over);
                [value * sign, slope]
            }
        }
    }

    /// The torque of a form, also where the law is in another.
    #[inline(always)]
    pub fn of_zone(&self, zone: Zone, twist: N, rate: N) -> Transmitted<N> {
        let [spring, slope] = self.spring(zone, twist);
        let zero = N::splat(0.0);
        if zone.piece == 0 {
            return Transmitted { value: zero, by_twist: zero, by_rate: zero, damper: zero };
        }
        match zone.held {
            0 => {
                let damper = self.damping * rate;
                Transmitted { value: spring + damper, by_twist: slope, by_rate: self.damping, damper }
            }
            held => {
                let share = f64::from(held);
                let damper = spring * share;
                Transmitted { value: spring + damper, by_twist: slope * (1.0 + share), by_rate: zero, damper }
            }
        }
    }

    /// Torque at a twist and a rate.
    #[inline(always)]
    pub fn torque(&self, twist: N, rate: N) -> Transmitted<N> {
        self.of_zone(self.zone(twist, rate), twist, rate)
    }
}
