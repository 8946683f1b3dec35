//! Steady motion of one machine to a wanted accuracy.
//!
//! The turn is solved on a mesh and on one twice as fine, until both agree. What differs by Δ on a method of
//! order 8 is off by Δ/255 on the finer one, so agreement is asked for within 100 times the accuracy. Where
//! the motor's or gearbox's characteristic has a kink at some speed, the angles at which the speed passes it
//! are found on each mesh and become ends of steps on the next.

use crate::call::poll;
use crate::cycle::{Machine, Step, Turn};
use crate::gauss::S;
use crate::lanes::{Job, in_lanes};
use crate::law::Moving;
use crate::layout::unbundle;
use crate::linkage::Motion;
use crate::measures::{Extreme, Extremes, Totals};
use crate::plan::Plan;
use crate::real::Real;
use crate::status::Status;
use std::f64::consts::TAU;

/// Steps of the first mesh.
const FIRST: usize = 24;

/// Finest mesh: a turn in 12 288 steps, about two minutes of arc each.
const FINEST: usize = FIRST << 9;

/// Agreement of two meshes per accuracy asked for; see the head of this file.
const MARGIN: f64 = 100.0;

/// Relative distance of a speed from a kink's below which it counts as the kink's. A break that is off by
/// 1e-9 rad changes the solution by the square of that.
const ON_KINK: f64 = 1e-10;

/// The smallest accuracy that rounding leaves reachable.
const ROUNDING: f64 = 2e-14;

/// The solution at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Crank angle \[rad\].
    pub phi: f64,
    /// Kinetic energy \[J\].
    pub E: f64,
    /// Time from φ = 0 \[s\].
    pub t: f64,
}

/// Steady motion of one machine.
#[derive(Clone, Debug)]
pub struct Steady {
    /// The solution at the starts of the steps.
    pub marks: Vec<Mark>,
    /// Derivative of the turn-to-turn map.
    pub multiplier: f64,
    /// Measures.
    pub extremes: Extremes<f64>,
    /// Integrals.
    pub totals: Totals<f64>,
    /// Relative difference of the last two meshes.
    pub difference: f64,
    /// Sweeps over all meshes.
    pub sweeps: u32,
}

/// Solves for the steady motion with relative accuracy `accuracy`.
///
/// # Errors
/// [`Status::DoesNotClose`], [`Status::NoSteadyMotion`], or [`Status::Inaccurate`] when the finest mesh
/// does not suffice.
pub fn steady(plan: &Plan, q: &[f64], accuracy: f64) -> Result<Steady, Status> {
    let machine = Machine { plan, q };
    let mut m = Motion::new(&plan.mechanism, q);
    let accuracy = accuracy.max(ROUNDING);
    let breaks = machine.breaks(&mut m);
    let (speeds, moving) = (plan.speed_kinks(q), plan.moving_kinks());
    let mut mesh = Mesh { plan, q, breaks: &breaks, n: FIRST, tolerance: accuracy * 1e-2, last: None };
    let (mut crossings, mut sweeps) = (Vec::new(), 0);
    while mesh.n <= FINEST {
        poll();
        let with_crossings = merged(&breaks, &crossings);
        let found = in_lanes(Mesh { breaks: &with_crossings, ..mesh })?;
        sweeps += found.sweeps;
        let passed = speeds.iter().copied().filter(|&speed| found.may_pass(speed)).map(Event::Speed);
        let events: Vec<Event> = passed.chain(moving.iter().copied().map(Event::Law)).collect();
        let next = crossings_of(&found.marks, &machine, &events, &mut m);
        if let Some((difference, extremes)) = found.agreed.filter(|_| next.len() == crossings.len()) {
            let Solved { marks, multiplier, totals, .. } = found;
            return Ok(Steady { marks, multiplier, extremes, totals, difference, sweeps });
        }
        mesh.last = Some((found.totals.period, found.marks[0].E, accuracy));
        (crossings, mesh.n) = (next, mesh.n * 2);
    }
    Err(Status::Inaccurate)
}

/// Breaks of the turn with further angles, in order.
fn merged(breaks: &[f64], more: &[f64]) -> Vec<f64> {
    let mut all = [breaks, more].concat();
    all.sort_by(f64::total_cmp);
    all
}

/// The search on one mesh, with the steps of the machine in lanes.
#[derive(Clone, Copy)]
struct Mesh<'a> {
    plan: &'a Plan,
    q: &'a [f64],
    breaks: &'a [f64],
    n: usize,
    tolerance: f64,
    /// Period and first energy on the mesh before, and the accuracy to which they should agree.
    last: Option<(f64, f64, f64)>,
}

/// What a mesh gives; the measures only where it agrees with the one before.
struct Solved {
    marks: Vec<Mark>,
    multiplier: f64,
    totals: Totals<f64>,
    sweeps: u32,
    /// Least and greatest speed at the stages.
    speeds: (f64, f64),
    agreed: Option<(f64, Extremes<f64>)>,
}

