//! Derivatives of steady motion by the numbers of the machine.
//!
//! At a solution of F(x, p) = 0 one step of Newton's method in dual numbers leaves x where it is and gives
//! dx/dp = −F_x⁻¹ F_p: the solver of [`linkwright_core::drive::cycle`] itself, run once more on the mesh and from the
//! solution that it found, with a direction of the parameters in every lane. There is no second description
//! of any formula, and the iteration is not differentiated.
//!
//! Ends of steps that lie on a kink move with it (φ_k′ = −w_p/w′ for the zero of a watched quantity w), so
//! that a torque may jump there. An extreme stays an extreme: its derivative is that of the curve at its
//! angle (envelope theorem), or along the kink that it sits on.

use crate::along::{Directions, put};
use crate::layers::resolved;
use crate::moving_kinks::MovingKinks;
use crate::peaks::{AT_END, Peak, SIDES, peaks_of_acceleration, steps_before};
use linkwright_core::drive::cycle::Turn;
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::events::{Events, Passage};
use linkwright_core::drive::extremes::Extreme;
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::layout::{Layout, bundle, unbundle};
use linkwright_core::drive::reading::{Mark, State};
use linkwright_core::drive::steady::Steady;
use linkwright_core::drive::step::{Step, stages_of_part};
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::call::poll;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::matrix::LuFactors;
use linkwright_kernel::out_of_line;
use linkwright_kernel::radau::S;
use linkwright_kernel::real::{LANES_MAX, Real};

/// Numbers of the revolution that are differentiated: the four extremes, the period, the multiplier, the works of
/// motor, drive and loads, mean and root mean square of the motor's torque.
pub const NUMBERS: usize = 11;

/// Curves that are differentiated: time, speed, acceleration, torques of motor, drive and loads, inertia.
pub const CURVES: usize = 7;

/// Rounds in which the ends of steps at kinks are moved: the second takes away what rounding leaves of the first.
const ROUNDS: usize = 4;

/// Share of its move, and of the largest change of u by the parameter, by which an end of a step may miss its kink: where
/// no round is needed any more; and in the solution that is read, far above rounding and below what anybody sees.
const MOVED: f64 = 1e-8;
const MISSED: f64 = 1e-5;

/// Change of u, as a share of u, that stands for none, for a change of the parameter by its own size: rounding.
const NOTHING: f64 = 1e-13;

/// Kinks are at one speed up to this share of it, and move together: rounding.
const SHARED: f64 = 1e-9;

/// Share of a step beside a peak of the speed at which the acceleration is read again.
const ASIDE: f64 = 4e-3;

/// Under a steep drive rounding of the speed is acceleration, which tells the place of an extreme of the speed worse than the
/// speed itself: where that is more than the first share of its change over [`ASIDE`]. Then the speed is read, at the second
/// share of a step, over which it changes by more than rounding.
const PLACED: f64 = 1e-6;
const ASIDE_OF_SPEED: f64 = 3e-2;

/// Of the speed read so, rounding is as if of an acceleration under a drive of steepness 2 over that share of the step: where
/// steepness times step is more than this the speed is surer. Behind a corner steps are short, and it is not.
const SURER: f64 = 150.0;

/// Speeds that differ by no more than so many roundings are the same.
const ROUNDINGS: f64 = 4.0;

/// Steps of Newton's method to the peak between those readings.
const NEWTON: usize = 3;

/// A peak by readings of the speed lies no farther from their middle than so many times their distance.
const FAR: f64 = 4.0;

/// An end of a step this near to a kink of loads or motion \[rad\] may move with it.
const ON_KINK: f64 = 1e-8;

/// The derivatives along some directions of the parameters.
pub struct Gradient<'a> {
    /// The machine's structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [f64],
    /// Directions, (parameters, directions).
    pub directions: &'a [f64],
    /// The size of what each direction is by, against which its changes count.
    pub sizes: &'a [f64],
    /// The solution.
    pub steady: &'a Steady,
}

