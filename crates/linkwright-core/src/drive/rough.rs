//! A rough motion of machines in lanes, from which Newton's method needs two sweeps in place of five.
//!
//! ```text
//! dE/dφ = M_d(ω) − M_r(φ, ω),   E = J u,   E(2π) = E(0)
//! ```
//!
//! The kinetic energy E takes the place of u, since its derivative needs no J′. Collocation at the start of a step, at one
//! stage and at the end is of order 3, and the machine is known there: a sweep takes two torques and one division a step, a
//! quarter of what the stages take. Where it does not converge the constant speed that balances the mean load remains.

use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::step::SHRINK;
use crate::kernel::dual::Dual;
use crate::kernel::out_of_line;
use crate::kernel::radau::{C, S};
use crate::kernel::real::Real;

/// The stages at which the torque is taken: one well inside the step, and its end.
const TAKEN: [usize; 2] = [2, S - 1];

/// Where the torque is taken, as shares of the step: at its start and at these stages.
const PLACES: [f64; 3] = [0.0, C[TAKEN[0]], C[TAKEN[1]]];

/// Integrals, from the start of a step to its stages, of the parabolas that are 1 at one of the places.
const RISES: [[f64; 3]; S] = rises();

/// Most sweeps.
const SWEEPS_MAX: usize = 8;

/// Relative correction after which a lane stays as it is: the next would be about its square, which is what the steps err by.
const CONVERGED: f64 = 0.03;

const fn rises() -> [[f64; 3]; S] {
    let (mut table, mut i) = ([[0.0; 3]; S], 0);
    while i < S {
        let mut j = 0;
        while j < 3 {
            let (at, a, b) = (PLACES[j], PLACES[(j + 1) % 3], PLACES[(j + 2) % 3]);
            let c = C[i];
            table[i][j] = c * (c * c / 3.0 - (a + b) * c / 2.0 + a * b) / ((at - a) * (at - b));
            j += 1;
        }
        i += 1;
    }
    table
}

/// A step of the rough motion.
#[derive(Clone, Copy)]
struct RoughStep<R> {
    /// Energy at the stages taken \[J\].
    energy: [R; 2],
    /// Torque left at the places \[N m\], and its derivative by the energy there.
    torque: [Dual<R>; 3],
    /// Correction of the energies for the start as it is, and per unit of correction of the start.
    p: [R; 2],
    g: [R; 2],
}

/// Energies of a revolution, kept for the next.
pub(super) struct RoughMotion<R> {
    steps: Vec<RoughStep<R>>,
    growth: Vec<R>,
    defect: Vec<R>,
}

impl<R: Real> Machine<'_, R> {
    /// Torque that drive and loads leave at a stage with an energy, and its derivative by the energy.
    #[inline(always)]
    fn torque_left(&self, turn: &Turn<R>, step: usize, stage: usize, energy: R) -> Dual<R> {
        let known = self.geometry_at(turn.geometry_of(self, step), stage);
        let row = &turn.steps[step].rows[stage];
        let u = Dual { value: energy * row.inverse, d: row.inverse };
        let [_, geared, drag] = self.torques_at(row, known, u);
        geared - drag
    }
}

impl<R: Real> RoughMotion<R> {
    pub(super) fn new() -> Self {
        RoughMotion { steps: Vec::new(), growth: Vec::new(), defect: Vec::new() }
    }

    /// Starts every step of a revolution, which has one constant speed, from the rough motion.
    #[inline(always)]
    pub(super) fn start(&mut self, turn: &mut Turn<R>, machine: &Machine<'_, R>) {
        let zero = R::splat(0.0);
        let nothing = Dual::constant(zero);
        let empty = RoughStep { energy: [zero; 2], torque: [nothing; 3], p: [zero; 2], g: [zero; 2] };
        self.steps.resize(turn.steps.len(), empty);
        for (rough, step) in self.steps.iter_mut().zip(&turn.steps) {
            for i in 0..TAKEN.len() {
                rough.energy[i] = step.u / step.rows[TAKEN[i]].inverse;
            }
        }
        let mut change = R::splat(f64::INFINITY);
        for _ in 0..SWEEPS_MAX {
            change = self.sweep(turn, machine, change);
            if change.max_lane() < CONVERGED {
                break;
            }
        }
        out_of_line!(R, self.give(turn, change));
    }

