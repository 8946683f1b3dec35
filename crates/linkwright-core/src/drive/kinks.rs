//! Where over the revolution the reduced machine is not smooth: dead centres under dry friction, knots of tables.
//!
//! A dry resistance enters the energy equation as F·|s′|, which has a kink where the slide turns back
//! (s′ = 0); a table has one at each knot; a formula where the argument of `abs`, `sign`, `step`, `min`,
//! `max` or `where` changes sign. Between these angles everything is smooth, so a method of high
//! order keeps its order when it goes from kink to kink.
//!
//! Smooth, but as steep as one pleases: the friction c·tanh(k v) of a formula takes on its sign within a small angle beside
//! a dead centre. Steps of a steady motion therefore end where a speed that a formula knows is zero, and where the force
//! changes fast beside that angle, there too; and wherever else a formula is steep ([`crate::drive::steep`]).

use crate::drive::equation::Machine;
use crate::drive::law::Moment;
use crate::drive::layout::unbundle;
use crate::drive::loads::{At, FormulaLoad, Load, What};
use crate::drive::steep::{Along, SteepKind, Steepness};
use crate::drive::structure::Plan;
use crate::kernel::dual::Dual;
use crate::kernel::formula::Variable;
use crate::kernel::out_of_line;
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use crate::kernel::table::{Knot, Table};
use crate::linkage::mechanism::Element;
use crate::linkage::motion::{Motion, stretch};
use std::f64::consts::TAU;

/// A quantity whose zeros over the revolution are kinks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Watch {
    /// What a load acts on turns back; a point comes to rest, on whatever path.
    Turns(At),
    /// It passes a knot of a table over its position.
    Passes(At, Knot),
    /// The point turns back in the direction of x, or of y.
    PointTurns(usize, Axis),
    /// A spring of this free length passes, or nearly passes, through its own anchor.
    Anchor(usize, usize, Slot),
    /// A switch of a formula.
    Switch(FormulaLoad, usize),
}

/// An axis of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    X,
    Y,
}

/// A spring that gets shorter than this share of its free length turns round so fast that it counts as a
/// kink.
const SHORT: f64 = 0.1;

/// A point rests where its path speed p′ falls below this share of p″.
const AT_REST: f64 = 1e-6;

/// Angles of a revolution at which zeros are looked for. Two zeros between neighbours are found where the cubic through
/// values and slopes dips towards zero.
const SCAN: usize = 48;

/// The bottom of a dip is looked for where the cubic falls below this share of the smaller value beside it.
const DIP: f64 = 0.5;

/// Steps of the secant towards the bottom of a dip.
const BOTTOM_STEPS: usize = 8;

/// Newton steps to a zero: the guess is good to (2π/48)² ~ 1e-2, Newton squares it: 1e-4, 1e-8, 1e-16.
const POLISHES: usize = 4;

/// Where the quantity bends, Newton is kept inside a bracket that shrinks, until it moves by less than this
/// \[rad\], with at most so many steps.
const POLISHED: f64 = 1e-12;
const POLISHES_MAX: usize = 60;

/// An interval in which a watched quantity changes sign, and where about.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    low: f64,
    high: f64,
    guess: f64,
    /// Sign of the quantity at the low end.
    sign: f64,
}

/// An interval at whose ends a watched quantity of one sign goes towards zero, with its slopes there.
#[derive(Clone, Copy, Debug)]
struct Dip {
    low: f64,
    values: [f64; 2],
    slopes: [f64; 2],
}

/// Share of a scan interval by which the scan is shifted, so that the round angles at which dead centres
/// tend to lie (0°, 90°, …) fall inside intervals.
const SHIFT: f64 = 0.37;

/// A crank angle this near to a zero \[rad\] is on the kink.
pub const ON_KINK: f64 = 1e-9;

/// Zeros closer than this \[rad\] to the end of the revolution count as its start: rounding must not decide.
const WRAP: f64 = 1e-7;

