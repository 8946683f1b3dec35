//! An edge that runs backwards at times crosses some chords more than once: chord by chord, what its places there leave.
//!
//! The way p(t) is cut where it turns back; on each branch a chord is crossed once. Between the chords at which branches end
//! their number does not change; with p as a pendulum's between two of them, p = m + w sin u, what is left is smooth over u,
//! also where the edge stands for a moment, but for kinks, at which Gauss's rule of short panels errs by little.

use super::knife::{Head, Knife};
use super::needed::Stations;
use super::uncut::crossing;
use linkwright_kernel::gauss::{B, C};
use std::f64::consts::{FRAC_PI_2, PI};

/// The uncut parts of a head, and the length it requires.
#[derive(Clone, Copy, Debug, Default)]
pub struct UncutParts {
    /// Half of the length that would leave nothing.
    pub half: f64,
    /// The point that is reached last, along n and e.
    pub p: f64,
    pub s: f64,
    /// Area behind all crossings of its chord, ahead of them, and between two of them.
    pub area: [f64; 3],
}

/// Panels of Gauss's rule over a head: with some kinks in them, they leave 1e-5 of it; and between two chords at least.
const PANELS: usize = 128;
const LEAST: usize = 16;

/// Share of the radius by which a chord between two stations may need more than they say.
const NEAR: f64 = 0.05;

/// Steps of the search for the chord that needs most: the golden section gains a digit in five.
const GOLDEN: usize = 40;

/// Times of crossings are known to this, in seconds: rounding.
const CLOSE: f64 = 1e-15;

/// A branch of the way: times and places p of its ends.
#[derive(Clone, Copy, Debug)]
struct Branch {
    t: [f64; 2],
    p: [f64; 2],
}

/// Head and edge: with no edge, what it needs alone.
pub fn cover(knife: &Knife, head: &Head<f64>, half: Option<f64>, stations: &Stations) -> UncutParts {
    let branches = branches(knife, head, stations);
    let r = head.radius;
    let mut levels: Vec<f64> =
        branches.iter().flat_map(|each| each.p).filter(|p| p.abs() < r).chain([-r, r]).collect();
    levels.sort_by(f64::total_cmp);
    let spans: Vec<[f64; 2]> = levels
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > 1e-14 * r)
        .map(|pair| [0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0])])
        .collect();
    let panels = (PANELS / spans.len().max(1)).max(LEAST);
    let chord =
        |[middle, width]: [f64; 2], u: f64| Chord::at(knife, head, &branches, middle + width * u.sin());
    let mut left = most(&spans, panels, r, &chord);
    if let Some(half) = half {
        for &span in &spans {
            let area = area(span[1], panels, |u| chord(span, u).left(half));
            for (sum, more) in left.area.iter_mut().zip(area) {
                *sum += more;
            }
        }
    }
    left
}

/// The way, cut where it turns back, from before the head to beyond it.
fn branches(knife: &Knife, head: &Head<f64>, stations: &Stations) -> Vec<Branch> {
    let ends = [-head.radius, head.radius].map(|level| knife.bracket(head, level));
    let (from, to) = (ends[0][0].min(ends[1][0]), ends[0][2].max(ends[1][2]));
    let speed = |t: f64| knife.place(head, t).p[1];
    let bend = |t: f64| knife.place(head, t).p[2];
    let mut cuts = vec![from];
    knife.stretches(head, [from, to], knife.turns(from.abs().max(to.abs())), |[start, end]| {
        if end > start {
            let (middle, width) = (0.5 * (start + end), 0.5 * (end - start));
            let at = |t: f64| (t, knife.place(head, t).p);
            let mut before = at(start + 1e-9 * width);
            // Beside a corner the speed is that of the stretch.
            let last = middle + width * (1.0 - 1e-9);
            for t in stations.turns.iter().map(|[sin, _]| middle + width * sin).chain([last]) {
                let here = at(t);
                let mut from = before;
                if (before.1[2] > 0.0) != (here.1[2] > 0.0) {
                    // The edge is slowest, or fastest, in between: there it may run backwards for a moment.
                    let t = crossing([before.0, here.0], [before.1[2], here.1[2]], CLOSE, bend);
                    cuts.extend(turn(from, at(t), speed));
                    from = at(t);
                }
                cuts.extend(turn(from, here, speed));
                before = here;
            }
            cuts.push(end);
        }
    });
    let place = |t: f64| knife.place(head, t).p[0];
    cuts.windows(2).map(|t| Branch { t: [t[0], t[1]], p: [place(t[0]), place(t[1])] }).collect()
}

