//! Where the speed turns inside a step, and whether it passes a kink of the drive there and comes back.
//!
//! The polynomial of a step ([`crate::kernel::rk::Stages::component`]) lies between the least and the greatest of its
//! coefficients over Bernstein's polynomials: most steps are done with these eight numbers. Its slope has no more zeros than
//! the differences of the coefficients change their sign: halves without a change are left out, the others are halved again.
//!
//! Source: Farouki, *The Bernstein polynomial basis: a centennial retrospective*, Comput. Aided Geom. Des. 29 (2012) 379:
//! hull, variation of signs, de Casteljau's halves.

/// Degree of the polynomial.
const DEGREE: usize = 7;

/// Halvings of a step to a turn: its place is good to 1e-6 of the step, the speed there to the square of that.
const HALVINGS: u32 = 20;

const BINOMIALS: [[f64; DEGREE + 1]; DEGREE + 1] = binomials();

const fn binomials() -> [[f64; DEGREE + 1]; DEGREE + 1] {
    let mut table = [[0.0; DEGREE + 1]; DEGREE + 1];
    let mut n = 0;
    while n <= DEGREE {
        table[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    table
}

/// A polynomial over a step, by its coefficients over Bernstein's polynomials.
#[derive(Clone, Copy, Debug)]
pub struct Bernstein([f64; DEGREE + 1]);

impl Bernstein {
    /// That starts from `y` with the factors of [`crate::kernel::rk::Stages::polynomial`]: of z, z (1 − z), z² (1 − z), …
    pub fn new(y: f64, factors: &[f64; DEGREE]) -> Self {
        let mut b = [y; DEGREE + 1];
        for (i, factor) in factors.iter().enumerate() {
            // zᵃ (1 − z)ᶜ is zᵃ (1 − z)ᶜ (z + 1 − z)ʳ with a + c + r the degree.
            let (a, rest) = (i / 2 + 1, DEGREE - 1 - i);
            for k in 0..=rest {
                b[a + k] += factor * BINOMIALS[rest][k] / BINOMIALS[DEGREE][a + k];
            }
        }
        Bernstein(b)
    }

    /// Its values lie between these two.
    fn hull(&self) -> (f64, f64) {
        self.0.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &b| (low.min(b), high.max(b)))
    }

    /// Both halves.
    fn halves(&self) -> [Bernstein; 2] {
        let (mut b, mut left) = (self.0, self.0);
        for level in 1..=DEGREE {
            for k in 0..=DEGREE - level {
                b[k] = 0.5 * (b[k] + b[k + 1]);
            }
            left[level] = b[0];
        }
        [Bernstein(left), Bernstein(b)]
    }

    /// Whether its slope may change its sign.
    fn may_turn(&self) -> bool {
        let rises = self.0.windows(2).any(|pair| pair[1] > pair[0]);
        rises && self.0.windows(2).any(|pair| pair[1] < pair[0])
    }

    /// Adds where it turns, as shares of the step, and its values there; parts that change by less than `small` are left out.
    fn turns(&self, (from, length): (f64, f64), small: f64, found: &mut Vec<(f64, f64)>) {
        let (low, high) = self.hull();
        if high - low <= small || !self.may_turn() {
            return;
        }
        if length <= 0.5_f64.powi(HALVINGS as i32) {
            found.push((from, self.0[0]));
            return;
        }
        for (half, part) in [from, from + 0.5 * length].into_iter().zip(self.halves()) {
            part.turns((half, 0.5 * length), small, found);
        }
    }
}

/// The share of a step at which it is to be cut, so that its ends show that the speed passes one of some kinks and comes
/// back inside; none where it does not. A speed within `near` of a kink is on neither side of it.
pub fn passed_and_back(speed: &Bernstein, kinks: impl Iterator<Item = f64>, near: f64) -> Option<f64> {
    let (low, high) = speed.hull();
    let passed: Vec<f64> = kinks.filter(|kink| low < kink - near && kink + near < high).collect();
    if passed.is_empty() {
        return None;
    }
    let mut turns = Vec::new();
    // Turns as small as a millionth of what tells a side of a kink show on no side.
    speed.turns((0.0, 1.0), 1e-6 * near, &mut turns);
    let cut = |kink: f64| first_cut(speed, &turns, kink, near);
    passed.into_iter().filter_map(cut).min_by(f64::total_cmp)
}

/// The turn at which to cut for one kink: the last before the first passage that the ends of the step do not show, or the
/// first turn where the passage lies before it.
fn first_cut(speed: &Bernstein, turns: &[(f64, f64)], kink: f64, near: f64) -> Option<f64> {
    let side = |value: f64| if (value - kink).abs() <= near { 0.0 } else { (value - kink).signum() };
    let mut last = side(speed.0[0]);
    for (k, &(share, value)) in turns.iter().enumerate() {
        if side(value) * last < 0.0 {
            return Some(if k == 0 { share } else { turns[k - 1].0 });
        }
        last = if side(value) == 0.0 { last } else { side(value) };
    }
    let ends_across = side(speed.0[DEGREE]) * last < 0.0;
    turns.last().filter(|_| ends_across).map(|turn| turn.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial at a share, as its factors are meant.
    fn value(y: f64, factors: &[f64; DEGREE], z: f64) -> f64 {
        let part = |(i, factor): (usize, &f64)| {
            factor * z.powi(i as i32 / 2 + 1) * (1.0 - z).powi((i as i32 + 1) / 2)
        };
        y + factors.iter().enumerate().map(part).sum::<f64>()
    }

    /// Values of a polynomial with these coefficients, by de Casteljau at any share.
    fn at(b: &Bernstein, z: f64) -> f64 {
        let mut b = b.0;
        for level in 1..=DEGREE {
            for k in 0..=DEGREE - level {
                b[k] = (1.0 - z) * b[k] + z * b[k + 1];
            }
        }
        b[0]
    }

    const FACTORS: [f64; DEGREE] = [0.3, -2.0, 1.5, 3.0, -1.0, 0.7, 5.0];

    #[test]
    fn coefficients_are_of_the_same_polynomial() {
        let b = Bernstein::new(2.0, &FACTORS);
        for k in 0..=20 {
            let z = f64::from(k) / 20.0;
            // A few roundings of numbers of size one.
            assert!((at(&b, z) - value(2.0, &FACTORS, z)).abs() < 1e-14, "at {z}");
        }
    }

    /// Every change of sign of the slope between many samples is found, and nothing else.
    #[test]
    fn turns_are_all_found() {
        for case in 0..40 {
            let factors = std::array::from_fn(|i| {
                (1.7 * f64::from(case) + 2.3 * i as f64).sin() * 3.0_f64.powi(i as i32 / 2)
            });
            let (b, n) = (Bernstein::new(1.0, &factors), 20_000);
            let samples: Vec<f64> =
                (0..=n).map(|k| value(1.0, &factors, f64::from(k) / f64::from(n))).collect();
            let turned = |w: &[f64]| (w[1] - w[0]) * (w[2] - w[1]) < 0.0;
            let wanted: Vec<f64> = samples
                .windows(3)
                .zip(1..)
                .filter(|(w, _)| turned(w))
                .map(|(_, k)| f64::from(k) / f64::from(n))
                .collect();
            let mut found = Vec::new();
            b.turns((0.0, 1.0), 1e-15, &mut found);
            found.dedup_by(|a, b| a.0 - b.0 < 1e-5);
            assert_eq!(found.len(), wanted.len(), "case {case}: {found:?}, {wanted:?}");
            for (&(z, y), wanted) in found.iter().zip(wanted) {
                assert!((z - wanted).abs() < 1.1e-4, "case {case}: {z}, {wanted}");
                assert!((y - value(1.0, &factors, z)).abs() < 1e-11, "case {case}: value");
            }
        }
    }

    /// 1 − 4 d z (1 − z) dips by d amid the step, and by d/2 at 0.15 and 0.85.
    #[test]
    fn a_dip_below_a_kink_is_seen() {
        let dip = |start: f64, d: f64| Bernstein::new(start, &[0.0, -4.0 * d, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let cut = |b: Bernstein, kink: f64| passed_and_back(&b, [kink].into_iter(), 1e-11);
        let middle = cut(dip(1.0, 0.1), 0.95).expect("below the kink amid the step");
        assert!((middle - 0.5).abs() < 2e-6, "{middle}");
        assert_eq!(cut(dip(1.0, 0.1), 0.89), None, "not down to the kink");
        // From the kink itself down and back to it: no passage in between.
        assert_eq!(cut(dip(1.0, 0.1), 1.0), None, "from the kink");
        // From the kink down, and farther up: passed on the way back.
        let farther = Bernstein::new(1.0, &[0.05, -0.4, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(cut(farther, 1.0).is_some_and(|z| (z - 0.4375).abs() < 2e-6), "from the kink and across");
    }
}
