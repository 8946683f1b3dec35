//! What an edge of given length leaves of a head, if it never retreats: the parts of chords beyond its two ends, over
//! the way of the edge along its normal.
//!
//! The integrand has kinks where an end of the edge crosses the rim of the head. They are found first, those of many heads side
//! by side; between them it is smooth, and Gauss's rule takes it. A lane is a kink, or a place of the edge over one head.

use super::knife::{Head, Knife};
use super::needed::{Stations, half_chord};
use linkwright_kernel::gauss::{B, C};
use linkwright_kernel::real::Real;
use std::f64::consts::FRAC_PI_2;

/// Length of u, and of the law's phase, that a part of Gauss's rule takes at most: of order 8, it leaves 1e-12 of a head.
const PART: f64 = 0.25;

/// Distances in u of a rim from the end of a stretch between which parts are shorter. Nothing of the head is left to count
/// closer to it, and parts are short enough farther from it.
const NEAR_RIM: std::ops::Range<f64> = 1e-4..1.0;

/// Steps of the search for a kink: regula falsi (Illinois) gains a digit and a half each.
const SEARCH: usize = 60;

/// Length of a step to a kink after which it is known: the next would be a thousandth of it, and the integrand is zero at
/// its one side, so that an error counts squared.
const CLOSE: f64 = 1e-7;

/// An edge that is too short for some heads.
#[derive(Clone, Debug)]
pub struct ShortEdge<'a> {
    pub knife: &'a Knife,
    /// Half of its length.
    pub half: f64,
    /// Turns of the law that a corner may fall into while a head is passed.
    pub turns: std::ops::RangeInclusive<i32>,
    pub stations: &'a Stations,
}

/// Some heads of which something is left, and lists that are used again for the next ones.
#[derive(Clone, Debug, Default)]
pub struct Uncut {
    passes: Vec<Pass>,
    brackets: Brackets,
    /// Places u of the edge, their sines, and by how much the ends of the chord lie beyond those of the edge.
    places: [Vec<f64>; 6],
    kinks: Vec<f64>,
    /// Places u and weights of Gauss's rule.
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

/// A smooth stretch of the pass over one head.
#[derive(Clone, Copy, Debug)]
struct Pass {
    /// Whose it is.
    row: usize,
    swing: Swing<f64>,
    /// Its brackets are those before this place, from that of the pass before on.
    end: usize,
}

/// What an end of the edge lies beyond an end of the chord by: these times q and the half chord, less half of the edge. Behind
/// and ahead; and the same of the chord's other ends.
const ENDS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];

/// Brackets of kinks: both ends, the function there, what it is made of; and the pass.
#[derive(Clone, Debug, Default)]
struct Brackets {
    rows: [Vec<f64>; 6],
    pass: Vec<usize>,
}

/// A stretch of time, run through as t = m + w sin u.
#[derive(Clone, Copy, Debug)]
struct Swing<R> {
    head: Head<R>,
    middle: R,
    width: R,
}

impl Uncut {
    /// Forgets all heads.
    pub fn clear(&mut self) {
        self.passes.clear();
        self.brackets.pass.clear();
        self.brackets.rows.iter_mut().for_each(Vec::clear);
    }

    /// Adds a head that is passed between two times; `top` is when most is left of it.
    #[inline(always)]
    pub fn add<R: Real>(
        &mut self,
        edge: &ShortEdge<'_>,
        row: usize,
        head: &Head<f64>,
        window: [f64; 2],
        top: f64,
    ) {
        edge.knife.stretches(
            head,
            window,
            edge.turns.clone(),
            #[inline(always)]
            |[start, end]| {
                if end > start {
                    let (middle, width) = (0.5 * (start + end), 0.5 * (end - start));
                    let swing = Swing { head: *head, middle, width };
                    self.look::<R>(edge, &swing, (top - middle) / width);
                    self.bracket();
                    self.passes.push(Pass { row, swing, end: self.brackets.pass.len() });
                }
            },
        );
    }

    /// Areas of the heads left uncut beyond the rear and the front end, along e: those of each smooth stretch, with
    /// the head's row.
    #[inline(always)]
    pub fn areas<R: Real>(&mut self, edge: &ShortEdge<'_>, mut take: impl FnMut(usize, [f64; 2])) {
        self.cross::<R>(edge);
        let mut first = 0;
        for nth in 0..self.passes.len() {
            let Pass { row, swing, end } = self.passes[nth];
            let (u, kinks) = (&edge.stations.u, &mut self.kinks);
            kinks.clear();
            kinks.push(u[0]);
            kinks.extend_from_slice(&self.brackets.rows[1][first..end]);
            kinks.push(u[u.len() - 1]);
            if !edge.knife.corners.is_empty() {
                swing.grade(edge.knife, kinks);
            }
            kinks.sort_unstable_by(f64::total_cmp);
            first = end;
            let lanes = swing.splat::<R>();
            self.nodes(edge, &swing, &lanes);
            take(row, self.area(edge, &lanes));
        }
    }

