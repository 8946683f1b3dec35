//! One cycle of steady motion, a revolution or as many as the loads take to repeat: the periodic solution of the
//! machine's equation of motion over the crank angle ([`crate::drive::equation`]).
//!
//! The revolution is divided from kink to kink into steps ([`crate::drive::step`]); the stages of all steps and the closure
//! u(2π) = u(0) are solved together by Newton. Eliminating the stages step by step leaves the Newton step of the return map,
//! and the product of the steps' growth is that map's derivative: the multiplier of a small disturbance over one revolution
//! (stable when below 1 in size).

use crate::drive::equation::Machine;
use crate::drive::law::LawGeometry;
use crate::drive::layout::{Layout, bundle};
use crate::drive::step::{CONVERGED, SHRINK, Step};
use crate::kernel::call::poll;
use crate::kernel::dual::Dual;
use crate::kernel::out_of_line;
use crate::kernel::radau::{B, S, StageNewton};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// A revolution in steps, and what the solution took.
#[derive(Clone, Debug)]
pub struct Turn<R> {
    /// The steps from φ = 0 to 2π.
    pub steps: Vec<Step<R>>,
    /// What the laws need to know at the stages, law by law, stage by stage, step by step.
    pub geometry: Vec<LawGeometry<R>>,
    /// What the lanes hold.
    pub layout: Layout,
    /// Derivative of the return map.
    pub multiplier: R,
    /// Newton sweeps over the revolution.
    pub sweeps: u32,
    /// Largest relative correction of the last sweep, of the revolution in each lane.
    pub correction: R,
    /// Relative correction after which a lane has converged: the next would be about its square.
    pub limit: f64,
    /// What follows u at the end of each step, as [`Turn::pass`] took it; none where u itself does.
    pub passed: Vec<[R; 2]>,
}

/// Newton sweeps before giving up. From a good start 5 suffice; 40 leave room for damped ones.
const SWEEPS_MAX: u32 = 40;

impl<R: Real> Machine<'_, R> {
    /// Steady speed of a crank with constant load: where the drive's torque balances mean load and viscous
    /// drag, by Newton from the drive's starting speed. A first guess only, so it need not converge.
    #[inline(always)]
    fn guess_speed(&self, turn: &Turn<R>) -> R {
        let (load, viscous) = turn.mean_load(self.plan.cycle());
        let start = self.q[self.plan.drive.speed_start];
        let (low, high) = (start * 0.02, start * 3.0);
        let mut omega = start;
        for _ in 0..6 {
            let w = Dual::variable(omega);
            let mut net = self.plan.drive.torque(&self.plan.tables, self.q, w)
                - Dual::constant(load)
                - Dual::constant(viscous) * w;
            if !turn.geometry.is_empty() {
                net = net - turn.mean_laws(self, w);
            }
            let next = omega - net.value / net.d;
            omega = next.max(low).min(high);
        }
        // Where a flat characteristic just balances the load this is 0/0: stay at the start then.
        omega.select_lt(high * 2.0, omega, start)
    }
}

impl<R: Real> Turn<R> {
    /// Machines in lanes, each with its own ends of as many steps.
    #[inline(always)]
    pub fn tabulate_machines(&mut self, machine: &Machine<'_, R>, edges: &[&[f64]], m: &mut Motion<R>) {
        let n = edges[0].len();
        let mut starts = vec![0.0; R::LANES];
        let mut ends = starts.clone();
        let mut steps = Vec::with_capacity(n);
        for k in 1..n {
            for (lane, edges) in edges.iter().enumerate() {
                (starts[lane], ends[lane]) = (edges[k - 1], edges[k]);
            }
            let start = R::load(&starts);
            steps.push((start, R::load(&ends) - start));
        }
        self.tabulate_again(machine, &steps, m);
    }

    /// One machine, its steps between the given angles in lanes, the last bundle filled up at the end.
    #[inline(always)]
    pub fn of_steps(machine: &Machine<'_, R>, edges: &[f64], m: &mut Motion<R>) -> Self {
        let (mut phi, mut h): (Vec<f64>, Vec<f64>) =
            edges.windows(2).map(|ends| (ends[0], ends[1] - ends[0])).unzip();
        let filled = phi.len().next_multiple_of(R::LANES);
        phi.resize(filled, machine.plan.cycle());
        h.resize(filled, 0.0);
        let steps = bundle(&phi).into_iter().zip(bundle(&h)).collect();
        Self::tabulate(machine, steps, Layout::Steps, m)
    }

