//! The linear system of all steps of a cycle about a solution: (1 − h A ⊗ F) δX = δy + right side, closed over the cycle.

use linkwright_core::drive::layout::{bundle, unbundle};
use linkwright_driveline::equation::{Equation, Rates};
use linkwright_driveline::mesh::Rows;
use linkwright_driveline::steady::Steady;
use linkwright_kernel::matrix::LuFactors;
use linkwright_kernel::radau::{A, C, S, value};
use linkwright_kernel::real::Real;

/// How far before the end of its step the last stage is read, as a share of the step: on the side of the step of a kink of the
/// motor's characteristic, at which derivatives of the torque leap and of which the angle is known to less than that.
const INSIDE: f64 = 1e-6;

/// Places of the stages where they are read.
pub(crate) const READ: [f64; S] = [C[0], C[1], C[2], C[3], 1.0 - INSIDE];

/// All steps.
pub(crate) struct Sweep {
    m: usize,
    /// Of every step its system, taken apart.
    systems: Vec<LuFactors<f64>>,
    /// ∂(stages of a step)/∂(its start), row by row, of every step.
    pub(crate) by_start: Vec<Vec<f64>>,
    /// 1 − M, taken apart.
    closure: LuFactors<f64>,
}

/// A state where a stage is read.
pub(crate) fn state_read(steady: &Steady, k: usize, i: usize) -> Vec<f64> {
    let solution = &steady.solution;
    if i + 1 < S {
        return solution.stage(k, i).to_vec();
    }
    (0..solution.states()).map(|number| value(&solution.quintic(k, number), READ[i])).collect()
}

impl Sweep {
    /// About a solution.
    pub(crate) fn new(equation: Equation<'_>, steady: &Steady) -> Self {
        let (mesh, m) = (&steady.mesh, equation.chain.states());
        let n = S * m;
        let at = |pair: &[f64]| READ.map(|c| pair[0] + c * (pair[1] - pair[0]));
        let rows = Rows::at(&equation, &mesh.edges.windows(2).flat_map(at).collect::<Vec<f64>>());
        let mut rates = Rates::new(equation.chain);
        let (mut systems, mut by_start) = (Vec::new(), Vec::new());
        let mut end = identity(m);
        for k in 0..mesh.steps() {
            let mut jacobians = Vec::with_capacity(S * m * m);
            for i in 0..S {
                equation.rates(&rows.row(k * S + i), &state_read(steady, k, i), &mut rates);
                jacobians.extend_from_slice(&rates.jacobian);
            }
            let h = mesh.length(k);
            let mut system = LuFactors::new(n);
            system.factor(|row, column| {
                let (i, r, j, s) = (row / m, row % m, column / m, column % m);
                f64::from(u8::from(row == column)) - h * A[i][j] * jacobians[(j * m + r) * m + s]
            });
            let mut own = vec![0.0; n * m];
            for start in 0..m {
                let mut side: Vec<f64> = (0..n).map(|row| f64::from(u8::from(row % m == start))).collect();
                system.solve(&mut side);
                side.iter().enumerate().for_each(|(row, x)| own[row * m + start] = *x);
            }
            end = product(&own[(n - m) * m..], &end, m);
            systems.push(system);
            by_start.push(own);
        }
        let mut closure = LuFactors::new(m);
        closure.factor(|r, c| f64::from(u8::from(r == c)) - end[r * m + c]);
        Sweep { m, systems, by_start, closure }
    }

    /// ∂(end of a step)/∂(its start), row by row.
    pub(crate) fn end_by_start(&self, k: usize) -> &[f64] {
        &self.by_start[k][(S - 1) * self.m * self.m..]
    }

    /// Stages of a step for a right side, its start held.
    #[inline(always)]
    pub(crate) fn stages<R: Real>(&self, k: usize, side: &[R]) -> Vec<R> {
        lane_by_lane(&self.systems[k], side)
    }

    /// The start of a cycle whose end is `off` where its start is held.
    #[inline(always)]
    pub(crate) fn closed<R: Real>(&self, off: &[R]) -> Vec<R> {
        lane_by_lane(&self.closure, off)
    }
}

/// Solves for the right side of every lane.
#[inline(always)]
fn lane_by_lane<R: Real>(system: &LuFactors<f64>, side: &[R]) -> Vec<R> {
    let mut all = unbundle(side);
    for lane in 0..R::LANES {
        let mut own: Vec<f64> = all.iter().skip(lane).step_by(R::LANES).copied().collect();
        system.solve(&mut own);
        for (to, x) in all.iter_mut().skip(lane).step_by(R::LANES).zip(own) {
            *to = x;
        }
    }
    bundle(&all)
}

/// The unit matrix, row by row.
pub(crate) fn identity(m: usize) -> Vec<f64> {
    (0..m * m).map(|at| f64::from(u8::from(at / m == at % m))).collect()
}

/// The product of two square matrices.
pub(crate) fn product(first: &[f64], second: &[f64], m: usize) -> Vec<f64> {
    let entry = |at: usize| (0..m).map(|j| first[at / m * m + j] * second[j * m + at % m]).sum();
    (0..m * m).map(entry).collect()
}
