//! One turn of steady motion: the periodic solution of the machine's energy equation.
//!
//! ```text
//! dE/dφ = M_d(ω) − M_r(φ) − c(φ) ω,   ω = √(2E/J(φ)),   E(2π) = E(0)
//! ```
//!
//! E is the kinetic energy ½ J ω² (paper 1, equation (1), with E for its state, which needs no dJ/dφ).
//! The turn is divided from kink to kink into steps of [`crate::gauss`]; the stages of all steps and the
//! closure E(2π) = E(0) are solved together by Newton. Eliminating the stages step by step leaves the
//! Newton step of the turn-to-turn map, and the product of the steps' growth is that map's derivative: the
//! multiplier of a small disturbance over one turn (stable when below 1 in size).

use crate::call::poll;
use crate::dual::Dual;
use crate::gauss::{B, C, S, StageNewton, stage_newton};
use crate::law::Given;
use crate::layout::{Layout, bundle};
use crate::linkage::Motion;
use crate::plan::Plan;
use crate::plane::Angle;
use crate::real::{Lift, Real};
use std::f64::consts::TAU;

/// The reduced machine at one stage: all that the energy equation needs besides E.
#[derive(Clone, Copy, Debug)]
pub struct Row<R> {
    /// √(2/J), so that ω = √(2/J)·√E.
    pub root: R,
    /// dJ/dφ \[kg m²/rad\]; zero where only the energy is asked for.
    pub J_d1: R,
    /// Resisting torque that does not depend on speed \[N m\].
    pub load: R,
    /// Viscous coefficient \[N m s/rad\].
    pub viscous: R,
}

/// A step of the turn: where it starts, how long it is, its stages.
#[derive(Clone, Copy, Debug)]
pub struct Step<R> {
    /// Crank angle at its start \[rad\].
    pub phi: R,
    /// Length \[rad\].
    pub h: R,
    /// The machine at its stages.
    pub rows: [Row<R>; S],
    /// Kinetic energy at its start \[J\].
    pub E: R,
    /// Kinetic energy at its stages \[J\].
    pub X: [R; S],
}

/// A turn in steps, and what the solution took.
#[derive(Clone, Debug)]
pub struct Turn<R> {
    /// The steps from φ = 0 to 2π.
    pub steps: Vec<Step<R>>,
    /// What the laws need to know at the stages, law by law, stage by stage, step by step.
    pub given: Vec<Given<R>>,
    /// What the lanes hold.
    pub layout: Layout,
    /// Derivative of the turn-to-turn map.
    pub multiplier: R,
    /// Newton sweeps over the turn.
    pub sweeps: u32,
    /// Largest relative correction of the last sweep in any lane; NaN lanes are passed over.
    pub correction: f64,
}

/// A machine with its parameters in lanes of `R`: what every function of a turn works on.
#[derive(Clone, Copy)]
pub struct Machine<'a, R> {
    /// Its structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [R],
}

/// Newton sweeps before giving up. From a good start 5 suffice; 40 leave room for damped ones.
const SWEEPS_MAX: u32 = 40;

/// A sweep may lower an energy at most to this share of itself, so that roots stay real.
const SHRINK: f64 = 0.25;

