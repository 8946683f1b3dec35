//! A function that repeats with an angle: quintics between even knots, each with the value, slope and bend of the knots at its
//! ends.
//!
//! The slope that [`Periodic::value_and_slope`] gives is that of the very polynomial whose value it gives, so that the work of
//! ½ J′ ω² is what the kinetic energy ½ J ω² gains.

/// Powers 0 to 5 of the share of a piece.
pub type Powers = [f64; 6];

/// Quintics between even knots over a period.
#[derive(Clone, Debug)]
pub struct Periodic {
    pieces: Vec<Powers>,
    /// How many there are, and one over it.
    count: f64,
    inverse_count: f64,
    /// Pieces per angle \[1/rad\].
    density: f64,
}

impl Periodic {
    /// From value, first and second derivative at even knots, the first at angle zero; `None` unless there are as many of
    /// each, at least one, all finite, and the period is positive.
    pub fn new(period: f64, value: &[f64], d1: &[f64], d2: &[f64]) -> Option<Self> {
        let n = value.len();
        let finite = value.iter().chain(d1).chain(d2).all(|x| x.is_finite());
        let sound = n > 0 && d1.len() == n && d2.len() == n && finite && period > 0.0 && period.is_finite();
        let h = period / n as f64;
        let knot = |i: usize| [value[i % n], d1[i % n] * h, d2[i % n] * (h * h)];
        sound.then(|| Periodic {
            pieces: (0..n).map(|i| quintic(knot(i), knot(i + 1))).collect(),
            count: n as f64,
            inverse_count: 1.0 / n as f64,
            density: n as f64 / period,
        })
    }

    /// Mean over a period.
    pub fn mean(&self) -> f64 {
        let of = |piece: &[f64; 6]| piece.iter().enumerate().map(|(k, c)| c / (k + 1) as f64).sum::<f64>();
        self.pieces.iter().map(of).sum::<f64>() / self.pieces.len() as f64
    }

    /// Pieces per angle \[1/rad\].
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Its pieces over a period.
    pub fn pieces(&self) -> &[Powers] {
        &self.pieces
    }

    /// Powers of a piece, counted on over all periods.
    #[inline(always)]
    fn powers(&self, piece: f64) -> &Powers {
        // From the middle of the piece, so that rounding leads to no other period.
        let before = ((piece + 0.5) * self.inverse_count).floor() * self.count;
        &self.pieces[in_low_bits(piece - before + IN_LOW_BITS).min(self.pieces.len() - 1)]
    }

    /// The piece at an angle, and the share of it there.
    #[inline(always)]
    fn piece(&self, angle: f64) -> (&Powers, f64) {
        let along = angle * self.density;
        let whole = along.floor();
        (self.powers(whole), along - whole)
    }

    /// Value and slope at an angle.
    #[inline(always)]
    pub fn value_and_slope(&self, angle: f64) -> [f64; 2] {
        let (&[a, b, c, d, e, f], z) = self.piece(angle);
        // Sums of pairs do not wait for each other.
        let square = z * z;
        let value = (a + b * z) + square * ((c + d * z) + square * (e + f * z));
        let d1 = (b + 2.0 * c * z) + square * ((3.0 * d + 4.0 * e * z) + square * (5.0 * f));
        [value, d1 * self.density]
    }

    /// Second derivative at an angle.
    #[inline(always)]
    pub fn bend(&self, angle: f64) -> f64 {
        let (&[_, _, c, d, e, f], z) = self.piece(angle);
        let d2 = 2.0 * c + z * (6.0 * d + z * (12.0 * e + z * 20.0 * f));
        d2 * (self.density * self.density)
    }
}

/// Added to a whole number from 0 to 2³², it leaves that in the low bits, which takes a third of the instructions of a conversion
/// that minds what does not fit.
pub const IN_LOW_BITS: f64 = 4_503_599_627_370_496.0;

/// What stands there.
#[inline(always)]
pub fn in_low_bits(sum: f64) -> usize {
    sum.to_bits() as u32 as usize
}

/// Powers of the quintic with value, slope and bend at 0 and at 1.
fn quintic([p0, v0, a0]: [f64; 3], [p1, v1, a1]: [f64; 3]) -> [f64; 6] {
    let (rise, gain, bend) = (p1 - p0 - v0 - a0 / 2.0, v1 - v0 - a0, a1 - a0);
    [
        p0,
        v0,
        a0 / 2.0,
        10.0 * rise - 4.0 * gain + bend / 2.0,
        -15.0 * rise + 7.0 * gain - bend,
        6.0 * rise - 3.0 * gain + bend / 2.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sine(n: usize) -> Periodic {
        let angle = |i: usize| TAU * i as f64 / n as f64;
        let list = |f: fn(f64) -> f64| (0..n).map(|i| f(angle(i))).collect::<Vec<_>>();
        Periodic::new(TAU, &list(f64::sin), &list(f64::cos), &list(|x| -x.sin())).expect("even knots")
    }

    /// Sixth order in the distance of the knots for the value, and repeats on both sides of zero.
    #[test]
    fn sine_is_followed() {
        let worst = |n: usize| {
            let table = sine(n);
            let off = |x: f64| (table.value_and_slope(x)[0] - x.sin()).abs();
            (0..997).map(|i| off(-9.0 + 0.02 * f64::from(i))).fold(0.0, f64::max)
        };
        let order = (worst(16) / worst(32)).log2();
        assert!((order - 6.0).abs() < 0.2, "the error falls with power {order}");
        // h⁶/(6!·2⁶) of the sixth derivative: (2π/64)⁶/46080.
        assert!(worst(64) < 2.0e-11, "{}", worst(64));
    }

    /// 2 + sin² has the mean 2.5.
    #[test]
    fn mean_is_exact() {
        let angle = |i: i32| TAU * f64::from(i) / 16.0;
        let list = |f: fn(f64) -> f64| (0..16).map(|i| f(angle(i))).collect::<Vec<_>>();
        let (value, slope) = (list(|x| 2.0 + x.sin().powi(2)), list(|x| (2.0 * x).sin()));
        let table = Periodic::new(TAU, &value, &slope, &list(|x| 2.0 * (2.0 * x).cos())).expect("even knots");
        assert!((table.mean() - 2.5).abs() < 1e-15, "{}", table.mean());
    }

    #[test]
    fn slopes_are_those_of_the_value() {
        let (table, step) = (sine(12), 1e-5);
        for x in [0.3, 2.2, -7.9, 40.0] {
            let ([_, d1], d2) = (table.value_and_slope(x), table.bend(x));
            let ([a, s], [b, t]) = (table.value_and_slope(x - step), table.value_and_slope(x + step));
            // Central differences err by step² and by rounding over the step.
            assert!(((b - a) / (2.0 * step) - d1).abs() < 1e-9, "slope at {x}");
            assert!(((t - s) / (2.0 * step) - d2).abs() < 1e-8, "bend at {x}");
        }
    }

    #[test]
    fn bad_tables_are_refused() {
        assert!(Periodic::new(TAU, &[], &[], &[]).is_none(), "empty");
        assert!(Periodic::new(TAU, &[1.0, 2.0], &[0.0], &[0.0, 0.0]).is_none(), "lengths");
        assert!(Periodic::new(0.0, &[1.0], &[0.0], &[0.0]).is_none(), "no period");
        assert!(Periodic::new(TAU, &[f64::NAN], &[0.0], &[0.0]).is_none(), "not finite");
    }
}
