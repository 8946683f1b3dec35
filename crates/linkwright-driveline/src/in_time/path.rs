//! Steps of a motion, one after another, and what ends them.

use super::attempt::Attempt;
use super::events::{Event, Events};
use super::mounted::{Mounted, Tables};
use super::start::Start;
use super::system::System;
use super::trajectory::{End, Trajectory};
use crate::equation::Equation;
use linkwright_core::drive::mesh::crossing;
use linkwright_kernel::call::poll;
use linkwright_kernel::rk::next_factor_of;
use serde::{Deserialize, Serialize};

/// Steps after which a motion is given up.
const STEPS_MAX: usize = 400_000;

/// Steps after which it is looked again which method is to go on.
const LOOK: usize = 8;

/// Shares of a step at which it is looked for events.
const LOOKS: usize = 8;

/// Times that a step is made shorter.
const ATTEMPTS: usize = 60;

/// Events in a row without a step between them.
const AT_ONCE: usize = 32;

/// A step on the way to a kink is at most so many times as long as it takes to come there at this acceleration.
const BEYOND: f64 = 1.1;

/// A step that errs too much where it passes a kink is tried again until a little behind it.
const PAST: f64 = 1.02;

/// Share of its largest value below which a twist is only as exact as that, and share of the working speed for speeds.
const SMALL: f64 = 0.01;

/// Twists \[rad\] that count as none.
const NO_TWIST: f64 = 1e-9;

/// Speeds as a share of the working speed, and torques as a share of the largest, that count as none at rest.
const AT_REST: f64 = 1e-6;

/// Shares by which a quantity may miss zero and be there: angles \[rad\], speeds over the working speed, torques over the largest.
const THERE: f64 = 1e-13;

/// Distance of the speed from a jump of a law, as a share, at which its two sides are looked at.
const ASIDE: f64 = 1e-6;

/// A step that passes a jump has at least this share of the time so far, which would not change otherwise.
const LEAST_PASSING: f64 = 1e-14;

/// Share of the time by which the last step may fall short of it.
const ROUNDING_OF_TIME: f64 = 4.0 * f64::EPSILON;

/// Follows the motion until the time, the revolutions or rest end it.
pub fn follow(equation: Equation<'_>, start: &Start) -> Trajectory {
    Continuation::new(equation, start.accuracy).follow(equation, start)
}

/// What the solver knows of a motion at the end of an interval: with it the next one goes on as if there were no end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Length of the next step \[s\].
    h: f64,
    is_stiff: bool,
    /// Largest twist against the crank so far, of every mass.
    twists: Vec<f64>,
    /// Largest torque so far \[N m\].
    torque: f64,
    /// Largest work so far \[J\].
    work: f64,
}

/// What is kept from one interval of a motion to the next, as another program asks for them one by one.
pub struct Continuation {
    tables: Vec<Tables>,
    /// None before the first interval.
    pub pace: Option<Pace>,
}

impl Continuation {
    /// Of a machine with its numbers, before its motion.
    pub fn new(equation: Equation<'_>, accuracy: f64) -> Self {
        Continuation { tables: Tables::all(equation, accuracy), pace: None }
    }

    /// Something done with the machine as it starts, of which the tables are known.
    pub fn at<'a, T>(
        &mut self,
        equation: Equation<'a>,
        start: &Start,
        work: impl FnOnce(&mut System<'a>) -> T,
    ) -> T {
        let tables = std::mem::take(&mut self.tables);
        let mut system = System::with(equation, start, tables);
        let found = work(&mut system);
        self.tables = system.mounted.into_iter().map(Mounted::into_tables).collect();
        found
    }

    /// Follows the motion of an interval until the time, the revolutions or rest end it.
    pub fn follow(&mut self, equation: Equation<'_>, start: &Start) -> Trajectory {
        let pace = self.pace.take();
        let (trajectory, pace) = self.at(equation, start, |system| follow_on(system, start, pace));
        self.pace = Some(pace);
        trajectory
    }
}

