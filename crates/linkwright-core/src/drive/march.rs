//! All motions over one revolution, from the fastest down: which repeat, and whether any does.
//!
//! The equation has one unknown u over φ, so motions from different starts never cross: the return map
//! P is increasing. Three things follow.
//!
//! * A motion that starts too fast to repeat, P(u) < u, slows down turn by turn, and whatever repeats lies
//!   below P(u); it ends in the fastest motion that repeats, which therefore draws in all that are faster.
//! * If it comes to rest instead, so does every slower one: then no motion repeats.
//! * Between a start that gains speed and one that loses it lies one that repeats.
//!
//! Turns are marched through step by step with as short steps as the motion needs. Instead of waiting turn
//! by turn, starts are lowered by a share, or put where Newton on P(u) = u expects a motion that repeats. That none was
//! leapt over is read from the gain P(u) − u and its slope at both ends: the cubic through them must keep
//! clear of zero, or the interval is halved.

use crate::drive::cycle::divide;
use crate::drive::equation::Machine;
use crate::drive::events::{Event, Events, Pull, Side};
use crate::drive::mesh::{Crossing, Piece};
use crate::drive::step::Step;
use crate::kernel::call::poll;
use crate::kernel::radau::{B, C, N, S};
use crate::linkage::motion::Motion;

/// What the polynomial of a step may have of the highest degree, as a share of u: with order 9, errors are about the square of
/// its 14th part, by which its acceleration departs from one of a degree less. It is taken from u: where drive and loads
/// balance, rounding leaves few digits of the acceleration.
const TAIL: f64 = 1.4e-4;

/// Longest step: a 24th of the revolution.
const LONGEST: usize = 24;

/// A step shorter than this \[rad\], or a u below this share of that at the working speed, is rest where the torques at
/// standstill do not drive the machine on. Where they do it creeps, and is followed down to the second share.
const REST_STEP: f64 = 1e-9;
const REST: f64 = 1e-10;
const CREEP: f64 = 1e-24;

/// Most steps of a revolution.
const STEPS_MAX: usize = 20_000;

/// Turns that may be marched through before the search is given up, and steps in all of them: some seconds.
pub const TURNS_MAX: usize = 500;
pub const STEPS_IN_ALL_MAX: usize = 400_000;

/// Relative distance from repeating at which a motion is good enough to start from.
const REPEATS: f64 = 1e-7;

/// Relative distance from repeating at which a motion still repeats.
const CLOSES: f64 = 1e-4;

/// Doublings of the speed from three times the working speed, or from the fastest hint: a machine that gains speed after the last,
/// at 1500 times, runs away.
const DOUBLINGS: i32 = 10;

/// Slow motions are looked for down to this share of u at the working speed: a hundredth of the speed.
const SLOWEST: f64 = 1e-4;

/// How near, as a share of itself, a start that gains speed is followed to one that comes to rest.
const BRINK: f64 = 1e-3;

/// Halvings of an interval to see that nothing repeats in it, and to keep several that repeat apart.
const HALVINGS: u32 = 8;

/// Share of the smaller gain at the ends of an interval that the cubic between must keep from zero: where it
/// bends towards zero, the gain itself may get there.
const CLEAR: f64 = 0.9;

/// Work below this share of its parts is none.
const NO_WORK: f64 = 1e-8;

/// A gain below this share of u is that of the work over J.
const SLIGHT: f64 = 1e-6;

/// Rounding of what carries inertias along, relative.
const ROUNDING: f64 = 1e-14;

/// How near to a motion that repeats, as a share of u, every other may repeat too; and how exactly the ends of the range of
/// those are found.
const BESIDE: f64 = 1e-4;
const ENDS: f64 = 1e-7;

/// A motion this near to a jump of a law, as a share of u, is on it.
const ON_JUMP: f64 = 1e-9;

/// By how much of u a motion that leaves a jump is put beside it.
const BESIDE_JUMP: f64 = 1e-11;

/// A jump that has just been passed is not passed again within this angle \[rad\]: there it would be slid along.
const AGAIN: f64 = 1e-9;

