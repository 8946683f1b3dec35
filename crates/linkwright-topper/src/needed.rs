//! How long the edge must be to cut all of a head: L/2 = max (|q| + √(r² − p²)) while it passes.
//!
//! The time runs as that of a pendulum, t = m + w sin u, between the ends of each smooth stretch: chords are then smooth
//! over u up to the rim, where they have no length. Tops of parabolas through three stations are climbed by Newton.

use super::knife::{Head, Knife, Place};
use linkwright_kernel::real::Real;
use std::f64::consts::PI;

/// What a head needs.
#[derive(Clone, Copy, Debug)]
pub struct EdgeRequirement<R> {
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
    /// u, with both ends of the stretch, and their sines.
    pub u: Vec<f64>,
    pub sines: Vec<f64>,
    pub step: f64,
}

impl Stations {
    /// In the middles of n equal steps.
    pub fn new(n: usize) -> Self {
        let step = PI / n as f64;
        let inner = |j: usize| (j as f64 + 0.5) * step - 0.5 * PI;
        let turns = (0..n).map(|j| inner(j).sin_cos().into()).collect();
        let u: Vec<f64> = std::iter::once(-0.5 * PI).chain((0..n).map(inner)).chain([0.5 * PI]).collect();
        let sines = u.iter().map(|u| u.sin()).collect();
        Stations { turns, u, sines, step }
    }
}

/// Newton's steps from the top of a parabola, which is off by the cube of a station's step: each doubles its digits.
const STEPS: usize = 3;

/// A top that may be the highest of all: how high about, where, and how far it may be off.
#[derive(Clone, Copy)]
struct Top<R> {
    height: R,
    at: R,
    reach: R,
}

/// What the head needs while the edge passes it between two times; with room for a row a station.
#[inline(always)]
pub fn needed<R: Real>(
    knife: &Knife,
    head: &Head<R>,
    window: [R; 2],
    turns: std::ops::RangeInclusive<i32>,
    stations: &Stations,
    rows: &mut [[R; 2]],
) -> EdgeRequirement<R> {
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
            swing(knife, head, [middle, width], stations, rows);
            let last = rows.len() - 1;
            for (j, row) in rows.iter().enumerate() {
                let [sin, cos] = stations.turns[j];
                let (t, pace) = (middle + width * sin, width * (cos * stations.step));
                for side in 0..2 {
                    found[side] = better(found[side], (row[side], t));
                    // Between its neighbours a station lies no higher than the top of the parabola through the three.
                    let top = if j == 0 || j == last {
                        Top { height: row[side], at: t, reach: pace }
                    } else {
                        parabola([rows[j - 1][side], row[side], rows[j + 1][side]], t, pace)
                    };
                    tops[side] = higher(tops[side], top);
                }
            }
        },
    );
    let [(near, at_near), (far, at_far)] = found;
    let sampled = (near.max(far), near.select_lt(far, at_far, at_near));
    let side = near.select_lt(far, R::splat(1.0), R::splat(-1.0));
    // The side of the higher top; it may be another than that of the highest sample.
    let top = higher(tops[0], tops[1]);
    let top_side = tops[0].height.select_lt(tops[1].height, R::splat(1.0), R::splat(-1.0));
    let climbed = climbed(knife, head, top, -top_side);
    EdgeRequirement {
        half: sampled.0.max(climbed.0),
        at: sampled.0.select_lt(climbed.0, climbed.1, sampled.1),
        side: sampled.0.select_lt(climbed.0, top_side, side),
    }
}

/// Heights at all stations; those as far before as behind the middle have the sine of their distance in common.
#[inline(always)]
fn swing<R: Real>(
    knife: &Knife,
    head: &Head<R>,
    [middle, width]: [R; 2],
    stations: &Stations,
    rows: &mut [[R; 2]],
) {
    let phase = head.phase + middle * knife.rate;
    let abreast = (phase, phase.sin_cos());
    let n = rows.len();
    for k in 0..n.div_ceil(2) {
        let way = width * stations.turns[n - 1 - k][0];
        let [before, behind] = knife.law.beside(abreast, way * knife.rate);
        rows[k] = height(head, &knife.placed(head, middle - way, before));
        rows[n - 1 - k] = height(head, &knife.placed(head, middle + way, behind));
    }
}

/// ±q + √(r² − p²): what the chord's end behind, and that ahead, asks of the edge.
#[inline(always)]
fn heights<R: Real>(knife: &Knife, head: &Head<R>, t: R) -> [R; 2] {
    height(head, &knife.place(head, t))
}

/// The same at a place of the edge.
#[inline(always)]
fn height<R: Real>(head: &Head<R>, place: &Place<R>) -> [R; 2] {
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
    let quotient = slope / bend;
    let height = b - slope * quotient * 0.125;
    let nothing = R::splat(f64::NEG_INFINITY);
    let at = at - pace * (quotient * 0.5);
    Top { height: is_top.select_lt(R::splat(0.0), nothing, height), at, reach: pace }
}

/// Newton on the slope of √(r² − p²) ± q from about its top.
#[inline(always)]
fn climbed<R: Real>(knife: &Knife, head: &Head<R>, top: Top<R>, sign: R) -> (R, R) {
    let (low, high) = (top.at - top.reach, top.at + top.reach);
    let mut t = top.at;
    let mut best = (R::splat(f64::NEG_INFINITY), t);
    for step in 0..=STEPS {
        let place = knife.place(head, t);
        let [p, dp, ddp] = place.p;
        let chord = half_chord(head.radius, p);
        best = better(best, (chord + place.q[0] * sign, t));
        if step < STEPS {
            let inverse = chord.recip();
            let lean = p * dp * inverse;
            let slope = place.q[1] * sign - lean;
            let bend = place.q[2] * sign - (dp * dp + p * ddp + lean * lean) * inverse;
            t = (t - slope / bend).max(low).min(high);
        }
    }
    best
}