/// Derivatives, each list direction by direction.
#[derive(Clone, Debug)]
pub struct Derivatives {
    /// (numbers, directions).
    pub numbers: Vec<f64>,
    /// The solution along the directions.
    pub along: SolutionAlong,
    /// By direction: the crank angle of a kink whose move was not found, so that nothing is known of the derivatives \[rad\];
    /// NaN where there is none.
    pub lost: Vec<f64>,
}

/// A solution on the steps that resolve its derivatives.
#[derive(Clone, Debug)]
struct SolvedSteps {
    /// At the starts of the steps.
    marks: Vec<Mark>,
    /// Ends of steps that lie on kinks of loads or motion, and may move with them; the others stay \[rad\].
    on_kinks: Vec<f64>,
}

impl SolvedSteps {
    fn new(of: &Gradient<'_>) -> Self {
        let marks = resolved(of.plan, of.q, of.steady);
        let kinks = kinks(of.plan, of.q);
        let ends = marks.iter().map(|mark| mark.phi).chain([of.plan.cycle()]);
        let is_kink = |phi: &f64| kinks.iter().any(|kink| (kink - phi).abs() < ON_KINK);
        let on_kinks = ends.filter(is_kink).collect();
        SolvedSteps { marks, on_kinks }
    }
}

/// A solution with its derivatives, from which those of curves are read.
#[derive(Clone, Debug)]
pub struct SolutionAlong {
    solved: SolvedSteps,
    /// By step: its start, u there and at its stages; last the end of the last step.
    values: Vec<f64>,
    /// (values, directions).
    d: Vec<f64>,
}

/// Numbers of a step among [`SolutionAlong::values`].
const OF_STEP: usize = 2 + S;

/// Curves along the directions that a solution was differentiated along.
pub struct CurvesAlong<'a> {
    /// The solution, and what it was found from.
    pub of: Gradient<'a>,
    /// With its derivatives.
    pub along: &'a SolutionAlong,
    /// Crank angles of the curves, within the cycle \[rad\].
    pub phi: &'a [f64],
}

impl CurvesAlong<'_> {
    /// (curves, angles, directions). Not inlined: every crate that called it would compile its own kernel.
    #[inline(never)]
    pub fn curves(self) -> Vec<f64> {
        in_common_lanes(self)
    }
}

impl Job for CurvesAlong<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<f64> {
        let (n, of) = (self.of.n(), &self.of);
        let mut curves = vec![0.0; CURVES * self.phi.len() * n];
        let directions = of.along();
        for some in directions.moving().chunks(R::LANES) {
            poll();
            let q = directions.numbers::<R>(some);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            let dual = DualRevolution::read(of, &q, self.along, some);
            for (at, &phi) in self.phi.iter().enumerate() {
                for (curve, value) in dual.curves_at(phi, &mut m).into_iter().enumerate() {
                    put(value.d, some, &mut curves[(curve * self.phi.len() + at) * n..][..n]);
                }
            }
        }
        curves
    }
}

impl Gradient<'_> {
    /// How many directions there are.
    fn n(&self) -> usize {
        self.directions.len() / self.q.len().max(1)
    }

    /// The derivatives. Not inlined: every crate that called it would compile its own kernel.
    #[inline(never)]
    pub fn derivatives(self) -> Derivatives {
        in_common_lanes(self)
    }

    fn along(&self) -> Directions<'_> {
        Directions { plan: self.plan, q: self.q, values: self.directions, n: self.n() }
    }
}