/// First step that leaves a jump, as a share of the longest.
const FIRST_OFF: f64 = 0.02;

/// Halvings of a step to the angle at which a motion leaves a jump, and of a range to the u at which it creeps.
const LEAVING: usize = 40;

/// The next start lies above this share of u, so that the gain is seen in all its turns.
const LEAP: f64 = 0.85;

/// How far behind the place that Newton expects the next start lies, so that what repeats lies between.
const BEHIND: f64 = 0.1;

/// A motion through one revolution.
#[derive(Clone, Debug)]
struct Revolution {
    start: f64,
    end: f64,
    /// Derivative of the end by the start.
    growth: f64,
    pieces: Vec<Piece>,
    /// Where it passes kinks of laws.
    crossings: Vec<Crossing>,
    /// Where it begins to slide along a jump of a law.
    slides: Option<Sliding>,
    balance: Balance,
}

/// What drive and loads leave over a revolution.
#[derive(Clone, Copy, Debug)]
struct Balance {
    /// Work \[J\].
    work: f64,
    /// That of their sizes, and what rounding leaves where there are none.
    size: f64,
    rounding: f64,
    /// Whether no torque of the revolution depends on the speed.
    is_even: bool,
}

/// Where a motion begins to slide along a jump of a law.
#[derive(Clone, Copy, Debug)]
pub struct Sliding {
    /// Crank angle \[rad\].
    pub phi: f64,
    /// Speed at which it is held \[rad/s\].
    pub omega: f64,
    /// Over what angle it slides in the whole revolution \[rad\].
    pub over: f64,
}

/// A motion that repeats, to about seven digits.
#[derive(Clone, Debug)]
pub struct PeriodicMotion {
    /// Its steps.
    pub pieces: Vec<Piece>,
    /// Where it passes kinks of laws, ends of its steps.
    pub crossings: Vec<Crossing>,
    /// Derivative of the end of the revolution by its start.
    pub growth: f64,
    /// Where it begins to slide along a jump of a law, if it does.
    pub slides: Option<Sliding>,
}

impl PeriodicMotion {
    /// u at φ = 0.
    pub fn u(&self) -> f64 {
        self.pieces[0].u
    }
}

/// The motions that repeat, and what becomes of starts beyond them.
#[derive(Clone, Debug)]
pub struct Repeating {
    /// From the fastest down.
    pub motions: Vec<PeriodicMotion>,
    /// Speed at φ = 0 above which the machine runs away \[rad/s\]; NaN where it does not.
    pub away_from: f64,
    /// Speed at φ = 0 below which starts were not followed to an end \[rad/s\]; 0 where all were.
    pub followed_to: f64,
}

/// Why no motion repeats.
#[derive(Clone, Copy, Debug)]
pub enum NoMotion {
    /// Started with speed `omega` at φ = 0, the machine comes to rest at `phi`, and so does every slower
    /// start; every faster one slows down to it.
    Rests { omega: f64, phi: f64 },
    /// At speed `omega` the machine still gains speed from turn to turn, as from all starts faster than `from`.
    RunsAway { omega: f64, from: f64 },
    /// Drive and loads leave no work over a revolution at any speed of a range: all of them repeat. Speeds at φ = 0; the
    /// fastest may be infinite, the slowest zero.
    Neutral { slowest: f64, fastest: f64 },
    /// It does not close at the angle `phi`.
    DoesNotClose { phi: f64 },
    /// No answer within the turns allowed.
    Unknown,
}

/// Whether a motion that is this slow somewhere is rest to a search beside a known motion.
pub fn counts_as_rest(machine: &Machine<'_, f64>, omega: f64) -> bool {
    omega * omega <= REST * machine.q[machine.plan.drive.speed_start].powi(2)
}

/// Which motions are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionChoice {
    /// The fastest one.
    Fastest,
    /// All, down to a hundredth of the working speed.
    All,
}

