//! Kinks and jumps of the equation of motion at angles that depend on the motion: a speed at which the characteristic of
//! the drive has a kink, a switch of a formula, a knot of a damper's table.
//!
//! Where the motion passes one is found from its steps and becomes the end of a step. That end moves with the motion: the
//! step of Newton's method over the revolution takes u from the side before to the side behind as if the kink were passed
//! where g, the quantity whose zero it is, would be zero ([`Passage`]), so that it converges however much the torque jumps;
//! then the end goes there. What depends on the side (a slope, a torque that jumps) is taken on the branch of the step
//! ([`crate::kernel::branch`]).

use crate::drive::check::KinkAtEnd;
use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::law::{LawGeometry, SpeedKink};
use crate::drive::layout::bundle;
use crate::drive::mesh::{Crossing, Mesh, Move, Piece, crossing};
use crate::drive::step::REFERENCE;
use crate::drive::structure::Plan;
use crate::kernel::radau::{AT, C, N, S, through, value};
use crate::kernel::real::Real;
use crate::kernel::turns::Bernstein;
use crate::linkage::motion::Motion;

/// Relative distance of a speed from a kink's below which it counts as the kink's. A break that is off by
/// 1e-9 rad changes the solution by the square of that.
const ON_KINK: f64 = 1e-10;

/// A kink this close to the end of a step, as a share of the step, lies at the end: what is left of it
/// changes the solution by the square of that. Where a law may jump it changes the solution in proportion.
const KINK_SHARE: f64 = 1e-6;
const KINK_SHARE_JUMP: f64 = 1e-10;

/// Angles \[rad\] to both sides of a jump at which the machine is looked at: far from where rounding hides the jump, near
/// enough that what extrapolation to it leaves is of the order of their product.
const BESIDE: f64 = 1e-5;

/// Rounding of u after a revolution, relative, and after a step that forgets where it started.
const ROUNDING: f64 = 1e-12;
const ROUNDING_OF_STEP: f64 = 1e-14;

/// A change of the acceleration at a kink below this share of it is no jump.
const NO_JUMP: f64 = 1e-8;

/// How far ahead of a motion the state lies that tells its side, as a share of a step.
const AHEAD: f64 = 1e-6;

/// How far beside a kink the state lies that tells its side: a share of u, or an angle where the kink hardly depends on u.
const NUDGE: f64 = 1e-7;
const UPRIGHT: f64 = 1e-3;

/// Distance of u from a jump, as a share, at which its two sides are looked at.
const ASIDE: f64 = 1e-6;

/// A quantity that turns within this share of its size from its zero may pass it: what the quintic of a step may err by.
const NEARLY: f64 = 1e-3;

/// What the motion may pass where its equation has a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A speed of the crank: the number of a kink of the drive.
    Speed(usize),
    /// A kink of a law.
    Law(SpeedKink),
}

/// Share of the room beside an end of a step by which it goes towards a kink that lies beyond.
const ON_THE_WAY: f64 = 0.5;

/// Newton steps to the zero of an event: g is nearly linear in u.
const LEVEL_SWEEPS: usize = 4;

/// What the torques beside a jump do with a motion that is on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pull {
    /// Drive it back from either side.
    Holds,
    /// Drive it to where u is larger.
    Up,
    /// Drive it to where u is smaller.
    Down,
}

/// Where the motion passes an event inside a step.
#[derive(Clone, Copy, Debug)]
struct Passing {
    /// Crank angle \[rad\], and u there.
    phi: f64,
    u: f64,
    /// What the quantity is where it is looked at next.
    beyond: f64,
}

/// How the motion passes a kink at the end of a step, or beside it.
#[derive(Clone, Copy, Debug)]
pub struct Passage<R> {
    /// u at the end of the step.
    u: R,
    /// The quantity whose zero the kink is, there.
    g: R,
    /// Its derivatives by φ and u.
    slopes: [R; 2],
    /// ε at the end of the step, on its branch.
    before: R,
    /// ε at the start of the next step, on its branch.
    behind: R,
}

impl<R: Real> Passage<R> {
    /// Angle behind the end of the step at which the motion before it passes the kink \[rad\]: −g/g′.
    #[inline(always)]
    pub fn late(&self) -> R {
        self.late_with(self.before)
    }

    /// The same with an acceleration.
    #[inline(always)]
    fn late_with(&self, epsilon: R) -> R {
        -self.g / (self.slopes[0] + self.slopes[1] * epsilon)
    }

    /// Its derivative by u.
    fn late_by_u(&self) -> R {
        -self.slopes[1] / (self.slopes[0] + self.slopes[1] * self.before)
    }

    /// Whether the kink is at the end of the step, to a relative rounding of u.
    fn is_there(&self, rounding: f64) -> bool {
        self.g.abs().max_lane() <= rounding * (self.slopes[1] * self.u).abs().max_lane()
    }

