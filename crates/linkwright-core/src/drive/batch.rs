//! Many machines of one structure: rows into lanes, lanes over threads.
//!
//! A row is one machine: the base parameters with some slots replaced. Rows whose motion passes kinks of the drive's
//! characteristic are collected and get ends of steps there ([`crate::drive::passing`]). Rows that lanes cannot do to the
//! accuracy asked for (laws with kinks of their own, no convergence) are done again one by one by
//! [`crate::drive::steady`], which also names the reason when there is no answer.

use crate::drive::cycle::{Machine, Turn, divide};
use crate::drive::extremes::Extremes;
use crate::drive::layout::{Layout, unbundle};
use crate::drive::measures::Totals;
use crate::drive::passing::MeshedRow;
use crate::drive::steady::{Steady, steady};
use crate::drive::structure::Plan;
use crate::kernel::call::{in_threads, poll};
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::kernel::status::Status;
use crate::linkage::in_line::{InLine, in_line};
use crate::linkage::motion::Motion;
use rayon::prelude::*;

/// Parameters that differ from row to row.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// Parameters of every row, before replacement.
    pub base: &'a [f64],
    /// Which of them are replaced.
    pub slots: &'a [usize],
    /// Their values: slot by slot, each with one value a row.
    pub values: &'a [f64],
    /// How many rows.
    pub n: usize,
}

impl Rows<'_> {
    /// Parameters of one row.
    pub fn row(&self, row: usize) -> Vec<f64> {
        let mut q = self.base.to_vec();
        self.replace(row, &mut q);
        q
    }

    /// Puts what differs in one row into parameters.
    pub(super) fn replace(&self, row: usize, q: &mut [f64]) {
        for (i, &slot) in self.slots.iter().enumerate() {
            q[slot] = self.values[i * self.n + row];
        }
    }

    /// Parameters of some rows, one a lane; the last is repeated past the end.
    #[inline(always)]
    fn lanes<R: Real>(&self, rows: &[usize], q: &mut [R]) {
        let mut lanes = vec![0.0; R::LANES];
        for (i, &slot) in self.slots.iter().enumerate() {
            let column = &self.values[i * self.n..(i + 1) * self.n];
            for (lane, value) in lanes.iter_mut().enumerate() {
                *value = column[rows[lane.min(rows.len() - 1)]];
            }
            q[slot] = R::load(&lanes);
        }
    }
}

/// Quantities of a row's steady motion, in the order of a result row.
pub const QUANTITIES: usize = 13;

/// Steps a revolution in lanes before they are halved; [`PROMISED`] tells where these do not suffice.
const STEPS: usize = 16;

/// Relative corrections after which a revolution, and the revolution in steps of half the length, have converged. The next would be
/// about their squares, which measured errors do not notice.
const CONVERGED: [f64; 2] = [1e-5, 1e-7];

/// Most times that ends of steps are moved to the kinks that a motion passes.
const PLACEMENTS: usize = 4;

/// Ends of steps farther from their kinks \[rad\], or speeds farther beyond a kink as a share, are not placed well enough.
const PLACED: f64 = 1e-6;

/// Relative error that a row in lanes may have, as measured; rows above it are solved one by one.
const PROMISED: f64 = 1e-7;

/// Rows that a thread takes at once: enough to amortise its buffers, few enough to share the work evenly.
const CHUNK: usize = 256;

/// Measures of a revolution as a row of numbers:
/// speed min, max; acceleration min, max; period; multiplier; motor work, crank work, load work;
/// torque mean, rms; crank angles of the speed's extremes.
fn row_of<R: Real>(multiplier: R, e: &Extremes<R>, t: &Totals<R>) -> [R; QUANTITIES] {
    [
        e.speed_min.value,
        e.speed_max.value,
        e.acceleration_min.value,
        e.acceleration_max.value,
        t.period,
        multiplier,
        t.motor_work,
        t.crank_work,
        t.load_work,
        t.torque_mean,
        t.torque_rms,
        e.speed_min.phi,
        e.speed_max.phi,
    ]
}

/// The row of one machine.
pub fn row_of_steady(s: &Steady) -> [f64; QUANTITIES] {
    row_of(s.multiplier, &s.extremes, &s.totals)
}

