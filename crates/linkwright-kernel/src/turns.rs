//! Where the speed turns inside a step, and whether it passes a kink of the drive there and comes back.
//!
//! The polynomial of a step ([`crate::rk::Stages::component`]) lies between the minimum and the maximum of its
//! coefficients over Bernstein's polynomials: most steps are done with these eight numbers. Where these rise all along, or fall,
//! so does the polynomial: a part in which they do neither is halved, until its ends say all of it.
//!
//! Source: Farouki, *The Bernstein polynomial basis: a centennial retrospective*, Comput. Aided Geom. Des. 29 (2012) 379:
//! hull, monotony, de Casteljau's halves.

/// Degree of the polynomial.
const DEGREE: usize = 7;

/// Most halvings of a step towards a turning point: its place is then known to 1e-9 of the step, the speed there to rounding.
const HALVINGS: u32 = 30;

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
    /// That starts from `y` with the factors of [`crate::rk::Stages::polynomial`]: of z, z (1 − z), z² (1 − z), …
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

    /// That of a polynomial by powers of the share of the step, from its value at the start on.
    pub fn of_powers<const N: usize>(powers: &[f64; N]) -> Self {
        let of = |k: usize| (0..N).map(|p| powers[p] * BINOMIALS[k][p] / BINOMIALS[DEGREE][p]).sum();
        Bernstein(std::array::from_fn(of))
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

    /// Adds the starts of parts that rise all along, fall all along, or change by less than `small`: shares of the step, and
    /// the values there. What the polynomial reaches between two of them follows from their values.
    fn parts(&self, (from, length): (f64, f64), small: f64, found: &mut Vec<(f64, f64)>) {
        let (low, high) = self.hull();
        if !self.may_turn() || high - low <= small || length <= 0.5_f64.powi(HALVINGS as i32) {
            found.push((from, self.0[0]));
            return;
        }
        for (half, part) in [from, from + 0.5 * length].into_iter().zip(self.halves()) {
            part.parts((half, 0.5 * length), small, found);
        }
    }
}

impl Bernstein {
    /// Shares of the step at which the polynomial turns, but for turns by less than `small`.
    pub fn turns(&self, small: f64) -> Vec<f64> {
        let mut parts = Vec::new();
        self.parts((0.0, 1.0), small, &mut parts);
        parts.into_iter().skip(1).map(|part| part.0).collect()
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
    let mut parts = Vec::new();
    // A tenth of what tells a side of a kink.
    speed.parts((0.0, 1.0), 0.1 * near, &mut parts);
    let cut = |kink: f64| first_cut(&parts, speed.0[DEGREE], kink, near);
    passed.into_iter().filter_map(cut).min_by(f64::total_cmp)
}

/// The start of a part at which to cut for one kink: so that the step passes it once, from side to side; or, where it starts
/// on the kink, so that it ends before it passes it.
fn first_cut(parts: &[(f64, f64)], end: f64, kink: f64, near: f64) -> Option<f64> {
    let side = |value: f64| if (value - kink).abs() <= near { 0.0 } else { (value - kink).signum() };
    let apart: Vec<(f64, f64)> = parts
        .iter()
        .chain([&(1.0, end)])
        .map(|&(share, value)| (share, side(value)))
        .filter(|part| part.1 != 0.0)
        .collect();
    let mut passages = apart.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    let (first, second) = (passages.next()?, passages.next());
    let starts_on_kink = side(parts[0].1) == 0.0;
    match second {
        _ if starts_on_kink => Some(first[0].0),
        Some(second) => Some(second[0].0),
        // Once to the other side, and back to the kink itself.
        None => (side(end) == 0.0).then_some(first[1].0),
    }
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

    #[test]
    fn powers_have_the_same_coefficients() {
        let powers = [2.0, 0.3, -1.5, 4.0, 0.7, -3.0];
        let b = Bernstein::of_powers(&powers);
        for k in 0..=20 {
            let z = f64::from(k) / 20.0;
            let direct = powers.iter().rev().fold(0.0, |sum, power| sum * z + power);
            assert!((at(&b, z) - direct).abs() < 1e-14, "at {z}");
        }
    }

    /// Against samples: a step is cut where a kink is passed that its ends do not show, and else not.
    #[test]
    fn passages_are_all_found() {
        let (n, near) = (4000, 1e-11);
        let mut cuts = 0;
        for case in 0..1500 {
            let wave = |i: usize| (1.7 * f64::from(case) + 2.3 * i as f64).sin();
            let factors = std::array::from_fn(|i| wave(i) * 3.0_f64.powi(i as i32 / 2));
            let share = |k: i32| f64::from(k) / f64::from(n);
            let samples: Vec<f64> = (0..=n).map(|k| value(1.0, &factors, share(k))).collect();
            let kink = 1.0 + 0.2 * wave(8);
            let side = |z: f64| (value(1.0, &factors, z) - kink).signum();
            let passages =
                samples.windows(2).filter(|pair| (pair[0] - kink) * (pair[1] - kink) < 0.0).count();
            let found = passed_and_back(&Bernstein::new(1.0, &factors), [kink].into_iter(), near);
            assert_eq!(found.is_some(), passages > 1, "case {case}: {passages} passages, {found:?}");
            if let Some(cut) = found {
                // The part before is passed once, as its ends show, or not at all.
                let before = (1..n).map(share).filter(|&z| z < cut);
                let changes = before.clone().zip(before.skip(1)).filter(|&(a, b)| side(a) != side(b)).count();
                assert!(changes < 2, "case {case}: {changes} passages before {cut}");
                cuts += 1;
            }
        }
        assert!(cuts > 50, "{cuts} cuts tell something");
    }

    /// 1 − 4 d z (1 − z) dips by d amid the step.
    #[test]
    fn a_dip_below_a_kink_is_seen() {
        let dip = |start: f64, d: f64| Bernstein::new(start, &[0.0, -4.0 * d, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let cut = |b: Bernstein, kink: f64| passed_and_back(&b, [kink].into_iter(), 1e-11);
        let middle = cut(dip(1.0, 0.1), 0.95).expect("below the kink amid the step");
        assert!(at(&dip(1.0, 0.1), middle) < 0.95);
        assert_eq!(cut(dip(1.0, 0.1), 0.89), None, "not down to the kink");
        // From the kink itself down and back to it: no passage in between.
        assert_eq!(cut(dip(1.0, 0.1), 1.0), None, "from the kink");
        // From the kink down, and farther up: passed on the way back.
        let farther = Bernstein::new(1.0, &[0.05, -0.4, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(cut(farther, 1.0).is_some_and(|z| (0.0..0.875).contains(&z)), "from the kink and across");
    }
}