/// When the edge turns back between two times, if it does.
fn turn(from: (f64, [f64; 3]), to: (f64, [f64; 3]), speed: impl Fn(f64) -> f64) -> Option<f64> {
    let turns = (from.1[1] > 0.0) != (to.1[1] > 0.0);
    turns.then(|| crossing([from.0, to.0], [from.1[1], to.1[1]], CLOSE, speed))
}

/// A chord of the head, and the middles of the edge along it when it crosses, increasing.
struct Chord {
    p: f64,
    c: f64,
    crossings: Vec<f64>,
}

impl Chord {
    fn at(knife: &Knife, head: &Head<f64>, branches: &[Branch], p: f64) -> Self {
        let inside = |each: &&Branch| (each.p[0] < p) != (each.p[1] < p);
        let mut crossings: Vec<f64> = branches
            .iter()
            .filter(inside)
            .map(|each| {
                let miss = |t: f64| knife.place(head, t).p[0] - p;
                let t = crossing(each.t, [each.p[0] - p, each.p[1] - p], CLOSE, miss);
                knife.place(head, t).q[0]
            })
            .collect();
        crossings.sort_by(f64::total_cmp);
        let c = (head.radius * head.radius - p * p).max(0.0).sqrt();
        Chord { p, c, crossings }
    }

    /// Half of the length that it needs, and the point that is reached last.
    fn needs(&self) -> (f64, f64) {
        let gaps = self.crossings.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let points = gaps.filter(|s| s.abs() < self.c).chain([-self.c, self.c]);
        let distance = |s: f64| self.crossings.iter().map(|q| (s - q).abs()).fold(f64::INFINITY, f64::min);
        points.map(|s| (distance(s), s)).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0.0))
    }

    /// What an edge leaves behind, ahead, and between.
    fn left(&self, half: f64) -> [f64; 3] {
        let (Some(first), Some(last)) = (self.crossings.first(), self.crossings.last()) else {
            return [0.0, 0.0, 2.0 * self.c];
        };
        let clip = |s: f64| s.clamp(-self.c, self.c);
        let between = |pair: &[f64]| (clip(pair[1] - half) - clip(pair[0] + half)).max(0.0);
        [
            clip(first - half) + self.c,
            self.c - clip(last + half),
            self.crossings.windows(2).map(between).sum(),
        ]
    }
}

/// The chord that needs most: the highest of all panels, and of those that come near it, is climbed.
fn most(spans: &[[f64; 2]], panels: usize, r: f64, chord: &impl Fn([f64; 2], f64) -> Chord) -> UncutParts {
    let step = PI / panels as f64;
    let mut looked = Vec::with_capacity(spans.len());
    for &span in spans {
        let needs = |u: f64| chord(span, u).needs().0;
        let found = (0..panels).map(|k| (k as f64 + 0.5) * step - FRAC_PI_2).map(|u| (needs(u), u));
        looked.extend(found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(need, u)| (need, u, span)));
    }
    let highest = looked.iter().map(|each| each.0).fold(f64::NEG_INFINITY, f64::max);
    let mut left = UncutParts { half: f64::NEG_INFINITY, ..UncutParts::default() };
    for (_, start, span) in looked.into_iter().filter(|each| each.0 > highest - NEAR * r) {
        let ends = [(start - step).max(-FRAC_PI_2), (start + step).min(FRAC_PI_2)];
        let found = chord(span, golden(ends, |u| chord(span, u).needs().0));
        let (half, s) = found.needs();
        if half > left.half {
            (left.half, left.p, left.s) = (half, found.p, s);
        }
    }
    left
}

/// Where a function with one top between two places has it.
fn golden([mut a, mut b]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut x, mut y) = (b - share * (b - a), a + share * (b - a));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..GOLDEN {
        if fx > fy {
            (b, y, fy) = (y, x, fx);
            x = b - share * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + share * (b - a);
            fy = f(y);
        }
    }
    if fx > fy { x } else { y }
}

/// ∫ left dp with p = m + w sin u.
fn area(width: f64, panels: usize, left: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let step = PI / panels as f64;
    let mut sum = [0.0; 3];
    for panel in 0..panels {
        for (c, b) in C.into_iter().zip(B) {
            let u = (panel as f64 + c) * step - FRAC_PI_2;
            for (sum, left) in sum.iter_mut().zip(left(u)) {
                *sum += b * step * left * width * u.cos();
            }
        }
    }
    sum
}