struct March<'a> {
    machine: &'a Machine<'a, f64>,
    breaks: &'a [f64],
    /// u below which a machine may be at rest, and that to which one that creeps is followed, if it is at all.
    rest: f64,
    least: Option<f64>,
    m: Motion<f64>,
    /// Those of laws are ends of steps.
    events: Events<'a, f64>,
    turns: usize,
    /// Steps tried in all of them.
    steps: usize,
    /// Motions that repeat, from the fastest down.
    found: Vec<PeriodicMotion>,
    /// Starts that are to be looked at, the fastest of which tells where to begin; others beside a motion that is known.
    hints: &'a [f64],
    beside: &'a [f64],
    /// The slowest start from which, as from all faster ones, the machine gains speed without end; NaN where it does not.
    away: f64,
    /// The fastest start of all.
    fastest: f64,
    /// Changes of sign of the gain that have been closed in on.
    refined: usize,
    /// Down to here all starts have been followed.
    followed: f64,
}

/// Motions that repeat, to about seven digits; at least one. `hints` are u at φ = 0 between which some may lie, however near to
/// each other. `known` are others on both sides of a motion that is known: beside one at a working speed a slow machine counts as
/// at rest, since nothing so slow is reported; without one it is followed however slow it is, as long as it is driven on at
/// standstill.
///
/// # Errors
/// [`NoMotion`] says why there is none.
pub fn repeating(
    machine: &Machine<'_, f64>,
    breaks: &[f64],
    which: MotionChoice,
    hints: &[f64],
    known: Option<&[f64]>,
) -> Result<Repeating, NoMotion> {
    let m = Motion::new(&machine.plan.mechanism, machine.q);
    let working = 0.5 * machine.q[machine.plan.drive.speed_start].powi(2);
    let mut march = March {
        machine,
        breaks,
        rest: REST * working,
        least: known.is_none().then_some(CREEP * working),
        m,
        events: Events::new(*machine),
        turns: 0,
        steps: 0,
        found: Vec::new(),
        hints,
        beside: known.unwrap_or_default(),
        away: f64::NAN,
        fastest: f64::NAN,
        refined: 0,
        followed: f64::INFINITY,
    };
    match march.walk(working, which) {
        Err(NoMotion::Neutral { slowest, .. }) => march.take_range(slowest, working, which),
        // What comes to rest has been followed to its end.
        Ok(()) | Err(NoMotion::Rests { .. }) if !march.found.is_empty() => Ok(march.into_repeating(0.0)),
        Err(_) if !march.found.is_empty() => {
            let followed = march.followed;
            Ok(march.into_repeating(followed))
        }
        Ok(()) | Err(NoMotion::Rests { .. }) if !march.away.is_nan() => {
            let [omega, from] = [march.fastest, march.away].map(|u| (2.0 * u).sqrt());
            Err(NoMotion::RunsAway { omega, from })
        }
        Ok(()) => Err(NoMotion::Unknown),
        Err(reason) => Err(reason),
    }
}

impl Balance {
    /// Adds a step.
    fn add(&mut self, machine: &Machine<'_, f64>, step: &Step<f64>) {
        let Machine { plan, q, .. } = *machine;
        for (i, row) in step.rows.iter().enumerate() {
            let torque = plan.drive.torque(&plan.tables, q, (2.0 * step.X[i]).sqrt());
            let carried = row.drift * step.X[i];
            let left = (step.K[i] + carried) / row.inverse;
            self.rounding += step.h * B[i] * carried.abs() / row.inverse * ROUNDING;
            self.work += step.h * B[i] * left;
            self.size += step.h * B[i] * (torque.abs() + (torque - left).abs());
            self.is_even &= step.D[i] + row.drift == 0.0;
        }
    }
}

impl Revolution {
    /// What u gains over the revolution.
    fn gain(&self) -> f64 {
        self.end - self.start
    }

    /// Whether it repeats, and so do all that pass the same torques.
    fn is_neutral(&self) -> bool {
        let Balance { work, size, rounding, is_even } = self.balance;
        is_even
            && work.abs() <= NO_WORK * size + rounding
            && self.crossings.is_empty()
            && self.slides.is_none()
    }

