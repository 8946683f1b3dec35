//! The motion from mark to mark: where something outside switches, a step ends, and the next begins.

use super::equilibrium::Equilibrium;
use super::explicit::{Explicit, STABLE_PHASE};
use super::extremes::{Extreme, Extremes};
use super::friction::State;
use super::implicit::Implicit;
use super::rates::Rates;
use super::rounding::Rounding;
use super::settle::{Event, is_forced, settle};
use super::stages::Change;
use super::stepper::{Scale, Stepper};
use super::system::System;
use super::watch::{Watch, value as friction_value};
use linkwright_kernel::call::poll;

/// What to follow.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Angles and speeds of the masses at the start.
    pub angle: &'a [f64],
    pub speed: &'a [f64],
    /// Times to sample at, increasing from zero on.
    pub times: &'a [f64],
    /// When the motion begins, zero or before: what swings in until zero is not recorded.
    pub start: f64,
    pub duration: f64,
    /// Relative accuracy of a step, at its end and on the way there.
    pub accuracy: f64,
    pub method: Method,
    pub steps_max: usize,
}

/// Which steps are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Method {
    /// Explicit unless the fastest swing would ask for too many steps, or a torque be lost in the rounding of angles.
    Auto = 0,
    Explicit = 1,
    Implicit = 2,
}

/// How the motion ended; the numbers are what crosses the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum End {
    /// The time is over.
    Time = 0,
    /// More steps would be needed than allowed.
    TooManySteps = 1,
    /// No step keeps the accuracy.
    Inaccurate = 2,
    /// An acceleration is no finite number at the start of a stretch.
    NotFinite = 3,
    /// The torque of a shaft is lost in the rounding of angles.
    Rounded = 4,
    /// No states of the elements with friction and of gear stages agree, or they change without end.
    Unsettled = 5,
}

/// What an element with friction has done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// How often it has come to hold.
    pub engagements: usize,
    /// How long it slid and held \[s\].
    pub slipping: f64,
    pub stuck: f64,
}

/// The motion.
#[derive(Clone, Debug)]
pub struct Course {
    pub end: End,
    /// Time reached \[s\].
    pub time: f64,
    /// Rows over the samples: angle of each mass, its speed, torque of each link, kinetic and potential energy, torque and state
    /// of each element with friction.
    pub samples: Vec<f64>,
    /// Of the torque of each link, then of the speed of each mass, then of the torque of each element with friction and its
    /// power.
    pub extremes: Vec<Extreme>,
    /// Work of each torque, loss in each link, loss at each mass, loss in each element with friction \[J\].
    pub work: Vec<f64>,
    pub tallies: Vec<Tally>,
    /// Kinetic and potential energy at the start and at the end \[J\].
    pub energies: [f64; 4],
    pub method: Method,
    pub steps: usize,
    pub rejected: usize,
    pub evaluations: usize,
    /// Bound of the fastest swing at the start \[rad/s\].
    pub fastest: f64,
}

/// Steps that stability would ask of the explicit method beyond which the implicit one is taken: a second or so of work.
const STIFF: f64 = 200_000.0;

/// Shares of a step at which changes are looked for, where it counts as begun, and share within which they are met.
const LOOKS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const NEAR: f64 = 1e-6;
const MEETS: f64 = 1e-13;

/// Angle of a table over which a step may go, so that none is overlooked: a twelfth of its revolution \[rad\].
const REACH: f64 = 0.5;

/// Fastest swing that implicit steps are asked to follow \[rad/s\]: 1.6 kHz, the twelfth harmonic of ignition in an engine of
/// twelve cylinders at 1300 rpm. What swings faster stands still for them, and says nothing about speeds.
const FOLLOWED: f64 = 1e4;

/// First step as a share of the fastest swing's radian, and of the whole time.
const FIRST: (f64, f64) = (0.1, 1e-3);

/// Share of a step from which on an event is at its end.
const AT_THE_END: f64 = 1.0 - 1e-9;

