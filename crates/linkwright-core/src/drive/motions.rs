//! Motions of many machines at many angles: rows or pieces of the revolution over threads, angles into lanes.
//!
//! What is asked for is found along the chains that lead to it ([`crate::linkage::chain`]) where there are such, else the
//! whole mechanism is placed.

use crate::drive::batch::Rows;
use crate::drive::structure::Plan;
use crate::kernel::call::{in_threads, poll};
use crate::kernel::jet::Jet;
use crate::kernel::lanes::{Job, in_common_lanes, in_lanes};
use crate::kernel::out_of_line;
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::linkage::chain::Chain;
use crate::linkage::motion::{Channel, Motion};
use rayon::prelude::*;

/// Numbers of output that a task should write: large against the cost of waking a thread, and within its cache.
const TASK: usize = 65_536;

/// Motions of all rows at the same angles; whether all numbers are finite, and so are their sums at an angle. `out` is
/// (rows, numbers, angles), contiguous.
pub fn motions(plan: &Plan, rows: &Rows<'_>, phi: &[f64], channels: &[Channel], out: &mut [f64]) -> bool {
    let n = phi.len();
    let width: usize = channels.iter().map(|c| c.width()).sum();
    if n == 0 || width == 0 {
        return true;
    }
    let request = MotionRequest { plan, rows, channels, chains: &chains(plan, channels) };
    if rows.n == 1 {
        return motion_of_one(&request, phi, out);
    }
    let angles = Angles::of(phi);
    let at_once = (TASK / (width * n)).max(1);
    let task = |(k, out): (usize, &mut [f64])| {
        let lists = out.chunks_exact_mut(width * n).map(|row| row.chunks_exact_mut(n).collect());
        in_lanes(MotionJob { request, first: k * at_once, angles: &angles, out: lists.collect() })
    };
    if rows.n <= at_once {
        return task((0, out));
    }
    in_threads(|crew| {
        let tasks = out.par_chunks_mut(width * n * at_once).enumerate();
        tasks.map(|rows| crew.task(|| task(rows))).reduce(|| true, |a, b| a && b)
    })
}

/// One machine: each task takes a piece of the angles.
fn motion_of_one(request: &MotionRequest<'_>, phi: &[f64], out: &mut [f64]) -> bool {
    let n = phi.len();
    let piece = (TASK * n / out.len()).max(1).next_multiple_of(64);
    let mut pieces: Vec<Vec<&mut [f64]>> = (0..n.div_ceil(piece)).map(|_| Vec::new()).collect();
    for list in out.chunks_exact_mut(n) {
        poll();
        for (piece, part) in pieces.iter_mut().zip(list.chunks_mut(piece)) {
            piece.push(part);
        }
    }
    let task = |(k, out): (usize, Vec<&mut [f64]>)| {
        let angles = Angles::of(&phi[k * piece..(k * piece + out[0].len())]);
        in_lanes(MotionJob { request: *request, first: 0, angles: &angles, out: vec![out] })
    };
    if pieces.len() == 1 {
        // Waking threads would take longer than doing it.
        return pieces.into_iter().enumerate().all(task);
    }
    in_threads(|crew| {
        let pieces = pieces.into_par_iter().enumerate();
        pieces.map(|piece| crew.task(|| task(piece))).reduce(|| true, |a, b| a && b)
    })
}

/// The chains to all channels; none where one hangs on the crank in another way, or where they would solve more dyads
/// than thrice those of the mechanism: so much more it costs to keep everything that moves.
fn chains(plan: &Plan, channels: &[Channel]) -> Vec<Chain> {
    let found: Option<Vec<Chain>> = channels.iter().map(|&c| Chain::to(&plan.mechanism, c)).collect();
    let solved = |chains: &Vec<Chain>| chains.iter().map(Chain::dyads).sum::<usize>();
    found.filter(|chains| solved(chains) <= 3 * plan.mechanism.n_gaps).unwrap_or_default()
}

/// What is asked of which machines.
#[derive(Clone, Copy)]
struct MotionRequest<'a> {
    plan: &'a Plan,
    rows: &'a Rows<'a>,
    channels: &'a [Channel],
    /// One a channel, or none at all.
    chains: &'a [Chain],
}

/// Crank angles with sine and cosine.
struct Angles<'a> {
    phi: &'a [f64],
    sin: Vec<f64>,
    cos: Vec<f64>,
}

impl<'a> Angles<'a> {
    fn of(phi: &'a [f64]) -> Self {
        let (mut sin, mut cos) = (vec![0.0; phi.len()], vec![0.0; phi.len()]);
        in_lanes(SinCos { phi, sin: &mut sin, cos: &mut cos });
        Angles { phi, sin, cos }
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
    request: MotionRequest<'a>,
    first: usize,
    angles: &'a Angles<'a>,
    out: Vec<Vec<&'b mut [f64]>>,
}

impl Job for MotionJob<'_, '_> {
    /// Whether all numbers are finite.
    type Output = bool;

