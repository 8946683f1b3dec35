//! The mesh of each row of a batch: its own, so that its result depends on that row alone.
//!
//! A row whose motion passes a speed at which the drive's characteristic has a kink gets ends of steps at the angles at
//! which it does so, also where it does so and returns between two stages. The solution on that mesh passes them elsewhere by the square of what the first was off; the ends of
//! its steps are moved there, in all lanes at once, until they stay. Steps that are too coarse are halved.

use crate::drive::cycle::{Turn, divide};
use crate::drive::equation::Machine;
use crate::drive::layout::unbundle;
use crate::drive::mesh::crossing;
use crate::drive::step::Step;
use crate::kernel::out_of_line;
use crate::kernel::radau::{C, S};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Steps a revolution at least, before any is halved.
const STEPS: usize = 16;

/// The same of rows that pass kinks of the drive: they accelerate harder, and with as many as the others have two thirds of
/// them need a further mesh.
const BESIDE_KINKS: usize = 20;

/// A passage this near to another end of a step \[rad\] lies there.
const APART: f64 = 1e-6;

/// An end of a step this near to where the kink is passed \[rad\] stays: what is left changes the solution by the square
/// of that.
const SETTLED: f64 = 1e-7;

/// Most of the shorter step beside it by which an end of a step is moved at once.
const ROOM: f64 = 0.4;

/// A row passes a kink inside a step where it lies beyond it on both sides by this share.
const PASSED: f64 = 1e-6;

/// The solution at an angle.
#[derive(Clone, Copy)]
struct Sample {
    phi: f64,
    u: f64,
    /// Acceleration there, coming from before.
    epsilon: f64,
    /// The same going on: another one where the load jumps.
    after: f64,
}

/// A row of a batch with the mesh that it is solved on.
pub(super) struct RowMesh {
    /// Number of the row.
    pub row: usize,
    /// Ends of its steps \[rad\].
    pub edges: Vec<f64>,
    /// How often the mesh was made anew.
    pub rounds: usize,
    /// Ends of the smooth pieces of its revolution, but for kinks of the drive.
    breaks: Vec<f64>,
    /// u at which the drive has its kink, for each end of a step; 0 where there is none.
    kinks: Vec<f64>,
    /// What to start from, from φ = 0 to the end of the cycle; nothing at first.
    samples: Vec<Sample>,
    /// What to start from on the same mesh, in place of the samples: u at the start of each step and its stages.
    start: Vec<f64>,
}

impl RowMesh {
    /// Of a row of which nothing is known but the ends of its smooth pieces.
    pub(super) fn new(row: usize, breaks: Vec<f64>) -> Self {
        let edges = divide(&breaks, STEPS);
        RowMesh {
            row,
            kinks: vec![0.0; edges.len()],
            edges,
            rounds: 0,
            breaks,
            samples: Vec::new(),
            start: Vec::new(),
        }
    }

    /// Ends of the smooth pieces of its revolution.
    pub(super) fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// u at the kink on which this end of a step lies; 0 where there is none.
    pub(super) fn kink(&self, edge: usize) -> f64 {
        self.kinks[edge]
    }

    /// Whether the speed is passed at an end of a step.
    pub(super) fn has(&self, speed: f64) -> bool {
        self.kinks.contains(&(0.5 * speed * speed))
    }

    /// Takes over a solution, from which ends of steps at kinks of the drive follow.
    pub(super) fn place_kinks(&mut self, speeds: &[f64]) {
        let mut passages: Vec<(f64, f64)> = Vec::new();
        for u in speeds.iter().map(|speed| 0.5 * speed * speed) {
            for ends in self.samples.windows(2) {
                passages.extend(passed(ends[0], ends[1], u).map(|phi| (phi, u)));
            }
        }
        passages.retain(|&(phi, _)| self.breaks.iter().all(|at| (at - phi).abs() > APART));
        passages.sort_by(|a, b| a.0.total_cmp(&b.0));
        passages.dedup_by(|a, b| a.0 - b.0 < APART);
        let mut ends = self.breaks.clone();
        ends.extend(passages.iter().map(|&(phi, _)| phi));
        ends.sort_by(f64::total_cmp);
        self.edges = divide(&ends, BESIDE_KINKS << self.rounds);
        let kink = |edge: &f64| passages.iter().find(|(phi, _)| phi == edge).map_or(0.0, |&(_, u)| u);
        self.kinks = self.edges.iter().map(kink).collect();
        self.rounds += 1;
    }

