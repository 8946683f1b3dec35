//! Steady motion of one machine to a wanted accuracy.
//!
//! The revolution is solved on a mesh, the error of every step is measured ([`crate::drive::check`]), and steps that err
//! too much are made shorter, until none does. Where the motor's or gearbox's characteristic has a kink at
//! some speed, the angles at which the motion passes it become ends of steps. The accuracy that is reported
//! is what was measured.
//!
//! Newton over the whole revolution from one constant speed finds the motion of all but a few machines. Where it
//! fails, or finds a motion from which the machine departs, or one that may not be the only one
//! ([`crate::drive::levels`]), the revolution is marched through instead ([`crate::drive::march`]): that finds all motions that
//! repeat, or shows that none does. The fastest is the answer: it draws in every faster start. The others are
//! reported.

use crate::drive::between::Between;
use crate::drive::check::last_correction;
use crate::drive::cycle::{Turn, divide};
use crate::drive::equation::Machine;
use crate::drive::events::{Events, leap};
use crate::drive::extremes::{Extreme, Extremes};
use crate::drive::law::Moment;
use crate::drive::layout::unbundle;
use crate::drive::march::{
    MotionChoice, NoMotion, PeriodicMotion, Repeating, Sliding, counts_as_rest, repeating,
};
use crate::drive::measures::Totals;
use crate::drive::mesh::{Crossing, Mesh, Piece, speed_along};
use crate::drive::reading::Mark;
use crate::drive::steep::{Along, SteepKind, Steepness};
use crate::drive::step::OVER_KINK;
use crate::drive::structure::Plan;
use crate::kernel::call::poll;
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::radau::S;
use crate::kernel::real::Real;
use crate::kernel::status::Status;
use crate::linkage::motion::Motion;

/// Steps of the first mesh for an accuracy of 1e-8 or more.
const FIRST: f64 = 24.0;

/// Most steps of a revolution.
pub const STEPS_MAX: usize = 12_288;

/// Most meshes. Some make steps at least half as long, and steps behind a kink shorter at once; some place a
/// kink.
const MESHES_MAX: usize = 400;

/// Most meshes on which a kink of the drive is placed anew before errors are looked at: each squares the
/// distance.
const PLACEMENTS_MAX: u32 = 8;

/// The same where a law may jump: far from the motion an end of a step goes some way into the next at most.
const JUMP_PLACEMENTS_MAX: u32 = 60;

/// Most looks at where formulas are steep along a solution: what is found changes the solution, and so where it is.
const LOOKS_MAX: u32 = 20;

/// An accuracy that is asked for and cannot be had is reported, as long as it is better than this.
const USABLE: f64 = 1e-5;

/// An accuracy below the first is taken as it is when more meshes than the second do not reduce it to this share.
const NOISE: f64 = 1e-11;
const IDLE_MAX: u32 = 3;
const WON: f64 = 0.9;

/// By how much the accuracy is lowered where that which is asked for cannot be had.
const LOWER: f64 = 10.0;

/// Steady motion of one machine.
#[derive(Clone, Debug)]
pub struct Steady {
    /// The solution at the starts of the steps.
    pub marks: Vec<Mark>,
    /// What lies between the starts of steps as series, where these are as exact as the steps.
    pub between: Option<Vec<Between<f64>>>,
    /// Where the motion passes kinks that depend on it: ends of steps.
    pub crossings: Vec<Crossing>,
    /// Derivative of the return map.
    pub multiplier: f64,
    /// Extremes.
    pub extremes: Extremes<f64>,
    /// Integrals.
    pub totals: Totals<f64>,
    /// Relative error as measured.
    pub reached: f64,
    /// What rounding of the speed makes of accelerations, as [`Check::rounding`](crate::drive::check::Check::rounding).
    pub rounding: f64,
    /// Sweeps over all meshes.
    pub sweeps: u32,
    /// Whether there may be faster, and slower, motions that repeat.
    pub may_have: Rivals,
    /// u at φ = 0 at levels of energy that tell of them.
    pub hints: Vec<f64>,
    /// Those that there are, from the fastest down.
    pub others: Vec<OtherMotion>,
    /// Starts of which it is known that they do not settle, or not known whether they do.
    pub beyond: Beyond,
}