    /// A revolution without steps.
    #[inline(always)]
    pub fn empty(layout: Layout) -> Self {
        Turn {
            steps: Vec::new(),
            geometry: Vec::new(),
            layout,
            multiplier: R::splat(0.0),
            sweeps: 0,
            correction: R::splat(f64::INFINITY),
            limit: CONVERGED,
            passed: Vec::new(),
        }
    }

    /// Steps from (start, length) pairs, not solved yet.
    #[inline(always)]
    pub fn tabulate(machine: &Machine<'_, R>, steps: Vec<(R, R)>, layout: Layout, m: &mut Motion<R>) -> Self {
        let mut turn = Self::empty(layout);
        turn.tabulate_again(machine, &steps, m);
        turn
    }

    /// The same in the place of this turn: a revolution of machines in lanes takes some hundred thousand bytes, which a batch
    /// asks for once.
    #[inline(always)]
    pub fn tabulate_again(&mut self, machine: &Machine<'_, R>, steps: &[(R, R)], m: &mut Motion<R>) {
        out_of_line!(R, {
            let zero = R::splat(0.0);
            self.geometry.clear();
            self.passed.clear();
            if self.steps.len() != steps.len() {
                self.steps.resize(steps.len(), Step::unsolved(zero, zero, zero));
            }
            for (k, &(phi, h)) in steps.iter().enumerate() {
                (self.steps[k].phi, self.steps[k].h) = (phi, h);
                self.take_rows(machine, k, m);
            }
            (self.multiplier, self.sweeps, self.correction) = (zero, 0, R::splat(f64::INFINITY));
        })
    }

    /// The stages of a step, which has its start and length; what laws need there is added to `geometry`.
    #[inline(always)]
    pub fn take_rows(&mut self, machine: &Machine<'_, R>, k: usize, m: &mut Motion<R>) {
        let step = &mut self.steps[k];
        step.rows = machine.rows(step.phi, step.h, m, &mut self.geometry);
    }

    /// What the laws need to know at the stages of a step.
    #[inline(always)]
    pub fn geometry_of(&self, machine: &Machine<'_, R>, k: usize) -> &[LawGeometry<R>] {
        let n = S * machine.plan.laws.len();
        &self.geometry[k * n..(k + 1) * n]
    }

    /// Starts every step from one constant speed that balances the mean load.
    #[inline(always)]
    pub fn start_from_balance(&mut self, machine: &Machine<'_, R>) {
        out_of_line!(R, {
            let u = machine.guess_speed(self).squared() * 0.5;
            for step in &mut self.steps {
                (step.u, step.X) = (u, [u; S]);
            }
        })
    }

    /// Means over the revolution of the load and of the viscous coefficient.
    #[inline(always)]
    fn mean_load(&self, cycle: f64) -> (R, R) {
        let (mut load, mut viscous) = (R::splat(0.0), R::splat(0.0));
        for step in &self.steps {
            for i in 0..S {
                let weight = step.h * (B[i] / cycle);
                load = weight.mul_add(step.rows[i].load, load);
                viscous = weight.mul_add(step.rows[i].viscous, viscous);
            }
        }
        (self.layout.total(load), self.layout.total(viscous))
    }

    /// Mean over the revolution of the laws' load torque at one constant speed.
    #[inline(always)]
    fn mean_laws(&self, machine: &Machine<'_, R>, omega: Dual<R>) -> Dual<R> {
        let mut sum = Dual::constant(R::splat(0.0));
        for (k, step) in self.steps.iter().enumerate() {
            let geometry = self.geometry_of(machine, k);
            for i in 0..S {
                let torque = machine.laws(machine.geometry_at(geometry, i), omega);
                sum = torque * Dual::constant(step.h * (B[i] / machine.plan.cycle())) + sum;
            }
        }
        Dual { value: self.layout.total(sum.value), d: self.layout.total(sum.d) }
    }

