//! Motion in time from a given angle and speed: run-up, run-down, anything not yet steady.
//!
//! ```text
//! dφ/dt = ω,   dω/dt = ε = [M_d(ω) − M_r(φ, ω) − ½ J′(φ) ω²] / J(φ)
//! ```
//!
//! counted in the direction in which the crank turns, by [`crate::kernel::rk`], or by [`crate::kernel::radau`] where the drive is so steep that stability would limit the steps of the
//! former and not their error, with these events met exactly by the end of a step: kinks over the angle (dead centres
//! under dry friction, knots of tables), speeds at which the drive's characteristic has a kink, standstill. A step whose
//! speed passes such a speed and comes back inside is cut where the speed turns, and one between whose stages a formula has a
//! pulse before it.
//! At standstill the dry loads decide: what is left of the drive's torque must exceed them to move on.
//!
//! | module | answers |
//! | --- | --- |
//! | [`equation`] | the equation of motion, and which way the machine goes from rest |
//! | [`attempt`] | steps of any length from one instant, by the explicit method |
//! | [`stiff`] | the same by the implicit one |
//! | [`reduced`] | inertia and loads as polynomials over the angle |
//! | `unseen` | pulses of formulas between the stages of a step |

pub mod attempt;
pub mod equation;
pub mod reduced;
pub mod stiff;
mod unseen;

use self::attempt::{Attempts, ExplicitAttempt, Piece, aside_of, state};
pub use self::equation::Turning;
use self::equation::{AT_REST, Equation, Jump, Y};
use self::reduced::ReducedCurves;
use self::stiff::StiffAttempt;
use crate::drive::equation::Machine;
use crate::drive::events::turns_near_zero;
use crate::drive::kinks::landings;
use crate::drive::mesh::crossing;
use crate::drive::structure::Plan;
use crate::kernel::call::poll;
use crate::kernel::radau::{AT, N};
use crate::kernel::rk::{Trial, next_factor_of};
use crate::kernel::turns::{Bernstein, passed_and_back};
use crate::linkage::motion::Motion;
use std::f64::consts::TAU;

/// What to follow.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Crank angle at the start \[rad\].
    pub phi: f64,
    /// Speed at the start in the direction in which the crank turns \[rad/s\], not negative.
    pub omega: f64,
    pub turning: Turning,
    /// Longest time \[s\].
    pub duration: f64,
    /// Most revolutions of the crank.
    pub turns: f64,
    /// Relative accuracy of a step, at its end and on the way there.
    pub accuracy: f64,
}

/// How the motion ended; the numbers are what crosses the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum End {
    /// The time is over.
    Time = 0,
    /// The turns are done.
    Turns = 1,
    /// At rest, and the drive cannot overcome the resistance.
    DoesNotStart = 2,
    /// At rest, and the loads drive the machine backwards.
    StartsBackwards = 3,
    /// Came to rest on the way and stays there.
    Stall = 4,
    /// Came to rest on the way and is driven backwards.
    Reversal = 5,
    /// A dyad does not close at the angle reached.
    DoesNotClose = 6,
    /// Too many steps, or steps too small, for the accuracy.
    Inaccurate = 7,
    /// Slides along a jump of a load over the speed.
    Slides = 8,
}

impl End {
    /// What a step that is given up for its error says.
    fn of_error(error: f64) -> Self {
        if error.is_nan() { End::DoesNotClose } else { End::Inaccurate }
    }
}

/// The motion at the ends of the steps.
#[derive(Clone, Debug)]
pub struct Trajectory {
    pub t: Vec<f64>,
    pub phi: Vec<f64>,
    pub omega: Vec<f64>,
    pub epsilon: Vec<f64>,
    /// Of each step the polynomials of angle and speed ([`crate::kernel::rk::Stages::component`]).
    pub between: Vec<[[f64; 7]; 2]>,
    /// Of each step whether it is by the implicit method.
    pub implicit: Vec<bool>,
    pub end: End,
    /// Drive's torque at the crank where the motion ended \[N m\].
    pub drive_torque: f64,
    /// Torque the loads need there to be overcome \[N m\].
    pub load_torque: f64,
    /// Evaluations of the machine.
    pub evaluations: usize,
}