    /// How the passing changes a small disturbance: the later the motion passes a jump, the longer the acceleration before
    /// it lasts. With g′ the derivative of g along the motion, the factor is g′ behind over g′ before (the saltation of
    /// Aizerman and Gantmacher, *PMM* 22, 1958); 1 where the acceleration is continuous.
    #[inline(always)]
    pub fn factor(&self) -> R {
        let [by_phi, by_u] = self.slopes;
        let factor = (by_phi + by_u * self.behind) / (by_phi + by_u * self.before);
        self.where_continuous(R::splat(1.0), factor)
    }

    /// What u at the end of the step becomes for the next one, as `[scale, offset]`: the acceleration before lasts to where
    /// the kink is passed, so that u there, followed back to the end of the step, differs by (ε before − ε behind)·late. That
    /// is linear in u with the slope `scale`: the pair does not depend on the u that it was made from.
    #[inline(always)]
    pub fn through(&self) -> [R; 2] {
        let scale = self.factor();
        let carried = (self.before - self.behind).mul_add(self.late(), self.u);
        [scale, self.where_continuous(R::splat(0.0), carried - scale * self.u)]
    }

    /// One value where the acceleration is continuous, whose rounding would otherwise count, and another elsewhere.
    #[inline(always)]
    fn where_continuous(&self, there: R, elsewhere: R) -> R {
        let size = self.before.abs().max(self.behind.abs());
        (self.behind - self.before).abs().select_lt(size * NO_JUMP, there, elsewhere)
    }
}

/// A state that tells on which side of all kinks a motion is.
#[derive(Clone, Debug)]
pub struct Side {
    /// What laws know there.
    geometry: Vec<LawGeometry<f64>>,
    /// u there.
    u: f64,
}

impl Side {
    /// The machine on the branch of this side.
    pub fn of<'b>(&'b self, machine: &Machine<'b, f64>) -> Machine<'b, f64> {
        Machine { side: Some((&self.geometry, self.u)), ..*machine }
    }
}

impl Plan {
    /// How close to its kinks the ends of steps have to be, as a share of the step.
    pub fn kink_share(&self) -> f64 {
        if self.may_jump() { KINK_SHARE_JUMP } else { KINK_SHARE }
    }
}

/// The quantities whose zeros are kinks, of one machine or of its derivatives along several directions.
pub struct Events<'a, R> {
    machine: Machine<'a, R>,
    /// Speeds of the crank at which the drive has kinks \[rad/s\].
    speeds: Vec<R>,
    /// Kinks of laws.
    laws: Vec<SpeedKink>,
}

impl<'a, R: Real> Events<'a, R> {
    /// Those of a machine.
    #[inline(always)]
    pub fn new(machine: Machine<'a, R>) -> Self {
        let speeds = machine.plan.drive.speed_kinks(&machine.plan.tables, machine.q);
        Events { machine, speeds, laws: machine.plan.speed_kinks() }
    }

    /// All of them.
    fn all(&self) -> impl Iterator<Item = Event> {
        (0..self.speeds.len()).map(Event::Speed).chain(self.laws.iter().copied().map(Event::Law))
    }

    /// The quantity whose zero the event is.
    #[inline(always)]
    pub fn value(&self, event: Event, phi: R, u: R, m: &mut Motion<R>) -> R {
        let omega = (u * 2.0).sqrt();
        match event {
            Event::Speed(nth) => omega - self.speeds[nth],
            Event::Law(kink) => {
                let mut geometry = Vec::new();
                self.machine.row(phi, m, &mut geometry);
                let at = [omega, R::splat(f64::NAN)];
                self.machine.plan.speed_kink_value(self.machine.q, kink, &geometry, at)
            }
        }
    }

    /// Its derivatives by φ and by u, by central differences.
    #[inline(always)]
    pub fn slopes(&self, event: Event, phi: R, u: R, m: &mut Motion<R>) -> [R; 2] {
        let (over_phi, over_u) = (R::splat(BESIDE), u * BESIDE);
        let by_phi = self.value(event, phi + over_phi, u, m) - self.value(event, phi - over_phi, u, m);
        let by_u = self.value(event, phi, u + over_u, m) - self.value(event, phi, u - over_u, m);
        [by_phi / (over_phi * 2.0), by_u / (over_u * 2.0)]
    }

    /// The kink with a number in the order of `all`.
    #[inline(always)]
    pub fn nth(&self, nth: usize) -> Event {
        let speeds = self.speeds.len();
        if nth < speeds { Event::Speed(nth) } else { Event::Law(self.laws[nth - speeds]) }
    }

    /// How the motion passes a kink at a crank angle with u, and ε on either side.
    #[inline(always)]
    pub fn passage(
        &self,
        event: Event,
        phi: R,
        u: R,
        [before, behind]: [R; 2],
        m: &mut Motion<R>,
    ) -> Passage<R> {
        let slopes = self.slopes(event, phi, u, m);
        Passage { u, g: self.value(event, phi, u, m), slopes, before, behind }
    }
}

