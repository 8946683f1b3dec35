//! Maximum and minimum torque of each link, speed of each mass, torque and power of each element with friction, with their
//! times, between the ends of steps as well.
//!
//! Values and their rates at both ends of a step tell where the cubic between them turns; where that could be a new extreme,
//! the method's own polynomial is asked.

use super::equilibrium::Equilibrium;
use super::rates::Rates;
use super::stepper::Stepper;
use super::watch::{Watch, value as friction_value};

/// Largest value, its time, minimum value, its time.
pub type Extreme = [f64; 4];

/// Share of a cubic's rise above the ends by which it may miss.
const DOUBT: f64 = 0.1;

/// Extremes so far: links, masses, torques of elements with friction, powers of these.
#[derive(Clone, Debug)]
pub struct Extremes {
    pub rows: Vec<Extreme>,
    before: Vec<(f64, f64)>,
    now: Vec<(f64, f64)>,
}

impl Extremes {
    /// None yet.
    pub fn new(rates: &Rates<'_>) -> Self {
        let n = rates.system.links.len() + rates.system.len() + 2 * rates.system.frictions.len();
        let none = [f64::NEG_INFINITY, 0.0, f64::INFINITY, 0.0];
        Extremes { rows: vec![none; n], before: vec![(0.0, 0.0); n], now: vec![(0.0, 0.0); n] }
    }

    /// Looks at values and rates at the instant last evaluated, where a stretch of time begins.
    pub fn begin(&mut self, rates: &Rates<'_>) {
        self.look(rates);
        std::mem::swap(&mut self.before, &mut self.now);
    }

    /// Looks at values and rates at the instant last evaluated, the end of a step.
    pub fn look(&mut self, rates: &Rates<'_>) {
        let system = rates.system;
        let links = (0..system.links.len()).map(|place| rates.link_torque(place));
        let n = system.len();
        let speeds = rates.omega[..n].iter().copied().zip(rates.acceleration.iter().copied());
        // Rates follow from the middle of the step: [`Extremes::bend`].
        let rubbing = (0..2 * system.frictions.len()).map(|row| (friction_value(rates, row), f64::NAN));
        self.now.iter_mut().zip(links.chain(speeds).chain(rubbing)).for_each(|(now, found)| *now = found);
    }

    /// Sets the rates of the last rows at both ends of a step by the parabolas through their values in its middle.
    pub fn bend(&mut self, middle: &[f64], h: f64) {
        let first = self.rows.len() - middle.len();
        for ((before, now), &b) in self.before[first..].iter_mut().zip(&mut self.now[first..]).zip(middle) {
            let (a, c) = (before.0, now.0);
            before.1 = (4.0 * b - 3.0 * a - c) / h;
            now.1 = (3.0 * c + a - 4.0 * b) / h;
        }
    }

    /// Sets the torques of shafts as good as rigid at both ends of a step, with the rates of the parabola through them and the
    /// torque within the step: those of the equations of motion are rounding times the stiffness.
    pub fn balance(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        equilibrium: &mut Equilibrium,
        at: (f64, &Vec<f64>),
        h: f64,
    ) {
        let links = rates.system.links.len();
        let [a, b, c] = [0.0, 0.5, 1.0].map(|share| {
            equilibrium.at(rates, stepper, at, h, share);
            (0..links).map(|s| equilibrium.torque(s)).collect::<Vec<_>>()
        });
        for (s, values) in a.into_iter().zip(b).zip(c).enumerate() {
            if let ((Some(a), Some(b)), Some(c)) = values {
                self.before[s] = (a, (4.0 * b - 3.0 * a - c) / h);
                self.now[s] = (c, (3.0 * c + a - 4.0 * b) / h);
            }
        }
    }

    /// Takes the start and the inside of a step from an instant, by the polynomial that was made of it.
    pub fn take(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        (equilibrium, watch): (&mut Equilibrium, &mut Watch),
        (t, state): (f64, &Vec<f64>),
        h: f64,
    ) {
        let rubbing = rates.system.links.len() + rates.system.len();
        for row in 0..self.rows.len() {
            note(&mut self.rows[row], self.before[row].0, t);
            if !self.may_turn(row, h) {
                continue;
            }
            for turn in turns(self.before[row], self.now[row], h)
                .filter(|turn| self.is_new(row, turn.value))
                .collect::<Vec<_>>()
            {
                let value = |share: f64| {
                    if let Some(row) = row.checked_sub(rubbing) {
                        return watch.value(rates, stepper, (t, state), h, (share, row));
                    }
                    if equilibrium.torque(row).is_some() {
                        equilibrium.at(rates, stepper, (t, state), h, share);
                    }
                    let balanced = equilibrium.torque(row);
                    balanced.unwrap_or_else(|| value_at(rates, stepper, state, row, share))
                };
                let (share, value) = refined(value, turn.share);
                note(&mut self.rows[row], value, t + share * h);
            }
        }
    }