fn follow_on(system: &mut System<'_>, start: &Start, pace: Option<Pace>) -> (Trajectory, Pace) {
    let mut y = vec![0.0; system.layout.size];
    y[..start.state.len()].copy_from_slice(&start.state);
    set_senses(system, start.time, &y);
    let events = Events::new(system, start.time, &y, start.turns);
    let mut path = Path::new(start, system, y, events, pace);
    path.trajectory.end = path.run(system);
    let pace = path.pace.clone();
    (path.finish(system), pace)
}

/// Directions of a state: those of speeds, and at rest what the torques do.
pub(super) fn set_senses(system: &mut System<'_>, t: f64, y: &[f64]) {
    for mass in system.holding() {
        let speed = system.speed(mass, y);
        let is_moving = speed.abs() > system.slow;
        let sense = if is_moving { speed.signum() } else { system.way_from_rest(t, y, mass) };
        system.senses[mass] = sense;
    }
}

/// A motion as far as it has been followed.
struct Path<'s> {
    start: &'s Start,
    trajectory: Trajectory,
    events: Events,
    y: Vec<f64>,
    t: f64,
    pace: Pace,
}

/// A step that was tried.
enum Tried {
    /// It keeps the accuracy; length to try next, and the event at its end.
    Accepted { h: f64, end: Vec<f64>, next: f64, event: Option<usize> },
    /// An event happens before anything moves.
    AtOnce(usize),
    /// None is short enough.
    Failed(End),
}

impl<'s> Path<'s> {
    /// At its start.
    fn new(start: &'s Start, system: &System<'_>, y: Vec<f64>, events: Events, pace: Option<Pace>) -> Self {
        let trajectory = Trajectory {
            t: vec![start.time],
            states: y.clone(),
            between: Vec::new(),
            senses: Vec::new(),
            intervals: Vec::new(),
            zones: Vec::new(),
            implicit: 0,
            events: Vec::new(),
            end: End::Time,
            torques: [f64::NAN; 2],
            evaluations: 0,
        };
        let twists = y[..system.layout.others].iter().map(|twist| twist.abs().max(NO_TWIST)).collect();
        let first = Pace { h: 0.01 / start.speed, is_stiff: false, twists, torque: 0.0, work: 0.0 };
        Path { start, trajectory, events, y, t: start.time, pace: pace.unwrap_or(first) }
    }

    /// Follows the motion to its end.
    fn run(&mut self, system: &mut System<'_>) -> End {
        let mut at_once = 0;
        let mut attempt = Attempt::new(system, &self.y);
        attempt.is_stiff = self.pace.is_stiff;
        for count in 0..STEPS_MAX {
            poll();
            if self.t >= self.start.until {
                return End::Time;
            }
            if !attempt.begin(system, self.t, &self.y) {
                return End::DoesNotClose;
            }
            self.note_sizes(system);
            if self.is_at_rest(system) {
                return End::Rest;
            }
            if count % LOOK == 0 {
                attempt.choose(system, self.t, &self.y, self.pace.h);
                self.pace.is_stiff = attempt.is_stiff;
            }
            match self.step(system, &mut attempt, self.pace.h) {
                Tried::Failed(end) => return end,
                Tried::AtOnce(nth) => {
                    at_once += 1;
                    if at_once > AT_ONCE {
                        return End::Inaccurate;
                    }
                    if self.happens(system, nth) {
                        return End::Turns;
                    }
                }
                Tried::Accepted { h: length, end, next, event } => {
                    (self.pace.h, at_once) = (next, 0);
                    self.keep(system, &attempt, length, end);
                    if event.is_some_and(|nth| self.happens(system, nth)) {
                        return End::Turns;
                    }
                }
            }
        }
        End::Inaccurate
    }

    /// Takes an event into account; whether it ends the motion.
    fn happens(&mut self, system: &mut System<'_>, nth: usize) -> bool {
        let event = self.events.list[nth];
        self.events.happen(system, nth, self.t, &mut self.y);
        let (size, last) = (system.layout.size, self.trajectory.t.len() - 1);
        self.trajectory.states[last * size..].copy_from_slice(&self.y);
        self.trajectory.events.push((last, event));
        matches!(event, Event::Last(_))
    }

