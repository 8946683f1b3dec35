//! Steady motion of one machine to a wanted accuracy.
//!
//! The turn is solved on a mesh and on one twice as fine, until both agree. What differs by Δ on a method of
//! order 8 is off by Δ/255 on the finer one, so agreement is asked for within 100 times the accuracy. Where
//! the motor's or gearbox's characteristic has a kink at some speed, the angles at which the speed passes it
//! are found on each mesh and become ends of steps on the next.

use crate::cycle::{Machine, Turn};
use crate::lanes::Job;
use crate::linkage::Motion;
use crate::measures::{Extremes, Totals};
use crate::plan::Plan;
use crate::real::Real;
use crate::status::Status;

/// Steps of the first mesh.
const FIRST: usize = 24;

/// Finest mesh: a turn in 12 288 steps, about two minutes of arc each.
const FINEST: usize = FIRST << 9;

/// Agreement of two meshes per accuracy asked for; see the head of this file.
const MARGIN: f64 = 100.0;

/// The smallest accuracy that rounding leaves reachable.
const ROUNDING: f64 = 2e-14;

/// Steady motion of one machine.
#[derive(Clone, Debug)]
pub struct Steady {
    /// The turn's solution.
    pub turn: Turn<f64>,
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
    let speeds = plan.speed_kinks(q);
    let (mut crossings, mut before, mut sweeps, mut n) = (Vec::new(), None, 0, FIRST);
    while n <= FINEST {
        let breaks = machine.breaks(&crossings, &mut m);
        let mut turn = Turn::tabulate(&machine, &breaks, n, &mut m);
        if !turn.closes() {
            return Err(Status::DoesNotClose);
        }
        turn.start_from_balance(&machine);
        turn.solve(&machine, accuracy * 1e-2);
        sweeps += turn.sweeps;
        if !turn.is_solved() {
            return Err(Status::NoSteadyMotion);
        }
        let totals = turn.totals(&machine);
        let found = (totals.period, turn.steps[0].E);
        let difference = before.map_or(f64::INFINITY, |old| relative_difference(found, old));
        let next = turn.crossings(&machine, &speeds, &mut m);
        let settled = next.len() == crossings.len();
        if settled && difference <= MARGIN * accuracy {
            let extremes = turn.extremes(&machine, &mut m);
            return Ok(Steady { turn, extremes, totals, difference, sweeps });
        }
        (crossings, before, n) = (next, Some(found), n * 2);
    }
    Err(Status::Inaccurate)
}

fn relative_difference(a: (f64, f64), b: (f64, f64)) -> f64 {
    ((a.0 - b.0) / a.0).abs().max(((a.1 - b.1) / a.1).abs())
}

impl Turn<f64> {
    /// Whether every dyad closes at every stage.
    fn closes(&self) -> bool {
        self.steps.iter().all(|step| step.rows.iter().all(|row| !row.root.is_nan()))
    }

    /// Whether Newton converged to a real motion.
    pub fn is_solved(&self) -> bool {
        self.correction.is_finite()
            && self.correction <= 1e-6
            && self.multiplier.is_finite()
            && self.steps.iter().all(|step| step.E > 0.0 && step.E.is_finite())
    }

    /// Angles at which the speed passes one of the given ones.
    fn crossings(&self, machine: &Machine<'_, f64>, speeds: &[f64], m: &mut Motion<f64>) -> Vec<f64> {
        if speeds.is_empty() {
            return Vec::new();
        }
        let omega: Vec<f64> = self.steps.iter().map(|s| machine.state(s.phi, s.E, m).omega).collect();
        let mut found = Vec::new();
        for (k, step) in self.steps.iter().enumerate() {
            let (a, b) = (omega[k], omega[(k + 1) % omega.len()]);
            for &speed in speeds.iter().filter(|&&speed| (a - speed) * (b - speed) < 0.0) {
                let excess = |h: f64| {
                    let E = machine.advance(step.phi, step.E, h, m);
                    machine.state(step.phi + h, E, m).omega - speed
                };
                found.push(step.phi + crossing(excess, step.h, a - speed, b - speed));
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }
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
    pub turn: &'a Turn<f64>,
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
        let times = self.times();
        let mut curves = Curves::default();
        let n = R::LANES;
        let mut from = vec![[0.0; 4]; n];
        for phis in self.phi.chunks(n) {
            for (lane, slot) in from.iter_mut().enumerate() {
                let phi = phis[lane.min(phis.len() - 1)];
                let k = self.turn.steps.partition_point(|step| step.phi <= phi).max(1) - 1;
                let step = &self.turn.steps[k];
                *slot = [step.phi, step.E, phi - step.phi, times[k]];
            }
            let gather = |i: usize| R::load(&from.iter().map(|slot| slot[i]).collect::<Vec<_>>());
            let (phi, E, h, start) = (gather(0), gather(1), gather(2), gather(3));
            let (end, dt) = R::outline(
                #[inline(always)]
                || machine.advance_timed(phi, E, h, &mut m),
            );
            let state = R::outline(
                #[inline(always)]
                || machine.state(phi + h, end, &mut m),
            );
            let put = |list: &mut Vec<f64>, value: R| {
                let mut row = vec![0.0; n];
                value.store(&mut row);
                list.extend_from_slice(&row[..phis.len()]);
            };
            put(&mut curves.time, start + dt);
            put(&mut curves.omega, state.omega);
            put(&mut curves.epsilon, state.epsilon);
            put(&mut curves.motor_torque, state.motor_torque);
            put(&mut curves.drive_torque, state.drive_torque);
            put(&mut curves.load_torque, state.load_torque);
            put(&mut curves.J, state.J);
        }
        curves
    }
}

impl ReadCurves<'_> {
    /// Time at the start of each step.
    fn times(&self) -> Vec<f64> {
        let mut t = 0.0;
        let durations = self.turn.steps.iter().map(|step| {
            let start = t;
            t += step.duration();
            start
        });
        durations.collect()
    }
}