/// Starts that lie beyond all motions that are known, as speeds at φ = 0 \[rad/s\]; NaN where there are none.
#[derive(Clone, Copy, Debug)]
pub struct Beyond {
    /// From faster ones the machine runs away.
    pub away_from: f64,
    /// Faster ones were not followed to an end.
    pub undecided_above: f64,
    /// Slower ones were not followed to an end.
    pub undecided_below: f64,
}

impl Beyond {
    /// Everything is known, or was not asked for.
    const NOTHING: Beyond =
        Beyond { away_from: f64::NAN, undecided_above: f64::NAN, undecided_below: f64::NAN };
}

/// Whether other motions may repeat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rivals {
    /// Above the one that was found.
    pub faster: bool,
    /// Below it.
    pub slower: bool,
    /// Right beside it, since drive and loads do not tell speeds apart there.
    pub beside: bool,
}

/// Another motion of the machine that repeats.
#[derive(Clone, Copy, Debug)]
pub struct OtherMotion {
    /// Minimum speed of the crank \[rad/s\].
    pub speed_min: f64,
    /// Maximum speed of the crank \[rad/s\].
    pub speed_max: f64,
    /// Duration of the revolution \[s\].
    pub period: f64,
    /// Derivative of the return map: the machine departs from the motion above 1.
    pub multiplier: f64,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug)]
pub struct Failure {
    /// The kind.
    pub status: Status,
    /// Crank angle where the machine comes to rest, does not close, or begins to slide along a jump \[rad\]; NaN where
    /// there is none.
    pub phi: f64,
    /// Speed from which it slows down, which it still exceeds, or at which it slides \[rad/s\]; NaN where there is none.
    /// Of a range of speeds that all repeat the fastest at φ = 0, infinite where there is none.
    pub omega: f64,
    /// The slowest of that range at φ = 0 \[rad/s\], 0 where it goes down to rest.
    pub slowest: f64,
    /// Accuracy that was reached.
    pub reached: f64,
}

impl Failure {
    fn new(status: Status) -> Self {
        Failure { status, phi: f64::NAN, omega: f64::NAN, slowest: f64::NAN, reached: f64::NAN }
    }
}

impl From<NoMotion> for Failure {
    fn from(reason: NoMotion) -> Self {
        match reason {
            NoMotion::Rests { omega, phi } => Failure { phi, omega, ..Failure::new(Status::NoSteadyMotion) },
            NoMotion::RunsAway { omega, .. } => Failure { omega, ..Failure::new(Status::NoSteadyMotion) },
            NoMotion::DoesNotClose { phi } => Failure { phi, ..Failure::new(Status::DoesNotClose) },
            NoMotion::Neutral { slowest, fastest } => {
                Failure { omega: fastest, slowest, ..Failure::new(Status::Neutral) }
            }
            NoMotion::Unknown => Failure::new(Status::Undecided),
        }
    }
}

/// Meshes on which Newton's method is tried again, as multiples of [`FIRST`]: that of an accuracy of 1e-12, and the finest.
const FINER: [f64; 2] = [3.15, 4.0];

/// Another motion counts as the same if their u at φ = 0 differ by less than this share.
const SAME: f64 = 1e-5;

/// Share of u by which starts beside a known motion must gain or lose for the march to tell which; and how far from it they
/// may start for that.
const MET: f64 = 1e-6;
const FAR: f64 = 1e-2;

/// A motion that is held by a jump over no more than this angle \[rad\] may pass below it when it is solved exactly: what is
/// marched to [`crate::drive::march`]'s seven digits grazes the jump.
const BRIEF: f64 = 0.05;

/// Ends of steps this near to each other \[rad\] are one.
const NO_ANGLE: f64 = 1e-12;

/// Most times in a row that a revolution which Newton does not solve is marched through, and the shortest step of it \[rad\].
const MARCHES_MAX: u32 = 8;
const SHORTEST: f64 = 1e-11;

/// Accuracy to which other motions are reported.
const TOLD: f64 = 1e-7;