impl<R: Real> Machine<'_, R> {
    /// Energy balance dE/dφ without laws, and its derivative by E.
    #[inline(always)]
    pub fn balance(&self, row: &Row<R>, E: R) -> Dual<R> {
        let omega = Dual::variable(E).sqrt() * Dual::constant(row.root);
        let torque = self.plan.drive_torque(self.q, omega);
        torque - Dual::constant(row.load) - Dual::constant(row.viscous) * omega
    }

    /// What the laws take from the balance, and its derivative by E.
    #[inline(always)]
    pub fn taken(&self, row: &Row<R>, given: &[Given<R>], E: R) -> Dual<R> {
        self.laws(given, Dual::variable(E).sqrt() * Dual::constant(row.root))
    }

    /// Resisting torque of all laws at a stage; no time counts, since no turn differs from another.
    #[inline(always)]
    pub fn laws<N: Lift<R>>(&self, given: &[Given<R>], omega: N) -> N {
        N::outline(
            #[inline(always)]
            || self.plan.law_torque(self.q, given, omega, N::splat(f64::NAN)),
        )
    }

    /// What the laws need to know at one stage of several.
    #[inline(always)]
    pub fn given_at<'a>(&self, given: &'a [Given<R>], stage: usize) -> &'a [Given<R>] {
        let n = self.plan.laws.len();
        &given[stage * n..(stage + 1) * n]
    }

    /// The energy balance at the stages of a step: values and derivatives.
    #[inline(always)]
    fn balances(&self, rows: &[Row<R>; S], given: &[Given<R>], X: &[R; S]) -> ([R; S], [R; S]) {
        let (mut f, mut d) = (*X, *X);
        for i in 0..S {
            let balance = self.balance(&rows[i], X[i]);
            (f[i], d[i]) = (balance.value, balance.d);
        }
        if !given.is_empty() {
            for i in 0..S {
                let taken = self.taken(&rows[i], self.given_at(given, i), X[i]);
                (f[i], d[i]) = (f[i] - taken.value, d[i] - taken.d);
            }
        }
        (f, d)
    }

    /// The reduced machine at a crank angle; what its laws need to know there is added to `given`.
    #[inline(always)]
    pub fn row<const ORDER: u8>(&self, phi: R, m: &mut Motion<R>, given: &mut Vec<Given<R>>) -> Row<R> {
        let r = self.plan.reduce::<R, ORDER>(self.q, Angle::new(phi), 1.0, m);
        if !self.plan.laws.is_empty() {
            self.plan.give(self.q, phi, m, given);
        }
        let root = (R::splat(2.0) / r.J).sqrt();
        Row { root, J_d1: r.J_d1, load: r.load + r.dry, viscous: r.viscous }
    }

    /// The four stages of a step.
    #[inline(always)]
    fn rows<const ORDER: u8>(
        &self,
        phi: R,
        h: R,
        m: &mut Motion<R>,
        given: &mut Vec<Given<R>>,
    ) -> [Row<R>; S] {
        let mut rows = [Row { root: h, J_d1: h, load: h, viscous: h }; S];
        for i in 0..S {
            rows[i] = self.row::<ORDER>(h.mul_add(R::splat(C[i]), phi), m, given);
        }
        rows
    }

    /// Energy after going on by `h` from (`phi`, `E`): one step of order 8 of its own. This is how the
    /// solution is read between the steps of the turn, with the accuracy it has at their ends.
    #[inline(always)]
    pub fn advance(&self, phi: R, E: R, h: R, m: &mut Motion<R>) -> R {
        self.step_from(phi, E, h, m).1
    }

    /// [`Machine::advance`] with the time it takes \[s\].
    #[inline(always)]
    pub fn advance_timed(&self, phi: R, E: R, h: R, m: &mut Motion<R>) -> (R, R) {
        let (step, end) = self.step_from(phi, E, h, m);
        (end, step.duration())
    }

    /// One step solved on its own, and the energy at its end.
    #[inline(always)]
    fn step_from(&self, phi: R, E: R, h: R, m: &mut Motion<R>) -> (Step<R>, R) {
        let mut given = Vec::new();
        let rows = self.rows::<1>(phi, h, m, &mut given);
        let mut X = [E; S];
        let mut end = E;
        // From E itself, off by some percent, Newton squares the error: 1e-3, 1e-7, 1e-14.
        for _ in 0..3 {
            let (f, d) = self.balances(&rows, &given, &X);
            let newton = stage_newton(E, h, &f, &d, &X);
            for i in 0..S {
                X[i] = X[i] + newton.p[i];
            }
            end = newton.end;
        }
        (Step { phi, h, rows, E, X }, end)
    }

    /// Steady speed of a crank with constant load: where the drive's torque balances mean load and viscous
    /// drag, by Newton from the drive's starting speed. A first guess only, so it need not converge.
    #[inline(always)]
    fn guess_speed(&self, turn: &Turn<R>) -> R {
        let (load, viscous) = turn.mean_load();
        let start = self.q[self.plan.drive.speed_start];
        let (low, high) = (start * 0.02, start * 3.0);
        let mut omega = start;
        for _ in 0..6 {
            let w = Dual::variable(omega);
            let mut net =
                self.plan.drive_torque(self.q, w) - Dual::constant(load) - Dual::constant(viscous) * w;
            if !turn.given.is_empty() {
                net = net - turn.mean_laws(self, w);
            }
            let next = omega - net.value / net.d;
            omega = next.max(low).min(high);
        }
        // Where a flat characteristic just balances the load this is 0/0: stay at the start then.
        omega.select_lt(high * 2.0, omega, start)
    }
}

