//! Where over the revolution a formula is steep: a pulse may rise and fall back between two stages of a step, and nothing would
//! be seen of it.
//!
//! Values at some angles cannot tell; bounds can. The formula is worked through with all that its variables are over a piece of
//! the revolution ([`crate::kernel::bounds`]), which bounds its values and slopes there. Of a piece that may hide more than a
//! small share of the largest value seen so far, both halves are looked at, the one that may hide most first, until none is
//! left (branch and bound; Moore, *Interval Analysis*, 1966). What had to be cut into small pieces is steep, and gets ends of
//! steps in it and beside it; the error of steps that see something of it is then measured like any other.
//!
//! Each instruction of the formula that may be steep is looked at by itself, so that a large smooth force beside a small pulse
//! does not cover it.

use crate::drive::loads::{FormulaLoad, Law};
use crate::drive::structure::Plan;
use crate::kernel::bounds::Bounds;
use crate::kernel::dual::Dual;
use crate::kernel::formula::{Formula, Inputs, Variable};
use crate::kernel::interval::Interval;
use crate::kernel::plane::Angle;
use crate::linkage::motion::Motion;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

/// Pieces of a revolution of the fastest link that are looked at first: over them the mechanism moves smoothly.
const FIRST: f64 = 48.0;

/// A piece may hide this share of the largest value. What is less beside a pulse, its foot, is smooth beside the ends of steps
/// there, and seen.
const SHARE: f64 = 1e-3;

/// What is wider \[rad\] lies between no two stages: those of the two halves of a step of a 24th of a revolution are no farther
/// apart than 0.04 rad.
const WIDE: f64 = 0.04;

/// Pieces shorter than this \[rad\] are steep. A pulse exp(−(x/w)²) is bent by 2/w² at most, so that it is cut to pieces of
/// about √(2 · SHARE) w: those of one that is less than 0.1 rad wide on each side.
const SHORT: f64 = 0.004;

/// The shortest piece \[rad\]: a pulse within it does no work. Ends of smooth pieces are as exact.
const SHORTEST: f64 = 1e-9;

/// A link turns no faster than this: beside a change point it may be faster for a moment, in which a pulse does no work.
const FASTEST: f64 = 1000.0;

/// Most cuts.
const CUTS_MAX: usize = 4096;

/// Short pieces to a step: some 120 make up a pulse, so that steps are about half as long as its width on each side.
const PER_STEP: usize = 16;

/// Ends lie at the edges of what is steep and so many of its widths beside it, as far as the next \[rad\]; not where an end is
/// already, to the last shares of that distance or of the width.
const BESIDE: [f64; 3] = [1.0, 5.0, 25.0];
const FARTHEST: f64 = 0.1;
const ROOM: f64 = 0.6;
const EDGE: f64 = 0.1;

/// A solution sees what is steep where its steps are no longer than so many times what they have of it: of their ten nodes, two
/// times five, some lie in it, and the rest is measured. Less of it than the second share is its foot.
const SEEN: f64 = 4.0;
const FOOT: f64 = 0.15;

/// A force that changes by no more than this times the difference of its ends does not come back.
const FLANK: f64 = 1.1;

/// A formula along the revolution at given speeds of the crank.
pub(super) struct Steepness<'a> {
    pub plan: &'a Plan,
    pub q: &'a [f64],
    pub load: FormulaLoad,
    /// Speed of the crank over φ with its derivative.
    pub omega: &'a dyn Fn(f64) -> Dual<f64>,
    /// Whether what is steep at angles that depend on the speed is looked for, or what is whatever the speed.
    pub moves: bool,
    /// Ends of the smooth pieces of the cycle.
    pub breaks: &'a [f64],
}

/// What the formula needs, and what the instruction gives, at an angle.
#[derive(Clone, Copy)]
struct Sample {
    phi: f64,
    inputs: Inputs<Dual<f64>>,
    value: f64,
}

/// A piece of the revolution: its start, middle and end.
struct Piece {
    samples: [Sample; 3],
    /// How far the instruction may depart from what the samples say.
    hides: f64,
    /// Whether it is a part of another.
    is_cut: bool,
}

/// Where the formula is steep.
struct Place {
    low: f64,
    high: f64,
    /// Whether the force rises or falls over it, and does not come back.
    is_flank: bool,
}

