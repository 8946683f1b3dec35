//! A curve given by points: cubics between them with the slopes given at both ends of each, straight lines outside.
//!
//! With two slopes at each point it holds straight lines as well as smooth curves; two points at one place are a step.

/// Cubics between points, straight lines before the first and after the last.
#[derive(Clone, Debug)]
pub struct Curve {
    x: Vec<f64>,
    /// Powers 0 to 3 of the distance from the left point; the first is the line before, counted from the first point.
    pieces: Vec<[f64; 4]>,
    /// Integral from the first point to each.
    integrals: Vec<f64>,
}

impl Curve {
    /// From points, and the slopes just before and just after each; `None` unless there are as many of each, at least one,
    /// all finite, and the places never decrease.
    pub fn new(x: &[f64], y: &[f64], before: &[f64], after: &[f64]) -> Option<Self> {
        let n = x.len();
        let finite = x.iter().chain(y).chain(before).chain(after).all(|v| v.is_finite());
        let ordered = x.windows(2).all(|pair| pair[0] <= pair[1]);
        let sound = n > 0 && y.len() == n && before.len() == n && after.len() == n && finite && ordered;
        if !sound {
            return None;
        }
        let mut pieces = vec![[y[0], before[0], 0.0, 0.0]];
        pieces.extend((1..n).map(|i| cubic(x[i] - x[i - 1], [y[i - 1], after[i - 1]], [y[i], before[i]])));
        pieces.push([y[n - 1], after[n - 1], 0.0, 0.0]);
        let mut integrals = vec![0.0; n];
        for i in 1..n {
            integrals[i] = integrals[i - 1] + area(&pieces[i], x[i] - x[i - 1]);
        }
        Some(Curve { x: x.to_vec(), pieces, integrals })
    }

    /// The places of the points.
    pub fn knots(&self) -> &[f64] {
        &self.x
    }

    /// The steepest slope at a point, either way.
    pub fn steepest(&self) -> f64 {
        let ends = self.x.windows(2).zip(&self.pieces[1..]).map(|(x, [_, b, c, d])| {
            let z = x[1] - x[0];
            b.abs().max((b + z * (2.0 * c + z * 3.0 * d)).abs())
        });
        let outside = [self.pieces[0][1].abs(), self.pieces[self.x.len()][1].abs()];
        ends.chain(outside).fold(0.0, f64::max)
    }

    /// The piece that holds x; of two that meet there the right one.
    #[inline(always)]
    pub fn piece(&self, x: f64) -> usize {
        self.x.partition_point(|&knot| knot <= x)
    }

    /// Value and slope at x of a piece, also beyond its ends.
    #[inline(always)]
    pub fn of_piece(&self, piece: usize, x: f64) -> (f64, f64) {
        let z = x - self.x[piece.saturating_sub(1)];
        let [a, b, c, d] = self.pieces[piece];
        (a + z * (b + z * (c + z * d)), b + z * (2.0 * c + z * 3.0 * d))
    }

    /// Value and slope at x.
    #[inline(always)]
    pub fn at(&self, x: f64) -> (f64, f64) {
        self.of_piece(self.piece(x), x)
    }

    /// Integral from zero to x.
    pub fn integral(&self, x: f64) -> f64 {
        self.up_to(x) - self.up_to(0.0)
    }

    fn up_to(&self, x: f64) -> f64 {
        let piece = self.piece(x);
        let left = piece.saturating_sub(1);
        self.integrals[left] + area(&self.pieces[piece], x - self.x[left])
    }
}

/// Powers of the cubic over a length with value and slope at both ends; of no length, a constant that nothing asks for.
fn cubic(h: f64, [y0, s0]: [f64; 2], [y1, s1]: [f64; 2]) -> [f64; 4] {
    if h == 0.0 {
        return [y0, 0.0, 0.0, 0.0];
    }
    let chord = (y1 - y0) / h;
    [y0, s0, (3.0 * chord - 2.0 * s0 - s1) / h, (s0 + s1 - 2.0 * chord) / (h * h)]
}

/// Integral of a piece from its left end over a length.
fn area([a, b, c, d]: &[f64; 4], z: f64) -> f64 {
    z * (a + z * (b / 2.0 + z * (c / 3.0 + z * d / 4.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic through its own values and slopes is itself, with lines that go on outside.
    #[test]
    fn cubic_is_followed() {
        let f = |x: f64| x * x * x - 2.0 * x + 1.0;
        let slope = |x: f64| 3.0 * x * x - 2.0;
        let x = [-1.0, 0.5, 2.0];
        let slopes = x.map(slope);
        let curve = Curve::new(&x, &x.map(f), &slopes, &slopes).expect("ordered points");
        for place in [-1.0, -0.3, 0.5, 1.7, 2.0] {
            let (value, rise) = curve.at(place);
            // A few roundings of numbers of size ten.
            assert!((value - f(place)).abs() < 1e-14 && (rise - slope(place)).abs() < 1e-13, "at {place}");
        }
        assert_eq!(curve.at(3.0), (f(2.0) + slope(2.0), slope(2.0)), "beyond");
        let primitive = |x: f64| x.powi(4) / 4.0 - x * x + x;
        assert!((curve.integral(1.7) - primitive(1.7)).abs() < 1e-14, "integral");
        assert!((curve.integral(-0.7) - primitive(-0.7)).abs() < 1e-14, "integral to the left");
        assert!((curve.integral(3.0) - (primitive(2.0) + f(2.0) + 0.5 * slope(2.0))).abs() < 1e-13);
    }

    /// Two points at one place are a step: on the step itself the right side counts.
    #[test]
    fn steps_are_steps() {
        let flat = [0.0; 4];
        let curve = Curve::new(&[0.0, 1.0, 1.0, 2.0], &[3.0, 3.0, 5.0, 5.0], &flat, &flat).expect("a step");
        assert_eq!(
            [curve.at(0.5).0, curve.at(1.0).0, curve.at(1.5).0, curve.at(9.0).0],
            [3.0, 5.0, 5.0, 5.0]
        );
        assert_eq!(curve.of_piece(curve.piece(0.5), 1.0).0, 3.0, "the left side at the step");
    }

    #[test]
    fn bad_curves_are_refused() {
        assert!(Curve::new(&[], &[], &[], &[]).is_none(), "empty");
        assert!(Curve::new(&[1.0, 0.0], &[0.0; 2], &[0.0; 2], &[0.0; 2]).is_none(), "backwards");
        assert!(Curve::new(&[0.0], &[f64::INFINITY], &[0.0], &[0.0]).is_none(), "not finite");
    }
}
