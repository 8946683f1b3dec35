//! Speeds at which the drive's characteristic has a kink, as ends of steps of machines in lanes.
//!
//! A row whose motion on a mesh without them passes such a speed gets a mesh of its own with the angles at which it
//! does so. The solution on that mesh passes them elsewhere by the square of what the first was off; the ends of its
//! steps are moved there, in all lanes at once, until they stay. Each row's mesh depends on that row alone.

use crate::drive::cycle::{Machine, Turn, divide};
use crate::drive::layout::unbundle;
use crate::drive::mesh::{Piece, crossing};
use crate::kernel::radau::{AT, C, N, S, value};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// A passage this near to another end of a step \[rad\] lies there.
const APART: f64 = 1e-6;

/// An end of a step this near to where the kink is passed \[rad\] stays: what is left changes the solution by the square
/// of that.
const SETTLED: f64 = 1e-7;

/// Most of the shorter step beside it by which an end of a step is moved at once.
const ROOM: f64 = 0.4;

/// A row of a batch with the mesh on which its kinks are ends of steps.
pub(super) struct MeshedRow {
    /// Number of the row.
    pub row: usize,
    /// Ends of its steps \[rad\].
    pub edges: Vec<f64>,
    /// u at which the drive has its kink, for each end of a step; 0 where there is none.
    kinks: Vec<f64>,
    /// What to start from.
    pieces: Vec<Piece>,
}

impl MeshedRow {
    /// A row from its solution on a mesh without kinks; `breaks` are the ends of the smooth pieces of its revolution.
    pub(super) fn new(row: usize, pieces: Vec<Piece>, breaks: &[f64], speeds: &[f64], n: usize) -> Self {
        let mut passages: Vec<(f64, f64)> = Vec::new();
        for u in speeds.iter().map(|speed| 0.5 * speed * speed) {
            for piece in &pieces {
                passages.extend(piece.passages(u).into_iter().map(|phi| (phi, u)));
            }
        }
        passages.retain(|&(phi, _)| breaks.iter().all(|at| (at - phi).abs() > APART));
        passages.sort_by(|a, b| a.0.total_cmp(&b.0));
        passages.dedup_by(|a, b| a.0 - b.0 < APART);
        let mut ends: Vec<f64> = breaks.iter().copied().chain(passages.iter().map(|&(phi, _)| phi)).collect();
        ends.sort_by(f64::total_cmp);
        let edges = divide(&ends, n);
        let kink = |edge: &f64| passages.iter().find(|(phi, _)| phi == edge).map_or(0.0, |&(_, u)| u);
        let kinks = edges.iter().map(kink).collect();
        MeshedRow { row, edges, kinks, pieces }
    }

    /// Whether this end of a step lies on a kink.
    pub(super) fn is_kink(&self, edge: usize) -> bool {
        self.kinks.get(edge).is_some_and(|&u| u > 0.0)
    }

    /// Whether the speed is passed at an end of a step.
    pub(super) fn has(&self, speed: f64) -> bool {
        self.kinks.contains(&(0.5 * speed * speed))
    }
}

impl Piece {
    /// Angles at which the piece passes `u`, by its samples.
    fn passages(&self, u: f64) -> Vec<f64> {
        let mut samples = [self.u; N];
        samples[1..].copy_from_slice(&self.X);
        if samples.iter().all(|x| *x < u) || samples.iter().all(|x| *x >= u) {
            return Vec::new();
        }
        let quintic = self.quintic();
        let passed = |i: &usize| (samples[*i] < u) != (samples[*i + 1] < u);
        let place = |i: usize| {
            let f = |x: f64| value(&quintic, AT[i] + x) - u;
            self.phi + self.h * (AT[i] + crossing(f, AT[i + 1] - AT[i], samples[i] - u, samples[i + 1] - u))
        };
        (0..S).filter(passed).map(place).collect()
    }