/// Events that may follow each other without time going on by more than this share of the whole.
const EVENTS_AT_ONCE: (usize, f64) = (100, 1e-12);

/// Follows the motion.
pub fn follow(system: &System, request: &Request<'_>) -> Course {
    let mut rates = Rates::new(system);
    let state = rates.state(request.angle, request.speed);
    rates.enter(request.start);
    rates.derivative(request.start, &state, &mut state.clone());
    if rates.stages.any() {
        rates.set_senses(request.start, &state);
    }
    let fastest = rates.fastest();
    let stiff = (request.duration - request.start) * fastest / STABLE_PHASE > STIFF;
    let auto = request.method == Method::Auto;
    if !(request.method == Method::Implicit || auto && stiff) {
        let stepper = Explicit::new(&rates);
        let follower =
            Follower::new(rates.clone(), state.clone(), request, Method::Explicit, fastest, stepper);
        let course = follower.run();
        if !(auto && course.end == End::Rounded) {
            return course;
        }
    }
    let stepper = Implicit::new(&rates);
    Follower::new(rates, state, request, Method::Implicit, fastest, stepper).run()
}

/// Where a step has to end, as a share of it, and what changes there.
#[derive(Clone, Copy, Debug)]
struct Due {
    share: f64,
    change: Option<Change>,
}

struct Follower<'a, S> {
    request: &'a Request<'a>,
    rates: Rates<'a>,
    stepper: S,
    scale: Scale,
    /// Fastest swing that the steps may have to follow \[rad/s\].
    followed: f64,
    extremes: Extremes,
    equilibrium: Equilibrium,
    /// Whether it tells the torque of a shaft in this step.
    rigid: bool,
    rounding: Rounding,
    watch: Watch,
    /// Events since the time last counted.
    at_once: (usize, f64),
    course: Course,
    state: Vec<f64>,
    end: Vec<f64>,
    sample: Vec<f64>,
    /// Room for the derivative of a sample.
    end_slopes: Vec<f64>,
    next_sample: usize,
}

impl<'a, S: Stepper> Follower<'a, S> {
    fn new(
        rates: Rates<'a>,
        state: Vec<f64>,
        request: &'a Request<'a>,
        method: Method,
        fastest: f64,
        stepper: S,
    ) -> Self {
        let (n, m, f) = (rates.system.len(), rates.system.links.len(), rates.system.frictions.len());
        let [kinetic, potential] = rates.energies(&state);
        let course = Course {
            end: End::Time,
            time: request.start,
            samples: vec![f64::NAN; (2 * n + m + 2 + 2 * f) * request.times.len()],
            extremes: Vec::new(),
            work: vec![0.0; rates.powers.len()],
            tallies: vec![Tally::default(); f],
            energies: [kinetic, potential, 0.0, 0.0],
            method,
            steps: 0,
            rejected: 0,
            evaluations: 0,
            fastest,
        };
        let (accuracy, followed) = match method {
            Method::Implicit => (estimated(request.accuracy), fastest.min(FOLLOWED)),
            _ => (request.accuracy, fastest),
        };
        let scale = Scale::new([accuracy, request.accuracy], &rates, followed);
        let mut scale = if method == Method::Implicit { scale } else { scale.following(&rates) };
        scale.widen(rates.system, &state);
        Follower {
            request,
            stepper,
            scale,
            followed,
            extremes: Extremes::new(&rates),
            equilibrium: Equilibrium::new(rates.system),
            rigid: false,
            rounding: Rounding::new(rates.system),
            watch: Watch::new(&rates, request.accuracy),
            at_once: (0, f64::NEG_INFINITY),
            course,
            end: state.clone(),
            sample: state.clone(),
            end_slopes: state.clone(),
            state,
            rates,
            next_sample: 0,
        }
    }