    /// Whether drive and loads clearly leave work.
    fn gains_work(&self) -> bool {
        let Balance { work, size, rounding, .. } = self.balance;
        work > NO_WORK * size + rounding
    }

    /// Where Newton expects a start that repeats.
    fn newton(&self) -> f64 {
        self.start + self.gain() / (1.0 - self.growth)
    }

    /// The start to go on with below this one.
    fn next_below(&self) -> f64 {
        let least = LEAP * self.start;
        if self.gain() >= 0.0 {
            return least;
        }
        let newton = self.newton();
        let behind = newton - BEHIND * (self.start - newton);
        // A growth of 1 or more, or a NaN, points to nothing below.
        let next = if self.growth < 1.0 && behind > least { behind } else { least };
        next.min(self.end)
    }

    /// Whether nothing repeats between this start and a slower one with a gain of the same sign: by the order
    /// of motions, or by the cubic through gains and slopes.
    fn is_clear_down_to(&self, low: &Revolution) -> bool {
        let (h, sign) = (self.start - low.start, self.gain().signum());
        if (sign < 0.0 && self.end <= low.start) || (sign > 0.0 && low.end >= self.start) {
            return true;
        }
        let least = CLEAR * self.gain().abs().min(low.gain().abs());
        let (left, right) = ((low.growth - 1.0) * h, (self.growth - 1.0) * h);
        (1..16).all(|i| {
            let x = f64::from(i) / 16.0;
            let (y, up) = (1.0 - x, x * x * (3.0 - 2.0 * x));
            let cubic = low.gain() * (1.0 - up) + self.gain() * up + left * x * y * y - right * x * x * y;
            sign * cubic > least
        })
    }
}

