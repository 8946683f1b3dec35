//! Many machines of one structure: rows into lanes, lanes over threads.
//!
//! A row is one machine: the base parameters with some slots replaced. Rows whose motion passes kinks of the drive's
//! characteristic are collected and get ends of steps there (`row_lanes`). Rows that lanes cannot do to the
//! accuracy asked for (laws with kinks of their own, no convergence) are done again one by one by
//! [`crate::drive::steady`], which also names the reason when there is no answer.

use crate::drive::row_lanes::{PEAKS_PROMISED, Results, RowLanes};
use crate::drive::row_mesh::RowMesh;
use crate::drive::rows::row_of;
pub use crate::drive::rows::{QUANTITIES, Rows};
use crate::drive::steady::{Beyond, Steady, steady};
use crate::drive::structure::Plan;
use crate::kernel::call::{in_threads, poll};
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::kernel::status::Status;
use crate::linkage::in_line::{InLine, in_line};
use crate::linkage::motion::Motion;
use rayon::prelude::*;

/// Rows that a thread takes at once: enough that rows with as many steps fill the lanes, few enough to share the work evenly
/// and to keep their meshes near.
const CHUNK: [usize; 2] = [128, 1024];

/// Chunks for each thread, so that none waits long for another.
const CHUNKS: usize = 8;

/// The row of one machine.
pub fn row_of_steady(s: &Steady) -> [f64; QUANTITIES] {
    row_of(s.multiplier, &s.extremes, &s.totals)
}

/// What becomes of starts faster than the motion of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum FastStarts {
    /// They settle to it.
    Settle = 0,
    /// From some speed on the machine runs away.
    RunAway = 1,
    /// They were not followed to an end.
    Undecided = 2,
}

impl From<Beyond> for FastStarts {
    fn from(beyond: Beyond) -> Self {
        if !beyond.undecided_above.is_nan() {
            FastStarts::Undecided
        } else if beyond.away_from.is_nan() {
            FastStarts::Settle
        } else {
            FastStarts::RunAway
        }
    }
}

/// What came out besides the numbers.
pub struct Outcome {
    /// Of each row.
    pub status: Vec<Status>,
    /// Of each row that has an answer.
    pub fast_starts: Vec<FastStarts>,
    /// Turns swept in all.
    pub sweeps: u64,
}

/// Steady motions of all rows: `out` is (rows, `QUANTITIES`).
pub fn steady_rows(plan: &Plan, rows: &Rows<'_>, accuracy: f64, out: &mut [f64]) -> Outcome {
    // Where a law has its kinks is only known with the motion: such rows are solved one by one.
    let is_for_lanes = !plan.may_jump();
    let mut status = vec![if is_for_lanes { Status::Ok } else { Status::Inaccurate }; rows.n];
    let mut fast_starts = vec![FastStarts::Settle; rows.n];
    let sweeps: u64 = in_threads(|crew| {
        let n = (rows.n / (CHUNKS * rayon::current_num_threads())).clamp(CHUNK[0], CHUNK[1]);
        status
            .par_chunks_mut(n)
            .zip(fast_starts.par_chunks_mut(n))
            .zip(out.par_chunks_mut(n * QUANTITIES))
            .enumerate()
            .map(|(chunk, ((status, fast_starts), out))| {
                crew.task(|| {
                    let first = chunk * n;
                    let chunk = Chunk { plan, rows, first, status, out };
                    let swept = if is_for_lanes { in_lanes(chunk) } else { 0 };
                    swept + retry(plan, rows, accuracy, Results { first, status, out }, fast_starts)
                })
            })
            .sum()
    });
    Outcome { status, fast_starts, sweeps }
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

    /// All rows, then those that need other meshes. Rows of one bundle have as many steps each, so that none is filled up: no
    /// bits of a row depend on its neighbours.
    #[inline(always)]
    fn run<R: Real>(self) -> u64 {
        let mut lanes = RowLanes::<R>::new(self.plan, self.rows);
        let mut to = Results { first: self.first, status: self.status, out: self.out };
        let all: Vec<usize> = (0..to.status.len()).collect();
        let mut next: Vec<RowMesh> =
            all.chunks(R::LANES).flat_map(|rows| lanes.new_meshes(rows, self.first)).collect();
        let (mut is_new, mut sweeps) = (true, 0);
        while !next.is_empty() {
            for meshes in bundles(std::mem::take(&mut next), R::LANES) {
                sweeps += if is_new {
                    lanes.solve_new(meshes, &mut to, &mut next)
                } else {
                    lanes.solve_again(meshes, &mut to, &mut next)
                };
            }
            is_new = false;
        }
        sweeps
    }
}

/// Meshes with as many steps, a bundle of lanes at a time.
fn bundles(mut meshes: Vec<RowMesh>, lanes: usize) -> Vec<Vec<RowMesh>> {
    meshes.sort_by_key(|mesh| (mesh.edges.len(), mesh.row));
    let mut bundles: Vec<Vec<RowMesh>> = Vec::new();
    for mesh in meshes {
        match bundles.last_mut() {
            Some(last) if last.len() < lanes && last[0].edges.len() == mesh.edges.len() => last.push(mesh),
            _ => bundles.push(vec![mesh]),
        }
    }
    bundles
}

/// Does the rows again, one by one, that lanes could not do. Returns the turns swept.
fn retry(
    plan: &Plan,
    rows: &Rows<'_>,
    accuracy: f64,
    to: Results<'_>,
    fast_starts: &mut [FastStarts],
) -> u64 {
    let mut sweeps = 0;
    let numbers = to.out.chunks_exact_mut(QUANTITIES);
    for (i, (status, row)) in to.status.iter_mut().zip(numbers).enumerate() {
        if *status == Status::Ok {
            continue;
        }
        let q = rows.row(to.first + i);
        let found = steady(plan, &q, accuracy);
        sweeps += found.as_ref().map_or(0, |found| u64::from(found.sweeps));
        *status = match &found {
            Ok(found) if found.reached <= accuracy.max(PEAKS_PROMISED) => Status::Ok,
            Ok(_) => Status::Inaccurate,
            Err(failure) => failure.status,
        };
        match found {
            Ok(found) if *status == Status::Ok => {
                row.copy_from_slice(&row_of_steady(&found));
                fast_starts[i] = found.beyond.into();
            }
            _ => row.fill(f64::NAN),
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