/// Steady motions of all rows: `out` is (rows, `QUANTITIES`). Returns a status for each row and the total
/// number of turns swept.
pub fn steady_rows(plan: &Plan, rows: &Rows<'_>, accuracy: f64, out: &mut [f64]) -> (Vec<Status>, u64) {
    let mut status = vec![Status::Ok; rows.n];
    let sweeps: u64 = in_threads(|crew| {
        status
            .par_chunks_mut(CHUNK)
            .zip(out.par_chunks_mut(CHUNK * QUANTITIES))
            .enumerate()
            .map(|(chunk, (status, out))| {
                crew.task(|| {
                    let first = chunk * CHUNK;
                    let swept = in_lanes(Chunk { plan, rows, first, status, out });
                    swept + retry(plan, rows, first, accuracy, status, out)
                })
            })
            .sum()
    });
    (status, sweeps)
}

/// A piece of the batch: `out` holds the rows one after the other, `QUANTITIES` numbers each.
struct Chunk<'a> {
    plan: &'a Plan,
    rows: &'a Rows<'a>,
    first: usize,
    status: &'a mut [Status],
    out: &'a mut [f64],
}

impl Job for Chunk<'_> {
    type Output = u64;

    /// All rows on a mesh without kinks of the drive, then those that pass some on meshes of their own.
    #[inline(always)]
    fn run<R: Real>(mut self) -> u64 {
        let mut lanes = Lanes::<R>::new(self.plan, self.rows);
        let all: Vec<usize> = (0..self.status.len()).collect();
        let new = |rows: &[usize]| Bundle { rows: rows.to_vec(), passing: Vec::new() };
        let mut bundles: Vec<Bundle> = all.chunks(R::LANES).map(new).collect();
        let (mut passing, mut sweeps) = (Vec::new(), 0);
        while !bundles.is_empty() {
            for bundle in &bundles {
                sweeps += lanes.solve(bundle, &mut self, &mut passing);
            }
            // Lanes with about as many steps side by side.
            passing.sort_by_key(|row: &MeshedRow| (row.edges.len(), row.row));
            bundles.clear();
            let mut rest = passing.drain(..).peekable();
            while rest.peek().is_some() {
                let passing: Vec<MeshedRow> = rest.by_ref().take(R::LANES).collect();
                bundles.push(Bundle { rows: passing.iter().map(|row| row.row).collect(), passing });
            }
        }
        sweeps
    }
}

/// Rows that are solved side by side, counted from the first of the chunk.
struct Bundle {
    rows: Vec<usize>,
    /// Their meshes where they pass kinks of the drive, else empty.
    passing: Vec<MeshedRow>,
}

/// What bundles of rows are solved with.
struct Lanes<'a, R> {
    plan: &'a Plan,
    rows: &'a Rows<'a>,
    q: Vec<R>,
    m: Motion<R>,
    coarse: Turn<R>,
    turn: Turn<R>,
    /// Parameters of a row on its own.
    row: Vec<f64>,
}

impl<'a, R: Real> Lanes<'a, R> {
    #[inline(always)]
    fn new(plan: &'a Plan, rows: &'a Rows<'a>) -> Self {
        let q: Vec<R> = rows.base.iter().map(|&x| R::splat(x)).collect();
        let m = Motion::new(&plan.mechanism, &q);
        let (coarse, turn) = (Turn::empty(Layout::Machines), Turn::empty(Layout::Machines));
        Lanes { plan, rows, q, m, coarse, turn, row: rows.base.to_vec() }
    }