/// Solves for the steady motion with relative accuracy `accuracy`.
///
/// # Errors
/// [`Status::DoesNotClose`], [`Status::NoSteadyMotion`], [`Status::Slides`], [`Status::Neutral`]; [`Status::Undecided`] when
/// the search has found none in its time, [`Status::NotConverged`] when Newton does not hold what it found, and
/// [`Status::Inaccurate`] when the finest mesh does not suffice.
pub fn steady(plan: &Plan, q: &[f64], accuracy: f64) -> Result<Steady, Failure> {
    fastest_and(MotionChoice::Fastest, plan, q, accuracy)
}

/// The same, with all others that repeat.
///
/// # Errors
/// As [`steady`].
pub fn steady_with_others(plan: &Plan, q: &[f64], accuracy: f64) -> Result<Steady, Failure> {
    fastest_and(MotionChoice::All, plan, q, accuracy)
}

fn fastest_and(which: MotionChoice, plan: &Plan, q: &[f64], accuracy: f64) -> Result<Steady, Failure> {
    let machine = Machine::new(plan, q).keeping_branch(plan.may_jump());
    let breaks = machine.ends(&mut Motion::new(&plan.mechanism, q)).swap_remove(0);
    // With order 9 a mesh this much finer is good for the accuracy where 24 steps are for 1e-8.
    let steps = FIRST * (1e-8 / accuracy).powf(0.125).clamp(1.0, 4.0);
    let mesh = Mesh::new(divide(&breaks, steps as usize));
    let search = Search { plan, q, breaks: &breaks, accuracy, mesh, start: None, any: false };
    let first = search.best_on(&FINER);
    let stable = match first {
        Ok(found) if found.multiplier < 1.0 => Some(found),
        Err(failure) if failure.status == Status::DoesNotClose => return Err(failure),
        _ => None,
    };
    if let Some(found) = &stable {
        let Rivals { faster, slower, beside } = found.may_have;
        if !faster && !beside && (!slower || which == MotionChoice::Fastest) {
            return stable.ok_or(Failure::new(Status::Inaccurate));
        }
    }
    let hints = stable.as_ref().map_or(&[][..], |found| &found.hints);
    let known = stable.as_ref().map(Steady::starts_beside);
    match (repeating(&machine, &breaks, which, hints, known.as_deref()), stable) {
        (Ok(found), stable) => {
            let answer = fastest_of(&search, &found.motions, stable)?;
            Ok(Steady { beyond: beyond(&found, which), ..answer })
        }
        (Err(reason @ NoMotion::Neutral { .. }), _) => Err(reason.into()),
        (Err(reason), Some(found)) => {
            let speed = (2.0 * found.marks[0].u).sqrt();
            let is_creep = counts_as_rest(&machine, found.extremes.speed_min.value);
            Ok(Steady { beyond: beyond_known(reason, speed, is_creep, which), ..found })
        }
        (Err(reason), None) => Err(reason.into()),
    }
}

/// What a search that found motions leaves to say of starts beyond them.
fn beyond(found: &Repeating, which: MotionChoice) -> Beyond {
    // Slower ones count only where all motions are asked for.
    let is_cut = which == MotionChoice::All && found.followed_to > 0.0;
    Beyond {
        away_from: found.away_from,
        undecided_below: if is_cut { found.followed_to } else { f64::NAN },
        ..Beyond::NOTHING
    }
}

/// What a search that found none leaves to say of starts beyond a motion that is solved already, which has `speed` at φ = 0 and
/// may creep so slowly that the search takes it for rest.
fn beyond_known(reason: NoMotion, speed: f64, is_creep: bool, which: MotionChoice) -> Beyond {
    match reason {
        NoMotion::Rests { .. } if is_creep => Beyond::NOTHING,
        NoMotion::RunsAway { from, .. } if is_creep => Beyond { away_from: from, ..Beyond::NOTHING },
        _ => Beyond {
            away_from: if let NoMotion::RunsAway { from, .. } = reason { from } else { f64::NAN },
            undecided_above: speed,
            undecided_below: if which == MotionChoice::All { speed } else { f64::NAN },
        },
    }
}