    #[inline(always)]
    fn run<R: Real>(self) -> bool {
        if self.request.chains.is_empty() {
            out_of_line!(R, self.place_all::<R>())
        } else {
            out_of_line!(R, self.follow_chains::<R>())
        }
    }
}

impl MotionJob<'_, '_> {
    /// Along the chains to what is asked for, and nothing else.
    #[inline(always)]
    fn follow_chains<R: Real>(self) -> bool {
        let MotionJob { request: MotionRequest { rows, channels, chains, .. }, first, angles, out } = self;
        let (sin, cos) = (&angles.sin, &angles.cos);
        let whole = sin.len() / R::LANES * R::LANES;
        // The angles that do not fill all lanes, filled up with the last.
        let rest = sin.len() - whole;
        let filled = |from: &[f64]| {
            let mut lanes = vec![from[from.len() - 1]; R::LANES];
            lanes[..rest].copy_from_slice(&from[whole..]);
            lanes
        };
        let (last_sin, last_cos) = (filled(sin), filled(cos));
        let mut last: Vec<Vec<f64>> = (0..6).map(|_| vec![0.0; R::LANES]).collect();
        let mut numbers = Vec::new();
        let mut flaw = R::splat(0.0);
        let mut row = rows.base.to_vec();
        for (i, mut out) in out.into_iter().enumerate() {
            poll();
            rows.replace(first + i, &mut row);
            let mut lists = out.as_mut_slice();
            for (chain, channel) in chains.iter().zip(channels) {
                chain.numbers(&row, &mut numbers);
                let (own, others) = lists.split_at_mut(channel.width());
                lists = others;
                flaw = flaw + chain.follow::<R>(&numbers, &sin[..whole], &cos[..whole], own);
                if rest > 0 {
                    let mut to: Vec<&mut [f64]> = last.iter_mut().map(Vec::as_mut_slice).collect();
                    flaw = flaw + chain.follow::<R>(&numbers, &last_sin, &last_cos, &mut to);
                    for (list, lanes) in own.iter_mut().zip(&last) {
                        list[whole..].copy_from_slice(&lanes[..rest]);
                    }
                }
            }
        }
        is_without(flaw)
    }

    /// Everything that moves, and of it what is asked for.
    #[inline(always)]
    fn place_all<R: Real>(self) -> bool {
        let MotionJob { request: MotionRequest { plan, rows, channels, .. }, first, angles, out } = self;
        let Angles { phi, sin, cos } = angles;
        let n = phi.len();
        let mut row = rows.base.to_vec();
        let mut q: Vec<R> = row.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(&plan.mechanism, &q);
        let mut rest = Motion::new(&plan.mechanism, &row);
        let (mut flaw, mut flaw_of_rest) = (R::splat(0.0), 0.0);
        for (i, mut out) in out.into_iter().enumerate() {
            poll();
            rows.replace(first + i, &mut row);
            for &slot in rows.slots {
                q[slot] = R::splat(row[slot]);
            }
            m.ground(&plan.mechanism, &q);
            rest.ground(&plan.mechanism, &row);
            let whole = n / R::LANES * R::LANES;
            for at in (0..whole).step_by(R::LANES) {
                let angle =
                    Angle { phi: R::load(&phi[at..]), sin: R::load(&sin[at..]), cos: R::load(&cos[at..]) };
                plan.mechanism.place::<R, 2>(&q, angle, &mut m);
                store(
                    &m,
                    channels,
                    at,
                    &mut out,
                    #[inline(always)]
                    |x: R, to| {
                        flaw = x.mul_add(R::splat(0.0), flaw);
                        x.store(to);
                    },
                );
            }
            // The angles that do not fill all lanes.
            for at in whole..n {
                let angle = Angle { phi: phi[at], sin: sin[at], cos: cos[at] };
                plan.mechanism.place::<f64, 2>(&row, angle, &mut rest);
                store(&rest, channels, at, &mut out, |x, to| {
                    flaw_of_rest += 0.0 * x;
                    to[0] = x;
                });
            }
        }
        is_without(flaw) && flaw_of_rest == 0.0
    }
}

/// Whether a sum of products with zero is free of NaN in all lanes.
#[inline(always)]
fn is_without<R: Real>(flaw: R) -> bool {
    let mut lanes = vec![0.0; R::LANES];
    flaw.store(&mut lanes);
    lanes.iter().all(|x| *x == 0.0)
}

/// Writes all channels at one angle (or one a lane) by `write`, a number to each list.
#[inline(always)]
pub fn store<R: Real>(
    m: &Motion<R>,
    channels: &[Channel],
    at: usize,
    out: &mut [&mut [f64]],
    mut write: impl FnMut(R, &mut [f64]),
) {
    let zero = R::splat(0.0);
    let mut lists = out.iter_mut();
    for channel in channels {
        let numbers = match *channel {
            Channel::Point(i) => {
                let place = &m.points[i];
                [place.p.x, place.p.y, place.d1.x, place.d1.y, place.d2.x, place.d2.y]
            }
            Channel::Link(i) => {
                let link = &m.links[i];
                [link.e.x, link.e.y, link.d1, link.d2, zero, zero]
            }
            Channel::Slide(i) => {
                let slide = &m.slides[i];
                [slide.s, slide.d1, slide.d2, zero, zero, zero]
            }
        };
        // There are as many lists as the channels have numbers.
        for (number, list) in numbers[..channel.width()].iter().zip(&mut lists) {
            write(*number, &mut list[at..]);
        }
    }
}

/// Third transfer functions of one machine: x‴, y‴ of a point, ψ‴ of a link, s‴ of a slide, in the order of
/// the channels. `out` is (numbers, angles). They come from positions alone, in jets of the crank angle.
pub fn third(plan: &Plan, q: &[f64], phi: &[f64], channels: &[Channel], out: &mut [f64]) {
    in_common_lanes(ThirdJob { plan, q, phi, channels, out });
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
