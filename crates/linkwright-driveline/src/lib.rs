//! Motion of a torsionally flexible driveline that drives a mechanism with its true inertia J(φ) and loads M(φ, ω).
//!
//! | module | answers |
//! | --- | --- |
//! | [`law`] | torque of a link: straight, by a curve, with backlash |
//! | [`chain`] | masses, the springs with dampers between them, torques from outside |
//! | [`station`] | further mechanisms, at angles that the state tells |
//! | `speed_kinks` | where speeds with a kink of a characteristic are passed |
//! | [`station_kinks`] | where they pass kinks of their own |
//! | [`batch`] | many machines of one structure, each from the solution of another |
//! | `bundle` | the periodic solutions of some machines at once |
//! | [`equation`] | the equations of motion over the crank angle, and their Jacobian |
//! | `elimination` | a dense system for several right sides |
//! | [`mesh`] | steps of a cycle, the mechanism at their stages, a solution on them |
//! | [`cycle`] | Newton's method for the periodic solution |
//! | [`error`] | error of a solution in every step |
//! | [`request`] | what is asked for, and why there is none |
//! | [`scale`] | what errors are compared with |
//! | [`crossings`] | where a solution passes kinks of laws |
//! | `followed` | cycles in time, on steps that end where laws change their form |
//! | [`starts`] | the periodic solution on few steps |
//! | `finer` | ends of finer steps |
//! | [`steady`] | the periodic solution to a wanted accuracy |
//! | [`search`] | steady motion: by Newton's method, or behind cycles that the machine goes through |
//! | [`branch`] | steady motions over a parameter, through folds |
//! | [`reading`] | curves, extremes, and power of every part |
//! | [`in_time`] | motion in time from rest or any state |
//! | [`work`] | means and work of a cycle |

pub mod batch;
pub mod branch;
mod bundle;
pub mod chain;
pub mod crossings;
pub mod cycle;
mod elimination;
pub mod equation;
pub mod error;
mod finer;
mod followed;
pub mod in_time;
pub mod law;
pub mod mesh;
pub mod reading;
pub mod request;
pub mod scale;
pub mod search;
mod speed_kinks;
pub mod starts;
pub mod station;
pub mod station_kinks;
pub mod steady;
pub mod work;
