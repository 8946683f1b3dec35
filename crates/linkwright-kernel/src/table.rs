//! Tables: values at knots, straight lines between, end values held outside or repeated every period.

/// A table of `y` over increasing `x`.
#[derive(Clone, Debug)]
pub struct Table {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Table {
    /// From knots; `None` unless there are as many `y` as `x`, at least one, finite and increasing.
    pub fn new(x: &[f64], y: &[f64]) -> Option<Self> {
        let increasing = x.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = x.iter().chain(y).all(|v| v.is_finite());
        (!x.is_empty() && x.len() == y.len() && increasing && finite)
            .then(|| Table { x: x.to_vec(), y: y.to_vec() })
    }

    /// The knots.
    pub fn knots(&self) -> &[f64] {
        &self.x
    }

    /// The end of the last line along which the table changes in the direction of `sign`; 0 without any.
    pub fn last_change(&self, sign: f64) -> f64 {
        let changes = |i: &usize| sign * (self.y[*i] - self.y[*i - 1]) > 0.0;
        (1..self.x.len()).rev().find(changes).map_or(0.0, |i| self.x[i])
    }

    /// Value and slope at `x`; the end values are held outside.
    pub fn held(&self, x: f64) -> (f64, f64) {
        let n = self.x.len();
        if x.is_nan() {
            return (f64::NAN, f64::NAN);
        }
        if x <= self.x[0] {
            return (self.y[0], 0.0);
        }
        if x >= self.x[n - 1] {
            return (self.y[n - 1], 0.0);
        }
        let i = self.x.partition_point(|&knot| knot <= x) - 1;
        between(x, (self.x[i], self.y[i]), (self.x[i + 1], self.y[i + 1]))
    }

    /// Value and slope at `x`, the table being repeated every `period`.
    pub fn periodic(&self, x: f64, period: f64) -> (f64, f64) {
        let n = self.x.len();
        let (first, last) = (self.x[0], self.x[n - 1]);
        let x = first + (x - first).rem_euclid(period);
        if x >= last {
            let closing = (first + period, self.y[0]);
            return if closing.0 > last {
                between(x, (last, self.y[n - 1]), closing)
            } else {
                (self.y[0], 0.0)
            };
        }
        self.held(x)
    }
}

fn between(x: f64, a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let slope = (b.1 - a.1) / (b.0 - a.0);
    (a.1 + slope * (x - a.0), slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn ends_are_held_and_turns_repeat() {
        let table = Table::new(&[0.0, 1.0, 3.0], &[1.0, 3.0, -1.0]).expect("increasing knots");
        assert_eq!(table.held(0.5), (2.0, 2.0), "between knots");
        assert_eq!(table.held(-1.0), (1.0, 0.0), "before the first");
        assert_eq!(table.held(9.0), (-1.0, 0.0), "after the last");
        let (value, _) = table.periodic(0.5 + 3.0 * TAU, TAU);
        assert!((value - 2.0).abs() < 1e-14, "three turns on: {value}");
        let (closing, _) = table.periodic(-1e-12, TAU);
        assert!((closing - 1.0).abs() < 1e-11, "meets the first knot: {closing}");
        let (longer, _) = table.periodic(2.0 * TAU + 2.0, 2.0 * TAU);
        assert!((longer - 1.0).abs() < 1e-14, "two turns are one period: {longer}");
    }

    #[test]
    fn bad_tables_are_refused() {
        assert!(Table::new(&[0.0, 0.0], &[1.0, 2.0]).is_none(), "equal knots");
        assert!(Table::new(&[], &[]).is_none(), "empty");
        assert!(Table::new(&[0.0], &[f64::NAN]).is_none(), "not finite");
    }
}