/// A force that changes within a small angle beside a rest is looked for from the first angle \[rad\] on at so many, each this
/// share of the one before. Between two of them a smooth one changes by about this share of its change between the two before;
/// it is steep where it changes by more than the next share of that, and by more than the last share of its size.
const FARTHEST: f64 = 0.04;
const LOOKS: usize = 9;
const NEARER: f64 = 0.25;
const STEEP: f64 = 0.5;
const SLIGHT: f64 = 1e-3;

/// Such a force is sought out by ends of steps, so many times as far from the rest as it changes within, but for those that
/// would lie farther than the next \[rad\], or nearer to another end than the last share of their distance.
const STEEP_ENDS: [f64; 3] = [1.5, 8.0, 40.0];
const STEEP_FARTHEST: f64 = 0.1;
const STEEP_ROOM: f64 = 0.3;

impl Plan {
    /// All quantities to be watched, each once: two loads may ask for the same.
    fn watches(&self) -> Vec<Watch> {
        let mut watches = Vec::new();
        for watch in self.all_watches() {
            if !watches.contains(&watch) {
                watches.push(watch);
            }
        }
        watches
    }

    /// The same as often as loads ask for them: each with what moves it.
    pub fn all_watches(&self) -> Vec<Watch> {
        let mut watches = Vec::new();
        let switches = self.still_switches().into_iter();
        watches.extend(switches.map(|(load, at)| Watch::Switch(load, at)));
        for Load { at, what } in self.laws.iter().chain(&self.loads) {
            if what.bends_at_rest() && *at != At::Crank {
                watches.push(Watch::Turns(*at));
            }
            if what.knows_position() {
                let knots = what.numbers().1.into_iter().flat_map(|table| self.tables[table].moving_knots());
                watches.extend(knots.map(|knot| Watch::Passes(*at, knot)));
            }
            if let (&At::Between { from, to }, &What::Spring { free_length, .. }) = (at, what) {
                watches.push(Watch::Anchor(from, to, free_length));
            }
        }
        watches
    }

    /// Formulas in all loads.
    fn all_formulas(&self) -> impl Iterator<Item = FormulaLoad> + '_ {
        self.loads.iter().chain(&self.laws).filter_map(Load::formula)
    }

    /// Formulas in all loads with the switches whose zeros are crank angles that no speed moves.
    fn still_switches(&self) -> Vec<(FormulaLoad, usize)> {
        let mut found = Vec::new();
        for load in self.all_formulas() {
            let switches = &self.formulas[load.formula].switches;
            found.extend(switches.iter().filter(|s| s.is_still()).map(|s| (load, s.at)));
        }
        found
    }

    /// Whether the argument of a switch of a formula may be zero more often than a scan sees.
    fn winds(&self, load: FormulaLoad, at: usize) -> bool {
        self.formulas[load.formula].switches.iter().any(|switch| switch.at == at && switch.winds)
    }

    /// Formulas in all loads with what is zero where a speed that they know is.
    fn rests(&self) -> Vec<(FormulaLoad, Watch)> {
        let mut found = Vec::new();
        for load in self.all_formulas() {
            let formula = &self.formulas[load.formula];
            let speeds = load.at.speeds().into_iter().filter(|(speed, _)| formula.reads(*speed));
            found.extend(speeds.map(|(_, watch)| (load, watch)));
        }
        found
    }

    /// Whether some formula may hide something beside the end of a step: it knows a speed that comes to zero, or may be steep.
    pub fn may_hide(&self) -> bool {
        !self.rests().is_empty() || self.may_be_steep()
    }

    /// Tables over the crank angle, with the revolutions after which each repeats.
    pub fn angle_tables(&self) -> impl Iterator<Item = (&Table, u32)> {
        self.loads.iter().filter_map(|load| match load.what {
            What::OverAngle { table, turns } => Some((&self.tables[table], turns)),
            _ => None,
        })
    }

    /// Their knots within the cycle.
    fn angle_knots(&self) -> Vec<f64> {
        let mut knots = Vec::new();
        for (table, turns) in self.angle_tables() {
            for first in (0..self.turns).step_by(turns as usize) {
                let start = TAU * f64::from(first);
                let within = |knot: &f64| start + knot.rem_euclid(TAU * f64::from(turns));
                knots.extend(table.knots().iter().map(within));
            }
        }
        knots
    }

    /// Angles of a cycle at which zeros are looked for.
    fn scan(&self) -> usize {
        SCAN * self.turns as usize
    }
}

