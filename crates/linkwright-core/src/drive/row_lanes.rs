//! Rows of a batch side by side in lanes.

use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::law::Moment;
use crate::drive::layout::{Layout, unbundle};
use crate::drive::loads::FormulaLoad;
use crate::drive::mesh::{Piece, speed_along};
use crate::drive::nested::NodeSolution;
use crate::drive::rough::RoughMotion;
use crate::drive::row_mesh::RowMesh;
use crate::drive::rows::{QUANTITIES, Rows, row_of};
use crate::drive::steep::{Along, SteepKind, Steepness};
use crate::drive::structure::Plan;
use crate::kernel::out_of_line;
use crate::kernel::radau::{C, S};
use crate::kernel::real::Real;
use crate::kernel::status::Status;
use crate::linkage::motion::Motion;
use std::cmp::Ordering;

/// Relative correction after which a revolution has converged: the next is made at the nodes of the steps, is about its
/// square, and what it leaves is measured.
const CONVERGED: f64 = 1e-4;

/// Relative correction after which ends of steps are moved to the kinks that a motion passes for the first time.
const PLACING: f64 = 0.03;

/// Most times that they are moved.
const PLACEMENTS: usize = 6;

/// The rough motion passes a kink for sure where it lies beyond it on both sides by this share of u: it errs by less.
const CLEAR: f64 = 0.01;

/// Ends of steps farther from their kinks \[rad\] are not placed well enough.
const PLACED: f64 = 1e-6;

/// Relative error that a row in lanes may have, as measured.
const PROMISED: f64 = 1e-7;

/// The same of peaks of acceleration, which rounding of the speed alone may cost where the drive is steep.
pub(super) const PEAKS_PROMISED: f64 = 1e-6;

/// Most meshes that a row is solved on; rows that ask for more are solved one by one.
const MESHES_MAX: usize = 4;

/// Rows of a bundle, and where their results go.
pub(super) struct Results<'a> {
    /// Number of the first row of the chunk in the batch.
    pub first: usize,
    /// Of the rows of the chunk.
    pub status: &'a mut [Status],
    /// Their results one after the other.
    pub out: &'a mut [f64],
}

/// What bundles of rows are solved with.
pub(super) struct RowLanes<'a, R> {
    plan: &'a Plan,
    rows: &'a Rows<'a>,
    q: Vec<R>,
    m: Motion<R>,
    turn: Turn<R>,
    /// What to start from.
    rough: RoughMotion<R>,
    /// The solution at the nodes of its steps.
    nested: NodeSolution<R>,
}

/// What becomes of a solved row.
#[derive(Clone, Copy, PartialEq)]
enum Verdict {
    /// It has its result.
    Good,
    /// It passes kinks of the drive inside its steps.
    Kinks,
    /// Some of its steps are too long.
    Coarse,
    /// It is to be solved on its own.
    Refused,
}

impl<'a, R: Real> RowLanes<'a, R> {
    #[inline(always)]
    pub(super) fn new(plan: &'a Plan, rows: &'a Rows<'a>) -> Self {
        let q: Vec<R> = rows.base.iter().map(|&x| R::splat(x)).collect();
        let m = Motion::new(&plan.mechanism, &q);
        let turn = Turn { limit: CONVERGED, ..Turn::empty(Layout::Machines) };
        RowLanes { plan, rows, q, m, turn, rough: RoughMotion::new(), nested: NodeSolution::new() }
    }

    /// The meshes of rows of which nothing is known.
    #[inline(always)]
    pub(super) fn new_meshes(&mut self, rows: &[usize], first: usize) -> Vec<RowMesh> {
        self.load(rows.iter().copied(), first);
        let (machine, m) = (Machine::new(self.plan, &self.q), &mut self.m);
        let breaks = machine.ends(m);
        rows.iter().zip(breaks).map(|(&row, breaks)| RowMesh::new(row, breaks)).collect()
    }

    /// Solves rows of which nothing is known; returns the turns swept. Those that need other meshes are added to the list.
    #[inline(always)]
    pub(super) fn solve_new(
        &mut self,
        mut meshes: Vec<RowMesh>,
        to: &mut Results<'_>,
        next: &mut Vec<RowMesh>,
    ) -> u64 {
        out_of_line!(R, {
            self.load(meshes.iter().map(|mesh| mesh.row), to.first);
            self.tabulate(&meshes);
            let (machine, turn, rough) = (Machine::new(self.plan, &self.q), &mut self.turn, &mut self.rough);
            turn.start_from_balance(&machine);
            rough.start(turn, &machine);
            if out_of_line!(R, self.place_rough_kinks(&mut meshes)) {
                next.append(&mut meshes);
                return 0;
            }
            let (machine, turn) = (Machine::new(self.plan, &self.q), &mut self.turn);
            turn.solve(&machine);
            self.take(meshes, R::splat(0.0), to, next)
        })
    }

