//! The periodic solution on one mesh, by Newton's method on all stages and the closure of the cycle together.
//!
//! In every step the stages X_i of Radau IIA are unknowns, X_i = y + h Σ a_ij f(X_j). One sweep makes each step linear, which gives
//! its end as p + U δy over its start; chained over the cycle, the closure y(end) = y(0) is one small system. The product of the U
//! is the monodromy matrix, whose eigenvalues are the Floquet multipliers: shares of small disturbances that are left after a cycle.
//!
//! Source: Ascher, Mattheij, Russell, *Numerical Solution of Boundary Value Problems*, ch. 5; Hairer, Wanner, II, IV.8.

use crate::elimination::solve;
use crate::equation::{Equation, Rates};
use crate::mesh::{Mesh, Solution};
use linkwright_kernel::call::poll;
use linkwright_kernel::radau::{A, S};

/// Sweeps of Newton's method at most.
pub(crate) const SWEEPS_MAX: usize = 40;

/// Share to which corrections of a motion that is near fall at least in each sweep.
pub(crate) const FALLS: f64 = 0.5;

/// Sweeps without damping, and the smallest share of a correction that is taken.
const UNDAMPED: usize = 5;
/// See [`UNDAMPED`].
const DAMPED_MOST: f64 = 0.125;

/// Corrections, as a share of what they correct, at which the last sweep has been.
const SMALL: f64 = 1e-9;

/// Corrections that rounding leaves.
const ROUNDING: f64 = 1e-12;

/// A sweep lowers the speed of the crank to no less than this share.
const SPEED_LEFT: f64 = 0.3;

/// Largest correction, as a share of what it corrects, at which sweeps still come near.
const FAR: f64 = 1e6;

/// Share of the way to the stage before at which the end of a step is seen from inside.
const INSIDE: f64 = 1e-6;

/// Where a motion ends that does not go on.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Crank angle from the start of the first cycle \[rad\].
    pub phi: f64,
    /// Last speed of the crank \[rad/s\].
    pub omega: f64,
}

/// Works on one mesh, with its room.
pub struct Cycle<'a> {
    equation: Equation<'a>,
    mesh: &'a Mesh,
    rates: Rates,
    /// Rows of one step's system, with its right sides.
    table: Vec<f64>,
    /// Rates and Jacobians at the stages of a step.
    f: Vec<f64>,
    jacobians: Vec<f64>,
}

impl<'a> Cycle<'a> {
    /// On a mesh.
    pub fn new(equation: Equation<'a>, mesh: &'a Mesh) -> Self {
        let m = equation.chain.states();
        Cycle {
            equation,
            mesh,
            rates: Rates::new(equation.chain),
            table: Vec::new(),
            f: vec![0.0; S * m],
            jacobians: vec![0.0; S * m * m],
        }
    }

    /// Makes a step linear about its stages: corrections of the stages for the start as it is, by that of the start, and
    /// by that of a parameter of which the rates at all stages have these derivatives, in the last columns of the table.
    fn linear_step(&mut self, k: usize, y: &[f64], stages: &[f64], by_parameter: &[f64]) {
        let m = y.len();
        let (h, n) = (self.mesh.length(k), S * m);
        for i in 0..S {
            // The last stage lies on the kink at which the step ends.
            let like = (i == S - 1 && self.mesh.at_kink[k]).then(|| &stages[(i - 1) * m..][..m]);
            let (row, y) = (self.mesh.rows.row(k * S + i), &stages[i * m..][..m]);
            if i == S - 1 {
                // The step may end at a kink, which is seen from inside: values are taken on from there by their slopes.
                let before = &stages[(i - 1) * m..][..m];
                let inside: Vec<f64> =
                    y.iter().zip(before).map(|(y, before)| y + INSIDE * (before - y)).collect();
                self.equation.rates_before(&row, &inside, like, &mut self.rates);
                self.rates.take_on(&inside, y);
            } else {
                self.equation.rates(&row, y, &mut self.rates);
            }
            self.f[i * m..][..m].copy_from_slice(&self.rates.rate);
            self.jacobians[i * m * m..][..m * m].copy_from_slice(&self.rates.jacobian);
        }
        let own = usize::from(!by_parameter.is_empty());
        let width = n + 1 + m + own;
        self.table.clear();
        self.table.resize(n * width, 0.0);
        for i in 0..S {
            for r in 0..m {
                let row = &mut self.table[(i * m + r) * width..][..width];
                let mut right = y[r] - stages[i * m + r];
                for j in 0..S {
                    let weight = h * A[i][j];
                    let jacobian = &self.jacobians[(j * m + r) * m..][..m];
                    for (to, slope) in row[j * m..][..m].iter_mut().zip(jacobian) {
                        *to = -weight * slope;
                    }
                    right += weight * self.f[j * m + r];
                }
                row[i * m + r] += 1.0;
                row[n] = right;
                row[n + 1 + r] = 1.0;
                if own > 0 {
                    let slopes = &by_parameter[k * n..][..n];
                    row[width - 1] = (0..S).map(|j| h * A[i][j] * slopes[j * m + r]).sum();
                }
            }
        }
        solve(&mut self.table, n, width - n);
    }