    /// Whether a step passes `u` inside, by more than a share of it.
    pub(super) fn passes(&self, u: f64, share: f64) -> bool {
        let samples = || self.X.into_iter().chain([self.u]);
        samples().any(|x| x < u * (1.0 - share)) && samples().any(|x| x > u * (1.0 + share))
    }
}

impl<R: Real> Turn<R> {
    /// The solved steps of the machine in each lane, those of no length left out.
    #[inline(always)]
    pub(super) fn pieces_of_lanes(&self) -> Vec<Vec<Piece>> {
        let mut lanes = vec![Vec::with_capacity(self.steps.len()); R::LANES];
        for step in &self.steps {
            let numbers = [step.phi, step.h, step.u, step.X[0], step.X[1], step.X[2], step.X[3], step.X[4]];
            let flat = unbundle(&numbers);
            for (lane, pieces) in lanes.iter_mut().enumerate() {
                let of = |number: usize| flat[number * R::LANES + lane];
                if of(1) > 0.0 {
                    let X = std::array::from_fn(|i| of(3 + i));
                    pieces.push(Piece { phi: of(0), h: of(1), u: of(2), X });
                }
            }
        }
        lanes
    }

    /// Starts every lane from the solution that it has on other steps.
    #[inline(always)]
    pub(super) fn start_from_lanes(&mut self, rows: &[&MeshedRow]) {
        let n = self.steps.len();
        let mut values = vec![0.0; n * N * R::LANES];
        let phi = unbundle(&self.steps.iter().map(|step| step.phi).collect::<Vec<_>>());
        let h = unbundle(&self.steps.iter().map(|step| step.h).collect::<Vec<_>>());
        for (lane, row) in rows.iter().enumerate() {
            let mut at = 0;
            let mut quintic = row.pieces[0].quintic();
            for k in 0..n {
                let (phi, h) = (phi[k * R::LANES + lane], h[k * R::LANES + lane]);
                // The piece that the step's middle lies in.
                while at + 1 < row.pieces.len() && row.pieces[at + 1].phi <= phi + 0.5 * h {
                    at += 1;
                    quintic = row.pieces[at].quintic();
                }
                let piece = &row.pieces[at];
                for i in 0..N {
                    let share = if i == 0 { 0.0 } else { C[i - 1] };
                    values[(k * N + i) * R::LANES + lane] = piece.value(&quintic, phi + share * h);
                }
            }
        }
        for (step, values) in self.steps.iter_mut().zip(values.chunks_exact(N * R::LANES)) {
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
        rows: &[&MeshedRow],
        m: &mut Motion<R>,
    ) -> R {
        let (zero, n) = (R::splat(0.0), self.steps.len());
        let (mut moves, mut most) = (vec![zero; n + 1], zero);
        let mut lanes = vec![0.0; R::LANES];
        for k in 1..n {
            for (lane, row) in lanes.iter_mut().zip(rows) {
                *lane = row.kinks.get(k).copied().unwrap_or(0.0);
            }
            let (kink, before, step) = (R::load(&lanes), &self.steps[k - 1], &self.steps[k]);
            let (by, room) = ((kink - step.u) / before.K[S - 1], before.h.min(step.h) * ROOM);
            // A NaN is not below the limit.
            let by = by.abs().select_lt(room, by, room);
            let by = by.abs().select_lt(R::splat(SETTLED), zero, by);
            moves[k] = zero.select_lt(kink, by, zero);
            most = most.max(moves[k].abs());
        }
        if most.max_lane() > 0.0 {
            self.geometry.clear();
            for k in 0..n {
                let step = &mut self.steps[k];
                step.phi = step.phi + moves[k];
                step.h = step.h + (moves[k + 1] - moves[k]);
                self.take_rows(machine, k, m);
            }
            self.correction = zero.select_lt(most, R::splat(f64::INFINITY), self.correction);
        }
        most
    }
}