    /// Adds a step to the motion.
    fn keep(&mut self, system: &System<'_>, attempt: &Attempt, h: f64, end: Vec<f64>) {
        self.t += h;
        let left = self.start.until - self.t;
        if left.is_finite() && left.abs() <= ROUNDING_OF_TIME * self.start.until {
            self.t = self.start.until;
        }
        self.trajectory.t.push(self.t);
        self.trajectory.states.extend_from_slice(&end);
        self.trajectory.between.extend_from_slice(&attempt.between);
        self.trajectory.implicit += usize::from(attempt.is_stiff);
        self.trajectory.senses.extend_from_slice(&system.senses);
        self.trajectory.intervals.extend(system.mounted.iter().map(|one| one.between));
        self.trajectory.zones.extend_from_slice(&system.zones);
        self.y = end;
    }

    /// Remembers how large twists, torques and works have been, of the state whose rates were computed last.
    fn note_sizes(&mut self, system: &System<'_>) {
        for (largest, y) in self.pace.twists.iter_mut().zip(&self.y) {
            *largest = largest.max(y.abs());
        }
        let chain = system.equation.chain;
        let torques = chain.links.iter().map(|link| chain.torque(link, &self.y).value.abs());
        let drives = system.drives.iter().fold(self.pace.torque, |most, drive| most.max(drive.abs()));
        self.pace.torque = torques.fold(drives, f64::max);
        self.pace.work =
            self.y[system.layout.shaft..].iter().fold(self.pace.work, |most, work| most.max(work.abs()));
    }

    /// Whether nothing moves, and nothing will.
    fn is_at_rest(&self, system: &System<'_>) -> bool {
        let rests = |mass: usize| {
            let is_slow = system.speed(mass, &self.y).abs() <= AT_REST * self.start.speed;
            system.senses[mass] == 0.0 || (is_slow && system.net[mass].abs() <= AT_REST * self.pace.torque)
        };
        !system.mounted.iter().any(Mounted::knows_time) && (0..=system.crank()).all(rests)
    }

    /// Error that each number of the state may have: one part for all its sizes, and one in proportion to its size.
    fn tolerances(&self, system: &System<'_>) -> Vec<[f64; 2]> {
        let (layout, speed) = (system.layout, self.start.speed);
        let work = self.pace.work.max(system.inertia[system.crank()] * (SMALL * speed).powi(2));
        let of = |n: usize| match n {
            n if n < layout.others => [SMALL * self.pace.twists[n], 1.0],
            n if n <= layout.omega => [SMALL * speed, 1.0],
            n if n == layout.phi => [1.0, 0.0],
            _ => [work, 0.0],
        };
        (0..layout.size).map(of).map(|part| part.map(|part| part * self.start.accuracy)).collect()
    }

    /// The next step, at most of a length.
    fn step(&mut self, system: &mut System<'_>, attempt: &mut Attempt, longest: f64) -> Tried {
        let (t, y) = (self.t, self.y.clone());
        let landing = self.landing(system, attempt.rate());
        let tolerances = self.tolerances(system);
        let order = attempt.order();
        let mut limit = longest;
        let (mut growth_max, mut reason) = (f64::INFINITY, End::Inaccurate);
        let (mut end, mut cut) = (y.clone(), false);
        let mut wanted: Option<(f64, Option<usize>)> = None;
        for _ in 0..ATTEMPTS {
            let h = match wanted {
                Some((h, _)) => h,
                None => limit.min(landing).min(self.start.until - t),
            };
            let error = attempt.to(system, &tolerances, (t, &y), h, &mut end);
            if error.is_nan() || error > 1.0 {
                (limit, growth_max) = (h * next_factor_of(error, order).min(0.9), 1.0);
                // What lies behind a kink is as another machine: that may be all that is wrong with the step.
                if let Some(at) =
                    self.kink_within(system, (t, &y), h, &end).filter(|_| wanted.is_none() && !cut)
                {
                    (limit, cut) = (limit.max(PAST * at), true);
                }
                wanted = None;
                reason = if error.is_nan() { End::DoesNotClose } else { End::Inaccurate };
                continue;
            }
            if let Some((_, event)) = wanted {
                let next = if event.is_some() { limit.max(longest) } else { limit.max(h) };
                return Tried::Accepted { h, end, next, event };
            }
            let grown = h * next_factor_of(error, order).min(growth_max);
            let next = if h < limit { grown.max(limit) } else { grown };
            match self.first_event(system, attempt, (t, &y), h) {
                None => return Tried::Accepted { h, end, next, event: None },
                Some((nth, share)) if share * h <= f64::EPSILON * t.abs().max(h) => {
                    return Tried::AtOnce(nth);
                }
                Some((nth, share)) => {
                    let at = share * h;
                    limit = next.min(longest.max(h));
                    wanted = Some(match self.events.list[nth] {
                        Event::Law(law) => self.passing(system, attempt, (t, &y), (h, at), (law, nth)),
                        _ => (at, Some(nth)),
                    });
                }
            }
        }
        Tried::Failed(reason)
    }

