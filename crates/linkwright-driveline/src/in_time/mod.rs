//! Motion in time of a driveline with its mechanism, from any state.
//!
//! ```text
//! J_i a_i = M_d(w_i) + Σ T,   J(φ) a + ½ J′(φ) ω² = Σ T − M_r(φ, ω, t)
//! ```
//!
//! by DOP853 ([`linkwright_kernel::rk`]), or by Radau IIA ([`linkwright_kernel::radau`]) where stability would limit its steps, with the twists and speeds against the crank as unknowns: where links are stiff these are
//! small, and known as exactly as their torque. Steps end on kinks over the angle and over speeds, where a mass comes to rest, and
//! where a torque overcomes what holds it. Works are integrated beside the motion, so that the balance of energy measures it.
//!
//! | module | answers |
//! | --- | --- |
//! | [`system`] | torques and rates at one instant |
//! | [`events`] | what ends a step |
//! | `attempt` | steps of any length from one instant, by either method |
//! | `path` | accepted steps and their events |
//! | [`reading`] | curves and extremes, balance of energy |

mod attempt;
pub mod events;
mod path;
pub mod reading;
pub mod system;

use self::events::{Event, Events};
use self::path::Path;
use self::system::System;
use crate::equation::Equation;
use linkwright_core::drive::kinks::{kinks, landings};

/// What to follow.
#[derive(Clone, Debug)]
pub struct Start {
    /// Twists against the crank, speeds against it, speed and angle of the crank; without works.
    pub state: Vec<f64>,
    /// Time \[s\].
    pub time: f64,
    /// Direction in which the motor drives, +1 or −1.
    pub motor: f64,
    /// Speed of the crank about which the machine works \[rad/s\].
    pub speed: f64,
    /// Time at which the motion ends at the latest \[s\].
    pub until: f64,
    /// Most revolutions of the crank from the start angle, either way.
    pub turns: f64,
    /// Relative accuracy of a step, at its end and on the way there.
    pub accuracy: f64,
}

/// How a motion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The time is over.
    Time,
    /// The revolutions are done.
    Turns,
    /// All masses are at rest, and nothing moves them.
    Rest,
    /// The mechanism has no acceleration at the angle reached.
    DoesNotClose,
    /// Too many steps, or steps too small, for the accuracy.
    Inaccurate,
}

/// A motion at the ends of its steps, and between them.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Times \[s\].
    pub t: Vec<f64>,
    /// States, row by row.
    pub states: Vec<f64>,
    /// Factors of the polynomial of every number of the state in every step ([`linkwright_kernel::rk::rise`]).
    pub between: Vec<[f64; 7]>,
    /// Direction of every mass in every step, row by row.
    pub senses: Vec<f64>,
    /// Crank angles between two kinks, in which each step is.
    pub intervals: Vec<[f64; 2]>,
    /// Steps by the implicit method.
    pub implicit: usize,
    /// What ended steps: number of the end, and the event.
    pub events: Vec<(usize, Event)>,
    /// How it ended.
    pub end: End,
    /// Torque of the motor at the crank at the end, and of the loads, as if the crank were about to turn \[N m\].
    pub torques: [f64; 2],
    /// Evaluations of the machine.
    pub evaluations: usize,
}

/// Follows the motion until the time, the revolutions or rest end it.
pub fn follow(equation: Equation<'_>, start: &Start) -> Trajectory {
    let Equation { plan, q, .. } = equation;
    let kinks = landings(plan, q, kinks(plan, q));
    let mut system = System::new(equation, &kinks, start.speed, start.motor, start.accuracy);
    let mut y = vec![0.0; system.layout.size];
    y[..start.state.len()].copy_from_slice(&start.state);
    set_senses(&mut system, start.time, &y);
    let events = Events::new(&mut system, kinks, start.time, &y, start.turns);
    let mut path = Path::new(start, &system, y, events);
    path.trajectory.end = path.run(&mut system);
    path.finish(&mut system)
}

/// Directions of a state: those of speeds, and at rest what the torques do.
fn set_senses(system: &mut System<'_>, t: f64, y: &[f64]) {
    for mass in system.holding() {
        let speed = system.speed(mass, y);
        let is_moving = speed.abs() > system.slow;
        let sense = if is_moving { speed.signum() } else { system.way_from_rest(t, y, mass) };
        system.senses[mass] = sense;
    }
}
