//! A solution along directions: the derivatives of all its numbers, and of its monodromy matrix.

use super::kinks::{Kink, on_sides};
use super::peaks::{Place, Quantity, read};
use super::stage::StageRow;
use super::sweep::{READ, Sweep, identity, product, state_read};
use crate::moving_kinks::MovingKinks;
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::layout::unbundle;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::equation::{Equation, Rates};
use linkwright_driveline::steady::Steady;
use linkwright_driveline::work::Work;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::out_of_line;
use linkwright_kernel::radau::{A, B, N, S, slope_and_bend, through, value};
use linkwright_kernel::real::{LANES_MAX, Real};

/// An end of a step this near to a kink of loads or motion \[rad\] moves with it.
const ON_KINK: f64 = 1e-8;

/// A solution with its derivatives along some directions, one a lane.
pub(super) struct Along<'a, R> {
    equation: Equation<'a, Dual<R>>,
    steady: &'a Steady,
    edges: Vec<Dual<R>>,
    /// Of all stages.
    rows: Vec<StageRow<R>>,
    /// Derivatives of the state at the start and at all stages.
    start: Vec<R>,
    stages: Vec<R>,
    /// By how much the ends of the steps move that lie on kinks of the solution, with its state held at their angles.
    shifts: Vec<R>,
}

impl<'a, R: Real> Along<'a, R> {
    #[inline(always)]
    pub(super) fn new(
        equation: Equation<'a, Dual<R>>,
        steady: &'a Steady,
        sweep: &Sweep,
        kinks: &[Kink],
        m: &mut Motion<Dual<R>>,
    ) -> Self {
        let edges = moving_edges(&equation, steady, m);
        let mut rows = Vec::with_capacity(S * (edges.len() - 1));
        for ends in edges.windows(2) {
            for at in READ {
                rows.push(StageRow::new(&equation, ends[0] + (ends[1] - ends[0]) * at, m));
            }
        }
        let shifts = vec![R::splat(0.0); edges.len()];
        let mut along =
            Along { equation, steady, edges, rows, start: Vec::new(), stages: Vec::new(), shifts };
        out_of_line!(R, along.solve(sweep));
        for kink in kinks {
            along.shifts[kink.step] = out_of_line!(R, along.shift(kink, m));
        }
        along
    }

    /// Length of a step \[rad\].
    #[inline(always)]
    fn length(&self, k: usize) -> Dual<R> {
        self.edges[k + 1] - self.edges[k]
    }

    /// The derivatives of the states.
    #[inline(always)]
    fn solve(&mut self, sweep: &Sweep) {
        let m = self.steady.solution.states();
        let (n, steps) = (S * m, self.steady.mesh.steps());
        let mut rates = Rates::new(self.equation.chain);
        let mut alone = Vec::with_capacity(steps * n);
        let mut end = vec![R::splat(0.0); m];
        for k in 0..steps {
            let mut changes = Vec::with_capacity(n);
            for i in 0..S {
                let y: Vec<Dual<R>> = state_read(self.steady, k, i).into_iter().map(Dual::splat).collect();
                self.equation.rates(&self.rows[k * S + i].row(), &y, &mut rates);
                let h = self.length(k);
                changes.extend(rates.rate.iter().map(|&rate| (h * rate).d));
            }
            let own = sweep.stages(k, &weighted(&changes, m));
            end = applied(sweep.end_by_start(k), &end, &own[n - m..]);
            alone.extend(own);
        }
        self.start = sweep.closed(&end);
        let mut before = self.start.clone();
        for (own, by_start) in alone.chunks_exact(n).zip(&sweep.by_start) {
            let stages = applied(by_start, &before, own);
            before = stages[n - m..].to_vec();
            self.stages.extend(stages);
        }
    }

    /// Coefficients of the quintic of the derivative of a number of the state in a step.
    #[inline(always)]
    fn quintic(&self, k: usize, number: usize) -> [R; N] {
        let m = self.start.len();
        let at = |i: usize| self.stages[(k * S + i) * m + number];
        let mut values = [if k == 0 { self.start[number] } else { self.stages[(k * S - 1) * m + number] }; N];
        for i in 0..S {
            values[i + 1] = at(i);
        }
        through(&values)
    }

