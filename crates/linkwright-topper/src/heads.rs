//! Many heads under one knife: what each needs, and what the edge leaves of it.

use super::knife::{Head, Knife};
use super::needed::{Stations, half_chord, needed};
use super::retreat;
use super::uncut::{ShortEdge, Uncut};
use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::{Real, store_part};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Results a head: length that it needs; the point that is reached last, along x and y from its centre; area that is left
/// on the right of the edge, on its left, and between two passes of it.
pub const RESULTS: usize = 6;

/// A column of each result.
pub type Columns<'a> = [&'a mut [f64]; RESULTS];

/// Heads: columns of one entry or one a head.
#[derive(Clone, Copy, Debug)]
pub struct Heads<'a> {
    pub radius: &'a [f64],
    pub offset: &'a [f64],
    pub phase: &'a [f64],
    /// How many.
    pub n: usize,
}

/// Looks at all heads; `fine` stations per revolution of the law; areas are zero without an edge. `out` holds a column of each
/// result.
pub fn cover(knife: &Knife, heads: &Heads<'_>, length: Option<f64>, fine: usize, out: Columns<'_>) {
    let longest = longest(knife, heads);
    let turns = knife.rate.abs() * 2.0 * longest / TAU;
    let stations = Stations::new(fine.saturating_add((fine as f64 * turns).min(MOST) as usize));
    let work = Work { knife, heads, half: length.map(|l| 0.5 * l), stations: &stations, longest };
    let task = |(k, out): (usize, Columns<'_>)| {
        if knife.retreats() {
            work.one_by_one(k * CHUNK, out);
        } else {
            in_lanes(Chunk { work: &work, first: k * CHUNK, out });
        }
    };
    in_threads(|crew| {
        let tasks = chunks(out).into_par_iter().enumerate();
        tasks.for_each(|heads| crew.task(|| task(heads)));
    });
}

/// Heads a task: some hundred microseconds of work.
const CHUNK: usize = 256;

/// Columns cut into those of the tasks.
fn chunks(out: Columns<'_>) -> Vec<Columns<'_>> {
    let n = out[0].len();
    let mut rest = out.map(|column| column.chunks_mut(CHUNK));
    (0..n.div_ceil(CHUNK)).map(|_| rest.each_mut().map(|chunk| chunk.next().unwrap_or_default())).collect()
}

/// Stations of a pass at most, for a knife that hardly goes on.
const MOST: f64 = 4096.0;

/// Longest time from abreast to either end of a pass.
fn longest(knife: &Knife, heads: &Heads<'_>) -> f64 {
    let most = |column: &[f64]| column.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let [sin, _] = knife.direction;
    let way = most(heads.radius) + (knife.reach + most(heads.offset)) * sin.abs();
    way / knife.advance().abs()
}

/// What all chunks share.
struct Work<'a> {
    knife: &'a Knife,
    heads: &'a Heads<'a>,
    half: Option<f64>,
    stations: &'a Stations,
    longest: f64,
}

fn entry(column: &[f64], k: usize) -> f64 {
    column[k.min(column.len() - 1)]
}

impl Work<'_> {
    fn head(&self, k: usize) -> Head<f64> {
        let Heads { radius, offset, phase, .. } = self.heads;
        Head { radius: entry(radius, k), offset: entry(offset, k), phase: entry(phase, k) }
    }

    /// Place along x and y of a point given along n and e.
    #[inline(always)]
    fn point<R: Real>(&self, p: R, s: R) -> [R; 2] {
        let [sin, cos] = self.knife.direction;
        [p * cos + s * sin, s * cos - p * sin]
    }

    /// The scalar way, for an edge that retreats.
    fn one_by_one(&self, first: usize, mut out: Columns<'_>) {
        for k in 0..out[0].len() {
            poll();
            let left = retreat::cover(self.knife, &self.head(first + k), self.half, self.stations);
            let [x, y] = self.point(left.p, left.s);
            let row = [2.0 * left.half, x, y, left.area[0], left.area[1], left.area[2]];
            out.iter_mut().zip(row).for_each(|(column, x)| column[k] = x);
        }
    }
}

struct Chunk<'a> {
    work: &'a Work<'a>,
    first: usize,
    out: Columns<'a>,
}

impl Job for Chunk<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let [need, last_x, last_y, behind, ahead, between] = self.out;
        let n = need.len();
        [&mut *behind, &mut *ahead, between].into_iter().for_each(|area| area.fill(0.0));
        let mut lanes = vec![0.0; 6 * R::LANES];
        let Work { knife, stations, longest, .. } = *self.work;
        let turns = knife.turns(longest);
        let edge = self.work.half.map(|half| ShortEdge { knife, half, turns, stations });
        let mut uncut = Uncut::default();
        let mut heights = vec![[R::splat(0.0); 2]; stations.turns.len()];
        for at in (0..n).step_by(R::LANES) {
            poll();
            let found = out_of_line!(R, self.work.lanes::<R>(self.first + at, &mut heights));
            let [half, _, p, s, ..] = found;
            let [x, y] = self.work.point(p, s);
            store_part(half + half, &mut need[at..]);
            store_part(x, &mut last_x[at..]);
            store_part(y, &mut last_y[at..]);
            let Some(edge) = &edge else { continue };
            for (x, to) in found.into_iter().zip(lanes.chunks_exact_mut(R::LANES)) {
                x.store(to);
            }
            let of = |k: usize, lane: usize| lanes[k * R::LANES + lane];
            uncut.clear();
            for lane in (0..R::LANES.min(n - at)).filter(|&lane| edge.half < of(0, lane)) {
                let head = self.work.head(self.first + at + lane);
                out_of_line!(R, uncut.add::<R>(edge, lane, &head, [of(4, lane), of(5, lane)], of(1, lane)));
            }
            out_of_line!(R, {
                uncut.areas::<R>(edge, |lane, area| {
                    behind[at + lane] += area[0];
                    ahead[at + lane] += area[1];
                });
            });
        }
    }
}

impl Work<'_> {
    /// What the heads from one on need, as many as there are lanes, and between which times they are passed; beyond the
    /// last they are repeated.
    #[inline(always)]
    fn lanes<R: Real>(&self, first: usize, heights: &mut [[R; 2]]) -> [R; 6] {
        let Work { knife, heads, stations, longest, .. } = self;
        let load = |column: &[f64]| {
            let mut lanes = [0.0; 2 * LANES_MAX];
            for (lane, to) in lanes[..R::LANES].iter_mut().enumerate() {
                *to = entry(column, first + lane);
            }
            R::load(&lanes)
        };
        let head = Head { radius: load(heads.radius), offset: load(heads.offset), phase: load(heads.phase) };
        let window = [knife.time(&head, -head.radius), knife.time(&head, head.radius)];
        let found = needed(knife, &head, window, knife.turns(*longest), stations, heights);
        let p = knife.place(&head, found.at).p[0];
        [found.half, found.at, p, found.side * half_chord(head.radius, p), window[0], window[1]]
    }
}

/// Lanes of the widest register.
const LANES_MAX: usize = 8;
