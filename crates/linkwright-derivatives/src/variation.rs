//! Derivatives of a motion in time by the numbers of the machine: the variational equation along the motion that was found.
//!
//! ```text
//! δφ˙ = δω,   δω˙ = ∂ε/∂φ δφ + ∂ε/∂ω δω + ∂ε/∂p δp
//! ```
//!
//! It is linear. The rates are the equation of motion in dual numbers, a direction in every lane, at the stages of Radau IIA
//! ([`linkwright_kernel::radau`]) in the steps of the motion; the stages of a step are one system of equations, factored once for all
//! directions.
//!
//! Where the acceleration jumps, at g(φ, ω, p) = 0, the motion passes by δt = −δg/g˙ later, and the acceleration before lasts
//! longer by that: δω behind is δω + (ε before − ε behind) δt (Aizerman, Gantmacher, *PMM* 22, 1958). Such places are kinks over
//! the angle, speeds at which the drive has a kink, standstill, and kinks of laws, at which the steps are divided.

use crate::along::{Directions, put};
use crate::moving_kinks::MovingKinks;
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::events::{Event, Events};
use linkwright_core::drive::law::SpeedKink;
use linkwright_core::drive::mesh::crossing;
use linkwright_core::drive::structure::Plan;
use linkwright_core::drive::transient::equation::Y;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::call::poll;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::matrix::LuFactors;
use linkwright_kernel::out_of_line;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::radau::{A, B, C, S};
use linkwright_kernel::real::{LANES_MAX, Real};
use linkwright_kernel::rk::rise;

/// Share of a step by which what lies at its end is read inside it, on its side of a kink there, and carried on to the end.
const INSIDE: f64 = 1e-6;

/// The same as an angle \[rad\], beyond the distance at which steps land on kinks; in a very short step no more than a share.
const BESIDE_KINK: f64 = 5e-9;
const INSIDE_MAX: f64 = 0.05;

/// Angle \[rad\] that the crank turns by at its working speed in the time by which the sides of an event are apart at least: steps
/// that close in on a jump become as short as rounding. A motion may change in less than that, but not in less than the share
/// [`INSIDE`] of the time that it took so far. Where it is slower the sides of a kink over the angle are that angle apart, which
/// steps miss the kink by less.
const ASIDE: f64 = 1e-8;

/// A crank angle this near to a kink \[rad\], and a speed this near, as a share, is on it.
const ON_KINK: f64 = 1e-7;
const ON_SPEED: f64 = 1e-9;

/// A change of the acceleration below this share of it is no jump: what reading beside an event leaves.
const NO_JUMP: f64 = 1e-9;

/// Places in a step at which signs of laws' kinks are looked at.
const LOOKS: usize = 8;

/// A motion in time as [`super::Trajectory`] has it: at the ends of its steps, and between them.
#[derive(Clone, Copy)]
pub struct SolvedMotion<'a> {
    /// Times \[s\], angles \[rad\] and speeds \[rad/s\], counter-clockwise, (steps + 1).
    pub t: &'a [f64],
    /// Crank angle there \[rad\].
    pub phi: &'a [f64],
    /// Speed there \[rad/s\].
    pub omega: &'a [f64],
    /// Factors of the polynomials of angle and speed, (steps, 2, 7).
    pub between: &'a [f64],
}

impl SolvedMotion<'_> {
    /// Angle and speed at a share of a step.
    fn state(&self, k: usize, share: f64) -> Y {
        let [angle, speed] = [0, 1].map(|which| rise(&self.between[14 * k + 7 * which..][..7], share));
        [self.phi[k] + angle, self.omega[k] + speed]
    }

    /// Angles and speeds at instants of the motion; at the end of a step by the step behind it.
    pub fn read(&self, at: &[f64]) -> [Vec<f64>; 2] {
        let mut found = [0, 1].map(|_| Vec::with_capacity(at.len()));
        let inner = &self.t[1..self.t.len() - 1];
        for &t in at {
            let k = inner.partition_point(|&time| time <= t);
            let state = self.state(k, (t - self.t[k]) / (self.t[k + 1] - self.t[k]));
            found.iter_mut().zip(state).for_each(|(list, x)| list.push(x));
        }
        found
    }
}

