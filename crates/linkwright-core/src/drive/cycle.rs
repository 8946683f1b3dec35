//! One cycle of steady motion, a revolution or as many as the loads take to repeat: the periodic solution of the
//! machine's equation of motion over the crank angle.
//!
//! ```text
//! du/dφ = ε = [M_d(ω) − M_r(φ, ω) − J′(φ) u] / J(φ),   ω = √(2u),   u(2π) = u(0)
//! ```
//!
//! u = ½ ω² is the state (paper 1, equation (1), divided by J): its derivative by the angle *is* the
//! acceleration, so the acceleration is known as well as the solution is, also where a steep motor leaves
//! little of it. The revolution is divided from kink to kink into steps of [`crate::kernel::radau`]; the stages of all
//! steps and the closure u(2π) = u(0) are solved together by Newton. Eliminating the stages step by step
//! leaves the Newton step of the return map, and the product of the steps' growth is that map's
//! derivative: the multiplier of a small disturbance over one revolution (stable when below 1 in size).

use crate::drive::law::LawGeometry;
use crate::drive::layout::{Layout, bundle};
use crate::drive::structure::Plan;
use crate::kernel::branch::OnBranch;
use crate::kernel::call::poll;
use crate::kernel::dual::Dual;
use crate::kernel::plane::Angle;
use crate::kernel::radau::{B, C, N, S, StageNewton, stage_newton, through, value};
use crate::kernel::real::{Lift, Real};
use crate::linkage::motion::Motion;

/// The reduced machine at one stage: all that the equation of motion needs besides u.
#[derive(Clone, Copy, Debug)]
pub struct Row<R> {
    /// 1/J \[1/(kg m²)\].
    pub inverse: R,
    /// J′/J \[1/rad\].
    pub drift: R,
    /// Load torque that does not depend on speed \[N m\].
    pub load: R,
    /// Viscous coefficient \[N m s/rad\].
    pub viscous: R,
}

/// A step of the revolution: where it starts, how long it is, its stages.
#[derive(Clone, Copy, Debug)]
pub struct Step<R> {
    /// Crank angle at its start \[rad\].
    pub phi: R,
    /// Length \[rad\].
    pub h: R,
    /// The machine at its stages.
    pub rows: [Row<R>; S],
    /// u at its start \[rad²/s²\].
    pub u: R,
    /// u at its stages.
    pub X: [R; S],
    /// ε at its stages \[rad/s²\].
    pub K: [R; S],
    /// ∂ε/∂u at its stages \[1/rad\].
    pub D: [R; S],
    /// Derivative of its end by its start.
    pub growth: R,
}

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

/// A machine with its parameters in lanes of `R`: what every function of a revolution works on.
#[derive(Clone, Copy)]
pub struct Machine<'a, R> {
    /// Its structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [R],
    /// Whether the laws at all stages of a step keep to one branch, that of [`REFERENCE`]: where a law jumps at some speed
    /// the jump is the end of a step then, and rounding does not decide on which side of it a stage lies.
    pub keeps_branch: bool,
    /// The state that chooses the branch of all stages in the place of [`REFERENCE`]: what laws know there, and u.
    pub side: Option<(&'a [LawGeometry<R>], R)>,
    /// How far \[rad\] inside a step its ends are known to be on its side, where the machine may jump there at an angle; 0 where it
    /// does not.
    pub(super) inside: f64,
}

/// Ends of steps are as near \[rad\] to the angles at which the machine jumps, and so far inside they are on the side of the step, but
/// by no more than a share of it.
const AT_JUMP: f64 = 1e-12;
const AT_JUMP_OF_STEP: f64 = 0.25;

/// The stage whose state chooses the branch: well inside the step.
pub const REFERENCE: usize = 2;

/// Newton sweeps before giving up. From a good start 5 suffice; 40 leave room for damped ones.
const SWEEPS_MAX: u32 = 40;

