//! What an edge of given length leaves of a head, if it never retreats: the parts of chords beyond its two ends, over
//! the way of the edge along its normal.
//!
//! The integrand has kinks where an end of the edge crosses the rim of the head. They are found first; between them it is
//! smooth, and Gauss's rule takes it. A lane is a place of the edge over one head.

use super::knife::{Head, Knife};
use super::needed::{Stations, half_chord};
use crate::gauss::{B, C};
use crate::real::Real;

/// Length of u that a part of Gauss's rule takes, at most: of order 8, it leaves some 1e-12 of a head.
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
                swing.kinks(scratch);
                let more = swing.area::<R>(scratch);
                area = [area[0] + more[0], area[1] + more[1]];
            }
        },
    );
    area
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
        [q + chord - self.half, chord - q - self.half, q - chord - self.half, -q - chord - self.half]
    }

    /// Both ends, and where an end of the edge crosses the rim, increasing.
    #[inline(always)]
    fn kinks(&self, scratch: &mut Scratch) {
        let Scratch { places, kinks, .. } = scratch;
        kinks.clear();
        kinks.push(places[0][0]);
        for pair in places.windows(2) {
            let [here, there] = [pair[0], pair[1]].map(|[_, q, chord]| self.beyond(q, chord));
            let first = kinks.len();
            for k in 0..4 {
                if (here[k] > 0.0) != (there[k] > 0.0) {
                    let crossed = crossing(
                        [pair[0][0], pair[1][0]],
                        [here[k], there[k]],
                        CLOSE,
                        #[inline(always)]
                        |u| {
                            let [chord, q, _] = self.at(u);
                            self.beyond(q, chord)[k]
                        },
                    );
                    kinks.push(crossed);
                }
            }
            kinks[first..].sort_by(f64::total_cmp);
        }
        kinks.push(places[places.len() - 1][0]);
    }

    /// Area left on both sides.
    #[inline(always)]
    fn area<R: Real>(&self, scratch: &mut Scratch) -> [f64; 2] {
        self.nodes(scratch);
        let zero = R::splat(0.0);
        let (mut behind, mut ahead) = (zero, zero);
        for (u, weight) in scratch.nodes.chunks_exact(R::LANES).zip(scratch.weights.chunks_exact(R::LANES)) {
            let [chord, q, pace] = self.at(R::load(u));
            let left = |far: R| (far + chord - R::splat(self.half)).max(zero).min(chord + chord);
            let share = pace * R::load(weight);
            behind = behind + left(q) * share;
            ahead = ahead + left(-q) * share;
        }
        [sum(behind), sum(ahead)]
    }

    /// Gauss's nodes of all panels in which something is left, filled up to whole lanes with nodes of no weight.
    #[inline(always)]
    fn nodes(&self, scratch: &mut Scratch) {
        let Scratch { kinks, nodes, weights, .. } = scratch;
        nodes.clear();
        weights.clear();
        for pair in kinks.windows(2) {
            let [chord, q, _] = self.at(0.5 * (pair[0] + pair[1]));
            let [behind, ahead, ..] = self.beyond(q, chord);
            if behind <= 0.0 && ahead <= 0.0 {
                continue;
            }
            let parts = ((pair[1] - pair[0]) / PART).ceil().max(1.0);
            let step = (pair[1] - pair[0]) / parts;
            for part in 0..parts as usize {
                nodes.extend(C.iter().map(|c| pair[0] + (part as f64 + c) * step));
                weights.extend(B.iter().map(|b| b * step));
            }
        }
        let whole = nodes.len().next_multiple_of(16);
        nodes.resize(whole, 0.0);
        weights.resize(whole, 0.0);
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