    /// Time in which a crank comes to a kink of its mechanism, or to where the motion ends, at this acceleration, and a little more.
    fn landing(&self, system: &System<'_>, rate: &[f64]) -> f64 {
        let (layout, y) = (system.layout, &self.y);
        let mut soonest = f64::INFINITY;
        let mut look = |angle: f64, omega: f64, epsilon: f64| {
            let time = BEYOND * time_to(angle.max(0.0), omega, epsilon);
            soonest = if time > 0.0 { soonest.min(time) } else { soonest };
        };
        for way in [1.0, -1.0] {
            let [omega, epsilon] = [y[layout.omega], rate[layout.omega]].map(|rate| way * rate);
            look(way * (self.events.last(way) - y[layout.phi]), omega, epsilon);
            for (place, one) in system.mounted.iter().enumerate() {
                let to = one.between[usize::from(way > 0.0)] - system.angle(place, y);
                let [speed, acceleration] = [system.speed(one.mass, y), system.speed(one.mass, rate)];
                look(way * to, way * one.ratio * speed, way * one.ratio * acceleration);
            }
        }
        soonest
    }

    /// Time at which the first kink over a speed is passed in a step that errs too much, about: by start, rate and end.
    fn kink_within(
        &self,
        system: &mut System<'_>,
        (t, y): (f64, &[f64]),
        h: f64,
        end: &[f64],
    ) -> Option<f64> {
        system.act(t, y);
        let found = self.events.list.iter().enumerate().filter_map(|(nth, &event)| {
            let (Event::Speed(mass, _) | Event::Rest(mass)) = event else { return None };
            let side = self.events.side(system, nth);
            let at = if let Event::Speed(_, at) = event { at } else { 0.0 };
            let [from, to] = [y, end].map(|y| system.speed(mass, y) - at);
            (from * side > 0.0 && to * side < 0.0).then(|| {
                let slope = system.acceleration(mass) * h;
                // from + slope s + (to − from − slope) s² is zero between 0 and 1, by the root that never cancels.
                let (a, b) = (to - from - slope, slope);
                let root = (b * b - 4.0 * a * from).max(0.0).sqrt();
                let share = 2.0 * from / (-b + root.copysign(from));
                h * share.clamp(0.0, 1.0)
            })
        });
        found.reduce(f64::min)
    }

    /// The first event in the step tried last, and the share of the step at which it happens.
    fn first_event(
        &mut self,
        system: &mut System<'_>,
        attempt: &Attempt,
        (t, y): (f64, &[f64]),
        h: f64,
    ) -> Option<(usize, f64)> {
        let mut there = y.to_vec();
        let mut before = vec![0.0; self.events.list.len()];
        self.values(system, (t, y), &mut before);
        let mut values = before.clone();
        for look in 1..=LOOKS {
            let share = look as f64 / LOOKS as f64;
            attempt.state(share, y, &mut there);
            self.values(system, (t + share * h, &there), &mut values);
            let mut first: Option<(usize, f64)> = None;
            for nth in 0..values.len() {
                let side = self.events.side(system, nth);
                if side == 0.0 {
                    self.events.start_on(nth, values[nth]);
                    continue;
                }
                if values[nth] * side >= 0.0 || values[nth].abs() <= self.near(system, nth) {
                    continue;
                }
                let low = (look - 1) as f64 / LOOKS as f64;
                let at = if before[nth] * side <= 0.0 {
                    low
                } else {
                    let mut value = |x: f64| {
                        attempt.state(low + x, y, &mut there);
                        let at = (t + (low + x) * h, &there[..]);
                        let laws = self.laws(system, nth, at);
                        self.events.value(system, &laws, at, self.events.list[nth])
                    };
                    low + crossing(&mut value, share - low, before[nth], values[nth])
                };
                if first.is_none_or(|(_, earliest)| at < earliest) {
                    first = Some((nth, at));
                }
            }
            if first.is_some() {
                return first;
            }
            before.copy_from_slice(&values);
        }
        None
    }