impl Job for Gradient<'_> {
    type Output = Derivatives;

    #[inline(always)]
    fn run<R: Real>(self) -> Derivatives {
        let n = self.n();
        let mut numbers = vec![0.0; NUMBERS * n];
        let (directions, mut lost) = (self.along(), vec![f64::NAN; n]);
        let solved = SolvedSteps::new(&self);
        let ends = if self.steady.crossings.is_empty() {
            None
        } else {
            Some(out_of_line!(R, MovingEnds::new::<R>(&self, &solved)))
        };
        let extremes = &self.steady.extremes;
        let accelerations = [&extremes.acceleration_min, &extremes.acceleration_max];
        let peaks = peaks_of_acceleration(self.plan, self.q, self.steady, &solved.marks, accelerations);
        let rows = OF_STEP * solved.marks.len() + 1;
        let (mut values, mut d) = (vec![0.0; rows], vec![0.0; rows * n]);
        for some in directions.moving().chunks(R::LANES) {
            poll();
            let q = directions.numbers::<R>(some);
            let mut m = Motion::new(&self.plan.mechanism, &q);
            let mut dual = DualRevolution::new(&self, &q, &solved, &mut m);
            if let Some(ends) = &ends {
                let mut sizes = [1.0; LANES_MAX];
                for (size, &way) in sizes.iter_mut().zip(some) {
                    *size = self.sizes[way];
                }
                put(dual.move_crossings(ends, R::load(&sizes), &mut m), some, &mut lost);
            }
            for (row, number) in dual.numbers(peaks, &mut m).into_iter().enumerate() {
                put(number.d, some, &mut numbers[row * n..][..n]);
            }
            for (k, step) in dual.turn.steps.iter().enumerate() {
                let own = [dual.edges[k], step.u].into_iter().chain(step.X);
                for (row, number) in (k * OF_STEP..).zip(own) {
                    values[row] = number.value.max_lane();
                    put(number.d, some, &mut d[row * n..][..n]);
                }
            }
            let end = dual.edges[solved.marks.len()];
            values[rows - 1] = end.value.max_lane();
            put(end.d, some, &mut d[(rows - 1) * n..]);
        }
        Derivatives { numbers, along: SolutionAlong { solved, values, d }, lost }
    }
}

/// The solved revolution in dual numbers.
struct DualRevolution<'a, R: Real> {
    machine: Machine<'a, Dual<R>>,
    steady: &'a Steady,
    /// The solution at the starts of its steps.
    marks: &'a [Mark],
    turn: Turn<Dual<R>>,
    /// Ends of the steps, the last at the end of the cycle.
    edges: Vec<Dual<R>>,
}

impl<'a, R: Real> DualRevolution<'a, R> {
    #[inline(always)]
    fn new(of: &Gradient<'a>, q: &'a [Dual<R>], solved: &'a SolvedSteps, m: &mut Motion<Dual<R>>) -> Self {
        out_of_line!(R, {
            let (plan, steady) = (of.plan, of.steady);
            let machine = Machine::new(plan, q).keeping_sides_of_bends().keeping_branch(plan.may_jump());
            let mut moved =
                out_of_line!(R, MovingKinks(machine).moving(&solved.on_kinks, m)).into_iter().peekable();
            let ends = solved.marks.iter().map(|mark| mark.phi).chain([plan.cycle()]);
            let mut edges = Vec::with_capacity(solved.marks.len() + 1);
            for phi in ends {
                let is_moved = moved.peek().is_some_and(|edge| edge.value.max_lane() == phi);
                let edge = if is_moved { moved.next() } else { None };
                edges.push(edge.unwrap_or(Dual::splat(phi)));
            }
            let marks = &solved.marks;
            let mut dual =
                DualRevolution { machine, steady, marks, turn: Turn::empty(Layout::Machines), edges };
            dual.differentiate(m);
            dual
        })
    }

    /// The solution with its derivatives along some directions, as it was found.
    #[inline(always)]
    fn read(of: &Gradient<'a>, q: &'a [Dual<R>], along: &'a SolutionAlong, some: &[usize]) -> Self {
        out_of_line!(R, {
            let (values, d) = (&along.values, &along.d);
            let numbers = Directions { plan: of.plan, q: values, values: d, n: of.n() }.numbers::<R>(some);
            let machine =
                Machine::new(of.plan, q).keeping_sides_of_bends().keeping_branch(of.plan.may_jump());
            let mut edges = Vec::with_capacity(along.solved.marks.len() + 1);
            let mut turn = Turn::empty(Layout::Machines);
            for (k, own) in numbers.chunks_exact(OF_STEP).enumerate() {
                edges.push(own[0]);
                let end = numbers[(k + 1) * OF_STEP];
                let mut step = Step::unsolved(own[0], end - own[0], own[1]);
                step.X.copy_from_slice(&own[2..]);
                turn.steps.push(step);
            }
            edges.push(numbers[along.solved.marks.len() * OF_STEP]);
            DualRevolution { machine, steady: of.steady, marks: &along.solved.marks, turn, edges }
        })
    }

