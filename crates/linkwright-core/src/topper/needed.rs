//! How long the edge must be to cut all of a head: L/2 = max (|q| + √(r² − p²)) while it passes.
//!
//! The time runs as that of a pendulum, t = m + w sin u, between the ends of each smooth stretch: chords are then smooth
//! over u up to the rim, where they have no length. Tops of parabolas through three stations are climbed by Newton.

use super::knife::{Head, Knife};
use crate::real::Real;
use std::f64::consts::PI;

/// What a head needs.
#[derive(Clone, Copy, Debug)]
pub struct Needed<R> {
    /// Half of the length.
    pub half: R,
    /// When the edge crosses the chord whose end is the last to be reached.
    pub at: R,
    /// +1 if that end lies ahead along e, −1 if behind.
    pub side: R,
}

/// sin u and cos u at stations over a stretch, and the step of u.
#[derive(Clone, Debug)]
pub struct Stations {
    pub turns: Vec<[f64; 2]>,
    pub step: f64,
}

impl Stations {
    /// In the middles of n equal steps.
    pub fn new(n: usize) -> Self {
        let step = PI / n as f64;
        let turns = (0..n).map(|j| ((j as f64 + 0.5) * step - 0.5 * PI).sin_cos().into()).collect();
        Stations { turns, step }
    }
}

/// Newton's steps from a station: it starts within half a step of the top.
const STEPS: usize = 4;

/// A top that may be the highest of all: how high about, where, and how far it may be off.
#[derive(Clone, Copy)]
struct Top<R> {
    height: R,
    at: R,
    reach: R,
}

/// What the head needs while the edge passes it between two times.
#[inline(always)]
pub fn needed<R: Real>(
    knife: &Knife,
    head: &Head<R>,
    window: [R; 2],
    turns: std::ops::RangeInclusive<i32>,
    stations: &Stations,
) -> Needed<R> {
    let zero = R::splat(0.0);
    let mut tops = [Top { height: R::splat(f64::NEG_INFINITY), at: window[0], reach: zero }; 2];
    let mut found = [(R::splat(f64::NEG_INFINITY), window[0]); 2];
    knife.stretches(
        head,
        window,
        turns,
        #[inline(always)]
        |[start, end]| {
            let (middle, width) = ((start + end) * 0.5, (end - start) * 0.5);
            let [behind, ahead] = heights(knife, head, end);
            found = [better(found[0], (behind, end)), better(found[1], (ahead, end))];
            let mut rows = [[zero; 3]; 2];
            for (j, &[sin, cos]) in stations.turns.iter().enumerate() {
                let t = middle + width * sin;
                let pace = width * (cos * stations.step);
                let row = heights(knife, head, t);
                for side in 0..2 {
                    let height = row[side];
                    rows[side] = [rows[side][1], rows[side][2], height];
                    found[side] = better(found[side], (height, t));
                    tops[side] = higher(tops[side], Top { height, at: t, reach: pace });
                    if j >= 2 {
                        let [sin, cos] = stations.turns[j - 1];
                        let pace = width * (cos * stations.step);
                        tops[side] = higher(tops[side], parabola(rows[side], middle + width * sin, pace));
                    }
                }
            }
        },
    );
    for side in 0..2 {
        found[side] = climbed(knife, head, tops[side], side, found[side]);
    }
    let [(near, at_near), (far, at_far)] = found;
    Needed {
        half: near.max(far),
        at: near.select_lt(far, at_far, at_near),
        side: near.select_lt(far, R::splat(1.0), R::splat(-1.0)),
    }
}

/// ±q + √(r² − p²): what the chord's end behind, and that ahead, asks of the edge.
#[inline(always)]
fn heights<R: Real>(knife: &Knife, head: &Head<R>, t: R) -> [R; 2] {
    let place = knife.place(head, t);
    let chord = half_chord(head.radius, place.p[0]);
    [chord + place.q[0], chord - place.q[0]]
}

/// √(r² − p²), zero outside.
#[inline(always)]
pub fn half_chord<R: Real>(radius: R, p: R) -> R {
    (radius * radius - p * p).max(R::splat(0.0)).sqrt()
}

/// The greater value, with its time; a NaN is passed over.
#[inline(always)]
fn better<R: Real>(a: (R, R), b: (R, R)) -> (R, R) {
    (a.0.select_lt(b.0, b.0, a.0), a.0.select_lt(b.0, b.1, a.1))
}

#[inline(always)]
fn higher<R: Real>(a: Top<R>, b: Top<R>) -> Top<R> {
    Top {
        height: a.height.select_lt(b.height, b.height, a.height),
        at: a.height.select_lt(b.height, b.at, a.at),
        reach: a.height.select_lt(b.height, b.reach, a.reach),
    }
}

/// The top of a parabola through three stations, if the middle one is the highest; else nothing.
#[inline(always)]
fn parabola<R: Real>([a, b, c]: [R; 3], at: R, pace: R) -> Top<R> {
    let (slope, bend) = (c - a, a - b - b + c);
    let is_top = (b - a).min(b - c);
    let height = b - slope * slope / (bend * 8.0);
    let nothing = R::splat(f64::NEG_INFINITY);
    let shift = slope / (bend * -2.0);
    Top { height: is_top.select_lt(R::splat(0.0), nothing, height), at: at + pace * shift, reach: pace }
}

/// Newton on the slope of a height from about its top.
#[inline(always)]
fn climbed<R: Real>(knife: &Knife, head: &Head<R>, top: Top<R>, side: usize, mut best: (R, R)) -> (R, R) {
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let (low, high) = (top.at - top.reach, top.at + top.reach);
    let mut t = top.at;
    for _ in 0..STEPS {
        let place = knife.place(head, t);
        let [p, dp, ddp] = place.p;
        let chord = half_chord(head.radius, p);
        let height = chord + place.q[0] * sign;
        best = better(best, (height, t));
        let inverse = chord.recip();
        let slope = place.q[1] * sign - p * dp * inverse;
        let lean = p * dp * inverse;
        let bend = place.q[2] * sign - (dp * dp + p * ddp + lean * lean) * inverse;
        t = (t - slope / bend).max(low).min(high);
    }
    better(best, (heights(knife, head, t)[side], t))
}
