//! What an edge of given length leaves of a head, if it never retreats: the parts of chords beyond its two ends, over
//! the way of the edge along its normal.
//!
//! The integrand has kinks where an end of the edge crosses the rim of the head. They are found first; between them it is
//! smooth, and Gauss's rule takes it. A lane is a place of the edge over one head.

use super::knife::{Head, Knife};
use super::needed::{Stations, half_chord};
use linkwright_kernel::gauss::{B, C};
use linkwright_kernel::real::Real;

/// Length of u, and of the law's phase, that a part of Gauss's rule takes at most: of order 8, it leaves 1e-12 of a head.
const PART: f64 = 0.25;

/// Steps of the search for a kink: regula falsi (Illinois) gains a digit and a half each.
const SEARCH: usize = 60;

/// How well a kink is known: the integrand is zero at its one side, so that an error counts squared.
const CLOSE: f64 = 1e-9;

/// Lists that are used again from head to head.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Places u of the edge, how far it lies from the centre along itself, and half of the chord there.
    places: Vec<[f64; 3]>,
    kinks: Vec<f64>,
    /// Places u and weights of Gauss's rule.
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

/// Area that is left beyond the end behind and that ahead, seen along e; `top` is when most is left.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one head, one edge, one pass")]
pub fn uncut<R: Real>(
    knife: &Knife,
    head: &Head<f64>,
    half: f64,
    window: [f64; 2],
    turns: std::ops::RangeInclusive<i32>,
    stations: &Stations,
    top: f64,
    scratch: &mut Scratch,
) -> [f64; 2] {
    let mut area = [0.0; 2];
    knife.stretches(
        head,
        window,
        turns,
        #[inline(always)]
        |[start, end]| {
            if end > start {
                let (middle, width) = (0.5 * (start + end), 0.5 * (end - start));
                let swing = Swing { knife, head, half, middle, width };
                swing.look::<R>(stations, top, scratch);
                swing.kinks::<R>(scratch);
                let more = swing.area::<R>(scratch);
                area = [area[0] + more[0], area[1] + more[1]];
            }
        },
    );
    area
}

/// What an end of the edge lies beyond an end of the chord by: these times q and the half chord, less half of the edge.
const ENDS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];

/// Brackets of kinks: both ends, the function there, what it is made of.
#[derive(Default)]
struct Brackets {
    rows: [[f64; 16]; 6],
    n: usize,
}

impl Brackets {
    #[inline(always)]
    fn push(&mut self, [a, b]: [f64; 2], [fa, fb]: [f64; 2], [along, across]: [f64; 2]) {
        for (row, x) in self.rows.iter_mut().zip([a, b, fa, fb, along, across]) {
            row[self.n] = x;
        }
        self.n += 1;
    }
}

/// A stretch of time, run through as t = m + w sin u.
struct Swing<'a> {
    knife: &'a Knife,
    head: &'a Head<f64>,
    half: f64,
    middle: f64,
    width: f64,
}