    /// Makes ends of steps where the rough motion of a row clearly passes kinks of the drive; whether any does. All rows then
    /// keep it, to be solved beside others with as many steps.
    #[inline(always)]
    fn place_rough_kinks(&mut self, meshes: &mut [RowMesh]) -> bool {
        let (mut low, mut high) = (R::splat(f64::INFINITY), R::splat(0.0));
        for step in &self.turn.steps {
            for &u in &step.X {
                (low, high) = (low.min(u), high.max(u));
            }
        }
        let kinks = self.speeds_between(low * (1.0 + CLEAR), high * (1.0 - CLEAR), meshes.len());
        if kinks.iter().all(Vec::is_empty) {
            return false;
        }
        let (machine, turn) = (Machine::new(self.plan, &self.q), &mut self.turn);
        turn.take_accelerations(&machine);
        turn.give_samples(meshes);
        let has_kinks: Vec<bool> = kinks.iter().map(|kinks| !kinks.is_empty()).collect();
        turn.give_starts(meshes, &has_kinks);
        for (mesh, kinks) in meshes.iter_mut().zip(&kinks).filter(|(_, kinks)| !kinks.is_empty()) {
            mesh.place_kinks(kinks);
        }
        true
    }

    /// The same of rows with a solution on other meshes.
    #[inline(always)]
    pub(super) fn solve_again(
        &mut self,
        mut meshes: Vec<RowMesh>,
        to: &mut Results<'_>,
        next: &mut Vec<RowMesh>,
    ) -> u64 {
        out_of_line!(R, {
            self.load(meshes.iter().map(|mesh| mesh.row), to.first);
            self.tabulate(&meshes);
            let (machine, turn, m) = (Machine::new(self.plan, &self.q), &mut self.turn, &mut self.m);
            turn.start_from_samples(&meshes);
            turn.limit = PLACING;
            let mut lost = turn.solve_lanes(&machine, R::splat(0.0));
            turn.limit = CONVERGED;
            let mut displaced = R::splat(0.0);
            for placement in 0..=PLACEMENTS {
                displaced = turn.move_to_kinks(&machine, &mut meshes, m);
                if placement > 0 && displaced.max_lane() <= 0.0 {
                    break;
                }
                lost = turn.solve_lanes(&machine, lost);
            }
            turn.correction = R::splat(0.0).select_lt(lost, lost, turn.correction);
            self.take(meshes, displaced, to, next)
        })
    }

    #[inline(always)]
    fn load(&mut self, rows: impl Iterator<Item = usize>, first: usize) {
        let numbers: Vec<usize> = rows.map(|row| first + row).collect();
        self.rows.lanes(&numbers, &mut self.q);
        self.m.ground(&self.plan.mechanism, &self.q);
    }

    #[inline(always)]
    fn tabulate(&mut self, meshes: &[RowMesh]) {
        let (machine, turn, m) = (Machine::new(self.plan, &self.q), &mut self.turn, &mut self.m);
        let mut edges: Vec<&[f64]> = meshes.iter().map(|mesh| &mesh.edges[..]).collect();
        edges.resize(R::LANES, &meshes[meshes.len() - 1].edges);
        turn.tabulate_machines(&machine, &edges, m);
    }