    fn run(mut self) -> Course {
        for mark in marks(self.rates.system, self.request) {
            if self.course.time == 0.0 {
                self.record();
            }
            self.course.end = self.stretch(mark);
            if self.course.end != End::Time {
                break;
            }
        }
        let follows = self.course.method == Method::Explicit;
        if follows && self.course.end == End::Time && self.is_rounded() {
            self.course.end = End::Rounded;
        }
        let [kinetic, potential] = self.rates.energies(&self.state);
        self.course.energies[2..].copy_from_slice(&[kinetic, potential]);
        self.course.extremes = self.extremes.rows;
        self.course.work = self.rates.in_order(&self.course.work);
        self.course.rejected = self.stepper.rejected();
        self.course.evaluations = self.rates.evaluations;
        self.course
    }

    /// Whether the twist of some shaft does not tell its torque as exactly as asked for.
    fn is_rounded(&self) -> bool {
        let Course { steps, .. } = self.course;
        self.rounding.hides(self.rates.system, steps, self.request.accuracy, &self.extremes.rows)
    }

    /// Begins to record: extremes, work and energy count from here.
    fn record(&mut self) {
        self.extremes = Extremes::new(&self.rates);
        self.course.work.fill(0.0);
        self.course.tallies.fill(Tally::default());
        let [kinetic, potential] = self.rates.energies(&self.state);
        self.course.energies[..2].copy_from_slice(&[kinetic, potential]);
    }

    /// Up to the next mark.
    fn stretch(&mut self, mark: f64) -> End {
        let start = self.course.time;
        self.rates.enter(0.5 * (start + mark));
        // Torques that jump may set free what was stuck.
        if let Some(end) = self.begin(None, self.first(mark)) {
            return end;
        }
        while self.course.time < mark {
            if self.course.steps == self.request.steps_max {
                return End::TooManySteps;
            }
            let before = self.course.time;
            if !self.step(mark) {
                return End::Inaccurate;
            }
            if let Some(event) = self.watch.event.take() {
                let first = match event {
                    Event::Stage(_) => self.first(mark),
                    _ => self.course.time - before,
                };
                if let Some(end) = self.begin(Some(event), first) {
                    return end;
                }
            }
        }
        End::Time
    }

    /// Length of a first step to try, towards a mark.
    fn first(&self, mark: f64) -> f64 {
        (FIRST.0 / self.followed.max(f64::MIN_POSITIVE)).min(FIRST.1 * (mark - self.course.time))
    }

    /// Begins anew at a mark or an event, with a length of step to try first; how the motion ends, if it cannot go on.
    fn begin(&mut self, event: Option<Event>, first: f64) -> Option<End> {
        let (t, rates) = (self.course.time, &mut self.rates);
        if rates.contacts.any() || rates.stages.any() {
            rates.derivative(t, &self.state, &mut self.sample);
            self.watch.widen(rates);
            let small = self.watch.small();
            let before = rates.contacts.states.clone();
            let forced = rates.system.frictions.iter().any(|friction| is_forced(rates, friction, small));
            if forced || !settle(rates, t, &mut self.state, small, event) || self.is_stalled() {
                return Some(End::Unsettled);
            }
            for ((tally, before), now) in
                self.course.tallies.iter_mut().zip(before).zip(&self.rates.contacts.states)
            {
                let sticks = before != State::Stuck && *now == State::Stuck;
                tally.engagements += usize::from(sticks && event.is_some());
            }
        }
        self.stepper.begin(&mut self.rates, t, &self.state, first);
        if !self.rates.acceleration.iter().all(|a| a.is_finite()) {
            return Some(End::NotFinite);
        }
        self.watch.begin(&mut self.rates);
        self.extremes.begin(&self.rates);
        None
    }

    /// Counts an event; whether events follow each other without end.
    fn is_stalled(&mut self) -> bool {
        let (events, since) = self.at_once;
        let shortest = EVENTS_AT_ONCE.1 * (self.request.duration - self.request.start);
        let moves = self.course.time > since + shortest;
        self.at_once = if moves { (0, self.course.time) } else { (events + 1, since) };
        self.at_once.0 > EVENTS_AT_ONCE.0
    }