    /// Quantities of all events that may happen.
    fn values(&self, system: &mut System<'_>, at: (f64, &[f64]), to: &mut [f64]) {
        let laws = system.at_law_kinks(at.0, at.1);
        for (nth, to) in to.iter_mut().enumerate() {
            let event = self.events.list[nth];
            let is_still = matches!(event, Event::Slip(..)) && self.events.side(system, nth) == 0.0;
            *to = if is_still { 0.0 } else { self.events.value(system, &laws, at, event) };
        }
    }

    /// Kinks of laws, if the event is one.
    fn laws(&self, system: &mut System<'_>, nth: usize, (t, y): (f64, &[f64])) -> Vec<f64> {
        if matches!(self.events.list[nth], Event::Law(_)) { system.at_law_kinks(t, y) } else { Vec::new() }
    }

    /// What a quantity may miss zero by.
    fn near(&self, system: &System<'_>, nth: usize) -> f64 {
        match self.events.list[nth] {
            Event::Kink(place, _) => THERE * (1.0 + system.angle(place, &self.y).abs()),
            Event::Last(_) => THERE * (1.0 + self.y[system.layout.phi].abs()),
            Event::Bound(link, way) => THERE * system.bounds(link)[usize::from(way > 0.0)].abs(),
            Event::Speed(..) | Event::Rest(_) => THERE * self.start.speed,
            Event::Slip(..) | Event::Limit(..) => THERE * self.pace.torque,
            Event::Law(_) => 0.0,
        }
    }

    /// Length of a step that meets a kink of a law: it passes a jump only where it is so short that the jump does not count.
    fn passing(
        &self,
        system: &mut System<'_>,
        attempt: &Attempt,
        (t, y): (f64, &[f64]),
        (h, at): (f64, f64),
        (law, nth): (usize, usize),
    ) -> (f64, Option<usize>) {
        let mut there = y.to_vec();
        attempt.state(at / h, y, &mut there);
        let omega = system.layout.omega;
        let by_speed = ASIDE * self.start.speed;
        let by_time = ASIDE / self.start.speed;
        let mut side = |sign: f64| {
            let mut aside = there.clone();
            aside[omega] += sign * by_speed;
            let value = system.at_law_kinks(t + at + sign * by_time, &aside)[law];
            system.act(t + at + sign * by_time, &aside);
            let all: Vec<f64> = (0..=system.crank()).map(|mass| system.acceleration(mass)).collect();
            (value, all)
        };
        let (ahead, behind) = (side(1.0).1, side(-1.0).1);
        let leap = ahead.iter().zip(&behind).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let allowed = self.start.accuracy * (there[omega].abs() + SMALL * self.start.speed) / leap;
        let allowed = allowed.max(LEAST_PASSING * t);
        if h <= allowed || at + 0.5 * allowed >= h {
            (h.min(at + 0.5 * allowed), Some(nth))
        } else if at > 0.5 * allowed {
            (at - 0.25 * allowed, None)
        } else {
            (at + 0.5 * allowed, Some(nth))
        }
    }

    /// The motion, with what acts at its end.
    fn finish(mut self, system: &mut System<'_>) -> Trajectory {
        system.senses.fill(self.start.motor);
        system.act(self.t, &self.y);
        self.trajectory.torques = [system.drives.iter().sum(), system.load];
        self.trajectory.evaluations = system.evaluations;
        self.trajectory
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