impl Trajectory {
    /// From the direction in which the crank turned to counter-clockwise.
    fn count_counter_clockwise(&mut self, sense: f64) {
        let curves = [&mut self.phi, &mut self.omega, &mut self.epsilon];
        let values = curves.into_iter().flatten().chain(self.between.iter_mut().flatten().flatten());
        // Zero has no sign.
        values.for_each(|value| *value = sense * *value + 0.0);
        self.drive_torque *= sense;
        self.load_torque *= sense;
    }
}

/// Steps after which the motion is given up: a run-up of a thousand turns takes a tenth of them.
const STEPS_MAX: usize = 400_000;

/// How close a landing on the last angle must be \[rad\].
const LANDING: f64 = 1e-13;

/// Share of the duration by which the sum of the steps may fall short of it: the rounding of the last sums.
const ROUNDING_OF_TIME: f64 = 4.0 * f64::EPSILON;

/// How close a landing on a kink must be, for an accuracy ε: this times √ε \[rad\]. Passing a kink by δ errs
/// by δ² times its change of slope, a millionth of ε.
const NEAR: f64 = 1e-3;

/// A step of the crank shorter than this \[rad\] may be due to a jump on which the motion is held.
const SHORT: f64 = 1e-7;

/// Newton steps to the speed of a jump: the quantity is nearly linear in it.
const LEVEL_SWEEPS: usize = 4;

/// How near to a jump, as a share of the speed, steps that go back and forth across it leave the motion.
const NEAR_JUMP: f64 = 1e-5;

/// Follows the motion until time, turns or an event end it.
pub fn follow(plan: &Plan, q: &[f64], start: &Start) -> Trajectory {
    let machine = Machine::new(plan, q);
    let mut motion = Motion::new(&plan.mechanism, q);
    let mut kinks = landings(plan, q, machine.breaks(&mut motion).swap_remove(0));
    let curves = ReducedCurves::new(plan, &kinks, start.turning.crank, start.accuracy);
    if start.turning.crank < 0.0 {
        kinks = kinks.iter().rev().map(|kink| plan.cycle() - kink).collect();
    }
    let speed_scale = q[plan.drive.speed_start].max(start.omega);
    let turning = start.turning;
    let mut follower = Equation {
        machine,
        law_kinks: plan.speed_kinks(),
        motion,
        geometry: Vec::new(),
        speed_scale,
        turning,
        evaluations: 0,
        curves,
        steep: Vec::new(),
    };
    follower.find_steep_laws();
    let mut path = Path::new(plan, q, start, kinks);
    path.run(&mut follower);
    path.finish(&mut follower)
}

struct Path {
    trajectory: Trajectory,
    kinks: Vec<f64>,
    /// Angle after which the kinks come again.
    cycle: f64,
    speeds: Vec<f64>,
    last_angle: f64,
    last_time: f64,
    accuracy: f64,
    speed_scale: f64,
}

/// A step that was accepted, in one piece or two, and whether it ended at standstill.
struct AcceptedStep {
    pieces: Vec<Piece>,
    /// Length to try next.
    next: f64,
    at_rest: bool,
    /// Whether it came to a jump that holds the motion.
    is_held: bool,
}

/// A step that passes a jump of a law.
#[derive(Clone, Copy, Debug)]
struct Passing {
    /// The length that it may have instead, if it may not be so long.
    shorter: Option<f64>,
    /// Whether the jump holds the motion.
    holds: bool,
}

/// A step that passes a jump has at least this share of the time so far, which would not change otherwise.
const LEAST_PASSING: f64 = 1e-14;

/// What an explicit step may have of h ∂ε/∂ω: DOP853 is stable up to about 6, and its error grows large before.
const STABLE: f64 = 4.0;

