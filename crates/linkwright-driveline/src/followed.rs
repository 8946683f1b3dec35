//! Cycles of a driveline as it goes through them in time, each with steps that end where its laws change their form.
//!
//! Between two events the rates are smooth, so that the derivative of the end of a cycle by its start on these steps is that of the
//! motion, and Newton's method finds every law in the form that it has.

use crate::cycle::Stop;
use crate::equation::Equation;
use crate::finer::SAME_ANGLE;
use crate::in_time::Continuation;
use crate::in_time::events::Event;
use crate::in_time::start::Start;
use crate::in_time::trajectory::{End, Trajectory};
use crate::mesh::{Mesh, Solution};
use crate::request::Failure;
use linkwright_core::drive::mesh::crossing;
use linkwright_kernel::radau::C;
use linkwright_kernel::rk::rise;
use std::f64::consts::TAU;

/// Relative accuracy of a step.
const ACCURACY: f64 = 1e-8;

/// Time of a cycle at most, over that at the speed of the search.
const SLOWEST: f64 = 1e3;

/// What is followed.
pub(crate) struct Follower<'a> {
    /// The machine.
    pub(crate) equation: Equation<'a>,
    kinks: &'a [f64],
    known: Continuation,
    start: Start,
    /// Angle of the crank before the next cycle \[rad\].
    turned: f64,
}

/// A cycle that was followed.
pub(crate) struct Passed {
    /// Crank angles at the ends of the steps in time \[rad\].
    angles: Vec<f64>,
    /// Ends of steps over the angle, from 0 to the end of the cycle, and those of them where laws change their form \[rad\].
    edges: Vec<f64>,
    placed: Vec<f64>,
    trajectory: Trajectory,
}

impl<'a> Follower<'a> {
    /// Of a machine whose mechanism has kinks at these angles, from 0 to the end of its cycle, about a speed of the crank.
    pub(crate) fn new(equation: Equation<'a>, kinks: &'a [f64], speed: f64) -> Self {
        let cycle = kinks[kinks.len() - 1];
        let masses = equation.chain.masses();
        let start = Start {
            state: Vec::new(),
            time: 0.0,
            motor: 1.0,
            brakes: vec![0.0; masses],
            supply: 1.0,
            torques: vec![0.0; masses],
            coupling: 0.0,
            speed,
            until: SLOWEST * cycle / speed,
            turns: cycle / TAU,
            accuracy: ACCURACY,
        };
        Follower { equation, kinks, known: Continuation::new(equation, ACCURACY), start, turned: 0.0 }
    }

    /// The next cycle, which begins with a state.
    ///
    /// # Errors
    /// Where the crank does not go on, from the start of the first one; or it cannot be followed so exactly.
    pub(crate) fn cycle(&mut self, y: &[f64]) -> Result<Passed, Failure> {
        self.start.state.clear();
        self.start.state.extend_from_slice(y);
        self.start.state.push(0.0);
        let trajectory = self.known.follow(self.equation, &self.start);
        let (m, size) = (y.len(), trajectory.states.len() / trajectory.t.len());
        let at = |number: usize| trajectory.states.iter().skip(number).step_by(size).copied();
        let (angles, speeds): (Vec<f64>, Vec<f64>) = (at(m).collect(), at(m - 1).collect());
        let forward = speeds.iter().take_while(|&&speed| speed > 0.0).count();
        if forward < speeds.len() || matches!(trajectory.end, End::Rest | End::Time) {
            let last = forward.max(1) - 1;
            return Err(Failure::Stops(Stop { phi: self.turned + angles[last], omega: speeds[last] }));
        }
        if trajectory.end != End::Turns {
            return Err(Failure::NotFound { off: f64::NAN, parting: f64::NAN });
        }
        let (edges, placed) = self.edges(&trajectory, &angles);
        self.turned += edges[edges.len() - 1];
        Ok(Passed { angles, edges, placed, trajectory })
    }

    /// Ends of steps over the angle: those of the steps in time, and exactly the kinks of the mechanism.
    fn edges(&self, trajectory: &Trajectory, angles: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut edges = self.kinks.to_vec();
        let mut add = |angle: f64| {
            let behind = edges.partition_point(|&edge| edge < angle);
            let near = |i: usize| edges.get(i).is_some_and(|edge| (edge - angle).abs() < SAME_ANGLE);
            let is_new = !near(behind) && !near(behind.wrapping_sub(1));
            if is_new {
                edges.insert(behind, angle);
            }
            is_new
        };
        let mut placed = Vec::new();
        for (at, event) in &trajectory.events {
            if !matches!(event, Event::Last(_) | Event::Kink(0, _)) && add(angles[*at]) {
                placed.push(angles[*at]);
            }
        }
        angles.iter().for_each(|&angle| {
            add(angle);
        });
        (edges, placed)
    }
}

impl Passed {
    /// State at its start, with what follows behind it.
    pub(crate) fn start(&self) -> &[f64] {
        &self.trajectory.states
    }

    /// State at its end, of `m` numbers.
    pub(crate) fn end(&self, m: usize) -> Vec<f64> {
        let size = self.trajectory.states.len() / self.trajectory.t.len();
        self.trajectory.states[self.trajectory.states.len() - size..][..m].to_vec()
    }

    /// States at the ends of its steps in time.
    pub(crate) fn states(&self, m: usize) -> Solution {
        let size = self.trajectory.states.len() / self.trajectory.t.len();
        let rows = self.trajectory.states.chunks_exact(size).map(|row| &row[..m]);
        Solution { start: self.trajectory.states[..m].to_vec(), stages: rows.flatten().copied().collect() }
    }

    /// Adds the state at a crank angle.
    fn add_state(&self, angle: f64, m: usize, to: &mut Vec<f64>) {
        let size = self.trajectory.states.len() / self.trajectory.t.len();
        let steps = self.angles.len() - 1;
        let k = self.angles.partition_point(|&end| end < angle).clamp(1, steps) - 1;
        let factors = &self.trajectory.between[k * size..][..size];
        let [before, behind] = [k, k + 1].map(|end| self.angles[end] - angle);
        let share = if behind <= 0.0 {
            1.0
        } else if before >= 0.0 {
            0.0
        } else {
            crossing(|share| before + rise(&factors[m], share), 1.0, before, behind)
        };
        let start = &self.trajectory.states[k * size..][..m];
        to.extend(start.iter().zip(factors).map(|(y, factors)| y + rise(factors, share)));
    }
}

/// Steps and motion over some cycles, one behind the other, and the ends of steps at which laws change their form.
pub(crate) fn joined<'p>(
    equation: &Equation<'_>,
    cycles: impl Iterator<Item = &'p Passed>,
) -> (Mesh, Solution, Vec<f64>) {
    let m = equation.chain.states();
    let (mut edges, mut placed) = (vec![0.0], Vec::new());
    let mut solution = Solution { start: Vec::new(), stages: Vec::new() };
    for passed in cycles {
        let before = edges[edges.len() - 1];
        edges.extend(passed.edges[1..].iter().map(|edge| before + edge));
        placed.extend(passed.placed.iter().map(|kink| before + kink));
        if solution.start.is_empty() {
            passed.add_state(0.0, m, &mut solution.start);
        }
        for pair in passed.edges.windows(2) {
            C.iter()
                .for_each(|c| passed.add_state(pair[0] + c * (pair[1] - pair[0]), m, &mut solution.stages));
        }
    }
    (Mesh::new(equation, edges).with_kinks(&placed), solution, placed)
}