    /// The edge at all stations and where most is left: between two stations nothing else might be.
    #[inline(always)]
    fn look<R: Real>(&mut self, edge: &ShortEdge<'_>, swing: &Swing<f64>, highest: f64) {
        let Stations { u, sines, .. } = edge.stations;
        let [places, sin, ends @ ..] = &mut self.places;
        places.clear();
        places.extend_from_slice(u);
        sin.clear();
        sin.extend_from_slice(sines);
        if highest.abs() < 1.0 {
            let next = sines.partition_point(|&sine| sine < highest);
            places.insert(next, highest.asin());
            sin.insert(next, highest);
        }
        let n = places.len();
        let whole = n.next_multiple_of(R::LANES);
        sin.resize(whole, 0.0);
        ends.iter_mut().for_each(|row| row.resize(whole, 0.0));
        let (swing, half) = (swing.splat::<R>(), R::splat(edge.half));
        let mut most = [R::splat(f64::NEG_INFINITY); 4];
        for first in (0..n).step_by(R::LANES) {
            let [chord, q, _] = swing.at_sine(edge.knife, R::load(&sin[first..]));
            for ((row, most), [along, across]) in ends.iter_mut().zip(&mut most).zip(ENDS) {
                let beyond = q * along + chord * across - half;
                *most = most.max(beyond);
                beyond.store(&mut row[first..]);
            }
        }
        // Where an end of the edge lies beyond that of the chord all the time there is nothing to look for.
        for (row, most) in ends.iter_mut().zip(most) {
            row.truncate(if most.max_lane() > 0.0 { n } else { 0 });
        }
    }

    /// Brackets of kinks between neighbouring places.
    #[inline(always)]
    fn bracket(&mut self) {
        let [u, _, ends @ ..] = &self.places;
        for (row, [along, across]) in ends.iter().zip(ENDS) {
            for (i, pair) in row.windows(2).enumerate() {
                if (pair[0] > 0.0) != (pair[1] > 0.0) {
                    let numbers = [u[i], u[i + 1], pair[0], pair[1], along, across];
                    self.brackets.rows.iter_mut().zip(numbers).for_each(|(row, x)| row.push(x));
                    self.brackets.pass.push(self.passes.len());
                }
            }
        }
    }

    /// Where an end of the edge crosses the rim, in place of the end of each bracket: regula falsi (Illinois), a bracket a lane.
    #[inline(always)]
    fn cross<R: Real>(&mut self, edge: &ShortEdge<'_>) {
        let (zero, tiny, half) = (R::splat(0.0), R::splat(f64::MIN_POSITIVE), R::splat(edge.half));
        let Brackets { rows, pass } = &mut self.brackets;
        let n = pass.len();
        let whole = n.next_multiple_of(R::LANES);
        if n > 0 {
            // Lanes without a bracket repeat the last.
            pass.resize(whole, pass[n - 1]);
            rows.iter_mut().for_each(|row| row.resize(whole, row[n - 1]));
        }
        for first in (0..n).step_by(R::LANES) {
            let swing = Swing::<R>::of(&self.passes, &pass[first..]);
            let mut a = R::load(&rows[0][first..]);
            let mut b = R::load(&rows[1][first..]);
            let mut fa = R::load(&rows[2][first..]);
            let mut fb = R::load(&rows[3][first..]);
            let (along, across) = (R::load(&rows[4][first..]), R::load(&rows[5][first..]));
            // A lane that is close keeps its place, so that it does not depend on the others.
            let (mut found, mut open) = (b, R::splat(1.0));
            for _ in 0..SEARCH {
                let x = fb.abs().select_lt(tiny, b, b - fb * (b - a) / (fb - fa));
                let (sin, _) = x.sin_cos();
                let [chord, q, _] = swing.at_sine(edge.knife, sin);
                let fx = q * along + chord * across - half;
                found = zero.select_lt(open, x, found);
                open = (x - b).abs().select_lt(R::splat(CLOSE), zero, open);
                // On the side of b the other end counts half; else b becomes the other end.
                let same = fx * fb;
                let (at, value) = (same.select_lt(zero, b, a), same.select_lt(zero, fb, fa * 0.5));
                (a, fa, b, fb) = (at, value, x, fx);
                if open.max_lane() <= 0.0 {
                    break;
                }
            }
            found.store(&mut rows[1][first..]);
        }
    }