impl<R: Real> Machine<'_, R> {
    /// The watched quantity and its derivative by φ.
    #[inline(always)]
    pub fn watched(&self, watch: Watch, phi: R, m: &Motion<R>) -> (R, R) {
        match watch {
            Watch::Turns(at) => at.turning(self.q, m),
            Watch::Passes(at, knot) => {
                let way = at.way(true, self.q, m);
                (way.position - knot.number(self.q), way.d1)
            }
            Watch::Anchor(from, to, _) => At::Between { from, to }.turning(self.q, m),
            Watch::PointTurns(point, axis) => {
                let (d1, d2) = (m.points[point].d1, m.points[point].d2);
                if axis == Axis::X { (d1.x, d2.x) } else { (d1.y, d2.y) }
            }
            Watch::Switch(load, at) => self.plan.switch_over_angle((load, at), self.q, phi, m),
        }
    }

    /// Ends of the smooth pieces of the cycle of each lane: increasing from 0 to its end.
    #[inline(always)]
    pub fn breaks(&self, m: &mut Motion<R>) -> Vec<Vec<f64>> {
        out_of_line!(R, {
            let mut lanes: Vec<Vec<f64>> = vec![vec![0.0]; R::LANES];
            let watches = self.plan.watches();
            if !watches.is_empty() {
                let scan = self.scan(&watches, m);
                for (&watch, values) in watches.iter().zip(scan.chunks_exact(2 * self.plan.scan() * R::LANES))
                {
                    match watch {
                        Watch::Switch(load, at) if self.plan.winds(load, at) => {
                            let brackets = self.for_each_lane(|q| brackets(self.plan, q, load, at));
                            self.add_zeros(watch, &brackets, &mut lanes, m);
                        }
                        _ => self.zeros(watch, values, &mut lanes, m),
                    }
                }
            }
            self.programme_joints(&mut lanes);
            let cycle = self.plan.cycle();
            for lane in &mut lanes {
                lane.extend(self.plan.angle_knots());
                for angle in lane.iter_mut() {
                    *angle = if *angle > cycle - WRAP { 0.0 } else { *angle };
                }
                lane.push(cycle);
                lane.sort_by(f64::total_cmp);
                lane.dedup();
            }
            lanes
        })
    }

    /// The same, and ends of steps at rests and where a formula is steep: between two stages of a long step nothing would be
    /// seen of it.
    #[inline(always)]
    pub fn ends(&self, m: &mut Motion<R>) -> Vec<Vec<f64>> {
        out_of_line!(R, {
            let mut lanes = self.breaks(m);
            let breaks = if self.plan.may_be_steep() { lanes.clone() } else { Vec::new() };
            self.add_rests(&mut lanes, m);
            let mut of_lanes = breaks.iter().zip(&mut lanes);
            self.for_each_lane(|q| {
                if let Some((breaks, ends)) = of_lanes.next() {
                    add_steep(self.plan, q, breaks, ends);
                }
            });
            lanes
        })
    }

    /// What comes of the numbers of each lane.
    fn for_each_lane<T>(&self, mut act: impl FnMut(&[f64]) -> T) -> Vec<T> {
        let numbers = unbundle(self.q);
        let of_lane = |lane| numbers.iter().skip(lane).step_by(R::LANES).copied().collect::<Vec<_>>();
        (0..R::LANES).map(|lane| act(&of_lane(lane))).collect()
    }

    /// Adds ends of steps at rests, and beside those at which the force of a formula changes within a small angle.
    #[inline(always)]
    fn add_rests(&self, lanes: &mut [Vec<f64>], m: &mut Motion<R>) {
        let rests = self.plan.rests();
        if rests.is_empty() {
            return;
        }
        let watches: Vec<Watch> = rests.iter().map(|rest| rest.1).collect();
        let scan = self.scan(&watches, m);
        for (&(load, watch), values) in rests.iter().zip(scan.chunks_exact(2 * self.plan.scan() * R::LANES)) {
            let mut zeros = vec![Vec::new(); R::LANES];
            self.zeros(watch, values, &mut zeros, m);
            for nth in 0..zeros.iter().map(Vec::len).max().unwrap_or(0) {
                let at = |lane: usize| zeros[lane].get(nth).copied();
                let mut places: Vec<f64> = (0..R::LANES).map(|lane| at(lane).unwrap_or(0.0)).collect();
                let zero = R::load(&places);
                let widths = [-1.0, 1.0].map(|side| {
                    let width = self.width(&load, zero, side, m);
                    width.store(&mut places);
                    places.clone()
                });
                for (lane, ends) in lanes.iter_mut().enumerate() {
                    if let Some(zero) = at(lane) {
                        add_ends_beside(zero, [widths[0][lane], widths[1][lane]], ends);
                    }
                }
            }
        }
    }

    /// Angle within which the force of a formula changes steeply on one side of a rest, at the speed at which the search starts;
    /// 0 where it does not.
    #[inline(always)]
    fn width(&self, load: &FormulaLoad, zero: R, side: f64, m: &mut Motion<R>) -> R {
        out_of_line!(R, {
            let (mut forces, mut largest) = ([zero; LOOKS], R::splat(0.0));
            let mut off = FARTHEST;
            for force in &mut forces {
                let phi = zero + R::splat(side * off);
                self.plan.mechanism.place::<R, 1>(self.q, Angle::new(phi), m);
                *force = self.plan.force(load, self.q, phi, self.q[self.plan.drive.speed_start], m);
                largest = largest.max(force.abs());
                off *= NEARER;
            }
            let (mut width, mut off) = (R::splat(0.0), FARTHEST);
            let mut before = (forces[0] - forces[1]).abs();
            for ends in forces[1..].windows(2) {
                off *= NEARER;
                let change = (ends[0] - ends[1]).abs();
                let first = width.select_lt(R::splat(f64::MIN_POSITIVE), R::splat(off), width);
                width = (before * STEEP).max(largest * SLIGHT).select_lt(change, first, width);
                before = change;
            }
            width
        })
    }

    /// Adds the joints of motion laws in pieces, where a derivative jumps.
    #[inline(always)]
    fn programme_joints(&self, lanes: &mut [Vec<f64>]) {
        let mut row = vec![0.0; R::LANES];
        for element in &self.plan.mechanism.elements {
            let Element::Programme(programme) = element else { continue };
            for piece in programme.law.pieces() {
                (self.q[programme.phase] + piece.start).store(&mut row);
                for (lane, joint) in lanes.iter_mut().zip(&row) {
                    let turns = (0..self.plan.turns).map(|turn| TAU * f64::from(turn));
                    lane.extend(turns.map(|start| start + joint.rem_euclid(TAU)));
                }
            }
        }
    }

    /// All watched quantities over the scan angles with their slopes: watch by watch, values before slopes,
    /// angle by angle, lane by lane.
    #[inline(always)]
    fn scan(&self, watches: &[Watch], m: &mut Motion<R>) -> Vec<f64> {
        out_of_line!(R, {
            let n = self.plan.scan();
            let mut values = vec![0.0; watches.len() * 2 * n * R::LANES];
            for i in 0..n {
                let phi = R::splat(scan_angle(i));
                self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
                for (w, watch) in watches.iter().enumerate() {
                    let (value, slope) = self.watched(*watch, phi, m);
                    value.store(&mut values[(2 * w * n + i) * R::LANES..]);
                    slope.store(&mut values[((2 * w + 1) * n + i) * R::LANES..]);
                }
            }
            values
        })
    }

    /// Adds the zeros of one watched quantity to each lane's list.
    #[inline(always)]
    fn zeros(&self, watch: Watch, values: &[f64], lanes: &mut [Vec<f64>], m: &mut Motion<R>) {
        out_of_line!(R, {
            let n = self.plan.scan();
            let (values, slopes) = values.split_at(n * R::LANES);
            let (mut brackets, mut dips) = (vec![Vec::new(); R::LANES], vec![Vec::new(); R::LANES]);
            let mut pairs = vec![Vec::new(); R::LANES];
            for lane in 0..R::LANES {
                let at = |list: &[f64], i: usize| list[(i % n) * R::LANES + lane];
                for i in 0..n {
                    let (a, b) = (at(values, i), at(values, i + 1));
                    if a * b < 0.0 {
                        let (low, width) = (scan_angle(i), TAU / SCAN as f64);
                        brackets[lane].push(Bracket {
                            low,
                            high: low + width,
                            guess: low + a / (a - b) * width,
                            sign: a.signum(),
                        });
                        continue;
                    }
                    let slopes = [at(slopes, i), at(slopes, i + 1)];
                    if slopes[0] * a.signum() >= 0.0 || slopes[1] * a.signum() <= 0.0 {
                        continue;
                    }
                    let dip = Dip { low: scan_angle(i), values: [a, b], slopes };
                    if dip.is_deep() {
                        dips[lane].push(dip);
                    }
                }
            }
            for nth in 0..dips.iter().map(Vec::len).max().unwrap_or(0) {
                self.split(watch, nth, &dips, &mut pairs, m);
            }
            self.add_zeros(watch, &brackets, lanes, m);
            self.add_zeros(watch, &pairs, lanes, m);
        })
    }

    /// Adds the zeros in the brackets of each lane to its list.
    #[inline(always)]
    fn add_zeros(&self, watch: Watch, brackets: &[Vec<Bracket>], lanes: &mut [Vec<f64>], m: &mut Motion<R>) {
        out_of_line!(R, {
            let [mut low, mut high, mut guess, mut sign] =
                [const { Vec::new() }; 4].map(|_: Vec<f64>| vec![0.0; R::LANES]);
            for nth in 0..brackets.iter().map(Vec::len).max().unwrap_or(0) {
                for lane in 0..R::LANES {
                    if let Some(bracket) = brackets[lane].get(nth) {
                        (low[lane], high[lane]) = (bracket.low, bracket.high);
                        (guess[lane], sign[lane]) = (bracket.guess, bracket.sign);
                    }
                }
                let root = out_of_line!(
                    R,
                    self.polish(watch, [R::load(&low), R::load(&high), R::load(&sign)], R::load(&guess), m)
                );
                root.store(&mut guess);
                for lane in 0..R::LANES {
                    if brackets[lane].len() > nth && guess[lane].is_finite() {
                        lanes[lane].push(guess[lane].rem_euclid(self.plan.cycle()));
                    }
                }
            }
        })
    }

    /// Goes to the bottom of one dip a lane, and adds brackets on either side where it lies beyond zero.
    #[inline(always)]
    fn split(
        &self,
        watch: Watch,
        nth: usize,
        dips: &[Vec<Dip>],
        brackets: &mut [Vec<Bracket>],
        m: &mut Motion<R>,
    ) {
        out_of_line!(R, {
            let width = TAU / SCAN as f64;
            let of = |lane: usize| dips[lane].get(nth).copied().unwrap_or(Dip::NONE);
            let load = |of: &dyn Fn(usize) -> f64| R::load(&(0..R::LANES).map(of).collect::<Vec<_>>());
            let sign = load(&|lane| of(lane).values[0].signum());
            let (mut low, mut high) = (load(&|lane| of(lane).low), load(&|lane| of(lane).low + width));
            let (mut falls, mut rises) = (load(&|lane| of(lane).slopes[0]), load(&|lane| of(lane).slopes[1]));
            (falls, rises) = (falls * sign, rises * sign);
            let (zero, mut bottom, mut least) = (R::splat(0.0), low, R::splat(f64::INFINITY));
            for _ in 0..BOTTOM_STEPS {
                let phi = (low * rises - high * falls) / (rises - falls);
                self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
                let (value, slope) = self.watched(watch, phi, m);
                let (value, slope) = (value * sign, slope * sign);
                bottom = value.select_lt(least, phi, bottom);
                least = least.min(value);
                (low, falls) = (slope.select_lt(zero, phi, low), slope.select_lt(zero, slope, falls));
                (high, rises) = (slope.select_lt(zero, high, phi), slope.select_lt(zero, rises, slope));
            }
            let (mut place, mut depth) = (vec![0.0; R::LANES], vec![0.0; R::LANES]);
            bottom.store(&mut place);
            least.store(&mut depth);
            for (lane, brackets) in brackets.iter_mut().enumerate() {
                if let Some(dip) = dips[lane].get(nth).filter(|_| depth[lane] < 0.0) {
                    brackets.extend(dip.halves(place[lane], depth[lane], width));
                }
            }
        })
    }

    /// Newton from a linear guess, kept inside the bracket.
    #[inline(always)]
    fn polish(&self, watch: Watch, [low, high, sign]: [R; 3], guess: R, m: &mut Motion<R>) -> R {
        out_of_line!(R, {
            let (mut phi, mut low, mut high) = (guess, low, high);
            let (zero, mut change) = (R::splat(0.0), R::splat(f64::INFINITY));
            for polish in 0..POLISHES_MAX {
                if polish >= POLISHES && change.max_lane() < POLISHED {
                    break;
                }
                self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
                let (value, slope) = self.watched(watch, phi, m);
                // On the lower side of the zero the value has the sign that it has at the low end.
                let below = zero.select_lt(value * sign, R::splat(1.0), zero);
                (low, high) = (zero.select_lt(below, phi, low), zero.select_lt(below, high, phi));
                let newton = phi - value / slope;
                let middle = (low + high) * 0.5;
                let inside = newton.select_lt(low, middle, high.select_lt(newton, middle, newton));
                let next = value.abs().select_lt(R::splat(f64::MIN_POSITIVE), phi, inside);
                // A lane that is there stays: its last bits do not depend on how long another takes.
                let there = R::splat(if polish < POLISHES { 0.0 } else { POLISHED });
                let moved = change.select_lt(there, change, (next - phi).abs());
                (phi, change) = (change.select_lt(there, phi, next), moved);
            }
            zero.select_lt(self.room(watch, m), phi, R::splat(f64::NAN))
        })
    }

    /// Positive where a zero of the watched quantity is a kink.
    #[inline(always)]
    pub fn room(&self, watch: Watch, m: &Motion<R>) -> R {
        match watch {
            // Where the spring stays long its extremes are smooth.
            Watch::Anchor(from, to, free_length) => self.q[free_length] * SHORT - stretch(m, from, to).0,
            // Elsewhere the path speed has an extreme only.
            Watch::Turns(At::Point { point }) => {
                let place = &m.points[point];
                place.d2.dot(place.d2) * (AT_REST * AT_REST) - place.d1.dot(place.d1)
            }
            _ => R::splat(1.0),
        }
    }
}

