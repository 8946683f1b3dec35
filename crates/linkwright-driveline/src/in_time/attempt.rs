//! Steps of any length from one instant: explicit by DOP853, implicit by Radau IIA with five stages.
//!
//! A shaft that is nearly rigid, or a motor that holds its speed, limits the steps of the explicit method by its stability and not by
//! its error. The stages z_i of the implicit one are solved together by Newton's method with the derivatives at the start,
//!
//! ```text
//! (1 − h A ⊗ J) Δz = h A f(y + z) − z
//! ```
//!
//! and the error is that of the quintic through them, by its defect ([`crate::error`]).
//!
//! Source: Hairer, Wanner, *Solving Ordinary Differential Equations II*, IV.8.

use super::system::System;
use crate::elimination::solve;
use crate::error::{ERROR_OF_DEFECT, GAMMA, WATCHED};
use linkwright_kernel::radau::{A, C, S, slope_and_bend, through, value};
use linkwright_kernel::rk::{Stages, factors, over, rise, worse};

/// What an explicit step may have of h |λ| for the fastest eigenvalue λ: it is stable up to about 6.
const STABLE: f64 = 3.0;

/// What an implicit step must have of it at least.
const STIFF: f64 = 1.0;

/// Sweeps of Newton's method for a step.
const SWEEPS_MAX: usize = 12;

/// Share of the tolerance below which a correction is none.
const SOLVED: f64 = 1e-4;

/// Corrections that no longer shrink so much are rounding, if they are below the tolerance.
const SHRINKS: f64 = 0.5;

/// Attempts from one instant.
pub(super) struct Attempt {
    /// Factors of the polynomials of the step tried last.
    pub between: Vec<[f64; 7]>,
    /// Whether steps are implicit.
    pub is_stiff: bool,
    stages: Stages<Vec<f64>>,
    rate: Vec<f64>,
    /// Derivatives of the rates at the start; empty until they are asked for.
    slopes: Vec<f64>,
}

impl Attempt {
    /// Room for states like this one.
    pub(super) fn new(system: &System<'_>, y: &Vec<f64>) -> Self {
        Attempt {
            between: vec![[0.0; 7]; system.layout.size],
            is_stiff: false,
            stages: Stages::new(y),
            rate: y.clone(),
            slopes: Vec::new(),
        }
    }

    /// Begins at a time and a state; whether it has rates.
    pub(super) fn begin(&mut self, system: &mut System<'_>, t: f64, y: &[f64]) -> bool {
        system.rates(t, y, &mut self.rate);
        self.slopes.clear();
        self.stages.start().copy_from_slice(&self.rate);
        self.rate.iter().all(|rate| rate.is_finite())
    }

    /// Rates at the start.
    pub(super) fn rate(&self) -> &[f64] {
        &self.rate
    }

    /// Order of the error.
    pub(super) fn order(&self) -> f64 {
        if self.is_stiff { 6.0 } else { 8.0 }
    }

    /// Decides by the fastest eigenvalue, bounded by Gershgorin's theorem, which method is to go on with steps of a length.
    pub(super) fn choose(&mut self, system: &mut System<'_>, t: f64, y: &[f64], h: f64) {
        self.find_slopes(system, t, y);
        let (others, m) = (system.layout.others, system.layout.phi + 1);
        let row = |r: usize, columns: std::ops::Range<usize>| -> f64 {
            self.slopes[r * m..][columns].iter().map(|slope| slope.abs()).sum()
        };
        let [by_twist, by_speed] = [0..others, others..m]
            .map(|columns| (others..=2 * others).map(|r| row(r, columns.clone())).fold(0.0, f64::max));
        let fastest = by_twist.sqrt() + by_speed;
        self.is_stiff = h * fastest > if self.is_stiff { STIFF } else { STABLE };
    }