    /// One step; whether one keeps the accuracy.
    fn step(&mut self, mark: f64) -> bool {
        poll();
        let t = self.course.time;
        let Some((mut h, mut reached)) = self.find_step(mark) else { return false };
        let mut due = self.due(h);
        if let Some(Due { share, .. }) = due.filter(|due| due.share < 1.0) {
            let there = t + share * h;
            self.stepper.retake();
            let Some(found) = self.find_step(there) else { return false };
            (h, reached) = found;
            due = due.filter(|_| reached == there);
        }
        let at = (t, &self.state);
        self.stepper.work(&mut self.rates, at, h, &mut self.course.work);
        self.rigid = self.equilibrium.find(&self.rates, &self.stepper, &self.end, h);
        let equilibrium = &mut self.equilibrium;
        if self.rigid {
            self.extremes.balance(&mut self.rates, &self.stepper, equilibrium, at, h);
        }
        self.extremes.bend(&self.watch.middle, h);
        let inside = (equilibrium, &mut self.watch);
        self.extremes.take(&mut self.rates, &self.stepper, inside, at, h);
        self.extremes.advance(reached);
        while self.next_sample < self.request.times.len() && self.request.times[self.next_sample] <= reached {
            let time = self.request.times[self.next_sample];
            let share = if time == reached { 1.0 } else { ((time - t) / h).clamp(0.0, 1.0) };
            if time == reached {
                self.sample.copy_from_slice(&self.end);
            } else {
                self.stepper.components(share, &self.state, &mut self.sample);
            }
            self.write_sample(h, share);
        }
        for (tally, state) in self.course.tallies.iter_mut().zip(&self.rates.contacts.states) {
            match state {
                State::Open => {}
                State::Stuck => tally.stuck += h,
                State::Slip { .. } => tally.slipping += h,
            }
        }
        self.stepper.advance();
        self.watch.advance();
        std::mem::swap(&mut self.state, &mut self.end);
        self.scale.widen(self.rates.system, &self.state);
        self.rounding.note(self.rates.system, self.rates.is_relative(), &self.state);
        self.course.time = reached;
        self.course.steps += 1;
        let change = due.and_then(|due| due.change).filter(|_| reached < mark).map(Event::Stage);
        self.watch.event = self.watch.event.take().or(change);
        true
    }

    /// Where a stage changes its sense in a step, or the equations bend.
    fn due(&mut self, h: f64) -> Option<Due> {
        if !self.rates.has_kinks() {
            return None;
        }
        let (t, state, stepper) = (self.course.time, &self.state, &self.stepper);
        let (rates, sample) = (&mut self.rates, &mut self.sample);
        let mut smooth = Vec::new();
        let mut here = Vec::new();
        let mut look = |share: f64, to: &mut Vec<u32>| {
            stepper.components(share, state, sample);
            rates.derivative(t + share * h, sample, &mut sample.clone());
            rates.stretches(t + share * h, to);
            rates.change()
        };
        look(NEAR, &mut smooth);
        let mut at = |share: f64| {
            let change = look(share, &mut here);
            (change.is_some() || here != smooth).then_some(Due { share, change })
        };
        let mut low = NEAR;
        let mut due = LOOKS.into_iter().find_map(|share| {
            let due = at(share);
            low = if due.is_none() { share } else { low };
            due
        })?;
        while due.share - low > MEETS {
            let middle = 0.5 * (low + due.share);
            match at(middle) {
                Some(found) => due = found,
                None => low = middle,
            }
        }
        // One that the time cannot tell from the start is over.
        ((t + due.share * h) - t > MEETS * t.abs()).then_some(due)
    }