    /// Halves the steps that err by more than a tolerance; whether there are any.
    pub(super) fn refine(&mut self, errors: &[f64], tolerance: f64) -> bool {
        let (mut edges, mut kinks) = (vec![0.0], vec![self.kinks[0]]);
        for (k, ends) in self.edges.windows(2).enumerate() {
            if errors[k] > tolerance {
                edges.push(0.5 * (ends[0] + ends[1]));
                kinks.push(0.0);
            }
            edges.push(ends[1]);
            kinks.push(self.kinks[k + 1]);
        }
        let is_finer = edges.len() > self.edges.len();
        (self.edges, self.kinks) = (edges, kinks);
        self.rounds += 1;
        is_finer
    }

    /// Whether no step has a kink at this speed inside.
    pub(super) fn resolves(&self, speed: f64) -> bool {
        let u = 0.5 * speed * speed;
        let is_inside = |samples: &[Sample]| {
            let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
            let mut take = |u: f64| (low, high) = (low.min(u), high.max(u));
            samples.iter().for_each(|sample| take(sample.u));
            let between = samples.windows(2).filter_map(|ends| extreme(ends[0], ends[1]));
            between.for_each(|sample| take(sample.u));
            low < u * (1.0 - PASSED) && high > u * (1.0 + PASSED)
        };
        (0..self.samples.len() / S).all(|k| !is_inside(&self.samples[k * S..=(k + 1) * S]))
    }
}

/// Where the cubic through two samples with their slopes passes `u`: nowhere, once, or on both sides of its extreme.
fn passed(from: Sample, to: Sample, u: f64) -> impl Iterator<Item = f64> {
    let middle = extreme(from, to).unwrap_or(to);
    [(from, middle), (middle, to)]
        .into_iter()
        .filter(move |(from, to)| (from.u < u) != (to.u < u))
        .map(move |(from, to)| passage(from, to, u))
}

/// The extreme that the cubic through two samples with their slopes has between them.
fn extreme(from: Sample, to: Sample) -> Option<Sample> {
    let (h, rise) = (to.phi - from.phi, to.u - from.u);
    let (start, end) = (h * from.after, h * to.epsilon);
    if start * end >= 0.0 {
        return None;
    }
    let bend = 3.0 * rise - 2.0 * start - end;
    let slope = |x: f64| start + x * (2.0 * bend + 3.0 * x * (start + end - 2.0 * rise));
    let at = crossing(slope, 1.0, start, end);
    Some(Sample { phi: from.phi + at * h, u: hermite(from, to, at), epsilon: 0.0, after: 0.0 })
}

/// Where the cubic through two samples on both sides of `u`, with their slopes, passes it.
fn passage(from: Sample, to: Sample, u: f64) -> f64 {
    let h = to.phi - from.phi;
    from.phi + crossing(|x| hermite(from, to, x / h) - u, h, from.u - u, to.u - u)
}

/// The cubic through two samples with their slopes, at a share of the way.
fn hermite(from: Sample, to: Sample, x: f64) -> f64 {
    let (h, rise) = (to.phi - from.phi, to.u - from.u);
    let y = 1.0 - x;
    from.u + x * x * (3.0 - 2.0 * x) * rise + x * y * h * (y * from.after - x * to.epsilon)
}

/// The slope of a step's quintic at its start.
#[inline(always)]
fn slope_at_start<R: Real>(step: &Step<R>) -> R {
    step.quintic()[1] / step.h
}

/// Gives the rows a sample.
#[inline(always)]
fn give<R: Real>(rows: &mut [RowMesh], numbers: [R; 4], lanes: &mut [f64]) {
    for (number, lanes) in numbers.iter().zip(lanes.chunks_exact_mut(R::LANES)) {
        number.store(lanes);
    }
    for (lane, row) in rows.iter_mut().enumerate() {
        let of = |number: usize| lanes[number * R::LANES + lane];
        row.samples.push(Sample { phi: of(0), u: of(1), epsilon: of(2), after: of(3) });
    }
}

impl<R: Real> Turn<R> {
    /// Gives the rows, one a lane, the solution at the starts and stages of their steps.
    #[inline(always)]
    pub(super) fn give_samples(&self, rows: &mut [RowMesh]) {
        out_of_line!(R, {
            let mut lanes = vec![0.0; 4 * R::LANES];
            for row in rows.iter_mut() {
                row.samples = Vec::with_capacity(self.steps.len() * S + 1);
                row.start.clear();
            }
            let first = &self.steps[0];
            give(rows, [first.phi, first.u, first.K[0], slope_at_start(first)], &mut lanes);
            for (k, step) in self.steps.iter().enumerate() {
                for i in 0..S - 1 {
                    let phi = step.h.mul_add(R::splat(C[i]), step.phi);
                    give(rows, [phi, step.X[i], step.K[i], step.K[i]], &mut lanes);
                }
                // Behind the last step nothing follows.
                let after = slope_at_start(self.steps.get(k + 1).unwrap_or(step));
                give(rows, [step.phi + step.h, step.X[S - 1], step.K[S - 1], after], &mut lanes);
            }
            // At φ = 0 the motion is that at the end of the cycle.
            for row in rows {
                let end = row.samples.last().map_or(f64::NAN, |sample| sample.epsilon);
                row.samples[0].epsilon = end;
            }
        })
    }