    /// Solves for the periodic motion until every lane has converged, or until it is clear that some will
    /// not.
    #[inline(always)]
    pub fn solve(&mut self, machine: &Machine<'_, R>) {
        let mut work = Vec::with_capacity(self.steps.len());
        while self.sweeps < SWEEPS_MAX && self.correction.max_lane() >= self.limit {
            poll();
            self.sweep(machine, &mut work);
            self.sweeps += 1;
        }
    }

    /// One more sweep over a solved revolution whose last correction exceeds a limit: the growth of its steps is that before the
    /// correction. Whether it was made.
    #[inline(always)]
    pub fn polish(&mut self, machine: &Machine<'_, R>, limit: f64) -> bool {
        let is_needed = self.correction.max_lane() > limit;
        if is_needed {
            let converged = std::mem::replace(&mut self.limit, 0.0);
            self.sweep(machine, &mut Vec::with_capacity(self.steps.len()));
            self.limit = converged;
            self.sweeps += 1;
        }
        is_needed
    }

    /// ε at the stages of a start.
    #[inline(always)]
    pub(super) fn take_accelerations(&mut self, machine: &Machine<'_, R>) {
        out_of_line!(R, {
            let laws = S * machine.plan.laws.len();
            for (k, step) in self.steps.iter_mut().enumerate() {
                step.K = machine.accelerations(step, &self.geometry[k * laws..(k + 1) * laws]).0;
            }
        })
    }

    /// Newton for the stages of every step on its own, then for the starts of all steps together.
    #[inline(always)]
    pub fn sweep(&mut self, machine: &Machine<'_, R>, work: &mut Vec<StageNewton<R>>) {
        out_of_line!(R, {
            work.clear();
            let mut starts = Vec::with_capacity(self.steps.len());
            let laws = S * machine.plan.laws.len();
            for (k, step) in self.steps.iter_mut().enumerate() {
                let geometry = &self.geometry[k * laws..(k + 1) * laws];
                work.push(machine.step_newton(step, geometry, self.correction, self.limit));
                starts.push(step.u);
            }
            let ends = self.layout.ends(&starts);
            let (mut growth, mut defect) = (starts, ends);
            for (k, step) in self.steps.iter().enumerate() {
                growth[k] = step.growth;
                let mut end = step.end() + work[k].p[S - 1];
                if let Some(&[scale, offset]) = self.passed.get(k) {
                    growth[k] = growth[k] * scale;
                    end = end.mul_add(scale, offset);
                }
                defect[k] = end - defect[k];
            }
            let (delta, multiplier) = self.layout.close(&growth, &defect);
            let (mut worst, done, limit) = (R::splat(0.0), self.correction, R::splat(self.limit));
            for ((step, newton), delta) in self.steps.iter_mut().zip(work.iter()).zip(delta) {
                worst = worst.max(step.take(newton, delta, done, self.limit));
                let next = (step.u + delta).max(step.u * SHRINK);
                step.u = done.select_lt(limit, step.u, next);
            }
            self.multiplier = done.select_lt(limit, self.multiplier, multiplier);
            self.correction = done.select_lt(limit, done, self.layout.highest(worst));
        })
    }

    /// Whether every dyad closes, and the machine has inertia, at every stage.
    #[inline(always)]
    pub fn closes(&self) -> bool {
        let mut worst = R::splat(0.0);
        for step in &self.steps {
            for row in &step.rows {
                // NaN, which an open dyad leaves, is not below the limit.
                worst = worst.max(row.inverse.select_lt(R::splat(f64::INFINITY), worst, R::splat(1.0)));
            }
        }
        worst.max_lane() < 0.5
    }
}

/// Ends of equal steps, `n` a revolution at least, from break to break.
pub fn divide(breaks: &[f64], n: usize) -> Vec<f64> {
    let longest = std::f64::consts::TAU / n as f64;
    let mut edges = vec![0.0];
    for ends in breaks.windows(2) {
        let length = ends[1] - ends[0];
        // The guard keeps a segment of exactly n·longest from being cut into n + 1 by rounding.
        let count = (length / longest - 1e-9).ceil();
        edges.extend((1..count as usize).map(|i| ends[0] + length * (i as f64 / count)));
        edges.extend((length > 0.0).then_some(ends[1]));
    }
    edges
}