    /// The solution on the steps between the edges, with its derivatives.
    #[inline(always)]
    fn differentiate(&mut self, m: &mut Motion<Dual<R>>) {
        out_of_line!(Dual<R>, {
            let marks = self.marks;
            let mut steps = Vec::with_capacity(marks.len());
            for ends in self.edges.windows(2) {
                steps.push((ends[0], ends[1] - ends[0]));
            }
            self.turn.tabulate_again(&self.machine, &steps, m);
            for (step, mark) in self.turn.steps.iter_mut().zip(marks) {
                step.u = Dual::splat(mark.u);
                step.X = mark.X.map(Dual::splat);
            }
            let mut work = Vec::with_capacity(marks.len());
            // The first sweep gives the derivative of the solution, the second that of its growth.
            for _ in 0..2 {
                self.turn.correction = Dual::splat(f64::INFINITY);
                self.turn.sweep(&self.machine, &mut work);
            }
        })
    }

    /// Moves the ends of steps at which the motion passes a kink along with it: the quantity g whose zero the kink is
    /// stays zero, φ′ = −(g_p + g_u u_p)/g′, with g′ along the motion before the kink, which depends on the moves of all
    /// ends. First the ends are brought to the kinks themselves, from which they are as far off as the accuracy of the solution
    /// allows: steepness leaps there, and with it derivatives. That depends on no direction: the solution is one for all. Sides
    /// and jumps count in the multiplier. The crank angle of an end that misses its kink, NaN where none does.
    #[inline(always)]
    fn move_crossings(&mut self, ends: &MovingEnds, size: R, m: &mut Motion<Dual<R>>) -> R {
        out_of_line!(R, {
            let events = Events::new(self.machine);
            let (zero, none) = (R::splat(0.0), R::splat(f64::NAN));
            let mut passages = self.passages(&events, m);
            for round in 0..ROUNDS {
                if round > 0 && self.misses(&passages, MOVED, size).iter().all(|miss| miss.max_lane() <= 0.0)
                {
                    break;
                }
                let late: Vec<Dual<R>> = passages.iter().map(|(_, passage)| passage.late()).collect();
                let off = |late: &Dual<R>| if round == 0 { late.value } else { zero };
                let values = ends.moves(&late.iter().map(off).collect::<Vec<_>>());
                let moves = ends.moves(&late.iter().map(|late| late.d).collect::<Vec<_>>());
                for ((k, _), (value, d)) in passages.iter().zip(values.into_iter().zip(moves)) {
                    self.move_end(*k, Dual { value, d });
                }
                self.differentiate(m);
                passages = self.passages(&events, m);
            }
            let mut factor = Dual::splat(1.0);
            for (k, passage) in &passages {
                let (step, geometry) = (&self.turn.steps[*k], self.turn.geometry_of(&self.machine, *k));
                factor =
                    factor * passage.factor() * (self.machine.growth_on_side(step, geometry) / step.growth);
            }
            self.turn.multiplier = self.turn.multiplier * factor;
            let mut lost = none;
            for ((k, _), miss) in passages.iter().zip(self.misses(&passages, MISSED, size)) {
                lost = zero.select_lt(miss, self.edges[k + 1].value, lost);
            }
            lost = self.parted(lost);
            // Nothing is known of derivatives that do not settle.
            let nothing = (-R::splat(f64::INFINITY)).select_lt(lost, none, zero);
            self.turn.multiplier.d = self.turn.multiplier.d + nothing;
            for step in &mut self.turn.steps {
                step.u.d = step.u.d + nothing;
                step.X.iter_mut().for_each(|X| X.d = X.d + nothing);
            }
            lost
        })
    }