/// A sweep may lower u at most to this share of itself, so that roots stay real.
pub(super) const SHRINK: f64 = 0.25;

/// Newton sweeps of a step on its own.
const STEP_SWEEPS: usize = 16;

/// Relative correction after which the stages of a step have converged: the next would be about its square.
pub const CONVERGED: f64 = 1e-8;

/// Largest correction of the last sweep that counts as converged at all.
const SOLVED: f64 = 1e-6;

impl<'a, R: Real> Machine<'a, R> {
    /// A machine that is evaluated as it is at every stage.
    pub fn new(plan: &'a Plan, q: &'a [R]) -> Self {
        let inside = if plan.jumps_over_angle() { AT_JUMP } else { 0.0 };
        Machine { plan, q, keeps_branch: false, side: None, inside }
    }

    /// A machine that is read on the side of the step also where it only bends at an angle, so that derivatives jump.
    #[must_use]
    pub fn keeping_sides_of_bends(self) -> Self {
        let inside = if self.plan.bends_over_angle() { AT_JUMP } else { 0.0 };
        Machine { inside, ..self }
    }

    /// A machine whose steps each keep to one branch, or not.
    #[must_use]
    pub fn keeping_branch(self, keeps_branch: bool) -> Self {
        Machine { keeps_branch, ..self }
    }

    /// ε without laws.
    #[inline(always)]
    fn drive_acceleration<N: Lift<R>>(&self, row: &Row<R>, u: N) -> N {
        let omega = (u * 2.0).sqrt();
        let torque = self.plan.drive.torque(&self.plan.tables, self.q, omega);
        let net = torque - N::lift(row.load) - N::lift(row.viscous) * omega;
        net * N::lift(row.inverse) - N::lift(row.drift) * u
    }

    /// ε, and its derivative by u.
    #[inline(always)]
    pub fn acceleration(&self, row: &Row<R>, geometry: &[LawGeometry<R>], u: R) -> Dual<R> {
        let free = self.drive_acceleration(row, Dual::variable(u));
        if geometry.is_empty() {
            return free;
        }
        let taken = self.laws(geometry, (Dual::variable(u) * 2.0).sqrt());
        free - taken * Dual::constant(row.inverse)
    }

    /// The same with laws on the branch of a reference, which has its own `known` and u. The drive's torque is continuous.
    #[inline(always)]
    pub fn acceleration_on_branch(
        &self,
        row: &Row<R>,
        geometry: &[LawGeometry<R>],
        u: R,
        (known, at): (&[LawGeometry<R>], R),
    ) -> Dual<R> {
        let free = self.drive_acceleration(row, Dual::variable(u));
        if geometry.is_empty() {
            return free;
        }
        let u = OnBranch { value: Dual::variable(u), at };
        let taken = self.laws_on_branch(geometry, known, (u * 2.0).sqrt()).value;
        free - taken * Dual::constant(row.inverse)
    }

    /// Load torque of all laws at a stage; no time counts, since no turn differs from another.
    #[inline(always)]
    pub fn laws<N: Lift<R>>(&self, geometry: &[LawGeometry<R>], omega: N) -> N {
        N::out_of_line(
            #[inline(always)]
            || self.plan.law_torque::<R, R, N>(self.q, geometry, omega, N::splat(f64::NAN)),
        )
    }

    /// The same on the branch of a reference, where the laws know what is `known`.
    #[inline(always)]
    pub fn laws_on_branch<N>(&self, geometry: &[LawGeometry<R>], known: &[LawGeometry<R>], omega: N) -> N
    where
        N: Lift<R> + Lift<OnBranch<R, R>>,
    {
        let both: Vec<LawGeometry<OnBranch<R, R>>> =
            geometry.iter().zip(known).map(|(geometry, known)| geometry.on_branch_of(known)).collect();
        N::out_of_line(
            #[inline(always)]
            || self.plan.law_torque::<R, OnBranch<R, R>, N>(self.q, &both, omega, N::splat(f64::NAN)),
        )
    }