/// A piece that is to be looked at.
#[derive(PartialEq)]
struct Waiting {
    hides: f64,
    width: f64,
    nth: usize,
}

/// The look at one instruction.
struct Search<'a, 'b> {
    of: &'a Steepness<'a>,
    formula: &'a Formula,
    at: usize,
    m: &'b mut Motion<f64>,
    pieces: Vec<Piece>,
    queue: BinaryHeap<Waiting>,
    /// The largest value seen.
    largest: f64,
}

impl Plan {
    /// Whether some formula may be steep.
    pub(super) fn may_be_steep(&self) -> bool {
        self.formulas.iter().any(|formula| !formula.steep.is_empty())
    }

    /// Formulas that may be steep at angles that depend on the speed.
    pub(super) fn laws_with_pulses(&self) -> Vec<FormulaLoad> {
        let formulas = self.laws.iter().filter_map(|law| match law {
            Law::Formula(load) => Some(*load),
            Law::Damper { .. } => None,
        });
        formulas.filter(|load| self.formulas[load.formula].steep.iter().any(|steep| steep.moves)).collect()
    }
}

impl Steepness<'_> {
    /// Adds ends where the formula is steep to those of the steps of a cycle.
    pub(super) fn add_ends(&self, ends: &mut Vec<f64>, m: &mut Motion<f64>) {
        self.for_each_place(m, |place, least| {
            add_ends_in(place, least, ends);
            add_ends_beside(place, ends);
        });
    }

    /// Whether steps with given ends see all that is steep: what they have some stages in, and the flank of a force that is another
    /// one behind a place than before it, with no other place in the same step.
    pub(super) fn is_seen(&self, ends: &[f64], m: &mut Motion<f64>) -> bool {
        let (formula, mut places) = (&self.plan.formulas[self.load.formula], Vec::new());
        self.for_each_place(m, |place, _| {
            let force = |sample: &Sample| formula.value::<f64, Dual<f64>>(self.q, &sample.inputs).value;
            let forces: Vec<f64> = place.iter().flat_map(|piece| &piece.samples).map(force).collect();
            let (width, rise) =
                (Interval::around(forces.iter().copied()).width(), forces[0] - forces[forces.len() - 1]);
            // Some function may be steep where nothing of it is left in the force.
            if width > 0.0 {
                let [low, high] = [place[0].samples[0].phi, place[place.len() - 1].samples[2].phi];
                places.push(Place { low, high, is_flank: width <= FLANK * rise.abs() });
            }
        });
        let is_alone = |place: &Place, low: f64, high: f64| {
            let is_other = |other: &Place| other.low > place.high || other.high < place.low;
            !places.iter().any(|other| is_other(other) && other.high > low && other.low < high)
        };
        places
            .iter()
            .all(|place| place.unseen(ends).all(|step| place.is_flank && is_alone(place, step[0], step[1])))
    }

    /// Goes through all places where the formula is steep, with what may hide there.
    fn for_each_place(&self, m: &mut Motion<f64>, mut act: impl FnMut(&[Piece], f64)) {
        let formula = &self.plan.formulas[self.load.formula];
        for at in formula.steep.iter().filter(|steep| steep.moves == self.moves).map(|steep| steep.at) {
            let (pieces, queue) = (Vec::new(), BinaryHeap::new());
            let mut search = Search { of: self, formula, at, m, pieces, queue, largest: 0.0 };
            search.run();
            search.for_each_place(&mut act);
        }
    }
}

impl Search<'_, '_> {
    /// Cuts the cycle into pieces that hide nothing.
    fn run(&mut self) {
        self.start();
        let first = self.pieces.len();
        while let Some(Waiting { hides, nth, .. }) = self.queue.pop() {
            if hides <= SHARE * self.largest {
                return;
            }
            if self.pieces.len() - first >= CUTS_MAX {
                return;
            }
            self.cut(nth);
        }
    }