    /// Where kinks of the drive at one speed that the motion passes, as points of two tables, move to different speeds: which of
    /// them a step ends on then, its one end cannot tell. `lost` has the crank angle of a kink there.
    #[inline(always)]
    fn parted(&self, mut lost: R) -> R {
        let Machine { plan, q, .. } = self.machine;
        let extremes = &self.steady.extremes;
        let passed = extremes.speed_min.value..=extremes.speed_max.value;
        let kinks = plan.drive.kinks_of_lanes(&plan.tables, q);
        for (i, one) in kinks.iter().enumerate() {
            let at = one.value.max_lane();
            for other in &kinks[i + 1..] {
                let is_shared = (other.value.max_lane() - at).abs() <= SHARED * at;
                if is_shared && passed.contains(&at) {
                    let apart = (one.d - other.d).abs();
                    let rounding = (one.d.abs() + other.d.abs()) * SHARED;
                    lost = rounding.select_lt(apart, R::splat(self.steady.crossings[0].phi), lost);
                }
            }
        }
        lost
    }

    /// Moves the end of a step, and the start of the revolution with its end.
    #[inline(always)]
    fn move_end(&mut self, k: usize, by: Dual<R>) {
        let last = self.edges.len() - 1;
        self.edges[k + 1] = self.edges[k + 1] + by;
        if k + 1 == last {
            self.edges[0] = self.edges[0] + by;
        }
    }

    /// By how much each end of a step at a kink misses it beyond a share of its move, of the largest change of u and of u:
    /// not above zero where it does not.
    #[inline(always)]
    fn misses(&self, passages: &[(usize, Passage<Dual<R>>)], share: f64, size: R) -> Vec<R> {
        let change = self.change();
        let mut misses = Vec::with_capacity(passages.len());
        for (k, passage) in passages {
            let (step, missed) = (&self.turn.steps[*k], passage.late().d.abs());
            let of_u = missed * step.K[S - 1].value.abs();
            let beyond = (missed - self.edges[k + 1].d.abs() * share).min(of_u - change * share);
            misses.push(beyond.min(of_u * size - step.X[S - 1].value * NOTHING));
        }
        misses
    }

    /// Largest change of u at the starts of steps.
    #[inline(always)]
    fn change(&self) -> R {
        let mut most = R::splat(0.0);
        for step in &self.turn.steps {
            most = most.max(step.u.d.abs());
        }
        most
    }

    /// How the motion passes the kinks at ends of steps, with the number of the step before each. Of several kinks at one
    /// end the first stands for all.
    #[inline(always)]
    fn passages(
        &self,
        events: &Events<'_, Dual<R>>,
        m: &mut Motion<Dual<R>>,
    ) -> Vec<(usize, Passage<Dual<R>>)> {
        out_of_line!(Dual<R>, {
            let (marks, n) = (self.marks, self.turn.steps.len());
            let mut passages: Vec<(usize, Passage<Dual<R>>)> = Vec::new();
            for crossing in &self.steady.crossings {
                let behind = marks.partition_point(|mark| mark.phi < crossing.phi - AT_END);
                let k = (behind + n - 1) % n;
                if passages.iter().all(|passage| passage.0 != k) {
                    let sides = [self.turn.steps[k].K[S - 1], self.start_of(behind % n, m)];
                    let (event, phi, u) =
                        (events.nth(crossing.nth), self.edges[k + 1], self.turn.steps[k].end());
                    passages.push((k, events.passage(event, phi, u, sides, m)));
                }
            }
            passages
        })
    }

    /// Acceleration at the start of a step, on its branch.
    #[inline(always)]
    fn start_of(&self, k: usize, m: &mut Motion<Dual<R>>) -> Dual<R> {
        self.machine.start(&self.turn.steps[k], self.turn.geometry_of(&self.machine, k), m)
    }