/// What to differentiate.
pub struct Variation<'a> {
    /// Along what.
    pub of: Directions<'a>,
    /// Derivatives of angle and speed at the start, (2, directions).
    pub start: &'a [f64],
    /// The motion.
    pub motion: SolvedMotion<'a>,
    /// Instants, increasing \[s\].
    pub at: &'a [f64],
}

/// Derivatives at the instants, the times held; where one is that of an event, those before it.
#[derive(Clone, Debug)]
pub struct Variations {
    /// Of the angle, (instants, directions).
    pub phi: Vec<f64>,
    /// Of the speed, (instants, directions).
    pub omega: Vec<f64>,
    /// The acceleration itself, (instants).
    pub epsilon: Vec<f64>,
}

impl Variation<'_> {
    /// The derivatives. Not inlined: every crate that called it would compile its own kernel.
    #[inline(never)]
    pub fn derivatives(self) -> Variations {
        in_common_lanes(self)
    }
}

impl Job for Variation<'_> {
    type Output = Variations;

    #[inline(always)]
    fn run<R: Real>(self) -> Variations {
        let Variation { of, start, motion, at } = self;
        let (angles, speeds) = start.split_at(of.n);
        let mut along = Along::<R> {
            plain: Plain::new(&of),
            rates: Rates::new(of),
            motion,
            now: [angles.to_vec(), speeds.to_vec()],
            passed: f64::NEG_INFINITY,
        };
        let mut found = Variations { phi: Vec::new(), omega: Vec::new(), epsilon: Vec::new() };
        let mut next = 0;
        for k in 0..motion.t.len() - 1 {
            // No derivatives are needed after the last instant.
            if next == at.len() {
                break;
            }
            poll();
            let mut cuts = along.law_cuts(k);
            let [begin, end] = [motion.t[k], motion.t[k + 1]];
            while next < at.len() && (at[next] <= end || k + 2 == motion.t.len()) {
                cuts.push((((at[next] - begin) / (end - begin)).clamp(0.0, 1.0), None));
                next += 1;
            }
            cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut from = 0.0;
            for (share, law) in cuts {
                along.advance(k, from, share);
                from = share;
                let t = begin + share * (end - begin);
                match law {
                    Some(law) => along.pass_law(k, t, law),
                    None => along.note(k, t, &mut found),
                }
            }
            along.advance(k, from, 1.0);
            along.pass_end(k);
        }
        found
    }
}

/// Where a jump of the acceleration may be.
#[derive(Clone, Copy)]
enum EventPlace {
    /// A kink over the angle, within the cycle.
    Angle(f64),
    /// A speed of the drive, by its number in their order.
    Speed(usize),
    Rest,
    Law(SpeedKink),
}

/// The machine in plain numbers.
struct Plain<'a> {
    machine: Machine<'a, f64>,
    m: Motion<f64>,
    kinks: Vec<f64>,
    speeds: Vec<f64>,
    laws: Vec<SpeedKink>,
}

impl<'a> Plain<'a> {
    fn new(of: &Directions<'a>) -> Self {
        let machine = Machine::new(of.plan, of.q);
        let mut m = Motion::new(&of.plan.mechanism, of.q);
        let kinks = machine.breaks(&mut m).swap_remove(0);
        let speeds = of.plan.drive.speed_kinks(&of.plan.tables, of.q);
        Plain { machine, m, kinks, speeds, laws: of.plan.speed_kinks() }
    }

    fn acceleration(&mut self, [phi, omega]: Y) -> f64 {
        acceleration(self.machine.plan, self.machine.q, phi, omega, &mut self.m)
    }

    /// The quantity whose zero is a kink of a law.
    fn law(&mut self, kink: SpeedKink, [phi, omega]: Y) -> f64 {
        let events = Events::new(self.machine);
        events.value(Event::Law(kink), phi, 0.5 * omega * omega, &mut self.m)
    }

    /// The kink on which a state lies.
    fn passed(&self, state: Y) -> Option<EventPlace> {
        let places = self.kinks.iter().copied().map(EventPlace::Angle);
        let near = places.min_by(|a, b| self.off(*a, state).total_cmp(&self.off(*b, state)));
        if let Some(kink) = near.filter(|kink| self.off(*kink, state) < ON_KINK) {
            return Some(kink);
        }
        if state[1] == 0.0 {
            return Some(EventPlace::Rest);
        }
        let mut speeds = (0..self.speeds.len()).map(EventPlace::Speed);
        speeds.find(|speed| self.off(*speed, state) <= ON_SPEED)
    }

