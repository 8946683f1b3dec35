//! What is asked of a driveline, and why there is no steady motion.

use crate::cycle::Stop;

/// Why there is none.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// The crank comes to rest, or turns back.
    Stops(Stop),
    /// Neither Newton's method nor the motion in time comes to a periodic motion.
    NotFound {
        /// Smallest difference of its last cycles, over the largest of each number of the state.
        off: f64,
        /// Factor by which motions that are close part in a cycle, on average; NaN where it was not measured.
        parting: f64,
    },
    /// Steps cannot be divided further.
    Inaccurate(f64),
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// Relative accuracy.
    pub accuracy: f64,
    /// Speed of the crank to begin with \[rad/s\].
    pub speed: f64,
    /// Size of the fastest eigenvalue of the driveline whose disturbances last for a cycle \[1/s\].
    pub fastest: f64,
    /// Cycles that are followed before Newton's method is tried.
    pub cycles_first: usize,
    /// Cycles that are followed at most.
    pub cycles_max: usize,
    /// Cycles after which a motion that is followed may repeat, at most.
    pub multiples: usize,
    /// State to begin with, instead of one speed without twist.
    pub start: Option<Vec<f64>>,
}