    /// Pieces from end to end of the smooth ones. These end a little beside the ends: on them rounding decides between the
    /// sides of a jump.
    fn start(&mut self) {
        let (cycle, per_turn) = (self.of.plan.cycle(), FIRST * self.fastest());
        let mut ends = self.of.breaks.to_vec();
        ends.extend((1..self.of.plan.turns).map(|turn| TAU * f64::from(turn)));
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|next, last| *next - *last < 4.0 * SHORTEST);
        for ends in ends.windows(2) {
            let (low, high) = (ends[0] + SHORTEST, ends[1].min(cycle) - SHORTEST);
            let n = ((high - low) * per_turn / TAU).ceil();
            let mut last = self.sample(low);
            for i in 1..=n as usize {
                let next = self.sample(low + (high - low) * i as f64 / n);
                self.add(last, next, false);
                last = next;
            }
        }
    }

    /// Turns of the fastest link to one of the crank, of the crank itself if that is faster, or if the formula knows it alone.
    fn fastest(&mut self) -> f64 {
        let Steepness { plan, q, .. } = self.of;
        let known =
            [Variable::X, Variable::Y, Variable::Vx, Variable::Vy, Variable::V, Variable::S, Variable::Psi];
        let mut fastest = 1.0_f64;
        if known.into_iter().chain([Variable::PsiDot]).any(|variable| self.formula.reads(variable)) {
            for i in 0..FIRST as usize * plan.turns as usize {
                plan.mechanism.place::<f64, 2>(q, Angle::new(i as f64 * TAU / FIRST), self.m);
                fastest = self.m.links.iter().fold(fastest, |most, link| most.max(link.d1.abs()));
            }
        }
        fastest.min(FASTEST)
    }

    /// The formula at an angle.
    fn sample(&mut self, phi: f64) -> Sample {
        let Steepness { plan, q, load, omega, .. } = self.of;
        plan.mechanism.place::<f64, 2>(q, Angle::new(phi), self.m);
        let inputs = load.along(self.formula, phi, omega(phi), self.m);
        let value = self.formula.result::<f64, Dual<f64>>(self.at, q, &inputs).value;
        if value.is_finite() {
            self.largest = self.largest.max(value.abs());
        }
        Sample { phi, inputs, value }
    }

    fn piece(&mut self, from: Sample, to: Sample, is_cut: bool) -> Piece {
        let middle = self.sample(0.5 * (from.phi + to.phi));
        let mut piece = Piece { samples: [from, middle, to], hides: 0.0, is_cut };
        if piece.width() > SHORTEST {
            let inputs = piece.bounds();
            piece.hides = piece.hidden(self.formula.result::<f64, Bounds>(self.at, self.of.q, &inputs));
        }
        piece
    }

    fn add(&mut self, from: Sample, to: Sample, is_cut: bool) {
        let piece = self.piece(from, to, is_cut);
        self.wait(&piece, self.pieces.len());
        self.pieces.push(piece);
    }

    fn wait(&mut self, piece: &Piece, nth: usize) {
        if piece.hides > 0.0 {
            self.queue.push(Waiting { hides: piece.hides, width: piece.width(), nth });
        }
    }

    /// Puts both halves in the place of a piece.
    fn cut(&mut self, nth: usize) {
        let [from, middle, to] = self.pieces[nth].samples;
        let first = self.piece(from, middle, true);
        self.wait(&first, nth);
        self.pieces[nth] = first;
        self.add(middle, to, true);
    }

    /// Goes through the places where short pieces follow one another and the formula changes.
    fn for_each_place(&mut self, act: &mut impl FnMut(&[Piece], f64)) {
        let least = SHARE * self.largest;
        self.pieces.sort_by(|a, b| a.samples[0].phi.total_cmp(&b.samples[0].phi));
        for place in self.pieces.chunk_by(|a, b| a.is_steep(least) && b.is_steep(least)) {
            let values = place.iter().flat_map(|piece| piece.samples.map(|sample| sample.value));
            let changes = Interval::around(values).width() > least || place.iter().any(|p| p.hides > least);
            if place[0].is_steep(least) && changes {
                act(place, least);
            }
        }
    }
}

impl Piece {
    fn width(&self) -> f64 {
        self.samples[2].phi - self.samples[0].phi
    }

    /// Whether it had to be cut short, or may still hide something since there were too many pieces.
    fn is_steep(&self, least: f64) -> bool {
        self.is_cut && self.width() < SHORT || self.hides > least
    }