impl Solved {
    /// Whether the motion may pass a speed, with room for what lies between the stages.
    fn may_pass(&self, speed: f64) -> bool {
        let (low, high) = self.speeds;
        let room = 0.1 * (high - low) + 1e-9 * high;
        low - room < speed && speed < high + room
    }
}

impl Job for Mesh<'_> {
    type Output = Result<Solved, Status>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let q: Vec<R> = self.q.iter().map(|&x| R::splat(x)).collect();
        let machine = Machine { plan: self.plan, q: &q };
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut turn = Turn::of_steps(&machine, self.breaks, self.n, &mut m);
        if !turn.closes() {
            return Err(Status::DoesNotClose);
        }
        turn.start_from_balance(&machine);
        turn.solve(&machine, self.tolerance);
        if !turn.is_solved() {
            return Err(Status::NoSteadyMotion);
        }
        let totals = turn.totals(&machine).first_lane();
        let marks = turn.marks();
        let agreed = self.last.and_then(|(period, E, accuracy)| {
            let difference = relative_difference((totals.period, marks[0].E), (period, E));
            (difference <= MARGIN * accuracy)
                .then(|| (difference, turn.extremes(&machine, &mut m).first_lane()))
        });
        let multiplier = first_lane(turn.multiplier);
        Ok(Solved { marks, multiplier, totals, sweeps: turn.sweeps, speeds: turn.stage_speeds(), agreed })
    }
}

fn relative_difference(a: (f64, f64), b: (f64, f64)) -> f64 {
    ((a.0 - b.0) / a.0).abs().max(((a.1 - b.1) / a.1).abs())
}

impl<R: Real> Turn<R> {
    /// Whether every dyad closes at every stage.
    #[inline(always)]
    fn closes(&self) -> bool {
        let mut worst = R::splat(0.0);
        for step in &self.steps {
            for row in &step.rows {
                // NaN, which an open dyad leaves, is not below the limit.
                worst = worst.max(row.root.select_lt(R::splat(f64::INFINITY), worst, R::splat(1.0)));
            }
        }
        worst.max_lane() < 0.5
    }

    /// Whether Newton converged to a real motion in every lane.
    #[inline(always)]
    fn is_solved(&self) -> bool {
        let energies: Vec<R> = self.steps.iter().map(|step| step.E).collect();
        !self.steps.is_empty()
            && self.correction <= 1e-6
            && unbundle(&[self.multiplier]).iter().all(|x| x.is_finite())
            && unbundle(&energies).iter().all(|&E| E > 0.0 && E.is_finite())
    }

    /// Least and greatest speed at the stages of all lanes.
    #[inline(always)]
    fn stage_speeds(&self) -> (f64, f64) {
        let mut low = R::splat(f64::INFINITY);
        let mut high = R::splat(0.0);
        for step in &self.steps {
            for i in 0..S {
                let omega = step.rows[i].root * step.X[i].sqrt();
                low = low.min(omega);
                high = high.max(omega);
            }
        }
        (-(-low).max_lane(), high.max_lane())
    }

    /// The solution at the starts of the steps, those of no length left out.
    #[inline(always)]
    fn marks(&self) -> Vec<Mark> {
        let columns = |of: &dyn Fn(&Step<R>) -> R| unbundle(&self.steps.iter().map(of).collect::<Vec<_>>());
        let (phi, E) = (columns(&|step| step.phi), columns(&|step| step.E));
        let (h, duration) = (columns(&|step| step.h), columns(&|step| step.duration()));
        let mut t = 0.0;
        let mut marks = Vec::with_capacity(phi.len());
        for k in 0..phi.len() {
            if h[k] > 0.0 {
                marks.push(Mark { phi: phi[k], E: E[k], t });
            }
            t += duration[k];
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
            doubt: first_lane(self.doubt),
        }
    }
}

/// What the motion may pass where its equation has a kink.
#[derive(Clone, Copy)]
enum Event {
    /// A speed of the crank.
    Speed(f64),
    /// A kink of a law.
    Law(Moving),
}

impl Event {
    /// The quantity whose zero it is.
    fn value(self, machine: &Machine<'_, f64>, phi: f64, E: f64, m: &mut Motion<f64>) -> f64 {
        let omega = machine.state(phi, E, m).omega;
        match self {
            Event::Speed(speed) => omega - speed,
            Event::Law(kink) => {
                let mut given = Vec::new();
                machine.plan.give(machine.q, phi, m, &mut given);
                machine.plan.moving_value(machine.q, kink, &given, omega)
            }
        }
    }

    /// The size of the quantity, against which a value counts as zero.
    fn size(self, values: &[f64]) -> f64 {
        match self {
            Event::Speed(speed) => speed,
            Event::Law(_) => values.iter().fold(0.0, |size, value| value.abs().max(size)),
        }
    }
}

