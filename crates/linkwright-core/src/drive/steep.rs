//! Where along a motion a formula is steep: a pulse may rise and fall back between two stages of a step, and nothing would
//! be seen of it.
//!
//! Values at some places cannot tell; bounds can. The formula is worked through with all that its variables are over a piece of
//! the motion ([`crate::kernel::bounds`]), which bounds its values and slopes there. Of a piece that may hide more than a
//! small share of the largest value seen so far, both halves are looked at, the one that may hide most first, until none is
//! left (branch and bound; Moore, *Interval Analysis*, 1966). What had to be cut into small pieces is steep.
//!
//! Each instruction of the formula that may be steep is looked at by itself, so that a large smooth force beside a small pulse
//! does not cover it.

use crate::drive::law::Moment;
use crate::drive::loads::FormulaLoad;
use crate::drive::structure::Plan;
use crate::kernel::bounds::Bounds;
use crate::kernel::dual::Dual;
use crate::kernel::formula::{Formula, Inputs, Steep, Variable};
use crate::kernel::interval::Interval;
use crate::kernel::plane::Angle;
use crate::linkage::motion::Motion;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, VecDeque};
use std::f64::consts::{PI, TAU};

/// Pieces of a revolution of the fastest link that are looked at first: over them the mechanism moves smoothly.
const FIRST: f64 = 48.0;

/// A piece may hide this share of the largest value. What is less beside a pulse, its foot, is smooth beside the ends of steps
/// there, and seen; a step in time, which ends before a pulse, measures more of it.
const SHARE: f64 = 1e-3;
const SHARE_IN_TIME: f64 = 1e-2;

/// Values below this share of the largest that there may be anywhere do not count: far beside a pulse its foot is as steep as
/// it is small.
const FAINT: f64 = 1e-6;

/// What is wider \[rad\] lies between no two stages: those of the two halves of a step of a 24th of a revolution are no farther
/// apart than 0.04 rad.
pub(super) const WIDE: f64 = 0.04;

/// Pieces shorter than this \[rad\] are steep. A pulse exp(−(x/w)²) is bent by 2/w² at most, so that it is cut to pieces of
/// about √(2 · SHARE) w: those of one that is less than 0.1 rad wide on each side.
const SHORT: f64 = 0.004;

/// The shortest piece \[rad\]: a pulse within it does no work. Ends of smooth pieces are as exact.
const SHORTEST: f64 = 1e-9;

/// A link turns no faster than this: beside a change point it may be faster for a moment, in which a pulse does no work.
const FASTEST: f64 = 1000.0;

/// Most cuts of a search for what is steep. A pulse takes two for each halving of the width down to its own: what is left
/// beyond these are so many pulses that the ends beside each are more than a revolution may have.
const CUTS_MAX: usize = 1 << 16;

/// Most cuts of a search for the zeros of a switch.
const ZERO_CUTS_MAX: usize = 4096;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SteepKind {
    /// What is steep at angles that no speed moves. Switches are ends of smooth pieces.
    Still,
    /// What is steep at angles that depend on the speed. Switches there are sought out by the solution.
    Moving,
    /// The same, and switches.
    MovingOrJumping,
}

/// A formula of a machine, of which it is asked where it is steep.
pub(super) struct Steepness<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    load: FormulaLoad,
    kind: SteepKind,
    /// Instructions that may be steep, and below what size their results do not count.
    instructions: Vec<(usize, f64)>,
    /// Revolutions of the fastest link that the formula knows to one of the crank.
    fastest: f64,
}

/// A motion over the crank angle, or over what grows with it in a similar measure \[rad\].
pub(super) struct Along<'a> {
    pub moment: &'a dyn Fn(f64) -> Moment,
    /// Ends of its smooth pieces.
    pub breaks: Vec<f64>,
}

/// What the formula needs, and what the instruction gives, at a place of the motion.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub at: f64,
    phi: Dual<f64>,
    pub inputs: Inputs<Dual<f64>>,
    pub value: f64,
}

/// A piece of the motion: its start, middle and end.
pub(super) struct Piece {
    pub samples: [Sample; 3],
    /// How far the instruction may depart from what the samples say.
    pub hides: f64,
    /// Whether it is a part of another.
    is_cut: bool,
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
    along: &'a Along<'a>,
    formula: &'a Formula,
    at: usize,
    m: &'b mut Motion<f64>,
    pieces: Vec<Piece>,
    queue: BinaryHeap<Waiting>,
    /// The largest value seen.
    largest: f64,
}

impl Plan {
    /// Whether some formula may be steep besides its switches.
    pub(super) fn may_be_steep(&self) -> bool {
        self.formulas.iter().any(|formula| formula.steep.iter().any(|steep| !steep.jumps))
    }

    /// Loads that are laws with a formula in which something of this kind may be steep.
    pub(super) fn steep_laws(&self, kind: SteepKind) -> Vec<FormulaLoad> {
        self.formula_laws().filter(|load| self.is_steep(load, kind)).collect()
    }