    /// Gives the rows that have no kink the start of their lane on their mesh: beside others they are solved from the same
    /// numbers.
    #[inline(always)]
    pub(super) fn give_starts(&self, rows: &mut [RowMesh], has_kinks: &[bool]) {
        out_of_line!(R, {
            let mut lanes = vec![0.0; R::LANES];
            for step in &self.steps {
                for u in [step.u].iter().chain(&step.X) {
                    u.store(&mut lanes);
                    for (lane, row) in rows.iter_mut().enumerate().filter(|&(lane, _)| !has_kinks[lane]) {
                        row.start.push(lanes[lane]);
                    }
                }
            }
        })
    }

    /// Starts every lane from the solution that it has on other steps.
    #[inline(always)]
    pub(super) fn start_from_samples(&mut self, rows: &[RowMesh]) {
        let (n, stages) = (self.steps.len(), S + 1);
        let mut values = vec![0.0; n * stages * R::LANES];
        for lane in 0..R::LANES {
            let row = &rows[lane.min(rows.len() - 1)];
            let (samples, mut at) = (&row.samples, 0);
            for k in 0..n {
                let (low, high) = (row.edges[k], row.edges[k + 1]);
                for i in 0..stages {
                    let to = &mut values[(k * stages + i) * R::LANES + lane];
                    if !row.start.is_empty() {
                        *to = row.start[k * stages + i];
                        continue;
                    }
                    let share = if i == 0 { 0.0 } else { C[i - 1] };
                    let phi = low + share * (high - low);
                    while at + 2 < samples.len() && samples[at + 1].phi < phi {
                        at += 1;
                    }
                    let (from, next) = (samples[at], samples[at + 1]);
                    let x = ((phi - from.phi) / (next.phi - from.phi)).clamp(0.0, 1.0);
                    // Where the solution falls fast a cubic may swing below zero.
                    let least = 0.5 * from.u.min(next.u);
                    *to = hermite(from, next, x).max(least);
                }
            }
        }
        for (step, values) in self.steps.iter_mut().zip(values.chunks_exact(stages * R::LANES)) {
            step.u = R::load(values);
            for i in 0..S {
                step.X[i] = R::load(&values[(i + 1) * R::LANES..]);
            }
        }
    }

    /// Moves ends of steps to where the solution passes their kinks; the largest move of each lane \[rad\], 0 where all
    /// stayed. The lanes that moved are to be solved again, the others are as they were.
    #[inline(always)]
    pub(super) fn move_to_kinks(
        &mut self,
        machine: &Machine<'_, R>,
        rows: &mut [RowMesh],
        m: &mut Motion<R>,
    ) -> R {
        out_of_line!(R, {
            let (zero, n) = (R::splat(0.0), self.steps.len());
            let (mut moves, mut most) = (vec![zero; n + 1], zero);
            let mut lanes = vec![0.0; R::LANES];
            for k in 1..n {
                for (lane, kink) in lanes.iter_mut().enumerate() {
                    *kink = rows[lane.min(rows.len() - 1)].kink(k);
                }
                let (kink, before, step) = (R::load(&lanes), &self.steps[k - 1], &self.steps[k]);
                let (by, room) = ((kink - step.u) / before.K[S - 1], before.h.min(step.h) * ROOM);
                // A NaN is not below the limit.
                let by = by.abs().select_lt(room, by, room);
                let by = by.abs().select_lt(R::splat(SETTLED), zero, by);
                moves[k] = zero.select_lt(kink, by, zero);
                most = most.max(moves[k].abs());
            }
            if most.max_lane() <= 0.0 {
                return most;
            }
            self.geometry.clear();
            for k in 0..n {
                let is_moved = moves[k].abs().max(moves[k + 1].abs()).max_lane() > 0.0;
                let step = &mut self.steps[k];
                step.phi = step.phi + moves[k];
                step.h = step.h + (moves[k + 1] - moves[k]);
                if is_moved || !machine.plan.laws.is_empty() {
                    self.take_rows(machine, k, m);
                }
            }
            for (k, by) in moves.iter().enumerate().take(n) {
                let by = unbundle(&[*by]);
                for (row, by) in rows.iter_mut().zip(by).filter(|(row, _)| row.kink(k) > 0.0) {
                    row.edges[k] += by;
                }
            }
            self.correction = zero.select_lt(most, R::splat(f64::INFINITY), self.correction);
            most
        })
    }
}
