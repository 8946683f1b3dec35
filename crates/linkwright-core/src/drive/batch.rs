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
use crate::kernel::jet::Jet;
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
        for (i, &slot) in self.slots.iter().enumerate() {
            q[slot] = self.values[i * self.n + row];
        }
        q
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

/// What is asked of a motion at every angle.
#[derive(Clone, Copy, Debug)]
pub enum Channel {
    /// Position, first and second transfer function of a point: x, y, x′, y′, x″, y″.
    Point(usize),
    /// Direction of a link as cos ψ, sin ψ, and ψ′, ψ″.
    Link(usize),
    /// A slide's s, s′, s″.
    Slide(usize),
}

impl Channel {
    /// How many numbers it gives at each angle.
    pub fn width(self) -> usize {
        match self {
            Channel::Point(_) => 6,
            Channel::Link(_) => 4,
            Channel::Slide(_) => 3,
        }
    }
}

/// Numbers of output that a task should write: large against the cost of handing it over.
const TASK: usize = 8192;

/// Motions of all rows at the same angles. `out` is (rows, numbers, angles), contiguous.
pub fn motions(plan: &Plan, rows: &Rows<'_>, phi: &[f64], channels: &[Channel], out: &mut [f64]) {
    let n = phi.len();
    let width: usize = channels.iter().map(|c| c.width()).sum();
    if n == 0 || width == 0 {
        return;
    }
    let (mut sin, mut cos) = (vec![0.0; n], vec![0.0; n]);
    in_lanes(SinCos { phi, sin: &mut sin, cos: &mut cos });
    let job = |first: usize, at: std::ops::Range<usize>, out: Vec<Vec<&mut [f64]>>| {
        let (phi, sin, cos) = (&phi[at.clone()], &sin[at.clone()], &cos[at]);
        in_lanes(MotionJob { plan, rows, first, phi, sin, cos, channels, out });
    };
    if rows.n == 1 {
        // One machine: each task takes a piece of the turn.
        let piece = (TASK / width).max(1).next_multiple_of(64);
        let mut pieces: Vec<Vec<&mut [f64]>> = (0..n.div_ceil(piece)).map(|_| Vec::new()).collect();
        for list in out.chunks_exact_mut(n) {
            poll();
            for (piece, part) in pieces.iter_mut().zip(list.chunks_mut(piece)) {
                piece.push(part);
            }
        }
        let task = |(k, out): (usize, Vec<&mut [f64]>)| {
            job(0, k * piece..(k * piece + out[0].len()), vec![out]);
        };
        if pieces.len() == 1 {
            // Waking threads would take longer than doing it.
            pieces.into_iter().enumerate().for_each(task);
        } else {
            in_threads(|crew| {
                pieces.into_par_iter().enumerate().for_each(|piece| crew.task(|| task(piece)));
            });
        }
    } else {
        let at_once = (TASK / (width * n)).max(1);
        let task = |(k, out): (usize, &mut [f64])| {
            let lists = out.chunks_exact_mut(width * n).map(|row| row.chunks_exact_mut(n).collect());
            job(k * at_once, 0..n, lists.collect());
        };
        in_threads(|crew| {
            let tasks = out.par_chunks_mut(width * n * at_once).enumerate();
            tasks.for_each(|rows| crew.task(|| task(rows)));
        });
    }
}

struct SinCos<'a> {
    phi: &'a [f64],
    sin: &'a mut [f64],
    cos: &'a mut [f64],
}

impl Job for SinCos<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let whole = self.phi.len() / R::LANES * R::LANES;
        for at in (0..whole).step_by(R::LANES) {
            let (s, c) = R::load(&self.phi[at..]).sin_cos();
            s.store(&mut self.sin[at..]);
            c.store(&mut self.cos[at..]);
        }
        for at in whole..self.phi.len() {
            (self.sin[at], self.cos[at]) = self.phi[at].sin_cos();
        }
    }
}

/// Rows from `first` on at some angles; `out` holds one list a number for every row.
struct MotionJob<'a, 'b> {
    plan: &'a Plan,
    rows: &'a Rows<'a>,
    first: usize,
    phi: &'a [f64],
    sin: &'a [f64],
    cos: &'a [f64],
    channels: &'a [Channel],
    out: Vec<Vec<&'b mut [f64]>>,
}

impl Job for MotionJob<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let n = self.phi.len();
        let MotionJob { plan, rows, first, phi, sin, cos, channels, out } = self;
        let mut row = rows.base.to_vec();
        let mut q: Vec<R> = row.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(&plan.mechanism, &q);
        let mut rest = Motion::new(&plan.mechanism, &row);
        for (i, mut out) in out.into_iter().enumerate() {
            poll();
            for (k, &slot) in rows.slots.iter().enumerate() {
                row[slot] = rows.values[k * rows.n + first + i];
                q[slot] = R::splat(row[slot]);
            }
            m.ground(&plan.mechanism, &q);
            rest.ground(&plan.mechanism, &row);
            let whole = n / R::LANES * R::LANES;
            for at in (0..whole).step_by(R::LANES) {
                let angle =
                    Angle { phi: R::load(&phi[at..]), sin: R::load(&sin[at..]), cos: R::load(&cos[at..]) };
                plan.mechanism.place::<R, 2>(&q, angle, &mut m);
                store(&m, channels, at, &mut out);
            }
            // The angles that do not fill all lanes.
            for at in whole..n {
                let angle = Angle { phi: phi[at], sin: sin[at], cos: cos[at] };
                plan.mechanism.place::<f64, 2>(&row, angle, &mut rest);
                store(&rest, channels, at, &mut out);
            }
        }
    }
}