/// Angles at which the motion passes one of the given events.
fn crossings_of(
    marks: &[Mark],
    machine: &Machine<'_, f64>,
    events: &[Event],
    m: &mut Motion<f64>,
) -> Vec<f64> {
    let mut crossings = Vec::new();
    for event in events {
        let values: Vec<f64> = marks.iter().map(|mark| event.value(machine, mark.phi, mark.E, m)).collect();
        let near = ON_KINK * event.size(&values);
        for (k, mark) in marks.iter().enumerate() {
            let h = marks.get(k + 1).map_or(TAU, |next| next.phi) - mark.phi;
            let (left, right) = (values[k], values[(k + 1) % values.len()]);
            if left.abs() <= near {
                // The crossing of the mesh before: it stays an end of steps.
                crossings.push(mark.phi);
            } else if left * right < 0.0 && right.abs() > near {
                let excess = |h: f64| {
                    let E = machine.advance(mark.phi, mark.E, h, m);
                    event.value(machine, mark.phi + h, E, m)
                };
                crossings.push(mark.phi + crossing(excess, h, left, right));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings
}

/// Zero of `f` in [0, h] with given values of opposite sign at the ends: Illinois variant of regula falsi
/// (Dowell, Jarratt, *BIT* 11, 1971), order 1.44, never leaves the bracket.
pub fn crossing(mut f: impl FnMut(f64) -> f64, h: f64, mut left: f64, mut right: f64) -> f64 {
    let (mut a, mut b) = (0.0, h);
    let mut root = a;
    for _ in 0..60 {
        root = (a * right - b * left) / (right - left);
        let value = f(root);
        // Rounding of the speed limits the place to about 1e-14 of the step.
        if value == 0.0 || (b - a).abs() <= 1e-14 * h.abs() {
            break;
        }
        if value * right < 0.0 {
            (a, left) = (b, right);
        } else {
            left *= 0.5;
        }
        if (root - b).abs() <= 1e-14 * h.abs() {
            break;
        }
        (b, right) = (root, value);
    }
    root
}

/// Curves over the turn at given angles (from 0 to 2π): each list as long as `phi`.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    pub time: Vec<f64>,
    pub omega: Vec<f64>,
    pub epsilon: Vec<f64>,
    pub motor_torque: Vec<f64>,
    pub drive_torque: Vec<f64>,
    pub load_torque: Vec<f64>,
    pub J: Vec<f64>,
}

/// Reads the solution at many angles, as many at once as there are lanes.
pub struct ReadCurves<'a> {
    /// The machine's structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [f64],
    /// The solution.
    pub marks: &'a [Mark],
    /// The angles \[rad\], in [0, 2π].
    pub phi: &'a [f64],
}

impl Job for ReadCurves<'_> {
    type Output = Curves;

    #[inline(always)]
    fn run<R: Real>(self) -> Curves {
        let q: Vec<R> = self.q.iter().map(|&x| R::splat(x)).collect();
        let machine = Machine { plan: self.plan, q: &q };
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut curves = Curves::default();
        let n = R::LANES;
        let mut from = [vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        let mut lanes = vec![0.0; n];
        let mut k = 0;
        for phis in self.phi.chunks(n) {
            poll();
            for lane in 0..n {
                let phi = phis[lane.min(phis.len() - 1)];
                k = self.mark_before(phi, k);
                let mark = &self.marks[k];
                let values = [mark.phi, mark.E, phi - mark.phi, mark.t];
                for (list, value) in from.iter_mut().zip(values) {
                    list[lane] = value;
                }
            }
            let [phi, E, h, start] =
                [R::load(&from[0]), R::load(&from[1]), R::load(&from[2]), R::load(&from[3])];
            let (end, dt) = R::outline(
                #[inline(always)]
                || machine.advance_timed(phi, E, h, &mut m),
            );
            let state = R::outline(
                #[inline(always)]
                || machine.state(phi + h, end, &mut m),
            );
            let row = [
                (&mut curves.time, start + dt),
                (&mut curves.omega, state.omega),
                (&mut curves.epsilon, state.epsilon),
                (&mut curves.motor_torque, state.motor_torque),
                (&mut curves.drive_torque, state.drive_torque),
                (&mut curves.load_torque, state.load_torque),
                (&mut curves.J, state.J),
            ];
            for (list, value) in row {
                value.store(&mut lanes);
                list.extend_from_slice(&lanes[..phis.len()]);
            }
        }
        curves
    }
}

impl ReadCurves<'_> {
    /// Index of the last mark not after φ, looked for from a likely one on.
    fn mark_before(&self, phi: f64, from: usize) -> usize {
        let is_before = |k: usize| self.marks.get(k).is_some_and(|mark| mark.phi <= phi);
        let mut k = if is_before(from) { from } else { 0 };
        while is_before(k + 1) {
            k += 1;
        }
        k
    }
}