    /// What the laws need to know at one stage of several.
    #[inline(always)]
    pub fn geometry_at<'g>(&self, geometry: &'g [LawGeometry<R>], stage: usize) -> &'g [LawGeometry<R>] {
        let n = self.plan.laws.len();
        &geometry[stage * n..(stage + 1) * n]
    }

    /// Whether the laws at a stage are on the branch of [`REFERENCE`].
    #[inline(always)]
    pub fn is_on_branch(&self, stage: usize) -> bool {
        self.keeps_branch || (self.inside > 0.0 && stage == S - 1)
    }

    /// ε at the stages of a step, and its derivatives.
    #[inline(always)]
    fn accelerations(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> ([R; S], [R; S]) {
        let (rows, X) = (&step.rows, &step.X);
        let (mut f, mut d) = (*X, *X);
        for i in 0..S {
            if self.is_on_branch(i) {
                continue;
            }
            let free = self.drive_acceleration(&rows[i], Dual::variable(X[i]));
            (f[i], d[i]) = (free.value, free.d);
        }
        for i in 0..S {
            let own = self.geometry_at(geometry, i);
            if self.is_on_branch(i) {
                let reference = self.side.unwrap_or((self.geometry_at(geometry, REFERENCE), X[REFERENCE]));
                let epsilon = self.acceleration_on_branch(&rows[i], own, X[i], reference);
                (f[i], d[i]) = (epsilon.value, epsilon.d);
            } else if !geometry.is_empty() {
                let taken = self.laws(own, (Dual::variable(X[i]) * 2.0).sqrt());
                (f[i], d[i]) = (f[i] - taken.value * rows[i].inverse, d[i] - taken.d * rows[i].inverse);
            }
        }
        (f, d)
    }

    /// A step with a known solution, and what its laws need to know.
    #[inline(always)]
    pub fn step_of(
        &self,
        phi: R,
        h: R,
        u: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        let mut geometry = Vec::new();
        let rows = self.rows(phi, h, m, &mut geometry);
        (Step { X, ..Step::at_rest(phi, h, rows, u) }, geometry)
    }

    /// Growth of a step that ends on a kink of the drive, with the slope that the drive's torque has on its side of the
    /// kink; the step's own has the slope that rounding chose. The torque itself is the same on either side.
    #[inline(always)]
    pub fn growth_on_side(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> R {
        let (f, mut d) = self.accelerations(step, geometry);
        d[S - 1] = d[S - 1] + self.slope_besides(&step.rows[S - 1], step.X[S - 1], step.X[REFERENCE]);
        stage_newton(step.u, step.h, &f, &d, &step.X).u[S - 1]
    }

    /// What the slope ∂ε/∂u by the drive has on the branch of a reference besides that which rounding chose, on a kink.
    #[inline(always)]
    pub(super) fn slope_besides(&self, row: &Row<R>, u: R, reference: R) -> R {
        let on_branch = OnBranch { value: Dual::variable(u), at: reference };
        self.drive_acceleration(row, on_branch).value.d - self.drive_acceleration(row, on_branch.value).d
    }

    /// Where the stages of a step lie on another branch than the one that the step keeps to: the most that this makes of
    /// u at its end. The last stage lies on the kink itself.
    #[inline(always)]
    pub fn off_branch(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> R {
        let mut sum = R::splat(0.0);
        for i in 0..S - 1 {
            let own = self.acceleration(&step.rows[i], self.geometry_at(geometry, i), step.X[i]).value;
            sum = (own - step.K[i]).abs().mul_add(step.h * B[i], sum);
        }
        sum
    }

    /// The reduced machine at a crank angle; what its laws need to know there is added to `geometry`.
    #[inline(always)]
    pub fn row(&self, phi: R, m: &mut Motion<R>, geometry: &mut Vec<LawGeometry<R>>) -> Row<R> {
        R::out_of_line(
            #[inline(always)]
            || {
                let r = self.plan.reduce::<R, 2>(self.q, Angle::new(phi), 1.0, m);
                if !self.plan.laws.is_empty() {
                    self.plan.add_geometry(self.q, phi, m, geometry);
                }
                let inverse = r.J.recip();
                Row { inverse, drift: r.J_d1 * inverse, load: r.load + r.dry, viscous: r.viscous }
            },
        )
    }

    /// The reduced machine at an end of a step, on its side of a jump there: drawn on from two angles inside, of which the
    /// other is farther `inside` by as much. Read at the nearer one it would not be what the speed at the end belongs to, and a steep
    /// drive would make that angle times its steepness of it.
    #[inline(always)]
    fn row_at_end(&self, phi: R, inside: R, m: &mut Motion<R>, geometry: &mut Vec<LawGeometry<R>>) -> Row<R> {
        if self.inside == 0.0 {
            return self.row(phi, m, geometry);
        }
        let mut none = Vec::new();
        let [far, near] = [inside + inside, inside].map(|by| self.row(phi + by, m, &mut none));
        if !self.plan.laws.is_empty() {
            self.row(phi, m, geometry);
        }
        near.drawn_on_from(&far)
    }

    /// ε at the start of a step, on its side where it may jump there, of which the geometry of its stages is known.
    #[inline(always)]
    pub fn start(&self, step: &Step<R>, geometry: &[LawGeometry<R>], m: &mut Motion<R>) -> R {
        let mut own = Vec::with_capacity(self.plan.laws.len());
        let row = self.row_at_end(step.phi, self.inside_by(step.h), m, &mut own);
        if !(self.keeps_branch || self.inside > 0.0) {
            return self.acceleration(&row, &own, step.u).value;
        }
        let known = (self.geometry_at(geometry, REFERENCE), step.X[REFERENCE]);
        self.acceleration_on_branch(&row, &own, step.u, known).value
    }

    /// How far inside a step its ends are known to be on its side.
    #[inline(always)]
    fn inside_by(&self, h: R) -> R {
        (h * AT_JUMP_OF_STEP).min(R::splat(self.inside))
    }

    /// The reduced machine at a stage of a step; at the end on the side of the step.
    #[inline(always)]
    fn row_at(
        &self,
        (phi, h): (R, R),
        stage: usize,
        m: &mut Motion<R>,
        geometry: &mut Vec<LawGeometry<R>>,
    ) -> Row<R> {
        let at = h.mul_add(R::splat(C[stage]), phi);
        if stage == S - 1 {
            self.row_at_end(at, -self.inside_by(h), m, geometry)
        } else {
            self.row(at, m, geometry)
        }
    }

    /// The stages of a step.
    #[inline(always)]
    fn rows(&self, phi: R, h: R, m: &mut Motion<R>, geometry: &mut Vec<LawGeometry<R>>) -> [Row<R>; S] {
        let mut rows = [Row { inverse: h, drift: h, load: h, viscous: h }; S];
        for i in 0..S {
            rows[i] = self.row_at((phi, h), i, m, geometry);
        }
        rows
    }

    /// A step of its own from (`phi`, `u`) on by `h`, and what its laws needed. This is how the solution is
    /// read between the steps of the revolution. Lanes that do not converge are NaN.
    #[inline(always)]
    pub fn advance(&self, phi: R, u: R, h: R, m: &mut Motion<R>) -> (Step<R>, Vec<LawGeometry<R>>) {
        self.advance_near(phi, u, h, [u; S], m)
    }

    /// The same with stages to start from.
    #[inline(always)]
    pub fn advance_near(
        &self,
        phi: R,
        u: R,
        h: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        self.advance_within(CONVERGED, phi, u, h, X, m)
    }

    /// The same until the relative correction is below a limit.
    #[inline(always)]
    pub fn advance_within(
        &self,
        limit: f64,
        phi: R,
        u: R,
        h: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        let mut geometry = Vec::new();
        let rows = self.rows(phi, h, m, &mut geometry);
        let step = R::out_of_line(
            #[inline(always)]
            || self.solve_step(Step { X, ..Step::at_rest(phi, h, rows, u) }, &geometry, limit),
        );
        (step, geometry)
    }

    /// Newton for the stages of a step from its start values.
    #[inline(always)]
    fn solve_step(&self, mut step: Step<R>, geometry: &[LawGeometry<R>], limit: f64) -> Step<R> {
        let mut worst = R::splat(f64::INFINITY);
        for _ in 0..STEP_SWEEPS {
            let newton = self.step_newton(&mut step, geometry, worst, limit);
            let correction = step.take(&newton, R::splat(0.0), worst, limit);
            worst = worst.select_lt(R::splat(limit), worst, correction);
            if worst.max_lane() < limit {
                break;
            }
        }
        // A NaN is not below the limit.
        step.X[S - 1] = worst.select_lt(R::splat(SOLVED), step.X[S - 1], R::splat(f64::NAN));
        step.K[S - 1] = worst.select_lt(R::splat(SOLVED), step.K[S - 1], R::splat(f64::NAN));
        step
    }

    /// One Newton step for the stages of a step. Lanes whose last correction was small enough keep what they
    /// have: no lane's bits depend on how long another takes.
    #[inline(always)]
    fn step_newton(
        &self,
        step: &mut Step<R>,
        geometry: &[LawGeometry<R>],
        correction: R,
        limit: f64,
    ) -> StageNewton<R> {
        let limit = R::splat(limit);
        let (f, d) = self.accelerations(step, geometry);
        let newton = stage_newton(step.u, step.h, &f, &d, &step.X);
        for i in 0..S {
            step.K[i] = correction.select_lt(limit, step.K[i], f[i]);
            step.D[i] = correction.select_lt(limit, step.D[i], d[i]);
        }
        step.growth = correction.select_lt(limit, step.growth, newton.u[S - 1]);
        newton
    }

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

impl<R: Real> Row<R> {
    /// What a row and one before it make of one as far behind it, all near each other.
    #[inline(always)]
    fn drawn_on_from(&self, before: &Self) -> Self {
        Row {
            inverse: self.inverse + (self.inverse - before.inverse),
            drift: self.drift + (self.drift - before.drift),
            load: self.load + (self.load - before.load),
            viscous: self.viscous + (self.viscous - before.viscous),
        }
    }
}

impl<R: Real> Step<R> {
    /// A step whose stages are still those of its start.
    #[inline(always)]
    fn at_rest(phi: R, h: R, rows: [Row<R>; S], u: R) -> Self {
        let zero = R::splat(0.0);
        Step { phi, h, rows, u, X: [u; S], K: [zero; S], D: [zero; S], growth: zero }
    }

    /// A step whose stages are not known, as the machine there is not.
    #[inline(always)]
    pub(super) fn unsolved(phi: R, h: R, u: R) -> Self {
        let zero = R::splat(0.0);
        let row = Row { inverse: zero, drift: zero, load: zero, viscous: zero };
        Self::at_rest(phi, h, [row; S], u)
    }

    /// u at its end: the last stage.
    #[inline(always)]
    pub fn end(&self) -> R {
        self.X[S - 1]
    }

    /// Quintic through u at its start and its stages, over the share of the step.
    #[inline(always)]
    pub fn quintic(&self) -> [R; N] {
        let mut values = [self.u; N];
        values[1..].copy_from_slice(&self.X);
        through(&values)
    }

    /// Corrects the stages for a correction of the start; the largest relative correction.
    #[inline(always)]
    fn take(&mut self, newton: &StageNewton<R>, delta: R, last: R, limit: f64) -> R {
        let (mut worst, limit) = (R::splat(0.0), R::splat(limit));
        for i in 0..S {
            let change = newton.u[i].mul_add(delta, newton.p[i]);
            let next = (self.X[i] + change).max(self.X[i] * SHRINK);
            let next = last.select_lt(limit, self.X[i], next);
            // The tangent gives ε at the corrected stage to the square of the correction.
            self.K[i] = self.D[i].mul_add(next - self.X[i], self.K[i]);
            worst = worst.max(change.abs() / self.X[i]);
            self.X[i] = next;
        }
        worst
    }

    /// Steepest ∂ε/∂u of its stages, in size \[1/rad\].
    #[inline(always)]
    pub fn steepness(&self) -> R {
        let mut steepest = self.D[0].abs();
        for d in &self.D[1..] {
            steepest = steepest.max(d.abs());
        }
        steepest
    }

    /// How long the step takes \[s\]: ∫ dφ/ω.
    #[inline(always)]
    pub fn duration(&self) -> R {
        let mut t = R::splat(0.0);
        for i in 0..S {
            t = (self.h * B[i] / (self.X[i] * 2.0).sqrt()) + t;
        }
        t
    }
}

/// Stages of a part of a step, from share `from` on by share `length`, on the step's quintic; not below a
/// share of what the part starts from, where a polynomial may swing.
#[inline(always)]
pub fn stages_of_part<R: Real>(quintic: &[R; N], from: R, length: R) -> [R; S] {
    let mut X = [from; S];
    let least = value(quintic, from) * SHRINK;
    for i in 0..S {
        X[i] = value(quintic, length.mul_add(R::splat(C[i]), from)).max(least);
    }
    X
}

impl<R: Real> Turn<R> {
    /// Machines in lanes, each with its own ends of steps; lanes with fewer steps are filled up at its end.
    #[inline(always)]
    pub fn tabulate_machines(&mut self, machine: &Machine<'_, R>, edges: &[&[f64]], m: &mut Motion<R>) {
        let most = edges.iter().map(|lane| lane.len()).max().unwrap_or(0);
        let at = |lane: &[f64], k: usize| lane.get(k).copied().unwrap_or(machine.plan.cycle());
        let mut starts = vec![0.0; R::LANES];
        let mut ends = starts.clone();
        let mut steps = Vec::with_capacity(most);
        for k in 1..most {
            for (lane, edges) in edges.iter().enumerate() {
                (starts[lane], ends[lane]) = (at(edges, k - 1), at(edges, k));
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
    }

    /// The stages of a step, which has its start and length; what laws need there is added to `geometry`.
    #[inline(always)]
    pub fn take_rows(&mut self, machine: &Machine<'_, R>, k: usize, m: &mut Motion<R>) {
        let step = &mut self.steps[k];
        for i in 0..S {
            step.rows[i] = machine.row_at((step.phi, step.h), i, m, &mut self.geometry);
        }
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
        let u = machine.guess_speed(self).squared() * 0.5;
        for step in &mut self.steps {
            (step.u, step.X) = (u, [u; S]);
        }
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
            R::out_of_line(
                #[inline(always)]
                || self.sweep(machine, &mut work),
            );
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
            R::out_of_line(
                #[inline(always)]
                || self.sweep(machine, &mut Vec::with_capacity(self.steps.len())),
            );
            self.limit = converged;
            self.sweeps += 1;
        }
        is_needed
    }

    /// ε at the stages of a start.
    #[inline(always)]
    pub(super) fn take_accelerations(&mut self, machine: &Machine<'_, R>) {
        let laws = S * machine.plan.laws.len();
        for (k, step) in self.steps.iter_mut().enumerate() {
            step.K = machine.accelerations(step, &self.geometry[k * laws..(k + 1) * laws]).0;
        }
    }

    /// Newton for the stages of every step on its own, then for the starts of all steps together.
    #[inline(always)]
    pub fn sweep(&mut self, machine: &Machine<'_, R>, work: &mut Vec<StageNewton<R>>) {
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
