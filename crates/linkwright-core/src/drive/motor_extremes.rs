//! Extremes of the motor's torque and power in a steady motion.
//!
//! In one revolution the speed takes every value between its extremes, and the torque depends on the speed alone. Between
//! the speeds at which the characteristic bends or turns, torque and power have one maximum at most.

use crate::drive::motor::{Drive, Motor};
use crate::drive::structure::Plan;
use crate::kernel::table::Table;

/// Share of an interval beside its ends: what rises from both has its maximum between them. One that is nearer to an end is met
/// there to the square of this.
const BESIDE: f64 = 1e-6;

/// Parts of an interval at whose ends a maximum is looked for, and how often between the neighbours of the best: 1e-9 of the
/// interval in the end, and a smooth maximum is met to the square of that.
const PARTS: usize = 64;
const ZOOMS: usize = 7;

/// Extremes over some range of the speed.
#[derive(Clone, Copy, Debug)]
pub struct MotorExtremes {
    /// Torque at the motor's shaft \[N m\].
    pub torque_min: f64,
    pub torque_max: f64,
    /// Power \[W\].
    pub power_max: f64,
}

impl Plan {
    /// Extremes of the motor between two speeds of the crank \[rad/s\].
    pub fn motor_extremes(&self, q: &[f64], low: f64, high: f64) -> MotorExtremes {
        let ratio = q[self.drive.ratio];
        let mut ends = vec![low];
        ends.extend(self.drive.motor_marks(&self.tables, q).into_iter().filter(|&at| low < at && at < high));
        ends.push(high);
        let torque = |omega: f64| self.drive.motor_torque::<f64, f64>(&self.tables, q, omega);
        MotorExtremes {
            torque_min: -highest(|omega| -torque(omega), &ends),
            torque_max: highest(torque, &ends),
            power_max: highest(|omega| torque(omega) * omega * ratio, &ends),
        }
    }
}

impl Drive {
    /// Speeds of the crank between which the motor's torque is smooth and turns once at most, increasing \[rad/s\].
    fn motor_marks(&self, tables: &[Table], q: &[f64]) -> Vec<f64> {
        let mut marks = match &self.motor {
            Motor::Off | Motor::Constant { .. } | Motor::Line { .. } => Vec::new(),
            Motor::Induction { inverse_synchronous, slip, spans, .. } => {
                let breakdown = (1.0 - q[*slip]) / q[*inverse_synchronous];
                spans.iter().map(|span| q[span.x1]).chain([breakdown]).collect()
            }
            Motor::Table { table } => tables[*table].knots().to_vec(),
        };
        marks.iter_mut().for_each(|speed| *speed /= q[self.ratio]);
        marks.sort_by(f64::total_cmp);
        marks
    }
}

/// Maximum of a function that has one at most between neighbouring ends.
fn highest(of: impl Fn(f64) -> f64, ends: &[f64]) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for pair in ends.windows(2) {
        let (low, high, near) = (pair[0], pair[1], (pair[1] - pair[0]) * BESIDE);
        let [start, beside_start, beside_end, end] = [low, low + near, high - near, high].map(&of);
        best = best.max(start).max(beside_start).max(beside_end).max(end);
        if beside_start > start && beside_end > end {
            best = best.max(peak(&of, low, high));
        }
    }
    best
}

/// Maximum of a function that has one between two ends.
fn peak(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for _ in 0..ZOOMS {
        let at = |i: usize| low + (high - low) * (i as f64 / PARTS as f64);
        let (mut top, mut highest) = (0, f64::NEG_INFINITY);
        for i in 0..=PARTS {
            let value = of(at(i));
            if value > highest {
                (top, highest) = (i, value);
            }
        }
        best = best.max(highest);
        (low, high) = (at(top.saturating_sub(1)), at((top + 1).min(PARTS)));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maximum_is_found_inside_at_a_mark_and_at_an_end() {
        let inside = |x: f64| 3.0 - (x - 1.7) * (x - 1.7);
        // Rounding of a smooth maximum.
        assert!((highest(inside, &[1.0, 4.0]) - 3.0).abs() < 1e-15, "inside");
        let roof = |x: f64| 2.0 - (x - 2.5).abs();
        assert_eq!(highest(roof, &[1.0, 2.5, 4.0]), 2.0, "at a mark");
        assert_eq!(highest(|x: f64| x, &[1.0, 2.0]), 2.0, "at an end");
        assert_eq!(highest(inside, &[1.7, 1.7]), 3.0, "of one speed");
    }
}