impl<R: Real> Step<R> {
    /// How long the step takes \[s\]: ∫ dφ/ω.
    #[inline(always)]
    pub fn duration(&self) -> R {
        let mut t = R::splat(0.0);
        for i in 0..S {
            t = (self.h * B[i] / (self.rows[i].root * self.X[i].sqrt())) + t;
        }
        t
    }
}

impl<R: Real> Turn<R> {
    /// Machines in lanes: divides the turn at `breaks` (increasing, from 0 to 2π, lanes may differ) into
    /// steps no longer than 2π/`n`, the longest lane deciding, and tabulates the machines at their stages.
    #[inline(always)]
    pub fn of_machines(machine: &Machine<'_, R>, breaks: &[R], n: usize, m: &mut Motion<R>) -> Self {
        Self::tabulate(machine, divide(breaks, n), Layout::Machines, m)
    }

    /// One machine, its steps in lanes, the last bundle filled up at 2π.
    #[inline(always)]
    pub fn of_steps(machine: &Machine<'_, R>, breaks: &[f64], n: usize, m: &mut Motion<R>) -> Self {
        let (mut phi, mut h): (Vec<f64>, Vec<f64>) = divide(breaks, n).into_iter().unzip();
        let filled = phi.len().next_multiple_of(R::LANES);
        phi.resize(filled, TAU);
        h.resize(filled, 0.0);
        let steps = bundle(&phi).into_iter().zip(bundle(&h)).collect();
        Self::tabulate(machine, steps, Layout::Steps, m)
    }

    #[inline(always)]
    fn tabulate(machine: &Machine<'_, R>, steps: Vec<(R, R)>, layout: Layout, m: &mut Motion<R>) -> Self {
        let zero = R::splat(0.0);
        let mut tabulated = Vec::with_capacity(steps.len());
        let mut given = Vec::with_capacity(steps.len() * S * machine.plan.laws.len());
        for (phi, h) in steps {
            let rows = R::outline(
                #[inline(always)]
                || machine.rows::<2>(phi, h, m, &mut given),
            );
            tabulated.push(Step { phi, h, rows, E: zero, X: [zero; S] });
        }
        Turn { steps: tabulated, given, layout, multiplier: zero, sweeps: 0, correction: f64::INFINITY }
    }

    /// Starts every energy from one constant speed that balances the mean load.
    #[inline(always)]
    pub fn start_from_balance(&mut self, machine: &Machine<'_, R>) {
        let omega = machine.guess_speed(self);
        for step in &mut self.steps {
            for i in 0..S {
                step.X[i] = (omega / step.rows[i].root).squared();
            }
            step.E = step.X[0];
        }
    }