    /// Distance of a state from a kink over the angle \[rad\], from one over the speed as a share of that, from rest \[rad/s\].
    fn off(&self, event: EventPlace, [phi, omega]: Y) -> f64 {
        match event {
            EventPlace::Angle(kink) => {
                let cycle = self.machine.plan.cycle();
                let apart = (phi - kink).rem_euclid(cycle);
                apart.min(cycle - apart)
            }
            EventPlace::Speed(nth) => (omega / self.speeds[nth] - 1.0).abs(),
            EventPlace::Rest | EventPlace::Law(_) => omega,
        }
    }
}

/// ε at a crank angle and a speed, counter-clockwise.
#[inline(always)]
fn acceleration<N: Real>(plan: &Plan, q: &[N], phi: N, omega: N, m: &mut Motion<N>) -> N {
    out_of_line!(N, {
        let r = plan.reduce::<N, 2>(q, Angle::new(phi), 1.0, m);
        let mut net = plan.drive.torque::<N, N>(&plan.tables, q, omega)
            - (r.load + r.dry)
            - omega * (r.viscous + omega * r.J_d1 * 0.5);
        if !plan.laws.is_empty() {
            let mut geometry = Vec::new();
            plan.add_geometry(q, phi, m, &mut geometry);
            net = net - plan.law_torque::<N, N, N>(q, &geometry, omega, N::splat(f64::NAN));
        }
        net / r.J
    })
}

/// What the slope at the end of a step is made of, of a polynomial through the values at its stages.
fn slopes_at_end() -> [f64; S] {
    let others = |i: usize, k: usize| (0..S).filter(move |&j| j != i && j != k);
    let end = S - 1;
    std::array::from_fn(|i| {
        if i == end {
            return others(i, i).map(|j| 1.0 / (C[end] - C[j])).sum();
        }
        let product: f64 = others(i, end).map(|j| (C[end] - C[j]) / (C[i] - C[j])).product();
        product / (C[i] - C[end])
    })
}

/// Some directions, one a lane: of the parameters, and behind them of the angle and of the speed.
struct Lanes<R> {
    some: Vec<usize>,
    q: Vec<Dual<R>>,
    m: Motion<Dual<R>>,
    /// Derivatives of angle and speed.
    state: [R; 2],
}

impl<R: Real> Lanes<R> {
    #[inline(always)]
    fn new(of: &Directions<'_>, some: &[usize]) -> Self {
        let q = of.numbers::<R>(some);
        let m = Motion::new(&of.plan.mechanism, &q);
        let mut state = [[0.0; LANES_MAX]; 2];
        for (lane, &way) in some.iter().enumerate().filter(|(_, way)| **way >= of.n) {
            state[way - of.n][lane] = 1.0;
        }
        Lanes { some: some.to_vec(), q, m, state: [R::load(&state[0]), R::load(&state[1])] }
    }

    #[inline(always)]
    fn state(&self, y: Y) -> [Dual<R>; 2] {
        [0, 1].map(|i| Dual { value: R::splat(y[i]), d: self.state[i] })
    }
}

/// Derivatives of what the equation of motion consists of, by all directions and by angle and speed.
struct Rates<'a, R> {
    of: Directions<'a>,
    lanes: Vec<Lanes<R>>,
}

impl<'a, R: Real> Rates<'a, R> {
    #[inline(always)]
    fn new(of: Directions<'a>) -> Self {
        let mut ways = of.moving();
        ways.extend([of.n, of.n + 1]);
        let mut lanes = Vec::with_capacity(ways.len().div_ceil(R::LANES));
        for some in ways.chunks(R::LANES) {
            lanes.push(Lanes::new(&of, some));
        }
        Rates { of, lanes }
    }

    /// Derivatives of a quantity of some lanes, (directions + 2).
    #[inline(always)]
    fn derivatives(&mut self, mut of: impl FnMut(&Plan, &mut Lanes<R>) -> R) -> Vec<f64> {
        let mut all = vec![0.0; self.of.n + 2];
        for lanes in &mut self.lanes {
            put(of(self.of.plan, lanes), &lanes.some, &mut all);
        }
        all
    }

    /// Those of the acceleration.
    #[inline(always)]
    fn acceleration(&mut self, y: Y) -> Vec<f64> {
        out_of_line!(R, {
            self.derivatives(
                #[inline(always)]
                |plan, lanes| {
                    let [phi, omega] = lanes.state(y);
                    acceleration(plan, &lanes.q, phi, omega, &mut lanes.m).d
                },
            )
        })
    }