/// What an implicit step must have of it at least. An explicit step at the limit of its stability leaves a disturbance, for which
/// the first implicit steps must be as short; they are to go on until it has died, or the two methods take turns without end.
const STIFF: f64 = 1.0;

/// Steps after which it is looked again which method is to go on: a look costs one evaluation, a step 17.
const LOOK: usize = 8;

impl Path {
    fn new(plan: &Plan, q: &[f64], start: &Start, kinks: Vec<f64>) -> Self {
        let first = start.turning.crank * start.phi;
        let trajectory = Trajectory {
            t: vec![0.0],
            phi: vec![first],
            omega: vec![start.omega],
            epsilon: Vec::new(),
            between: Vec::new(),
            implicit: Vec::new(),
            end: End::Time,
            drive_torque: f64::NAN,
            load_torque: f64::NAN,
            evaluations: 0,
        };
        Path {
            trajectory,
            kinks,
            speeds: plan.drive.kinks_turning(&plan.tables, q, start.turning.with_motor()),
            cycle: plan.cycle(),
            last_angle: first + start.turns * TAU,
            last_time: start.duration,
            accuracy: start.accuracy,
            speed_scale: q[plan.drive.speed_start].max(start.omega),
        }
    }

    fn now(&self) -> (f64, Y) {
        let path = &self.trajectory;
        let last = path.t.len() - 1;
        (path.t[last], [path.phi[last], path.omega[last]])
    }

    fn run(&mut self, follower: &mut Equation<'_>) {
        let (_, y) = self.now();
        if y[1] <= AT_REST * self.speed_scale {
            self.trajectory.omega[0] = 0.0;
            let way = follower.balance_at_rest(0.0, y[0]).2;
            if way != 1 {
                self.trajectory.end = if way == 0 { End::DoesNotStart } else { End::StartsBackwards };
                return;
            }
        }
        // A hundredth of a radian at working speed: small against any feature, soon grown tenfold.
        let mut h = 0.01 / self.speed_scale;
        let (_, y) = self.now();
        let mut k0 = follower.derivative(0.0, &y);
        let mut is_stiff = false;
        for count in 0..STEPS_MAX {
            poll();
            self.trajectory.epsilon.push(k0[1]);
            let (t, y) = self.now();
            if let Some(end) = self.is_over(t, &y, &k0) {
                self.trajectory.end = end;
                return;
            }
            if count % LOOK == 0 {
                let limit = if is_stiff { STIFF } else { STABLE };
                is_stiff = follower.acceleration(t, &y).1 * h < -limit;
            }
            let step = match self.step(follower, (t, &y, &k0), h, is_stiff) {
                Ok(step) => step,
                Err(end) => {
                    let slides = end == End::Inaccurate && follower.slides(t, &y);
                    self.trajectory.end = if slides { End::Slides } else { end };
                    return;
                }
            };
            h = step.next;
            if step.is_held || (h * y[1] < SHORT && follower.slides(t, &y)) {
                self.trajectory.end = End::Slides;
                return;
            }
            k0 = self.keep(&step.pieces, is_stiff);
            if step.at_rest {
                let (t, y) = self.now();
                self.trajectory.epsilon.push(k0[1]);
                if self.stays_at_rest(follower, t, y[0]) {
                    return;
                }
                self.trajectory.epsilon.pop();
            }
        }
        self.trajectory.end = End::Inaccurate;
    }

    /// Adds a step to the motion but for the acceleration at its end; the derivative there.
    fn keep(&mut self, pieces: &[Piece], is_stiff: bool) -> Y {
        let (mut t, path) = (self.now().0, &mut self.trajectory);
        for (k, piece) in pieces.iter().enumerate() {
            t += piece.h;
            let left = self.last_time - t;
            if left.is_finite() && left.abs() <= ROUNDING_OF_TIME * self.last_time {
                t = self.last_time;
            }
            path.t.push(t);
            path.phi.push(piece.y[0]);
            path.omega.push(piece.y[1]);
            path.between.push(piece.between);
            path.implicit.push(is_stiff);
            if k + 1 < pieces.len() {
                path.epsilon.push(piece.rate[1]);
            }
        }
        pieces[pieces.len() - 1].rate
    }