    /// Means over the turn of the load and of the viscous coefficient.
    #[inline(always)]
    fn mean_load(&self) -> (R, R) {
        let (mut load, mut viscous) = (R::splat(0.0), R::splat(0.0));
        for step in &self.steps {
            for i in 0..S {
                let weight = step.h * (B[i] / TAU);
                load = weight.mul_add(step.rows[i].load, load);
                viscous = weight.mul_add(step.rows[i].viscous, viscous);
            }
        }
        (self.layout.total(load), self.layout.total(viscous))
    }

    /// Mean over the turn of the laws' resisting torque at one constant speed.
    #[inline(always)]
    fn mean_laws(&self, machine: &Machine<'_, R>, omega: Dual<R>) -> Dual<R> {
        let mut sum = Dual::constant(R::splat(0.0));
        for (k, step) in self.steps.iter().enumerate() {
            for i in 0..S {
                let torque = machine.laws(machine.given_at(&self.given, k * S + i), omega);
                sum = torque * Dual::constant(step.h * (B[i] / TAU)) + sum;
            }
        }
        Dual { value: self.layout.total(sum.value), d: self.layout.total(sum.d) }
    }

    /// Solves for the periodic motion until no lane's correction exceeds `tolerance` (relative), or until
    /// it is clear that some lane will not converge.
    #[inline(always)]
    pub fn solve(&mut self, machine: &Machine<'_, R>, tolerance: f64) {
        let mut work = Vec::with_capacity(self.steps.len());
        // Newton's correction squares from sweep to sweep: below √tolerance the next is below tolerance.
        let last = tolerance.sqrt().min(1e-7);
        while self.sweeps < SWEEPS_MAX {
            poll();
            R::outline(
                #[inline(always)]
                || self.sweep(machine, &mut work),
            );
            self.sweeps += 1;
            if self.correction <= last {
                return;
            }
        }
    }

    /// Newton for the stages of every step on its own, then for the starts of all steps together.
    #[inline(always)]
    fn sweep(&mut self, machine: &Machine<'_, R>, work: &mut Vec<StageNewton<R>>) {
        work.clear();
        let mut starts = Vec::with_capacity(self.steps.len());
        let laws = S * machine.plan.laws.len();
        for (k, step) in self.steps.iter().enumerate() {
            let given = &self.given[k * laws..(k + 1) * laws];
            let (f, d) = machine.balances(&step.rows, given, &step.X);
            work.push(stage_newton(step.E, step.h, &f, &d, &step.X));
            starts.push(step.E);
        }
        let ends = self.layout.ends(&starts);
        let (mut growth, mut defect) = (starts, ends);
        for k in 0..work.len() {
            growth[k] = work[k].growth;
            defect[k] = work[k].end - defect[k];
        }
        let (delta, multiplier) = self.layout.close(&growth, &defect);
        self.multiplier = multiplier;
        let mut worst = R::splat(0.0);
        for ((step, newton), delta) in self.steps.iter_mut().zip(work.iter()).zip(delta) {
            for i in 0..S {
                let change = newton.u[i].mul_add(delta, newton.p[i]);
                worst = worst.max(change.abs() / step.X[i]);
                step.X[i] = (step.X[i] + change).max(step.X[i] * SHRINK);
            }
            step.E = (step.E + delta).max(step.E * SHRINK);
        }
        self.correction = worst.max_lane();
    }
}

/// Start and length of equal steps, no longer than 2π/`n` in any lane, from break to break.
#[inline(always)]
fn divide<R: Real>(breaks: &[R], n: usize) -> Vec<(R, R)> {
    let longest = TAU / n as f64;
    let mut steps = Vec::with_capacity(n + breaks.len());
    for ends in breaks.windows(2) {
        let length = ends[1] - ends[0];
        // The guard keeps a segment of exactly n·longest from being cut into n + 1 by rounding.
        let count = (length.max_lane() / longest - 1e-9).ceil();
        let h = length * (1.0 / count.max(1.0));
        for i in 0..count as usize {
            steps.push((h.mul_add(R::splat(i as f64), ends[0]), h));
        }
    }
    steps
}