impl Events<'_, f64> {
    /// The size of a quantity, against which a value counts as zero.
    fn size(&self, event: Event, values: &[f64]) -> f64 {
        match event {
            Event::Speed(nth) => self.speeds[nth],
            Event::Law(_) => values.iter().fold(0.0, |size, value| value.abs().max(size)),
        }
    }

    /// The quantity whose zero the event is, on the quintic of a step at a share of it.
    fn on_piece(&self, event: Event, piece: &Piece, share: f64, m: &mut Motion<f64>) -> f64 {
        let phi = piece.phi + share * piece.h;
        self.value(event, phi, piece.value(&piece.quintic(), phi), m)
    }

    /// The mesh with its ends at kinks moved to where the solved motion passes them, and with new ends at those that it
    /// passes inside steps; none where all lie at ends.
    pub fn placed(&self, mesh: &Mesh, pieces: &[Piece], breaks: &[f64], m: &mut Motion<f64>) -> Option<Mesh> {
        let kink_share = self.machine.plan.kink_share();
        let mut moves = Vec::with_capacity(mesh.crossings.len());
        for crossing in &mesh.crossings {
            moves.push(self.move_of(crossing, pieces, m));
        }
        let mut next = mesh.clone();
        let mut changes = next.follow(&moves, breaks, kink_share);
        for found in self.crossings(mesh, &moves, pieces, m) {
            changes |= next.add_crossing(found, kink_share);
        }
        changes.then_some(next)
    }

    /// How the end of a step has to move to where the motion passes its kink; none where it does not.
    fn move_of(&self, crossing: &Crossing, pieces: &[Piece], m: &mut Motion<f64>) -> Option<Move> {
        let event = self.nth(crossing.nth);
        let [before, behind] = beside(crossing.phi, pieces);
        let sides = [before, behind].map(|piece| self.on_piece(event, piece, C[REFERENCE], m));
        if sides[0] * sides[1] >= 0.0 {
            return None;
        }
        let passage = self.passage_between(event, before, behind, m);
        let slopes =
            [before, behind].map(|piece| self.slope_on_branch_of(piece, crossing.phi, passage.u, m).abs());
        let layer = slopes[0].max(slopes[1]).recip();
        let rounding = ROUNDING_OF_STEP.max(ROUNDING * (-slopes[0] * before.h).exp());
        if passage.is_there(rounding) {
            return Some(Move { by: 0.0, layer });
        }
        // Where the drive is steep ε on a branch tells nothing of a motion that has left it: at a kink of the drive u itself,
        // along the step in which the end lies on its own side.
        let late = passage.late_with(match event {
            Event::Law(_) => passage.before,
            Event::Speed(_) if passage.g * sides[0] > 0.0 => before.slope(1.0),
            Event::Speed(_) => behind.slope(0.0),
        });
        let room = [(C[REFERENCE] - 1.0) * before.h, C[REFERENCE] * behind.h];
        if room[0] < late && late < room[1] {
            return Some(Move { by: late, layer });
        }
        // Where it passes at a flat angle the tangent points far off: the sign changes between the middles of the steps.
        let end = self.value(event, before.phi + before.h, before.X[S - 1], m);
        let by = if end * sides[0] < 0.0 {
            self.within(event, before, [C[REFERENCE], 1.0], [sides[0], end], m) - before.h
        } else {
            let start = self.value(event, behind.phi, behind.u, m);
            if start * sides[1] < 0.0 {
                self.within(event, behind, [0.0, C[REFERENCE]], [start, sides[1]], m)
            } else {
                // u leaps over the kink here, by what the acceleration before it makes of a long way: some of that way.
                late.clamp(ON_THE_WAY * room[0], ON_THE_WAY * room[1])
            }
        };
        Some(Move { by, layer })
    }

    /// Where the quintic of a step passes a kink between two shares of it, with the values there: a length from its start.
    fn within(
        &self,
        event: Event,
        piece: &Piece,
        [from, to]: [f64; 2],
        [left, right]: [f64; 2],
        m: &mut Motion<f64>,
    ) -> f64 {
        piece.h * (from + crossing(|x| self.on_piece(event, piece, from + x, m), to - from, left, right))
    }

    /// How the motion passes a kink between two steps.
    fn passage_between(
        &self,
        event: Event,
        before: &Piece,
        behind: &Piece,
        m: &mut Motion<f64>,
    ) -> Passage<f64> {
        let (phi, u) = (before.phi + before.h, before.X[S - 1]);
        let sides = [self.on_branch_of(before, phi, u, m), self.on_branch_of(behind, behind.phi, u, m)];
        self.passage(event, phi, u, sides, m)
    }

    /// ε on the branch of a step.
    fn on_branch_of(&self, piece: &Piece, phi: f64, u: f64, m: &mut Motion<f64>) -> f64 {
        let (mut geometry, mut known) = (Vec::new(), Vec::new());
        self.machine.row(C[REFERENCE].mul_add(piece.h, piece.phi), m, &mut known);
        let row = self.machine.row(phi, m, &mut geometry);
        self.machine.acceleration_on_branch(&row, &geometry, u, (&known, piece.X[REFERENCE])).value
    }

    /// How the motion passes the ends of steps at kinks: the number of the step before each, and its passage. Of several
    /// kinks at one end the first stands for all.
    pub fn passages(&self, mesh: &Mesh, pieces: &[Piece], m: &mut Motion<f64>) -> Vec<(usize, Passage<f64>)> {
        let mut passages: Vec<(usize, Passage<f64>)> = Vec::with_capacity(mesh.crossings.len());
        for crossing in &mesh.crossings {
            let k = before(crossing.phi, pieces);
            if passages.iter().all(|passage| passage.0 != k) {
                let [before, behind] = beside(crossing.phi, pieces);
                passages.push((k, self.passage_between(self.nth(crossing.nth), before, behind, m)));
            }
        }
        passages
    }

    /// ε on both sides of the ends of steps at kinks, where the motion passes these, with the number of the step before: under
    /// a steep drive what is left of the way there changes it much more than u.
    pub fn sides(
        &self,
        passages: &[(usize, Passage<f64>)],
        pieces: &[Piece],
        m: &mut Motion<f64>,
    ) -> Vec<(usize, [f64; 2])> {
        let of_passage = |&(k, ref passage): &(usize, Passage<f64>)| {
            let [before, behind] = [&pieces[k], &pieces[(k + 1) % pieces.len()]];
            let late = passage.late();
            let is_near = late.abs() < NEARLY * before.h.min(behind.h);
            let late = if is_near { late } else { 0.0 };
            let u = passage.before.mul_add(late, passage.u);
            let ends = [(before, before.phi + before.h), (behind, behind.phi)];
            (k, ends.map(|(piece, phi)| self.on_branch_of(piece, phi + late, u, m)))
        };
        passages.iter().map(of_passage).collect()
    }

    /// Kinks that the motion may pass, by number: those of the drive near its speeds, and all of laws.
    fn within_reach(&self, pieces: &[Piece]) -> Vec<(usize, Event)> {
        let stages = pieces.iter().flat_map(|piece| piece.X);
        let (low, high) = stages.fold((f64::INFINITY, 0.0_f64), |(low, high), u| (low.min(u), high.max(u)));
        // With room for what lies between the stages.
        let may_be_passed = |event: &Event| match *event {
            Event::Speed(nth) => (0.8 * low..1.2 * high).contains(&(0.5 * self.speeds[nth].powi(2))),
            Event::Law(_) => true,
        };
        self.all().enumerate().filter(|(_, event)| may_be_passed(event)).collect()
    }

    /// The quantity whose zero a kink is, at the starts of the steps and at the end of the last.
    fn at_ends(&self, event: Event, pieces: &[Piece], m: &mut Motion<f64>) -> Vec<f64> {
        let last = &pieces[pieces.len() - 1];
        let starts = pieces.iter().map(|piece| (piece.phi, piece.u));
        let ends = starts.chain([(self.machine.plan.cycle(), last.X[S - 1])]);
        ends.map(|(phi, u)| self.value(event, phi, u, m)).collect()
    }

    /// Crank angle and acceleration where the solution passes a kink inside a step, however near to its end: the curve of
    /// the acceleration has a corner there.
    pub fn corners(&self, pieces: &[Piece], m: &mut Motion<f64>) -> Vec<(f64, f64)> {
        let mut corners = Vec::new();
        for (_, event) in self.within_reach(pieces) {
            let values = self.at_ends(event, pieces, m);
            for (piece, ends) in pieces.iter().zip(values.windows(2)) {
                if ends[0] * ends[1] < 0.0 {
                    let h = self.within(event, piece, [0.0, 1.0], [ends[0], ends[1]], m);
                    corners.push(self.corner(event, piece, h, m));
                }
            }
        }
        corners
    }

    /// Crank angle and ε at a kink that lies so far from the start of a step by its quintic. At a speed of the drive the motion
    /// itself tells by how much that is off: under a steep drive ε falls fast behind the kink.
    fn corner(&self, event: Event, piece: &Piece, h: f64, m: &mut Motion<f64>) -> (f64, f64) {
        let step = self.machine.advance(piece.phi, piece.u, h, m).0;
        let [u, epsilon] = [step.X[S - 1], step.K[S - 1]];
        let Event::Speed(nth) = event else { return (piece.phi + h, epsilon) };
        let by = (0.5 * self.speeds[nth].powi(2) - u) / epsilon;
        // A motion that hardly passes the speed has no corner to speak of.
        if by.is_nan() || by.abs() > NEARLY * h {
            return (piece.phi + h, epsilon);
        }
        (piece.phi + h + by, self.machine.advance(piece.phi, piece.u, h + by, m).0.K[S - 1])
    }

    /// Kinks of the drive or of a law that the motion passes inside steps, besides those at ends that stay.
    fn crossings(
        &self,
        mesh: &Mesh,
        moves: &[Option<Move>],
        pieces: &[Piece],
        m: &mut Motion<f64>,
    ) -> Vec<Crossing> {
        let mut crossings = Vec::new();
        let cycle = self.machine.plan.cycle();
        let reaches: Vec<[f64; 2]> = pieces.iter().map(reach).collect();
        for (nth, event) in self.within_reach(pieces) {
            let values = self.at_ends(event, pieces, m);
            let near = ON_KINK * self.size(event, &values);
            let all = mesh.crossings.iter().zip(moves);
            let stays = all.filter(|(crossing, by)| crossing.nth == nth && by.is_some());
            let stays: Vec<f64> = stays.map(|(crossing, _)| crossing.phi).collect();
            let is_at = |phi: f64| stays.iter().any(|&at| at == phi || (at == 0.0 && phi == cycle));
            let middle = |piece: &Piece, m: &mut Motion<f64>| self.on_piece(event, piece, C[REFERENCE], m);
            let mut passed = Vec::new();
            let may_pass = |k: usize| match event {
                Event::Speed(nth) => {
                    let [low, high] = reaches[k];
                    (low..=high).contains(&(0.5 * self.speeds[nth].powi(2)))
                }
                Event::Law(_) => true,
            };
            for (k, piece) in pieces.iter().enumerate().filter(|&(k, _)| may_pass(k)) {
                // On the kink at its start and on either side of it around there: that end of a step is the kink's.
                let before = &pieces[(k + pieces.len() - 1) % pieces.len()];
                if values[k].abs() <= near && !is_at(piece.phi) && middle(before, m) * middle(piece, m) < 0.0
                {
                    crossings.push(Crossing { phi: piece.phi, nth });
                }
                // Beside a kink that stays the side of the step counts.
                let end = pieces.get(k + 1).map_or(cycle, |next| next.phi);
                let ends = [(piece.phi, values[k]), (end, values[k + 1])];
                let ends = ends.map(|(phi, value)| (!is_at(phi)).then_some(value));
                passed.extend(self.passed_inside(event, piece, ends, near, m));
            }
            // A jump that holds the motion is passed neither there nor where the motion comes back.
            let mut is_beyond = false;
            for passing in passed {
                let is_held = !is_beyond && self.is_held(event, &passing, m);
                if !is_beyond && !is_held && 0.0 < passing.phi && passing.phi < cycle {
                    crossings.push(Crossing { phi: passing.phi, nth });
                }
                is_beyond = is_held;
            }
        }
        crossings
    }

    /// Where a step passes an event. Of the ends those count that have a value. Between the ends the quantity is looked at amid
    /// the step and where it turns near its zero.
    fn passed_inside(
        &self,
        event: Event,
        piece: &Piece,
        [start, end]: [Option<f64>; 2],
        near: f64,
        m: &mut Motion<f64>,
    ) -> Vec<Passing> {
        let mut nodes: Vec<(f64, f64)> = start.into_iter().map(|value| (0.0, value)).collect();
        if start.is_none() || end.is_none() {
            nodes.push((C[REFERENCE], self.on_piece(event, piece, C[REFERENCE], m)));
        }
        nodes.extend(self.turns_near_zero(event, piece, m));
        nodes.extend(end.map(|value| (1.0, value)));
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes.retain(|node| node.1.abs() > near);
        let mut passed = Vec::new();
        for pair in nodes.windows(2).filter(|pair| pair[0].1 * pair[1].1 < 0.0) {
            let [from, to] = [pair[0], pair[1]];
            let phi = piece.phi + self.within(event, piece, [from.0, to.0], [from.1, to.1], m);
            let u = piece.value(&piece.quintic(), phi);
            passed.push(Passing { phi, u, beyond: to.1 });
        }
        passed
    }

    /// Shares of a step at which the quantity of a law turns near its zero or beyond, and its values there, as exact as the
    /// step.
    fn turns_near_zero(&self, event: Event, piece: &Piece, m: &mut Motion<f64>) -> Vec<(f64, f64)> {
        if let Event::Speed(nth) = event {
            return self.turns_near_speed(nth, piece, m);
        }
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            let u = if i == 0 { piece.u } else { piece.X[i - 1] };
            *value = self.value(event, AT[i].mul_add(piece.h, piece.phi), u, m);
        }
        let turns = turns_near_zero(&values).into_iter();
        let exact = |share: f64| {
            let end = self.machine.advance(piece.phi, piece.u, share * piece.h, m).0.end();
            (share, self.value(event, piece.phi + share * piece.h, end, m))
        };
        turns.map(exact).filter(|node| node.1.is_finite()).collect()
    }

    /// The same of a speed of the drive's kinks. Where the quintic clearly passes it, it is not made more exact.
    fn turns_near_speed(&self, nth: usize, piece: &Piece, m: &mut Motion<f64>) -> Vec<(f64, f64)> {
        let kink = 0.5 * self.speeds[nth].powi(2);
        let [low, high] = reach(piece);
        if kink < low || kink > high {
            return Vec::new();
        }
        let range = (high - low) / 3.0;
        let quintic = piece.quintic();
        let turns = Bernstein::of_powers(&quintic).turns(ON_KINK * kink).into_iter();
        let exact = |share: f64| {
            let beyond = value(&quintic, share) - kink;
            if beyond.abs() > NEARLY * range {
                return (share, self.on_piece(Event::Speed(nth), piece, share, m));
            }
            let end = self.machine.advance(piece.phi, piece.u, share * piece.h, m).0.end();
            (share, (2.0 * end).sqrt() - self.speeds[nth])
        };
        turns.map(exact).filter(|node| node.1.is_finite()).collect()
    }

    /// Whether a jump holds the motion where it comes to it.
    fn is_held(&self, event: Event, passing: &Passing, m: &mut Motion<f64>) -> bool {
        let Event::Law(_) = event else { return false };
        let u = self.level(event, passing.phi, passing.u, m);
        self.pull(event, passing.phi, u, m) == Pull::Holds
    }

    /// Where a motion that was solved as if there were no jump goes beyond one that holds it, by more than a share of its
    /// speed: crank angle, and speed there.
    pub fn held_inside(&self, pieces: &[Piece], share: f64, m: &mut Motion<f64>) -> Option<[f64; 2]> {
        for &kink in &self.laws {
            let event = Event::Law(kink);
            let values = self.at_ends(event, pieces, m);
            let near = ON_KINK * self.size(event, &values);
            let mut is_beyond = false;
            for (piece, ends) in pieces.iter().zip(values.windows(2)) {
                for passing in self.passed_inside(event, piece, [Some(ends[0]), Some(ends[1])], near, m) {
                    is_beyond = !is_beyond && self.is_held(event, &passing, m);
                    let u = self.level(event, passing.phi, passing.u, m);
                    let by_speed = 2.0 * (u * self.slopes(event, passing.phi, u, m)[1]).abs();
                    if is_beyond && passing.beyond.abs() > share * by_speed {
                        return Some([passing.phi, (2.0 * u).sqrt()]);
                    }
                }
            }
        }
        None
    }

    /// Where a step that keeps to a side passes a kink of a law first, as a length from its start, and the kink's number;
    /// none where it passes none. `geometry` is what laws know at its stages.
    pub fn first_of_laws(
        &self,
        side: &Side,
        piece: &Piece,
        geometry: &[LawGeometry<f64>],
        m: &mut Motion<f64>,
    ) -> Option<(f64, usize)> {
        let (mut first, speeds): (Option<(f64, usize)>, _) = (None, self.speeds.len());
        for nth in speeds..speeds + self.laws.len() {
            let mut values = [self.value(self.nth(nth), piece.phi, piece.u, m); N];
            for i in 0..S {
                let geometry = self.machine.geometry_at(geometry, i).to_vec();
                values[i + 1] = self.on_side(nth, &Side { geometry, u: piece.X[i] });
            }
            let near = ON_KINK * self.size(self.nth(nth), &values);
            // A step may start on the kink itself, or beyond it by rounding.
            let from = self.on_side(nth, side).signum();
            let start = from * near.max(from * values[0]);
            let machine = side.of(&self.machine);
            let mut excess = |x: f64| {
                let end = machine.advance(piece.phi, piece.u, x, m).0.end();
                self.value(self.nth(nth), piece.phi + x, end, m)
            };
            let mut nodes: Vec<(f64, f64)> = AT.into_iter().zip(values).collect();
            nodes[0].1 = start;
            nodes.extend(turns_near_zero(&values).into_iter().map(|share| (share, excess(share * piece.h))));
            nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
            let is_passed = |node: &(f64, f64)| node.1 * from < 0.0 && node.1.abs() > near;
            let Some(to) = nodes.iter().position(is_passed) else { continue };
            let [from, to] = [nodes[to - 1], nodes[to]];
            let (start, length) = (from.0 * piece.h, (to.0 - from.0) * piece.h);
            let at = start + crossing(|x| excess(start + x), length, from.1, to.1);
            if first.is_none_or(|(least, _)| at < least) {
                first = Some((at, nth));
            }
        }
        first
    }

    /// The quantity whose zero the kink of a law is, on a side.
    fn on_side(&self, nth: usize, side: &Side) -> f64 {
        let kink = self.laws[nth - self.speeds.len()];
        let at = [(2.0 * side.u).sqrt(), f64::NAN];
        self.machine.plan.speed_kink_value(self.machine.q, kink, &side.geometry, at)
    }

    /// The side of a motion that goes on at a crank angle, a little ahead.
    pub fn ahead(&self, phi: f64, u: f64, h: f64, m: &mut Motion<f64>) -> Side {
        let (step, geometry) = self.machine.advance(phi, u, h * AHEAD, m);
        // Newton may not find a way through a jump there.
        let u = if step.X[S - 1].is_finite() { step.X[REFERENCE] } else { u };
        Side { geometry: self.machine.geometry_at(&geometry, REFERENCE).to_vec(), u }
    }

    /// The side above a state, or below it.
    pub fn beside(&self, phi: f64, u: f64, above: bool, m: &mut Motion<f64>) -> Side {
        let mut geometry = Vec::new();
        self.machine.row(phi, m, &mut geometry);
        Side { geometry, u: u * if above { 1.0 + NUDGE } else { 1.0 - NUDGE } }
    }

    /// The side behind a kink of a law that the motion passes, and how it passes it; `epsilon` is that before.
    pub fn behind(
        &self,
        nth: usize,
        before: &Side,
        [phi, u, epsilon]: [f64; 3],
        m: &mut Motion<f64>,
    ) -> (Side, Passage<f64>) {
        let event = self.nth(nth);
        let slopes = self.slopes(event, phi, u, m);
        let from = self.on_side(nth, before);
        // Beside the kink in u; in φ where its level is upright.
        let side = if (slopes[1] * u).abs() > slopes[0].abs() * UPRIGHT {
            self.beside(phi, u, from * slopes[1] < 0.0, m)
        } else {
            Side { u, ..self.beside(phi + NUDGE, u, true, m) }
        };
        let mut geometry = Vec::new();
        let row = self.machine.row(phi, m, &mut geometry);
        let behind = self.machine.acceleration_on_branch(&row, &geometry, u, (&side.geometry, side.u)).value;
        let passage = self.passage(event, phi, u, [epsilon, behind], m);
        (side, passage)
    }

    /// The jump of a law on which the motion is held: there, within the share `near` of u, the torques of both sides drive it
    /// back. It slides along the jump then (Filippov, *Differential Equations with Discontinuous Righthand Sides*, 1988,
    /// § 4), and the law has some value between those of its sides.
    pub fn held(&self, phi: f64, u: f64, near: f64, m: &mut Motion<f64>) -> Option<Event> {
        self.laws.iter().copied().map(Event::Law).find(|&event| {
            let level = self.level(event, phi, u, m);
            (level / u - 1.0).abs() <= near && self.pull(event, phi, level, m) == Pull::Holds
        })
    }

    /// u on the zero of an event, near the given one, by Newton.
    pub fn level(&self, event: Event, phi: f64, mut u: f64, m: &mut Motion<f64>) -> f64 {
        for _ in 0..LEVEL_SWEEPS {
            u -= self.value(event, phi, u, m) / self.slopes(event, phi, u, m)[1];
        }
        u
    }

    /// What the torques beside the zero of an event do with a motion that is on it.
    pub fn pull(&self, event: Event, phi: f64, u: f64, m: &mut Motion<f64>) -> Pull {
        let [by_phi, by_u] = self.slopes(event, phi, u, m);
        let mut geometry = Vec::new();
        let row = self.machine.row(phi, m, &mut geometry);
        let epsilon = |share: f64| self.machine.acceleration(&row, &geometry, u * (1.0 + share)).value;
        // How fast u leaves the zero on either side of it.
        let [below, above] = [-ASIDE, ASIDE].map(|x| 2.0 * epsilon(x) - epsilon(2.0 * x) + by_phi / by_u);
        if below > 0.0 && above < 0.0 && below - above > NO_JUMP * u {
            Pull::Holds
        } else if above > 0.0 {
            Pull::Up
        } else {
            Pull::Down
        }
    }

    /// Growth of a step that ends on a kink of the drive.
    fn growth_on_side(&self, piece: &Piece, m: &mut Motion<f64>) -> f64 {
        let (step, geometry) = self.machine.step_of(piece.phi, piece.h, piece.u, piece.X, m);
        self.machine.growth_on_side(&step, &geometry)
    }

    /// What is known of the kinks at ends of steps, on which the multiplier depends.
    pub fn kinks_at_ends(
        &self,
        passages: &[(usize, Passage<f64>)],
        pieces: &[Piece],
        m: &mut Motion<f64>,
    ) -> Vec<KinkAtEnd> {
        let of_passage = |&(step, ref passage): &(usize, Passage<f64>)| {
            let [before, behind] = [&pieces[step], &pieces[(step + 1) % pieces.len()]];
            let (phi, u) = (before.phi + before.h, passage.u);
            let sides = [
                self.slope_on_branch_of(before, phi, u, m),
                self.slope_on_branch_of(behind, behind.phi, u, m),
            ];
            let change = sides[0] - sides[1];
            let late = passage.late();
            let room = before.h.min(behind.h);
            KinkAtEnd {
                step,
                exponent: if late.abs() < NEARLY * room { change * late } else { 0.0 },
                per_u: (change * passage.late_by_u()).abs(),
                most: change.abs() * room,
            }
        };
        passages.iter().map(of_passage).collect()
    }

    /// ∂ε/∂u on the branch of a step.
    fn slope_on_branch_of(&self, piece: &Piece, phi: f64, u: f64, m: &mut Motion<f64>) -> f64 {
        let (mut geometry, mut known) = (Vec::new(), Vec::new());
        self.machine.row(C[REFERENCE].mul_add(piece.h, piece.phi), m, &mut known);
        let row = self.machine.row(phi, m, &mut geometry);
        let at = piece.X[REFERENCE];
        self.machine.acceleration_on_branch(&row, &geometry, u, (&known, at)).d
            + self.machine.slope_besides(&row, u, at)
    }

    /// The multiplier: the growths of all steps, on the side of their kinks on which they lie, and up to where these are
    /// passed.
    pub fn multiplier(
        &self,
        growths: &[f64],
        passages: &[(usize, Passage<f64>)],
        kinks: &[KinkAtEnd],
        pieces: &[Piece],
        m: &mut Motion<f64>,
    ) -> f64 {
        let mut multiplier: f64 = growths.iter().product();
        for ((k, passage), kink) in passages.iter().zip(kinks) {
            // What the step has counted for so far, on the side that rounding chose.
            let side = self.growth_on_side(&pieces[*k], m) / growths[*k];
            multiplier *= passage.factor() * side * kink.exponent.exp();
        }
        multiplier
    }
}