impl Dip {
    /// A lane without one; nothing of it is used.
    const NONE: Dip = Dip { low: 0.0, values: [1.0; 2], slopes: [-1.0, 1.0] };

    /// Whether the cubic through values and slopes comes near zero or beyond.
    fn is_deep(&self) -> bool {
        let [a, b] = self.values.map(f64::abs);
        let sign = self.values[0].signum();
        let [left, right] = self.slopes.map(|slope| slope * sign * TAU / SCAN as f64);
        if !(left < 0.0 && right > 0.0) {
            return false;
        }
        (1..8).any(|i| {
            let x = f64::from(i) / 8.0;
            let (y, up) = (1.0 - x, x * x * (3.0 - 2.0 * x));
            a * (1.0 - up) + b * up + left * x * y * y - right * x * x * y < DIP * a.min(b)
        })
    }

    /// The brackets on either side of a bottom beyond zero, with the zeros of parabolas.
    fn halves(&self, bottom: f64, depth: f64, width: f64) -> [Bracket; 2] {
        let high = self.low + width;
        let guess = |end: f64, value: f64| {
            let share = (depth.abs() / (depth.abs() + value.abs())).sqrt();
            bottom + (end - bottom) * share
        };
        [
            Bracket {
                low: self.low,
                high: bottom,
                guess: guess(self.low, self.values[0]),
                sign: self.values[0].signum(),
            },
            Bracket { low: bottom, high, guess: guess(high, self.values[1]), sign: -self.values[0].signum() },
        ]
    }
}