    /// Those of the quantity whose zero an event is.
    #[inline(always)]
    fn event(&mut self, event: EventPlace, y: Y) -> Vec<f64> {
        out_of_line!(R, {
            self.derivatives(
                #[inline(always)]
                |plan, lanes| {
                    let [phi, omega] = lanes.state(y);
                    let machine = Machine::new(plan, &lanes.q);
                    match event {
                        EventPlace::Angle(at) => {
                            phi.d - MovingKinks(machine).moving(&[at], &mut lanes.m)[0].d
                        }
                        EventPlace::Speed(nth) => {
                            omega.d - plan.drive.speed_kinks(&plan.tables, &lanes.q)[nth].d
                        }
                        EventPlace::Rest => omega.d,
                        EventPlace::Law(kink) => {
                            let u = omega.squared() * 0.5;
                            Events::new(machine).value(Event::Law(kink), phi, u, &mut lanes.m).d
                        }
                    }
                },
            )
        })
    }
}

/// The derivatives as they go along with the motion.
struct Along<'a, R> {
    plain: Plain<'a>,
    rates: Rates<'a, R>,
    motion: SolvedMotion<'a>,
    /// Of angle and speed.
    now: [Vec<f64>; 2],
    /// When the last kink of a law was passed \[s\].
    passed: f64,
}