/// Writes all channels at one angle (or one a lane), a number to each list.
#[inline(always)]
fn store<R: Real>(m: &Motion<R>, channels: &[Channel], at: usize, out: &mut [&mut [f64]]) {
    let mut lists = out.iter_mut();
    let mut put = Put { lists: &mut lists, at };
    for channel in channels {
        match *channel {
            Channel::Point(i) => {
                let place = &m.points[i];
                put.next(place.p.x);
                put.next(place.p.y);
                put.next(place.d1.x);
                put.next(place.d1.y);
                put.next(place.d2.x);
                put.next(place.d2.y);
            }
            Channel::Link(i) => {
                let link = &m.links[i];
                put.next(link.e.x);
                put.next(link.e.y);
                put.next(link.d1);
                put.next(link.d2);
            }
            Channel::Slide(i) => {
                let slide = &m.slides[i];
                put.next(slide.s);
                put.next(slide.d1);
                put.next(slide.d2);
            }
        }
    }
}

/// Writes one number after the other, each to the next list.
struct Put<'a, 'b, 'c> {
    lists: &'a mut std::slice::IterMut<'b, &'c mut [f64]>,
    at: usize,
}

impl Put<'_, '_, '_> {
    #[inline(always)]
    fn next<R: Real>(&mut self, value: R) {
        // There are as many lists as the channels have numbers.
        if let Some(list) = self.lists.next() {
            value.store(&mut list[self.at..]);
        }
    }
}

/// Third transfer functions of one machine: x‴, y‴ of a point, ψ‴ of a link, s‴ of a slide, in the order of
/// the channels. `out` is (numbers, angles). They come from positions alone, in jets of the crank angle.
pub fn third(plan: &Plan, q: &[f64], phi: &[f64], channels: &[Channel], out: &mut [f64]) {
    in_lanes(ThirdJob { plan, q, phi, channels, out });
}

struct ThirdJob<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    phi: &'a [f64],
    channels: &'a [Channel],
    out: &'a mut [f64],
}

impl Job for ThirdJob<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let n = self.phi.len();
        let q: Vec<Jet<R, 4>> = self.q.iter().map(|&x| Jet::splat(x)).collect();
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut lanes = vec![0.0; R::LANES];
        for (block, phi) in self.phi.chunks(R::LANES).enumerate() {
            poll();
            lanes[..phi.len()].copy_from_slice(phi);
            let angle = Angle::new(Jet::variable(R::load(&lanes)));
            self.plan.mechanism.place::<Jet<R, 4>, 1>(&q, angle, &mut m);
            let mut row = 0;
            for channel in self.channels {
                for value in third_of(*channel, &m).into_iter().take(channel.third_width()) {
                    value.store(&mut lanes);
                    let at = row * n + block * R::LANES;
                    self.out[at..at + phi.len()].copy_from_slice(&lanes[..phi.len()]);
                    row += 1;
                }
            }
        }
    }
}

impl Channel {
    /// How many third derivatives it gives at each angle.
    pub fn third_width(self) -> usize {
        if matches!(self, Channel::Point(_)) { 2 } else { 1 }
    }
}

/// Third derivatives of a channel; the second entry is used by points alone.
#[inline(always)]
fn third_of<R: Real>(channel: Channel, m: &Motion<Jet<R, 4>>) -> [R; 2] {
    let zero = R::splat(0.0);
    match channel {
        Channel::Point(i) => [m.points[i].p.x.c[3] * 6.0, m.points[i].p.y.c[3] * 6.0],
        Channel::Link(i) => {
            // ψ′ = e × e′, so ψ‴ = e × e‴ + e′ × e″.
            let (x, y) = (&m.links[i].e.x.c, &m.links[i].e.y.c);
            let outer = x[0] * y[3] - y[0] * x[3];
            let inner = x[1] * y[2] - y[1] * x[2];
            [outer * 6.0 + inner * 2.0, zero]
        }
        Channel::Slide(i) => [m.slides[i].s.c[3] * 6.0, zero],
    }
}

/// Radicand of each dyad at each angle: where one is negative the mechanism does not close. `out` is
/// (dyads, angles).
pub fn gaps(plan: &Plan, q: &[f64], phi: &[f64], out: &mut [f64]) {
    in_lanes(GapJob { plan, q, phi, out });
}

struct GapJob<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    phi: &'a [f64],
    out: &'a mut [f64],
}

impl Job for GapJob<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let n = self.phi.len();
        let q: Vec<R> = self.q.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut lanes = vec![0.0; R::LANES];
        for (block, phi) in self.phi.chunks(R::LANES).enumerate() {
            poll();
            lanes[..phi.len()].copy_from_slice(phi);
            self.plan.mechanism.place::<R, 1>(&q, Angle::new(R::load(&lanes)), &mut m);
            for (k, gap) in m.gaps.iter().enumerate() {
                gap.store(&mut lanes);
                let at = k * n + block * R::LANES;
                self.out[at..at + phi.len()].copy_from_slice(&lanes[..phi.len()]);
            }
        }
    }
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