impl At {
    /// Speeds that a formula may know here, each with what is zero where it is.
    fn speeds(self) -> Vec<(Variable, Watch)> {
        let of_point = |point| {
            [
                (Variable::Vx, Watch::PointTurns(point, Axis::X)),
                (Variable::Vy, Watch::PointTurns(point, Axis::Y)),
            ]
        };
        let mut speeds = match self {
            At::Slide { point, .. } => {
                [(Variable::V, Watch::Turns(self))].into_iter().chain(of_point(point)).collect()
            }
            At::Point { point } | At::Toward { point, .. } | At::Along { point, .. } => {
                [(Variable::V, Watch::Turns(At::Point { point }))]
                    .into_iter()
                    .chain(of_point(point))
                    .collect()
            }
            _ => Vec::new(),
        };
        if let At::Along { link, .. } | At::Link { link } = self {
            speeds.push((Variable::PsiDot, Watch::Turns(At::Link { link })));
        }
        speeds
    }
}

/// Brackets of the zeros of the argument of a switch that no speed moves.
fn brackets(plan: &Plan, q: &[f64], load: FormulaLoad, at: usize) -> Vec<Bracket> {
    let mut m = Motion::new(&plan.mechanism, q);
    let moment = |phi| Moment::steady(phi, Dual::constant(1.0));
    let along = Along::cycle(plan, &moment, &[0.0, plan.cycle()]);
    let zeros = Steepness::new(plan, q, load, SteepKind::Still, &mut m).zeros(&along, at, &mut m);
    let of_zero = |[low, high]: [f64; 2]| {
        plan.mechanism.place::<f64, 2>(q, Angle::new(low), &mut m);
        let sign = plan.switch_over_angle((load, at), q, low, &m).0;
        Bracket { low, high, guess: 0.5 * (low + high), sign: if sign < 0.0 { -1.0 } else { 1.0 } }
    };
    zeros.into_iter().map(of_zero).collect()
}