    /// Makes the cycle linear about a solution: rows of corrections of all stages by what each step begins with, and of the end of the
    /// cycle by its start. Columns: for what they are as they are, by the numbers of the start, and by a parameter if asked for.
    pub(crate) fn linear(&mut self, solution: &Solution, by_parameter: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let m = solution.states();
        let (n, columns) = (S * m, 1 + m + usize::from(!by_parameter.is_empty()));
        let mut solved = vec![0.0; self.mesh.steps() * n * columns];
        let mut end = vec![0.0; m * columns];
        for r in 0..m {
            end[r * columns + 1 + r] = 1.0;
        }
        for k in 0..self.mesh.steps() {
            self.linear_step(k, solution.start_of(k), &solution.stages[k * n..][..n], by_parameter);
            let kept = &mut solved[k * n * columns..][..n * columns];
            for (to, row) in kept.chunks_exact_mut(columns).zip(self.table.chunks_exact(n + columns)) {
                to.copy_from_slice(&row[n..]);
            }
            end = chained(&kept[(n - m) * columns..], &end, m);
        }
        (solved, end)
    }

    /// Newton's method for the periodic solution, from a guess. Gives the monodromy matrix, row by row, or nothing where it does
    /// not converge, or where its corrections do not fall to a half behind some sweeps.
    pub fn periodic(&mut self, solution: &mut Solution, scale: &[f64], patience: usize) -> Option<Vec<f64>> {
        let m = solution.states();
        let (mut last, mut damped) = (f64::INFINITY, 1.0);
        for sweep in 0..SWEEPS_MAX {
            poll();
            let (solved, end) = self.linear(solution, &[]);
            let mut table = closure(&end, solution, 0);
            solve(&mut table, m, 1);
            let start: Vec<f64> = (0..m).map(|r| table[r * (m + 1) + m]).collect();
            let [size, _] = correct(solution, &solved, &start, scale, damped)?;
            if is_last(size, last) {
                return Some(monodromy(&end, m));
            }
            if sweep >= patience && size > FALLS * last {
                return None;
            }
            damped = damping(damped, sweep, size / last);
            last = size;
        }
        None
    }
}

/// Share of the next correction that is taken: between two forms of a law Newton's method may alternate, which shorter steps
/// end.
pub(crate) fn damping(damped: f64, sweep: usize, left: f64) -> f64 {
    if sweep > UNDAMPED && left > 1.0 - 0.5 * damped {
        (0.5 * damped).max(DAMPED_MOST)
    } else {
        (2.0 * damped).min(1.0)
    }
}

/// Whether the last sweep has been, by its correction and the one before.
pub(crate) fn is_last(size: f64, last: f64) -> bool {
    size <= ROUNDING || (size <= SMALL && size >= 0.1 * last) || last <= SMALL
}

/// Derivative of the end of a cycle by its start, row by row.
pub(crate) fn monodromy(end: &[f64], m: usize) -> Vec<f64> {
    end.chunks_exact(end.len() / m).flat_map(|row| row[1..=m].to_vec()).collect()
}

/// Rows of (1 − U) δ − g δλ = p + what the end is beside the start, with `more` columns and rows of a parameter.
pub(crate) fn closure(end: &[f64], solution: &Solution, more: usize) -> Vec<f64> {
    let m = solution.states();
    let (columns, width) = (end.len() / m, m + more + 1);
    let close = &solution.stages[solution.stages.len() - m..];
    let mut table = vec![0.0; (m + more) * width];
    for (r, row) in end.chunks_exact(columns).enumerate() {
        let to = &mut table[r * width..][..width];
        for c in 0..m {
            to[c] = f64::from(u8::from(r == c)) - row[1 + c];
        }
        (0..more).for_each(|j| to[m + j] = -row[1 + m + j]);
        to[width - 1] = row[0] + close[r] - solution.start[r];
    }
    table
}

/// Corrects start and stages by that of the start, and of a parameter behind it; the largest correction over what it corrects, and the
/// share of it that was taken, if sweeps may come near.
pub(crate) fn correct(
    solution: &mut Solution,
    solved: &[f64],
    by: &[f64],
    scale: &[f64],
    damped: f64,
) -> Option<[f64; 2]> {
    let m = solution.states();
    let columns = 1 + by.len();
    let mut corrections = Vec::with_capacity(solution.stages.len());
    let mut before = by.to_vec();
    for rows in solved.chunks_exact(S * m * columns) {
        for row in rows.chunks_exact(columns) {
            corrections.push(row[0] + row[1..].iter().zip(&before).map(|(u, d)| u * d).sum::<f64>());
        }
        before[..m].copy_from_slice(&corrections[corrections.len() - m..]);
    }
    let (mut size, mut share) = (0.0_f64, damped);
    for (y, d) in solution.stages.chunks_exact(m).zip(corrections.chunks_exact(m)) {
        for r in 0..m {
            size = size.max(d[r].abs() / scale[r]);
        }
        if d[m - 1] < 0.0 {
            share = share.min((1.0 - SPEED_LEFT) * y[m - 1] / -d[m - 1]);
        }
    }
    if !size.is_finite() || size > FAR || corrections.iter().any(|d| d.is_nan()) {
        return None;
    }
    for (y, d) in solution.stages.iter_mut().zip(&corrections) {
        *y += share * d;
    }
    for (y, d) in solution.start.iter_mut().zip(by) {
        *y += share * d;
    }
    Some([if share < damped { size.max(1.0) } else { size }, share])
}

/// p, U and g of a step behind those of what is before it.
fn chained(step: &[f64], before: &[f64], m: usize) -> Vec<f64> {
    let columns = before.len() / m;
    let mut found = vec![0.0; m * columns];
    for (row, to) in step.chunks_exact(columns).zip(found.chunks_exact_mut(columns)) {
        to[0] = row[0];
        to[1 + m..].copy_from_slice(&row[1 + m..]);
        for (u, before) in row[1..=m].iter().zip(before.chunks_exact(columns)) {
            for (to, x) in to.iter_mut().zip(before) {
                *to += u * x;
            }
        }
    }
    found
}