    fn is_over(&self, t: f64, y: &Y, k0: &Y) -> Option<End> {
        if !k0[1].is_finite() {
            Some(End::DoesNotClose)
        } else if t >= self.last_time {
            Some(End::Time)
        } else if y[0] >= self.last_angle - LANDING {
            Some(End::Turns)
        } else {
            None
        }
    }

    /// At standstill on the way: ends the motion unless the drive takes it on.
    fn stays_at_rest(&mut self, follower: &mut Equation<'_>, t: f64, phi: f64) -> bool {
        let way = follower.balance_at_rest(t, phi).2;
        if way < 1 {
            self.trajectory.end = if way < 0 { End::Reversal } else { End::Stall };
        }
        way < 1
    }

    /// The next accepted step from `from`, of length at most `longest`; or why none is.
    fn step(
        &self,
        follower: &mut Equation<'_>,
        from: (f64, &Y, &Y),
        longest: f64,
        is_stiff: bool,
    ) -> Result<AcceptedStep, End> {
        let (t, y, _) = from;
        if is_stiff {
            self.step_by(&mut StiffAttempt::new(follower, (t, y), self.accuracy), from, longest)
        } else {
            self.step_by(&mut ExplicitAttempt::new(follower, from, self.accuracy), from, longest)
        }
    }

    /// The next step by either method; none where it errs too much, or the machine has no acceleration however near.
    fn step_by(
        &self,
        attempt: &mut impl Attempts,
        (t, y, k0): (f64, &Y, &Y),
        mut longest: f64,
    ) -> Result<AcceptedStep, End> {
        let target = self.next_angle(y[0]);
        let rest = self.last_time - t;
        let landing = time_to(target - y[0], y[1], k0[1]);
        let order = attempt.order();
        let mut growth_max = f64::INFINITY;
        let mut reason = End::Inaccurate;
        // Forty reductions by a tenth to nine tenths reach any length that still changes t.
        for _ in 0..40 {
            let mut h = longest.min(rest).min(landing);
            let mut trial = attempt.to(h);
            if trial.error.is_nan() || trial.error > 1.0 {
                (longest, growth_max) = (h * next_factor_of(trial.error, order).min(0.9), 1.0);
                reason = End::of_error(trial.error);
                continue;
            }
            let tried = h;
            if trial.y[0] > target || h == landing {
                let is_last = target == self.last_angle;
                let near = if is_last { LANDING } else { NEAR * self.accuracy.sqrt() };
                (trial, h) = land(attempt, trial, h, (target, near));
            }
            let event = self.first_speed_event(attempt, y[1]);
            let mut end = trial.y;
            if let Some((at, speed)) = event {
                (h, end) = (at, [attempt.to(at).y[0], speed]);
            }
            let on_the_way = attempt.fill(h, &end);
            if on_the_way.is_nan() || on_the_way > 1.0 {
                (longest, growth_max) = (h * next_factor_of(on_the_way, order).min(0.9), 1.0);
                reason = End::of_error(on_the_way);
                continue;
            }
            let pieces = attempt.pieces();
            if let Some(share) = self.passed_inside(y[1], &pieces) {
                longest = h * share;
                continue;
            }
            if let Some(turn) = self.touches(attempt, (t, y), &pieces) {
                longest = turn;
                continue;
            }
            let passing = self.passing(attempt, (t, y), (h, &end));
            if let Some(Passing { shorter: Some(shorter), .. }) = passing {
                longest = shorter;
                continue;
            }
            if let Some(share) = attempt.first_unseen((t, y), &pieces) {
                longest = h * share;
                continue;
            }
            // A step cut short by an event says nothing about the length that the next may have.
            let grown = tried * next_factor_of(trial.error.max(on_the_way), order).min(growth_max);
            let next = if tried < longest { grown.max(longest) } else { grown };
            let at_rest = event.is_some() && end[1] == 0.0;
            let is_held = passing.is_some_and(|passing| passing.holds);
            return Ok(AcceptedStep { pieces, next, at_rest, is_held });
        }
        Err(reason)
    }

