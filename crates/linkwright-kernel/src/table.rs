//! Tables: values at knots, straight lines between, end values held outside or repeated every period.

use crate::real::{Lift, Real};

/// A table of `y` over increasing `x`.
#[derive(Clone, Debug)]
pub struct Table {
    x: Vec<f64>,
    y: Vec<f64>,
    /// First of the parameters that its values are as well, if they are: then its derivatives follow theirs.
    first: Option<usize>,
}

impl Table {
    /// From knots; `None` unless there are as many `y` as `x`, at least one, finite and increasing.
    pub fn new(x: &[f64], y: &[f64]) -> Option<Self> {
        let increasing = x.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = x.iter().chain(y).all(|v| v.is_finite());
        (!x.is_empty() && x.len() == y.len() && increasing && finite).then(|| Table {
            x: x.to_vec(),
            y: y.to_vec(),
            first: None,
        })
    }

    /// The table whose values are parameters as well, one behind the other from the first on.
    #[must_use]
    pub fn with_parameters(self, first: usize) -> Self {
        Table { first: Some(first), ..self }
    }

    /// The parameters that its values are.
    pub fn parameters(&self) -> std::ops::Range<usize> {
        self.first.map_or(0..0, |first| first..first.saturating_add(self.y.len()))
    }

    /// Value at `x`, the end values being held outside; derivatives by `x` and by the values.
    #[inline(always)]
    pub fn held_at<R: Real, N: Lift<R>>(&self, x: N, q: &[R]) -> N {
        self.value_at(x, q, None)
    }

    /// The same of the table repeated every `period`.
    #[inline(always)]
    pub fn periodic_at<R: Real, N: Lift<R>>(&self, x: N, period: f64, q: &[R]) -> N {
        self.value_at(x, q, Some(period))
    }

    #[inline(always)]
    fn value_at<R: Real, N: Lift<R>>(&self, x: N, q: &[R], period: Option<f64>) -> N {
        let value = x.map(
            #[inline(always)]
            |x| self.value(self.line(x, period)),
        );
        if N::IS_PLAIN || self.first.is_none() { value } else { self.with_values(value, x, q, period) }
    }

    /// A value with what its own values' derivatives add to it, by the share that each has in it.
    fn with_values<R: Real, N: Lift<R>>(&self, value: N, x: N, q: &[R], period: Option<f64>) -> N {
        let end = |of: fn(&Line) -> usize| x.map(|x| (of(&self.line(x, period)) as f64, 0.0));
        let [from, to] = [end(|line| line.from), end(|line| line.to)];
        let together = |ends: N| -(-ends).max_lane() == ends.max_lane();
        let moved = |sum: N, (i, slot): (usize, usize)| {
            let share = x.map(|x| Self::share(i, &self.line(x, period)));
            // Zero but for its derivatives.
            (N::lift(q[slot]) - self.y[i]).mul_add(share, sum)
        };
        let all = self.parameters().enumerate();
        if !(together(from) && together(to)) {
            return all.fold(value, moved);
        }
        let ends = [from, to].map(|ends| ends.max_lane() as usize);
        let count = if ends[0] == ends[1] { 1 } else { 2 };
        let slots = self.parameters();
        ends[..count].iter().map(|&i| (i, slots.start + i)).fold(value, moved)
    }

    /// Share of the value of a knot in that on a line, and its slope.
    fn share(i: usize, line: &Line) -> (f64, f64) {
        if line.from == line.to {
            return (f64::from(i == line.from), 0.0);
        }
        let ahead = (line.x - line.start) / line.width;
        match i {
            _ if i == line.from => (1.0 - ahead, -line.width.recip()),
            _ if i == line.to => (ahead, line.width.recip()),
            _ => (0.0, 0.0),
        }
    }

    /// The line that `x` lies on; a single knot where its value is held.
    fn line(&self, x: f64, period: Option<f64>) -> Line {
        let (first, last) = (self.x[0], self.x.len() - 1);
        let x = period.map_or(x, |period| first + (x - first).rem_euclid(period));
        let held = |i| Line { x, from: i, to: i, start: x, width: 0.0 };
        let between =
            |from: usize, to, end: f64| Line { x, from, to, start: self.x[from], width: end - self.x[from] };
        if x <= first || x.is_nan() {
            return held(0);
        }
        if x >= self.x[last] {
            return match period {
                Some(period) if first + period > self.x[last] => between(last, 0, first + period),
                Some(_) => held(0),
                None => held(last),
            };
        }
        let i = self.x.partition_point(|&knot| knot <= x) - 1;
        between(i, i + 1, self.x[i + 1])
    }

    /// Value and slope on a line.
    fn value(&self, line: Line) -> (f64, f64) {
        if line.x.is_nan() {
            return (f64::NAN, f64::NAN);
        }
        if line.from == line.to {
            return (self.y[line.from], 0.0);
        }
        let slope = (self.y[line.to] - self.y[line.from]) / line.width;
        (self.y[line.from] + slope * (line.x - line.start), slope)
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
        self.value(self.line(x, None))
    }

    /// Value and slope at `x`, the table being repeated every `period`.
    pub fn periodic(&self, x: f64, period: f64) -> (f64, f64) {
        self.value(self.line(x, Some(period)))
    }
}

/// A piece of a table, between two knots or held at one.
struct Line {
    /// Where it is read, within the period.
    x: f64,
    from: usize,
    to: usize,
    /// Place of the first knot, and of the second from there.
    start: f64,
    width: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use std::f64::consts::TAU;

    /// The values' shares make up the value, between knots, before, behind, and where it closes.
    #[test]
    fn a_value_is_the_sum_of_its_shares() {
        let (x, y) = ([0.5, 1.0, 3.0], [1.0, 3.0, -1.0]);
        let table = Table::new(&x, &y).expect("increasing knots").with_parameters(2);
        let of = |at: f64, period, part: fn((f64, f64)) -> f64| {
            (0..3).map(|i| part(Table::share(i, &table.line(at, period))) * y[i]).sum::<f64>()
        };
        let sum = |at, period| of(at, period, |share| share.0);
        let slopes = |at, period| of(at, period, |share| share.1);
        for at in [-1.0, 0.5, 0.7, 1.0, 2.9, 3.0, 4.0, 5.9, 6.2, 9.0] {
            let ((held, slope), (turned, slope_turned)) = (table.held(at), table.periodic(at, 4.0));
            assert!((sum(at, None) - held).abs() < 1e-15 && (slopes(at, None) - slope).abs() < 1e-15, "{at}");
            let (value, d1) = (sum(at, Some(4.0)), slopes(at, Some(4.0)));
            assert!((value - turned).abs() < 1e-14 && (d1 - slope_turned).abs() < 1e-14, "{at} of a turn");
        }
        let q = [0.0, 0.0, 1.0, 3.0, -1.0].map(|value| Dual { value, d: f64::from(value == 3.0) });
        let beside = table.held_at(Dual { value: 2.0, d: 0.0 }, &q);
        assert!((beside.value - 1.0).abs() < 1e-15 && (beside.d - 0.5).abs() < 1e-15, "{beside:?}");
    }

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