    /// Length and end of a step that keeps the accuracy at its end and on the way there, read or not, so that reading changes
    /// nothing; `None` if none does.
    fn find_step(&mut self, mark: f64) -> Option<(f64, f64)> {
        let at = (self.course.time, &self.state);
        let t = at.0;
        let mut longest = (mark - t).min(REACH / self.rates.turning(&self.state).max(f64::MIN_POSITIVE));
        let mut meant = None;
        // Forty reductions by a tenth to nine tenths reach any length that still changes t.
        for _ in 0..40 {
            let h = self.stepper.step(&mut self.rates, at, longest, &self.scale, &mut self.end)?;
            // What is left to the mark is taken whole, and then it is met to the last bit.
            let reached = if h == mark - t { mark } else { t + h };
            if reached == t {
                return None;
            }
            self.stepper.accept(&mut self.rates, reached, &self.end);
            self.watch.look(&mut self.rates);
            self.extremes.look(&self.rates);
            let error = self.stepper.fill(&mut self.rates, at, h, &self.scale, &self.end);
            if error <= 1.0 {
                let rubs = self.rates.contacts.any();
                let first = || self.watch.first(&mut self.rates, &self.stepper, at, h);
                let Some((share, event)) = rubs.then(first).flatten() else {
                    self.watch.event = meant.filter(|_| h == longest);
                    return Some((h, reached));
                };
                if share >= AT_THE_END || h == longest && meant == Some(event) {
                    self.watch.event = Some(event);
                    return Some((h, reached));
                }
                (longest, meant) = (share * h, Some(event));
                self.stepper.retake();
                continue;
            }
            self.stepper.shorten(h, error);
        }
        None
    }

    /// Writes what the sample's state, at a share of the step, says into the next column.
    fn write_sample(&mut self, h: f64, share: f64) {
        let (n, columns, column) = (self.rates.system.len(), self.request.times.len(), self.next_sample);
        if self.rigid {
            let at = (self.course.time, &self.state);
            self.equilibrium.at(&mut self.rates, &self.stepper, at, h, share);
        }
        let sample = &mut self.sample;
        let torque = |s: usize| match self.equilibrium.torque(s).filter(|_| self.rigid) {
            Some(torque) => torque,
            None => self.rates.link_torque_at(s, |i| sample[i]),
        };
        let torques: Vec<f64> = (0..self.rates.system.links.len()).map(torque).collect();
        let energies = self.rates.energies(sample);
        let rubbing = self.rates.system.frictions.len();
        if rubbing > 0 {
            self.rates.derivative(self.course.time + h * share, sample, &mut self.end_slopes);
            self.rates.carry();
        }
        let rubbed: Vec<f64> = (0..rubbing)
            .map(|e| friction_value(&self.rates, e))
            .chain(self.rates.contacts.states.iter().map(|state| state.code()))
            .collect();
        self.rates.to_absolute(sample);
        let values = sample[..2 * n].iter().chain(&torques).chain(&energies).chain(&rubbed);
        for (row, &value) in values.enumerate() {
            self.course.samples[row * columns + column] = value;
        }
        self.next_sample += 1;
    }
}

/// Accuracy for the implicit method's estimate, which is of lower order than its steps: those are then about as exact as
/// asked for (RADAU5 does the same).
fn estimated(accuracy: f64) -> f64 {
    0.1 * accuracy.powf(2.0 / 3.0)
}

/// Times at which something outside switches or bends, zero, from which on is recorded, and the end.
fn marks(system: &System, request: &Request<'_>) -> Vec<f64> {
    let courses = system.controllers.iter().flat_map(|one| system.curves[one.set_point].knots());
    let switches = system.torques.iter().flat_map(|torque| torque.marks(&system.curves)).chain([0.0]);
    let engagements = system.frictions.iter().filter_map(|friction| friction.engagement);
    let engaged = engagements.flat_map(|curve| system.curves[curve].knots());
    let switches = switches.chain(courses.chain(engaged).copied());
    let mut found: Vec<f64> = switches.filter(|&t| request.start < t && t < request.duration).collect();
    found.push(request.duration);
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}