/// Adds ends where formulas are steep whatever the speed.
fn add_steep(plan: &Plan, q: &[f64], breaks: &[f64], ends: &mut Vec<f64>) {
    let (mut m, omega) = (Motion::new(&plan.mechanism, q), Dual::constant(q[plan.drive.speed_start]));
    let moment = |phi| Moment::steady(phi, omega);
    let along = Along::cycle(plan, &moment, breaks);
    for load in plan.all_formulas().filter(|load| plan.is_steep(load, SteepKind::Still)) {
        Steepness::new(plan, q, load, SteepKind::Still, &mut m).add_ends(&along, ends, &mut m);
    }
}

/// Adds a rest, and ends on both sides of it within which a force changes steeply, to those of a cycle.
fn add_ends_beside(rest: f64, widths: [f64; 2], ends: &mut Vec<f64>) {
    let cycle = ends[ends.len() - 1];
    let mut places = vec![(rest, 0.0)];
    for (side, width) in [-1.0, 1.0].into_iter().zip(widths).filter(|(_, width)| *width > 0.0) {
        let beside = STEEP_ENDS.into_iter().map(|times| times * width).filter(|&off| off < STEEP_FARTHEST);
        places.extend(beside.map(|off| (rest + side * off, off)));
    }
    for (place, off) in places {
        let (place, room) = (place.rem_euclid(cycle), ON_KINK.max(STEEP_ROOM * off));
        if ends.iter().all(|end| (end - place).abs() > room) {
            ends.push(place);
        }
    }
    ends.sort_by(f64::total_cmp);
}

/// Angles of one machine's turn at which steps of its motion in time end \[rad\]: the ends of its smooth pieces, and where a
/// formula is steep whatever the speed.
pub fn landings(plan: &Plan, q: &[f64], breaks: Vec<f64>) -> Vec<f64> {
    let mut ends = breaks.clone();
    if plan.may_be_steep() {
        add_steep(plan, q, &breaks, &mut ends);
    }
    ends
}

/// Ends of the smooth pieces of one machine's turn \[rad\].
pub fn kinks(plan: &Plan, q: &[f64]) -> Vec<f64> {
    Machine::new(plan, q).breaks(&mut Motion::new(&plan.mechanism, q)).swap_remove(0)
}

fn scan_angle(i: usize) -> f64 {
    (i as f64 + SHIFT) * TAU / SCAN as f64
}