impl<R: Real> Along<'_, R> {
    /// Angle and speed at an instant of the motion.
    fn state_at(&self, t: f64) -> Y {
        let times = self.motion.t;
        let k = times.partition_point(|&time| time < t).clamp(1, times.len() - 1) - 1;
        self.motion.state(k, ((t - times[k]) / (times[k + 1] - times[k])).clamp(0.0, 1.0))
    }

    /// Time by which the sides of an instant of a step are apart from it.
    fn aside(&self, k: usize) -> f64 {
        let Machine { plan, q, .. } = self.plain.machine;
        self.aside_at(k, q[plan.drive.speed_start])
    }

    /// The same at a speed at which the angle counts.
    fn aside_at(&self, k: usize, speed: f64) -> f64 {
        let [begin, from, to] = [0, k, k + 1].map(|i| self.motion.t[i]);
        (INSIDE * (to - from)).max((ASIDE / speed).min(INSIDE * (to - begin)))
    }

    /// The same beside an event.
    fn aside_of(&self, k: usize, event: EventPlace) -> f64 {
        match event {
            EventPlace::Angle(_) => self.aside(k).max(self.aside_at(k, self.motion.omega[k + 1].abs())),
            EventPlace::Speed(_) | EventPlace::Rest | EventPlace::Law(_) => self.aside(k),
        }
    }

    /// The acceleration at an instant, read before it or behind it by a time, with its sign, and carried on to it.
    fn beside(&mut self, t: f64, by: f64) -> f64 {
        let [near, far] = [1.0, 2.0].map(|times| self.state_at(t + times * by));
        2.0 * self.plain.acceleration(near) - self.plain.acceleration(far)
    }

    /// From one share of a step to another.
    fn advance(&mut self, k: usize, from: f64, to: f64) {
        if to <= from {
            return;
        }
        let h = (to - from) * (self.motion.t[k + 1] - self.motion.t[k]);
        let inside = if to < 1.0 { INSIDE } else { self.inside(k, from) };
        let stages = C.map(|c| c.min(1.0 - inside));
        let mut rates = stages.map(|c| self.rates.acceleration(self.motion.state(k, from + (to - from) * c)));
        let n = self.rates.of.n;
        let slope = slopes_at_end();
        for way in 0..n + 2 {
            let rise: f64 = (0..S).map(|j| slope[j] * rates[j][way]).sum();
            rates[S - 1][way] += inside * rise;
        }
        let [by_angle, by_speed] = [n, n + 1].map(|i| -> [f64; S] { std::array::from_fn(|j| rates[j][i]) });
        let mut system = LuFactors::new(S);
        system.factor(|i, j| {
            let twice: f64 = (0..S).map(|l| A[i][l] * by_angle[l] * A[l][j]).sum();
            f64::from(u8::from(i == j)) - h * (A[i][j] * by_speed[j] + h * twice)
        });
        let [angles, speeds] = &mut self.now;
        for (way, (angle, speed)) in angles.iter_mut().zip(speeds).enumerate() {
            let forced: [f64; S] = std::array::from_fn(|j| by_angle[j].mul_add(*angle, rates[j][way]));
            let row = |i: usize| *speed + h * (0..S).map(|j| A[i][j] * forced[j]).sum::<f64>();
            let mut stages: [f64; S] = std::array::from_fn(row);
            system.solve(&mut stages);
            *angle += h * (0..S).map(|j| B[j] * stages[j]).sum::<f64>();
            *speed = stages[S - 1];
        }
    }

    /// Share by which the end of a part of a step, from a share of it on, is read inside: beyond where it lands on a kink.
    fn inside(&self, k: usize, from: f64) -> f64 {
        let [start, end] = [k, k + 1].map(|i| self.motion.phi[i]);
        let is_on_kink =
            matches!(self.plain.passed([end, self.motion.omega[k + 1]]), Some(EventPlace::Angle(_)));
        let share = BESIDE_KINK / ((1.0 - from) * (end - start)).abs();
        if is_on_kink { share.clamp(INSIDE, INSIDE_MAX) } else { INSIDE }
    }

    /// Keeps what holds at an instant of a step.
    fn note(&mut self, k: usize, t: f64, found: &mut Variations) {
        found.phi.extend(&self.now[0]);
        found.omega.extend(&self.now[1]);
        let way = if t > self.motion.t[0] { -1.0 } else { 1.0 };
        found.epsilon.push(self.beside(t, way * self.aside(k)));
    }

    /// Past an event at the end of a step, if there is one. Of several ends beside it the nearest counts.
    fn pass_end(&mut self, k: usize) {
        if k + 2 >= self.motion.t.len() {
            return;
        }
        let ends = [k, k + 1, k + 2].map(|i| [self.motion.phi[i], self.motion.omega[i]]);
        if let Some(event) = self.plain.passed(ends[1]) {
            let [before, at, behind] = ends.map(|end| self.plain.off(event, end));
            if at < before && at <= behind {
                self.pass(k, self.motion.t[k + 1], event);
            }
        }
    }

    /// Past a kink of a law, if the motion is on its other side a while later; steps that close in on a jump may go back and forth.
    fn pass_law(&mut self, k: usize, t: f64, law: SpeedKink) {
        let aside = self.aside(k);
        let [before, behind] = [-aside, aside].map(|by| {
            let y = self.state_at(t + by);
            self.plain.law(law, y)
        });
        if before * behind < 0.0 && t - self.passed > 2.0 * aside {
            self.pass(k, t, EventPlace::Law(law));
            self.passed = t;
        }
    }

    /// Past an event at an instant of a step.
    fn pass(&mut self, k: usize, t: f64, event: EventPlace) {
        let aside = self.aside_of(k, event);
        let [before, behind] = [-1.0, 1.0].map(|way| self.beside(t, way * aside));
        if (behind - before).abs() <= NO_JUMP * before.abs().max(behind.abs()) {
            return;
        }
        let (y, n) = (self.state_at(t), self.rates.of.n);
        let g = self.rates.event(event, y);
        let along = g[n] * y[1] + g[n + 1] * before;
        let [angles, speeds] = &mut self.now;
        for (way, (angle, speed)) in angles.iter().zip(speeds).enumerate() {
            let late = -(g[way] + g[n] * angle + g[n + 1] * *speed) / along;
            *speed += (before - behind) * late;
        }
    }

    /// Shares of a step at which the motion passes kinks of laws.
    fn law_cuts(&mut self, k: usize) -> Vec<(f64, Option<SpeedKink>)> {
        let mut cuts = Vec::new();
        for law in self.plain.laws.clone() {
            let mut left = self.law_at(law, k, 0.0);
            for look in 0..LOOKS {
                let [from, to] = [look, look + 1].map(|look| look as f64 / LOOKS as f64);
                let right = self.law_at(law, k, to);
                if left * right < 0.0 {
                    let length = crossing(|x| self.law_at(law, k, from + x), to - from, left, right);
                    cuts.push((from + length, Some(law)));
                }
                left = right;
            }
        }
        cuts
    }

    fn law_at(&mut self, law: SpeedKink, k: usize, share: f64) -> f64 {
        let y = self.motion.state(k, share);
        self.plain.law(law, y)
    }
}