    /// Takes the end of the step, and lets it be the start of the next.
    pub fn advance(&mut self, t: f64) {
        for (row, now) in self.rows.iter_mut().zip(&self.now) {
            note(row, now.0, t);
        }
        std::mem::swap(&mut self.before, &mut self.now);
    }

    /// Whether the cubic over a step may have a new extreme inside: it lies between the minimum and the maximum of its
    /// coefficients over Bernstein's polynomials.
    fn may_turn(&self, row: usize, h: f64) -> bool {
        let (before, now) = (self.before[row], self.now[row]);
        let inner = [before.0 + h / 3.0 * before.1, now.0 - h / 3.0 * now.1];
        inner.into_iter().any(|value| !value.is_finite() || self.is_new(row, value))
    }

    /// Whether a value inside a step may be a new extreme.
    fn is_new(&self, row: usize, value: f64) -> bool {
        let (before, now, [most, _, least, _]) = (self.before[row].0, self.now[row].0, self.rows[row]);
        let bold = value + DOUBT * (value - 0.5 * (before + now));
        bold > most.max(now) || bold < least.min(now)
    }
}

fn note(row: &mut Extreme, value: f64, t: f64) {
    if value > row[0] {
        (row[0], row[1]) = (value, t);
    }
    if value < row[2] {
        (row[2], row[3]) = (value, t);
    }
}

/// Torque of a link or speed of a mass at a share of the step.
fn value_at(rates: &Rates<'_>, stepper: &impl Stepper, state: &[f64], row: usize, share: f64) -> f64 {
    let component = |i: usize| stepper.component(share, state, i);
    let (system, n) = (rates.system, rates.system.len());
    if row < system.links.len() {
        return rates.link_torque_at(row, component);
    }
    let i = row - system.links.len();
    let first = if i > 0 && rates.is_relative() { system.turns_of(i) * component(n) } else { 0.0 };
    first + component(n + i)
}

/// Where a cubic turns, as a share of the step, and its value there.
#[derive(Clone, Copy, Debug)]
struct Turn {
    share: f64,
    value: f64,
}

/// Turns of the cubic with value and rate at both ends of a step.
fn turns((v0, r0): (f64, f64), (v1, r1): (f64, f64), h: f64) -> impl Iterator<Item = Turn> {
    let (s0, s1, rise) = (h * r0, h * r1, v1 - v0);
    // p′ = s0 + 2bz + 3cz²
    let (b, c) = (3.0 * rise - 2.0 * s0 - s1, s0 + s1 - 2.0 * rise);
    let root = (b * b - 3.0 * c * s0).sqrt();
    // The larger sum first, so that no digits cancel; without a root both are NaN, which lies in no step.
    let sum = -(b + root.copysign(b));
    [sum / (3.0 * c), s0 / sum]
        .into_iter()
        .filter(|z| (0.0..1.0).contains(z))
        .map(move |z| Turn { share: z, value: v0 + z * (s0 + z * (b + z * c)) })
}

/// Share and value of the extreme near a share, by parabolas through three values, twice.
fn refined(mut value: impl FnMut(f64) -> f64, near: f64) -> (f64, f64) {
    let mut share = near;
    for reach in [0.05, 0.005] {
        let middle = share.clamp(reach, 1.0 - reach);
        let [a, b, c] = [middle - reach, middle, middle + reach].map(&mut value);
        let bend = a - 2.0 * b + c;
        if bend != 0.0 {
            share = (middle + 0.5 * reach * (a - c) / bend).clamp(middle - reach, middle + reach);
        }
    }
    (share, value(share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_of_a_cubic() {
        // z³ − 1.2z² + 0.36z turns at 0.2 and 0.6.
        let p = |z: f64| z * (0.36 + z * (z - 1.2));
        let slope = |z: f64| 0.36 + z * (3.0 * z - 2.4);
        let mut found: Vec<Turn> =
            turns((p(0.0), slope(0.0) / 0.5), (p(1.0), slope(1.0) / 0.5), 0.5).collect();
        found.sort_by(|a, b| a.share.total_cmp(&b.share));
        assert_eq!(found.len(), 2);
        for (turn, wanted) in found.iter().zip([0.2, 0.6]) {
            assert!((turn.share - wanted).abs() < 1e-14 && (turn.value - p(wanted)).abs() < 1e-14);
        }
        assert_eq!(turns((0.0, 1.0), (1.0, 1.0), 1.0).count(), 0, "a straight line");
    }

    /// Exact to the fourth order of the last reach for a sine.
    #[test]
    fn peak_of_a_sine() {
        let (share, value) = refined(|z| (2.0 * z + 0.7).sin(), 0.41);
        assert!((share - (std::f64::consts::FRAC_PI_2 - 0.7) / 2.0).abs() < 1e-5, "{share}");
        assert!((value - 1.0).abs() < 1e-10, "{value}");
    }
}