/// The fastest of the motions that repeat from which the machine does not depart, with the others; `known` is
/// one that is solved already.
fn fastest_of(
    search: &Search<'_>,
    motions: &[PeriodicMotion],
    known: Option<Steady>,
) -> Result<Steady, Failure> {
    let (mut answer, mut others, mut failed): (Option<Steady>, Vec<OtherMotion>, _) =
        (None, Vec::new(), None);
    for motion in motions {
        let slides = motion.slides.map(|Sliding { phi, omega, .. }| Failure {
            phi,
            omega,
            ..Failure::new(Status::Slides)
        });
        if motion.slides.is_some_and(|sliding| sliding.over > BRIEF) {
            others.push(OtherMotion::from(motion));
            failed = failed.or(slides);
            continue;
        }
        // One end of a range that repeats: Newton's equations are singular there.
        if motion.growth == 1.0 {
            others.push(OtherMotion::from(motion));
            continue;
        }
        let is_known = |found: &&Steady| (motion.u() / found.marks[0].u - 1.0).abs() <= SAME;
        let solved = match known.as_ref().filter(is_known) {
            Some(found) => Ok(found.clone()),
            None => search.from(motion, answer.is_some()).best(),
        };
        match solved {
            Ok(found) if answer.is_none() && found.multiplier < 1.0 => answer = Some(found),
            Ok(found) => others.push(OtherMotion::from(&found)),
            Err(failure) => {
                others.push(OtherMotion::from(motion));
                failed = failed.or(slides).or(Some(failure));
            }
        }
    }
    // The march goes from start to start, and may not have met what is solved already.
    if let (Some(answer), Some(known)) = (&answer, &known) {
        let u = known.marks[0].u;
        let is_met = |motion: &PeriodicMotion| (motion.u() / u - 1.0).abs() <= SAME;
        if (answer.marks[0].u / u - 1.0).abs() > SAME && !motions.iter().any(is_met) {
            others.push(OtherMotion::from(known));
            others.sort_by(|a, b| a.period.total_cmp(&b.period));
        }
    }
    match (answer.or(known), failed) {
        (Some(found), _) => Ok(Steady { others, ..found }),
        (None, Some(failure)) if failure.status == Status::Slides => Err(failure),
        (None, Some(failure)) if failure.status == Status::Inaccurate => Err(failure),
        // There is a motion, but Newton does not hold it.
        (None, _) => {
            let fastest = motions.iter().map(|motion| (2.0 * motion.u()).sqrt()).reduce(f64::max);
            Err(Failure { omega: fastest.unwrap_or(f64::NAN), ..Failure::new(Status::NotConverged) })
        }
    }
}

impl Steady {
    /// Starts on both sides of this motion: a jump may drive away what is hardly faster.
    fn starts_beside(&self) -> Vec<f64> {
        let off = (MET / (1.0 - self.multiplier)).max(SAME);
        if off < FAR { [-off, off].map(|off| (1.0 + off) * self.marks[0].u).to_vec() } else { Vec::new() }
    }
}

impl From<&Steady> for OtherMotion {
    fn from(found: &Steady) -> Self {
        OtherMotion {
            speed_min: found.extremes.speed_min.value,
            speed_max: found.extremes.speed_max.value,
            period: found.totals.period,
            multiplier: found.multiplier,
        }
    }
}

impl From<&PeriodicMotion> for OtherMotion {
    /// From the marched turn, to its stages.
    fn from(motion: &PeriodicMotion) -> Self {
        let stages = || motion.pieces.iter().flat_map(|piece| piece.X);
        let speed = |u: f64| (2.0 * u).sqrt();
        OtherMotion {
            speed_min: speed(stages().fold(f64::INFINITY, f64::min)),
            speed_max: speed(stages().fold(0.0, f64::max)),
            period: motion.pieces.iter().map(Piece::duration).sum(),
            multiplier: motion.growth,
        }
    }
}

/// The search from one mesh on, with the steps of the machine in lanes.
#[derive(Clone)]
struct Search<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    breaks: &'a [f64],
    accuracy: f64,
    mesh: Mesh,
    /// What to start from; one constant speed otherwise.
    start: Option<Vec<Piece>>,
    /// Whether a motion from which the machine departs is wanted too.
    any: bool,
}

