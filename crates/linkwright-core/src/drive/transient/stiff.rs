//! Steps where the drive holds its speed fast: Radau IIA over time, and what a step errs, measured by its halves.
//!
//! A disturbance of the speed dies with exp(∂ε/∂ω · t). Where it dies within a small part of the step that the accuracy would
//! allow, an explicit method must follow its death all along; an L-stable one need not ([`crate::kernel::radau`]).
//! The stages of speed are the unknowns; those of the angle are their integrals:
//!
//! ```text
//! ω_i = ω + h Σ a_ij ε(t_j, φ_j, ω_j),   φ_i = φ + h Σ a_ij ω_j
//! ```
//!
//! Newton takes ∂ε/∂ω exactly and leaves out ∂ε/∂φ: a correction of the speed by δ turns the crank by h δ, little of a revolution.
//!
//! A step is done once as a whole and once in two halves. The halves are what is returned; the two differ by what the
//! whole errs, 2⁶ times as much as the halves, since the quintic through the stages errs with h⁶.
//!
//! Source: Hairer, Wanner, *Solving Ordinary Differential Equations II*, IV.5 and IV.8; Hairer, Nørsett, Wanner, I, II.4 on
//! the error by halves.

use super::attempt::{Attempts, Piece, aside_of, tolerance};
use super::equation::{Equation, Jump, Y};
use crate::kernel::radau::{A, B, C, N, S, stage_newton, through, value};
use crate::kernel::rk::{Trial, factors, over, worse};

/// Newton sweeps of a step; each takes what the angles were off by a further factor (ω h)², or ten.
const SWEEPS_MAX: usize = 20;

/// Correction of a speed, as a share of it, that rounding leaves.
const ROUNDING: f64 = 1e-15;

/// What the halves err over what the whole differs from them: 2⁻⁶ where steps are short, more than that where they are not.
const ERROR_OF_DIFFERENCE: f64 = 1.0 / 16.0;

/// Share of ∂ε/∂ω times the speed that rounding leaves of an acceleration.
const ROUNDING_OF_RATE: f64 = 1e-14;

/// A step that was solved.
#[derive(Clone, Copy, Debug)]
struct StiffStep {
    h: f64,
    from: Y,
    /// Speeds at its stages, less that at its start.
    rise: [f64; S],
    /// Acceleration at its end.
    rate: f64,
    /// ∂ε/∂ω there.
    steepness: f64,
}

impl StiffStep {
    /// Quintic of what the speed has risen by, over the share of the step.
    fn quintic(&self) -> [f64; N] {
        let mut values = [0.0; N];
        values[1..].copy_from_slice(&self.rise);
        through(&values)
    }

    fn end(&self) -> Y {
        let turned = self.from[1] + (0..S).map(|j| B[j] * self.rise[j]).sum::<f64>();
        [self.from[0] + self.h * turned, self.from[1] + self.rise[S - 1]]
    }

    /// The step as it is returned.
    fn piece(&self) -> Piece {
        let speed = self.quintic();
        let mut angle = integral(&speed);
        angle[1] += self.from[1];
        let angle = angle.map(|a| a * self.h);
        let between = [factors(&angle), factors(&speed)];
        let end = self.end();
        Piece { h: self.h, y: end, rate: [end[1], self.rate], between }
    }
}

/// Integral of a quintic from 0 on.
fn integral(a: &[f64; N]) -> [f64; N + 1] {
    std::array::from_fn(|p| if p == 0 { 0.0 } else { a[p - 1] / p as f64 })
}

/// Steps of any length from one instant by the implicit method; the last one is kept.
pub struct StiffAttempt<'a, 'm> {
    equation: &'a mut Equation<'m>,
    from: (f64, Y),
    accuracy: f64,
    aside: f64,
    halves: Option<[StiffStep; 2]>,
    end: Y,
    error: f64,
}

impl<'a, 'm> StiffAttempt<'a, 'm> {
    /// From an instant and its state.
    pub fn new(equation: &'a mut Equation<'m>, (t, y): (f64, &Y), accuracy: f64) -> Self {
        let aside = aside_of(equation.speed_scale);
        StiffAttempt { equation, from: (t, *y), accuracy, aside, halves: None, end: *y, error: f64::NAN }
    }

    /// A step in two halves and its error over what it may be; or the error of one that cannot be solved.
    fn measured(&mut self, h: f64) -> Result<([StiffStep; 2], f64), f64> {
        let (t, y) = self.from;
        let whole = self.solve(t, y, h, [0.0; S])?;
        let halves = self.in_halves(&whole)?;
        let error = self.difference(&whole, &halves);
        Ok((halves, error))
    }

