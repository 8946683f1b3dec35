//! A motion that was followed.

use super::events::Event;
use crate::law::Zone;

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
    /// Angles of the crank of every mechanism between two kinks, in which each step is, row by row.
    pub intervals: Vec<[f64; 2]>,
    /// Form of the law of every link in every step, row by row.
    pub zones: Vec<Zone>,
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