    /// The numbers of the revolution.
    #[inline(always)]
    fn numbers(&self, peaks: [Peak; 2], m: &mut Motion<Dual<R>>) -> [Dual<R>; NUMBERS] {
        let extremes = &self.steady.extremes;
        let speeds = [extremes.speed_min, extremes.speed_max].map(|extreme| self.peak_of_speed(&extreme, m));
        let [least, largest] = peaks.map(|peak| self.peak_of_acceleration(peak, m));
        let totals = self.turn.totals(&self.machine);
        [
            speeds[0],
            speeds[1],
            least,
            largest,
            totals.period,
            self.turn.multiplier,
            totals.motor_work,
            totals.crank_work,
            totals.load_work,
            totals.torque_mean,
            totals.torque_rms,
        ]
    }

    /// An extreme of the speed. Its derivative is that at the place of the peak, where the acceleration is zero; the angle
    /// where it was read is off by millionths of a step, over which the derivative may change much where inertia does.
    #[inline(always)]
    fn peak_of_speed(&self, extreme: &Extreme<f64>, m: &mut Motion<Dual<R>>) -> Dual<R> {
        out_of_line!(Dual<R>, {
            let phi = self.turned_back(extreme.phi);
            let [low, high] = self.step_around(phi);
            let there = self.state(phi, m).1;
            // A corner is where it is.
            if (phi - low).min(high - phi) < AT_END {
                return there.omega;
            }
            let aside = ASIDE * (0.5 * (high + low) - phi).signum() * (high - low);
            let beside = self.state(phi + aside, m).1.epsilon.value;
            let change = beside - there.epsilon.value;
            let step = &self.turn.steps[self.steps_before(phi)];
            let rounding = step.steepness().value * step.u.value * f64::EPSILON;
            let is_surer = (step.steepness().value * step.h.value).max_lane() > SURER;
            if is_surer && (rounding - change.abs() * PLACED).max_lane() > 0.0 {
                // As far as rounding tells it is at the end of the step, where the speed may have a corner.
                let at_ends = [low, high].map(|end| self.state(end, m).1.omega);
                let is_as_high = |end: &Dual<R>| {
                    let off = (end.value - there.omega.value).abs()
                        - there.omega.value * (ROUNDINGS * f64::EPSILON);
                    off.max_lane() <= 0.0
                };
                return at_ends.into_iter().find(is_as_high).unwrap_or_else(|| self.peak_by_speeds(phi, m));
            }
            let off = there.epsilon.value * aside / change;
            let off = off.abs().select_lt(R::splat(aside.abs()), off, R::splat(0.0));
            Dual { d: there.omega.d - off * there.epsilon.d / there.omega.value, ..there.omega }
        })
    }

    /// An extreme of the acceleration, or what its corner is. Its derivative is that at the place of the peak too.
    #[inline(always)]
    fn peak_of_acceleration(&self, peak: Peak, m: &mut Motion<Dual<R>>) -> Dual<R> {
        match peak {
            Peak::Corner(edge, value) => self.corner(edge, value, m),
            Peak::Inside(phi) => self.state(phi, m).1.epsilon,
        }
    }

    /// An extreme of the speed by the speed itself: that of the quartic through readings beside it.
    #[inline(always)]
    fn peak_by_speeds(&self, phi: f64, m: &mut Motion<Dual<R>>) -> Dual<R> {
        let [low, high] = self.step_around(phi);
        let aside = ASIDE_OF_SPEED * (high - low);
        // Within the step, beyond whose ends the curve may bend.
        let middle = phi.clamp(low + 2.0 * aside, high - 2.0 * aside);
        let mut at = [Dual::splat(0.0); 5];
        for (k, omega) in at.iter_mut().enumerate() {
            *omega = self.state((k as f64 - 2.0).mul_add(aside, middle), m).1.omega;
        }
        let curve = quartic(at);
        let off = peak_of(&curve);
        // Where the speed is constant there is no peak.
        let off = off.abs().select_lt(R::splat(FAR), off, R::splat((phi - middle) / aside));
        let off = Dual { value: off, d: R::splat(0.0) };
        curve[0] + off * (curve[1] + off * (curve[2] + off * (curve[3] + off * curve[4])))
    }