    /// Whether something of this kind may be steep in the formula of a load.
    pub(super) fn is_steep(&self, load: &FormulaLoad, kind: SteepKind) -> bool {
        self.formulas[load.formula].steep.iter().any(|steep| kind.is(steep))
    }
}

impl SteepKind {
    fn is(self, steep: &Steep) -> bool {
        match self {
            SteepKind::Still => !steep.moves && !steep.jumps,
            SteepKind::Moving => steep.moves && !steep.jumps,
            SteepKind::MovingOrJumping => steep.moves,
        }
    }

    /// Share of the largest value that a piece may hide.
    fn share(self) -> f64 {
        if self == SteepKind::MovingOrJumping { SHARE_IN_TIME } else { SHARE }
    }
}

impl<'a> Along<'a> {
    /// A cycle with the ends of its smooth pieces, over the crank angle. A formula that repeats after a revolution may jump
    /// after each.
    pub(super) fn cycle(plan: &Plan, moment: &'a dyn Fn(f64) -> Moment, breaks: &[f64]) -> Self {
        let mut breaks = breaks.to_vec();
        breaks.extend((1..plan.turns).map(|turn| TAU * f64::from(turn)));
        breaks.sort_by(f64::total_cmp);
        Along { moment, breaks }
    }
}

impl<'a> Steepness<'a> {
    pub(super) fn new(
        plan: &'a Plan,
        q: &'a [f64],
        load: FormulaLoad,
        kind: SteepKind,
        m: &mut Motion<f64>,
    ) -> Self {
        let formula = &plan.formulas[load.formula];
        let anything = Bounds { value: Interval::EVERYTHING, slope: Interval::EVERYTHING };
        let faint = |steep: &Steep| {
            let all = formula.result::<f64, Bounds>(steep.at, q, &Inputs::all(anything)).value.abs().high;
            (steep.at, if all.is_finite() { FAINT * all } else { 0.0 })
        };
        let instructions = formula.steep.iter().filter(|steep| kind.is(steep)).map(faint).collect();
        Steepness { plan, q, load, kind, instructions, fastest: fastest(plan, q, formula, m) }
    }

    /// Goes through all places where the formula is steep, with what may hide there.
    pub(super) fn for_each_place(
        &self,
        along: &Along<'_>,
        m: &mut Motion<f64>,
        mut act: impl FnMut(&[Piece], f64),
    ) {
        let formula = &self.plan.formulas[self.load.formula];
        for &(at, largest) in &self.instructions {
            let (pieces, queue) = (Vec::new(), BinaryHeap::new());
            let mut search = Search { of: self, along, formula, at, m, pieces, queue, largest };
            search.run();
            search.for_each_place(&mut act);
        }
    }

    /// Ends of the first pieces, from end to end of each smooth one. These end a little beside the ends: on them rounding decides
    /// between the sides of a jump.
    fn first_ends(&self, along: &Along<'_>) -> Vec<Vec<f64>> {
        let mut ends = along.breaks.clone();
        ends.dedup_by(|next, last| *next - *last < 4.0 * SHORTEST);
        let mut all = Vec::new();
        for ends in ends.windows(2) {
            let (low, high) = (ends[0] + SHORTEST, ends[1] - SHORTEST);
            let [from, to] = [low, high].map(|end| (along.moment)(end).phi.value);
            let turned = (to - from).abs().max(high - low);
            let n = (turned * FIRST * self.fastest / TAU).ceil();
            all.push((0..=n as usize).map(|i| low + (high - low) * i as f64 / n).collect());
        }
        all
    }

    /// What the formula needs at a place.
    fn sample(&self, along: &Along<'_>, at: f64, m: &mut Motion<f64>) -> Sample {
        let moment = (along.moment)(at);
        self.plan.mechanism.place::<f64, 2>(self.q, Angle::new(moment.phi.value), m);
        let inputs = self.load.along(&self.plan.formulas[self.load.formula], &moment, m);
        Sample { at, phi: moment.phi, inputs, value: f64::NAN }
    }

    /// Brackets of all zeros of the argument of a switch: pieces over which it may be zero are halved until it rises or falls
    /// over each, or no more than rounding is left.
    pub(super) fn zeros(&self, along: &Along<'_>, switch: usize, m: &mut Motion<f64>) -> Vec<[f64; 2]> {
        let formula = &self.plan.formulas[self.load.formula];
        let mut sample = |at: f64| {
            let sample = self.sample(along, at, m);
            let value = formula.switch::<f64, Dual<f64>>(switch, self.q, &sample.inputs).value;
            Sample { value, ..sample }
        };
        let (mut pieces, mut zeros, mut cuts) = (VecDeque::new(), Vec::new(), 0);
        for ends in self.first_ends(along) {
            let samples: Vec<Sample> = ends.into_iter().map(&mut sample).collect();
            pieces.extend(samples.windows(2).map(|piece| [piece[0], piece[1]]));
        }
        while let Some([from, to]) = pieces.pop_front() {
            let middle = sample(0.5 * (from.at + to.at));
            let inputs = self.bounds(&[from, middle, to]);
            let Bounds { value, slope } = formula.switch::<f64, Bounds>(switch, self.q, &inputs);
            if value.is_empty() || value.low > 0.0 || value.high < 0.0 {
                continue;
            }
            let has_one = slope.low > 0.0 || slope.high < 0.0;
            if has_one || to.at - from.at < SHORTEST || cuts >= ZERO_CUTS_MAX {
                if (from.value < 0.0) != (to.value < 0.0) {
                    zeros.push([from.at, to.at]);
                }
                continue;
            }
            cuts += 1;
            pieces.extend([[from, middle], [middle, to]]);
        }
        zeros.sort_by(|a, b| a[0].total_cmp(&b[0]));
        zeros
    }

