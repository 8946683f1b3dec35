//! All motions over one turn, from the fastest down: which repeat, and whether any does.
//!
//! The equation has one unknown u over φ, so motions from different starts never cross: the turn-to-turn map
//! P is increasing. Two things follow.
//!
//! * A motion that starts too fast to repeat, P(u) < u, slows down turn by turn, and whatever repeats lies
//!   below it; it ends in the fastest motion that repeats, which therefore draws in all that are faster.
//! * If it comes to rest instead, so does every slower one: then no motion repeats.
//!
//! Turns are marched through step by step with as short steps as the motion needs. Instead of waiting turn
//! by turn, Newton on P(u) = u leaps ahead, and a bracket keeps it from passing what it seeks.

use crate::call::poll;
use crate::cycle::{Machine, divide};
use crate::linkage::Motion;
use crate::mesh::Piece;
use crate::radau::{S, tail};

/// What the polynomial of a step may have of the highest degree, as a share of u: with order 9, errors are
/// about the square of that.
const TAIL: f64 = 1e-4;

/// Longest step: a 24th of the turn.
const LONGEST: usize = 24;

/// A step shorter than this \[rad\], or a u below this share of that at the working speed, is rest.
const REST_STEP: f64 = 1e-9;
const REST: f64 = 1e-10;

/// Most steps of a turn.
const STEPS_MAX: usize = 20_000;

/// Turns that may be marched through before the search is given up.
const TURNS_MAX: usize = 200;

/// Relative distance from repeating at which a motion is good enough to start from.
const REPEATS: f64 = 1e-7;

/// Doublings of the speed before a machine counts as running away: from three times the working speed to
/// 3000 times.
const DOUBLINGS: usize = 10;

/// A motion through one turn.
#[derive(Clone, Debug)]
struct Revolution {
    start: f64,
    end: f64,
    /// Derivative of the end by the start.
    growth: f64,
    pieces: Vec<Piece>,
}

/// Why no motion repeats.
#[derive(Clone, Copy, Debug)]
pub enum NoMotion {
    /// Started with speed `omega` at φ = 0, the machine comes to rest at `phi`, and so does every slower
    /// start; every faster one slows down to it.
    Rests { omega: f64, phi: f64 },
    /// At speed `omega` the machine still gains speed from turn to turn.
    RunsAway { omega: f64 },
    /// It does not close at the angle `phi`.
    DoesNotClose { phi: f64 },
    /// No answer within the turns allowed.
    Unknown,
}

struct March<'a> {
    machine: &'a Machine<'a, f64>,
    breaks: &'a [f64],
    rest: f64,
    m: Motion<f64>,
}

/// The fastest motion that repeats, to about seven digits.
///
/// # Errors
/// [`NoMotion`] says why there is none.
pub fn fastest_motion(machine: &Machine<'_, f64>, breaks: &[f64]) -> Result<Vec<Piece>, NoMotion> {
    let m = Motion::new(&machine.plan.mechanism, machine.q);
    let working = 0.5 * machine.q[machine.plan.drive.speed_start].powi(2);
    let mut march = March { machine, breaks, rest: REST * working, m };
    // Above: slows down. Below: comes to rest (none yet: u = 0), or gains speed.
    let mut below = Below { u: 0.0, rests: NoMotion::Unknown, is_gaining: false };
    let mut above = march.fast_start(9.0 * working, &mut below)?;
    for _ in 0..TURNS_MAX {
        if (above.start - above.end) <= REPEATS * above.start {
            return Ok(above.pieces);
        }
        if !below.is_gaining && above.end <= below.u {
            return Err(below.rests);
        }
        let newton = above.start + (above.end - above.start) / (1.0 - above.growth);
        let is_inside = newton > below.u && newton < above.start;
        let next = if is_inside { newton } else { 0.5 * (below.u + above.start) };
        if below.is_gaining && above.start - below.u <= REPEATS * above.start {
            return Ok(above.pieces);
        }
        match march.revolution(next) {
            Ok(found) if found.end < found.start => above = found,
            Ok(found)
                if found.start - found.end <= REPEATS * found.start
                    && found.growth < 1.0
                    && found.end - found.start <= REPEATS * found.start =>
            {
                return Ok(found.pieces);
            }
            Ok(found) => below = Below { u: found.start, is_gaining: true, ..below },
            Err(rests @ NoMotion::Rests { .. }) => below = Below { u: next, rests, is_gaining: false },
            Err(other) => return Err(other),
        }
    }
    Err(NoMotion::Unknown)
}

/// The fastest start that is known not to slow down.
#[derive(Clone, Copy)]
struct Below {
    u: f64,
    rests: NoMotion,
    is_gaining: bool,
}

impl March<'_> {
    /// A motion fast enough to slow down.
    fn fast_start(&mut self, mut u: f64, below: &mut Below) -> Result<Revolution, NoMotion> {
        for _ in 0..DOUBLINGS {
            match self.revolution(u) {
                Ok(found) if found.end < found.start => return Ok(found),
                Ok(_) => *below = Below { u, is_gaining: true, ..*below },
                Err(rests @ NoMotion::Rests { .. }) => *below = Below { u, rests, is_gaining: false },
                Err(other) => return Err(other),
            }
            u *= 4.0;
        }
        Err(if below.is_gaining { NoMotion::RunsAway { omega: (0.5 * u).sqrt() } } else { below.rests })
    }

    /// The motion from a start through one turn.
    fn revolution(&mut self, start: f64) -> Result<Revolution, NoMotion> {
        let mut turn = Revolution { start, end: start, growth: 1.0, pieces: Vec::new() };
        let longest = divide(&[0.0, std::f64::consts::TAU], LONGEST)[1];
        let mut h = 0.25 * longest;
        let mut next_break = 1;
        let mut phi = 0.0;
        while next_break < self.breaks.len() {
            poll();
            if turn.pieces.len() > STEPS_MAX {
                return Err(NoMotion::Unknown);
            }
            let left = self.breaks[next_break] - phi;
            let step = h.min(left);
            let (found, _) = self.machine.advance(phi, turn.end, step, &mut self.m);
            if found.rows.iter().any(|row| !row.inverse.is_finite()) {
                return Err(NoMotion::DoesNotClose { phi });
            }
            let least = found.X.iter().copied().fold(turn.end, f64::min);
            let coarse = tail(&found.K) * step / (TAIL * least);
            // A NaN is not good either.
            let is_good = coarse <= 1.0 && least > 0.0 && found.growth > 0.0;
            // The highest degree falls with the fourth power of the length, what it adds to u with the fifth.
            let factor = if coarse.is_nan() { 0.2 } else { (0.8 * coarse.powf(-0.2)).clamp(0.2, 3.0) };
            if is_good {
                turn.pieces.push(Piece { phi, h: step, u: turn.end, X: found.X });
                turn.end = found.X[S - 1];
                turn.growth *= found.growth;
                phi += step;
                if step >= left {
                    (phi, next_break) = (self.breaks[next_break], next_break + 1);
                } else {
                    h = (step * factor).min(longest);
                }
            } else {
                h = step * factor.min(0.5);
            }
            let is_stuck = !is_good && h < REST_STEP.min(1e-3 * left);
            if is_stuck || turn.end <= self.rest {
                let omega = (2.0 * start).sqrt();
                return Err(NoMotion::Rests { omega, phi });
            }
        }
        Ok(turn)
    }
}