impl Swing<'_> {
    /// Half of the chord, the place of the edge along it, and how fast the edge goes over u.
    #[inline(always)]
    fn at<R: Real>(&self, u: R) -> [R; 3] {
        let Head { radius, offset, phase } = *self.head;
        let head = Head { radius: R::splat(radius), offset: R::splat(offset), phase: R::splat(phase) };
        let (sin, cos) = u.sin_cos();
        let place = self.knife.place(&head, sin * self.width + self.middle);
        [half_chord(head.radius, place.p[0]), place.q[0], place.p[1] * cos * self.width]
    }

    /// The edge at all stations and where most is left: between two stations nothing else might be.
    #[inline(always)]
    fn look<R: Real>(&self, stations: &Stations, top: f64, scratch: &mut Scratch) {
        let mut lanes = [0.0; 16];
        scratch.places.clear();
        for u in stations.u.chunks(R::LANES) {
            lanes[..u.len()].copy_from_slice(u);
            lanes[u.len()..].fill(u[0]);
            let [chord, q, _] = self.at(R::load(&lanes));
            let (mut chords, mut along) = ([0.0; 16], [0.0; 16]);
            chord.store(&mut chords);
            q.store(&mut along);
            scratch.places.extend((0..u.len()).map(|k| [u[k], along[k], chords[k]]));
        }
        let highest = (top - self.middle) / self.width;
        if highest.abs() < 1.0 {
            let u = highest.asin();
            let [chord, q, _] = self.at(u);
            let next = scratch.places.partition_point(|place| place[0] < u);
            scratch.places.insert(next, [u, q, chord]);
        }
    }

    /// How far the chord's ends lie beyond the edge's, behind and ahead; and how far its other ends do.
    #[inline(always)]
    fn beyond(&self, q: f64, chord: f64) -> [f64; 4] {
        ENDS.map(|[along, across]| along * q + across * chord - self.half)
    }

    /// Both ends, and where an end of the edge crosses the rim, increasing.
    #[inline(always)]
    fn kinks<R: Real>(&self, scratch: &mut Scratch) {
        let Scratch { places, kinks, .. } = scratch;
        kinks.clear();
        let mut found = Brackets::default();
        for pair in places.windows(2) {
            let [here, there] = [pair[0], pair[1]].map(|[_, q, chord]| self.beyond(q, chord));
            for k in 0..4 {
                if (here[k] > 0.0) != (there[k] > 0.0) {
                    found.push([pair[0][0], pair[1][0]], [here[k], there[k]], ENDS[k]);
                    if found.n == R::LANES {
                        kinks.extend_from_slice(&self.crossings::<R>(&found)[..found.n]);
                        found.n = 0;
                    }
                }
            }
        }
        if found.n > 0 {
            kinks.extend_from_slice(&self.crossings::<R>(&found)[..found.n]);
        }
        kinks.push(places[0][0]);
        kinks.push(places[places.len() - 1][0]);
        kinks.sort_by(f64::total_cmp);
    }

    /// Where an end of the edge crosses the rim, a bracket each: regula falsi (Illinois) in lanes.
    #[inline(always)]
    fn crossings<R: Real>(&self, found: &Brackets) -> [f64; 16] {
        let mut rows = found.rows;
        for row in &mut rows {
            // Lanes without a bracket repeat the first.
            let first = row[0];
            row[found.n..].fill(first);
        }
        let [mut a, mut b, mut fa, mut fb, along, across] = rows.map(
            #[inline(always)]
            |row| R::load(&row),
        );
        let (zero, tiny) = (R::splat(0.0), R::splat(f64::MIN_POSITIVE));
        for _ in 0..SEARCH {
            let x = fb.abs().select_lt(tiny, b, b - fb * (b - a) / (fb - fa));
            let [chord, q, _] = self.at(x);
            let fx = q * along + chord * across - R::splat(self.half);
            let far = (x - b).abs().max_lane();
            // On the side of b the other end counts half; else b becomes the other end.
            let same = fx * fb;
            let (at, value) = (same.select_lt(zero, b, a), same.select_lt(zero, fb, fa * 0.5));
            (a, fa, b, fb) = (at, value, x, fx);
            if far < CLOSE {
                break;
            }
        }
        let mut at = [0.0; 16];
        b.store(&mut at);
        at
    }

    /// Length of a chord beyond an end of the edge.
    #[inline(always)]
    fn left<R: Real>(&self, q: R, chord: R) -> R {
        (q + chord - R::splat(self.half)).max(R::splat(0.0)).min(chord + chord)
    }

    /// Area left on both sides.
    #[inline(always)]
    fn area<R: Real>(&self, scratch: &mut Scratch) -> [f64; 2] {
        self.nodes::<R>(scratch);
        let zero = R::splat(0.0);
        let (mut behind, mut ahead) = (zero, zero);
        for (u, weight) in scratch.nodes.chunks_exact(R::LANES).zip(scratch.weights.chunks_exact(R::LANES)) {
            let [chord, q, pace] = self.at(R::load(u));
            let share = pace * R::load(weight);
            behind = behind + self.left(q, chord) * share;
            ahead = ahead + self.left(-q, chord) * share;
        }
        [sum(behind), sum(ahead)]
    }

    /// Gauss's nodes of all panels in which something is left, filled up to whole lanes with nodes of no weight.
    #[inline(always)]
    fn nodes<R: Real>(&self, scratch: &mut Scratch) {
        let Scratch { kinks, nodes, weights, .. } = scratch;
        nodes.clear();
        weights.clear();
        for panels in kinks.windows(2).collect::<Vec<_>>().chunks(R::LANES) {
            let mut middles = [0.0; 16];
            for (middle, pair) in middles.iter_mut().zip(panels) {
                *middle = 0.5 * (pair[0] + pair[1]);
            }
            let [chord, q, _] = self.at(R::load(&middles));
            let (mut chords, mut along) = ([0.0; 16], [0.0; 16]);
            chord.store(&mut chords);
            q.store(&mut along);
            for (k, pair) in panels.iter().enumerate() {
                // Beyond either end, whichever.
                if along[k].abs() + chords[k] > self.half {
                    self.panel([pair[0], pair[1]], nodes, weights);
                }
            }
        }
        let whole = nodes.len().next_multiple_of(16);
        nodes.resize(whole, 0.0);
        weights.resize(whole, 0.0);
    }

    /// Gauss's nodes of a panel: parts that are short in u, and in the phase of the law.
    #[inline(always)]
    fn panel(&self, [from, to]: [f64; 2], nodes: &mut Vec<f64>, weights: &mut Vec<f64>) {
        let turned = self.knife.rate * self.width * (to.sin() - from.sin());
        let parts = ((to - from).max(turned) / PART).ceil().max(1.0);
        let step = (to - from) / parts;
        for part in 0..parts as usize {
            nodes.extend(C.iter().map(|c| from + (part as f64 + c) * step));
            weights.extend(B.iter().map(|b| b * step));
        }
    }
}

/// The sum of all lanes.
#[inline(always)]
fn sum<R: Real>(x: R) -> f64 {
    let mut lanes = [0.0; 16];
    x.store(&mut lanes);
    lanes[..R::LANES].iter().sum()
}

/// Where a function crosses zero between two places (Dowell, Jarratt 1971: the Illinois method).
#[inline(always)]
pub fn crossing(
    [mut a, mut b]: [f64; 2],
    [mut fa, mut fb]: [f64; 2],
    close: f64,
    f: impl Fn(f64) -> f64,
) -> f64 {
    for _ in 0..SEARCH {
        let x = b - fb * (b - a) / (fb - fa);
        let fx = f(x);
        if fx == 0.0 || (x - b).abs() < close {
            return x;
        }
        if (fx > 0.0) == (fb > 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (x, fx);
    }
    b
}