    /// Bounds of what the formula needs, which knows the crank angle within a cycle. The motion of the mechanism is smooth over
    /// a piece; only the formula is steep. A parabola through the samples leaves their hull by a quarter of what the middle is
    /// off the chord at most; that much four times leaves room for what is no parabola.
    fn bounds(&self, [from, middle, to]: &[Sample; 3]) -> Inputs<Bounds> {
        let of = |three: [Dual<f64>; 3]| Bounds {
            value: smooth(three.map(|x| x.value)),
            slope: smooth(three.map(|x| x.d)),
        };
        let bounds = Inputs::of_three([&from.inputs, &middle.inputs, &to.inputs], of);
        let anything = |value| Bounds { value, slope: Interval::EVERYTHING };
        let turned = |sample: &Sample| Dual { value: sample.phi.value - from.phi.value, ..sample.phi };
        let phi = of([from, middle, to].map(turned)) + from.inputs.phi.value;
        // The angle within a cycle starts anew after it, that of a link that goes round jumps from π to −π.
        let restarts = (phi.value.width() - bounds.phi.value.width()).abs() > 1.0;
        let wraps = bounds.psi.value.width() > PI;
        let cycle = TAU * f64::from(self.load.turns);
        Inputs {
            phi: if restarts { anything(Interval { low: 0.0, high: cycle }) } else { phi },
            psi: if wraps { anything(Interval { low: -PI, high: PI }) } else { bounds.psi },
            ..bounds
        }
    }

    /// The force at a place.
    pub(super) fn force(&self, at: &Sample) -> f64 {
        self.plan.formulas[self.load.formula].value::<f64, Dual<f64>>(self.q, &at.inputs).value
    }
}

impl Search<'_, '_> {
    /// Cuts the motion into pieces that hide nothing.
    fn run(&mut self) {
        self.start();
        let first = self.pieces.len();
        while let Some(Waiting { hides, nth, .. }) = self.queue.pop() {
            if hides <= self.of.kind.share() * self.largest {
                return;
            }
            if self.pieces.len() - first >= CUTS_MAX {
                return;
            }
            self.cut(nth);
        }
    }

    fn start(&mut self) {
        for ends in self.of.first_ends(self.along) {
            let mut from = self.sample(ends[0]);
            for &end in &ends[1..] {
                let to = self.sample(end);
                self.add(from, to, false);
                from = to;
            }
        }
    }

    /// The formula at a place.
    fn sample(&mut self, at: f64) -> Sample {
        let mut sample = self.of.sample(self.along, at, self.m);
        sample.value = self.formula.result::<f64, Dual<f64>>(self.at, self.of.q, &sample.inputs).value;
        if sample.value.is_finite() {
            self.largest = self.largest.max(sample.value.abs());
        }
        sample
    }

    fn piece(&mut self, from: Sample, to: Sample, is_cut: bool) -> Piece {
        let samples = [from, self.sample(0.5 * (from.at + to.at)), to];
        let mut piece = Piece { samples, hides: 0.0, is_cut };
        if piece.width() > SHORTEST {
            let inputs = self.of.bounds(&samples);
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
        let least = self.of.kind.share() * self.largest;
        self.pieces.sort_by(|a, b| a.samples[0].at.total_cmp(&b.samples[0].at));
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
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.samples[0].at, self.samples[2].at]
    }

    fn width(&self) -> f64 {
        let [low, high] = self.ends();
        high - low
    }

    /// Whether it had to be cut short, or may still hide something since there were too many pieces.
    fn is_steep(&self, least: f64) -> bool {
        self.is_cut && self.width() < SHORT || self.hides > least
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

/// Turns of the fastest link to one of the crank, of the crank itself if that is faster, or if the formula knows it alone.
fn fastest(plan: &Plan, q: &[f64], formula: &Formula, m: &mut Motion<f64>) -> f64 {
    let known =
        [Variable::X, Variable::Y, Variable::Vx, Variable::Vy, Variable::V, Variable::S, Variable::Psi];
    let mut fastest = 1.0_f64;
    if known.into_iter().chain([Variable::PsiDot]).any(|variable| formula.reads(variable)) {
        for i in 0..FIRST as usize * plan.turns as usize {
            plan.mechanism.place::<f64, 2>(q, Angle::new(i as f64 * TAU / FIRST), m);
            fastest = m.links.iter().fold(fastest, |most, link| most.max(link.d1.abs()));
        }
    }
    fastest.min(FASTEST)
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