    /// The end of the revolution for its start: the step before an end moves with it, and before the first lies the last.
    #[inline(always)]
    fn turned_back(&self, phi: f64) -> f64 {
        if phi - self.marked(0) < AT_END { self.marked(self.marks.len()) } else { phi }
    }

    /// Number of the steps before the one that a crank angle lies in.
    #[inline(always)]
    fn steps_before(&self, phi: f64) -> usize {
        steps_before(self.marks, phi)
    }

    /// The ends of the step that a crank angle lies in.
    #[inline(always)]
    fn step_around(&self, phi: f64) -> [f64; 2] {
        let k = self.steps_before(phi);
        [k, k + 1].map(|edge| self.marked(edge))
    }

    /// An end of a step where the solution was found; those at kinks have been brought to them.
    #[inline(always)]
    fn marked(&self, edge: usize) -> f64 {
        let last = &self.marks[self.marks.len() - 1];
        self.marks.get(edge).map_or(last.phi + last.h, |mark| mark.phi)
    }

    /// The acceleration at an end of a step, along its move. Where it jumps there, on the side that has the value.
    #[inline(always)]
    fn corner(&self, edge: usize, value: f64, m: &mut Motion<Dual<R>>) -> Dual<R> {
        out_of_line!(Dual<R>, {
            let before = self.state(self.turned_back(self.marked(edge)), m).1.epsilon;
            let behind = self.start_of(edge % self.turn.steps.len(), m);
            let far = |side: Dual<R>| (side.value - value).abs().max_lane();
            // Where it is continuous rounding has no say.
            if far(behind) < 0.5 * far(before) && far(before) > SIDES * value.abs() { behind } else { before }
        })
    }

    /// The curves at a crank angle.
    #[inline(always)]
    fn curves_at(&self, phi: f64, m: &mut Motion<Dual<R>>) -> [Dual<R>; CURVES] {
        let (t, state) = self.state(phi, m);
        [t, state.omega, state.epsilon, state.motor_torque, state.drive_torque, state.load_torque, state.J]
    }

    /// Time and state at a crank angle, or at the end of a step that lies there, which may move.
    #[inline(always)]
    fn state(&self, phi: f64, m: &mut Motion<Dual<R>>) -> (Dual<R>, State<Dual<R>>) {
        out_of_line!(Dual<R>, {
            let there = self.step_to(phi, m);
            let mut t = there.0.duration();
            for before in &self.turn.steps[..self.steps_before(phi)] {
                t = t + before.duration();
            }
            // Time counts from φ = 0, which may lie beside the start of the first step where that moves.
            let start = (self.turn.steps[0].u * 2.0).sqrt();
            (t + self.edges[0] / start, self.machine.state_at_end(&there))
        })
    }

    /// The part of a step to a crank angle, or to the end of the step that lies there, which may move.
    #[inline(always)]
    fn step_to(&self, phi: f64, m: &mut Motion<Dual<R>>) -> (Step<Dual<R>>, Vec<LawGeometry<Dual<R>>>) {
        out_of_line!(Dual<R>, {
            let k = self.steps_before(phi);
            let step = &self.turn.steps[k];
            let ends_here = (self.marked(k + 1) - phi).abs() < AT_END;
            let to = if ends_here { self.edges[k + 1] } else { Dual::splat(phi) };
            let h = to - step.phi;
            let near = stages_of_part(&step.quintic(), Dual::splat(0.0), h / step.h);
            self.machine.advance_near(step.phi, step.u, h, near, m)
        })
    }
}