    /// Takes the results of the solved rows that are good, and makes meshes for those that need others.
    #[inline(always)]
    fn take(
        &mut self,
        mut meshes: Vec<RowMesh>,
        displaced: R,
        to: &mut Results<'_>,
        next: &mut Vec<RowMesh>,
    ) -> u64 {
        out_of_line!(R, {
            let n = meshes.len() as u64;
            let kinks = self.kinks_passed(meshes.len());
            let is_solved = unbundle(&[self.turn.correction]);
            let mut verdicts = vec![Verdict::Good; meshes.len()];
            let passes = kinks.iter().any(|kinks| !kinks.is_empty());
            if passes {
                let turn = &self.turn;
                turn.give_samples(&mut meshes);
            }
            for (lane, verdict) in verdicts.iter_mut().enumerate() {
                if is_solved[lane].partial_cmp(&CONVERGED) != Some(Ordering::Less) {
                    *verdict = Verdict::Refused;
                } else if !kinks[lane].iter().all(|&speed| meshes[lane].resolves(speed)) {
                    *verdict = Verdict::Kinks;
                }
            }
            let errors = self.judge(&meshes, displaced, &mut verdicts, to);
            if !passes && verdicts.contains(&Verdict::Coarse) {
                let turn = &self.turn;
                turn.give_samples(&mut meshes);
            }
            self.refuse_pulses(&meshes, &mut verdicts, to.first);
            for (lane, mut mesh) in meshes.into_iter().enumerate() {
                let goes_on = mesh.rounds < MESHES_MAX
                    && match verdicts[lane] {
                        Verdict::Good => continue,
                        Verdict::Refused => false,
                        Verdict::Kinks => {
                            mesh.place_kinks(&kinks[lane]);
                            true
                        }
                        Verdict::Coarse => {
                            let of_lane = errors.iter().skip(lane).step_by(R::LANES);
                            mesh.refine(&of_lane.copied().collect::<Vec<_>>(), PROMISED)
                        }
                    };
                if goes_on {
                    next.push(mesh);
                } else {
                    to.status[mesh.row] = Status::Inaccurate;
                }
            }
            u64::from(self.turn.sweeps) * n
        })
    }

    /// Refuses rows whose steps do not see where a formula that knows a speed is steep along their solution.
    #[inline(always)]
    fn refuse_pulses(&self, meshes: &[RowMesh], verdicts: &mut [Verdict], first: usize) {
        let laws = self.plan.steep_laws(SteepKind::Moving);
        if laws.is_empty() {
            return;
        }
        let mut pieces = vec![Vec::new(); R::LANES];
        for step in &self.turn.steps {
            let [phi, h, u] = [step.phi, step.h, step.u].map(|x| unbundle(&[x]));
            let X = step.X.map(|x| unbundle(&[x]));
            for (lane, pieces) in pieces.iter_mut().enumerate().filter(|&(lane, _)| h[lane] > 0.0) {
                let X = std::array::from_fn(|i| X[i][lane]);
                pieces.push(Piece { phi: phi[lane], h: h[lane], u: u[lane], X });
            }
        }
        for ((mesh, verdict), pieces) in meshes.iter().zip(verdicts).zip(&pieces) {
            if *verdict == Verdict::Good
                && !sees_pulses(self.plan, &self.rows.row(first + mesh.row), &laws, mesh, pieces)
            {
                *verdict = Verdict::Refused;
            }
        }
    }

    /// Speeds of the drive's kinks between slowest and fastest, of each of some lanes.
    #[inline(always)]
    fn kinks_passed(&self, n: usize) -> Vec<Vec<f64>> {
        let (mut low, mut high) = (R::splat(f64::INFINITY), R::splat(0.0));
        for step in &self.turn.steps {
            let mut before = 0.0;
            for i in 0..S {
                // Between two stages a curve does not pass the tangent on the side to which it bends away from its chord.
                let on_tangent = step.X[i] - step.K[i] * step.h * (C[i] - before);
                low = low.min(step.X[i]).min(on_tangent);
                high = high.max(step.X[i]).max(on_tangent);
                before = C[i];
            }
        }
        self.speeds_between(low, high, n)
    }

    /// Speeds of the drive's kinks between two values of u, of each of some lanes.
    #[inline(always)]
    fn speeds_between(&self, low: R, high: R, n: usize) -> Vec<Vec<f64>> {
        let (zero, mut passed) = (R::splat(0.0), vec![Vec::new(); n]);
        for speed in self.plan.drive.kinks_of_lanes(&self.plan.tables, &self.q) {
            let u = speed.squared() * 0.5;
            let inside = low.select_lt(u, u.select_lt(high, speed, zero), zero);
            if zero.any_below(inside) {
                for (passed, speed) in passed.iter_mut().zip(unbundle(&[inside])) {
                    passed.extend((speed > 0.0).then_some(speed));
                }
            }
        }
        passed
    }