impl Search<'_> {
    /// The best solution, on finer meshes too where Newton's method does not find one on this: whether it does is not to depend
    /// on the accuracy that is asked for.
    fn best_on(&self, finer: &[f64]) -> Result<Steady, Failure> {
        let mut found = self.best();
        for steps in finer {
            if !matches!(found, Err(Failure { status: Status::NoSteadyMotion, .. })) {
                break;
            }
            let mesh = Mesh::new(divide(self.breaks, (FIRST * steps) as usize));
            found = Search { mesh, ..self.clone() }.best();
        }
        found
    }

    /// The solution, to a lower accuracy where that which is asked for ends in rounding: with ever shorter steps the noise of
    /// accelerations under a steep drive only grows.
    fn best(&self) -> Result<Steady, Failure> {
        let (mut found, mut accuracy) = (in_lanes(self.clone()), self.accuracy);
        while let Err(Failure { status: Status::Inaccurate, reached, .. }) = found
            && accuracy < 0.2 * USABLE
        {
            accuracy *= LOWER;
            found = in_lanes(Search { accuracy, ..self.clone() });
            // What was reached before counts if nothing better follows.
            found = found.map_err(|failure| Failure { reached: failure.reached.min(reached), ..failure });
        }
        found
    }

    /// The search from a marched revolution on: for the answer, or for another motion, which is only reported.
    fn from(&self, motion: &PeriodicMotion, told: bool) -> Self {
        let mut edges = ends_of(&motion.pieces, self.plan.cycle());
        // A jump may hold a motion over no angle at all.
        edges.dedup_by(|next, last| *next - *last < NO_ANGLE);
        let accuracy = if told { self.accuracy.max(TOLD) } else { self.accuracy };
        Search {
            mesh: Mesh { crossings: motion.crossings.clone(), ..Mesh::new(edges) },
            start: Some(motion.pieces.clone()),
            any: true,
            accuracy,
            ..self.clone()
        }
    }
}