    /// The length at which to cut a step that passes a kink of a law and comes back inside: where it is beyond, by more than
    /// the speed may err.
    fn touches(&self, attempt: &mut impl Attempts, (t, y): (f64, &Y), pieces: &[Piece]) -> Option<f64> {
        let kinks = attempt.at_law_kinks(t, y).len();
        if kinks == 0 {
            return None;
        }
        let whole: f64 = pieces.iter().map(|piece| piece.h).sum();
        let looks = AT.map(|share| attempt.at_law_kinks(t + share * whole, &state(y, pieces, share * whole)));
        for nth in 0..kinks {
            let values = std::array::from_fn(|i| looks[i][nth]);
            let ends = [values[0], values[N - 1]];
            for share in turns_near_zero(&values).into_iter().filter(|_| ends[0] * ends[1] > 0.0) {
                // A step that ends beyond a jump would see it, and be driven back before it counts as beyond.
                let (at, there) = (t + share * whole, state(y, pieces, share * whole));
                let beyond = attempt.at_law_kinks(at, &there)[nth];
                let faster = attempt.at_law_kinks(at, &[there[0], there[1] * (1.0 + self.accuracy)])[nth];
                if beyond * ends[0] < 0.0 && beyond.abs() > (faster - beyond).abs() {
                    return Some(share * whole);
                }
            }
        }
        None
    }

    /// How a step passes a jump of a law, if it does. An implicit step does not see what jumps before its first stage, and an
    /// explicit one sees it too well: a step passes a jump only where it is so short that the jump does not count.
    fn passing(
        &self,
        attempt: &mut impl Attempts,
        (t, y): (f64, &Y),
        (h, end): (f64, &Y),
    ) -> Option<Passing> {
        let (before, behind) = (attempt.at_law_kinks(t, y), attempt.at_law_kinks(t + h, end));
        let mut found: Option<Passing> = None;
        for nth in (0..before.len()).filter(|&nth| before[nth] * behind[nth] < 0.0) {
            let excess = |x: f64| {
                let there = attempt.to(x).y;
                attempt.at_law_kinks(t + x, &there)[nth]
            };
            let at = crossing(excess, h, before[nth], behind[nth]);
            let there = attempt.to(at).y;
            let Jump { leap, holds } = attempt.jump(nth, t + at, &there);
            let allowed = self.accuracy * (there[1] + aside_of(self.speed_scale)) / leap.abs();
            let allowed = allowed.max(LEAST_PASSING * t);
            let beside = if at > 0.5 * allowed { at - 0.25 * allowed } else { allowed };
            let shorter = (h > allowed).then_some(beside);
            let least = found.and_then(|passing| passing.shorter).unwrap_or(f64::INFINITY);
            if found.is_none() || shorter.is_some_and(|shorter| shorter < least) {
                found = Some(Passing { shorter, holds });
            }
        }
        found
    }

    /// The next angle at which a step must end.
    fn next_angle(&self, phi: f64) -> f64 {
        let turn = (phi / self.cycle).floor() * self.cycle;
        let passed = phi + 10.0 * NEAR * self.accuracy.sqrt();
        let after = |base: f64| self.kinks.iter().map(move |kink| base + kink).find(|&angle| angle > passed);
        let kink = after(turn).or_else(|| after(turn + self.cycle)).unwrap_or(f64::INFINITY);
        kink.min(self.last_angle)
    }