    /// Solves a bundle; returns the turns swept. Rows that are found to pass kinks of the drive are added to the list.
    #[inline(always)]
    fn solve(&mut self, bundle: &Bundle, chunk: &mut Chunk<'_>, passing: &mut Vec<MeshedRow>) -> u64 {
        let Bundle { rows, passing: meshes } = bundle;
        let numbers: Vec<usize> = rows.iter().map(|row| chunk.first + row).collect();
        self.rows.lanes(&numbers, &mut self.q);
        self.m.ground(&self.plan.mechanism, &self.q);
        let (machine, m) = (Machine::new(self.plan, &self.q), &mut self.m);
        let mesh_of = |lane: usize| &meshes[lane.min(meshes.len() - 1)];
        let meshes: Vec<&MeshedRow> =
            if meshes.is_empty() { Vec::new() } else { (0..R::LANES).map(mesh_of).collect() };
        let mut breaks = Vec::new();
        if meshes.is_empty() {
            breaks = R::out_of_line(
                #[inline(always)]
                || machine.breaks(m),
            );
        }
        let edges: Vec<Vec<f64>> = if meshes.is_empty() {
            breaks.iter().map(|breaks| divide(breaks, STEPS)).collect()
        } else {
            meshes.iter().map(|mesh| mesh.edges.clone()).collect()
        };
        let (coarse, turn) = (&mut self.coarse, &mut self.turn);
        R::out_of_line(
            #[inline(always)]
            || coarse.tabulate_machines(&machine, &edges, m),
        );
        coarse.limit = CONVERGED[0];
        if meshes.is_empty() {
            R::out_of_line(
                #[inline(always)]
                || coarse.start_from_balance(&machine),
            );
        } else {
            coarse.start_from_lanes(&meshes);
        }
        let mut displaced = R::splat(0.0);
        for _ in 0..=PLACEMENTS {
            R::out_of_line(
                #[inline(always)]
                || coarse.solve(&machine),
            );
            if meshes.is_empty() {
                break;
            }
            displaced = coarse.move_to_kinks(&machine, &meshes, m);
            if displaced.max_lane() <= 0.0 {
                break;
            }
        }
        let n = rows.len() as u64;
        let is_free = if meshes.is_empty() {
            hand_over(coarse, &breaks, rows, passing, |row| {
                self.rows.replace(chunk.first + row, &mut self.row);
                self.plan.drive.speed_kinks(&self.plan.tables, &self.row)
            })
        } else {
            vec![true; rows.len()]
        };
        if !is_free.contains(&true) {
            return u64::from(coarse.sweeps) * n;
        }
        R::out_of_line(
            #[inline(always)]
            || coarse.halve_into(turn, &machine, m),
        );
        turn.limit = CONVERGED[1];
        R::out_of_line(
            #[inline(always)]
            || turn.solve(&machine),
        );
        for k in (1..coarse.steps.len()).filter(|&k| meshes.iter().any(|mesh| mesh.is_kink(k))) {
            // The end of a step is that of the second of its halves.
            let step = &turn.steps[2 * k - 1];
            let side = machine.growth_on_side(step, turn.geometry_of(&machine, 2 * k - 1)) / step.growth;
            let is_kink: Vec<f64> = meshes.iter().map(|mesh| f64::from(u8::from(mesh.is_kink(k)))).collect();
            let factor = R::load(&is_kink).select_lt(R::splat(0.5), R::splat(1.0), side);
            turn.multiplier = turn.multiplier * factor;
        }
        let extremes = R::out_of_line(
            #[inline(always)]
            || turn.extremes(&machine, None, m),
        );
        let totals = R::out_of_line(
            #[inline(always)]
            || turn.totals(&machine),
        );
        let error = R::out_of_line(
            #[inline(always)]
            || turn.error_against(coarse, &machine, m),
        );
        let may_have_faster = R::out_of_line(
            #[inline(always)]
            || coarse.may_have_faster(&machine),
        );
        // Where Newton did not converge, or to a motion that the machine departs from, or that may not be
        // the fastest, there is no error to trust.
        let none = R::splat(f64::NAN);
        let is_stable = turn.multiplier.select_lt(R::splat(1.0), error, none);
        let is_fastest = may_have_faster.select_lt(R::splat(0.5), is_stable, none);
        let is_placed = displaced.select_lt(R::splat(PLACED), is_fastest, none);
        let trusted = turn.correction.select_lt(R::splat(turn.limit), is_placed, none);
        let mut errors = vec![0.0; R::LANES];
        trusted.store(&mut errors);
        let (mut lane, row_of_lanes) = (vec![0.0; R::LANES], row_of(turn.multiplier, &extremes, &totals));
        for (k, quantity) in row_of_lanes.into_iter().enumerate() {
            quantity.store(&mut lane);
            for (i, row) in rows.iter().enumerate() {
                if is_free[i] {
                    chunk.out[row * QUANTITIES + k] = lane[i];
                }
            }
        }
        let pieces = if meshes.is_empty() { Vec::new() } else { turn.pieces_of_lanes() };
        for (i, &row) in rows.iter().enumerate() {
            if !is_free[i] {
                continue;
            }
            let result = &chunk.out[row * QUANTITIES..(row + 1) * QUANTITIES];
            self.rows.replace(numbers[i], &mut self.row);
            let speeds = self.plan.drive.speed_kinks(&self.plan.tables, &self.row);
            let is_passed = |speed: &&f64| result[0] < **speed && **speed < result[1];
            let is_resolved = |speed: &f64| {
                let u = 0.5 * speed * speed;
                meshes.get(i).is_some_and(|mesh| mesh.has(*speed))
                    && pieces[i].iter().all(|piece| !piece.passes(u, PLACED))
            };
            let is_good = errors[i] <= PROMISED && result.iter().all(|x| x.is_finite()) && result[0] > 0.0;
            if !is_good || !speeds.iter().filter(is_passed).all(is_resolved) {
                chunk.status[row] = Status::Inaccurate;
            }
        }
        u64::from(coarse.sweeps + turn.sweeps) * n
    }
}