    /// One sweep of Newton over the revolution; the largest relative correction of each lane. Lanes that have converged keep
    /// what they have: no lane's bits depend on how long another takes.
    #[inline(always)]
    fn sweep(&mut self, turn: &Turn<R>, machine: &Machine<'_, R>, last: R) -> R {
        out_of_line!(R, {
            let (one, limit, n) = (R::splat(1.0), R::splat(CONVERGED), turn.steps.len());
            let mut start = self.steps[n - 1].energy[1];
            let mut before = machine.torque_left(turn, n - 1, TAKEN[1], start);
            self.growth.clear();
            self.defect.clear();
            for k in 0..n {
                let (rough, step) = (&mut self.steps[k], &turn.steps[k]);
                let mut torque = [before; 3];
                for i in 0..TAKEN.len() {
                    torque[i + 1] = machine.torque_left(turn, k, TAKEN[i], rough.energy[i]);
                }
                let (mut r, mut to_start, mut matrix) = ([start; 2], [one; 2], [[one; 2]; 2]);
                for i in 0..TAKEN.len() {
                    let rises = &RISES[TAKEN[i]];
                    r[i] = start - rough.energy[i];
                    for j in 0..PLACES.len() {
                        r[i] = (step.h * rises[j]).mul_add(torque[j].value, r[i]);
                    }
                    to_start[i] = (step.h * rises[0]).mul_add(torque[0].d, one);
                    for j in 0..TAKEN.len() {
                        let entry = torque[j + 1].d * (step.h * -rises[j + 1]);
                        matrix[i][j] = if i == j { entry + one } else { entry };
                    }
                }
                let [[a, b], [c, d]] = matrix;
                let inverse = a.mul_add(d, -(b * c)).recip();
                for (from, to) in [(r, &mut rough.p), (to_start, &mut rough.g)] {
                    to[0] = d.mul_add(from[0], -(b * from[1])) * inverse;
                    to[1] = a.mul_add(from[1], -(c * from[0])) * inverse;
                }
                for (kept, torque) in rough.torque.iter_mut().zip(torque) {
                    *kept = Dual { value: last.select_lt(limit, kept.value, torque.value), ..torque };
                }
                self.growth.push(rough.g[1]);
                self.defect.push(rough.p[1]);
                (start, before) = (rough.energy[1], torque[2]);
            }
            let (delta, _) = turn.layout.close(&self.growth, &self.defect);
            let mut worst = R::splat(0.0);
            for (rough, delta) in self.steps.iter_mut().zip(delta) {
                let at_start = last.select_lt(limit, R::splat(0.0), delta);
                rough.torque[0].value = rough.torque[0].d.mul_add(at_start, rough.torque[0].value);
                for i in 0..TAKEN.len() {
                    let (change, energy) = (rough.g[i].mul_add(delta, rough.p[i]), rough.energy[i]);
                    let next = (energy + change).max(energy * SHRINK);
                    worst = worst.max(change.abs() / energy);
                    rough.energy[i] = last.select_lt(limit, energy, next);
                    let torque = &mut rough.torque[i + 1];
                    torque.value = torque.d.mul_add(rough.energy[i] - energy, torque.value);
                }
            }
            last.select_lt(limit, last, worst)
        })
    }

    /// Gives the steps u at their starts and stages, in the lanes that have converged.
    #[inline(always)]
    fn give(&self, turn: &mut Turn<R>, change: R) {
        let (limit, n) = (R::splat(CONVERGED), turn.steps.len());
        let mut start = self.steps[n - 1].energy[1];
        let mut at_start = start * turn.steps[n - 1].rows[TAKEN[1]].inverse;
        for (rough, step) in self.steps.iter().zip(&mut turn.steps) {
            let balance = step.u;
            step.u = change.select_lt(limit, at_start, balance);
            for i in 0..S {
                let mut energy = start;
                for j in 0..PLACES.len() {
                    energy = (step.h * RISES[i][j]).mul_add(rough.torque[j].value, energy);
                }
                // Where the torque falls fast a parabola may swing.
                let energy = energy.max(start * SHRINK);
                step.X[i] = change.select_lt(limit, energy * step.rows[i].inverse, balance);
            }
            start = rough.energy[1];
            at_start = start * step.rows[TAKEN[1]].inverse;
        }
    }
}