    /// Bounds of what the formula needs. The motion of the mechanism is smooth over a piece; only the formula is steep. A
    /// parabola through the samples leaves their hull by a quarter of what the middle is off the chord at most; that much four
    /// times leaves room for what is no parabola.
    fn bounds(&self) -> Inputs<Bounds> {
        let [from, middle, to] = &self.samples;
        let [low, high] = [from.phi, to.phi];
        let bounds = Inputs::of_three([&from.inputs, &middle.inputs, &to.inputs], |three: [Dual<f64>; 3]| {
            let (values, slopes) = (three.map(|x| x.value), three.map(|x| x.d));
            Bounds { value: smooth(values), slope: smooth(slopes) }
        });
        let phi = Interval { low: from.inputs.phi.value, high: from.inputs.phi.value + (high - low) };
        let phi = Bounds { value: phi, slope: Interval::at(1.0) };
        // The angle of a link that goes round jumps from π to −π.
        let wraps = bounds.psi.value.width() > PI;
        let anything = Bounds { value: Interval { low: -PI, high: PI }, slope: Interval::EVERYTHING };
        Inputs { phi, psi: if wraps { anything } else { bounds.psi }, ..bounds }
    }

    /// By how much a value may depart from the straight lines through the samples: a quarter of the width times the range of
    /// slopes, where a change that is wider than what lies between two stages is none that hides.
    fn hidden(&self, of: Bounds) -> f64 {
        let by_slope = 0.25 * of.slope.width() * self.width().min(WIDE);
        let by_value = of.value.high - of.value.low;
        // An infinite value less an infinite one may be anything.
        if by_value.is_nan() { by_slope } else { by_value.max(0.0).min(by_slope) }
    }
}

/// Bounds of what changes smoothly with given values at start, middle and end of a piece.
fn smooth([from, middle, to]: [f64; 3]) -> Interval {
    let sag = (middle - 0.5 * (from + to)).abs();
    Interval::around([from, middle, to]).widened(sag)
}

/// Adds ends so that no step has too many of the pieces of a place, or one that may still hide something beside another.
fn add_ends_in(place: &[Piece], least: f64, ends: &mut Vec<f64>) {
    let (mut count, mut found) = (0, Vec::new());
    for piece in place {
        let [from, _, to] = piece.samples.map(|sample| sample.phi);
        count = if has_end(ends, from, to) { 0 } else { count + 1 };
        if count == PER_STEP || piece.hides > least && count > 0 {
            found.push(to);
            count = 0;
        }
    }
    ends.extend(found);
    ends.sort_by(f64::total_cmp);
}

/// Adds ends on both sides of a place, the farther apart the farther away: outside there may be the foot of a pulse.
fn add_ends_beside(place: &[Piece], ends: &mut Vec<f64>) {
    let (low, high) = (place[0].samples[0].phi, place[place.len() - 1].samples[2].phi);
    let (width, cycle) = (high - low, ends[ends.len() - 1]);
    for (edge, side) in [(low, -1.0), (high, 1.0)] {
        for times in [0.0].into_iter().chain(BESIDE) {
            let off = times * width;
            let (at, room) = ((edge + side * off).rem_euclid(cycle), (ROOM * off).max(EDGE * width));
            if off < FARTHEST && !has_end(ends, at - room, at + room) {
                ends.push(at);
                ends.sort_by(f64::total_cmp);
            }
        }
    }
}

impl Place {
    /// Steps with given ends, in order, that may have no stage in the part that they have of the place.
    fn unseen<'a>(&'a self, ends: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        let &Place { low, high, .. } = self;
        let first = ends.partition_point(|&end| end <= low).max(1) - 1;
        ends[first..].windows(2).take_while(move |step| step[0] < high).filter(move |step| {
            let of_it = step[1].min(high) - step[0].max(low);
            of_it > FOOT * (high - low) && step[1] - step[0] > SEEN * of_it
        })
    }
}

/// Whether some end of a step lies within two angles; ends are in order.
fn has_end(ends: &[f64], low: f64, high: f64) -> bool {
    let at = ends.partition_point(|&end| end < low);
    ends.get(at).is_some_and(|&end| end <= high)
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.hides.total_cmp(&other.hides).then(self.width.total_cmp(&other.width))
    }
}