/// Coefficients, from the constant on, of the quartic through values at −2, −1, 0, 1 and 2.
#[inline(always)]
fn quartic<T: Real>(at: [T; 5]) -> [T; 5] {
    let [odd, even] = [at[3] - at[1], at[3] + at[1]];
    let [far_odd, far_even] = [at[4] - at[0], at[4] + at[0]];
    [
        at[2],
        (odd * 8.0 - far_odd) * (1.0 / 12.0),
        (even * 16.0 - far_even - at[2] * 30.0) * (1.0 / 24.0),
        (far_odd - odd * 2.0) * (1.0 / 12.0),
        (far_even - even * 4.0 + at[2] * 6.0) * (1.0 / 24.0),
    ]
}

/// Where a quartic that is nearly a parabola has its peak: one step of Newton's method from 0 misses it by the square of its
/// length, the third by its eighth power.
#[inline(always)]
fn peak_of<R: Real>(curve: &[Dual<R>; 5]) -> R {
    let [slope, bend, third, fourth] = [curve[1].value, curve[2].value, curve[3].value, curve[4].value];
    let mut off = R::splat(0.0);
    for _ in 0..NEWTON {
        let rise = ((fourth * 4.0 * off + third * 3.0) * off + bend * 2.0) * off + slope;
        let rate = (fourth * 12.0 * off + third * 6.0) * off + bend * 2.0;
        off = off - rise / rate;
    }
    off
}

/// How the ends of steps at kinks move one another: the motion passes a kink later where an end before it has moved, as a
/// torque jumps there, or as the slope at the end of a steep step is known less well than the step.
struct MovingEnds {
    /// Derivatives of the angles by which the motion passes the kinks behind the ends, by the moves of all ends.
    late: LuFactors<f64>,
}

impl MovingEnds {
    /// Those of a solution: each end is moved in a lane of its own.
    #[inline(always)]
    fn new<R: Real>(of: &Gradient<'_>, solved: &SolvedSteps) -> Self {
        let q: Vec<Dual<R>> = of.q.iter().map(|&value| Dual::splat(value)).collect();
        let mut m = Motion::new(&of.plan.mechanism, &q);
        let mut dual = DualRevolution::new(of, &q, solved, &mut m);
        let events = Events::new(dual.machine);
        let ends: Vec<usize> = dual.passages(&events, &mut m).iter().map(|(k, _)| *k).collect();
        let n = ends.len();
        let mut columns = vec![vec![0.0; n]; n.next_multiple_of(R::LANES)];
        for (first, moved) in ends.chunks(R::LANES).enumerate() {
            let unit = |lane: usize, way: f64| {
                let mut lanes = vec![0.0; R::LANES];
                lanes[lane] = way;
                Dual { value: R::splat(0.0), d: R::load(&lanes) }
            };
            for (lane, &k) in moved.iter().enumerate() {
                dual.move_end(k, unit(lane, 1.0));
            }
            dual.differentiate(&mut m);
            for (row, (_, passage)) in dual.passages(&events, &mut m).iter().enumerate() {
                for (lane, by) in unbundle(&[passage.late().d]).into_iter().enumerate() {
                    columns[first * R::LANES + lane][row] = by;
                }
            }
            for (lane, &k) in moved.iter().enumerate() {
                dual.move_end(k, unit(lane, -1.0));
            }
        }
        let mut late = LuFactors::new(n);
        late.factor(|row, column| columns[column][row]);
        MovingEnds { late }
    }

    /// The moves of the ends that bring them to their kinks, which the motion passes `late` behind them.
    #[inline(always)]
    fn moves<R: Real>(&self, late: &[R]) -> Vec<R> {
        let lanes = unbundle(late);
        let mut moves = vec![0.0; lanes.len()];
        for lane in 0..R::LANES {
            let mut one: Vec<f64> = lanes.iter().skip(lane).step_by(R::LANES).map(|late| -late).collect();
            self.late.solve(&mut one);
            for (k, by) in one.into_iter().enumerate() {
                moves[k * R::LANES + lane] = by;
            }
        }
        bundle(&moves)
    }
}