    /// Gauss's nodes of all panels in which something is left, filled up to whole lanes with nodes of no weight.
    #[inline(always)]
    fn nodes<R: Real>(&mut self, edge: &ShortEdge<'_>, swing: &Swing<f64>, lanes: &Swing<R>) {
        let Uncut { kinks, nodes, weights, .. } = self;
        nodes.clear();
        weights.clear();
        for first in (0..kinks.len() - 1).step_by(R::LANES) {
            let pairs = kinks[first..].windows(2).take(R::LANES);
            let mut middles = [0.0; 16];
            for (middle, pair) in middles.iter_mut().zip(pairs.clone()) {
                *middle = 0.5 * (pair[0] + pair[1]);
            }
            let [chord, q, _] = lanes.at_sine(edge.knife, R::load(&middles).sin_cos().0);
            // Beyond either end, whichever.
            let mut beyond = [0.0; 16];
            (q.abs() + chord).store(&mut beyond);
            for (pair, beyond) in pairs.zip(beyond) {
                if beyond > edge.half {
                    let rate = edge.knife.rate * swing.width;
                    panel([pair[0], pair[1]], rate, nodes, weights);
                }
            }
        }
        let whole = nodes.len().next_multiple_of(R::LANES);
        nodes.resize(whole, 0.0);
        weights.resize(whole, 0.0);
    }

    /// Area left on both sides.
    #[inline(always)]
    fn area<R: Real>(&self, edge: &ShortEdge<'_>, swing: &Swing<R>) -> [f64; 2] {
        let (zero, half) = (R::splat(0.0), R::splat(edge.half));
        let (mut behind, mut ahead) = (zero, zero);
        for (u, weight) in self.nodes.chunks_exact(R::LANES).zip(self.weights.chunks_exact(R::LANES)) {
            let (sin, cos) = R::load(u).sin_cos();
            let [chord, q, speed] = swing.at_sine(edge.knife, sin);
            let share = speed * cos * swing.width * R::load(weight);
            behind = behind + left(q, chord, half) * share;
            ahead = ahead + left(-q, chord, half) * share;
        }
        [sum(behind), sum(ahead)]
    }
}

impl<R: Real> Swing<R> {
    /// Half of the chord, the place of the edge along it, and the speed of the edge along its normal, where u has a sine.
    #[inline(always)]
    fn at_sine(&self, knife: &Knife, sin: R) -> [R; 3] {
        let place = knife.place(&self.head, sin * self.width + self.middle);
        [half_chord(self.head.radius, place.p[0]), place.q[0], place.p[1]]
    }

    /// Those of some passes side by side.
    #[inline(always)]
    fn of(passes: &[Pass], chosen: &[usize]) -> Self {
        let mut lanes = [[0.0; 16]; 5];
        for (lane, &nth) in chosen[..R::LANES].iter().enumerate() {
            let Swing { head: Head { radius, offset, phase }, middle, width } = passes[nth].swing;
            for (row, x) in lanes.iter_mut().zip([radius, offset, phase, middle, width]) {
                row[lane] = x;
            }
        }
        let head = Head { radius: R::load(&lanes[0]), offset: R::load(&lanes[1]), phase: R::load(&lanes[2]) };
        Swing { head, middle: R::load(&lanes[3]), width: R::load(&lanes[4]) }
    }
}

impl Swing<f64> {
    /// Ends of parts beside an end of the stretch that lies close to the rim: there the chord is a root of t − t₀ of the edge's
    /// motion in this stretch, which without the corner would come to the rim at t₀, and parts must be short beside the
    /// distance √(2 |t₀ − t| / w) in u.
    fn grade(&self, knife: &Knife, kinks: &mut Vec<f64>) {
        for side in [-1.0, 1.0] {
            let [chord, _, speed] = self.at_sine(knife, side);
            let apart = chord / (self.head.radius * speed * self.width).sqrt();
            if !NEAR_RIM.contains(&apart) {
                continue;
            }
            let mut from_end = 0.0_f64;
            loop {
                from_end += PART * from_end.hypot(apart);
                if from_end >= NEAR_RIM.end {
                    break;
                }
                kinks.push(side * (FRAC_PI_2 - from_end));
            }
        }
    }

    /// The same in every lane.
    #[inline(always)]
    fn splat<R: Real>(&self) -> Swing<R> {
        let Head { radius, offset, phase } = self.head;
        let head = Head { radius: R::splat(radius), offset: R::splat(offset), phase: R::splat(phase) };
        Swing { head, middle: R::splat(self.middle), width: R::splat(self.width) }
    }
}

/// Length of a chord beyond an end of the edge.
#[inline(always)]
fn left<R: Real>(q: R, chord: R, half: R) -> R {
    (q + chord - half).max(R::splat(0.0)).min(chord + chord)
}

/// Gauss's nodes of a panel: parts that are short in u, and in the phase of the law, which changes at most by `rate` over u.
#[inline(always)]
fn panel([from, to]: [f64; 2], rate: f64, nodes: &mut Vec<f64>, weights: &mut Vec<f64>) {
    let turned = rate * (to.sin() - from.sin());
    let parts = ((to - from).max(turned) / PART).ceil().max(1.0);
    let step = (to - from) / parts;
    for part in 0..parts as usize {
        for (c, b) in C.iter().zip(B) {
            nodes.push(from + (part as f64 + c) * step);
            weights.push(b * step);
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