impl<R: Real> Turn<R> {
    /// Takes u through the kinks at ends of steps: for each the number of the step before, and how the motion passes it.
    #[inline(always)]
    pub fn pass(&mut self, passages: &[(usize, Passage<f64>)]) {
        let n = self.steps.len() * R::LANES;
        let (mut scale, mut offset) = (vec![1.0; n], vec![0.0; n]);
        for (k, passage) in passages {
            let [by, and] = passage.through();
            // Where a kink holds the motion, or drives it away on both sides, it is not passed.
            if by > 0.0 && by.is_finite() && and.is_finite() {
                (scale[*k], offset[*k]) = (by, and);
            }
        }
        let pairs = bundle(&scale).into_iter().zip(bundle(&offset));
        self.passed = pairs.map(|(scale, offset)| [scale, offset]).collect();
    }
}

/// Shares of a step at which a quantity with these values at its start and stages turns near its zero or beyond it.
pub fn turns_near_zero(values: &[f64; N]) -> Vec<f64> {
    let quintic = through(values);
    let room = NEARLY * values.iter().fold(0.0, |size: f64, value| value.abs().max(size));
    let is_near = |share: &f64| {
        let value = value(&quintic, *share);
        value.abs() <= room || value * values[0] < 0.0 || value * values[N - 1] < 0.0
    };
    Bernstein::of_powers(&quintic).turns(ON_KINK * room).into_iter().filter(is_near).collect()
}

