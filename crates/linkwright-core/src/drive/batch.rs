//! Many machines of one structure: rows into lanes, lanes over threads.
//!
//! A row is one machine: the base parameters with some slots replaced. Rows that lanes cannot do to the
//! accuracy asked for (a kink of the drive's characteristic inside the range of speed, no convergence) are
//! done again one by one by [`crate::drive::steady`], which also names the reason when there is no answer.

use crate::drive::cycle::{Machine, Turn};
use crate::drive::extremes::Extremes;
use crate::drive::measures::Totals;
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

    /// Parameters of `R::LANES` rows from `first` on; the last row is repeated past the end.
    #[inline(always)]
    fn lanes<R: Real>(&self, first: usize, q: &mut Vec<R>) {
        q.clear();
        q.extend(self.base.iter().map(|&x| R::splat(x)));
        let mut padded = vec![0.0; R::LANES];
        for (i, &slot) in self.slots.iter().enumerate() {
            let column = &self.values[i * self.n..(i + 1) * self.n];
            q[slot] = match column.get(first..first + R::LANES) {
                Some(whole) => R::load(whole),
                None => {
                    for (lane, value) in padded.iter_mut().enumerate() {
                        *value = column[(first + lane).min(self.n - 1)];
                    }
                    R::load(&padded)
                }
            };
        }
    }
}

/// Quantities of a row's steady motion, in the order of a result row.
pub const QUANTITIES: usize = 13;

/// Steps a turn in lanes before they are halved; [`PROMISED`] tells where these do not suffice.
const STEPS: usize = 16;

/// Relative error that a row in lanes may have, as measured; rows above it are solved one by one.
const PROMISED: f64 = 1e-7;

/// Rows that a thread takes at once: enough to amortise its buffers, few enough to share the work evenly.
const CHUNK: usize = 256;

/// Measures of a turn as a row of numbers:
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

    #[inline(always)]
    fn run<R: Real>(self) -> u64 {
        let mut q: Vec<R> = self.rows.base.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut sweeps = 0;
        let mut lane = vec![0.0; R::LANES];
        for (block, status) in self.status.chunks_mut(R::LANES).enumerate() {
            let at = block * R::LANES;
            self.rows.lanes::<R>(self.first + at, &mut q);
            m.ground(&self.plan.mechanism, &q);
            let machine = Machine { plan: self.plan, q: &q };
            let breaks = R::outline(
                #[inline(always)]
                || machine.breaks(&mut m),
            );
            let mut coarse = R::outline(
                #[inline(always)]
                || Turn::of_machines(&machine, &breaks, STEPS, &mut m),
            );
            R::outline(
                #[inline(always)]
                || coarse.start_from_balance(&machine),
            );
            R::outline(
                #[inline(always)]
                || coarse.solve(&machine),
            );
            let mut turn = R::outline(
                #[inline(always)]
                || coarse.halved(&machine, &mut m),
            );
            R::outline(
                #[inline(always)]
                || turn.solve(&machine),
            );
            let extremes = R::outline(
                #[inline(always)]
                || turn.extremes(&machine, &mut m),
            );
            let totals = R::outline(
                #[inline(always)]
                || turn.totals(&machine),
            );
            sweeps += u64::from(coarse.sweeps + turn.sweeps) * status.len() as u64;
            for (k, quantity) in row_of(turn.multiplier, &extremes, &totals).into_iter().enumerate() {
                quantity.store(&mut lane);
                for i in 0..status.len() {
                    self.out[(at + i) * QUANTITIES + k] = lane[i];
                }
            }
            let error = R::outline(
                #[inline(always)]
                || turn.error_against(&coarse, &machine, &mut m),
            );
            let may_have_faster = R::outline(
                #[inline(always)]
                || turn.may_have_faster(&machine),
            );
            // Where Newton did not converge, or to a motion that the machine departs from, or that may not be
            // the fastest, there is no error to trust.
            let none = R::splat(f64::NAN);
            let is_stable = turn.multiplier.select_lt(R::splat(1.0), error, none);
            let is_fastest = may_have_faster.select_lt(R::splat(0.5), is_stable, none);
            let trusted = turn.correction.select_lt(R::splat(PROMISED), is_fastest, none);
            trusted.store(&mut lane);
            for (status, error) in status.iter_mut().zip(&lane) {
                if error.is_nan() || *error > PROMISED {
                    *status = Status::Inaccurate;
                }
            }
        }
        sweeps
    }
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
    let moves_kinks = !plan.moving_kinks().is_empty();
    for (i, (status, row)) in status.iter_mut().zip(out.chunks_exact_mut(QUANTITIES)).enumerate() {
        let q = rows.row(first + i);
        let passes_kink = || {
            moves_kinks || plan.drive.speed_kinks(&plan.tables, &q).iter().any(|&s| row[0] < s && s < row[1])
        };
        let is_good = row.iter().all(|x| x.is_finite()) && row[0] > 0.0;
        if *status == Status::Ok && is_good && !passes_kink() {
            continue;
        }
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
    let mut given = Vec::new();
    for (i, &phi_i) in phi.iter().enumerate() {
        poll();
        plan.mechanism.place::<f64, 1>(q, Angle::new(phi_i), &mut m);
        given.clear();
        plan.give(q, phi_i, &m, &mut given);
        for (k, &omega_k) in omega.iter().enumerate() {
            out[k * phi.len() + i] = plan.law_torque(q, &given, omega_k, f64::NAN);
        }
    }
}
