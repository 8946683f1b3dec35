//! Steps of order 8 by [`linkwright_kernel::rk`]: exact and cheap as long as no swing is much faster than those that matter.

use super::rates::Rates;
use super::stepper::{Scale, Stepper};
use linkwright_kernel::rk::{Stages, WEIGHTS, add, next_factor};
use std::mem::swap;

/// Phase of the fastest undamped swing up to which its amplitude does not grow in a step.
pub const STABLE_PHASE: f64 = 5.9;

/// Error between the ends of a step, over what it may be, below which it does not limit the next: that may be twice as long.
pub const SAYS_NOTHING: f64 = 1.0 / 512.0;

/// Explicit steps with their stages. Their states have places for whole registers.
#[derive(Clone, Debug)]
pub struct Explicit {
    /// How many masses, and places for them.
    masses: usize,
    places: usize,
    from: Vec<f64>,
    to: Vec<f64>,
    stages: Stages<Vec<f64>>,
    /// Powers at each stage.
    powers: Vec<Vec<f64>>,
    end_powers: Vec<f64>,
    h: f64,
    rejected: usize,
}

impl Explicit {
    /// For a system.
    pub fn new(rates: &Rates<'_>) -> Self {
        let (room, masses) = (rates.room(), rates.system.len());
        Explicit {
            masses,
            places: room.len() / 2,
            stages: Stages::of(&room, 2 * masses),
            from: room.clone(),
            to: room,
            powers: vec![rates.powers.clone(); WEIGHTS.len()],
            end_powers: rates.powers.clone(),
            h: 0.0,
            rejected: 0,
        }
    }

    /// Place of a number of the state.
    fn place(&self, i: usize) -> usize {
        if i < self.masses { i } else { self.places + i - self.masses }
    }
}

impl Stepper for Explicit {
    fn begin(&mut self, rates: &mut Rates<'_>, t: f64, state: &[f64], first: f64) {
        rates.copy(state, &mut self.from);
        rates.derivative_in_place(t, &self.from, self.stages.start());
        self.powers[0].copy_from_slice(&rates.powers);
        self.h = first;
    }

    fn step(
        &mut self,
        rates: &mut Rates<'_>,
        (t, state): (f64, &Vec<f64>),
        longest: f64,
        scale: &Scale,
        end: &mut Vec<f64>,
    ) -> Option<f64> {
        rates.copy(state, &mut self.from);
        let size = |i: usize, size: f64| scale.of(i, size);
        let mut growth_max = f64::INFINITY;
        // Forty reductions by a tenth to nine tenths reach any length that still changes t.
        for _ in 0..40 {
            let h = fitting(self.h, longest);
            let mut stage = 0;
            let powers = &mut self.powers;
            let mut f = |t: f64, y: &Vec<f64>, to: &mut Vec<f64>| {
                rates.derivative_in_place(t, y, to);
                stage += 1;
                // All of them are written anew each time.
                swap(&mut powers[stage], &mut rates.powers);
            };
            let error = self.stages.try_step(&mut f, (t, &self.from), h, &size, &mut self.to);
            if error <= 1.0 {
                let grown = h * next_factor(error).min(growth_max);
                // A step cut short by an event says nothing about the length that the next may have.
                self.h = if h < self.h { grown.max(self.h) } else { grown };
                rates.copy(&self.to, end);
                return Some(h);
            }
            self.h = h * next_factor(error).min(0.9);
            growth_max = 1.0;
            self.rejected += 1;
        }
        None
    }

    fn accept(&mut self, rates: &mut Rates<'_>, t_end: f64, _: &[f64]) {
        rates.derivative_in_place(t_end, &self.to, self.stages.end());
        swap(&mut self.end_powers, &mut rates.powers);
    }

    fn fill(
        &mut self,
        rates: &mut Rates<'_>,
        (t, _): (f64, &Vec<f64>),
        h: f64,
        scale: &Scale,
        _: &[f64],
    ) -> f64 {
        let (system, at, end) = (rates.system, (t, &self.from), &self.to);
        let mut f = |t: f64, y: &Vec<f64>, to: &mut Vec<f64>| rates.derivative_in_place(t, y, to);
        self.stages.fill(&mut f, at, h, end);
        let error =
            self.stages.error_between(&mut f, at, h, &|y, error| scale.worst(system, error, [y, end]));
        // A step cut short says nothing about the next.
        if error > SAYS_NOTHING {
            self.h = self.h.min(h * next_factor(error));
        }
        error
    }

    fn shorten(&mut self, h: f64, error: f64) {
        self.h = h * next_factor(error).min(0.9);
        self.rejected += 1;
    }

    fn component(&self, share: f64, state: &[f64], i: usize) -> f64 {
        self.stages.component(share, state[i], self.place(i))
    }

    fn components(&self, share: f64, state: &[f64], to: &mut [f64]) {
        let ((from, to), n) = ((state.split_at(self.masses), to.split_at_mut(self.masses)), self.places);
        self.stages.components(share, 0, from.0, to.0);
        self.stages.components(share, n, from.1, to.1);
    }

    fn slope(&self, share: f64, h: f64, i: usize) -> f64 {
        self.stages.slope(share, self.place(i)) / h
    }

    fn work(&mut self, _: &mut Rates<'_>, _: (f64, &Vec<f64>), h: f64, to: &mut [f64]) {
        add(to, h, &WEIGHTS, &self.powers);
    }

    fn advance(&mut self) {
        self.stages.advance();
        swap(&mut self.powers[0], &mut self.end_powers);
    }

    fn rejected(&self) -> usize {
        self.rejected
    }
}

/// The length to try: what is left to the next event is taken whole or in halves, never leaving a splinter.
pub fn fitting(h: f64, longest: f64) -> f64 {
    if h >= 0.99 * longest {
        longest
    } else if h > 0.5 * longest {
        0.5 * longest
    } else {
        h
    }
}