/// How far u leaps at ends of steps where the motion is taken through kinks, as a share of itself: what is left of the way
/// from such an end to its kink.
pub fn leap(mesh: &Mesh, pieces: &[Piece]) -> f64 {
    let leaps = mesh.crossings.iter().map(|crossing| {
        let [before, behind] = beside(crossing.phi, pieces);
        (behind.u / before.X[S - 1] - 1.0).abs()
    });
    leaps.fold(0.0, f64::max)
}

/// The smallest and the largest u that a step may have: its quintic leaves the range of its six samples by less than three
/// quarters of it, and an end on a kink leaves it by rounding.
fn reach(piece: &Piece) -> [f64; 2] {
    let (low, high) = piece.X.iter().fold((piece.u, piece.u), |(low, high), &u| (low.min(u), high.max(u)));
    let room = (high - low).max(4.0 * ON_KINK * high);
    [low - room, high + room]
}

/// Number of the step that ends at a crank angle: the last one for the start of the revolution.
fn before(phi: f64, pieces: &[Piece]) -> usize {
    let behind = pieces.partition_point(|piece| piece.phi < phi);
    (behind + pieces.len() - 1) % pieces.len()
}

/// The steps before and behind a crank angle.
fn beside(phi: f64, pieces: &[Piece]) -> [&Piece; 2] {
    let k = before(phi, pieces);
    [&pieces[k], &pieces[(k + 1) % pieces.len()]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A kink at u = 10 + ½φ on a motion with ε = 2 before and 5 behind, from u at φ = 0: passed at φ = (10 − u)/1.5.
    #[test]
    fn u_behind_a_jump_lies_on_the_motion_behind_it() {
        for made_from in [9.0, 9.7, 10.4] {
            let [before, behind] = [2.0, 5.0];
            let passage = Passage { u: made_from, g: made_from - 10.0, slopes: [-0.5, 1.0], before, behind };
            let [scale, offset] = passage.through();
            for u in [9.0, 10.0, 11.0] {
                let at = (10.0 - u) / 1.5;
                let expected = u + before * at - behind * at;
                assert!((scale * u + offset - expected).abs() < 1e-12, "{made_from} {u}");
            }
        }
    }
}