/// Adds the rows of a bundle that pass kinks of the drive to the list; which do not. `kinks_of` a row are speeds.
#[inline(always)]
fn hand_over<R: Real>(
    turn: &Turn<R>,
    breaks: &[Vec<f64>],
    rows: &[usize],
    passing: &mut Vec<MeshedRow>,
    mut kinks_of: impl FnMut(usize) -> Vec<f64>,
) -> Vec<bool> {
    let (mut low, mut high) = (R::splat(f64::INFINITY), R::splat(0.0));
    for step in &turn.steps {
        for &u in &step.X {
            (low, high) = (low.min(u), high.max(u));
        }
    }
    let (low, high) = (unbundle(&[low]), unbundle(&[high]));
    let is_solved = unbundle(&[turn.correction]);
    let (mut is_free, mut pieces) = (vec![true; rows.len()], Vec::new());
    for (lane, &row) in rows.iter().enumerate() {
        let mut speeds = kinks_of(row);
        speeds.retain(|speed| low[lane] < 0.5 * speed * speed && 0.5 * speed * speed < high[lane]);
        if !speeds.is_empty() && is_solved[lane] < turn.limit {
            if pieces.is_empty() {
                pieces = turn.pieces_of_lanes();
            }
            let solution = std::mem::take(&mut pieces[lane]);
            passing.push(MeshedRow::new(row, solution, &breaks[lane], &speeds, STEPS));
            is_free[lane] = false;
        }
    }
    is_free
}

/// Does the rows again, one by one, that lanes could not do. Returns the turns swept.
fn retry(
    plan: &Plan,
    rows: &Rows<'_>,
    first: usize,
    accuracy: f64,
    status: &mut [Status],
    out: &mut [f64],
) -> u64 {
    let mut sweeps = 0;
    // Where a law has its kinks is only known with the motion.
    let moves_kinks = plan.may_jump();
    for (i, (status, row)) in status.iter_mut().zip(out.chunks_exact_mut(QUANTITIES)).enumerate() {
        if *status == Status::Ok && !moves_kinks {
            continue;
        }
        let q = rows.row(first + i);
        match steady(plan, &q, accuracy) {
            Ok(found) => {
                row.copy_from_slice(&row_of_steady(&found));
                *status = Status::Ok;
                sweeps += u64::from(found.sweeps);
            }
            Err(failure) => {
                row.fill(f64::NAN);
                *status = failure.status;
            }
        }
    }
    sweeps
}

/// Where the links of a dyad come into line in each row: rows with nothing of the kind are left out.
pub fn rows_in_line(plan: &Plan, rows: &Rows<'_>, element: usize) -> Vec<(usize, InLine)> {
    let of_row = |row: usize| {
        let found = in_line(&plan.mechanism, element, &rows.row(row));
        found.into_iter().map(move |at| (row, at)).collect::<Vec<_>>()
    };
    if rows.n == 1 {
        // Waking threads would take longer than doing it.
        return of_row(0);
    }
    in_threads(|crew| (0..rows.n).into_par_iter().flat_map_iter(|row| crew.task(|| of_row(row))).collect())
}

/// J, J′, load, dry and viscous torque coefficients at each angle, turning forward. `out` is (5, angles).
pub fn reductions(plan: &Plan, q: &[f64], phi: &[f64], out: &mut [f64]) {
    let mut m = Motion::new(&plan.mechanism, q);
    let n = phi.len();
    for (i, &phi_i) in phi.iter().enumerate() {
        poll();
        let r = plan.reduce::<f64, 2>(q, Angle::new(phi_i), 1.0, &mut m);
        for (k, value) in [r.J, r.J_d1, r.load, r.dry, r.viscous].into_iter().enumerate() {
            out[k * n + i] = value;
        }
    }
}

/// Torque of all laws at each angle and each of some speeds. `out` is (speeds, angles).
pub fn law_torques(plan: &Plan, q: &[f64], phi: &[f64], omega: &[f64], out: &mut [f64]) {
    let mut m = Motion::new(&plan.mechanism, q);
    let mut geometry = Vec::new();
    for (i, &phi_i) in phi.iter().enumerate() {
        poll();
        plan.mechanism.place::<f64, 1>(q, Angle::new(phi_i), &mut m);
        geometry.clear();
        plan.add_geometry(q, phi_i, &m, &mut geometry);
        for (k, &omega_k) in omega.iter().enumerate() {
            out[k * phi.len() + i] = plan.law_torque::<f64, f64, f64>(q, &geometry, omega_k, f64::NAN);
        }
    }
}