impl March<'_> {
    /// What was found, with u down to which starts were followed.
    fn into_repeating(self, followed: f64) -> Repeating {
        let speed = |u: f64| (2.0 * u).sqrt();
        Repeating { motions: self.found, away_from: speed(self.away), followed_to: speed(followed) }
    }

    /// Goes down from the fastest start, until the machine comes to rest.
    fn walk(&mut self, working: f64, which: MotionChoice) -> Result<(), NoMotion> {
        let fast = self.hints.iter().copied().fold(9.0 * working, f64::max);
        let high = self.fast_start(fast)?;
        // Among starts that run away, far above all that is known, leaps may be long.
        let far = if self.away.is_nan() {
            f64::INFINITY
        } else {
            self.beside.iter().fold(fast, |a, &b| a.max(4.0 * b))
        };
        self.descend(high, far, working, which)
    }

    /// Goes down from a start until the machine comes to rest, in long leaps above `far`.
    fn descend(
        &mut self,
        mut high: Revolution,
        far: f64,
        working: f64,
        which: MotionChoice,
    ) -> Result<(), NoMotion> {
        let slows = high.gain() < 0.0;
        loop {
            self.followed = high.start;
            // Below starts that gain speed the fastest motion is one that the machine departs from.
            let holds = |motion: &PeriodicMotion| motion.slides.is_none() && (slows || motion.growth < 1.0);
            if which == MotionChoice::Fastest && self.found.iter().any(holds) {
                return Ok(());
            }
            // Below starts that slow down the known motion is where the next slower start gains speed.
            let beside = if slows { &[][..] } else { self.beside };
            let hints = self.hints.iter().chain(beside).copied().filter(|&hint| hint < high.start);
            let below = if high.start > far { (0.25 * high.start).max(far) } else { high.next_below() };
            let next = hints.fold(below, f64::max);
            if high.gain() >= 0.0 && next < SLOWEST * working {
                return Ok(());
            }
            high = match self.revolution(next) {
                Ok(low) => self.between(high, low, HALVINGS)?,
                Err(rests @ NoMotion::Rests { .. }) => return self.down_to_rest(high, next, rests),
                Err(other) => return Err(other),
            };
        }
    }

    /// A motion fast enough to slow down. Where the fastest of all starts still gains speed, that one: the machine runs away.
    fn fast_start(&mut self, mut u: f64) -> Result<Revolution, NoMotion> {
        self.fastest = u * 4.0_f64.powi(DOUBLINGS - 1);
        if let Ok(top) = self.revolution(self.fastest)
            && top.gains_work()
        {
            self.away = top.start;
            return Ok(top);
        }
        let mut reason = NoMotion::Unknown;
        for _ in 0..DOUBLINGS {
            reason = match self.revolution(u) {
                Ok(found) if found.gain() < 0.0 => return Ok(found),
                Ok(_) => NoMotion::Unknown,
                Err(rests @ NoMotion::Rests { .. }) => rests,
                Err(other) => return Err(other),
            };
            u *= 4.0;
        }
        Err(reason)
    }

    /// Finds what repeats between two starts; gives back the lower.
    fn between(&mut self, high: Revolution, low: Revolution, halvings: u32) -> Result<Revolution, NoMotion> {
        let changes = (high.gain() < 0.0) != (low.gain() < 0.0);
        // With one change of sign and both slopes towards it there is one that repeats.
        let slope = if high.gain() < 0.0 { 1.0 } else { -1.0 };
        let is_one = changes && [&high, &low].iter().all(|end| slope * (end.growth - 1.0) < 0.0);
        if is_one || (changes && halvings == 0) {
            self.refine(high, &low)?;
            return Ok(low);
        }
        if halvings == 0 || (!changes && high.is_clear_down_to(&low)) {
            return Ok(low);
        }
        let middle = self.turning(0.5 * (high.start + low.start))?;
        let middle = self.between(high, middle, halvings - 1)?;
        self.between(middle, low, halvings - 1)
    }

    /// Newton for what repeats between two starts, kept inside the bracket.
    fn refine(&mut self, mut high: Revolution, low: &Revolution) -> Result<(), NoMotion> {
        self.refined += 1;
        let (mut bottom, mut nearest) = (low.start, low.clone());
        if high.gain().abs() < low.gain().abs() {
            nearest = high.clone();
        }
        let falls = high.gain() < 0.0;
        let (mut top, mut best) = (high.start, nearest.clone());
        while top - bottom > REPEATS * top && (nearest.newton() / nearest.start - 1.0).abs() > REPEATS {
            let newton = nearest.newton();
            let is_inside = newton > bottom && newton < top;
            high = self.turning(if is_inside { newton } else { 0.5 * (bottom + top) })?;
            *if (high.gain() < 0.0) == falls { &mut top } else { &mut bottom } = high.start;
            if high.gain().abs() < best.gain().abs() {
                best = high.clone();
            }
            nearest = high;
        }
        // Under a drive that is steep between kinks, as a speed controller is, gains scatter by what the steps miss of the kinks.
        let nearest = best;
        if self.refined == 1 && !self.away.is_nan() && !falls {
            self.away = top;
        }
        // Where both sides of a jump drive a motion away, the gain leaps over zero: nothing repeats there. Where motions part
        // fast, none closes as well, but Newton expects one at hand.
        let closes = (nearest.end / nearest.start - 1.0).abs() <= CLOSES;
        if closes || (nearest.newton() / nearest.start - 1.0).abs() <= REPEATS {
            if let Err(neutral @ NoMotion::Neutral { .. }) = self.revolution((1.0 - BESIDE) * nearest.start) {
                return Err(neutral);
            }
            let Revolution { pieces, crossings, growth, slides, .. } = nearest;
            self.found.push(PeriodicMotion { pieces, crossings, growth, slides });
        }
        Ok(())
    }

    /// From a start that turns to one that comes to rest: what lies between?
    fn down_to_rest(
        &mut self,
        mut high: Revolution,
        mut rest: f64,
        mut reason: NoMotion,
    ) -> Result<(), NoMotion> {
        // Every start between falls to what rests, or what gains is followed to the brink.
        while (high.gain() < 0.0 && high.end > rest) || high.start - rest > BRINK * high.start {
            match self.revolution(0.5 * (high.start + rest)) {
                Ok(low) => high = self.between(high, low, HALVINGS)?,
                Err(rests @ NoMotion::Rests { .. }) => (rest, reason) = (0.5 * (high.start + rest), rests),
                Err(other) => return Err(other),
            }
        }
        Err(reason)
    }

    /// The motion from a start above one that turns: where it comes to rest all the same, rounding decides.
    fn turning(&mut self, start: f64) -> Result<Revolution, NoMotion> {
        self.revolution(start).map_err(|reason| match reason {
            NoMotion::Rests { .. } => NoMotion::Unknown,
            other => other,
        })
    }

    /// The motion from a start through one revolution; an error where it is one of many that repeat.
    fn revolution(&mut self, start: f64) -> Result<Revolution, NoMotion> {
        let turn = self.turn_from(start)?;
        let omega = (2.0 * start).sqrt();
        if turn.is_neutral() { Err(NoMotion::Neutral { slowest: omega, fastest: omega }) } else { Ok(turn) }
    }

    /// Adds the ends of the range of motions around a speed that all repeat; an error where none is faster, but for one that
    /// is its end, nor any slower that holds the machine.
    fn take_range(mut self, omega: f64, working: f64, which: MotionChoice) -> Result<Repeating, NoMotion> {
        let (slowest, fastest) = self.range(omega);
        let end = (1.0 + 2.0 * BESIDE) * 0.5 * fastest * fastest;
        self.found.retain(|motion| motion.u() > end);
        let is_fastest = !self.found.is_empty();
        let mut ends = Vec::new();
        for omega in [fastest, slowest].into_iter().filter(|omega| omega.is_finite() && *omega > 0.0) {
            let Revolution { pieces, crossings, slides, .. } = self.turn_from(0.5 * omega * omega)?;
            ends.push(PeriodicMotion { pieces, crossings, growth: 1.0, slides });
        }
        let mut followed = 0.5 * slowest * slowest;
        if !is_fastest {
            if slowest > 0.0 && self.look_below(followed, working, which) {
                followed = self.followed;
            } else {
                return Err(NoMotion::Neutral { slowest, fastest });
            }
        }
        let at = if is_fastest { self.found.len() } else { 0 };
        self.found.splice(at..at, ends);
        Ok(self.into_repeating(followed))
    }

    /// Whether a motion below the slowest of a range, which has this u, holds the machine.
    fn look_below(&mut self, slowest: f64, working: f64, which: MotionChoice) -> bool {
        let Ok(high) = self.revolution((1.0 - 2.0 * BESIDE) * slowest) else { return false };
        self.refined = 0;
        if high.gain() > 0.0 {
            // From here the machine gains speed up to the range.
            self.away = high.start;
        }
        // Elsewhere nothing is known of what lies below the last start.
        if let Ok(()) | Err(NoMotion::Rests { .. }) = self.descend(high, f64::INFINITY, working, which) {
            self.followed = 0.0;
        }
        self.found.iter().any(|motion| motion.growth < 1.0 && motion.slides.is_none())
    }

    /// The range of speeds around one that all repeat.
    fn range(&mut self, omega: f64) -> (f64, f64) {
        (self.turns, self.steps) = (0, 0);
        let [slowest, fastest] = [0.25, 4.0].map(|by| {
            let (mut inside, mut beyond) = (0.5 * omega * omega, 0.5 * omega * omega * by);
            for _ in 0..DOUBLINGS {
                if !self.is_neutral_from(beyond) {
                    break;
                }
                (inside, beyond) = (beyond, beyond * by);
            }
            if self.is_neutral_from(beyond) {
                return if by < 1.0 { 0.0 } else { f64::INFINITY };
            }
            while (beyond / inside - 1.0).abs() > ENDS {
                let middle = (inside * beyond).sqrt();
                *if self.is_neutral_from(middle) { &mut inside } else { &mut beyond } = middle;
            }
            (2.0 * inside).sqrt()
        });
        (slowest, fastest)
    }

    fn is_neutral_from(&mut self, start: f64) -> bool {
        self.turn_from(start).is_ok_and(|turn| turn.is_neutral())
    }

    /// The motion from a start through one revolution, whatever others do.
    fn turn_from(&mut self, start: f64) -> Result<Revolution, NoMotion> {
        self.turns += 1;
        if self.turns > TURNS_MAX {
            return Err(NoMotion::Unknown);
        }
        let (pieces, crossings) = (Vec::new(), Vec::new());
        let balance = Balance { work: 0.0, size: 0.0, rounding: 0.0, is_even: true };
        let mut turn =
            Revolution { start, end: start, growth: 1.0, pieces, crossings, slides: None, balance };
        let longest = divide(&[0.0, std::f64::consts::TAU], LONGEST)[1];
        let mut h = 0.25 * longest;
        let mut next_break = 1;
        let mut phi = 0.0;
        let mut side: Option<Side> = None;
        let (mut put_at, mut inverse) = (f64::NAN, f64::NAN);
        while next_break < self.breaks.len() {
            poll();
            self.steps += 1;
            if turn.pieces.len() + turn.crossings.len() > STEPS_MAX || self.steps > STEPS_IN_ALL_MAX {
                return Err(NoMotion::Unknown);
            }
            let left = self.breaks[next_break] - phi;
            if let Some(event) = self.events.held(phi, turn.end, ON_JUMP, &mut self.m) {
                let (slid, pull) = self.slide(event, &mut turn, phi, left.min(longest));
                (phi, next_break) = if slid < left {
                    (phi + slid, next_break)
                } else {
                    (self.breaks[next_break], next_break + 1)
                };
                h = FIRST_OFF * longest;
                side = (pull != Pull::Holds && slid < left)
                    .then(|| self.events.beside(phi, turn.end, pull == Pull::Up, &mut self.m));
                continue;
            }
            let mut step = h.min(left);
            let on = side.take().or_else(|| {
                self.machine.keeps_branch.then(|| self.events.ahead(phi, turn.end, step, &mut self.m))
            });
            let machine = on.as_ref().map_or(*self.machine, |side| side.of(self.machine));
            let (mut found, geometry) = machine.advance(phi, turn.end, step, &mut self.m);
            let piece = Piece { phi, h: step, u: turn.end, X: found.X };
            let jump =
                on.as_ref().and_then(|on| self.events.first_of_laws(on, &piece, &geometry, &mut self.m));
            // What has just been passed at a flat angle is not passed back at once, whatever rounding says.
            let is_again = |&(to, nth): &(f64, usize)| {
                turn.crossings.last() == Some(&Crossing { phi, nth }) && to < AGAIN
            };
            let jump = jump.filter(|jump| !is_again(jump));
            if let Some((to, _)) = jump.filter(|&(to, _)| to < step) {
                step = to;
                found = machine.advance(phi, turn.end, step, &mut self.m).0;
            }
            if found.rows.iter().any(|row| !row.inverse.is_finite()) {
                return Err(NoMotion::DoesNotClose { phi });
            }
            let least = found.X.iter().copied().fold(turn.end, f64::min);
            let coarse = found.quintic()[N - 1].abs() / (TAIL * least);
            // A NaN is not good either.
            let is_good = coarse <= 1.0 && least > 0.0 && found.growth > 0.0;
            // The highest degree falls with the fourth power of the length, what it adds to u with the fifth.
            let factor = if coarse.is_nan() { 0.2 } else { (0.8 * coarse.powf(-0.2)).clamp(0.2, 3.0) };
            if is_good {
                if step > 0.0 {
                    turn.pieces.push(Piece { phi, h: step, u: turn.end, X: found.X });
                }
                turn.end = found.X[S - 1];
                turn.growth *= found.growth;
                inverse = found.rows[S - 1].inverse;
                turn.balance.add(self.machine, &found);
                phi += step;
                h = (step * factor).min(longest);
                let is_break = step >= left;
                if is_break {
                    (phi, next_break) = (self.breaks[next_break], next_break + 1);
                }
                if let (Some((_, nth)), Some(on)) = (jump, &on) {
                    let at = [phi, turn.end, found.K[S - 1]];
                    let (behind, passage) = self.events.behind(nth, on, at, &mut self.m);
                    turn.growth *= passage.factor();
                    turn.crossings.push(Crossing { phi, nth });
                    (h, side) = (h.max(FIRST_OFF * longest), Some(behind));
                } else {
                    side = on;
                }
                // Behind a break other choices of the laws may hold.
                side = side.filter(|_| !is_break);
            } else {
                (h, side) = (step * factor.min(0.5), on);
            }
            let is_stuck = !is_good && h < REST_STEP.min(1e-3 * left);
            if is_stuck
                && put_at != phi
                && let Some(u) = self.creep_below(phi, turn.end)
            {
                // Whatever falls to it within no angle goes on from it.
                (turn.end, turn.growth, put_at) = (u, 0.0, phi);
                (h, side) = (FIRST_OFF * longest, None);
            } else if is_stuck || (turn.end <= self.rest && !self.is_driven_on(phi, turn.end)) {
                let omega = (2.0 * start).sqrt();
                return Err(NoMotion::Rests { omega, phi });
            }
        }
        // J is the same at both ends, so u gains work over J: exact where it is small against what inertia carries along.
        let is_slight = (turn.end / start - 1.0).abs() < SLIGHT && turn.growth > 0.5;
        if is_slight && turn.crossings.is_empty() && turn.slides.is_none() && put_at.is_nan() {
            turn.end = turn.balance.work.mul_add(inverse, start);
        }
        Ok(turn)
    }

    /// Whether the torques at standstill drive a slow machine on.
    fn is_driven_on(&mut self, phi: f64, u: f64) -> bool {
        self.least.is_some_and(|least| u > least && self.acceleration(phi, least) > 0.0)
    }

    /// The highest u below a given one to which a machine falls that creeps: the torques balance there, and drive on what is
    /// slower.
    fn creep_below(&mut self, phi: f64, u: f64) -> Option<f64> {
        let least = self.least?;
        let (mut fast, mut slow) = (u, 0.5 * u);
        while self.acceleration(phi, slow) <= 0.0 {
            (fast, slow) = (slow, 0.5 * slow);
            if slow < least {
                return None;
            }
        }
        if fast == u && self.acceleration(phi, u) > 0.0 {
            return None;
        }
        for _ in 0..LEAVING {
            let middle = 0.5 * (slow + fast);
            *if self.acceleration(phi, middle) > 0.0 { &mut slow } else { &mut fast } = middle;
        }
        Some(slow)
    }

    /// ε at a crank angle.
    fn acceleration(&mut self, phi: f64, u: f64) -> f64 {
        let mut geometry = Vec::new();
        let row = self.machine.row(phi, &mut self.m, &mut geometry);
        self.machine.acceleration(&row, &geometry, u).value
    }

    /// Takes a motion that is held on a jump along it, at most by `most`, to where one side lets it go: how far, and which side.
    fn slide(&mut self, event: Event, turn: &mut Revolution, phi: f64, most: f64) -> (f64, Pull) {
        let (start, events, m) = (turn.end, &self.events, &mut self.m);
        let mut at = |x: f64| {
            let u = events.level(event, phi + x, start, m);
            (u, events.pull(event, phi + x, u, m))
        };
        let (mut slid, mut end) = (most, at(most));
        if end.1 != Pull::Holds {
            let mut held = 0.0;
            for _ in 0..LEAVING {
                let middle = 0.5 * (held + slid);
                let there = at(middle);
                if there.1 == Pull::Holds {
                    held = middle;
                } else {
                    (slid, end) = (middle, there);
                }
            }
        }
        turn.pieces.push(Piece { phi, h: slid, u: start, X: C.map(|c| at(c * slid).0) });
        turn.end = match end.1 {
            Pull::Holds => end.0,
            Pull::Up => end.0 * (1.0 + BESIDE_JUMP),
            Pull::Down => end.0 * (1.0 - BESIDE_JUMP),
        };
        // Whatever reaches the jump leaves it in the same way.
        turn.growth = 0.0;
        let omega = (2.0 * start).sqrt();
        turn.slides.get_or_insert(Sliding { phi, omega, over: 0.0 }).over += slid;
        (slid, end.1)
    }
}
