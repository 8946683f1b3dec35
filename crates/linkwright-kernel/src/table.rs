//! Tables: values at knots, straight lines between, end values held outside or repeated every period.

use crate::out_of_line;
use crate::real::{Lift, Real};
use serde::{Deserialize, Serialize};

/// A table of `y` over increasing `x`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Table {
    x: Vec<f64>,
    y: Vec<f64>,
    /// First of the parameters that its points are as well, if they are: then its derivatives follow theirs.
    first: Option<usize>,
}

/// A place of a table, and the parameter that it is as well, if it is one.
#[derive(Clone, Copy, Debug)]
pub struct Knot {
    /// The place.
    pub x: f64,
    slot: Option<usize>,
}

/// Knots at one place are one, whatever moves them.
impl PartialEq for Knot {
    fn eq(&self, other: &Self) -> bool {
        self.x == other.x
    }
}

impl Knot {
    /// The place as a number of the machine; it moves with its parameter.
    #[inline(always)]
    pub fn number<R: Real>(&self, q: &[R]) -> R {
        number(self.x, self.slot, q)
    }
}

/// A number that may be a parameter as well, which duals alone read.
#[inline(always)]
fn number<R: Real>(value: f64, slot: Option<usize>, q: &[R]) -> R {
    match slot {
        Some(slot) if R::IS_DUAL => q[slot],
        _ => R::splat(value),
    }
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

    /// The table whose points are parameters as well, one behind the other from the first on: all places, then all values.
    #[must_use]
    pub fn with_parameters(self, first: usize) -> Self {
        Table { first: Some(first), ..self }
    }

    /// The parameters that its points are.
    pub fn parameters(&self) -> std::ops::Range<usize> {
        self.first.map_or(0..0, |first| first..first.saturating_add(2 * self.y.len()))
    }

    /// Its places, which may move.
    pub fn moving_knots(&self) -> impl Iterator<Item = Knot> + '_ {
        self.x.iter().enumerate().map(|(i, &x)| Knot { x, slot: self.first.map(|first| first + i) })
    }

    /// Its points, place and value, as numbers of the machine.
    #[inline(always)]
    pub fn points<R: Real>(&self, q: &[R]) -> impl Iterator<Item = [R; 2]> {
        (0..self.x.len()).map(|i| self.point(i, q))
    }

    #[inline(always)]
    fn point<R: Real>(&self, i: usize, q: &[R]) -> [R; 2] {
        let slot = |of: usize| self.first.map(|first| first + of * self.x.len() + i);
        [number(self.x[i], slot(0), q), number(self.y[i], slot(1), q)]
    }

    /// Value at `x`, the end values being held outside; derivatives by `x` and by the points.
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
        if R::IS_DUAL && self.first.is_some() { self.with_points(value, x, q, period) } else { value }
    }

    /// A value with what its points' derivatives add to it, by the share that each has in it. A point that goes ahead by
    /// itself takes its line along: there it lowers the value by the slope, as going down by that much would.
    #[inline(always)]
    fn with_points<R: Real, N: Lift<R>>(&self, value: N, x: N, q: &[R], period: Option<f64>) -> N {
        out_of_line!(N, {
            let from = x.map(|x| (self.line(x, period).from as f64, 0.0));
            let to = x.map(|x| (self.line(x, period).to as f64, 0.0));
            let slope = x.map(|x| (self.value(self.line(x, period)).1, 0.0));
            let (first, last) = (from.max_lane() as usize, to.max_lane() as usize);
            let is_shared = -(-from).max_lane() == from.max_lane() && -(-to).max_lane() == to.max_lane();
            let points = if is_shared { vec![first, last] } else { (0..self.x.len()).collect() };
            let mut sum = value;
            for (nth, &i) in points.iter().enumerate() {
                if nth > 0 && points[nth - 1] == i {
                    continue;
                }
                let share = x.map(|x| Self::share(i, &self.line(x, period)));
                let [place, height] = self.point(i, q);
                // Zero but for its derivatives.
                let rise = (N::lift(height) - self.y[i]) - (N::lift(place) - self.x[i]) * slope;
                sum = rise.mul_add(share, sum);
            }
            sum
        })
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
    }

    /// Beside each end of a line in turn, and where it closes: what differences of tables with other points say, also of the
    /// slope, which duals of duals carry.
    #[test]
    fn points_move_a_value_as_differences_do() {
        let (x, y) = ([0.5, 1.0, 3.0], [1.0, 3.0, -1.0]);
        let start: Vec<f64> = [9.0].into_iter().chain(x).chain(y).collect();
        let of = |q: &[f64]| Table::new(&q[1..4], &q[4..]).expect("increasing knots").with_parameters(1);
        for (at, period) in [0.2, 0.7, 2.0, 3.4].into_iter().flat_map(|at| [(at, None), (at, Some(4.0))]) {
            for way in 1..start.len() {
                let (mut low, mut high) = (start.clone(), start.clone());
                (low[way], high[way]) = (low[way] - 1e-6, high[way] + 1e-6);
                let [low, high] = [low, high].map(|q| match period {
                    Some(period) => of(&q).periodic(at, period),
                    None => of(&q).held(at),
                });
                let mut q: Vec<Dual<f64>> = start.iter().copied().map(Dual::constant).collect();
                q[way].d = 1.0;
                let there = Dual::variable(Dual::constant(at));
                let found: Dual<Dual<f64>> = of(&start).value_at(there, &q, period);
                for (d, low, high) in [(found.value.d, low.0, high.0), (found.d.d, low.1, high.1)] {
                    assert!(
                        (d - (high - low) / 2e-6).abs() < 1e-8,
                        "{d} by {way} at {at}, period {period:?}"
                    );
                }
            }
        }
        let knots: Vec<f64> = of(&start).moving_knots().map(|knot| knot.number(&start)).collect();
        assert_eq!(knots, x);
        assert_eq!(of(&start).points(&start).map(|[_, y]| y).collect::<Vec<_>>(), y);
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