    fn find_slopes(&mut self, system: &mut System<'_>, t: f64, y: &[f64]) {
        if self.slopes.is_empty() {
            let m = system.layout.phi + 1;
            self.slopes.resize(m * m, 0.0);
            system.slopes(t, y, &mut self.slopes);
        }
    }

    /// State at a share of the step tried last.
    pub(super) fn state(&self, share: f64, y: &[f64], to: &mut [f64]) {
        for (to, (y, factors)) in to.iter_mut().zip(y.iter().zip(&self.between)) {
            *to = y + rise(factors, share);
        }
    }

    /// Tries a step: its end, its polynomials, and the error over the tolerance, at the end and on the way there.
    pub(super) fn to(
        &mut self,
        system: &mut System<'_>,
        tolerances: &[[f64; 2]],
        from: (f64, &Vec<f64>),
        h: f64,
        end: &mut Vec<f64>,
    ) -> f64 {
        let scale = |n: usize, size: f64| tolerances[n][0] + tolerances[n][1] * size;
        if self.is_stiff {
            self.implicit(system, &scale, from, h, end)
        } else {
            self.explicit(system, &scale, from, h, end)
        }
    }

    fn explicit(
        &mut self,
        system: &mut System<'_>,
        scale: &impl Fn(usize, f64) -> f64,
        (t, y): (f64, &Vec<f64>),
        h: f64,
        end: &mut Vec<f64>,
    ) -> f64 {
        let mut f = |t: f64, y: &Vec<f64>, to: &mut Vec<f64>| system.rates(t, y, to);
        let error = self.stages.try_step(&mut f, (t, y), h, scale, end);
        if error.is_nan() || error > 1.0 {
            return error;
        }
        f(t + h, end, self.stages.end());
        self.stages.fill(&mut f, (t, y), h, end);
        let measure = |y: &[f64], error: &[f64]| {
            let share = |n: usize| over(error[n], scale(n, y[n].abs()), y[n].abs());
            (0..y.len()).map(share).fold(0.0, worse)
        };
        let between = self.stages.error_between(&mut f, (t, y), h, &measure);
        for (n, factors) in self.between.iter_mut().enumerate() {
            *factors = self.stages.polynomial(n);
        }
        worse(error, between)
    }

    fn implicit(
        &mut self,
        system: &mut System<'_>,
        scale: &impl Fn(usize, f64) -> f64,
        (t, y): (f64, &Vec<f64>),
        h: f64,
        end: &mut [f64],
    ) -> f64 {
        self.find_slopes(system, t, y);
        let Some(rises) = self.solved(system, scale, (t, y), h) else { return f64::INFINITY };
        let quintics: Vec<_> = (0..y.len())
            .map(|n| {
                let mut values = [0.0; S + 1];
                (0..S).for_each(|i| values[i + 1] = rises[i][n]);
                through(&values)
            })
            .collect();
        for (n, quintic) in quintics.iter().enumerate() {
            end[n] = y[n] + rises[S - 1][n];
            self.between[n] = factors(quintic);
        }
        // The defect between the stages, less what stiff parts hold back.
        let m = system.layout.phi + 1;
        let (mut there, mut rates) = (y.clone(), y.clone());
        let (mut worst, mut table) = (0.0, vec![0.0; m * (m + 1)]);
        for (share, weight) in WATCHED.into_iter().zip(ERROR_OF_DEFECT) {
            for (n, quintic) in quintics.iter().enumerate() {
                there[n] = y[n] + value(quintic, share);
            }
            system.rates(t + share * h, &there, &mut rates);
            let defect = |n: usize| weight * (slope_and_bend(&quintics[n], share).0 - h * rates[n]);
            for r in 0..m {
                for c in 0..m {
                    table[r * (m + 1) + c] = f64::from(u8::from(r == c)) - h * GAMMA * self.slopes[r * m + c];
                }
                table[r * (m + 1) + m] = defect(r);
            }
            solve(&mut table, m, 1);
            for n in 0..y.len() {
                let error = if n < m { table[n * (m + 1) + m] } else { defect(n) };
                worst = worse(worst, over(error, scale(n, there[n].abs()), there[n].abs()));
            }
        }
        worst
    }