impl Job for Search<'_> {
    type Output = Result<Steady, Failure>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let q: Vec<R> = self.q.iter().map(|&x| R::splat(x)).collect();
        // A law that jumps within a step would leave its stages no solution.
        let may_jump = self.plan.may_jump();
        let mut plain_motion = Motion::new(&self.plan.mechanism, self.q);
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let (mut mesh, mut start, mut sweeps, mut reached) = (self.mesh, self.start, 0, f64::NAN);
        let (mut placements, mut marches, mut best, mut idle) = (0, 0, f64::INFINITY, 0);
        let mut looks = 0;
        if mesh.edges.len() > STEPS_MAX {
            return Err(Failure::new(Status::Inaccurate));
        }
        for _ in 0..MESHES_MAX {
            poll();
            let machine = Machine::new(self.plan, &q).keeping_branch(may_jump);
            let events = Events::new(Machine::new(self.plan, self.q).keeping_branch(may_jump));
            let mut turn = Turn::of_steps(&machine, &mesh.edges, &mut m);
            if !turn.closes() {
                return Err(Failure::new(Status::DoesNotClose));
            }
            match &start {
                Some(pieces) => turn.start_from(pieces),
                None => turn.start_from_balance(&machine),
            }
            if may_jump && !mesh.crossings.is_empty() {
                turn.pass(&events.passages(&mesh, &turn.pieces(), &mut plain_motion));
            }
            turn.solve(&machine);
            sweeps += turn.sweeps;
            if !may_jump
                && !turn.is_solved()
                && marches < MARCHES_MAX
                && let Some(pieces) = &start
                && let Some(marched) = marched(
                    self.plan,
                    self.q,
                    &mesh.edges,
                    pieces[pieces.len() - 1].X[S - 1],
                    &mut plain_motion,
                )
            {
                (mesh.edges, marches) = (ends_of(&marched, self.plan.cycle()), marches + 1);
                start = Some(marched);
                continue;
            }
            let multiplier = unbundle(&[turn.multiplier])[0];
            if !turn.is_solved() || (multiplier >= 1.0 && !self.any) {
                return Err(Failure { reached, ..Failure::new(Status::NoSteadyMotion) });
            }
            marches = 0;
            let pieces = turn.pieces();
            if (placements < PLACEMENTS_MAX || may_jump)
                && let Some(next) = events.placed(&mesh, &pieces, self.breaks, &mut plain_motion)
            {
                if placements > JUMP_PLACEMENTS_MAX {
                    break;
                }
                (mesh, start, placements) = (next, Some(pieces), placements + 1);
                continue;
            }
            let leap = if may_jump { leap(&mesh, &pieces) } else { 0.0 };
            if leap > USABLE.max(self.accuracy) {
                break;
            }
            let mut is_better = turn.polish(&machine, last_correction(multiplier, self.accuracy));
            let over_kinks = if mesh.crossings.is_empty() { 0 } else { OVER_KINK };
            for _ in 0..over_kinks {
                is_better |= turn.polish(&machine, 0.0);
            }
            let pieces = if is_better { turn.pieces() } else { pieces };
            let passages = events.passages(&mesh, &pieces, &mut plain_motion);
            let kinks = events.kinks_at_ends(&passages, &pieces, &mut plain_motion);
            let check = turn.check(&machine, &kinks, self.accuracy, false, &mut m);
            let is_good = check.is_good();
            reached = check.reached.max(leap);
            // Near rounding more steps may only make more noise.
            idle = if reached < WON * best { 0 } else { idle + 1 };
            best = best.min(reached);
            let is_noise = reached < NOISE && idle > IDLE_MAX;
            let next = (!is_good && !is_noise).then(|| mesh.refined(&check.excess));
            let next = next.filter(|next| next.edges.len() <= STEPS_MAX);
            let Some(next) = next else {
                let mut edges = mesh.edges.clone();
                add_pulses(self.plan, self.q, self.breaks, &pieces, &mut edges, &mut plain_motion);
                if edges.len() > mesh.edges.len() {
                    if looks >= LOOKS_MAX || edges.len() > STEPS_MAX {
                        break;
                    }
                    (mesh.edges, start, placements, looks) = (edges, Some(pieces), 0, looks + 1);
                    continue;
                }
                if !is_good {
                    reached = reached.max(turn.check(&machine, &kinks, self.accuracy, true, &mut m).reached);
                }
                if !is_good && reached > USABLE.max(self.accuracy) {
                    break;
                }
                let multiplier =
                    events.multiplier(&turn.growths(), &passages, &kinks, &pieces, &mut plain_motion);
                if multiplier.is_nan() || (multiplier >= 1.0 && !self.any) {
                    return Err(Failure { reached, ..Failure::new(Status::NoSteadyMotion) });
                }
                let (accuracy, scale) = (self.accuracy.max(reached), turn.acceleration_scale(&machine));
                // A jump that holds the motion so near to the end of its rise that nobody sees it does not count.
                if may_jump
                    && let Some([phi, omega]) = events.held_inside(&pieces, accuracy, &mut plain_motion)
                {
                    return Err(Failure { phi, omega, reached, ..Failure::new(Status::Slides) });
                }
                // Ends of steps lie beside kinks of the speed by up to a millionth of a step; with jumps they lie on them.
                let corners = if may_jump { Vec::new() } else { events.corners(&pieces, &mut plain_motion) };
                let hints = turn.hints(&machine);
                let (between, off) = turn.between(&machine, accuracy, scale, &mut m).unzip();
                let mut starts = turn.starts(&machine, &mut m);
                if may_jump {
                    turn.take_sides(&events.sides(&passages, &pieces, &mut plain_motion), &mut starts);
                }
                return Ok(Steady {
                    marks: turn.marks(),
                    between: between.as_ref().map(|series| turn.in_a_row(series)),
                    crossings: mesh.crossings,
                    multiplier,
                    extremes: turn
                        .extremes(&machine, between.as_deref(), &starts, &mut m)
                        .first_lane()
                        .with_corners(&corners),
                    totals: turn.totals(&machine).first_lane(),
                    reached: off.map_or(reached, |off| reached.max(off)),
                    rounding: check.rounding,
                    sweeps,
                    may_have: Rivals {
                        faster: first_lane(turn.may_have_faster(&machine)) > 0.5 || !hints[0].is_empty(),
                        slower: first_lane(turn.may_have_slower(&machine)) > 0.5 || !hints[1].is_empty(),
                        beside: first_lane(turn.may_be_neutral(&machine)) > 0.5,
                    },
                    hints: hints.concat(),
                    others: Vec::new(),
                    beyond: Beyond::NOTHING,
                });
            };
            (mesh, start, placements) = (next, Some(pieces), 0);
        }
        // Before any error was measured, the angles at which the motion passes jumps did not settle.
        let status = if reached.is_nan() { Status::NotConverged } else { Status::Inaccurate };
        Err(Failure { reached, ..Failure::new(status) })
    }
}