    /// The step in two halves, from the stages of the whole.
    fn in_halves(&mut self, whole: &StiffStep) -> Result<[StiffStep; 2], f64> {
        let (t, y) = self.from;
        let (quintic, half) = (whole.quintic(), 0.5 * whole.h);
        let guess = |from: f64, base: f64| C.map(|c| value(&quintic, from + 0.5 * c) - base);
        let first = self.solve(t, y, half, guess(0.0, 0.0))?;
        let middle = first.rise[S - 1];
        let second = self.solve(t + half, first.end(), half, guess(0.5, middle))?;
        Ok([first, second])
    }

    /// Newton for the stages of a step, from a guess of what the speed rises by.
    fn solve(&mut self, t: f64, from: Y, h: f64, guess: [f64; S]) -> Result<StiffStep, f64> {
        let [phi, omega] = from;
        let mut rise = guess;
        let mut last = f64::INFINITY;
        for _ in 0..SWEEPS_MAX {
            let (mut rates, mut slopes) = ([0.0; S], [0.0; S]);
            for i in 0..S {
                let turned: f64 = (0..S).map(|j| A[i][j] * rise[j]).sum();
                let angle = phi + h * (C[i] * omega + turned);
                (rates[i], slopes[i]) = self.equation.acceleration(t + C[i] * h, &[angle, omega + rise[i]]);
            }
            let correction = stage_newton(0.0, h, &rates, &slopes, &rise).p;
            let mut worst = 0.0;
            for i in 0..S {
                worst = worse(worst, correction[i].abs());
                rise[i] += correction[i];
            }
            if worst.is_nan() {
                return Err(f64::NAN);
            }
            let size = omega.abs() + rise.iter().fold(0.0, |size, rise| rise.abs().max(size));
            // Corrections that no longer shrink are rounding, if they are small at all.
            let is_rounding =
                worst <= ROUNDING * size || (worst >= 0.5 * last && worst <= 1e3 * ROUNDING * size);
            if is_rounding {
                let rate = slopes[S - 1].mul_add(correction[S - 1], rates[S - 1]);
                return Ok(StiffStep { h, from, rise, rate, steepness: slopes[S - 1] });
            }
            last = worst;
        }
        Err(f64::INFINITY)
    }

    /// What the halves err, by what the whole differs from them at their stages, over what they may.
    fn difference(&self, whole: &StiffStep, halves: &[StiffStep; 2]) -> f64 {
        let quintic = whole.quintic();
        let mut worst = 0.0;
        let mut add = |error: f64, tolerance: f64, size: f64| {
            worst = worse(worst, over(ERROR_OF_DIFFERENCE * error, tolerance, size));
        };
        for (k, half) in halves.iter().enumerate() {
            for i in 0..S {
                let share = 0.5 * (k as f64 + C[i]);
                let by_whole = whole.from[1] + value(&quintic, share);
                let speed = half.from[1] + half.rise[i];
                add(by_whole - speed, tolerance(self.accuracy, self.aside, 1, speed.abs()), speed.abs());
            }
        }
        let [end, other] = [halves[1].end(), whole.end()];
        for n in 0..2 {
            let size = end[n].abs();
            add(end[n] - other[n], tolerance(self.accuracy, self.aside, n, size), size);
        }
        let [rate, scale] = [halves[1].rate, self.equation.speed_scale];
        let rounding = ROUNDING_OF_RATE * (halves[1].steepness * end[1]).abs();
        add(rate - whole.rate, (self.accuracy * (rate.abs() + scale * scale)).max(rounding), rate.abs());
        worst
    }
}

impl Attempts for StiffAttempt<'_, '_> {
    /// The error is infinite where the stages do not converge, NaN where the machine has no acceleration.
    fn to(&mut self, h: f64) -> Trial<2> {
        self.halves = None;
        self.error = match self.measured(h) {
            Ok((halves, error)) => {
                self.halves = Some(halves);
                error
            }
            Err(error) => error,
        };
        let end = self.halves.map_or([f64::NAN; 2], |halves| halves[1].end());
        Trial { y: end, error: self.error }
    }

    fn speeds(&self) -> Vec<(f64, f64)> {
        let mut passed = 0.0;
        let end = |half: &StiffStep| {
            passed += half.h;
            (passed, half.end()[1])
        };
        self.halves.iter().flatten().map(end).collect()
    }

    /// What was measured on all of the step when it was tried.
    fn fill(&mut self, _h: f64, end: &Y) -> f64 {
        self.end = *end;
        self.error
    }

    fn pieces(&self) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = self.halves.iter().flatten().map(StiffStep::piece).collect();
        if let Some(last) = pieces.last_mut() {
            last.y = self.end;
        }
        pieces
    }

    fn order(&self) -> f64 {
        6.0
    }

    fn at_law_kinks(&mut self, t: f64, y: &Y) -> Vec<f64> {
        self.equation.at_law_kinks(t, y)
    }

    fn jump(&mut self, nth: usize, t: f64, y: &Y) -> Jump {
        self.equation.jump(nth, t, y)
    }

    fn first_unseen(&mut self, from: (f64, &Y), pieces: &[Piece]) -> Option<f64> {
        self.equation.first_unseen(from, pieces)
    }
}