    /// Writes the results of rows that are good so far, or tells why they are not. Returns the errors of all steps, lane by
    /// lane.
    #[inline(always)]
    fn judge(
        &mut self,
        meshes: &[RowMesh],
        displaced: R,
        verdicts: &mut [Verdict],
        to: &mut Results<'_>,
    ) -> Vec<f64> {
        out_of_line!(R, {
            if !verdicts.contains(&Verdict::Good) {
                return Vec::new();
            }
            let machine = Machine::new(self.plan, &self.q);
            let (turn, nested, m) = (&mut self.turn, &mut self.nested, &mut self.m);
            let totals =
                nested.correct(turn, &machine, &kinks_at_ends(meshes, turn.steps.len()), PROMISED, m);
            for (verdict, worst) in verdicts.iter_mut().zip(unbundle(&[nested.worst])) {
                if *verdict == Verdict::Good && worst > PROMISED {
                    *verdict = Verdict::Coarse;
                }
            }
            let errors = unbundle(&nested.errors);
            if !verdicts.contains(&Verdict::Good) {
                return errors;
            }
            let extremes = turn.extremes(&machine, Some(&nested.between), &nested.starts, m);
            let may_have_faster = turn.may_have_faster(&machine);
            let may_be_neutral = turn.may_be_neutral(&machine);
            let may_have_faster = may_have_faster.max(may_be_neutral);
            // A motion that the machine departs from, or that may not be the fastest, is no answer.
            let (zero, one) = (R::splat(0.0), R::splat(1.0));
            let is_stable = turn.multiplier.select_lt(one, one, zero);
            let is_fastest = may_have_faster.select_lt(R::splat(0.5), is_stable, zero);
            let is_answer = displaced.select_lt(R::splat(PLACED), is_fastest, zero);
            let is_answer = nested.noise.select_lt(R::splat(PEAKS_PROMISED), is_answer, zero);
            let is_answer = zero.select_lt(extremes.speed_min.value, is_answer, zero);
            let is_answer = unbundle(&[is_answer]);
            let numbers = unbundle(&row_of(turn.multiplier, &extremes, &totals));
            let kinks = self.plan.drive.kinks_of_lanes(&self.plan.tables, &self.q);
            let kinks: Vec<Vec<f64>> = kinks.iter().map(|kink| unbundle(&[*kink])).collect();
            for (lane, mesh) in meshes.iter().enumerate() {
                if verdicts[lane] != Verdict::Good {
                    continue;
                }
                let result = &mut to.out[mesh.row * QUANTITIES..(mesh.row + 1) * QUANTITIES];
                for (k, number) in result.iter_mut().enumerate() {
                    *number = numbers[k * R::LANES + lane];
                }
                // Extremes may lie beyond a kink that no stage does.
                let is_unseen = |speed: f64| result[0] < speed && speed < result[1] && !mesh.has(speed);
                let passes_unseen = kinks.iter().any(|kink| is_unseen(kink[lane]));
                if passes_unseen || is_answer[lane] < 0.5 || !result.iter().all(|x| x.is_finite()) {
                    verdicts[lane] = Verdict::Refused;
                }
            }
            errors
        })
    }
}

impl<R: Real> Turn<R> {
    /// Solves until every lane has converged or is lost; returns infinity in the lost ones, given those lost before. A lane
    /// that does not converge stays as it is from then on: the sweeps that it takes are not missing to others.
    #[inline(always)]
    fn solve_lanes(&mut self, machine: &Machine<'_, R>, lost: R) -> R {
        let (zero, before) = (R::splat(0.0), std::mem::take(&mut self.sweeps));
        self.correction = zero.select_lt(lost, zero, self.correction);
        self.solve(machine);
        self.sweeps += before;
        self.correction.select_lt(R::splat(self.limit), lost, R::splat(f64::INFINITY))
    }
}

/// Whether the steps of a row see all that these laws have steep along its solution.
fn sees_pulses(plan: &Plan, q: &[f64], laws: &[FormulaLoad], mesh: &RowMesh, pieces: &[Piece]) -> bool {
    let (mut m, omega) = (Motion::new(&plan.mechanism, q), speed_along(pieces));
    let moment = |phi| Moment::steady(phi, omega(phi));
    let along = Along::cycle(plan, &moment, mesh.breaks());
    let sees =
        |&load| Steepness::new(plan, q, load, SteepKind::Moving, &mut m).is_seen(&along, &mesh.edges, &mut m);
    laws.iter().all(sees)
}

/// u at the kink of the drive that is passed at each end of `n` steps; 0 in lanes in which there is none.
#[inline(always)]
fn kinks_at_ends<R: Real>(meshes: &[RowMesh], n: usize) -> Vec<R> {
    let mut lanes = vec![0.0; R::LANES];
    let mut ends = Vec::with_capacity(n + 1);
    for k in 0..=n {
        for (lane, kink) in lanes.iter_mut().enumerate() {
            *kink = meshes[lane.min(meshes.len() - 1)].kink(k);
        }
        ends.push(R::load(&lanes));
    }
    ends
}