    /// State at a share of a step, which moves with its ends.
    #[inline(always)]
    fn state(&self, k: usize, share: f64) -> Vec<Dual<R>> {
        let solution = &self.steady.solution;
        let mut y = Vec::with_capacity(self.start.len());
        for number in 0..self.start.len() {
            let of_state = value(&solution.quintic(k, number), share);
            let d = value(&self.quintic(k, number), R::splat(share));
            y.push(Dual { value: R::splat(of_state), d });
        }
        y
    }

    /// A quantity at its extreme, or at another place that moves with the ends of its step.
    #[inline(always)]
    pub(super) fn at(&self, quantity: Quantity, place: Place, m: &mut Motion<Dual<R>>) -> Dual<R> {
        let Place { step, share } = place.inside();
        let mut phi = self.edges[step] + self.length(step) * share;
        let mut y = self.state(step, share);
        let edge = step + usize::from(share > 0.5);
        if place.is_corner() {
            let (h, shift) = (self.steady.mesh.length(step), self.shifts[edge]);
            phi.d = phi.d + shift;
            for (number, y) in y.iter_mut().enumerate() {
                let slope = slope_and_bend(&self.steady.solution.quintic(step, number), share).0;
                y.d = y.d + shift * (slope / h);
            }
        }
        read(&self.equation, quantity, phi, &y, m)
    }

    /// A quantity at a crank angle that is held.
    #[inline(always)]
    pub(super) fn at_angle(&self, quantity: Quantity, phi: f64, m: &mut Motion<Dual<R>>) -> Dual<R> {
        let mesh = &self.steady.mesh;
        let step = mesh.edges.partition_point(|&edge| edge <= phi).clamp(1, mesh.steps()) - 1;
        let share = (Dual::splat(phi) - self.edges[step]) / self.length(step);
        let mut y = Vec::with_capacity(self.start.len());
        for number in 0..self.start.len() {
            let of_state = self.steady.solution.quintic(step, number).map(Dual::<R>::splat);
            let along = value(&of_state, share);
            let moved = value(&self.quintic(step, number), share.value);
            y.push(Dual { value: along.value, d: along.d + moved });
        }
        read(&self.equation, quantity, Dual::splat(phi), &y, m)
    }

    /// Means and work of a cycle.
    #[inline(always)]
    pub(super) fn work(&self) -> Work<Dual<R>> {
        out_of_line!(R, {
            let chain = self.equation.chain;
            let (mut work, mut rates) = (Work::new(chain), Rates::new(chain));
            for k in 0..self.steady.mesh.steps() {
                for i in 0..S {
                    // Where a step ends at a kink, derivatives are those inside.
                    let y = self.state(k, READ[i]);
                    let angle = self.length(k) * B[i];
                    self.equation.rates(&self.rows[k * S + i].row(), &y, &mut rates);
                    work.add(chain, &rates, &y, angle);
                }
            }
            work
        })
    }

    /// Derivatives of the monodromy matrix M = Π U: those of the steps from the change of their Jacobians, and those by kinks that
    /// move. No number where a kink has no derivative.
    #[inline(always)]
    pub(super) fn monodromy(&self, sweep: &Sweep, kinks: &[Kink]) -> Vec<R> {
        let m = self.start.len();
        let mut rates = Rates::new(self.equation.chain);
        let (mut end, mut moved) = (identity(m), vec![R::splat(0.0); m * m]);
        let mut kinks = kinks.iter().peekable();
        for k in 0..self.steady.mesh.steps() {
            if let Some(kink) = kinks.next_if(|kink| kink.step == k) {
                let bent = product(&kink.bends, &end, m);
                moved.iter_mut().zip(bent).for_each(|(to, bent)| *to = *to + self.shifts[k] * bent);
            }
            let h = self.length(k);
            let mut changes = Vec::with_capacity(S * m * m);
            for i in 0..S {
                let y = self.state(k, READ[i]);
                self.equation.rates(&self.rows[k * S + i].row(), &y, &mut rates);
                changes.extend(rates.jacobian.iter().map(|&entry| (h * entry).d));
            }
            let (by_start, own) = (&sweep.by_start[k], sweep.end_by_start(k));
            // Of U along the directions, column by column.
            let mut columns = Vec::with_capacity(m);
            for start in 0..m {
                let mut change = Vec::with_capacity(S * m);
                for (j, jacobian) in changes.chunks_exact(m * m).enumerate() {
                    let stage = &by_start[j * m * m..][..m * m];
                    for row in jacobian.chunks_exact(m) {
                        let terms = row.iter().zip(stage.iter().skip(start).step_by(m));
                        change.push(terms.fold(R::splat(0.0), |sum, (&d, &u)| sum + d * u));
                    }
                }
                columns.push(sweep.stages(k, &weighted(&change, m)).split_off((S - 1) * m));
            }
            let mut next = vec![R::splat(0.0); m * m];
            for (at, to) in next.iter_mut().enumerate() {
                let (r, c) = (at / m, at % m);
                for j in 0..m {
                    *to = *to + columns[j][r] * end[j * m + c] + moved[j * m + c] * own[r * m + j];
                }
            }
            end = product(own, &end, m);
            moved = next;
        }
        moved
    }