    /// The earliest time in the step tried last at which the speed passes a kink of the drive or zero, and that speed.
    fn first_speed_event(&self, attempt: &mut impl Attempts, omega: f64) -> Option<(f64, f64)> {
        let (mut from, mut left) = (0.0, omega);
        for (to, right) in attempt.speeds() {
            let is_past = |speed: f64| {
                // A step that starts on the speed itself, to rounding, is not passing it.
                let apart = (left - speed).abs() > AT_REST * self.speed_scale;
                apart && (left - speed) * (right - speed) < 0.0
            };
            let passed = self.speeds.iter().copied().chain([0.0]).filter(|&speed| is_past(speed));
            // On its way to the other end the speed passes first what lies next to it.
            if let Some(speed) = passed.min_by(|a, b| (left - a).abs().total_cmp(&(left - b).abs())) {
                let excess = |x: f64| attempt.to(from + x).y[1] - speed;
                return Some((from + crossing(excess, to - from, left - speed, right - speed), speed));
            }
            (from, left) = (to, right);
        }
        None
    }

    /// The share of the step at which to cut it, where its speed passes a kink of the drive or zero and comes back.
    fn passed_inside(&self, omega: f64, pieces: &[Piece]) -> Option<f64> {
        let whole: f64 = pieces.iter().map(|piece| piece.h).sum();
        let (mut from, mut start) = (0.0, omega);
        for piece in pieces {
            let kinks = self.speeds.iter().copied().chain([0.0]);
            let speed = Bernstein::new(start, &piece.between[1]);
            if let Some(share) = passed_and_back(&speed, kinks, AT_REST * self.speed_scale) {
                return Some((from + share * piece.h) / whole);
            }
            (from, start) = (from + piece.h, piece.y[1]);
        }
        None
    }

    fn finish(mut self, follower: &mut Equation<'_>) -> Trajectory {
        let (t, y) = self.now();
        let path = &mut self.trajectory;
        if path.epsilon.len() < path.t.len() {
            path.epsilon.push(follower.derivative(t, &y)[1]);
        }
        (path.drive_torque, path.load_torque, _) = follower.balance_at_rest(t, y[0]);
        path.evaluations = follower.evaluations;
        path.count_counter_clockwise(follower.turning.crank);
        self.trajectory
    }
}

impl Equation<'_> {
    /// Whether the motion is held on a jump of a law near here.
    fn slides(&mut self, t: f64, y: &Y) -> bool {
        (0..self.law_kinks.len()).any(|nth| {
            let mut there = *y;
            for _ in 0..LEVEL_SWEEPS {
                let near = [there[0], there[1] * (1.0 + NEAR_JUMP)];
                let (value, beside) = (self.at_law_kinks(t, &there)[nth], self.at_law_kinks(t, &near)[nth]);
                there[1] -= value * NEAR_JUMP * there[1] / (beside - value);
            }
            let is_near = there[1] > 0.0 && (there[1] / y[1] - 1.0).abs() <= NEAR_JUMP;
            is_near && self.jump(nth, t, &there).holds
        })
    }
}

/// Time to turn by `angle` at speed ω and acceleration ε; infinite if it is not reached.
fn time_to(angle: f64, omega: f64, epsilon: f64) -> f64 {
    let root = omega * omega + 2.0 * epsilon * angle;
    if root < 0.0 {
        return f64::INFINITY;
    }
    let speed = omega + root.sqrt();
    if speed > 0.0 { 2.0 * angle / speed } else { f64::INFINITY }
}

/// Newton on the length of the step until it ends on the target angle.
fn land(
    attempt: &mut impl Attempts,
    mut trial: Trial<2>,
    mut h: f64,
    (target, near): (f64, f64),
) -> (Trial<2>, f64) {
    for _ in 0..6 {
        let miss = target - trial.y[0];
        if miss.abs() <= near || trial.y[1] <= 0.0 {
            break;
        }
        h += miss / trial.y[1];
        trial = attempt.to(h);
    }
    (trial, h)
}