/// The motion from u at φ = 0 over some steps, one after the other; those that Newton does not solve are halved. Where a stage
/// lies in the layer in which a steep formula takes on its sign, a step may have no solution.
fn marched(plan: &Plan, q: &[f64], edges: &[f64], mut u: f64, m: &mut Motion<f64>) -> Option<Vec<Piece>> {
    let (machine, mut phi) = (Machine::new(plan, q), edges[0]);
    let (mut pieces, mut ends) = (Vec::new(), edges[1..].to_vec());
    ends.reverse();
    while let Some(&end) = ends.last() {
        poll();
        let h = end - phi;
        if h < SHORTEST || pieces.len() > STEPS_MAX {
            return None;
        }
        let step = machine.advance(phi, u, h, m).0;
        // A step that does not converge leaves a NaN.
        if step.end() > 0.0 {
            pieces.push(Piece { phi, h, u, X: step.X });
            (phi, u) = (end, step.end());
            ends.pop();
        } else {
            ends.push(phi + 0.5 * h);
        }
    }
    Some(pieces)
}

/// Adds ends of steps where formulas that know a speed are steep along a solution that does not see it.
fn add_pulses(
    plan: &Plan,
    q: &[f64],
    breaks: &[f64],
    pieces: &[Piece],
    ends: &mut Vec<f64>,
    m: &mut Motion<f64>,
) {
    let laws = plan.steep_laws(SteepKind::Moving);
    if laws.is_empty() {
        return;
    }
    let omega = speed_along(pieces);
    let moment = |phi| Moment::steady(phi, omega(phi));
    let along = Along::cycle(plan, &moment, breaks);
    for load in laws {
        let steepness = Steepness::new(plan, q, load, SteepKind::Moving, m);
        if !steepness.is_seen(&along, ends, m) {
            steepness.add_ends(&along, ends, m);
        }
    }
}

/// Ends of the steps of a revolution.
fn ends_of(pieces: &[Piece], cycle: f64) -> Vec<f64> {
    pieces.iter().map(|piece| piece.phi).chain([cycle]).collect()
}

impl<R: Real> Turn<R> {
    /// Whether Newton converged to a real motion.
    #[inline(always)]
    fn is_solved(&self) -> bool {
        let flat = |of: &dyn Fn(&crate::drive::step::Step<R>) -> R| {
            unbundle(&self.steps.iter().map(of).collect::<Vec<_>>())
        };
        !self.steps.is_empty()
            && unbundle(&[self.correction]).iter().all(|&x| x <= 1e-6)
            && unbundle(&[self.multiplier]).iter().all(|x| x.is_finite())
            && flat(&|step| step.u)
                .into_iter()
                .chain(flat(&|step| step.end()))
                .all(|u| u > 0.0 && u.is_finite())
    }

    /// The solution at the starts of the steps, those of no length left out.
    #[inline(always)]
    fn marks(&self) -> Vec<Mark> {
        let mut t = 0.0;
        let mut marks = Vec::new();
        for piece in self.pieces() {
            marks.push(Mark { phi: piece.phi, u: piece.u, t, h: piece.h, X: piece.X });
            t += piece.duration();
        }
        marks
    }
}

#[inline(always)]
fn first_lane<R: Real>(x: R) -> f64 {
    unbundle(&[x])[0]
}

impl<R: Real> Totals<R> {
    /// Those of the first lane.
    #[inline(always)]
    fn first_lane(&self) -> Totals<f64> {
        Totals {
            period: first_lane(self.period),
            motor_work: first_lane(self.motor_work),
            crank_work: first_lane(self.crank_work),
            load_work: first_lane(self.load_work),
            torque_mean: first_lane(self.torque_mean),
            torque_rms: first_lane(self.torque_rms),
        }
    }
}

impl<R: Real> Extremes<R> {
    /// Those of the first lane.
    #[inline(always)]
    fn first_lane(&self) -> Extremes<f64> {
        let first = |e: &Extreme<R>| Extreme { value: first_lane(e.value), phi: first_lane(e.phi) };
        Extremes {
            speed_min: first(&self.speed_min),
            speed_max: first(&self.speed_max),
            acceleration_min: first(&self.acceleration_min),
            acceleration_max: first(&self.acceleration_max),
        }
    }
}