    /// By how much a kink of the solution moves.
    #[inline(always)]
    fn shift(&self, kink: &Kink, m: &mut Motion<Dual<R>>) -> R {
        let mut rates = Rates::new(self.equation.chain);
        let [before, behind] = on_sides(kink.step, |k, share| {
            let phi = self.edges[k] + self.length(k) * share;
            let y = self.state(k, share);
            self.equation.rates(&StageRow::new(&self.equation, phi, m).row(), &y, &mut rates);
            unbundle(&rates.rate.iter().map(|rate| rate.d).collect::<Vec<R>>())
        });
        let mut moves = [0.0; LANES_MAX];
        for (lane, to) in moves.iter_mut().enumerate().take(R::LANES) {
            let own = |all: &[f64]| all.iter().skip(lane).step_by(R::LANES).copied().collect::<Vec<f64>>();
            *to = kink.moves(&own(&before), &own(&behind));
        }
        R::load(&moves)
    }
}

/// Ends of the steps; those on kinks move with them.
#[inline(always)]
fn moving_edges<R: Real>(
    equation: &Equation<'_, Dual<R>>,
    steady: &Steady,
    m: &mut Motion<Dual<R>>,
) -> Vec<Dual<R>> {
    out_of_line!(R, {
        let Equation { plan, q, .. } = *equation;
        let plain: Vec<f64> = q.iter().map(|number| number.value.max_lane()).collect();
        let kinks = kinks(plan, &plain);
        let is_kink = |phi: f64| kinks.iter().any(|kink| (kink - phi).abs() < ON_KINK);
        let on: Vec<f64> = steady.mesh.edges.iter().copied().filter(|&phi| is_kink(phi)).collect();
        let machine = Machine::new(plan, q).keeping_sides_of_bends().keeping_branch(plan.may_jump());
        let mut moved = MovingKinks(machine).moving(&on, m).into_iter().peekable();
        let mut edges = Vec::with_capacity(steady.mesh.edges.len());
        for &phi in &steady.mesh.edges {
            let is_moved = moved.peek().is_some_and(|edge| edge.value.max_lane() == phi);
            let edge = if is_moved { moved.next() } else { None };
            edges.push(edge.unwrap_or(Dual::splat(phi)));
        }
        // The cycle ends where it begins.
        let last = edges.len() - 1;
        edges[last].d = edges[0].d;
        edges
    })
}

/// Σ_j A_ij of what the stages have, stage by stage.
#[inline(always)]
fn weighted<R: Real>(of_stages: &[R], m: usize) -> Vec<R> {
    let mut sums = vec![R::splat(0.0); S * m];
    for i in 0..S {
        for j in 0..S {
            for r in 0..m {
                sums[i * m + r] = sums[i * m + r] + of_stages[j * m + r] * A[i][j];
            }
        }
    }
    sums
}

/// A matrix, row by row, times a vector, added to another.
#[inline(always)]
fn applied<R: Real>(matrix: &[f64], x: &[R], to: &[R]) -> Vec<R> {
    let mut sums = to.to_vec();
    for (sum, row) in sums.iter_mut().zip(matrix.chunks_exact(x.len())) {
        for (&a, &x) in row.iter().zip(x) {
            *sum = *sum + x * a;
        }
    }
    sums
}