    /// What the state rises by until each stage; none where Newton's method does not converge.
    fn solved(
        &self,
        system: &mut System<'_>,
        scale: &impl Fn(usize, f64) -> f64,
        (t, y): (f64, &[f64]),
        h: f64,
    ) -> Option<[Vec<f64>; S]> {
        let m = system.layout.phi + 1;
        let matrix = Factors::of(h, &self.slopes, m);
        let mut rises = C.map(|c| self.rate.iter().map(|rate| c * h * rate).collect::<Vec<f64>>());
        let mut rates: [Vec<f64>; S] = std::array::from_fn(|_| y.to_vec());
        let (mut there, mut off, mut last) = (y.to_vec(), vec![0.0; S * m], f64::INFINITY);
        for _ in 0..SWEEPS_MAX {
            for i in 0..S {
                for n in 0..y.len() {
                    there[n] = y[n] + rises[i][n];
                }
                system.rates(t + C[i] * h, &there, &mut rates[i]);
            }
            for i in 0..S {
                for n in 0..y.len() {
                    let by_rates: f64 = (0..S).map(|j| A[i][j] * rates[j][n]).sum::<f64>() * h;
                    if n < m {
                        off[i * m + n] = by_rates - rises[i][n];
                    } else {
                        // Works follow from the motion.
                        rises[i][n] = by_rates;
                    }
                }
            }
            matrix.solve(&mut off);
            let mut worst = 0.0;
            for i in 0..S {
                for n in 0..m {
                    rises[i][n] += off[i * m + n];
                    worst = worse(worst, off[i * m + n].abs() / scale(n, (y[n] + rises[i][n]).abs()));
                }
            }
            if worst <= SOLVED || (worst <= 1.0 && worst >= SHRINKS * last) {
                return Some(rises);
            }
            if worst.is_nan() || worst >= 2.0 * last {
                return None;
            }
            last = worst;
        }
        None
    }
}

/// Triangular factors of 1 − h A ⊗ J, rows exchanged for large pivots.
struct Factors {
    rows: Vec<f64>,
    order: Vec<usize>,
}

impl Factors {
    fn of(h: f64, slopes: &[f64], m: usize) -> Self {
        let n = S * m;
        let mut rows = vec![0.0; n * n];
        for i in 0..S {
            for j in 0..S {
                for r in 0..m {
                    for c in 0..m {
                        let one = f64::from(u8::from(i == j && r == c));
                        rows[(i * m + r) * n + j * m + c] = one - h * A[i][j] * slopes[r * m + c];
                    }
                }
            }
        }
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let size = |i: usize| rows[i * n + k].abs();
            let pivot = (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            if pivot != k {
                order.swap(k, pivot);
                let (above, below) = rows.split_at_mut(pivot * n);
                above[k * n..][..n].swap_with_slice(&mut below[..n]);
            }
            let (above, below) = rows.split_at_mut((k + 1) * n);
            let row = &above[k * n..];
            let inverse = 1.0 / row[k];
            for other in below.chunks_exact_mut(n) {
                let factor = other[k] * inverse;
                other[k] = factor;
                if factor != 0.0 {
                    for c in k + 1..n {
                        other[c] -= factor * row[c];
                    }
                }
            }
        }
        Factors { rows, order }
    }

    fn solve(&self, right: &mut [f64]) {
        let n = right.len();
        let given = right.to_vec();
        for k in 0..n {
            let known: f64 = (0..k).map(|c| self.rows[k * n + c] * right[c]).sum();
            right[k] = given[self.order[k]] - known;
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|c| self.rows[k * n + c] * right[c]).sum();
            right[k] = (right[k] - known) / self.rows[k * n + k];
        }
    }
}
